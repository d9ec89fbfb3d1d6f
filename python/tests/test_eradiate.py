"""Leaves in Eradiate, run there for real. It brings a Mitsuba of its own, so it is another Python's: FROND_ERADIATE_PYTHON, or that
of build/eradiate-venv, which leaf_benchmark/run makes; skipped where there is none."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]

CODE = """
import numpy
from leaf_benchmark.programs import eradiate as runner
from eradiate import unit_registry as ureg
from eradiate.scenes.biosphere import DiscreteCanopy, InstancedCanopyElement
from measurements.shared import ply

import frond
from frond.eradiate import FrondLeafCloud, FrondMeshTreeElement

cloud = FrondLeafCloud.cuboid(n_leaves=4, leaf_radius=0.1, l_horizontal=1.0, l_vertical=1.0)
cloud.leaf = {"specimen": "maize"}
assert cloud._template_bsdfs[f"{cloud.bsdf_id}.specimen"] == "maize"

# 400 disks in a box, as an Eradiate canopy of disks, and as one mesh of squares for both programs
LEAVES, RADIUS, SIDE, HEIGHT, SUN = 400, 0.12, 3.0, 1.0, 30.0
ZENITH, NM, TARGET = [-60.0, -30.0, 0.0, 30.0, 60.0], [551.0, 800.0], (-0.8, 0.8, -0.8, 0.8, 1.0)
random = numpy.random.default_rng(5)
places = random.uniform([-1.5, -1.5, 0.1], [1.5, 1.5, 0.9], (LEAVES, 3))
n = random.normal(size=(LEAVES, 3))
n[:, 2] = abs(n[:, 2])
n /= numpy.linalg.norm(n, axis=1)[:, None]
x = numpy.cross(numpy.where(abs(n[:, :1]) > 0.7, [[0, 1, 0]], [[1, 0, 0]]), n)
x /= numpy.linalg.norm(x, axis=1)[:, None]
y = numpy.cross(n, x)
corners = (places[:, None] + 0.15 * numpy.stack([x, y, -x, -y], axis=1)).reshape(-1, 3)
first = 4 * numpy.arange(LEAVES)[:, None]
ply.write("leaves.ply", corners, numpy.concatenate([first + [0, 1, 2], first + [0, 2, 3]]))
rows = numpy.zeros(LEAVES, dtype=[("transform", "<f4", (3, 4))])
rows["transform"] = numpy.stack([x, y, n, places], axis=2)
numpy.save("leaves.npy", rows)

head = f'WorldBegin LightSource "distant" "point3 from" [ {numpy.sin(numpy.radians(SUN))} 0 {numpy.cos(numpy.radians(SUN))} ] ' \
    '"point3 to" [ 0 0 0 ] "spectrum L" "stdillum-E" Material "leaf_solved" "string incident" "reciprocal" '
cloud = FrondLeafCloud(id="leaves", leaf_positions=places * ureg.m, leaf_orientations=n, leaf_radii=numpy.full(LEAVES, RADIUS) * ureg.m,
                       leaf={"specimen": "soybean"})
disks = DiscreteCanopy(instanced_canopy_elements=[InstancedCanopyElement(canopy_element=cloud, instance_positions=[[0, 0, 0]] * ureg.m)],
                       size=[SIDE, SIDE, HEIGHT] * ureg.m)
mesh = runner.canopy(FrondMeshTreeElement(id="leaf", mesh_filename="leaves.ply", mesh_units=ureg.m, leaf={"specimen": "soybean"}),
                     [SIDE, SIDE, HEIGHT])
of_disks = f'ObjectBegin "leaf" Shape "disk" "float radius" {RADIUS} ObjectEnd Shape "instances" "string object" "leaf" "string filename" "leaves.npy"'
for canopy, leaves in ((disks, of_disks), (mesh, 'Shape "plymesh" "string filename" "leaves.ply"')):
    brf = numpy.array([runner.brf_of(canopy, SUN, ZENITH, TARGET, 150, seed, NM, 64)[0] for seed in range(1, 9)])
    open("canopy.pbrt", "w").write(head + leaves)
    ours = frond.brf("canopy.pbrt", NM, zenith=[-z for z in ZENITH], target=TARGET, rms=5e-3)["brf"]
    z = (brf.mean(axis=0) - numpy.reshape(ours, (len(ZENITH), -1))) / (brf.std(axis=0, ddof=1) / numpy.sqrt(len(brf)))
    print(float(abs(z).max()))
"""


def test_canopies_have_our_brf(tmp_path):
    python = os.environ.get("FROND_ERADIATE_PYTHON", str(ROOT / "build" / "eradiate-venv" / "bin" / "python"))
    if not os.path.exists(python):
        pytest.skip("Eradiate is not installed: leaf_benchmark/run does")
    paths = [*sys.path[:1], os.environ.get("FROND_PYTHON_PATH", str(ROOT / "build/release/python")), str(ROOT)]
    found = subprocess.run([python, "-c", CODE], capture_output=True, text=True, cwd=tmp_path, env=dict(os.environ, PYTHONPATH=os.pathsep.join(paths)))
    assert found.returncode == 0, found.stderr
    # 20 figures of 7 degrees of freedom each: Student's t beyond 8.5 has a chance of 6e-5, of any 1.3e-3. Seeds are fixed.
    assert all(float(z) < 8.5 for z in found.stdout.split()[-2:])
