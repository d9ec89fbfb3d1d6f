"""Computes the model truth: what abm converges to, by leaf_solved. Images have two halves with seeds that no entry uses; their
difference is the truth's noise. frond gives the same bits on every machine: truth.json has the hash of each file's numbers."""

import hashlib
import json
import pathlib

import numpy

import frond
from measurements.shared.tools import ROOT, program

from ..programs import frond as by_frond, interface

FOLDER = pathlib.Path(__file__).parent
BUILD = ROOT / "build" / "leaf_benchmark" / "truth"
TASKS = ROOT / "leaf_benchmark" / "tasks"
LEAF = "leaf_solved,specimen=soybean"
MATERIAL = '"leaf_solved" "string specimen" "soybean"'
SAMPLES = 1024
PATHS = 1 << 18  # of a view of the canopy
SEEDS = (1001, 1002)
RAYS = 256  # times 4096


def colors(path):
    """Red, green and blue `[row][column][color]` of an EXR, or of a .npy; rows from the top."""
    if path.suffix == ".npy":
        return numpy.load(path).astype(float)
    names, pixels = frond.read_image(path)
    return numpy.stack([pixels[:, :, names.index(c)] for c in "RGB"], axis=-1).astype(float)


def recorded():
    path = FOLDER / "truth.json"
    return json.loads(path.read_text(encoding="utf-8")) if path.exists() else {}


def files(task):
    """The files of a task's truth, which are computed if they are missing."""
    ends = {"image": [f"-{seed}.exr" for seed in SEEDS], "leaf": [".csv"], "canopy": [f"-{seed}.csv" for seed in SEEDS]}
    paths = [BUILD / f"{task.name}{end}" for end in ends[task.kind]]
    BUILD.mkdir(parents=True, exist_ok=True)
    if not all(path.exists() for path in paths):
        if task.kind == "image":
            for path, seed in zip(paths, SEEDS):
                by_frond.image(MATERIAL)(task, SAMPLES, seed, path)
        elif task.kind == "canopy":
            for path, seed in zip(paths, SEEDS):
                numpy.savetxt(path, by_frond.brf(MATERIAL)(task, PATHS, seed)[0], delimiter=",", header="BRF by view and wavelength")
        else:
            interface.write_table(paths[0], by_frond.table(LEAF)(task, RAYS, SEEDS[0])[0])
        check(task, paths)
    return paths


def check(task, paths):
    """Records the hash of the numbers, or compares it with that of record."""
    content = [colors(path).astype("<f4").tobytes() if path.suffix == ".exr" else path.read_bytes() for path in paths]
    found, known = hashlib.sha256(b"".join(content)).hexdigest(), recorded()
    if known.get(task.name, {}).get("sha256", found) != found:
        raise SystemExit(f"the truth of {task.name} is not that of {FOLDER / 'truth.json'}: delete its entry there after a change of the leaf")
    known[task.name] = {"sha256": found, "samples": {"image": SAMPLES, "leaf": RAYS * 4096, "canopy": PATHS}[task.kind], "frond": program("--version").strip()}
    (FOLDER / "truth.json").write_text(json.dumps(known, indent=1) + "\n", encoding="utf-8")


def halves(task):
    """The two halves of an image, and where all of a pixel's samples see a leaf first."""
    pairs = files(task)
    share = [frond.read_image(path) for path in pairs]
    leaf = numpy.min([pixels[:, :, names.index("leaf")] for names, pixels in share], axis=0)
    return [colors(path) for path in pairs], leaf >= 1


if __name__ == "__main__":
    for folder in sorted(TASKS.glob("*/task.json")):
        files(interface.Task(folder.parent))
