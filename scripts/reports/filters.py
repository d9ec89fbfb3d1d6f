"""docs/filters.md: error against time of samples that pixels share and of samples of their own, at equal blur."""

import itertools
import pathlib
import re
import tempfile

import numpy
import pandas

import charts
import frond
from tools import ROOT, arguments, machine, table, write

SCENES = ["hundred-leaves", "soybean-front", "soybean-back", "soybean-ambient"]
SAMPLES = [4, 16, 64]
SEEDS = (1, 2)
# The Gaussian of sigma 0.5 that ends at 1.5 pixels has a standard deviation of 0.479; so has a box of this radius.
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
    """A row for each filter. Filters take turns, so that whatever else the machine does falls on all of them."""
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
                     # The median of one squared difference is 0.455 of its mean, were it normal.
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


PAGE = """# Filters

Written by `scripts/filters`. {machine}

A `PixelFilter` that is wider than a pixel can be had in two ways. **Importance sampling**, as in pbrt-v4: a pixel draws its
samples from its filter, and no other pixel has them. **Splatting**, as in Mitsuba: samples lie evenly in their pixels, and each
counts in all pixels that the filter reaches, by its weight; a pixel is sum(w L) / sum(w). Both give the same image with the same
blur, and splatting uses each sample several times: with the Gaussian, pbrt-v4's default and ours, a pixel has the noise of three
times the samples, for up to a tenth more time (`sinc`, whose samples reach 81 pixels, a third). That is what frond does unless a scene or a command says
otherwise:

```
PixelFilter "gaussian" "string reconstruction" "importance"
frond render scene.pbrt --filter gaussian,reconstruction=importance -o leaf.exr
frond render scene.pbrt --filter box -o leaf.exr
```

`auto`, the default, is splatting where that makes less noise, were all samples of an image alike: for `gaussian`, `mitchell`,
`triangle` and `sinc` with their usual parameters and for a `box` wider than a pixel; not for a box of one pixel, which is the
same in both ways, nor for a filter much narrower than its radius, or with one above 8.5 pixels.

![Error against CPU time of filters of one blur](images/filters.svg)

{size}, leaf_solved, wavelengths smpte, two renders of each, in turn. The boxes beside that of one pixel have
a radius of 0.830, which blurs as much as the Gaussian (a standard deviation of 0.479 pixels). **RMS**: noise over pixels and
linear colours. **Relative**: the same of noise over the pixel's own mean, where that is above a thousandth of the image's, and
its **median** over pixels and colours. **Efficiency**: 1 / (variance × CPU time), over that of importance samples from the same
filter, and over that of the box of one pixel, which blurs less; by relative errors too.

{table}
## What to know

- **Pixels share noise.** That of a pixel and its neighbours hangs together: it looks softer, and whoever sums pixels up as
  independent takes a variance that is too small, with the Gaussian by a factor of {correlated:.2f} at most. The EXR says so,
  `frond:correlated_pixels`; `frond difference` reads it, and `--max-rms` knows it. `frond compare`, whose intervals are those of
  independent pixels, importance-samples always, and so does the pilot that chooses a leaf's model; so its errors and costs are those of such
  renders, and of all its candidates alike. Radiometers (`frond brf`) have pixels that are apart, and a box.
- **`variance.R`** and the others follow from how the samples of a pixel and of its neighbours differ, and are as much an upper bound
  with low-discrepancy samples as they are without splatting.
- **Channels** of what camera rays meet first, `leaf` and `samples` are of the pixel's own samples: those of a box. Edges are
  sharper in them than in the colours.
- **Crops** have the pixels of the whole image, to the bit: samples of the pixels around that reach them are taken too. `frond
  render --part` leaves those to the other parts.
- **Weights** may be negative (`mitchell`, `sinc`). A pixel's sum of weights is near its mean when its neighbours have samples; where
  it falls below a quarter of that, in images of one sample a pixel, the mean stands in for it.
- **Memory**: the film takes 128 bytes a pixel, and for shared samples 64 more for each pixel that a tile's samples reach: 209 bytes
  a pixel with the Gaussian, 228 with `mitchell` and `triangle`, 272 with `sinc`.
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
    head = ["scene", "samples", "filter", "µs a path", "RMS · 10³", "relative", "median", "efficiency over importance",
            "by relative errors", "over the box", "by relative errors"]
    write(options.docs / "filters.md", PAGE.format(machine=machine(), size="`--quick`, 256 × 256 pixels", table=table(head, body),
                                                   correlated=correlated))


if __name__ == "__main__":
    main()
