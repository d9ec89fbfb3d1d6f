"""The leaf benchmark: error against CPU time of leaf materials in several programs (docs/leaf_benchmark.md)

Runs entries on tasks, and writes results/ENTRY.json, results/results.csv and, unless only some entries or samples were asked for, the
sections of docs/leaf_benchmark.md. Results of other tasks, entries and numbers of samples stay.
  --task TASK       only this task; repeatable
  --entry ENTRY     only this entry: a folder of leaf_benchmark/entries, or the path of another folder; repeatable
  --samples N,N     samples per pixel of the images, by default 1,8,64; paths of a view of the canopy, by default 1024,16384
  --core N          reserves this core for the entries: real-time priority, which needs root
  --again           a second run with other seeds, which is stored beside the first
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
SAMPLES = {"image": [1, 8, 64], "leaf": [64], "canopy": [1024, 16384]}  # by kind of task
MISSING = 127  # exit status of an entry whose program is not installed
# Entries in Python find this one and that of Eradiate, with the packages of leaf_benchmark/run, and this folder.
ENVIRONMENT = os.environ | {"PATH": f"{pathlib.Path(sys.executable).parent}:{os.environ['PATH']}:{HERE.parent / 'build' / 'eradiate-venv' / 'bin'}",
                            "PYTHONPATH": f"{HERE.parent}:{os.environ.get('PYTHONPATH', '')}", "PYTHONDONTWRITEBYTECODE": "1"}


class Cannot(Exception):
    """An entry's reason why it has no figures for a task."""


def entries():
    return sorted(path.parent for path in HERE.glob("entries/*/entry"))


def tasks():
    return {name: Task(HERE / "tasks" / name) for name in TASKS if (HERE / "tasks" / name / "task.json").exists()}


def run(entry, task, samples, seed, out, core=None):
    """What the entry prints: its CPU seconds, set-up and versions."""
    words = [entry / "entry", task.folder, samples, seed, out]
    if core is not None:  # round robin, because threads of one program may wait for each other
        words = ["chrt", "--rr", 10, "taskset", "--cpu-list", core, *words]
    done = subprocess.run(list(map(str, words)), capture_output=True, text=True, check=False, env=ENVIRONMENT)
    lines = [line for line in done.stderr.splitlines() if line.strip()]
    if done.returncode and lines and lines[-1].startswith("cannot: "):
        raise Cannot(lines[-1].removeprefix("cannot: "))
    if done.returncode == MISSING:
        raise FileNotFoundError(lines[-1])
    if done.returncode:
        raise SystemExit(f"{entry.name} {task.name} ended with {done.returncode}:\n{done.stderr}")
    return json.loads(done.stdout.strip().splitlines()[-1])


def written(out):
    """The file that an entry wrote: OUT, or OUT with the suffix .npy."""
    return next(path for path in (out, out.with_suffix(".npy")) if path.exists())


def points_of(entry, task, folder, options, read, measured):
    """A result with a point for each number of samples, from renders with two seeds. Other measures are those of the last number."""
    points = []
    for samples in options.samples or SAMPLES[task.kind]:
        outs = [folder / f"{samples}-{seed}.{'exr' if task.kind == 'image' else 'csv'}" for seed in options.seeds]
        took = [run(entry, task, samples, seed, out, options.core) for seed, out in zip(options.seeds, outs)]
        found = measured([read(written(out)) for out in outs])
        points.append({"samples": samples, "cpu_s": min(t["cpu_s"] for t in took), "rms": found.pop("rms"),
                       "core": "shared" if options.core is None else "reserved"})
    return {"points": points, "setup_s": min(t["setup_s"] for t in took), **found}, took[0]["versions"]


def image_result(entry, task, folder, options):
    from .truth import make as truth  # needs frond
    halves, leaf = truth.halves(task)
    return points_of(entry, task, folder, options, truth.colors, lambda images: measures.of_images(images, halves, leaf))


def canopy_result(entry, task, folder, options):
    from .truth import make as truth
    read = lambda path: numpy.loadtxt(path, delimiter=",", skiprows=1)
    halves = [read(path) for path in truth.files(task)]
    return points_of(entry, task, folder, options, read, lambda tables: measures.of_brf(tables, halves, task.wavelengths_nm, len(task.view_zenith)))


def leaf_result(entry, task, folder, options):
    from .truth import make as truth
    out, [true] = folder / "table.csv", truth.files(task)
    took = run(entry, task, SAMPLES["leaf"][0], options.seeds[0], out, options.core)
    rows = measures.read_table(out)
    return {"cpu_s": took["cpu_s"], "errors": measures.of_table(rows, measures.read_table(true)),
            "checks": checks.check(rows, task.leaf)}, took["versions"]


RESULTS = {"image": image_result, "leaf": leaf_result, "canopy": canopy_result}


def measure(entry, of, options):
    """Runs an entry on tasks, and keeps each task's result, or the reason why there is none."""
    for task in of:
        versions = {}
        with tempfile.TemporaryDirectory(prefix="leaf_benchmark.", dir=os.environ.get("TMPDIR")) as temporary:
            try:
                result, versions = RESULTS[task.kind](entry, task, pathlib.Path(temporary), options)
            except Cannot as reason:
                result = {"cannot": str(reason)}
            except FileNotFoundError as reason:
                print(f"{entry.name} left out: {reason}", flush=True)
                return
        print(entry.name, task.name, brief(result), flush=True)
        keep(options.out or HERE / "results", entry.name, task.name, result, versions, options.again)


def brief(result):
    if "cannot" in result:
        return f"cannot: {result['cannot']}"
    if "points" in result:
        last, bias = result["points"][-1], result["bias"]["all"]
        return f"RMS {last['rms']:.5f} at {last['samples']} samples, {last['cpu_s']:.2f} s; bias {bias[0]:.5f} ({bias[1]:.5f} to {bias[2]:.5f})"
    failed = [f"{c['check']} ({c['words']}): {c['value']:.4f}, limit {c['limit']:.4f}" for c in result.get("checks", []) if not c["passed"]]
    return f"{result.get('errors', '')}; " + ("checks passed" if not failed else "failed: " + "; ".join(failed))


def keep(folder, name, task, result, versions, again):
    """Merges a result into those of record."""
    path = folder / f"{name}.json"
    known = json.loads(path.read_text(encoding="utf-8")) if path.exists() else {"entry": name, "versions": {}, "tasks": {}}
    known["versions"] |= versions
    before = known["tasks"].setdefault(task, {})
    if again and "points" in result:
        before["again"] = {"points": result["points"], "bias": result["bias"]["all"]}
    elif not again:
        known["tasks"][task] = merged(before, result | {"machine": machine(), "date": datetime.date.today().isoformat(), "load": max(os.getloadavg())})
    folder.mkdir(parents=True, exist_ok=True)
    path.write_text(json.dumps(rounded(known), indent=1) + "\n", encoding="utf-8")


def merged(before, result):
    """A result with the points and the second run of an earlier one; measures are those of the render with the most samples."""
    if not (before.get("points") and result.get("points")):
        return result
    points = {point["samples"]: point for point in [*before["points"], *result["points"]]}
    last = max((before, result), key=lambda r: (r["points"][-1]["samples"], r is result))
    again = {"again": before["again"]} if "again" in before else {}
    return last | {"points": [points[n] for n in sorted(points)]} | again


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
    parser.add_argument("--samples", type=lambda text: [int(n) for n in text.split(",")])
    parser.add_argument("--core", type=int)
    parser.add_argument("--again", action="store_true")
    parser.add_argument("--out", type=pathlib.Path)
    parser.add_argument("--page", action="store_true")
    options = parser.parse_args()
    options.seeds = (3, 4) if options.again else (1, 2)
    of = [task for name, task in tasks().items() if name in (options.task or TASKS)]
    if not options.page:
        chosen = [path if path.is_dir() else HERE / "entries" / path for path in map(pathlib.Path, options.entry)] if options.entry else entries()
        for entry in chosen:
            measure(entry.resolve(), of, options)
    if not options.out:
        from . import page
        page.write_all()


if __name__ == "__main__":
    main()
