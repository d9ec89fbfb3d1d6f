"""docs/canopy.md: canopies against a reference, and which leaf model is enough in one."""

import argparse
import csv
import io
import itertools
import math
import os
import pathlib
import subprocess
import tempfile

from tools import COLORS, FROND, ROOT, block, cpu_seconds, frond, gnuplot, machine, table

MODELS = ["leaf_lambert", "leaf_simplified", "leaf_solved"]
REFERENCE = "leaf_solved"
ANGLES = ["spherical", "planophile", "erectophile"]
INDICES = [1, 3, 5]
SUNS = [20, 45, 70]
BANDS = [450, 550, 670, 800, 1650, 2200]
ZENITH = "-60:60:10"
RMS = 0.01
PLOT = 4  # metres
ENOUGH = 0.02  # of the BRF, in every band and direction

SCENE = """Option "float period" [{plot} {plot}]
WorldBegin
LightSource "distant" "point3 from" [{sun_x} 0 {sun_z}] "point3 to" [0 0 0] "spectrum L" "stdillum-E"
MakeNamedMaterial "soil" "string type" "diffuse" "spectrum reflectance"
  [300 0.05 450 0.08 550 0.12 670 0.16 800 0.22 1000 0.27 1400 0.30 1650 0.38 2200 0.35 2500 0.30]
MakeNamedMaterial "leaf" "string type" "leaf_solved" "string specimen" "soybean"
NamedMaterial "soil"
Shape "bilinearmesh" "point3 P" [0 0 0  {plot} 0 0  0 {plot} 0  {plot} {plot} 0]
NamedMaterial "leaf"
ObjectBegin "leaf" Shape "disk" ObjectEnd
Shape "instances" "string object" "leaf" "string filename" "leaves.npy"
"""


def records(text):
    return list(csv.DictReader(io.StringIO(text)))


def het01(folder, rms):
    """Rows of the 76 angles, and the CPU time."""
    subprocess.run([str(ROOT / "scenes/canopy/make"), str(folder)], check=True, env=os.environ | {"FROND": str(FROND)},
                   capture_output=True)
    for name in ("het01.pbrt",):
        (folder / name).write_text((ROOT / "scenes/canopy" / name).read_text())
    text, cpu = cpu_seconds(lambda: frond("brf", folder / "het01.pbrt", "--zenith=-75:75:2", "--wavelengths", 800,
                                          "--rms", rms, "--csv", "-", "-q"))
    reference = [line.split(",") for line in (ROOT / "tests/reference/het01_brfpp.csv").read_text().splitlines()
                 if line and not line.startswith(("#", "vza"))]
    rows = []
    for ours, (zenith, _, brf, brf_se) in zip(records(text), reference):
        assert float(ours["zenith_deg"]) == float(zenith)
        mean, error = float(ours["brf"]), math.hypot(float(ours["brf_se"]), float(brf_se))
        rows.append({"zenith": float(zenith), "ours": mean, "se": float(ours["brf_se"]), "reference": float(brf),
                     "relative": mean / float(brf) - 1, "z": (mean - float(brf)) / error})
    return rows, cpu


def het01_text(rows, cpu):
    off = [r for r in rows if abs(r["relative"]) > 0.005 and abs(r["z"]) > 3]
    mean = sum(r["relative"] for r in rows) / len(rows)
    mean_se = math.sqrt(sum((r["se"] / r["reference"]) ** 2 for r in rows)) / len(rows)
    worst = max(rows, key=lambda r: abs(r["z"]))
    return (f"{len(rows)} angles in {cpu:.0f} s of CPU time. Mean difference {100 * mean:+.2f} ± {100 * mean_se:.2f} %; RMS "
            f"{100 * math.sqrt(sum(r['relative'] ** 2 for r in rows) / len(rows)):.2f} %, where standard errors are "
            f"{100 * math.sqrt(sum((r['se'] / r['reference']) ** 2 for r in rows) / len(rows)):.2f} %; furthest "
            f"{worst['z']:+.1f} standard errors, at {worst['zenith']:g}°. "
            f"{'No angle is' if not off else str(len(off)) + ' angles are'} further off than 0.5 % and 3 standard errors.")


class Canopy:
    """A homogeneous canopy: its files, and what models make of it."""

    def __init__(self, folder, angles, index, sun):
        self.angles, self.index, self.sun = angles, index, sun
        frond("canopy", "-q", "-o", folder / "leaves.npy", "--lai", index, "--angles", angles, "--scale", 0.05, "--size",
              f"{PLOT},{PLOT}", "--heights", "0.05,1.5")
        self.scene = folder / "scene.pbrt"
        radians = math.radians(sun)
        self.scene.write_text(SCENE.format(plot=PLOT, sun_x=-math.sin(radians), sun_z=math.cos(radians)))
        self.brf, self.par = {}, {}

    def measure(self, rms):
        for model in MODELS:
            text = frond("brf", self.scene, f"--zenith={ZENITH}", "--wavelengths", ",".join(map(str, BANDS)), "--rms", rms,
                         "--swap", f"leaf={model}", "--csv", "-", "-q")
            self.brf[model] = {(float(r["zenith_deg"]), float(r["wavelength_nm"])): (float(r["brf"]), float(r["brf_se"]))
                               for r in records(text)}
            text = frond("flux", self.scene, "--wavelengths", "400:700:20", "--paths", "2e5", "--swap", f"leaf={model}",
                         "--csv", "-", "-q")
            self.par[model] = next((float(r["share"]), float(r["share_se"])) for r in records(text)
                                   if r["quantity"] == "absorbed" and r["material"] == "leaf" and r["wavelength_nm"] == "PAR")
        return self

    def difference(self, model, key):
        """Relative to the reference, and its standard error."""
        (a, a_se), (b, b_se) = self.brf[model][key], self.brf[REFERENCE][key]
        return a / b - 1, a / b * math.hypot(a_se / a, b_se / b)

    def extremes(self, model, band):
        differences = [self.difference(model, key) for key in self.brf[model] if key[1] == band]
        return min(d for d, _ in differences), max(d for d, _ in differences)

    def name(self):
        return f"{self.angles}, LAI {self.index}, sun {self.sun}°"


def chart(canopies):
    """Differences against the zenith angle: a panel for each band, a curve for each model and leaf angle distribution."""
    shown = [c for c in canopies if c.index == 3 and c.sun == 45]
    script = ("set multiplot layout 2,3\nset xlabel 'zenith angle of the view (degrees)'\nset ylabel 'BRF over leaf\\_solved, %'\n"
              "set xtics 30\nset key off\nset xzeroaxis lw 1.2 lc rgb '#000000'\n")
    for panel, band in enumerate(BANDS):
        plots = []
        for i, (canopy, model) in enumerate(itertools.product(shown, [m for m in MODELS if m != REFERENCE])):
            points = [(z, 100 * canopy.difference(model, (z, b))[0], 100 * canopy.difference(model, (z, b))[1])
                      for z, b in canopy.brf[model] if b == band]
            script += block(f"d{panel}_{i}", points)
            color = COLORS[1 + ANGLES.index(canopy.angles)]
            dash = 1 if model == "leaf_lambert" else 2
            name = f"{canopy.angles}, {model}".replace("_", r"\\_")
            plots.append(f"$d{panel}_{i} with lines lw 2 dt {dash} lc rgb '{color}' title \"{name}\", "
                         f"$d{panel}_{i} with yerrorbars pt 7 ps 0.3 lw 1 lc rgb '{color}' notitle")
        key = "set key top right font ',10' samplen 3" if panel == 0 else "set key off"
        script += f"{key}\nset title '{band} nm'\nplot {', '.join(plots)}\n"
    gnuplot(ROOT / "docs/images/canopy.svg", script + "unset multiplot\n", (1200, 760))


PAGE = """# Which leaf is enough in a canopy

Written by `scripts/canopy`. {machine}

## RAMI HET01

15 balls of 10 m, each of 49,999 leaves, over soil, in the near infrared (`scenes/canopy/het01.pbrt`; the leaves are thrown anew,
from the published description), against the reference of Eradiate's regression suite (`tests/reference/het01_brfpp.csv`).
{het01}

## Leaf models in homogeneous canopies

Disks of 5 cm at random, soybean leaves over soil, under the sun alone; views of the principal plane from −60 to 60°, negative
ones from the sun's side. Differences of the BRF from that with `leaf_solved`, the walk's exact BSDF: what a Lambertian leaf of
the same reflectance and transmittance gets wrong (`leaf_lambert`), and three lobes scaled by a table (`leaf_simplified`).
Standard errors are about {noise:.1f} % of a difference. All leaves are reciprocal
([conventions](conventions.md)).

![Differences of the BRF by band and direction](images/canopy.svg)

*Leaf area index 3, the sun at 45°. Solid: leaf_lambert, dashed: leaf_simplified; blue: spherical leaf angles, vermilion:
planophile, green: erectophile. Bars: standard errors.*

{extremes}
*Least and largest difference over the directions, %, over leaf area indices 1, 3 and 5 and the sun at 20, 45 and 70°.*

### Absorbed light

Photons that leaves absorb, 400 to 700 nm, of those that fall in (fAPAR, direct light):

{par}
### What to take

{verdict}
"""


def extremes_table(canopies):
    body = []
    for model in [m for m in MODELS if m != REFERENCE]:
        for angles in ANGLES:
            cells = []
            for band in BANDS:
                pairs = [c.extremes(model, band) for c in canopies if c.angles == angles]
                cells.append(f"{100 * min(low for low, _ in pairs):+.0f} to {100 * max(high for _, high in pairs):+.0f}")
            body.append([f"`{model}`", angles, *cells])
    return table(["", "leaf angles", *(f"{band} nm" for band in BANDS)], body)


def par_table(canopies):
    body = []
    for c in canopies:
        reference, _ = c.par[REFERENCE]
        body.append([c.name(), f"{reference:.4f} ± {c.par[REFERENCE][1]:.4f}",
                     *(f"{100 * (c.par[m][0] / reference - 1):+.2f} ± "
                       f"{100 * math.hypot(c.par[m][1] / c.par[m][0], c.par[REFERENCE][1] / reference):.2f} %"
                       for m in MODELS if m != REFERENCE)])
    return table(["canopy", "`leaf_solved`", *(f"`{m}`" for m in MODELS if m != REFERENCE)], body)


def verdict(canopies):
    """For each model, in how many canopies it is enough in every band and direction, and in the infrared alone."""
    lines = []
    for model in [m for m in MODELS if m != REFERENCE]:
        counts = []
        for bands in (BANDS, [800]):
            # Not clearly beyond: less three standard errors.
            counts.append(sum(all(abs(d) - 3 * e <= ENOUGH for d, e in (c.difference(model, key) for key in c.brf[model]
                                                                       if key[1] in bands)) for c in canopies))
        worst = max((abs(c.difference(model, key)[0]), c, key) for c in canopies for key in c.brf[model])
        par = max(abs(c.par[model][0] / c.par[REFERENCE][0] - 1) for c in canopies)
        lines.append(f"- `{model}`: BRF off by {100 * worst[0]:.0f} % at most ({worst[1].name()}, {worst[2][1]:g} nm, view "
                     f"{worst[2][0]:g}°); nowhere clearly off by more than {100 * ENOUGH:.0f} % in {counts[0]} of {len(canopies)} "
                     f"canopies over all bands, in {counts[1]} at 800 nm alone; absorbed photons off by {100 * par:.1f} % at most.")
    return "\n".join(lines)


def main():
    parser = argparse.ArgumentParser(prog="scripts/canopy", description=__doc__)
    parser.add_argument("--only", choices=["het01", "study"], help="one of both, printed; no page is written")
    parser.add_argument("--rms", type=float, default=RMS, help="relative standard error of the BRFs")
    options = parser.parse_args()
    with tempfile.TemporaryDirectory(prefix="frond_canopy.") as name:
        folder = pathlib.Path(name)
        if options.only != "study":
            het = het01_text(*het01(folder, 0.003))
            print(het, flush=True)
        if options.only == "het01":
            return
        canopies = []
        for angles, index, sun in itertools.product(ANGLES, INDICES, SUNS):
            canopies.append(Canopy(folder, angles, index, sun).measure(options.rms))
            print(canopies[-1].name(), {m: canopies[-1].extremes(m, 670) for m in MODELS}, flush=True)
    noise = 100 * math.sqrt(sum(c.difference(MODELS[0], key)[1] ** 2 for c in canopies for key in c.brf[MODELS[0]]) /
                            sum(len(c.brf[MODELS[0]]) for c in canopies))
    print(extremes_table(canopies), par_table(canopies), verdict(canopies), sep="\n")
    if options.only:
        return
    chart(canopies)
    page = PAGE.format(machine=machine(), het01=het, noise=noise, extremes=extremes_table(canopies), par=par_table(canopies),
                       verdict=verdict(canopies))
    (ROOT / "docs/canopy.md").write_text(page, encoding="utf-8")


if __name__ == "__main__":
    main()
