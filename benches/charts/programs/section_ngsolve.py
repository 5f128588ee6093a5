"""Meridian sections of round plates in NGSolve (https://ngsolve.org): quadrilaterals of any order.

Heat advances by the L-stable, diagonally implicit Runge–Kutta method of third order (Alexander
1977, doi 10.1137/0714068). Elements end at the edge of the spot, where loads jump, and crowd there.
"""

import numpy as np
from ngsolve import (
    H1,
    BilinearForm,
    GridFunction,
    IfPos,
    LinearForm,
    VectorH1,
    ds,
    dx,
    grad,
    pi,
    x,
)
from ngsolve.meshes import MakeStructured2DMesh

GAMMA = 0.43586652150845967
"""The root of γ³ − 3γ² + 3γ/2 − 1/6 of which the method is L-stable."""
LAST = 1.5 * GAMMA**2 - 5.0 * GAMMA + 1.25
STAGES = [[GAMMA], [0.5 * (1.0 - GAMMA), GAMMA], [1.0 - LAST - GAMMA, LAST, GAMMA]]


def crowded(first: float, length: float, growth: float) -> np.ndarray:
    """Ends of elements from 0 to about `length`, the first of about a size, the others growing."""
    count = max(round(np.log1p(length / first * (growth - 1.0)) / np.log(growth)), 1)
    ends = np.cumsum(growth ** np.arange(count))
    return np.concatenate([[0.0], ends / ends[-1] * length])


class Section:
    """A disc: r is x, its top is y = 0."""

    def __init__(self, case: dict):
        self.case, self.order = case, case["order"]
        spot, half, thickness = case["spot"], case["half"], case["thickness"]
        outward = crowded(case["radial"], half - spot, case["growth"]) + spot
        # Of the spot, the inner half has elements as large as they have become there.
        inward = spot - crowded(case["radial"], spot, case["growth"])[::-1]
        radii = np.concatenate([inward, outward[1:]])
        depths = -crowded(case["depth"], thickness, case["growth"])[::-1]
        self.mesh = MakeStructured2DMesh(
            quads=True,
            nx=len(radii) - 1,
            ny=len(depths) - 1,
            mapping=lambda s, t: (
                float(radii[round(s * (len(radii) - 1))]),
                float(depths[round(t * (len(depths) - 1))]),
            ),
        )
        self.is_loaded = IfPos(spot - x, 1.0, 0.0)
        self.heats = H1(self.mesh, order=self.order)
        self.rise = GridFunction(self.heats)

    def heated(self) -> None:
        """Capacity, conductance and a unit flux on the spot."""
        rise, test = self.heats.TnT()
        case, ring = self.case, 2.0 * pi * x
        self.capacity = BilinearForm(ring * case["capacity"] * rise * test * dx).Assemble().mat
        conducting = ring * case["conductivity"] * grad(rise) * grad(test) * dx
        self.conductance = BilinearForm(conducting).Assemble().mat
        self.flux = LinearForm(ring * self.is_loaded * test * ds("top")).Assemble().vec

    def advance(self, flux: float, duration: float, count: int) -> None:
        """Warms the section by so many equal steps."""
        step = duration / count
        system = self.capacity.CreateMatrix()
        system.AsVector().data = (
            self.capacity.AsVector() + GAMMA * step * self.conductance.AsVector()
        )
        inverse = system.Inverse(self.heats.FreeDofs(), "sparsecholesky")
        state, source = self.rise.vec, self.flux.CreateVector()
        slopes = [self.flux.CreateVector() for _ in STAGES]
        between = self.flux.CreateVector()
        for _ in range(count):
            for stage, weights in enumerate(STAGES):
                between.data = state
                for weight, slope in zip(weights[:-1], slopes, strict=False):
                    between.data += step * weight * slope
                source.data = flux * self.flux - self.conductance * between
                slopes[stage].data = inverse * source
            for weight, slope in zip(STAGES[-1], slopes, strict=True):
                state.data += step * weight * slope

    def elastic(self) -> None:
        """Stiffness, and nodal forces of a unit pressure on the spot."""
        young, poisson = self.case["young"], self.case["poisson"]
        self.shear = 0.5 * young / (1.0 + poisson)
        self.lame = young * poisson / ((1.0 + poisson) * (1.0 - 2.0 * poisson))
        # Side and bottom are rollers, or the side is clamped.
        held = "right" if self.case.get("is_clamped") else "bottom"
        self.moves = VectorH1(self.mesh, order=self.order, dirichletx="left|right", dirichlety=held)
        self.moved = GridFunction(self.moves)
        moved, test = self.moves.TnT()
        ring = 2.0 * pi * x
        inner = sum(a * b for a, b in zip(self.strains(moved), self.strains(test), strict=True))
        # The shear strain counts twice.
        inner += self.strains(moved)[3] * self.strains(test)[3]
        volumes = sum(self.strains(moved)[:3]) * sum(self.strains(test)[:3])
        form = ring * (2.0 * self.shear * inner + self.lame * volumes) * dx(bonus_intorder=2)
        stiffness = BilinearForm(form).Assemble().mat
        self.compliance = stiffness.Inverse(self.moves.FreeDofs(), "sparsecholesky")
        self.press = LinearForm(-ring * self.is_loaded * test[1] * ds("top")).Assemble().vec
        modulus = (3.0 * self.lame + 2.0 * self.shear) * self.case.get("expansion", 0.0)
        warm, _ = self.heats.TnT()
        expanding = ring * modulus * warm * sum(self.strains(test)[:3]) * dx(bonus_intorder=2)
        form = BilinearForm(trialspace=self.heats, testspace=self.moves)
        form += expanding
        self.expanding, self.modulus = form.Assemble().mat, modulus

    def strains(self, moved) -> tuple:
        """rr, tt, zz and rz."""
        slopes = grad(moved)
        return slopes[0, 0], moved[0] / x, slopes[1, 1], 0.5 * (slopes[0, 1] + slopes[1, 0])

    def load(self, pressure: float) -> None:
        """Displacements under a pressure and the warmth of now."""
        force = self.press.CreateVector()
        force.data = pressure * self.press
        force.data += self.expanding * self.rise.vec
        self.moved.vec.data = self.compliance * force

    def temperature(self, depth: float) -> float:
        """Rise on the axis [K]."""
        return float(self.rise(self.mesh(0.0, -depth)))

    def stress(self, depth: float) -> tuple[float, float]:
        """rr and zz on the axis [Pa], where the hoop's strain is the radial one."""
        slopes = grad(self.moved)(self.mesh(0.0, -depth))
        side, axial = slopes[0], slopes[3]
        common = self.lame * (2.0 * side + axial) - self.modulus * self.temperature(depth)
        return common + 2.0 * self.shear * side, common + 2.0 * self.shear * axial
