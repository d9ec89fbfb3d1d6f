#!/usr/bin/env python3
"""Writes the tensor files of the scenes 10_measured_*: the BRDFs of rough metals by a formula, stored in the parameterization of
Dupuy and Jakob 2018. tests/materials/measured_test.cpp compares the files with the formula.

f(o, i) = R(wavelength) D(m) G1(o) G1(i) / (4 cos_o cos_i), with the Trowbridge-Reitz distribution D of roughness alpha_x,
alpha_y and Smith's G1; R is linear from 0.9 at 360 nm to 0.3 at 830 nm."""

import struct
from pathlib import Path

import numpy

FOLDER = Path(__file__).parent
WAVELENGTHS = numpy.array([360, 595, 830], "f4")
TYPES = {numpy.dtype("u1"): 1, numpy.dtype("f4"): 10}


def reflectance(nm):
    return 0.9 - 0.6 * (nm - 360) / 470


class Facets:
    """Trowbridge-Reitz facets; directions are arrays [..., 3]."""

    def __init__(self, alpha_x, alpha_y):
        self.a = numpy.array([alpha_x, alpha_y, 1.0])

    def density(self, m):
        return 1 / (numpy.pi * self.a[0] * self.a[1] * numpy.sum((m / self.a) ** 2, axis=-1) ** 2)

    def g1(self, w):
        cosine = numpy.maximum(w[..., 2], 1e-9)
        return 2 / (1 + numpy.sqrt(1 + ((self.a[0] * w[..., 0]) ** 2 + (self.a[1] * w[..., 1]) ** 2) / cosine**2))

    def sigma(self, w):
        """Area of the facets seen from w, per area of the surface."""
        stretched = numpy.linalg.norm(w * self.a, axis=-1)
        return (w[..., 2] + stretched) / 2


def direction(theta, phi):
    return numpy.stack([numpy.sin(theta) * numpy.cos(phi), numpy.sin(theta) * numpy.sin(phi), numpy.cos(theta)], axis=-1)


def square(width, height):
    """Polar and azimuth angles of the nodes of the unit square, [y][x]."""
    u, v = numpy.meshgrid(numpy.linspace(0, 1, width), numpy.linspace(0, 1, height))
    return u**2 * numpy.pi / 2, (2 * v - 1) * numpy.pi, u


def bilinear(grid, x, y):
    height, width = grid.shape
    x, y = x * (width - 1), y * (height - 1)
    i, j = numpy.minimum(x.astype(int), width - 2), numpy.minimum(y.astype(int), height - 2)
    s, t = x - i, y - j
    return ((1 - t) * ((1 - s) * grid[j, i] + s * grid[j, i + 1]) + t * ((1 - s) * grid[j + 1, i] + s * grid[j + 1, i + 1]))


def inverse_of_linear(a, b, area):
    root = a + numpy.sqrt(numpy.maximum(0, a * a + 2 * area * (b - a)))
    return numpy.clip(2 * area / numpy.maximum(root, 1e-30), 0, 1)


def warp(density, u, v):
    """The point with the cumulative probabilities v of y, and u of x given y."""
    height, width = density.shape
    left = numpy.concatenate([numpy.zeros((height, 1)), numpy.cumsum((density[:, 1:] + density[:, :-1]) / 2, axis=1)], axis=1)
    rows = left[:, -1]
    below = numpy.concatenate([[0], numpy.cumsum((rows[1:] + rows[:-1]) / 2)])
    target = v * below[-1]
    y = min(max(numpy.searchsorted(below, target, "right") - 1, 0), height - 2)
    t = inverse_of_linear(rows[y], rows[y + 1], target - below[y])
    along, values = (1 - t) * left[y] + t * left[y + 1], (1 - t) * density[y] + t * density[y + 1]
    target = u * along[-1]
    x = min(max(numpy.searchsorted(along, target, "right") - 1, 0), width - 2)
    s = inverse_of_linear(values[x], values[x + 1], target - along[x])
    return (x + s) / (width - 1), (y + t) / (height - 1)


def fields(facets, phi_i, theta_i, normals, values):
    """Fields of a file. `normals`: width and height of the grids over half vectors; `values`: of the spectra."""
    theta, phi, u = square(*normals)
    half = direction(theta, phi)
    ndf = facets.density(half)
    spectra = numpy.zeros((len(phi_i), len(theta_i), len(WAVELENGTHS), values, values))
    vndf = numpy.zeros((len(phi_i), len(theta_i), *ndf.shape))
    for p, phi_o in enumerate(phi_i):
        turn = phi_o if len(phi_i) <= 2 else 0.0  # isotropic: half vectors relative to the azimuth of o
        for t, theta_o in enumerate(theta_i):
            o = direction(theta_o, phi_o)
            seen = numpy.maximum(0, direction(theta, phi + turn) @ o)
            vndf[p, t] = ndf * seen / facets.sigma(o) * 2 * numpy.pi**2 * u * numpy.sin(theta)
            for (y, x) in numpy.ndindex(values, values):
                at = numpy.array(warp(vndf[p, t], x / (values - 1), y / (values - 1)))
                m = direction(at[0] ** 2 * numpy.pi / 2, (2 * at[1] - 1) * numpy.pi + turn)
                i = 2 * (m @ o) * m - o
                if i[2] <= 0:
                    continue
                f = facets.density(m) * facets.g1(o) * facets.g1(i) / (4 * o[2] * i[2])
                spectra[p, t, :, y, x] = reflectance(WAVELENGTHS) * f * 4 * facets.sigma(o) * i[2] / bilinear(ndf, *at)
    theta, phi, _ = square(33, 2 if len(phi_i) <= 2 else 33)
    return {"phi_i": phi_i, "theta_i": theta_i, "wavelengths": WAVELENGTHS, "ndf": ndf,
            "sigma": facets.sigma(direction(theta, phi)), "vndf": vndf, "luminance": spectra[:, :, 1], "spectra": spectra}


def write(path, description, arrays):
    everything = {"description": numpy.frombuffer(description.encode(), "u1"), "jacobian": numpy.array([1], "u1"),
                  **{name: numpy.ascontiguousarray(array, "f4") for name, array in arrays.items()}}
    length = 18 + sum(13 + len(name) + 8 * array.ndim for name, array in everything.items())
    head, data = b"tensor_file\0" + struct.pack("<BBI", 1, 0, len(everything)), b""
    for name, array in everything.items():
        head += struct.pack("<H", len(name)) + name.encode() + struct.pack("<HBQ", array.ndim, TYPES[array.dtype],
                                                                          length + len(data))
        head += struct.pack(f"<{array.ndim}Q", *array.shape)
        data += array.tobytes()
    path.write_bytes(head + data)


def main():
    angles = numpy.radians([0, 12, 24, 36, 48, 60, 70, 78, 84, 88])
    write(FOLDER / "metal.bsdf", "alpha 0.4", fields(Facets(0.4, 0.4), numpy.array([0.0]), angles, (48, 25), 16))
    write(FOLDER / "brushed.bsdf", "alpha 0.2, 0.5",
          fields(Facets(0.2, 0.5), numpy.linspace(-numpy.pi, numpy.pi, 9), angles[[0, 2, 4, 5, 7, 9]], (24, 25), 10))


if __name__ == "__main__":
    main()
