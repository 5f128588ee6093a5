"""The maps of coupling, by name."""

from cases.coupling.lengths import lengths
from cases.coupling.lumps import gauss_seidel, iterate, jacobi
from cases.coupling.records import records
from cases.coupling.rings import rings
from cases.coupling.slabs import slabs
from cases.coupling.solids import touching_solids

MAPS = {
    "coupling_jacobi": jacobi,
    "coupling_gauss_seidel": gauss_seidel,
    "coupling_iterate": iterate,
    "coupling_slabs": slabs,
    "coupling_rings": rings,
    "coupling_solids": touching_solids,
    "coupling_lengths": lengths,
    "coupling_records": records,
}
