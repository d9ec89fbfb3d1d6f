"""Triangle meshes and their PLY bytes."""

import struct
from dataclasses import dataclass, field

# Steps that vertices are rounded to. sin and pow differ in their last bits from one C library or processor to another;
# rounded, the files come out the same to the byte everywhere.
POSITION_STEP_M = 2.0**-27
NORMAL_STEP = 2.0**-14


@dataclass
class Mesh:
    """Vertices as tuples; triangles run counter-clockwise about the side that the normals are on."""

    points: list = field(default_factory=list)
    normals: list = field(default_factory=list)
    uvs: list = field(default_factory=list)
    triangles: list = field(default_factory=list)

    def vertex(self, point, normal, uv):
        self.points.append(point)
        self.normals.append(normal)
        self.uvs.append(uv)
        return len(self.points) - 1

    def quad(self, a, b, c, d):
        self.triangles += [(a, b, c), (a, c, d)]

    def append(self, other):
        first = len(self.points)
        self.points += other.points
        self.normals += other.normals
        self.uvs += other.uvs
        self.triangles += [tuple(i + first for i in t) for t in other.triangles]


def _rounded(values, step):
    return [round(v / step) * step for v in values]


def ply_bytes(mesh, comment, with_normals=True):
    """Binary little-endian PLY: x y z [nx ny nz] u v, faces as lists of int."""
    names = ["x", "y", "z"] + (["nx", "ny", "nz"] if with_normals else []) + ["u", "v"]
    header = ["ply", "format binary_little_endian 1.0", f"comment {comment}", f"element vertex {len(mesh.points)}"]
    header += [f"property float {name}" for name in names]
    header += [f"element face {len(mesh.triangles)}", "property list uchar int vertex_indices", "end_header", ""]
    out = bytearray("\n".join(header).encode("ascii"))
    for point, normal, uv in zip(mesh.points, mesh.normals, mesh.uvs):
        values = _rounded(point, POSITION_STEP_M)
        if with_normals:
            values += _rounded(normal, NORMAL_STEP)
        out += struct.pack(f"<{len(names)}f", *values, *_rounded(uv, NORMAL_STEP))
    for triangle in mesh.triangles:
        out += struct.pack("<B3i", 3, *triangle)
    return bytes(out)
