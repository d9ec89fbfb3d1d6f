"""Cases of the radiation transfer model intercomparison, RAMI (section "rami" of docs/radiometry.md)

Measures HET01 against its reference, HET06, and a homogeneous layer of disks against a solution of the turbid medium. Takes about
15 minutes of CPU time.
  --published FOLDER  data of HET01, which frond does not contain; needed unless --quick: the leaf positions of the intercomparison,
                      het01_UNI_sphere.def (https://rami-benchmark.jrc.ec.europa.eu), and the reference of Eradiate's regression
                      suite as het01_brfpp.csv with the columns vza_deg, vaa_deg, brf, brf_se
  --quick             few samples, into build/rami_report
"""

import math
import pathlib
import re
import tempfile
import textwrap
import time

import numpy
import pandas

import frond

from .shared.tools import ROOT, arguments, machine, program, program_csv, rms, table, write_section
from .shared.turbid import turbid_layer

DRAWS = 8  # of random positions: a draw differs from the mean over all possible ones
HET01_VIEWS = range(-75, 76, 2)
HET06_VIEWS = [-75, -61, -41, -21, -1, 19, 39, 59, 75]
HOMOGENEOUS_VIEWS = [(0, 90), (30, 90), (60, 90)]
LAI, LEAF_R, LEAF_T, SOIL, SUN = 3, 0.4957, 0.4409, 0.159, 30  # of the homogeneous layer: RAMI's leaves in the near infrared

HOMOGENEOUS = """Option "float period" [ {plot} {plot} ]
WorldBegin
{sun}
MakeNamedMaterial "soil" "string type" "diffuse" "spectrum reflectance" [ 300 {soil} 2500 {soil} ]
MakeNamedMaterial "leaf" "string type" "diffusetransmission"
  "spectrum reflectance" [ 300 {r} 2500 {r} ] "spectrum transmittance" [ 300 {t} 2500 {t} ]
NamedMaterial "soil"
Shape "bilinearmesh" "point3 P" [ 0 0 0  {plot} 0 0  0 {plot} 0  {plot} {plot} 0 ]
NamedMaterial "leaf"
ObjectBegin "leaf" Shape "disk" ObjectEnd
Shape "instances" "string object" "leaf" "string filename" "layer.npy"
"""

# Numbers: regression case HET06 of Eradiate. The plot ends at its rim, there are no copies around it.
FOREST = """{period}WorldBegin
{sun}
MakeNamedMaterial "snow" "string type" "diffuse" "spectrum reflectance" [ 300 0.86 2500 0.86 ]
MakeNamedMaterial "trunk" "string type" "diffuse" "spectrum reflectance" [ 300 0.14 2500 0.14 ]
MakeNamedMaterial "leaf" "string type" "diffusetransmission"
  "spectrum reflectance" [ 300 0.08 2500 0.08 ] "spectrum transmittance" [ 300 0.03 2500 0.03 ]
NamedMaterial "snow"
Shape "bilinearmesh" "point3 P" [ -250 -250 0  250 -250 0  -250 250 0  250 250 0 ]
NamedMaterial "leaf"
ObjectBegin "disk" Shape "disk" ObjectEnd
ObjectBegin "tree"
  Shape "instances" "string object" "disk" "string filename" "crown.npy"
  NamedMaterial "trunk"
  Shape "cylinder" "float radius" 0.15 "float zmin" -0.1 "float zmax" 1.5
  Shape "disk" "float radius" 0.15 "float height" 1.5
ObjectEnd
Shape "instances" "string object" "tree" "string filename" "trees.npy"
"""


def sun(zenith_deg):
    toward = numpy.radians(zenith_deg)
    return (f'LightSource "distant" "point3 from" [ {numpy.sin(toward):.8f} 0 {numpy.cos(toward):.8f} ] "point3 to" [ 0 0 0 ] '
            '"spectrum L" "stdillum-E"')


def instances(path, **columns):
    """Writes an instance table of these columns."""
    text = path.with_suffix(".csv")
    pandas.DataFrame(columns).to_csv(text, index=False)
    program("instances", text, "-o", path)


def sphere(random, count):
    """Returns unit vectors that point anywhere."""
    z, phi = random.uniform(-1, 1, count), random.uniform(0, 2 * numpy.pi, count)
    return numpy.sqrt(1 - z**2) * numpy.cos(phi), numpy.sqrt(1 - z**2) * numpy.sin(phi), z


def crown(path, seed):
    """6480 disks of 5 cm, uniform in a cone of radius 1.8 m and height 12 m above a trunk of 1.5 m."""
    random, count = numpy.random.default_rng(seed), 6480
    down = random.uniform(0, 1, count) ** (1 / 3)  # distance from the tip, in heights
    radius, phi = 1.8 * down * numpy.sqrt(random.uniform(0, 1, count)), random.uniform(0, 2 * numpy.pi, count)
    nx, ny, nz = sphere(random, count)
    instances(path, x=radius * numpy.cos(phi), y=radius * numpy.sin(phi), z=1.5 + 12 * (1 - down), nx=nx, ny=ny, nz=nz, scale=0.05)


def trees(path, seed, count=10_000, apart=3.6, half=248.2):
    """Trees at random whose crowns do not overlap, by a grid of cells that hold at most one tree."""
    random, cell = numpy.random.default_rng(seed), apart / 2**0.5
    places, grid = [], {}
    while len(places) < count:
        x, y = random.uniform(-half, half, 2)
        i, j = int(x // cell), int(y // cell)
        near = (grid.get((i + di, j + dj)) for di in range(-2, 3) for dj in range(-2, 3))
        if all(p is None or (p[0] - x)**2 + (p[1] - y)**2 >= apart**2 for p in near):
            grid[i, j] = (x, y)
            places.append((x, y))
    x, y = numpy.transpose(places)
    instances(path, x=x, y=y, z=0 * x)


def row(name, quantity, ours, error, reference=None, reference_error=0.0):
    def number(value, error):
        digits = max(4, 1 - math.floor(math.log10(error)))
        return f"{value:.{digits}f} ± {error:.{digits}f}"

    cells = [name, quantity, number(ours, error)]
    if reference is None:
        return [*cells, "", ""]
    both = numpy.hypot(error, reference_error)
    return [*cells, number(reference, reference_error) if reference_error else f"{reference:.4g}",
            f"{100 * (ours / reference - 1):+.2f} % ({(ours - reference) / both:+.1f} σ)"]


def mean_of(draws):
    """Returns the mean over draws and its standard error; the latter contains the noise of each."""
    return numpy.mean(draws, axis=0), numpy.std(draws, axis=0, ddof=1) / len(draws)**0.5


def compared(brf, error, reference):
    """A sentence: differences of 76 angles from the reference. `error`: of the differences."""
    z, relative = (brf - reference.brf) / error, brf / reference.brf - 1
    worst = abs(z).idxmax()
    return (f"mean difference {100 * relative.mean():+.3f} ± {100 * rms(error / reference.brf) / len(z)**0.5:.3f} %, RMS difference "
            f"{100 * rms(relative):.2f} % with an RMS standard error of {100 * rms(error / reference.brf):.2f} %, mean χ² {(z**2).mean():.2f}, "
            f"largest difference {z[worst]:+.1f} standard errors, at {reference.vza_deg[worst]:g}°")


def het01(folder, asked, published):
    """Returns rows and a paragraph. The reference and the leaves are not frond's to distribute."""
    reference = pandas.read_csv(published / "het01_brfpp.csv", comment="#")
    (folder / "het01.pbrt").write_text((ROOT / "scenes/canopy/het01.pbrt").read_text())
    program("instances", ROOT / "scenes/canopy/het01-spheres.csv", "-o", folder / "het01-balls.npy")
    ball = re.search(r'canopy -o "\$folder/het01-leaves.npy" (.*) --seed', (ROOT / "scenes/canopy/make").read_text())[1].split()

    def measured(rms, seed):  # with one seed, the draws would share a part of their noise
        found = frond.brf(folder / "het01.pbrt", [800], zenith=HET01_VIEWS, rms=rms, seed=seed)
        assert list(found.zenith_deg) == list(reference.vza_deg)
        return found.brf, found.brf_se

    draws = []
    for seed in range(1, DRAWS + 1):
        program("canopy", "-q", "-o", folder / "het01-leaves.npy", *ball, "--seed", seed)
        draws.append(measured(1.5 * asked, seed))
        print(f"HET01: draw {seed}", flush=True)
    values, noise = (numpy.array(part) for part in zip(*draws))
    mean = values.mean(axis=0)
    noise = rms(noise / mean)
    spread = max(0.0, rms(values.std(axis=0, ddof=1) / mean)**2 - noise**2)**0.5  # of the leaves alone
    se = mean * ((spread**2 + noise**2) / DRAWS)**0.5
    error = numpy.sqrt(se**2 + (mean * spread)**2 + reference.brf_se**2)  # the reference is one draw of the leaves, too
    text = (f"With {DRAWS} draws of the leaves, between which the BRF varies by {100 * spread:.2f} % (RMS, without noise), the error "
            f"of the mean and the reference's own draw included: {compared(mean, error, reference)}.")
    leaves = numpy.loadtxt(published / "het01_UNI_sphere.def")
    instances(folder / "het01-leaves.npy", **dict(zip(("scale", "x", "y", "z", "nx", "ny", "nz"), leaves.T)))
    mean, se = measured(asked, DRAWS + 1)
    error = numpy.hypot(se, reference.brf_se)
    text = f"With the leaf positions of the intercomparison: {compared(mean, error, reference)}. {text}"
    rows = [row("HET01, published leaves", f"BRF at {z}°", mean[i], se[i], reference.brf[i], reference.brf_se[i])
            for i, z in enumerate(HET01_VIEWS) if z in (-61, -21, -1, 39, 75)]
    return rows, text


def het06(folder, asked, paths):
    """Returns rows."""
    target = "-250,250,-250,250,6.75"

    def measured(seed, sun_deg, views, rms, periodic=False, path_seed=None):
        crown(folder / "crown.npy", seed)
        trees(folder / "trees.npy", seed)
        period = 'Option "float period" [ 500 500 ]\n' if periodic else ""
        (folder / "forest.pbrt").write_text(FOREST.format(period=period, sun=sun(sun_deg)))
        found = frond.brf(folder / "forest.pbrt", [650], zenith=views, rms=rms, target=None if periodic else target,
                          seed=path_seed or seed)
        return found.brf.to_numpy(), found.brf_se.to_numpy()

    mean, error = mean_of([measured(seed, 40, HET06_VIEWS, asked)[0] for seed in range(1, DRAWS + 1)])
    rows = [row(f"HET06, {DRAWS} draws", f"BRF at {z}°", mean[i], error[i]) for i, z in enumerate(HET06_VIEWS)]
    print("HET06: draws", flush=True)
    # Light that the periodic plot sends from 40 to 20 degrees is that from 20 to 40.
    (there, there_se), (back, back_se), (coarse, coarse_se) = (
        [v[0] for v in measured(1, sun_deg, [view], rms, True, path_seed)]
        for sun_deg, view, rms, path_seed in ((40, -20, asked / 3, 1), (20, -40, asked / 3, 2), (40, -20, 2 * asked, 3)))
    rows.append(row("HET06, repeated plot", "BRF, sun 40°, view −20°, against sun 20°, view −40°", there, there_se, back, back_se))
    rows.append(row("HET06, repeated plot", "BRF, sun 40°, view −20°, with fewer paths, against many", coarse, coarse_se, there, there_se))
    (folder / "forest.pbrt").write_text(FOREST.format(period="", sun=sun(40)))
    flux = program_csv("flux", folder / "forest.pbrt", "--target", target, "--wavelengths", 650, "--paths", paths, "--csv", "-", "-q")
    total = flux[flux.quantity == "sum"].iloc[0]
    rows.append(row("HET06", "sum of absorbed and leaving light, against 1", total.share, total.share_se, 1.0))
    return rows


def homogeneous(folder, asked, paths):
    """Returns rows: disks against the turbid medium, which is their limit for radius 0."""
    albedo, absorbed, brf = turbid_layer(LAI, LEAF_R, LEAF_T, SOIL, SUN, HOMOGENEOUS_VIEWS)
    rows = []
    for radius, plot in ((0.05, 4), (0.0125, 2)):
        scene = folder / "layer.pbrt"
        scene.write_text(HOMOGENEOUS.format(plot=plot, sun=sun(SUN), soil=SOIL, r=LEAF_R, t=LEAF_T))

        def measured(seed):
            program("canopy", "-q", "-o", folder / "layer.npy", "--lai", LAI, "--angles", "spherical", "--scale", radius, "--size",
                    f"{plot},{plot}", "--heights", f"{radius},{2 - radius}", "--seed", seed)
            found = frond.brf(scene, [800], zenith=[z for z, _ in HOMOGENEOUS_VIEWS], azimuth=90, rms=asked, seed=seed)
            flux = frond.flux(scene, [800], paths=paths, seed=seed).set_index(["quantity", "material"]).share
            return [*found.brf, flux["reflected", ""], flux["absorbed", "soil"]]

        names = [*(f"BRF at {z}°, across" for z, _ in HOMOGENEOUS_VIEWS), "albedo", "absorbed by the soil"]
        rows += [row(f"Homogeneous, disks of {100 * radius:g} cm", *values) for values in
                 zip(names, *mean_of([measured(seed) for seed in range(1, DRAWS + 1)]), [*brf, albedo, absorbed])]
    return rows


SECTION = """## RAMI

Cases of the radiation transfer model intercomparison, all by `measurements/run rami`. Machine: {machine}; {minutes:.0f} minutes.

{rows}

*Angles: zenith angles of the view in the sun's plane, negative on the sun's side; "across": at azimuth 90° from it. The last column
is the difference from the reference, and in units of the standard error of both.*

**HET01** (`scenes/canopy/het01.pbrt`): 15 balls of radius 10 m with 49,999 leaves each, over soil, in the near infrared, at 76 angles.
The reference is from Eradiate's regression suite, which is not part of frond. {het01}

**HET06**: 10,000 conifers of 6480 leaves over snow, in the red, on a plot of 500 m that ends at its rim, sun at 40°, seen through the
plot at a height of 6.75 m. Trees and leaves are drawn from the published description, trees without overlap. The reference is not
public; the table has frond's values, with errors from the draws, and three checks: reciprocity, convergence and the balance of
energy.

**Homogeneous layer**: disks with spherical leaf angles, leaf area index 3, between 0 and 2 m, leaves and soil as in HET01, sun at 30°.
The reference is a solution by doubling of the turbid medium (`measurements/shared/turbid.py`), the limit of small leaves. Errors are those of the mean of {draws} draws."""


def main():
    options = arguments("rami", ("--published", dict(type=pathlib.Path, help="folder with het01_UNI_sphere.def and het01_brfpp.csv")))
    if not (options.published or options.quick):
        raise SystemExit("measurements/run rami: the page has HET01, which needs --published FOLDER; --quick leaves it out")
    asked, paths = (0.03, 20_000) if options.quick else (0.003, 1_000_000)
    start = time.monotonic()
    with tempfile.TemporaryDirectory(prefix="frond_rami.") as name:
        folder = pathlib.Path(name)
        layer = homogeneous(folder, 2 * asked, paths // 4)
        print("Homogeneous layer", flush=True)
        forest = het06(folder, 2 * asked, paths)
        balls, text = het01(folder, asked, options.published) if options.published else ([], "Not measured: no --published.")
    rows = table(["case", "quantity", "frond", "reference", "difference"], balls + forest + layer)
    minutes = (time.monotonic() - start) / 60
    section = SECTION.format(machine=machine(), minutes=minutes, rows="@rows@", het01=text, draws=DRAWS)
    section = "\n\n".join(textwrap.fill(paragraph, 130, break_on_hyphens=False) for paragraph in section.split("\n\n"))
    write_section(options.docs / "radiometry.md", "rami", section.replace("@rows@", rows.strip()))


if __name__ == "__main__":
    main()
