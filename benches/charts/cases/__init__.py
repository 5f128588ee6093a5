"""The charts, by name."""

from cases.spot import spot

CHARTS = {"spot": spot}
