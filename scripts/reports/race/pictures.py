"""Pictures as rows of luminance, and what can be said of several that differ in their seeds alone."""

import array
import dataclasses
import math
import pathlib
import re
import statistics
import struct
import zlib

WEIGHTS = {"R": 0.2126, "G": 0.7152, "B": 0.0722}
BORDER = 2  # pixels left out on each side: a filter that splats has fewer samples there
BLOCK = 16


def read(path):
    """Luminance, row by row from the top, of a PFM or of an EXR as frond writes it."""
    data = pathlib.Path(path).read_bytes()
    return read_pfm(data) if data[:2] == b"PF" else read_exr(data)


def read_pfm(data):
    head = re.match(rb"PF\s+(\d+)\s+(\d+)\s+(\S+)\s", data)
    width, height = int(head[1]), int(head[2])
    values = array.array("f", data[head.end():])
    if float(head[3]) > 0:
        values.byteswap()
    r, g, b = (values[i::3] for i in range(3))
    gray = luminance({"R": r, "G": g, "B": b})
    return [gray[y * width:(y + 1) * width] for y in reversed(range(height))]


def read_exr(data):
    """Scan lines of floats, 16 at a time, compressed by zip."""
    attributes, at = {}, 8
    while data[at]:
        name, kind = (part.decode() for part in data[at:].split(b"\0", 2)[:2])
        at += len(name) + len(kind) + 2
        size, = struct.unpack_from("<i", data, at)
        attributes[name] = data[at + 4:at + 4 + size]
        at += 4 + size
    if attributes["compression"] != b"\x03":
        raise SystemExit("an EXR that the race cannot read")
    x0, y0, x1, y1 = struct.unpack("<4i", attributes["dataWindow"])
    width, height = x1 - x0 + 1, y1 - y0 + 1
    names = [name.decode() for name in re.findall(rb"([^\0]+)\0.{16}", attributes["channels"], re.DOTALL)]
    offsets = struct.unpack_from(f"<{(height + 15) // 16}Q", data, at + 1)
    rows = []
    for i, offset in enumerate(offsets):
        lines = min(16, height - 16 * i)
        full = lines * width * len(names) * 4
        size, = struct.unpack_from("<i", data, offset + 4)
        block = data[offset + 8:offset + 8 + size]
        values = array.array("f", block if size == full else unfiltered(zlib.decompress(block)))
        for y in range(lines):
            first = y * len(names) * width
            row = {n: values[first + k * width:first + (k + 1) * width] for k, n in enumerate(names) if n in WEIGHTS}
            rows.append(luminance(row))
    return rows


def unfiltered(data):
    """Undoes what OpenEXR does before zip: differences of bytes, and all even bytes before all odd ones."""
    out = bytearray(len(data))
    value, half = 128, (len(data) + 1) // 2
    plain = bytearray(len(data))
    for i, byte in enumerate(data):
        value = (value + byte - 128) & 255
        plain[i] = value
    plain[0] = data[0]
    out[0::2], out[1::2] = plain[:half], plain[half:]
    return bytes(out)


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
