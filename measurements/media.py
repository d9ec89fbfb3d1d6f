"""Media: a turbid medium against its solution and disks, noise and cost of each medium (section "media" of docs/media.md)

Writes a chart, too. Takes some 5 minutes.
  --gallery   renders the image of the section "Mist" instead
  --quick     few samples, into build/media_report
"""

import pathlib
import tempfile

import frond
import numpy

from .gallery import FLOOR, LIGHT, MEDIA, MEDIA_PLACES, TORUS, VIEW
from .rami import HOMOGENEOUS, LAI, LEAF_R, LEAF_T, SOIL, SUN, sun
from .shared import charts
from .shared.tools import ROOT, arguments, machine, program, table, write_section
from .shared.turbid import turbid_layer

HEIGHT = 2
TURBID = """Option "float period" [ 2 2 ]
WorldBegin
{sun}
MakeNamedMedium "leaves" "string type" "turbid" "float density" {density}
  "spectrum reflectance" [ 300 {r} 2500 {r} ] "spectrum transmittance" [ 300 {t} 2500 {t} ]
AttributeBegin
  Material "interface"
  MediumInterface "leaves" ""
  Shape "bilinearmesh" "point3 P" [ 0 0 {height}  2 0 {height}  0 2 {height}  2 2 {height} ]
AttributeEnd
Material "diffuse" "spectrum reflectance" [ 300 {soil} 2500 {soil} ]
Shape "bilinearmesh" "point3 P" [ 0 0 0  2 0 0  0 2 0  2 2 0 ]
"""
ZENITH = [-60, -30, 0, 30, 60]
DISKS = ((0.05, 4), (0.0125, 2))  # radius, and width of the plot
DRAWS = 4


def brf_of(scene, asked, seed=1):
    """BRF and standard error in the sun's plane, then across."""
    found = [frond.brf(scene, [800], zenith=ZENITH, azimuth=azimuth, rms=asked, seed=seed) for azimuth in (0, 90)]
    return [numpy.concatenate([f[name] for f in found]) for name in ("brf", "brf_se")]


def turbid(folder, asked):
    """Rows: view, solution, and for the medium and disks the difference in per cent."""
    views = [(abs(z), azimuth + (180 if z < 0 else 0)) for azimuth in (0, 90) for z in ZENITH]
    true = turbid_layer(LAI, LEAF_R, LEAF_T, SOIL, SUN, views)[2]
    scene = folder / "turbid.pbrt"
    scene.write_text(TURBID.format(sun=sun(SUN), density=LAI / HEIGHT, height=HEIGHT, soil=SOIL, r=LEAF_R, t=LEAF_T))
    columns = [brf_of(scene, asked)]
    for radius, plot in DISKS:
        scene = folder / "layer.pbrt"
        scene.write_text(HOMOGENEOUS.format(plot=plot, sun=sun(SUN), soil=SOIL, r=LEAF_R, t=LEAF_T))
        draws = []
        for seed in range(1, DRAWS + 1):
            program("canopy", "-q", "-o", folder / "layer.npy", "--lai", LAI, "--angles", "spherical", "--scale", radius, "--size",
                    f"{plot},{plot}", "--heights", f"{radius},{HEIGHT - radius}", "--seed", seed)
            draws.append(brf_of(scene, asked, seed)[0])
        columns.append([numpy.mean(draws, axis=0), numpy.std(draws, axis=0, ddof=1) / DRAWS**0.5])
        print(radius, flush=True)
    rows = []
    for i, t in enumerate(true):
        view = f"{ZENITH[i % len(ZENITH)]}°" + (", across" if i >= len(ZENITH) else "")
        rows.append((view, f"{t:.5f}", *(f"{100 * (mean[i] / t - 1):+.2f} ± {100 * se[i] / t:.2f}" for mean, se in columns)))
    z = (columns[0][0] - true) / columns[0][1]
    return rows, abs(z).max()


def scene_of(name, size, integrator):
    """A body of the medium on a floor, as in the gallery."""
    place, radius = MEDIA_PLACES.get(name, "Translate 0 0 0.8"), 0.8 if name in ("homogeneous", "turbid") else 1.5
    return f"""{VIEW}Film "rgb" "integer xresolution" {size} "integer yresolution" {size}
Integrator {integrator}
WorldBegin
{LIGHT}{FLOOR}AttributeBegin
{place}
{MEDIA[name]}
AttributeEnd
AttributeBegin
Translate 0 0 0.8
Material "interface"
MediumInterface "medium" ""
Shape "sphere" "float radius" {radius}
AttributeEnd
"""


SIZE = 64


def noise(ladder, size=SIZE):
    """By curve: CPU time, RMS error of green over its mean, paths."""
    volpath = '"volpath" "integer maxdepth" 50'
    runs = {name: (name, volpath) for name in MEDIA}
    runs["homogeneous, without light samples"] = ("homogeneous", volpath + ' "bool sampledirect" false')
    curves = {}
    for curve, (name, integrator) in runs.items():
        loaded, curves[curve] = frond.loads(scene_of(name, size, integrator), TORUS.parent, wavelengths="hero"), []
        loaded.render(1)
        for samples in ladder:
            image = loaded.render(samples)
            error = float(image.variance[:, :, 1].mean())**0.5 / float(image.rgb[:, :, 1].mean())
            curves[curve].append((image.statistics["cpu_seconds"], error, samples * size**2))
        print(curve, curves[curve][-1], flush=True)
    return curves


def chart_noise(path, curves):
    of, [[panel]] = charts.figure(800, 520)
    for i, (name, points) in enumerate(curves.items()):
        panel.loglog([p[0] for p in points], [p[1] for p in points], "osD^vPX"[i] + "-", color=charts.COLORS[i], label=name)
    panel.set(xlabel="CPU time (s)", ylabel="RMS error of green over its mean")
    charts.legend(of, panel, 3)
    charts.save(of, path)


def page(rows, z, curves):
    costs = [(name, f"{1e6 * p[-1][0] / p[-1][2]:.2f}", f"{p[-1][1]:.4f}") for name, p in curves.items()]
    samples = next(iter(curves.values()))[-1][2] // SIZE**2
    return f"""`measurements/run media` measures the following. Machine: {machine()}.

**Turbid medium.** BRF at 800 nm of a layer of leaves with spherical leaf angles, leaf area index {LAI}, reflectance {LEAF_R},
transmittance {LEAF_T}, over soil of reflectance {SOIL}, sun at {SUN}°. The solution is by doubling (`measurements/shared/turbid.py`, which
shares no code with frond). Differences from it in per cent, with standard errors: the medium `turbid` by `volpath`, and disks of two
radii by `path`, the mean of {DRAWS} draws. The medium's largest difference is {z:.1f} standard errors. At the direction
of the sun itself (−{SUN}°) disks are brighter by a third at either radius: the hot spot of
leaves of finite size, which the medium does not model. The errors of disks are estimated from so few draws.

{table(("view zenith", "solution", "medium", *(f"disks of {100 * r:g} cm" for r, _ in DISKS)), rows)}
**Noise and cost.** The bodies of the [gallery](gallery.md#medium) at {SIZE} × {SIZE} pixels with hero wavelengths; RMS error of the green channel
over its mean, against CPU time.

![Error against CPU time](images/media-noise.svg)

{table(("medium", "µs per path", f"error at {samples} samples per pixel"), costs)}"""


def mist(docs):
    """Renders the image of a field in mist, and returns its section."""
    scene, image = ROOT / "scenes/outdoors/mist.pbrt", docs / "images/media/mist.jpg"
    image.parent.mkdir(parents=True, exist_ok=True)
    program("render", scene, "--exposure", "auto", "-o", image, *(["--quick", "--spp", 2] if docs != ROOT / "docs" else []))
    lines = scene.read_text(encoding="utf-8").split("\n", 1)[1].replace('Include "field.pbrt"\n', "").strip()
    return f"`scenes/outdoors/mist.pbrt`:\n\n![A field of soybean in mist](images/media/mist.jpg)\n\n```\n{lines}\n```"


def main():
    options = arguments("media", ("--gallery", {"action": "store_true", "help": "render the image of the page instead"}))
    page_file = options.docs / "media.md"
    if options.gallery:
        write_section(page_file, "mist", mist(options.docs), script="media")
        return
    with tempfile.TemporaryDirectory(prefix="frond_media.") as name:
        rows, z = turbid(pathlib.Path(name), 0.03 if options.quick else 0.004)
    curves = noise([4, 16] if options.quick else [4, 16, 64])
    chart_noise(options.docs / "images" / "media-noise.svg", curves)
    write_section(page_file, "media", page(rows, z, curves))


if __name__ == "__main__":
    main()
