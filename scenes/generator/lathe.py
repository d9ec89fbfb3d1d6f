"""Vessels: surfaces of revolution about z."""

import math

from mesh import Mesh


def _spline(points, steps):
    """Catmull-Rom through the points, `steps` between two of them."""
    ends = [points[0]] + points + [points[-1]]
    for p0, p1, p2, p3 in zip(ends, ends[1:], ends[2:], ends[3:]):
        for i in range(steps):
            t = i / steps
            yield tuple(
                0.5 * (2 * b + (c - a) * t + (2 * a - 5 * b + 4 * c - d) * t * t + (3 * b - a - 3 * c + d) * t**3)
                for a, b, c, d in zip(p0, p1, p2, p3))
    yield points[-1]


def turn(profile, steps=4, sectors=96):
    """The profile, points (radius, z), turned about z. Its outside is to the right of the way along the profile."""
    mesh, rings = Mesh(), []
    line = [(max(r, 0.0), z) for r, z in _spline(profile, steps)]
    lengths = [0.0]
    for (r0, z0), (r1, z1) in zip(line, line[1:]):
        lengths.append(lengths[-1] + math.hypot(r1 - r0, z1 - z0))
    for i, (r, z) in enumerate(line):
        before, after = line[max(i - 1, 0)], line[min(i + 1, len(line) - 1)]
        dr, dz = after[0] - before[0], after[1] - before[1]
        if r == 0:
            dz = 0.0  # smooth where it meets the axis
        size = math.hypot(dr, dz)
        ring = []
        for j in range(sectors + 1):
            angle = 2 * math.pi * (j % sectors) / sectors
            c, s = math.cos(angle), math.sin(angle)
            normal = (dz / size * c, dz / size * s, -dr / size)
            ring.append(mesh.vertex((r * c, r * s, z), normal, (j / sectors, lengths[i] / lengths[-1])))
        rings.append(ring)
    for (low, first), (high, second) in zip(zip(line, rings), zip(line[1:], rings[1:])):
        for j in range(sectors):
            if low[0] > 0:
                mesh.triangles.append((first[j], first[j + 1], second[j + 1]))
            if high[0] > 0:
                mesh.triangles.append((first[j], second[j + 1], second[j]))
    return mesh
