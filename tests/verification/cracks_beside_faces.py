"""Stress intensity of cracks near a free face, by finite elements (scikit-fem): how far the
formulas of flaws hold, those of a half plane and of an infinite body.

The faces of a crack of length 1 bear a uniform pressure. An edge crack in plane strain is parallel
to a free face, and so is a penny, both at a distance d. The energy release rate is the difference
of energies of two crack lengths. Exit code 1 if the formulas are off by more than 2 % far from a
face, or by more than 6.5 % at the distances from which `flaw_near_face` is silent.
"""

import sys

import numpy as np
from skfem import (
    Basis,
    BilinearForm,
    ElementQuad2,
    ElementVector,
    FacetBasis,
    LinearForm,
    MeshQuad,
    condense,
    solve,
)
from skfem.helpers import ddot, dot, eye, sym_grad, trace

POISSON = 0.3
SIZE = 1 / 16  # of elements at the crack
FAR, GROWTH, FINE = 40.0, 1.3, 1.7
FREE = {"edge crack": 5.0, "penny": 2.0}  # as `Flaw::FREE`
EXACT = {"edge crack": 1.1215 * np.pi**0.5, "penny": 2 / np.pi**0.5}
FAR_OFF, NEAR_OFF = 0.02, 0.065


def graded(end: float) -> np.ndarray:
    """Places from 0 to an end, evenly spaced beside the crack."""
    places, size = [0.0], SIZE
    while places[-1] < end - 1e-9:
        size *= GROWTH if places[-1] > FINE else 1.0
        places.append(min(end, places[-1] + size))
    return np.array(places)


def cracked(distance: float, length: float) -> MeshQuad:
    """A mesh whose left end is the face, with a crack along x = 0 from y = 0 on."""
    across = np.concatenate([-graded(distance)[:0:-1], graded(FAR)])
    mesh = MeshQuad.init_tensor(across, graded(FAR))
    points, corners = mesh.p.copy(), mesh.t.copy()
    opened = np.flatnonzero((abs(points[0]) < 1e-9) & (points[1] < length - 1e-9))
    other = np.arange(points.shape[1])
    other[opened] = points.shape[1] + np.arange(len(opened))
    right = points[0][corners].mean(axis=0) > 0
    corners[:, right] = other[corners[:, right]]
    return MeshQuad(np.hstack([points, points[:, opened]]), corners)


def energy(kind: str, distance: float, length: float) -> float:
    """Elastic energy at a Young's modulus of 1; of a penny that of a radian."""
    mesh = cracked(distance, length)
    basis = Basis(mesh, ElementVector(ElementQuad2()))
    is_round = kind == "penny"
    shear = 0.5 / (1 + POISSON)
    lame = POISSON / ((1 + POISSON) * (1 - 2 * POISSON))

    @BilinearForm
    def stiffness(u, v, w):
        radius = w.x[1] if is_round else 1.0
        hoops = [u[1] / radius, v[1] / radius] if is_round else [0.0, 0.0]
        strains = [sym_grad(u), sym_grad(v)]
        volumes = [trace(strain) + hoop for strain, hoop in zip(strains, hoops, strict=True)]
        stress = 2 * shear * strains[0] + lame * eye(volumes[0], 2)
        hoop = 2 * shear * hoops[0] + lame * volumes[0]
        return (ddot(stress, strains[1]) + hoop * hoops[1]) * radius

    @LinearForm
    def pressure(v, w):
        return -dot(w.n, v) * (w.x[1] if is_round else 1.0)

    faces = mesh.facets_satisfying(lambda x: abs(x[0]) < 1e-9, boundaries_only=True)
    load = pressure.assemble(FacetBasis(mesh, basis.elem, facets=faces))
    held = basis.get_dofs(lambda x: abs(x[1] - FAR) < 1e-9).all()
    if is_round:
        axis = basis.get_dofs(lambda x: abs(x[1]) < 1e-9).all(["u^2"])
        held = np.union1d(held, axis)
    moved = solve(*condense(stiffness.assemble(basis), load, D=held))
    return 0.5 * load @ moved


def intensity(kind: str, distance: float) -> float:
    shorter, longer = (energy(kind, distance, 1 + part * SIZE) for part in (-1, 1))
    return ((longer - shorter) / (2 * SIZE) / (1 - POISSON**2)) ** 0.5


def main() -> int:
    wrong = 0
    for kind, free in FREE.items():
        for distance in (FAR, 2 * free, free, 0.6 * free, 0.4 * free):
            part = intensity(kind, distance) / EXACT[kind]
            print(f"{kind}, {distance:g} of its size from a face: {part:.3f} of the formula")
            wrong += distance == FAR and abs(part - 1) > FAR_OFF
            wrong += distance == free and not 1 < part < 1 + NEAR_OFF
            wrong += distance < free and part < 1 + NEAR_OFF
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
