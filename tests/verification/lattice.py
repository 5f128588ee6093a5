"""Notched beams of impinge's lattice, and of independent codes: elastic opening and loads.

The lattice is built anew here: textbook beam elements, supports as constraints, damage by secant
iterations instead of Newton's method. The elastic opening is that of plane-stress finite elements
(scikit-fem), too. Beyond 24 µm the equilibrium without scatter is unstable, and secant iterations
leave it. Exit code 1 if loads differ by more than 1.5 %, elastic openings by more than 0.1 %
between the lattices or by more than 6 % from finite elements.
"""

import sys
from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
import scipy.sparse as sp
from impinge import Unit
from scipy.sparse.linalg import splu
from scipy.spatial import cKDTree
from skfem import Basis, BilinearForm, ElementQuad2, ElementVector, MeshQuad, asm
from skfem.helpers import ddot, eye, sym_grad, trace

YOUNG, POISSON, THICKNESS = 30e9, 0.2, 0.1524  # Pa, 1, m
STRENGTH, KNEE, END, SHARE, BENDING = 4.5e6, 9.05e-6, 197e-6, 0.13, 0.1
NOTCH = 2.54e-3  # m, width
OF_LOADS, OF_OPENINGS, OF_ELEMENTS = 0.015, 0.001, 0.06


@dataclass(frozen=True)
class Beam:
    depth: float  # m; the span is thrice, the notch a third of it
    spacing: float  # m

    @property
    def span(self) -> float:
        return 3 * self.depth

    @property
    def notch(self) -> float:
        return self.depth / 3

    @property
    def length(self) -> float:
        return self.span + 4 * self.spacing


class Lattice:
    """Particles across the beam, as u, w and θ each; links as beam elements."""

    def __init__(self, beam: Beam):
        s, column = beam.spacing, beam.spacing * 3**0.5 / 2
        most = int(beam.length / 2 / column - 0.5 + 1e-6)
        rows = np.arange(round(beam.depth / s))
        places = [
            (j * column, (0.25 + 0.5 * (j % 2) + k) * s)
            for j in range(-most, most + 1)
            for k in rows
            if j or (0.25 + k) * s > beam.notch
        ]
        self.places = np.array(places)
        self.pairs = cKDTree(self.places).query_pairs(1.3 * s, output_type="ndarray")
        across = self.places[self.pairs[:, 1]] - self.places[self.pairs[:, 0]]
        self.lengths = np.hypot(*across.T)
        self.turn = across / self.lengths[:, None]
        axial = YOUNG * s * THICKNESS / (3**0.5 * (1 - POISSON))
        flexural = YOUNG * s**3 * THICKNESS * (1 - 3 * POISSON)
        flexural /= 12 * 3**0.5 * (1 - POISSON**2)
        self.elements = np.array([self.element(i, axial, flexural) for i in range(len(across))])
        self.dofs = np.concatenate([3 * self.pairs[:, [k]] + np.arange(3) for k in (0, 1)], axis=1)
        self.beam = beam
        self.damage = np.zeros(len(across))
        self.support()

    def element(self, i: int, axial: float, flexural: float) -> np.ndarray:
        """Stiffness of a plane frame element in the global axes."""
        a, c = axial / self.lengths[i], flexural / self.lengths[i] ** 3
        ell = self.lengths[i]
        k = np.zeros((6, 6))
        k[np.ix_([0, 3], [0, 3])] = a * np.array([[1, -1], [-1, 1]])
        bend = [
            [12, 6 * ell, -12, 6 * ell],
            [6 * ell, 4 * ell**2, -6 * ell, 2 * ell**2],
            [-12, -6 * ell, 12, -6 * ell],
            [6 * ell, 2 * ell**2, -6 * ell, 4 * ell**2],
        ]
        k[np.ix_([1, 2, 4, 5], [1, 2, 4, 5])] = c * np.array(bend)
        rotation = self.rotation(i)
        return rotation.T @ k @ rotation

    def rotation(self, i: int) -> np.ndarray:
        c, s = self.turn[i]
        one = np.array([[c, s, 0], [-s, c, 0], [0, 0, 1]])
        return np.kron(np.eye(2), one)

    def nearest(self, x: float, upper: bool) -> list[tuple[int, float]]:
        """The particles of a face beside a place, with their parts of what acts there."""
        z = self.places[:, 1]
        s = self.beam.spacing
        face = np.flatnonzero(z > self.beam.depth - 0.9 * s if upper else z < 0.9 * s)
        away = self.places[face, 0] - x
        if (exact := face[abs(away) < 1e-9]).size:
            return [(exact[0], 1.0)]
        left, right = away[away < 0].max(), away[away > 0].min()
        part = right / (right - left)
        return [(face[away == left][0], part), (face[away == right][0], 1 - part)]

    def support(self) -> None:
        """Constraints on the supports, unit load and opening; the middle is held along x."""
        count = 3 * len(self.places)
        half = self.beam.span / 2
        ends = [self.nearest(x, False) for x in (-half, half)]
        load = self.nearest(0.0, True)
        self.load = np.zeros(count)
        rows = [np.zeros(count) for _ in range(3)]
        for row, end in zip(rows, ends, strict=False):
            for particle, part in end:
                row[3 * particle + 1] = part
        rows[2][3 * load[0][0]] = 1
        for particle, part in load:
            self.load[3 * particle + 1] -= part
        self.constraints = sp.csr_matrix(np.array(rows))
        self.mouth = np.zeros(count)
        for side in (-1, 1):
            low = self.places[:, 1] < 0.9 * self.beam.spacing
            own = np.flatnonzero((self.places[:, 0] * side > 0) & low)
            near = own[abs(self.places[own, 0]).argmin()]
            self.mouth[3 * near] += side
            self.mouth[3 * near + 2] += side * self.places[near, 1]
        held = [particle for place in [*ends, load] for particle, _ in place]
        away = np.min([np.hypot(*(self.places - self.places[i]).T) for i in held], axis=0)
        far = away > 2 * self.beam.spacing
        self.breaks = far[self.pairs].all(axis=1)

    def unit_response(self) -> np.ndarray:
        """Displacements under the unit load at the present damage."""
        left = np.maximum(1 - self.damage, 1e-9)
        values = (left[:, None, None] * self.elements).ravel()
        rows = np.repeat(self.dofs, 6, axis=1).ravel()
        columns = np.tile(self.dofs, (1, 6)).ravel()
        count = len(self.load)
        stiffness = sp.coo_matrix((values, (rows, columns)), (count, count))
        scale = YOUNG * THICKNESS
        held = scale * self.constraints
        whole = sp.bmat([[stiffness, held.T], [held, None]])
        right = np.concatenate([self.load, np.zeros(3)])
        return splu(whole.tocsc()).solve(right)[:count]

    def stretches(self, u: np.ndarray) -> np.ndarray:
        local = np.array([self.rotation(i) @ u[self.dofs[i]] for i in range(len(self.pairs))])
        chord = (local[:, 4] - local[:, 1]) / self.lengths
        turned = local[:, [2, 5]] - chord[:, None]
        curved = 2 * abs(turned @ np.array([[2, 1], [1, 2]]))
        return (local[:, 3] - local[:, 0]) / self.lengths + BENDING * curved.max(axis=1)

    def open(self, opening: float) -> float:
        """The load at an opening, by secant iterations."""
        before = 0.0
        for _ in range(2000):
            unit = self.unit_response()
            load = opening / (self.mouth @ unit)
            self.damage = np.maximum(self.damage, self.law(self.stretches(load * unit)))
            if abs(load - before) < 1e-5 * load:
                return load
            before = load
        raise RuntimeError("the damage does not settle")

    def law(self, stretch: np.ndarray) -> np.ndarray:
        onset = STRENGTH / YOUNG
        ratio = stretch / onset
        knee, end = (1 + w / (onset * self.beam.spacing) for w in (KNEE, END))
        falls = [(1 - (1 - SHARE) * (ratio - 1) / (knee - 1)), SHARE * (end - ratio) / (end - knee)]
        force = np.select([ratio <= 1, ratio <= knee, ratio < end], [ratio, *falls], 0.0)
        return np.where(self.breaks & (ratio > 1), 1 - force / np.maximum(ratio, 1e-30), 0.0)


def elastic_opening(beam: Beam) -> float:
    """Opening over load [m/N] of half the beam, by quadratic finite elements in plane stress."""
    h = beam.notch / 32
    x = np.concatenate([np.arange(0, 40) * h, np.linspace(40 * h, beam.span / 2, 60)])
    mesh = MeshQuad.init_tensor(x, np.linspace(0, beam.depth, 97))
    basis = Basis(mesh, ElementVector(ElementQuad2()))
    lame = YOUNG * POISSON / (1 - POISSON**2)  # of plane stress
    shear = YOUNG / (2 * (1 + POISSON))

    @BilinearForm
    def energy(u, v, _):
        strain = sym_grad(u)
        stress = 2 * shear * strain + lame * eye(trace(strain), 2)
        return ddot(stress, sym_grad(v))

    stiffness = THICKNESS * asm(energy, basis)
    places = basis.doflocs
    ligament = (places[0] < 1e-12) & (places[1] > beam.notch - 1e-9)
    held = np.flatnonzero(ligament & component(basis, 0))
    corner = (abs(places[0] - beam.span / 2) < 1e-12) & (abs(places[1]) < 1e-12)
    held = np.concatenate([held, np.flatnonzero(corner & component(basis, 1))])
    load = np.zeros(basis.N)
    top = (places[0] < 1e-12) & (abs(places[1] - beam.depth) < 1e-12)
    load[np.flatnonzero(top & component(basis, 1))] = -0.5
    free = np.setdiff1d(np.arange(basis.N), held)
    u = np.zeros(basis.N)
    u[free] = splu(stiffness[free][:, free].tocsc()).solve(load[free])
    # The lattice's opening is that of the particles beside the missing column.
    mouth = (abs(places[1]) < 1e-12) & component(basis, 0)
    order = np.argsort(places[0][mouth])
    reach = 3**0.5 / 2 * beam.spacing
    return 2 * np.interp(reach, places[0][mouth][order], u[mouth][order])


def component(basis: Basis, k: int) -> np.ndarray:
    """True for unknowns of one component: those of nodes, edges and insides by turns."""
    found = np.zeros(basis.N, bool)
    for numbers in (basis.nodal_dofs, basis.facet_dofs, basis.interior_dofs):
        found[numbers[k]] = True
    return found


def loads(beam: Beam, openings: np.ndarray, folder: Path) -> np.ndarray:
    """Those of impinge, without scatter and without contact, as the other lattice."""
    scene = folder / "beam.toml"
    scene.write_text(
        f'name = "Beam"\nstop_time = 1.0\nstep = 0.1\n[body.beam]\nkind = "lattice"\n'
        f"length = {beam.length}\ndepth = {beam.depth}\nthickness = {THICKNESS}\n"
        f"spacing = {beam.spacing}\nnotch = {{ depth = {beam.notch}, width = {NOTCH} }}\n"
        f'support = {{ three_point = {{ span = {beam.span} }} }}\ncontrol = "opening"\n'
        f"contact = false\nscatter = 0.0\nmaterial = {{ density = 2323.0, young = {YOUNG}, "
        f'poisson = {POISSON}, softening = {{ model = "openings", strength = {STRENGTH}, '
        f"openings = [{KNEE}, {END}], share = {SHARE}, bending = {BENDING} }} }}\n"
    )
    found = []
    with Unit(scene) as unit:
        for opening in openings:
            unit.set({"beam.opening": opening})
            unit.step_to(unit.time + 0.1)
            found += list(unit.get(["beam.force"]))
    return np.array(found)


def main() -> int:
    wrong = 0
    for beam in (Beam(76.2e-3, 6.35e-3), Beam(76.2e-3, 76.2e-3 / 18)):
        openings = np.concatenate([[1e-6], np.arange(4, 25, 4) * 1e-6])
        with TemporaryDirectory() as folder:
            own = loads(beam, openings, Path(folder))
        lattice = Lattice(beam)
        other = np.array([lattice.open(opening) for opening in openings])
        elements = elastic_opening(beam)
        off = abs(own / other - 1).max()
        elastic = own[0] / other[0] - 1
        of_elements = openings[0] / own[0] / elements - 1
        print(f"depth {beam.depth * 1e3:.1f} mm, spacing {beam.spacing * 1e3:.2f} mm:", end="")
        print(f" load {own[-1]:.0f} N, {other[-1]:.0f} N (up to {off:.2%});", end="")
        print(f" stiffness {elastic:+.3%},", end="")
        print(f" opening {of_elements:+.1%} beside finite elements")
        wrong += off > OF_LOADS or abs(elastic) > OF_OPENINGS
        wrong += abs(of_elements) > OF_ELEMENTS
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
