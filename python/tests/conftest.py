import os
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, os.environ.get("FROND_PYTHON_PATH", str(ROOT / "build" / "release" / "python")))

SCENE = """
Camera "orthographic" "float screenwindow" [ -1 1 -1 1 ]
Film "rgb" "integer xresolution" 16 "integer yresolution" 16
Sampler "lattice" "integer pixelsamples" 16
WorldBegin
LightSource "infinite" "spectrum L" "stdillum-D65"
MakeNamedMaterial "leaf" "string type" "leaf_solved"
NamedMaterial "leaf"
Shape "bilinearmesh" "point3 P" [ -2 -2 1  2 -2 1  -2 2 1  2 2 1 ]
"""


@pytest.fixture
def scene_text():
    """A leaf in an even light."""
    return SCENE


@pytest.fixture
def scenes():
    return ROOT / "scenes"


@pytest.fixture
def reference():
    return ROOT / "tests" / "reference"
