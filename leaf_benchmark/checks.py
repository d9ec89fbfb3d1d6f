"""Checks of an entry's table of the task "leaf", before its figures count. Each finding has the largest deviation and what it may be."""

import numpy

from .measures import colors, ours_of

NEAR, STEEP = 10, 70  # degrees from the normal


def integral(rows, viewer_front, light_front):
    """Light of the unit hemisphere on a side that leaves the leaf near the normal of the viewer's side, by f alone: pi f is integrated
    over the squared cosine by the three angles of light, exactly if it is a quadratic. The integral is over the light because many leaf
    models are not reciprocal."""
    of = rows[rows.quantity == "f"]
    theta, light = of.theta.to_numpy(float), of.light.to_numpy(float)
    seen = theta < NEAR if viewer_front else theta > 180 - NEAR
    means = [colors(of[seen & (light == (angle if light_front else 180 - angle))]).mean(axis=0) for angle in (0, 30, 60)]
    return numpy.pi * (means[0] + 3 * means[1] + 5 * means[2]) / 9


def check(rows, leaf):
    """The findings: a dictionary of name, deviation and limit, with what was found in words. `leaf` is tasks/leaf.json."""
    shares = {name: ours_of(rows, name) for name in "RTS"}
    theta = shares["R"].theta.to_numpy(float)
    result = []

    def finding(name, deviations, limit, words):
        deviations = numpy.atleast_2d(deviations)
        worst = float(numpy.max(numpy.where(numpy.isnan(deviations), numpy.inf, deviations)))
        result.append({"check": name, "value": worst, "limit": float(limit), "passed": bool(worst <= limit), "words": words})

    total = colors(shares["R"]) + colors(shares["T"])
    finding("energy", total - 1, 0.005, "R + T beyond 1")
    steep = abs(numpy.cos(numpy.radians(theta))) < numpy.cos(numpy.radians(STEEP))  # where lobes are narrow, and estimates noisy
    finding("furnace", abs(colors(shares["S"]) - total)[~steep], 0.01, "light from all sides less R + T")
    for side, near in (("front", theta < NEAR), ("back", theta > 180 - NEAR)):
        for name in "RT":
            true = numpy.array(leaf[side][name][0])
            finding(f"{name} of the {side}", abs(colors(shares[name])[near] - true), 0.003 + 0.02 * true.max(), f"{name} near the normal")
    for side, near in (("front", theta < NEAR), ("back", theta > 180 - NEAR)):
        for name in "RT":
            share = colors(shares[name])[near][0]
            found = integral(rows, side == "front", (side == "front") == (name == "R"))
            finding(f"cosine, {name} of the {side}", abs(found - share), 0.003 + 0.1 * share.max(), f"f integrated less {name}")
    finding("positive", -colors(rows), 1e-6, "f below 0")
    return result
