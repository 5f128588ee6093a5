"""The charts of solids, by name."""

from cases.solids.spot import spot

CHARTS = {"spot": spot}
