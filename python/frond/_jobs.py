"""The jobs of frond as functions. Their signatures, docstrings and checks are made from the records of the command line."""

import inspect
import keyword
import os
import re

from . import _frond
from ._session import Scene, _show, checked_session, checked_text
from ._values import flag, in_unit, is_array, named, number, numbers, scalar, table_text, texts

_ANNOTATIONS = {"flag": "bool", "count": "int", "seed": "int", "real": "float", "numbers": "float | Sequence[float] | str",
                "text": "str | os.PathLike", "texts": "str | Sequence[str] | Mapping[str, str]"}


def _annotation(param):
    if param["type"] in _NUMERIC and param["kind"] == "text":
        return "float | Sequence[float] | str" if "," in param["type"] or param["type"] not in ("STOPS", "KELVIN") else "float | str"
    of_kind = _ANNOTATIONS[param["kind"]]
    if param["kind"] == "texts" and "=" not in param["type"] and param["type"] != "SWAP":
        of_kind = "str | os.PathLike | Sequence[str | os.PathLike]"
    if param["type"] == "CSV":
        of_kind = "str | pandas.DataFrame | Mapping[str, Sequence[float]]"
    return of_kind + (" | Scene" + (" | Sequence[str | os.PathLike | Scene]" if param["kind"] == "texts" else "") if param["scene"] else "")


#: Types of texts in which numbers stand, with the text between several of them and their unit.
_NUMERIC = {"WAVELENGTHS": (",", "nm"), "STOPS": (",", "stops"), "KELVIN": (",", "K"), "R,G,B": (",", ""), "THETAxPHI": ("x", ""),
            "FIRST:END": (":", "")}


def _number_text(value):
    return str(value) if isinstance(value, int) else repr(value)


def _part(value, name, *, is_number=False):
    """Returns a text, a path, or where they are allowed a number, as text. Numbers keep all digits."""
    value = scalar(value)
    if isinstance(value, (str, os.PathLike)):
        return os.fsdecode(value)
    if isinstance(value, (bytes, bytearray, memoryview)):
        return os.fsdecode(bytes(value))
    if not is_number:
        raise TypeError(f"{name}: a text is needed, not {named(value)}")
    return _number_text(number(value, name))


def _flag_words(param, name, value):
    value = scalar(value)
    return [value] if isinstance(value, str) else ["true" if flag(value, name) else "false"]


def _is_text_list(value):
    """Whether a value is a list in which a text stands, such as a range: ["0:80:10", "85"]."""
    return isinstance(value, (list, tuple)) and any(isinstance(v, str) for v in value)


def _number_words(param, name, value):
    value = scalar(in_unit(value, name, param["unit"]))
    if isinstance(value, str):
        return [value]
    if param["kind"] != "numbers":
        return [_number_text(number(value, name))]
    if _is_text_list(value):
        return [",".join(_part(v, name, is_number=True) for v in value)]
    return [",".join(map(_number_text, numbers(value, name, param["unit"])))]


def _text_words(param, name, value):
    if param["type"] in _NUMERIC:
        separator, unit = _NUMERIC[param["type"]]
        value = in_unit(value, name, unit)
        if not isinstance(scalar(value), str) and not _is_text_list(value):
            return [separator.join(map(_number_text, numbers(value, name, unit)))]
    value = scalar(value)
    if value is True and param["implied"]:
        return ["true"]
    if isinstance(value, (str, bytes, bytearray, memoryview, os.PathLike)):
        return [_part(value, name)]
    if param["choices"] or any(kind in param["type"] for kind in ("FILE", "FOLDER", "CHART", "SCENE")):
        raise TypeError(f"{name}: {'one of ' + ', '.join(param['choices']) if param['choices'] else 'a path'} is needed, not {named(value)}")
    if param["type"] == "CSV":
        return [table_text(value, name)]
    if param["type"] == "MATERIAL" and not hasattr(value, "__iter__"):
        raise TypeError(f"{name}: {no_text(value)}")
    return [",".join(_part(v, name, is_number=param["type"] in _NUMERIC) for v in texts(value, name))]


def _mapped_words(param, name, value):
    """Returns NAME=VALUE for each item of a mapping; the parts of a value are joined as the type of the parameter says."""
    if "=" not in param["type"] and param["type"] != "SWAP":
        raise TypeError(f"{name}: a text or a list of texts is needed, not {named(value)}")
    separator = ":" if ":" in param["type"] else ","

    def text(v):
        v = scalar(v)
        if isinstance(v, (str, bytes, os.PathLike)) or not hasattr(v, "__iter__"):
            return _part(v, name, is_number="NUMBER" in param["type"])
        return separator.join(_part(part, name, is_number=True) for part in texts(v, name))

    return [f"{_part(key, name)}={text(v)}" for key, v in value.items()]


def _texts_words(param, name, value):
    value = scalar(value)
    if isinstance(value, (str, bytes, bytearray, memoryview, os.PathLike)):
        text = _part(value, name)
        if param["name"] == "swap" and "=" not in text.split(",")[0]:
            text = "*=" + text  # a model for every leaf
        return [text]
    if hasattr(value, "items") and not is_array(value):
        return _mapped_words(param, name, value)
    if not hasattr(value, "__iter__") and "MATERIAL" in param["type"]:
        raise TypeError(f"{name}: {no_text(value)}")
    return [_part(v, name) for v in texts(value, name)]


_WORDS = {"flag": _flag_words, "count": _number_words, "seed": _number_words, "real": _number_words, "numbers": _number_words,
          "text": _text_words, "texts": _texts_words}


def words(param, value):
    """Returns the list of texts for a parameter, in the grammar of the command line: one text, or any number for a repeatable
    parameter. Raises TypeError or ValueError, as for a file name whose bytes are not UTF-8."""
    name = python_name(param["name"])
    return [checked_text(text, name) for text in _WORDS[param["kind"]](param, name, value)]


def no_text(value):
    """Returns the error for a material that is no text."""
    return f'a text is needed, not {named(value)}; frond.register_material("name", bsdf) gives an object of frond.Bsdf a name'


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


def python_name(name):
    """Returns the Python name of a job or parameter: time_limit for time-limit, import_ for import."""
    return name.replace("-", "_") + ("_" if keyword.iskeyword(name) else "")


def arguments(params, given):
    """Returns {name: texts} of the given keywords, for the records `params`."""
    found = {}
    for param in params:
        value = given.get(python_name(param["name"]))
        if value is None:
            continue
        of_value = words(param, value)
        if param["kind"] != "flag" or of_value != ["false"]:
            found[param["name"]] = of_value
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


JOBS = {job["name"]: job for job in _frond.jobs()}
FUNCTIONS = {python_name(name): _function(job) for name, job in JOBS.items()}
