"""Repeats the experiments of the paper on the leaf models."""
