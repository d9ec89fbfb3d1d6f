"""The reciprocal leaf beside the model that it is made of: docs/reciprocal_leaf.md."""

import pathlib
import tempfile

import numpy

import charts
import frond
from tools import ROOT, arguments, machine, plane_of_incidence, rms, sized, table, write

LEAVES = ("soybean", "maize")
CONVENTIONS = ("traced", "light", "reciprocal")
SCENES = {"front": "front lit", "back": "back lit", "ambient": "ambient light"}

INTRODUCTION = """# A reciprocal leaf

Written by `scripts/reciprocal`. {machine}

The random walk through a leaf is not reciprocal: light that goes from a to b and light that goes from b to a are not
scattered alike ([how far](validation.md#reciprocity)). A renderer has to choose which direction it calls incident, and
either choice costs something: `"string incident" "traced"`, as published, does not conserve energy in an image, and
`"light"` conserves it, but its samples have weights without bound where a path looks along a leaf. Neither can be
followed from the light and from the camera alike.

`"string incident" "reciprocal"` is a third: the reciprocal, energy-conserving BSDF closest to the model. `leaf_solved`,
`leaf_simplified`, `leaf_lambert` and `leaf` have it; `abm` has not, since a walk knows nothing of the way back.
`frond brf` and `frond flux` take it where the scene says nothing; leaves by `abm` take `light` there.

| `incident` | reciprocal | energy kept in an image | weights of samples | published |
|---|---|---|---|---|
| `traced` | no | no | bounded | yes, and the default of `frond render` |
| `light` | no | yes | not bounded toward grazing views | no |
| `reciprocal` | yes | yes | bounded | no |

## How it is made

**Light that has been inside.** With f(i, o) the model's BSDF for light from i to o, directions on both sides of the leaf,

    f_r(i, o) = d(i) (f(i, o) + f(o, i)) / 2 d(o),

where d is a positive number for each direction, such that light from every direction is scattered in the same amount as before:

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
    """Shares of light from each angle: a row of those reflected and one of those transmitted."""
    found = frond.goniophotometer(material, nm, angles, patches=(36, 36), integrate=True)
    shares = found["f"][:, 0] * found["projected_solid_angle_sr"]
    reflected = (found["theta_o_deg"] < 90) == (numpy.array(angles) <= 90)[:, None, None]
    return [(shares * side).sum(axis=(1, 2)) for side in (reflected, ~reflected)]


def shares():
    angles = (0, 30, 60, 80, 100, 120, 150, 180)
    body = []
    for material in ("leaf_solved", "leaf_simplified"):
        for leaf in LEAVES:
            for nm in (551, 800):
                both = [exposure(f"{material} specimen={leaf} incident={i}", angles, nm) for i in ("traced", "reciprocal")]
                for name, model, reciprocal in zip("RT", *both):
                    body.append([f"`{material}`, {leaf}", nm, name, *(f"{x:.3f}, {y:.3f}" for x, y in zip(model, reciprocal))])
    return table(["", "nm", ""] + [f"{a}°" for a in angles], body)


def diffuse_transmittance(leaf, nm, incident):
    """Mean under diffuse light, from above and from below: by Gauss's rule in the cosine."""
    nodes, weights = numpy.polynomial.legendre.leggauss(8)
    cosines = (1 + nodes) / 2
    angles = numpy.degrees(numpy.arccos(cosines))
    material = f"leaf_solved specimen={leaf} incident={incident}"
    return [weights * cosines @ exposure(material, list(side), nm)[1] for side in (angles, 180 - angles)]


def energy():
    angles, body = (5, 30, 60, 75, 85, 89), []
    for material in ("leaf_solved", "leaf_simplified", "leaf_lambert"):
        for incident in CONVENTIONS:
            found = frond.goniophotometer(f"{material} specimen=soybean mesophyllfraction=0 incident={incident}", 551, angles,
                                          rendered=True, integrate=True)
            sums = (found["f"][:, 0] * found["projected_solid_angle_sr"]).sum(axis=(1, 2))
            body.append([f"`{material}`", incident] + [f"{x:.4f}" for x in sums])
    return table(["", "`incident`"] + [f"{a}°" for a in angles], body)


def changes(folder):
    """How far f moves, in the mean, and where."""
    angles, body = (5, 30, 60, 75, 175, 150, 120, 105), []
    of, panels = charts.figure(1200, 760, 2, 3, sharex=True)
    for row, leaf in zip(panels, LEAVES):
        for nm in (551, 800):
            found = {incident: frond.goniophotometer(f"leaf_solved specimen={leaf} incident={incident}", nm, angles,
                                                     patches=(90, 72), integrate=True) for incident in ("traced", "reciprocal")}
            before, after = (g["f"][:, 0] for g in found.values())
            weight = found["traced"]["projected_solid_angle_sr"]
            moved = numpy.sqrt((weight * (after - before)**2).sum(axis=(1, 2)) / (weight * before**2).sum(axis=(1, 2)))
            body.append([leaf, nm] + [f"{100 * x:.1f} %" for x in moved])
        for panel, title, lit_below, crosses in zip(row, ("reflected, lit from above", "transmitted from above",
                                                          "reflected, lit from below"), (0, 0, 1), (0, 1, 0)):
            for color, angle in zip(charts.COLORS[1:], (30, 60)):
                for name, line in (("traced", "--"), ("reciprocal", "-")):
                    f = found[name]["f"][angles.index(180 - angle if lit_below else angle), 0]
                    angles_seen, place = plane_of_incidence(found[name], lit_below != crosses)
                    panel.plot(angles_seen, numpy.pi * f[place], line, color=color,
                               label=f"{angle}°, {'model' if name == 'traced' else name}")
            panel.set(title=f"{leaf}, {title}", xlim=(-90, 90), ylim=(0, 0.8 if crosses else 2.5), xticks=range(-90, 91, 45))
        row[0].set_ylabel("π f, 800 nm")
    panels[1, 1].set_xlabel("direction of leaving (°), straight on to the right")
    charts.legend(of, panels[0, 0], 4)
    charts.save(of, folder / "shape.svg")
    return table(["", "nm"] + [f"light at {a}°" for a in angles], body)


def noise(scene, incident, samples, first_seed):
    """Of a render: RMS over its pixels of leaves alone, and their median by what it would be of a normal distribution."""
    a, b = (frond.load(scene, wavelengths="smpte", swap={"leaf": f"leaf_solved,incident={incident}"}, seed=first_seed + k)
            .render(samples) for k in (0, 1))
    leaves = (a["leaf"] == 1) & (b["leaf"] == 1)
    differences = abs(a.rgb - b.rgb)[leaves].astype(float) / numpy.sqrt(2)
    return rms(differences), numpy.median(differences) / 0.67449


def noise_table(quick, folder):
    size, samples = (64, 16) if quick else (192, 64)
    body, ratios = [], {}
    for name, title in SCENES.items():
        scene = sized(ROOT / f"scenes/soybean-{name}/scene.pbrt", folder, size)
        for incident in CONVENTIONS:
            total, median = noise(scene, incident, samples, 1)
            ratios[name, incident] = ratio = total / median
            body.append([title, incident, f"{total:.4f}", f"{median:.4f}", f"{ratio:.2f}", f"{ratio / ratios[name, 'traced']:.2f}"])
    text = table(["scene", "`incident`", "RMS", "median", "RMS / median", "over that of traced"], body)
    return text, size, samples


def settling(quick, folder, images):
    """RMS noise times the root of the number of samples: level where the variance settles."""
    size, counts = (48, (4, 16, 64)) if quick else (96, (4, 16, 64, 256, 1024))
    of, [row] = charts.figure(1100, 480, 1, 2, sharex=True)
    body = []
    for panel, name in zip(row, ("front", "ambient")):
        scene = sized(ROOT / f"scenes/soybean-{name}/scene.pbrt", folder, size)
        for color, incident in zip(charts.COLORS[1:], CONVENTIONS):
            found = numpy.array([noise(scene, incident, n, 11) for n in counts]) * numpy.sqrt(counts)[:, None]
            body.append([SCENES[name], incident] + ["{:.3f}, {:.3f}".format(*pair) for pair in found])
            panel.loglog(counts, found[:, 0], "o-", color=color, label=incident)
            panel.loglog(counts, found[:, 1], "--", color=color, label=f"{incident}, by the median")
        panel.set(title=SCENES[name], xlabel="samples a pixel")
        charts.plain_ticks(panel.xaxis, counts)
    row[0].set_ylabel("noise × √samples")
    charts.legend(of, row[0], 3)
    charts.save(of, images / "settling.svg")
    return table(["scene", "`incident`"] + [f"{n} samples" for n in counts], body), size


def main():
    options = arguments("reciprocal")
    images = options.docs / "images" / "reciprocal_leaf"
    with tempfile.TemporaryDirectory() as temporary:
        folder = pathlib.Path(temporary)
        noises, size, samples = noise_table(options.quick, folder)
        settled, settled_size = settling(options.quick, folder, images)
    model_t, leaf_t = (diffuse_transmittance("soybean", 551, incident) for incident in ("traced", "reciprocal"))
    text = INTRODUCTION.format(machine=machine(), least=0.07) + f"""
## What it changes

**R and T** at each angle, the model's and the reciprocal leaf's; above 90° the abaxial side is lit. Their sum stays; what is
transmitted from one side and from the other has to be the same on the whole, and so a little goes from one to the other:

{shares()}
**Shape**: the RMS of f_r − f over that of f, over all directions of leaving by projected solid angle, surface and body:

{changes(images)}
f in the plane of incidence at 800 nm, for light at 30° and 60° from the normal. Toward grazing the model's f goes beyond the
chart, like 1 / cos θo; the reciprocal leaf's is bounded.

![the model's f and the reciprocal leaf's in the plane of incidence](images/reciprocal_leaf/shape.svg)

**Energy**: what a render shows of a leaf that absorbs nothing, lit from one direction and seen from all around; it should
be 1 (`frond goniophotometer --rendered --integrate`):

{energy()}
## Noise

Of images by `leaf_solved` in linear SMPTE-C, white in the light 1: {size} × {size} pixels, {samples} samples each; of
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
    write(options.docs / "reciprocal_leaf.md", text)


if __name__ == "__main__":
    main()
