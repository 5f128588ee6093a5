"""The charts of solids, by name."""

from cases.solids.fronts import layers, melting
from cases.solids.pressure import pressure
from cases.solids.spot import spot

CHARTS = {"spot": spot, "pressure": pressure, "layers": layers, "melting": melting}
