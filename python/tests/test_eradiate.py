"""Leaves in Eradiate, run there for real. It brings a Mitsuba of its own, so it is another Python's: FROND_ERADIATE_PYTHON, or that
of build/eradiate-venv, which measurements/run eradiate makes; skipped where there is none."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]

CODE = """
import eradiate, numpy
eradiate.set_mode("mono")
eradiate.config.settings.progress = "NONE"
from measurements import eradiate as report
from frond.eradiate import FrondLeafCloud

cloud = FrondLeafCloud.cuboid(n_leaves=4, leaf_radius=0.1, l_horizontal=1.0, l_vertical=1.0)
cloud.leaf = {"specimen": "maize"}
assert cloud._template_bsdfs[f"{cloud.bsdf_id}.specimen"] == "maize"

report.FOLDER.mkdir(parents=True, exist_ok=True)
leaf = {"leaf": {"specimen": "soybean"}}
brf = numpy.array([report.by_eradiate(report.SMALL, FrondLeafCloud, leaf, seed, 400)[0] for seed in range(1, 9)])
mean, error = brf.mean(axis=0), brf.std(axis=0, ddof=1) / numpy.sqrt(len(brf))
ours, *_ = report.by_frond(report.SMALL, '"leaf_solved" "string incident" "reciprocal"', rms=5e-3)
z = (mean - ours) / error
print(float(abs(z).max()))
"""


def test_a_canopy_has_our_brf():
    python = os.environ.get("FROND_ERADIATE_PYTHON", str(ROOT / "build" / "eradiate-venv" / "bin" / "python"))
    if not os.path.exists(python):
        pytest.skip("Eradiate is not installed: measurements/run eradiate does")
    paths = [*sys.path[:1], os.environ.get("FROND_PYTHON_PATH", str(ROOT / "build/release/python")), str(ROOT)]
    found = subprocess.run([python, "-c", CODE], capture_output=True, text=True, env=dict(os.environ, PYTHONPATH=os.pathsep.join(paths)))
    assert found.returncode == 0, found.stderr
    # 14 figures of 7 degrees of freedom each: Student's t beyond 8.5 has a chance of 6e-5, of any 9e-4. Seeds are fixed.
    assert float(found.stdout.split()[-1]) < 8.5
