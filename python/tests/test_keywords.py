"""Every keyword of every function of the module works: it reaches the command, whose record accepts it. Values are made from the
records, so that a new option is tested too. After reports of keywords of a signature that ended with a TypeError (`data=` of fit)."""

import inspect
import re
import tempfile
from pathlib import Path

import frond
import numpy
import pytest
from conftest import SCENE
from frond import _frond, _records

JOBS = _records.JOBS

#: A valid value for each type of a text.
TEXTS = {
    "SCENE": "scene.pbrt", "FILE": "some.exr", "FOLDER": "folder", "CHART": "chart.svg", "ANGLES": "ellipsoidal,mean=60", "WAVELENGTHS": [450, 550], "SWAP": {"*": "leaf_lambert"},
    "INTEGRATOR": "path,maxdepth=2", "FILTER": "box", "CHANNELS": ["normal", "depth"], "KINDS": True, "STOPS": 1, "KELVIN": 5500,
    "HOST:PORT": "127.0.0.1:9", "FIRST:END": (0, 2), "MATERIAL": "leaf_lambert", "MATERIAL|SCENE": "leaf_lambert", "FILE|FOLDER": "out.csv",
    "R,G,B": (0.01, 0.01, 0.02), "NAME": "leaf", "CSV": {"nm": [500, 510], "R": [0.1, 0.2]}, "LEAF": "a", "NAME=NUMBER": {"thickness": 1e-4},
    "THETAxPHI": (4, 6), "PLUGIN": "abm", "SPECTRUM": "solar-am1.5-direct", "NAME=LEAST:MOST": {"chlorophylla": (2, 5)},
    "UNIT": "cm", "AXIS": "z", "BANDS": "par,blue=400:500"}
#: Values for parameters that have no type, or whose type is not enough.
OWN = {"display": "sRGB", "view": "Raw", "color-space": "linear sRGB", "scale": 0.5, "max-rms": "2%", "images": ["a.exr", "b.exr", "c.exr", "d.exr"],
       "parts": ["a.part", "b.part"], "crop": (0, 0.5, 0, 1), "lanes": [1, 2], "heights": (0, 1), "depths": (1, 2), "model": "plant.obj",
       "min-time": 0.01, "emission": [690, 740]}
NUMBERS = {1: [30], 2: (1, 2), 3: (650, 550, 450), 4: (0, 2, 0, 2), 5: (0, 1, 0, 1, 0)}


def value_of(param):
    """Returns a valid value that is not the default."""
    kind, name = param["kind"], param["name"]
    if name in OWN:
        return OWN[name]
    if param["choices"]:
        return param["choices"][-1]
    if kind == "flag":
        return True
    if kind in ("count", "seed"):
        if param["default"]:
            return int(float(param["default"])) + 1
        return max(int(float(re.search(r"Range: from (\S+)", param["doc"] or "Range: from 1")[1])), 4) if "Range: from" in param["doc"] else 4
    if kind == "real":
        return float(param["default"] or 0.5)
    if kind == "numbers":
        count = len(param["type"].split(",")) if "," in param["type"] else 0
        return numpy.asarray(NUMBERS[count]) if count else [0.5] if param["type"] == "NUMBER" else [551, 600] if param["unit"] == "nm" else [0, 30]
    assert param["type"] in TEXTS, f"a valid value for a text of type {param['type']} is missing here"
    return TEXTS[param["type"]]


class Captured(Exception):
    """What a function hands to its command."""


@pytest.fixture
def capture(monkeypatch):
    def run(session, job, arguments, progress, scenes=None):
        raise Captured(job, arguments)
    monkeypatch.setattr(_frond, "run", run)


def given_of(job, name):
    """Returns the required keywords of a job, those that `name` needs, and `name`."""
    params = {p["name"]: p for p in job["params"]}
    chosen = {n for n, p in params.items() if p["required"]} | {name}
    for needed in re.findall(r"Needs --([a-z-]+)", params[name]["doc"]):
        chosen.add(needed)
    return {_records.python_name(n): value_of(params[n]) for n in chosen}


CASES = [(name, param) for name, job in JOBS.items() for param in job["params"]]


@pytest.mark.parametrize("name, param", CASES, ids=[f"{name}-{param['name']}" for name, param in CASES])
def test_each_keyword_reaches_its_command(name, param, capture, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    given = given_of(JOBS[name], param["name"])
    keyword = _records.python_name(param["name"])
    if name == "fit" and keyword not in ("file", "data"):
        given |= {"wavelengths": [500, 510], "R": [0.1, 0.2]}
    with pytest.raises(Captured) as caught:
        getattr(frond, _records.python_name(name))(**given)
    job, arguments = caught.value.args
    expected = _records.words(param, given[keyword])
    if name == "goniophotometer" and keyword == "wavelengths":
        expected = [",".join(repr(float(v)) for v in given[keyword])]
    assert job == name and arguments[param["name"]] == expected
    _frond.check_arguments(name, arguments)  # raises InputError for what the record refuses


@pytest.mark.parametrize("name, param", [c for c in CASES if c[1]["aliases"]], ids=[f"{n}-{p['name']}" for n, p in CASES if p["aliases"]])
def test_each_other_name_of_a_keyword_too(name, param, capture):
    for alias in (alias for alias in param["aliases"].split(",") if len(alias) > 1):
        given = given_of(JOBS[name], param["name"])
        given[_records.python_name(alias)] = given.pop(_records.python_name(param["name"]))
        with pytest.raises(Captured) as caught:
            getattr(frond, _records.python_name(name))(**given)
        assert param["name"] in caught.value.args[1]


@pytest.mark.parametrize("name", JOBS)
def test_signatures_name_what_is_taken(name, capture):
    function = getattr(frond, _records.python_name(name))
    parameters = inspect.signature(function).parameters
    assert {_records.python_name(p["name"]) for p in JOBS[name]["params"]} <= set(parameters)
    assert {"progress", "session"} <= set(parameters)
    with pytest.raises(TypeError, match="no_such_keyword"):
        function(**given_of(JOBS[name], JOBS[name]["params"][0]["name"]), no_such_keyword=1)


@pytest.mark.parametrize("name", [name for name in JOBS if name not in ("list", "completion", "man")])
def test_none_is_not_given(name, capture):
    """None for every keyword that may be left out is the same as to leave it out."""
    job = JOBS[name]
    required = {_records.python_name(p["name"]): value_of(p) for p in job["params"] if p["required"]}
    if name == "fit":
        required = {"file": "leaf.csv"}
    everything = {_records.python_name(p["name"]): None for p in job["params"]} | required
    found = []
    for given in (required, everything):
        try:
            getattr(frond, _records.python_name(name))(**given)
        except Captured as captured:
            found.append(captured.args)
    assert len(found) == 2
    defaults = {p["name"]: [p["default"]] for p in job["params"] if p["default"]}
    strip = lambda given: {n: w for n, w in given.items() if numpy.all([x == y for x, y in zip(w, defaults.get(n, [None]))]) == False}
    assert strip(found[0][1]).keys() <= found[1][1].keys() | required.keys()


#: Keywords of `load`, with a value that differs from the default.
LOADING = [p for p in JOBS["render"]["params"] if p["name"] not in frond._session._NOT_OF_LOADING]


@pytest.mark.parametrize("param", LOADING, ids=[p["name"] for p in LOADING])
def test_each_keyword_of_load(param):
    value = (0, 3) if param["name"] == "pixel" else value_of(param)
    scene = frond.loads(SCENE, **{_records.python_name(param["name"]): value, "session": SESSION})
    assert scene.render(2).array.size > 0


TABLES = tempfile.TemporaryDirectory()
#: With a cache: a leaf of a scene is prepared once, not for each call.
SESSION = frond.Session(threads=1, cache=TABLES.name)


def test_keywords_of_load_that_are_none():
    for name in ("max_rms", "output", "checkpoint", "exposure"):
        with pytest.raises(TypeError, match=f"load.. got an unexpected keyword argument '{name}': it is one of frond.render"):
            frond.loads(SCENE, **{name: 1})
    with pytest.raises(TypeError, match="unexpected keyword argument 'bogus'$"):
        frond.loads(SCENE, bogus=1)
    with pytest.raises(TypeError, match="samples and spp are two names"):
        frond.loads(SCENE, samples=1, spp=2)
    assert frond.loads(SCENE, samples=3).samples == frond.loads(SCENE, spp=3).samples == 3
    with pytest.raises(ValueError, match="samples: a whole number from 1 on is needed, not 0"):
        frond.loads(SCENE, samples=0)


def test_instruments_take_all_keywords_at_once(tmp_path, monkeypatch):
    """With results: of a second material, of patches as text, of one number and of names of options."""
    monkeypatch.chdir(tmp_path)
    table = frond.spectrophotometer("diffuse", wavelength=[500, 551], angle=30, with_="leaf_lambert", rays=100, seed=3, csv="a.csv", json="a.json",
                                    plot="a.svg", session=SESSION)
    assert len(table) == 4 and all(Path(f"a.{kind}").exists() for kind in ("csv", "json", "svg"))
    one = frond.goniophotometer("diffuse", "500,551", 30, patches="4x6", rays=1000, session=SESSION)
    two = frond.goniophotometer("diffuse", [500, 551], angles=[30], with_=["leaf_lambert"], patches=(4, 6), rays=1000, session=SESSION)
    assert one["f"].shape == (1, 2, 4, 6) and two["f"].shape == (2, 1, 2, 4, 6)
    assert numpy.array_equal(one["f"], two["f"][0]) and two["theta_o_deg"].shape == (4, 6)


def test_fit_reads_absorptance_and_states_no_error_of_what_is_missing(reference):
    table = frond.read_spectra(reference / "lopex93_soybean.csv")
    fitted = {"structure": "bifacial", "sieve": False}
    both = frond.fit(table["wavelength_nm"], table["R"], table["T"], **fitted)
    given = {"wavelength_nm": table["wavelength_nm"], "R": table["R"], "A": 1 - table["R"] - table["T"]}
    assert frond.fit(data=given, **fitted).leaf == pytest.approx(both.leaf, rel=1e-6)
    assert both.result.facts["rmse_T"] > 0
    assert numpy.isnan(frond.fit(table["wavelength_nm"], table["R"], **fitted).result.facts["rmse_T"])


def test_fit_takes_its_keywords(tmp_path, reference):
    path = reference / "lopex93_soybean.csv"
    fitted = {"structure": "bifacial", "sieve": False}
    expected = frond.fit(path=path, **fitted)
    table = frond.read_spectra(path)
    text = path.read_text(encoding="utf-8")
    for source in ({"file": path}, {"data": text}, {"data": table[["wavelength_nm", "R", "T"]]},
                   {"data": {"wavelength_nm": table["wavelength_nm"], "R": table["R"], "T": table["T"]}},
                   {"data": table.set_index("wavelength_nm")[["R", "T"]]},
                   {"data": table.set_index("wavelength_nm")[["R", "T"]].to_xarray()},
                   {"data": table[["wavelength_nm", "R", "T"]].to_records(index=False)}):
        assert frond.fit(**source, **fitted).leaf == expected.leaf, source.keys()
    for wrong, message in [({}, "it needs wavelengths"), ({"R": [0.1]}, "R and T need wavelengths"),
                           ({"file": path, "path": path}, "path and file are given"), ({"file": path, "R": [0.1]}, "file has its own")]:
        with pytest.raises(ValueError, match=message):
            frond.fit(**wrong)
