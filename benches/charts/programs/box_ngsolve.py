"""The plate of `plate_ngsolve.py` as a square one: a wider disc and a correction, by NGSolve.

What holds the sides of the box takes back what the disc's section has moved there. The difference
is an elastic field without loads in a quarter of the box, so smooth that few elements have it.
"""

import numpy as np
from impact_on_plate import follow
from ngsolve import (
    CF,
    BilinearForm,
    GridFunction,
    InnerProduct,
    Sym,
    Trace,
    VectorH1,
    VoxelCoefficient,
    dx,
    grad,
    sqrt,
    x,
    y,
    z,
)
from ngsolve.meshes import MakeStructured3DMesh
from plate_ngsolve import Plate
from telling import tell

BLOCK_ORDER = 5
SAMPLES = 400
"""Of the section's displacements along r and along z; linear between them."""


class Box(Plate):
    """A square plate twice `box` wide; the disc's radius `half` is more than half its diagonal."""

    def elastic(self) -> None:
        super().elastic()
        side, thickness, count = self.case["box"], self.case["thickness"], self.case["blocks"]
        self.quarter = MakeStructured3DMesh(
            hexes=True,
            nx=count,
            ny=count,
            nz=max(count // 3, 1),
            mapping=lambda r, s, t: (side * r, side * s, thickness * (t - 1.0)),
        )
        # x is 0 at the back, y at the left.
        space = VectorH1(
            self.quarter,
            order=BLOCK_ORDER,
            dirichletx="back|front|right",
            dirichlety="left|front|right",
            dirichletz="front|right",
        )
        self.taken = GridFunction(space)
        taken, test = space.TnT()
        stress = 2.0 * self.shear * Sym(grad(taken))
        work = InnerProduct(stress, Sym(grad(test)))
        work += self.lame * Trace(grad(taken)) * Trace(grad(test))
        self.stiffness = BilinearForm(work * dx).Assemble().mat
        self.inverse = self.stiffness.Inverse(space.FreeDofs(), "sparsecholesky")

    def load(self, pressure: float) -> None:
        super().load(pressure)
        outward, up = self.of_section()
        radius = sqrt(x * x + y * y)
        held = -1.0 * CF((outward * x / radius, outward * y / radius, up))
        vector = self.taken.vec
        vector[:] = 0.0
        self.taken.Set(held, definedon=self.quarter.Boundaries("front|right"))
        force = vector.CreateVector()
        force.data = self.stiffness * vector
        vector.data -= self.inverse * force

    def of_section(self) -> tuple:
        """Displacements along r and z at the points of the box's sides."""
        side, thickness = self.case["box"], self.case["thickness"]
        start, end = (0.99 * side, -thickness), (1.01 * 2.0**0.5 * side, 0.0)
        radii = np.linspace(start[0], end[0], SAMPLES)
        heights = np.linspace(start[1], end[1], SAMPLES)
        r, h = (grid.ravel() for grid in np.meshgrid(radii, heights))
        moved = self.moved(self.mesh(r, h)).reshape(SAMPLES, SAMPLES, 2)
        place = CF((sqrt(x * x + y * y), z))
        return tuple(
            VoxelCoefficient(
                start, end, np.ascontiguousarray(moved[:, :, n]), linear=True, trafocf=place
            )
            for n in (0, 1)
        )

    def stress(self, depth: float) -> tuple[float, float]:
        """xx and zz on the axis [Pa]."""
        slopes = np.array(grad(self.taken)(self.quarter(0.0, 0.0, -depth)))[[0, 4, 8]]
        more = self.lame * slopes.sum() + 2.0 * self.shear * slopes[[0, 2]]
        side, axial = super().stress(depth)
        return side + more[0], axial + more[1]


def prepare(case: dict):
    box = Box(case)
    return lambda: follow(box)


if __name__ == "__main__":
    tell(prepare)
