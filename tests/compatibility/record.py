"""Writes tests/data/VERSION: files of this version, which every later one must read (docs/compatibility.md).

Run it once for each release, before its tag, and never again for that version:
PYTHONPATH=build/release/python build/python-venv/bin/python tests/compatibility/record.py build/release/frond
"""

import json
import pathlib
import shutil
import subprocess
import sys

import frond

ROOT = pathlib.Path(__file__).resolve().parents[2]
BLOCK = 8  # pixels

SCENE = """# Files of earlier versions of frond: two tables of leaves, and a table of instances.
Scale -1 1 1
LookAt 0 -3 1   0 0 0   0 0 1
Camera "perspective" "float fov" 40
Film "rgb" "integer xresolution" 32 "integer yresolution" 32
PixelFilter "box"
Sampler "paddedsobol" "integer pixelsamples" 64
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
    for name in ("commands.md", "plugins.md"):
        shutil.copy(ROOT / "docs" / name, folder)
    shutil.copy(ROOT / "python" / "frond" / "__init__.pyi", folder / "frond.pyi")
    for kind, sources in SOURCES.items():
        (folder / kind).mkdir()
        for source in sources:
            shutil.copy(ROOT / source, folder / kind)


if __name__ == "__main__":
    main()
