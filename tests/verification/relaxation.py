"""A disc whose moduli relax, in impinge and in scikit-fem by the correspondence principle.

The disc is glued to its base, warmed at time zero and pressed on the middle of its top. impinge
steps through time; the peer solves elasticity with the moduli of the Laplace transform on a mesh of
its own and inverts that by Talbot's method, so the two share neither mesh nor steps. Exit code 1 if
they differ.
"""

import sys
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
import skfem
from skfem.helpers import ddot, sym_grad

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "python"))
from impinge import Unit  # noqa: E402

RADIUS, THICKNESS, PRESSED = 10e-3, 4e-3, 4e-3  # m
YOUNG, POISSON, EXPANSION, RISE, PRESSURE = 3e9, 0.35, 7e-5, 20.0, 4e6
SHEAR = [(0.5, 0.3), (0.4, 3.0)]  # fractions, times [s]
BULK = [(0.2, 1.0)]
TIMES = [0.1, 0.5, 2.0, 10.0]  # s
DEPTH = 1e-3  # m, of the place of stress
LIMIT = 1.0  # percent
TALBOT = 12


def modulus(first, branches, s):
    """The modulus of the Laplace transform, s times that of relaxation."""
    return first * (1 - sum(g / (1 + s * tau) for g, tau in branches))


def elastic(basis, held, bulk, shear):
    """Deflection of the middle of the top, and stress rr and zz below it, for moduli."""
    lame = bulk - 2 / 3 * shear
    rise = EXPANSION * RISE

    def radial(u, w):
        return u[0] / w.x[0]

    @skfem.BilinearForm(dtype=np.complex128)
    def stiffness(u, v, w):
        e, d = sym_grad(u), sym_grad(v)
        hoop, other = radial(u, w), radial(v, w)
        volume, its = e[0, 0] + e[1, 1] + hoop, d[0, 0] + d[1, 1] + other
        return (lame * volume * its + 2 * shear * (ddot(e, d) + hoop * other)) * w.x[0]

    @skfem.LinearForm(dtype=np.complex128)
    def thermal(v, w):
        d = sym_grad(v)
        return 3 * bulk * rise * (d[0, 0] + d[1, 1] + radial(v, w)) * w.x[0]

    @skfem.LinearForm(dtype=np.complex128)
    def pressed(v, w):
        return -PRESSURE * v[1] * w.x[0]

    top = skfem.FacetBasis(basis.mesh, basis.elem, facets="pressed", intorder=4)
    load = thermal.assemble(basis) + pressed.assemble(top)
    u = skfem.solve(*skfem.condense(stiffness.assemble(basis), load, D=held))
    middle = np.flatnonzero(np.all(np.isclose(basis.doflocs, 0.0, atol=1e-12), axis=0))
    gradient = gradient_at(basis, u, np.array([[1e-9], [-DEPTH + 1e-9]]))
    rr, zz = gradient[0, 0], gradient[1, 1]
    stress = lame * (2 * rr + zz) - 3 * bulk * rise
    return np.array([u[middle[-1]], stress + 2 * shear * rr, stress + 2 * shear * zz])


def gradient_at(basis, u, place):
    cell = basis.mesh.element_finder()(*place)
    local = basis.mapping.invF(place[:, :, None], tind=cell)
    shapes = (basis.elem.gbasis(basis.mapping, local, i, tind=cell)[0] for i in range(basis.Nbfun))
    values = u[basis.element_dofs[:, cell[0]]]
    return sum(value * shape.grad[:, :, 0, 0] for value, shape in zip(values, shapes, strict=True))


def invert(of_s, time):
    """Talbot's inversion of a Laplace transform, as J. Abate and W. Whitt (2006) have it."""
    total = 0.5 * np.exp(2 * TALBOT / 5) * of_s(2 * TALBOT / (5 * time))
    for k in range(1, TALBOT):
        angle = k * np.pi / TALBOT
        cot = 1 / np.tan(angle)
        delta = 2 * k * np.pi / 5 * (cot + 1j)
        weight = 1 + 1j * angle * (1 + cot**2) - 1j * cot
        total = total + np.exp(delta) * weight * of_s(delta / time)
    return (0.4 * total / time).real


def peer():
    radii = np.unique(np.r_[np.linspace(0, 6e-3, 19), np.linspace(6e-3, RADIUS, 9)])
    mesh = skfem.MeshQuad.init_tensor(radii, np.linspace(-THICKNESS, 0, 17))
    mesh = mesh.with_boundaries(
        {
            "pressed": lambda x: np.isclose(x[1], 0) & (x[0] < PRESSED),
            "base": lambda x: np.isclose(x[1], -THICKNESS),
        }
    )
    basis = skfem.Basis(mesh, skfem.ElementVector(skfem.ElementQuad2()), intorder=5)
    axis = basis.get_dofs(lambda x: np.isclose(x[0], 0)).all("u^1")
    held = np.unique(np.r_[axis, basis.get_dofs("base").all()])
    bulk, shear = YOUNG / 3 / (1 - 2 * POISSON), YOUNG / 2 / (1 + POISSON)

    def of_s(s):
        return elastic(basis, held, modulus(bulk, BULK, s), modulus(shear, SHEAR, s)) / s

    return np.array([invert(of_s, time) for time in TIMES])


SCENE = f"""
name = "Relaxation"
stop_time = 10.0
step = 0.1
[body.disc]
kind = "solid"
shape = {{ disc = {{ radius = {RADIUS}, thickness = {THICKNESS} }} }}
initial_temperature = {300.0 + RISE}
stress_free_temperature = 300.0
mesh = {{ spacing = 0.25e-3, depth_spacing = 0.1e-3, growth = 1.1 }}
faces.bottom = {{ clamped = true }}
[body.disc.material]
model = "viscoelastic"
density = 1200.0
specific_heat = 1500.0
conductivity = 0.2
young = {YOUNG}
poisson = {POISSON}
expansion = {EXPANSION}
shear_relaxation = [{", ".join(f"{{ fraction = {g}, time = {t} }}" for g, t in SHEAR)}]
bulk_relaxation = [{", ".join(f"{{ fraction = {g}, time = {t} }}" for g, t in BULK)}]
[[load]]
name = "press"
on = "disc.top"
footprint = {{ disc = {{ radius = {PRESSED} }} }}
carries = ["pressure"]
start = {{ pressure = {PRESSURE} }}
[[probe]]
name = "top"
in = "disc"
at = [0.0, 0.0, 0.0]
gives = ["displacement"]
[[probe]]
name = "below"
in = "disc"
at = [0.0, 0.0, {-DEPTH}]
gives = ["stress"]
"""


def ours():
    with TemporaryDirectory() as folder:
        path = Path(folder) / "scene.toml"
        path.write_text(SCENE)
        rows = []
        with Unit(path) as unit:
            for time in TIMES:
                unit.step_to(time)
                rows.append(unit.get(["top.displacement_z", "below.stress_xx", "below.stress_zz"]))
    return np.array(rows)


def main():
    found, wanted = ours(), peer()
    off = 100 * np.abs(found - wanted) / np.abs(wanted).max(axis=0)
    print("t/s    deflection/µm        xx/MPa            zz/MPa          off/%")
    for time, a, b, c in zip(TIMES, found, wanted, off, strict=True):
        pairs = zip(a, b, [1e6, 1e-6, 1e-6], strict=True)
        texts = "  ".join(f"{x * f:8.3f} {y * f:8.3f}" for x, y, f in pairs)
        print(f"{time:5.1f}  {texts}   {c.round(3)}")
    sys.exit(int(off.max() > LIMIT))


if __name__ == "__main__":
    main()
