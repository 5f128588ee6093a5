"""The maps of coupling, by name."""

MAPS = {}
