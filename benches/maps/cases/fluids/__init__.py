"""The maps of fluids, by name."""

from cases.fluids import capillary_waves, impacts, pairs, steps

MAPS = steps.MAPS | capillary_waves.MAPS | pairs.MAPS | impacts.MAPS
