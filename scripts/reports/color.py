"""Colours: from the linear RGB of frond's images to CIELAB, and the distance between two."""

import math

# Linear RGB to XYZ relative to D65, rows; of the spaces that the wavelength strategies' films come out in.
XYZ_FROM_RGB = {
    "linear sRGB": ((0.4123908, 0.3575843, 0.1804808), (0.2126390, 0.7151687, 0.0721923), (0.0193308, 0.1191948, 0.9505322)),
    "linear SMPTE-C": ((0.3935209, 0.3652581, 0.1916769), (0.2123764, 0.7010599, 0.0865638),
                       (0.0187391, 0.1119339, 0.9583847)),
}
WHITE = (0.9504559, 1.0, 1.0890578)  # D65 at 0.3127, 0.3290


def xyz(rgb, space):
    return tuple(sum(m * c for m, c in zip(row, rgb)) for row in XYZ_FROM_RGB[space])


def lab(color):
    """CIELAB (CIE 15:2004) of XYZ relative to WHITE; linear near black and below."""

    def f(t):
        return t ** (1 / 3) if t > (6 / 29) ** 3 else t * (29 / 6) ** 2 / 3 + 4 / 29

    x, y, z = (f(c / w) for c, w in zip(color, WHITE))
    return 116 * y - 16, 500 * (x - y), 200 * (y - z)


def delta_e(one, other):
    """CIEDE2000 of two CIELAB colours (Sharma, Wu and Dalal 2005, whose equations it follows one by one)."""
    (l1, a1, b1), (l2, a2, b2) = one, other
    mean_c7 = ((math.hypot(a1, b1) + math.hypot(a2, b2)) / 2) ** 7
    g = (1 - math.sqrt(mean_c7 / (mean_c7 + 25**7))) / 2
    a1, a2 = a1 * (1 + g), a2 * (1 + g)
    c1, c2 = math.hypot(a1, b1), math.hypot(a2, b2)
    h1, h2 = (math.degrees(math.atan2(b, a)) % 360 if a or b else 0 for a, b in ((a1, b1), (a2, b2)))
    dh = 0 if c1 * c2 == 0 else (h2 - h1 + 180) % 360 - 180
    dl, dc, dhh = l2 - l1, c2 - c1, 2 * math.sqrt(c1 * c2) * math.sin(math.radians(dh / 2))
    l, c = (l1 + l2) / 2, (c1 + c2) / 2
    if c1 * c2 == 0:
        h = h1 + h2
    elif abs(h1 - h2) <= 180:
        h = (h1 + h2) / 2
    else:
        h = (h1 + h2 + (360 if h1 + h2 < 360 else -360)) / 2

    def cosine(angle):
        return math.cos(math.radians(angle))

    t = 1 - 0.17 * cosine(h - 30) + 0.24 * cosine(2 * h) + 0.32 * cosine(3 * h + 6) - 0.20 * cosine(4 * h - 63)
    sl = 1 + 0.015 * (l - 50) ** 2 / math.sqrt(20 + (l - 50) ** 2)
    sc, sh = 1 + 0.045 * c, 1 + 0.015 * c * t
    rt = -2 * math.sqrt(c**7 / (c**7 + 25**7)) * math.sin(math.radians(60 * math.exp(-(((h - 275) / 25) ** 2))))
    return math.sqrt((dl / sl) ** 2 + (dc / sc) ** 2 + (dhh / sh) ** 2 + rt * (dc / sc) * (dhh / sh))


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
    for one, other, distance in PUBLISHED:
        assert abs(delta_e(one, other) - distance) < 1e-4, (one, other)
        assert abs(delta_e(other, one) - distance) < 1e-4, (one, other)


if __name__ == "__main__":
    check()
