"""Commands take a frond.Scene in place of a file, and give the same result. After a question about plant canopies: frond.flux and
frond.brf of a scene that was loaded, with changes, ended with "'Scene' object is not iterable" (docs/python.md has both)."""

import os
from pathlib import Path

import frond
import numpy
import pytest

CANOPY = """
Option "float period" [ 1 1 ]
Camera "orthographic" "float screenwindow" [ -1 1 -1 1 ]
Film "rgb" "integer xresolution" 12 "integer yresolution" 8
Sampler "lattice" "integer pixelsamples" 4
WorldBegin
LightSource "distant" "point3 from" [ -0.5 0 0.866025 ] "point3 to" [ 0 0 0 ] "spectrum L" "solar-am1.5-direct"
MakeNamedMaterial "soil" "string type" "diffuse" "spectrum reflectance" "soil.spd"
NamedMaterial "soil"
Shape "bilinearmesh" "point3 P" [ 0 0 0  1 0 0  0 1 0  1 1 0 ]
MakeNamedMaterial "leaf" "string type" "leaf_lambert"
NamedMaterial "leaf"
ObjectBegin "leaf"
  Shape "disk" "float radius" 1
ObjectEnd
Shape "instances" "string object" "leaf" "string filename" "leaves.npy"
"""
SOIL = "300 0.1\n2500 0.3\n"
BANDS = "400:700:50"


@pytest.fixture
def folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    frond.canopy("leaves.npy", lai=1, scale=0.1, size=(1, 1), heights=(0.1, 1), seed=4)
    Path("soil.spd").write_text(SOIL)
    Path("canopy.pbrt").write_text(CANOPY)
    return tmp_path


def assert_equal(found, expected):
    assert list(found.columns) == list(expected.columns) and len(found) == len(expected)
    for name in found.columns:
        if found[name].dtype.kind == "f":
            assert numpy.array_equal(found[name], expected[name], equal_nan=True), name
        else:
            assert list(found[name]) == list(expected[name]), name


def loaded(how, **over):
    return frond.load("canopy.pbrt", **over) if how == "file" else frond.loads(CANOPY, **over)


#: Keywords of a measurement that a scene can be loaded with.
EDITS = [
    {},
    {"swap": {"soil": "diffuse,reflectance=0.6"}},
    {"swap": "leaf_lambert,specimen=maize", "seed": 7},
    {"integrator": "path,maxdepth=1"},
    {"swap": {"soil": "diffuse,reflectance=0.6", "*": "leaf_lambert,specimen=maize"}, "wavelengths": [450, 650]},
]


@pytest.mark.parametrize("how", ["file", "text"])
@pytest.mark.parametrize("edit", [edit for edit in EDITS if "integrator" not in edit], ids=str)
def test_flux_of_a_scene_is_that_of_its_file(folder, how, edit):
    expected = frond.flux("canopy.pbrt", **{"wavelengths": BANDS, **edit}, paths=2000)
    found = frond.flux(loaded(how, **edit), **({} if "wavelengths" in edit else {"wavelengths": BANDS}), paths=2000)
    assert_equal(found, expected)


@pytest.mark.parametrize("how", ["file", "text"])
@pytest.mark.parametrize("edit", EDITS, ids=str)
def test_brf_of_a_scene_is_that_of_its_file(folder, how, edit):
    measured = {"zenith": [0, 40], "paths": 320}
    assert_equal(frond.brf(loaded(how, **edit), **measured), frond.brf("canopy.pbrt", **edit, **measured))


def test_the_edits_have_an_effect(folder):
    """Otherwise the tests above compare nothing."""
    tables = [frond.brf("canopy.pbrt", **edit, zenith=[0, 40], paths=320) for edit in EDITS]
    factors = [tuple(table["brf"]) for table in tables]
    assert len(set(factors)) == len(factors)


def test_a_day_in_steps_without_files(folder):
    """A scene for each step of a day, from a text alone."""
    absorbed = []
    for zenith in (0.2, 0.9):
        light = f'"point3 from" [ {numpy.sin(zenith)} 0 {numpy.cos(zenith)} ]'
        scene = frond.loads(CANOPY.replace('"point3 from" [ -0.5 0 0.866025 ]', light))
        table = frond.flux(scene, BANDS, paths=4000)
        rows = table[(table["quantity"] == "absorbed") & (table["material"] == "leaf")]
        absorbed.append(rows["share"].iloc[0])
    assert absorbed[1] > absorbed[0] + 0.05  # a low sun meets more leaves


def test_a_keyword_of_the_call_replaces_that_of_the_scene(folder):
    scene = frond.load("canopy.pbrt", seed=7, wavelengths=[450], swap={"soil": "diffuse,reflectance=0.6", "leaf": "leaf_lambert"})
    found = frond.flux(scene, [550], seed=8, swap={"soil": "diffuse,reflectance=0.9"}, paths=2000)
    expected = frond.flux("canopy.pbrt", [550], seed=8, paths=2000,
                          swap={"leaf": "leaf_lambert", "soil": "diffuse,reflectance=0.9"})
    assert_equal(found, expected)


def test_wavelengths_of_colours_are_none_of_a_measurement(folder):
    scene = frond.load("canopy.pbrt", wavelengths="smpte")
    assert_equal(frond.flux(scene, paths=2000), frond.flux("canopy.pbrt", paths=2000))
    with pytest.raises(frond.InputError, match="is for images of colours"):
        frond.flux(scene, wavelengths="hero", paths=2000)


def test_flux_by_instance(folder):
    table, leaves = frond.flux(frond.load("canopy.pbrt"), BANDS, by="instance", paths=2000)
    of_file, others = frond.flux("canopy.pbrt", BANDS, by="instance", paths=2000)
    assert_equal(table, of_file)
    assert_equal(leaves, others)


@pytest.mark.parametrize("edit", [
    {"samples": 3}, {"quick": True}, {"pixels": (1, 5, 2, 6)}, {"crop": (0, 0.5, 0, 1)}, {"channels": ["normal"]},
    {"wavelengths": "smpte", "swap": {"*": "leaf_lambert,specimen=maize"}}, {"filter": "box"}, {"disable_pixel_jitter": True},
    {"wavelengths": [450, 650]}, {"for_denoiser": True}], ids=str)
def test_render_of_a_scene(folder, edit):
    """The command, with the keywords that the scene was loaded with."""
    given = {"spp" if name == "samples" else name: value for name, value in edit.items()}
    frond.render("canopy.pbrt", output="file.exr", **given)
    for how in ("file", "text"):
        frond.render(loaded(how, **edit), output=f"{how}.memory.exr")
        (names, ours), (others, theirs) = frond.read_image(f"{how}.memory.exr"), frond.read_image("file.exr")
        assert names == others and numpy.array_equal(ours, theirs, equal_nan=True)
    image = loaded("file", **edit).render()
    assert numpy.allclose(image.array[:, :, [image.channels.index(name) for name in names]], theirs, rtol=1e-3, atol=1e-5)


def test_a_crop_of_the_call_replaces_that_of_the_scene(folder):
    scene = frond.load("canopy.pbrt", pixels=(1, 5, 2, 6))
    frond.render(scene, output="crop.exr", crop=(0, 0.5, 0, 1))
    assert frond.read_image("crop.exr")[1].shape[:2] == (8, 6)


def test_parts_of_a_file_and_of_a_scene_are_of_one_render(folder):
    over = {"swap": {"*": "leaf_lambert,specimen=maize"}, "seed": 3}
    frond.render("canopy.pbrt", part="a.part", samples="0:2", **over)
    frond.render(frond.load("canopy.pbrt", **over), part="b.part", samples="2:4")
    frond.merge(["a.part", "b.part"], "merged.exr")
    frond.render("canopy.pbrt", "whole.exr", 4, **over)
    assert numpy.array_equal(frond.read_image("merged.exr")[1], frond.read_image("whole.exr")[1])


@pytest.mark.parametrize("edit", [{}, {"swap": {"soil": "diffuse,reflectance=0.6"}}, {"wavelengths": "smpte"}, {"pixels": (2, 10, 1, 5)}],
                         ids=str)
def test_compare_of_a_scene(folder, edit):
    small = {"size": 8, "spp": 4, "reference_spp": 8, "reference": "leaf_lambert,specimen=maize", "materials": ["leaf_lambert"]}
    if "pixels" in edit:  # which the command has no keyword for: the film's
        Path("edited.pbrt").write_text(CANOPY.replace('"rgb"', '"rgb" "integer pixelbounds" [ 2 10 1 5 ]'))
        expected = frond.compare("edited.pbrt", **small)
    elif "swap" in edit:
        Path("edited.pbrt").write_text(CANOPY.replace('"diffuse" "spectrum reflectance" "soil.spd"', '"diffuse" "spectrum reflectance" [ 300 0.6 2500 0.6 ]'))
        expected = frond.compare("edited.pbrt", **small)
    else:
        expected = frond.compare("canopy.pbrt", **small, **edit)
    found = frond.compare(frond.load("canopy.pbrt", **edit), **small)
    for name in (name for name in expected.columns if name.startswith("rms")):
        assert numpy.allclose(found[name], expected[name], rtol=1e-5, equal_nan=True), name
    assert any(name.startswith("rms") for name in expected.columns)


def test_export_of_a_scene(folder):
    plain = CANOPY.replace('Option "float period" [ 1 1 ]\n', "")
    Path("plain.pbrt").write_text(plain)
    over = {"swap": {"soil": "diffuse,reflectance=0.6", "*": "leaf_lambert,specimen=maize"}}
    frond.export("plain.pbrt", "mitsuba", "of_file", wavelengths=551, **over)
    frond.export(frond.load("plain.pbrt", **over), "mitsuba", "of_scene", wavelengths=551)
    frond.export(frond.load("plain.pbrt", pixels=(1, 5, 2, 6), samples=9, wavelengths=[551], **over), "mitsuba", "of_crop")
    text = [Path(name, "scene.xml").read_text() for name in ("of_file", "of_scene", "of_crop")]
    assert text[0] == text[1]
    assert '"crop_width" value="4"' in text[2] and '"sample_count" value="9"' in text[2]
    with pytest.raises(frond.InputError, match="format csv takes a material, not a scene"):
        frond.export(frond.load("plain.pbrt"), "csv", "e.csv", wavelengths=551, angles=0)


def test_check_of_scenes(folder):
    scene = frond.load("canopy.pbrt", swap={"soil": "diffuse,reflectance=0.6"})
    found = frond.check([scene, "canopy.pbrt", frond.loads(CANOPY)])
    assert found.text.count("no errors") == 3 and found.code == 0
    assert "<string>: no errors" in found.text
    assert frond.check(scene).text == "canopy.pbrt: no errors\n"
    os.remove("leaves.npy")
    assert "leaves.npy" in frond.check("canopy.pbrt").table["problem"][0]
    assert "has changed" in frond.check([scene, "canopy.pbrt"]).table["problem"][0]


def test_the_scene_file_itself_is_not_read_again(folder):
    scene = frond.load("canopy.pbrt")
    expected = frond.flux("canopy.pbrt", paths=2000)
    os.remove("canopy.pbrt")
    assert_equal(frond.flux(scene, paths=2000), expected)


def test_a_file_that_has_changed_is_named(folder):
    """Instance tables, meshes and spectra are read again: other content would be another scene, without a message."""
    scene = frond.load("canopy.pbrt")
    Path("soil.spd").write_text("300 0.5\n2500 0.5\n\n")
    with pytest.raises(frond.InputError, match='soil.spd" has changed since the scene "canopy.pbrt" was loaded: load it again'):
        frond.flux(scene, paths=2000)
    os.remove("soil.spd")
    with pytest.raises(frond.InputError, match="soil.spd"):
        frond.brf(scene, paths=320)


def test_files_of_a_text_are_found_from_its_folder(folder, monkeypatch):
    scene = frond.loads(CANOPY, folder)
    expected = frond.flux("canopy.pbrt", paths=2000)
    (folder / "elsewhere").mkdir()
    monkeypatch.chdir(folder / "elsewhere")
    assert_equal(frond.flux(scene, paths=2000), expected)


def test_an_open_leaf_is_that_of_the_file(folder):
    Path("open.pbrt").write_text(CANOPY.replace('"leaf_lambert"', '"leaf"').replace('Option "float period" [ 1 1 ]\n', ""))
    session = frond.Session(cache=folder / "cache")
    scene = frond.load("open.pbrt", session=session)
    assert scene.choice
    assert_equal(frond.flux(scene, [550], paths=1000), frond.flux("open.pbrt", [550], paths=1000, session=session))


def test_the_session_is_that_of_the_scene(folder):
    class Paper(frond.Bsdf):
        reciprocal = True

        def f(self, wo, wi, nm):
            return 0.2 if wo[2] * wi[2] > 0 else 0.05

    session = frond.Session(threads=1, cache=False)
    frond.register_material("paper", Paper(), session=session)
    text = CANOPY.replace('"diffuse" "spectrum reflectance" "soil.spd"', '"paper"')
    table = frond.flux(frond.loads(text, session=session), [550], paths=200)
    assert len(table) > 0


def test_what_takes_a_path_says_so(folder):
    scene, image = frond.load("canopy.pbrt"), frond.load("canopy.pbrt").render(1)
    for call, message in [
        (lambda: frond.submit(scene, "o.exr", 4, tasks=2, engine="slurm"), "scene: a path is needed, not a frond.Scene; its tasks read"),
        (lambda: frond.render([scene, scene]), "a scene in memory is rendered alone"),
        (lambda: frond.render(image), "scene: .* not a frond.Image"),
        (lambda: frond.flux(image), "scene: .* not a frond.Image"),
        (lambda: frond.flux([scene, scene]), "scene: .* not a frond.Scene"),
        (lambda: frond.load(scene), "path: a path is needed, not a frond.Scene"),
        (lambda: frond.load(image), "path: a path is needed, not a frond.Image"),
        (lambda: frond.loads(scene), "text: text is needed, not a frond.Scene"),
        (lambda: frond.convert(scene, "o.png"), "images: .* not a frond.Scene"),
        (lambda: frond.describe(scene), "name: .* not a frond.Scene"),
        (lambda: frond.spectrophotometer(scene, 551), "material: .* not a frond.Scene"),
        (lambda: frond.flux("canopy.pbrt", irradiance=scene), "irradiance: .* not a frond.Scene"),
        (lambda: frond.flux([450, 550], scene), "wavelengths: a value is needed, not a frond.Scene"),
        (lambda: frond.flux([450, 550], "canopy.pbrt"), "scene: a path is needed, not .450, 550. .list."),
    ]:
        with pytest.raises((TypeError, frond.InputError), match=message):
            call()
