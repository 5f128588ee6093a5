"""The charts of coupling, by name."""

from cases.coupling.masters import masters
from cases.coupling.reduced import reduced

CHARTS = {"masters": masters, "reduced": reduced}
