"""Other renderers: time, noise and efficiency of frond, Mitsuba 3 and pbrt-v4 (section "race" of docs/performance.md)

Renders the same scenes with each program in turn. Mitsuba is installed into build/python-venv by pip; pbrt-v4 is the pbrt on the
PATH or of --pbrt PATH. Missing programs are named and left out. Takes some hours on one core; figures of scenes that are not
rendered again are kept.
  --quick                      small images, two rounds, scenes front and ambient; prints the section, writes no page
  --only SCENE                 only this scene; repeatable: front, ambient, soybean-front, soybean-back, soybean-ambient, canopy
  --programs WORD              frond and the programs whose names contain WORD; repeatable
  --leaves KIND                only opaque or leaf
  --filters FILTER             only box or gaussian
  --rounds N                   renders of each kind, each with its own seed; default: 5
  --samples N                  per pixel, a power of four; default: 64
  --size N                     pixels along each side; default: 512
  --threads N                  of every program; default: 1
  --pbrt PATH                  the pbrt program
  --mitsuba PYTHON             a Python with mitsuba
  --no-docs                    prints the section, writes no page
  --convergence                instead: error against time of hair, subsurface and Film "spectral", frond and pbrt-v4, and a chart; 10 minutes
"""

import argparse
import json
import os
import pathlib
import platform
import shutil
import tempfile

import numpy

from ..shared.tools import ROOT, machine, write_section
from . import convergence, luminance, page, programs, scenes

DOCUMENT = ROOT / "docs" / "performance.md"
FIGURES = ROOT / "build" / "race" / "figures.json"

FULL = {"size": 512, "samples": 64, "rounds": 5, "threads": 1, "filters": ["box", "gaussian"], "leaves": list(scenes.LEAVES)}
QUICK = {"size": 256, "samples": 16, "rounds": 2}


def arguments():
    """The options; measurements/run race describes them."""
    parser = argparse.ArgumentParser(prog="measurements/run race")
    parser.add_argument("--only", action="append", choices=list(scenes.SCENES), metavar="SCENE")
    parser.add_argument("--programs", metavar="WORD", action="append")
    for name in ("filters", "leaves"):
        parser.add_argument(f"--{name}", nargs=1, choices=FULL[name])
    for name in ("size", "samples", "rounds", "threads"):
        parser.add_argument(f"--{name}", type=int, metavar="N")
    parser.add_argument("--pbrt", metavar="PATH")
    parser.add_argument("--mitsuba", metavar="PYTHON")
    for name in ("--quick", "--no-docs", "--convergence"):
        parser.add_argument(name, action="store_true")
    options = parser.parse_args()
    options.no_docs |= options.quick  # few samples are no figures for the page
    for name, value in (FULL | (QUICK if options.quick else {})).items():
        setattr(options, name, getattr(options, name) or value)
    if options.rounds < 2 or options.samples not in [4**n for n in range(1, 9)]:  # which every program's sampler spreads evenly
        raise SystemExit("--rounds is at least 2, --samples a power of four: 4, 16, 64, 256 ...")
    return options


def race(name, leaf, running, setting, folder):
    """Renders one scene and kind of leaf with all programs in turn; a dictionary of figures for each filter and program."""
    results = []
    for reconstruction in setting.filters:
        costs, images, base = {}, {}, {}
        for program in running:
            base[program.name] = program.render(reconstruction, 1, 0, folder / f"base{program.suffix}")
            costs[program.name], images[program.name] = [], []
        for index in range(setting.rounds):
            for program in running if index % 2 == 0 else reversed(running):
                out = folder / f"image{program.suffix}"
                costs[program.name].append(program.render(reconstruction, setting.samples, index + 1, out))
                images[program.name].append(luminance.read(out))
        measured = {program.name: luminance.measure(images[program.name]) for program in running}
        for program in running:
            first = next(p for p in running if p.spectral == program.spectral)
            results.append(figures(program, reconstruction, base[program.name], costs[program.name],
                                   measured[program.name], measured[first.name], setting)
                           | {"scene": name, "leaf": leaf, "filter": reconstruction, "reference": first.name})
            print(name, leaf, reconstruction, page.short(results[-1]), flush=True)
    return results


def figures(program, reconstruction, base, costs, own, reference, setting):
    pixels = setting.size**2
    us = (numpy.array(costs) - base) / (pixels * (setting.samples - 1)) * 1e6  # per path, by round: CPU, wall
    cpu, wall = program.before(reconstruction) + base - numpy.median(us, axis=0) * pixels / 1e6
    beside = luminance.difference(own, reference)
    return {"program": program.name, "cpu": us[:, 0].tolist(), "wall": us[:, 1].tolist(), "set_up_cpu": cpu, "set_up_wall": wall,
            "mean": own.mean, "mean_error": own.mean_error,
            "variance": own.relative_variance, "variance_error": own.variance_error / own.mean**2,
            "difference": beside.mean, "difference_error": beside.error, "blocks": beside.blocks}


def main():
    setting = options = arguments()
    if options.convergence:
        text = convergence.main(options.pbrt or shutil.which("pbrt"), FIGURES.parent)
        return write_section(DOCUMENT, "race_convergence", text, "race")
    running, missing = programs.present(options.pbrt, options.mitsuba)
    for text in missing:
        print(f"Left out: {text}", flush=True)
    if options.programs:
        running = [p for p in running if p.name.startswith("frond") or any(word in p.name for word in options.programs)]
    names = options.only or (["front", "ambient"] if options.quick else list(scenes.SCENES))
    raced = {}
    for name in names:
        load, results = os.getloadavg()[0], []
        with tempfile.TemporaryDirectory(prefix="frond_race.", dir=os.environ.get("TMPDIR")) as temporary:
            folder = pathlib.Path(temporary)
            scene = scenes.SCENES[name](folder)
            for leaf in setting.leaves:
                able = [p for p in running if p.can(scene, leaf)]
                for program in able:
                    program.open(scene, leaf, setting, folder)
                results += race(name, leaf, able, setting, folder)
                for program in able:
                    program.close()
                load = max(load, os.getloadavg()[0])
        raced[name] = {"what": scenes.SCENES[name].__doc__, "load": load, "setting": {key: getattr(setting, key) for key in FULL},
                       "results": results}
        if not options.no_docs:
            keep(raced)
    about = {"machine": machine(), "system": f"{platform.system()} {platform.machine()}", "missing": missing,
             "versions": sorted({program.version() for program in running})}
    if options.no_docs:
        print(page.section(about, raced))
    else:
        write_section(DOCUMENT, "race", page.section(about, kept()))
        write_section(DOCUMENT, "race_summary", page.overview(kept()), "race")


def kept():
    """Figures of the scenes that were measured on this machine, in the order of SCENES."""
    if not FIGURES.exists():
        return {}
    figures = json.loads(FIGURES.read_text(encoding="utf-8"))
    of_here = figures["scenes"] if figures.get("machine") == machine() else {}
    return {name: of_here[name] for name in scenes.SCENES if name in of_here}


def keep(raced):
    """Stores the figures, so that a scene can be measured alone and an interrupted run keeps its finished scenes."""
    figures = {"machine": machine(), "scenes": kept() | raced}
    FIGURES.parent.mkdir(parents=True, exist_ok=True)
    FIGURES.write_text(json.dumps(figures, indent=1), encoding="utf-8")


if __name__ == "__main__":
    main()
