"""Accuracy of the leaf models (docs/results/validation.md)

Writes charts, too.
  --only PART ...   measures these parts again: spectra, tables, modes, figures, walks, solution, f_against_sample, reciprocity,
                    weaknesses
  --quick           a hundredth of the rays, into build/validation_report
"""

import argparse

from ..shared.tools import machine
from .bsdf import figures, reciprocity, solution
from .leaf import f_against_sample, modes, spectra, tables, walks, weaknesses
from .report import Report

PARTS = (spectra, tables, modes, figures, walks, solution, f_against_sample, reciprocity, weaknesses)


def main():
    parser = argparse.ArgumentParser(prog="measurements/run validation")
    parser.add_argument("--quick", action="store_true")
    parser.add_argument("--only", metavar="PART", nargs="+", choices=[part.__name__ for part in PARTS], default=[],
                        help="measure these parts again and keep the others")
    options = parser.parse_args()
    report = Report(options.quick)
    if not options.only:
        report.add(f"""
# Validation

For readers who need to know how accurate frond's leaf models are: against measured leaves, against the published figures, and
against each other.

```sh
measurements/run validation --quick
```

With `--quick` the script traces a hundredth of the rays and writes into `build/validation_report`. Without it, the script writes
this page; `--only PART` measures single parts again. [The paper's experiments](paper.md) repeat the errors and speed-ups of the
publication; [Limits of the methods](stability.md) has cases with extreme parameters.

Written by `measurements/run validation`{' --quick' if report.quick else ''}: {machine()}.
""")
    for part in PARTS:
        if options.only and part.__name__ not in options.only:
            continue
        print(part.__name__, flush=True)
        part(report)
    report.write(renewed=bool(options.only))


if __name__ == "__main__":
    main()
