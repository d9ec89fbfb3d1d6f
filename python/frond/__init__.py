"""frond: a spectral renderer for plant leaves, from Python.

    import frond
    scene = frond.load("scene.pbrt", swap={"*": "leaf_solved"}, wavelengths="smpte")
    image = scene.render(samples=64)
    image["G"]                                    # NumPy, rows from the top

    frond.spectrophotometer("leaf_solved", wavelengths=[450, 551, 680])
    frond.fit(path="leaf.csv").material
    frond.brf("canopy.pbrt", wavelengths=[670, 800])
    frond.conform("leaf_solved,specimen=maize")
    frond.run("flux", scene="canopy.pbrt").table    # any command of frond, by its name

Every command of frond is a function of the same name with the same parameters. Bad input is an `InputError` with file, line
and column; messages go to the logger "frond" of the module `logging`. Angles are in degrees, wavelengths in nm. NumPy is
imported with the first array, pandas, where it is installed, with the first table.
"""

import pathlib as _pathlib
import warnings as _warnings

from . import _jobs
from ._errors import InputError
from ._frond import version as __version__
from ._session import Image, Scene, Session, default_session, load, loads, read_image, write_image
from ._jobs import Result, run
from ._measure import (Fit, bench, brf, compare, conform, fit, flux, goniophotometer, names, read_spectra, register_material,
                       spectrophotometer)
from ._bsdf import Bsdf, FlatBsdf, LeafTable, bsdf, leaf_table

Picture = Image  # the older name

# A file of the other project may lie in place of this one, or disappear with it.
if next(_pathlib.Path(__file__).parents[1].glob("frond-*.dist-info"), None):
    _warnings.warn("another project of the name frond is installed here too, with a module of the same name: "
                   "pip uninstall frond frond-render, then install frond-render again", stacklevel=2)

globals().update({name: function for name, function in _jobs.FUNCTIONS.items() if name not in globals()})

__all__ = sorted({name for name in _jobs.FUNCTIONS if name != "list"} | {
    "Bsdf", "Fit", "FlatBsdf", "InputError", "Image", "LeafTable", "Picture", "Result", "Scene", "Session", "__version__", "bsdf",
    "default_session", "leaf_table", "load", "loads", "names", "read_image", "read_spectra", "register_material", "run",
    "write_image"})
