"""The command `frond` of a wheel: starts the program that lies in the package."""

import os
import sys
from pathlib import Path


def main():
    """Replaces this process by the program, so that signals, exit status and output are its own."""
    program = Path(__file__).with_name("bin") / "frond"
    os.execv(program, [sys.argv[0], *sys.argv[1:]])
