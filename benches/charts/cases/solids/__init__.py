"""The charts of solids, by name."""

from cases.solids.alumina_plate import alumina_plate
from cases.solids.contact import contact
from cases.solids.fronts import layers, melting
from cases.solids.pressure import pressure
from cases.solids.spot import spot
from cases.solids.yielding import yielding

CHARTS = {
    of.__name__: of for of in (spot, alumina_plate, pressure, layers, melting, contact, yielding)
}
