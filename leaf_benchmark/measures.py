"""Errors of an entry's images and tables against the truth."""

import numpy
import pandas

from .programs.interface import COLUMNS

BLOCK = 4  # pixels, of local errors


def blocks(image, leaf):
    """Means over blocks of BLOCK x BLOCK pixels that see leaf alone, `[block][color]`."""
    rows, columns = (n // BLOCK for n in leaf.shape)
    cut = lambda a: a[:rows * BLOCK, :columns * BLOCK].reshape(rows, BLOCK, columns, BLOCK, *a.shape[2:])
    whole = cut(leaf).all(axis=(1, 3))
    return cut(image).mean(axis=(1, 3))[whole]


def root(square):
    return float(numpy.sqrt(max(0, square)))


def squared(images, halves):
    """Mean square error by pixel and colour of one render, without the truth's noise."""
    return numpy.mean([(a - halves[0]) * (a - halves[1]) for a in images], axis=0)


def bias(images, halves, leaf):
    """RMS of what no number of samples removes, over leaf pixels, with its 95 % interval; `[pixel]` or `[pixel][color]`.

    The mean of products of two independent differences has no contribution of noise. Its variance follows from the differences of the two
    renders; it is that of other seeds, because the pixels are all that there are. The colours of a pixel, of the same paths, are taken as
    fully correlated."""
    (a, b), (r, s) = (tuple(image[leaf] for image in pair) for pair in (images, halves))
    square = ((a - r) * (b - s) + (a - s) * (b - r)) / 2
    noise, mean = ((a - b)**2 + (r - s)**2) / 2, (a + b - r - s) / 2
    deviation = numpy.sqrt(2 * mean**2 * noise)  # the mean's own noise contributes the noise's square
    error = numpy.linalg.norm(deviation.reshape(len(deviation), -1).sum(axis=1)) / square.size
    return [root(square.mean()), root(square.mean() - 1.96 * error), root(max(0, square.mean()) + 1.96 * error)]


def of_images(images, halves, leaf):
    """Over leaf pixels: RMS error of one render; bias by colour and of all; median error of a pixel; largest error of a block. FLIP."""
    channels = lambda of, i: [image[..., i] for image in of]
    mean, truth = numpy.mean(images, axis=0), numpy.mean(halves, axis=0)
    return {"rms": root(squared(images, halves)[leaf].mean()),
            "bias": {name: bias(channels(images, i), channels(halves, i), leaf) for i, name in enumerate(("red", "green", "blue"))}
            | {"all": bias(images, halves, leaf)},
            "median": float(numpy.median(numpy.sqrt(((mean - truth)[leaf]**2).mean(axis=1)))),
            "largest": float(abs(blocks(mean - truth, leaf)).max()), "flip": flip(mean, truth), "mean": float((mean - truth)[leaf].mean())}


def of_brf(values, halves, nm, views):
    """Relative to the truth's mean of each wavelength, over the views: RMS error of one measurement; bias by wavelength and of all; error of
    the mean over the views. If there is a row beyond the views: relative error of absorbed light."""
    result = {"absorbed": dict(zip(map(str, nm), (numpy.mean(values, axis=0)[views] / numpy.mean(halves, axis=0)[views] - 1).tolist()))} \
        if len(values[0]) > views else {}
    values, halves = (numpy.array([table[:views] for table in of]) for of in (values, halves))
    scale, whole = halves.mean(axis=(0, 1)), numpy.ones(views, bool)
    values, halves = values / scale, halves / scale
    return result | {
        "rms": root(squared(values, halves).mean()),
        "bias": {str(w): bias(values[..., i], halves[..., i], whole) for i, w in enumerate(nm)} | {"all": bias(values, halves, whole)},
        "mean": {str(w): float((values - halves)[..., i].mean()) for i, w in enumerate(nm)}}


def flip(image, truth):
    """Mean FLIP (Andersson et al. 2020) at 67 pixels per degree; the brightest hundredth of the truth is white."""
    import flip_evaluator
    white = numpy.quantile(truth.max(axis=2), 0.99)
    shown = [numpy.clip(a / white, 0, 1) for a in (truth, image)]
    srgb = [numpy.where(a < 0.0031308, 12.92 * a, 1.055 * a ** (1 / 2.4) - 0.055).astype(numpy.float32) for a in shown]
    return float(flip_evaluator.evaluate(*srgb, "LDR", applyMagma=False)[1])


def time_to(points, bias, wanted):
    """CPU seconds until the RMS error is `wanted`: interpolated between the measured points, beyond the last one with a variance that
    falls as 1 / samples. None: the bias is larger."""
    cpu = numpy.array([p["cpu_s"] for p in points])
    error = numpy.minimum.accumulate([p["rms"] for p in points])
    if error[-1] <= wanted:
        return float(numpy.exp(numpy.interp(-numpy.log(wanted), -numpy.log(error), numpy.log(cpu))))
    rest = wanted**2 - bias**2
    return float(cpu[-1] * max(error[-1]**2 - bias**2, 0) / rest) if rest > 0 else None


def of_table(rows, truth):
    """RMS of pi times the error of f over the directions of a side, weighted by projected solid angle, reflected and transmitted; and
    the largest errors of R and T. For a white Lambertian reflector, pi f is 1."""
    result = {}
    ours, true = (t[t.quantity == "f"].reset_index(drop=True) for t in (rows, truth))
    reflected = (true.light.astype(float) < 90) == (true.theta.astype(float) < 90)
    weight = abs(numpy.sin(2 * numpy.radians(true.theta.astype(float))))
    off = (numpy.pi * (colors(ours) - colors(true)))**2
    for name, where in (("reflected", reflected), ("transmitted", ~reflected)):
        result[name] = root(numpy.average(off[where].mean(axis=1), weights=weight[where]))
    for name in "RT":
        result[name] = float(abs(colors(ours_of(rows, name)) - colors(ours_of(truth, name))).max())
    return result


def colors(rows):
    return rows[["red", "green", "blue"]].to_numpy(float)


def ours_of(rows, quantity):
    return rows[rows.quantity == quantity].sort_values("theta")


def frame(rows):
    """A table as read from a file."""
    rows = pandas.DataFrame(list(rows), columns=COLUMNS)
    return rows.apply(pandas.to_numeric, errors="coerce").assign(quantity=rows.quantity)


def read_table(path):
    return pandas.read_csv(path, dtype={"quantity": str})
