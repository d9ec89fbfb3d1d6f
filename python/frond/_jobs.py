"""The jobs of frond as functions. Their signatures, docstrings and checks are made from the records of the command line."""

import inspect
import re

from . import _frond
from ._dataset import dataset, write
from ._records import JOBS, NUMERIC, arguments, by_alias, python_name
from ._session import Scene, _show, checked_session
from ._values import named

_ANNOTATIONS = {"flag": "bool", "count": "int", "seed": "int", "real": "float", "numbers": "float | Sequence[float] | str",
                "text": "str | os.PathLike", "texts": "str | Sequence[str] | Mapping[str, str]"}


def _annotation(param):
    if param["type"] in NUMERIC and param["kind"] == "text":
        return "float | Sequence[float] | str" if "," in param["type"] or param["type"] not in ("STOPS", "KELVIN") else "float | str"
    of_kind = _ANNOTATIONS[param["kind"]]
    if param["kind"] == "texts" and "=" not in param["type"] and param["type"] != "SWAP":
        of_kind = "str | os.PathLike | Sequence[str | os.PathLike]"
    if param["type"] == "CSV":
        of_kind = "str | pandas.DataFrame | Mapping[str, Sequence[float]]"
    return of_kind + (" | Scene" + (" | Sequence[str | os.PathLike | Scene]" if param["kind"] == "texts" else "") if param["scene"] else "")


def with_scenes(params, given):
    """Returns the keywords with the names of scenes in memory in place of them, and {index: scene} of their words."""
    scenes = {}
    for param in params:
        name = python_name(param["name"])
        value = given.get(name)
        several = isinstance(value, (list, tuple))
        found = {i: v for i, v in enumerate(value if several else [value]) if isinstance(v, Scene)}
        if not found:
            continue
        if not param["scene"] or several and param["kind"] != "texts":
            reason = "; its tasks read the file in processes of their own" if param["type"] == "SCENE" and not param["scene"] else ""
            raise TypeError(f"{name}: {'a path' if 'SCENE' in param['type'] else 'a value'} is needed, not {named(next(iter(found.values())))}{reason}")
        scenes |= found
        names = [found[i].path if i in found else v for i, v in enumerate(value if several else [value])]
        given = given | {name: names if several else names[0]}
    return given, scenes


def _default(param):
    text = param["default"]
    if param["kind"] == "flag":
        return False
    if not text:
        return inspect.Parameter.empty if param["required"] else None
    return {"count": lambda t: int(float(t)), "seed": int, "real": float}.get(param["kind"], str)(text)


def _doc(text):
    """Spells the options in a help text as Python keywords."""
    return re.sub(r"--([a-z][a-z-]*)", lambda match: python_name(match[1]), text)


def _signature(job):
    kinds, parameters = inspect.Parameter, []
    for i, param in enumerate(job["params"]):
        kind = kinds.POSITIONAL_OR_KEYWORD if i < 3 else kinds.KEYWORD_ONLY
        parameters.append(kinds(python_name(param["name"]), kind, default=_default(param), annotation=_annotation(param)))
    # Python requires parameters without a default before those with one.
    seen_default = False
    for i, parameter in enumerate(parameters[:3]):
        seen_default = seen_default or parameter.default is not kinds.empty
        if seen_default and parameter.default is kinds.empty:
            parameters[i] = parameter.replace(default=None)
    parameters.append(kinds("progress", kinds.KEYWORD_ONLY, default=None))
    parameters.append(kinds("session", kinds.KEYWORD_ONLY, default=None, annotation="Session | None"))
    return inspect.Signature(parameters, return_annotation="Result")


def _docstring(job):
    lines = [job["doc"], "", *([job["details"], ""] if job["details"] else [])]
    lines += [f"{python_name(p['name'])}: {_doc(p['doc'])}" for p in job["params"]]
    return "\n".join(lines)


class Result:
    """The result of a job: `tables` {name: table}, single values `facts` {name: value}, `notes` (a list of texts), the `text`
    that the command prints, and its exit `code`.

    A table is a pandas.DataFrame if pandas is installed, else a dictionary of columns. `table` is the first table. `provenance` has
    the facts by which a measurement can be repeated: version, command, seed and the scene's hash; a DataFrame has them in `attrs`.
    """

    def __init__(self, found):
        self.columns, self.facts = found["tables"], found["facts"]
        self.notes, self.text, self.code = found["notes"], found["text"], found["code"]

    @property
    def provenance(self):
        return {name: self.facts[name] for name in ("version", "command", "seed", "scene_hash") if name in self.facts}

    @property
    def tables(self):
        return {name: _table(columns, self.provenance) for name, columns in self.columns.items()}

    @property
    def table(self):
        return _table(next(iter(self.columns.values())), self.provenance) if self.columns else None

    def to_xarray(self, *tables):
        """Returns the first table, or those named, as an xarray.Dataset with the attributes of the CF conventions: dimensions,
        units, and standard errors as ancillary variables. Needs xarray."""
        return dataset({name: self.columns[name] for name in tables or list(self.columns)[:1]}, self.provenance)

    def to_netcdf(self, path, *tables):
        """Writes `to_xarray` as a NetCDF file. Needs xarray and netCDF4, h5netcdf or scipy."""
        write(self.to_xarray(*tables), path)

    def __str__(self):
        return self.text


def _table(columns, provenance=None):
    try:
        import pandas
    except ImportError:
        import numpy
        return {name: numpy.asarray(values) for name, values in columns.items()}
    table = pandas.DataFrame(columns)
    table.attrs.update(provenance or {})
    return table


def run(name, /, *, progress=None, session=None, **given):
    """Runs the job `name` with the keywords of its function and returns a `Result`. Raises InputError."""
    if not isinstance(name, str) or name not in JOBS:
        raise ValueError(f"there is no job {name!r}: one of {', '.join(JOBS)}")
    job = JOBS[name]
    given = by_alias(job["params"], given)
    known = {python_name(p["name"]) for p in job["params"]}
    for unknown in given.keys() - known:
        raise TypeError(f"{name}() got an unexpected keyword argument {unknown!r}")
    given, scenes = with_scenes(job["params"], given)
    if session is None and scenes:
        session = next(iter(scenes.values())).session
    return Result(_frond.run(checked_session(session)._session, name, arguments(job["params"], given), _show(progress),
                             {i: scene._scene for i, scene in scenes.items()}))


def _function(job):
    signature = _signature(job)

    def call(*args, **kwargs):
        bound = signature.bind(*args, **by_alias(job["params"], kwargs))
        return run(job["name"], **bound.arguments)

    call.__name__ = call.__qualname__ = python_name(job["name"])
    call.__signature__, call.__doc__, call.__module__ = signature, _docstring(job), "frond"
    return call


FUNCTIONS = {python_name(name): _function(job) for name, job in JOBS.items()}
