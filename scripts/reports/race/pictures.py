"""Pictures as rows of luminance, and what can be said of several that differ in their seeds alone."""

import array
import dataclasses
import math
import pathlib
import re
import statistics

import exr

WEIGHTS = {"R": 0.2126, "G": 0.7152, "B": 0.0722}
BORDER = 2  # pixels left out on each side: a filter that splats has fewer samples there
BLOCK = 16


def read(path):
    """Luminance, row by row from the top, of a PFM or of an EXR as frond writes it."""
    data = pathlib.Path(path).read_bytes()
    return read_pfm(data) if data[:2] == b"PF" else [luminance(row) for row in exr.read(data)]


def read_pfm(data):
    head = re.match(rb"PF\s+(\d+)\s+(\d+)\s+(\S+)\s", data)
    width, height = int(head[1]), int(head[2])
    values = array.array("f", data[head.end():])
    if float(head[3]) > 0:
        values.byteswap()
    r, g, b = (values[i::3] for i in range(3))
    gray = luminance({"R": r, "G": g, "B": b})
    return [gray[y * width:(y + 1) * width] for y in reversed(range(height))]


def luminance(channels):
    r, g, b = (channels[n] for n in "RGB")
    wr, wg, wb = (WEIGHTS[n] for n in "RGB")
    return array.array("f", [wr * x + wg * y + wb * z for x, y, z in zip(r, g, b)])


@dataclasses.dataclass
class Block:
    """Some pixels: mean over them, and its variance over seeds; mean of the pixels' variances."""
    mean: float
    mean_variance: float
    pixel_variance: float


@dataclasses.dataclass
class Statistics:
    """Of the pictures of several seeds."""
    mean: float
    mean_error: float  # standard error, from the spread of each block between seeds
    variance: float  # of one picture's pixel, mean over pixels
    variance_error: float  # standard error, from the spread over blocks of pixels
    blocks: list
    seeds: int

    @property
    def relative_variance(self):
        return self.variance / self.mean**2


def measure(pictures):
    count = len(pictures)
    height, width = len(pictures[0]), len(pictures[0][0])
    blocks = []
    for y in range(BORDER, height - BORDER - BLOCK + 1, BLOCK):
        for x in range(BORDER, width - BORDER - BLOCK + 1, BLOCK):
            parts = [[v for row in p[y:y + BLOCK] for v in row[x:x + BLOCK]] for p in pictures]
            sums = [statistics.fmean(part) for part in parts]
            total = list(map(sum, zip(*parts)))
            squares = sum(v * v for part in parts for v in part)
            within = (squares - sum(t * t for t in total) / count) / (count - 1) / BLOCK**2
            blocks.append(Block(statistics.fmean(sums), statistics.variance(sums) / count, max(0, within)))
    variances = [b.pixel_variance for b in blocks]
    return Statistics(statistics.fmean(b.mean for b in blocks), math.sqrt(sum(b.mean_variance for b in blocks)) / len(blocks),
                      statistics.fmean(variances), statistics.stdev(variances) / math.sqrt(len(blocks)), blocks, count)


@dataclasses.dataclass
class Difference:
    """Of two programs' pictures, relative to the mean of the second."""
    mean: float
    error: float  # standard error of that
    blocks: float  # RMS over blocks of 16 x 16 pixels, less what noise makes


def difference(a, b):
    square = statistics.fmean((x.mean - y.mean)**2 - x.mean_variance - y.mean_variance for x, y in zip(a.blocks, b.blocks))
    return Difference(a.mean / b.mean - 1, math.hypot(a.mean_error, b.mean_error) / b.mean,
                      math.sqrt(max(0, square)) / b.mean)
