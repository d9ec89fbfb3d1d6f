"""The leaf as a file, by the header that other programs read it with."""

import os
import shutil
import subprocess
from pathlib import Path

import frond
import numpy
import pytest

HEADER = Path(__file__).resolve().parents[2] / "exports" / "cpp"


@pytest.fixture(scope="module")
def program(tmp_path_factory):
    compiler = os.environ.get("CXX") or shutil.which("c++")
    if not compiler:
        pytest.skip("there is no C++ compiler")
    path = tmp_path_factory.mktemp("leaf") / "leaf_albedo"
    subprocess.run([compiler, "-std=c++17", "-O1", "-Wall", "-Wextra", "-Werror", "-o", path, HEADER / "leaf_albedo.cpp"], check=True)
    return path


def pairs(count):
    w = numpy.random.default_rng(2).normal(size=(2, count, 3))
    w[:, :, 2] = numpy.copysign(numpy.maximum(abs(w[:, :, 2]), 0.01 * numpy.linalg.norm(w, axis=2)), w[:, :, 2])
    return w / numpy.linalg.norm(w, axis=2)[:, :, None]


def by_header(program, path, nm, first, second, *more):
    text = "\n".join(" ".join(repr(float(x)) for x in (*a, *b)) for a, b in zip(first, second))
    words = [program, path, str(nm), "-", *map(str, more)]
    found = subprocess.run(words, input=text, capture_output=True, text=True, check=True).stdout
    return numpy.array([[float(x) for x in line.split()] for line in found.splitlines()])


@pytest.mark.parametrize("incident", ["traced", "reciprocal"])
@pytest.mark.parametrize("specimen", ["soybean", "maize"])
def test_f_is_that_of_leaf_solved(program, tmp_path, specimen, incident):
    words = f"leaf_solved,specimen={specimen},incident={incident}"
    nm = [455, 551, 608]
    frond.leaf_table(words, nm).save(tmp_path / "a.leaf")
    first, second = pairs(3000)
    expected = frond.bsdf(words, nm).f(first, second)
    for lane, wavelength in enumerate(nm):
        found = by_header(program, tmp_path / "a.leaf", wavelength, first, second)
        difference = numpy.pi * (found[:, 0] - expected[:, lane])
        assert numpy.sqrt((difference**2).mean()) < 5e-5
        assert (found[:, 1] > 0).all()


def test_depths_and_wavelengths_between(program, tmp_path):
    """Another chlorophyll by its optical depth, at a wavelength between two of the table."""
    frond.leaf_table("leaf_solved,incident=reciprocal", numpy.arange(500, 601, 20), depths=(0.01, 5)).save(tmp_path / "b.leaf")
    chlorophyll = 2.0
    from frond import _frond
    chemistry = _frond.leaf_chemistry(frond.default_session()._session, f"leaf_solved,chlorophylla={chlorophyll}", [553.0])
    depth = chemistry["thickness"] * chemistry["mesophyllfraction"] * sum(
        chemistry["amount"][n] * a[0] for n, a in chemistry["specific_absorption"].items())
    first, second = pairs(1000)
    expected = frond.bsdf(f"leaf_solved,incident=reciprocal,chlorophylla={chlorophyll}", [553]).f(first, second)[:, 0]
    found = by_header(program, tmp_path / "b.leaf", 553, first, second, depth)[:, 0]
    assert numpy.sqrt(((numpy.pi * (found - expected)) ** 2).mean()) < 5e-4


@pytest.mark.parametrize("theta_deg", [8, 60, 172])
def test_samples_give_back_what_the_leaf_does(program, tmp_path, theta_deg):
    frond.leaf_table("leaf_solved", [551]).save(tmp_path / "c.leaf")
    words = subprocess.run([program, tmp_path / "c.leaf", "551", str(theta_deg)], capture_output=True, text=True, check=True).stdout.split()
    expected = frond.goniophotometer("leaf_solved", 551, theta_deg, patches=(40, 40), integrate=True)
    share = expected["f"][0, 0] * expected["projected_solid_angle_sr"]
    lit = (expected["theta_o_deg"] < 90) == (theta_deg < 90)
    # 10^6 samples with weights below 2: standard errors below 5e-4.
    assert abs(float(words[1]) - share[lit].sum()) < 2e-3
    assert abs(float(words[3]) - share[~lit].sum()) < 2e-3


def test_the_command_writes_the_same_file(tmp_path):
    for leaf in ("leaf_solved,specimen=maize", "leaf_solved,specimen=maize,incident=reciprocal"):
        frond.leaf_table(leaf, [455, 551, 608]).save(tmp_path / "module.leaf")
        command = [os.environ["FROND"], "table", leaf, "--wavelengths", "608,551,455"]
        subprocess.run([*command, "-o", tmp_path / "command.leaf", "-q"], check=True)
        # Where odd modes are 0, a table that was in the cache has 0, and one that was not a rounding error.
        module, ours = (numpy.fromfile(tmp_path / f"{name}.leaf", numpy.float32)[11:-2] for name in ("module", "command"))
        assert module.shape == ours.shape and numpy.allclose(module, ours, rtol=1e-6, atol=1e-9)


def test_a_damaged_file_is_refused(program, tmp_path):
    path = tmp_path / "d.leaf"
    frond.leaf_table("leaf_solved", [551]).save(path)
    whole = path.read_bytes()
    for bad, message in ((whole[:-100], "damaged"), (whole[:500] + b"x" + whole[501:], "damaged"), (b"no leaf", "not a .leaf file")):
        path.write_bytes(bad)
        found = subprocess.run([program, path, "551", "8"], capture_output=True, text=True)
        assert found.returncode == 1 and message in found.stderr


def forged(reciprocal=0, cells=4, wavelengths=(551,), depths=(), modes=1, claims=None):
    """Bytes of a .leaf file with a correct checksum. claims: numbers of the header in place of the right ones."""
    side, columns, kept = cells + 3, len(wavelengths) * max(1, len(depths)), max(len(wavelengths), 1)
    whole = dict(reciprocal=reciprocal, cells=cells, wavelengths=len(wavelengths), depths=len(depths), modes=modes) | (claims or {})
    header = numpy.array([whole["reciprocal"], whole["cells"], whole["wavelengths"], whole["depths"], *[whole["modes"]] * 4], "<u4")
    arrays = numpy.concatenate([[1.0], wavelengths, depths, numpy.full(len(wavelengths), 1.5), numpy.ones((kept if reciprocal else 1) * 65),
                                numpy.full(4 * columns * modes * side**2, 0.1), numpy.full(4 * columns * side, 0.3)]).astype("<f4")
    data = b"FRONDLF1" + header.tobytes() + arrays.tobytes()
    mask, h = 2**64 - 1, 0xCBF29CE484222325
    for byte in data:
        h = (h ^ byte) * 0x100000001B3 & mask
    h = (h ^ h >> 30) * 0xBF58476D1CE4E5B9 & mask
    h = (h ^ h >> 27) * 0x94D049BB133111EB & mask
    return data + (h ^ h >> 31).to_bytes(8, "little")


#: What makes a forged file damaged, although its checksum is right.
DAMAGED = {"no wavelength": dict(wavelengths=()), "no cell": dict(cells=0), "one depth": dict(depths=(1.0,)), "depth 0": dict(depths=(0.0,)),
           "depths 0 and 1": dict(depths=(0.0, 1.0)), "falling wavelengths": dict(wavelengths=(551, 455)), "nan": dict(wavelengths=(float("nan"),)),
           "many wavelengths": dict(claims=dict(wavelengths=2**32 - 1)), "many cells": dict(claims=dict(cells=2**32 - 3)),
           "a product of 2^64": dict(claims=dict(cells=2**17 - 3, modes=2**30))}


@pytest.mark.parametrize("name", ["good", *DAMAGED])
def test_a_forged_file_is_damaged(program, tmp_path, name):
    (tmp_path / "f.leaf").write_bytes(forged(**DAMAGED.get(name, {})))
    done = subprocess.run([program, tmp_path / "f.leaf", "551", "30"], capture_output=True, text=True)
    assert (done.returncode, "damaged" in done.stderr) == ((0, False) if name == "good" else (1, True)), done.stderr
