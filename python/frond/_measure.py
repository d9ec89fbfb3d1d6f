"""Jobs whose results Python returns as arrays or objects: instruments, radiometry, conformance and fits."""

import inspect
import os
import re

from . import _frond
from ._jobs import FUNCTIONS, _table, no_text, run
from ._session import checked_session, checked_text, path_text


def material_text(material):
    """Returns a material as text, "leaf_solved,specimen=maize"; a list of its words is joined by commas. Raises TypeError."""
    if not isinstance(material, str) and not hasattr(material, "__iter__"):
        raise TypeError(f"material: {no_text(material)}")
    return checked_text(material if isinstance(material, str) else ",".join(str(part) for part in material), "material")


def _numbers(values):
    return [float(v) for v in (values if getattr(values, "ndim", 1) and hasattr(values, "__iter__") else [values])]


def _session_of(session):
    return checked_session(session)._session


def names(kind="material", *, session=None):
    """Returns {name: description} of the plug-ins of a kind ("material", "light", "integrator", ...)."""
    return checked_session(session).names(kind)


def _with_keywords_of(name):
    """Decorator: adds the keywords and the documentation of a job to a function that passes them on."""
    def decorate(function):
        job, kinds = FUNCTIONS[name], inspect.Parameter
        of_job = job.__signature__.parameters
        own = [p if p.default is not None or p.name not in of_job else
               p.replace(default=of_job[p.name].default, annotation=of_job[p.name].annotation)
               for p in inspect.signature(function).parameters.values() if p.kind is not kinds.VAR_KEYWORD]
        names = {p.name for p in own}
        more = [p.replace(kind=kinds.KEYWORD_ONLY) for p in of_job.values() if p.name not in names]
        function.__signature__ = inspect.Signature(sorted(own + more, key=lambda p: p.kind))
        function.__doc__ = "\n\n".join(filter(None, (inspect.getdoc(function), job.__doc__)))
        return function
    return decorate


def _of_table(name):
    """Returns a function that runs the job `name` and returns its first table."""
    job = FUNCTIONS[name]

    def call(*args, **kwargs):
        return job(*args, **kwargs).table

    call.__name__ = call.__qualname__ = name
    call.__signature__ = job.__signature__.replace(return_annotation="pandas.DataFrame | dict")
    call.__doc__, call.__module__ = job.__doc__ + "\n\nReturns the job's table.", "frond"
    return call


brf, compare = _of_table("brf"), _of_table("compare")


@_with_keywords_of("spectrophotometer")
def spectrophotometer(material, wavelengths, angles=8, **options):
    return FUNCTIONS["spectrophotometer"](material_text(material), wavelengths, angles, **options).table


@_with_keywords_of("flux")
def flux(scene, wavelengths=None, *, by=None, **options):
    """Returns the table of reflected, transmitted and absorbed shares of the incident light. In the rows of PAR photons
    "wavelength_nm" is NaN; they require wavelengths from 400 to 700 nm, at most 50 nm apart ("400:700:20").

    With by="instance" also a dictionary of arrays: "absorbed" and "absorbed_se" (standard error) `[instance][wavelength]`,
    "areas" `[instance]`, "wavelengths_nm", and if there is PAR, "par_umol_m2_s" and "par_umol_m2_s_se" `[instance]`: absorbed
    photons by leaf area."""
    result = FUNCTIONS["flux"](scene, wavelengths, by=by, **options)
    if by is None:
        return result.table
    columns = result.columns["instances"]
    bands = [name for name in columns if name.startswith("absorbed_") and not name.endswith("_se")]
    import numpy
    return result.tables["flux"], {
        "absorbed": numpy.stack([columns[name] for name in bands], axis=1),
        "absorbed_se": numpy.stack([columns[name + "_se"] for name in bands], axis=1),
        "areas": columns["area"], "wavelengths_nm": [float(name.removeprefix("absorbed_")) for name in bands],
        **{name: columns[name] for name in ("par_umol_m2_s", "par_umol_m2_s_se") if name in columns}}


@_with_keywords_of("goniophotometer")
def goniophotometer(material, wavelengths, angles=8, *, patches=(20, 40), **options):
    """Returns f over the whole sphere of directions as a dictionary of arrays: "f" and "f_se" (standard error) in 1/sr
    `[angle][wavelength][theta][phi]`; the centres "theta_o_deg", "phi_o_deg" and the "projected_solid_angle_sr" of the
    detector's patches `[theta][phi]`; "theta_i_deg" and "wavelength_nm". patches: (number in theta, number in phi)."""
    import numpy
    nm, theta = _numbers(wavelengths), _numbers(angles)
    counts = tuple(patches)
    found = run("goniophotometer", material=material_text(material), wavelengths=nm, angles=theta,
                patches="x".join(map(str, counts)), **options).columns["measurements"]
    arrays = {name: numpy.reshape(found[name], (len(theta), len(nm), *counts)) for name in
              ("f_per_sr", "f_se", "theta_deg", "phi_deg", "projected_solid_angle_sr")}
    result = {"theta_o_deg": arrays["theta_deg"][0, 0], "phi_o_deg": arrays["phi_deg"][0, 0],
              "projected_solid_angle_sr": arrays["projected_solid_angle_sr"][0, 0], "f": arrays["f_per_sr"], "f_se": arrays["f_se"]}
    return {"theta_i_deg": numpy.array(theta), "wavelength_nm": numpy.array(nm), **result}


@_with_keywords_of("conform")
def conform(material, *, session=None, **options):
    """Tests whether a BSDF obeys the laws of scattering. material: text, or an object of `frond.Bsdf`. Returns a dictionary:
    "laws" {law: verdict}, "findings" a table, "all_hold" True if no law is broken."""
    if not isinstance(material, (str, list, tuple)):
        name = f"{type(material).__name__}-{id(material):x}"
        if name not in names(session=session):
            register_material(name, material, session=session)
        material = name
    result = run("conform", material=material_text(material), session=session, **options)
    laws = result.columns["laws"]
    rows = [dict(zip(laws, row)) for row in zip(*laws.values())]
    return {**result.facts, "laws": {row["law"]: row for row in rows}, "findings": result.tables["findings"]}


def register_material(name, bsdf, *, session=None):
    """Registers an object of `frond.Bsdf` as a material that scenes of the session name by `name`. Its renders use one
    core, because each call needs Python's lock. Raises TypeError or ValueError."""
    from ._bsdf import Bsdf
    if not isinstance(bsdf, Bsdf):
        raise TypeError(f"bsdf: an object of a subclass of frond.Bsdf is needed, not {bsdf!r}")
    if not re.fullmatch(r"[\w.-]+", checked_text(name, "name")):
        raise ValueError(f"name: letters, digits, _ - and . are needed, not {name!r}")
    _frond.register_material(_session_of(session), name, (type(bsdf).__doc__ or name).strip().split("\n")[0], bsdf)


class Fit:
    """A leaf fitted to measured spectra; `fit` returns it."""

    def __init__(self, result):
        self.result = result
        leaf = result.columns["leaf"]
        self.leaf = dict(zip(leaf["name"], (float(v) for v in leaf["value"])))  #: {parameter: value}, as a material takes them

    rmse = property(lambda self: self.result.facts["rmse"], doc="Root mean square error of R and T together.")
    numbers = property(lambda self: self.result.tables["numbers"],
                       doc="Table of the fitted parameters: value, unit, relative_standard_error, identified.")
    contents = property(lambda self: self.result.tables["contents"],
                        doc="Table of contents per leaf area: chlorophyll (a and b), carotenoids and anthocyanins in ug/cm2, "
                            "water and drymatter in g/cm2; relative_standard_error.")
    misfits = property(lambda self: self.result.tables["misfits"],
                       doc="Table of the bands in which R or T is off by more than 0.01, with the lowest R that the fitted "
                           "structure reaches there with any absorption.")
    spectra = property(lambda self: self.result.tables["spectra"], doc="Table of the measured and the fitted spectra.")

    @property
    def parameters(self):
        """{parameter: value} for Mitsuba's `frond_leaf`."""
        return {"specimen": self.result.facts["specimen"], **self.leaf, "absorption": self.result.facts["absorption"],
                "sieve": self.result.facts["sieve"]}

    @property
    def material(self):
        """Parameters as text: ["specimen=soybean", "thickness=0.00017", ...]. Joined by commas behind "leaf_solved," they
        are a material for `swap` and the instruments."""
        parts = [f"{name}={self.result.facts[name]}" for name in ("specimen", "absorption")] + [f"{name}={value!r}" for name, value in self.leaf.items()]
        return parts + (["sieve=true"] if self.result.facts["sieve"] else [])

    def scene(self, material="leaf"):
        """Returns the `Material` line of a scene file."""
        of_leaf = self.result.facts["scene"]
        return of_leaf.replace(of_leaf.split('"')[1].join('""'), f'"{material}"', 1)

    def __str__(self):
        return self.result.text


def _csv(wavelengths, R, T):
    """Returns the columns as CSV text for the job `fit`."""
    count = len(wavelengths)
    columns = {"wavelength_nm": wavelengths, "R": R, "T": T}
    columns = {name: list(values) for name, values in columns.items() if values is not None}
    for name, values in columns.items():
        if len(values) != count:
            raise ValueError(f"fit: {count} wavelengths have {len(values)} {name}")
        if any(hasattr(v, "__len__") for v in values):
            raise ValueError(f"fit: {name} has more than one number for a wavelength")
    rows = zip(*columns.values())
    lines = [",".join(columns)] + [",".join("" if v is None or v != v else repr(float(v)) for v in row) for row in rows]
    return "\n".join(lines) + "\n"


@_with_keywords_of("fit")
def fit(wavelengths=None, R=None, T=None, *, path=None, all_leaves=False, sieve=None, **options):
    """Fits the parameters of a leaf to measured reflectance and transmittance. Returns a Fit, or with all_leaves=True the table
    of all leaves of the files: one row for each, with its parameters, their standard errors (columns ending in _se), contents
    per leaf area, and in "status" why it could not be fitted.

    wavelengths: in nm. R, T: shares of the incident light, in [0, 1]; one of them may be missing. path: a file, in place of
    these arrays; with all_leaves a list of files, too. sieve: True or False, absorption with sieve and detour effects; by default
    whichever fits better. fix: {"chlorophylla": 3.9}, or per leaf area {"chlorophyll": "40ug/cm2", "water": "0.012g/cm2"}.
    Raises ValueError or InputError."""
    if (path is None) == (wavelengths is None):
        raise ValueError("fit takes measurements, or the path of a file with them")
    if path is None:
        source = {"data": _csv(wavelengths, R, T)}
    else:
        files = path if isinstance(path, (list, tuple)) else [path]
        if len(files) != 1 and not all_leaves:
            raise ValueError(f"fit: path has {len(files)} files; all_leaves=True fits the leaves of several")
        source = {"file": [path_text(file) for file in files]}
    if isinstance(sieve, bool):
        sieve = "on" if sieve else "off"
    result = run("fit", **source, all_leaves=all_leaves, sieve=sieve, **options)
    return result.table if all_leaves else Fit(result)


def read_spectra(path, *, leaf="", angle=8.0):
    """Reads a file of measured spectra as the job `fit` does. Returns a table of wavelength_nm, theta_deg, R and T. leaf: the
    leaf to read if the file has several. angle: of incidence, in degrees, if the file does not say it. Raises InputError."""
    rows = _frond.read_spectra(path_text(path), leaf, angle)
    columns = list(zip(*rows)) or [(), (), (), ()]
    return _table(dict(zip(("wavelength_nm", "theta_deg", "R", "T"), map(list, columns))))
