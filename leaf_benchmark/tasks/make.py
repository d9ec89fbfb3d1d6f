"""Writes the tasks: task.json with camera, lights and colours, leaf.json with the leaf's R and T, and a PLY and an OBJ file for each
surface, in world coordinates (metres, z up, right-handed). Only the meshes are not in the repository.

A task of kind "image" asks for an image, "leaf" for the table of docs/leaf_benchmark.md.
"""

import json
import pathlib
import tempfile

import numpy

from measurements.race.scenes import Scene, Shape, affine, lamp, read, rotation
from measurements.shared import ply
from measurements.shared.tools import ROOT

FOLDER = pathlib.Path(__file__).parent
NM = [608, 551, 455]  # red, green and blue
SIZE = 128
DEPTH = 64
ANGLES = [4.5 + 9 * i for i in range(10)]  # centres of the rows of the table's directions
LIGHTS = [0, 30, 60]
LEAF = "leaf_solved,specimen=soybean"
# Reflectance spectra of the other surfaces, as in scenes/soybean-*/scene.pbrt.
OTHERS = {"petiole": ([300, 450, 500, 550, 600, 670, 700], [0.05, 0.06, 0.09, 0.20, 0.14, 0.09, 0.25]),
          "backdrop": ([300, 2500], [0.015, 0.015]),
          "soil": ([300, 400, 700], [0.03, 0.04, 0.12])}
UNITS = ("lengths in metres, z up, right-handed; angles in degrees; radiance relative to that of a white Lambertian surface that faces the "
         "lamp at its target, or under the sky; red, green and blue are radiances at the wavelengths, without a colour matrix")


def glow(folder):
    """A leaf lit from behind, seen from below and close up, with the shadow of a leaf above it."""
    mesh = lambda name, place: Shape("plymesh", {"filename": str(ROOT / "scenes" / "meshes" / name)}, place, "leaf")
    light = lamp([0.35, 0.2, 1], 2, 0.03)
    return Scene(camera={"look": [[0.05, -0.04, -0.22], [0.05, 0, 0], [0, 1, 0]], "fov": 22},
                 shapes=[mesh("leaflet-terminal-1.ply", numpy.eye(4)), light,
                         mesh("leaflet-left-1.ply", affine(place=[0.03, 0.005, 0.03]) @ rotation(35, 0, 0, 1))])


IMAGES = {name: lambda folder, name=name: read(ROOT / f"scenes/soybean-{name}/scene.pbrt", folder)
          for name in ("front", "back", "ambient")} | {"glow": glow}


def write_meshes(path, points, triangles):
    """NAME.ply and NAME.obj. The leaf's front is the side from which a triangle's vertices turn counter-clockwise."""
    ply.write(path.with_suffix(".ply"), points, triangles)
    lines = [f"v {x:.7g} {y:.7g} {z:.7g}" for x, y, z in points] + [f"f {a} {b} {c}" for a, b, c in triangles + 1]
    path.with_suffix(".obj").write_text("\n".join(lines) + "\n", encoding="ascii")


def meshes_of(scene):
    """Points and triangles by material, in world coordinates."""
    found = {}
    placed = [(shape, shape.to_world) for shape in scene.shapes if not shape.object and shape.kind != "disk"]
    placed += [(shape, matrix @ shape.to_world) for name, matrix in scene.instances for shape in scene.shapes if shape.object == name]
    for shape, matrix in placed:
        p = shape.parameters
        points, triangles = ply.read(p["filename"]) if "filename" in p else (
            numpy.reshape(p["P"], (-1, 3)), numpy.reshape(p["indices"], (-1, 3)).astype(int))
        if numpy.linalg.det(matrix[:3, :3]) < 0:
            triangles = triangles[:, ::-1]
        found.setdefault(shape.material, []).append((points @ matrix[:3, :3].T + matrix[:3, 3], triangles))
    for material, parts in found.items():
        starts = numpy.cumsum([0, *(len(points) for points, _ in parts)])
        yield (material, numpy.concatenate([points for points, _ in parts]),
               numpy.concatenate([triangles + start for (_, triangles), start in zip(parts, starts)]))


def lights_of(scene):
    for shape in scene.shapes:
        if shape.radiance:
            z = -shape.to_world[:3, 2] if shape.reversed else shape.to_world[:3, 2]
            yield {"center": shape.to_world[:3, 3].tolist(), "toward": z.tolist(), "radius": shape.parameters["radius"][0],
                   "radiance": shape.radiance}


def write_json(path, content):
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(json.dumps(content, indent=1) + "\n", encoding="utf-8")


def write_images():
    for name, make in IMAGES.items():
        with tempfile.TemporaryDirectory() as temporary:
            scene, surfaces = make(pathlib.Path(temporary)), []
            (FOLDER / name).mkdir(exist_ok=True)
            for material, points, triangles in meshes_of(scene):
                write_meshes(FOLDER / name / material, points, triangles)
                color = None if material == "leaf" else numpy.interp(NM, *OTHERS[material]).round(6).tolist()
                surfaces.append({"name": material, "mesh": material, "reflectance": color})
        position, target, up = scene.camera["look"]
        write_json(FOLDER / name / "task.json", {
            "kind": "image", "units": UNITS, "wavelengths_nm": NM, "width": SIZE, "height": SIZE, "pixel_filter": "box",
            "camera": {"position": position, "target": target, "up": up, "fov": scene.camera["fov"]}, "scattering_events": DEPTH,
            "lamps": list(lights_of(scene)), "sky": scene.sky, "surfaces": surfaces})


def write_leaf():
    import frond
    angles = [8, *ANGLES]
    sides = {"front": angles, "back": [180 - angle for angle in angles]}
    found = frond.spectrophotometer(LEAF, NM, [a for side in sides.values() for a in side], rays=4_000_000)
    found = found.set_index(["theta_deg", "wavelength_nm"])
    shares = {side: {share: [[round(float(found.loc[(a, nm), share]), 5) for nm in NM] for a in of] for share in "RT"}
              for side, of in sides.items()}
    write_json(FOLDER / "leaf.json", {
        "what": "R and T at the angles from the normal of either side, a row for each, in red, green and blue; R_se and T_se: largest "
                "standard errors. A material with one number takes those at 8 degrees, as an integrating sphere measures them.",
        "wavelengths_nm": NM, "angle": angles, **shares, "R_se": float(found.R_se.max()), "T_se": float(found.T_se.max())})
    write_json(FOLDER / "leaf" / "task.json", {
        "kind": "leaf", "wavelengths_nm": NM, "light_theta": LIGHTS, "theta": [*ANGLES, *(180 - a for a in reversed(ANGLES))],
        "phi": [4.5 + 9 * i for i in range(40)]})


def canopy_leaves(count, side, height, leaf_area):
    """Corners `[leaf][4][3]` of squares at uniform places, whose fronts look up, all directions alike (spherical)."""
    random, edge = numpy.random.default_rng(1), leaf_area**0.5
    place = random.uniform([-side / 2, -side / 2, edge], [side / 2, side / 2, height - edge], (count, 3))
    z, turn, angle = random.uniform(0, 1, count), 2 * numpy.pi * random.random(count), 2 * numpy.pi * random.random(count)
    normal = numpy.stack([numpy.sqrt(1 - z * z) * numpy.cos(turn), numpy.sqrt(1 - z * z) * numpy.sin(turn), z], axis=1)
    x = numpy.cross(normal, numpy.where(abs(z[:, None]) < 0.9, [[0, 0, 1]], [[1, 0, 0]]))
    x /= numpy.linalg.norm(x, axis=1)[:, None]
    y = numpy.cross(normal, x)
    a, b = (edge / 2**0.5 * (c * x + d * y) for c, d in ((numpy.cos(angle)[:, None], numpy.sin(angle)[:, None]),
                                                         (-numpy.sin(angle)[:, None], numpy.cos(angle)[:, None])))
    return place[:, None] + numpy.stack([a, b, -a, -b], axis=1)


def write_canopy():
    """A finite canopy of leaf area index 3 in a box of 10 x 10 x 2 m, without soil, measured in its middle."""
    import frond
    nm, count, side, height = [450, 550, 670, 800], 100_000, 10, 2
    corners = canopy_leaves(count, side, height, 3 * side**2 / count)
    (FOLDER / "canopy").mkdir(exist_ok=True)
    first = 4 * numpy.arange(count)[:, None]
    write_meshes(FOLDER / "canopy" / "leaf", corners.reshape(-1, 3), numpy.concatenate([first + [0, 1, 2], first + [0, 2, 3]]))
    found = frond.spectrophotometer(LEAF, nm, [8, 172], rays=1_000_000).set_index(["theta_deg", "wavelength_nm"])
    shares = {name: {share: [[round(float(found.loc[(angle, w), share]), 5) for w in nm]] for share in "RT"}
              for name, angle in (("front", 8), ("back", 172))}
    write_json(FOLDER / "canopy" / "task.json", {
        "kind": "canopy", "wavelengths_nm": nm, "units": "metres, degrees; the sun is at (sin, 0, cos) of sun_zenith, and a view of positive "
        "zenith on its side, in the same plane; target: xmin, xmax, ymin, ymax, z of the square whose BRF is measured; "
        "period: of the canopy in x and y, for the absorbed share of its light, not for the BRF",
        "sun_zenith": 30, "view_zenith": [-60, -40, -20, 0, 20, 40, 60], "target": [-1.5, 1.5, -1.5, 1.5, height], "period": [side, side],
        "scattering_events": DEPTH, "surfaces": [{"name": "leaf", "mesh": "leaf", "reflectance": None}], "leaf": shares})


if __name__ == "__main__":
    write_images()
    write_leaf()
    write_canopy()
