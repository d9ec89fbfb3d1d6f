"""Profiles a render."""
