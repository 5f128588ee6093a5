"""A straight crack in a hot strip that sinks into a bath, by linear fracture mechanics.

A strip of half width b has the steady temperature of a plate that sinks into a bath (closed form,
see `closed-form/src/dipped_plate.rs`), and a sharp crack along its middle from far below up to a
place near the surface of the bath. Half of it is meshed by bilinear elements in plane stress; the
energy release rate G is the difference of the elastic energies of cracks one element shorter and
longer. The crack is where G = G_c, that is where `αΔT √(Eb/G_c)` is `1/√g` of the
`g = G/(E (αΔT)² b)` of its lead over the surface; it is stable where that grows with the lead.

    build-fmu tests/verification/dipped_strip.toml -o out/dipped_strip.fmu
    python tests/verification/dipped_strip.py [FMU]

prints the least driving number at which a crack runs and its lead at that of the scene, twice and
four times as much, and with the unit the lead of its crack: that of broken elements, and that of
the equivalent crack, 1.33 ℓ further (`cracks.rs`).
"""

import sys
from pathlib import Path

import numpy as np
from impinge import Unit
from scipy.sparse import csc_matrix
from scipy.sparse.linalg import splu

POISSON = 0.23
LENGTH = 2.5  # of the strip on both sides of the crack's tip
HALF_WIDTH, THICKNESS = 12e-3, 0.5e-3  # m
CAPACITY, CONDUCTIVITY, COEFFICIENT = 2500.0 * 840.0, 1.0, 1e3
YOUNG, EXPANSION, ENERGY, DROP, SPEED = 72.3e9, 7.7e-6, 8.8, 80.0, 0.2e-3
LENGTH_OF_DAMAGE, AHEAD, BROKEN, HEIGHT = 1e-3, 1.33, 0.9, 54e-3
COUNT = 32  # elements over the half width
LEADS = np.arange(0.0, 0.92, 0.04)


def rise(heights: np.ndarray, peclet: float, exchange: float) -> np.ndarray:
    """Temperature below the initial one over that of the bath, at heights above its surface."""
    below = 2.0 * exchange / (np.sqrt(peclet**2 + 4.0 * exchange) + peclet)
    surface = peclet / (peclet + below)
    above = 1.0 - (1.0 - surface) * np.exp(-peclet * np.maximum(heights, 0.0))
    return np.where(heights > 0.0, above, surface * np.exp(below * np.minimum(heights, 0.0))) - 1.0


class Strip:
    """Half a strip of modulus 1: nodes run along x first."""

    def __init__(self, count: int):
        self.count, self.rows = count, int(round(2 * LENGTH * count))
        self.heights = np.linspace(-LENGTH, LENGTH, self.rows + 1)
        i, j = (a.ravel() for a in np.meshgrid(range(count), range(self.rows), indexing="ij"))
        first = i + (count + 1) * j
        self.corners = np.stack([first, first + 1, first + count + 1, first + count + 2], 1)
        self.places = np.stack([2 * self.corners, 2 * self.corners + 1], 2).reshape(-1, 8)
        law = np.array([[1, POISSON, 0], [POISSON, 1, 0], [0, 0, 0.5 * (1 - POISSON)]])
        self.law = law / (1 - POISSON**2)
        self.points = [self.point(x, z) for x in (-1, 1) for z in (-1, 1)]
        own = sum(b.T @ self.law @ b for b, _ in self.points) / (4.0 * count**2)
        pattern = (np.repeat(self.places, 8, 1).ravel(), np.tile(self.places, (1, 8)).ravel())
        self.stiffness = csc_matrix((np.tile(own.ravel(), len(i)), pattern))

    def point(self, x: float, z: float):
        """Strain of corner displacements, and shape functions, at a Gauss point."""
        x, z = 0.5 + 0.5 * x / 3**0.5, 0.5 + 0.5 * z / 3**0.5
        along = self.count * np.array([z - 1, 1 - z, -z, z])
        across = self.count * np.array([x - 1, -x, 1 - x, x])
        strain = np.zeros((3, 8))
        strain[0, 0::2] = strain[2, 1::2] = along
        strain[1, 1::2] = strain[2, 0::2] = across
        return strain, np.array([(1 - x) * (1 - z), x * (1 - z), (1 - x) * z, x * z])

    def energy(self, tip: int, warmed: np.ndarray) -> float:
        """Elastic energy with a crack up to a row of nodes, at temperatures of rows."""
        nodal = np.repeat(warmed, self.count + 1)[self.corners]
        load, own = np.zeros(self.stiffness.shape[0]), 0.0
        unit = np.array([1.0, 1.0, 0.0])
        part = 1.0 / (4.0 * self.count**2)
        for strain, shape in self.points:
            warm = nodal @ shape
            np.add.at(load, self.places, part * np.outer(warm, strain.T @ self.law @ unit))
            own += 0.5 * part * np.sum(warm**2) * (unit @ self.law @ unit)
        middle = 2 * (self.count + 1) * np.arange(tip, self.rows + 1)
        free = np.setdiff1d(np.arange(len(load)), [*middle, 2 * (self.count + 1) * self.rows + 1])
        moved = splu(self.stiffness[free][:, free].tocsc()).solve(load[free])
        return own - 0.5 * load[free] @ moved

    def release(self, lead: float, peclet: float, exchange: float) -> float:
        """G/(E (αΔT)² b) of a crack whose tip leads the surface of the bath."""
        warmed = rise(self.heights + lead, peclet, exchange)
        tip = self.rows // 2
        return self.count * (self.energy(tip - 1, warmed) - self.energy(tip + 1, warmed))


def measured(unit_file: Path):
    """Prints the lead of broken elements and of the equivalent crack as the bath rises."""
    with Unit(unit_file) as unit:
        for height in 1e-3 * np.arange(2.0, 24.1, 2.0):
            unit.step_to(height / SPEED)
            damage = unit["section.damage"]
            rows = np.nonzero(np.any(damage > BROKEN, axis=0))[0]
            lead = HEIGHT * rows[-1] / (damage.shape[1] - 1) - height
            ahead = lead + AHEAD * LENGTH_OF_DAMAGE
            found = f"broken {1e3 * lead:5.2f}, crack {1e3 * ahead:5.2f} mm ahead"
            print(f"bath at {1e3 * height:4.1f} mm: {found}")


def main():
    strip = Strip(COUNT)
    exchange = 2.0 * COEFFICIENT / (CONDUCTIVITY * THICKNESS) * HALF_WIDTH**2
    scene = EXPANSION * DROP * np.sqrt(YOUNG * HALF_WIDTH / ENERGY)
    for speed in (0.5 * SPEED, SPEED, 2.0 * SPEED):
        peclet = HALF_WIDTH * speed * CAPACITY / CONDUCTIVITY
        driving = np.array([strip.release(lead, peclet, exchange) ** -0.5 for lead in LEADS])
        least = int(np.argmin(driving))
        runs = f"cracks run from {driving[least]:.2f} on"
        print(f"{1e3 * speed:.1f} mm/s, bv/D = {peclet:.2f}: {runs}")
        for number in scene * np.array([1.0, 2.0, 4.0]):
            if number > driving[least]:
                lead = 1e3 * HALF_WIDTH * np.interp(number, driving[least:], LEADS[least:])
                print(f"  αΔT√(Eb/G_c) = {number:5.2f}: {lead:.2f} mm ahead")
    if len(sys.argv) > 1:
        measured(Path(sys.argv[1]))


if __name__ == "__main__":
    main()
