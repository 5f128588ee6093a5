"""The alumina plate in scikit-fem: an independent program for the same equations on the same nodes.

A quarter of the plate with symmetry planes x = 0 and y = 0, its other sides clamped, insulated all
around; heat and pressure, constant in time, on a disc about the centre of the top. Heat advances by
an L-stable, diagonally implicit Runge–Kutta method of order 2 with the consistent mass matrix,
mechanics by one static solve.

Stress at a point: polynomials are fitted to what varies slowly through the heated layer, ε_xx, ε_yy
and σ_zz, at the Gauss points around, where they are most accurate; with the temperature of the
point they give the other stresses. (Projected onto the shape functions instead, σ_zz of the loaded
surface is some per cent off.)
"""

import os
from dataclasses import dataclass
from math import pi, sqrt

import numpy as np
import scipy.sparse as sp
from skfem import (
    Basis,
    BilinearForm,
    ElementHex1,
    ElementHex2,
    ElementVector,
    FacetBasis,
    LinearForm,
    MeshHex,
    condense,
)
from skfem.helpers import ddot, dot, grad, sym_grad, trace


@dataclass(frozen=True)
class Case:
    """Material and load, all in SI units."""

    density: float = 3950.0
    specific_heat: float = 900.0
    conductivity: float = 10.0
    young: float = 300e9
    poisson: float = 0.21
    expansion: float = 8.1e-6
    heat_flux: float = 1e8
    pressure: float = 25e6
    radius: float = 30e-6

    @property
    def lame(self):
        e, nu = self.young, self.poisson
        return e * nu / ((1 + nu) * (1 - 2 * nu)), e / (2 * (1 + nu))

    @property
    def thermal_modulus(self):
        lam, mu = self.lame
        return (3 * lam + 2 * mu) * self.expansion


def pardiso():
    """A solver of symmetric positive definite matrices; where MKL lies is searched for once."""
    from pypardiso import PyPardisoSolver

    solver = PyPardisoSolver(mtype=2)
    os.environ.setdefault("PYPARDISO_MKL_RT", solver.libmkl._name)
    return solver


class Factor:
    """A factorised symmetric positive definite matrix: PARDISO where there is one, else SuperLU."""

    def __init__(self, matrix):
        try:
            solver = pardiso()
        except ImportError:
            from scipy.sparse.linalg import splu

            self.name = "SuperLU"
            lu = splu(matrix.tocsc(), permc_spec="MMD_AT_PLUS_A", options={"SymmetricMode": True})
            self.solve = lu.solve
            return
        self.name = "PARDISO"
        solver.size_limit_storage = 0  # compare matrices by hash, keep no copy
        upper = sp.triu(matrix, format="csr")
        solver.factorize(upper)
        self.solve = lambda b: solver.solve(upper, b)


class SymmetricFactor:
    """Factors matrices of one pattern one after another; PARDISO orders only the first.

    Upper triangles in CSR.
    """

    def __init__(self):
        self.solver, self.upper, self.is_ordered = None, None, False

    def factor(self, upper):
        """Makes a matrix the one that `back` solves for."""
        self.upper = upper
        try:
            self.solver = self.solver or pardiso()
        except ImportError:
            self.back = Factor((upper + sp.triu(upper, 1).T).tocsr()).solve
            return
        nothing = np.zeros(upper.shape[0])
        if not self.is_ordered:
            self._run(11, upper, nothing)
            self.is_ordered = True
        self._run(22, upper, nothing)

    def back(self, b):
        return self._run(33, self.upper, b)

    def solve(self, upper, b):
        self.factor(upper)
        return self.back(b)

    def _run(self, phase, upper, b):
        self.solver.set_phase(phase)
        return np.ravel(self.solver._call_pardiso(upper, b.reshape(-1, 1)))


def ends_of_elements(axes, order):
    """Ends of the elements from the nodes along each axis."""
    for nodes in axes:
        assert (len(nodes) - 1) % order == 0
    return [np.ascontiguousarray(nodes[::order]) for nodes in axes]


class Plate:
    """Bases and matrices on the nodes of `axes`, x and y from the symmetry planes outwards."""

    def __init__(self, axes, order, case):
        self.case = case
        element = {1: ElementHex1, 2: ElementHex2}[order]()
        self.order = order
        self.ends = ends_of_elements(axes, order)
        self.mesh = MeshHex.init_tensor(*self.ends)
        degree = 2 * order + 1  # order + 1 Gauss points along each edge: exact on bricks
        self.scalar = Basis(self.mesh, element, intorder=degree)
        self.vector = Basis(self.mesh, ElementVector(element), intorder=degree)
        facets, quadrature = self._facets_under_disc()
        self.disc = FacetBasis(self.mesh, element, facets=facets, quadrature=quadrature)
        self.disc_vector = FacetBasis(
            self.mesh, ElementVector(element), facets=facets, quadrature=quadrature
        )

    def _facets_under_disc(self):
        """The facets that the disc touches, with many points each, for it ends inside of some."""
        corners = self.mesh.p[:, self.mesh.facets]
        on_top = np.isclose(corners[2], self.mesh.p[2].max(), atol=1e-12).all(axis=0)
        near = np.hypot(corners[0].min(axis=0), corners[1].min(axis=0)) < self.case.radius
        pair = 0.5 - sqrt(1 / 12), 0.5 + sqrt(1 / 12)  # Gauss points of each of 25 × 25 parts
        u, v = np.meshgrid(*[[(i + x) / 25 for i in range(25) for x in pair]] * 2)
        quadrature = np.array([u.ravel(), v.ravel()]), np.full(u.size, 1 / u.size)
        return np.nonzero(on_top & near)[0], quadrature

    def _footprint(self, w):
        """The load's indicator, scaled so that its integral is the area of a quarter disc."""
        inside = np.hypot(w.x[0], w.x[1]) < self.case.radius
        area = (inside * self.disc.dx).sum()
        return inside * (pi * self.case.radius**2 / 4 / area)

    # Heat

    def assemble_heat(self):
        case = self.case
        capacity = case.density * case.specific_heat
        self.mass = BilinearForm(lambda t, s, _: capacity * t * s).assemble(self.scalar)
        self.conduction = BilinearForm(
            lambda t, s, _: case.conductivity * dot(grad(t), grad(s))
        ).assemble(self.scalar)
        flux = LinearForm(lambda s, w: case.heat_flux * self._footprint(w) * s)
        self.heating = flux.assemble(self.disc)

    GAMMA = 1 - 1 / sqrt(2)

    def factor_heat(self, step):
        self.step = step
        self.heat_factor = Factor((self.mass + self.GAMMA * step * self.conduction).tocsr())

    def heat_step(self, temperature):
        """SDIRK2: two stages, one factorisation, L-stable, order 2."""
        g, dt = self.GAMMA, self.step
        rate = self.heating - self.conduction @ temperature
        first = self.heat_factor.solve(rate)
        rate = rate - (1 - g) * dt * (self.conduction @ first)
        second = self.heat_factor.solve(rate)
        return temperature + dt * ((1 - g) * first + g * second)

    # Mechanics

    def assemble_mechanics(self):
        lam, mu = self.case.lame
        self.stiffness = BilinearForm(
            lambda u, v, _: (
                lam * trace(sym_grad(u)) * trace(sym_grad(v))
                + 2 * mu * ddot(sym_grad(u), sym_grad(v))
            )
        ).assemble(self.vector)
        self.swelling = BilinearForm(
            lambda t, v, _: self.case.thermal_modulus * t * trace(sym_grad(v))
        ).assemble(self.scalar, self.vector)
        push = LinearForm(lambda v, w: -self.case.pressure * self._footprint(w) * v[2])
        self.pushing = push.assemble(self.disc_vector)
        far = [self.mesh.p[axis].max() for axis in range(2)]
        fixed = [
            self.vector.get_dofs(lambda x: np.isclose(x[0], 0.0, atol=1e-12)).all("u^1"),
            self.vector.get_dofs(lambda x: np.isclose(x[1], 0.0, atol=1e-12)).all("u^2"),
            self.vector.get_dofs(lambda x: np.isclose(x[0], far[0])).all(),
            self.vector.get_dofs(lambda x: np.isclose(x[1], far[1])).all(),
        ]
        self.fixed = np.unique(np.concatenate(fixed))

    def factor_mechanics(self):
        matrix, _, _, self.free = condense(
            self.stiffness, np.zeros(self.vector.N), D=self.fixed, expand=True
        )
        self.elastic_factor = Factor(matrix.tocsr())

    def displacement(self, temperature):
        u = np.zeros(self.vector.N)
        u[self.free] = self.elastic_factor.solve(
            (self.pushing + self.swelling @ temperature)[self.free]
        )
        return u

    # Results

    def values(self, temperature, displacement, points):
        """Temperature rise, stresses and displacements at points, `(3, n)`."""
        scalar, vector = self.scalar.probes(points), self.vector.probes(points)
        count = points.shape[1]
        result = {"temperature": scalar @ temperature}
        u = (vector @ displacement).reshape(3, count)
        result |= {f"displacement_{axis}": u[i] for i, axis in enumerate("xyz")}
        rise = result["temperature"]
        smooth = [self._smooth(displacement, temperature, point) for point in points.T]
        strain_x, strain_y, stress_z = np.array(smooth).T
        e, nu, alpha = self.case.young, self.case.poisson, self.case.expansion
        common = (nu * stress_z - e * alpha * rise) / (1 - nu)
        result["stress_xx"] = e / (1 - nu**2) * (strain_x + nu * strain_y) + common
        result["stress_yy"] = e / (1 - nu**2) * (strain_y + nu * strain_x) + common
        result["stress_zz"] = stress_z
        return result

    def _smooth(self, displacement, temperature, point):
        """ε_xx, ε_yy and σ_zz at a point, all even about both symmetry planes."""
        low, high = np.array([self._around(axis, x) for axis, x in enumerate(point)]).T[:, :, None]
        centre = np.mean(self.mesh.p[:, self.mesh.t], axis=1)
        elements = np.nonzero(np.all((centre > low) & (centre < high), axis=0))[0]
        places, _ = np.polynomial.legendre.leggauss(self.order)
        local = np.array(np.meshgrid(*[(places + 1) / 2] * 3)).reshape(3, -1)
        rule = {"elements": elements, "quadrature": (local, np.full(local.shape[1], 1.0))}
        basis = Basis(self.mesh, self.vector.elem, **rule)
        gradient = basis.interpolate(displacement).grad
        rise = Basis(self.mesh, self.scalar.elem, **rule).interpolate(temperature)
        lam, mu = self.case.lame
        strains = [gradient[i, i] for i in range(3)]
        stress = lam * sum(strains) + 2 * mu * strains[2] - self.case.thermal_modulus * rise
        at = basis.global_coordinates().reshape(3, -1)
        values = np.array([f.ravel() for f in (strains[0], strains[1], np.asarray(stress))])
        for axis in range(2):
            if low[axis] < 0.0:
                image = np.where(np.arange(3) == axis, -1.0, 1.0)[:, None] * at
                at, values = np.hstack([at, image]), np.hstack([values, values])
        # Quadratic along each axis, in units of the stretch
        local = (at - point[:, None]) / np.ptp(at, axis=1)[:, None]
        x, y, z = (c[:, None] ** np.arange(3) for c in local)
        terms = np.einsum("ni,nj,nk->nijk", x, y, z).reshape(-1, 27)
        scale = np.abs(values).max(axis=1)
        return np.linalg.lstsq(terms, (values / scale[:, None]).T, rcond=None)[0][0] * scale

    def _around(self, axis, x):
        """The stretch of two or three elements about a coordinate; below zero for images."""
        ends = self.ends[axis]
        if axis < 2:
            ends = np.concatenate([-ends[:0:-1], ends])
        count = 2 * (3 - self.order) if np.isclose(ends, x, atol=1e-12).any() else 3
        first = np.searchsorted(ends, x - 1e-12) - (count + 1) // 2
        first = min(max(first, 0), len(ends) - 1 - count)
        return ends[first], ends[first + count]
