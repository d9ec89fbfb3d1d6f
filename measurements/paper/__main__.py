"""Experiments of Baranoski and Rokne's paper, with their figures and frond's (docs/results/paper.md)

  --quick          few samples, into build/paper
  --smoke FOLDER   very few samples, into a folder: tests that the measurement runs
  --continue       resumes an interrupted run
  --threads N      number of threads; default: all
"""

import argparse
import pathlib
import re
import shlex

import numpy

from ..shared.tools import ROOT, machine, rms, table, write
from .convergence import convergence, curves_of
from .runs import FULL, MODELS, QUICK, SETS, SMOKE, Runs
from .table2 import differences, goals, table_2


def rendered(runs, images, measured):
    runs.sheet(images / "figures-5-7.jpg")
    report = measured["front"]["images"]["abm"][0]
    samples, pixels = 2 * report["samples_per_pixel"], report["paths"] // report["samples_per_pixel"]
    body = []
    for s in SETS:
        seconds = {m: sum(r["cpu_seconds"] for r in measured[s.name]["images"][m]) for m in MODELS}
        foliar = measured[s.name]["images"]["abm"][0]["foliar_ratio"]
        body.append((s.order, s.title, f"{s.foliar_percent:.2f} %", f"{100 * foliar:.2f} %",
                     *(f"{seconds[m]:.0f} s" for m in MODELS)))
    return f"""
## Figures 5 to 7: the images

![Three sets of images, each with both models](images/paper/figures-5-7.jpg)

{samples} samples per pixel, {pixels:,} pixels; the ABM at the left, the simplified model at the right. The plants, the light and
the view are frond's, because the paper does not describe its own. They match what the paper states: a soybean leaf, the side that
is lit, ambient light alone in the third set, and the foliar ratio. The images are shown with an exposure of
{', '.join(str(s.stops) for s in SETS)} stops.

{table(("set", "light", "foliar ratio, paper", "frond", "CPU, `abm`", "CPU, `leaf_simplified`"), body)}
The paper gives one time: 95 minutes of CPU on an SGI R10000 for its Figure 7b. It does not state the number of pixels.
"""


def leaf_table(runs, tables):
    solved, sampled = tables["solve"], tables["montecarlo"]
    apart = abs(numpy.subtract(solved["shares"], sampled["shares"]))
    return f"""
## The table of reflectances and transmittances

The paper samples the leaf table with 10⁶ rays at each degree from 0° to 180° at three wavelengths; it has 14.5 kB. Here, sampling
with {runs.setting.table_rays:,} rays takes {sampled['cpu_seconds']:.2g} s of CPU time, and solving, as for this page,
{solved['cpu_seconds']:.2g} s. The two tables differ by {rms(apart):.1e} (RMS of Rs, Rd and T; at most {apart.max():.1e}), which is
the noise of sampling. A render holds 12.4 kB of it: 258 angles of 48 bytes, uniform in the square root of the cosine.
[Validation](validation.md#the-table-solved-against-sampled) has the errors of sampling and solving, [file
formats](../file_formats.md) those of coarser steps.
"""


ELSEWHERE = """
## Other experiments

| in the paper | here |
|---|---|
| Figures 1 and 4: BDF curves at 30° and 45° | [validation](validation.md#figures-1-and-4-of-the-paper-the-bdf-in-the-plane-of-incidence) |
| Figure 2: absorption of chlorophyll | data of the authors' later publications, and the spectra that follow: [validation](validation.md#spectra-400-to-2500-nm) |
| Table 1: chromaticities and dominant wavelengths | [conventions](../conventions.md), also for the error of 455 nm |
| future work: Meyer's choice of wavelengths | [conventions](../conventions.md) |
"""


def page(runs, images, measured, tables, command):
    commands = "\n".join(shlex.join(["frond", *map(str, runs.comparison_words(part, SETS[0]))]).replace(f"{ROOT}/", "")
                         for part in ("comparison", "manner"))
    used = sum(m["comparison"]["cpu_seconds"] + m["manner"]["cpu_seconds"] +
               sum(r["cpu_seconds"] for halves in m["images"].values() for r in halves) for m in measured.values())
    return f"""# The paper's experiments

For readers who compare frond with the publication of its leaf models: G. V. G. Baranoski and J. G. Rokne, "A Simplified Model for
Light Interaction with Plant Tissue". The page repeats the paper's experiments and gives its figures and frond's.

```sh
measurements/run paper --quick
```

With `--quick` it takes few samples and writes into `build/paper`. Without this option it writes this page; `--continue`
resumes an interrupted run.

"The ABM" is `abm`, the random walk, analog as published. "The simplified model" is `leaf_simplified` with a solved table. A
value of 1 is a white diffuse surface in the light.

Written by `{command}` in {used / 60:.0f} minutes of CPU time: {machine()}.
{goals(measured)}
{rendered(runs, images, measured)}
{convergence(runs, images, measured)}
{table_2(runs, measured)}
{leaf_table(runs, tables)}
{differences(measured)}
{ELSEWHERE}
The comparisons were made with these commands:

```
{commands}
```

The other scenes use the same commands with their own `--target`.
"""


def measure(runs):
    """{set: its measurements}, one experiment after the other."""
    measured = {s.name: {part: runs.compared(part, s) for part in ("comparison", "manner")} for s in SETS}
    for s in SETS:
        measured[s.name]["ends"] = curves_of(runs, s, measured[s.name]["manner"])
    for s in SETS:
        measured[s.name]["images"] = runs.images(s)
        measured[s.name]["difference"] = runs.difference(s)
    return measured


def main():
    parser = argparse.ArgumentParser(prog="measurements/run paper", description="The experiments of Baranoski and Rokne's paper.")
    parser.add_argument("--quick", action="store_true", help="few samples, into build/paper")
    parser.add_argument("--smoke", metavar="FOLDER", help="very few samples, into a folder: tests that the measurement runs")
    parser.add_argument("--continue", dest="keep", action="store_true", help="keep the measurements of an earlier run")
    parser.add_argument("--threads", type=int, help="number of threads; default: all")
    options = parser.parse_args()
    setting = SMOKE if options.smoke else QUICK if options.quick else FULL
    scratch = pathlib.Path(options.smoke) if options.smoke else ROOT / "build" / "paper" / ("quick" if options.quick else "full")
    docs = ROOT / "docs" / "results" if setting is FULL else scratch
    runs = Runs(setting, scratch, options.threads, options.keep)
    measured = measure(runs)
    tables = {method: runs.table(method) for method in ("solve", "montecarlo")}
    command = "measurements/run paper" + (" --quick" if setting is not FULL else "") + (" --continue" if options.keep else "")
    text = page(runs, docs / "images" / "paper", measured, tables, command)
    write(docs / "paper.md", re.sub(r"\n{3,}", "\n\n", text))


if __name__ == "__main__":
    main()
