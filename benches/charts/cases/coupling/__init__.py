"""The charts of coupling, by name."""

CHARTS = {}
