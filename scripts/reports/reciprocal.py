"""The reciprocal leaf beside the model that it is made of: docs/reciprocal_leaf.md."""

import argparse
import json
import math
import pathlib
import re
import statistics
import tempfile

import exr
from tools import COLORS, ROOT, block, frond, gnuplot, machine, rows, table

LEAVES = ("soybean", "maize")
CONVENTIONS = ("traced", "light", "reciprocal")
SCENES = {"front": "front lit", "back": "back lit", "ambient": "ambient light"}

INTRODUCTION = """# A reciprocal leaf

Written by `scripts/reciprocal`. {machine}

The random walk through a leaf is not reciprocal: light that goes from a to b and light that goes from b to a are not
scattered alike ([how far](validation.md#reciprocity)). A renderer has to choose which direction it calls incident, and
either choice costs something: `"string incident" "traced"`, as published, does not conserve energy in a picture, and
`"light"` conserves it, but its samples have weights without bound where a path looks along a leaf. Neither can be
followed from the light and from the camera alike.

`"string incident" "reciprocal"` is a third: the leaf nearest to the model that gives back what it takes. `leaf_solved`,
`leaf_simplified`, `leaf_lambert` and `leaf` have it; `abm` has not, since a walk knows nothing of the way back.
`frond brf` and `frond flux` take it where the scene says nothing; leaves by `abm` take `light` there.

| `incident` | reciprocal | energy kept in a picture | weights of samples | published |
|---|---|---|---|---|
| `traced` | no | no | bounded | yes, and the default of `frond render` |
| `light` | no | yes | not bounded toward grazing views | no |
| `reciprocal` | yes | yes | bounded | no |

## How it is made

**Light that has been inside.** With f(i, o) the model's BSDF for light from i to o, directions on both sides of the leaf,

    f_r(i, o) = d(i) (f(i, o) + f(o, i)) / 2 d(o),

where d is a positive number for each direction, such that every direction gives back as much light as before:

    ∫ f_r(i, o) |cos θo| dωo = ∫ f(i, o) |cos θo| dωo = Rd(i) + T(i).

A symmetric matrix with positive entries can be scaled so in one way (Sinkhorn 1964), and the repetition
d ← √(d (Rd + T) / (S d)), S the integral above without d(i), finds it; at the start d is 1. By the solved leaf's series
([solved_leaf.md](solved_leaf.md)) f has the factors (1 − F(i)) (1 − F(o)), which are reciprocal, and 1 / μo', which is not;
d depends on the angle to the normal alone, so mode 0 gives it, and then every mode is scaled alike:

    h_r,m(i, o) = d(i) (h_m(i, o) / μo' + h_m(o, i) / μi') / 2 d(o),   f_r = (1 − F(i)) (1 − F(o)) Σ h_r,m cos mφ.

The nodes are those of the table, even in the sine of the angle, both sides in one matrix; the integral takes the table's
cubics exactly. Between the nodes the energy is that of the model to the table's tolerance, which is halved.
The mean of f(i, o) and f(o, i) is the arithmetic one: it is linear, so that series stay series, and tables that are mixed,
for wavelengths that vary and textured chemistry, stay what they are. The geometric mean changes f by as much.

**The surface** is made reciprocal by itself, so that what is reflected there stays Fresnel's share F. With p the lobe about the
mirror direction before the plane cuts it, which is the same both ways round,

    f_r(i, o) = F(i) / I(i) p(i, o) F(o) / I(o),   I(i) = ∫ p(i, o) F(o) / I(o) |cos θo| dωo.

I is smooth in cos θ and not below {least:.2f} for any exponent up to 1,000 and the indices of leaves: a table of 65 cosines, a
cubic in the index of refraction. A cuticle by a texture takes a table over the exponent as well.

**Three lobes.** In `leaf_simplified` f is Rd(i) / π to one side and T(i) / π to the other: the same formula with
f_r = d(i) (Rd(i) + Rd(o)) / 2π d(o), and d follows from six means over angle. Its surface lobe is scaled as above, with the
table's Rs for F. In `leaf_lambert` two numbers are left, and a quadratic equation gives their product.

**Samples** are drawn as from the model: the surface's lobe and a cosine lobe on either side. All weights are bounded,
since 1 / I and (1 − F) h are.
"""


def exposure(material, angles, nm):
    """Sums of f |cos| over patches for light from each angle: reflected and transmitted."""
    sums = {}
    for p in rows(frond("goniophotometer", *material.split(), "--angles", ",".join(map(str, angles)), "--wavelengths", nm,
                        "--patches", "36x36", "--integrate", "--csv", "-", "-q")):
        at = sums.setdefault(p["incidence_deg"], [0, 0])
        other = (p["incidence_deg"] > 90) != (p["theta_deg"] > 90)
        at[other] += p["f_per_sr"] * p["projected_solid_angle_sr"]
    return sums


def shares():
    angles = (0, 30, 60, 80, 100, 120, 150, 180)
    body = []
    for material in ("leaf_solved", "leaf_simplified"):
        for leaf in LEAVES:
            for nm in (551, 800):
                both = [exposure(f"{material} specimen={leaf} incident={i}", angles, nm) for i in ("traced", "reciprocal")]
                for k, name in enumerate("RT"):
                    body.append([f"`{material}`, {leaf}", nm, name] +
                                [f"{both[0][a][k]:.3f}, {both[1][a][k]:.3f}" for a in angles])
    return table(["", "nm", ""] + [f"{a}°" for a in angles], body)


def diffuse_transmittance(leaf, nm, incident):
    """Mean under diffuse light, from above and from below: by Gauss's rule in the cosine."""
    half = [(0.1834346424956498, 0.3626837833783620), (0.5255324099163290, 0.3137066458778873),
            (0.7966664774136267, 0.2223810344533745), (0.9602898564975363, 0.1012285362903763)]
    nodes = [((1 + s * x) / 2, w / 2) for x, w in half for s in (-1, 1)]
    angles = {round(math.degrees(math.acos(mu)), 6): 2 * mu * w for mu, w in nodes}
    result = []
    for below in (False, True):
        at = {round(180 - a, 6) if below else a: w for a, w in angles.items()}
        sums = exposure(f"leaf_solved specimen={leaf} incident={incident}", sorted(at), nm)
        result.append(sum(w * sums[a][1] for a, w in at.items()))
    return result


def energy():
    angles, body = (5, 30, 60, 75, 85, 89), []
    for material in ("leaf_solved", "leaf_simplified", "leaf_lambert"):
        for incident in CONVENTIONS:
            sums = {}
            for p in rows(frond("goniophotometer", material, "specimen=soybean", "mesophyllfraction=0",
                                f"incident={incident}", "--angles", ",".join(map(str, angles)), "--wavelengths", 551,
                                "--rendered", "--integrate", "--csv", "-", "-q")):
                sums[p["incidence_deg"]] = sums.get(p["incidence_deg"], 0) + p["f_per_sr"] * p["projected_solid_angle_sr"]
            body.append([f"`{material}`", incident] + [f"{x:.4f}" for x in sums.values()])
    return table(["", "`incident`"] + [f"{a}°" for a in angles], body)


def patches(leaf, incident, angles, nm):
    result = {}
    for p in rows(frond("goniophotometer", "leaf_solved", f"specimen={leaf}", f"incident={incident}", "--angles",
                        ",".join(map(str, angles)), "--wavelengths", nm, "--patches", "90x72", "--integrate", "--csv", "-",
                        "-q")):
        result[p["incidence_deg"], p["theta_deg"], p["phi_deg"]] = p
    return result


def changes(charts):
    """How far f moves, in the mean, and where."""
    angles, body, data, panels = (5, 30, 60, 75, 175, 150, 120, 105), [], "", ""
    for row, leaf in enumerate(LEAVES):
        for nm in (551, 800):
            before, after = (patches(leaf, incident, angles, nm) for incident in ("traced", "reciprocal"))
            cells = []
            for a in angles:
                square = change = 0
                for key, p in before.items():
                    if key[0] == a:
                        weight = p["projected_solid_angle_sr"]
                        square += weight * p["f_per_sr"]**2
                        change += weight * (after[key]["f_per_sr"] - p["f_per_sr"])**2
                cells.append(f"{100 * math.sqrt(change / square):.1f} %")
            body.append([leaf, nm] + cells)
        column_titles = (("reflected, lit from above", lambda a: (a, False)), ("transmitted from above", lambda a: (a, True)),
                         ("reflected, lit from below", lambda a: (180 - a, False)))
        for column, (title, lit) in enumerate(column_titles):
            plots = []
            for i, a in enumerate((30, 60)):
                incidence, crosses = lit(a)
                for line, (name, source) in enumerate((("model", before), ("reciprocal", after))):
                    points = []
                    for (theta_i, theta, phi), p in source.items():
                        if theta_i != incidence or (theta > 90) != ((incidence > 90) != crosses) or phi not in (0, 180):
                            continue
                        out = min(theta, 180 - theta)
                        points.append((-out if phi == 0 else out, math.pi * p["f_per_sr"]))
                    block_name = f"f{row}{column}{i}{line}"
                    data += block(block_name, sorted(points))
                    plots.append(f"${block_name} with lines lw 2 dt {(2, 1)[line]} lc rgb '{COLORS[1 + i]}' title '{a}°, {name}'")
            panels += f"""
set title '{leaf}, {title}'
{'set ylabel "π f, 800 nm"' if column == 0 else 'unset ylabel'}
{'set xlabel "direction of leaving (°), straight on to the right"' if row == 1 else 'unset xlabel'}
{'set key top left nobox samplen 1.5' if (row, column) == (0, 0) else 'unset key'}
set yrange [0:{0.8 if column == 1 else 2.5}]
plot {', '.join(plots)}
"""
    gnuplot(charts / "shape.svg", data + f"""
set multiplot layout 2,3
set xrange [-90:90]
set xtics 45
{panels}
unset multiplot
""", (1200, 760))
    return table(["", "nm"] + [f"light at {a}°" for a in angles], body)


def small_scene(name, size, folder):
    """A copy of a scene at this resolution, which finds its parts where they are."""
    home = ROOT / "scenes" / f"soybean-{name}"
    text = (home / "scene.pbrt").read_text()
    text = re.sub(r'("integer [xy]resolution") \d+', rf"\1 {size}", text)
    text = re.sub(r'(Include|"string filename") "(?=[^/"]*\.(?:pbrt|ply)")', rf'\1 "{home}/', text)
    path = folder / f"{name}.pbrt"
    path.write_text(text)
    return path


def picture(scene, incident, samples, seed, folder):
    """Row by row the colours, and whether the pixel shows leaves alone."""
    path = folder / "render.exr"
    frond("render", scene, "--wavelengths", "smpte", "--swap", f"leaf=leaf_solved,incident={incident}", "--spp", samples,
          "--seed", seed, "-o", path, "-q")
    return [[(row[c][x], row["leaf"][x] == 1) for c in "RGB" for x in range(len(row["leaf"]))]
            for row in exr.read(path.read_bytes(), ["R", "G", "B", "leaf"])]


def noise(scene, incident, samples, first_seed, folder):
    """Of a render: RMS over its pixels, and their median by what it would be of a normal distribution."""
    a, b = (picture(scene, incident, samples, first_seed + k, folder) for k in (0, 1))
    differences = [abs(x - y) / math.sqrt(2) for i, j in zip(a, b) for (x, leaf), (y, too) in zip(i, j) if leaf and too]
    return math.sqrt(statistics.fmean(d * d for d in differences)), statistics.median(differences) / 0.67449


def noise_table(quick, folder):
    size, samples = (64, 16) if quick else (192, 64)
    body, ratios = [], {}
    for name, title in SCENES.items():
        scene = small_scene(name, size, folder)
        for incident in CONVENTIONS:
            rms, median = noise(scene, incident, samples, 1, folder)
            ratios[name, incident] = rms / median
            body.append([title, incident, f"{rms:.4f}", f"{median:.4f}", f"{rms / median:.2f}",
                         f"{rms / median / ratios[name, 'traced']:.2f}"])
    text = table(["scene", "`incident`", "RMS", "median", "RMS / median", "over that of traced"], body)
    return text, size, samples


def settling(quick, folder, charts):
    """RMS noise times the root of the number of samples: level where the variance settles."""
    size, counts = (48, (4, 16, 64)) if quick else (96, (4, 16, 64, 256, 1024))
    data, plots, body = "", [], []
    for s, name in enumerate(("front", "ambient")):
        scene = small_scene(name, size, folder)
        for c, incident in enumerate(CONVENTIONS):
            points = []
            for n in counts:
                rms, median = noise(scene, incident, n, 11, folder)
                points.append((n, rms * math.sqrt(n), median * math.sqrt(n)))
            body.append([SCENES[name], incident] + [f"{p[1]:.3f}, {p[2]:.3f}" for p in points])
            block_name = f"s{s}{c}"
            data += block(block_name, points)
            plots.append((s, f"${block_name} using 1:2 with linespoints pt 7 ps 0.5 lw 2 lc rgb '{COLORS[1 + c]}' "
                             f"title '{incident}', ${block_name} using 1:3 with lines dt 2 lw 1.5 lc rgb '{COLORS[1 + c]}' "
                             f"notitle"))
    panels = ""
    for s, name in enumerate(("front", "ambient")):
        panels += f"""
set title '{SCENES[name]}'
{'set ylabel "noise × √samples"' if s == 0 else 'unset ylabel'}
{'set key top left nobox samplen 1.5' if s == 0 else 'unset key'}
plot {', '.join(text for which, text in plots if which == s)}
"""
    gnuplot(charts / "settling.svg", data + f"""
set multiplot layout 1,2
set logscale xy
set logscale x 4
set xrange [{counts[0] / 1.5}:{counts[-1] * 1.5}]
set xlabel 'samples a pixel'
{panels}
unset multiplot
""", (1100, 480))
    return table(["scene", "`incident`"] + [f"{n} samples" for n in counts], body), size


def main():
    parser = argparse.ArgumentParser(prog="scripts/reciprocal", description=__doc__)
    parser.add_argument("--quick", action="store_true")
    quick = parser.parse_args().quick
    home = ROOT / "build" / "reciprocal" if quick else ROOT / "docs"
    charts = home / "images" / "reciprocal_leaf"
    with tempfile.TemporaryDirectory() as temporary:
        folder = pathlib.Path(temporary)
        noises, size, samples = noise_table(quick, folder)
        settled, settled_size = settling(quick, folder, charts)
    model_t, leaf_t = (diffuse_transmittance("soybean", 551, incident) for incident in ("traced", "reciprocal"))
    text = INTRODUCTION.format(machine=machine(), least=0.07) + f"""
## What it changes

**R and T** at each angle, the model's and the reciprocal leaf's; above 90° the abaxial side is lit. Their sum stays; what is
transmitted from one side and from the other has to be the same on the whole, and so a little goes from one to the other:

{shares()}
**Shape**: the RMS of f_r − f over that of f, over all directions of leaving by projected solid angle, surface and body:

{changes(charts)}
f in the plane of incidence at 800 nm, for light at 30° and 60° from the normal. Toward grazing the model's f goes beyond the
chart, like 1 / cos θo; the reciprocal leaf's is bounded.

![the model's f and the reciprocal leaf's in the plane of incidence](images/reciprocal_leaf/shape.svg)

**Energy**: what a render shows of a leaf that absorbs nothing, lit from one direction and seen from all around; it should
be 1 (`frond goniophotometer --rendered --integrate`):

{energy()}
## Noise

Of pictures by `leaf_solved` in linear SMPTE-C, white in the light 1: {size} × {size} pixels, {samples} samples each; of
those that show leaves alone the differences of two renders with seeds of their own, over √2. The median is scaled to be the
RMS where all pixels are alike and normally distributed; scenes are not, so the last column has the ratio over that of
`traced`: tails of the estimator, and not the scene's.

{noises}
Does the variance settle? RMS and median of the noise times the root of the number of samples, {settled_size} ×
{settled_size} pixels: both are level where the variance is finite, or fall where low-discrepancy samples do better than that; where it is not
finite the RMS rises, by leaps.

{settled}
![noise times the root of samples against samples; dashed: by the median](images/reciprocal_leaf/settling.svg)

## Limits

- It departs from the published model: use `traced` to reproduce what was published, and the figures of
  [validation.md](validation.md) are of the model. No measured leaf is known here that could tell the two apart: measured
  reflectance factors are reciprocal within their errors, as optics demands of what neither changes wavelength nor rotates
  polarisation, and no cell-level model is.
- T is the same from both sides on the whole (the mean under diffuse light); the model's is not: for soybean at 551 nm it is
  {model_t[0]:.3f} from above and {model_t[1]:.3f} from below, of the reciprocal leaf {leaf_t[0]:.3f} and {leaf_t[1]:.3f}.
- `abm` refuses it: the walk would have to be weighed by the solved leaf's f_r / f, and would then be no check of it.
"""
    home.mkdir(parents=True, exist_ok=True)
    (home / "reciprocal_leaf.md").write_text(text, encoding="utf-8")
    print(f"Written: {home / 'reciprocal_leaf.md'}")


if __name__ == "__main__":
    main()
