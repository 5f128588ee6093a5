"""Gradient damage in scikit-fem: an independent program for the edge crack of `cracks.rs`.

AT1 without tension, plane strain, bilinear elements with four points. Displacement and damage are
minimised in turn, changes of damage lengthened by 1.6 (P. E. Farrell & C. Maurini 2017, doi
10.1002/nme.5300), until damage changes by less than 1e-4 and at most 1e-6 of the forces are left.
Displacements follow from Newton's method, damage from an active set between its last value and 1;
both with direct solvers, PARDISO if there is pypardiso.

    python tests/verification/cracks_peer.py [NODES PER LENGTH] [STEPS]

prints energies and times of a step each, to be held beside those that

    cargo test --release --features verification --test verification edge_crack -- --nocapture

prints.
"""

import sys
import time
from math import sqrt

import numpy as np
from scipy.integrate import quad
from scipy.sparse.linalg import splu
from scipy.special import erfc
from skfem import Basis, BilinearForm, ElementQuad1, ElementVector, LinearForm, MeshQuad
from skfem.helpers import dot, grad

try:
    from pypardiso import spsolve as pardiso
except ImportError:
    pardiso = None

YOUNG, POISSON, EXPANSION = 100.0, 0.2, 1e-3
RESIDUAL, TOLERANCE, OVER = 1e-6, 1e-4, 1.6
FORCES = 1e-6
DEPTH, AHEAD = 20.0, 1.33
LAME = YOUNG * POISSON / ((1 + POISSON) * (1 - 2 * POISSON))
SHEAR = YOUNG / (2 * (1 + POISSON))


def solve(matrix, right):
    return pardiso(matrix.tocsr(), right) if pardiso else splu(matrix.tocsc()).solve(right)


def remaining(principal):
    """Stress, tangent and energy that a material without tension stores, from principal strains."""
    order = np.argsort(-principal, axis=0)
    high, middle, low = np.take_along_axis(principal, order, axis=0)
    own = np.zeros((3, 3, *low.shape))
    plane = YOUNG / (1 - POISSON**2)
    closed = low < 0
    one = closed & (middle + POISSON * low >= 0)
    shut = (1 - POISSON) * high + POISSON * (middle + low) < 0
    two = closed & ~one & ~shut
    all_three = closed & ~one & shut
    own[2, 2][one] = YOUNG
    for i, j in ((1, 1), (2, 2)):
        own[i, j][two] = plane
    own[1, 2][two] = own[2, 1][two] = POISSON * plane
    for i in range(3):
        for j in range(3):
            own[i, j][all_three] = LAME + (2 * SHEAR if i == j else 0)
    rank = np.argsort(order, axis=0)
    tangent = np.empty_like(own)
    for i in range(3):
        for j in range(3):
            picked = np.zeros_like(low)
            for a in range(3):
                for b in range(3):
                    mask = (rank[i] == a) & (rank[j] == b)
                    picked[mask] = own[a, b][mask]
            tangent[i, j] = picked
    stress = np.einsum("ij...,j...->i...", tangent, principal)
    return stress, tangent, 0.5 * np.sum(stress * principal, axis=0)


def respond(strain, damage):
    """Stress and tangent in xx, zz, yy, xz with engineering shear, and the energy set free."""
    along, across, third, shear = strain
    mean, half = (along + across) / 2, (along - across) / 2
    radius = np.sqrt(half**2 + shear**2 / 4)
    safe = np.where(radius > 0, radius, 1.0)
    cosine = np.where(radius > 0, half / safe, 1.0)
    sine = np.where(radius > 0, shear / 2 / safe, 0.0)
    principal = np.array([mean + radius, mean - radius, third])
    left, left_tangent, left_energy = remaining(principal)
    intact_tangent = np.full((3, 3, *mean.shape), LAME)
    for i in range(3):
        intact_tangent[i, i] += 2 * SHEAR
    intact = np.einsum("ij...,j...->i...", intact_tangent, principal)
    released = 0.5 * np.sum(intact * principal, axis=0) - left_energy
    factor = (1 - damage) ** 2 + RESIDUAL
    p = factor * (intact - left) + left
    h = factor * (intact_tangent - left_tangent) + left_tangent
    is_round = radius < 1e-9 * (np.abs(mean) + np.abs(third))
    turning = np.where(
        is_round, 0.25 * (h[0, 0] + h[1, 1]) - 0.5 * h[0, 1], (p[0] - p[1]) / (4 * safe)
    )
    centre, spread = (p[0] + p[1]) / 2, (p[0] - p[1]) / 2
    stress = np.array([centre + spread * cosine, centre - spread * cosine, p[2], spread * sine])
    zero, one = np.zeros_like(mean), np.ones_like(mean)
    upper, lower = (1 + cosine) / 2, (1 - cosine) / 2
    axes = np.array(
        [[upper, lower, zero, sine / 2], [lower, upper, zero, -sine / 2], [zero, zero, one, zero]]
    )
    turn = np.array([-sine, sine, zero, cosine])
    tangent = np.einsum("ia...,ij...,jb...->ab...", axes, h, axes)
    tangent += turning * turn[:, None] * turn[None, :]
    return stress, tangent, released


def strain_of(u):
    d = grad(u)
    return np.array([d[0, 0], d[1, 1], 0 * d[0, 0], d[0, 1] + d[1, 0]])


@BilinearForm
def stiffness(u, v, w):
    both = strain_of(u), strain_of(v)
    return np.einsum("a...,ab...,b...->...", both[1], w["tangent"], both[0])


@LinearForm
def forces(v, w):
    return np.sum(w["stress"] * strain_of(v), axis=0)


@BilinearForm
def damage_matrix(d, e, w):
    return 2 * w["released"] * d * e + 2 * w["spread"] * dot(grad(d), grad(e))


@LinearForm
def damage_load(e, w):
    return (2 * w["released"] - 3 / 8) * e


def growing(fine, end, step):
    places = list(np.linspace(0, fine, round(fine / step) + 1))
    step *= 1.15
    while places[-1] + 1.5 * step < end:
        places.append(places[-1] + step)
        step *= 1.15
    return np.array([*places, end])


def shocked(depth):
    """K of an edge crack under a jump of the surface temperature, over σ_s √δ."""

    def part(angle):
        x = np.sin(angle)
        return erfc(x * depth / 2) * (1.3 - 0.3 * x**1.25)

    return 2 * sqrt(depth / np.pi) * quad(part, 0, np.pi / 2)[0]


class Plane:
    def __init__(self, per_length):
        step = 1 / per_length
        end = 12 * DEPTH
        aside = growing(3.0, end, step)
        x = np.concatenate([-aside[::-1] - step / 2, aside + step / 2])
        z = growing(DEPTH + 8, end, step)
        mesh = MeshQuad.init_tensor(x, z)
        self.u = Basis(mesh, ElementVector(ElementQuad1()), intorder=3)
        self.d = Basis(mesh, ElementQuad1(), intorder=3)
        px, pz = mesh.p
        self.depth = pz
        distance = np.where(pz < DEPTH, np.abs(px) - step / 2, np.hypot(px, pz - DEPTH))
        self.damage = np.maximum(1 - np.maximum(distance, 0) / 2, 0) ** 2
        self.moved = np.zeros(self.u.N)
        on = self.u.nodal_dofs
        sides = (px == x[0]) | (px == x[-1])
        held = np.concatenate([on[0, sides], on[1, pz == z[-1]]])
        self.free = np.setdiff1d(np.arange(self.u.N), held)
        corners = mesh.p[:, mesh.t]
        size = np.sqrt(np.prod(corners.max(axis=1) - corners.min(axis=1), axis=0))
        part = 1 - 3 * size / 8
        self.spread = np.broadcast_to(
            (3 / 8 * part**2)[:, None], self.d.interpolate(self.damage).shape
        )

    def cold(self, part):
        """Temperatures when heat has gone a part of the depth at which the crack starts."""
        reach = 0.5 * (DEPTH + AHEAD)
        toughness = sqrt(YOUNG / (1 - POISSON**2))
        drop = toughness / (sqrt(reach) * shocked(2.0)) * (1 - POISSON) / (YOUNG * EXPANSION)
        return -drop * erfc(self.depth / (2 * part * reach))

    def respond(self, damage, rise):
        strain = strain_of(self.u.interpolate(self.moved))
        strain[:3] -= EXPANSION * np.asarray(self.d.interpolate(rise))
        return respond(strain, np.asarray(self.d.interpolate(damage)))

    def settle(self, damage, rise, scale, tolerance):
        for _ in range(40):
            stress, tangent, released = self.respond(damage, rise)
            residual = -forces.assemble(self.u, stress=stress)[self.free]
            if np.linalg.norm(residual) <= tolerance * scale:
                return released
            matrix = stiffness.assemble(self.u, tangent=tangent)[self.free][:, self.free]
            self.moved[self.free] += solve(matrix, residual)
        raise RuntimeError("no equilibrium")

    def bounded(self, released, low, damage):
        matrix = damage_matrix.assemble(self.d, released=released, spread=self.spread).tocsr()
        load = damage_load.assemble(self.d, released=released)
        for _ in range(60):
            gradient = matrix @ damage - load
            held = (damage <= low) & (gradient > 0) | (damage >= 1) & (gradient < 0)
            free = np.flatnonzero(~held)
            step = np.zeros_like(damage)
            step[free] = solve(matrix[free][:, free], -gradient[free])
            new = np.clip(damage + step, low, 1)
            change = np.abs(new - damage).max()
            damage = new
            if change <= 0.1 * TOLERANCE:
                break
        return damage

    def advance(self, rise):
        low, change = self.damage.copy(), 1.0
        still = np.zeros((4, *np.asarray(self.d.interpolate(rise)).shape))
        still[:3] -= EXPANSION * np.asarray(self.d.interpolate(rise))
        stress, _, _ = respond(still, 0 * still[0])
        scale = np.linalg.norm(forces.assemble(self.u, stress=stress))
        for count in range(1, 3000):
            tolerance = FORCES * np.clip(0.1 * change / TOLERANCE, 1, 100)
            released = self.settle(self.damage, rise, scale, tolerance)
            new = self.bounded(released, low, self.damage)
            change = np.abs(new - self.damage).max()
            if change <= TOLERANCE:
                self.damage = new
                return count
            self.damage = np.clip(self.damage + OVER * (new - self.damage), low, 1)
        raise RuntimeError("no minimum")

    def dissipated(self):
        own = self.d.interpolate(self.damage)
        square = dot(own.grad, own.grad)
        return np.sum((3 / 8 * np.asarray(own) + self.spread * square) * self.d.dx)


def main(per_length=3.0, steps=15):
    plane = Plane(per_length)
    print(f"{plane.depth.size} nodes, {'PARDISO' if pardiso else 'SuperLU'}")
    first, begun = None, time.perf_counter()
    for step in range(steps):
        part = 0.9 + 0.02 * step
        count = plane.advance(plane.cold(part))
        dissipated = plane.dissipated()
        first = dissipated if first is None else first
        took = time.perf_counter() - begun
        print(f"{part:.2f} {count} alternations, growth {dissipated - first:.4f}, {took:.1f} s")


if __name__ == "__main__":
    main(*(float(value) for value in sys.argv[1:2]), *(int(value) for value in sys.argv[2:3]))
