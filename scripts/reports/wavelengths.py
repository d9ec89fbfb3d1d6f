"""The colour error of wavelength strategies on the leaf scenes against time: docs/wavelengths.md."""

import pathlib
import tempfile

import numpy

import charts
import color
import frond
from tools import ROOT, arguments, machine, program, sized, table, write

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
    """XYZ of each pixel, which of them are leaves, and the CPU time."""

    def __init__(self, scene, wavelengths, space, samples, seed, folder):
        image = frond.load(scene, wavelengths=wavelengths, seed=seed).render(samples)
        self.seconds, self.leaf = image.statistics["cpu_seconds"], image["leaf"] > 0.5
        if image.color_space:
            rgb = image.rgb
        else:  # bands: colours are what frond convert makes of them
            image.save(folder / "render.exr")
            program("convert", folder / "render.exr", "-o", folder / "rgb.exr")
            names, pixels = frond.read_image(folder / "rgb.exr")
            rgb = pixels[:, :, [names.index(name) for name in "RGB"]]
        self.xyz = color.xyz(rgb, space)


class Reference:
    """Two halves with seeds of their own: their mean is the reference, their difference its noise."""

    def __init__(self, scene, samples, folder):
        halves = [Render(scene, REFERENCE, "linear sRGB", samples, seed, folder) for seed in (101, 102)]
        self.leaf = halves[0].leaf
        self.xyz = sum(half.xyz for half in halves) / 2
        self.noise = color.delta_e(*(color.lab(half.xyz[self.leaf]) for half in halves)).mean() / 2

    def errors(self, render):
        """Mean over the leaf pixels, what 95 % of them are below, and that of their mean colour, in which little noise is left."""
        leaf = self.leaf
        each = color.delta_e(color.lab(render.xyz[leaf]), color.lab(self.xyz[leaf]))
        of_mean = color.delta_e(color.lab(render.xyz[render.leaf].mean(axis=0)), color.lab(self.xyz[leaf].mean(axis=0)))
        return {"seconds": render.seconds, "mean": each.mean(), "p95": numpy.quantile(each, 0.95), "leaf": of_mean}


def measure(name, ladder, reference_samples, folder):
    scene = sized(ROOT / f"scenes/soybean-{name}/scene.pbrt", folder, RESOLUTION)
    reference, curves = Reference(scene, reference_samples, folder), {}
    for strategy, (space, _) in STRATEGIES.items():
        frond.load(scene, wavelengths=strategy).render(1)  # makes the tables
        curves[strategy] = [reference.errors(Render(scene, strategy, space, samples, 1, folder)) for samples in ladder]
        print(name, strategy, curves[strategy][-1], flush=True)
    return reference, curves


def chart(path, results):
    of, [row] = charts.figure(1300, 480, 1, 3, sharex=True, sharey=True)
    for panel, (scene, (reference, curves)) in zip(row, results.items()):
        for hue, mark, (strategy, points) in zip(charts.COLORS, "osD^v", curves.items()):
            panel.loglog([p["seconds"] for p in points], [p["mean"] for p in points], f"{mark}-", color=hue, label=strategy)
        panel.axhline(reference.noise, color="#888888", linestyle="--", linewidth=1, label="noise of the reference")
        panel.set(title=f"soybean, {SCENES[scene]}", xlabel="CPU time (s)", ylim=(0.2, 30))
    charts.plain_ticks(row[0].yaxis, [0.2, 0.3, 0.5, 1, 2, 3, 5, 10, 20, 30])
    row[0].set_ylabel("mean colour error of leaf pixels, ΔE₀₀")
    charts.legend(of, row[0], 6)
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
    return f"""# Wavelengths: colour error against time

Written by `scripts/wavelengths`. The three soybean scenes at {RESOLUTION} x {RESOLUTION} pixels, their leaves as they are
(`leaf_simplified`), rendered with each wavelength strategy at {', '.join(map(str, ladder))} samples per pixel, against a
reference with a band at every nanometre from 360 to 830 nm (`{REFERENCE}`, two halves of
{reference_samples} samples per pixel). The colour error is CIEDE2000 where a white in the light is the white of CIELAB, over
the pixels of which more than half is leaf. It holds noise as well as what a strategy gets wrong; the reference's own noise is
about {noises}. Time is CPU time of the render; tables of leaves are not counted.

![Colour error against CPU time](images/wavelengths.svg)

At {ladder[-1]} samples per pixel; the last column is the error of the mean colour of all leaf pixels, where hardly any noise is
left: what the strategy gets wrong.

{table(("scene", "strategy", "wavelengths a path", "CPU s", "mean", "95 % below", "mean leaf"), body)}
A few fixed wavelengths stand for a spectrum: `smpte` and `meyer` keep an error however long they render; `hero` has noise
alone. `smpte,blue=464.7` takes the dominant wavelength of the blue primary by CIE 1931 data in place of the paper's 455 nm:
on these leaves that moves the mean colour's error by {blue:.2f} at most.
`meyer,white=D65` scales the published quadrature so that D65 keeps its own colour.

Machine: {machine()}.
"""


def main():
    options = arguments("wavelengths")
    color.check()
    ladder, reference_samples = ([4, 16], 128) if options.quick else ([4, 16, 64, 256], 512)
    with tempfile.TemporaryDirectory() as name:
        results = {s: measure(s, ladder, reference_samples, pathlib.Path(name)) for s in SCENES}
    chart(options.docs / "images" / "wavelengths.svg", results)
    write(options.docs / "wavelengths.md", page(results, ladder, reference_samples))


if __name__ == "__main__":
    main()
