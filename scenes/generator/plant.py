"""Trifoliolate leaves and the stem that bears them: where each leaflet stands, and the tubes between."""

import random
from dataclasses import dataclass, field
from math import radians

import tube
import vec
from mesh import Mesh

UP = (0.0, 0.0, 1.0)


@dataclass(frozen=True)
class Leaf:
    """One leaf: a petiole that ends in a terminal leaflet and a pair of lateral ones. Degrees and metres."""

    height: float  # of its node on the stem
    azimuth: float
    elevation: float  # of the petiole where it leaves the stem
    petiole: float  # length
    scale: float = 1.0  # of the leaflets
    sag: float = 25.0  # how far the petiole bends down on its way
    pitch: float = -12.0  # of the blades, along the leaf's axis
    roll: float = 0.0  # about that axis
    lateral: float = 74.0  # angle between the axis and the lateral leaflets
    lateral_pitch: float = -14.0
    turn: float = 0.0  # of the blades against the petiole, about the vertical
    seed: int = 0


@dataclass(frozen=True)
class Placed:
    """A leaflet of a kind in the scene's space: its axes (midrib, left, adaxial), base and size."""

    kind: str
    frame: tuple
    origin: tuple
    scale: float


@dataclass
class Plant:
    """`facing` pulls the blades' upper sides toward a direction, as leaves turn to the light."""

    stem: list  # points, from the ground up
    leaves: list
    radius: float = 0.003
    facing: tuple = UP
    facing_weight: float = 0.0
    origin: tuple = (0.0, 0.0, 0.0)
    leaflets: list = field(default_factory=list)
    tubes: Mesh = field(default_factory=Mesh)

    def grow(self):
        """Fills `leaflets` and `tubes`."""
        if self.stem:
            self.tubes.append(tube.tube([vec.add(p, self.origin) for p in self.stem], self.radius, 0.5 * self.radius))
        for leaf in self.leaves:
            self._grow_leaf(leaf)
        return self

    def _node(self, height):
        for low, high in zip(self.stem, self.stem[1:]):
            if low[2] <= height <= high[2]:
                return vec.lerp(low, high, (height - low[2]) / (high[2] - low[2]))
        return self.stem[-1]

    def _grow_leaf(self, leaf):
        node = vec.add(self._node(leaf.height), self.origin)
        start = vec.direction(leaf.azimuth, leaf.elevation)
        finish = vec.direction(leaf.azimuth, leaf.elevation - 2 * leaf.sag)
        middle = vec.add(node, vec.mul(start, leaf.petiole / 2))
        end = vec.add(middle, vec.mul(finish, leaf.petiole / 2))
        self.tubes.append(tube.tube(tube.arc(node, middle, end, 10), 0.0016 * leaf.scale, 0.0011 * leaf.scale))
        self._grow_blades(leaf, end)

    def _blade_frame(self, leaf):
        normal = vec.normalize(vec.lerp(UP, self.facing, self.facing_weight))
        axis = vec.reject(vec.direction(leaf.azimuth + leaf.turn, 0), normal)
        axis = vec.rotate(axis, vec.cross(axis, normal), radians(leaf.pitch))
        normal = vec.rotate(vec.reject(normal, axis), axis, radians(leaf.roll))
        return axis, normal

    def _grow_blades(self, leaf, end):
        draw = random.Random(1000 + leaf.seed)
        axis, normal = self._blade_frame(leaf)
        fork = vec.add(end, vec.mul(axis, 0.024 * leaf.scale))
        self._stalk(leaf, end, fork)
        self._place(leaf, draw, "terminal", fork, axis, normal, draw.uniform(-5, 5), 1.06)
        for side, kind in ((1, "left"), (-1, "right")):
            across = vec.rotate(axis, normal, side * radians(leaf.lateral + draw.uniform(-5, 5)))
            pitch = leaf.lateral_pitch + draw.uniform(-6, 6)
            self._place(leaf, draw, kind, end, across, normal, pitch, draw.uniform(0.9, 0.98))

    def _place(self, leaf, draw, kind, fork, axis, normal, pitch, size):
        """A leaflet on its petiolule; `pitch` in degrees against the blades' plane."""
        left = vec.cross(normal, axis)
        axis = vec.rotate(axis, left, radians(-pitch))
        left = vec.rotate(left, axis, radians(draw.uniform(-9, 9)))
        normal = vec.cross(axis, left)
        scale = leaf.scale * size
        base = vec.add(fork, vec.mul(axis, 0.005 * scale))
        self._stalk(leaf, fork, vec.add(base, vec.mul(axis, 0.004 * scale)))
        name = f"{kind}-{1 + draw.randrange(2)}"
        self.leaflets.append(Placed(name, (axis, left, normal), base, scale))

    def _stalk(self, leaf, start, end):
        points = [vec.lerp(start, end, i / 3) for i in range(4)]
        self.tubes.append(tube.tube(points, 0.0010 * leaf.scale, 0.0007 * leaf.scale, sides=8))


def transform(placed):
    """pbrt's Transform: the matrix column by column, rounded so that it reads the same everywhere (no -0)."""
    columns = [vec.mul(axis, placed.scale) + (0.0,) for axis in placed.frame] + [placed.origin + (1.0,)]
    return " ".join(f"{round(x, 6) + 0.0:.6f}" for column in columns for x in column)


def flutter(draw):
    """Directives that turn a leaflet about its base during the exposure: about the midrib, and up or down, in degrees."""
    turns = f"Rotate {draw.uniform(-14, 14):.2f} 1 0 0  Rotate {draw.uniform(-7, 7):.2f} 0 1 0"
    return f"  ActiveTransform EndTime  {turns}  ActiveTransform All"


def pbrt_text(placed_leaflets, stems_file, mesh_folder, wind=None):
    """The plant as a file to Include: each kind of leaflet once, then its instances, then the stems. `wind`: random
    numbers for motion; None: the leaves stand still."""
    lines = ["# Written by scenes/generator/make.py.", ""]
    for kind in sorted({p.kind for p in placed_leaflets}):
        lines += [f'ObjectBegin "{kind}"', '  NamedMaterial "leaf"']
        lines += [f'  Shape "plymesh" "string filename" "{mesh_folder}/leaflet-{kind}.ply"', "ObjectEnd", ""]
    for placed in placed_leaflets:
        lines += ["AttributeBegin", f"  Transform [ {transform(placed)} ]"] + ([flutter(wind)] if wind else [])
        lines += [f'  ObjectInstance "{placed.kind}"', "AttributeEnd"]
    if stems_file:
        lines += ["", 'NamedMaterial "petiole"', f'Shape "plymesh" "string filename" "{stems_file}"']
    return "\n".join(lines) + "\n"
