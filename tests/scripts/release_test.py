"""Versions and dates that a release changes by hand are equal everywhere."""

import pathlib
import re
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]


def found(name, pattern):
    return re.search(pattern, (ROOT / name).read_text(encoding="utf-8"), re.M)[1]


class Version(unittest.TestCase):
    def test_the_citation_has_the_version_of_the_project(self):
        self.assertEqual(found("CITATION.cff", r"^version: (.*)$"), found("CMakeLists.txt", r"project\(frond VERSION (\S+)"))

    def test_the_changelog_and_the_citation_have_its_date(self):
        version, date = re.search(r"^## (\S+), (\S+)$", (ROOT / "CHANGELOG.md").read_text(encoding="utf-8"), re.M).groups()
        self.assertEqual(version, found("CMakeLists.txt", r"project\(frond VERSION (\S+)"))
        if date != "unreleased":
            self.assertEqual(date, found("CITATION.cff", r"^date-released: \"(.*)\"$"))


if __name__ == "__main__":
    unittest.main()
