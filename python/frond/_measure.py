"""Instruments, radiometers, fits and comparisons: functions that return tables.

A table is a pandas.DataFrame where pandas is installed, else a dictionary of NumPy arrays by column.
"""

import json
import os

from . import _frond
from ._session import _show, _swaps, _text_of_wavelengths, default_session


def _table(rows, columns=None):
    names = list(columns or (rows[0] if rows else ()))
    data = {name: [row.get(name) for row in rows] for name in names}
    try:
        import pandas
    except ImportError:
        import numpy
        return {name: numpy.array(values) for name, values in data.items()}
    return pandas.DataFrame(data)


def _words(material):
    """"leaf_solved specimen=maize", or a list of such words."""
    return material.split() if isinstance(material, str) else [str(word) for word in material]


def _numbers(values):
    return [float(v) for v in (values if hasattr(values, "__iter__") else [values])]


def _session_of(session):
    return (session or default_session())._session


def names(kind="material", *, session=None):
    """What scenes can name of a kind ("material", "integrator", "light", ...): {name: what it is}."""
    return (session or default_session()).names(kind)


def spectrophotometer(material, wavelengths, angles=8, *, rays=1_000_000, standard_error=0.0, rendered=False, seed=0,
                      session=None):
    """Reflectance R, transmittance T, absorptance A of a material, and where it tells them apart Rs and Rd of R, each
    with its standard error: a table, one row for each wavelength and angle.

    material: as on the command line: "abm specimen=soybean". angles: of incidence, above 90 on the back. standard_error:
    stop once those of R, T and A are no larger (`rays` then are the most). rendered: as a renderer shows it.
    """
    nm, theta = _numbers(wavelengths), _numbers(angles)
    bench = _frond.Bench(_session_of(session), _words(material), nm)
    return _table([bench.shares(w, angle, int(rays), standard_error, seed, rendered)
                   for angle in theta for w in range(len(nm))])


def goniophotometer(material, wavelengths, angles=8, *, patches=(20, 40), rays=1_000_000, integrate=False,
                    rendered=False, seed=0, session=None):
    """f in 1/sr over the whole sphere: a dictionary with arrays "f" and "f_se" `[angle][wavelength][theta][phi]`, the
    patches' middles "theta_o_deg" and "phi_o_deg" and "projected_solid_angle_sr" `[theta][phi]`, "theta_i_deg" and
    "wavelength_nm". integrate: without noise, where f is no random estimate.
    """
    import numpy
    nm, theta = _numbers(wavelengths), _numbers(angles)
    bench = _frond.Bench(_session_of(session), _words(material), nm)
    found = [[bench.patches(w, angle, int(rays), tuple(patches), integrate, seed, rendered) for w in range(len(nm))]
             for angle in theta]
    result = {name: found[0][0][name] for name in ("theta_o_deg", "phi_o_deg", "projected_solid_angle_sr")}
    for name in ("f", "f_se"):
        result[name] = numpy.array([[reading[name] for reading in row] for row in found])
    return {"theta_i_deg": numpy.array(theta), "wavelength_nm": numpy.array(nm), **result}


def conform(material, *, wavelengths=(608, 551, 455), angles=(0, 30, 60, 80, 89), samples=20_000, lossless=False,
            reciprocal=False, false_alarm_rate=1e-6, seed=1, session=None):
    """Whether a BSDF obeys the laws of scattering: a material by its words, or an object of `frond.Bsdf`. What
    `frond conform --json` finds, as a dictionary; `["laws"]` has the verdicts, `all_hold` is their sum.
    """
    asked = [[float(a) for a in angles], int(samples), seed, lossless, reciprocal, false_alarm_rate]
    if isinstance(material, (str, list, tuple)):
        text = _frond.conform(_session_of(session), _words(material), _numbers(wavelengths), *asked)
    else:
        text = _frond.conform_python(material, type(material).__name__, _numbers(wavelengths), *asked)
    report = json.loads(text)
    report["all_hold"] = all(law["verdict"] != "broken" for law in report["laws"].values())
    return report


def register_material(name, bsdf, *, session=None):
    """Makes an object of `frond.Bsdf` a material that scenes of the session can name. Renders of it use one core: each
    call goes to Python."""
    _frond.register_material(_session_of(session), name, (type(bsdf).__doc__ or name).strip().split("\n")[0], bsdf)


def _measurement(wavelengths, swap, target, period, seed, paths, rms):
    return _frond.Measurement(_text_of_wavelengths(wavelengths), _swaps(swap), target, period, seed, int(paths), rms or 0.0)


def _description(scene, session):
    return _session_of(session).read(os.fspath(scene))


def brf(scene, wavelengths=(450, 550, 670, 800), *, zenith=range(-75, 76, 5), azimuth=(0,), swap=None, target=None,
        period=None, paths=65536, rms=None, seed=None, progress=None, session=None):
    """Bidirectional reflectance factor of a scene from far away: a table of zenith_deg, azimuth_deg, wavelength_nm, brf
    and its standard error brf_se.

    Leaves are reciprocal where the scene does not say what is incident. target: (x0, x1, y0, y1, z); period: (x, y) after
    which the scene is there again. rms: until the relative standard errors are below it.
    """
    views = [(float(z), float(a)) for a in _numbers(azimuth) for z in _numbers(zenith)]
    measurement = _measurement(wavelengths, swap, target, period, seed, paths, rms)
    found = _frond.brf(_session_of(session), _description(scene, session), views, measurement, _show(progress))
    return _table([{"zenith_deg": view[0], "azimuth_deg": view[1], "wavelength_nm": nm, "brf": found["brf"][v, w],
                    "brf_se": found["brf_se"][v, w]}
                   for v, view in enumerate(views) for w, nm in enumerate(found["wavelengths_nm"])])


def flux(scene, wavelengths=(450, 550, 670, 800), *, swap=None, target=None, period=None, paths=65536, rms=None,
         by_instance=False, seed=None, progress=None, session=None):
    """Where the light goes that falls on a scene: a table of quantity, material, wavelength_nm, share and its standard
    error share_se. by_instance: with it a dictionary of what each copy absorbs: "absorbed", "absorbed_se"
    `[copy][wavelength]`, "areas" and "wavelengths_nm".
    """
    measurement = _measurement(wavelengths, swap, target, period, seed, paths, rms)
    found = _frond.flux(_session_of(session), _description(scene, session), measurement, by_instance, _show(progress))
    table = _table(found.pop("rows"))
    return (table, found) if by_instance else table


def compare(scene, models=("abm", "leaf_simplified", "leaf_solved", "leaf_lambert"), *, reference="abm,mode=weighted",
            wavelengths=None, size=128, samples=32, reference_samples=128, progress=None, session=None):
    """What leaf models cost in a scene and how wrong they are: a table, one row for each model, number of samples and
    region ("all" pixels, or those that see a "leaf"), with cpu_seconds and RMSE, its noise and its bias.
    """
    rows = _frond.compare(_session_of(session), os.fspath(scene), list(models), reference, _text_of_wavelengths(wavelengths),
                          size, samples, reference_samples, _show(progress))
    return _table(list(rows))


def read_spectra(path, *, leaf="", angle=8.0):
    """Measured spectra as `frond fit` reads them: a table of wavelength_nm, theta_deg, R and T."""
    rows = _frond.read_spectra(os.fspath(path), leaf, angle)
    return _table([dict(zip(("wavelength_nm", "theta_deg", "R", "T"), row)) for row in rows],
                  ("wavelength_nm", "theta_deg", "R", "T"))


class Fit:
    """A leaf that was fitted to measurements."""

    def __init__(self, fit):
        self._fit = fit
        self.report = json.loads(fit.json())  #: everything, as `frond fit --json` writes it

    rmse = property(lambda self: self.report["rmse"], doc="Of R and T together.")
    leaf = property(lambda self: self.report["leaf"], doc="The leaf's numbers, as a material takes them.")

    @property
    def parameters(self):
        """The leaf's parameters as a dictionary, for Mitsuba's frond_leaf."""
        return {"specimen": self.report["specimen"], **self.leaf, "sieve": self.report["sieve"]}

    @property
    def numbers(self):
        """A table of what was fitted: value, relative_standard_error, identified."""
        return _table(self.report["numbers"])

    @property
    def material(self):
        """The leaf as words: for instruments, `bsdf`, and with commas between them for `swap`."""
        words = [f"specimen={self.report['specimen']}"] + [f"{name}={value!r}" for name, value in self.leaf.items()]
        return words + (["sieve=true"] if self.report["sieve"] else [])

    def scene(self, material="leaf"):
        """A Material line of a scene file."""
        return self._fit.scene(material)

    def __str__(self):
        return self._fit.text()


def fit(wavelengths=None, R=None, T=None, *, path=None, leaf="", angle=8.0, structure="", sieve=None, like="", fix=None,
        session=None):
    """The leaf whose solved walk comes nearest to measured reflectance and transmittance: arrays of `wavelengths` (nm) and
    `R`, `T` (shares; either may be missing), or a file by `path`. `fix`: numbers that are known, {"chlorophylla": 3.9};
    `like`: a specimen whose numbers are expected.
    """
    if (path is None) == (wavelengths is None):
        raise ValueError("fit takes measurements, or the path of a file with them")
    if path is not None:
        rows, source = _frond.read_spectra(os.fspath(path), leaf, angle), os.path.basename(os.fspath(path))
    else:
        count = len(wavelengths)
        columns = [[None] * count if c is None else [None if v != v else float(v) for v in c] for c in (R, T)]
        if any(len(c) != count for c in columns):
            raise ValueError(f"fit: {count} wavelengths have {len(columns[0])} R and {len(columns[1])} T")
        rows, source = list(zip(_numbers(wavelengths), [float(angle)] * count, *columns)), "arrays"
    return Fit(_frond.fit(_session_of(session), rows, structure, sieve, like, list((fix or {}).items()), source))
