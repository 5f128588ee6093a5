"""Nonlinear heat in scikit-fem: an independent program for the same equations on the same nodes.

A quarter of a box with symmetry planes x = 0 and y = 0 under a Gaussian flux; its top radiates.
Linear elements with consistent conduction (27 neighbours), volumes and radiating areas lumped to
the nodes. The unknown is the volumetric enthalpy [J/m³]. An L-stable, diagonally implicit
Runge–Kutta method of order 2 with steps of one length, Newton's method in each stage.

The conductivity enters in either of two ways: at the Gauss points of the interpolated temperature
(`AtPoints`), or as the nodal heat conductivity integral θ = ∫ k dT (`Integral`), whose stiffness
never changes and whose systems are symmetric: dearer and cheaper set-ups of the same physics.
"""

from dataclasses import dataclass
from math import sqrt

import numpy as np
import scipy.sparse as sp
from peer import SymmetricFactor
from skfem import Basis, BilinearForm, ElementHex1, FacetBasis, LinearForm, MeshHex
from skfem.helpers import dot, grad

STEFAN_BOLTZMANN = 5.670374419e-8


@dataclass(frozen=True)
class Melt:
    """Constants in SI units; tables are (temperatures, values), held outside."""

    density: float
    specific_heat: tuple
    conductivity: tuple
    solidus: float
    liquidus: float
    latent_heat: float


class Antiderivative:
    """∫ f dT of a piecewise linear f from a temperature on, and its inverse, exact."""

    def __init__(self, knots, values, reference):
        self.knots, self.values = np.asarray(knots), np.asarray(values)
        pieces = np.diff(self.knots) * (self.values[:, 0] + self.values[:, 1]) / 2
        self.sums = np.concatenate([[0.0], np.cumsum(pieces)])
        self.sums -= self(reference)

    def _piece(self, number):
        """Beginning, value there and slope."""
        first, last = self.values[number].T
        return self.knots[number], first, (last - first) / np.diff(self.knots)[number]

    def __call__(self, t):
        number = np.clip(np.searchsorted(self.knots, t, side="right") - 1, 0, len(self.values) - 1)
        begin, value, slope = self._piece(number)
        along = t - begin
        return self.sums[number] + along * (value + 0.5 * slope * along)

    def inverse(self, total):
        """The temperature, and f there."""
        number = np.clip(
            np.searchsorted(self.sums, total, side="right") - 1, 0, len(self.values) - 1
        )
        begin, value, slope = self._piece(number)
        above = total - self.sums[number]
        end = np.sqrt(value**2 + 2 * slope * above)
        return begin + 2 * above / (value + end), end


def antiderivative(table, reference, extra=(), more=None):
    """That of a table with `more(T)` added, constant between the `extra` knots."""
    wide = [1.0, 20000.0]  # Temperatures [K] that nothing here leaves.
    knots = np.unique([*wide, *table[0], *extra])
    middle = 0.5 * (knots[:-1] + knots[1:])
    ends = np.column_stack([np.interp(knots[:-1], *table), np.interp(knots[1:], *table)])
    if more is not None:
        ends = ends + more(middle)[:, None]
    return Antiderivative(knots, ends, reference)


class Melting:
    """The problem on the nodes of `axes`, x and y from the symmetry planes outwards."""

    GAMMA = 1 - 1 / sqrt(2)
    TOLERANCE = 1e-3  # Of a temperature [K], what Newton's method may leave.

    def __init__(self, axes, melt, cold, emissivity):
        self.melt, self.cold, self.emissivity = melt, cold, emissivity
        self.axes = axes
        self.mesh = MeshHex.init_tensor(*axes)
        self.basis = Basis(self.mesh, ElementHex1(), intorder=3)
        high = axes[2][-1]
        facets = self.mesh.facets_satisfying(lambda x: np.isclose(x[2], high, atol=1e-12))
        self.top = FacetBasis(self.mesh, ElementHex1(), facets=facets, intorder=8)
        self.volumes = LinearForm(lambda s, w: s).assemble(self.basis)
        self.areas = LinearForm(lambda s, w: s).assemble(self.top)
        rate = melt.density * melt.latent_heat / (melt.liquidus - melt.solidus)
        ends = (melt.solidus, melt.liquidus)
        table = melt.specific_heat[0], melt.density * np.array(melt.specific_heat[1])
        within = lambda t: np.where((t > ends[0]) & (t < ends[1]), rate, 0.0)  # noqa: E731
        self.enthalpy = antiderivative(table, cold, ends, within)
        self.content = np.zeros(self.basis.N)
        self.newton_steps = 0

    def heat_by(self, peak, radius):
        """Sets a Gaussian flux, 1/e² at the radius."""
        flux = LinearForm(
            lambda s, w: peak * np.exp(-2 * (w.x[0] ** 2 + w.x[1] ** 2) / radius**2) * s
        )
        self.heating = flux.assemble(self.top)

    def temperature(self):
        return self.enthalpy.inverse(self.content)[0]

    def liquid_volume(self):
        """[m³], of the whole box."""
        melt = self.melt
        part = (self.temperature() - melt.solidus) / (melt.liquidus - melt.solidus)
        return 4 * float(self.volumes @ np.clip(part, 0.0, 1.0))

    def on_grid(self, nodal):
        """Values as [x, y, z]."""
        places = [
            np.searchsorted(axis, at - 1e-9 * np.ptp(axis))
            for axis, at in zip(self.axes, self.basis.doflocs, strict=True)
        ]
        grid = np.empty([len(axis) for axis in self.axes])
        grid[tuple(places)] = nodal
        return grid

    def radiation(self, t):
        """Into the nodes [W], and how it falls with their temperature [W/K]."""
        scale = self.emissivity * STEFAN_BOLTZMANN * self.areas
        return scale * (self.cold**4 - t**4), 4 * scale * t**3

    def advance(self, duration, count):
        dt, g = duration / count, self.GAMMA
        for _ in range(count):
            known = self.volumes * self.content
            first = self.stage(known, g * dt)
            self.content = self.content_found
            self.stage(known + (1 - g) * dt * first, g * dt)
            self.content = self.content_found

    def stage(self, known, tau):
        """Solves `V H − τ R(H) = known` from the present enthalpies; answers R."""
        content = self.content
        flow, missing = self._missing(content, known, tau)
        for _ in range(40):
            t, capacity = self.enthalpy.inverse(content)
            sensible = self.melt.density * np.interp(t, *self.melt.specific_heat)
            if np.abs(missing / (self.volumes * sensible)).max() < self.TOLERANCE:
                self.content_found = content
                return flow
            self.newton_steps += 1
            change = capacity * self.solve(t, capacity, tau, missing)
            part, size = 1.0, np.linalg.norm(missing)
            while True:
                flow, found = self._missing(content + part * change, known, tau)
                if np.linalg.norm(found) < (1 - 0.1 * part) * size or part < 0.02:
                    break
                part *= 0.5
            content, missing = content + part * change, found
        raise RuntimeError("the peer's Newton method did not converge")

    def _missing(self, content, known, tau):
        t, _ = self.enthalpy.inverse(content)
        flow = self.conducted(t) + self.heating + self.radiation(t)[0]
        return flow, known + tau * flow - self.volumes * content


class AtPoints(Melting):
    """k(T) of the interpolated temperature at the Gauss points, its derivative included."""

    def __init__(self, *given):
        super().__init__(*given)
        knots, values = (np.asarray(column) for column in self.melt.conductivity)
        slopes = np.concatenate([[0.0], np.diff(values) / np.diff(knots), [0.0]])
        self.k = lambda t: np.interp(t, knots, values)
        self.slope = lambda t: slopes[np.searchsorted(knots, t)]
        self.flow_form = LinearForm(lambda s, w: -self.k(w.t) * dot(w.t.grad, grad(s)))
        self.change_form = BilinearForm(
            lambda d, s, w: (
                self.k(w.t) * dot(grad(d), grad(s)) + self.slope(w.t) * d * dot(w.t.grad, grad(s))
            )
        )

    def conducted(self, t):
        return self.flow_form.assemble(self.basis, t=self.basis.interpolate(t))

    def solve(self, t, capacity, tau, missing):
        """The change of temperature."""
        matrix = self.change_form.assemble(self.basis, t=self.basis.interpolate(t))
        diagonal = self.volumes * capacity + tau * self.radiation(t)[1]
        system = (tau * matrix + sp.diags(diagonal)).tocsr()
        try:
            from pypardiso import spsolve
        except ImportError:
            from scipy.sparse.linalg import spsolve
        return spsolve(system, missing)


class Integral(Melting):
    """θ = ∫ k dT at the nodes: one stiffness, symmetric systems of one pattern."""

    def __init__(self, *given):
        super().__init__(*given)
        self.potential = antiderivative(self.melt.conductivity, self.cold)
        stiffness = BilinearForm(lambda d, s, w: dot(grad(d), grad(s)))
        self.stiffness = stiffness.assemble(self.basis).tocsr()
        self.upper = sp.triu(self.stiffness, format="csr")
        self.upper.sort_indices()
        self.factor = SymmetricFactor()

    def conducted(self, t):
        return -(self.stiffness @ self.potential(t))

    def solve(self, t, capacity, tau, missing):
        """The change of temperature, from that of θ."""
        k = np.interp(t, *self.melt.conductivity)
        system = self.upper * tau
        diagonal = (self.volumes * capacity + tau * self.radiation(t)[1]) / k
        # Columns are sorted, so that each row of the triangle begins on the diagonal.
        system.data[system.indptr[:-1]] += diagonal
        return self.factor.solve(system, missing) / k
