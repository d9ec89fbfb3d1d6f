"""Stems, petioles and petiolules: tapered tubes along curves."""

import math

import vec
from mesh import Mesh


def bezier(p0, p1, p2, t):
    return vec.lerp(vec.lerp(p0, p1, t), vec.lerp(p1, p2, t), t)


def arc(p0, p1, p2, steps):
    """Points of a quadratic Bezier curve."""
    return [bezier(p0, p1, p2, i / steps) for i in range(steps + 1)]


def _tangent(points, i):
    return vec.normalize(vec.sub(points[min(i + 1, len(points) - 1)], points[max(i - 1, 0)]))


def _frames(points):
    """Tangent and a side vector at each point, the side carried along without turning."""
    tangent = _tangent(points, 0)
    side = vec.reject((0.0, 0.0, 1.0) if abs(tangent[2]) < 0.9 else (1.0, 0.0, 0.0), tangent)
    for i in range(len(points)):
        tangent = _tangent(points, i)
        side = vec.reject(side, tangent)
        yield tangent, side


def tube(points, start_radius, end_radius, sides=10):
    """Closed at both ends by cones as long as the radius."""
    mesh, rings = Mesh(), []
    frames = list(_frames(points))
    for i, (point, (tangent, side)) in enumerate(zip(points, frames)):
        t = i / (len(points) - 1)
        rings.append(_ring(mesh, point, tangent, side, start_radius + (end_radius - start_radius) * t, t, sides))
    for first, second in zip(rings, rings[1:]):
        for j in range(sides):
            mesh.quad(first[j], first[j + 1], second[j + 1], second[j])
    _cap(mesh, rings[0], points[0], vec.mul(frames[0][0], -1), start_radius, 0.0)
    _cap(mesh, list(reversed(rings[-1])), points[-1], frames[-1][0], end_radius, 1.0)
    return mesh


def _ring(mesh, point, tangent, side, radius, t, sides):
    up = vec.cross(tangent, side)
    ring = []
    for j in range(sides + 1):
        angle = 2 * math.pi * (j % sides) / sides
        normal = vec.add(vec.mul(side, math.cos(angle)), vec.mul(up, math.sin(angle)))
        ring.append(mesh.vertex(vec.add(point, vec.mul(normal, radius)), normal, (j / sides, t)))
    return ring


def _cap(mesh, ring, point, outward, radius, t):
    tip = mesh.vertex(vec.add(point, vec.mul(outward, radius)), outward, (0.5, t))
    for a, b in zip(ring, ring[1:]):
        mesh.triangles.append((tip, b, a))
