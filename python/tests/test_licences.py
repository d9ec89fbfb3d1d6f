"""Licences of the sources: every file has one, and the origin of every table of others' figures is stated."""

import pathlib
import re
import subprocess
import sys
import tomllib

import pytest

ROOT = pathlib.Path(__file__).parents[2]


def entries():
    """Those of REUSE.toml, in its order: (paths, holders of the copyright, licence)."""
    def listed(value):
        return [value] if isinstance(value, str) else value
    found = tomllib.loads((ROOT / "REUSE.toml").read_text(encoding="utf-8"))["annotations"]
    return [(listed(e["path"]), listed(e["SPDX-FileCopyrightText"]), e["SPDX-License-Identifier"]) for e in found]


def test_reuse_lint():
    pytest.importorskip("reuse")
    found = subprocess.run([sys.executable, "-m", "reuse", "--root", ROOT, "lint"], capture_output=True, text=True)
    assert found.returncode == 0, found.stdout + found.stderr


def test_every_table_has_an_origin():
    """A licence for all files would cover a new table of unknown origin, too: tables have entries of their own."""
    tables = [*ROOT.glob("src/**/*.csv"), *ROOT.glob("tests/reference/*.csv"), *ROOT.glob("scenes/**/*.csv")]
    assert len(tables) >= 9
    stated = {path for paths, _, _ in entries()[1:] for path in paths}
    for table in tables:
        assert str(table.relative_to(ROOT)) in stated, f"REUSE.toml does not state the licence of {table}"
    notice = (ROOT / "NOTICE").read_text(encoding="utf-8")
    for path in stated:
        assert (ROOT / path).is_file(), f"REUSE.toml names {path}, which is not there"
        assert pathlib.Path(path).name in notice, f"NOTICE does not state the origin of {path}"
    for path in re.findall(r"^- ((?:src|scenes)/[^:]+):", notice, re.M):
        assert path in stated, f"REUSE.toml has no entry for {path}, which NOTICE names"


def test_debian_states_the_same():
    """cmake/debian/copyright, in Debian's format, has the entries of REUSE.toml, and a text for each licence."""
    text = (ROOT / "cmake/debian/copyright").read_text(encoding="utf-8")
    parts = [dict(re.findall(r"^([\w-]+): (.*(?:\n .*)*)", part, re.M)) for part in text.split("\n\n")]
    stated = [(["**" if path == "*" else path for path in part["Files"].split()],
               [line.strip() for line in part["Copyright"].split("\n")],
               part["License"].replace(" and ", " AND ")) for part in parts if "Files" in part]
    assert stated == entries()
    texts = {part["License"].split("\n")[0] for part in parts if "License" in part and "Files" not in part}
    assert texts == {licence for _, _, words in stated for licence in words.split(" AND ")}
