"""Runs every ```sh block of README.md and docs/cookbook.md, one after the other, in a folder of its own for each page; fails on the
first that fails, and where an image of a command is nearly black or white. README.md's ```shell blocks install frond: scripts/package,
scripts/wheel and tests/package do. Where FROND_SLOW_TESTS is 1 those of docs/shot.md too, with its blocks in Python among them. (Those of
the cookbook: python/tests/test_cookbook.py. Always its first ones: python/tests/test_shot.py.)

usage: cookbook_test.py BUILD_DIR FOLDER [PYTHON]
The build is installed into FOLDER, and its frond is the one in the path. Without PYTHON, which the module frond is built for,
docs/shot.md is left out."""

import os
import pathlib
import re
import shutil
import struct
import subprocess
import sys
import time
import zlib

ROOT = pathlib.Path(__file__).resolve().parents[2]

# Images that are no renders: a signed difference, white where there is none, and the charts of a report.
NO_RENDERS = re.compile(r"difference\.png$|report/")

# README.md's commands make whole images. Here they are small: these options are added where none of the name is given.
SMALLER = """#!/bin/sh
case "$1 $*" in
  render*--quick*) ;;
  render*) set -- "$@" --quick ;;
  compare*--size*) ;;
  compare*) set -- "$@" --size 48 --spp 8 --reference-spp 32 ;;
  spectrophotometer*--rays*) ;;
  spectrophotometer*) set -- "$@" --rays 1e4 ;;
esac
exec "%s" "$@"
"""


def blocks(text, languages="sh"):
    """Line numbers, languages and commands."""
    for match in re.finditer(rf"^```({languages})\n(.*?)^```$", text, re.M | re.S):
        yield text.count("\n", 0, match.start(2)) + 1, match[1], match[2]


def install(build, folder):
    """Environments whose frond is that of the build: as it is, and for small images."""
    programs, small = folder / "prefix" / "bin", folder / "small"
    subprocess.run(["cmake", "--install", build, "--prefix", programs.parent], check=True, stdout=subprocess.DEVNULL)
    small.mkdir()
    (small / "frond").write_text(SMALLER % (programs / "frond"))
    (small / "frond").chmod(0o755)
    environment = os.environ | {"PATH": f"{programs}:{os.environ['PATH']}", "XDG_CACHE_HOME": str(folder / "cache")}
    return environment, environment | {"PATH": f"{small}:{environment['PATH']}"}


def clone(folder):
    """The folder, with what a clone has."""
    folder.mkdir()
    for name in ("scenes", "examples", "tests"):
        (folder / name).symlink_to(ROOT / name)
    return folder


def mean_of_png(path):
    """The mean of a PNG of 8 bits without interlacing, as displayed, from 0 to 1; alpha does not count."""
    data = path.read_bytes()
    assert data[:8] == b"\x89PNG\r\n\x1a\n", path
    at, packed = 8, b""
    while at < len(data):
        size, kind = struct.unpack_from(">I4s", data, at)
        chunk = data[at + 8:at + 8 + size]
        if kind == b"IHDR":
            width, height, depth, color, _, _, interlace = struct.unpack(">IIBBBBB", chunk)
        elif kind == b"IDAT":
            packed += chunk
        at += size + 12
    assert depth == 8 and interlace == 0, path
    channels = {0: 1, 2: 3, 4: 2, 6: 4}[color]
    colors, stride = channels - (color >= 4), width * channels
    raw, row, total = zlib.decompress(packed), bytearray(stride), 0
    for y in range(height):
        kind, line = raw[y * (stride + 1)], bytearray(raw[y * (stride + 1) + 1:(y + 1) * (stride + 1)])
        for i in range(stride):
            a, b, c = (line[i - channels], row[i], row[i - channels]) if i >= channels else (0, row[i], 0)
            if kind == 1:
                line[i] = (line[i] + a) & 255
            elif kind == 2:
                line[i] = (line[i] + b) & 255
            elif kind == 3:
                line[i] = (line[i] + (a + b) // 2) & 255
            elif kind == 4:
                _, _, nearest = min((abs(b - c), 0, a), (abs(a - c), 1, b), (abs(a + b - 2 * c), 2, c))
                line[i] = (line[i] + nearest) & 255
        row = line
        total += sum(sum(row[k::channels]) for k in range(colors))
    return total / (width * height * colors * 255)


def images(folder):
    """{PNG: time of its last change} of the renders below a folder."""
    return {path: path.stat().st_mtime_ns for path in folder.rglob("*.png") if not NO_RENDERS.search(str(path.relative_to(folder)))}


def run(page, least_blocks, least_images, here, environment, python=None):
    programs = {"sh": ["bash", "-euo", "pipefail", "-c"]} | ({"python": [python, "-c"]} if python else {})
    count, seen = 0, images(here)
    shown = 0
    for line, language, commands in blocks((ROOT / page).read_text(encoding="utf-8"), "|".join(programs)):
        count += 1
        start = time.monotonic()
        r = subprocess.run([*programs[language], commands], cwd=here, env=environment, text=True, check=False,
                           stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
        print(f"{page}:{line}: {time.monotonic() - start:.1f} s", flush=True)
        if r.returncode != 0:
            sys.exit(f"{commands}\n{r.stdout}\nexit code {r.returncode}")
        before, seen = seen, images(here)
        for path in seen:
            if before.get(path) == seen[path]:
                continue
            shown += 1
            mean = mean_of_png(path)
            print(f"  {path.name}: mean {mean:.2f}", flush=True)
            if not 0.1 < mean < 0.9:
                sys.exit(f"{commands}\n{path.name} is nearly {'black' if mean < 0.5 else 'white'}: its mean is {mean:.3f} (--exposure auto?)")
    if count < least_blocks or shown < least_images:
        sys.exit(f"{page} has {count} blocks of commands and {shown} images: are they ```sh?")


def main(build, folder, python=None):
    folder = pathlib.Path(folder).resolve()
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    environment, small = install(build, folder)
    readme = (ROOT / "README.md").read_text(encoding="utf-8").splitlines()
    if len(readme) > 100:
        sys.exit(f"README.md has {len(readme)} lines: 100 at most")
    run("README.md", 2, 2, clone(folder / "readme"), small)
    run("docs/cookbook.md", 10, 4, clone(folder / "clone"), environment)
    if python and os.environ.get("FROND_SLOW_TESTS") == "1":
        run("docs/shot.md", 6, 6, clone(folder / "shot"), environment | {"PYTHONPATH": str(pathlib.Path(build) / "python")}, python)


if __name__ == "__main__":
    main(*sys.argv[1:])
