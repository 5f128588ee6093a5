"""The maps of fluids, by name."""

MAPS = {}
