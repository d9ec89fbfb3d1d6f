"""How far the leaf models are from reciprocal, and what that does to energy and pictures."""

import json
import math

from tools import BUILD, COLORS, ROOT, block, frond, rows, table
from validation_report import LEAVES
from validation_walks import readings


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

Neither leaf model is reciprocal, and [reciprocal_leaf.md](reciprocal_leaf.md) has what can be done about it: light that goes from a to b and light that goes from b to a are not scattered alike.
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
        for incident in ("traced", "light", "reciprocal"):
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
