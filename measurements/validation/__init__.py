"""Measures the accuracy of the leaf models."""
