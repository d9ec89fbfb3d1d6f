"""Values of Python: arrays of the field's packages are taken, or refused with the true reason; errors name the argument, what is
needed and the type that was given. After reports of labelled and masked arrays that ended with wrong reasons: pydata/xarray#520
(arrays of labels in other packages), linetools/linetools#226 (masked arrays taken as data)."""

import array
import datetime
import decimal
import enum
import fractions
import pathlib
import tempfile

import frond
import numpy
import pandas
import pytest
import xarray
from conftest import SCENE
from frond import _records

NM = [450.0, 551.0, 700.0]


class Quantity:
    """The interface of pint, with lengths only."""

    def __init__(self, magnitude, units):
        self.magnitude, self.units = magnitude, units

    def to(self, unit):
        factors = {"nm": 1.0, "um": 1000.0}
        if unit not in factors or self.units not in factors:
            raise TypeError(f"Cannot convert from '{self.units}' to '{unit}'")
        return Quantity(self.magnitude * factors[self.units] / factors[unit], unit)

    def __array__(self, dtype=None, copy=None):  # as pint does, with a warning: the unit is lost
        return numpy.asarray(self.magnitude, dtype)

    def __iter__(self):
        return (Quantity(m, self.units) for m in self.magnitude)


class AstroQuantity(numpy.ndarray):
    """The interface of astropy."""

    unit = "um"

    def to_value(self, unit):
        if unit != "nm":
            raise ValueError(f"'um' (length) and '{unit}' (dimensionless) are not convertible")
        return numpy.asarray(self) * 1000


class Tensor:
    """A tensor of torch, in the memory of the host or of a device."""

    def __init__(self, values, device="cpu"):
        self.values, self.device = numpy.asarray(values), device
        self.ndim, self.shape, self.dtype = self.values.ndim, self.values.shape, self.values.dtype

    def __array__(self, dtype=None, copy=None):
        if self.device != "cpu":
            raise TypeError(f"can't convert {self.device} device type tensor to numpy. Use Tensor.cpu() first")
        return self.values


class Band(enum.Enum):
    GREEN = 551
    RED = 670.5


class Leaf(enum.Enum):
    SIMPLE = "leaf_lambert"


TAKEN = {
    "list": NM, "tuple": tuple(NM), "generator": (nm for nm in NM), "iterator": iter(NM), "text": "450,551,700",
    "float64": numpy.array(NM), "float32": numpy.array(NM, "f4"), "float16": numpy.array([450, 551, 700], "f2"), "longdouble": numpy.array(NM, "g"),
    "int64": numpy.array([450, 551, 700]), "uint16": numpy.array([450, 551, 700], "u2"), "swapped": numpy.array(NM, ">f8"),
    "strided": numpy.repeat(NM, 2)[::2], "reversed": numpy.array(NM[::-1])[::-1], "object": numpy.array(NM, object),
    "list of scalars": [numpy.float32(nm) for nm in NM], "list of 0-d": [numpy.array(nm) for nm in NM], "without a mask": numpy.ma.array(NM),
    "masked, none": numpy.ma.array(NM, mask=[0, 0, 0]), "Series": pandas.Series(NM, index=[7, 8, 9]), "Index": pandas.Index(NM),
    "nullable": pandas.Series([450, 551, 700], dtype="Int64"), "DataArray": xarray.DataArray(NM, dims="wavelength", name="nm"),
    "coordinate": xarray.DataArray([1, 2, 3], {"w": NM}, "w").w, "units nm": xarray.DataArray(NM, dims="w", attrs={"units": "nm"}),
    "units um": xarray.DataArray(numpy.array(NM) / 1000, dims="w", attrs={"units": "um"}), "buffer": array.array("d", NM),
    "memoryview": memoryview(array.array("d", NM)), "tensor": Tensor(NM), "Decimal": [decimal.Decimal("450"), decimal.Decimal("551"), decimal.Decimal("700")],
    "Fraction": [fractions.Fraction(450), 551, 700], "keys": dict.fromkeys(NM).keys(), "quantity": Quantity(numpy.array(NM) / 1000, "um"),
    "quantities": [Quantity(nm, "nm") for nm in NM], "astropy": (numpy.array(NM) / 1000).view(AstroQuantity),
    "DataArray of a quantity": None,
}
del TAKEN["DataArray of a quantity"]

#: Value, and what its error says.
REFUSED = [
    (None, "not None|is needed"),
    (numpy.ma.array(NM, mask=[0, 1, 1]), "a masked array with 2 masked values, the first at index 1"),
    (numpy.ma.array([450, 551], mask=[1, 0]), "a masked array with 1 masked values"),
    (pandas.Series([450, None], dtype="Int64"), "1 of 2 values are nan or missing, the first at index 1"),
    ([450, float("nan")], "1 of 2 values are nan or missing"),
    ([450, None], "nan or missing, the first at index 1"),
    (numpy.ones((2, 3)), r"not a numpy.ndarray of shape \(2, 3\)"),
    (xarray.DataArray(numpy.ones((2, 3)), dims=("leaf", "wavelength")), "not an? xarray.DataArray of dimensions leaf, wavelength"),
    (xarray.Dataset({"R": ("w", NM)}), "xarray.Dataset of the variables R"),
    (pandas.DataFrame({"nm": NM, "R": NM}), "pandas.DataFrame of 3 rows and the columns nm, R"),
    (xarray.DataArray(NM, dims="w", attrs={"units": "degC"}), "\"units\" is 'degC': nm is needed"),
    (Quantity(numpy.array(NM), "second"), "Cannot convert from 'second' to 'nm'"),
    (Tensor(NM, "cuda:0"), "can't convert cuda:0 device type tensor"),
    (numpy.array([1 + 2j]), "complex128"), (1 + 2j, "complex"), ([1 + 2j], "complex"),
    (numpy.array([True]), "type bool"), (True, "True .bool"), ([551, True], "True .bool., at index 1"), (numpy.bool_(True), "bool"),
    (numpy.array(["2026-01-01"], "M8[D]"), "datetime64"), (datetime.date(2026, 1, 1), "datetime.date"),
    (numpy.array([(1, 2.0)], [("nm", "i4"), ("R", "f8")]), "nm"),
    ({"nm": 551}, "dict"), ({551, 608}, "set.*no order"), (b"551", "bytes"), (object(), "an object"), (int, "the type int"), (len, "builtin_function"),
    ([[450, 551], [600, 700]], "list"), ([numpy.ones(2)], "numpy.ndarray"), (["green"], "green"), (pathlib.Path("nm.csv"), "Path|nm.csv"),
]

TABLES = tempfile.TemporaryDirectory()
#: With a cache: a leaf of a scene is prepared once, not for each call.
SESSION = frond.Session(threads=1, cache=TABLES.name)
SMALL = {"rays": 100, "session": SESSION}


def wavelengths_of(table):
    return sorted(set(table["wavelength_nm"]))


@pytest.mark.parametrize("name", TAKEN)
def test_lists_of_numbers_are_taken(name):
    value = list(TAKEN[name]) if name in ("generator", "iterator") else TAKEN[name]
    again = (lambda: iter(value)) if name in ("generator", "iterator") else (lambda: value)
    assert wavelengths_of(frond.spectrophotometer("diffuse", again(), **SMALL)) == NM
    assert frond.bsdf("diffuse", again(), session=SESSION).wavelengths == NM
    assert list(frond.goniophotometer("diffuse", again(), 0, patches=(2, 2), **SMALL)["wavelength_nm"]) == NM
    channels = frond.loads(SCENE, wavelengths=again(), session=SESSION).render(1).channels
    assert [name for name in channels if name.startswith("S0.")] == ["S0.450,000000nm", "S0.551,000000nm", "S0.700,000000nm"]


@pytest.mark.parametrize("value, message", REFUSED, ids=[str(i) for i in range(len(REFUSED))])
def test_what_is_no_list_of_numbers_is_named(value, message):
    for call in (lambda: frond.spectrophotometer("diffuse", value, **SMALL), lambda: frond.bsdf("diffuse", value, session=SESSION),
                 lambda: frond.goniophotometer("diffuse", value, 0, **SMALL), lambda: frond.leaf_table("leaf_solved", value, session=SESSION)):
        with pytest.raises((TypeError, ValueError), match=message) as caught:
            call()
        assert "wavelengths" in str(caught.value)
    if value is not None and not isinstance(value, bytes):  # bytes are the text of a strategy
        with pytest.raises((TypeError, ValueError), match=message) as caught:
            frond.loads(SCENE, wavelengths=value, session=SESSION)
        assert "wavelengths" in str(caught.value)


def test_angles_have_their_own_unit():
    angles = xarray.DataArray([0.0, numpy.pi / 6], dims="view", attrs={"units": "rad"})
    assert frond.bsdf("diffuse", Quantity(numpy.array([0.36, 0.45]), "um"), session=SESSION).wavelengths == [360, 450]
    assert numpy.allclose(sorted(set(frond.spectrophotometer("diffuse", 551, angles, **SMALL)["theta_deg"])), [0, 30])
    with pytest.raises(ValueError, match="angles: .*Cannot convert from 'nm' to 'deg'; degrees is needed"):
        frond.spectrophotometer("diffuse", 551, Quantity(numpy.array([1.0]), "nm"), **SMALL)


def leaf_spectra():
    nm = numpy.arange(400.0, 800, 5)
    return nm, 0.05 + 0.4 / (1 + numpy.exp((710 - nm) / 10)), 0.02 + 0.45 / (1 + numpy.exp((710 - nm) / 10))


def test_spectra_of_labelled_and_masked_arrays():
    """A missing value is left out, whatever marks it; a masked value never is data."""
    nm, R, T = leaf_spectra()
    lost = numpy.zeros(len(nm), bool)
    lost[[3, 40]] = True
    holes = numpy.where(lost, numpy.nan, R)
    options = {"structure": "bifacial", "sieve": False, "session": SESSION}
    expected = frond.fit(nm, holes, T, **options)
    whole = frond.fit(nm, R, T, **options)
    assert expected.leaf != whole.leaf
    garbage = numpy.where(lost, 0.9, R)
    for masked in (numpy.ma.array(garbage, mask=lost), pandas.Series(garbage).mask(lost), pandas.Series(garbage).mask(lost).astype("Float64"),
                   xarray.DataArray(garbage, {"wl": nm}, "wl").where(~lost), [None if l else v for v, l in zip(R, lost)],
                   xarray.DataArray(100 * holes, {"wl": nm}, "wl", attrs={"units": "%"})):
        found = frond.fit(nm, masked, T, **options)
        for name, value in expected.leaf.items():
            assert found.leaf[name] == pytest.approx(value, rel=1e-6), type(masked)
    labelled = xarray.DataArray(R, {"wl": nm}, "wl")
    assert frond.fit(labelled.wl, labelled, xarray.DataArray(T, dims="wl"), **options).leaf == whole.leaf
    with pytest.raises(ValueError, match="wavelengths: a masked array with 2 masked values, the first at index 3"):
        frond.fit(numpy.ma.array(nm, mask=lost), R, T)
    with pytest.raises(ValueError, match="fit: 80 wavelengths have 79 R"):
        frond.fit(nm, R[1:], T)


def test_a_table_in_place_of_a_column_is_named():
    nm, R, T = leaf_spectra()
    table = pandas.DataFrame({"nm": nm, "R": R, "T": T})
    with pytest.raises(TypeError, match=r'T: one dimension is needed, not a pandas.DataFrame .*DataFrame.T is the transposed table: write table\["T"\]'):
        frond.fit(table.nm, table.R, table.T)
    with pytest.raises(TypeError, match="wavelengths: an array is needed, not a pandas.DataFrame .* a table is given as data="):
        frond.fit(table)
    with pytest.raises(TypeError, match="R: one dimension is needed, not an? xarray.DataArray of dimensions leaf, wl"):
        frond.fit(nm, xarray.DataArray([R, R], dims=("leaf", "wl")))
    with pytest.raises(TypeError, match="data: CSV as a text, or a table with named columns is needed, not a numpy.ndarray"):
        frond.fit(data=numpy.ones((3, 3)))
    with pytest.raises(ValueError, match="data: columns of one length are needed"):
        frond.fit(data={"nm": nm, "R": R[1:]})


def test_a_table_of_many_leaves():
    nm, R, T = leaf_spectra()
    leaves = xarray.Dataset({"R": (("leaf", "nm"), [R, 0.9 * R]), "T": (("leaf", "nm"), [T, T])}, {"leaf": ["a", "b"], "nm": nm})
    assert list(frond.fit(data=leaves, all_leaves=True, session=SESSION)["leaf"]) == ["a", "b"]


def test_images_of_arrays(tmp_path):
    rgb = numpy.arange(24.0).reshape(2, 4, 3) / 24
    path = tmp_path / "a.exr"
    for value in (rgb, rgb.astype("f4"), rgb.astype(">f4"), rgb[:, ::-1][:, ::-1], rgb.tolist(), Tensor(rgb), numpy.ma.array(rgb),
                  xarray.DataArray(rgb, dims=("y", "x", "c")), numpy.asfortranarray(rgb)):
        frond.write_image(path, value)
        assert numpy.allclose(frond.read_image(path)[1], rgb, atol=1e-3)
    for value, message in [(numpy.ma.array(rgb, mask=rgb > 0.5), "rgb: a masked array with 11 masked values"),
                           ((rgb * 255).astype("u1"), "rgb: linear colours are needed, in which 1 is white, not a numpy.ndarray .* uint8"),
                           (rgb + 1j, "rgb: an array of numbers is needed.*complex128"), (rgb > 0, "rgb: .*bool"), ("red", "rgb: "), (None, "rgb: "),
                           ({"R": 1}, "rgb: "), (rgb[:, :, :2], r"rgb: an array \[row\]\[column\]\[3\] is needed, not of shape \(2, 4, 2\)"),
                           (Tensor(rgb, "cuda:0"), "rgb: .*cuda:0"), ([[1, 2], [3]], "rgb: ")]:
        with pytest.raises((TypeError, ValueError), match=message):
            frond.write_image(path, value)


def test_directions_of_arrays():
    bsdf = frond.bsdf("diffuse", [551], session=SESSION)
    up = [0.0, 0.0, 1.0]
    for value in (up, numpy.array(up), numpy.array([up], ">f8"), xarray.DataArray([up], dims=("n", "xyz")), Tensor([up]), (0, 0, 1), numpy.array([0, 0, 1])):
        assert bsdf.f(value, up).shape == (1, 1)
    for value, message in [(numpy.ma.array(up, mask=[1, 0, 0]), "wo: a masked array with 1 masked"), ([0, 0, 1j], "wo: .*complex"), ("up", "wo: "), (None, "wo: "),
                           ([[0, 0], [0, 1]], r"wo: directions are an array \[n\]\[3\]"), (numpy.ones((2, 2, 3)), "wo: directions"), ([True, False, True], "wo: .*bool"), ([0, 0, "a"], "wo: ")]:
        with pytest.raises((TypeError, ValueError), match=message):
            bsdf.f(value, up)
    for seed in (-1, 2**64, 1.5, "1", None, True):
        with pytest.raises((TypeError, ValueError), match="seed: a whole number"):
            bsdf.f(up, up, seed=seed)


#: Wrong values for each kind of argument.
WRONG = {
    "flag": [1, 0, 1.0, b"yes", object(), [True], {}, numpy.ones(2)],
    "count": [True, "many", None.__class__, 1 + 2j, {}, {1}, object(), b"3", [3], numpy.array([3]), numpy.bool_(True)],
    "real": [True, "much", 1 + 2j, {}, {1}, object(), b"3", [3.0], numpy.array([3.0]), datetime.date(2026, 1, 1)],
    "numbers": [True, "few", 1 + 2j, {}, {1}, object(), b"3", [[3.0]], [None], ["few"]],
    "text": [3, 2.5, True, 1 + 2j, {}, {"a"}, object(), [3], numpy.arange(3), None.__class__],
    "texts": [3, 2.5, True, 1 + 2j, {"a"}, object(), [3], numpy.arange(3), [None]],
}
WRONG["seed"] = WRONG["count"]
#: Where numbers and flags have a meaning as text.
MEANT = {("text", "WAVELENGTHS"), ("text", "STOPS"), ("text", "KELVIN"), ("text", "R,G,B"), ("text", "THETAxPHI"), ("text", "FIRST:END"), ("text", "CSV")}
PARAMS = {f"{name}-{p['name']}": (name, p) for name, job in _records.JOBS.items() for p in job["params"]}


@pytest.mark.parametrize("name", PARAMS)
def test_a_wrong_type_is_named(name):
    """Each error has the keyword, and the type that was given, in words that a reader of Python knows."""
    job, param = PARAMS[name]
    keyword = _records.python_name(param["name"])
    for value in WRONG[param["kind"]]:
        if (param["kind"], param["type"]) in MEANT and not isinstance(value, (dict, set)) or value is True and param["implied"]:
            continue
        given = {keyword: value}
        if isinstance(value, str):
            with pytest.raises(frond.InputError, match=f'{keyword}: .* "{value}" was given'):
                frond._frond.check_arguments(job, _records.arguments(_records.JOBS[job]["params"], given))
            continue
        if isinstance(value, dict) and "=" in param["type"] + param["type"].replace("SWAP", "="):
            continue  # a mapping without items
        with pytest.raises((TypeError, ValueError)) as caught:
            frond._frond.check_arguments(job, _records.arguments(_records.JOBS[job]["params"], given))
        text = str(caught.value)
        assert text.startswith(f"{keyword}: "), text
        assert " needed" in text and "iterable" not in text and "fspath" not in text and "codec" not in text, text


@pytest.mark.parametrize("value", [numpy.str_("leaf_lambert"), Leaf.SIMPLE, b"leaf_lambert", ["leaf_lambert"], ("leaf_lambert", "specimen=maize"),
                                   numpy.array("leaf_lambert"), numpy.array(["leaf_lambert"]), pandas.Series(["leaf_lambert"])], ids=str)
def test_texts_of_other_types_are_taken(value):
    assert frond.loads(SCENE, swap={"*": value}, session=SESSION).materials[-1][1] == "leaf_lambert"
    if not isinstance(value, bytes):
        assert len(frond.spectrophotometer(value, 551, **SMALL)) == 1


def test_scalars_of_other_types_are_taken(tmp_path):
    for rays in (100, numpy.int64(100), numpy.uint8(100), numpy.array(100), 100.0, numpy.float64(100), "100", decimal.Decimal(100), pandas.Series([100])[0]):
        assert frond.spectrophotometer("diffuse", 551, rays=rays, session=SESSION)["R"][0] > 0
    for nm in (Band.GREEN, numpy.array(551), numpy.float32(551), xarray.DataArray(551), Quantity(0.551, "um")):
        assert wavelengths_of(frond.spectrophotometer("diffuse", nm, **SMALL)) == [551]
    for adaptive in (numpy.array(True),):
        assert frond.loads(SCENE, adaptive=adaptive, session=SESSION).render(32, max_rms=numpy.float32(0.5)).samples
    for strict in (numpy.bool_(False), False, None, numpy.array(False)):
        assert frond.loads(SCENE, strict=strict, session=SESSION)
    path = tmp_path / "scene.pbrt"
    path.write_text(SCENE)
    for name in (str(path), path, bytes(path), numpy.str_(path), memoryview(bytes(path))):
        assert frond.load(name, session=SESSION).width == 16
        assert frond.check(name).code == 0


def test_arguments_of_the_other_functions_are_named(tmp_path):
    scene = frond.loads(SCENE, session=SESSION)
    image = scene.render(1)
    for call, message in [
        (lambda: scene.render(max_rms="x"), "max_rms is for scenes"), (lambda: scene.render(time_limit="x"), "time_limit: a number is needed, not 'x' .str"),
        (lambda: scene.render(True), "samples: a whole number is needed, not True .bool"), (lambda: scene.render(numpy.ones(2)), "samples: .*shape"),
        (lambda: scene.render(1, progress=3), "progress: .* not 3 .int"), (lambda: frond.loads(SCENE, adaptive=1), "adaptive: True or False is needed, not 1 .int"),
        (lambda: frond.loads(5), "text: text is needed, not 5 .int"), (lambda: frond.loads(SCENE, 5), "folder: a path is needed, not 5 .int"),
        (lambda: frond.load(None), "path: a path is needed, not None"), (lambda: frond.load(["a.pbrt"]), "path: a path is needed, not .'a.pbrt'. .list"),
        (lambda: image.save(5), "path: a path is needed, not 5 .int"), (lambda: image.save_part(None), "path: a path is needed, not None"),
        (lambda: frond.read_image(image), "path: a path is needed, not a frond.Image"), (lambda: frond.write_image(tmp_path / "a.exr", numpy.ones((1, 1, 3)), like=5), "like: a path is needed"),
        (lambda: frond.write_image(tmp_path / "a.exr", numpy.ones((1, 1, 3)), color_space=5), "color_space: text is needed, not 5"),
        (lambda: frond.Session(threads="2"), "threads: a whole number is needed, not '2' .str"), (lambda: frond.Session(threads=True), "threads: .*bool"),
        (lambda: frond.Session(cache=5), "cache: a path is needed, not 5"), (lambda: frond.Session(plugins=5), "plugins: .*not 5"), (lambda: frond.Session(plugins=[5]), "plugins: a path is needed, not 5"),
        (lambda: frond.names(5), "kind: text is needed, not 5"), (lambda: frond.names(session=5), "session: a frond.Session is needed, not 5"),
        (lambda: frond.read_spectra(5), "path: a path"), (lambda: frond.read_spectra("a.csv", leaf=5), "leaf: text is needed"), (lambda: frond.read_spectra("a.csv", angle="x"), "angle: a number is needed"),
        (lambda: frond.leaf_table("leaf_solved", 551, tolerance="x"), "tolerance: a number is needed, not 'x'"), (lambda: frond.leaf_table("leaf_solved", 551, depths=1), "depths: .least, most. is needed"),
        (lambda: frond.leaf_table("leaf_solved", 551, depths=("a", "b")), "depths: a number is needed"), (lambda: frond.leaf_table(5, 551), "material: a text is needed, not 5"),
        (lambda: frond.register_material(5, None), "bsdf: an object of a subclass of frond.Bsdf is needed, not None"), (lambda: frond.conform({"a": 1}), "material: a text is needed"),
        (lambda: frond.goniophotometer("diffuse", 551, patches=5), "patches: "), (lambda: frond.goniophotometer("diffuse", 551, patches=("a", "b")), "patches: a whole number is needed, not 'a'"),
        (lambda: frond.fit(path=5), "path: a path is needed, not 5"), (lambda: frond.fit(file=5), "file: a path is needed, not 5"), (lambda: frond.fit(data=5), "data: CSV"),
        (lambda: frond.run(5), "there is no job 5"), (lambda: frond.check({"scene.pbrt"}), "scene: .*no order"), (lambda: frond.check({"a": "b"}), "scene: .*dict"),
        (lambda: frond.canopy(tmp_path / "a.npy", column={"chlorophylla": 3}), "column"),
    ]:
        with pytest.raises((TypeError, ValueError), match=message):
            call()
