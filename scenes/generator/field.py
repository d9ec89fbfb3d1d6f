"""A field of soybean in rows: plants, their tables, the soil, maps of the veins and the sky.

A leaflet stands in a table of its plant, with its chlorophyll; a plant in a table of the field, with its vigour. The
field is a tile that is repeated periodically along x and y: rows run along y, and whatever varies slowly has the tile's period.
"""

import math
import random
import struct
import zlib
from dataclasses import replace

import leaflet
import tube
import vec
from mesh import Mesh, ply_bytes
from plant import Leaf, Plant

ROW = 0.70  # between rows
ROWS, LENGTH = 16, 12.0
PERIOD = (ROWS * ROW, LENGTH)
SPACING = 0.08  # between plants of a row
FACING = 75.0  # azimuth that leaves turn to: +x is 0, +y is 90
KINDS = 7
STEP = 2.0**-22  # what the tables' numbers are rounded to, as in mesh.py


# Plants


def leaves_of(draw, height):
    """From the lowest leaf to the youngest, and the share of a healthy leaf's chlorophyll that each has."""
    count = draw.randrange(12, 18)
    azimuth, drift = draw.uniform(0, 360), draw.uniform(12, 34)
    for i in range(count):
        t = i / (count - 1)
        azimuth += 180 + draw.gauss(drift, 18)
        young = max(0.0, (t - 0.78) / 0.22)
        petiole = (0.08 + 0.11 * math.sin(math.pi * (0.12 + 0.62 * t))) * (1 - 0.68 * young) * draw.uniform(0.88, 1.12)
        yield Leaf(
            height=0.10 + (height - 0.10) * t**0.85,
            azimuth=azimuth,
            elevation=22 + 28 * t + 20 * young + draw.gauss(0, 6),
            petiole=petiole,
            scale=(0.86 + 0.42 * math.sin(math.pi * min(1.0, t / 0.9) * 0.78)) * (1 - 0.48 * young) * draw.uniform(0.93, 1.07),
            sag=draw.uniform(8, 20),
            pitch=-18 + 20 * young + draw.gauss(0, 13),
            roll=draw.gauss(0, 18),
            lateral_pitch=-12 + 18 * young + draw.gauss(0, 5),
            turn=draw.gauss(0, 18),
            seed=draw.randrange(1 << 30),
        ), health(draw, t, young)


def health(draw, t, young):
    """Lower leaves grow old and yellow, the youngest are not green yet."""
    old = max(0.0, 1 - t / 0.42)
    share = (1 - 0.55 * old**1.2) * (1 - 0.30 * young)
    if draw.random() < 0.03:
        share *= draw.uniform(0.15, 0.45)
    return share * draw.uniform(0.84, 1.10)


class FieldPlant(Plant):
    """With tubes that are cut less finely: a field has many."""

    def _grow_leaf(self, leaf):
        node = self._node(leaf.height)
        start = vec.direction(leaf.azimuth, leaf.elevation)
        finish = vec.direction(leaf.azimuth, leaf.elevation - 2 * leaf.sag)
        middle = vec.add(node, vec.mul(start, leaf.petiole / 2))
        end = vec.add(middle, vec.mul(finish, leaf.petiole / 2))
        self.tubes.append(tube.tube(tube.arc(node, middle, end, 6), 0.0015 * leaf.scale, 0.0010 * leaf.scale, sides=7))
        self._grow_blades(leaf, end)

    def _stalk(self, leaf, start, end):
        points = [vec.lerp(start, end, i / 2) for i in range(3)]
        self.tubes.append(tube.tube(points, 0.0010 * leaf.scale, 0.0007 * leaf.scale, sides=5))


def grow(kind):
    """The plant, and the chlorophyll of each of its leaflets."""
    draw = random.Random(7000 + kind)
    height = draw.uniform(0.60, 0.74)
    lean, bearing = draw.uniform(0.0, 0.07), draw.uniform(0, 2 * math.pi)
    stem = []
    for i in range(9):
        t = i / 8
        zigzag = 0.005 * (-1) ** i * (t > 0)
        reach = lean * t * t
        stem.append((reach * math.cos(bearing) + zigzag, reach * math.sin(bearing) - 0.5 * zigzag, height * t - 0.03 * (i == 0)))
    leaves, shares = zip(*leaves_of(draw, height))
    facing = vec.direction(FACING, 24)
    grown = FieldPlant(stem, leaves, radius=0.0042, facing=facing, facing_weight=0.33).grow()
    shapes = {name: 1 + (kind >> bit & 1) for bit, name in enumerate(("terminal", "left", "right"))}
    grown.leaflets = [replace(p, kind=f"{p.kind.split('-')[0]}-{shapes[p.kind.split('-')[0]]}") for p in grown.leaflets]
    return grown, [shares[i // 3] * draw.uniform(0.95, 1.05) for i in range(len(grown.leaflets))]


# The field


def waves(x, y, terms):
    """A slow variation, with the tile's period: (amplitude, waves along x, along y, phase)."""
    return sum(a * math.cos(2 * math.pi * (m * x / PERIOD[0] + n * y / PERIOD[1]) + p) for a, m, n, p in terms)


VIGOUR = ((0.14, 1, 1, 0.4), (0.12, -2, 1, 2.0), (0.09, 1, -3, 4.1), (0.07, 3, 2, 5.3))
HEIGHT = ((0.05, 1, 1, 0.6), (0.04, -2, 1, 1.6), (0.03, 2, -3, 3.0))


def plants():
    """Kind, map and vigour of each plant."""
    draw = random.Random(42)
    count = round(LENGTH / SPACING)
    for row in range(ROWS):
        for i in range(count):
            x = (row + 0.5) * ROW + draw.gauss(0, 0.012)
            y = (i + 0.5) * LENGTH / count + draw.uniform(-0.02, 0.02)
            if draw.random() < 0.03:
                continue  # did not come up
            size = (1 + waves(x, y, HEIGHT)) * min(1.25, max(0.72, draw.gauss(1.0, 0.085)))
            turn, tilt, toward = draw.gauss(0, 40), draw.gauss(0, 4), draw.uniform(0, 360)
            vigour = min(1.15, max(0.45, (0.95 + waves(x, y, VIGOUR)) * draw.gauss(1.0, 0.10)))
            axis = vec.direction(toward, 0)
            frame = [vec.rotate(vec.direction(turn, 0), axis, math.radians(tilt)),
                     vec.rotate(vec.direction(turn + 90, 0), axis, math.radians(tilt)),
                     vec.rotate((0.0, 0.0, 1.0), axis, math.radians(tilt))]
            yield draw.randrange(KINDS), rows_of(frame, (x, y, 0.0), size), vigour


def rows_of(frame, origin, scale):
    """The three rows of a map, one after another."""
    return [c for i in range(3) for c in (*(axis[i] * scale for axis in frame), origin[i])]


def npy_bytes(rows, column=None):
    """NumPy's format, version 1: records of `transform` and one more number."""
    further = f", ('{column}', '<f4')" if column else ""
    header = f"{{'descr': [('transform', '<f4', (3, 4)){further}], 'fortran_order': False, 'shape': ({len(rows)},), }}"
    header += " " * (-(10 + len(header) + 1) % 64) + "\n"
    out = b"\x93NUMPY\x01\x00" + struct.pack("<H", len(header)) + header.encode("ascii")
    return out + b"".join(struct.pack(f"<{len(row)}f", *(round(x / STEP) * STEP for x in row)) for row in rows)


def plants_text(kinds):
    """The plants as a file to Include: leaflets, plants of them, the field of those."""
    lines = ["# Written by scenes/generator/make.py.", ""]
    for shape in sorted({shape for shapes in kinds.values() for shape in shapes}):
        lines += [f'ObjectBegin "{shape}"', f'  NamedMaterial "leaf-{shape}"']
        lines += [f'  Shape "plymesh" "string filename" "../../meshes/leaflet-{shape}.ply"', "ObjectEnd"]
    for kind, shapes in kinds.items():
        lines += ["", f'ObjectBegin "plant-{kind}"']
        for shape in shapes:
            lines += [f'  Shape "instances" "string object" "{shape}" "string filename" "plants/{kind}-{shape}.npy"']
        lines += ['  NamedMaterial "petiole"', f'  Shape "plymesh" "string filename" "plants/{kind}-stems.ply"', "ObjectEnd"]
    lines += [""]
    for kind in kinds:
        lines += [f'Shape "instances" "string object" "plant-{kind}" "string filename" "plants/{kind}-field.npy"']
    return "\n".join(lines) + "\n"


# Soil


class Noise:
    """Smooth noise over a lattice that repeats."""

    def __init__(self, seed, columns, rows):
        draw = random.Random(seed)
        self.values = [[draw.uniform(-1, 1) for _ in range(columns)] for _ in range(rows)]
        self.columns, self.rows = columns, rows

    def at(self, u, v):
        """u and v from 0 to 1 and so on."""
        x, y = u * self.columns, v * self.rows
        i, j = math.floor(x), math.floor(y)
        a, b = _smooth(x - i), _smooth(y - j)
        low, high = self.values[j % self.rows], self.values[(j + 1) % self.rows]
        i, k = i % self.columns, (i + 1) % self.columns
        return (low[i] * (1 - a) + low[k] * a) * (1 - b) + (high[i] * (1 - a) + high[k] * a) * b


def _smooth(t):
    return t * t * (3 - 2 * t)


SOIL = (2 * ROW, 1.2)  # of a patch


def soil(columns=70, rows=60):
    """A patch with two furrows and clods; its edges fit those of its neighbours."""
    noises = [(0.006, Noise(1, 9, 8)), (0.014, Noise(2, 23, 20)), (0.007, Noise(3, 47, 40))]
    mesh = Mesh()

    def height(u, v):
        z = 0.022 * -math.cos(4 * math.pi * u) - 0.03
        rough = [a * noise.at(u, v) for a, noise in noises]
        return z + rough[0] + max(-0.002, rough[1]) + max(-0.001, rough[2])

    def vertex(i, j):
        u, v, d = i / columns, j / rows, 1e-3
        along_x = (2 * d * SOIL[0], 0.0, height(u + d, v) - height(u - d, v))
        along_y = (0.0, 2 * d * SOIL[1], height(u, v + d) - height(u, v - d))
        normal = vec.normalize(vec.cross(along_x, along_y))
        return mesh.vertex((u * SOIL[0], v * SOIL[1], height(u, v)), normal, (u, v))

    grid = [[vertex(i, j) for i in range(columns + 1)] for j in range(rows + 1)]
    for low, high in zip(grid, grid[1:]):
        for i in range(columns):
            mesh.quad(low[i], low[i + 1], high[i + 1], high[i])
    return mesh


def soil_patches():
    frame = ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))
    for i in range(round(PERIOD[0] / SOIL[0])):
        for j in range(round(PERIOD[1] / SOIL[1])):
            yield rows_of(frame, (i * SOIL[0], j * SOIL[1], 0.0), 1.0)


# Veins


class Veins:
    """How much of the blade's chlorophyll there is at (u, v) of a leaflet: less on veins."""

    WIDTH, HEIGHT = 160, 256
    STEPS = 40  # across half a blade

    def __init__(self, shape):
        self.sheet = leaflet.Leaflet(shape, leaflet.MAIN)
        self.curves = {side: [[self.sheet.along(vein, side * (i + 0.5) / self.STEPS) for i in range(self.STEPS + 1)]
                              for vein in self.sheet.veins] for side in (-1, 1)}
        self.draw = random.Random(shape.seed)
        self.cells = {}
        self.patches = Noise(shape.seed + 1, 7, 9)

    def _cell(self, i, j):
        if (i, j) not in self.cells:
            self.cells[i, j] = (i + self.draw.random(), j + self.draw.random())
        return self.cells[i, j]

    def _net(self, u, v):
        """1 on the finest veins, which enclose small cells."""
        x, y = u * 30, v * 44
        i, j = int(x), int(y)
        near = sorted((x - a) ** 2 + (y - b) ** 2 for a, b in
                      (self._cell(i + k, j + l) for l in (-1, 0, 1) for k in (-1, 0, 1)))
        return max(0.0, 1 - (math.sqrt(near[1]) - math.sqrt(near[0])) / 0.28)

    def at(self, u, s):
        outline = max(0.02, self.sheet.outline(s))
        v = min(1.0, max(-1.0, (2 * u - 1) / outline))
        side, across = (1 if v >= 0 else -1), abs(v)
        midrib = _bump((2 * u - 1) / (0.045 * (1 - 0.65 * s)))
        place = max(0.0, across * self.STEPS - 0.5)
        i = min(int(place), self.STEPS - 1)
        secondary = 0.0
        for curve in self.curves[side]:
            distance = s - (curve[i] + (curve[i + 1] - curve[i]) * (place - i))
            secondary = max(secondary, _bump(distance / (0.0105 * (1 - 0.5 * across))))
        secondary *= 1 - 0.55 * across**2
        blade = 1 + 0.10 * self.patches.at(u, s) - 0.10 * across**4
        return blade * (1 - 0.80 * midrib) * (1 - 0.62 * secondary) * (1 - 0.20 * self._net(u, s))

    def png(self):
        """v runs up, from the leaflet's base."""
        lines = [[self.at((i + 0.5) / self.WIDTH, 1 - (j + 0.5) / self.HEIGHT) for i in range(self.WIDTH)]
                 for j in range(self.HEIGHT)]
        return png_bytes([[min(255, max(0, round(230 * x))) for x in line] for line in lines])


def _bump(x):
    return (1 - x * x) ** 2 if abs(x) < 1 else 0.0


def png_bytes(lines):
    """Grey, of 8 bits. Stored as it is: what zlib makes of it differs from one version to another."""
    data = b"".join(b"\0" + bytes(line) for line in lines)
    parts = [data[i : i + 65535] for i in range(0, len(data), 65535)]
    stored = b"\x78\x01"
    for i, part in enumerate(parts):
        stored += struct.pack("<BHH", i + 1 == len(parts), len(part), len(part) ^ 0xFFFF) + part
    stored += struct.pack(">I", zlib.adler32(data))

    def chunk(name, content):
        return struct.pack(">I", len(content)) + name + content + struct.pack(">I", zlib.crc32(name + content))

    header = struct.pack(">IIBBBBB", len(lines[0]), len(lines), 8, 0, 0, 0, 0)
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", stored) + chunk(b"IEND", b"")


# Sky

SUN_AZIMUTH, SUN_ELEVATION = 32.0, 42.0
SKY_SIZE = 512


def sky(direction):
    """Linear sRGB: blue overhead, pale at the hazy horizon, warm about the sun."""
    up = max(0.0, direction[2])
    haze = math.exp(-up / 0.12)
    pale = math.exp(-up / 0.40)
    near = vec.dot(direction, vec.direction(SUN_AZIMUTH, SUN_ELEVATION))
    glow = math.exp((near - 1) / 0.16)
    core = math.exp((near - 1) / 0.018)
    color = []
    for zenith, horizon, mist, warm in zip((0.10, 0.24, 0.60), (0.34, 0.54, 0.86), (0.50, 0.66, 0.92), (1.0, 0.80, 0.55)):
        c = zenith + (horizon - zenith) * pale
        c += (mist - c) * 0.75 * haze * (0.45 + 0.55 * (1 + near) / 2)
        color.append(c + warm * (0.75 * glow * (0.3 + 0.7 * pale) + 1.6 * core))
    return color


def from_square(x, y):
    """pbrt-v4's equal-area map of the sphere, x and y from -1 to 1."""
    d = 1 - (abs(x) + abs(y))
    r = 1 - abs(d)
    phi = math.pi / 4 * ((abs(y) - abs(x)) / r + 1 if r else 1)
    ring = r * math.sqrt(max(0.0, 2 - r * r))
    return (math.copysign(math.cos(phi), x) * ring, math.copysign(math.sin(phi), y) * ring, math.copysign(1 - r * r, d))


def sky_bytes():
    """Radiance's RGBE, lines as they are."""
    out = [b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y %d +X %d\n" % (SKY_SIZE, SKY_SIZE)]
    for j in range(SKY_SIZE):
        for i in range(SKY_SIZE):
            color = sky(from_square((2 * i + 1) / SKY_SIZE - 1, (2 * j + 1) / SKY_SIZE - 1))
            mantissa, exponent = math.frexp(max(color))
            out.append(bytes([min(255, round(c * 256 / 2.0**exponent)) for c in color] + [exponent + 128]))
    return b"".join(out)


def files(shapes):
    """Path under scenes/ -> bytes. `shapes`: of the leaflets."""
    out, kinds, folder = {}, {}, "canopy/soybean-field"
    for kind in range(KINDS):
        grown, shares = grow(kind)
        kinds[kind] = sorted({p.kind for p in grown.leaflets})
        for shape in kinds[kind]:
            rows = [rows_of(p.frame, p.origin, p.scale) + [share] for p, share in zip(grown.leaflets, shares)
                    if p.kind == shape]
            out[f"{folder}/plants/{kind}-{shape}.npy"] = npy_bytes(rows, "health")
        out[f"{folder}/plants/{kind}-stems.ply"] = ply_bytes(grown.tubes, "stem, petioles and petiolules")
    field = list(plants())
    for kind in range(KINDS):
        rows = [placed + [vigour] for k, placed, vigour in field if k == kind]
        out[f"{folder}/plants/{kind}-field.npy"] = npy_bytes(rows, "vigour")
    out[f"{folder}/plants.pbrt"] = plants_text(kinds).encode("ascii")
    out[f"{folder}/soil.ply"] = ply_bytes(soil(), "soil with furrows")
    out[f"{folder}/soil.npy"] = npy_bytes(list(soil_patches()))
    for name, shape in shapes.items():
        out[f"{folder}/veins/{name}.png"] = Veins(shape).png()
    out[f"{folder}/sky.hdr"] = sky_bytes()
    return out
