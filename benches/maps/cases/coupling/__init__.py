"""The maps of coupling, by name."""

from cases.coupling.contact import contact_exchanges, contact_prandtl, contact_spacing
from cases.coupling.lengths import lengths
from cases.coupling.liquids import (
    heat_of_films,
    heat_of_pairs,
    temperature_of_films,
    temperature_of_pairs,
)
from cases.coupling.lumps import gauss_seidel, iterate, jacobi
from cases.coupling.records import records
from cases.coupling.reductions import reductions
from cases.coupling.rings import rings
from cases.coupling.slabs import slabs
from cases.coupling.solids import touching_solids

MAPS = {
    "coupling_jacobi": jacobi,
    "coupling_gauss_seidel": gauss_seidel,
    "coupling_iterate": iterate,
    "coupling_slabs": slabs,
    "coupling_rings": rings,
    "coupling_contact": contact_spacing,
    "coupling_prandtl": contact_prandtl,
    "coupling_exchanges": contact_exchanges,
    "coupling_solids": touching_solids,
    "coupling_reductions": reductions,
    "coupling_lengths": lengths,
    "coupling_records": records,
    "coupling_pairs_heat": heat_of_pairs,
    "coupling_pairs_temperature": temperature_of_pairs,
    "coupling_films_heat": heat_of_films,
    "coupling_films_temperature": temperature_of_films,
}
