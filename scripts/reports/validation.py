"""Writes docs/validation.md: how right the leaf models are, all of it measured."""

import argparse
import json
import math
import re
import subprocess

from tools import BUILD, COLORS, FROND, ROOT, block, frond, gnuplot, machine, number, rows, run, table

LEAVES = ["soybean", "maize"]
RGB = [608, 551, 455]


class Report:
    def __init__(self, quick):
        self.quick = quick
        self.folder = BUILD.parent / "validation" if quick else ROOT / "docs"
        self.images = self.folder / "images" / "validation"
        self.folder.mkdir(parents=True, exist_ok=True)
        self.parts = []

    def rays(self, full):
        return f"{full / 100 if self.quick else full:.0e}"

    def add(self, text):
        self.parts.append(text.strip() + "\n")

    def chart(self, name, title, script, size=(900, 560)):
        gnuplot(self.images / f"{name}.svg", script, size)
        self.add(f"![{title}](images/validation/{name}.svg)")

    def write(self):
        path = self.folder / "validation.md"
        path.write_text("\n".join(self.parts))
        print(path)


# --- Spectra ---------------------------------------------------------------------------------------------------------


def spectrum(leaf, sieve):
    """R and T of both sides at 8 degrees, by wavelength: {(nm, theta): (R, T)}."""
    text = frond("table", "--specimen", leaf, f"sieve={'true' if sieve else 'false'}", "--wavelengths", "400:2500:10",
                 "--angles", "8,172", "-q", "-o", "-")
    return {(r["wavelength_nm"], r["theta_deg"]): (r["Rs"] + r["Rd"], r["T"]) for r in rows(text)}


def measured_leaf():
    """LOPEX93, mean and range of five soybean leaves."""
    return rows((ROOT / "tests" / "reference" / "lopex93_soybean.csv").read_text())


def rms(differences):
    differences = list(differences)
    return math.sqrt(sum(d * d for d in differences) / len(differences))


def spectra(report):
    report.add(f"""
## Spectra, 400 to 2500 nm

Reflectance R and transmittance T at 8° from the normal, solved at every 10 nm with the optical constants of Baranoski
(2006). R is drawn from below, T from above: what lies between the curves is absorbed. Grey: the mean and the range of
five soybean leaves (LOPEX93, Hosgood et al. 1994), which have their own thickness and chemistry; no parameter of the
model was fitted to them. "Sieve" is the later form of Beer's law (Baranoski and Eng 2007).
""")
    lopex = measured_leaf()
    figures = []
    for leaf in LEAVES:
        curves = {sieve: spectrum(leaf, sieve) for sieve in (False, True)}
        draw_spectra(report, leaf, curves, lopex)
        for sieve, curve in curves.items():
            for theta, side in ((8, "adaxial"), (172, "abaxial")):
                cells = [leaf, side, "on" if sieve else "off"]
                for low, high in ((400, 700), (700, 1300), (1300, 2500)):
                    inside = [r for r in lopex if low <= r["wavelength_nm"] <= high]
                    for i, name in enumerate(("R_mean", "T_mean")):
                        cells.append(f"{rms(curve[r['wavelength_nm'], theta][i] - r[name] for r in inside):.3f}")
                if leaf == "soybean":
                    figures.append(cells)
    report.add("RMS difference from the measured soybean leaves, by band:\n")
    report.add(table(["leaf", "side", "sieve", "R 400-700", "T 400-700", "R 700-1300", "T 700-1300", "R 1300-2500",
                      "T 1300-2500"], figures))


def draw_spectra(report, leaf, curves, lopex):
    data, plots = "", []
    if leaf == "soybean":
        data += block("lopex", [(r["wavelength_nm"], r["R_min"], r["R_max"], 1 - r["T_max"], 1 - r["T_min"],
                                 r["R_mean"], 1 - r["T_mean"]) for r in lopex])
        plots += ["$lopex using 1:2:3 with filledcurves fc rgb '#d0d0d0' title 'LOPEX93 soybean, range'",
                  "$lopex using 1:4:5 with filledcurves fc rgb '#d0d0d0' notitle",
                  "$lopex using 1:6 with lines lw 1.5 lc rgb '#808080' title 'LOPEX93 soybean, mean'",
                  "$lopex using 1:7 with lines lw 1.5 lc rgb '#808080' notitle"]
    for s, (sieve, curve) in enumerate(curves.items()):
        for t, (theta, side) in enumerate(((8, "adaxial"), (172, "abaxial"))):
            name = f"c{s}{t}"
            data += block(name, [(nm, r, 1 - tr) for (nm, th), (r, tr) in sorted(curve.items()) if th == theta])
            style = f"lines lw 2 lc rgb '{COLORS[1 + t]}'" + (" dt (6,4)" if sieve else "")
            plots += [f"${name} using 1:2 with {style} title '{side}{', sieve' if sieve else ''}'",
                      f"${name} using 1:3 with {style} notitle"]
    report.chart(f"spectra-{leaf}", f"R and 1 - T of {leaf}", data + f"""
set title '{leaf}, light at 8°'
set xlabel 'wavelength (nm)'
set ylabel 'reflectance R'
set y2label 'transmittance T'
set xrange [400:2500]
set yrange [0:1]
set y2range [1:0]
set ytics 0.2 nomirror
set y2tics 0.2
set key at screen 0.5,0.015 bottom center horizontal nobox maxrows 2
set bmargin 7
plot {', '.join(plots)}
""", (900, 640))


# --- Table -----------------------------------------------------------------------------------------------------------

TABLE_ANGLES = "0:90:15,105:180:15"


def timed_table(leaf, *options):
    """Rows of a table by (angle, wavelength), and the CPU time that it took without starting the program."""
    words = [FROND, "table", "--specimen", leaf, "--wavelengths", "608,551,455", "--angles", TABLE_ANGLES, "--threads",
             "1", "-o", "-", *options]
    done = subprocess.run([str(w) for w in words], capture_output=True, text=True, check=True)
    seconds = float(re.search(r"([0-9.e+-]+) s of CPU", done.stderr).group(1))
    return {(r["theta_deg"], r["wavelength_nm"]): r for r in rows(done.stdout)}, seconds


def difference(a, b):
    """RMS over the table's figures, and the largest."""
    d = [a[k][name] - b[k][name] for k in b for name in ("Rd", "T")]
    return rms(d), max(map(abs, d))


def tables(report):
    report.add("""
## The table: solved against sampled

The same shares by both methods, at 13 angles of incidence on both sides and 608, 551 and 455 nm. The reference is the
solution with 40 nodes a segment. Monte Carlo is the paper's: analog walks, here by the batched kernel.
""")
    body, data, plots = [], "", []
    for number_of_leaf, leaf in enumerate(LEAVES):
        exact, _ = timed_table(leaf, "--method", "solve", "--nodes", 40)
        sampled, solved = [], []
        for rays in (1e3, 1e4, 1e5) if report.quick else (1e3, 1e4, 1e5, 1e6, 1e7):
            values, seconds = timed_table(leaf, "--method", "montecarlo", "--rays", f"{rays:.0e}")
            error, worst = difference(values, exact)
            sampled.append((seconds, error))
            body.append([leaf, f"Monte Carlo, {rays:.0e} rays", f"{seconds:.3g}", f"{error:.1e}", f"{worst:.1e}"])
        for nodes in (3, 4, 6, 8, 12, 16, 24):
            values, seconds = timed_table(leaf, "--method", "solve", "--nodes", nodes)
            error, worst = difference(values, exact)
            solved.append((seconds, error))
            body.append([leaf, f"solve, {nodes} nodes", f"{seconds:.3g}", f"{error:.1e}", f"{worst:.1e}"])
        color, mark = COLORS[1 + number_of_leaf], 7 + 2 * number_of_leaf
        data += block(f"mc{number_of_leaf}", sampled) + block(f"so{number_of_leaf}", solved)
        plots += [f"$mc{number_of_leaf} with linespoints pt {mark} lw 2 lc rgb '{color}' title '{leaf}, Monte Carlo'",
                  f"$so{number_of_leaf} with linespoints pt {mark - 1} lw 2 dt (6,3) lc rgb '{color}' title '{leaf}, solved'"]
    report.chart("table-error", "Error of the table against CPU time", data + f"""
set title 'Table of 13 angles, three wavelengths'
set logscale xy
set format xy '10^{{%L}}'
set yrange [1e-11:0.1]
set xlabel 'CPU time (s)'
set ylabel 'RMS error of Rd and T'
set key bottom left
plot {', '.join(plots)}
""")
    report.add(table(["leaf", "method", "CPU s", "RMS error", "largest"], body))


# --- Figures 1 and 4 -------------------------------------------------------------------------------------------------


def figures(report):
    rays = report.rays(1e8)
    report.add(f"""
## Figures 1 and 4 of the paper: the BDF in the plane of incidence

Both models for soybean by the goniophotometer, {rays} rays a curve, detectors of 9° by 9°: 20 in the polar angle and 40
in azimuth, as in the paper. Above 90° light has gone through the leaf. Bars: one standard error, mostly smaller than
the lines.
""")
    for nm in RGB:
        name = f"bdf-{nm}"
        frond("goniophotometer", "abm", "specimen=soybean", "--with", "leaf_simplified specimen=soybean", "--angles",
              "30,45", "--wavelengths", nm, "--rays", rays, "-q", "--plot", report.images / f"{name}.svg")
        report.add(f"![BDF at {nm} nm](images/validation/{name}.svg)")


# --- Walks against walks ---------------------------------------------------------------------------------------------


def readings(material, angles, wavelengths, rays, *options):
    text = frond("spectrophotometer", *material.split(), "--angles", angles, "--wavelengths", wavelengths, "--rays", rays,
                 "--csv", "-", "-q", *options)
    return {(r["theta_deg"], r["wavelength_nm"]): r for r in rows(text)}


def z_scores(a, b, names=("R", "T")):
    return [(a[k][n] - b[k][n]) / math.hypot(a[k][n + "_se"], b[k][n + "_se"]) for k in a for n in names]


def walks(report):
    rays = report.rays(1e7)
    body = []
    for leaf in LEAVES:
        measured = [readings(f"abm specimen={leaf} mode={mode}", "0,30,60,85,120,180", "455,551,608,800", rays)
                    for mode in ("analog", "weighted")]
        z = z_scores(*measured)
        body.append([f"{leaf}: weighted against analog absorption, R and T", f"{rays} rays each", len(z),
                     f"{sum(x * x for x in z):.0f}", f"{max(map(abs, z)):.1f}"])
    body += heroes(report)
    report.add("""
## Walks against walks

Each row compares two ways to the same figures: the sum of squared differences in standard errors should be near the
number of comparisons (its own standard deviation is the root of twice that number).

Hero wavelengths: four wavelengths whose indices differ far more than any leaf's (cuticle 1.3 to 1.7) on one walk, in
detectors all over the sphere, against walks of one wavelength; "wide" is soybean with lobes of exponent 0.
""")
    report.add(table(["comparison", "effort", "comparisons", "chi-square", "largest, in standard errors"], body))


def heroes(report):
    """The test's own figures, with more rays."""
    path = report.folder / "heroes.json"
    run("env", f"FROND_HERO_RAYS={'1e5' if report.quick else '3e6'}", BUILD / "tests" / "test_leaf",
        "--gtest_filter=*SpectralWalk.Fills*", f"--gtest_output=json:{path}")
    found = json.loads(path.read_text())
    path.unlink()
    body = []
    for suite in found["testsuites"]:
        for case in suite["testsuite"]:
            body.append([f"{case['leaf']}: hero walks, {case['absorption']}, light at {case['theta_deg']}°",
                         f"{number(case['rays']):.0e} rays each", case["comparisons"],
                         f"{number(case['chi_square']):.0f}", f"{number(case['largest']):.1f}"])
    return body


def f_against_sample(report):
    body = []
    samples = report.rays(1e6).replace("e+0", "e")
    for material in ("abm", "abm mode=weighted", "abm specimen=maize", "abm incident=light", "leaf_simplified",
                     "leaf_simplified incident=light", "diffusetransmission"):
        text = frond("conform", *material.split(), "--samples", samples, "--json", "-")
        for name, law in json.loads(text)["laws"].items():
            if name in ("sampling", "unbiasedness", "energy") and "worst_p" in law:
                body.append([f"`{material}`", name, law["tests"], f"{law['worst_p']:.2g}", law["verdict"]])
    report.add(f"""
## `f` against `sample`

The laws of `frond conform`, {samples} samples for each direction of incidence (0, 30, 60, 80, 89° on both sides), at
608, 551 and 455 nm. *Unbiasedness*: in every bin of the sphere the mean weight of `sample` is the integral of `f` times
the cosine. *Sampling*: directions are distributed as `pdf`. *Energy*: no more comes out than went in. The p-value is
the smallest of so many tests: about one over their number is what chance gives.
""")
    report.add(table(["material", "law", "tests", "smallest p", ""], body))


# --- Reciprocity -----------------------------------------------------------------------------------------------------


def brdf(material, theta, nm, rays):
    text = frond("goniophotometer", *material.split(), "--angle", theta, "--wavelengths", nm, "--rays", rays, "--patches",
                 "36x36", "--csv", "-", "-q")
    return rows(text)


def around_azimuth(patches, theta):
    """Mean over azimuth of f toward theta, and its standard error."""
    ring = [p for p in patches if p["theta_min_deg"] <= theta < p["theta_max_deg"]]
    return sum(p["f_per_sr"] for p in ring) / len(ring), math.sqrt(sum(p["f_se"] ** 2 for p in ring)) / len(ring)


def reciprocity(report):
    rays = report.rays(3e7)
    report.add(f"""
## Reciprocity

Neither leaf model is reciprocal: light that goes from a to b and light that goes from b to a are not scattered alike.
f is the mean over azimuth into a ring of 5° ({rays} rays, 800 nm), for light that the model calls incident at 12.5° and
leaves at 72.5°, over that of the way back. 1 would be reciprocal.
""")
    body = []
    a, b = 12.5, 72.5
    for material in ("abm specimen=soybean", "leaf_simplified specimen=soybean", "abm specimen=maize",
                     "leaf_simplified specimen=maize", "diffusetransmission"):
        there, back = brdf(material, a, 800, rays), brdf(material, b, 800, rays)
        below = brdf(material, 180 - b, 800, rays)
        cells = [f"`{material}`"]
        for forth, returned in ((around_azimuth(there, b), around_azimuth(back, a)),
                                (around_azimuth(there, 180 - b), around_azimuth(below, a))):
            ratio = forth[0] / returned[0]
            error = ratio * math.hypot(forth[1] / forth[0], returned[1] / returned[0])
            cells.append(f"{ratio:.3f} ± {error:.3f}")
        body.append(cells)
    report.add(table(["material", "reflection, f(12.5°→72.5°) / f(72.5°→12.5°)",
                      "transmission, f(12.5°→107.5°) / f(107.5°→12.5°)"], body))
    lossless(report)
    pictures(report)


def lossless(report):
    """What a leaf that absorbs nothing sends back of light from one direction, as a render shows it."""
    angles, body = "5,30,60,75,85", []
    for material in ("abm", "leaf_simplified"):
        for incident in ("traced", "light"):
            r = readings(f"{material} specimen=soybean mesophyllfraction=0 incident={incident}", angles, 551,
                         report.rays(1e7), "--rendered")
            body.append([f"`{material}`", incident] +
                        [f"{x['R'] + x['T']:.4f} ± {x['A_se']:.4f}" for x in r.values()])
    report.add("""
A leaf that absorbs nothing, lit by distant light and looked at from all around, should give back all of it. What a
render shows of it (`frond spectrophotometer --rendered`: light along wi, detectors along wo):
""")
    report.add(table(["material", "`incident`"] + [f"light at {a}°" for a in angles.split(",")], body))


def pictures(report):
    body = []
    spp = 8 if report.quick else 32
    for scene in ("front", "back", "ambient"):
        halves = []
        for incident in ("traced", "light"):
            for seed in (1, 2):
                path = BUILD.parent / f"{scene}-{incident}-{seed}.exr"
                frond("render", ROOT / "scenes" / f"soybean-{scene}" / "scene.pbrt", "--wavelengths", "smpte", "--swap",
                      f"leaf=leaf_simplified,incident={incident}", "--spp", spp, "--seed", seed, "-o", path, "-q")
                halves.append(path)
        d = json.loads(frond("difference", *halves, "--json"))
        for path in halves:
            path.unlink()
        body.append([scene] + [f"{d['leaf_mean_difference_' + c]:+.4f}" for c in ("red", "green", "blue")] +
                    [f"{d['leaf_bias_' + c]:.4f}" for c in ("red", "green", "blue")])
    report.add(f"""
The same in the pictures: `incident` "traced" minus "light" on leaf pixels of the three scenes, for `leaf_simplified` at
{2 * spp} samples per pixel; white in the light is 1.
""")
    report.add(table(["scene", "mean, red", "green", "blue", "RMS without noise, red", "green", "blue"], body))


# --- Weaknesses ------------------------------------------------------------------------------------------------------


def weaknesses(report):
    lopex = {r["wavelength_nm"]: r for r in measured_leaf()}
    plain, sieve = spectrum("soybean", False), spectrum("soybean", True)
    at = lambda curve, nm, theta, i: curve[nm, theta][i]
    report.add(f"""
## What the models get wrong

- **Blue from below.** The abaxial side reflects {at(plain, 450, 172, 0):.3f} at 450 nm; the measured adaxial sides
  {lopex[450]['R_mean']:.3f} (LOPEX93 has no abaxial ones). A ray that enters from below meets
  the air space behind the epidermis, which reflects it before any pigment does, whatever the wavelength.
- **No sieve effect, no detours in plain Beer's law.** Pigments stand in chloroplasts, not spread evenly, and light goes
  round about between cells. The switch puts cos(cos θ) in place of cos θ: a formula that fits, not a path length. Steep
  ways then absorb more and flat ones less. For soybean lit from above it comes nearer to the measured leaves at most
  wavelengths: R at 800 nm is {at(plain, 800, 8, 0):.3f} without and {at(sieve, 800, 8, 0):.3f} with it (measured
  {lopex[800]['R_mean']:.3f}), T at 680 nm {at(plain, 680, 8, 1):.3f} and {at(sieve, 680, 8, 1):.3f}
  ({lopex[680]['T_mean']:.3f}). The green peak stays too low: R at 550 nm {at(plain, 550, 8, 0):.3f} and
  {at(sieve, 550, 8, 0):.3f} ({lopex[550]['R_mean']:.3f}).
- **One tissue.** No veins, no hairs, no wax bloom; the leaf is the same from place to place unless textures say so.
- **leaf_simplified** has the walk's R and T at every angle, but a cosine's shape for all that has been inside: the walk's
  leans forward and falls off toward grazing, as Figures 1 and 4 show.
- **Polarisation** is left out: Fresnel's formulas are for unpolarised light at every interface.
- **Neither is reciprocal**, see above.
""")


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--quick", action="store_true")
    report = Report(parser.parse_args().quick)
    report.add(f"""
# Validation

Made by `scripts/validation`{' --quick' if report.quick else ''} from what it measured, on {machine()}.
""")
    for part in (spectra, tables, figures, walks, f_against_sample, reciprocity, weaknesses):
        print(part.__name__, flush=True)
        part(report)
    report.write()


if __name__ == "__main__":
    main()
