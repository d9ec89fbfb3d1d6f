"""The jobs of frond as functions. Their signatures, docstrings and checks are made from the records of the command line."""

import inspect
import keyword
import operator
import os
import re

from . import _frond
from ._session import _show, checked_session, checked_text

_ANNOTATIONS = {"flag": "bool", "count": "int", "seed": "int", "real": "float", "numbers": "float | Sequence[float] | str",
                "text": "str | os.PathLike", "texts": "str | Sequence[str] | Mapping[str, str]"}


def _annotation(param):
    return "float | str" if param["type"] == "STOPS" else _ANNOTATIONS[param["kind"]]


def _text(value):
    """Returns a value as text, in the grammar of the command line. Numbers keep all digits."""
    if hasattr(value, "item") and getattr(value, "ndim", 0) == 0:
        value = value.item()  # a NumPy scalar
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, (str, os.PathLike)):
        return os.fsdecode(value)
    if isinstance(value, (bytes, bytearray)):
        return os.fsdecode(bytes(value))
    if getattr(value, "ndim", 0) == 0:  # arrays have __index__ and __float__ too
        if hasattr(value, "__index__"):
            return str(operator.index(value))
        if hasattr(value, "__float__"):
            return repr(float(value))
    return ",".join(_text(v) for v in value)


def words(param, value):
    """Returns the list of texts for a parameter: one text, or any number for a repeatable parameter. Raises TypeError or
    ValueError, as for a file name whose bytes are not UTF-8."""
    try:
        found = _words(param, value)
    except TypeError as error:
        raise TypeError(f"{python_name(param['name'])}: {error}") from None
    return [checked_text(text, python_name(param["name"])) for text in found]


def no_text(value):
    """Returns the error for a material that is no text."""
    return f'a text is needed, not {value!r}; frond.register_material("name", bsdf) gives an object of frond.Bsdf a name'


def _words(param, value):
    if param["kind"] != "texts":
        return [_text(value)]
    if isinstance(value, (bytearray, memoryview)):
        value = bytes(value)
    if isinstance(value, (str, bytes, os.PathLike)):
        text = os.fsdecode(value)
        if param["name"] == "swap" and "=" not in text.split(",")[0]:
            text = "*=" + text  # a model for every leaf
        return [text]
    if hasattr(value, "items"):
        return [f"{name}={_text(v)}" for name, v in value.items()]
    if not hasattr(value, "__iter__") and param["type"] == "MATERIAL":
        raise TypeError(no_text(value))
    return [_text(v) for v in value]


def python_name(name):
    """Returns the Python name of a job or parameter: time_limit for time-limit, import_ for import."""
    return name.replace("-", "_") + ("_" if keyword.iskeyword(name) else "")


def arguments(params, given):
    """Returns {name: texts} of the given keywords, for the records `params`."""
    found = {}
    for param in params:
        value = given.get(python_name(param["name"]))
        if value is not None and not (param["kind"] == "flag" and value is False):
            found[param["name"]] = words(param, value)
    return found


def by_alias(params, given):
    """Returns the keywords with aliases replaced by the names of the records. Raises TypeError if both are given."""
    names = {python_name(alias): python_name(p["name"]) for p in params for alias in p["aliases"].split(",") if len(alias) > 1}
    found = {}
    for name, value in given.items():
        own = names.get(name, name)
        if own in found:
            raise TypeError(f"{own} is given twice, also by its other name")
        found[own] = value
    return found


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

    A table is a pandas.DataFrame if pandas is installed, else a dictionary of columns. `table` is the first table.
    """

    def __init__(self, found):
        self.columns, self.facts = found["tables"], found["facts"]
        self.notes, self.text, self.code = found["notes"], found["text"], found["code"]

    @property
    def tables(self):
        return {name: _table(columns) for name, columns in self.columns.items()}

    @property
    def table(self):
        return _table(next(iter(self.columns.values())))

    def __str__(self):
        return self.text


def _table(columns):
    try:
        import pandas
    except ImportError:
        import numpy
        return {name: numpy.asarray(values) for name, values in columns.items()}
    return pandas.DataFrame(columns)


def run(name, /, *, progress=None, session=None, **given):
    """Runs the job `name` with the keywords of its function and returns a `Result`. Raises InputError."""
    if name not in JOBS:
        raise ValueError(f"there is no job {name!r}: one of {', '.join(JOBS)}")
    job = JOBS[name]
    given = by_alias(job["params"], given)
    known = {python_name(p["name"]) for p in job["params"]}
    for unknown in given.keys() - known:
        raise TypeError(f"{name}() got an unexpected keyword argument {unknown!r}")
    return Result(_frond.run(checked_session(session)._session, name, arguments(job["params"], given), _show(progress)))


def _function(job):
    signature = _signature(job)

    def call(*args, **kwargs):
        bound = signature.bind(*args, **by_alias(job["params"], kwargs))
        return run(job["name"], **bound.arguments)

    call.__name__ = call.__qualname__ = python_name(job["name"])
    call.__signature__, call.__doc__, call.__module__ = signature, _docstring(job), "frond"
    return call


JOBS = {job["name"]: job for job in _frond.jobs()}
FUNCTIONS = {python_name(name): _function(job) for name, job in JOBS.items()}
