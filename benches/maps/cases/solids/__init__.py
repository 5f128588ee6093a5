"""The maps of solids, by name."""

MAPS = {}
