"""Triangle meshes as binary PLY files."""

import pathlib

import numpy

FACE = numpy.dtype([("count", "u1"), ("of", "<i4", 3)])


def read(path):
    """Points and triangles of a file with vertices of floats."""
    head, body = pathlib.Path(path).read_bytes().split(b"end_header\n", 1)
    words = head.decode("ascii").split()
    vertices, faces = (int(words[words.index(name) + 1]) for name in ("vertex", "face"))
    columns = words[words.index("vertex"):words.index("face")].count("float")
    points = numpy.frombuffer(body, "<f4", vertices * columns).reshape(vertices, columns)[:, :3]
    triangles = numpy.frombuffer(body, FACE, faces, offset=4 * vertices * columns)
    assert (triangles["count"] == 3).all()
    return points.astype(float), triangles["of"]


def write(path, points, triangles):
    """Writes points and triangles, without normals; returns the path as text."""
    record = numpy.zeros(len(triangles), FACE)
    record["count"], record["of"] = 3, triangles
    head = ["ply", "format binary_little_endian 1.0", f"element vertex {len(points)}", *(f"property float {c}" for c in "xyz"),
            f"element face {len(triangles)}", "property list uchar int vertex_indices", "end_header", ""]
    pathlib.Path(path).write_bytes("\n".join(head).encode("ascii") + numpy.asarray(points, "<f4").tobytes() + record.tobytes())
    return str(path)
