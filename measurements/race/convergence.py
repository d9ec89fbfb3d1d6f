"""Error against time of hair, subsurface and Film "spectral", by frond and pbrt-v4 (measurements/run race --convergence)."""

import json
import types

import frond
import numpy

from ..gallery import FLOOR, LIGHT, TUFT, VIEW
from ..shared import charts
from ..shared.tools import ROOT, Use, machine, table
from . import luminance, programs, scenes

LADDER, SEEDS = (1, 4, 16, 64), 6  # samples per pixel, and renders of each
SPECTRAL = LADDER[1:]  # frond refuses fewer than reach each of 16 buckets
TRUTH = 512  # samples per pixel, in four renders
SIZE = 68
FRONT = f"""{VIEW}Film "rgb" "integer xresolution" {SIZE} "integer yresolution" {SIZE} "bool savefp16" false
Sampler "paddedsobol" "integer pixelsamples" 1
Integrator "volpath" "integer maxdepth" 50
PixelFilter "box"
WorldBegin
{LIGHT}{FLOOR}"""
# Reflectance and transmittance of the specimen soybean-lopex (abm, 8 degrees from the normal).
LEAF = {"reflectance": "360 0.06 400 0.059 450 0.056 500 0.058 525 0.107 550 0.136 575 0.104 600 0.083 650 0.056 680 0.048 "
                       "700 0.129 725 0.366 750 0.463 830 0.482",
        "transmittance": "360 0 450 0.001 500 0.019 525 0.11 550 0.15 575 0.111 600 0.082 650 0.029 680 0.005 700 0.15 725 0.358 "
                         "750 0.426 830 0.446"}


BERRIES = "".join(f'AttributeBegin Translate {x} {y} {r} Shape "sphere" "float radius" {r} AttributeEnd\n'
                  for x, y, r in ((-0.75, 0, 0.6), (0.6, 0.3, 0.7), (0.05, -0.85, 0.45)))


def spectral(folder):
    """A soybean plant as in the scene soybean-front, with the spectra of a leaf and 16 buckets."""
    file = folder / "plant.pbrt"
    scenes.write_pbrt(scenes.soybean("front")(folder), file, "leaf", True, SIZE)
    text = file.read_text(encoding="utf-8").replace('Film "rgb"', 'Film "spectral" "integer nbuckets" 16 "bool savefp16" false')
    for name, value in zip(LEAF, scenes.LEAVES["leaf"]):
        text = text.replace(f'"spectrum {name}" {scenes.grey(value)}', f'"spectrum {name}" [ {LEAF[name]} ]')
    return text


# By name: what it is, and a function from the folder of its files to its text.
SCENES = {
    "awns": ("260 curves of hair", lambda _: FRONT + 'Material "hair" "rgb reflectance" [ 0.75 0.55 0.25 ] "float beta_m" 0.2\n' + TUFT),
    "snowberries": ("subsurface, the same at all wavelengths", lambda _: f"""{FRONT}Material "subsurface" "float roughness" 0.05
  "spectrum sigma_a" [ 300 0.05 2500 0.05 ] "spectrum sigma_s" [ 300 12 2500 12 ]\n{BERRIES}"""),
    "red berries": ("subsurface, mean free paths by wavelength", lambda _: f"""{FRONT}Material "subsurface" "float roughness" 0.05
  "rgb reflectance" [ 0.6 0.1 0.05 ] "rgb mfp" [ 0.12 0.08 0.06 ]\n{BERRIES}"""),
    "spectral": ('a soybean plant in Film "spectral", 16 buckets', spectral)}


def read(path):
    """`[channel][row][column]` of the buckets of a spectral film or else of R, G and B."""
    names, pixels = frond.read_image(path)
    chosen = [name for name in names if name.startswith("S0.")] or ["R", "G", "B"]
    return numpy.stack([pixels[:, :, names.index(name)] for name in chosen]).astype(float)


def measure(folder, racing):
    """By scene and program: CPU seconds and mean squares of the error `[ladder][seed]`; and pbrt-v4's truth beside frond's."""
    def render(program, name, samples, seed):
        use = Use(*program.words(folder / f"{name}.pbrt", samples, seed, folder / "image.exr"))
        return use.cpu, read(folder / "image.exr")

    truths, found = {}, {}
    for name, (_, scene) in SCENES.items():
        (folder / f"{name}.pbrt").write_text(scene(folder), encoding="utf-8")
        truths[name] = [numpy.stack([render(program, name, TRUTH // 4, 101 + i)[1] for i in range(4)]) for program in racing]
        own, other = ([luminance.measure(channel) for channel in truth.swapaxes(0, 1)] for truth in truths[name])
        differences = [luminance.difference(b, a) for a, b in zip(own, other)]
        found[name] = {"programs": {}, "differences": [(float(d.mean), float(d.mean / d.error)) for d in differences]}
        print("truth", name, found[name]["differences"], flush=True)
    for name in SCENES:
        for program, truth in zip(racing, truths[name]):
            mean, variance = truth.mean(0), truth.var(0, ddof=1).mean() / len(truth)
            renders = [[render(program, name, samples, 1 + i) for i in range(SEEDS)] for samples in (SPECTRAL if name == "spectral" else LADDER)]
            found[name]["programs"][program.name] = {
                "cpu": [[seconds for seconds, _ in row] for row in renders],
                "squares": [[(numpy.square(image - mean).mean() - variance) / mean.mean()**2 for _, image in row] for row in renders]}
        print(name, flush=True)
    return found


def points(of_program):
    """CPU seconds per image without set-up, RMS error, its relative standard error; and the set-up."""
    medians, samples = numpy.median(of_program["cpu"], axis=1), numpy.array(LADDER[-len(of_program["cpu"]):])
    path = (medians[-1] - medians[0]) / (samples[-1] - samples[0])  # CPU time of one sample in each pixel
    squares = numpy.array(of_program["squares"])
    mean = squares.mean(1)
    return path * samples, numpy.sqrt(mean), squares.std(1, ddof=1) / SEEDS**0.5 / mean, max(0, medians[0] - path * samples[0])


def chart(path, found):
    of, panels = charts.figure(960, 660, 2, 2)
    for panel, (name, of_scene) in zip(panels.ravel(), found.items()):
        for hue, mark, (who, of_program) in zip(charts.COLORS[1:], "os", of_scene["programs"].items()):
            seconds, error, *_ = points(of_program)
            panel.loglog(seconds, 100 * error, f"{mark}-", color=hue, label=who)
        panel.set(title=f"{name}: {SCENES[name][0]}", xlabel="CPU time without set-up (s)", ylabel="RMS error over the mean (%)")
    charts.legend(of, panels[0][0], 2)
    charts.save(of, path)


def section(found):
    rows = []
    for name, of_scene in found.items():
        reference = points(of_scene["programs"]["frond"])
        difference, z = max(of_scene["differences"], key=lambda pair: abs(pair[1]))
        for who, of_program in of_scene["programs"].items():
            seconds, error, relative, set_up = points(of_program)
            worth = (reference[1] / error)**2 * reference[0] / seconds
            spread = worth * numpy.hypot(relative, reference[2])
            own = who == "frond"
            blank = [""] * (len(LADDER) - len(error))
            rows.append([name if own else "", who, f"{1e6 * seconds[-1] / SIZE**2 / LADDER[-1]:.1f}", f"{set_up:.2f} s",
                         *blank, *(f"{100 * e:.3g} %" for e in error),
                         *blank, *("1" if own else f"{w:.2f} ± {s:.2f}" for w, s in zip(worth, spread)),
                         "" if own else f"{z:+.1f} ({100 * difference:+.2f} %)"])
    head = ["scene", "program", "CPU, µs", "set-up", *(f"error, {s}" for s in LADDER), *(f"efficiency, {s}" for s in LADDER), "z"]
    return f"""### Hair, subsurface and spectral film

{machine()}; pbrt-v4. `measurements/run race --convergence`, one thread.

{"; ".join(f"*{name}*: {what}" for name, (what, _) in SCENES.items())}.
{SIZE} × {SIZE} pixels, box filter, paths of up to 50 scattering events (the plant: 16), {SEEDS} seeds. CPU: time of a path. Error: RMS over pixels and
channels (R, G and B, or the buckets) at so many samples per pixel, relative to their mean, from the program's own truth of {TRUTH} samples,
whose noise is subtracted. z: difference of pbrt-v4's truth from frond's in standard errors (and in per cent), in the channel where it is
largest.

![Error against CPU time of hair, subsurface and spectral film](images/race.svg)

{table(head, rows)}"""


def main(pbrt, folder):
    """Measures, draws the chart, and returns the section."""
    if not pbrt:
        raise SystemExit("--convergence needs pbrt-v4: no pbrt on the PATH, none given by --pbrt")
    racing = [programs.Frond("frond", "hero"), programs.Pbrt(pbrt)]
    for program in racing:
        program.setting = types.SimpleNamespace(threads=1)
    folder.mkdir(parents=True, exist_ok=True)
    found = measure(folder, racing)
    (folder / "convergence.json").write_text(json.dumps(found), encoding="utf-8")
    chart(ROOT / "docs" / "images" / "race.svg", found)
    return section(found)
