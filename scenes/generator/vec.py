"""Vectors of three numbers, as tuples."""

import math


def add(a, b):
    return (a[0] + b[0], a[1] + b[1], a[2] + b[2])


def sub(a, b):
    return (a[0] - b[0], a[1] - b[1], a[2] - b[2])


def mul(a, s):
    return (a[0] * s, a[1] * s, a[2] * s)


def dot(a, b):
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def length(a):
    return math.sqrt(dot(a, a))


def normalize(a):
    return mul(a, 1 / length(a))


def lerp(a, b, t):
    return add(mul(a, 1 - t), mul(b, t))


def combine(x, y, z, c):
    """Point with coordinates c in the frame x, y, z."""
    return add(add(mul(x, c[0]), mul(y, c[1])), mul(z, c[2]))


def rotate(v, axis, angle):
    """v turned about the unit axis, right-handed, angle in radians (Rodrigues)."""
    c, s = math.cos(angle), math.sin(angle)
    return add(add(mul(v, c), mul(cross(axis, v), s)), mul(axis, dot(axis, v) * (1 - c)))


def reject(v, n):
    """Unit vector along the part of v that is perpendicular to the unit n."""
    return normalize(sub(v, mul(n, dot(v, n))))


def direction(azimuth_deg, elevation_deg):
    """Unit vector; z is up, azimuth 0 is +x and 90 is +y."""
    a, e = math.radians(azimuth_deg), math.radians(elevation_deg)
    return (math.cos(e) * math.cos(a), math.cos(e) * math.sin(a), math.sin(e))
