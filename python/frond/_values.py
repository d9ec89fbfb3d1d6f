"""Values of Python as numbers and texts: arrays of the field's packages, physical units, and what is no such value."""

import contextlib
import csv
import enum
import io
import math
import operator
import os
import reprlib
import tempfile

#: Units by the unit of a parameter, with the factor to it. Unnamed parameters are shares.
_UNITS = {
    "nm": {"nm": 1, "nanometer": 1, "nanometre": 1, "nanometers": 1, "nanometres": 1, "um": 1e3, "\u00b5m": 1e3, "\u03bcm": 1e3,
           "micrometer": 1e3, "micrometre": 1e3, "micrometers": 1e3, "micrometres": 1e3, "micron": 1e3, "microns": 1e3, "m": 1e9},
    "degrees": {"degrees": 1, "degree": 1, "deg": 1, "\u00b0": 1, "rad": 180 / math.pi, "radian": 180 / math.pi, "radians": 180 / math.pi},
    "": {"": 1, "1": 1, "-": 1, "dimensionless": 1, "unitless": 1, "%": 0.01, "percent": 0.01},
}
_short = reprlib.Repr()
_short.maxstring = _short.maxother = 60


def type_name(value):
    """Returns the type of a value with its package, as in numpy.ndarray and frond.Image."""
    kind = type(value)
    if kind.__module__ == "builtins":
        return kind.__qualname__
    return f"{kind.__module__.partition('.')[0]}.{kind.__qualname__}"


def named(value):
    """Returns a value as errors name it: an array by its shape and type, anything else by its text and type."""
    if value is None:
        return "None"
    dims = getattr(value, "dims", None)
    columns = getattr(value, "columns", None)
    if dims is not None and hasattr(value, "data_vars"):
        return f"a {type_name(value)} of the variables {', '.join(map(str, value.data_vars))}"
    if columns is not None and hasattr(value, "shape"):
        return f"a {type_name(value)} of {value.shape[0]} rows and the columns {', '.join(map(str, list(columns)[:8]))}"
    dtype = getattr(value, "dtype", None)
    if dtype is not None and getattr(value, "ndim", 0):
        of = f"dimensions {', '.join(map(str, dims))}" if dims else f"shape {tuple(value.shape)}"
        return f"a {type_name(value)} of {of} and type {dtype}"
    if isinstance(value, (set, frozenset, dict, list, tuple, str, bytes, bytearray, int, float, complex)):
        return f"{_short.repr(value)} ({type_name(value)})"
    return f"the type {value.__name__}" if isinstance(value, type) else f"{'an' if type_name(value)[0] in 'aeio' else 'a'} {type_name(value)}"


def is_array(value):
    """Whether a value is an array with dimensions, of whichever package."""
    return bool(getattr(value, "ndim", 0)) or (hasattr(value, "__array__") and getattr(value, "ndim", 1) != 0)


def scalar(value):
    """Returns a scalar of an array package or an enumeration as a plain value of Python; others as they are."""
    if isinstance(value, enum.Enum) and not isinstance(value, (str, int, float)):
        value = value.value
    if getattr(value, "ndim", None) == 0 and hasattr(value, "item") and not hasattr(value, "units") and not hasattr(value, "unit"):
        mask = getattr(value, "mask", False)
        return None if mask is not False and bool(mask) else value.item()
    return value


def _converted(values):
    """Returns converted numbers without the last digit, in which a conversion rounds: 0.36 um are 360 nm."""
    if is_array(values):
        import numpy
        values = numpy.asarray(values)
        return values if values.dtype.kind != "f" else numpy.reshape([float(f"{v:.15g}") for v in values.flat], values.shape)
    return float(f"{values:.15g}") if isinstance(values, float) else values


def in_unit(value, what, unit):
    """Returns a quantity of pint or astropy, or a labelled array with the attribute "units", as plain numbers in `unit`; others
    as they are. Raises ValueError for a unit that cannot be converted."""
    wanted = {"degrees": "deg", "stops": ""}.get(unit, unit)
    try:
        if hasattr(value, "magnitude") and hasattr(value, "units") and hasattr(value, "to"):
            return _converted(value.to(wanted or "dimensionless").magnitude)
        if hasattr(value, "unit") and hasattr(value, "to_value"):
            return _converted(value.to_value(wanted))
    except Exception as error:
        raise ValueError(f"{what}: {error}; {f'{unit} is' if unit else 'numbers without a unit are'} needed") from None
    if not hasattr(value, "dims") or not hasattr(value, "attrs") or hasattr(value, "data_vars"):
        return value
    if hasattr(value.data, "magnitude") and hasattr(value.data, "units"):  # a DataArray of quantities
        return in_unit(value.data, what, unit)
    own = value.attrs.get("units")
    if own is None or unit not in _UNITS:
        return value
    factor = _UNITS[unit].get(str(own).strip())
    if factor is None:
        raise ValueError(f"{what}: the array's attribute \"units\" is {str(own)!r}: {unit or 'a share of 1'} is needed")
    return value if factor == 1 else _converted(value.data * factor)  # without the attribute


def number(value, what, unit=""):
    """Returns a scalar as int or float. Raises TypeError for what is no number; a number's text is one."""
    value = scalar(in_unit(value, what, unit))
    if isinstance(value, str):
        try:
            return float(value)
        except ValueError:
            raise TypeError(f"{what}: a number is needed, not {named(value)}") from None
    if isinstance(value, (bool, complex, type)) or is_array(value) or not (hasattr(value, "__index__") or hasattr(value, "__float__")):
        raise TypeError(f"{what}: a number is needed, not {named(value)}")
    return operator.index(value) if hasattr(value, "__index__") else float(value)


def whole(value, what, least=0):
    """Returns a whole number. Raises TypeError, or ValueError below `least`."""
    value = scalar(value)
    if isinstance(value, bool) or not hasattr(value, "__index__") or is_array(value):
        raise TypeError(f"{what}: a whole number is needed, not {named(value)}")
    found = operator.index(value)
    if found < least:
        raise ValueError(f"{what}: a whole number from {least} on is needed, not {found}")
    return found


def flag(value, what):
    """Returns True or False. Raises TypeError for anything else."""
    value = scalar(value)
    if not isinstance(value, bool):
        raise TypeError(f"{what}: True or False is needed, not {named(value)}")
    return value


def _of_array(values, what):
    """Returns the values of an array as a list, masked ones as None. Raises TypeError or ValueError, which name the array."""
    import numpy
    if getattr(values, "ndim", 1) != 1 or hasattr(values, "data_vars"):
        at = " (DataFrame.T is the transposed table: write table[\"T\"])" if what == "T" and hasattr(values, "columns") else ""
        raise TypeError(f"{what}: one dimension is needed, not {named(values)}{at}")
    try:
        array = values if isinstance(values, numpy.ndarray) else numpy.asarray(values)
    except Exception as error:
        raise TypeError(f"{what}: {named(values)} is no array in memory: {error}") from None
    if array.ndim != 1:
        raise TypeError(f"{what}: one dimension is needed, not {named(values)}")
    if array.dtype.kind not in "iufOUT":
        raise TypeError(f"{what}: numbers are needed, not {named(values)}")
    return array.tolist()


def numbers(values, what, unit="", *, missing=False):
    """Returns a number, or the numbers of a list, an iterator or an array of one dimension, as a list of int and float.

    Arrays: of NumPy (any numeric type, strided, byte-swapped, masked), pandas, xarray, polars, torch, and buffers. unit: that of
    the numbers; quantities are converted to it. missing: masked values, None and NaN become NaN; otherwise they are refused.
    Raises TypeError for what holds no numbers, and ValueError for missing ones."""
    values = in_unit(values, what, unit)
    if isinstance(values, str):
        from . import _frond
        found = _frond.parse_numbers(values) if values.isascii() else None
        if found is None:
            raise ValueError(f"{what}: a list of numbers, as in 0,8,30 or first:last:step, is needed, not {named(values)}")
        return found
    if isinstance(values, memoryview):
        import numpy
        values = numpy.asarray(values)
    if isinstance(values, (bytes, bytearray)) or hasattr(values, "items") and not is_array(values) or hasattr(values, "data_vars"):
        raise TypeError(f"{what}: numbers are needed, not {named(values)}")
    if isinstance(values, (set, frozenset)):
        raise TypeError(f"{what}: a list of numbers is needed, not {named(values)}, which has no order")
    masked = type(getattr(values, "mask", None)).__module__.startswith("numpy") and hasattr(values, "filled")
    if is_array(values):
        values = _of_array(values, what)
    elif values is None or not hasattr(values, "__iter__") or isinstance(values, type) or getattr(values, "ndim", 1) == 0:
        if _is_missing(scalar(values)) and not isinstance(scalar(values), float):
            raise TypeError(f"{what}: numbers are needed, not {named(values)}")
        values = [number(values, what, unit)]
    found = []
    for i, value in enumerate(values):
        value = scalar(value)
        if _is_missing(value):
            found.append(math.nan)
            continue
        try:
            found.append(number(value, what, unit))
        except TypeError as error:
            raise TypeError(f"{error}, at index {i}") from None
    lost = [i for i, value in enumerate(found) if value != value]
    if lost and not missing:
        if masked:
            raise ValueError(f"{what}: a masked array with {len(lost)} masked values, the first at index {lost[0]}")
        raise ValueError(f"{what}: numbers are needed; {len(lost)} of {len(found)} values are nan or missing, the first at index {lost[0]}")
    return found


def reals(values, what, unit="", *, missing=False):
    """Returns `numbers` as floats."""
    try:
        return [float(value) for value in numbers(values, what, unit, missing=missing)]
    except OverflowError:
        raise ValueError(f"{what}: numbers below 1.8e308 are needed") from None


def _is_missing(value):
    if isinstance(value, (str, bool, bytes)) or is_array(value) or hasattr(value, "__len__"):
        return False
    return value is None or type(value).__name__ in ("NAType", "NaTType", "MaskedConstant") or isinstance(value, float) and value != value


def array_of(values, what, dtype):
    """Returns an array of floats for the renderer. Raises TypeError or ValueError for what is no array of numbers."""
    import numpy
    values = in_unit(values, what, "")
    if getattr(values, "mask", None) is not None and hasattr(values, "filled") and numpy.ma.getmaskarray(values).any():
        raise ValueError(f"{what}: a masked array with {int(numpy.ma.getmaskarray(values).sum())} masked values")
    try:
        array = numpy.asarray(values)
    except Exception as error:
        raise TypeError(f"{what}: {named(values)} is no array of numbers: {error}") from None
    if array.dtype.kind == "O":
        try:
            array = array.astype(dtype)
        except (TypeError, ValueError) as error:
            raise TypeError(f"{what}: {named(values)} is no array of numbers: {error}") from None
    if array.dtype.kind not in "iuf":
        raise TypeError(f"{what}: an array of numbers is needed, not {named(values if is_array(values) else array)}")
    return numpy.ascontiguousarray(array, dtype)


def texts(value, what):
    """Returns the texts of a list. Raises TypeError for what is no list of them."""
    if isinstance(value, (set, frozenset)):
        raise TypeError(f"{what}: a list is needed, not {named(value)}, which has no order")
    if not hasattr(value, "__iter__") or hasattr(value, "items") and not hasattr(value, "dtype"):
        raise TypeError(f"{what}: a text or a list of texts is needed, not {named(value)}")
    return list(value)


def file_text(value, what):
    """Returns the text of a path (str, bytes or os.PathLike). Raises TypeError for anything else."""
    value = scalar(value)
    if isinstance(value, (bytearray, memoryview)):
        value = bytes(value)
    if not isinstance(value, (str, bytes, os.PathLike)):
        raise TypeError(f"{what}: a path is needed, not {named(value)}")
    return os.fsdecode(value)


def checked_text(text, what):
    """Returns the text. Raises TypeError if it is not a str, and ValueError for a zero byte, at which it would be cut off, and for
    what UTF-8 cannot hold."""
    if not isinstance(text, str):
        raise TypeError(f"{what}: text is needed, not {named(text)}")
    if "\0" in text:
        raise ValueError(f"{what}: a text without zero bytes is needed, not {text!r}")
    try:
        text.encode()
    except UnicodeEncodeError:
        raise ValueError(f"{what}: {text!r} is not UTF-8") from None
    return text


@contextlib.contextmanager
def table_file(table, what):
    """Context of the path of a table: that of a file, or of a temporary file with the columns of a data frame or a dictionary, whose
    index of times becomes the column "time"."""
    if table is None or isinstance(table, (str, bytes, os.PathLike)):
        yield table
        return
    index = getattr(table, "index", None)
    if hasattr(index, "tz_localize") and "time" not in table.columns:
        table = table.rename_axis("time")
    with tempfile.TemporaryDirectory(prefix="frond-") as folder:
        path = os.path.join(folder, what + ".csv")
        with open(path, "w", encoding="utf-8") as file:
            file.write(table_text(table, what))
        yield path


def path_text(path, what="path"):
    """Returns a path (str, bytes or os.PathLike) as text. Raises the errors of `file_text` and `checked_text`."""
    return checked_text(file_text(path, what), what)


def table_text(table, what):
    """Returns a table as CSV: a data frame, a Dataset of one dimension or more, a structured array, or a dictionary of columns."""
    if hasattr(table, "data_vars") and hasattr(table, "to_dataframe"):
        table = table.to_dataframe()
    if hasattr(table, "reset_index") and hasattr(table, "columns"):
        if any(name is not None for name in table.index.names):
            table = table.reset_index()
        if getattr(table.columns, "nlevels", 1) > 1:
            raise TypeError(f"{what}: columns of one level are needed, not {named(table)}")
        columns = {str(name): table[name] for name in table.columns}
    elif hasattr(table, "get_columns"):
        columns = {column.name: column for column in table.get_columns()}
    elif getattr(getattr(table, "dtype", None), "names", None):
        columns = {name: table[name] for name in table.dtype.names}
    elif isinstance(table, dict):
        columns = {str(name): values for name, values in table.items()}
    else:
        raise TypeError(f"{what}: CSV as a text, or a table with named columns is needed, not {named(table)}")
    if not columns:
        raise ValueError(f"{what}: a table with columns is needed, not an empty one")
    for name, values in columns.items():
        if not hasattr(values, "__iter__") or isinstance(values, (str, bytes, set, frozenset)) or getattr(values, "ndim", 1) != 1:
            raise TypeError(f"{what}: the column {name!r} is a list of values, not {named(values)}")
    lists = {name: [None if _is_missing(scalar(v)) else scalar(v) for v in values] for name, values in columns.items()}
    lengths = {name: len(values) for name, values in lists.items()}
    if len(set(lengths.values())) > 1:
        raise ValueError(f"{what}: columns of one length are needed, not of {lengths}")
    out = io.StringIO()
    writer = csv.writer(out, lineterminator="\n")
    writer.writerow(lists)
    writer.writerows([["" if v is None else repr(v) if isinstance(v, float) else v for v in row] for row in zip(*lists.values())])
    return out.getvalue()
