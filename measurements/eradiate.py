"""Eradiate: a canopy of frond's leaves there and in frond brf (section "eradiate" of docs/other_renderers.md)

Compares the results in one canopy, and the time of both for the same error in a homogeneous one; writes a chart. Installs
Eradiate, with its own Mitsuba, into build/eradiate-venv by pip, and runs by that Python.
  --quick   few samples, into build/eradiate_report
"""

import dataclasses
import time

import eradiate
import numpy

eradiate.set_mode("mono")
eradiate.config.settings.progress = "NONE"
from eradiate import unit_registry as ureg
from eradiate.scenes.biosphere import DiscreteCanopy, InstancedCanopyElement, LeafCloud

import frond
from frond.eradiate import FrondLeafCloud

from .shared import charts
from .shared.tools import ROOT, arguments, machine, table, write_section

FOLDER = ROOT / "build" / "eradiate"
RGB = [551.0, 800.0]
ZENITH = [-60.0, -40.0, -20.0, 0.0, 20.0, 40.0, 60.0]
SUN = 30.0
SAMPLES = 24_000
BATCHES = 8
NEAR_INFRARED = [800.0]
REFLECTANCE, TRANSMITTANCE = 0.5, 0.44


@dataclasses.dataclass
class Canopy:
    """Disks at random places in a box; lengths in metres."""
    leaves: int
    radius: float
    side: float
    height: float
    seen: float  # half the side of the measured square, at the top

    def __post_init__(self):
        rng = numpy.random.default_rng(5)
        half = self.side / 2
        ranges = ((-half, half), (-half, half), (0.1, self.height - 0.1))
        self.positions = numpy.stack([rng.uniform(*of, self.leaves) for of in ranges], axis=1)
        normals = rng.normal(size=(self.leaves, 3))
        normals[:, 2] = abs(normals[:, 2])
        self.normals = normals / numpy.linalg.norm(normals, axis=1)[:, None]


SMALL = Canopy(leaves=400, radius=0.12, side=3.0, height=1.0, seen=0.8)
HOMOGENEOUS = Canopy(leaves=9549, radius=0.1, side=10.0, height=2.0, seen=3.0)  # a leaf area index of 3

SECTION = """### Agreement of Eradiate with `frond brf`

Measured by `measurements/run eradiate` on {machine}; Eradiate {version}, frond {frond_version}.

The canopy has {leaves} disks with a radius of {radius} m at random positions in a box of {side} x {side} x {height} m, without a ground.
The leaves are soybean, reciprocal. The sun is at {sun}° from the zenith, and the views lie in the principal plane; negative
zenith angles are opposite to the sun. The measured area is a square of {seen} m at the top. Eradiate traces {samples} paths per
direction and wavelength; `frond brf` renders to a noise of {asked:g} %.

{rows}
The standard errors of Eradiate's BRF are estimated from {batches} runs. The differences have a chi-square of {chi2:.1f} with
{count} degrees of freedom. The run takes {ours:.1f} times the CPU time of the same run with `bilambertian` leaves.

![BRF of the canopy](images/eradiate/brf.svg)

#### Time for the same error

A homogeneous canopy of {discs:,} disks (leaf area index 3) of Lambertian leaves with an albedo of {albedo:g}, at 800 nm, seen from the
same directions with {many:,} paths per view. CPU time is that of these renders less that of renders with {few:,} paths, and so
without the time to load. The noise is the relative standard deviation of a view's BRF over {batches} seeds, RMS over the views;
the efficiency is 1 / (noise² x CPU time) relative to frond. The means differ with a chi-square of {raced_chi2:.1f} with {views}
degrees of freedom.

{race}"""


def frond_scene(canopy, material):
    """Writes the canopy under the sun as a scene of frond, with leaves of a material in the scene format; returns its path."""
    n = canopy.normals
    x = numpy.cross(numpy.where(abs(n[:, :1]) > 0.7, [[0, 1, 0]], [[1, 0, 0]]), n)
    x /= numpy.linalg.norm(x, axis=1)[:, None]
    rows = numpy.zeros(canopy.leaves, dtype=[("transform", "<f4", (3, 4))])
    rows["transform"] = numpy.stack([x, numpy.cross(n, x), n, canopy.positions], axis=2)
    numpy.save(FOLDER / "leaves.npy", rows)
    path = FOLDER / "canopy.pbrt"
    path.write_text(f"""WorldBegin
LightSource "distant" "point3 from" [ {numpy.sin(numpy.radians(SUN))} 0 {numpy.cos(numpy.radians(SUN))} ] "point3 to" [ 0 0 0 ]
  "spectrum L" "stdillum-E"
Material {material}
ObjectBegin "leaf" Shape "disk" "float radius" {canopy.radius} ObjectEnd
Shape "instances" "string object" "leaf" "string filename" "leaves.npy"
""")
    return path


def by_eradiate(canopy, cloud_type, leaf, seed, samples, wavelengths=RGB):
    """BRF by view and wavelength, and the CPU time in seconds."""
    cloud = cloud_type(id="leaves", leaf_positions=canopy.positions * ureg.m, leaf_orientations=canopy.normals,
                       leaf_radii=numpy.full(canopy.leaves, canopy.radius) * ureg.m, **leaf)
    element = InstancedCanopyElement(canopy_element=cloud, instance_positions=[[0, 0, 0]] * ureg.m)
    elements = DiscreteCanopy(instanced_canopy_elements=[element], size=[canopy.side, canopy.side, canopy.height] * ureg.m)
    seen = canopy.seen
    experiment = eradiate.experiments.CanopyExperiment(
        canopy=elements, surface={"type": "black"},
        illumination={"type": "directional", "zenith": SUN, "azimuth": 0.0, "irradiance": 1.0},
        measures={"type": "mdistant", "construct": "hplane", "zeniths": ZENITH, "azimuth": 0.0, "spp": samples,
                  "target": {"type": "rectangle", "xmin": -seen, "xmax": seen, "ymin": -seen, "ymax": seen, "z": canopy.height},
                  "srf": {"type": "delta", "wavelengths": wavelengths}},
        integrator={"type": "path", "max_depth": 64})
    start = time.process_time()
    result = eradiate.run(experiment, seed_state=eradiate.rng.SeedState(seed))
    seconds = time.process_time() - start
    brf = result["brf"]
    [views] = [d for d in brf.dims if d != "w" and brf.sizes[d] == len(ZENITH)]
    return brf.transpose(views, "w", ...).values.reshape(len(ZENITH), len(wavelengths)), seconds


def by_frond(canopy, material, seed=0, wavelengths=RGB, **effort):
    """BRF and its standard error by view and wavelength, and the CPU time in seconds."""
    scene, seen = frond_scene(canopy, material), canopy.seen
    start = time.process_time()
    found = frond.brf(scene, wavelengths, zenith=[-z for z in ZENITH],  # frond brf counts zenith angles on the sun's side as negative
                      target=(-seen, seen, -seen, seen, canopy.height), seed=seed, **effort)
    seconds = time.process_time() - start
    return *(numpy.reshape(found[name], (len(ZENITH), len(wavelengths))) for name in ("brf", "brf_se")), seconds


def race(few, many):
    """Table of CPU time per path, noise and efficiency in the homogeneous canopy, with `few` and `many` paths per view, and the
    chi-square of the difference of the means."""
    leaf = {"leaf_reflectance": REFLECTANCE, "leaf_transmittance": TRANSMITTANCE}
    material = (f'"diffusetransmission" "spectrum reflectance" [ 300 {REFLECTANCE} 2500 {REFLECTANCE} ] '
                f'"spectrum transmittance" [ 300 {TRANSMITTANCE} 2500 {TRANSMITTANCE} ]')
    programs = {"frond brf": lambda seed, paths: by_frond(HOMOGENEOUS, material, seed, NEAR_INFRARED, paths=paths)[::2],
                "Eradiate": lambda seed, paths: by_eradiate(HOMOGENEOUS, LeafCloud, leaf, seed, paths, NEAR_INFRARED)}
    brf, seconds = {name: [] for name in programs}, {name: [] for name in programs}
    for seed in range(1, BATCHES + 1):
        for name, render in programs.items():
            _, start = render(seed, few)
            image, end = render(seed, many)
            brf[name].append(image)
            seconds[name].append((end - start) / ((many - few) * len(ZENITH)))
    rows, best, means = [], None, {}
    for name, images in brf.items():
        mean, deviation = numpy.mean(images, axis=0), numpy.std(images, axis=0, ddof=1)
        variance, micros = float(((deviation / mean) ** 2).mean()), 1e6 * float(numpy.median(seconds[name]))
        best = best or 1 / (variance * micros)
        means[name] = mean, deviation / numpy.sqrt(BATCHES)
        rows.append([name, f"{micros:.2f} µs", f"{100 * variance**0.5:.3f} %", f"{1 / (variance * micros) / best:.2f}"])
    (a, a_error), (b, b_error) = means.values()
    chi2 = float(((a - b) ** 2 / (a_error**2 + b_error**2)).sum())
    return table(["program", "CPU time per path", "noise of a view", "efficiency"], rows), chi2


def main():
    options = arguments("eradiate")
    samples, asked, few, many = (800, 0.02, 100, 1000) if options.quick else (SAMPLES, 1e-3, 4096, 65536)
    FOLDER.mkdir(parents=True, exist_ok=True)
    zenith = numpy.array(ZENITH)
    leaf = {"leaf": {"specimen": "soybean"}}
    runs = [by_eradiate(SMALL, FrondLeafCloud, leaf, seed, samples // BATCHES) for seed in range(1, BATCHES + 1)]
    _, plain = by_eradiate(SMALL, LeafCloud, {"leaf_reflectance": 0.4, "leaf_transmittance": 0.4}, 1, samples // BATCHES)
    brf = numpy.array([r[0] for r in runs])
    mean, error = brf.mean(axis=0), brf.std(axis=0, ddof=1) / numpy.sqrt(BATCHES)
    found, found_error, _ = by_frond(SMALL, '"leaf_solved" "string incident" "reciprocal"', rms=asked)
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
    raced, raced_chi2 = race(few, many)
    write_section(options.docs / "other_renderers.md", "eradiate", SECTION.format(
        machine=machine(), version=eradiate.__version__, frond_version=frond.__version__, leaves=SMALL.leaves, radius=SMALL.radius,
        side=SMALL.side, height=SMALL.height, sun=SUN, seen=2 * SMALL.seen, samples=f"{samples:,}", asked=100 * asked, batches=BATCHES,
        rows=table(["zenith", "nm", "Eradiate", "frond", "difference"], rows), ours=numpy.median([r[1] for r in runs]) / plain,
        chi2=float((z**2).sum()), count=z.size, discs=HOMOGENEOUS.leaves, albedo=REFLECTANCE + TRANSMITTANCE, few=few, many=many,
        race=raced, raced_chi2=raced_chi2, views=len(ZENITH)))


if __name__ == "__main__":
    main()
