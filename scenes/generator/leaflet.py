"""A soybean leaflet as one curved sheet with its veins in relief.

The sheet is a smooth function of two numbers: a, along the midrib from base (0) to tip (1), and v, across it from the
right margin (-1) to the left one (1). Lines of constant a leave the midrib and arch toward the tip as the secondary
veins do, so that a few rows of vertices along each vein show its relief.

In the leaflet's own space the base is the origin, the midrib starts along +x, and +z is the adaxial (upper) side: that
is where normals and winding point. Metres and radians.
"""

import math
import random
from dataclasses import dataclass

import vec
from mesh import Mesh

EPSILON = 5e-4  # step of the differences that give the normals, in a and v


@dataclass(frozen=True)
class Detail:
    """How finely a leaflet is cut: 4 * columns * rows triangles."""

    veins: int = 8  # pairs
    columns: int = 24  # on each side of the midrib
    base_rows: int = 5
    gap_rows: int = 4  # between two veins
    tip_rows: int = 7


MAIN = Detail()
SPEED = Detail(veins=7, columns=10, base_rows=4, gap_rows=1, tip_rows=5)  # 2,000 triangles


@dataclass(frozen=True)
class Shape:
    """One leaflet's figure. A lateral leaflet has one half wider than the other."""

    seed: int
    length: float = 0.10
    width: float = 0.066
    left: float = 1.0  # width of the half at +y, in units of width / 2
    right: float = 1.0
    droop: float = 0.7  # how far the midrib turns down from base to tip
    sway: float = 0.0  # and sideways
    twist: float = 0.0
    fold: float = 0.28  # rise of each half at the midrib
    curl: float = 0.5  # how far it bends down again at the margin
    wave: float = 0.0022  # undulation of the margin


class Leaflet:
    """The sheet: `point` and `normal` of (a, v)."""

    def __init__(self, shape, detail):
        self.shape, self.detail = shape, detail
        draw = random.Random(shape.seed)
        n = detail.veins
        self.veins = [0.035 + 0.78 * (k / (n - 1)) ** 0.94 + draw.uniform(-0.008, 0.008) * (k > 0) for k in range(n)]
        self.vein_width = 0.0055
        self.waves = {side: [draw.uniform(0, 2 * math.pi) for _ in range(3)] for side in (-1, 1)}
        self.wave_counts = {side: draw.uniform(2.1, 3.1) for side in (-1, 1)}
        self.quilt_phase = {(side, k): draw.random() for side in (-1, 1) for k in range(n + 1)}
        self.alternation = draw.choice((-1, 1)) * draw.uniform(0.010, 0.016)

    def outline(self, s):
        """Half width, 1 at the widest: rounded base, acute tip."""
        p, q = 0.62, 1.08
        widest = p / (p + q)
        s = min(max(s, 0.0), 1.0)
        return (s / widest) ** p * ((1 - s) / (1 - widest)) ** q

    def along(self, a, v):
        """Where on the midrib's axis the point (a, v) lies, 0..1: veins leave it and arch forward."""
        a, across = min(max(a, 0.0), 1.0), abs(v)
        side = math.copysign(1, v)
        a += side * self.alternation * 4 * a * (1 - a) * (1 - math.exp(-across / 0.06))
        a = min(max(a, 0.0), 1.0)
        reach = 0.57 * math.sqrt(a) * (1 - a)
        return a + reach * (0.72 * across + 0.28 * across**3)

    def midrib(self, s):
        """Position on the midrib and the frame there: tangent, left, up."""
        steps = 12
        position = (0.0, 0.0, 0.0)
        for i in range(steps + 1):  # Simpson's rule
            weight = 1 if i in (0, steps) else 4 if i % 2 else 2
            position = vec.add(position, vec.mul(self._tangent(s * i / steps), weight * s / (3 * steps)))
        tangent = self._tangent(s)
        yaw = self.shape.sway * s * s
        left = (-math.sin(yaw), math.cos(yaw), 0.0)
        left = vec.rotate(left, tangent, self.shape.twist * s)
        return vec.mul(position, self.shape.length), tangent, left, vec.cross(tangent, left)

    def _tangent(self, s):
        pitch, yaw = -self.shape.droop * max(s, 0.0) ** 1.5, self.shape.sway * s * s
        return (math.cos(pitch) * math.cos(yaw), math.cos(pitch) * math.sin(yaw), math.sin(pitch))

    def height(self, x, v, s):
        """Of the cross-section above the midrib's frame: raised halves that bend down again, and a wavy margin."""
        shape, side = self.shape, (1 if v >= 0 else -1)
        radius, half = 0.004, shape.width / 2
        fold = shape.fold * (1 - 0.45 * s)
        rise = fold * radius * math.log(math.cosh(x / radius)) - 0.5 * shape.curl * x * x / half
        phases, count = self.waves[side], self.wave_counts[side]
        wave = math.sin(2 * math.pi * count * s + phases[0]) + 0.4 * math.sin(4.6 * math.pi * count * s + phases[1])
        envelope = abs(v) ** 2.5 * math.sin(math.pi * min(max(s, 0.0), 1.0)) ** 0.5
        return rise + shape.wave * wave * envelope

    def relief(self, a, v, s):
        """Veins sunk into the adaxial side (raised on the abaxial one), the blade between them slightly puffed."""
        across, side = abs(v), (1 if v >= 0 else -1)
        depth = 0.0007 * (1 - 0.8 * s) * min(1.0, self.outline(s) / 0.4)
        sunk = depth * _ridge(v / 0.04)
        taper = 1 - math.exp(-((across / 0.05) ** 2))
        for vein in self.veins:
            sunk += 0.00024 * (1 - 0.75 * across) * (1 - 0.4 * a) * taper * _ridge((a - vein) / self.vein_width)
        return self._quilt(a, across, side) - sunk

    def _quilt(self, a, across, side):
        edges = [0.0] + self.veins + [1.0]
        k = sum(1 for vein in self.veins if a >= vein)
        size = edges[k + 1] - edges[k]
        u = min(max((a - edges[k]) / size, 0.0), 1.0)
        bump = math.sin(math.pi * u) ** 2 * min(1.0, size / 0.1)
        inside = (1 - math.exp(-((across / 0.15) ** 2))) * (1 - across**4)
        ends = 0.3 if k in (0, len(self.veins)) else 1.0
        ladder = math.cos(2 * math.pi * (6.5 * across + 0.35 * u + self.quilt_phase[side, k]))
        return bump * inside * (0.00050 + 0.00010 * ends * ladder)

    def point(self, a, v):
        s = self.along(a, v)
        half = self.shape.width / 2 * (self.shape.left if v >= 0 else self.shape.right)
        x = v * half * self.outline(s)
        position, _, left, up = self.midrib(s)
        lift = self.height(x, v, s) + self.relief(a, v, s)
        return vec.add(position, vec.add(vec.mul(left, x * math.cos(self.shape.fold)), vec.mul(up, lift)))

    def normal(self, a, v):
        """Unit, on the adaxial side."""
        a = min(max(a, 2 * EPSILON), 1 - 2 * EPSILON)
        v = min(max(v, -1 + EPSILON), 1 - EPSILON)
        da = vec.sub(self.point(a + EPSILON, v), self.point(a - EPSILON, v))
        dv = vec.sub(self.point(a, v + EPSILON), self.point(a, v - EPSILON))
        return vec.normalize(vec.cross(da, dv))

    def uv(self, a, v):
        """u across the blade, 0.5 on the midrib; v from base to tip."""
        s = self.along(a, v)
        return (0.5 + 0.5 * v * self.outline(s), s)


def _ridge(x):
    """A smooth bump of height 1 over (-1, 1)."""
    return (1 - x * x) ** 2 if abs(x) < 1 else 0.0


def _rows(leaflet):
    detail, width = leaflet.detail, leaflet.vein_width
    rows = [(leaflet.veins[0] - width) * ((i + 1) / (detail.base_rows + 1)) ** 2 for i in range(detail.base_rows)]
    for k, vein in enumerate(leaflet.veins):
        rows += [vein + width * t for t in (-1, -0.5, 0, 0.5, 1)]
        last = k + 1 == len(leaflet.veins)
        end, count = (1.0, detail.tip_rows) if last else (leaflet.veins[k + 1] - width, detail.gap_rows)
        start = vein + width
        rows += [start + (end - start) * (i + 1) / (count + 1) for i in range(count)]
    return rows


def _columns(detail):
    inner = [0.02, 0.04] if detail.columns > 12 else [0.04]
    outer = detail.columns - len(inner)
    half = inner + [0.04 + 0.96 * ((i + 1) / outer) ** 1.05 for i in range(outer)]
    return [-v for v in reversed(half)] + [0.0] + half


def build(shape, detail=MAIN):
    """The leaflet's mesh."""
    leaflet, mesh = Leaflet(shape, detail), Mesh()

    def vertex(a, v):
        return mesh.vertex(leaflet.point(a, v), leaflet.normal(a, v), leaflet.uv(a, v))

    columns = _columns(detail)
    base = vertex(0.0, 0.0)
    grid = [[vertex(a, v) for v in columns] for a in _rows(leaflet)]
    tip = vertex(1.0, 0.0)
    for j in range(len(columns) - 1):
        mesh.triangles.append((base, grid[0][j], grid[0][j + 1]))
        mesh.triangles.append((grid[-1][j], tip, grid[-1][j + 1]))
    for row, following in zip(grid, grid[1:]):
        for j in range(len(columns) - 1):
            mesh.quad(row[j], following[j], following[j + 1], row[j + 1])
    return mesh
