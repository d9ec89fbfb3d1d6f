"""Files that earlier versions wrote, in tests/data/VERSION, are read, and what they offered is still there
(docs/compatibility.md)."""

import ast
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys

import numpy
import pytest

import frond

ROOT = pathlib.Path(__file__).parents[2]
VERSIONS = sorted(folder for folder in (ROOT / "tests/data").iterdir() if folder.is_dir())
sys.path.insert(0, str(ROOT / "tests/compatibility"))
from record import block_means, outputs  # noqa: E402

pytestmark = pytest.mark.parametrize("version", VERSIONS, ids=lambda folder: folder.name)


@pytest.fixture
def copy(version, tmp_path):
    return pathlib.Path(shutil.copytree(version, tmp_path / version.name))


def expected(version):
    return {name: numpy.array(values) for name, values in json.loads((version / "expected.json").read_text()).items()}


def test_parts_are_merged(version, copy):
    frond.merge([copy / "0.part", copy / "32.part"], copy / "merged.exr")
    # Sums are exact, but for the rounding to the file's floats.
    numpy.testing.assert_allclose(block_means(copy / "merged.exr"), expected(version)["merged"], rtol=1e-6)


def test_a_scene_with_tables_renders_the_same(version, copy):
    """16 seeds against the recorded means, whose noise is 16 times smaller in variance. By Student's t with 15 degrees of
    freedom, a correct image exceeds 8 standard errors in one of 48 means with probability 5e-5."""
    renders = []
    for seed in range(16):
        frond.render(copy / "scene.pbrt", copy / "image.exr", seed=seed, spp=64)
        renders.append(block_means(copy / "image.exr"))
    error = numpy.std(renders, axis=0, ddof=1) / 4
    difference = numpy.mean(renders, axis=0) - expected(version)["mean"]
    # Blocks of the even sky have no noise, only rounding.
    assert (abs(difference) <= 8 * numpy.hypot(error, error / 4) + 1e-6).all()


def test_a_leaf_file_is_read(version, copy):
    table = frond.leaf_table("leaf_solved,specimen=soybean,incident=reciprocal", [551])
    table.save(copy / "now.leaf")
    old, now = ((copy / name).read_bytes() for name in ("soybean.leaf", "now.leaf"))
    same = len(old) == len(now) and old[:16] == now[:16]
    assert same or old[:8] != now[:8], "the format changed: give it another version, and read both"
    compiler = shutil.which("g++")
    if not compiler:
        pytest.skip("there is no g++")
    program = copy / "leaf_albedo"
    subprocess.run([compiler, "-std=c++17", "-O1", ROOT / "exports/cpp/leaf_albedo.cpp", "-o", program], check=True)
    albedos = [subprocess.run([program, copy / name, "551", "30"], capture_output=True, text=True, check=True).stdout
               for name in ("soybean.leaf", "now.leaf")]
    # Machines with other instructions round differently.
    old, now = ([float(number) for number in re.findall(r"\d+\.\d+", text)] for text in albedos)
    assert old and old == pytest.approx(now, rel=1e-4, abs=1e-6)


def test_plugins_of_the_version_compile_and_load(version):
    """Those that tests/CMakeLists.txt compiled from the version's sources."""
    folder = pathlib.Path(os.environ["FROND_TEST_PLUGIN"]).parent / version.name
    for source in (version / "plugins").glob("*.cpp"):
        found = subprocess.run([os.environ["FROND"], "list", "--plugin", folder / f"{source.stem}.so"], capture_output=True, text=True)
        assert found.returncode == 0, found.stderr
    described = subprocess.run([os.environ["FROND"], "describe", "--plugin", folder / "soil.so", "soil"], capture_output=True, text=True)
    assert "soil" in described.stdout


def test_a_program_of_the_version_compiles_and_runs(version, tmp_path):
    program = pathlib.Path(os.environ["FROND_TEST_PLUGIN"]).parent / version.name / "embed"
    scene = tmp_path / "scene.pbrt"
    scene.write_text("""Camera "perspective" "float fov" 40
Film "rgb" "integer xresolution" 16 "integer yresolution" 16
WorldBegin
LightSource "infinite"
Translate 0 0 3
Material "leaf_simplified"
Shape "disk"
""")
    ran = subprocess.run([program, scene], capture_output=True, text=True)
    assert ran.returncode == 0 and "pixels; green differs" in ran.stdout, ran.stderr


def parameters_of(pages):
    """{(plug-in or command, name of a parameter): (types, default, choices)}, from the tables below headings. Words in capitals,
    for values of options, are no types."""
    found, heading = {}, None
    words = lambda cell: re.split(r" ?(?:\\\||,) ?", cell)
    for line in "\n".join(page.read_text(encoding="utf-8") for page in pages).splitlines():
        if line.startswith("#"):
            heading = line.strip("# ")
        elif line.startswith("| `"):
            cells = [cell.strip() for cell in re.split(r"(?<!\\)\|", line)[1:]]
            kinds, default, _, choices = (*cells[1:5], *4 * [""])[:4]
            for name in words(cells[0].strip("`")):
                found[heading, name] = ({kind for kind in words(kinds) if kind.islower()}, default, words(choices))
    return found


@pytest.mark.parametrize("page", ["plugins.md", "commands.md"])
def test_plugins_commands_and_parameters_remain(version, page):
    before, now = parameters_of([version / page]), parameters_of(sorted((ROOT / "docs").glob(page.replace(".md", "*.md"))))
    missing = before.keys() - now.keys()
    assert not missing, f"{version.name} had these; keep them, or say in CHANGELOG.md what replaces them: {sorted(missing)}"
    for key, (kinds, default, choices) in before.items():
        assert kinds <= now[key][0], f"{key} took other values in {version.name}"
        assert default in (now[key][1], "required"), f"{key} had the default {default} in {version.name}"
        assert len(choices) == 1 or set(choices) <= set(now[key][2]), f"{key} had other choices in {version.name}"


def test_fields_and_columns_remain(version, copy):
    before = json.loads((version / "outputs.json").read_text())
    now = outputs(os.environ["FROND"], before, copy)
    for command, of in before.items():
        for form, names in of.items():
            missing = [name for name in names if name not in now[command][form]]
            assert not missing, f"frond {command}: {form} of {version.name} had {missing}"


def functions(stub):
    """Names of parameters by the function or method."""
    found = {}
    for node in ast.walk(ast.parse(stub.read_text(encoding="utf-8"))):
        inside = node.body if isinstance(node, (ast.ClassDef, ast.Module)) else []
        for child in inside:
            if isinstance(child, ast.FunctionDef) and not child.name.startswith("_"):
                name = f"{node.name}.{child.name}" if isinstance(node, ast.ClassDef) else child.name
                arguments = child.args
                found[name] = ([a.arg for a in arguments.posonlyargs + arguments.args], {a.arg for a in arguments.kwonlyargs})
    return found


def test_python_functions_remain(version):
    now = functions(ROOT / "python/frond/__init__.pyi")
    for name, (positional, keywords) in functions(version / "frond.pyi").items():
        assert name in now, f"frond.{name} of {version.name} is gone"
        assert now[name][0][:len(positional)] == positional, f"the order of parameters of frond.{name} has changed"
        assert keywords <= now[name][1] | set(now[name][0]), f"a parameter of frond.{name} is gone"
