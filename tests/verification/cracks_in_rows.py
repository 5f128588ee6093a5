"""Stress intensity of edge cracks in a row beside finite elements (scikit-fem).

Cracks of length 1 and equal distances bear a pressure that is even, or grows or falls with the
depth. Half of one crack and half of the way to the next are modelled between planes of symmetry.
The energy release rate is the virtual work of the pressure: the change of twice the energy with the
length. Exit code 1 if the program differs by more than 0.4 %.
"""

import sys
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
from impinge import Unit
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
from skfem.helpers import ddot, eye, sym_grad, trace

POISSON = 0.22
SIZE = 1 / 40  # of elements at the crack, along it
FAR, GROWTH = 30.0, 1.25
SPACINGS = (8.0, 4.0, 2.0, 1.0, 0.5, 0.2)
OFF = 0.004

# A held plate whose temperature is linear in the depth: 1 MPa at the face, `slope` more at a depth
# of one crack.
DEPTH = 1e-4  # m
SCENE = """
name = "Row"
stop_time = 1.0
step = 1.0
[body.plate]
kind = "solid"
shape = {{ box = [4e-3, 4e-3, 2e-3] }}
initial_temperature = 1000.0
mesh = {{ spacing = 1e-3, depth_spacing = 1e-4 }}
faces.top = {{ temperature = {top!r} }}
faces.bottom = {{ temperature = {bottom!r}, roller = true }}
faces.sides = {{ roller = true }}
[body.plate.material]
model = "thermoelastic"
density = 4000.0
specific_heat = 900.0
conductivity = 100.0
young = 100e9
poisson = 0.22
expansion = 1e-5
"""
FLAW = """
[[flaw]]
name = "f{n}"
in = "plate"
at = [0.0, 0.0, 0.0]
normal = [1.0, 0.0, 0.0]
depth = {depth!r}
spacing = {spacing!r}
gives = ["stress_intensity"]
"""
DROP = 1e6 * (1 - POISSON) / (100e9 * 1e-5)  # K for 1 MPa


def graded(end: float, fine: float, size: float) -> np.ndarray:
    """Places from 0 to an end, evenly spaced up to another."""
    places = [0.0]
    while places[-1] < end - 1e-9:
        size *= GROWTH if places[-1] > fine else 1.0
        places.append(min(end, places[-1] + size))
    return np.array(places)


def energy(spacing: float, slope: float, length: float) -> float:
    """Elastic energy at a Young's modulus of 1, of half a crack."""
    across = graded(0.5 * spacing, 0.1, min(SIZE, spacing / 24))
    mesh = MeshQuad.init_tensor(across, graded(FAR, 1.5, SIZE))
    basis = Basis(mesh, ElementVector(ElementQuad2()))
    shear = 0.5 / (1 + POISSON)
    lame = POISSON / ((1 + POISSON) * (1 - 2 * POISSON))

    @BilinearForm
    def stiffness(u, v, w):
        strains = [sym_grad(u), sym_grad(v)]
        return ddot(2 * shear * strains[0] + lame * eye(trace(strains[0]), 2), strains[1])

    @LinearForm
    def pressure(v, w):
        return (1 + slope * w.x[1]) * v[0]

    def on_crack(x):
        return (abs(x[0]) < 1e-9) & (x[1] < length + 1e-9)

    faces = mesh.facets_satisfying(on_crack, boundaries_only=True)
    load = pressure.assemble(FacetBasis(mesh, basis.elem, facets=faces))
    ahead = basis.get_dofs(lambda x: (abs(x[0]) < 1e-9) & (x[1] > length - 1e-9)).all(["u^1"])
    beside = basis.get_dofs(lambda x: abs(x[0] - 0.5 * spacing) < 1e-9).all(["u^1"])
    end = basis.get_dofs(lambda x: abs(x[1] - FAR) < 1e-9).all()
    held = np.unique(np.concatenate([ahead, beside, end]))
    moved = solve(*condense(stiffness.assemble(basis), load, D=held))
    return 0.5 * load @ moved


def intensity(spacing: float, slope: float) -> float:
    shorter, longer = (energy(spacing, slope, 1 + part * SIZE) for part in (-1, 1))
    return (2 * (longer - shorter) / (2 * SIZE) / (1 - POISSON**2)) ** 0.5


def by_program(slope: float) -> list[float]:
    """Stress intensities of all spacings, over 1 MPa and the root of the depth."""
    top = 1000.0 - DROP
    scene = SCENE.format(top=top, bottom=top - DROP * slope * 2e-3 / DEPTH)
    flaws = "".join(
        FLAW.format(n=n, depth=DEPTH, spacing=spacing * DEPTH) for n, spacing in enumerate(SPACINGS)
    )
    with TemporaryDirectory() as folder:
        file = Path(folder) / "row.toml"
        file.write_text(scene + flaws)
        with Unit(file) as unit:
            for _ in range(20):
                unit.step(1.0)
            found = unit.get([f"f{n}.stress_intensity" for n in range(len(SPACINGS))])
    return [float(value) / (1e6 * DEPTH**0.5) for value in found]


def main() -> int:
    wrong = 0
    for slope in (0.0, 0.5, -0.5):
        for spacing, found in zip(SPACINGS, by_program(slope), strict=True):
            wanted = intensity(spacing, slope)
            off = found / wanted - 1
            print(f"slope {slope:+g}, spacing {spacing:g}: K {found:.4f}, {100 * off:+.2f} %")
            wrong += abs(off) > OFF
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
