import inspect
import json
import math
import os
import pathlib
import subprocess

import frond
import numpy
import pytest


def test_spectrophotometer_is_the_commands():
    found = frond.spectrophotometer("leaf_solved,specimen=maize", [551, 800], [8, 172], rays=20_000, seed=3)
    text = subprocess.run([os.environ["FROND"], "spectrophotometer", "leaf_solved,specimen=maize", "--wavelengths", "551,800",
                           "--angles", "8,172", "--rays", "20000", "--seed", "3", "--json", "-", "-q"], capture_output=True,
                          text=True, check=True).stdout
    expected = json.loads(text)["measurements"]
    assert numpy.allclose(list(found["R"]), [r["R"] for r in expected], rtol=1e-12)
    assert numpy.allclose(list(found["T_se"]), [r["T_se"] for r in expected], rtol=1e-12)


def test_f_integrates_to_reflectance():
    """A leaf's f over patches, summed by their projected solid angles, is R and T: against the solver's table."""
    found = frond.goniophotometer("leaf_solved", 551, [8, 172], integrate=True)
    shares = frond.spectrophotometer("leaf_solved", 551, [8, 172], rays=1_000_000)
    for i, theta in enumerate((8, 172)):
        f = found["f"][i, 0] * found["projected_solid_angle_sr"]
        upper = found["theta_o_deg"] < 90
        lit = upper if theta < 90 else ~upper
        for name, side in (("R", lit), ("T", ~lit)):
            difference = f[side].sum() - shares[name][i]
            assert abs(difference) < 5 * shares[name + "_se"][i] + 1e-4


def test_f_of_a_leaf_is_reciprocal():
    rng = numpy.random.default_rng(1)
    w = rng.normal(size=(2, 1000, 3))
    w /= numpy.linalg.norm(w, axis=2)[:, :, None]
    bsdf = frond.bsdf("leaf_solved,incident=reciprocal")
    assert bsdf.is_reciprocal and not bsdf.is_stochastic
    assert numpy.array_equal(bsdf.f(w[0], w[1]), bsdf.f(w[1], w[0]))
    wi, weight, pdf = bsdf.sample(w[0])
    assert numpy.allclose(bsdf.pdf(w[0], wi), pdf, rtol=1e-3)
    cosine = abs(wi[:, 2:])
    assert numpy.allclose(weight, bsdf.f(w[0], wi) * cosine / pdf[:, None], rtol=1e-3, atol=1e-6)


class White(frond.Bsdf):
    """White paper."""

    flags, reciprocal = ("reflection", "diffuse"), True

    def f(self, wo, wi, nm):
        return 1 / math.pi if wo[2] * wi[2] > 0 else 0.0


class Gains(White):
    def f(self, wo, wi, nm):
        return 1.2 / math.pi if wo[2] * wi[2] > 0 else 0.0


class WrongDensity(White):
    def pdf(self, wo, wi, nm):
        return 1 / (2 * math.pi) if wo[2] * wi[2] > 0 else 0.0


@pytest.mark.parametrize("bsdf, broken", [(White(), set()), (Gains(), {"energy"}), (WrongDensity(), {"sampling"})])
def test_laws_hold_a_bsdf_in_python(bsdf, broken):
    report = frond.conform(bsdf, samples=4000, angles=[0, 60])
    found = {name for name, law in report["laws"].items() if law["verdict"] == "broken"}
    assert broken <= found and bool(broken) == bool(found)
    assert report["all_hold"] == (not broken)


class FivePercentTooBright(frond.Bsdf):
    def f(self, wo, wi, nm):
        return 1.05 / math.pi if wo[2] * wi[2] > 0 else 0.0


class HalfOfThat(frond.Bsdf):
    def f(self, wo, wi, nm):
        return 0.525 / math.pi if wo[2] * wi[2] > 0 else 0.0


def test_conform_finds_five_percent_at_its_defaults():
    report = frond.conform(FivePercentTooBright())
    assert not report["all_hold"] and report["verdict"] == "Broken: energy."
    energy = report["laws"]["energy"]
    assert energy["verdict"] == "broken" and abs(energy["largest"] - 1.05) < 0.05 and energy["detectable"] <= 0.05


def test_conform_states_its_power_and_its_parameters():
    report = frond.conform(HalfOfThat(), samples=2000)
    assert report["all_hold"]
    assert report["verdict"] == "No law was found broken, at the defaults only: there is no parameter with a range."
    energy = report["laws"]["energy"]
    assert energy["quantity"] == "directional albedo" and abs(energy["largest"] - 0.525) < 0.1 and energy["largest_se"] > 0
    assert energy["largest_parameters"] == "defaults" and energy["largest_wavelength_nm"] in (608, 551, 455)
    assert energy["detectable"] > 0.05 and 1.8 < report["detectable_factor"] < 3
    assert "f too large everywhere by a factor of" in report["text"]
    assert {"value", "detectable", "parameters", "theta_deg"} <= set(report["findings"])


def test_bench_takes_bsdfs_in_python():
    table = frond.bench(White(), [HalfOfThat(), "diffuse"], angles=30, lanes=1, wavelengths=551, repetitions=1, min_time=0.001, samples=1000,
                        session=frond.Session(cache=False)).tables["times"]
    assert list(table["material"]) == ["White", "HalfOfThat", "diffuse"] and min(table["hit_ns"]) > 0


def test_the_name_of_a_bsdf_is_that_of_its_class():
    session = frond.Session(cache=False)
    one, other = White(), White()
    reports = [frond.conform(bsdf, samples=1000, angles=0, session=session) for bsdf in (one, other, one)]
    assert [r["material"] for r in reports] == ["White", "White-2", "White"]
    assert reports[0]["findings"].equals(reports[2]["findings"])
    named = White()
    frond.register_material("paper", named, session=session)
    assert frond.conform(named, samples=1000, angles=0, session=session)["material"] == "paper"


def test_a_bsdf_in_python_is_a_material(scene_text):
    session = frond.Session(threads=2, cache=False)
    frond.register_material("white", White(), session=session)
    frond.register_material("three", Colored(), session=session)
    text = scene_text.replace('"leaf_solved"', '"white"')
    image = frond.loads(text, session=session, wavelengths=[551, 800]).render(4)
    of_ours = scene_text.replace('"leaf_solved"', '"diffuse" "spectrum reflectance" [ 300 1 900 1 ]')
    expected = frond.loads(of_ours, session=session, wavelengths=[551, 800]).render(4)
    assert numpy.allclose(image.array[:, :, :2], expected.array[:, :, :2], rtol=1e-4)  # an even light: without noise
    with pytest.raises(frond.InputError, match='material "white" already exists'):
        frond.register_material("white", White(), session=session)
    with pytest.raises(ValueError, match="a BSDF is asked at 2 wavelengths, and gave 3 values"):
        frond.loads(text.replace('"white"', '"three"'), session=session, wavelengths=[551, 800]).render(1)


class Colored(White):
    def f(self, wo, wi, nm):
        return [0.1, 0.2, 0.3]


def test_fit_of_arrays_and_of_a_file(reference):
    of_file = frond.fit(path=reference / "lopex93_soybean.csv")
    table = frond.read_spectra(reference / "lopex93_soybean.csv")
    of_arrays = frond.fit(list(table["wavelength_nm"]), list(table["R"]), list(table["T"]))
    assert of_file.leaf == of_arrays.leaf
    assert of_file.rmse < 0.011
    assert 'Material "leaf"' in of_file.scene()
    shares = frond.spectrophotometer(["leaf_solved"] + of_file.material, 800, rays=100_000)
    measured = [r for nm, r in zip(table["wavelength_nm"], table["R"]) if nm == 800][0]
    assert abs(shares["R"][0] - measured) < 0.02
    contents = {name: value for name, value in zip(of_file.contents["name"], of_file.contents["value"])}
    leaf = of_file.leaf
    area = leaf["thickness"] * leaf["mesophyllfraction"]  # kg/m3 times this is kg/m2
    assert abs(contents["chlorophyll"] / (1e5 * area * (leaf["chlorophylla"] + leaf["chlorophyllb"])) - 1) < 1e-9
    assert abs(contents["water"] / (100 * area) - 1) < 1e-9
    assert set(of_file.misfits["quantity"]) <= {"R", "T"}
    with pytest.raises(frond.InputError, match="fewer than the 12 parameters"):
        frond.fit([550], [0.1])
    with pytest.raises(ValueError, match="takes measurements, or the path"):
        frond.fit()


def test_fit_of_all_leaves(tmp_path, reference):
    spectra = "leaf,nm,R,T\n" + "".join(
        f"{leaf},{nm},{share * r},{share * t}\n" for leaf, share in (("one", 1), ("two", 0.9)) for nm, r, t in (
            (450, .045, .016), (550, .08, .15), (650, .05, .05), (680, .045, .02), (720, .25, .28), (800, .44, .45),
            (1200, .41, .44), (1450, .12, .15), (1650, .29, .33), (1940, .04, .03), (2200, .12, .16)))
    (tmp_path / "leaves.csv").write_text(spectra + "bad,450,x,.1\n")
    (tmp_path / "other.csv").write_text(spectra.replace("one", "three"))
    shape = {"structure": "bifacial", "sieve": True}
    table = frond.fit(path=tmp_path / "leaves.csv", all_leaves=True, **shape)
    assert list(table["leaf"]) == ["one", "two", "bad"]
    assert [status == "fitted" for status in table["status"]] == [True, True, False]
    assert "leaves.csv:24:9" in table["status"][2]
    alone = frond.fit(path=tmp_path / "leaves.csv", leaf="two", **shape)
    assert table["chlorophylla"][1] == alone.leaf["chlorophylla"]
    assert abs(table["rmse"][1] - alone.rmse) < 1e-12
    both = frond.fit(path=[tmp_path / "leaves.csv", str(tmp_path / "other.csv")], all_leaves=True, **shape)
    assert list(both["file"]) == ["leaves.csv"] * 3 + ["other.csv"] * 2
    assert both["thickness"][0] == table["thickness"][0]
    with pytest.raises(ValueError, match="2 files; all_leaves=True"):
        frond.fit(path=[tmp_path / "leaves.csv"] * 2)
    with pytest.raises(frond.InputError, match="all_leaves takes all"):
        frond.fit(path=tmp_path / "other.csv")


def test_brf_and_flux_of_a_scene(tmp_path):
    (tmp_path / "canopy.pbrt").write_text("""
WorldBegin
LightSource "distant" "point3 from" [ 0 0 1 ] "point3 to" [ 0 0 0 ]
Material "diffuse" "spectrum reflectance" [ 300 0.4 900 0.4 ]
Shape "bilinearmesh" "point3 P" [ -1 -1 0  1 -1 0  -1 1 0  1 1 0 ]
""")
    brf = frond.brf(tmp_path / "canopy.pbrt", [670, 800], zenith=[0, 30], period=(2, 2), paths=4096)
    assert len(brf["brf"]) == 4
    assert numpy.allclose(list(brf["brf"]), 0.4, atol=2e-3)
    flux = frond.flux(tmp_path / "canopy.pbrt", [670], period=(2, 2), paths=65536)
    share = {q: (s, e) for q, s, e in zip(flux["quantity"], flux["share"], flux["share_se"])}
    assert abs(share["reflected"][0] - 0.4) < 5 * share["reflected"][1] + 1e-6
    assert abs(share["sum"][0] - 1) < 5 * share["sum"][1] + 1e-9


def test_fluorescence_of_a_scene(tmp_path):
    """A leaf in the sun has the same photon radiance everywhere: pi times it leaves upward. Within 5 standard errors: a false alarm in 2e6."""
    (tmp_path / "shares.csv").write_text("theta_deg,wavelength_nm,Rs,Rd,T\n8,400,0,0.1,0.1\n8,850,0,0.4,0.4\n")
    (tmp_path / "matrices.csv").write_text("excitation_nm,emission_nm,Mb,Mf\n" + "".join(f"{e},{f},1e-5,2e-5\n" for e in (400, 750) for f in (640, 850)))
    (tmp_path / "leaf.pbrt").write_text("""
WorldBegin
LightSource "sky" "float elevation" 60
Material "leaf_lambert" "string tablefile" "shares.csv" "string fluorescencematrices" "matrices.csv"
Shape "bilinearmesh" "point3 P" [ -1 -1 0  1 -1 0  -1 1 0  1 1 0 ]
""")
    brf = frond.brf(tmp_path / "leaf.pbrt", zenith=[0, 50], period=(2, 2), paths=4096, fluorescence=True, emission=[700, 740])
    assert list(brf)[:5] == ["zenith_deg", "azimuth_deg", "wavelength_nm", "radiance", "radiance_se"]
    assert numpy.allclose(brf["photon_radiance"], brf["photon_radiance"].mean(), rtol=0.02)
    flux = frond.flux(tmp_path / "leaf.pbrt", period=(2, 2), paths=65536, fluorescence=True, emission=[700, 740])
    upward = flux[(flux["quantity"] == "upward") & (flux["wavelength_nm"] == 740)].iloc[0]
    seen = brf[brf["wavelength_nm"] == 740].iloc[0]
    error = numpy.hypot(numpy.pi * seen["photon_radiance_se"], upward["photon_flux_se"])
    assert abs(numpy.pi * seen["photon_radiance"] - upward["photon_flux"]) < 5 * error + 1e-3 * upward["photon_flux"]


TURBID = """
Option "float period" [ 1 1 ]
WorldBegin
LightSource "distant" "point3 from" [ -0.5 0 0.8660254 ] "point3 to" [ 0 0 0 ] "spectrum L" "stdillum-E"
MakeNamedMedium "leaves" "string type" "turbid" "float density" 3
  "spectrum reflectance" [ 300 0.4957 2500 0.4957 ] "spectrum transmittance" [ 300 0.4409 2500 0.4409 ]
AttributeBegin
  Material "interface"
  MediumInterface "leaves" ""
  Shape "bilinearmesh" "point3 P" [ 0 0 1  1 0 1  0 1 1  1 1 1 ]
AttributeEnd
Material "diffuse" "spectrum reflectance" [ 300 0.159 2500 0.159 ]
Shape "bilinearmesh" "point3 P" [ 0 0 0  1 0 0  0 1 0  1 1 0 ]
"""


def test_a_turbid_medium_has_the_brf_of_the_transfer_equation(tmp_path, monkeypatch):
    """Against a solution by doubling, which shares no code with frond (measurements/shared/turbid.py). 5 standard errors."""
    monkeypatch.syspath_prepend(pathlib.Path(__file__).parents[2])
    from measurements.shared.turbid import turbid_layer
    (tmp_path / "turbid.pbrt").write_text(TURBID)
    zenith = [-60, -30, 0, 30, 60]
    for azimuth in (0, 90):
        found = frond.brf(tmp_path / "turbid.pbrt", [800], zenith=zenith, azimuth=azimuth, rms=0.004)
        views = [(abs(z), azimuth + (180 if z < 0 else 0)) for z in zenith]
        _, _, true = turbid_layer(3, 0.4957, 0.4409, 0.159, 30, views)
        z = (numpy.array(found["brf"]) - true) / numpy.array(found["brf_se"])
        assert abs(z).max() < 5, z
    with pytest.raises(frond.InputError, match="turbid.pbrt:5:40: flux does not trace participating media"):
        frond.flux(tmp_path / "turbid.pbrt", [800], paths=64)


CANOPY = """
Option "float period" [ 2 2 ]
WorldBegin
LightSource "distant" "point3 from" [ 0 0 1 ] "point3 to" [ 0 0 0 ] "spectrum L" "stdillum-E"
Material "diffuse" "spectrum reflectance" [ 300 0.2 900 0.2 ]
Shape "bilinearmesh" "point3 P" [ 0 0 0  2 0 0  0 2 0  2 2 0 ]
Material "diffuse" "spectrum reflectance" [ 300 0.5 900 0.5 ]
ObjectBegin "leaf" Shape "disk" "float radius" 0.5 ObjectEnd
Translate 1 1 1
ObjectInstance "leaf"
"""


def test_flux_has_par_and_the_defaults_of_the_command(tmp_path):
    """The sum is 1 within 5 standard errors: a false alarm in 2e6."""
    (tmp_path / "canopy.pbrt").write_text(CANOPY)
    by_default = frond.flux(tmp_path / "canopy.pbrt", paths=4096)
    assert sorted(set(by_default["wavelength_nm"])) == [450, 550, 670, 800]
    table = frond.flux(tmp_path / "canopy.pbrt", "400:700:50", paths=100_000)
    par = table[table["wavelength_nm"].isna()].set_index("quantity")
    assert abs(par["share"]["sum"] - 1) < 5 * par["share_se"]["sum"] + 1e-9
    table, leaves = frond.flux(tmp_path / "canopy.pbrt", "400:700:50", by="instance", paths=100_000)
    assert isinstance(leaves, type(table)) and list(leaves)[:5] == ["instance", "area", "par_umol_m2_s", "par_umol_m2_s_se", "absorbed_400"]
    assert abs(leaves["area"][0] - numpy.pi / 4) < 0.01
    # Photons that the disk absorbs, over its share of them: those of 1 m2 in full sun.
    share = numpy.mean([leaves[f"absorbed_{nm}"][0] for nm in range(400, 701, 50)])
    photons = leaves["par_umol_m2_s"][0] * leaves["area"][0] / 4 / share
    assert 1500 < photons < 2500 and leaves["par_umol_m2_s_se"][0] > 0
    for name, function in frond._jobs.FUNCTIONS.items():
        ours, of_command = (inspect.signature(f).parameters for f in (getattr(frond, name), function))
        for word in ours.keys() & of_command.keys():
            default = ours[word].default
            text = "x".join(map(str, default)) if isinstance(default, tuple) else str(default)
            assert default is None or text == str(of_command[word].default), (name, word)
    assert inspect.signature(frond.flux).parameters["wavelengths"].default == "450,550,670,800"


def test_flux_until_the_error_of_leaves(tmp_path):
    (tmp_path / "canopy.pbrt").write_text(CANOPY)
    given = {"scene": tmp_path / "canopy.pbrt", "wavelengths": [550], "by": "instance"}
    few = frond.run("flux", **given, paths=64).facts
    assert few["instance_error_median"] > 0.05 and few["instance_error_largest"] >= few["instance_error_median"]
    reached = frond.run("flux", **given, instance_error=0.001).facts
    assert reached["instance_error_median"] <= 0.001 and reached["paths"] > 65536
    with pytest.raises(frond.InputError, match="instance_error needs by"):
        frond.flux(tmp_path / "canopy.pbrt", instance_error=0.1)


def test_flux_in_photons(tmp_path):
    """A black disk absorbs all photons of the light: of an irradiance of 1.5 W/(m2 nm) at every wavelength, and of the scene's
    sky. 119.627 J m / mol is Planck's constant x c x Avogadro's, in nm and umol. Within 5 standard errors: a false alarm in
    2e6."""
    (tmp_path / "equal.spd").write_text("300 1.5\n2500 1.5\n")
    (tmp_path / "scene.pbrt").write_text("""WorldBegin
LightSource "sky"
ObjectBegin "leaf"
  Material "diffuse" "spectrum reflectance" [ 300 0 2500 0 ]
  Shape "disk" "float radius" 1
ObjectEnd
ObjectInstance "leaf"
""")
    scene, equal = tmp_path / "scene.pbrt", 1.5 * (700**2 - 400**2) / 2 / 119.626566
    sky = frond.run("flux", scene=scene, wavelengths="400:700:10", irradiance="scene", paths=1).facts["par_umol_m2_s"]
    assert 1500 < sky < 2200
    for wavelengths, irradiance, expected in (("400:700:10", tmp_path / "equal.spd", equal), ("400:700:10", "scene", sky),
                                              ("700,600,500,450,400,550,650", tmp_path / "equal.spd", equal)):
        _, leaves = frond.flux(scene, wavelengths, by="instance", irradiance=irradiance, paths=100_000)
        error = leaves["par_umol_m2_s_se"][0]
        assert 0 < error < 0.01 * expected and abs(leaves["par_umol_m2_s"][0] - expected) < 5 * error + 1e-3 * expected


def test_flux_by_energy_and_organ(tmp_path):
    """A black triangle of 0.5 m2 absorbs the energy of the light above it. Within 5 standard errors: a false alarm in 2e6."""
    (tmp_path / "leaf.pbrt").write_text("""WorldBegin
LightSource "sky" "float elevation" 40
MakeNamedMaterial "black" "string type" "diffuse" "spectrum reflectance" [ 300 0 2500 0 ]
NamedMaterial "black"
Shape "trianglemesh" "point3 P" [ 0 0 0  1 0 0  1 1 0 ]
""")
    tables = frond.flux(tmp_path / "leaf.pbrt", bands="par,all=300:2500", material="black", by="mesh", target=(0, 1, 0, 1, 0),
                        paths=20_000)
    assert list(tables) == ["meshes", "energy", "leaves", "surfaces"]
    incident = tables["energy"].query("quantity == 'incident' and material == ''").set_index("band")
    mesh = tables["meshes"].iloc[0]
    assert mesh["name"] == "black" and mesh["area"] == 0.5
    for band in ("par", "all"):
        assert abs(mesh[f"{band}_w_m2"] - incident["w_m2"][band]) < 5 * mesh[f"{band}_w_m2_se"]
        assert abs(incident["direct_w_m2"][band] + incident["diffuse_w_m2"][band] - incident["w_m2"][band]) < 1e-6 * incident["w_m2"][band]
    sunlit = tables["leaves"].query("leaves == 'sunlit' and band == 'par'").iloc[0]
    assert sunlit["area"] == 0.5 and abs(sunlit["absorbed_w_m2"] - mesh["par_w_m2"]) < 1e-6 * mesh["par_w_m2"]


def test_bench_of_a_material():
    found = frond.bench("diffuse", samples=1000, min_time=0.001)
    assert set(found.tables) == {"times", "worths"} and len(found.tables["times"]) > 0


def test_a_bsdf_has_any_number_of_wavelengths():
    nm = [450, 551, 670, 700, 750, 800]
    directions = [0, 0, 1], [[0, 0.6, 0.8], [0, 0.6, -0.8]]
    leaf = frond.bsdf("leaf_lambert", nm)
    alone = numpy.concatenate([frond.bsdf("leaf_lambert", [one]).f(*directions) for one in nm], axis=1)
    assert leaf.f(*directions).shape == (2, 6) and numpy.allclose(leaf.f(*directions), alone, rtol=1e-6)
    for call in (lambda: leaf.sample([0, 0, 1]), lambda: leaf.pdf(*directions)):
        with pytest.raises(ValueError, match="one to four wavelengths: there are 6"):
            call()


def test_bands_have_names(scene_text, tmp_path):
    """Of one mean wavelength, in the order of the files."""
    (tmp_path / "par.spd").write_text("400 1\n700 1\n")
    (tmp_path / "green.spd").write_text("540 1\n560 1\n")
    (tmp_path / "canopy.pbrt").write_text(CANOPY)
    bands = f"bands,responses={tmp_path}/par.spd,{tmp_path}/green.spd"
    brf = frond.brf(tmp_path / "canopy.pbrt", bands, zenith=[0], paths=64)
    assert list(brf["band"]) == ["par", "green"] and list(brf["wavelength_nm"]) == [550, 550]
    flux, leaves = frond.flux(tmp_path / "canopy.pbrt", bands + ",names=PAR,G", by="instance", paths=4096)
    assert list(flux["band"])[:2] == ["PAR", "G"] and list(flux["wavelength_nm"])[:2] == [550, 550]
    assert list(leaves) == ["instance", "area", "absorbed_PAR", "absorbed_PAR_se", "absorbed_G", "absorbed_G_se"]
    share = frond.goniophotometer("diffuse", bands, patches=(2, 2), rays=1000, illuminant="stdillum-D65")
    assert list(share["band"]) == ["par", "green"] and list(share["wavelength_nm"]) == [550, 550] and share["f"].shape == (1, 2, 2, 2)
    image = frond.loads(scene_text, wavelengths=bands).render(1)
    assert image.channels[:2] == ["S0.par", "S0.green"] and "variance.green" in image.channels
    xarray = pytest.importorskip("xarray")
    data = image.to_xarray()
    assert isinstance(data, xarray.Dataset) and data.radiance.dims == ("band", "y", "x")
    assert list(data.band) == ["par", "green"] == list(data.variance.band)
    assert numpy.array_equal(data.radiance.sel(band="green"), image["S0.green"])


def test_to_xarray(scene_text, tmp_path):
    xarray = pytest.importorskip("xarray")
    image = frond.loads(scene_text, wavelengths=[800, 551]).render(1)
    data = image.to_xarray()
    assert isinstance(data, xarray.Dataset) and data.radiance.dims == ("wavelength_nm", "y", "x")
    assert list(data.wavelength_nm) == [800, 551] == list(data.variance.wavelength_nm)
    assert numpy.array_equal(data.radiance.sel(wavelength_nm=551), image["S0.551,000000nm"])
    colors = frond.loads(scene_text, wavelengths="smpte").render(1)
    assert numpy.array_equal(colors.to_xarray()["G"], colors["G"]) and colors.to_xarray()["G"].dims == ("y", "x")
    (tmp_path / "canopy.pbrt").write_text(CANOPY)
    brf = frond.brf(tmp_path / "canopy.pbrt", [670, 800], zenith="-60:60:15", paths=64)
    brf = brf.set_index(["zenith_deg", "azimuth_deg", "wavelength_nm"]).to_xarray()
    assert brf.brf.sel(wavelength_nm=800).shape == (9, 1)


def test_compare(scene_text, tmp_path):
    (tmp_path / "scene.pbrt").write_text(scene_text)
    found = frond.compare(tmp_path / "scene.pbrt", ["leaf_solved", "leaf_lambert"], wavelengths="smpte", size=16, samples=4,
                          reference_samples=16, session=frond.Session(cache=False))
    assert set(found["candidate"]) == {"leaf_solved", "leaf_lambert"}
    assert set(found["samples"]) == {1, 2, 4}


def test_names_and_bad_words():
    assert "leaf_solved" in frond.names() and "path" in frond.names("integrator")
    with pytest.raises(frond.InputError, match="leaf_solved"):
        frond.spectrophotometer("leaf_solvd", 551)
    with pytest.raises(frond.InputError):
        frond.spectrophotometer("leaf_solved", 5510)


FLUORESCENT = "leaf_solved,fluorescence=0.01"


def test_fluorescence_by_direction_adds_up_to_the_matrices(tmp_path):
    """Both instruments have fluorescence; the integral over the directions of a side is Mb or Mf."""
    matrices = frond.spectrophotometer(FLUORESCENT, fluorescence=True, excitation=[440, 550], emission=[685, 740], angles=[8, 120],
                                       csv=tmp_path / "m.csv")
    assert list(numpy.unique(matrices["excitation_nm"])) == [440, 550] and len(matrices["Mb"]) == 8
    found = frond.goniophotometer(FLUORESCENT, fluorescence=True, excitation=[440, 550], emission=[685, 740], angles=[8, 120], patches=(6, 4))
    photons = numpy.asarray(found["f_per_sr_nm"]) * numpy.asarray(found["projected_solid_angle_sr"])
    lit = (numpy.asarray(found["kind"]) == "lit side").reshape(8, -1)
    photons = photons.reshape(8, -1)
    assert numpy.allclose((photons * lit).sum(axis=1), matrices["Mb"], rtol=3e-4)
    assert numpy.allclose((photons * ~lit).sum(axis=1), matrices["Mf"], rtol=3e-4)
    # A leaf of another model takes the file.
    replayed = frond.spectrophotometer(f"leaf_lambert,fluorescencematrices={tmp_path / 'm.csv'}", fluorescence=True, excitation=[440, 550],
                                       emission=[685, 740], angles=[8, 120])
    assert numpy.allclose(replayed["Mb"], matrices["Mb"], rtol=1e-7) and numpy.allclose(replayed["Mf"], matrices["Mf"], rtol=1e-7)


def test_goniophotometer_without_wavelengths_names_them():
    with pytest.raises(frond.InputError, match="wavelengths is needed"):
        frond.goniophotometer("diffuse")
