"""Tables of frond as xarray Datasets with the attributes of the CF conventions, and as NetCDF files."""

import re

_CONVENTIONS = "CF-1.8"

#: Columns that label rows, in the order of the dimensions.
_DIMENSIONS = ("time", "date", "material", "incidence_deg", "zenith_deg", "azimuth_deg", "wavelength_nm", "band", "theta_deg", "phi_deg",
               "instance")
#: Ends of column names, and the units that UDUNITS knows them by. The first one that fits counts.
_UNITS = (("umol_m2_s", "umol m-2 s-1"), ("mol_m2", "mol m-2"), ("w_m2", "W m-2"), ("mj_m2", "MJ m-2"), ("_per_sr", "sr-1"), ("_sr", "sr"),
          ("_deg", "degree"), ("_nm", "nm"))
_STANDARD_NAMES = {"time": "time", "wavelength_nm": "radiation_wavelength", "brf": "surface_bidirectional_reflectance"}
_LONG_NAMES = {
    "brf": "bidirectional reflectance factor", "hdrf": "hemispherical-directional reflectance factor",
    "wavelength_nm": "wavelength, of a band its mean", "zenith_deg": "zenith angle of the view", "azimuth_deg": "azimuth of the view",
    "incidence_deg": "angle from the front's normal to the light", "theta_deg": "angle from the front's normal", "phi_deg": "azimuth from that of the light",
    "R": "reflectance", "T": "transmittance", "A": "absorptance", "Rs": "reflectance of the surface", "Rd": "reflectance of the tissue",
    "f_per_sr": "BRDF on the lit side, BTDF on the other", "reflected": "share of the incident light that leaves upward",
    "transmitted": "share of the incident light that leaves downward", "absorbed": "share of the incident light that a material absorbs",
    "incident": "share of the incident light that falls on a material", "uncollided": "part of incident that has met nothing before",
    "sum": "sum of reflected, transmitted and absorbed", "area": "one-sided area", "material": "material", "band": "band",
    "instance": "number of the instance", "date": "day"}


def _xarray():
    try:
        import xarray
    except ImportError as error:
        raise ImportError("a Dataset needs the package xarray: pip install xarray") from error
    return xarray


def _error_of(name, columns):
    """Returns the column of standard errors of a column, or None."""
    found = {"f_per_sr": "f_se"}.get(name, name + "_se")
    return found if found in columns else None


def _times(values):
    """Returns times of ISO 8601 as datetime64, in UTC where they state a time zone."""
    import pandas
    times = pandas.to_datetime(list(values), utc=any(re.search(r"(Z|[+-]\d\d:?\d\d)$", text) for text in values))
    return times.tz_localize(None).to_numpy() if times.tz is not None else times.to_numpy()


def _unique(values):
    import numpy
    values = numpy.asarray(values)
    labels, first = numpy.unique(values, return_index=True)
    return values[numpy.sort(first)] if len(labels) else values


def _dimensions(columns, rows):
    """Returns {dimension: labels} so that the rows are all combinations of the labels, in their order. Where the outer dimensions are not,
    as the directions of a hemisphere, they are one dimension `row`."""
    import numpy
    present = [name for name in _DIMENSIONS if name in columns and not ("band" in columns and name == "wavelength_nm")]
    present.sort(key=lambda name: _changes(columns[name]))
    labels = {name: _unique(columns[name]) for name in present}
    for first in range(len(present) + 1):
        inner = present[first:]
        size = int(numpy.prod([len(labels[name]) for name in inner]))
        if rows % size or (first == 0 and rows != size):
            continue
        grid = numpy.meshgrid(*(labels[name] for name in inner), indexing="ij")
        if all((numpy.tile(of_axis.ravel(), rows // size) == columns[name]).all() for name, of_axis in zip(inner, grid)):
            outer = {} if first == 0 else {"row": numpy.arange(rows // size, dtype="int32")}
            return outer | {name: labels[name] for name in inner}


def _changes(values):
    """Number of rows whose value differs from that of the row before: the outermost dimension has the fewest."""
    return sum(a != b for a, b in zip(values, values[1:]))


def _reduced(array, names):
    """Returns an array without the dimensions along which it is constant, and the names of the others."""
    import numpy
    kept = []
    for axis, name in reversed(list(enumerate(names))):
        first = numpy.take(array, [0], axis=axis)
        same = (array == first) | ((array != array) & (first != first))
        if same.all() and name not in ("instance", "row"):  # an area that all leaves have is still that of each
            array = numpy.take(array, 0, axis=axis)
        else:
            kept.insert(0, name)
    return array, kept


def _name(text):
    text = re.sub(r"\W", "_", text)
    return text if text[:1].isalpha() else "v_" + text


def _attributes(name, of_error=False):
    unit = next((unit for end, unit in _UNITS if name.endswith(end)), "1")
    attributes = {"long_name": ("standard error of " if of_error else "") + _LONG_NAMES.get(name, name.replace("_", " "))}
    if name not in ("material", "kind", "band", "date", "time", "quantity"):
        attributes["units"] = unit
    standard = _STANDARD_NAMES.get(name)
    if standard:
        attributes["standard_name"] = standard + (" standard_error" if of_error else "")
    return attributes


def _variables(columns, prefix=None):
    """Returns (coordinates, variables) of a table, each {name: (dimensions, array, attributes)}."""
    import numpy
    columns = {name: numpy.asarray(values) for name, values in columns.items()}
    if "time" in columns:
        columns["time"] = _times(columns["time"])
    rows = len(next(iter(columns.values())))
    if rows == 0:
        return {}, {}
    dimensions = _dimensions(columns, rows)
    shape, names = tuple(len(labels) for labels in dimensions.values()), list(dimensions)
    coordinates = {name: ((name,), labels, _attributes(name)) for name, labels in dimensions.items()}
    variables = {}
    errors = {_error_of(name, columns) for name in columns} - {None}
    for name, values in columns.items():
        if name in dimensions:
            continue
        array = values.reshape(shape)
        error = _error_of(name, columns)
        if name in errors or error:
            of = next((mean for mean in columns if _error_of(mean, columns) == name), None) if name in errors else name
            own = prefix if prefix and of == "share" else f"{prefix.removesuffix('_par')}_{of}" if prefix else of
            attributes = _attributes(own, name in errors)
            if name not in errors:
                attributes["ancillary_variables"] = _name(own) + "_se"
            variables[_name(own) + ("_se" if name in errors else "")] = (names, array, attributes)
            continue
        array, kept = _reduced(array, names)
        if _is_empty(array):
            continue
        target = variables if array.dtype.kind in "fiu" and name not in _DIMENSIONS and kept else coordinates
        target[_name(name)] = (kept, array, _attributes(name))
    return coordinates, variables


def _of_flux(columns):
    """Returns the tables of a table of `flux`, one for each quantity: {name of the variable: columns}. PAR, which has no wavelength, is
    a quantity of its own."""
    import numpy
    columns = {name: numpy.asarray(values) for name, values in columns.items()}
    is_par = numpy.isnan(columns["wavelength_nm"].astype(float)) if "wavelength_nm" in columns else numpy.zeros(len(columns["quantity"]), bool)
    for quantity in _unique(columns["quantity"]):
        for par in (False, True):
            rows = (columns["quantity"] == quantity) & (is_par == par)
            if rows.any():
                found = {name: values[rows] for name, values in columns.items() if name != "quantity" and not (par and name in ("wavelength_nm", "band"))}
                yield str(quantity) + ("_par" if par else ""), {name: v for name, v in found.items() if not _is_empty(v)}


def _is_empty(values):
    """Whether all values of a column are missing."""
    import numpy
    return bool(numpy.isnan(values).all() if values.dtype.kind == "f" else (values == "").all() if values.dtype.kind in "OU" else False)


def dataset(tables, attributes):
    """Returns the tables {name: columns} as one Dataset. Columns with a standard error NAME_se become variables with that as an
    ancillary variable; the columns that label the rows become dimensions, or `row` where not all combinations are there."""
    xarray = _xarray()
    found = []
    for table, columns in tables.items():
        columns = dict(columns)
        if {"quantity", "share"} <= columns.keys():
            found += [_variables(part, quantity) for quantity, part in _of_flux(columns)]
        else:
            found.append(_variables(columns))
    coordinates, variables = {}, {}
    sizes = {}
    for of_table, measured in found:
        for name, (dims, array, attrs) in of_table.items():
            if name in coordinates and not _same(coordinates[name][1], array):
                raise ValueError(f"tables with different values of {name} do not fit into one Dataset: give one of them")
            coordinates[name] = (dims, array, attrs)
            sizes.update(zip(dims, getattr(array, "shape", ())))
        variables.update(measured)
    command = attributes.get("command", "frond")
    described = {"Conventions": _CONVENTIONS, "title": " ".join(command.split()[:2]), "source": f"frond {attributes.get('version', '')}".strip(),
                 "history": command}
    of = xarray.Dataset(variables, coords=coordinates, attrs=described | attributes)
    return of.transpose(..., "time") if "time" in of.dims else of  # CF: further dimensions come before that of time


def _same(a, b):
    import numpy
    return numpy.shape(a) == numpy.shape(b) and bool((numpy.asarray(a) == numpy.asarray(b)).all())


def write(of, path):
    """Writes a Dataset as NetCDF 4, or as NetCDF 3 where only scipy is installed."""
    import importlib.util
    for engine, package in (("netcdf4", "netCDF4"), ("h5netcdf", "h5netcdf"), ("scipy", "scipy")):
        if importlib.util.find_spec(package):
            # A coordinate without a fill value: CF allows no missing ones.
            encoding = {str(name): {"_FillValue": None} for name, v in of.variables.items() if name in of.coords and v.dtype.kind == "f"}
            if "time" in of.coords:
                encoding["time"] = {"units": "seconds since 1970-01-01", "dtype": "float64", "_FillValue": None}
            of.to_netcdf(path, engine=engine, encoding=encoding)
            return
    raise ImportError("NetCDF files need the package netCDF4, h5netcdf or scipy: pip install netCDF4")
