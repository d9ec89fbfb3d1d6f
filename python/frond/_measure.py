"""Jobs whose results have a form of their own in Python: fits, distributions of f, verdicts of laws; and measured spectra."""

import inspect
import os

from . import _frond
from ._jobs import FUNCTIONS, _table, run
from ._session import default_session


def material_text(material):
    """"leaf_solved,specimen=maize"; also from a list of its parts."""
    return material if isinstance(material, str) else ",".join(str(part) for part in material)


def _numbers(values):
    return [float(v) for v in (values if hasattr(values, "__iter__") else [values])]


def _session_of(session):
    return (session or default_session())._session


def names(kind="material", *, session=None):
    """What scenes can name of a kind ("material", "integrator", "light", ...): {name: one line}."""
    return (session or default_session()).names(kind)


def _with_keywords_of(name):
    """Adds the job's keywords to the signature of a function that passes them on, and its documentation."""
    def decorate(function):
        job, kinds = FUNCTIONS[name], inspect.Parameter
        own = [p for p in inspect.signature(function).parameters.values() if p.kind is not kinds.VAR_KEYWORD]
        names = {p.name for p in own}
        more = [p.replace(kind=kinds.KEYWORD_ONLY) for p in job.__signature__.parameters.values() if p.name not in names]
        function.__signature__ = inspect.Signature(sorted(own + more, key=lambda p: p.kind))
        function.__doc__ = "\n\n".join(filter(None, (inspect.getdoc(function), job.__doc__)))
        return function
    return decorate


def _of_table(name):
    """The job `name` with its first table as result."""
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
def flux(scene, wavelengths=None, *, by_instance=False, **options):
    """The job's table of shares of the light. by_instance: with it a dictionary of what each instance absorbs: arrays
    "absorbed", "absorbed_se" `[instance][wavelength]`, "areas" and "wavelengths_nm"."""
    result = FUNCTIONS["flux"](scene, wavelengths, by="instance" if by_instance else None, **options)
    if not by_instance:
        return result.table
    columns = result.columns["instances"]
    bands = [name for name in columns if name.startswith("absorbed_") and not name.endswith("_se")]
    import numpy
    return result.tables["flux"], {
        "absorbed": numpy.stack([columns[name] for name in bands], axis=1),
        "absorbed_se": numpy.stack([columns[name + "_se"] for name in bands], axis=1),
        "areas": columns["area"], "wavelengths_nm": [float(name.removeprefix("absorbed_")) for name in bands]}


@_with_keywords_of("goniophotometer")
def goniophotometer(material, wavelengths, angles=8, *, patches=(20, 40), **options):
    """f in 1/sr over the whole sphere: a dictionary with arrays "f" and "f_se" `[angle][wavelength][theta][phi]`, the
    patches' centres "theta_o_deg" and "phi_o_deg" and "projected_solid_angle_sr" `[theta][phi]`, "theta_i_deg" and
    "wavelength_nm"."""
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
    """Whether a BSDF obeys the laws of scattering: a material as text, or an object of `frond.Bsdf`. A dictionary:
    `["laws"]` has the verdicts by law, `["findings"]` a table, `all_hold` whether none is broken."""
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
    """Makes an object of `frond.Bsdf` a material that scenes of the session can name. Renders of it use one core: each
    call goes to Python."""
    _frond.register_material(_session_of(session), name, (type(bsdf).__doc__ or name).strip().split("\n")[0], bsdf)


class Fit:
    """A leaf that was fitted to measured spectra."""

    def __init__(self, result):
        self.result = result
        leaf = result.columns["leaf"]
        self.leaf = dict(zip(leaf["name"], (float(v) for v in leaf["value"])))  #: its parameters, as a material takes them

    rmse = property(lambda self: self.result.facts["rmse"], doc="Of R and T together.")
    numbers = property(lambda self: self.result.tables["numbers"],
                       doc="A table of what was fitted: value, relative_standard_error, identified.")
    spectra = property(lambda self: self.result.tables["spectra"], doc="Measured and fitted spectra: a table.")

    @property
    def parameters(self):
        """The leaf's parameters as a dictionary, for Mitsuba's frond_leaf."""
        return {"specimen": self.result.facts["specimen"], **self.leaf, "sieve": self.result.facts["sieve"]}

    @property
    def material(self):
        """The leaf's parts of a material in text: ["specimen=soybean", "thickness=0.00017", ...]; `swap` and the
        instruments take "leaf_solved," and these with commas between."""
        parts = [f"specimen={self.result.facts['specimen']}"] + [f"{name}={value!r}" for name, value in self.leaf.items()]
        return parts + (["sieve=true"] if self.result.facts["sieve"] else [])

    def scene(self, material="leaf"):
        """A Material line of a scene file."""
        of_leaf = self.result.facts["scene"]
        return of_leaf.replace(of_leaf.split('"')[1].join('""'), f'"{material}"', 1)

    def __str__(self):
        return self.result.text


def _csv(wavelengths, R, T):
    """Columns as the CSV text that the job reads."""
    count = len(wavelengths)
    columns = {"wavelength_nm": wavelengths, "R": R, "T": T}
    columns = {name: list(values) for name, values in columns.items() if values is not None}
    for name, values in columns.items():
        if len(values) != count:
            raise ValueError(f"fit: {count} wavelengths have {len(values)} {name}")
    rows = zip(*columns.values())
    lines = [",".join(columns)] + [",".join("" if v is None or v != v else repr(float(v)) for v in row) for row in rows]
    return "\n".join(lines) + "\n"


@_with_keywords_of("fit")
def fit(wavelengths=None, R=None, T=None, *, path=None, sieve=None, **options):
    """The leaf whose solved BSDF comes nearest to measured reflectance and transmittance: arrays of `wavelengths` (nm) and
    `R`, `T` (shares of the light; either may be missing), or a file by `path`. sieve: also True or False. fix: {"chlorophylla": 3.9}."""
    if (path is None) == (wavelengths is None):
        raise ValueError("fit takes measurements, or the path of a file with them")
    source = {"file": os.fspath(path)} if path is not None else {"data": _csv(wavelengths, R, T)}
    if isinstance(sieve, bool):
        sieve = "on" if sieve else "off"
    return Fit(run("fit", **source, sieve=sieve, **options))


def read_spectra(path, *, leaf="", angle=8.0):
    """Measured spectra as the job fit reads them: a table of wavelength_nm, theta_deg, R and T."""
    rows = _frond.read_spectra(os.fspath(path), leaf, angle)
    columns = list(zip(*rows)) or [(), (), (), ()]
    return _table(dict(zip(("wavelength_nm", "theta_deg", "R", "T"), map(list, columns))))
