"""Meridian sections of round plates in scikit-fem: quadratic quadrilaterals, PARDISO throughout.

Heat advances by the L-stable, diagonally implicit Runge–Kutta method of second order (Alexander
1977, doi 10.1137/0714068); elastic stress is projected onto the shape functions.
"""

import sys
from pathlib import Path

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
)
from skfem.helpers import dot, grad

sys.path.append(str(Path(__file__).resolve().parents[3] / "tests/verification"))
from peer import Factor  # noqa: E402

GAMMA = 1.0 - 0.5**0.5


def places(fine: float, size: float, end: float, growth: float) -> np.ndarray:
    """Ends of elements: equal ones up to `fine`, growing ones from there to `end`."""
    ends = list(np.linspace(0.0, fine, max(round(fine / size), 1) + 1))
    step = ends[-1] - ends[-2]
    while ends[-1] < end:
        step *= growth
        ends.append(ends[-1] + step)
    if len(ends) > 2 and end - ends[-2] < 0.5 * step:
        ends.pop()
    ends[-1] = end
    return np.array(ends)


def stepped(rise: np.ndarray, solve, conductance, load, step: float) -> np.ndarray:
    """Temperatures a step later; `solve` is for the capacity and `GAMMA * step` conductances."""
    first = solve(load - conductance @ rise)
    between = rise + (1.0 - GAMMA) * step * first
    second = solve(load - conductance @ between)
    return rise + step * ((1.0 - GAMMA) * first + GAMMA * second)


class Section:
    """A disc of some radius and thickness; r is x, z is y and ends at 0."""

    def __init__(self, case: dict):
        self.case = case
        radial = places(case["spot"], case["radial"], case["half"], case["growth"])
        if radial[-1] - case["spot"] < 1e-12:
            radial = places(case["half"], case["radial"], case["half"], case["growth"])
        depth = -places(case["depth"], case["depth"], case["thickness"], case["growth"])[::-1]
        self.mesh = MeshQuad.init_tensor(radial, depth)
        self.basis = Basis(self.mesh, ElementQuad2(), intorder=5)
        middle = self.mesh.p[:, self.mesh.facets].mean(axis=1)
        is_top = np.isclose(middle[1], 0.0, atol=1e-12) & (middle[0] < case["spot"])
        self.top = np.nonzero(is_top)[0]

    def loaded(self, element, component: int | None = None) -> np.ndarray:
        """Nodal vector of a unit load on the spot."""

        @LinearForm
        def form(v, w):
            return 2.0 * np.pi * w.x[0] * (v if component is None else v[component])

        return form.assemble(FacetBasis(self.mesh, element, facets=self.top, intorder=5))

    def heated(self) -> tuple:
        """Capacity, conductance and what a step of a given length is solved by."""
        capacity, conductivity = self.case["capacity"], self.case["conductivity"]

        @BilinearForm
        def storing(u, v, w):
            return 2.0 * np.pi * w.x[0] * capacity * u * v

        @BilinearForm
        def conducting(u, v, w):
            return 2.0 * np.pi * w.x[0] * conductivity * dot(grad(u), grad(v))

        return storing.assemble(self.basis), conducting.assemble(self.basis)

    def advance(self, flux: float, stop: float, steps: int):
        """Two functions: one that factors, one that makes all steps from zero."""
        mass, conductance = self.heated()
        load = flux * self.loaded(ElementQuad2())
        step = stop / steps
        factor = Factor((mass + GAMMA * step * conductance).tocsr())

        def run() -> np.ndarray:
            rise = np.zeros(len(load))
            for _ in range(steps):
                rise = stepped(rise, factor.solve, conductance, load, step)
            return rise

        return run

    def elastic(self):
        """A function of a pressure on the spot, and of more forces, that gives displacements."""
        young, poisson = self.case["young"], self.case["poisson"]
        lame = young * poisson / ((1 + poisson) * (1 - 2 * poisson))
        shear = young / (2 * (1 + poisson))
        vectors = Basis(self.mesh, ElementVector(ElementQuad2()), intorder=5)
        self.vectors, self.moduli = vectors, (lame, shear)

        @BilinearForm
        def stiff(u, v, w):
            r = w.x[0]
            a, b = grad(u), grad(v)
            hoop = u[0] * v[0] / r**2
            shears = 0.5 * (a[0, 1] + a[1, 0]) * (b[0, 1] + b[1, 0])
            inner = a[0, 0] * b[0, 0] + a[1, 1] * b[1, 1] + hoop + shears
            volumes = (a[0, 0] + a[1, 1] + u[0] / r) * (b[0, 0] + b[1, 1] + v[0] / r)
            return 2.0 * np.pi * r * (2.0 * shear * inner + lame * volumes)

        matrix = stiff.assemble(vectors)
        held = self.held(vectors)
        reduced, _, _, free = condense(matrix, np.zeros(matrix.shape[0]), D=held)
        factor = Factor(reduced.tocsr())

        press = self.loaded(ElementVector(ElementQuad2()), 1)

        def solve(pressure: float, more: float | np.ndarray = 0.0) -> np.ndarray:
            force = more - pressure * press
            moved = np.zeros(matrix.shape[0])
            moved[free] = factor.solve(force[free])
            return moved

        return solve

    def held(self, vectors: Basis) -> np.ndarray:
        """Unknowns that do not move: side and bottom are rollers, or the side is clamped."""
        axis = vectors.get_dofs(lambda x: np.isclose(x[0], 0.0)).all("u^1")
        side = vectors.get_dofs(lambda x: np.isclose(x[0], self.case["half"]))
        if self.case.get("is_clamped"):
            return np.unique(np.concatenate([axis, side.all()]))
        bottom = vectors.get_dofs(lambda x: np.isclose(x[1], -self.case["thickness"])).all("u^2")
        return np.unique(np.concatenate([axis, side.all("u^1"), bottom]))

    def stress(self, moved: np.ndarray, depth: float) -> np.ndarray:
        """rr, tt and zz on the axis [Pa], projected onto the shape functions."""
        lame, shear = self.moduli
        u = self.vectors.interpolate(moved)
        slopes, hoop = u.grad, u[0] / self.vectors.global_coordinates()[0]
        pressure = lame * (slopes[0, 0] + slopes[1, 1] + hoop)
        fields = [pressure + 2.0 * shear * part for part in (slopes[0, 0], hoop, slopes[1, 1])]

        return self.projected(fields, depth)

    def projected(self, fields: list[np.ndarray], depth: float) -> np.ndarray:
        """Values on the axis of fields at the points of quadrature, as shape functions have them.

        Without the weight r, which would leave the axis to chance."""

        @BilinearForm
        def mass(a, b, w):
            return a * b

        @LinearForm
        def of_field(b, w):
            return w["field"] * b

        factor = Factor(mass.assemble(self.basis).tocsr())
        probe = self.probe(depth)
        loads = (of_field.assemble(self.basis, field=np.asarray(field)) for field in fields)
        return np.array([float((probe @ factor.solve(load))[0]) for load in loads])

    def probe(self, depth: float):
        """A row that reads what is on the axis."""
        return self.basis.probes(np.array([[1e-9 * self.case["half"]], [-depth]]))
