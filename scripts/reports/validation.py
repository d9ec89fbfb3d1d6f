"""Writes docs/validation.md: how right the leaf models are, all of it measured."""

import argparse

from tools import machine
from validation_bsdf import figures, reciprocity, solution
from validation_leaf import f_against_sample, modes, spectra, tables, walks, weaknesses
from validation_report import Report

PARTS = (spectra, tables, modes, figures, walks, solution, f_against_sample, reciprocity, weaknesses)


def main():
    parser = argparse.ArgumentParser(prog="scripts/validation")
    parser.add_argument("--quick", action="store_true")
    parser.add_argument("--only", metavar="PART", nargs="+", choices=[part.__name__ for part in PARTS], default=[],
                        help="measure these parts anew and leave the others as they are")
    options = parser.parse_args()
    report = Report(options.quick)
    if not options.only:
        report.add(f"""
# Validation

Made by `scripts/validation`{' --quick' if report.quick else ''} from what it measured, on {machine()}.
""")
    for part in PARTS:
        if options.only and part.__name__ not in options.only:
            continue
        print(part.__name__, flush=True)
        part(report)
    report.write(renewed=bool(options.only))


if __name__ == "__main__":
    main()
