"""scripts/race"""

import argparse
import dataclasses
import json
import os
import pathlib
import platform
import statistics
import tempfile

from tools import ROOT, machine

from . import page, pictures, programs, scenes

DOCUMENT = ROOT / "docs" / "race.md"
FIGURES = ROOT / "build" / "race" / "figures.json"


@dataclasses.dataclass
class Setting:
    size: int = 512
    samples: int = 64  # a power of four: Mitsuba's ldsampler takes no other number
    rounds: int = 5
    threads: int = 1
    filters: tuple = ("box", "gaussian")
    leaves: tuple = tuple(scenes.LEAVES)


QUICK = Setting(size=256, samples=16, rounds=2)


def arguments():
    """What they do: scripts/race."""
    parser = argparse.ArgumentParser(prog="scripts/race")
    parser.add_argument("--only", action="append", choices=list(scenes.SCENES), metavar="SCENE")
    parser.add_argument("--programs", metavar="WORD", action="append")
    parser.add_argument("--leaves", choices=list(scenes.LEAVES))
    parser.add_argument("--filters", choices=["box", "gaussian"])
    for number in ("--rounds", "--samples", "--size", "--threads"):
        parser.add_argument(number, type=int, metavar="N")
    parser.add_argument("--pbrt", metavar="PATH")
    parser.add_argument("--mitsuba", metavar="PYTHON")
    for switch in ("--quick", "--no-docs"):
        parser.add_argument(switch, action="store_true")
    return parser.parse_args()


def setting_of(options):
    chosen = {name: getattr(options, name) for name in ("rounds", "samples", "size", "threads")}
    chosen |= {name: (value,) if value else None for name in ("leaves", "filters") for value in [getattr(options, name)]}
    setting = dataclasses.replace(QUICK if options.quick else Setting(), **{k: v for k, v in chosen.items() if v})
    if setting.rounds < 2 or setting.samples not in [4**n for n in range(1, 9)]:
        raise SystemExit("two rounds at least, and samples that are a power of four: 4, 16, 64, 256")
    return setting


def race(name, leaf, running, setting, folder):
    """One kind of picture by all programs in turn: for each filter and program a dictionary of figures."""
    results = []
    for reconstruction in setting.filters:
        costs, images, base = {}, {}, {}
        for program in running:
            base[program.name] = program.render(reconstruction, 1, 0, folder / f"base{program.suffix}")
            costs[program.name], images[program.name] = [], []
        for index in range(setting.rounds):
            for program in running if index % 2 == 0 else reversed(running):
                out = folder / f"picture{program.suffix}"
                costs[program.name].append(program.render(reconstruction, setting.samples, index + 1, out))
                images[program.name].append(pictures.read(out))
        measured = {program.name: pictures.measure(images[program.name]) for program in running}
        for program in running:
            first = next(p for p in running if p.spectral == program.spectral)
            results.append(figures(program, reconstruction, base[program.name], costs[program.name],
                                   measured[program.name], measured[first.name], setting)
                           | {"scene": name, "leaf": leaf, "filter": reconstruction, "reference": first.name})
            print(name, leaf, reconstruction, page.short(results[-1]), flush=True)
    return results


def figures(program, reconstruction, base, costs, own, reference, setting):
    paths = setting.size**2 * (setting.samples - 1)
    cpu = [(cost.cpu - base.cpu) / paths * 1e6 for cost in costs]
    wall = [(cost.wall - base.wall) / paths * 1e6 for cost in costs]
    before, path = program.before(reconstruction), setting.size**2 / 1e6
    beside = pictures.difference(own, reference)
    return {"program": program.name, "cpu": cpu, "wall": wall,
            "set_up_cpu": before.cpu + base.cpu - statistics.median(cpu) * path,
            "set_up_wall": before.wall + base.wall - statistics.median(wall) * path,
            "mean": own.mean, "mean_error": own.mean_error,
            "variance": own.relative_variance, "variance_error": own.variance_error / own.mean**2,
            "difference": beside.mean, "difference_error": beside.error, "blocks": beside.blocks}


def main():
    options = arguments()
    setting = setting_of(options)
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
        raced[name] = {"what": scenes.SCENES[name].__doc__, "load": load, "setting": dataclasses.asdict(setting),
                       "results": results}
        if not options.no_docs:
            keep(raced)
    about = {"machine": machine(), "system": f"{platform.system()} {platform.machine()}", "missing": missing,
             "versions": sorted({program.version() for program in running})}
    if options.no_docs:
        print(page.page(about, raced))
    else:
        DOCUMENT.write_text(page.page(about, kept()), encoding="utf-8")
        print(f"Written: {DOCUMENT}")


def kept():
    """Figures of scenes that this machine has raced, in their order."""
    if not FIGURES.exists():
        return {}
    figures = json.loads(FIGURES.read_text(encoding="utf-8"))
    of_here = figures["scenes"] if figures.get("machine") == machine() else {}
    return {name: of_here[name] for name in scenes.SCENES if name in of_here}


def keep(raced):
    """So that a scene can be raced by itself, and a race that is stopped has not been for nothing."""
    figures = {"machine": machine(), "scenes": kept() | raced}
    FIGURES.parent.mkdir(parents=True, exist_ok=True)
    FIGURES.write_text(json.dumps(figures, indent=1), encoding="utf-8")


if __name__ == "__main__":
    main()
