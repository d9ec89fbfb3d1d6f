"""Parts of docs/results/validation.md: spectra, tables and walks of the leaf models, and their known errors."""

import io

import numpy
import pandas

import frond

from ..shared import charts
from ..shared.tools import ROOT, frond_table, program_csv, rms, table
from .report import LEAVES, RGB


def spectrum(leaf, sieve):
    """R and T of both sides at 8 degrees, by angle and wavelength."""
    found = program_csv("table", "--specimen", leaf, f"sieve={'true' if sieve else 'false'}", "--wavelengths", "400:2500:10",
                        "--angles", "8,172", "-q", "-o", "-").set_index(["theta_deg", "wavelength_nm"]).sort_index()
    return found.assign(R=found.Rs + found.Rd)[["R", "T"]]


def measured_leaf():
    """LOPEX93, mean and range of five soybean leaves, by wavelength."""
    return pandas.read_csv(ROOT / "tests" / "reference" / "lopex93_soybean.csv", comment="#").set_index("wavelength_nm")


def spectra(report):
    report.add("""
## Spectra, 400 to 2500 nm

Reflectance R and transmittance T at 8° from the normal, solved every 10 nm with the optical constants of Baranoski (2006). R is
drawn from below and T from above; the part between the curves is absorbed. Grey: mean and range of five soybean leaves (LOPEX93,
Hosgood et al. 1994), which have their own thickness and chemistry; no parameter of the model was fitted to them. "Sieve" is the
later form of Beer's law (Baranoski and Eng 2007).
""")
    lopex = measured_leaf()
    figures = []
    for leaf in LEAVES:
        curves = {sieve: spectrum(leaf, sieve) for sieve in (False, True)}
        draw_spectra(report, leaf, curves, lopex)
        for sieve, curve in curves.items():
            if leaf != "soybean":
                continue
            for theta, side in ((8, "adaxial"), (172, "abaxial")):
                off = curve.loc[theta].join(lopex, how="right")
                cells = [leaf, side, "on" if sieve else "off"]
                for low, high in ((400, 700), (700, 1300), (1300, 2500)):
                    cells += [f"{rms(off[name].loc[low:high] - off[f'{name}_mean'].loc[low:high]):.3f}" for name in "RT"]
                figures.append(cells)
    report.add("RMS difference from the measured soybean leaves in three wavelength ranges (nm):\n")
    report.add(table(["leaf", "side", "sieve", "R 400-700", "T 400-700", "R 700-1300", "T 700-1300", "R 1300-2500",
                      "T 1300-2500"], figures))


def draw_spectra(report, leaf, curves, lopex):
    of, [[panel]] = charts.figure(900, 660)
    if leaf == "soybean":
        panel.fill_between(lopex.index, lopex.R_min, lopex.R_max, color="#d0d0d0", label="LOPEX93 soybean, range")
        panel.fill_between(lopex.index, 1 - lopex.T_max, 1 - lopex.T_min, color="#d0d0d0")
        panel.plot(lopex.index, lopex.R_mean, color="#808080", label="LOPEX93 soybean, mean")
        panel.plot(lopex.index, 1 - lopex.T_mean, color="#808080")
    for sieve, curve in curves.items():
        for color, theta, side in zip(charts.COLORS[1:], (8, 172), ("adaxial", "abaxial")):
            at = curve.loc[theta]
            style = {"color": color, "linestyle": "--" if sieve else "-"}
            panel.plot(at.index, at.R, label=side + (", sieve" if sieve else ""), **style)
            panel.plot(at.index, 1 - at["T"], **style)
    panel.set(title=f"{leaf}, light at 8°", xlabel="wavelength (nm)", ylabel="reflectance R", xlim=(400, 2500), ylim=(0, 1))
    panel.secondary_yaxis("right", functions=(lambda y: 1 - y, lambda y: 1 - y)).set_ylabel("transmittance T")
    charts.legend(of, panel, 3)
    report.chart(f"spectra-{leaf}", f"R and 1 - T of {leaf}", of)


TABLE_ANGLES = "0:90:15,105:180:15"


def timed_table(leaf, *options):
    """Rd and T of a table, and its CPU time without the start of the program."""
    text, seconds, _ = frond_table("--specimen", leaf, "--wavelengths", "608,551,455", "--angles", TABLE_ANGLES, "--threads", "1",
                                   *options)
    return pandas.read_csv(io.StringIO(text), comment="#").set_index(["theta_deg", "wavelength_nm"])[["Rd", "T"]], seconds


def tables(report):
    report.add("""
## The table: solved against sampled

Rd and T of the leaf table by both methods, at 13 angles of incidence on both sides and 608, 551 and 455 nm. The reference is the
solution with 40 nodes per segment. Monte Carlo is the paper's method: analog walks, here with the batched kernel.
""")
    body, (of, [[panel]]) = [], charts.figure(900, 580)
    for color, leaf in zip(charts.COLORS[1:], LEAVES):
        exact, _ = timed_table(leaf, "--method", "solve", "--nodes", 40)
        ways = {"Monte Carlo": [(f"Monte Carlo, {rays:.0e} rays", "--method", "montecarlo", "--rays", f"{rays:.0e}")
                                for rays in ((1e3, 1e4, 1e5) if report.quick else (1e3, 1e4, 1e5, 1e6, 1e7))],
                "solved": [(f"solve, {nodes} nodes", "--method", "solve", "--nodes", nodes) for nodes in (3, 4, 6, 8, 12, 16, 24)]}
        for line, (way, methods) in zip(("o-", "s--"), ways.items()):
            points = []
            for name, *options in methods:
                values, seconds = timed_table(leaf, *options)
                off = values - exact
                points.append((seconds, rms(off)))
                body.append([leaf, name, f"{seconds:.3g}", f"{rms(off):.1e}", f"{abs(off).max(axis=None):.1e}"])
            panel.loglog(*zip(*points), line, color=color, label=f"{leaf}, {way}")
    panel.set(title="Table of 13 angles, three wavelengths", xlabel="CPU time (s)", ylabel="RMS error of Rd and T", ylim=(1e-11, 0.1))
    charts.legend(of, panel, 4)
    report.chart("table-error", "Error of the table against CPU time", of)
    report.add(table(["leaf", "method", "CPU time, s", "RMS error", "largest error"], body))


class Modes:
    """A mode table of `frond table leaf_solved`: cells and, by wavelength, index and modes `[side][way][m][sin i][sin o]`."""

    def __init__(self, leaf, nm, more, *options):
        text, self.seconds, said = frond_table(f"leaf_solved,specimen={leaf},{more}", "--wavelengths", nm, "--threads", 1, *options)
        self.kilobytes = int(said.split(" kB in a render")[0].split()[-1])
        lines = [line for line in text.splitlines() if not line.startswith("#")]
        self.cells, at, self.columns = int(lines[0].split()[1]), 2, []
        while at < len(lines):
            index, series, at = float(lines[at].split()[3]), [], at + 1
            for _ in range(4):
                count, first = int(lines[at].split()[3]), at + 1
                at = first + count * (self.cells + 2)
                series.append(numpy.loadtxt(lines[first:at], ndmin=2).reshape(count, self.cells + 2, self.cells + 2))
            self.columns.append((index, series))

    def counts(self):
        """Largest numbers of modes of reflected and of transmitted light."""
        return [max(len(series[k]) for _, series in self.columns for k in ways) for ways in ((0, 2), (1, 3))]


def passage(sine, index):
    """1 - F and the cosine inside, for directions outside."""
    mu, inside = numpy.sqrt(1 - sine**2), numpy.sqrt(1 - (sine / index) ** 2)
    s, p = (mu - index * inside) / (mu + index * inside), (index * mu - inside) / (index * mu + inside)
    return 1 - (s * s + p * p) / 2, inside


def largest_between(a, b):
    """Largest difference of pi f at the grid's nodes, over azimuths."""
    largest, nodes = 0, a.cells + 1
    for (index, first), (_, second) in zip(a.columns, b.columns):
        through, inside = passage(numpy.arange(nodes) / a.cells, index)
        scale = numpy.pi * numpy.outer(through, through / inside)
        for x, y in zip(first, second):
            difference = numpy.zeros((max(len(x), len(y)), nodes, nodes))
            difference[:len(x)] += x[:, :nodes, :nodes]
            difference[:len(y)] -= y[:, :nodes, :nodes]
            cosines = numpy.cos(numpy.outer(numpy.arange(9) * numpy.pi / 8, numpy.arange(len(difference))))
            largest = max(largest, abs(numpy.tensordot(cosines, difference, 1) * scale).max())
    return largest


def small_patches(leaf, tolerance, step):
    """f over patches of 2 by 10 degrees, light at every `step` degrees on both sides."""
    angles = [*range(0, 89, step), *range(92, 181, step)]
    return frond.goniophotometer(f"leaf_solved,specimen={leaf},tolerance={tolerance}", RGB, angles, patches=(90, 36),
                                 integrate=True)["f"]


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
            off = numpy.pi * (small_patches(leaf, tolerance, step) - exact)
            back, across = table_of.counts()
            tolerance_body.append([leaf, f"{tolerance:g}", table_of.cells, f"{back}, {across}", f"{table_of.seconds:.2g}",
                                   table_of.kilobytes, f"{abs(off).max():.1e}", f"{rms(off):.1e}"])
    report.add("""
## The mode table: error against nodes, cells and time

The mode table of [`leaf_solved`](../leaf_models.md). Errors are those of pi f, which is 1 for white paper; times are CPU times on one
core. The following table has, by the solver's nodes per segment (`frond table leaf_solved --nodes`), the largest difference from 24
nodes over all angles and azimuths, and the time for one wavelength at a tolerance of 1e-5. The default is five nodes.
""")
    report.add(table(["leaf, nm", "3 nodes", "4", "5", "6", "8", "12"], nodes_body))
    report.add(f"""
The following table has, by `"float tolerance"` and at 608, 551 and 455 nm, the difference from a tolerance of 1e-5 over patches of
2° by 10° on the whole sphere, with light at every {step}° on both sides. Modes are the numbers of Fourier terms of reflected and of
transmitted light.
""")
    report.add(table(["leaf", "tolerance", "cells", "modes", "CPU time, s", "kB in a render", "largest error", "RMS error"],
                     tolerance_body))


def measurements(material, angles, wavelengths, rays, **options):
    found = frond.spectrophotometer(material, wavelengths, angles, rays=int(float(rays)), **options)
    return found.set_index(["theta_deg", "wavelength_nm"])


def walks(report):
    rays = report.rays(1e7)
    body = []
    for leaf in LEAVES:
        measured = [measurements(f"abm,specimen={leaf},mode={mode}", (0, 30, 60, 85, 120, 180), (455, 551, 608, 800), rays)
                    for mode in ("analog", "weighted")]
        (a, a_se), (b, b_se) = ((found[["R", "T"]].to_numpy(), found[["R_se", "T_se"]].to_numpy()) for found in measured)
        z = (a - b) / numpy.hypot(a_se, b_se)
        body.append([f"{leaf}: weighted against analog absorption, R and T", f"{rays} rays each", z.size, f"{(z**2).sum():.0f}",
                     f"{abs(z).max():.1f}"])
    # The test records these figures, here with more rays.
    body += [[f"{case['leaf']}: hero walks, {case['absorption']}, light at {case['theta_deg']}°", f"{float(case['rays']):.0e} rays each",
              case["comparisons"], f"{float(case['chi_square']):.0f}", f"{float(case['largest']):.1f}"]
             for case in report.cases_of("test_leaf", "*SpectralWalk.Fills*", FROND_HERO_RAYS="1e5" if report.quick else "3e6")]
    report.add("""
## Walks against walks

Each row compares two methods for the same quantities. The sum of the squared differences in standard errors (chi-square) should be
near the number of comparisons; its own standard deviation is the square root of twice that number.

Hero wavelengths: one walk carries four wavelengths whose refractive indices differ much more than those of leaves (cuticle 1.3 to
1.7). Its counts in detectors on the whole sphere are compared with walks of one wavelength; "wide" is soybean with lobes of
exponent 0.
""")
    report.add(table(["comparison", "effort", "comparisons", "chi-square", "largest, in standard errors"], body))


def f_against_sample(report):
    body = []
    samples = report.rays(1e6).replace("e+0", "e")
    for material in ("abm", "abm,mode=weighted", "abm,specimen=maize", "abm,incident=light", "leaf_solved",
                     "leaf_solved,specimen=maize", "leaf_solved,incident=light", "leaf_simplified",
                     "leaf_simplified,incident=light", "diffusetransmission"):
        for name, law in frond.conform(material, samples=int(float(samples)), given_only=True)["laws"].items():
            if name in ("sampling", "unbiasedness", "energy") and "worst_p" in law:
                p = f"{law['worst_p']:.2g}" if law["tests"] else "–"
                body.append([f"`{material}`", name, int(law["tests"]), p, law["verdict"]])
    report.add(f"""
## `f` against `sample`

The laws of `frond conform`, with {samples} samples for each direction of incidence (0, 30, 60, 80, 89° on both sides), at 608, 551
and 455 nm. *Unbiasedness*: in every bin of the sphere the mean weight of `sample` equals the integral of `f` times the cosine.
*Sampling*: directions are distributed as `pdf`. *Energy*: no more light leaves than arrives. The table has the smallest p-value of
all tests; chance gives about 1 / (number of tests).
""")
    report.add(table(["material", "law", "tests", "smallest p", "verdict"], body))


def black_leaf(*numbers):
    """R of both sides of a soybean leaf with an opaque mesophyll at 450 nm: (adaxial, abaxial)."""
    found = program_csv("table", "--specimen", "soybean", ",".join(("otherabsorption=1e5", *numbers)), "--wavelengths", "450", "--angles",
                        "8,172", "-q", "-o", "-").set_index("theta_deg")
    return (found.Rs + found.Rd)[[8, 172]].to_numpy()


def weaknesses(report):
    lopex = measured_leaf()
    plain, sieve = spectrum("soybean", False), spectrum("soybean", True)
    black = black_leaf()
    report.add(f"""
## Known errors of the models

- **Blue light on the abaxial side.** The abaxial side reflects {plain.R[172, 450]:.3f} at 450 nm; the measured adaxial sides
  reflect {lopex.R_mean[450]:.3f} (LOPEX93 has no abaxial measurements). A ray that enters from below meets the air space behind
  the epidermis, which reflects it before any pigment absorbs it, at every wavelength: a soybean leaf with an opaque mesophyll
  still reflects {black[1]:.3f} from below and {black[0]:.3f} from above. Of the parameters only `epidermisaspect` changes this:
  the value is {black_leaf('spongyaspect=20')[1]:.3f} with `spongyaspect` 20, {black_leaf('epidermisaspect=20')[1]:.3f} with
  `epidermisaspect` 20 and {black_leaf('epidermisaspect=1')[1]:.3f} with 1. No parameters make the abaxial side as dark in the blue
  as the measured adaxial side. The cause is the order of the tissues, which is that of the models' authors. Maize has mesophyll on
  both sides of its air space and is dark from below.
- **No sieve effect and no detours in the plain form of Beer's law.** Pigments are concentrated in chloroplasts, and light is
  deflected between cells. The parameter `sieve` replaces cos θ by cos(cos θ), which is a fitted formula and not a path length.
  Steep paths then absorb more and flat ones less. For soybean lit from above it is closer to the measured leaves at most
  wavelengths: R at 800 nm is {plain.R[8, 800]:.3f} without and {sieve.R[8, 800]:.3f} with it (measured {lopex.R_mean[800]:.3f}); T
  at 680 nm is {plain['T'][8, 680]:.3f} and {sieve['T'][8, 680]:.3f} ({lopex.T_mean[680]:.3f}). The green peak stays too low: R at
  550 nm is {plain.R[8, 550]:.3f} and {sieve.R[8, 550]:.3f} ({lopex.R_mean[550]:.3f}).
- **Homogeneous tissue.** The models have no veins, hairs or wax bloom. A leaf is uniform unless textures vary its parameters.
- **Shape of `leaf_simplified`.** The model has the walk's R and T at every angle, but scatters subsurface light with a cosine lobe.
  The walk scatters more light forward and less toward grazing angles, as Figures 1 and 4 show.
- **No polarisation.** Fresnel's formulas are for unpolarised light at every interface.
- **No reciprocity**, see [above](#reciprocity).
""")
