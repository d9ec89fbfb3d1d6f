"""scripts/tidy: which sources it looks at, and when it fails."""

import re
import unittest

from scripts_folder import SCRIPTS, FolderTest

FINDING = 'echo "/x/src/leaf.h:1:2: error: something [a-check]"'


class Tidy(FolderTest):
    def setUp(self):
        super().setUp()
        self.tool(self.tools / "dpkg-query", "echo install ok installed")
        self.tool(self.tools / "sudo", '"$@"')
        for tool in ("apt-get", "apt-cache"):
            self.tool(self.tools / tool, "exit 1")
        self.tool(self.tools / "cmake", "true")
        self.llvm_tool("clang-tidy-14", "14.0.6")
        self.write("leaf/walk.h", "")
        self.write("leaf/walk.cpp", '#include "leaf/walk.h"\n')
        self.write("core/math/vec.h", "")
        self.write("core/math/ray.h", '#include "core/math/vec.h"\n')
        self.write("core/bsdf.cpp", '#include "core/math/ray.h"\n')

    def write(self, name, text):
        path = self.root / "src" / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, encoding="utf-8")

    def tidy(self, *words):
        return self.bash(self.root / "scripts" / "tidy", *words)

    def looked_at(self):
        return sorted(line.split()[-1] for line in self.calls("clang-tidy-14").splitlines())

    def git(self, *words):
        self.bash("-c", 'cd "$0" && git -c user.name=x -c user.email=x -c init.defaultBranch=main "$@"', self.root, *words)

    def test_all_is_every_source(self):
        self.assertEqual(self.tidy("--all").returncode, 0)
        self.assertEqual(self.looked_at(), ["src/core/bsdf.cpp", "src/leaf.cpp", "src/leaf/walk.cpp"])

    def test_a_header_is_looked_at_by_its_source_or_one_that_includes_it(self):
        self.assertEqual(self.tidy(self.root / "src/leaf/walk.h", self.root / "src/core/math/vec.h").returncode, 0)
        self.assertEqual(self.looked_at(), ["src/core/bsdf.cpp", "src/leaf/walk.cpp"])

    def test_without_words_it_looks_at_what_differs_from_main(self):
        self.git("init")
        self.git("add", "src")
        self.git("commit", "-m", "x")
        self.assertIn("No file of src", self.tidy().stdout)
        self.git("checkout", "-b", "other")
        self.write("leaf/walk.h", "int changed;\n")
        self.git("commit", "-a", "-m", "y")
        self.write("core/bsdf.cpp", "int changed;\n")
        self.write("core/new.cpp", "")
        (self.root / "src" / "leaf.cpp").unlink()
        self.assertEqual(self.tidy().returncode, 0)
        self.assertEqual(self.looked_at(), ["src/core/bsdf.cpp", "src/core/new.cpp", "src/leaf/walk.cpp"])

    def test_what_it_cannot_compare_or_find_is_an_error(self):
        self.git("init")
        self.assertNotEqual(self.tidy().returncode, 0)
        self.assertNotEqual(self.tidy(self.root / "src/leaf/wlak.cpp").returncode, 0)

    def test_a_finding_is_an_error_and_said_once(self):
        self.llvm_tool("clang-tidy-14", "14.0.6", then=f'{FINDING}; echo "42 warnings generated." >&2; exit 1')
        done = self.tidy("--all")
        self.assertNotEqual(done.returncode, 0)
        self.assertEqual(done.stdout.count("[a-check]"), 1)
        self.assertEqual(done.stderr, "")

    def test_another_version_is_an_error(self):
        (self.tools / "clang-tidy-14").unlink()
        self.llvm_tool("clang-tidy", "19.1.7")
        done = self.tidy("--all")
        self.assertNotEqual(done.returncode, 0)
        self.assertIn("clang-tidy 14 is needed", done.stderr)
        self.assertEqual(self.calls("clang-tidy"), "")


class Settings(unittest.TestCase):
    def test_the_sources_that_the_reasons_name_exist(self):
        root = SCRIPTS.parent
        named = re.findall(r"[\w/]+\.(?:h|cpp)\b", (root / ".clang-tidy").read_text(encoding="utf-8"))
        self.assertIn("leaf/walk/batch_lanes.h", named)
        self.assertEqual([name for name in named if not (root / "src" / name).is_file()], [])


if __name__ == "__main__":
    unittest.main()
