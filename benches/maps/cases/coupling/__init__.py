"""The maps of coupling, by name."""

from cases.coupling.lumps import gauss_seidel, iterate, jacobi

MAPS = {
    "coupling_jacobi": jacobi,
    "coupling_gauss_seidel": gauss_seidel,
    "coupling_iterate": iterate,
}
