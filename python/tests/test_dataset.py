"""Results as xarray Datasets and NetCDF files."""

import sys

import pytest

import frond

pytest.importorskip("pandas")
xarray = pytest.importorskip("xarray")

SCENE = """Option "float period" [ 2 2 ]
WorldBegin
LightSource "sky" "float elevation" 50
MakeNamedMaterial "soil" "string type" "diffuse" "spectrum reflectance" [ 300 0.3  2500 0.3 ]
MakeNamedMaterial "leaf" "string type" "diffuse" "spectrum reflectance" [ 300 0.1  2500 0.6 ]
NamedMaterial "soil" Shape "bilinearmesh" "point3 P" [ 0 0 0  2 0 0  0 2 0  2 2 0 ]
NamedMaterial "leaf" ObjectBegin "leaf" Shape "disk" "float radius" 0.5 ObjectEnd
Translate 1 1 1 ObjectInstance "leaf" Translate 0.5 0 1 Rotate 60 0 1 0 ObjectInstance "leaf"
"""


@pytest.fixture(scope="module")
def scene():
    return frond.loads(SCENE)


def checked(of):
    """Checks what CF asks for of all variables."""
    for name, variable in of.variables.items():
        assert name.isidentifier(), name
        assert variable.attrs["long_name"], name
        if variable.dtype.kind == "f":
            assert variable.attrs["units"], name
        for error in variable.attrs.get("ancillary_variables", "").split():
            assert of[error].dims == variable.dims and of[error].attrs["units"] == variable.attrs["units"]
    assert of.attrs["Conventions"].startswith("CF-") and of.attrs["title"] and of.attrs["history"]
    return of


def test_brf(scene, tmp_path):
    result = frond.run("brf", scene=scene, zenith="-30,0,30", azimuth="0,90", wavelengths="450,670", paths=64)
    of = checked(result.to_xarray())
    assert of.hdrf.dims == ("zenith_deg", "azimuth_deg", "wavelength_nm") or of.hdrf.dims == ("azimuth_deg", "zenith_deg", "wavelength_nm")
    table = result.table
    for row in table.itertuples():
        at = dict(zenith_deg=row.zenith_deg, azimuth_deg=row.azimuth_deg, wavelength_nm=row.wavelength_nm)
        assert of.hdrf.sel(at) == row.hdrf and of.hdrf_se.sel(at) == row.hdrf_se
    assert of.attrs["seed"] == "0" and of.attrs["version"] == frond.__version__ and len(of.attrs["scene_hash"]) == 16
    assert "frond brf" in of.attrs["command"]
    assert table.attrs == result.provenance == {name: of.attrs[name] for name in ("version", "command", "seed", "scene_hash")}
    result.to_netcdf(tmp_path / "brf.nc")
    with xarray.open_dataset(tmp_path / "brf.nc") as again:
        assert again.hdrf.equals(of.hdrf) and again.attrs == of.attrs


def test_a_hemisphere_has_one_dimension_of_directions(scene):
    of = checked(frond.run("brf", scene=scene, hemisphere=True, wavelengths="450,670", paths=32).to_xarray())
    assert of.hdrf.dims == ("row", "wavelength_nm") and of.zenith_deg.dims == ("row",)


def test_flux(scene, tmp_path):
    result = frond.run("flux", scene=scene, wavelengths="400:700:50", paths=10_000, by="instance")
    of = checked(result.to_xarray("flux", "instances"))
    flux, instances = result.tables["flux"], result.tables["instances"]
    row = flux[(flux.quantity == "absorbed") & (flux.material == "leaf") & (flux.wavelength_nm == 550)].iloc[0]
    assert of.absorbed.sel(material="leaf", wavelength_nm=550) == row.share
    par = flux[(flux.quantity == "absorbed") & (flux.material == "leaf") & flux.wavelength_nm.isna()].iloc[0]
    assert of.absorbed_par.sel(material="leaf") == par.share and of.absorbed_par_se.sel(material="leaf") == par.share_se
    assert of.reflected.dims == ("wavelength_nm",) and of.area.dims == of.par_umol_m2_s.dims == ("instance",)
    assert of.par_umol_m2_s.attrs["units"] == "umol m-2 s-1"
    assert (of.absorbed_550 == instances.absorbed_550.to_numpy()).all()
    result.to_netcdf(tmp_path / "flux.nc", "flux")


def test_times(scene, tmp_path):
    import pandas
    day = pandas.DataFrame({"time": ["2026-06-21T10:00+02:00", "2026-06-21T12:00+02:00"], "elevation": [30.0, 60.0]})
    day.to_csv(tmp_path / "day.csv", index=False)
    of = checked(frond.run("flux", scene=scene, wavelengths="550,800", paths=2000, times=tmp_path / "day.csv").to_xarray())
    assert of.absorbed.dims == ("material", "wavelength_nm", "time")
    assert str(of.time.values[0]).startswith("2026-06-21T08:00")


def test_instruments(tmp_path):
    result = frond.run("spectrophotometer", material="leaf_lambert", with_="diffuse", wavelengths=[450, 550], angles=[0, 30], rays=1000)
    of = checked(result.to_xarray())
    assert of.R.dims == ("material", "theta_deg", "wavelength_nm") and of.rays == 1000
    result = frond.run("goniophotometer", material="diffuse", wavelengths=[450, 550], angles=[0, 30], patches="2x4", rays=1000)
    of = checked(result.to_xarray())
    assert of.f_per_sr.attrs == {"long_name": of.f_per_sr.attrs["long_name"], "units": "sr-1", "ancillary_variables": "f_per_sr_se"}
    assert {"incidence_deg", "wavelength_nm", "theta_deg", "phi_deg"} <= set(of.f_per_sr.dims) and of.kind.dims == ("theta_deg",)
    result.to_netcdf(tmp_path / "f.nc")


def test_missing_packages_are_named(scene, monkeypatch, tmp_path):
    result = frond.run("brf", scene=scene, zenith=0, wavelengths=550, paths=32)
    of = result.to_xarray()
    monkeypatch.setattr("importlib.util.find_spec", lambda name: None)
    with pytest.raises(ImportError, match="netCDF4, h5netcdf or scipy"):
        frond._dataset.write(of, tmp_path / "a.nc")
    monkeypatch.setitem(sys.modules, "xarray", None)
    with pytest.raises(ImportError, match="pip install xarray"):
        result.to_xarray()


def test_csv_is_plain_unless_asked(scene, tmp_path):
    plain, head = tmp_path / "plain.csv", tmp_path / "head.csv"
    frond.run("brf", scene=scene, zenith=0, wavelengths=550, paths=32, csv=plain)
    frond.run("brf", scene=scene, zenith=0, wavelengths=550, paths=32, csv=head, provenance=True)
    lines = head.read_text().splitlines()
    assert [line.split(":")[0] for line in lines[:4]] == ["# seed", "# scene_hash", "# version", "# command"]
    assert "\n".join(lines[4:]) + "\n" == plain.read_text() and not plain.read_text().startswith("#")
