"""Copies a shared library so that its calls of std::condition_variable::wait take the version of the symbol that libstdc++ of GCC 11 has, as
older_symbols.cpp does where a library is compiled: scripts/wheel, for Google Benchmark, which Debian packages as a shared library only.

usage: older_version.py FROM TO"""

import pathlib
import struct
import sys

NEWER, OLDER = b"GLIBCXX_3.4.30", b"GLIBCXX_3.4.11"


def elf_hash(name):
    """Of the ELF specification; the table of needed versions has it beside each name."""
    value = 0
    for byte in name:
        value = (value << 4) + byte
        high = value & 0xF0000000
        value = (value ^ (high >> 24)) & ~high
    return value


def replaced(data):
    for before, after in ((b"\0%b\0" % NEWER, b"\0%b\0" % OLDER), (struct.pack("<I", elf_hash(NEWER)), struct.pack("<I", elf_hash(OLDER)))):
        if data.count(before) != 1:
            raise ValueError(f"{data.count(before)} entries of {NEWER.decode()} where one is expected")
        data = data.replace(before, after)
    return data


if __name__ == "__main__":
    pathlib.Path(sys.argv[2]).write_bytes(replaced(pathlib.Path(sys.argv[1]).read_bytes()))
