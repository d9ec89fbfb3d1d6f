"""BSDFs of materials, leaf tables, and BSDFs written in Python."""

import math

from . import _frond
from ._records import no_text
from ._session import Scene, checked_session
from ._values import array_of, checked_text, is_array, number, path_text, reals, scalar, texts, whole


def material_text(material):
    """Returns a material as text, "leaf_solved,specimen=maize"; a list of its words is joined by commas. Raises TypeError."""
    material = scalar(material)
    if isinstance(material, str):
        return checked_text(material, "material")
    if isinstance(material, (bytes, Scene)) or not hasattr(material, "__iter__") or hasattr(material, "items") and not is_array(material):
        raise TypeError(f"material: {no_text(material)}")
    return ",".join(checked_text(scalar(part), "material") for part in texts(material, "material"))


def bands_of(values):
    """Returns wavelengths in nm as floats. Raises TypeError or ValueError."""
    return reals(values, "wavelengths", "nm")


def _seed_of(seed):
    found = whole(seed, "seed")
    if found >= 1 << 64:
        raise ValueError(f"seed: a whole number from 0 to 2^64 - 1 is needed, not {found}")
    return found


class FlatBsdf:
    """The BSDF of a material on a flat surface, at any number of wavelengths in nm; `pdf` and `sample` at one to four.

    Directions are arrays `[n][3]` of unit vectors that point away from the surface. The z axis is the surface normal, on
    the adaxial side of a leaf. `wo` points back along the camera path, `wi` toward the light. Arrays are broadcast.
    """

    def __init__(self, material, wavelengths, *, session=None):
        self.wavelengths = bands_of(wavelengths)
        # A path has up to four wavelengths.
        groups = [self.wavelengths[i:i + 4] for i in range(0, max(len(self.wavelengths), 1), 4)]
        self._bsdfs = [_frond.FlatBsdf(checked_session(session)._session, material_text(material), group) for group in groups]

    is_stochastic = property(lambda self: self._bsdfs[0].is_stochastic, doc="True if `f` is a random estimate.")
    is_reciprocal = property(lambda self: self._bsdfs[0].is_reciprocal, doc="True if the material claims f(a, b) = f(b, a).")

    @staticmethod
    def _directions(**directions):
        import numpy
        arrays = {name: numpy.atleast_2d(array_of(d, name, "float32")) for name, d in directions.items()}
        for name, array in arrays.items():
            if array.ndim != 2 or array.shape[1] != 3:
                raise ValueError(f"{name}: directions are an array [n][3], not of shape {array.shape}")
        shape = numpy.broadcast_shapes(*(a.shape for a in arrays.values()))
        return [numpy.ascontiguousarray(numpy.broadcast_to(a, shape)) for a in arrays.values()]

    def _of_one_path(self):
        if len(self._bsdfs) > 1:
            raise ValueError(f"pdf and sample are those of a path, of one to four wavelengths: there are {len(self.wavelengths)}")
        return self._bsdfs[0]

    def f(self, wo, wi, *, seed=0):
        """Returns the BSDF value in 1/sr, without the cosine: float32 `[n][wavelength]`."""
        import numpy
        pairs, seed = self._directions(wo=wo, wi=wi), _seed_of(seed)
        return numpy.concatenate([bsdf.f(*pairs, seed) for bsdf in self._bsdfs], axis=1)

    def pdf(self, wo, wi):
        """Returns the probability density of `sample` in 1/sr: float32 `[n]`. Raises ValueError for more than four
        wavelengths."""
        return self._of_one_path().pdf(*self._directions(wo=wo, wi=wi))

    def sample(self, wo, *, seed=0):
        """Samples a direction for each wo. Returns (wi `[n][3]`, weights f |cos| / pdf `[n][wavelength]`, pdf `[n]` in 1/sr);
        pdf is 0 where nothing is scattered. Raises ValueError for more than four wavelengths."""
        return self._of_one_path().sample(*self._directions(wo=wo), _seed_of(seed))


def bsdf(material, wavelengths=(608, 551, 455), *, session=None):
    """Returns the FlatBsdf of a material, as text ("leaf_solved,specimen=maize"), at wavelengths in nm. Raises InputError."""
    return FlatBsdf(material, wavelengths, session=session)


class LeafTable(dict):
    """The mode table of a `leaf_solved` as a dictionary of arrays (docs/file_formats.md): "wavelength_nm", "depth", "index",
    "surface", and Fourier modes such as "adaxial_reflected" `[column][mode][incident sine][leaving sine]`."""

    def save(self, path):
        """Writes a .leaf file, which exports/cpp/frond_leaf.h reads. If it fails, an old file stays. Raises InputError."""
        _frond.replace_file(path_text(path), self["bytes"])


def leaf_table(material, wavelengths, *, tolerance=5e-4, depths=None, session=None):
    """Returns the LeafTable of a `leaf_solved`. material: text, "leaf_solved,specimen=maize,incident=reciprocal". wavelengths:
    in nm. tolerance: largest error of pi f. depths: (least, most) optical depth of the mesophyll, for leaves whose chemistry
    varies. Raises InputError."""
    if depths is not None:
        depths = tuple(reals(depths, "depths"))
        if len(depths) != 2:
            raise ValueError(f"depths: (least, most) is needed, {len(depths)} numbers are given")
    return LeafTable(_frond.leaf_table(checked_session(session)._session, material_text(material), sorted(bands_of(wavelengths)),
                                       float(number(tolerance, "tolerance")), depths))


class Bsdf:
    """Base class of BSDFs written in Python. A subclass defines `f`; its own `sample` and `pdf` reduce noise.
    `frond.conform` tests it, `frond.register_material` makes it a material.

    Directions are tuples (x, y, z), unit vectors that point away from the surface, z along its normal. nm: the one to four
    wavelengths of a path. Values are one number for all wavelengths, or one for each.
    """

    flags = ("reflection", "transmission", "diffuse")  #: of "reflection", "transmission", "diffuse", "glossy"
    reciprocal = False  #: claims f(a, b) = f(b, a)

    def f(self, wo, wi, nm):
        """Returns the BSDF value in 1/sr, without the cosine."""
        raise NotImplementedError

    def _share_of_side(self, wo, wi):
        """Probability that `sample` chooses the side of wi."""
        sides = [side for side in ("reflection", "transmission") if side in self.flags]
        side = "reflection" if wo[2] * wi[2] > 0 else "transmission"
        return (side in sides) / len(sides)

    def sample(self, wo, uc, u, nm):
        """Samples a direction with the uniform numbers uc, u[0], u[1] in [0, 1). Returns (wi, f, pdf) or None. By default the
        density is proportional to the cosine, on each side that `flags` names."""
        both = "reflection" in self.flags and "transmission" in self.flags
        reflects = uc < 0.5 if both else "reflection" in self.flags
        radius, phi = math.sqrt(u[0]), 2 * math.pi * u[1]
        z = math.sqrt(max(0.0, 1 - u[0]))
        sign = math.copysign(1.0, wo[2]) * (1 if reflects else -1)
        wi = (radius * math.cos(phi), radius * math.sin(phi), sign * z)
        pdf = self.pdf(wo, wi, nm)
        return (wi, self.f(wo, wi, nm), pdf) if pdf > 0 else None

    def pdf(self, wo, wi, nm):
        """Returns the probability density of `sample` in 1/sr."""
        if wo[2] == 0:
            return 0.0
        return self._share_of_side(wo, wi) * abs(wi[2]) / math.pi
