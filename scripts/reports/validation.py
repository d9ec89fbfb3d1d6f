"""Writes docs/validation.md: how right the leaf models are, all of it measured."""

import argparse

from tools import machine
from validation_modes import modes
from validation_plane import figures
from validation_reciprocity import reciprocity
from validation_report import Report
from validation_solution import solution
from validation_spectra import spectra
from validation_tables import tables
from validation_walks import f_against_sample, walks
from validation_weaknesses import weaknesses

PARTS = (spectra, tables, modes, figures, walks, solution, f_against_sample, reciprocity, weaknesses)


def main():
    parser = argparse.ArgumentParser()
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
