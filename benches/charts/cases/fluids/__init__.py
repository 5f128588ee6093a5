"""The charts of fluids, by name."""

from cases.fluids.dam import dam
from cases.fluids.impact import impact
from cases.fluids.records import records
from cases.fluids.swing import swing
from cases.fluids.vortices import vortices

CHARTS = {of.__name__: of for of in (vortices, dam, swing, impact, records)}
