"""EXR files as frond writes them: scan lines of floats, 16 at a time, compressed by zip."""

import array
import itertools
import re
import struct
import zlib


def read(data, wanted="RGB"):
    """Rows from the top: of each a dictionary from a channel's name to its values."""
    attributes, at = {}, 8
    while data[at]:
        name, kind = (part.decode() for part in data[at:].split(b"\0", 2)[:2])
        at += len(name) + len(kind) + 2
        size, = struct.unpack_from("<i", data, at)
        attributes[name] = data[at + 4:at + 4 + size]
        at += 4 + size
    names = [name.decode() for name in re.findall(rb"([^\0]+)\0.{16}", attributes["channels"], re.DOTALL)]
    if attributes["compression"] != b"\x03" or not set(wanted) <= set(names):
        raise SystemExit("an EXR that cannot be read here")
    x0, y0, x1, y1 = struct.unpack("<4i", attributes["dataWindow"])
    width, height = x1 - x0 + 1, y1 - y0 + 1
    rows = []
    for i, offset in enumerate(struct.unpack_from(f"<{(height + 15) // 16}Q", data, at + 1)):
        lines = min(16, height - 16 * i)
        full = lines * width * len(names) * 4
        size, = struct.unpack_from("<i", data, offset + 4)
        block = data[offset + 8:offset + 8 + size]
        values = array.array("f", block if size == full else unfiltered(zlib.decompress(block)))
        for y in range(lines):
            first = y * len(names) * width
            rows.append({n: values[first + k * width:first + (k + 1) * width] for k, n in enumerate(names) if n in wanted})
    return rows


def unfiltered(data):
    """Undoes what OpenEXR does before zip: differences of bytes, and all even bytes before all odd ones."""
    plain = bytes(itertools.accumulate(data, lambda a, b: (a + b - 128) & 255))
    half = (len(data) + 1) // 2
    out = bytearray(len(data))
    out[0::2], out[1::2] = plain[:half], plain[half:]
    return bytes(out)
