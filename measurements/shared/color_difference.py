"""Colours: from the linear RGB of frond's images to CIELAB, and the distance between two; arrays whose last axis is the colour."""

import numpy

# Linear RGB to XYZ relative to D65; of the spaces that the wavelength strategies' films come out in.
XYZ_FROM_RGB = {
    "linear sRGB": ((0.4123908, 0.3575843, 0.1804808), (0.2126390, 0.7151687, 0.0721923), (0.0193308, 0.1191948, 0.9505322)),
    "linear SMPTE-C": ((0.3935209, 0.3652581, 0.1916769), (0.2123764, 0.7010599, 0.0865638),
                       (0.0187391, 0.1119339, 0.9583847)),
}
WHITE = (0.9504559, 1.0, 1.0890578)  # D65 at 0.3127, 0.3290


def xyz(rgb, space):
    return numpy.asarray(rgb, float) @ numpy.transpose(XYZ_FROM_RGB[space])


def lab(color):
    """CIELAB (CIE 15:2004) of XYZ relative to WHITE; linear near black and below."""
    t = numpy.asarray(color) / WHITE
    x, y, z = numpy.moveaxis(numpy.where(t > (6 / 29) ** 3, numpy.cbrt(t), t * (29 / 6) ** 2 / 3 + 4 / 29), -1, 0)
    return numpy.stack([116 * y - 16, 500 * (x - y), 200 * (y - z)], axis=-1)


def delta_e(one, other):
    """CIEDE2000 of CIELAB colours (Sharma, Wu and Dalal 2005, whose equations it follows one by one)."""
    (l1, a1, b1), (l2, a2, b2) = (numpy.moveaxis(numpy.asarray(c, float), -1, 0) for c in (one, other))
    weight = lambda c: numpy.sqrt(c**7 / (c**7 + 25**7))
    g = (1 - weight((numpy.hypot(a1, b1) + numpy.hypot(a2, b2)) / 2)) / 2
    a1, a2 = a1 * (1 + g), a2 * (1 + g)
    c1, c2 = numpy.hypot(a1, b1), numpy.hypot(a2, b2)
    h1, h2 = (numpy.degrees(numpy.arctan2(b, a)) % 360 for a, b in ((a1, b1), (a2, b2)))
    grey = c1 * c2 == 0
    dh = numpy.where(grey, 0, (h2 - h1 + 180) % 360 - 180)
    dl, dc, dhh = l2 - l1, c2 - c1, 2 * numpy.sqrt(c1 * c2) * numpy.sin(numpy.radians(dh / 2))
    l, c, turn = (l1 + l2) / 2, (c1 + c2) / 2, numpy.where(h1 + h2 < 360, 180, -180)
    h = numpy.where(grey, h1 + h2, (h1 + h2) / 2 + numpy.where(abs(h1 - h2) > 180, turn, 0))
    cosine = lambda angle: numpy.cos(numpy.radians(angle))
    t = 1 - 0.17 * cosine(h - 30) + 0.24 * cosine(2 * h) + 0.32 * cosine(3 * h + 6) - 0.20 * cosine(4 * h - 63)
    sl = 1 + 0.015 * (l - 50) ** 2 / numpy.sqrt(20 + (l - 50) ** 2)
    sc, sh = 1 + 0.045 * c, 1 + 0.015 * c * t
    rt = -2 * weight(c) * numpy.sin(numpy.radians(60 * numpy.exp(-(((h - 275) / 25) ** 2))))
    return numpy.sqrt((dl / sl) ** 2 + (dc / sc) ** 2 + (dhh / sh) ** 2 + rt * (dc / sc) * (dhh / sh))


# Pairs and distances from table 1 of Sharma, Wu and Dalal 2005.
PUBLISHED = (
    ((50.0, 2.6772, -79.7751), (50.0, 0.0, -82.7485), 2.0425),
    ((50.0, -1.0, 2.0), (50.0, 0.0, 0.0), 2.3669),
    ((50.0, 2.4900, -0.0010), (50.0, -2.4900, 0.0009), 7.1792),
    ((50.0, 2.5, 0.0), (73.0, 25.0, -18.0), 27.1492),
    ((60.2574, -34.0099, 36.2677), (60.4626, -34.1751, 39.4387), 1.2644),
    ((2.0776, 0.0795, -1.1350), (0.9033, -0.0636, -0.5514), 0.9082),
)


def check():
    one, other, distance = map(numpy.array, zip(*PUBLISHED))
    assert (abs(delta_e(one, other) - distance) < 1e-4).all()
    assert (abs(delta_e(other, one) - distance) < 1e-4).all()


if __name__ == "__main__":
    check()
