"""Limits of the methods: cases with extreme parameters and their expected results (docs/results/stability.md)

Runs frond_stability. Fails if a method's result is not the expected one.
"""

from .shared.tools import BUILD, ROOT, run, write

if __name__ == "__main__":
    write(ROOT / "docs" / "results" / "stability.md", run(BUILD / "tests" / "frond_stability", "--markdown"))
