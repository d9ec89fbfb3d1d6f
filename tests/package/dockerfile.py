"""Prints the steps of a Dockerfile as assignments of bash, for scripts/container. Of Docker's instructions those are read that
frond's Dockerfile has; others are errors.

usage: dockerfile.py FILE"""

import json
import pathlib
import re
import shlex
import sys


def steps(text):
    """base, mount, run_commands, environment, folder and entry of a Dockerfile with one stage."""
    text = re.sub(r"^\s*#.*\n", "", text, flags=re.M)
    found = {"base": "", "mount": "", "run_commands": [], "environment": [], "folder": "/", "entry": []}
    for line in re.sub(r"\\\n\s*", " ", text).splitlines():
        instruction, _, rest = line.partition(" ")
        rest = rest.strip()
        if instruction == "FROM":
            if found["base"]:
                raise ValueError("a second stage")
            found["base"] = rest
        elif instruction == "RUN":
            mount = re.match(r"--mount=type=bind,target=(/\S+)\s+", rest)
            if mount:
                found["mount"] = mount[1]
                rest = rest[mount.end():]
            if rest.startswith("--"):
                raise ValueError(line)
            found["run_commands"].append(rest)
        elif instruction == "ENV":
            found["environment"] += shlex.split(rest)
        elif instruction == "WORKDIR":
            found["folder"] = rest
        elif instruction == "ENTRYPOINT":
            found["entry"] = json.loads(rest)
        elif instruction not in ("", "LABEL", "CMD"):
            raise ValueError(line)
    return found


def main(path):
    for name, value in steps(pathlib.Path(path).read_text(encoding="utf-8")).items():
        print(f"{name}={shlex.quote(value)}" if isinstance(value, str) else f"{name}=({shlex.join(value)})")


if __name__ == "__main__":
    main(sys.argv[1])
