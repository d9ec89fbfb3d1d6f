"""BSDFs one by one: those of materials, and prototypes in Python."""

import math

from . import _frond
from ._measure import _numbers, _session_of, material_text


class FlatBsdf:
    """The BSDF of a material on a flat specimen, at one to four wavelengths.

    Directions are arrays `[n][3]` of unit vectors that point away from the surface, z along its normal, on a leaf's
    adaxial side; `wo` goes toward where a path came from, `wi` toward where light comes from.
    """

    def __init__(self, material, wavelengths, *, session=None):
        self.wavelengths = _numbers(wavelengths)
        self._bsdf = _frond.FlatBsdf(_session_of(session), material_text(material), self.wavelengths)

    is_stochastic = property(lambda self: self._bsdf.is_stochastic, doc="f is a random estimate.")
    is_reciprocal = property(lambda self: self._bsdf.is_reciprocal, doc="The material claims f(a, b) = f(b, a).")

    @staticmethod
    def _directions(*directions):
        import numpy
        arrays = [numpy.atleast_2d(numpy.asarray(d, dtype=numpy.float32)) for d in directions]
        shape = numpy.broadcast_shapes(*(a.shape for a in arrays))
        return [numpy.ascontiguousarray(numpy.broadcast_to(a, shape)) for a in arrays]

    def f(self, wo, wi, *, seed=0):
        """In 1/sr, without cosine: `[n][wavelength]`."""
        return self._bsdf.f(*self._directions(wo, wi), seed)

    def pdf(self, wo, wi):
        """Density of `sample` in 1/sr: `[n]`."""
        return self._bsdf.pdf(*self._directions(wo, wi))

    def sample(self, wo, *, seed=0):
        """A direction for each wo: wi `[n][3]`, its weight f |cos| / pdf `[n][wavelength]`, pdf `[n]`, which is 0 where there
        is none."""
        return self._bsdf.sample(*self._directions(wo), seed)


def bsdf(material, wavelengths=(608, 551, 455), *, session=None):
    """The BSDF of a material as text, "leaf_solved,specimen=maize", at one to four wavelengths."""
    return FlatBsdf(material, wavelengths, session=session)


class LeafTable(dict):
    """The solved leaf as arrays by name (docs/leaf_file.md): "wavelength_nm", "depth", "index", "surface", and series such as
    "adaxial_reflected" `[column][mode][incident sine][leaving sine]`."""

    def save(self, path):
        """As a file for other programs: exports/cpp/frond_leaf.h reads it."""
        with open(path, "wb") as file:
            file.write(self["bytes"])


def leaf_table(material, wavelengths, *, tolerance=5e-4, depths=None, session=None):
    """All that `leaf_solved` looks up. material: text, "leaf_solved,specimen=maize,incident=reciprocal". depths: (least,
    most) optical depth of the mesophyll that the table is to reach over, where chemistry varies."""
    return LeafTable(_frond.leaf_table(_session_of(session), material_text(material), sorted(_numbers(wavelengths)), tolerance, depths))


class Bsdf:
    """A BSDF in Python, for prototypes: `f` is what it needs, and with its own `sample` and `pdf` it has less noise.
    `frond.conform` holds it to the laws, `frond.register_material` makes it a material.

    Directions are tuples, unit, away from the surface, z along its normal; nm are the wavelengths of a path, at most
    four, and values are one number for all of them or one for each.
    """

    flags = ("reflection", "transmission", "diffuse")  #: what it does, of those and "glossy"
    reciprocal = False  #: claims f(a, b) = f(b, a)

    def f(self, wo, wi, nm):
        """In 1/sr, without cosine."""
        raise NotImplementedError

    def _share_of_side(self, wo, wi):
        """Of `sample`, that goes to the side of wi."""
        sides = [side for side in ("reflection", "transmission") if side in self.flags]
        side = "reflection" if wo[2] * wi[2] > 0 else "transmission"
        return (side in sides) / len(sides)

    def sample(self, wo, uc, u, nm):
        """(wi, f, pdf), or None; from numbers uc and u[0], u[1] in [0, 1). By default cosines on either side."""
        both = "reflection" in self.flags and "transmission" in self.flags
        reflects = uc < 0.5 if both else "reflection" in self.flags
        radius, phi = math.sqrt(u[0]), 2 * math.pi * u[1]
        z = math.sqrt(max(0.0, 1 - u[0]))
        sign = math.copysign(1.0, wo[2]) * (1 if reflects else -1)
        wi = (radius * math.cos(phi), radius * math.sin(phi), sign * z)
        pdf = self.pdf(wo, wi, nm)
        return (wi, self.f(wo, wi, nm), pdf) if pdf > 0 else None

    def pdf(self, wo, wi, nm):
        """Density of `sample`, 1/sr."""
        if wo[2] == 0:
            return 0.0
        return self._share_of_side(wo, wi) * abs(wi[2]) / math.pi
