"""The charts of coupling, by name."""

from cases.coupling.masters import masters

CHARTS = {"masters": masters}
