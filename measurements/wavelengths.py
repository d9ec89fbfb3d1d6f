"""Wavelength strategies: colour error against CPU time in the leaf scenes (section "wavelengths" of docs/conventions.md)

Writes a chart, too.
  --quick   few samples, into build/wavelengths_report
"""

import pathlib
import tempfile

import numpy

import frond

from .shared import charts
from .shared import color_difference
from .shared.tools import ROOT, arguments, machine, program, sized, table, write_section

SCENES = {"front": "front lit", "back": "back lit", "ambient": "ambient light"}
RESOLUTION = 128
REFERENCE = "bands,lambdamin=360,lambdamax=830,step=1"
STRATEGIES = {
    "smpte": ("linear SMPTE-C", 3),
    "smpte,blue=464.7": ("linear SMPTE-C", 3),
    "meyer": ("linear sRGB", 4),
    "meyer,white=D65": ("linear sRGB", 4),
    "hero": ("linear sRGB", 4),
}


class Render:
    """One render: XYZ of each pixel, a mask of the leaf pixels, and the CPU time in seconds."""

    def __init__(self, scene, wavelengths, space, samples, seed, folder):
        image = frond.load(scene, wavelengths=wavelengths, seed=seed, samples=samples).render()
        self.seconds, self.leaf = image.statistics["cpu_seconds"], image["leaf"] > 0.5
        if image.color_space:
            rgb = image.rgb
        else:  # bands: frond convert computes the colours
            image.save(folder / "render.exr")
            program("convert", folder / "render.exr", "-o", folder / "rgb.exr")
            names, pixels = frond.read_image(folder / "rgb.exr")
            rgb = pixels[:, :, [names.index(name) for name in "RGB"]]
        self.xyz = color_difference.xyz(rgb, space)


class Reference:
    """The reference: the mean of two renders with different seeds; their difference gives its noise."""

    def __init__(self, scene, samples, folder):
        halves = [Render(scene, REFERENCE, "linear sRGB", samples, seed, folder) for seed in (101, 102)]
        self.leaf = halves[0].leaf
        self.xyz = sum(half.xyz for half in halves) / 2
        self.noise = color_difference.delta_e(*(color_difference.lab(half.xyz[self.leaf]) for half in halves)).mean() / 2

    def errors(self, render):
        """Colour errors of a render: mean and 95 % quantile over the leaf pixels, and the error of their mean colour."""
        leaf = self.leaf
        each = color_difference.delta_e(color_difference.lab(render.xyz[leaf]), color_difference.lab(self.xyz[leaf]))
        of_mean = color_difference.delta_e(color_difference.lab(render.xyz[render.leaf].mean(axis=0)), color_difference.lab(self.xyz[leaf].mean(axis=0)))
        return {"seconds": render.seconds, "mean": each.mean(), "p95": numpy.quantile(each, 0.95), "leaf": of_mean}


def measure(name, ladder, reference_samples, folder):
    scene = sized(ROOT / f"scenes/soybean-{name}/scene.pbrt", folder, RESOLUTION)
    reference, curves = Reference(scene, reference_samples, folder), {}
    for strategy, (space, _) in STRATEGIES.items():
        frond.load(scene, wavelengths=strategy).render(1)  # fills the cache of leaf tables, which is not timed
        curves[strategy] = [reference.errors(Render(scene, strategy, space, samples, 1, folder)) for samples in ladder]
        print(name, strategy, curves[strategy][-1], flush=True)
    return reference, curves


def chart(path, results):
    """Mean error against time: a panel for each scene, with the strategies named in the first. `smpte,blue=464.7` is left out: its
    curve covers that of `smpte`."""
    of, panels = charts.figure(900, 340, 1, 3, sharex=True, sharey=True)
    hues = {s: hue for s, hue in zip(("smpte", "meyer", "meyer,white=D65", "hero"), charts.COLORS[1:])}
    for panel, (scene, (reference, curves)) in zip(panels[0], results.items()):
        for strategy, hue in hues.items():
            points = curves[strategy]
            panel.loglog([p["seconds"] for p in points], [p["mean"] for p in points], "o-", color=hue, markersize=4)
        panel.axhline(reference.noise, color="#888888", linestyle="--", linewidth=1)
        panel.set(title=f"soybean, {SCENES[scene]}", xlabel="CPU time (s)", ylim=(0.1, 10))
        charts.plain_ticks(panel.xaxis, [0.1, 1])
    charts.plain_ticks(panels[0, 0].yaxis, [0.1, 0.2, 0.3, 0.5, 1, 2, 3, 5, 10])
    panels[0, 0].set_ylabel("mean colour error of leaf pixels, ΔE₀₀")
    (_, of_front), *_, (of_last, _) = results.values()
    for strategy, hue in hues.items():
        point = of_front[strategy][-2]
        panels[0, 0].annotate(strategy, (point["seconds"], point["mean"]), (6, 4), textcoords="offset points",
                              ha="left" if strategy == "hero" else "center", color=hue)
    panels[0, 2].annotate("noise of the reference", (0.98, of_last.noise), (0, -13), xycoords=("axes fraction", "data"),
                          textcoords="offset points", ha="right", color="#666666")
    charts.save(of, path)


def page(results, ladder, reference_samples):
    body = []
    for scene, (reference, curves) in results.items():
        for strategy, points in curves.items():
            last = points[-1]
            body.append((SCENES[scene], f"`{strategy}`", STRATEGIES[strategy][1], f"{last['seconds']:.2f}",
                         f"{last['mean']:.2f}", f"{last['p95']:.2f}", f"{last['leaf']:.2f}"))
    noises = ", ".join(f"{reference.noise:.2f} ({SCENES[s]})" for s, (reference, _) in results.items())
    blue = max(abs(curves["smpte,blue=464.7"][-1]["leaf"] - curves["smpte"][-1]["leaf"]) for _, curves in results.values())
    return f"""## Colour error of the wavelength strategies

`measurements/run wavelengths` renders the three soybean scenes at {RESOLUTION} × {RESOLUTION} pixels with each wavelength strategy, at
{', '.join(map(str, ladder))} samples per pixel; the leaves keep the scenes' model, `leaf_simplified`. The reference has one band at
every nanometre from 360 to 830 nm (`{REFERENCE}`); it is the mean of two renders of
{reference_samples} samples per pixel. The colour error is CIEDE2000, averaged over the pixels of which more than half is leaf; the
white point of CIELAB is the colour of a white surface in the light. The error includes noise. The noise of the reference is about
{noises}. Time is the CPU time of the render, without the computation of leaf tables.

![Colour error against CPU time](images/wavelengths.svg)

At {ladder[-1]} samples per pixel (mean: mean error of the leaf pixels; 95 %: the error that 95 % of them are below; mean leaf:
error of the mean colour of all leaf pixels, which has little noise and so shows the bias of the strategy):

{table(("scene", "strategy", "wavelengths per path", "CPU s", "mean", "95 %", "mean leaf"), body)}
`smpte` and `meyer` represent a spectrum by a few fixed wavelengths and keep a bias at any number of samples; `hero` has noise
only. `smpte,blue=464.7` uses the blue primary's dominant wavelength by CIE 1931 data in place of the paper's 455 nm: on these
leaves that changes the error of the mean colour by {blue:.2f} at most. `meyer,white=D65` scales the published quadrature so that
D65 keeps its own colour.

Machine: {machine()}.
"""


def main():
    options = arguments("wavelengths")
    color_difference.check()
    ladder, reference_samples = ([4, 16], 128) if options.quick else ([4, 16, 64, 256], 512)
    with tempfile.TemporaryDirectory() as name:
        results = {s: measure(s, ladder, reference_samples, pathlib.Path(name)) for s in SCENES}
    chart(options.docs / "images" / "wavelengths.svg", results)
    write_section(options.docs / "conventions.md", "wavelengths", page(results, ladder, reference_samples))


if __name__ == "__main__":
    main()
