"""examples/read_part reads parts as docs/many_machines.md describes them: its colours equal those of frond's EXR file, to the bit.

usage: read_part_test.py FROND; exits with 77 where there is no zstd."""

import importlib.util
import pathlib
import shutil
import struct
import subprocess
import sys
import tempfile
import zlib

ROOT = pathlib.Path(__file__).resolve().parents[2]
SCENE = ROOT / "scenes" / "hundred-leaves" / "scene.pbrt"
sys.dont_write_bytecode = True
sys.path.insert(0, str(ROOT / "examples" / "read_part"))


def exr_header(data):
    """Attributes by name, and where the pixels' offsets begin."""
    at, attributes = 8, {}
    while data[at]:
        name = data[at : data.index(0, at)]
        at = data.index(0, at) + 1
        at = data.index(0, at) + 1  # the type
        (size,) = struct.unpack_from("<i", data, at)
        attributes[name.decode()] = data[at + 4 : at + 4 + size]
        at += 4 + size
    return attributes, at + 1


def unzipped(raw):
    """Inverse of OpenEXR's transformation before zlib: differences of neighbours, and even bytes before odd ones."""
    data = bytearray(zlib.decompress(raw))
    for i in range(1, len(data)):
        data[i] = (data[i - 1] + data[i] - 128) & 255
    half = (len(data) + 1) // 2
    data[0::2], data[1::2] = data[:half], data[half:]
    return bytes(data)


def read_exr(path):
    """Values of channels of 32-bit floats by (channel, x, y), of a file of scan lines with zip compression."""
    data = path.read_bytes()
    attributes, at = exr_header(data)
    channels, names = attributes["channels"], []
    while channels[0]:
        name, _, channels = channels.partition(b"\0")
        names.append(name.decode())
        channels = channels[16:]
    x0, y0, x1, y1 = struct.unpack("<4i", attributes["dataWindow"])
    width, values = x1 - x0 + 1, {}
    for offset in struct.unpack_from(f"<{(y1 - y0) // 16 + 1}Q", data, at):
        top, size = struct.unpack_from("<2i", data, offset)
        rows = min(16, y1 - top + 1)
        raw = data[offset + 8 : offset + 8 + size]
        if size < rows * width * 4 * len(names):
            raw = unzipped(raw)
        floats = iter(struct.unpack(f"<{rows * width * len(names)}f", raw))
        for y in range(top, top + rows):
            for name in names:
                for x in range(x0, x1 + 1):
                    values[name, x, y] = next(floats)
    return values


def rounded(value):
    return struct.unpack("<f", struct.pack("<f", value))[0]


def check(frond, folder, *options):
    import read_part

    part, image = folder / "leaf.part", folder / "leaf.exr"
    part.unlink(missing_ok=True)
    # A crop that cuts tiles.
    subprocess.run([frond, "render", SCENE, "--pixels", "230,281,250,300", "--part", part, "-q", *options], check=True)
    subprocess.run([frond, "merge", part, "-o", image, "--allow-holes", "-q"], check=True)
    exr = read_exr(image)
    header, tiles = read_part.read(part)
    assert all(tile["coverage"] for tile in tiles), "a tile that nothing covers"
    assert bool(header["film"]["splatting"]) == ("box" not in options)
    colors = read_part.mean_colors(header, tiles)
    for (x, y), (color, samples) in colors.items():
        for name, value in zip("RGB", color):
            assert rounded(value) == exr[name, x, y], (options, name, x, y)
        if ("samples", x, y) in exr:
            assert samples == exr["samples", x, y]
    assert len(colors) == 51 * 50, len(colors)
    assert dict(map(tuple, header["identity"]))["wavelengths"] == "hero"


def main():
    if not shutil.which("zstd") and not importlib.util.find_spec("zstandard"):
        print("skipped: no zstd")
        sys.exit(77)
    frond = pathlib.Path(sys.argv[1]).resolve()
    with tempfile.TemporaryDirectory() as name:
        for options in (["--spp", "4"], ["--samples", "5:29", "--channels", "samples,normal"],
                        ["--max-rms", "0.02", "--channels", "samples"], ["--spp", "3", "--filter", "box"],
                        ["--spp", "1", "--filter", "sinc"], ["--max-rms", "0.02", "--filter", "box"]):
            check(frond, pathlib.Path(name), *options)


if __name__ == "__main__":
    main()
