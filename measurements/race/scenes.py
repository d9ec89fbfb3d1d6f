"""Scenes of measurements/run race: frond's own, with grey materials, so that every program can render them.

A scene file is read into plain data. Materials, sampler and film, which differ between the programs, are replaced. The scene is
then written for pbrt-v4 and frond in their format, and for Mitsuba as JSON that mitsuba_worker.py loads.
"""

import dataclasses
import json
import math
import re

import numpy
from scipy.spatial.transform import Rotation

from ..shared import ply
from ..shared.tools import ROOT, program

# Reflectance of other surfaces; reflectance and transmittance of leaves. Grey materials give the same image with three
# wavelengths, RGB colours and spectra.
GREY = {"wall": 0.5, "petiole": 0.3, "backdrop": 0.1, "soil": 0.2}
LEAVES = {"opaque": (0.5, 0), "leaf": (0.45, 0.4)}
DEPTH = 16  # scattering events
GAUSSIAN = {"sigma": 0.5, "radius": 2}  # Mitsuba's only radius; the default of frond and pbrt-v4 is 1.5
MITSUBA_UNITS = 100  # units per metre in Mitsuba's scenes: it offsets ray origins from surfaces by 0.1 mm or more if 1 is a metre


@dataclasses.dataclass
class Shape:
    kind: str  # plymesh, trianglemesh, disk
    parameters: dict
    to_world: numpy.ndarray  # 4 x 4
    material: str
    object: str = None  # name of the object that contains the shape
    reversed: bool = False
    radiance: float = 0  # of the front


@dataclasses.dataclass
class Scene:
    camera: dict = dataclasses.field(default_factory=dict)
    shapes: list = dataclasses.field(default_factory=list)
    instances: list = dataclasses.field(default_factory=list)  # of (object, matrix)
    table: tuple = None  # (object, file): the instances as a table of frond
    distant: list = dataclasses.field(default_factory=list)  # of (direction to the light, irradiance)
    sky: float = 0


def affine(linear=numpy.eye(3), place=(0, 0, 0)):
    matrix = numpy.eye(4)
    matrix[:3, :3], matrix[:3, 3] = linear, place
    return matrix


def rotation(degrees, *axis):
    return affine(Rotation.from_rotvec(math.radians(degrees) * numpy.array(axis) / numpy.linalg.norm(axis)).as_matrix())


def directives(path):
    """Name, strings and numbers, and parameters, of each directive of a scene file."""
    words = re.findall(r'"[^"]*"|[\[\]]|[^\s\[\]"]+', re.sub(r"#.*", "", path.read_text(encoding="utf-8")))
    found, i = [], 0
    while i < len(words):
        name, plain, parameters, key = words[i], [], {}, None
        i += 1
        while i < len(words) and not words[i][0].isalpha():
            word = words[i]
            i += 1
            if word in "[]":
                continue
            value = word[1:-1] if word[0] == '"' else float(word)
            if isinstance(value, str) and " " in value:
                key = value
                parameters[key] = []
            else:
                (plain if key is None else parameters[key]).append(value)
        found.append((name, plain, parameters))
    return found


def read(path, folder):
    """Reads the directives that frond's own scenes use; any other directive is an error."""
    scene, stack = Scene(), []
    here = {"ctm": numpy.eye(4), "material": None, "reversed": False, "radiance": 0}
    current = None

    def follow(path):
        nonlocal here, current
        for name, plain, parameters in directives(path):
            if name in ("Film", "Sampler", "Integrator", "PixelFilter", "MakeNamedMaterial"):
                continue
            if name == "WorldBegin":
                here["ctm"] = numpy.eye(4)
            elif name == "Scale" and plain == [-1, 1, 1] and not scene.camera:
                continue  # right-handed space, as in all of frond's scenes
            elif name == "LookAt":
                scene.camera["look"] = [plain[0:3], plain[3:6], plain[6:9]]
            elif name == "Camera" and plain == ["perspective"]:
                scene.camera["fov"] = parameters["float fov"][0]
            elif name == "Include":
                follow(path.parent / plain[0])
            elif name == "AttributeBegin":
                stack.append(dict(here))
            elif name == "AttributeEnd":
                here = stack.pop()
            elif name == "Translate":
                here["ctm"] = here["ctm"] @ affine(place=plain)
            elif name == "Rotate":
                here["ctm"] = here["ctm"] @ rotation(*plain)
            elif name == "Transform":
                here["ctm"] = numpy.reshape(plain, (4, 4)).T
            elif name == "ReverseOrientation":
                here["reversed"] = not here["reversed"]
            elif name == "NamedMaterial":
                here["material"] = plain[0]
            elif name == "AreaLightSource":
                here["radiance"] = parameters["float scale"][0]
            elif name == "LightSource" and plain == ["infinite"]:
                scene.sky = parameters.get("float scale", [1])[0]
            elif name == "LightSource" and plain == ["distant"]:
                toward = [a - b for a, b in zip(parameters["point3 from"], parameters["point3 to"])]
                scene.distant.append((toward, parameters["float scale"][0]))
            elif name == "ObjectBegin":
                stack.append(dict(here))
                current = plain[0]
            elif name == "ObjectEnd":
                here, current = stack.pop(), None
            elif name == "ObjectInstance":
                scene.instances.append((plain[0], here["ctm"]))
            elif name == "Shape" and plain[0] in ("plymesh", "trianglemesh", "disk"):
                values = {key.split()[1]: value for key, value in parameters.items()}
                if "filename" in values:
                    values["filename"] = without_normals(path.parent / values["filename"][0], folder)
                scene.shapes.append(Shape(plain[0], values, here["ctm"], here["material"] or "backdrop", current,
                                          here["reversed"], here["radiance"]))
            else:
                raise SystemExit(f"{path}: measurements/run race does not support {name} {' '.join(map(str, plain))}")

    follow(path)
    return scene


def lamp(toward, distance, radius):
    """A disk light that faces the origin and gives a white surface there the value 1."""
    z = -numpy.array(toward) / numpy.linalg.norm(toward)
    x = numpy.array([z[1], -z[0], 0]) / math.hypot(z[0], z[1])
    matrix = affine(numpy.stack([x, numpy.cross(z, x), z], axis=1), -distance * z)
    return Shape("disk", {"radius": [radius]}, matrix, "backdrop", radiance=(distance**2 + radius**2) / radius**2)


def hundred_front(folder):
    """A hundred leaves in front of a wall, lit by a lamp; every pixel sees a surface."""
    scene = read(ROOT / "scenes/hundred-leaves/closed.pbrt", folder)
    [(toward, _)] = scene.distant
    scene.distant = []
    scene.shapes.append(lamp(toward, 4, 0.5))
    return scene


def hundred_ambient(folder):
    """The same leaves without a wall, under a uniform sky."""
    scene = read(ROOT / "scenes/hundred-leaves/scene.pbrt", folder)
    scene.distant, scene.sky = [], 1
    return scene


def soybean(name):
    def make(folder):
        return read(ROOT / f"scenes/soybean-{name}/scene.pbrt", folder)
    make.__doc__ = {"front": "A soybean plant, lit from the front by a lamp.", "back": "A soybean plant, lit from behind.",
                    "ambient": "A soybean plant on soil under a uniform sky."}[name]
    return make


LEAF_AREA = 0.00491  # of leaflet-speed.ply, one-sided
CANOPY_LEAVES = 100_000


def canopy(folder):
    """100,000 leaves of 2,000 triangles over soil, leaf area index 3, under the sun and a uniform sky."""
    side = math.sqrt(CANOPY_LEAVES * LEAF_AREA / 3)
    table = folder / "canopy.npy"
    program("canopy", "-q", "-o", table, "--count", CANOPY_LEAVES, "--scale", 1, "--leaf-area", LEAF_AREA, "--size", f"{side},{side}",
            "--heights", "0.05,2", "--seed", 1)
    leaves = numpy.tile(numpy.eye(4), (CANOPY_LEAVES, 1, 1))
    leaves[:, :3] = numpy.load(table)["transform"]
    middle, mesh = side / 2, without_normals(ROOT / "scenes/meshes/leaflet-speed.ply", folder)
    return Scene(
        camera={"look": [[middle, middle - 4, 5], [middle, middle, 1], [0, 0, 1]], "fov": 40},
        shapes=[Shape("plymesh", {"filename": mesh}, numpy.eye(4), "leaf", "leaf"),
                Shape("trianglemesh", {"indices": [0, 1, 2, 0, 2, 3],
                                       "P": [0, 0, 0, side, 0, 0, side, side, 0, 0, side, 0]}, numpy.eye(4), "soil")],
        instances=[("leaf", matrix) for matrix in leaves], table=("leaf", str(table)),
        distant=[((-0.5, 0, 0.8660254), 3)], sky=0.17)


SCENES = {"front": hundred_front, "ambient": hundred_ambient, "soybean-front": soybean("front"),
          "soybean-back": soybean("back"), "soybean-ambient": soybean("ambient"), "canopy": canopy}


def numbers(values):
    return " ".join(f"{v:.9g}" for v in numpy.ravel(values))


def without_normals(path, folder):
    """A copy of a mesh with flat triangles. Programs, and so their images, differ for directions that are on different sides of
    the vertex normals and of the triangle's normal."""
    return ply.write(folder / path.name, *ply.read(path))


def grey(value):
    return f"[ 300 {value} 2500 {value} ]"


def write_pbrt(scene, path, leaf, box, size, tables=False):
    """Writes a scene for pbrt-v4 and frond; with `tables` the instances are a table of frond."""
    white = '"spectrum L" "stdillum-D65"'
    lines = ["Scale -1 1 1", "LookAt " + " ".join(map(numbers, scene.camera["look"])),
             f'Camera "perspective" "float fov" {scene.camera["fov"]}',
             f'Film "rgb" "integer xresolution" {size} "integer yresolution" {size}',
             'Sampler "paddedsobol" "integer pixelsamples" 1', f'Integrator "path" "integer maxdepth" {DEPTH}',
             'PixelFilter "box"' if box else
             'PixelFilter "gaussian" "float sigma" {sigma} "float xradius" {radius} "float yradius" {radius}'.format(**GAUSSIAN),
             "WorldBegin"]
    for toward, irradiance in scene.distant:
        lines.append(f'LightSource "distant" "point3 from" [ {numbers(toward)} ] "point3 to" [ 0 0 0 ] {white} '
                     f'"float scale" {irradiance}')
    if scene.sky:
        lines.append(f'LightSource "infinite" {white} "float scale" {scene.sky}')
    for name, value in GREY.items():
        lines.append(f'MakeNamedMaterial "{name}" "string type" "diffuse" "spectrum reflectance" {grey(value)}')
    reflectance, transmittance = LEAVES[leaf]
    kind = f'"diffusetransmission" "spectrum transmittance" {grey(transmittance)}' if transmittance else '"diffuse"'
    lines.append(f'MakeNamedMaterial "leaf" "string type" {kind} "spectrum reflectance" {grey(reflectance)}')
    for shape in scene.shapes:
        lines.append(f'ObjectBegin "{shape.object}"' if shape.object else "AttributeBegin")
        lines.append(f"Transform [ {numbers(shape.to_world.T)} ]")
        lines.append(f'NamedMaterial "{shape.material}"')
        if shape.reversed:
            lines.append("ReverseOrientation")
        if shape.radiance:
            lines.append(f'AreaLightSource "diffuse" {white} "float scale" {shape.radiance}')
        p = shape.parameters
        lines.append({"disk": lambda: f'Shape "disk" "float radius" {p["radius"][0]}',
                      "plymesh": lambda: f'Shape "plymesh" "string filename" "{p["filename"]}"',
                      "trianglemesh": lambda: f'Shape "trianglemesh" "integer indices" [ {numbers(p["indices"])} ] '
                                              f'"point3 P" [ {numbers(p["P"])} ]'}[shape.kind]())
        lines.append("ObjectEnd" if shape.object else "AttributeEnd")
    if tables and scene.table:
        lines.append('Shape "instances" "string object" "{}" "string filename" "{}"'.format(*scene.table))
    else:
        for name, matrix in scene.instances:
            lines.append(f'AttributeBegin Transform [ {numbers(matrix.T)} ] ObjectInstance "{name}" AttributeEnd')
    path.write_text("\n".join(lines) + "\n", encoding="utf-8")


def write_json(scene, path, leaf, size):
    """Writes a scene for mitsuba_worker.py."""
    document = dataclasses.asdict(scene) | {"grey": GREY, "leaf": LEAVES[leaf], "depth": DEPTH, "size": size,
                                            "gaussian": GAUSSIAN}
    larger = affine(MITSUBA_UNITS * numpy.eye(3))
    place, target, up = scene.camera["look"]
    document["camera"] = scene.camera | {"look": [[MITSUBA_UNITS * v for v in place], [MITSUBA_UNITS * v for v in target], up]}
    document["instances"] = [(name, larger @ matrix) for name, matrix in scene.instances]
    for i, shape in enumerate(document["shapes"]):
        if not shape["object"]:
            shape["to_world"] = larger @ shape["to_world"]
        if shape["kind"] == "trianglemesh":
            points, triangles = (numpy.reshape(shape["parameters"][name], (-1, 3)) for name in ("P", "indices"))
            shape |= {"kind": "plymesh", "parameters": {"filename": ply.write(path.with_name(f"{path.stem}-{i}.ply"), points, triangles)}}
    path.write_text(json.dumps(document, default=lambda matrix: matrix.ravel().tolist()), encoding="utf-8")
