"""Images as arrays of luminance, and statistics of images that differ only in their seeds."""

import dataclasses

import numpy

import frond

WEIGHTS = {"R": 0.2126, "G": 0.7152, "B": 0.0722}
BORDER = 2  # pixels left out on each side: a filter that splats has fewer samples there
BLOCK = 16


def read(path):
    """Luminance `[row][column]`, rows from the top."""
    names, pixels = frond.read_image(path)
    return sum(weight * pixels[:, :, names.index(name)] for name, weight in WEIGHTS.items())


@dataclasses.dataclass
class Statistics:
    """Statistics of images with different seeds; a block is 16 x 16 pixels."""
    mean: float
    mean_error: float  # standard error, from the spread of each block between seeds
    variance: float  # of a pixel in one image, mean over the pixels
    variance_error: float  # standard error, from the spread over blocks
    block_means: numpy.ndarray
    block_variances: numpy.ndarray  # of these means, over seeds

    @property
    def relative_variance(self):
        return self.variance / self.mean**2


def measure(images):
    images = numpy.asarray(images, float)
    seeds, *size = images.shape
    down, across = ((pixels - 2 * BORDER) // BLOCK for pixels in size)
    blocks = images[:, BORDER:BORDER + down * BLOCK, BORDER:BORDER + across * BLOCK].reshape(seeds, down, BLOCK, across, BLOCK)
    means = blocks.mean(axis=(2, 4))
    mean_variances, variances = means.var(axis=0, ddof=1) / seeds, blocks.var(axis=0, ddof=1).mean(axis=(1, 3))
    return Statistics(means.mean(), numpy.sqrt(mean_variances.sum()) / mean_variances.size, variances.mean(),
                      variances.std(ddof=1) / numpy.sqrt(variances.size), means.mean(axis=0), mean_variances)


@dataclasses.dataclass
class Difference:
    """Difference of two programs' images, relative to the mean of the second."""
    mean: float
    error: float  # standard error of `mean`
    blocks: float  # RMS over blocks of 16 x 16 pixels, without the contribution of noise


def difference(a, b):
    square = ((a.block_means - b.block_means)**2 - a.block_variances - b.block_variances).mean()
    return Difference(a.mean / b.mean - 1, numpy.hypot(a.mean_error, b.mean_error) / b.mean, max(0, square)**0.5 / b.mean)
