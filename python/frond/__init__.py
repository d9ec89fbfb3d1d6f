"""frond: a spectral renderer for plant leaves, from Python.

    import frond
    scene = frond.load("scene.pbrt", swap={"*": "leaf_solved"}, wavelengths="smpte")
    picture = scene.render(samples=64)
    picture["G"]                                    # NumPy, rows from the top

    frond.spectrophotometer("leaf_solved", wavelengths=[450, 551, 680])
    frond.fit(path="leaf.csv").material
    frond.brf("canopy.pbrt", wavelengths=[670, 800])
    frond.conform("leaf_solved specimen=maize")

What is wrong with the input is an `InputError` with file, line and column; messages go to the logger "frond" of the
module `logging`. Angles are in degrees, wavelengths in nm. Nothing is imported before it is needed: NumPy comes with the
first array, pandas with the first table, where it is installed.
"""

from ._errors import InputError
from ._frond import version as __version__
from ._session import Picture, Scene, Session, default_session, load, loads, read_image
from ._measure import (brf, compare, conform, fit, flux, goniophotometer, names, read_spectra, register_material,
                       spectrophotometer)
from ._bsdf import Bsdf, FlatBsdf, LeafTable, bsdf, leaf_table

__all__ = [
    "Bsdf", "FlatBsdf", "InputError", "LeafTable", "Picture", "Scene", "Session", "__version__", "brf", "bsdf", "compare", "conform",
    "default_session", "fit", "flux", "goniophotometer", "leaf_table", "load", "loads", "names", "read_image", "read_spectra", "register_material",
    "spectrophotometer",
]
