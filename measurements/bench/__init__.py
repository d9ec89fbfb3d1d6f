"""Runs the benchmarks and compares two runs of them (docs/performance.md)."""
