"""The maps, by name."""

from cases import coupling, fluids, solids

MAPS = solids.MAPS | fluids.MAPS | coupling.MAPS
