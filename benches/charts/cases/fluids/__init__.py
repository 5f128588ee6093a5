"""The charts of fluids, by name."""

CHARTS = {}
