"""The leaf benchmark: error against CPU time of leaf materials in several programs (docs/leaf_benchmark.md)

Runs entries on tasks, and writes results/ENTRY.json, results/results.csv and, unless only some entries or samples were asked for, the
sections of docs/leaf_benchmark.md. Results of other tasks and entries stay.
  --task TASK       only this task; repeatable
  --entry ENTRY     only this entry: a folder of leaf_benchmark/entries, or the path of another folder; repeatable
  --samples N,N     samples per pixel of the images; default: 1,8,64
  --out FOLDER      writes the results there, and no page
  --page            runs nothing: writes the table and the page from the results
"""

import argparse
import datetime
import json
import os
import pathlib
import subprocess
import sys
import tempfile

import numpy

from measurements.shared.tools import machine

from . import checks, measures
from .programs.interface import Task

HERE = pathlib.Path(__file__).parent
TASKS = ["front", "back", "ambient", "glow", "leaf", "canopy"]
SAMPLES = [1, 8, 64]
LEAF_SAMPLES = 64
PATHS = [1024, 16384]  # of a view of the canopy
SEEDS = (1, 2)
# Entries in Python find this one, with the packages of leaf_benchmark/run, and this folder.
ENVIRONMENT = os.environ | {"PATH": f"{pathlib.Path(sys.executable).parent}:{os.environ['PATH']}",
                            "PYTHONPATH": f"{HERE.parent}:{os.environ.get('PYTHONPATH', '')}", "PYTHONDONTWRITEBYTECODE": "1"}


class Cannot(Exception):
    """An entry's reason why it has no figures for a task."""


def entries():
    return sorted(path.parent for path in HERE.glob("entries/*/entry"))


def tasks():
    return {name: Task(HERE / "tasks" / name) for name in TASKS if (HERE / "tasks" / name / "task.json").exists()}


def run(entry, task, samples, seed, out):
    """What the entry prints: its CPU seconds, set-up and versions."""
    done = subprocess.run([entry / "entry", task.folder, str(samples), str(seed), str(out)], capture_output=True, text=True, check=False,
                          env=ENVIRONMENT)
    lines = [line for line in done.stderr.splitlines() if line.strip()]
    if done.returncode and lines and lines[-1].startswith("cannot: "):
        raise Cannot(lines[-1].removeprefix("cannot: "))
    if done.returncode:
        raise SystemExit(f"{entry.name} {task.name} ended with {done.returncode}:\n{done.stderr}")
    return json.loads(done.stdout.strip().splitlines()[-1])


def written(out):
    """The file that an entry wrote: OUT, or OUT with the suffix .npy."""
    return next(path for path in (out, out.with_suffix(".npy")) if path.exists())


def image_result(entry, task, folder, numbers):
    from .truth import make as truth  # needs frond
    halves, leaf = truth.halves(task)
    points = []
    for samples in numbers:
        took, images = [], []
        for seed in SEEDS:
            out = folder / f"{samples}-{seed}.exr"
            took.append(run(entry, task, samples, seed, out))
            images.append(truth.colors(written(out)))
        found = measures.of_images(images, halves, leaf)
        points.append({"samples": samples, "cpu_s": min(t["cpu_s"] for t in took), "rms": found.pop("rms")})
    return {"points": points, "setup_s": min(t["setup_s"] for t in took), **found}, took[0]["versions"]


def leaf_result(entry, task, folder, _):
    from .truth import make as truth
    out = folder / "table.csv"
    took = run(entry, task, LEAF_SAMPLES, SEEDS[0], out)
    rows, [true] = measures.read_table(out), truth.files(task)
    return {"cpu_s": took["cpu_s"], "errors": measures.of_table(rows, measures.read_table(true)),
            "checks": checks.check(rows, task.leaf)}, took["versions"]


def canopy_result(entry, task, folder, _):
    from .truth import make as truth
    read = lambda path: numpy.loadtxt(path, delimiter=",", skiprows=1)
    halves, points = [read(path) for path in truth.files(task)], []
    for samples in PATHS:
        outs = [folder / f"{samples}-{seed}.csv" for seed in SEEDS]
        took = [run(entry, task, samples, seed, out) for seed, out in zip(SEEDS, outs)]
        found = measures.of_brf([read(out) for out in outs], halves, task.wavelengths_nm)
        points.append({"samples": samples, "cpu_s": min(t["cpu_s"] for t in took), "rms": found.pop("rms")})
    return {"points": points, "setup_s": min(t["setup_s"] for t in took), **found}, took[0]["versions"]


RESULTS = {"image": image_result, "leaf": leaf_result, "canopy": canopy_result}


def measure(entry, of, numbers, out):
    """Runs an entry on tasks, and keeps each task's result, or the reason why there is none."""
    for task in of:
        versions = {}
        with tempfile.TemporaryDirectory(prefix="leaf_benchmark.", dir=os.environ.get("TMPDIR")) as temporary:
            try:
                result, versions = RESULTS[task.kind](entry, task, pathlib.Path(temporary), numbers)
            except Cannot as reason:
                result = {"cannot": str(reason)}
        print(entry.name, task.name, brief(result), flush=True)
        keep(out, entry.name, {task.name: result}, versions)


def brief(result):
    if "cannot" in result:
        return f"cannot: {result['cannot']}"
    if "points" in result:
        last, bias = result["points"][-1], result["bias"]["all"]
        return f"RMS {last['rms']:.5f} at {last['samples']} samples, {last['cpu_s']:.2f} s; bias {bias[0]:.5f} ({bias[1]:.5f} to {bias[2]:.5f})"
    failed = [f"{c['check']} ({c['words']}): {c['value']:.4f}, limit {c['limit']:.4f}" for c in result.get("checks", []) if not c["passed"]]
    return f"{result.get('errors', '')}; " + ("checks passed" if not failed else "failed: " + "; ".join(failed))


def keep(folder, name, results, versions):
    """Merges results into those of record."""
    path = folder / f"{name}.json"
    known = json.loads(path.read_text(encoding="utf-8")) if path.exists() else {"entry": name, "versions": {}, "tasks": {}}
    about = {"machine": machine(), "date": datetime.date.today().isoformat(), "load": max(os.getloadavg())}
    known["versions"] |= versions
    known["tasks"] |= {task: result | about for task, result in results.items()}
    folder.mkdir(parents=True, exist_ok=True)
    path.write_text(json.dumps(rounded(known), indent=1) + "\n", encoding="utf-8")


def rounded(value):
    if isinstance(value, dict):
        return {key: rounded(v) for key, v in value.items()}
    if isinstance(value, list):
        return [rounded(v) for v in value]
    return float(f"{value:.4g}") if isinstance(value, float) else value


def main():
    parser = argparse.ArgumentParser(prog="leaf_benchmark/run")
    parser.add_argument("--task", action="append", choices=TASKS)
    parser.add_argument("--entry", action="append")
    parser.add_argument("--samples", type=lambda text: [int(n) for n in text.split(",")], default=SAMPLES)
    parser.add_argument("--out", type=pathlib.Path)
    parser.add_argument("--page", action="store_true")
    options = parser.parse_args()
    of = [task for name, task in tasks().items() if name in (options.task or TASKS)]
    if not options.page:
        chosen = [path if path.is_dir() else HERE / "entries" / path for path in map(pathlib.Path, options.entry)] if options.entry else entries()
        for entry in chosen:
            measure(entry.resolve(), of, options.samples, options.out or HERE / "results")
    if not options.out:
        from . import page
        page.write_all()


if __name__ == "__main__":
    main()
