"""What the formats of frond export keep of a leaf, read by the programs that they are for: docs/exports.md."""

import argparse
import csv
import json
import math
import os
import pathlib
import subprocess
import tempfile

import exr
from tools import ROOT, frond, machine, rows, run, table

PYTHON = ROOT / "build" / "exports" / "bin" / "python"
LEAF = "leaf_solved"
ANGLES = (8, 45, 70)
NM = (608, 551, 455)  # red, green and blue of the OSL shader
STEP = 5  # degrees between the directions that are compared
STEEP = 60  # degrees from the normal: beyond, f rises toward grazing

# LBNL/Klems Full: where rings end, and how many patches each has.
RINGS = ((0, 5, 1), (5, 15, 8), (15, 25, 16), (25, 35, 20), (35, 45, 24), (45, 55, 24), (55, 65, 24), (65, 75, 16), (75, 90, 12))
# Primaries and white of Radiance's colours (color.h), of sRGB, and XYZ of sRGB's white.
RADIANCE_PRIMARIES = ((0.640, 0.330), (0.290, 0.600), (0.150, 0.060), (1 / 3, 1 / 3))
SRGB_PRIMARIES = ((0.64, 0.33), (0.30, 0.60), (0.15, 0.06), (0.3127, 0.3290))


class Reference:
    """f of the leaf by the goniophotometer, mean over 5 x 5 degrees, R and T by the spectrophotometer."""

    def __init__(self, rays):
        self.f, self.shares = {}, {}
        for front in (True, False):
            angles = ",".join(str(a if front else 180 - a) for a in ANGLES)
            words = (LEAF, "incident=reciprocal", "--angles", angles, "--wavelengths", ",".join(map(str, NM)), "--csv", "-", "-q")
            for p in rows(frond("goniophotometer", *words, "--integrate", "--patches", f"{180 // STEP}x{360 // STEP}")):
                a = p["incidence_deg"]
                light = (p["wavelength_nm"], front, a if front else 180 - a)
                viewer_in_front = p["theta_deg"] < 90
                view = (viewer_in_front == front, p["theta_deg"] if viewer_in_front else 180 - p["theta_deg"], p["phi_deg"])
                self.f.setdefault(light, []).append((view, p["f_per_sr"], p["projected_solid_angle_sr"]))
            for s in rows(frond("spectrophotometer", *words, "--rays", rays)):
                a = s["theta_deg"]
                self.shares[s["wavelength_nm"], front, a if front else 180 - a] = (s["R"], s["T"], max(s["R_se"], s["T_se"]))

    def lights(self):
        return [(nm, front, a) for nm in NM for front in (True, False) for a in ANGLES]

    def rms(self, light, f, most=90):
        """Of pi times the difference, by projected solid angle, over views up to an angle: reflected and transmitted."""
        sums = {True: [0, 0], False: [0, 0]}
        for view, reference, weight in self.f[light]:
            if view[1] > most:
                continue
            at = sums[view[0]]
            at[0] += weight * (math.pi * (f(light, view) - reference))**2
            at[1] += weight
        return [math.sqrt(s / w) for s, w in (sums[True], sums[False])]


class Klems:
    """A file of one wavelength each, read as Radiance does: the value of the pair of patches that two directions lie in."""

    def __init__(self, folder):
        self.f = {}
        for nm in NM:
            path = folder / f"{nm}.xml"
            frond("export", LEAF, "--format", "radiance", "--wavelengths", nm, "-o", path, "-q")
            for block in path.read_text().split("<WavelengthDataDirection>")[1:]:
                kind, side = block.split("<", 1)[0].split()
                data = block.split("<ScatteringData>")[1].split("<")[0].replace(",", " ").split()
                # The back of the file is the front of the surface.
                self.f[nm, side == "Back", kind == "Reflection"] = list(map(float, data))

    @staticmethod
    def patch(theta, phi):
        first = 0
        for low, high, phis in RINGS:
            if theta < high:
                return first + round(phi / 360 * phis) % phis
            first += phis
        raise ValueError(theta)

    def __call__(self, light, view):
        # Light comes from the other side of the axis than its patch's own direction.
        return self.f[light[0], light[1], view[0]][self.patch(view[1], view[2]) * 145 + self.patch(light[2], 180)]

    def shares(self, light):
        sums = []
        for reflected in (True, False):
            total, out = 0, 0
            for low, high, phis in RINGS:
                ohm = math.pi * (math.cos(math.radians(low))**2 - math.cos(math.radians(high))**2) / phis
                for _ in range(phis):
                    total += ohm * self.f[light[0], light[1], reflected][out * 145 + self.patch(light[2], 180)]
                    out += 1
            sums.append(total)
        return sums


class Table:
    """The default table, linear between its numbers and constant beyond them."""

    def __init__(self, folder):
        path = folder / "t.csv"
        frond("export", LEAF, "--format", "csv", "--wavelengths", ",".join(map(str, sorted(NM))), "-o", path, "-q")
        self.bytes = path.stat().st_size
        self.value = {}
        with open(path, encoding="utf-8") as file:
            for r in csv.DictReader(line for line in file if not line.startswith("#")):
                key = (r["quantity"], float(r["wavelength_nm"]), r["side"] == "front", float(r["theta_i_deg"]))
                if r["quantity"] not in "RT":
                    key += (float(r["theta_o_deg"]), float(r["phi_o_deg"]) % 360)
                self.value[key] = float(r["value"])

    @staticmethod
    def around(x, step, last):
        low = min(math.floor(x / step), last // step)
        t = min(max(x / step - low, 0), 1) if low < last // step else 0
        return [(low * step, 1 - t)] + ([((low + 1) * step, t)] if t > 0 else [])

    def __call__(self, light, view):
        name = "f_r" if view[0] else "f_t"
        return sum(a * b * c * self.value[name, light[0], light[1], i, o, p % 360]
                   for i, a in self.around(light[2], 5, 85) for o, b in self.around(view[1], 5, 85)
                   for p, c in self.around(view[2], 15, 360))

    def shares(self, light):
        return [sum(a * self.value[name, light[0], light[1], i] for i, a in self.around(light[2], 5, 85)) for name in "RT"]


class Cycles:
    """The shader, rendered by Blender's Cycles."""

    def __init__(self, folder, rays, samples):
        shader = folder / "leaf.osl"
        frond("export", LEAF, "--format", "osl", "--wavelengths", ",".join(map(str, NM)), "--rays", rays, "-o", shader, "-q")
        sides = (True, False)
        questions = [{"shares": [a, s], "samples": samples} for s in sides for a in ANGLES]
        questions += [{"f": [a, s, v], "step": STEP} for s in sides for a in ANGLES for v in sides]
        run(PYTHON, ROOT / "tests" / "exports" / "osl_render.py", shader, folder / "answers.json", stdin=json.dumps(questions))
        answers = iter(json.loads((folder / "answers.json").read_text()))
        self.of_light, self.furnace, self.f = {}, {}, {}
        for s in sides:
            for a in ANGLES:
                found = next(answers)
                for c, nm in enumerate(NM):
                    self.of_light[nm, s, a] = [found["R"][c], found["T"][c]]
                    self.furnace[nm, s, a] = found["furnace"][c]
        for s in sides:
            for a in ANGLES:
                for v in sides:
                    for theta, phi, color in next(answers):
                        for c, nm in enumerate(NM):
                            self.f[nm, s, a, v == s, round(theta, 1), round(phi) % 360] = color[c]
        self.version = run(PYTHON, "-c", "import bpy; print(bpy.app.version_string)").split()[-1]

    def __call__(self, light, view):
        return self.f[(*light, view[0], round(view[1], 1), round(view[2]) % 360)]

    def shares(self, light):
        return self.of_light[light]


def comparison(reference, program):
    """A row for each light; and the largest errors."""
    body, errors = [], {"R": 0, "T": 0, "r": 0, "t": 0, "steep": 0}
    for light in reference.lights():
        r, t = program.shares(light)
        true_r, true_t, _ = reference.shares[light]
        of_r, of_t = reference.rms(light, program)
        steep = max(reference.rms(light, program, STEEP))
        for key, x in (("R", abs(r - true_r)), ("T", abs(t - true_t)), ("r", of_r), ("t", of_t), ("steep", steep)):
            errors[key] = max(errors[key], x)
        body.append([light[0], "front" if light[1] else "back", f"{light[2]}°", f"{true_r:.4f}", f"{r:.4f}", f"{true_t:.4f}",
                     f"{t:.4f}", f"{of_r:.4f}", f"{of_t:.4f}"])
    text = table(["nm", "side", "angle", "R", "R of the export", "T", "T of the export", "RMS π Δf, reflected", "transmitted"], body)
    return text, errors


def xyz_over_white(primaries, rgb):
    """X, Y and Z over those of (1, 1, 1), of a space with these primaries and this white."""
    columns = [(x / y, 1, (1 - x - y) / y) for x, y in primaries[:3]]
    white = (primaries[3][0] / primaries[3][1], 1, (1 - sum(primaries[3])) / primaries[3][1])
    det = lambda a, b, c: (a[0] * (b[1] * c[2] - b[2] * c[1]) - b[0] * (a[1] * c[2] - a[2] * c[1]) +
                           c[0] * (a[1] * b[2] - a[2] * b[1]))
    whole = det(*columns)
    scale = [det(*(white if i == j else columns[j] for j in range(3))) / whole for i in range(3)]
    return [sum(columns[i][k] * scale[i] * rgb[i] for i in range(3)) / white[k] for k in range(3)]


class Scene:
    """A leaf that fills the picture, under parallel light, by rtrace and by frond."""

    SIZE, FOV, LIGHT, VIEW = 48, 40, 40, 30  # pixels; degrees, the latter two from the normal, on both sides of it
    TIMES = 32  # that rtrace follows each ray: what it makes of one is random

    def __init__(self, folder, material, samples):
        self.folder, self.material = folder, material
        home = pathlib.Path(run(PYTHON, "-c", "import pyradiance; print(pyradiance.__path__[0])").strip())
        self.environment = dict(os.environ, RAYPATH=f".:{home / 'lib'}", PATH=f"{home / 'bin'}:{os.environ['PATH']}")
        frond("export", *material, "--format", "radiance", "-o", folder / "leaf.xml", "-q")
        self.report = self.radiance("checkBSDF", "leaf.xml")
        self.samples = samples

    def radiance(self, *words, text=True, **more):
        return subprocess.run(list(map(str, words)), cwd=self.folder, env=self.environment, check=True, capture_output=True,
                              text=text, **more).stdout

    @staticmethod
    def direction(theta_deg, front):
        theta = math.radians(theta_deg)
        return (math.sin(theta), 0, math.cos(theta) if front else -math.cos(theta))

    def by_radiance(self, lit_in_front, seen_in_front):
        half = 0.2
        radiance = 1 / (2 * math.pi * (1 - math.cos(math.radians(half))))
        toward = " ".join(map(str, self.direction(self.LIGHT, lit_in_front)))
        (self.folder / "scene.rad").write_text(
            f"void light sun\n0\n0\n3 {radiance} {radiance} {radiance}\nsun source s\n0\n0\n4 {toward} {2 * half}\n"
            "void BSDF leaf\n6 0 leaf.xml 0 1 0 .\n0\n0\nleaf polygon p\n0\n0\n12 -90 -90 0  90 -90 0  90 90 0  -90 90 0\n")
        (self.folder / "scene.oct").write_bytes(self.radiance("oconv", "scene.rad", text=False))
        x, _, z = eye = [3 * a for a in self.direction(-self.VIEW, seen_in_front)]
        forward, right = [-a / 3 for a in eye], (0, 1, 0)
        up = [-z / 3, 0, x / 3]
        rays, tangent = [], math.tan(math.radians(self.FOV / 2))
        for j in range(self.SIZE):
            for i in range(self.SIZE):
                a, b = ((2 * (k + 0.5) / self.SIZE - 1) * tangent for k in (i, j))
                rays.append(" ".join(map(str, (*eye, *(f + a * r + b * u for f, r, u in zip(forward, right, up))))))
        text = self.radiance("rtrace", "-h", "-ab", 0, "-dj", 0, "-lw", 1e-6, "scene.oct", input="\n".join(rays * self.TIMES) + "\n")
        found = [xyz_over_white(RADIANCE_PRIMARIES, list(map(float, line.split()))) for line in text.splitlines() if line.strip()]
        return [[sum(p[c] for p in found[i::len(rays)]) / self.TIMES for c in range(3)] for i in range(len(rays))]

    def by_frond(self, lit_in_front, seen_in_front):
        words = lambda v: " ".join(map(str, v))
        eye = [3 * a for a in self.direction(-self.VIEW, seen_in_front)]
        (self.folder / "scene.pbrt").write_text(f"""LookAt {words(eye)}  0 0 0  1 0 0
Camera "perspective" "float fov" {self.FOV}
Film "rgb" "integer xresolution" {self.SIZE} "integer yresolution" {self.SIZE}
PixelFilter "box"
WorldBegin
LightSource "distant" "point3 from" [{words(self.direction(self.LIGHT, lit_in_front))}] "point3 to" [0 0 0] "spectrum L" "stdillum-D65"
Material "{self.material[0]}" {"" if len(self.material) == 1 else '"string incident" "reciprocal"'}
Shape "trianglemesh" "point3 P" [-90 -90 0  90 -90 0  90 90 0  -90 90 0] "integer indices" [0 1 2  0 2 3]
""")
        path = self.folder / "scene.exr"
        frond("render", self.folder / "scene.pbrt", "--spp", self.samples, "-o", path, "-q")
        return [xyz_over_white(SRGB_PRIMARIES, [row[c][x] for c in "RGB"])
                for row in exr.read(path.read_bytes(), ["R", "G", "B"]) for x in range(self.SIZE)]

    def comparison(self):
        body, worst = [], [0, 0, 0]
        mean = lambda pixels, c: sum(p[c] for p in pixels) / len(pixels)
        for lit in (True, False):
            for seen in (True, False):
                a, b = self.by_radiance(lit, seen), self.by_frond(lit, seen)
                assert len(a) == len(b)
                ys = sorted(p[1] for p in a), sorted(p[1] for p in b)
                ends = lambda y: f"{y[len(y) // 20]:.4f} to {y[-1 - len(y) // 20]:.4f}"
                cells = []
                for c in range(3):
                    ours, theirs = mean(b, c), mean(a, c)
                    worst[c] = max(worst[c], abs(theirs / ours - 1))
                    cells.append(f"{ours:.4f}, {theirs:.4f}")
                body.append(["front" if lit else "back", "front" if seen else "back"] + cells + [ends(ys[1]), ends(ys[0])])
        return table(["lit", "seen", "X", "Y", "Z", "Y of 90 % of the pixels, frond", "Radiance"], body), worst


def has(module):
    return PYTHON.exists() and subprocess.run([PYTHON, "-c", f"import {module}"], capture_output=True, check=False).returncode == 0


def largest(errors):
    return (f"Largest errors: R {errors['R']:.4f}, T {errors['T']:.4f}; RMS of π Δf {errors['r']:.4f} reflected, "
            f"{errors['t']:.4f} transmitted; over views up to {STEEP}° from the normal {errors['steep']:.4f}.\n")


INTRODUCTION = """# Exports

Written by `scripts/exports`. {machine}

```
frond export NAME[,parameter=value...] --format radiance|csv|npz|netcdf|osl -o FILE
```

writes a material's BSDF for other programs. The material is named as for the [instruments](instruments.md). What is exported is
f as a renderer sees it: light from one direction, seen from another. Leaves are `reciprocal` where nothing is said of their
`incident`, as in `frond brf`: other programs follow light from either end ([reciprocal_leaf.md](reciprocal_leaf.md)).

Refused with a reason: materials whose f is a random estimate (`abm`; `leaf_solved` is its mean), that have a delta lobe, or that
refract light into another medium; wavelengths that the material's data do not reach; options that a format does not look at.
Files are written whole or not at all; `-` is standard output for formats that are text.

| format | for | keeps | error below |
|---|---|---|---|
| `radiance` | Radiance, WINDOW | f averaged over 145 × 145 pairs of patches, both sides | [patches](#klems-patches-for-radiance) |
| `csv`, `npz`, `netcdf` | everybody | R, T, and f at single directions, exactly | [between directions](#tables) |
| `osl` | Blender's Cycles | R and T by angle and side; f as three lobes | [lobes](#an-osl-shader-for-cycles) |

Errors are those of `{leaf}` (soybean): R and T beside `frond spectrophotometer --rays {rays}` (standard errors up to {se:.5f}), f
beside `frond goniophotometer --integrate` with patches of {step}° by {step}°: the RMS of π Δf over all directions of a side, by
projected solid angle; white paper has π f = 1.

"""

RADIANCE = """## Klems patches for Radiance

`--format radiance` writes XML as WINDOW 6 has it (LBNL/Klems Full), transmission and reflection from both sides. A value
is f averaged over both patches with respect to projected solid angle: by Gauss's rules of rising order until two agree within
2·10⁻⁵ and 2·10⁻⁴ of themselves, in π f; the file says by how much the last two differ at most.

- Light: by default 380 to 780 nm in steps of 10, or `--wavelengths`; linear in between, and the nearest beyond. Radiance's reader
  takes the blocks `Visible` (Y), `CIE-X` and `CIE-Z`: each is weighed by D65 and the CIE 1931 function, and divided by what
  white would have, so that grey stays grey. One wavelength alone makes one block, `Visible`.
- Sides: frond's front (adaxial side, +z) is the front of a Radiance surface, whose normal goes by the right-hand rule. WINDOW
  calls that side back. Of a material that is not the same all around, frond's x and y are Radiance's with the up vector
  `0 1 0` and the surface's normal along z.
- Solar blocks, which WINDOW wants for heat, are not written.
- A lobe that is narrower than a patch is spread over it: that is the format's error, and it goes for the direction of light
  as well. A warning tells where a lobe was too narrow to be integrated.

```
frond export leaf_solved,specimen=soybean --format radiance -o leaf.xml
```

and in the scene

```
void BSDF leaf
6 0 leaf.xml 0 1 0 .
0
0
```

An R or T of the export is that of the patch which the angle lies in, light from all over it: 8° is in the ring from 5 to 15, 70° in
that from 65 to 75, 45° at the lower edge of that from 45 to 55.

"""

TABLES = """## Tables

`--format csv`, `npz` and `netcdf` hold the same numbers: R and T over (wavelength, side, θi), and f over (wavelength, side, θi,
θo, φo, kind), kind being reflected or transmitted. `--wavelengths` has to be given; `--angles` (θi) and `--view-angles` (θo)
are every 5° up to 85° by default, `--view-azimuths` every 15° all around.

| axis | unit | |
|---|---|---|
| `wavelength` | nm | |
| `side` | | front (adaxial, +z) or back: where the light is |
| `theta_i`, `theta_o` | degree | from the normal, each on its own side |
| `phi_o` | degree | from the light's azimuth to the viewer's: the mirror direction is at 180 |
| `kind` | | reflected, transmitted |
| `R`, `T` | 1 | shares of the light, integrated to 10⁻⁴ of themselves |
| `f` | 1/sr | at single directions, as 32-bit floats |

- `csv`: long form, a line for each number; `quantity` is R, T, f_r or f_t.
- `npz`: `numpy.load("leaf.npz")["f_per_sr"]`; `axes` names the axes of it. Not compressed; the same input makes the same bytes.
- `netcdf`: classic, with attributes of the CF conventions (`units`, `long_name`, `flag_meanings`), which scipy, xarray and
  ncdump read. Debian's libnetcdf-dev has to be there when frond is built, else the format is refused; the library is opened
  when it is asked for.

At their nodes the numbers are frond's own. Read with linear interpolation in θi, θo and φo, and the last angle beyond it, the
default table ({megabytes:.1f} MB of CSV for three wavelengths) gives

"""

OSL = """## An OSL shader for Cycles

`--format osl` writes a shader `frond_leaf` of three lobes, as `leaf_simplified` has them: Cycles' `phong_ramp` for the surface,
`diffuse` for what comes back out of the leaf and `translucent` for what crosses it, weighed by tables of Rs, Rd and T over the
viewing angle (every 2.5°) and the side. Red, green and blue are 608, 551 and 455 nm, or three `--wavelengths` in that order, and
go into the renderer's own colours as they are.

- R and T are f integrated to 10⁻⁴ of themselves; how much of R is Rs is told by rays (`--rays`, 10⁶ each by default). A material
  that does not tell its surface from its body has no surface lobe, and a warning says so.
- The lobe's exponent follows from the surface's rays at normal incidence. Cycles weighs its lobe by the cosine with the
  normal besides, frond does not; the table divides by what Cycles' lobe alone sends on, so that Rs stays Rs.
- A closure's weight knows the viewer's angle and not the light's: R and T are kept, f is not reciprocal, and `incident=light` is
  refused.
- In Blender: render engine Cycles, Open Shading Language on, a Script node with the file, its BSDF to the material's Surface. The
  front is the side of the face's normal.

"""


def main():
    parser = argparse.ArgumentParser(prog="scripts/exports", description=__doc__)
    parser.add_argument("--quick", action="store_true")
    quick = parser.parse_args().quick
    rays, samples, spp = ("1e4", 64, 64) if quick else ("1e6", 4096, 1024)
    reference = Reference(rays)
    with tempfile.TemporaryDirectory() as temporary:
        folder = pathlib.Path(temporary)
        text = INTRODUCTION.format(machine=machine(), leaf=LEAF, rays=rays, step=STEP,
                                   se=max(s[2] for s in reference.shares.values()))
        klems, errors = comparison(reference, Klems(folder))
        text += RADIANCE + klems + "\n" + largest(errors)
        if has("pyradiance"):
            scene = Scene(folder, (LEAF, "incident=reciprocal"), spp)
            pictures, worst = scene.comparison()
            _, of_paper = Scene(folder, ("diffusetransmission",), spp).comparison()
            text += f"""
`checkBSDF` of Radiance says of the file with colour, which `wrapBSDF` reads too (`tests/exports/readers_test.py`)

```
{scene.report[scene.report.index("Type:"):].strip()}
```

**A scene**: a leaf that fills a picture of {Scene.SIZE} × {Scene.SIZE} pixels, parallel light of D65 of irradiance 1 across it at
{Scene.LIGHT}° from the normal, a perspective camera of {Scene.FOV}° at {Scene.VIEW}° on the other side of the normal. X, Y and Z over those of white, mean
over the picture: `frond render` ({spp} samples a pixel), Radiance (`rtrace -ab 0`, {Scene.TIMES} rays a
pixel). Means of Y differ by up to {100 * worst[1]:.1f} %, of X and Z by up to {100 * max(worst):.1f} %; of a `diffusetransmission` in place of the
leaf, whose f patches do not change, by up to {100 * of_paper[1]:.1f} and {100 * max(of_paper):.1f} %:

{pictures}"""
        else:
            text += "\nRadiance (pyradiance) could not be installed: no picture was rendered.\n"
        values = Table(folder)
        body, errors = comparison(reference, values)
        text += "\n" + TABLES.format(megabytes=values.bytes / 1e6) + body + "\n" + largest(errors)
        text += "\n" + OSL
        if has("bpy"):
            cycles = Cycles(folder, rays, samples)
            body, errors = comparison(reference, cycles)
            furnace = max(abs(cycles.furnace[light] - sum(reference.shares[light][:2])) for light in reference.lights())
            text += f"""Rendered by Cycles of Blender {cycles.version}: R and T are what the sheet shows under half a sky of radiance 1 ({64 * samples}
paths), f what it shows under parallel light. In a furnace, under a whole sky, R + T is off by up to {furnace:.4f}.

{body}
{largest(errors)}"""
        else:
            text += "Blender (bpy) could not be installed: the shader was not rendered.\n"
    home = ROOT / "build" / "exports_report" if quick else ROOT / "docs"
    home.mkdir(parents=True, exist_ok=True)
    (home / "exports.md").write_text(text, encoding="utf-8")
    print(f"Written: {home / 'exports.md'}")


if __name__ == "__main__":
    main()
