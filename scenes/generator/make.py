#!/usr/bin/python3
"""Makes the meshes and plants of the scenes.

    make.py            writes them beside this folder
    make.py --check    compares them with what is there, byte by byte; exits with 1 if anything differs
"""

import sys
from pathlib import Path

sys.dont_write_bytecode = True  # leaves no files beside the sources
import catalogue  # noqa: E402

SCENES = Path(__file__).resolve().parent.parent


def write(files):
    for name, content in files.items():
        path = SCENES / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(content)
        print(f"{name}: {len(content)} bytes")
    return 0


def check(files):
    wrong = [name for name, content in files.items() if not _holds(SCENES / name, content)]
    for name in wrong:
        print(f"{SCENES / name} is not what the generator makes", file=sys.stderr)
    return 1 if wrong else 0


def _holds(path, content):
    return path.is_file() and path.read_bytes() == content


def main(arguments):
    if arguments not in ([], ["--check"]):
        print(__doc__, file=sys.stderr)
        return 2
    files = catalogue.files()
    return check(files) if arguments else write(files)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
