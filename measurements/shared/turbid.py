"""BRF of a turbid layer of leaves over soil: independent of frond, for comparison.

Leaves are infinitesimal, bi-Lambertian, and point in all directions alike (spherical). Then the extinction is that of an isotropic
medium of optical depth LAI / 2, and the area scattering phase function is Gamma(b) = (R + T) (sin b - b cos b) / (3 pi) + T cos b / 3
for the angle b between the directions before and after (Ross 1981). Solved by doubling: de Haan, Bosma and Hovenier 1987.
"""

import numpy


def turbid_layer(lai, reflectance, transmittance, soil, sun_deg, views, nodes=32, modes=32):
    """Returns the albedo, the share that the soil absorbs, and the BRF for each of `views`: (zenith, azimuth from the sun's plane) in
    degrees, azimuth 0 away from the sun."""
    x, w = numpy.polynomial.legendre.leggauss(nodes)
    beams = numpy.cos(numpy.radians([sun_deg, *(zenith for zenith, _ in views)]))
    mu = numpy.concatenate([(x + 1) / 2, beams])
    w = numpy.concatenate([w / 2, numpy.full(len(beams), 1e-10)])  # the sun and the views are nodes of next to no weight
    phi = numpy.arange(512) * 2 * numpy.pi / 512
    sine = numpy.sqrt(1 - mu**2)

    def phase(side):
        cosine = side * mu[:, None, None] * mu[None, :, None] + (sine[:, None] * sine)[:, :, None] * numpy.cos(phi)
        b = numpy.arccos(numpy.clip(cosine, -1, 1))
        return 8 * ((reflectance + transmittance) * (numpy.sin(b) - b * numpy.cos(b)) / (3 * numpy.pi)
                    + transmittance * numpy.cos(b) / 3)

    back, forward = phase(-1), phase(1)
    doublings = 22
    thin = lai / 2 / 2**doublings
    one, brf = numpy.eye(len(mu)), numpy.zeros(len(views))
    for m in range(modes):  # of the Fourier series over azimuth
        R, T = (thin / mu[:, None] / 2 * (p * numpy.cos(m * phi)).mean(2) * w for p in (back, forward))
        T += numpy.diag(numpy.exp(-thin / mu))
        for _ in range(doublings):
            both = numpy.linalg.solve(one - R @ R, numpy.hstack([R @ T, T]))
            R, T = R + T @ both[:, :len(mu)], T @ both[:, len(mu):]
        beam = numpy.zeros(len(mu))
        beam[nodes] = (1 if m == 0 else 2) / (2 * numpy.pi * mu[nodes] * w[nodes])
        up = R @ beam
        if m == 0:
            ground = 2 * soil * numpy.ones((len(mu), 1)) * (mu * w)
            down = numpy.linalg.solve(one - R @ ground, T @ beam)
            up += T @ ground @ down
            albedo = 2 * numpy.pi * (mu * w) @ up
            absorbed = (1 - soil) * 2 * numpy.pi * (mu * w) @ down
        brf += numpy.pi * up[nodes + 1:] * numpy.cos(m * numpy.radians([azimuth for _, azimuth in views]))
    return albedo, absorbed, brf
