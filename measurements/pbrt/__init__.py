"""Compares frond with pbrt-v4."""
