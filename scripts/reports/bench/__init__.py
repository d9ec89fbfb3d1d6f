"""Runs the benchmarks and compares two runs of them (docs/benchmarks.md)."""
