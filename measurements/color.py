"""Colours of leaves, integrated over the CIE's table and rendered (section "color" of docs/color.md)

Renders with hero, smpte and meyer. Takes a minute.
  --quick   few samples, into build/color_report
"""

import io
import shutil

import numpy
import pandas

import frond

from .shared import color_difference
from .shared.tools import ROOT, arguments, frond_table, machine, program, table, write_section

STRATEGIES = ("hero", "smpte", "meyer,white=D65")
#: A diffuse surface with the reflectance of a leaf, lit by D65 so that a white one has the colour (1, 1, 1).
SCENE = """
LookAt 0 0 1  0 0 0  0 1 0
Camera "orthographic"
Film "rgb" "integer xresolution" 64 "integer yresolution" 64
Sampler "lattice" "integer pixelsamples" {samples}
Integrator "path" "integer maxdepth" 1
WorldBegin
LightSource "distant" "point3 from" [ 0 0 1 ] "point3 to" [ 0 0 0 ] "spectrum L" "stdillum-D65" "float scale" 3.14159265
Material "diffuse" "spectrum reflectance" [ {reflectance} ]
Shape "disk" "float radius" 9
"""


class Observer:
    """The CIE 1931 observer under D65: sums over the table of CIE 15:2004, every 5 nm."""

    def __init__(self):
        data = pandas.read_csv(ROOT / "tests/reference/cie_1931_2deg_d65_5nm.csv")
        self.nm = data["wavelength_nm"].to_numpy(float)
        self.weights = data[["xbar", "ybar", "zbar"]].to_numpy() * data[["d65"]].to_numpy()
        self.weights /= self.weights[:, 1].sum()

    def xyz(self, reflectance):
        return reflectance @ self.weights


def rgb(xyz):
    return numpy.linalg.solve(color_difference.XYZ_FROM_RGB["linear sRGB"], xyz)


def chroma(xyz):
    return numpy.hypot(*color_difference.lab(xyz)[1:])


def green_over_red(xyz):
    r, g, _ = rgb(xyz)
    return g / r


def row(name, nm, reflectance, surface, xyz):
    _, a, b = color_difference.lab(xyz)
    at_550 = numpy.interp(550, nm, reflectance)
    of_surface = "" if surface is None else f"{numpy.interp(550, nm, surface) / at_550:.2f}"
    return (name, f"{at_550:.3f}", of_surface, f"{xyz[1]:.3f}", f"{chroma(xyz):.1f}",
            f"{numpy.degrees(numpy.arctan2(b, a)) % 360:.0f}°", f"{green_over_red(xyz):.2f}")


def specimens():
    """Names and documentation."""
    return dict(line.split(None, 1) for line in program("list", "specimens").splitlines() if line.startswith("  "))


def of_specimen(name, observer):
    """Reflectance at 8 degrees and the share of light that the surface reflects, at the observer's wavelengths."""
    text, *_ = frond_table("--specimen", name, "--wavelengths", "360:830:5", "--angles", "8")
    data = pandas.read_csv(io.StringIO(text), comment="#")
    assert (data["wavelength_nm"] == observer.nm).all()
    return (data["Rs"] + data["Rd"]).to_numpy(), data["Rs"].to_numpy()


def rendered(reflectance, nm, strategy, samples):
    """XYZ of a surface of this reflectance in a render."""
    pairs = "  ".join(f"{l:g} {r:.7f}" for l, r in zip(nm, reflectance))
    image = frond.loads(SCENE.format(samples=samples, reflectance=pairs), wavelengths=strategy).render()
    return color_difference.xyz(image.rgb.reshape(-1, 3).mean(axis=0, dtype=float), image.color_space)


def measured_leaf(observer):
    """Mean reflectance of the soybean leaves of LOPEX93; that of the nearest end outside of the data."""
    data = pandas.read_csv(ROOT / "tests/reference/lopex93_soybean.csv", comment="#")
    return numpy.interp(observer.nm, data["wavelength_nm"], data["R_mean"])


def page(rows, strategies, paper, measured):
    share = float(rows[0][2])
    worst = max(numpy.abs(rgb(found["hero"]) - rgb(by_hand)).max() for _, by_hand, found in strategies)
    body = []
    for name, by_hand, found in strategies:
        body.append((f"`{name}`", "by integration", f"{chroma(by_hand):.1f}", f"{green_over_red(by_hand):.2f}", ""))
        body += [(f"`{name}`", f"`{s}`", f"{chroma(xyz):.1f}", f"{green_over_red(xyz):.2f}",
                  f"{color_difference.delta_e(color_difference.lab(xyz), color_difference.lab(by_hand)):.2f}") for s, xyz in found.items()]
    return f"""## Colours of the specimens

Reflectance at 8° of the upper side (`frond table --angles 8`), integrated with the CIE's table of the 1931 observer and D65 (CIE
15:2004, every 5 nm). Y: luminance, white is 1. Chroma and hue: C* and h of CIELAB. G/R: green over red of linear sRGB.

{table(("surface", "R at 550 nm", "of this the leaf's surface", "Y", "chroma", "hue", "G/R"), rows)}
The measured leaf is the mean of LOPEX93's soybeans (Hosgood et al. 1994). The colour of `soybean`, the leaf of Baranoski 2006, is
dull beside it: its chroma is {chroma(paper):.1f}, that of the measured leaf is {chroma(measured):.1f}. The white reflection of its
surface is {share:.0%} of what it reflects at 550 nm.

## Colours of the wavelength strategies

Renders of a diffuse surface with the same reflectance, in D65. ΔE₀₀: CIEDE2000 against the integration.

{table(("specimen", "wavelengths", "chroma", "G/R", "ΔE₀₀"), body)}
The linear sRGB of `hero` differs from the integration by {worst:.4f} at most, where white is 1.

{machine()}.
"""


def main():
    options = arguments("color")
    color_difference.check()
    observer, samples = Observer(), 16 if options.quick else 256
    rows, strategies, colors = [], [], {}
    for name in specimens():
        reflectance, surface = of_specimen(name, observer)
        colors[name] = observer.xyz(reflectance)
        rows.append(row(f"`{name}`", observer.nm, reflectance, surface, colors[name]))
        if name in ("soybean", "soybean-lopex"):
            found = {s: rendered(reflectance, observer.nm, s, samples) for s in STRATEGIES}
            strategies.append((name, colors[name], found))
    soybean = measured_leaf(observer)
    measured = observer.xyz(soybean)
    rows.append(row("measured soybean", observer.nm, soybean, None, measured))
    if options.quick:
        options.docs.mkdir(parents=True, exist_ok=True)
        shutil.copy(ROOT / "docs" / "color.md", options.docs)
    write_section(options.docs / "color.md", "color", page(rows, strategies, colors["soybean"], measured))


if __name__ == "__main__":
    main()
