"""Each command is defined once: its record is what every front end shows, checks and computes with."""

import inspect
import itertools
import os
import re
import subprocess
from pathlib import Path

import frond
import numpy
import pytest
from frond import _frond, _jobs, _records, _stubs

FROND = os.environ["FROND"]
ROOT = Path(__file__).resolve().parents[2]
JOBS = {name: job for name, job in _records.JOBS.items()}
PARAMS = [(name, param) for name, job in JOBS.items() for param in job["params"]]
IDS = [f"{name}-{param['name']}" for name, param in PARAMS]


def frond_command(*words, **more):
    return subprocess.run([FROND, *map(str, words)], capture_output=True, text=True, check=False, **more)


def one_line(text):
    return re.sub(r"\s+", " ", text)


def completed(*words):
    """What a shell offers for the last word."""
    return frond_command("completion", "bash", "--", "frond", *words).stdout.splitlines()


@pytest.fixture(scope="module")
def documents():
    def man(name):
        return frond_command("man", name).stdout.replace("\\-", "-").replace("\\(dq", '"').replace("\\(aq", "'").replace(
            "\\(ti", "~").replace("\\(ha", "^").replace("\\(ga", "`").replace("\\&", "").replace("\\e", "\\")
    return {
        "help": {name: one_line(frond_command(name, "--help").stdout) for name in JOBS},
        "man": {name: one_line(man(name)) for name in JOBS},
        "page": (ROOT / "docs/commands.md").read_text(encoding="utf-8"),
        "stub": (ROOT / "python/frond/__init__.pyi").read_text(encoding="utf-8"),
    }


def section(page, name):
    return page.split(f"### frond {name}\n")[1].split("\n### ")[0]


def own(name, param):
    """Not of the job that this one extends, which the page names in one line."""
    return not name.startswith("submit") or param["name"] in ("scene", "output", "spp", "paths", "tasks", "engine", "slurm", "run", "folder")


@pytest.mark.parametrize("name, param", PARAMS, ids=IDS)
def test_every_front_end_documents_every_parameter(name, param, documents):
    """With the same text, which has unit, range, choices and default."""
    option = param["name"] if param["positional"] else "--" + param["name"]
    text = one_line(param["doc"])
    assert option in documents["help"][name] and text in documents["help"][name]
    assert option in documents["man"][name] and text in documents["man"][name]
    if not param["positional"]:
        assert option in completed(name, "--")
    if param["choices"]:
        before = itertools.takewhile(lambda p: p != param, (p for p in JOBS[name]["params"] if p["positional"]))
        words = ["x" for _ in before] if param["positional"] else [option]
        assert set(param["choices"]) <= set(completed(name, *words, ""))
    if own(name, param):
        page = section(documents["page"], name).replace("\\|", "|")
        row = next(line for line in page.splitlines() if line.startswith("| `") and
                   re.search(rf"(?<![\w-]){re.escape(option)}(?![\w-])", line.split("|")[1]))
        for fact in (param["default"], param["unit"], *param["choices"]):
            assert fact in row
    name = _records.python_name(name)
    function = getattr(frond, name)
    keyword = _records.python_name(param["name"])
    parameters = inspect.signature(_jobs.FUNCTIONS[name]).parameters
    default = parameters[keyword].default
    expected = {"flag": False}.get(param["kind"], param["default"] or None)
    assert default is inspect.Parameter.empty or default == expected or str(default) == expected or float(default) == float(expected)
    assert f"{keyword}: {_jobs._doc(param['doc'])}" in _jobs.FUNCTIONS[name].__doc__
    assert function.__doc__
    assert re.search(rf"def {name}\(.*\b{keyword}\b", documents["stub"])


def test_the_stub_is_that_of_the_records(documents):
    assert documents["stub"] == _stubs.stub(), "run python -m frond._stubs > python/frond/__init__.pyi"


def bad_values(param):
    """Values that a record refuses by itself."""
    if param["choices"]:
        yield "no such choice"
    if param["kind"] in ("count", "seed", "real", "numbers"):
        yield from ("abc", "nan", "inf", "")
    if param["kind"] in ("count", "seed"):
        yield from ("1.5", "-1")
    range_of = re.search(r"Range: (?:from (\S+) to (\S+)\.|above 0)", param["doc"])
    if range_of and param["kind"] != "seed":
        yield "-1" if range_of[1] is None else repr(float(range_of[2]) * 2 + 1)


def good_values(job):
    """The least that a job needs."""
    return {p["name"]: p["choices"][0] if p["choices"] else {"count": "1", "numbers": "551", "flag": "true"}.get(p["kind"], "x")
            for p in job["params"] if p["required"]}


CASES = [(name, param, value) for name, param in PARAMS for value in bad_values(param)]


@pytest.mark.parametrize("name, param, value", CASES, ids=[f"{n}-{p['name']}-{v}" for n, p, v in CASES])
def test_bad_values_are_refused_alike(name, param, value):
    """By both front ends, in the same words but for the parameter's spelling; none is a signal."""
    given = good_values(JOBS[name]) | {param["name"]: value}
    count = 4 if name == "difference" else 1  # of its images
    words = []
    for p in JOBS[name]["params"]:
        if p["name"] in given and p["positional"]:
            words += [given[p["name"]]] * count
        elif p["name"] in given:
            words.append(f"--{p['name']}" if p["kind"] == "flag" else f"--{p['name']}={given[p['name']]}")
    done = frond_command(name, *words)
    assert done.returncode == 1 and done.stdout == ""
    if not value:  # CLI11 refuses "--name=" by itself
        assert f"--{param['name']}: " in done.stderr
        return
    session = frond.default_session()._session
    with pytest.raises(frond.InputError) as caught:
        _frond.run(session, name, {key: [text] * (count if key == "images" else 1) for key, text in given.items()}, None)
    of_python = str(caught.value)
    spelled = param["name"] if param["positional"] else "--" + param["name"]
    assert done.stderr == "frond: " + of_python.replace(_records.python_name(param["name"]) + ":", spelled + ":", 1) + "\n"
    assert " needed; " in of_python and f'"{value}"' in of_python


@pytest.mark.parametrize("name, given, message", [
    ("fit", {"file": "{leaf}", "fix": ["chlorophylla=-1"]}, "chlorophylla"),
    ("fit", {"file": "{leaf}", "fix": ["chlorophylla=nan"]}, "chlorophylla"),
    ("fit", {"file": "{leaf}", "fix": ["thickness=0"]}, "thickness"),
    ("fit", {"file": "{leaf}", "fix": ["clorophylla=1"]}, "did you mean"),
    ("fit", {"file": "{leaf}", "like": ["maize"], "structure": ["bifacial"]}, "unifacial"),
    ("fit", {"file": "{bad_reflectance}"}, "bad_reflectance.csv:3"),
    ("fit", {"file": "{bad_angle}"}, "bad_angle.csv:3"),
    ("brf", {"scene": "{scene}", "zenith": "95"}, "horizon"),
    ("brf", {"scene": "{scene}", "hemisphere": "true", "zenith": "10"}, "excludes"),
    ("brf", {"scene": "{scene}", "target": "1,0,0,1,0"}, "is empty"),
    ("flux", {"scene": "{scene}", "target": "1,0,0,1,0"}, "is empty"),
    ("render", {"scene": ["{scene}"], "swap": ["leaf"]}, "takes MATERIAL=PLUGIN"),
    ("render", {"scene": ["{scene}"], "samples": "4:2"}, "takes FIRST:END"),
    ("render", {"scene": ["{scene}"], "pixels": "30,40,0,1"}, "holds no pixel"),
    ("render", {"scene": ["{scene}"], "max-rms": "0.1", "samples": "0:4"}, "excludes"),
    ("conform", {"material": ["diffuse"], "angles": "95"}, "95"),
    ("conform", {"material": ["diffuse"], "samples": "10"}, "from 1000"),
    ("spectrophotometer", {"material": ["abm"], "wavelengths": "300"}, "from 360 to 2500"),
    ("spectrophotometer", {"material": ["abm"], "wavelengths": "551", "angles": "200"}, "200"),
])
def test_values_that_do_not_go_together_are_refused_alike(name, given, message, scene_text, tmp_path):
    files = {"scene": scene_text, "leaf": "nm,R,T\n550,0.1,0.1\n" * 1, "bad_reflectance": "nm,R\n550,0.1\n560,-1\n",
             "bad_angle": "nm,angle,R\n550,8,0.1\n560,200,0.1\n"}
    paths = {}
    for file, text in files.items():
        paths[file] = tmp_path / (file + (".pbrt" if file == "scene" else ".csv"))
        paths[file].write_text(text)
    texts = {key: [text.format(**paths) for text in ([value] if isinstance(value, str) else value)]
             for key, value in given.items()}
    words = []
    for param in JOBS[name]["params"]:
        for text in texts.get(param["name"], []):
            words.append(text if param["positional"] else "--" + param["name"] if param["kind"] == "flag" else f"--{param['name']}={text}")
    done = frond_command(name, *words, cwd=tmp_path)
    assert done.returncode == 1 and message in done.stderr
    with pytest.raises(frond.InputError) as caught:
        _frond.run(frond.default_session()._session, name, texts, None)
    normal = lambda text: re.sub(r"--|=(?= )|=$|[-_]", "", text)
    assert normal(done.stderr.strip().splitlines()[-1].removeprefix("frond: ")) == normal(str(caught.value))


#: A value for each parameter of render that decides its result, other than the default.
DECIDING = {"scene": None, "wavelengths": "smpte", "swap": "leaf=leaf_lambert", "seed": "7", "integrator": "path,maxdepth=2",
            "filter": "box", "channels": "normal", "for-denoiser": "true", "quick": "true", "color-space": "linear P3-D65",
            "disable-pixel-jitter": "true", "disable-texture-filtering": "true", "disable-wavelength-jitter": "true",
            "ignore-unsupported": "all"}
#: Those that do not: the samples and pixels of a part are in its coverage, not in its identity.
COVERAGE = {"spp", "crop", "pixels", "pixel", "samples", "max-rms", "time-limit"}
INDIFFERENT = {"threads": "1", "quiet": "true", "checkpoint": "0.05", "no-cache": "true", "strict": "true", "json": "statistics.json",
               "display-server": "127.0.0.1:9"}


def test_all_parameters_of_a_render_are_sorted():
    names = {p["name"] for p in JOBS["render"]["params"]}
    assert {p["name"] for p in JOBS["render"]["params"] if p["decides"]} == set(DECIDING)
    assert names - set(DECIDING) - COVERAGE - set(INDIFFERENT) == {
        "output", "part", "resume", "pilot", "display", "view", "exposure", "white-balance", "preview"}


@pytest.fixture(scope="module")
def part_of_scene(tmp_path_factory):
    folder = tmp_path_factory.mktemp("identity")
    from conftest import SCENE
    (folder / "scene.pbrt").write_text(SCENE)
    (folder / "cache").mkdir()

    def render(name, *words):
        return frond_command("render", "scene.pbrt", "--part", name, "--spp", "4", "--cache", "cache", *words, cwd=folder)

    assert render("base.part", "-q").returncode == 0
    return folder, render


def option(name, value):
    return f"--{name}" if value == "true" else f"--{name}={value}"


@pytest.mark.parametrize("name", [name for name, value in DECIDING.items() if value])
def test_what_decides_changes_the_identity(part_of_scene, name):
    folder, render = part_of_scene
    assert render(f"{name}.part", "-q", option(name, DECIDING[name])).returncode == 0
    merged = frond_command("merge", "base.part", f"{name}.part", "-o", "merged.exr", cwd=folder)
    assert merged.returncode == 1
    assert "these are not parts of the same render" in merged.stderr


@pytest.mark.parametrize("name", list(INDIFFERENT))
def test_what_does_not_decide_leaves_the_bytes(part_of_scene, name):
    folder, render = part_of_scene
    image = lambda file, *more: frond_command("render", "scene.pbrt", "-o", file, "--spp", "4", "--cache", "cache", *more,
                                              cwd=folder, env=os.environ | {"SOURCE_DATE_EPOCH": "0"})
    assert image("base.exr", "-q").returncode == 0
    done = image(f"{name}.exr", option(name, INDIFFERENT[name]))
    assert done.returncode == 0, done.stderr
    assert (folder / "base.exr").read_bytes() == (folder / f"{name}.exr").read_bytes()


def test_an_open_leaf_is_the_same_image_from_both(scene_text, tmp_path):
    text = scene_text.replace('"leaf_solved"', '"leaf" "float maxrms" 0.05')
    (tmp_path / "scene.pbrt").write_text(text)
    session = frond.Session(cache=tmp_path / "cache")
    image = frond.load(tmp_path / "scene.pbrt", session=session).render(4)
    image.save(tmp_path / "module.exr")
    done = frond_command("render", "scene.pbrt", "--spp", "4", "-o", "command.exr", "--cache", "cache", cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    (names, ours), (others, theirs) = (frond.read_image(tmp_path / f"{name}.exr") for name in ("module", "command"))
    assert names == others and numpy.array_equal(ours, theirs)
    assert image.color_space == "linear sRGB"


def test_parts_of_both_are_of_one_render(scene_text, tmp_path):
    (tmp_path / "scene.pbrt").write_text(scene_text)
    half = frond.load(tmp_path / "scene.pbrt", swap="leaf_lambert", seed=5).render(4)
    half.save_part(tmp_path / "python.part")
    common = ("--swap", "*=leaf_lambert", "--seed", "5", "-q")
    for words in (("--samples", "4:8", "--part", "command.part"), ("--spp", "8", "-o", "whole.exr")):
        assert frond_command("render", "scene.pbrt", *common, *words, cwd=tmp_path).returncode == 0
    merged = frond_command("merge", "python.part", "command.part", "-o", "merged.exr", "-q", cwd=tmp_path)
    assert merged.returncode == 0, merged.stderr
    (_, ours), (_, theirs) = (frond.read_image(tmp_path / f"{name}.exr") for name in ("merged", "whole"))
    assert numpy.array_equal(ours, theirs)


@pytest.mark.parametrize("name, given", [
    ("brf", {"scene": "scene.pbrt", "zenith": [0, 30], "wavelengths": [551, 800], "paths": 2048, "seed": 3, "period": (2, 2)}),
    ("flux", {"scene": "scene.pbrt", "wavelengths": [551], "paths": 65536, "seed": 3, "period": (2, 2)}),
    ("structure", {"scene": "scene.pbrt", "zenith": [0, 30], "rays": 4096, "seed": 3, "period": (2, 2)}),
    ("spectrophotometer", {"material": "leaf_solved,specimen=maize", "wavelengths": [551, 800], "angles": [8, 172], "rays": 20000}),
    ("goniophotometer", {"material": "abm", "wavelengths": 551, "rays": 20000, "patches": "4x6"}),
    ("fit", {"file": "leaf.csv", "structure": "bifacial", "sieve": "off"}),
])
def test_tables_are_the_same_from_both(name, given, scene_text, reference, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    sky = 'LightSource "infinite"'
    (tmp_path / "scene.pbrt").write_text(scene_text if sky in scene_text else scene_text)
    (tmp_path / "leaf.csv").write_text((reference / "lopex93_soybean.csv").read_text())
    result = frond.run(name, csv="python.csv", json="python.json", **given)
    words = []
    for param in JOBS[name]["params"]:
        if (value := given.get(_records.python_name(param["name"]))) is not None:
            for text in _records.words(param, value):
                words.append(text if param["positional"] else f"--{param['name']}={text}")
    done = frond_command(name, *words, "--csv", "command.csv", "--json", "command.json", "-q")
    assert done.returncode == 0, done.stderr
    for kind in ("csv", "json"):
        assert Path(f"python.{kind}").read_bytes() == Path(f"command.{kind}").read_bytes()
    assert len(result.table) > 0


def test_records_are_whole():
    for name, param in itertools.chain(PARAMS, (("session", p) for p in _frond.session_params())):
        assert param["doc"][0].isupper() or param["doc"][0] in "x\"$" or "[" in param["doc"], (name, param["name"])
        assert param["name"] == param["name"].lower() and "_" not in param["name"]


def test_a_keyword_and_its_alias_are_not_both_given():
    with pytest.raises(TypeError, match="angles is given twice"):
        frond.bench("lambert", angle=0, angles=[0, 45])


def test_commands_are_functions(scene_text, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    Path("scene.pbrt").write_text(scene_text)
    assert frond.check("scene.pbrt").text == "scene.pbrt: no errors\n"
    assert "thickness" in frond.describe(name="abm").text and "leaf_solved" in frond.list().text
    for part, samples in (("a.part", "0:2"), ("b.part", "2:4")):
        frond.render("scene.pbrt", part=part, samples=samples, seed=1)
    frond.merge(["a.part", "b.part"], output="merged.exr")
    found = frond.render(["scene.pbrt"], output="whole.exr", spp=4, seed=1)
    assert list(found.table["samples_per_pixel"]) == [4]
    (_, ours), (_, theirs) = (frond.read_image(f"{name}.exr") for name in ("merged", "whole"))
    assert numpy.array_equal(ours, theirs)
    frond.canopy(output="leaves.npy", count=10, size=(1, 1), scale=0.1)
    assert Path("leaves.npy").exists()
    frond.submit("scene.pbrt", output="out.exr", spp=4, tasks=2, engine="slurm", wavelengths="smpte", session=frond.Session(cache="tables"))
    assert f"--wavelengths smpte --cache {tmp_path}/tables" in Path("out.exr.slurm/render.sbatch").read_text()


def test_a_command_that_is_a_word_of_python_has_an_underscore(tmp_path):
    model = tmp_path / "plant.obj"
    model.write_text("v 0 0 0\nv 1 0 0\nv 1 0 1\nusemtl leaf.1\nf 1 2 3\n")
    found = frond.import_(model, tmp_path / "plant.pbrt", leaf={"leaf*": "leaf_lambert,specimen=maize"}, up="z", unit="cm")
    assert list(found.table["type"]) == ["leaf_lambert"] and found.facts["height"] == pytest.approx(0.01)
    assert frond.load(tmp_path / "plant.pbrt", swap="leaf_solved")
