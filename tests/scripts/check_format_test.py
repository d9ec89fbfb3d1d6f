"""scripts/check-format and what it takes for clang-format, on a path that holds nothing but what a test puts there."""

import pathlib
import shutil
import subprocess
import tempfile
import unittest

SCRIPTS = pathlib.Path(__file__).resolve().parents[2] / "scripts"
NEEDED = ("bash", "basename", "dirname", "env", "find", "id", "sed", "xargs")


class ScriptsTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.root = pathlib.Path(folder.name)
        self.tools = self.root / "tools"
        for name in ("scripts", "src", "tests", "bench", "tools"):
            (self.root / name).mkdir()
        for script in ("check-format", "llvm.sh", "setup.sh"):
            shutil.copy(SCRIPTS / script, self.root / "scripts")
        (self.root / "src" / "leaf.cpp").write_text("int leaf;\n", encoding="utf-8")
        for tool in NEEDED:
            (self.tools / tool).symlink_to(shutil.which(tool))

    def tool(self, path, script):
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(f"#!{shutil.which('bash')}\n{script}\n", encoding="utf-8")
        path.chmod(0o755)

    def clang_format(self, version, name="clang-format", folder=None, exit_code=0):
        """One that notes its arguments in a file of its own name."""
        self.tool((folder or self.tools) / name, f"""
if [ "$1" = --version ]; then echo "Debian clang-format version {version}"; exit; fi
echo "$@" >>{self.root}/{name}.calls
exit {exit_code}""")

    def calls(self, name="clang-format"):
        path = self.root / f"{name}.calls"
        return path.read_text(encoding="utf-8") if path.exists() else ""

    def bash(self, *words):
        return subprocess.run([self.tools / "bash", *words], env={"PATH": str(self.tools)}, capture_output=True, text=True,
                              check=False)


class CheckFormat(ScriptsTest):
    def check_format(self, *words):
        return self.bash(self.root / "scripts" / "check-format", *words)

    def assert_refused(self, done, *texts):
        self.assertNotEqual(done.returncode, 0)
        for text in ("clang-format 14 is needed", "scripts/test installs it", *texts):
            self.assertIn(text, done.stderr)

    def test_another_version_is_an_error_that_says_so(self):
        for version in ("19.1.7 (3+b1)", "13.0.1", "140.0.0"):
            self.clang_format(version)
            self.assert_refused(self.check_format(), f"clang-format is version {version.split('.', 1)[0]}")
            self.assert_refused(self.check_format("--fix"))
        self.assertEqual(self.calls(), "")

    def test_none_is_an_error_too(self):
        self.assert_refused(self.check_format(), "there is none")

    def test_the_right_one_is_found_beside_another(self):
        self.clang_format("19.1.7")
        self.clang_format("14.0.6", "clang-format-14")
        self.assertEqual(self.check_format().returncode, 0)
        self.assertEqual(self.calls(), "")
        self.assertEqual(self.calls("clang-format-14"), "--dry-run --Werror src/leaf.cpp\n")

    def test_the_right_one_needs_no_number_in_its_name(self):
        self.clang_format("14.0.6")
        self.assertEqual(self.check_format("--fix").returncode, 0)
        self.assertEqual(self.calls(), "-i src/leaf.cpp\n")

    def test_what_was_installed_from_a_wheel_is_found(self):
        self.clang_format("19.1.7")
        self.clang_format("14.0.6", folder=self.root / "build" / "tools" / "bin")
        self.assertEqual(self.check_format().returncode, 0)
        self.assertIn("src/leaf.cpp", self.calls())

    def test_what_it_would_change_is_an_error(self):
        self.clang_format("14.0.6", exit_code=1)
        self.assertNotEqual(self.check_format().returncode, 0)

    def test_words_that_it_does_not_know_are_refused(self):
        self.clang_format("14.0.6")
        done = self.check_format("--fxi")
        self.assertNotEqual(done.returncode, 0)
        self.assertIn("usage: scripts/check-format", done.stderr)


class Install(ScriptsTest):
    def setUp(self):
        super().setUp()
        self.tool(self.tools / "dpkg-query", "exit 1")
        self.tool(self.tools / "sudo", '"$@"')
        self.tool(self.tools / "apt-get", f'echo "$@" >>{self.root}/apt-get.calls')

    def install(self):
        return self.bash("-euc", f"source {self.root}/scripts/setup.sh; source {self.root}/scripts/llvm.sh; "
                                 "install_llvm clang-format")

    def test_the_package_is_taken_where_there_is_one(self):
        self.clang_format("19.1.7")
        self.tool(self.tools / "apt-cache", '[ "$*" = "show clang-format-14" ]')
        self.assertEqual(self.install().returncode, 0)
        self.assertIn("install -y -qq --no-install-recommends clang-format-14\n", self.calls("apt-get"))

    def test_nothing_is_installed_where_it_is_there(self):
        self.clang_format("14.0.6")
        self.assertEqual(self.install().returncode, 0)
        self.assertEqual(self.calls("apt-get"), "")


if __name__ == "__main__":
    unittest.main()
