"""Light "sky" against SPECTRL2 and the sky of Hosek and Wilkie, its noise and cost (section "outdoors" of docs/outdoors.md)

Writes charts, too.
  --gallery   renders the images of the section "A day outdoors" instead, some 20 minutes
  --quick     few samples, into build/outdoors_report
"""

import math

import numpy

import frond

from .shared import charts
from .shared.tools import ROOT, arguments, machine, program, rms, table, write_section

REFERENCE = ROOT / "tests" / "reference"
SHARED = 4  # conditions of spectrl2.csv in the chart; the table has all
HOSEK = {3: 0.2, 5: 0.4}  # aerosol optical depth that has about this turbidity at 550 nm
WHITE = 'Material "diffuse" "spectrum reflectance" [ 300 1 2500 1 ] Shape "disk" "float radius" 9\n'
CONSTANT = ('LightSource "infinite" "spectrum L" "stdillum-D65" "float scale" 5\nLightSource "distant" "point3 from" '
            '[ -0.47 -0.17 0.866 ] "point3 to" [ 0 0 0 ] "spectrum L" "stdillum-D65" "float scale" 100')
LIGHTS = {"sky, sun at 60°": 'LightSource "sky" "float elevation" 60 "float azimuth" 200',
          "sky, sun at 10°": 'LightSource "sky" "float elevation" 10 "float azimuth" 200',
          "sky, overcast": 'LightSource "sky" "string sky" "overcast"',
          "constant sky and distant light": CONSTANT}


def reference(name):
    return numpy.loadtxt(REFERENCE / name, delimiter=",", comments="#")


def scene(light, world, look, size, samples, bands):
    """The mean over the image of each band, and its standard error."""
    text = f"""LookAt {look}
Camera "orthographic" "float screenwindow" [ -0.1 0.1 -0.1 0.1 ]
Film "rgb" "integer xresolution" {size} "integer yresolution" {size}
PixelFilter "box"
Sampler "independent" "integer pixelsamples" {samples}
WorldBegin
{light}
{world}"""
    image = frond.loads(text, wavelengths=list(bands)).render(samples)
    pixels = image.array[:, :, :len(bands)].reshape(-1, len(bands)).astype(float)
    return pixels.mean(axis=0), pixels.std(axis=0) / math.sqrt(len(pixels))


def irradiances(samples):
    """Of each condition of spectrl2.csv: its row of inputs, wavelengths, SPECTRL2's values, and what a white plane measures."""
    rows, found = reference("spectrl2.csv"), []
    for condition in numpy.split(rows, len(rows) // 107):
        zenith, aerosol, angstrom, water, ozone, pressure, albedo, day = condition[0][:8]
        light = (f'LightSource "sky" "float elevation" {90 - zenith} "float azimuth" 40 "float aerosol" {aerosol} "float angstrom" '
                 f'{angstrom} "float water" {water} "float ozone" {ozone} "float pressure" {pressure} "float albedo" {albedo} '
                 f'"integer day" {int(day)}')
        nm, direct, diffuse = condition[:, 8], condition[:, 10] * math.cos(math.radians(zenith)), condition[:, 11]
        mean, error = scene(light, WHITE, "0 0 3  0 0 0  0 1 0", 32, samples, nm)
        found.append((condition[0][:8], nm, direct, diffuse, mean * math.pi, error * math.pi))
    return found


def chart_irradiances(path, found):
    of, [row] = charts.figure(1300, 420, 1, SHARED, sharey=True)
    for panel, (inputs, nm, direct, diffuse, mean, _) in zip(row, found):
        panel.plot(nm, direct + diffuse, color=charts.COLORS[1], label="total, SPECTRL2")
        panel.plot(nm, diffuse, color=charts.COLORS[3], label="diffuse, SPECTRL2")
        panel.plot(nm, mean, ".", color=charts.COLORS[2], markersize=3, label="total, frond's white plane")
        panel.set(title=f"sun {90 - inputs[0]:g}° high, aerosol {inputs[1]:g}", xlabel="wavelength (nm)")
    row[0].set_ylabel("irradiance (W m⁻² nm⁻¹)")
    charts.legend(of, row[0], 3)
    charts.save(of, path)


def radiance(light, zenith):
    """In the plane of a sun at azimuth 0, at 550 nm; negative zenith angles are away from the sun."""
    x, z = math.sin(math.radians(zenith)), math.cos(math.radians(zenith))
    return scene(light, "", f"0 0 0  {x} 0 {z}  0 1 0", 1, 1, [550])[0][0]


def chart_shapes(path):
    """Beside Hosek and Wilkie: returns RMS relative differences by sky and wavelength."""
    rows, differences = reference("sky_hosek.csv"), []
    of, [row] = charts.figure(1300, 460, 1, 2, sharey=True)
    for panel, turbidity in zip(row, HOSEK):
        sky = rows[rows[:, 1] == turbidity]
        sun = sky[0, 0]
        light = f'LightSource "sky" "float elevation" {90 - sun} "float aerosol" {HOSEK[turbidity]}'
        zenith = numpy.arange(-87.5, 88, 2.5)
        zenith = zenith[abs(zenith - sun) > 1]
        diffuse = diffuse_of(light)
        panel.semilogy(zenith, [radiance(light, z) / diffuse for z in zenith], color=charts.COLORS[0], label="frond, every wavelength")
        for hue, nm in zip((1, 3, 2), (400, 550, 700)):
            at = sky[sky[:, 5] == nm]
            angle = numpy.where(at[:, 4] == 0, 1, -1) * at[:, 3]
            at, angle = at[angle != sun], angle[angle != sun]  # frond's light has its disc there
            order = numpy.argsort(angle)
            panel.semilogy(angle[order], at[order, 6], "o--", color=charts.COLORS[hue], label=f"Hosek and Wilkie, {nm} nm")
            own = numpy.array([radiance(light, z) for z in angle]) / diffuse
            differences.append((f"{90 - sun:g}°", HOSEK[turbidity], nm, f"{100 * rms(own / at[:, 6] - 1):.0f} %"))
        panel.set(title=f"sun at {90 - sun:g}°, turbidity {turbidity}, aerosol {HOSEK[turbidity]}", xlabel="zenith angle in the sun's plane (degrees)")
    row[0].set_ylabel("radiance over diffuse irradiance (1/sr)")
    charts.legend(of, row[0], 4)
    charts.save(of, path)
    return differences


def diffuse_of(light):
    """Diffuse irradiance at 550 nm, from an image of all directions in the equal-area map, without the sun."""
    size = 256
    text = f"""LookAt 0 0 0  0 1 0  0 0 1
Camera "spherical" "string mapping" "equalarea"
Film "rgb" "integer xresolution" {size} "integer yresolution" {size}
PixelFilter "box"
Option "bool disablepixeljitter" true
WorldBegin
{light}"""
    image = frond.loads(text, wavelengths=[550]).render(1).array[:, :, 0].astype(float)
    x, y = numpy.meshgrid((numpy.arange(size) + 0.5) / size * 2 - 1, (numpy.arange(size) + 0.5) / size * 2 - 1)
    d = 1 - abs(x) - abs(y)
    cosine = numpy.where(d > 0, 1 - (1 - abs(d)) ** 2, 0)
    sun = image > 50 * numpy.median(image[d > 0])
    image[sun] = numpy.median(image[d > 0])
    return (image * cosine).sum() * 4 * math.pi / size**2


def noise(ladder):
    text = (ROOT / "scenes/outdoors/scene.pbrt").read_text(encoding="utf-8").replace('"../', f'"{ROOT}/scenes/')
    text = text.replace('resolution" 512', 'resolution" 160').replace('"string type" "leaf" ', '"string type" "leaf_solved" ')
    light = next(line for line in text.splitlines() if line.startswith("LightSource"))
    curves = {}
    for name, other in LIGHTS.items():
        loaded, curves[name] = frond.loads(text.replace(light, other), wavelengths="hero"), []
        loaded.render(1)
        for samples in ladder:
            image = loaded.render(samples)
            error = math.sqrt(float(image.variance[:, :, 1].mean())) / float(image.rgb[:, :, 1].mean())
            curves[name].append((image.statistics["cpu_seconds"], error, samples * 160 * 160))
        print(name, curves[name][-1], flush=True)
    return curves


def chart_noise(path, curves):
    of, [[panel]] = charts.figure(800, 480)
    for hue, mark, (name, points) in zip(charts.COLORS[1:], "osD^", curves.items()):
        panel.loglog([p[0] for p in points], [p[1] for p in points], f"{mark}-", color=hue, label=name)
    panel.set(xlabel="CPU time (s)", ylabel="RMS error of green over its mean")
    charts.legend(of, panel, 2)
    charts.save(of, path)


def page(found, differences, curves):
    rows = []
    for inputs, nm, direct, diffuse, mean, error in found:
        ratio = mean / (direct + diffuse) - 1
        rows.append((f"{90 - inputs[0]:g}°", *(f"{v:g}" for v in inputs[1:]), f"{100 * abs(ratio).max():.2f} %",
                     f"{100 * (error / mean).max():.2f} %"))
    baseline = curves["constant sky and distant light"][-1]
    costs = [(name, f"{1e6 * p[-1][0] / p[-1][2]:.2f}", f"{p[-1][0] / baseline[0]:.2f}", f"{p[-1][1]:.4f}") for name, p in curves.items()]
    return f"""`measurements/run outdoors` measures the following. Machine: {machine()}.

**Irradiance.** Total irradiance that a white horizontal plane measures, against SPECTRL2 (pvlib 0.16.1), at its 107 wavelengths. The
largest difference includes noise; the last column is the largest standard error.

{table(("sun", "aerosol", "angstrom", "water", "ozone", "pressure", "albedo", "day", "largest difference", "standard error"), rows)}
![Spectral irradiance of four clear days](images/outdoors-irradiance.svg)

**Angular distribution.** Radiance in the sun's plane over the diffuse irradiance, beside the model of Hosek and Wilkie (2012), which
is a fit to simulations of scattering. Its blue sky is flatter and its red sky steeper than its green one; Perez's distribution, fitted
to measurements, is the same for all. Its RMS difference from their model over 8 or 9 directions:

{table(("sun", "aerosol", "nm", "RMS difference"), differences)}
![Relative radiance in the sun's plane](images/outdoors-distribution.svg)

**Noise and cost.** The scene of this page at 160 × 160 pixels, with `leaf_solved` and hero wavelengths; RMS error of the green channel
over its mean, against CPU time.

![Error against CPU time](images/outdoors-noise.svg)

{table(("light", "µs per path", "relative", f"error at {int(baseline[2] / 160**2)} samples per pixel"), costs)}"""


#: Scenes of the gallery, with what changes in each.
GALLERY = {"morning": "An hour after sunrise in haze", "noon": "Noon in June", "overcast": "An overcast day",
           "wet": "After rain: wet soil", "autumn": "Autumn", "wind": "Wind: leaves that move"}


def gallery(docs):
    """Renders the gallery's scenes, and returns its section: images with the lines that differ."""
    text = ["Scenes of `scenes/outdoors`: a field, and a plant. The lines below are all that they say of light, soil and season. The images are",
            "exposed by `--exposure auto`, since a morning has a seventh of noon's light."]
    for name, title in GALLERY.items():
        scene, image = ROOT / "scenes/outdoors" / f"{name}.pbrt", docs / "images/outdoors" / f"{name}.jpg"
        image.parent.mkdir(parents=True, exist_ok=True)
        program("render", scene, "--exposure", "auto", "-o", image, *(["--quick", "--spp", 2] if docs != ROOT / "docs" else []))
        lines = scene.read_text(encoding="utf-8").split("WorldBegin\n")[1].replace('Include "field.pbrt"\n', "").strip()
        text.append(f"\n**{title}.** `scenes/outdoors/{name}.pbrt`\n\n![{title}](images/outdoors/{name}.jpg)\n\n```\n{lines}\n```")
        print(name, flush=True)
    return "\n".join(text)


def main():
    options = arguments("outdoors", ("--gallery", {"action": "store_true", "help": "render the images of the page instead"}))
    if options.gallery:
        write_section(options.docs / "outdoors.md", "gallery", gallery(options.docs), script="outdoors")
        return
    samples, ladder = (64, [4, 16]) if options.quick else (2048, [4, 16, 64, 256])
    images = options.docs / "images"
    found = irradiances(samples)
    chart_irradiances(images / "outdoors-irradiance.svg", found)
    differences = chart_shapes(images / "outdoors-distribution.svg")
    curves = noise(ladder)
    chart_noise(images / "outdoors-noise.svg", curves)
    write_section(options.docs / "outdoors.md", "outdoors", page(found, differences, curves))


if __name__ == "__main__":
    main()
