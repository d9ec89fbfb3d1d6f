"""Records of the jobs, and values of Python as words of the command line."""

import keyword
import os

from . import _frond
from ._values import checked_text, flag, in_unit, is_array, named, number, numbers, scalar, table_text, texts

JOBS = {job["name"]: job for job in _frond.jobs()}

#: Types of texts in which numbers stand, with the text between several of them and their unit.
NUMERIC = {"WAVELENGTHS": (",", "nm"), "STOPS": (",", "stops"), "KELVIN": (",", "K"), "R,G,B": (",", ""), "THETAxPHI": ("x", ""),
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
    if param["type"] in NUMERIC:
        separator, unit = NUMERIC[param["type"]]
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
    return [",".join(_part(v, name, is_number=param["type"] in NUMERIC) for v in texts(value, name))]


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
