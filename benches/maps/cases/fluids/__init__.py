"""The maps of fluids, by name."""

from cases.fluids import impacts, pairs, steps, surfaces

MAPS = steps.MAPS | surfaces.MAPS | pairs.MAPS | impacts.MAPS
