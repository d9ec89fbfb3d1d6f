"""The colour error of wavelength strategies on the leaf scenes against time: docs/wavelengths.md."""

import argparse
import json
import pathlib
import re
import tempfile

import color
from tools import COLORS, ROOT, block, frond, gnuplot, machine, run, table

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


def small_scene(name, folder):
    """A copy of a scene at our resolution, which finds its parts where they are."""
    home = ROOT / "scenes" / f"soybean-{name}"
    text = (home / "scene.pbrt").read_text()
    text = re.sub(r'("integer [xy]resolution") \d+', rf"\1 {RESOLUTION}", text)
    text = re.sub(r'(Include|"string filename") "(?=[^/"]*\.(?:pbrt|ply)")', rf'\1 "{home}/', text)
    path = folder / f"{name}.pbrt"
    path.write_text(text)
    return path


class Render:
    """Lab and XYZ of each pixel, which of them are leaves, and the CPU time."""

    def __init__(self, scene, wavelengths, space, samples, seed, folder):
        image, flat = folder / "render.exr", folder / "rgb.exr"
        report = json.loads(frond("render", scene, "--wavelengths", wavelengths, "--spp", samples, "--seed", seed,
                                  "-o", image, "--json"))
        self.seconds = report["cpu_seconds"]
        frond("convert", image, "-o", flat)
        rgb = dump(flat)
        self.leaf = [share[0] > 0.5 for share in dump(leaf_of(image, folder))]
        self.xyz = [color.xyz(p, space) for p in rgb]
        self.lab = [color.lab(p) for p in self.xyz]

    def mean_leaf(self):
        """Lab of the mean of all leaf pixels, in which little noise is left."""
        leaves = [c for c, is_leaf in zip(self.xyz, self.leaf) if is_leaf]
        return color.lab([sum(c[k] for c in leaves) / len(leaves) for k in range(3)])


def leaf_of(image, folder):
    path = folder / "leaf.exr"
    run("oiiotool", image, "--ch", "leaf", "-o", path)
    return path


def dump(path):
    """The channels of each pixel."""
    text = run("oiiotool", "--dumpdata", path)
    return [tuple(map(float, line.split(":", 1)[1].split())) for line in text.splitlines() if "Pixel (" in line]


def distances(render, reference_lab, leaf):
    return sorted(color.delta_e(a, b) for a, b, is_leaf in zip(render.lab, reference_lab, leaf) if is_leaf)


def mean(values):
    return sum(values) / len(values)


class Reference:
    """Two halves with seeds of their own: their mean is the reference, their difference its noise."""

    def __init__(self, scene, samples, folder):
        halves = [Render(scene, REFERENCE, "linear sRGB", samples, seed, folder) for seed in (101, 102)]
        self.leaf = halves[0].leaf
        self.xyz = [tuple((a + b) / 2 for a, b in zip(*pixel)) for pixel in zip(halves[0].xyz, halves[1].xyz)]
        self.lab = [color.lab(p) for p in self.xyz]
        self.noise = mean(distances(halves[0], halves[1].lab, self.leaf)) / 2
        self.seconds = sum(h.seconds for h in halves)
        leaves = [c for c, is_leaf in zip(self.xyz, self.leaf) if is_leaf]
        self.mean_leaf = color.lab([mean([c[k] for c in leaves]) for k in range(3)])


def measure(name, ladder, reference_samples, folder):
    scene = small_scene(name, folder)
    reference = Reference(scene, reference_samples, folder)
    curves = {}
    for strategy, (space, _) in STRATEGIES.items():
        frond("render", scene, "--wavelengths", strategy, "--spp", 1, "-o", folder / "warm.exr", "-q")  # makes the tables
        for samples in ladder:
            render = Render(scene, strategy, space, samples, 1, folder)
            errors = distances(render, reference.lab, reference.leaf)
            curves.setdefault(strategy, []).append({
                "samples": samples, "seconds": render.seconds, "mean": mean(errors),
                "p95": errors[int(0.95 * len(errors))],
                "leaf": color.delta_e(render.mean_leaf(), reference.mean_leaf)})
        print(name, strategy, curves[strategy][-1], flush=True)
    return reference, curves


def chart(path, results):
    script = "set multiplot layout 1,3\nset logscale xy\nset key top right font ',11'\nset format x '10^{%T}'\n"
    seconds = [p["seconds"] for _, curves in results.values() for points in curves.values() for p in points]
    script += f"set xrange [{min(seconds) / 1.3}:{1.3 * max(seconds)}]\n"
    script += "set xlabel 'CPU time (s)'\nset yrange [0.2:30]\nset ytics (0.2,0.3,0.5,1,2,3,5,10,20,30)\n"
    for panel, (scene, (reference, curves)) in enumerate(results.items()):
        plots = []
        for i, (strategy, points) in enumerate(curves.items()):
            script += block(f"d{panel}_{i}", [(p["seconds"], p["mean"]) for p in points])
            plots.append(f"$d{panel}_{i} using 1:2 with linespoints lw 2 pt {i + 4} ps 0.9 lc rgb '{COLORS[i]}' "
                         f"title '{strategy}'")
        plots.append(f"{reference.noise} with lines dt 2 lw 1 lc rgb '#888888' title 'noise of the reference'")
        script += f"set title 'soybean, {SCENES[scene]}'\n"
        script += f"set ylabel '{'mean colour error of leaf pixels, ΔE_{00}' if panel == 0 else ''}'\n"
        script += ("set key\n" if panel == 0 else "unset key\n") + "plot " + ", ".join(plots) + "\n"
    gnuplot(path, script + "unset multiplot\n", (1300, 480))


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
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--quick", action="store_true", help="few samples, into build/wavelengths")
    quick = parser.parse_args().quick
    color.check()
    ladder, reference_samples = ([4, 16], 128) if quick else ([4, 16, 64, 256], 512)
    docs = ROOT / "build" / "wavelengths" if quick else ROOT / "docs"
    with tempfile.TemporaryDirectory() as name:
        results = {s: measure(s, ladder, reference_samples, pathlib.Path(name)) for s in SCENES}
    chart(docs / "images" / "wavelengths.svg", results)
    (docs / "wavelengths.md").write_text(page(results, ladder, reference_samples))
    print(f"Written: {docs / 'wavelengths.md'}")


if __name__ == "__main__":
    main()
