"""Renders random scenes of all plug-ins in one process for hours."""
