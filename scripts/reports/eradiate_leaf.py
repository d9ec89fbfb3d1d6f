"""Compares Eradiate with `frond_leaf` to `frond brf` in one canopy: the section "eradiate" of docs/other_renderers.md. Run by the
Python of build/eradiate-venv."""

import time

import eradiate
import numpy

eradiate.set_mode("mono")
eradiate.config.settings.progress = "NONE"
from eradiate import unit_registry as ureg

import charts
import frond
from frond.eradiate import FrondLeafCloud
from tools import ROOT, arguments, machine, table, write_section

FOLDER = ROOT / "build" / "eradiate"
RGB = [551.0, 800.0]
ZENITH = [-60.0, -40.0, -20.0, 0.0, 20.0, 40.0, 60.0]
LEAVES, RADIUS, SIDE, HEIGHT = 400, 0.12, 3.0, 1.0
SUN = 30.0
TARGET = 0.8  # half the side of the measured square
SAMPLES = 24_000

SECTION = """### Agreement of Eradiate with `frond brf`

Measured by `scripts/eradiate` on {machine}; Eradiate {version}, frond {frond_version}.

The canopy has {leaves} disks with a radius of {radius} m at random positions in a box of {side} x {side} x {height} m, without a ground.
The leaves are soybean, reciprocal. The sun is at {sun}° from the zenith, and the views lie in the principal plane; negative
zenith angles are opposite to the sun. The measured area is a square of {seen} m at the top. Eradiate traces {samples} paths per
direction and wavelength; `frond brf` renders to a noise of {asked:g} %.

{rows}
The standard errors of Eradiate's BRF are estimated from {batches} runs. The differences have a chi-square of {chi2:.1f} with
{count} degrees of freedom. The run takes {ours:.1f} times the CPU time of the same run with `bilambertian` leaves.

![BRF of the canopy](images/eradiate/brf.svg)
"""


def canopy():
    rng = numpy.random.default_rng(5)
    positions = numpy.stack([rng.uniform(-SIDE / 2, SIDE / 2, LEAVES), rng.uniform(-SIDE / 2, SIDE / 2, LEAVES),
                             rng.uniform(0.1, HEIGHT - 0.1, LEAVES)], axis=1)
    normals = rng.normal(size=(LEAVES, 3))
    normals[:, 2] = abs(normals[:, 2])
    return positions, normals / numpy.linalg.norm(normals, axis=1)[:, None]


def frond_scene(positions, normals):
    lines = ['WorldBegin',
             'LightSource "distant" "point3 from" [ {} 0 {} ] "point3 to" [ 0 0 0 ] "spectrum L" "stdillum-E"'.format(
                 numpy.sin(numpy.radians(SUN)), numpy.cos(numpy.radians(SUN))),
             'MakeNamedMaterial "leaf" "string type" "leaf_solved" "string incident" "reciprocal"', 'NamedMaterial "leaf"']
    for p, n in zip(positions, normals):
        helper = numpy.array([0, 1, 0]) if abs(n[0]) > 0.7 else numpy.array([1, 0, 0])
        x = numpy.cross(helper, n)
        x /= numpy.linalg.norm(x)
        matrix = [*x, 0, *numpy.cross(n, x), 0, *n, 0, *p, 1]
        lines.append("AttributeBegin Transform [ {} ] Shape \"disk\" \"float radius\" {} AttributeEnd".format(
            " ".join(f"{v:.9g}" for v in matrix), RADIUS))
    path = FOLDER / "canopy.pbrt"
    path.write_text("\n".join(lines) + "\n")
    return path


def by_eradiate(positions, normals, kind, seed, samples):
    cloud = {"id": "leaves", "leaf_positions": positions * ureg.m, "leaf_orientations": normals,
             "leaf_radii": numpy.full(LEAVES, RADIUS) * ureg.m}
    if kind == "frond":
        cloud = FrondLeafCloud(**cloud, leaf={"specimen": "soybean"})
    else:
        from eradiate.scenes.biosphere import LeafCloud
        cloud = LeafCloud(**cloud, leaf_reflectance=0.4, leaf_transmittance=0.4)
    from eradiate.scenes.biosphere import DiscreteCanopy, InstancedCanopyElement
    element = InstancedCanopyElement(canopy_element=cloud, instance_positions=[[0, 0, 0]] * ureg.m)
    elements = DiscreteCanopy(instanced_canopy_elements=[element], size=[SIDE, SIDE, HEIGHT] * ureg.m)
    target = {"type": "rectangle", "xmin": -TARGET, "xmax": TARGET, "ymin": -TARGET, "ymax": TARGET, "z": HEIGHT}
    experiment = eradiate.experiments.CanopyExperiment(
        canopy=elements, surface={"type": "black"},
        illumination={"type": "directional", "zenith": SUN, "azimuth": 0.0, "irradiance": 1.0},
        measures={"type": "mdistant", "construct": "hplane", "zeniths": ZENITH, "azimuth": 0.0, "target": target, "spp": samples,
                  "srf": {"type": "delta", "wavelengths": RGB}},
        integrator={"type": "path", "max_depth": 64})
    start = time.process_time()
    result = eradiate.run(experiment, seed_state=eradiate.rng.SeedState(seed))
    seconds = time.process_time() - start
    brf = result["brf"].squeeze(drop=True)
    [views] = [d for d in brf.dims if d != "w"]
    zenith = numpy.copysign(result["vza"].values.ravel(), numpy.array(ZENITH))
    return zenith, brf.transpose(views, "w").values, seconds


def main():
    options = arguments("eradiate")
    samples, asked = (800, 0.02) if options.quick else (SAMPLES, 1e-3)
    FOLDER.mkdir(parents=True, exist_ok=True)
    positions, normals = canopy()
    batches = 8
    runs = [by_eradiate(positions, normals, "frond", seed, samples // batches) for seed in range(1, batches + 1)]
    _, _, plain = by_eradiate(positions, normals, "bilambertian", 1, samples // batches)
    zenith, brf = runs[0][0], numpy.array([r[1] for r in runs])
    mean, error = brf.mean(axis=0), brf.std(axis=0, ddof=1) / numpy.sqrt(batches)
    ours = frond.brf(frond_scene(positions, normals), RGB, zenith=-zenith,  # frond brf counts zenith angles on the sun's side as negative
                     target=(-TARGET, TARGET, -TARGET, TARGET, HEIGHT), rms=asked)
    found, found_error = (numpy.reshape(ours[name], mean.shape) for name in ("brf", "brf_se"))
    z = (mean - found) / numpy.hypot(error, found_error)
    of, [[panel]] = charts.figure(900, 540)
    for w, (nm, color) in enumerate(zip(RGB, charts.COLORS[1:])):
        panel.plot(zenith, found[:, w], color=color, label=f"frond brf, {nm:g} nm")
        panel.errorbar(zenith, mean[:, w], error[:, w], fmt="o", color=color, label=f"Eradiate, {nm:g} nm")
    panel.set(xlabel="view zenith angle (degrees)", ylabel="BRF", xlim=(-65, 65))
    panel.set_ylim(bottom=0)
    charts.legend(of, panel, 4)
    charts.save(of, options.docs / "images" / "eradiate" / "brf.svg")
    rows = [[f"{zenith[v]:g}°", f"{RGB[w]:g}", f"{mean[v, w]:.5f} ± {error[v, w]:.5f}", f"{found[v, w]:.5f} ± {found_error[v, w]:.5f}",
             f"{100 * (mean[v, w] / found[v, w] - 1):+.2f} %"] for v, w in numpy.ndindex(mean.shape)]
    write_section(options.docs / "other_renderers.md", "eradiate", SECTION.format(
        machine=machine(), version=eradiate.__version__, frond_version=frond.__version__, leaves=LEAVES, radius=RADIUS,
        side=SIDE, height=HEIGHT, sun=SUN, seen=2 * TARGET, samples=f"{samples:,}", asked=100 * asked, batches=batches,
        rows=table(["zenith", "nm", "Eradiate", "frond", "difference"], rows), ours=numpy.median([r[2] for r in runs]) / plain,
        chi2=float((z**2).sum()), count=z.size))


if __name__ == "__main__":
    main()
