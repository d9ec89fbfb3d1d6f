"""Runs every ```sh block of docs/cookbook.md, one after the other, in a folder of its own; fails on the first that fails.

usage: cookbook_test.py BUILD_DIR FOLDER
The build is installed into FOLDER, and its frond is the one in the path."""

import os
import pathlib
import re
import shutil
import subprocess
import sys
import time

ROOT = pathlib.Path(__file__).resolve().parents[2]
PAGE = ROOT / "docs" / "cookbook.md"


def blocks(text):
    """Line numbers and commands."""
    for match in re.finditer(r"^```sh\n(.*?)^```$", text, re.M | re.S):
        yield text.count("\n", 0, match.start(1)) + 1, match[1]


def scratch(build, folder):
    """The folder where commands run, with what a clone has, and their environment."""
    shutil.rmtree(folder, ignore_errors=True)
    prefix, here = folder / "prefix", folder / "clone"
    here.mkdir(parents=True)
    subprocess.run(["cmake", "--install", build, "--prefix", prefix], check=True, stdout=subprocess.DEVNULL)
    for name in ("scenes", "examples", "tests"):
        (here / name).symlink_to(ROOT / name)
    return here, os.environ | {"PATH": f"{prefix / 'bin'}:{os.environ['PATH']}", "XDG_CACHE_HOME": str(folder / "cache")}


def main(build, folder):
    here, environment = scratch(build, pathlib.Path(folder).resolve())
    count = 0
    for line, commands in blocks(PAGE.read_text(encoding="utf-8")):
        count += 1
        start = time.monotonic()
        r = subprocess.run(["bash", "-euo", "pipefail", "-c", commands], cwd=here, env=environment, text=True, check=False,
                           stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
        print(f"docs/cookbook.md:{line}: {time.monotonic() - start:.1f} s", flush=True)
        if r.returncode != 0:
            sys.exit(f"{commands}\n{r.stdout}\nexit code {r.returncode}")
    if count < 10:
        sys.exit(f"docs/cookbook.md has {count} blocks of commands: are they ```sh?")


main(*sys.argv[1:])
