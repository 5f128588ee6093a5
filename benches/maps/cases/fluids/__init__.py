"""The maps of fluids, by name."""

from cases.fluids import impacts, pairs, steps

MAPS = steps.MAPS | pairs.MAPS | impacts.MAPS
