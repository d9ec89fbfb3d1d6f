"""Reads a part of a render, as frond render --part and --checkpoint write them: docs/part_format.md.

  python3 read_part.py leaf.part             # identity, film and coverage
  python3 read_part.py leaf.part --pixels    # then "x y R G B samples", the mean colour of each pixel

Needs Python's standard library, and zstd: the package zstandard of PyPI, or else the program zstd (Debian: zstd)."""

import json
import signal
import struct
import subprocess
import sys

MAGIC, END = b"frond part 1\n", b"frond part end\n"
TILE = 16
ITEM = struct.Struct("<4i2Q")  # x0 y0 x1 y1, first sample, end
PIXEL_BYTES, BAND_BYTES, BLOCK_BYTES = 128, 48, 64
HITS_BYTES, MEAN_BYTES, ID_BYTES = 24, 16, 8


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
    """The header, and the tiles' records one after the other."""
    if not data.startswith(MAGIC):
        raise SystemExit("no part of a render, or of another version of the format")
    if not data.endswith(END):
        raise SystemExit("the part is cut short")
    (size,) = struct.unpack_from("<Q", data, len(MAGIC))
    begin = len(MAGIC) + 8
    text = data[begin : begin + size]
    (expected,) = struct.unpack_from("<Q", data, begin + size)
    if hash_bytes(text) != expected:
        raise SystemExit("the part's header is damaged")
    return json.loads(text), decompressed(data[begin + size + 8 : -len(END)])


def tiles_of(crop):
    """Rectangles of the tiles, in the file's order: a grid from pixel (0, 0) of the whole picture, cut to the crop."""
    x0, y0, x1, y1 = crop
    for top in range(y0 // TILE * TILE, y1, TILE):
        for left in range(x0 // TILE * TILE, x1, TILE):
            yield max(left, x0), max(top, y0), min(left + TILE, x1), min(top + TILE, y1)


class Pixel:
    """Sums over a pixel's samples; integers, with the units of docs/part_format.md."""

    def __init__(self, record):
        self.sum = [int.from_bytes(record[16 * c : 16 * c + 16], "little", signed=True) for c in range(3)]
        self.square = [int.from_bytes(record[16 * c : 16 * c + 16], "little", signed=True) for c in range(3, 6)]
        self.weight, self.samples, self.leaf, self.not_finite = struct.unpack_from("<q3Q", record, 96)

    def mean(self, exponent):
        if self.weight == 0:
            return [0.0] * 3
        return [s / 2**60 * (2.0**exponent * 2**30 / self.weight) for s in self.sum]


def read(path):
    """The header, and for each tile its rectangle, its coverage and its pixels."""
    with open(path, "rb") as file:
        header, data = split(file.read())
    film = header["film"]
    features = film["means"] * MEAN_BYTES + film["ids"] * ID_BYTES
    of_pixel = (PIXEL_BYTES + film["bands"] * BAND_BYTES + (features + HITS_BYTES if features else 0) +
                film["blocks"] * BLOCK_BYTES)
    tiles, at = [], 0
    for rectangle in tiles_of(film["crop"]):
        (items,) = struct.unpack_from("<Q", data, at)
        at += 8
        coverage = [ITEM.unpack_from(data, at + ITEM.size * i) for i in range(items)]
        at += ITEM.size * items
        x0, y0, x1, y1 = rectangle
        count = (x1 - x0) * (y1 - y0)
        pixels = [Pixel(data[at + PIXEL_BYTES * i : at + PIXEL_BYTES * (i + 1)]) for i in range(count)]
        at += count * of_pixel + 8  # the rays come last
        tiles.append((rectangle, coverage, pixels))
    if at != len(data):
        raise SystemExit("the part is damaged")
    return header, tiles


def print_summary(header, tiles):
    print("identity:")
    for name, value in header["identity"]:
        print(f"  {name}: {value}")
    film = header["film"]
    print("film: {} x {}, crop {}, {}".format(film["width"], film["height"], film["crop"],
                                              f"{film['bands']} bands" if film["bands"] else header["picture"]["space"]))
    print("coverage:")
    covered = {}  # rectangles that have the same samples
    for _, coverage, _ in tiles:
        for x0, y0, x1, y1, first, end in coverage:
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
    for (x0, y0, x1, _), _, pixels in tiles:
        for i, pixel in enumerate(pixels):
            x, y = x0 + i % (x1 - x0), y0 + i // (x1 - x0)
            print(x, y, *(f"{v:.9g}" for v in pixel.mean(header["film"]["exponent"])), pixel.samples)


if __name__ == "__main__":
    main()
