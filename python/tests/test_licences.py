"""Licences of the sources: every file has one, and the origin of every table of others' figures is stated."""

import pathlib
import subprocess
import sys

import pytest

ROOT = pathlib.Path(__file__).parents[2]


def test_reuse_lint():
    pytest.importorskip("reuse")
    found = subprocess.run([sys.executable, "-m", "reuse", "--root", ROOT, "lint"], capture_output=True, text=True)
    assert found.returncode == 0, found.stdout + found.stderr


def test_every_table_has_an_origin():
    """A licence for all files would cover a new table of unknown origin, too: tables have entries of their own."""
    tables = [*ROOT.glob("src/**/*.csv"), *ROOT.glob("tests/reference/*.csv"), *ROOT.glob("scenes/**/*.csv")]
    assert len(tables) >= 9
    entries, notice = ((ROOT / name).read_text(encoding="utf-8") for name in ("REUSE.toml", "NOTICE"))
    for table in tables:
        assert f'"{table.relative_to(ROOT)}"' in entries, f"REUSE.toml does not state the licence of {table}"
        assert table.name in notice, f"NOTICE does not state the origin of {table}"
