"""What a release changes by hand says the same everywhere."""

import pathlib
import re
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]


def found(name, pattern):
    return re.search(pattern, (ROOT / name).read_text(encoding="utf-8"), re.M)[1]


class Version(unittest.TestCase):
    def test_the_citation_has_the_version_of_the_project(self):
        self.assertEqual(found("CITATION.cff", r"^version: (.*)$"), found("CMakeLists.txt", r"project\(frond VERSION (\S+)"))


if __name__ == "__main__":
    unittest.main()
