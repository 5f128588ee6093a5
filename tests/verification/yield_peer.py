"""Bodies that yield, in scikit-fem: an independent program for the same equations and nodes.

Quadratic elements on the meridian section of a disc or on a quarter of a box, with the mesh, shape
functions and quadrature of scikit-fem. Heat is linear and advances by an L-stable Runge–Kutta
method of order 2; equilibrium is found at the end of each increment by Newton's method with the
consistent tangent. The change of volume, that of heat included, is projected on linear polynomials
in each element, as quadratic elements with it at all points lock in plastic flow (T. J. R. Hughes
1980, doi 10.1002/nme.1620150914).

Law: J₂ plasticity with linear isotropic and kinematic hardening, returned to yield radially.
Stresses and strains are written with shears times √2 (J. Mandel 1965), xx, yy, zz, xy, yz, xz or
rr, tt, zz, rz, so that products of tensors are those of vectors.
"""

from dataclasses import dataclass, field
from math import pi, sqrt

import numpy as np
import scipy.sparse as sp
from peer import Factor, SymmetricFactor, ends_of_elements
from skfem import (
    Basis,
    BilinearForm,
    ElementHex2,
    ElementQuad2,
    FacetBasis,
    LinearForm,
    MeshHex,
    MeshQuad,
)
from skfem.helpers import dot, grad

ROOT_2_3 = sqrt(2 / 3)


def of_temperature(constant, temperature):
    """A number, or (temperatures, values): linear between, held outside."""
    if isinstance(constant, tuple):
        return np.interp(temperature, *constant)
    return np.full_like(temperature, constant)


@dataclass(frozen=True)
class Metal:
    """Constants in SI units; those of mechanics may be tables over the temperature."""

    density: float
    specific_heat: float
    conductivity: float
    poisson: float
    expansion: float
    young: float | tuple
    yield_stress: float | tuple
    isotropic_hardening: float | tuple = 0.0
    kinematic_hardening: float | tuple = 0.0


@dataclass
class Points:
    """What all quadrature points remember, `(element, point, component)`."""

    plastic: np.ndarray
    accumulated: np.ndarray
    dissipated: np.ndarray


@dataclass
class Answer:
    """Of all quadrature points [Pa]."""

    stress: np.ndarray
    tangent: np.ndarray
    new: Points


def respond(metal, strain, temperature, expansion, old):
    """Radial return (M. L. Wilkins 1964) and its derivative; `expansion` is that of volume [1]."""
    width = strain.shape[-1]
    ones = np.zeros(width)
    ones[:3] = 1.0
    young = of_temperature(metal.young, temperature)
    bulk = young / (3 * (1 - 2 * metal.poisson))
    shear = young / (2 * (1 + metal.poisson))
    isotropic = of_temperature(metal.isotropic_hardening, temperature)
    kinematic = of_temperature(metal.kinematic_hardening, temperature)
    strength = of_temperature(metal.yield_stress, temperature)
    volume = strain @ ones
    pressure = bulk * (volume - expansion)
    shape = strain - (volume / 3)[..., None] * ones
    trial = 2 * shear[..., None] * (shape - old.plastic)
    # The back stress follows the same strain as the flow.
    overstress = trial - (2 / 3 * kinematic)[..., None] * old.plastic
    size = np.sqrt((overstress**2).sum(axis=-1))
    excess = np.maximum(size - ROOT_2_3 * (strength + isotropic * old.accumulated), 0.0)
    modulus = 2 * shear + 2 / 3 * (isotropic + kinematic)
    flow = excess / modulus
    direction = overstress / np.where(size > 0, size, 1.0)[..., None]
    stress = trial - (2 * shear * flow)[..., None] * direction + pressure[..., None] * ones
    more = ROOT_2_3 * flow
    new = Points(
        old.plastic + flow[..., None] * direction,
        old.accumulated + more,
        old.dissipated + strength * more,
    )
    part = 2 * shear * flow / np.where(size > 0, size, 1.0)
    along = np.where(flow > 0, 2 * shear * (2 * shear / modulus - part), 0.0)
    deviator = np.eye(width) - np.outer(ones, ones) / 3
    tangent = (2 * shear * (1 - part))[..., None, None] * deviator
    tangent += bulk[..., None, None] * np.outer(ones, ones)
    tangent -= (along[..., None] * direction)[..., :, None] * direction[..., None, :]
    return Answer(stress, tangent, new)


def von_mises(stress):
    """[Pa]"""
    mean = stress[..., :3].mean(axis=-1)
    shape = stress.copy()
    shape[..., :3] -= mean[..., None]
    return np.sqrt(1.5 * (shape**2).sum(axis=-1))


def max_principal(stress):
    """[Pa]"""
    tensor = np.zeros(stress.shape[:-1] + (3, 3))
    pairs = [(0, 2)] if stress.shape[-1] == 4 else [(0, 1), (1, 2), (0, 2)]
    for i in range(3):
        tensor[..., i, i] = stress[..., i]
    for k, (i, j) in enumerate(pairs):
        tensor[..., i, j] = tensor[..., j, i] = stress[..., 3 + k] / sqrt(2)
    return np.linalg.eigvalsh(tensor)[..., -1]


def products(at, degree):
    """Products of powers of the coordinates up to a degree each, a row a place; 1 first."""
    powers = [at[:, i, None] ** np.arange(degree + 1) for i in range(at.shape[1])]
    terms = powers[0]
    for more in powers[1:]:
        terms = (terms[:, :, None] * more[:, None, :]).reshape(len(at), -1)
    return terms


@dataclass
class Body:
    """A body on the nodes of `axes`: (r, z) of a section, or (x, y, z) from the symmetry planes on.

    `held(place, component)` tells which displacements are zero, from nodal places `(node, axis)`.
    Vectors of nodes run x (r) fastest; displacements have the components of a node together.
    """

    axes: tuple
    metal: Metal
    cold: float
    held: callable
    newton_steps: int = field(default=0, init=False)

    ORDER = 2
    TOLERANCE = 1e-11
    MOST_NEWTON = 40

    def __post_init__(self):
        self.is_ring = len(self.axes) == 2
        self.degrees = len(self.axes)
        ends = ends_of_elements(self.axes, self.ORDER)
        mesh, element, points = (
            (MeshQuad.init_tensor(*ends), ElementQuad2(), self.ORDER + 2)
            if self.is_ring
            else (MeshHex.init_tensor(*ends), ElementHex2(), self.ORDER + 1)
        )
        self.copies = 1 if self.is_ring else 4
        self.basis = Basis(mesh, element, intorder=2 * points - 1)
        self._number_nodes()
        self._shape_functions()
        free = ~np.concatenate(
            [self.held(self.places, c)[:, None] for c in range(self.degrees)], axis=1
        ).ravel()
        self.free = np.nonzero(free)[0]
        self._pattern(free)
        self.factor = SymmetricFactor()
        shape = self.volumes.shape
        width = self.strains.shape[2]
        self.points = Points(np.zeros((*shape, width)), np.zeros(shape), np.zeros(shape))
        self.displacement = np.zeros(self.degrees * len(self.places))

    def _number_nodes(self):
        """scikit-fem's numbers to those of the grid, x fastest."""
        number, stride = np.zeros(self.basis.N, dtype=int), 1
        for nodes, at in zip(self.axes, self.basis.doflocs, strict=True):
            nearest = np.abs(nodes[:, None] - at).argmin(axis=0)
            assert np.allclose(nodes[nearest], at, atol=1e-6 * np.ptp(nodes))
            number += stride * nearest
            stride *= len(nodes)
        assert len(np.unique(number)) == len(number) == stride
        self.number = number
        self.places = np.empty((stride, len(self.axes)))
        self.places[number] = self.basis.doflocs.T
        self.element_nodes = number[self.basis.element_dofs].T

    def _shape_functions(self):
        basis, count = self.basis, self.basis.Nbfun
        values = [np.asarray(basis.basis[a][0]) for a in range(count)]
        slopes = [basis.basis[a][0].grad for a in range(count)]
        at = np.asarray(basis.global_coordinates())
        self.values = np.stack(np.broadcast_arrays(*values), axis=-1)
        around = 2 * pi * at[0] if self.is_ring else 1.0
        self.volumes = basis.dx * around
        self.coordinates = np.moveaxis(at, 0, -1)
        elements, points = self.volumes.shape
        width = 4 if self.is_ring else 6
        d = self.degrees
        strains = np.zeros((elements, points, width, d * count))
        half = sqrt(0.5)
        for a in range(count):
            g = slopes[a]
            if self.is_ring:
                strains[:, :, 0, d * a] = g[0]
                strains[:, :, 1, d * a] = values[a] / at[0]
                strains[:, :, 2, d * a + 1] = g[1]
                strains[:, :, 3, d * a] = half * g[1]
                strains[:, :, 3, d * a + 1] = half * g[0]
                continue
            for c in range(3):
                strains[:, :, c, d * a + c] = g[c]
            for row, (i, j) in enumerate([(0, 1), (1, 2), (0, 2)]):
                strains[:, :, 3 + row, d * a + i] = half * g[j]
                strains[:, :, 3 + row, d * a + j] = half * g[i]
        self._project(strains)
        self.strains = strains
        unknowns = d * self.element_nodes[:, :, None] + np.arange(d)
        self.element_unknowns = unknowns.reshape(elements, -1)

    def _project(self, strains):
        """Replaces the change of volume in strains by its projection, the best in the mean."""
        centre = self.coordinates.mean(axis=1, keepdims=True)
        local = (self.coordinates - centre) / np.ptp(self.coordinates, axis=1, keepdims=True)
        terms = np.concatenate([np.ones((*local.shape[:2], 1)), local], axis=-1)
        weighted = (self.volumes[..., None] * terms).swapaxes(1, 2)
        self.projection = terms @ np.linalg.solve(weighted @ terms, weighted)
        volume = strains[:, :, :3].sum(axis=2)
        strains[:, :, :3] += ((self.projection @ volume - volume) / 3)[:, :, None]

    def _pattern(self, free):
        """Where each entry of the elements' matrices stands in the upper triangle of free ones."""
        number = np.full(free.size, -1)
        number[free] = np.arange(free.sum())
        of_element = number[self.element_unknowns]
        rows = np.broadcast_to(of_element[:, :, None], of_element.shape + of_element.shape[1:])
        columns = np.swapaxes(rows, 1, 2)
        self.entries = np.nonzero(((rows >= 0) & (columns >= rows)).ravel())[0]
        count = int(free.sum())
        keys = rows.ravel()[self.entries].astype(np.int64) * count + columns.ravel()[self.entries]
        keys, self.slots = np.unique(keys, return_inverse=True)
        starts = np.searchsorted(keys // count, np.arange(count + 1))
        self.upper = sp.csr_matrix((np.zeros(len(keys)), keys % count, starts), (count, count))

    # Heat

    def flux_under_spot(self, peak, radius):
        """Heat into the nodes of the top [W] of a Gaussian flux, 1/e² at the radius."""
        high = self.axes[-1][-1]
        facets = self.basis.mesh.facets_satisfying(lambda x: np.isclose(x[-1], high, atol=1e-12))
        top = FacetBasis(self.basis.mesh, self.basis.elem, facets=facets, intorder=8)

        def flux(s, w):
            if self.is_ring:
                return peak * np.exp(-2 * (w.x[0] / radius) ** 2) * 2 * pi * w.x[0] * s
            return peak * np.exp(-2 * (w.x[0] ** 2 + w.x[1] ** 2) / radius**2) * s

        return LinearForm(flux).assemble(top)[self._order()]

    def _order(self):
        return np.argsort(self.number)

    def assemble_heat(self):
        metal = self.metal
        around = (lambda w: 2 * pi * w.x[0]) if self.is_ring else (lambda w: 1.0)
        capacity = metal.density * metal.specific_heat
        mass = BilinearForm(lambda t, s, w: capacity * around(w) * t * s)
        conduction = BilinearForm(
            lambda t, s, w: metal.conductivity * around(w) * dot(grad(t), grad(s))
        )
        order = self._order()
        self.mass, self.conduction = (
            form.assemble(self.basis)[order][:, order].tocsr() for form in (mass, conduction)
        )

    GAMMA = 1 - 1 / sqrt(2)

    def advance_heat(self, rise, heating, duration, count):
        """`count` steps of an L-stable diagonally implicit method of order 2."""
        g, dt = self.GAMMA, duration / count
        factor = Factor((self.mass + g * dt * self.conduction).tocsr())
        for _ in range(count):
            rate = heating - self.conduction @ rise
            first = factor.solve(rate)
            second = factor.solve(rate - (1 - g) * dt * (self.conduction @ first))
            rise = rise + dt * ((1 - g) * first + g * second)
        return rise

    # Mechanics

    def strain_of(self, displacement):
        u = displacement[self.element_unknowns]
        return np.einsum("eqij,ej->eqi", self.strains, u, optimize=True)

    def forces(self, stress):
        """Nodal forces, and what they are small beside."""
        weighted = self.volumes[..., None] * stress
        elements = len(weighted)
        matrix = self.strains.reshape(elements, -1, self.strains.shape[-1])
        each = (weighted.reshape(elements, 1, -1) @ matrix)[:, 0, :]
        size = len(self.displacement)
        places = self.element_unknowns.ravel()
        return tuple(np.bincount(places, x.ravel(), size)[self.free] for x in (each, np.abs(each)))

    def stiffness(self, tangent):
        elements, points, width, unknowns = self.strains.shape
        scaled = (self.volumes[..., None, None] * tangent) @ self.strains
        left = self.strains.reshape(elements, points * width, unknowns).swapaxes(1, 2)
        each = left @ scaled.reshape(elements, points * width, unknowns)
        entries = each.ravel()[self.entries]
        self.upper.data[:] = np.bincount(self.slots, entries, len(self.upper.data))
        return self.upper

    def at_points(self, nodal):
        return np.einsum("eqa,ea->eq", self.values, nodal[self.element_nodes])

    def advance(self, temperature):
        """Equilibrium at nodal temperatures; no forces but those of supports."""
        at_points = self.at_points(temperature)
        u = self.displacement
        expansion = 3 * self.metal.expansion * (at_points - self.cold)
        given = at_points, (self.projection @ expansion[..., None])[..., 0]
        answer, left, size = self._left(u, given)
        for _ in range(self.MOST_NEWTON):
            if np.linalg.norm(left) <= self.TOLERANCE * size:
                break
            self.newton_steps += 1
            change = np.zeros_like(u)
            change[self.free] = self.factor.solve(self.stiffness(answer.tangent), left)
            part = 1.0
            while True:
                found = self._left(u + part * change, given)
                better = np.linalg.norm(found[1]) < (1 - 0.1 * part) * np.linalg.norm(left)
                if better or part < 0.1:
                    break
                part *= 0.5
            u = u + part * change
            answer, left, size = found
        else:
            raise RuntimeError("scikit-fem's peer found no equilibrium")
        self.displacement, self.points, self.stress = u, answer.new, answer.stress

    def _left(self, u, given):
        answer = respond(self.metal, self.strain_of(u), *given, self.points)
        forces, beside = self.forces(answer.stress)
        return answer, -forces, np.linalg.norm(beside)

    def dissipated(self):
        """[J]"""
        return self.copies * float((self.volumes * self.points.dissipated).sum())

    def recovered(self, values, place):
        """Values of points taken to a place, by superconvergent patches (O. C. Zienkiewicz and
        J. Z. Zhu 1992, doi 10.1002/nme.1620330702).

        In each element around, the best linear polynomials give values where strains of quadratic
        elements are most accurate; the best quadratic one through these gives that at the place.
        """
        corners = self.places[self.element_nodes]
        centre, size = corners.mean(axis=1), np.ptp(corners, axis=1)
        d = len(self.axes)
        near = np.all(np.abs(centre - place) < 1.1 * size, axis=1)
        accurate = np.array(np.meshgrid(*[(-sqrt(1 / 12), sqrt(1 / 12))] * d)).reshape(d, -1).T
        at, found = [], []
        for middle, edges, points, own in zip(
            centre[near], size[near], self.coordinates[near], values[near], strict=True
        ):
            linear = np.linalg.lstsq(products((points - middle) / edges, 1), own, rcond=None)[0]
            found.append(products(accurate, 1) @ linear)
            at.append(middle + accurate * edges)
        local = np.concatenate(at) - place
        terms = products(local / np.abs(local).max(axis=0), 2)
        return np.linalg.lstsq(terms, np.concatenate(found), rcond=None)[0][0]
