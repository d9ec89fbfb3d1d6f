"""Writes tests/data/VERSION: files of this version, which every later one must read (docs/compatibility.md).

Run it once for each release, before its tag, and never again for that version:
PYTHONPATH=build/release/python build/python-venv/bin/python tests/compatibility/record.py build/release/frond
"""

import csv
import json
import pathlib
import shutil
import subprocess
import sys
import tempfile

import frond

ROOT = pathlib.Path(__file__).resolve().parents[2]
BLOCK = 8  # pixels

SCENE = """# Files of earlier versions of frond: two tables of leaves, and a table of instances.
Scale -1 1 1
LookAt 0 -3 1   0 0 0   0 0 1
Camera "perspective" "float fov" 40
Film "rgb" "integer xresolution" 32 "integer yresolution" 32
PixelFilter "box"
Sampler "lattice" "integer pixelsamples" 64
Integrator "path" "integer maxdepth" 8
Option "string wavelengths" "smpte"
WorldBegin
LightSource "infinite" "spectrum L" "stdillum-D65" "float scale" 0.5
LightSource "distant" "point3 from" [ 1 -1 2 ] "point3 to" [ 0 0 0 ] "spectrum L" "stdillum-D65"
Material "leaf_simplified" "string specimen" "maize" "string tablefile" "maize.csv"
ObjectBegin "leaf"
  Shape "disk" "float radius" 0.2
ObjectEnd
Shape "instances" "string object" "leaf" "string filename" "leaves.npy"
Material "leaf_solved" "string specimen" "soybean" "string tablefile" "soybean.modes"
Shape "disk" "float radius" 1
"""
# Plug-ins of all kinds, and a program: tests/CMakeLists.txt compiles them with the headers of every later version.
SOURCES = {"plugins": ["tests/plugins/kinds.cpp", "examples/plugins/blade.cpp", "examples/plugins/led.cpp", "examples/plugins/soil.cpp"],
           "programs": ["examples/embed/embed.cpp"]}
LEAVES = "x,y,z,nx,ny,nz\n" + "".join(f"{x / 2},{y / 2},{0.3 + 0.1 * x},{x / 5},{y / 5},1\n" for x in (-1, 0, 1) for y in (-1, 0, 1))
# Commands that print JSON, in an order in which each finds its files. Their fields and their columns of CSV must remain.
OUTPUTS = """spectrophotometer leaf_solved --wavelengths 400:2500:50 --rays 1e3 --csv measured.csv --json -
goniophotometer leaf_solved --wavelengths 551 --rays 1e3 --patches 4x8 --csv patches.csv --json -
bench diffuse --wavelengths 551 --lanes 1 --min-time 0.001 --csv bench.csv --json -
conform diffuse --samples 1e3 --csv laws.csv --json -
fit measured.csv --csv fit.csv --json -
brf scene.pbrt --wavelengths 551 --paths 32 --csv brf.csv --json -
flux scene.pbrt --wavelengths 551 --paths 1e3 --csv flux.csv --json -
render scene.pbrt --spp 1 -o a.exr --json -
difference a.exr a.exr a.exr a.exr --json -"""


def outputs(program, commands, folder):
    """{command: {"json": its top-level fields, "csv": its columns}}, run in a folder with the version's scene."""
    found = {}
    for command in commands:
        words = command.split()
        text = subprocess.run([program, *words, "-q"], check=True, cwd=folder, capture_output=True, text=True).stdout
        found[command] = {"json": list(json.loads(text))}
        if "--csv" in words:
            with open(folder / words[words.index("--csv") + 1], encoding="utf-8") as file:
                found[command]["csv"] = next(csv.reader(line for line in file if not line.startswith("#")))
    return found


def block_means(file):
    """Means of R, G and B over blocks of the image, [row][column][colour]."""
    names, pixels = frond.read_image(file)
    colors = pixels[:, :, [names.index(c) for c in "RGB"]].astype(float)
    down, across = (size // BLOCK for size in colors.shape[:2])
    return colors.reshape(down, BLOCK, across, BLOCK, 3).mean(axis=(1, 3))


def main():
    program = pathlib.Path(sys.argv[1]).resolve()
    folder = ROOT / "tests" / "data" / frond.__version__
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)

    def run(*words):
        subprocess.run([program, *words, "-q"], check=True, cwd=folder)

    (folder / "scene.pbrt").write_text(SCENE)
    (folder / "leaves.csv").write_text(LEAVES)
    run("table", "leaf_simplified,specimen=maize", "--wavelengths", "455,551,608", "--angles", "0:180:10", "-o", "maize.csv")
    run("table", "leaf_solved,specimen=soybean", "--wavelengths", "455,551,608", "-o", "soybean.modes")
    run("table", "leaf_solved,specimen=soybean,incident=reciprocal", "--wavelengths", "551", "-o", "soybean.leaf")
    run("instances", "leaves.csv", "-o", "leaves.npy")
    for first in (0, 32):
        run("render", "scene.pbrt", "--samples", f"{first}:{first + 32}", "--part", f"{first}.part")
    run("merge", "0.part", "32.part", "-o", "merged.exr")
    merged = block_means(folder / "merged.exr")
    run("render", "scene.pbrt", "--seed", "1", "--spp", "16384", "-o", "image.exr")
    expected = {"merged": merged.tolist(), "mean": block_means(folder / "image.exr").tolist()}
    (folder / "expected.json").write_text(json.dumps(expected))
    for name in ("merged.exr", "image.exr"):
        (folder / name).unlink()
    with tempfile.TemporaryDirectory() as copy:
        found = outputs(program, OUTPUTS.splitlines(), pathlib.Path(shutil.copytree(folder, copy, dirs_exist_ok=True)))
    (folder / "outputs.json").write_text(json.dumps(found, indent=0) + "\n")
    shutil.copy(ROOT / "docs" / "commands.md", folder)
    with open(folder / "plugins.md", "w") as page:
        subprocess.run([program, "describe", "--markdown"], check=True, stdout=page)
    shutil.copy(ROOT / "python" / "frond" / "__init__.pyi", folder / "frond.pyi")
    for kind, sources in SOURCES.items():
        (folder / kind).mkdir()
        for source in sources:
            shutil.copy(ROOT / source, folder / kind)


if __name__ == "__main__":
    main()
