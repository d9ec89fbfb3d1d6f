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

    def write(self, renewed):
        """`renewed`: what was measured takes the place of sections of the same title in the page that there is."""
        path = self.folder / "validation.md"
        text = "\n".join(self.parts)
        if renewed:
            sections = dict((s.split("\n", 1)[0], s) for s in re.split(r"^(?=## )", path.read_text(), flags=re.M))
            for section in filter(None, re.split(r"^(?=## )", text, flags=re.M)):
                title = section.split("\n", 1)[0]
                if title not in sections:
                    raise SystemExit(f"{path} has no section {title!r}: measure all of it")
                sections[title] = section.rstrip("\n") + "\n\n"
            text = "".join(sections.values()).rstrip("\n") + "\n"
        path.write_text(text)
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

Rd and T by both methods, at 13 angles of incidence on both sides and 608, 551 and 455 nm. The reference is the
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


# --- The table of modes ----------------------------------------------------------------------------------------------


class Modes:
    """What `frond table leaf_solved` writes: cells and, by wavelength, index and modes [side][way][m][sin i][sin o]."""

    def __init__(self, leaf, nm, *options):
        words = [FROND, "table", "leaf_solved", f"specimen={leaf}", "--wavelengths", nm, "--threads", 1, "-o", "-", *options]
        done = subprocess.run([str(w) for w in words], capture_output=True, text=True, check=True)
        self.seconds = float(re.search(r"([0-9.e+-]+) s of CPU", done.stderr).group(1))
        self.kilobytes = int(re.search(r"([0-9]+) kB in a render", done.stderr).group(1))
        lines = [line.split() for line in done.stdout.splitlines() if not line.startswith("#")]
        self.cells, at, self.columns = int(lines[0][1]), 2, []
        while at < len(lines):
            index, series = float(lines[at][3]), []
            at += 1
            for _ in range(4):
                count, at = int(lines[at][3]), at + 1
                grids = [lines[at + m * (self.cells + 2):at + (m + 1) * (self.cells + 2)] for m in range(count)]
                series.append([[[float(x) for x in row] for row in grid] for grid in grids])
                at += count * (self.cells + 2)
            self.columns.append((index, series))

    def counts(self):
        """Most modes that light takes that comes back, and that crosses."""
        return [max(len(series[k]) for _, series in self.columns for k in ways) for ways in ((0, 2), (1, 3))]


def passage(sine, index):
    """1 - F and the cosine inside, of a direction outside."""
    mu, inside = math.sqrt(1 - sine * sine), math.sqrt(1 - (sine / index) ** 2)
    s, p = (mu - index * inside) / (mu + index * inside), (index * mu - inside) / (index * mu + inside)
    return 1 - (s * s + p * p) / 2, inside


def largest_between(a, b):
    """Largest difference of pi f at the grid's nodes, over azimuths."""
    largest = 0
    for (index, first), (_, second) in zip(a.columns, b.columns):
        through = [passage(i / a.cells, index) for i in range(a.cells + 1)]
        for x, y in zip(first, second):
            none = [[0] * (a.cells + 2)] * (a.cells + 2)
            differences = [(x[m] if m < len(x) else none, y[m] if m < len(y) else none) for m in range(max(len(x), len(y)))]
            for i in range(a.cells + 1):
                for o in range(a.cells + 1):
                    d = [p[i][o] - q[i][o] for p, q in differences]
                    scale = math.pi * through[i][0] * through[o][0] / through[o][1]
                    for k in range(9):
                        f = sum(x * math.cos(m * k * math.pi / 8) for m, x in enumerate(d))
                        largest = max(largest, abs(f) * scale)
    return largest


def small_patches(leaf, tolerance, step):
    """f over patches of 2 by 10 degrees, light at every `step` degrees on both sides."""
    text = frond("goniophotometer", "leaf_solved", f"specimen={leaf}", f"tolerance={tolerance}", "--integrate", "--angles",
                 f"0:88:{step},92:180:{step}", "--wavelengths", "608,551,455", "--patches", "90x36", "--csv", "-", "-q")
    return [p["f_per_sr"] for p in rows(text)]


def modes(report):
    nodes_body, tolerance_body = [], []
    step = 44 if report.quick else 8
    for leaf in LEAVES:
        for nm in (455, 551, 800):
            finest = Modes(leaf, nm, "tolerance=1e-5", "--nodes", 24)
            cells = []
            for nodes in (3, 4, 5, 6, 8, 12):
                some = Modes(leaf, nm, "tolerance=1e-5", "--nodes", nodes)
                cells.append(f"{largest_between(some, finest):.0e}, {1000 * some.seconds:.0f} ms")
            nodes_body.append([f"{leaf}, {nm}"] + cells)
        exact = small_patches(leaf, 1e-5, step)
        for tolerance in (1e-1, 1e-2, 2e-3, 5e-4, 1e-4):
            table_of = Modes(leaf, "608,551,455", f"tolerance={tolerance}")
            off = [math.pi * (x - y) for x, y in zip(small_patches(leaf, tolerance, step), exact)]
            back, across = table_of.counts()
            tolerance_body.append([leaf, f"{tolerance:g}", table_of.cells, f"{back}, {across}", f"{table_of.seconds:.2g}",
                                   table_of.kilobytes, f"{max(map(abs, off)):.1e}", f"{rms(off):.1e}"])
    report.add("""
## The table of modes: error against nodes, cells, modes and time

Of `leaf_solved` (docs/solved_leaf.md); errors are of pi f, which is 1 for white paper; times are CPU times of one core. By
the solver's nodes a segment (`frond table leaf_solved --nodes`), the largest difference from 24 nodes over all angles and
azimuths, and the time for one wavelength at a tolerance of 1e-5; five nodes are the default here:
""")
    report.add(table(["leaf, nm", "3 nodes", "4", "5", "6", "8", "12"], nodes_body))
    report.add(f"""
By `"float tolerance"`, at 608, 551 and 455 nm, the difference from a tolerance of 1e-5 over patches of 2° by 10° all around,
light at every {step}° on both sides; modes are those of light that comes back and of light that crosses:
""")
    report.add(table(["leaf", "tolerance", "cells", "modes", "CPU s", "kB in a render", "largest error", "RMS error"],
                     tolerance_body))


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
    for material in ("abm", "abm mode=weighted", "abm specimen=maize", "abm incident=light", "leaf_solved",
                     "leaf_solved specimen=maize", "leaf_solved incident=light", "leaf_simplified",
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


# --- The solution against walks --------------------------------------------------------------------------------------

CHART_ANGLES = {"adaxial": (0, 30, 45, 60, 80), "abaxial": (180, 150, 135, 120, 100)}


def solution(report):
    rays = report.rays(1e8)
    cases = patch_cases(report, rays)
    squares, freedom, default = (sum(number(c[k]) for c in cases) for k in ("chi_square", "freedom", "default_chi_square"))
    worst, default_worst = (max(number(c[k]) for c in cases) for k in ("largest", "default_largest"))
    report.add(f"""
## The solution against walks

`leaf_solved` is what `abm` converges to (docs/solved_leaf.md). Here f is integrated over each of 20 x 40 patches and set
beside the rays that the goniophotometer of `abm` catches there, analog and in single precision: nothing is left but the
noise of the walks, whose variance the solution tells too. At 30, 60 and 80° on both sides, four wavelengths, both leaves,
{rays} rays each, and ten times as many at one setting of each leaf. The solution is at a tolerance of 1e-5.

Counts are multinomial: one chi-square a run, over the patches (pooled until they expect 5 rays) and the rays that were
absorbed, and the patch that is furthest off, by its exact binomial chance as standard errors of a normal variable. With
other seeds a sound program would have a chi-square beyond the test's limit in 1 % of 48 runs, and a patch of
{len(cases) - 2} x 800 beyond 5.2 standard errors in 0.8 %. L2: relative difference of f over the sphere, and what the walks'
noise alone makes of it. What the solution or the walk's single precision had wrong would grow with the rays.

All {len(cases)} runs together: chi-square {squares:.0f} of {freedom:.0f} ({(squares - freedom) / math.sqrt(2 * freedom):+.1f} standard
deviations), the furthest patch {worst:.1f} standard errors off. The table of the default tolerance, 5e-4:
{default:.0f} ({(default - freedom) / math.sqrt(2 * freedom):+.1f}) and {default_worst:.1f}.
""")
    report.add(table(["leaf", "light at", "nm", "rays", "degrees of freedom", "chi-square", "p", "furthest patch", "L2",
                      "of noise", "chi-square of the default table"],
                     [[c["leaf"], c["theta_deg"] + "°", c["nm"], c["rays"], c["freedom"], f"{number(c['chi_square']):.0f}",
                       f"{number(c['p']):.2g}", f"{number(c['largest']):.1f}", f"{100 * number(c['l2']):.2f} %",
                       f"{100 * number(c['l2_noise']):.2f} %", f"{number(c['default_chi_square']):.0f}"] for c in cases]))
    chart_rays = report.rays(1e6)
    report.add(f"""
In the plane of incidence: lines are `leaf_solved`, integrated over the patches, points `abm` by {chart_rays} rays. Bars are
one standard error; below each panel stand the differences in standard errors. These are estimated from the rays caught,
and come out too small where those are few: the largest differences are negative.
""")
    for leaf in LEAVES:
        for side, angles in CHART_ANGLES.items():
            plane_chart(report, leaf, side, angles, chart_rays)


def patch_cases(report, rays):
    """The test's own figures."""
    path = report.folder / "patches.json"
    run("env", "FROND_SLOW_TESTS=1", f"FROND_PATCH_RAYS={rays}", BUILD / "tests" / "test_instruments",
        "--gtest_filter=*SolvedLeafAgainst*", f"--gtest_output=json:{path}")
    found = json.loads(path.read_text())
    path.unlink()
    return [case for suite in found["testsuites"] for case in suite["testsuite"]]


def in_plane(patches, reflected):
    """(angle, f, standard error, f without noise) from the light's side to the other one."""
    points = []
    for p in patches:
        if p["phi_deg"] not in (0, 180) or (p["kind"] == "BRDF") != reflected:
            continue
        from_normal = min(p["theta_deg"], 180 - p["theta_deg"])
        points.append((-from_normal if p["phi_deg"] == 0 else from_normal, p["f_per_sr"], p["f_se"]))
    return sorted(points)


def plane_chart(report, leaf, side, angles, rays):
    text = frond("goniophotometer", "leaf_solved", f"specimen={leaf}", "--with", f"abm specimen={leaf}", "--integrate",
                 "--angles", ",".join(map(str, angles)), "--wavelengths", ",".join(map(str, RGB)), "--rays", rays, "-q",
                 "--csv", "-")
    readings = {}
    for p in rows(text):
        readings.setdefault((p["material"].split()[0], p["incidence_deg"], p["wavelength_nm"]), []).append(p)
    data, panels = "", ""
    for row, reflected in enumerate((True, False)):
        for column, angle in enumerate(angles):
            plots, residuals = [], []
            for i, nm in enumerate(RGB):
                solved = in_plane(readings["leaf_solved", angle, nm], reflected)
                walked = in_plane(readings["abm", angle, nm], reflected)
                name, color = f"p{row}{column}{i}", COLORS[(2, 3, 1)[i]]
                data += block("s" + name, [(x, f) for x, f, _ in solved])
                data += block("w" + name, [(x, f, se, (f - g) / se if se > 0 else 0)
                                           for (x, f, se), (_, g, _) in zip(walked, solved)])
                mark = f"pt {(6, 4, 8)[i]} ps 0.5 lc rgb '{color}' notitle"
                plots += [f"$s{name} with lines lw 1.5 lc rgb '{color}' notitle", f"$w{name} with points {mark}",
                          f"$w{name} using 1:(bottom($2, $3)):(0):($2 + $3 - bottom($2, $3)) with vectors nohead lw 1.5 "
                          f"lc rgb '{color}' notitle"]
                residuals.append(f"$w{name} using 1:4 with points {mark}")
            panels += plane_panel(row, column, angle, len(angles), plots, residuals)
    key = ", ".join(f"NaN with linespoints pt {(6, 4, 8)[i]} ps 0.6 lw 1.5 lc rgb '{COLORS[(2, 3, 1)[i]]}' title '{nm} nm'"
                    for i, nm in enumerate(RGB))
    report.chart(f"solved-{leaf}-{side}", f"f in the plane of incidence, {leaf}, {side} side lit", data + f"""
bottom(f, se) = f > se ? f - se : 1e-6
set multiplot
set xrange [-90:90]
set xtics -60,30,60 format ''
unset key
{panels}
set origin 0,0
set size 1,0.05
set lmargin 0
set rmargin 0
set tmargin 0
set bmargin 0
unset title
unset xlabel
unset ylabel
unset tics
unset border
unset grid
unset object
set yrange [0:1]
set key at graph 0.5,0.5 center horizontal nobox samplen 3 width 4
plot {key}
unset multiplot
""", (1500, 900))


def plane_panel(row, column, angle, columns, plots, residuals):
    """One of R or T at one angle, with its differences below."""
    margin, width, top, height, low = 0.055, 0.936 / columns, 0.955 - row * 0.425, 0.265, 0.08
    left, right = margin + column * width, margin + (column + 0.93) * width
    first = column == 0
    from_normal = min(angle, 180 - angle)
    scale = "set logscale y\nset yrange [1e-4:20]\nset ytics 10 format '10^{%L}'" if row == 0 else \
        "unset logscale y\nset yrange [0:0.07]\nset ytics 0.02 format '%g'"
    if not first:
        scale += "\nset format y ''"
    title = f"light at {angle}°" if row == 0 else ""
    label = ("BRDF (sr^{-1})", "BTDF (sr^{-1})")[row] if first else ""
    return f"""
set lmargin at screen {left}
set rmargin at screen {right}
set tmargin at screen {top}
set bmargin at screen {top - height}
set title '{title}' offset 0,-0.5
set ylabel '{label}' offset 0.5 font ',14'
{scale}
set format x ''
unset xlabel
unset object
plot {', '.join(plots)}
set tmargin at screen {top - height - 0.012}
set bmargin at screen {top - height - 0.012 - low}
unset title
unset logscale y
set yrange [-6.5:6.5]
set ytics -4,4,4 format {"'%g'" if first else "''"}
set ylabel '{"difference / s.e." if first else ""}' font ',11' offset 0.5
set object 1 rectangle from graph 0, first -1 to graph 1, first 1 fc rgb '#e8e8e8' fs solid noborder behind
set format x '%g'
set xlabel '{"angle from the normal (°), light’s side negative" if row == 1 and column == columns // 2 else ""}'
plot {', '.join(residuals)}
"""


# --- Reciprocity -----------------------------------------------------------------------------------------------------


def brdf(material, theta, nm, *options):
    text = frond("goniophotometer", *material.split(), "--angle", theta, "--wavelengths", nm, "--csv", "-", "-q", *options)
    return rows(text)


def around_azimuth(patches, theta):
    """Mean over azimuth of f toward theta, and its standard error."""
    ring = [p for p in patches if p["theta_min_deg"] <= theta < p["theta_max_deg"]]
    return sum(p["f_per_sr"] for p in ring) / len(ring), math.sqrt(sum(p["f_se"] ** 2 for p in ring)) / len(ring)


def ratios(material, nm, a, b, *options):
    """f(a->b) / f(b->a) and its standard error, reflected and transmitted, as means over rings."""
    there, back, below = (brdf(material, theta, nm, "--patches", "36x36", *options) for theta in (a, b, 180 - b))
    result = []
    for forth, returned in ((around_azimuth(there, b), around_azimuth(back, a)),
                            (around_azimuth(there, 180 - b), around_azimuth(below, a))):
        ratio = forth[0] / returned[0]
        result.append((ratio, ratio * math.hypot(forth[1] / forth[0], returned[1] / returned[0])))
    return result


def reciprocity(report):
    rays = report.rays(3e7)
    a, b = 12.5, 72.5
    body = []
    for leaf in LEAVES:
        body += defect_rows(f"abm specimen={leaf}", f"leaf_solved specimen={leaf}", a, b, rays)
        body += defect_rows(f"leaf_simplified specimen={leaf}", f"leaf_simplified specimen={leaf}", a, b, rays)
    body += defect_rows("diffusetransmission", "diffusetransmission", a, b, rays)
    report.add(f"""
## Reciprocity

Neither leaf model is reciprocal: light that goes from a to b and light that goes from b to a are not scattered alike.
The table has f(a to b) / f(b to a) at 800 nm for light that the model calls incident at {a}° and leaves at {b}° from the
normal, on the adaxial side or (transmission) the abaxial one. 1 would be reciprocal. Means over azimuth are those of rings
5° wide, computed from f, for `abm` by its solution, and beside it as rays measure them ({rays} of them). In the plane of
incidence f is that of patches 1° by 5°.
""")
    report.add(table(["material", "", "mean over azimuth, computed", "by rays", "in the plane, straight on",
                      "in the plane, back"], body))
    defect_chart(report)
    lossless(report)
    pictures(report)


def defect_rows(material, closed_form, a, b, rays):
    computed = ratios(closed_form, 800, a, b, "--integrate")
    sampled = ratios(material, 800, a, b, "--rays", rays)
    fine = PlaneOfPatches(closed_form, 800, (a, b, 180 - b))
    body = []
    for i, (way, far) in enumerate((("reflection", b), ("transmission", 180 - b))):
        plane = [fine.f(a, far, phi) / fine.f(far, a, phi) for phi in (180, 0)]
        body.append([f"`{material}`", way, f"{computed[i][0]:.4f}", f"{sampled[i][0]:.3f} ± {sampled[i][1]:.3f}"] +
                    [f"{x:.4f}" for x in plane])
    return body


class PlaneOfPatches:
    """f of a closed form at some angles of incidence toward every degree, in and around the plane of incidence."""

    def __init__(self, material, nm, angles):
        words = ",".join(map(str, angles))
        self.patches = {}
        text = frond("goniophotometer", *material.split(), "--angles", words, "--wavelengths", nm, "--patches", "180x72",
                     "--integrate", "--csv", "-", "-q")
        for p in rows(text):
            self.patches[p["incidence_deg"], p["theta_deg"], p["phi_deg"]] = p["f_per_sr"]

    def f(self, theta_i, theta_o, phi):
        return self.patches[theta_i, theta_o, phi]

    def mean(self, theta_i, theta_o):
        return sum(self.f(theta_i, theta_o, 5 * k) for k in range(72)) / 72


def defect_chart(report):
    """Against both angles: how far f is from its reverse."""
    angles = [2.5 + 5 * k for k in range(18)]
    data, panels = "", ""
    for row, leaf in enumerate(LEAVES):
        f = PlaneOfPatches(f"leaf_solved specimen={leaf}", 800, angles + [180 - x for x in angles])
        for column, (title, side) in enumerate((("reflected, adaxial side", lambda x: (x, x)),
                                                ("reflected, abaxial side", lambda x: (180 - x, 180 - x)),
                                                ("transmitted, adaxial to abaxial", lambda x: (x, 180 - x)))):
            plots = []
            for i, a in enumerate((2.5, 32.5, 57.5, 82.5)):
                name = f"d{row}{column}{i}"
                pairs = [(b, side(a)[0], side(b)[1]) for b in angles]
                data += block(name, [(b, f.mean(x, y) / f.mean(y, x)) for b, x, y in pairs])
                plots.append(f"${name} with linespoints pt {(7, 5, 9, 13)[i]} ps 0.4 lw 1.5 lc rgb '{COLORS[i + (i > 2)]}' "
                             f"title 'a = {a}°'")
            panels += f"""
set title '{leaf}, {title}'
{'set ylabel "f(a to b) / f(b to a)"' if column == 0 else 'unset ylabel'}
{'set xlabel "b (° from the normal)"' if row == 1 else 'unset xlabel'}
{'set key top left nobox samplen 1.5' if (row, column) == (0, 2) else 'unset key'}
plot {', '.join(plots)}
"""
    report.add("""
The same against both angles, as means over azimuth, computed at 800 nm. Surface and body together:
""")
    report.chart("reciprocity", "f(a to b) / f(b to a) by both angles", data + f"""
set multiplot layout 2,3
set logscale y 2
set xrange [0:90]
set yrange [0.6:1.8]
set ytics (0.6, 0.7, 0.8, 0.9, 1, 1.2, 1.4, 1.6)
set xtics 30
{panels}
unset multiplot
""", (1200, 760))


def lossless(report):
    """What a leaf that absorbs nothing sends back of light from one direction, as a render shows it."""
    angles, body = "5,30,60,75,85", []
    leaf = "specimen=soybean mesophyllfraction=0"
    for incident in ("traced", "light"):
        r = readings(f"abm {leaf} incident={incident}", angles, 551, report.rays(1e7), "--rendered")
        body.append(["`abm`, by rays", incident] + [f"{x['R'] + x['T']:.4f} ± {x['A_se']:.4f}" for x in r.values()])
    for material in ("leaf_solved", "leaf_simplified"):
        for incident in ("traced", "light"):
            sums = {}
            for p in rows(frond("goniophotometer", material, *leaf.split(), f"incident={incident}", "--angles", angles,
                                "--wavelengths", 551, "--rendered", "--integrate", "--csv", "-", "-q")):
                sums[p["incidence_deg"]] = sums.get(p["incidence_deg"], 0) + p["f_per_sr"] * p["projected_solid_angle_sr"]
            body.append([f"`{material}`, integrated", incident] + [f"{x:.4f}" for x in sums.values()])
    report.add("""
A leaf that absorbs nothing, lit by distant light and looked at from all around, should give back all of it. What a
render shows of it (light along wi, detectors along wo; `frond spectrophotometer --rendered`, and `frond goniophotometer
--rendered --integrate` where f is no random estimate):
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


PARTS = (spectra, tables, modes, figures, walks, solution, f_against_sample, reciprocity, weaknesses)


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--quick", action="store_true")
    parser.add_argument("--only", metavar="PART", nargs="+", choices=[part.__name__ for part in PARTS], default=[],
                        help="measure these parts anew and leave the others as they are")
    options = parser.parse_args()
    report = Report(options.quick)
    if not options.only:
        report.add(f"""
# Validation

Made by `scripts/validation`{' --quick' if report.quick else ''} from what it measured, on {machine()}.
""")
    for part in PARTS:
        if options.only and part.__name__ not in options.only:
            continue
        print(part.__name__, flush=True)
        part(report)
    report.write(renewed=bool(options.only))


if __name__ == "__main__":
    main()
