"""Parts of docs/results/validation.md: f of the leaf models in the plane of incidence, the solution against walks, reciprocity."""

import pathlib
import tempfile

import numpy

import frond

from ..shared import charts
from ..shared.tools import ROOT, plane_of_incidence, program_json, table
from .leaf import measurements
from .report import LEAVES, RGB


def figures(report):
    rays = report.rays(1e8)
    report.add(f"""
## Figures 1 and 4 of the paper: the BDF in the plane of incidence

Both models for soybean, measured by the goniophotometer with {rays} rays per curve and detectors of 9° by 9°: 20 in the polar angle
and 40 in azimuth, as in the paper. Angles above 90° are transmitted light. Bars are one standard error, mostly smaller than the
lines.
""")
    materials = {name: frond.goniophotometer(f"{name},specimen=soybean", RGB, (30, 45), rays=int(float(rays)))
                 for name in ("abm", "leaf_simplified")}
    for w, nm in enumerate(RGB):
        of, panels = charts.figure(840, 760, 2, 2, sharex=True, sharey="row")
        for i, angle in enumerate((30, 45)):
            for row, below, label in ((0, False, "BRDF (sr⁻¹)"), (1, True, "BTDF (sr⁻¹)")):
                panel = panels[row, i]
                for color, (name, found) in zip(charts.COLORS, materials.items()):
                    x, place = plane_of_incidence(found, below)
                    panel.errorbar(x, found["f"][i, w][place], found["f_se"][i, w][place], color=color, linewidth=1.2, label=name)
                panel.axvline(-angle, color="#808080", linestyle=":", linewidth=1, label="toward the light")
                panel.axvline(angle, color="#808080", linewidth=1, label="mirror direction")
                panel.set(title="" if row else f"light at {angle}°, {nm} nm", ylabel="" if i else label, xticks=range(-90, 91, 30))
                if row:
                    panel.set_xlabel("angle from the normal (°), light’s side negative")
        for row in panels:
            row[0].set_ylim(bottom=0)
        charts.legend(of, panels[0, 0], 4)
        report.chart(f"bdf-{nm}", f"BDF at {nm} nm", of)


def plane_chart(report, leaf, side, angles, rays):
    solved = frond.goniophotometer(f"leaf_solved,specimen={leaf}", RGB, angles, integrate=True)
    walked = frond.goniophotometer(f"abm,specimen={leaf}", RGB, angles, rays=int(float(rays)))
    of, panels = charts.figure(1500, 900, 4, len(angles), sharex=True, sharey="row", height_ratios=(3, 1, 3, 1))
    for column, angle in enumerate(angles):
        for row, reflected in ((0, True), (2, False)):
            panel, below = panels[row:row + 2, column]
            for w, (nm, color, mark) in enumerate(zip(RGB, (charts.COLORS[i] for i in (2, 3, 1)), "os^")):
                x, place = plane_of_incidence(solved, (angle > 90) == reflected)
                f, g, se = (values[column, w][place] for values in (solved["f"], walked["f"], walked["f_se"]))
                panel.plot(x, f, color=color, linewidth=1.3, label=f"{nm} nm, leaf_solved")
                panel.errorbar(x, g, se, fmt=mark, color=color, markersize=3.5, markerfacecolor="none", elinewidth=1, label=f"{nm} nm, abm")
                below.plot(x, numpy.divide(g - f, se, out=numpy.zeros_like(f), where=se > 0), mark, color=color, markersize=3.5,
                           markerfacecolor="none")
            below.axhspan(-1, 1, color="#e8e8e8")
            below.set(ylim=(-6.5, 6.5), yticks=(-4, 0, 4))
            panel.set(yscale="log" if reflected else "linear", ylim=(1e-4, 20) if reflected else (0, 0.07))
        panels[0, column].set(title=f"light at {angle}°", xlim=(-90, 90), xticks=(-60, -30, 0, 30, 60))
    for row, label in enumerate(("BRDF (sr⁻¹)", "difference / s.e.", "BTDF (sr⁻¹)", "difference / s.e.")):
        panels[row, 0].set_ylabel(label, fontsize=10.5 if row % 2 == 0 else 8)
    panels[3, len(angles) // 2].set_xlabel("angle from the normal (°), light’s side negative")
    charts.legend(of, panels[0, 0], 6)
    report.chart(f"solved-{leaf}-{side}", f"f in the plane of incidence, {leaf}, {side} side lit", of)


CHART_ANGLES = {"adaxial": (0, 30, 45, 60, 80), "abaxial": (180, 150, 135, 120, 100)}


def solution(report):
    rays = report.rays(1e8)
    # The test records these figures.
    cases = report.cases_of("test_instruments", "*SolvedLeafAgainst*", FROND_SLOW_TESTS=1, FROND_PATCH_RAYS=rays)
    squares, freedom, default = (sum(float(c[k]) for c in cases) for k in ("chi_square", "freedom", "default_chi_square"))
    worst, default_worst = (max(float(c[k]) for c in cases) for k in ("largest", "default_largest"))
    report.add(f"""
## The solution against walks

[`leaf_solved`](../leaf_models.md) is the BSDF that `abm` converges to. Here its f is integrated over each of 20 x 40 patches and
compared with the rays that the goniophotometer of `abm` (analog, single precision) counts in the patch. The only difference should
be the noise of the walks, whose variance follows from the solution too. Light comes from 30, 60 and 80° on both sides, at four
wavelengths, on both leaves, with {rays} rays each and ten times as many in one case of each leaf. The tolerance of the solution is
1e-5.

Counts are multinomial. Each run has one chi-square over the patches (pooled until 5 rays are expected) and the absorbed rays.
"Furthest patch" is the patch with the smallest exact binomial probability, expressed as standard errors of a normal variable. With
other seeds a correct program would have a chi-square beyond the test's limit in 1 % of 48 runs, and one of {len(cases) - 2} x 800
patches beyond 5.2 standard errors in 0.8 %. L2 is the relative difference of f over the sphere; "of noise" is the value that the
noise of the walks alone gives. An error of the solution or of the walk's single precision would grow with the number of rays.

All {len(cases)} runs together: chi-square {squares:.0f} of {freedom:.0f} ({(squares - freedom) / (2 * freedom)**0.5:+.1f} standard
deviations), furthest patch {worst:.1f} standard errors. With the default tolerance of 5e-4: {default:.0f}
({(default - freedom) / (2 * freedom)**0.5:+.1f}) and {default_worst:.1f}.
""")
    report.add(table(["leaf", "light at", "nm", "rays", "degrees of freedom", "chi-square", "p", "furthest patch", "L2",
                      "of noise", "chi-square, default tolerance"],
                     [[c["leaf"], c["theta_deg"] + "°", c["nm"], c["rays"], c["freedom"], f"{float(c['chi_square']):.0f}",
                       f"{float(c['p']):.2g}", f"{float(c['largest']):.1f}", f"{100 * float(c['l2']):.2f} %",
                       f"{100 * float(c['l2_noise']):.2f} %", f"{float(c['default_chi_square']):.0f}"] for c in cases]))
    chart_rays = report.rays(1e6)
    report.add(f"""
The charts show the plane of incidence: lines are `leaf_solved`, integrated over the patches; points are `abm` with {chart_rays}
rays. Bars are one standard error; below each panel are the differences in standard errors. Standard errors are estimated from the
counted rays and are too small if these are few: the largest differences are negative.
""")
    for leaf in LEAVES:
        for side, angles in CHART_ANGLES.items():
            plane_chart(report, leaf, side, angles, chart_rays)


class Patches:
    """f for light at some angles, as means over patches of the sphere; by default of 5 by 10 degrees."""

    def __init__(self, material, nm, angles, patches=(36, 36), **options):
        self.angles, self.step = list(angles), (180 // patches[0], 360 // patches[1])
        found = frond.goniophotometer(material, nm, self.angles, patches=patches, **options)
        self.values, self.errors = found["f"][:, 0], found["f_se"][:, 0]

    def at(self, theta_i, theta_o):
        return self.angles.index(theta_i), int(theta_o // self.step[0])

    def f(self, theta_i, theta_o, phi):
        return self.values[self.at(theta_i, theta_o)][phi // self.step[1]]

    def mean(self, theta_i, theta_o):
        """Mean over azimuth and its standard error."""
        error = self.errors[self.at(theta_i, theta_o)]
        return self.values[self.at(theta_i, theta_o)].mean(), numpy.linalg.norm(error) / len(error)


def ratios(material, nm, a, b, **options):
    """f(a->b) / f(b->a) and its standard error, reflected and transmitted, as means over rings."""
    rings, result = Patches(material, nm, (a, b, 180 - b), **options), []
    for far in (b, 180 - b):
        (forth, forth_se), (back, back_se) = rings.mean(a, far), rings.mean(far, a)
        result.append((forth / back, forth / back * numpy.hypot(forth_se / forth, back_se / back)))
    return result


def reciprocity(report):
    rays = report.rays(3e7)
    a, b = 12.5, 72.5
    body = []
    for leaf in LEAVES:
        body += defect_rows(f"abm,specimen={leaf}", f"leaf_solved,specimen={leaf}", a, b, rays)
        body += defect_rows(f"leaf_simplified,specimen={leaf}", f"leaf_simplified,specimen={leaf}", a, b, rays)
    body += defect_rows("diffusetransmission", "diffusetransmission", a, b, rays)
    report.add(f"""
## Reciprocity

`abm`, `leaf_solved` and `leaf_simplified` are not reciprocal: f for light from a to b differs from f for light from b to a. [Leaf
models](../leaf_models.md) describes the reciprocal alternative. The table has f(a to b) / f(b to a) at 800 nm for light that is
incident at {a}° and leaves at {b}° from the normal, on the adaxial side or (transmission) on the abaxial side. A reciprocal model
has the value 1. Means over azimuth are means of rings 5° wide, computed from f (for `abm`, from its solution) and measured with
{rays} rays. In the plane of incidence f is the mean of patches of 1° by 5°.
""")
    report.add(table(["material", "", "mean over azimuth, computed", "measured", "in the plane, forward",
                      "in the plane, backward"], body))
    defect_chart(report)
    lossless(report)
    images(report)


def defect_rows(material, closed_form, a, b, rays):
    computed = ratios(closed_form, 800, a, b, integrate=True)
    sampled = ratios(material, 800, a, b, rays=int(float(rays)))
    fine = Patches(closed_form, 800, (a, b, 180 - b), (180, 72), integrate=True)
    body = []
    for i, (way, far) in enumerate((("reflection", b), ("transmission", 180 - b))):
        plane = [fine.f(a, far, phi) / fine.f(far, a, phi) for phi in (180, 0)]
        body.append([f"`{material}`", way, f"{computed[i][0]:.4f}", f"{sampled[i][0]:.3f} ± {sampled[i][1]:.3f}"] +
                    [f"{x:.4f}" for x in plane])
    return body


def defect_chart(report):
    """Chart of f(a to b) / f(b to a) against both angles."""
    angles = [2.5 + 5 * k for k in range(18)]
    of, panels = charts.figure(1200, 780, 2, 3, sharex=True, sharey=True)
    sides = {"reflected, adaxial side": lambda x: (x, x), "reflected, abaxial side": lambda x: (180 - x, 180 - x),
             "transmitted, adaxial to abaxial": lambda x: (x, 180 - x)}
    for row, leaf in zip(panels, LEAVES):
        found = Patches(f"leaf_solved,specimen={leaf}", 800, angles + [180 - x for x in angles], (180, 72), integrate=True)
        for panel, (title, side) in zip(row, sides.items()):
            for mark, color, a in zip("osDv", charts.COLORS, (2.5, 32.5, 57.5, 82.5)):
                pairs = [(side(a)[0], side(b)[1]) for b in angles]
                panel.semilogy(angles, [found.mean(x, y)[0] / found.mean(y, x)[0] for x, y in pairs], f"{mark}-", color=color, markersize=3,
                               linewidth=1.3, label=f"a = {a}°")
            panel.set(title=f"{leaf}, {title}", xlim=(0, 90), ylim=(0.6, 1.8), xticks=range(0, 91, 30))
        row[0].set_ylabel("f(a to b) / f(b to a)")
    charts.plain_ticks(panels[0, 0].yaxis, [0.6, 0.7, 0.8, 0.9, 1, 1.2, 1.4, 1.6])
    panels[1, 1].set_xlabel("b (° from the normal)")
    charts.legend(of, panels[0, 0], 4)
    report.add("""
The same ratio against both angles, as means over azimuth, computed at 800 nm, for surface reflection and subsurface scattering
together:
""")
    report.chart("reciprocity", "f(a to b) / f(b to a) by both angles", of)


def lossless(report):
    """Share of light from one direction that a leaf without absorption scatters, as a render shows it."""
    angles, body = (5, 30, 60, 75, 85), []
    leaf = "specimen=soybean,mesophyllfraction=0"
    for incident in ("traced", "light"):
        r = measurements(f"abm,{leaf},incident={incident}", angles, 551, report.rays(1e7), rendered=True)
        body.append(["`abm`, measured", incident] + [f"{x.R + x['T']:.4f} ± {x.A_se:.4f}" for _, x in r.iterrows()])
    for material in ("leaf_solved", "leaf_simplified"):
        for incident in ("traced", "light", "reciprocal"):
            found = frond.goniophotometer(f"{material},{leaf},incident={incident}", 551, angles, rendered=True, integrate=True)
            sums = (found["f"][:, 0] * found["projected_solid_angle_sr"]).sum(axis=(1, 2))
            body.append([f"`{material}`, integrated", incident] + [f"{x:.4f}" for x in sums])
    report.add("""
A leaf without absorption, lit by distant light and observed from all directions, should scatter all of the light. The table has
the share that a render shows (light along wi, detectors along wo). The commands are `frond spectrophotometer --rendered` and, for
models whose f is not a random estimate, `frond goniophotometer --rendered --integrate`.
""")
    report.add(table(["material", "`incident`"] + [f"light at {a}°" for a in angles], body))


def images(report):
    body = []
    spp = 8 if report.quick else 32
    for scene in ("front", "back", "ambient"):
        with tempfile.TemporaryDirectory() as folder:
            halves = [pathlib.Path(folder) / f"{incident}-{seed}.exr" for incident in ("traced", "light") for seed in (1, 2)]
            for path in halves:
                incident, seed = path.stem.split("-")
                frond.load(ROOT / "scenes" / f"soybean-{scene}" / "scene.pbrt", wavelengths="smpte", seed=int(seed),
                           swap={"leaf": f"leaf_simplified,incident={incident}"}).render(spp).save(path)
            d = program_json("difference", *halves, "--json", "-")
        body.append([scene] + [f"{d['leaf_mean_difference_' + c]:+.4f}" for c in ("red", "green", "blue")] +
                    [f"{d['leaf_bias_' + c]:.4f}" for c in ("red", "green", "blue")])
    report.add(f"""
The same in images: `incident` "traced" minus "light" on leaf pixels of the three scenes, for `leaf_simplified` with
{2 * spp} samples per pixel; a white diffuse surface in the light is 1.
""")
    report.add(table(["scene", "mean, red", "green", "blue", "RMS without noise, red", "green", "blue"], body))
