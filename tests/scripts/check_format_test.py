"""scripts/check-format, and how the right clang-format comes to be there."""

import unittest

from scripts_folder import FolderTest


class CheckFormat(FolderTest):
    def check_format(self, *words):
        return self.bash(self.root / "scripts" / "check-format", *words)

    def assert_refused(self, done, *texts):
        self.assertNotEqual(done.returncode, 0)
        for text in ("clang-format 14 is needed", "scripts/test installs it", *texts):
            self.assertIn(text, done.stderr)

    def test_another_version_is_an_error_that_says_so(self):
        for version in ("19.1.7 (3+b1)", "13.0.1", "140.0.0"):
            self.llvm_tool("clang-format", version)
            self.assert_refused(self.check_format(), f"clang-format is version {version.split('.', 1)[0]}")
            self.assert_refused(self.check_format("--fix"))
        self.assertEqual(self.calls("clang-format"), "")

    def test_none_is_an_error_too(self):
        self.assert_refused(self.check_format(), "there is none")

    def test_the_right_one_is_found_beside_another(self):
        self.llvm_tool("clang-format", "19.1.7")
        self.llvm_tool("clang-format-14", "14.0.6")
        self.assertEqual(self.check_format().returncode, 0)
        self.assertEqual(self.calls("clang-format"), "")
        self.assertEqual(self.calls("clang-format-14"), "--dry-run --Werror src/leaf.cpp\n")

    def test_the_right_one_needs_no_number_in_its_name(self):
        self.llvm_tool("clang-format", "14.0.6")
        self.assertEqual(self.check_format("--fix").returncode, 0)
        self.assertEqual(self.calls("clang-format"), "-i src/leaf.cpp\n")

    def test_what_was_installed_from_a_wheel_is_found(self):
        self.llvm_tool("clang-format", "19.1.7")
        self.llvm_tool("clang-format", "14.0.6", folder=self.root / "build" / "tools" / "bin")
        self.assertEqual(self.check_format().returncode, 0)
        self.assertIn("src/leaf.cpp", self.calls("clang-format"))

    def test_what_it_would_change_is_an_error(self):
        self.llvm_tool("clang-format", "14.0.6", then="exit 1")
        self.assertNotEqual(self.check_format().returncode, 0)

    def test_words_that_it_does_not_know_are_refused(self):
        self.llvm_tool("clang-format", "14.0.6")
        done = self.check_format("--fxi")
        self.assertNotEqual(done.returncode, 0)
        self.assertIn("usage: scripts/check-format", done.stderr)


class Install(FolderTest):
    """Debian's packages are such as a test says; what is installed comes out of a folder."""

    def setUp(self):
        super().setUp()
        self.tool(self.tools / "dpkg-query", "exit 1")
        self.tool(self.tools / "sudo", '"$@"')
        self.llvm_tool("clang-format-14", "14.0.6", folder=self.root / "archive")
        self.tool(self.tools / "apt-get", f"""
echo "$@" >>{self.root}/apt-get.calls
if [ "$1" = install ]; then cp {self.root}/archive/"${{@: -1}}" {self.tools}/; fi""")
        self.tool(self.tools / "apt-cache", f'[ "$1" = show ] && [ -e {self.root}/archive/"$2" ]')

    def install(self, name):
        return self.bash("-euc", f"source {self.root}/scripts/setup.sh; source {self.root}/scripts/llvm.sh; install_llvm {name}")

    def test_the_package_is_taken_where_there_is_one(self):
        self.llvm_tool("clang-format", "19.1.7")
        self.assertEqual(self.install("clang-format").returncode, 0)
        self.assertIn("install -y -qq --no-install-recommends clang-format-14\n", self.calls("apt-get"))

    def test_nothing_is_installed_where_it_is_there(self):
        self.llvm_tool("clang-format", "14.0.6")
        self.assertEqual(self.install("clang-format").returncode, 0)
        self.assertEqual(self.calls("apt-get"), "")

    def test_what_cannot_be_had_is_an_error(self):
        done = self.install("clang-tidy")
        self.assertNotEqual(done.returncode, 0)
        self.assertIn("clang-tidy 14 is needed", done.stderr)
        self.assertNotIn("PyPI", done.stderr)


if __name__ == "__main__":
    unittest.main()
