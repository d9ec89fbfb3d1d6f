"""The snippet of docs/outdoors.md that makes a sky from place and time runs as it stands, and gives a known position of the sun."""

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
    [block] = [b for b in re.findall(r"^```python\n(.*?)^```$", PAGE.read_text(encoding="utf-8"), re.M | re.S) if "pvlib" in b]
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
