"""CMakePresets.json: what runs under ThreadSanitizer is there, and the compiler of the preset clang is installed."""

import fnmatch
import json
import pathlib
import re
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
CASE = re.compile(r"^TEST(?:_F|_P)?\((\w+),\s*(\w+)\)", re.M)


class ThreadSanitizer(unittest.TestCase):
    def setUp(self):
        presets = json.loads((ROOT / "CMakePresets.json").read_text(encoding="utf-8"))
        self.build, = (p for p in presets["buildPresets"] if p["name"] == "tsan")
        self.test, = (p for p in presets["testPresets"] if p["name"] == "tsan")
        self.modules = [target.removeprefix("test_") for target in self.build["targets"]]

    def test_programs_that_are_built_are_run(self):
        self.assertEqual(self.test["filter"]["include"]["name"], f"^({'|'.join(self.modules)})$")

    def test_every_pattern_fits_a_case_and_every_program_has_one(self):
        patterns = self.test["environment"]["GTEST_FILTER"].split(":")
        unused = set(patterns)
        for module in self.modules:
            text = "".join(path.read_text(encoding="utf-8") for path in (ROOT / "tests" / module).glob("*_test.cpp"))
            cases = [".".join(names) for names in CASE.findall(text)]
            used = {p for p in patterns if fnmatch.filter(cases, p)}
            self.assertTrue(used, module)
            unused -= used
        self.assertFalse(unused)


class Compiler(unittest.TestCase):
    def test_the_package_of_clang_is_that_of_the_preset(self):
        presets = json.loads((ROOT / "CMakePresets.json").read_text(encoding="utf-8"))
        clang, = (p for p in presets["configurePresets"] if p["name"] == "clang")
        setup = (ROOT / "scripts" / "setup.sh").read_text(encoding="utf-8")
        self.assertIn(f"install_missing {clang['cacheVariables']['CMAKE_CXX_COMPILER'].replace('++', '')};", setup)


if __name__ == "__main__":
    unittest.main()
