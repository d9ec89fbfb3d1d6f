"""Gallery: an image of every plug-in that a scene can name (docs/gallery.md)

Renders a small image for each, and writes it with the lines of the scene that made it. Takes some minutes.
  --only WORD   only those whose names contain the word
  --quick       few samples, into build/gallery_report
"""

import math
import pathlib
import shutil
import tempfile

import frond
from PIL import Image

from .shared.tools import ROOT, arguments, write

SIZE = 200
SAMPLES = 256

# Made by this script beside a scene that reads it: an image with an up and a left.
LETTER = "letter.png"
# Copied there.
MEASURED = ROOT / "tests" / "pbrt_reference" / "brushed.bsdf"
TORUS = ROOT / "tests" / "pbrt_reference" / "torus.nvdb"

VIEW = """Scale -1 1 1
LookAt 0.4 -5 2.1   0 0 0.72   0 0 1
Camera "perspective" "float fov" 27
"""
LIGHT = """AttributeBegin
  Translate -2.2 -2.6 3.6
  Rotate 128 1 0 0.3
  AreaLightSource "diffuse" "spectrum L" "stdillum-D65" "float scale" 9
  Shape "disk" "float radius" 0.8
AttributeEnd
LightSource "infinite" "spectrum L" "stdillum-D65" "float scale" 0.35
"""
FLOOR = """AttributeBegin
  Texture "tiles" "spectrum" "checkerboard" "float uscale" 12 "float vscale" 12
    "rgb tex1" [ 0.5 0.5 0.5 ] "rgb tex2" [ 0.28 0.28 0.3 ]
  Material "diffuse" "texture reflectance" "tiles"
  Shape "bilinearmesh" "point3 P" [ -4 -4 0  4 -4 0  -4 4 0  4 4 0 ]
AttributeEnd
"""
BALL = """AttributeBegin
  Translate 0 0 0.8
  Rotate 20 0 0 1
  Shape "sphere" "float radius" 0.8
AttributeEnd
"""
LEAFLET = f"""AttributeBegin
  Translate -0.35 -0.3 0.3
  Rotate -55 0 1 0
  Rotate 100 1 0 0
  Scale 16 16 16
  Shape "plymesh" "string filename" "{ROOT}/scenes/meshes/leaflet-terminal-1.ply"
AttributeEnd
"""
def awn(i, count):
    """A curve of a tuft: the i-th of `count`, by the golden angle."""
    lean, angle = math.sqrt((i + 0.5) / count), 2.39996 * i
    places = ((0.2 * lean, 0), (0.3 * lean, 0.6), (0.6 * lean, 1.2), (1.1 * lean, 1.7 - 0.5 * lean))
    points = "  ".join(f"{out * math.cos(angle):.3f} {out * math.sin(angle):.3f} {height:.3f}" for out, height in places)
    return f'Shape "curve" "string type" "cylinder" "float width0" 0.035 "float width1" 0.01 "point3 P" [ {points} ]\n'


TUFT = "".join(awn(i, 260) for i in range(260))
FILM = f'Film "rgb" "integer xresolution" {SIZE} "integer yresolution" {SIZE}\n'
GREY = 'Material "diffuse" "rgb reflectance" [ 0.5 0.5 0.5 ]\n'
RED = 'Material "diffuse" "rgb reflectance" [ 0.55 0.12 0.06 ]\n'

# A number shows as colour and as height.
BUMPS = """
Texture "colors" "spectrum" "mix" "rgb tex1" [ 0.6 0.55 0.5 ] "rgb tex2" [ 0.03 0.2 0.3 ] "texture amount" "heights"
Material "diffuse" "texture reflectance" "colors" "texture displacement" "heights"
"""

# By kind and name: the lines of interest; where there are none, the plugin with its defaults.
MATERIALS = {
    "conductor": 'Material "conductor" "spectrum eta" "metal-Au-eta" "spectrum k" "metal-Au-k" "float roughness" 0.02',
    "dielectric": 'Material "dielectric" "spectrum eta" "glass-BK7"',
    "thindielectric": 'Material "thindielectric" "float eta" 1.5',
    "coateddiffuse": 'Material "coateddiffuse" "rgb reflectance" [ 0.45 0.08 0.05 ]',
    "coatedconductor": 'Material "coatedconductor" "float conductor.roughness" 0.1 "float thickness" 0.02',
    "diffuse": 'Material "diffuse" "rgb reflectance" [ 0.2 0.35 0.6 ]',
    "diffusetransmission": 'Material "diffusetransmission" "rgb reflectance" [ 0.3 0.2 0.1 ] "rgb transmittance" [ 0.1 0.3 0.4 ]',
    "hair": 'Material "hair" "rgb reflectance" [ 0.75 0.55 0.25 ] "float beta_m" 0.2',
    "measured": f'Material "measured" "string filename" "{MEASURED.name}"',
    "subsurface": 'Material "subsurface" "rgb reflectance" [ 0.75 0.35 0.12 ] "rgb mfp" [ 0.25 0.08 0.04 ] "float roughness" 0.02',
    "mix": 'MakeNamedMaterial "gold" "string type" "conductor" "spectrum eta" "metal-Au-eta" "spectrum k" "metal-Au-k"\n'
           'MakeNamedMaterial "blue" "string type" "diffuse" "rgb reflectance" [ 0.1 0.2 0.6 ]\n'
           'Texture "stripes" "float" "checkerboard" "float uscale" 12 "float vscale" 0.5 "float tex1" 1 "float tex2" 0\n'
           'Material "mix" "string materials" [ "gold" "blue" ] "texture amount" "stripes"',
} | {name: f'Material "{name}" "string specimen" "soybean-lopex"'
     for name in ("abm", "leaf", "leaf_lambert", "leaf_simplified", "leaf_solved")}
SPECTRUM_TEXTURES = {
    "constant": 'Texture "pattern" "spectrum" "constant" "rgb value" [ 0.15 0.4 0.2 ]',
    "scale": 'Texture "image" "spectrum" "imagemap" "string filename" "letter.png"\n'
             'Texture "pattern" "spectrum" "scale" "texture tex" "image" "float scale" 0.4',
    "mix": 'Texture "image" "spectrum" "imagemap" "string filename" "letter.png"\n'
           'Texture "pattern" "spectrum" "mix" "texture tex1" "image" "rgb tex2" [ 0.1 0.2 0.6 ] "float amount" 0.6',
    "imagemap": 'Texture "pattern" "spectrum" "imagemap" "string filename" "letter.png" "float uscale" 3 "float vscale" 2',
    "checkerboard": 'Texture "pattern" "spectrum" "checkerboard" "float uscale" 16 "float vscale" 8\n'
                    '  "rgb tex1" [ 0.6 0.5 0.3 ] "rgb tex2" [ 0.1 0.2 0.1 ]',
    "dots": 'Texture "pattern" "spectrum" "dots" "float uscale" 16 "float vscale" 8\n'
            '  "rgb inside" [ 0.6 0.5 0.3 ] "rgb outside" [ 0.5 0.1 0.05 ]',
    "bilerp": 'Texture "pattern" "spectrum" "bilerp" "rgb v00" [ 0.6 0.1 0.1 ] "rgb v01" [ 0.1 0.6 0.1 ]\n'
              '  "rgb v10" [ 0.1 0.1 0.6 ] "rgb v11" [ 0.6 0.6 0.1 ]',
    "directionmix": 'Texture "pattern" "spectrum" "directionmix" "vector3 dir" [ 0 0 1 ]\n'
                    '  "rgb tex1" [ 0.7 0.7 0.75 ] "rgb tex2" [ 0.1 0.25 0.05 ]',
    "marble": 'Texture "pattern" "spectrum" "marble" "float scale" 3 "float variation" 0.6 "integer octaves" 6',
    "soil": 'Texture "noise" "float" "fbm" "integer octaves" 6\n'
            'Texture "moisture" "float" "mix" "texture amount" "noise" "float tex1" 5 "float tex2" 50\n'
            'Texture "pattern" "spectrum" "soil" "string soil" "dry_sand" "texture moisture" "moisture"',
}
FLOAT_TEXTURES = {
    "constant": 'Texture "heights" "float" "constant" "float value" 0.5',
    "scale": 'Texture "noise" "float" "fbm"\nTexture "heights" "float" "scale" "texture tex" "noise" "float scale" 0.3',
    "mix": 'Texture "noise" "float" "fbm"\nTexture "steps" "float" "checkerboard" "float uscale" 12 "float vscale" 6 "float tex1" 0.3 "float tex2" 0\n'
           'Texture "heights" "float" "mix" "texture tex1" "noise" "texture tex2" "steps" "float amount" 0.8',
    "imagemap": 'Texture "heights" "float" "imagemap" "string filename" "letter.png" "float uscale" 3 "float vscale" 2 "float scale" 0.2',
    "checkerboard": 'Texture "heights" "float" "checkerboard" "float uscale" 16 "float vscale" 8 "float tex1" 0.2 "float tex2" 0',
    "dots": 'Texture "heights" "float" "dots" "float uscale" 16 "float vscale" 8 "float inside" 0 "float outside" 0.2',
    "bilerp": 'Texture "heights" "float" "bilerp" "float v01" 0.5 "float v11" 0.5',
    "directionmix": 'Texture "heights" "float" "directionmix" "vector3 dir" [ 0 0 1 ] "float tex1" 0.3 "float tex2" 0',
    "instance": None,  # a number of a table: on the page of the canopies
}
SHAPES = {
    "sphere": 'Shape "sphere" "float radius" 0.8 "float zmax" 0.6',
    "disk": 'Rotate 70 1 0 0  Shape "disk" "float radius" 0.8 "float innerradius" 0.35 "float phimax" 300',
    "cylinder": 'Shape "cylinder" "float radius" 0.55 "float zmin" -0.8 "float zmax" 0.6 "float phimax" 290',
    "bilinearmesh": 'Shape "bilinearmesh" "point3 P" [ -0.8 -0.6 -0.7  0.8 -0.6 0.3  -0.8 0.6 0.7  0.8 0.6 -0.5 ]',
    "trianglemesh": 'Shape "trianglemesh" "integer indices" [ 0 2 1  0 3 2  0 1 3  1 2 3 ]\n'
                    '  "point3 P" [ -0.8 -0.5 -0.8   0.8 -0.5 -0.8   0 0.8 -0.8   0 0 0.7 ]',
    "loopsubdiv": 'Shape "loopsubdiv" "integer levels" 4 "integer indices" [ 0 2 1  0 3 2  0 1 3  1 2 3 ]\n'
                  '  "point3 P" [ -1.3 -0.8 -0.8   1.3 -0.8 -0.8   0 1.3 -0.8   0 0 1.5 ]',
    "plymesh": None, "instances": None,
    "curve": 'Shape "curve" "string type" "cylinder" "float width0" 0.25 "float width1" 0.05\n'
             '  "point3 P" [ -0.9 0 -0.7   -0.9 0 1.4   0.9 0 -1.4   0.9 0 0.7 ]',
}
SHAPES["plymesh"] = f'Scale 14 14 14  Translate -0.045 0 0  Rotate -40 0 1 0  Rotate 70 1 0 0\nShape "plymesh" "string filename" "{ROOT}/scenes/meshes/leaflet-terminal-1.ply"'
LIGHTS = {
    "distant": 'LightSource "distant" "point3 from" [ -2 -3 4 ] "float scale" 3',
    "infinite": 'LightSource "infinite" "spectrum L" "stdillum-D65"',
    "sky": 'LightSource "sky" "float elevation" 40 "float azimuth" 240 "float albedo" 0.3 "float illuminance" 3',
    "point": 'LightSource "point" "point3 from" [ -1.6 -1.6 2.2 ] "float scale" 12',
    "spot": 'LightSource "spot" "point3 from" [ -1.6 -1.6 3 ] "point3 to" [ 0 0 0.6 ] "float coneangle" 16 "float scale" 30',
    "projection": 'AttributeBegin\n  Translate -1.2 -3 3  Rotate -128 1 0 0  Rotate 20 0 1 0\n'
                  '  LightSource "projection" "string filename" "letter.png" "float fov" 40 "float scale" 30\nAttributeEnd',
    "goniometric": 'AttributeBegin\n  Translate -1.2 -1.4 2.4\n'
                   '  LightSource "goniometric" "string filename" "letter.png" "float scale" 14\nAttributeEnd',
}
MEDIA = {
    "homogeneous": 'MakeNamedMedium "medium" "string type" "homogeneous" "rgb sigma_a" [ 0.1 0.3 0.8 ] "rgb sigma_s" [ 3 4 5 ] "float g" 0.5',
    "uniformgrid": 'MakeNamedMedium "medium" "string type" "uniformgrid" "integer nx" 3 "integer ny" 3 "integer nz" 3\n'
                   '  "point3 p0" [ -0.7 -0.7 -0.7 ] "point3 p1" [ 0.7 0.7 0.7 ] "rgb sigma_s" [ 9 8 6 ] "rgb sigma_a" [ 0.5 1 2 ]\n'
                   '  "float density" [ 2 0 2 0 0 0 2 0 2   0 0 0 0 2 0 0 0 0   2 0 2 0 0 0 2 0 2 ]',
    "rgbgrid": 'MakeNamedMedium "medium" "string type" "rgbgrid" "integer nx" 2 "integer ny" 2 "integer nz" 2 "float scale" 2\n'
               '  "point3 p0" [ -0.7 -0.7 -0.7 ] "point3 p1" [ 0.7 0.7 0.7 ]\n'
               '  "rgb sigma_s" [ 5 1 1  1 5 1  1 1 5  5 5 1   1 5 5  5 1 5  5 3 1  3 3 3 ]\n'
               '  "rgb sigma_a" [ 0 3 3  3 0 3  3 3 0  0 0 3   3 0 0  0 3 0  0 2 3  0 0 0 ]',
    "cloud": 'MakeNamedMedium "medium" "string type" "cloud" "point3 p0" [ -1 0 -1 ] "point3 p1" [ 1 1 1 ] "float density" 1.4\n'
             '  "float frequency" 2.5 "float sigma_a" 0 "float sigma_s" 25 "float g" 0.6',
    "nanovdb": f'MakeNamedMedium "medium" "string type" "nanovdb" "string filename" "{TORUS.name}"\n'
               '  "rgb sigma_s" [ 10 9 7 ] "rgb sigma_a" [ 1 2 4 ]',
    "turbid": 'MakeNamedMedium "medium" "string type" "turbid" "float density" 9 "rgb reflectance" [ 0.06 0.13 0.04 ]\n'
              '  "rgb transmittance" [ 0.04 0.13 0.03 ]',
}
#: Where each stands: the transformation at MakeNamedMedium.
MEDIA_PLACES = {"cloud": "Translate 0 0 0.25\nRotate 90 1 0 0", "nanovdb": "Translate 0 0 0.9\nRotate 60 1 0 0\nScale 0.75 0.75 0.75"}
CAMERAS = {
    "perspective": 'Camera "perspective" "float fov" 27 "float lensradius" 0.12 "float focaldistance" 4.6',
    "orthographic": 'Camera "orthographic" "float screenwindow" [ -1.3 1.3 -1.3 1.3 ]',
    "spherical": 'Camera "spherical"',
    "distant": None,  # columns of directions, no view
}


# Kinds in the page's order: lines by name, and those of plugins that are not there.
KINDS = {
    "material": (MATERIALS, 'Material "{}"'), "integrator": ({}, 'Integrator "{}"'), "camera": (CAMERAS, None),
    "sampler": ({}, 'Sampler "{}" "integer pixelsamples" 4'), "pixel filter": ({}, 'PixelFilter "{}"'), "shape": (SHAPES, None),
    "light": (LIGHTS, None), "float texture": (FLOAT_TEXTURES, 'Texture "heights" "float" "{}"'),
    "spectrum texture": (SPECTRUM_TEXTURES, 'Texture "pattern" "spectrum" "{}"'), "medium": (MEDIA, None),
}


def scene_of(kind, name, lines):
    """All of the scene, and the samples of a pixel."""
    front, world, things, samples = VIEW + FILM, LIGHT, FLOOR, SAMPLES
    if kind == "material":
        if name == "hair":
            front += 'Integrator "path" "integer maxdepth" 50\n'  # its colour is that of many scatterings
        things += "AttributeBegin\n" + lines + "\n" + (LEAFLET if name.startswith(("leaf", "abm")) else TUFT if name == "hair" else BALL) + "AttributeEnd\n"
    elif kind == "spectrum texture":
        things += lines + '\nMaterial "diffuse" "texture reflectance" "pattern"\n' + BALL
    elif kind == "float texture":
        things += lines + BUMPS + BALL
    elif kind == "shape":
        things += RED + "AttributeBegin\nTranslate 0 0 0.82\n" + lines + "\nAttributeEnd\n"
    elif kind == "light":
        world, things = "", lines + "\n" + FLOOR + RED + BALL
    elif kind == "medium":
        radius = 0.8 if name in ("homogeneous", "turbid") else 1.5
        things += (f"AttributeBegin\n{MEDIA_PLACES.get(name, 'Translate 0 0 0.8')}\n{lines}\nAttributeEnd\n"
                   f'AttributeBegin\nTranslate 0 0 0.8\nMaterial "interface"\nMediumInterface "medium" ""\n'
                   f'Shape "sphere" "float radius" {radius}\nAttributeEnd\n')
        front += 'Integrator "volpath" "integer maxdepth" 50\n'
    elif kind == "camera":
        front = "\n".join(VIEW.splitlines()[:2]) + "\n" + lines + "\n" + FILM
        things += RED + BALL
    else:
        front, samples = front + lines + "\n", 4 if kind == "sampler" else SAMPLES
        things += 'Material "coateddiffuse" "rgb reflectance" [ 0.45 0.08 0.05 ]\n' + BALL
    return front + "WorldBegin\n" + world + things, samples


def write_letter(path):
    """An F of two colours on a third."""
    rows = ["........", ".#####..", ".#......", ".####...", ".#......", ".#......", ".@......", "........"]
    colors = {".": (225, 215, 180), "#": (150, 40, 25), "@": (30, 80, 160)}
    image = Image.new("RGB", (len(rows[0]), len(rows)))
    image.putdata([colors[c] for row in rows for c in row])
    image.resize((8 * image.width, 8 * image.height), Image.Resampling.NEAREST).save(path)


def main():
    options = arguments("gallery", ("--only", dict(default="", metavar="WORD", help="plugins whose names hold it; others stay")))
    page = ["# Gallery", "", "For authors of scene files: an image of each plug-in that a scene can name, and the lines of the scene that produce it.",
            "Written by `measurements/run gallery`. [All parameters](plugins.md)."]
    with tempfile.TemporaryDirectory() as folder:
        write_letter(pathlib.Path(folder) / LETTER)
        shutil.copy(MEASURED, folder)
        shutil.copy(TORUS, folder)
        for kind, (table, default) in KINDS.items():
            page += ["", f"## {kind[0].upper() + kind[1:]}", ""]
            for name, doc in frond.names(kind).items():
                lines = table.get(name, default and default.format(name))
                if lines is None:  # it has no image
                    continue
                image = options.docs / "images" / "gallery" / f"{kind.replace(' ', '-')}-{name}.jpg"
                image.parent.mkdir(parents=True, exist_ok=True)
                if options.only in name:
                    scene, samples = scene_of(kind, name, lines)
                    frond.loads(scene, folder).render(min(samples, 4) if options.quick else samples).save(image)
                shown = lines.replace(f"{ROOT}/scenes/", "")
                page += [f"### `{name}`", "", doc, "", f"![{name}](images/gallery/{image.name})", "", "```", shown, "```", ""]
    write(options.docs / "gallery.md", "\n".join(page).rstrip() + "\n")


if __name__ == "__main__":
    main()
