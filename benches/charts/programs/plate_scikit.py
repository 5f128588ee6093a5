"""A round plate under the heat and pressure of an impact, held over steps, by scikit-fem.

Stress across follows from what varies slowly through the
heated layer, the strain across and the axial stress, and from the temperature of the point.
"""

import numpy as np
from impact_on_plate import follow
from meridian import GAMMA, Section, stepped
from peer import SymmetricFactor
from scipy.sparse import triu
from skfem import BilinearForm, ElementQuad2
from skfem.helpers import grad
from telling import tell


class Plate(Section):
    """Its `rise` of temperature [K] is that of now."""

    def __init__(self, case: dict):
        super().__init__(case)
        self.mass, self.conductance = self.heated()
        self.flux = self.loaded(ElementQuad2())
        self.factor = SymmetricFactor()
        self.rise = np.zeros(len(self.flux))
        self.solve = self.elastic()
        lame, shear = self.moduli
        self.modulus = (3.0 * lame + 2.0 * shear) * case["expansion"]

        @BilinearForm
        def expanding(warm, v, w):
            r, b = w.x[0], grad(v)
            return 2.0 * np.pi * r * self.modulus * warm * (b[0, 0] + b[1, 1] + v[0] / r)

        self.expanding = expanding.assemble(self.basis, self.vectors)

    def advance(self, flux: float, duration: float, count: int) -> None:
        step = duration / count
        system = self.mass + GAMMA * step * self.conductance
        self.factor.factor(triu(system, format="csr"))
        for _ in range(count):
            self.rise = stepped(
                self.rise, self.factor.back, self.conductance, flux * self.flux, step
            )

    def temperature(self, depth: float) -> float:
        """Rise on the axis [K]."""
        return float((self.probe(depth) @ self.rise)[0])

    def stresses(self, pressure: float, depth: float) -> tuple[float, float]:
        """Across and along the axis [Pa]: `(E (ε − α ΔT) + ν σ_zz)/(1 − ν)` and `σ_zz`."""
        moved = self.vectors.interpolate(self.solve(pressure, self.expanding @ self.rise))
        lame, shear = self.moduli
        slopes, hoop = moved.grad, moved[0] / self.vectors.global_coordinates()[0]
        warm = np.asarray(self.basis.interpolate(self.rise))
        volume = slopes[0, 0] + slopes[1, 1] + hoop
        axial = lame * volume + 2.0 * shear * slopes[1, 1] - self.modulus * warm
        strain, axial = self.projected([0.5 * (slopes[0, 0] + hoop), axial], depth)
        young, poisson = self.case["young"], self.case["poisson"]
        free = self.case["expansion"] * self.temperature(depth)
        return (young * (strain - free) + poisson * axial) / (1.0 - poisson), axial


def prepare(case: dict):
    plate = Plate(case)
    return lambda: follow(plate)


if __name__ == "__main__":
    tell(prepare)
