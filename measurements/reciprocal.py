"""Reciprocal BSDF of the leaf models: energy, shape, noise (section "reciprocal" of docs/leaf_models.md)

Measures it beside the models, and writes charts, too.
  --quick   few samples, into build/reciprocal_report
"""

import pathlib
import tempfile

import numpy

import frond

from .shared import charts
from .shared.tools import ROOT, arguments, machine, plane_of_incidence, rms, sized, table, write_section

LEAVES = ("soybean", "maize")
CONVENTIONS = ("traced", "light", "reciprocal")
SCENES = {"front": "front lit", "back": "back lit", "ambient": "ambient light"}


def shares_by_angle(material, angles, nm):
    """Reflected and transmitted shares of the incident light: two rows, a column for each angle."""
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
                both = [shares_by_angle(f"{material},specimen={leaf},incident={i}", angles, nm) for i in ("traced", "reciprocal")]
                for name, model, reciprocal in zip("RT", *both):
                    body.append([f"`{material}`, {leaf}", nm, name, *(f"{x:.3f}, {y:.3f}" for x, y in zip(model, reciprocal))])
    return table(["", "nm", ""] + [f"{a}°" for a in angles], body)


def diffuse_transmittance(leaf, nm, incident):
    """Transmittance of diffuse light from above and from below, by Gauss quadrature in the cosine."""
    nodes, weights = numpy.polynomial.legendre.leggauss(8)
    cosines = (1 + nodes) / 2
    angles = numpy.degrees(numpy.arccos(cosines))
    material = f"leaf_solved,specimen={leaf},incident={incident}"
    return [weights * cosines @ shares_by_angle(material, list(side), nm)[1] for side in (angles, 180 - angles)]


def energy():
    angles, body = (5, 30, 60, 75, 85, 89), []
    for material in ("leaf_solved", "leaf_simplified", "leaf_lambert"):
        for incident in CONVENTIONS:
            found = frond.goniophotometer(f"{material},specimen=soybean,mesophyllfraction=0,incident={incident}", 551, angles,
                                          rendered=True, integrate=True)
            sums = (found["f"][:, 0] * found["projected_solid_angle_sr"]).sum(axis=(1, 2))
            body.append([f"`{material}`", incident] + [f"{x:.4f}" for x in sums])
    return table(["", "`incident`"] + [f"{a}°" for a in angles], body)


def changes(folder):
    """RMS difference of f_r and f for each direction of light, and the chart of both in the plane of incidence."""
    angles, body = (5, 30, 60, 75, 175, 150, 120, 105), []
    of, panels = charts.figure(1200, 760, 2, 3, sharex=True)
    for row, leaf in zip(panels, LEAVES):
        for nm in (551, 800):
            found = {incident: frond.goniophotometer(f"leaf_solved,specimen={leaf},incident={incident}", nm, angles,
                                                     patches=(90, 72), integrate=True) for incident in ("traced", "reciprocal")}
            before, after = (g["f"][:, 0] for g in found.values())
            weight = found["traced"]["projected_solid_angle_sr"]
            difference = numpy.sqrt((weight * (after - before)**2).sum(axis=(1, 2)) / (weight * before**2).sum(axis=(1, 2)))
            body.append([leaf, nm] + [f"{100 * x:.1f} %" for x in difference])
        for panel, title, lit_below, crosses in zip(row, ("reflected, lit from above", "transmitted from above",
                                                          "reflected, lit from below"), (0, 0, 1), (0, 1, 0)):
            for color, angle in zip(charts.COLORS[1:], (30, 60)):
                for name, line in (("traced", "--"), ("reciprocal", "-")):
                    f = found[name]["f"][angles.index(180 - angle if lit_below else angle), 0]
                    angles_seen, patches = plane_of_incidence(found[name], lit_below != crosses)
                    panel.plot(angles_seen, numpy.pi * f[patches], line, color=color,
                               label=f"{angle}°, {'model' if name == 'traced' else name}")
            panel.set(title=f"{leaf}, {title}", xlim=(-90, 90), ylim=(0, 0.8 if crosses else 2.5), xticks=range(-90, 91, 45))
        row[0].set_ylabel("π f, 800 nm")
    panels[1, 1].set_xlabel("outgoing direction (°); forward scattering is on the right")
    charts.legend(of, panels[0, 0], 4)
    charts.save(of, folder / "shape.svg")
    return table(["", "nm"] + [f"light at {a}°" for a in angles], body)


def noise(scene, incident, samples, first_seed):
    """Noise of a render over the pixels that show leaves only: RMS, and median scaled to the RMS of a normal distribution."""
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
    text = table(["scene", "`incident`", "RMS", "median", "RMS / median", "relative to traced"], body)
    return text, size, samples


def convergence(quick, folder, images):
    """Noise times the square root of the number of samples, which is constant if the variance is finite."""
    size, counts = (48, (4, 16, 64)) if quick else (96, (4, 16, 64, 256, 1024))
    of, [row] = charts.figure(1100, 480, 1, 2, sharex=True)
    body = []
    for panel, name in zip(row, ("front", "ambient")):
        scene = sized(ROOT / f"scenes/soybean-{name}/scene.pbrt", folder, size)
        for color, incident in zip(charts.COLORS[1:], CONVENTIONS):
            found = numpy.array([noise(scene, incident, n, 11) for n in counts]) * numpy.sqrt(counts)[:, None]
            body.append([SCENES[name], incident] + ["{:.3f}, {:.3f}".format(*pair) for pair in found])
            panel.loglog(counts, found[:, 0], "o-", color=color, label=incident)
            panel.loglog(counts, found[:, 1], "--", color=color, label=f"{incident}, median")
        panel.set(title=SCENES[name], xlabel="samples per pixel")
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
        converged, converged_size = convergence(options.quick, folder, images)
    model_t, leaf_t = (diffuse_transmittance("soybean", 551, incident) for incident in ("traced", "reciprocal"))
    text = f"""## Measurements of the reciprocal BSDF

Measured by `measurements/run reciprocal` on {machine()}.

**R and T** at each angle of incidence, first of the model and then of its reciprocal BSDF; above 90° the abaxial side is lit.
R + T stays the same. Reciprocity requires the same diffuse transmittance from both sides, so a small share moves between R and T:

{shares()}
The diffuse transmittance (mean of T under diffuse light) of soybean at 551 nm is {model_t[0]:.3f} from above and {model_t[1]:.3f}
from below with the model, {leaf_t[0]:.3f} and {leaf_t[1]:.3f} with the reciprocal BSDF.

**Shape.** RMS of f_r − f relative to the RMS of f, over all outgoing directions, weighted by projected solid angle, including the
surface lobe:

{changes(images)}
f in the plane of incidence at 800 nm, for light at 30° and 60° from the normal. Toward grazing directions the model's f exceeds the
range of the chart, like 1 / cos θo; the reciprocal BSDF is bounded.

![the model's f and the reciprocal BSDF in the plane of incidence](images/reciprocal_leaf/shape.svg)

**Energy.** A render of a leaf that absorbs nothing, lit from one direction and integrated over all viewing directions, should show
1 (`frond goniophotometer --rendered --integrate`):

{energy()}
**Noise.** Images of `leaf_solved` in linear SMPTE-C, where a white surface in the light is 1; {size} × {size} pixels, {samples}
samples each. The noise is the difference of two renders with different seeds, over √2, on the pixels that show leaves only. The
median is scaled so that it equals the RMS if the noise has the same normal distribution in all pixels. The scenes themselves do
not meet this condition; the last column divides by the ratio of `traced`, which leaves the tails that are due to the estimator.

{noises}
RMS and median of the noise times the square root of the number of samples, {converged_size} × {converged_size} pixels: if the
variance is finite, both are constant, or decrease where low-discrepancy samples converge faster than independent ones; if it is not
finite, the RMS increases, in jumps.

{converged}
![noise times the square root of the number of samples against samples; dashed: median](images/reciprocal_leaf/settling.svg)
"""
    write_section(options.docs / "leaf_models.md", "reciprocal", text)


if __name__ == "__main__":
    main()
