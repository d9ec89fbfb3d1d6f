"""docs/filters.md: error against time of samples that pixels share and of samples of their own, at equal blur."""

import json
import math
import pathlib
import statistics
import tempfile

import exr
from tools import COLORS, ROOT, block, frond, gnuplot, machine, table

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
    "box of one pixel": (COLORS[0], 1, 4),
    "box, importance": (COLORS[5], 2, 6),
    "box, splatting": (COLORS[5], 1, 7),
    "Gaussian, importance": (COLORS[1], 2, 8),
    "Gaussian, splatting": (COLORS[1], 1, 9),
}


def colors_of(path):
    """R, G, B of all pixels."""
    return [value for row in exr.read(path.read_bytes()) for name in "RGB" for value in row[name]]


class Measured:
    """Renders with seeds of their own: by how they differ their noise, and what one of them costs."""

    def __init__(self):
        self.images, self.cpu, self.paths = [], 0.0, 0

    def add(self, run, image):
        self.cpu += run["cpu_seconds"] / len(SEEDS)
        self.paths = run["paths"]
        self.images.append(colors_of(image))

    def finish(self):
        a, b = self.images
        half_squares = [(x - y) ** 2 / 2 for x, y in zip(a, b)]
        means = [(x + y) / 2 for x, y in zip(a, b)]
        self.rms = math.sqrt(statistics.fmean(half_squares))
        lit = 1e-3 * statistics.fmean(means)
        relative = [s / m**2 for s, m in zip(half_squares, means) if m > lit]
        self.relative = math.sqrt(statistics.fmean(relative))
        # The median of one squared difference is 0.455 of its mean, were it normal.
        self.median = math.sqrt(statistics.median(relative) / 0.455)
        self.images = []
        return self

    def efficiency(self):
        return 1 / (self.rms**2 * self.cpu)

    def relative_efficiency(self):
        return 1 / (self.relative**2 * self.cpu)


def measure(scene, samples, folder):
    """By name of the filter. Filters take turns, so that whatever else the machine does falls on all of them."""
    found = {name: Measured() for name in FILTERS}
    for turn, seed in enumerate(SEEDS):
        for name in list(FILTERS) if turn % 2 == 0 else reversed(list(FILTERS)):
            image = folder / "picture.exr"
            run = json.loads(frond("render", ROOT / "scenes" / scene / "scene.pbrt", "-o", image, "--seed", seed, "--quick",
                                   "--spp", samples, "--wavelengths", "smpte", "--swap", "*=leaf_solved", "--filter",
                                   FILTERS[name], "--json", "-q"))
            found[name].add(run, image)
    return {name: m.finish() for name, m in found.items()}


def draw(results):
    script = ("set multiplot layout 2,2\nset logscale xy\nset xlabel 'CPU time, s'\nset ylabel 'RMS noise'\n"
              "set format xy '%g'\nset key top right font ',11'\n")
    tics = ", ".join(f"{digit}e{power}" for power in range(-5, 3) for digit in (1, 2, 5))
    script += f"set xtics ({tics})\nset ytics ({tics})\n"
    for scene, by_samples in results.items():
        plots = []
        measured = [m for found in by_samples.values() for m in found.values()]
        for axis, values in (("x", [m.cpu for m in measured]), ("y", [m.rms for m in measured])):
            script += f"set {axis}range [{min(values) / 1.3}:{max(values) * 1.6}]\n"
        for i, name in enumerate(FILTERS):
            color, dash, point = LINES[name]
            script += block(f"line{i}", [(found[name].cpu, found[name].rms) for found in by_samples.values()])
            plots.append(f"$line{i} with linespoints pt {point} ps 0.8 lw 2 dt {dash} lc rgb '{color}' title '{name}'")
        script += f"set title '{scene}'\nplot {', '.join(plots)}\nunset key\n"
    gnuplot(ROOT / "docs/images/filters.svg", script + "unset multiplot\n", (1000, 860))


PAGE = """# Filters

Written by `scripts/filters`. {machine}

A `PixelFilter` that is wider than a pixel can be had in two ways. **Importance sampling**, as in pbrt-v4: a pixel draws its
samples from its filter, and no other pixel has them. **Splatting**, as in Mitsuba: samples lie evenly in their pixels, and each
counts in all pixels that the filter reaches, by its weight; a pixel is sum(w L) / sum(w). Both give the same picture with the same
blur, and splatting uses each sample several times: with the Gaussian, pbrt-v4's default and ours, a pixel has the noise of three
times the samples, for up to a tenth more time (`sinc`, whose samples reach 81 pixels, a third). That is what frond does unless a scene or a command says
otherwise:

```
PixelFilter "gaussian" "string reconstruction" "importance"
frond render scene.pbrt --filter gaussian,reconstruction=importance -o leaf.exr
frond render scene.pbrt --filter box -o leaf.exr
```

`auto`, the default, is splatting where that makes less noise, were all samples of a picture alike: for `gaussian`, `mitchell`,
`triangle` and `sinc` with their usual parameters and for a `box` wider than a pixel; not for a box of one pixel, which is the
same in both ways, nor for a filter much narrower than its radius, or with one above 8.5 pixels.

![Error against CPU time of filters of one blur](images/filters.svg)

{size}, leaf_solved, wavelengths smpte, two renders of each, in turn. The boxes beside that of one pixel have
a radius of 0.830, which blurs as much as the Gaussian (a standard deviation of 0.479 pixels). **RMS**: noise over pixels and
linear colours. **Relative**: the same of noise over the pixel's own mean, where that is above a thousandth of the picture's, and
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
- **Crops** have the pixels of the whole picture, to the bit: samples of the pixels around that reach them are taken too. `frond
  render --part` leaves those to the other parts.
- **Weights** may be negative (`mitchell`, `sinc`). A pixel's sum of weights is near its mean when its neighbours have samples; where
  it falls below a quarter of that, in pictures of one sample a pixel, the mean stands in for it.
- **Memory**: the film takes 128 bytes a pixel, and for shared samples 64 more for each pixel that a tile's samples reach: 209 bytes
  a pixel with the Gaussian, 228 with `mitchell` and `triangle`, 272 with `sinc`.
"""


def main():
    results, correlated = {}, 0
    with tempfile.TemporaryDirectory(prefix="frond_filters.") as name:
        folder = pathlib.Path(name)
        for scene in SCENES:
            results[scene] = {samples: measure(scene, samples, folder) for samples in SAMPLES}
            print(scene, {s: {n: m.rms for n, m in found.items()} for s, found in results[scene].items()}, flush=True)
        frond("render", ROOT / "scenes/furnace/scene.pbrt", "--filter", "gaussian", "--spp", 1, "--quick", "-q", "--part",
              folder / "x.part")
        head = (folder / "x.part").read_bytes().partition(b'"correlated_pixels":')[2]
        correlated = float(head.split(b"\n")[0].strip(b" ,}"))
    draw(results)
    body = []
    for scene, by_samples in results.items():
        for samples, found in by_samples.items():
            if samples < 16:
                continue
            box = found["box of one pixel"]
            for filter_name, m in found.items():
                base = found.get(IMPORTANCE.get(filter_name))
                over = lambda other: "" if other is None else f"{m.efficiency() / other.efficiency():.2f}"
                relative = lambda other: ("" if other is None else
                                          f"{m.relative_efficiency() / other.relative_efficiency():.2f}")
                body.append([scene, samples, filter_name, f"{1e6 * m.cpu / m.paths:.2f}", f"{1e3 * m.rms:.3f}",
                             f"{100 * m.relative:.1f} %", f"{100 * m.median:.2f} %", over(base), relative(base),
                             over(box), relative(box)])
    head = ["scene", "samples", "filter", "µs a path", "RMS · 10³", "relative", "median", "efficiency over importance",
            "by relative errors", "over the box", "by relative errors"]
    page = PAGE.format(machine=machine(), size="`--quick`, 256 × 256 pixels",
                       table=table(head, body), correlated=correlated)
    (ROOT / "docs/filters.md").write_text(page)


if __name__ == "__main__":
    main()
