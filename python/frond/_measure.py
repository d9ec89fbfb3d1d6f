"""Jobs whose results Python returns as arrays or objects: instruments, radiometry, conformance and fits."""

import inspect
import re

from . import _frond
from ._bsdf import Bsdf, bands_of, material_text
from ._jobs import FUNCTIONS, _table, run
from ._records import JOBS, by_alias
from ._session import checked_session
from ._values import checked_text, is_array, named, number, path_text, reals, scalar, table_file, table_text, texts, whole


def _registered(bsdf, session):
    """Returns the name of an object of `frond.Bsdf` as a material of the session; registers it at the first use. The name is that
    of its class, so that equal runs have equal seeds."""
    session = checked_session(session)
    found = session._bsdfs.get(id(bsdf))
    if found is None:
        of_class, taken, i = re.sub(r"[^\w.-]", "_", type(bsdf).__name__), names(session=session), 1
        while (found := of_class if i == 1 else f"{of_class}-{i}") in taken:
            i += 1
        register_material(found, bsdf, session=session)
    return found


def _of_bsdf(material, session):
    """Returns a material as text; an object of `frond.Bsdf` is registered."""
    if isinstance(material, type) and issubclass(material, Bsdf):
        raise TypeError(f"material: {material.__name__} is a class; give an object of it, as in {material.__name__}()")
    return _registered(material, session) if isinstance(material, Bsdf) else material_text(material)


def names(kind="material", *, session=None):
    """Returns {name: description} of the plug-ins of a kind ("material", "light", "integrator", ...)."""
    return checked_session(session).names(kind)


def _with_keywords_of(name, returns=inspect.Signature.empty):
    """Decorator: adds the keywords and the documentation of a job to a function that passes them on."""
    def decorate(function):
        job, kinds = FUNCTIONS[name], inspect.Parameter
        of_job = job.__signature__.parameters
        own = [p if p.default is not None or p.name not in of_job else
               p.replace(default=of_job[p.name].default, annotation=of_job[p.name].annotation)
               for p in inspect.signature(function).parameters.values() if p.kind is not kinds.VAR_KEYWORD]
        names = {p.name for p in own}
        more = [p.replace(kind=kinds.KEYWORD_ONLY) for p in of_job.values() if p.name not in names]
        signature = inspect.Signature(sorted(own + more, key=lambda p: p.kind), return_annotation=returns)

        def call(*args, **kwargs):
            bound = signature.bind(*args, **by_alias(JOBS[name]["params"], kwargs))
            for given, value in bound.arguments.items():
                default = signature.parameters[given].default
                if value is None and default is not inspect.Parameter.empty:  # None is not given
                    bound.arguments[given] = default
            return function(*bound.args, **bound.kwargs)

        call.__name__, call.__qualname__, call.__module__ = function.__name__, function.__qualname__, "frond"
        call.__signature__ = signature
        call.__doc__ = "\n\n".join(filter(None, (inspect.getdoc(function), job.__doc__)))
        return call
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
def spectrophotometer(material, wavelengths=None, angles=8, **options):
    """Returns the table of measurements. With fluorescence=True it is the excitation-emission matrix, without wavelengths."""
    return FUNCTIONS["spectrophotometer"](material_text(material), wavelengths, angles, **options).table


@_with_keywords_of("flux")
def flux(scene, wavelengths=None, *, by=None, times=None, **options):
    """Returns the table of reflected, transmitted and absorbed shares of the incident light. In the rows of PAR photons
    "wavelength_nm" is NaN; they require wavelengths from 400 to 700 nm, at most 50 nm apart ("400:700:20").

    Bands with responses have names, in the column "band".

    With by="instance" also the table of the instances, one row each: "instance", "area", for PAR "par_umol_m2_s" (absorbed photons
    by leaf area), and for each wavelength or band "absorbed_550", "absorbed_nir", ... (shares of the incident light), each with a
    column "_se" (standard error). With by="mesh", "part", "triangle" or "material" its rows are these.

    With fluorescence=True the first table is the balance of photons, and of the instances "excited_umol_m2_s", "emitted_740" and
    "left_740" (nmol/(m2 s nm) by leaf area).

    With bands="par,nir,shortwave" a dictionary of tables: "energy", one row for each quantity and band, with W/m2 and umol/(m2 s);
    "leaves", sunlit and shaded leaf area with its light, if the scene has leaves; "surfaces", the light on those of each material; with
    by also "instances", "meshes", "parts",
    "triangles" or "materials".

    times: a table of times as a file, a data frame with a column or an index of times, or a dictionary of columns. The tables then
    have a column "time", and their rows of PAR "par_umol_m2_s"; the sums of each day are a table of
    run("flux", ...).tables["flux_days"]. With part= nothing is returned."""
    with table_file(times, "times") as path:
        tables = FUNCTIONS["flux"](scene, wavelengths, by=by, times=path, **options).tables
    if options.get("bands") is not None or not tables:
        return tables or None
    first = "fluorescence" if options.get("fluorescence") else "flux"
    return tables[first] if by is None else (tables[first], next(tables[name] for name in tables if name != first))


@_with_keywords_of("goniophotometer")
def goniophotometer(material, wavelengths=None, angles=8, *, patches=(20, 40), **options):
    """With fluorescence=True returns the table of fluorescence by direction, without wavelengths.

    Otherwise returns f over the whole sphere of directions as a dictionary of arrays: "f" and "f_se" (standard error) in 1/sr
    `[angle][wavelength][theta][phi]`; the centres "theta_o_deg", "phi_o_deg" and the "projected_solid_angle_sr" of the
    detector's patches `[theta][phi]`; "theta_i_deg" and "wavelength_nm", for bands with names also "band". patches: (number in
    theta, number in phi). With with_, "f" and "f_se" have the materials along a first axis."""
    if wavelengths is None or options.get("fluorescence"):
        return FUNCTIONS["goniophotometer"](material_text(material), wavelengths, angles, patches=patches, **options).table
    import numpy
    nm = wavelengths if isinstance(wavelengths, str) else bands_of(wavelengths)
    theta = reals(angles, "angles", "degrees")
    if isinstance(patches, str):
        patches = [int(v) if v.isdigit() else v for v in patches.replace(",", "x").split("x")]
    counts = tuple(whole(v, "patches") for v in texts(patches, "patches"))
    found = run("goniophotometer", material=material_text(material), wavelengths=nm, angles=theta,
                patches="x".join(map(str, counts)), **options).columns["measurements"]
    labels = [name for name in ("wavelength_nm", "band") if name in found]
    lights = len(set(zip(*(found[name] for name in labels)))) if isinstance(nm, str) else len(nm)
    # One or more materials: the further ones of with_ are along a first axis.
    materials = [] if options.get("with_") is None else [-1]
    arrays = {name: numpy.reshape(found[name], (*materials, len(theta), lights, *counts)) for name in
              ("f_per_sr", "f_se", "theta_deg", "phi_deg", "projected_solid_angle_sr", *labels)}
    first = {name: array.reshape(-1, *counts)[0] for name, array in arrays.items()}
    result = {"theta_o_deg": first["theta_deg"], "phi_o_deg": first["phi_deg"],
              "projected_solid_angle_sr": first["projected_solid_angle_sr"], "f": arrays["f_per_sr"], "f_se": arrays["f_se"]}
    return {"theta_i_deg": numpy.array(theta), **{name: arrays[name].reshape(-1, lights, *counts)[0, :, 0, 0] for name in labels}, **result}


@_with_keywords_of("conform")
def conform(material, *, session=None, **options):
    """Tests whether a BSDF obeys the laws of scattering. material: text, or an object of `frond.Bsdf`. Returns a dictionary with
    the facts of the command's JSON and "laws" {law: row}, "findings" a table, "text" the report. "all_hold" is True if no law was
    found broken, "verdict" says at which parameters. report["laws"]["energy"]: the "largest" directional albedo with its
    "largest_se" and where it was found; "detectable", the excess over 1 that would have been found there with a probability of
    95 %. report["detectable_factor"]: the factor on f that would have been found."""
    result = run("conform", material=_of_bsdf(material, session), session=session, **options)
    laws = result.columns["laws"]
    rows = [dict(zip(laws, row)) for row in zip(*laws.values())]
    return {**result.facts, "laws": {row["law"]: row for row in rows}, "findings": result.tables["findings"], "text": result.text}


@_with_keywords_of("bench", "Result")
def bench(material, with_=None, angles="0,45,80", *, session=None, **options):
    """Measures the cost of BSDFs. material, with_: text, or objects of `frond.Bsdf`."""
    if isinstance(with_, Bsdf):
        with_ = [with_]
    if isinstance(with_, (list, tuple)):
        with_ = [_of_bsdf(one, session) if isinstance(one, Bsdf) else one for one in with_]
    return FUNCTIONS["bench"](_of_bsdf(material, session), with_, angles, session=session, **options)


def register_material(name, bsdf, *, session=None):
    """Registers an object of `frond.Bsdf` as a material that scenes of the session name by `name`. Its renders use one
    core, because each call needs Python's lock. Raises TypeError or ValueError."""
    if not isinstance(bsdf, Bsdf):
        raise TypeError(f"bsdf: an object of a subclass of frond.Bsdf is needed, not {named(bsdf)}")
    if not re.fullmatch(r"[\w.-]+", checked_text(name, "name")):
        raise ValueError(f"name: letters, digits, _ - and . are needed, not {name!r}")
    session = checked_session(session)
    _frond.register_material(session._session, name, (type(bsdf).__doc__ or name).strip().split("\n")[0], bsdf)
    session._bsdfs.setdefault(id(bsdf), name)  # the session keeps the object, so that its id remains its own


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
    """Returns the columns as CSV text for the job `fit`. Missing values of R and T are empty."""
    columns = {"wavelength_nm": bands_of(wavelengths)}
    for name, values in (("R", R), ("T", T)):
        if values is not None:
            columns[name] = reals(values, name, missing=True)
            if len(columns[name]) != len(columns["wavelength_nm"]):
                raise ValueError(f"fit: {len(columns['wavelength_nm'])} wavelengths have {len(columns[name])} {name}")
    return table_text(columns, "fit")


@_with_keywords_of("fit")
def fit(wavelengths=None, R=None, T=None, *, path=None, file=None, data=None, all_leaves=False, sieve=None, **options):
    """Fits the parameters of a leaf to measured reflectance and transmittance. Returns a Fit, or with all_leaves=True the table
    of all leaves of the files: one row for each, with its parameters, their standard errors (columns ending in _se), contents
    per leaf area, and in "status" why it could not be fitted.

    wavelengths: in nm. R, T: shares of the incident light, in [0, 1]; one of them may be missing, and so may single values (NaN
    or masked). path or file: a file, in place of these arrays; with all_leaves a list of files, too. data: the text of such a
    file, or a table with its columns: a data frame, a dictionary of columns, a structured array or a Dataset. sieve: True or False, absorption with sieve and detour effects; by default
    whichever fits better. fix: {"chlorophylla": 3.9}, or per leaf area {"chlorophyll": "40ug/cm2", "water": "0.012g/cm2"}.
    Raises ValueError or InputError."""
    given = {name: value for name, value in (("wavelengths", wavelengths), ("path", path), ("file", file), ("data", data)) if value is not None}
    if len(given) != 1:
        named_ones = f"; {' and '.join(given)} are given" if given else f"; {'R and T need' if R is not None or T is not None else 'it needs'} wavelengths"
        raise ValueError(f"fit takes measurements, or the path of a file with them{named_ones}")
    if wavelengths is not None:
        if hasattr(wavelengths, "columns") or hasattr(wavelengths, "items") and not is_array(wavelengths):
            raise TypeError(f"wavelengths: an array is needed, not {named(wavelengths)}: a table is given as data=")
        source = {"data": _csv(wavelengths, R, T)}
    elif R is not None or T is not None:
        raise ValueError(f"fit: R and T belong to wavelengths; {next(iter(given))} has its own")
    elif data is not None:
        source = {"data": data}
    else:
        path = file if path is None else path
        files = path if isinstance(path, (list, tuple)) else [path]
        if len(files) != 1 and not all_leaves:
            raise ValueError(f"fit: {next(iter(given))} has {len(files)} files; all_leaves=True fits the leaves of several")
        source = {"file": [path_text(name, next(iter(given))) for name in files]}
    sieve = scalar(sieve)
    if isinstance(sieve, bool):
        sieve = "on" if sieve else "off"
    result = run("fit", **source, all_leaves=all_leaves, sieve=sieve, **options)
    return result.table if all_leaves else Fit(result)


def read_spectra(path, *, leaf="", angle=8.0):
    """Reads a file of measured spectra as the job `fit` does. Returns a table of wavelength_nm, theta_deg, R and T. leaf: the
    leaf to read if the file has several. angle: of incidence, in degrees, if the file does not say it. Raises InputError."""
    rows = _frond.read_spectra(path_text(path), checked_text(leaf, "leaf"), float(number(angle, "angle", "degrees")))
    columns = list(zip(*rows)) or [(), (), (), ()]
    return _table(dict(zip(("wavelength_nm", "theta_deg", "R", "T"), map(list, columns))))
