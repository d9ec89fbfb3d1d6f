"""The snippets of docs/outdoors.md run as they stand: that of place and time gives a known position of the sun, that of a weather station
the energy of a day."""

import math
import re
from pathlib import Path

import pytest

import frond

pytest.importorskip("pvlib")

PAGE = Path(__file__).resolve().parents[2] / "docs" / "outdoors.md"
#: The example of the Solar Position Algorithm (Reda and Andreas 2003, revised 2008, NREL/TP-560-34302, appendix A.5): 17 October 2003,
#: 12:30:30 in a zone 7 hours behind UTC. Its elevation is that of 1830 m above the sea: the air of the sea's level refracts by 0.004
#: degrees more.
SPA = {'"2026-06-21 11:00"': '"2003-10-17 12:30:30"', '"Europe/Zurich"': '"Etc/GMT+7"', "latitude=47.38": "latitude=39.742476",
       "longitude=8.54": "longitude=-105.1786"}
SPA_ELEVATION, SPA_AZIMUTH, SPA_DAY = 90 - 50.11162, 194.34024, 290


def snippet():
    return block_with("sky = f")


def block_with(text):
    [block] = [b for b in re.findall(r"^```python\n(.*?)^```$", PAGE.read_text(encoding="utf-8"), re.M | re.S) if text in b]
    return block


def executed(block):
    names = {}
    exec(compile(block, str(PAGE), "exec"), names)
    return names["sky"]


def radiance(sky, azimuth, elevation):
    """In a direction of the world whose +x is east and +y north; `azimuth` from north to east, as pvlib's."""
    a, e = math.radians(azimuth), math.radians(elevation)
    toward = math.sin(a) * math.cos(e), math.cos(a) * math.cos(e), math.sin(e)
    text = f"""LookAt 0 0 0  {toward[0]} {toward[1]} {toward[2]}  0 0 1
Camera "orthographic" "float screenwindow" [ -1 1 -1 1 ]
Film "rgb" "integer xresolution" 1 "integer yresolution" 1
WorldBegin
{sky}"""
    return float(frond.loads(text, wavelengths=[550]).render(1).array[0, 0, 0])


def test_position_of_the_sun():
    block = snippet()
    for written, example in SPA.items():
        assert written in block
        block = block.replace(written, example)
    sky = executed(block)
    numbers = {name: float(value) for name, value in re.findall(r'"(?:float|integer) (\w+)" ([-\d.e]+)', sky)}
    assert numbers["elevation"] == pytest.approx(SPA_ELEVATION, abs=0.01)
    assert numbers["azimuth"] == pytest.approx(90 - SPA_AZIMUTH, abs=0.001)
    assert numbers["day"] == SPA_DAY
    # The disc, 0.27 degrees in radius, is there and nowhere near.
    sun = radiance(sky, SPA_AZIMUTH, SPA_ELEVATION)
    for azimuth, elevation in ((0, 1), (0, -1), (1.5, 0), (-1.5, 0)):
        assert sun > 100 * radiance(sky, SPA_AZIMUTH + azimuth, SPA_ELEVATION + elevation)


def test_as_it_stands():
    sky = executed(snippet())
    image = frond.loads('Film "rgb" "integer xresolution" 4 "integer yresolution" 4\nWorldBegin\n' + sky).render(1)
    assert image.rgb.max() > 0


def test_weather_station(tmp_path):
    """Direct and diffuse irradiance by step against pvlib's, through the light's own log line, and PAR through `flux`."""
    names = {}
    exec(compile(block_with("erbs"), str(PAGE), "exec"), names)
    day, sun = names["day"], names["sun"]
    scene = frond.loads('Option "float period" [ 1 1 ]\nWorldBegin\nLightSource "sky"\nMaterial "diffuse" "spectrum reflectance" [ 300 0  2500 0 ]\n'
                        'Shape "bilinearmesh" "point3 P" [ 0 0 0  1 0 0  0 1 0  1 1 0 ]')
    table = frond.flux(scene, "400:700:50", times=day, paths=2000)
    assert list(table.time.unique()) == [str(time) for time in day.index]
    steps = frond.run("flux", scene=scene, wavelengths="400:700:50", times=day_file(day, tmp_path), paths=2000).tables["steps"]
    assert steps.elevation_deg.to_numpy() == pytest.approx(sun.apparent_elevation.to_numpy(), abs=0.01)
    # Photons of a clear sky are 1.9 to 2.2 umol for each joule of the whole spectrum.
    assert ((steps.par_umol_m2_s / day.ghi.to_numpy()).between(1.9, 2.3)).all()


def test_energy_of_each_step(caplog):
    """Within 0.5 % of the values of the station, as the light states them."""
    names = {}
    exec(compile(block_with("erbs"), str(PAGE), "exec"), names)
    for row, elevation in zip(names["day"].itertuples(), names["sun"].apparent_elevation):
        caplog.clear()
        with caplog.at_level("INFO", logger="frond"):
            frond.loads(f'Film "rgb" "integer xresolution" 1 "integer yresolution" 1\nWorldBegin\nLightSource "sky" "float elevation" {elevation} '
                        f'"float globalirradiance" {row.ghi} "float diffuseirradiance" {row.dhi}').render(1)
        total, direct, diffuse = (float(v) for v in re.search(r"total ([\d.]+), direct ([\d.]+), diffuse ([\d.]+)", caplog.text).groups())
        assert (total, direct, diffuse) == pytest.approx((row.ghi, row.ghi - row.dhi, row.dhi), rel=0.005)


def day_file(day, folder):
    """A file of a table of times."""
    day.rename_axis("time").to_csv(folder / "day.csv")
    return folder / "day.csv"
