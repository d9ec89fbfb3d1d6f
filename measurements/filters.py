"""Pixel filters: noise against CPU time (section "filters" of docs/rendering.md)

Renders four scenes with filters of equal blur, by splatting and by importance sampling in alternating order. Takes some ten
minutes on two cores.
  --quick   few samples, into build/filters_report
"""

import itertools
import pathlib
import re
import tempfile

import numpy
import pandas

import frond

from .shared import charts
from .shared.tools import ROOT, arguments, machine, table, write_section

SCENES = ["hundred-leaves", "soybean-front", "soybean-back", "soybean-ambient"]
SAMPLES = [4, 16, 64]
SEEDS = (1, 2)
# The Gaussian of sigma 0.5, cut at 1.5 pixels, has a standard deviation of 0.479 pixels; a box of this radius has the same.
BOX = "box,xradius=0.8297,yradius=0.8297"
FILTERS = {
    "box of one pixel": "box",
    "box, importance": f"{BOX},reconstruction=importance",
    "box, splatting": f"{BOX},reconstruction=splatting",
    "Gaussian, importance": "gaussian,reconstruction=importance",
    "Gaussian, splatting": "gaussian,reconstruction=splatting",
}
IMPORTANCE = {"box, splatting": "box, importance", "Gaussian, splatting": "Gaussian, importance"}
LINES = {
    "box of one pixel": (charts.COLORS[0], "-", "x"),
    "box, importance": (charts.COLORS[5], "--", "s"),
    "box, splatting": (charts.COLORS[5], "-", "s"),
    "Gaussian, importance": (charts.COLORS[1], "--", "o"),
    "Gaussian, splatting": (charts.COLORS[1], "-", "o"),
}


def measure(scene, samples):
    """A row for each filter. Filters alternate, so that other load on the machine disturbs all of them alike."""
    renders = {name: [] for name in FILTERS}
    for turn, seed in enumerate(SEEDS):
        for name in list(FILTERS)[::1 if turn % 2 == 0 else -1]:
            loaded = frond.load(ROOT / "scenes" / scene / "scene.pbrt", seed=seed, quick=True, wavelengths="smpte",
                                swap="leaf_solved", filter=FILTERS[name])
            renders[name].append(loaded.render(samples))
    rows = []
    for name, images in renders.items():
        a, b = (image.rgb.astype(float) for image in images)
        squares, means = (a - b) ** 2 / 2, (a + b) / 2
        lit = means > 1e-3 * means.mean()
        relative = squares[lit] / means[lit] ** 2
        rows.append({"scene": scene, "samples": samples, "filter": name, "rms": squares.mean() ** 0.5,
                     "relative": relative.mean() ** 0.5,
                     # The median of a squared normal variable is 0.455 of its mean.
                     "median": (numpy.median(relative) / 0.455) ** 0.5,
                     "cpu": numpy.mean([image.statistics["cpu_seconds"] for image in images]),
                     "paths": images[0].statistics["paths"]})
    return pandas.DataFrame(rows)


def draw(path, results):
    of, panels = charts.figure(1000, 880, 2, 2)
    for panel, (scene, rows) in zip(panels.flat, results.groupby("scene", sort=False)):
        for name, (color, line, mark) in LINES.items():
            chosen = rows[rows["filter"] == name]
            panel.loglog(chosen.cpu, chosen.rms, line, marker=mark, color=color, label=name)
        panel.set(title=scene, xlabel="CPU time, s", ylabel="RMS noise")
    charts.legend(of, panels[0, 0], 3)
    charts.save(of, path)


SECTION = """## Pixel filters: measurements

![Noise against CPU time of pixel filters](images/filters.svg)

Measured on {machine}.
{size}, `leaf_solved`, wavelengths `smpte`, two renders of each setting, in alternating order.
`box` (splatting and importance) has a radius of 0.830 pixels, which blurs as much as the Gaussian (standard
deviation 0.479 pixels). The box of one pixel blurs less.

- **RMS**: noise over pixels and linear colours. **relative**: RMS of the noise divided by the pixel's own mean, over pixels whose
  mean is above a thousandth of the image's mean. **median**: median of this relative noise over pixels and colours.
- **efficiency**: 1 / (variance × CPU time), divided by the efficiency of importance sampling with the same filter, and by the
  efficiency of the box of one pixel. **by relative noise**: the same ratio with the variance of the relative noise.

{table}
**Correlated noise.** With splatting the noise of neighbouring pixels is correlated, and the image looks softer. The variance of a
sum over pixels is too small if the pixels are taken for independent: with the Gaussian by a factor of {correlated:.2f} at most.
"""


def main():
    options = arguments("filters")
    results = pandas.concat([measure(*key) for key in itertools.product(SCENES, SAMPLES[:2] if options.quick else SAMPLES)])
    print(results.to_string(index=False))
    with tempfile.TemporaryDirectory(prefix="frond_filters.") as name:
        part = pathlib.Path(name) / "x.part"
        frond.load(ROOT / "scenes/furnace/scene.pbrt", filter="gaussian", quick=True).render(1).save_part(part)
        correlated = float(re.search(rb'"correlated_pixels":\s*([\d.e+-]+)', part.read_bytes())[1])
    draw(options.docs / "images" / "filters.svg", results)
    results["efficiency"], results["by_relative"] = (1 / (results[kind] ** 2 * results.cpu) for kind in ("rms", "relative"))
    body = []
    for (scene, samples), rows in results[results.samples >= 16].groupby(["scene", "samples"], sort=False):
        found = rows.set_index("filter")
        for m in rows.itertuples():
            over = [f"{getattr(m, kind) / found[kind][other]:.2f}" if other else "" for other in
                    (IMPORTANCE.get(m.filter), "box of one pixel") for kind in ("efficiency", "by_relative")]
            body.append([scene, samples, m.filter, f"{1e6 * m.cpu / m.paths:.2f}", f"{1e3 * m.rms:.3f}",
                         f"{100 * m.relative:.1f} %", f"{100 * m.median:.2f} %", *over])
    head = ["scene", "samples", "filter", "µs per path", "RMS · 10³", "relative", "median", "efficiency over importance",
            "by relative noise", "efficiency over the box of one pixel", "by relative noise"]
    write_section(options.docs / "rendering.md", "filters",
                  SECTION.format(machine=machine(), size="`--quick`, 256 × 256 pixels", table=table(head, body),
                                 correlated=correlated))


if __name__ == "__main__":
    main()
