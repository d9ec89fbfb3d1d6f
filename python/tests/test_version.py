"""Files that name the version name that of CMakeLists.txt, which pyproject.toml reads."""

import pathlib
import re

import pytest

ROOT = pathlib.Path(__file__).parents[2]
VERSION = re.search(r"project\(frond VERSION ([0-9.]+)", (ROOT / "CMakeLists.txt").read_text(encoding="utf-8"))[1]
NAMED = r"\bfrond(?:_render)?[-_ ](\d+\.\d+\.\d+)"


@pytest.mark.parametrize("file, pattern", [
    ("README.md", NAMED), ("docs/compatibility.md", NAMED), ("docs/python.md", NAMED), ("CITATION.cff", r"^version: (.+)$"),
    ("CHANGELOG.md", r"\A# Changelog\n\n## ([0-9.]+),")])
def test_the_version_is_the_same(file, pattern):
    found = re.findall(pattern, (ROOT / file).read_text(encoding="utf-8"), re.M)
    assert found and set(found) == {VERSION}
