"""The map of chlorophyll that docs/shot.md makes of a photo is the known one."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]


def test_the_map_of_a_photo_is_the_known_one(tmp_path, monkeypatch):
    pytest.importorskip("numpy")
    pytest.importorskip("PIL")
    pytest.importorskip("pandas")
    monkeypatch.setattr(sys, "path", [str(ROOT), *sys.path])
    monkeypatch.setenv("PATH", f"{Path(os.environ['FROND']).parent}:{os.environ['PATH']}")
    from measurements import shot

    for name in ("scenes", "examples"):
        (tmp_path / name).symlink_to(ROOT / name)
    monkeypatch.chdir(tmp_path)
    (_, photo), (_, script) = shot.blocks()[:2]
    subprocess.run(["bash", "-euc", photo], check=True)
    names = {}
    exec(compile(script, "docs/shot.md", "exec"), names)
    subprocess.run([os.environ["FROND"], "render", "examples/shot/photo.pbrt", "--spp", "1", "--channels", "uv", "-q", "-o", "uv.exr"],
                   check=True)
    known, leaf = shot.known_chlorophyll("uv.exr")
    of = leaf & names["mask"]
    assert of.sum() > 0.95 * leaf.sum()  # the mask has the leaf, but for its edge
    assert (names["mask"] & ~leaf).sum() < 0.01 * leaf.sum()
    found = list(shot.errors(names["chlorophyll"][of], known[of]))
    assert [count > 1000 for _, count, _, _ in found] == [True] * len(found)
    for content, _, mean, error in found:  # kg/m3, of contents up to 5; measured: docs/shot.md
        assert abs(mean) < 0.3 and error < 0.4, content
