"""The cookbook's recipes in Python run as they stand, one after the other. (Those for the shell: tests/cookbook.)"""

import os
import re
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]


def test_recipes(tmp_path, monkeypatch):
    pytest.importorskip("mitsuba")
    library = "/usr/lib/x86_64-linux-gnu/libLLVM-19.so"
    if "DRJIT_LIBLLVM_PATH" not in os.environ:
        if not os.path.exists(library):
            pytest.skip("libllvm19 is not installed")
        monkeypatch.setenv("DRJIT_LIBLLVM_PATH", library)
    for name in ("scenes", "tests"):
        (tmp_path / name).symlink_to(ROOT / name)
    monkeypatch.chdir(tmp_path)
    page = (ROOT / "docs" / "cookbook.md").read_text(encoding="utf-8")
    blocks = re.findall(r"^```python\n(.*?)^```$", page, re.M | re.S)
    assert len(blocks) >= 3
    names = {}
    for block in blocks:
        exec(compile(block, "docs/cookbook.md", "exec"), names)
    assert 0.7 < names["ndvi"].mean() < 0.9
    assert (tmp_path / "from_python.exr").stat().st_size > 1000
    monkeypatch.syspath_prepend(ROOT / "tests" / "cookbook")
    from cookbook_test import mean_of_png
    for image in ("mine.png", "mitsuba.png"):
        assert 0.1 < mean_of_png(tmp_path / image) < 0.9, image
