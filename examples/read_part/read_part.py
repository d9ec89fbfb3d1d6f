"""Reads a part, as frond render --part and --checkpoint write it (format: docs/many_machines.md).

  python3 read_part.py leaf.part             # identity, film and coverage
  python3 read_part.py leaf.part --pixels    # then "x y R G B samples", the mean colour of each pixel

Needs Python's standard library, and zstd: the package zstandard of PyPI, or else the program zstd (Debian: zstd)."""

import json
import signal
import struct
import subprocess
import sys

MAGIC, END = b"frond part 4\n", b"frond part end\n"
TILE = 16
ITEM = struct.Struct("<4i2Q")  # x0 y0 x1 y1, first sample, end
PIXEL_BYTES, BAND_BYTES = 128, 48
HITS_BYTES, MEAN_BYTES, ID_BYTES = 24, 16, 8
SPLAT_BYTES, BAND_SPLAT_BYTES = 64, 32


def decompressed(frame):
    try:
        import zstandard
    except ImportError:
        return subprocess.run(["zstd", "-dc"], input=frame, stdout=subprocess.PIPE, check=True).stdout
    return zstandard.ZstdDecompressor().decompressobj().decompress(frame)


def hash_bytes(data):
    """FNV-1a of 64 bits, then mixed."""
    mask = 2**64 - 1
    h = 0xCBF29CE484222325
    for byte in data:
        h = (h ^ byte) * 0x100000001B3 & mask
    h = (h ^ h >> 30) * 0xBF58476D1CE4E5B9 & mask
    h = (h ^ h >> 27) * 0x94D049BB133111EB & mask
    return h ^ h >> 31


def split(data):
    """The header, and the records of the tiles, one after the other."""
    if not data.startswith(MAGIC):
        raise SystemExit("not a part, or a part in another version of the format")
    if not data.endswith(END):
        raise SystemExit("the part is incomplete")
    (size,) = struct.unpack_from("<Q", data, len(MAGIC))
    begin = len(MAGIC) + 8
    text = data[begin : begin + size]
    (expected,) = struct.unpack_from("<Q", data, begin + size)
    if hash_bytes(text) != expected:
        raise SystemExit("the part's header is damaged")
    return json.loads(text), decompressed(data[begin + size + 8 : -len(END)])


def tiles_of(pixels):
    """Rectangles of the tiles, in the file's order: a grid from pixel (0, 0) of the whole image, cut to the pixels
    whose samples the part has."""
    x0, y0, x1, y1 = pixels
    for top in range(y0 // TILE * TILE, y1, TILE):
        for left in range(x0 // TILE * TILE, x1, TILE):
            yield max(left, x0), max(top, y0), min(left + TILE, x1), min(top + TILE, y1)


class Pixel:
    """Sums over a pixel's samples; integers, with the units of docs/many_machines.md."""

    def __init__(self, record):
        self.sum = [int.from_bytes(record[16 * c : 16 * c + 16], "little", signed=True) for c in range(3)]
        self.square = [int.from_bytes(record[16 * c : 16 * c + 16], "little", signed=True) for c in range(3, 6)]
        self.weight, self.samples, self.leaf, self.not_finite = struct.unpack_from("<q3Q", record, 96)

    def mean(self, exponent):
        if self.weight == 0:
            return [0.0] * 3
        return [s / 2**60 * (2.0**exponent * 2**30 / self.weight) for s in self.sum]


def integer(record, at):
    return int.from_bytes(record[at : at + 16], "little", signed=True)


class Splat:
    """Contribution of a tile's samples to a pixel that they reach, each times its weight."""

    def __init__(self, record):
        self.sum = [integer(record, 16 * c) for c in range(3)]
        (self.weight,) = struct.unpack_from("<q", record, 48)


def samples_of_pixel(tile):
    """Number of samples per pixel, as a mean over a tile's pixels."""
    (x0, y0, x1, y1), coverage = tile["rectangle"], tile["coverage"]
    taken = sum((item[2] - item[0]) * (item[3] - item[1]) * (item[5] - item[4]) for item in coverage)
    return taken / ((x1 - x0) * (y1 - y0))


def read(path):
    """The header, and for each tile its rectangle, its coverage, its pixels by (x, y) and, if samples are shared, its splats
    by (x, y)."""
    with open(path, "rb") as file:
        header, data = split(file.read())
    film = header["film"]
    splatting = film["splatting"]
    reach = [axis["reach"] for axis in splatting["axes"]] if splatting else None
    features = film["means"] * MEAN_BYTES + film["ids"] * ID_BYTES
    of_pixel = PIXEL_BYTES + film["bands"] * BAND_BYTES + (features + HITS_BYTES if features else 0)
    of_splat = SPLAT_BYTES + film["bands"] * BAND_SPLAT_BYTES
    tiles, at = [], 0
    for rectangle in tiles_of(splatting["sampled"] if splatting else film["crop"]):
        (items,) = struct.unpack_from("<Q", data, at)
        at += 8
        coverage = [ITEM.unpack_from(data, at + ITEM.size * i) for i in range(items)]
        at += ITEM.size * items
        x0, y0, x1, y1 = rectangle
        positions = [(x, y) for y in range(y0, y1) for x in range(x0, x1)]
        pixels = {position: Pixel(data[at + PIXEL_BYTES * i : at + PIXEL_BYTES * (i + 1)]) for i, position in enumerate(positions)}
        at += len(positions) * of_pixel
        splats = {}
        if splatting:
            columns = range(max(x0 - reach[0], 0), min(x1 + reach[0], film["width"]))
            rows = range(max(y0 - reach[1], 0), min(y1 + reach[1], film["height"]))
            positions = [(x, y) for y in rows for x in columns]
            for i, position in enumerate(positions):
                splats[position] = Splat(data[at + SPLAT_BYTES * i : at + SPLAT_BYTES * (i + 1)])
            at += len(positions) * of_splat
        if film["halves"]:
            at += 8 + len(positions) * SPLAT_BYTES  # the first part of the samples
        at += 8  # rays
        tiles.append({"rectangle": rectangle, "coverage": coverage, "pixels": pixels, "splats": splats})
    if at != len(data):
        raise SystemExit("the part is damaged")
    return header, tiles


def expected_weight(splatting, tiles, position):
    """Expected sum of weights in a pixel, for samples that are evenly distributed in their pixels."""
    x, y = position
    (reach_x, mean_x), (reach_y, mean_y) = ((axis["reach"], axis["mean"]) for axis in splatting["axes"])
    weight = 0.0
    for tile in tiles:
        for py in range(y - reach_y, y + reach_y + 1):
            for px in range(x - reach_x, x + reach_x + 1):
                if (px, py) in tile["pixels"]:
                    share = tile["pixels"][px, py].samples / samples_of_pixel(tile)
                    weight += share * mean_x[x - px + reach_x] * mean_y[y - py + reach_y]
    return weight


def mean_colors(header, tiles):
    """The mean colour of each pixel of the crop and its number of samples, by (x, y)."""
    film = header["film"]
    x0, y0, x1, y1 = film["crop"]
    means = {}
    if not film["splatting"]:
        for tile in tiles:
            for position, pixel in tile["pixels"].items():
                means[position] = pixel.mean(film["exponent"]), pixel.samples
        return means
    gathered = {(x, y): [0.0] * 4 for y in range(y0, y1) for x in range(x0, x1)}
    samples = {}
    for tile in tiles:
        count = samples_of_pixel(tile)
        if count == 0:
            continue
        samples.update((position, pixel.samples) for position, pixel in tile["pixels"].items())
        for position, splat in tile["splats"].items():
            if position in gathered:
                sums = gathered[position]
                for c in range(3):
                    sums[c] += splat.sum[c] / 2**60 / count
                sums[3] += splat.weight / 2**30 / count
    for position, (*sums, weight) in gathered.items():
        if film["splatting"]["has_negative_weights"]:
            expected = expected_weight(film["splatting"], tiles, position)
            weight = weight if weight >= expected / 4 else max(expected, 0.0)
        scale = 2.0 ** film["exponent"] / weight if weight > 0 else 0.0
        means[position] = [s * scale for s in sums], samples.get(position, 0)
    return means


def print_summary(header, tiles):
    print("identity:")
    for name, value in header["identity"]:
        print(f"  {name}: {value}")
    film = header["film"]
    print("film: {} x {}, crop {}, {}".format(film["width"], film["height"], film["crop"],
                                              f"{film['bands']} bands" if film["bands"] else header["image"]["space"]))
    print("coverage:")
    covered = {}  # number of pixels, by range of samples
    for tile in tiles:
        for x0, y0, x1, y1, first, end in tile["coverage"]:
            covered[first, end] = covered.get((first, end), 0) + (x1 - x0) * (y1 - y0)
    for (first, end), pixels in sorted(covered.items()):
        print(f"  samples {first}:{end} of {pixels} pixels")


def main():
    if len(sys.argv) not in (2, 3) or sys.argv[2:] not in ([], ["--pixels"]):
        raise SystemExit(__doc__)
    signal.signal(signal.SIGPIPE, signal.SIG_DFL)
    header, tiles = read(sys.argv[1])
    print_summary(header, tiles)
    if len(sys.argv) == 2:
        return
    if header["film"]["bands"]:
        raise SystemExit("a film of bands has no colours")
    for (x, y), (color, samples) in sorted(mean_colors(header, tiles).items(), key=lambda item: item[0][::-1]):
        print(x, y, *(f"{v:.9g}" for v in color), samples)


if __name__ == "__main__":
    main()
