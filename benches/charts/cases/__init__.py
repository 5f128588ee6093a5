"""The charts, by name."""

from cases import coupling, fluids, solids

CHARTS = solids.CHARTS | fluids.CHARTS | coupling.CHARTS
