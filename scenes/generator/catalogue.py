"""What there is to make: the leaflets and the plants of the scenes."""

import random

import field
import lathe
import leaflet
import plant
import vec
from leaflet import Shape
from mesh import ply_bytes
from plant import Leaf, Placed, Plant

MESHES = "../meshes"

LEAFLETS = {
    "terminal-1": Shape(seed=11, length=0.105, width=0.070, droop=0.65, fold=0.30, sway=0.05, twist=0.10),
    "terminal-2": Shape(seed=12, length=0.102, width=0.066, droop=0.95, fold=0.22, sway=-0.12, twist=-0.15, wave=0.0027),
    "left-1": Shape(seed=21, left=0.90, right=1.10, droop=0.75, fold=0.24, sway=0.16, twist=0.12),
    "left-2": Shape(seed=22, left=0.88, right=1.08, droop=0.45, fold=0.34, sway=0.05, twist=-0.2, wave=0.003),
    "right-1": Shape(seed=31, left=1.10, right=0.90, droop=0.60, fold=0.30, sway=-0.14, twist=-0.1),
    "right-2": Shape(seed=32, left=1.08, right=0.88, droop=0.90, fold=0.20, sway=-0.05, twist=0.18, wave=0.0027),
}


def front():
    """A plant that spreads its leaves toward a light behind the camera."""
    stem = [(0.0, 0.0, 0.0), (0.007, 0.0, 0.07), (-0.005, 0.003, 0.14), (0.005, -0.002, 0.20), (0.0, 0.0, 0.26)]
    return Plant(stem, [
        Leaf(0.07, 192, 30, 0.10, 1.05, pitch=-14, roll=-4, seed=1),
        Leaf(0.10, -18, 34, 0.10, 1.10, pitch=-10, roll=-6, seed=2),
        Leaf(0.14, -110, 40, 0.09, 1.00, pitch=-14, turn=-10, seed=5),
        Leaf(0.18, 155, 48, 0.11, 1.05, pitch=-8, roll=-6, seed=3),
        Leaf(0.22, 35, 52, 0.10, 1.00, pitch=-8, roll=-6, seed=4),
        Leaf(0.255, -60, 66, 0.05, 0.75, sag=15, pitch=-10, seed=6),
        Leaf(0.26, 120, 72, 0.03, 0.45, sag=10, pitch=12, lateral_pitch=10, seed=7),
    ], facing=(-0.1, -0.8, 0.6), facing_weight=0.55).grow()


def back():
    """The upper part of a plant against the light."""
    stem = [(0.0, 0.0, -0.2), (0.006, 0.0, 0.06), (-0.004, 0.003, 0.14), (0.004, -0.002, 0.20), (0.0, 0.0, 0.25)]
    return Plant(stem, [
        Leaf(0.09, 15, 40, 0.09, 0.95, pitch=-14, roll=5, seed=14),
        Leaf(0.13, 190, 40, 0.10, 1.05, pitch=-14, seed=11),
        Leaf(0.19, -12, 48, 0.10, 1.05, pitch=-10, seed=12),
        Leaf(0.24, 160, 62, 0.06, 0.90, sag=15, pitch=-5, seed=13),
        Leaf(0.25, -60, 75, 0.03, 0.50, sag=10, pitch=10, lateral_pitch=8, seed=15),
    ], facing=(-0.1, -1.0, 0.05), facing_weight=0.85).grow()


def ambient():
    """A young plant seen from above."""
    stem = [(0.0, 0.0, 0.0), (0.005, 0.0, 0.05), (-0.004, 0.003, 0.10), (0.0, 0.0, 0.15)]
    return Plant(stem, [
        Leaf(0.05, 12, 28, 0.085, 1.00, pitch=-10, seed=21),
        Leaf(0.06, 195, 30, 0.10, 1.05, pitch=-12, seed=22),
        Leaf(0.08, 105, 38, 0.10, 1.05, pitch=-8, seed=23),
        Leaf(0.10, -78, 40, 0.10, 1.05, pitch=-10, seed=24),
        Leaf(0.12, 50, 45, 0.10, 1.00, pitch=-10, seed=27),
        Leaf(0.13, 150, 55, 0.07, 0.85, pitch=-6, seed=25),
        Leaf(0.145, -30, 62, 0.05, 0.65, sag=15, pitch=-5, seed=26),
        Leaf(0.15, -160, 72, 0.03, 0.40, sag=10, pitch=12, lateral_pitch=10, seed=28),
    ]).grow()


def vase():
    """Three cut stems that lean on the rim of a vase."""
    plants = []
    for k, (azimuth, lean, leaves) in enumerate(((200, 0.080, 4), (325, 0.100, 4), (80, 0.060, 4))):
        out = vec.direction(azimuth, 0)
        foot, rim = vec.mul(out, -0.025), vec.mul(out, 0.022)
        stem = [vec.add(foot, (0, 0, 0.014)), vec.add(rim, (0, 0, 0.20)),
                vec.add(vec.mul(out, 0.6 * lean), (0, 0, 0.30)), vec.add(vec.mul(out, lean), (0, 0, 0.42))]
        plants.append(Plant(stem, [
            Leaf(0.26 + 0.045 * i, azimuth + (60, -70, 15, -160)[i], 35 + 10 * i, 0.06 - 0.01 * i, 0.95 - 0.12 * i,
                 pitch=-12 + 6 * i, seed=100 + 10 * k + i) for i in range(leaves)
        ], radius=0.0028, facing=(-0.9, -0.3, 0.4), facing_weight=0.35).grow())
    return _together(plants)


def pot():
    """A young plant in a pot: its soil lies 0.15 m above the ground."""
    stem = [(0.0, 0.0, 0.14), (0.005, 0.0, 0.20), (-0.004, 0.003, 0.28), (0.0, 0.0, 0.36)]
    return Plant(stem, [
        Leaf(0.19, 200, 35, 0.10, 1.00, pitch=-14, seed=31),
        Leaf(0.21, -20, 36, 0.10, 1.05, pitch=-10, seed=32),
        Leaf(0.24, 95, 40, 0.10, 1.00, pitch=-8, seed=33),
        Leaf(0.27, -100, 44, 0.09, 1.00, pitch=-12, seed=34),
        Leaf(0.31, 40, 50, 0.08, 0.90, pitch=-8, seed=35),
        Leaf(0.34, 165, 60, 0.06, 0.75, pitch=-5, seed=36),
        Leaf(0.355, -60, 72, 0.03, 0.45, sag=10, pitch=12, lateral_pitch=10, seed=37),
    ], facing=(0.4, -0.6, 0.7), facing_weight=0.3).grow()


def _together(plants):
    for other in plants[1:]:
        plants[0].leaflets += other.leaflets
        plants[0].tubes.append(other.tubes)
    return plants[0]


# Radius and height, metres, from the middle of the foot outside, over the rim, to the middle of the floor inside.
GLASS = [(0.0, 0.0), (0.030, 0.0), (0.046, 0.0008), (0.0495, 0.005), (0.053, 0.04), (0.056, 0.08), (0.052, 0.13),
         (0.040, 0.18), (0.036, 0.205), (0.044, 0.235), (0.0435, 0.2375), (0.0410, 0.2365), (0.0325, 0.206),
         (0.0362, 0.18), (0.0482, 0.13), (0.0522, 0.08), (0.049, 0.04), (0.044, 0.017), (0.030, 0.0135), (0.0, 0.013)]
CLAY = [(0.0, 0.002), (0.050, 0.002), (0.066, 0.0), (0.070, 0.004), (0.078, 0.06), (0.086, 0.128), (0.0875, 0.131),
        (0.096, 0.132), (0.0985, 0.135), (0.1005, 0.168), (0.0985, 0.172), (0.092, 0.172), (0.090, 0.168),
        (0.087, 0.135), (0.080, 0.12), (0.070, 0.05), (0.0, 0.05)]


def hundred():
    """A hundred leaflets that hang before the camera, upper sides toward it, for measurements of speed."""
    draw = random.Random(100)
    toward_camera = (0.0, -1.0, 0.0)
    for i in range(100):
        place = (i % 10 - 4.5 + draw.uniform(-0.4, 0.4), draw.uniform(0, 4), i // 10 - 4.5 + draw.uniform(-0.4, 0.4))
        normal = vec.normalize(vec.add(toward_camera, tuple(draw.uniform(-0.8, 0.8) for _ in range(3))))
        axis = vec.reject(vec.direction(draw.uniform(0, 360), draw.uniform(-90, -10)), normal)
        frame = (axis, vec.cross(normal, axis), normal)
        yield Placed("speed", frame, vec.mul(place, 0.095), draw.uniform(0.85, 1.2))


PLANTS = {"soybean-front": front, "soybean-back": back, "soybean-ambient": ambient, "vase": vase, "pot": pot}


def leaflets():
    for name, shape in LEAFLETS.items():
        yield name, ply_bytes(leaflet.build(shape), f"soybean leaflet {name}")
    coarse = leaflet.build(LEAFLETS["terminal-1"], leaflet.SPEED)
    yield "speed", ply_bytes(coarse, "soybean leaflet of 2,000 triangles")
    yield "faceted", ply_bytes(coarse, "soybean leaflet of 2,000 triangles without normals", with_normals=False)


def files():
    """Path under scenes/ -> bytes."""
    out = {f"meshes/leaflet-{name}.ply": content for name, content in leaflets()}
    for scene, grow in PLANTS.items():
        grown = grow()
        out[f"{scene}/stems.ply"] = ply_bytes(grown.tubes, "stem, petioles and petiolules")
        out[f"{scene}/plant.pbrt"] = plant.pbrt_text(grown.leaflets, "stems.ply", MESHES).encode("ascii")
    out["vase/glass.ply"] = ply_bytes(lathe.turn(GLASS), "glass vase")
    out["pot/clay.ply"] = ply_bytes(lathe.turn(CLAY), "flower pot")
    out["hundred-leaves/leaves.pbrt"] = plant.pbrt_text(list(hundred()), None, MESHES).encode("ascii")
    out["outdoors/wind_plant.pbrt"] = plant.pbrt_text(ambient().leaflets, "../soybean-ambient/stems.ply", MESHES,
                                                      random.Random(5)).encode("ascii")
    out |= field.files(LEAFLETS)
    return out
