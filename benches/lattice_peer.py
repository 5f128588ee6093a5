"""Speed of lattices that move beside a Numba program of the same lattice, on one core, in one run.

    cargo bench --bench lattice --no-run; python benches/lattice_peer.py BINARY [COLUMNS ROWS]

The peer is written as peridynamics programs in Numba are: a list of bonds, forces scattered to
particles in a loop over bonds, then a loop over particles; micropolar links with small rotations,
softening and breaking, without the sums of energies. BINARY is the compiled bench. Both print links
times time steps per second of processor time.
"""

import json
import math
import subprocess
import sys
import time

import numba
import numpy as np

YOUNG, POISSON, DENSITY, SPACING, THICKNESS = 30e9, 0.2, 2300.0, 1e-3, 0.1
ONSET, KNEE, END, SHARE, BENDING = 1.5e-4, 61.0, 1314.0, 0.13, 0.1
LINK_STEPS = 4e7


def lattice(columns, rows):
    """Places of hexagons, column by column, and pairs of neighbours."""
    j, k = np.divmod(np.arange(columns * rows), rows)
    places = SPACING * np.stack([j * math.sqrt(0.75), k + np.where(j % 2, 0.75, 0.25)], axis=1)
    pairs = []
    for i, (column, row) in enumerate(zip(j, k, strict=True)):
        lower = row - 1 if column % 2 == 0 else row
        for other, at in ((column, row + 1), (column + 1, lower), (column + 1, lower + 1)):
            if other < columns and 0 <= at < rows:
                pairs.append((i, other * rows + at))
    return places, np.array(pairs, dtype=np.int64)


@numba.njit(cache=False)
def advance(places, pairs, u, v, damage, constants, inverse, dt, steps):
    """Takes explicit steps of all particles."""
    axial, flexural, length = constants
    force = np.zeros_like(u)
    for _ in range(steps):
        force[:] = 0.0
        for link in range(pairs.shape[0]):
            a, b = pairs[link, 0], pairs[link, 1]
            c = (places[b, 0] - places[a, 0]) / length
            s = (places[b, 1] - places[a, 1]) / length
            x, z = u[b, 0] - u[a, 0], u[b, 1] - u[a, 1]
            stretched = c * x + s * z
            turned = (c * z - s * x) / length
            first, second = u[a, 2] - turned, u[b, 2] - turned
            bent = max(abs(2 * first + second), abs(first + 2 * second))
            ratio = (stretched / length + 2 * BENDING * bent) / ONSET
            if ratio > 1.0 and damage[link] < 1.0:
                if ratio <= KNEE:
                    new = (KNEE - SHARE) / (KNEE - 1.0) * (1.0 - 1.0 / ratio)
                elif ratio < END:
                    new = 1.0 - SHARE / (END - KNEE) * (END / ratio - 1.0)
                else:
                    new = 1.0
                damage[link] = max(damage[link], new)
            left = 1.0 - damage[link]
            normal = (1.0 if stretched < 0.0 else left) * axial * stretched
            own = left * flexural * (2 * first + second)
            other = left * flexural * (first + 2 * second)
            shear = (own + other) / length
            fx, fz = normal * c + shear * s, normal * s - shear * c
            force[a, 0] += fx
            force[a, 1] += fz
            force[b, 0] -= fx
            force[b, 1] -= fz
            force[a, 2] -= own
            force[b, 2] -= other
        for i in range(u.shape[0]):
            for k in range(3):
                v[i, k] += dt * force[i, k] * inverse[1 if k == 2 else 0]
                u[i, k] += dt * v[i, k]


def peer(columns, rows):
    """Link-steps per second of the peer."""
    places, pairs = lattice(columns, rows)
    facet = SPACING / math.sqrt(3.0)
    area = YOUNG * THICKNESS * facet
    axial = area / (1.0 - POISSON) / SPACING
    inertia = area * SPACING**2 * (1.0 - 3.0 * POISSON) / (12.0 * (1.0 - POISSON**2))
    constants = (axial, 2.0 * inertia / SPACING, SPACING)
    mass = DENSITY * THICKNESS * math.sqrt(0.75) * SPACING**2
    inverse = np.array([1.0 / mass, 1.0 / (mass * 5.0 / 36.0 * SPACING**2)])
    dt = 0.8 * 2.0 / math.sqrt(6.0) * SPACING / math.sqrt(YOUNG / DENSITY)
    u, v = np.zeros((len(places), 3)), np.zeros((len(places), 3))
    v[:, 0] = 0.1 * places[:, 0] / places[:, 0].max()
    damage = np.zeros(len(pairs))
    state = (places, pairs, u, v, damage, constants, inverse, dt)
    advance(*state, 1)
    steps = max(1, round(LINK_STEPS / len(pairs)))
    start = time.process_time()
    advance(*state, steps)
    return len(pairs) * steps / (time.process_time() - start)


def main():
    binary, *sizes = sys.argv[1:]
    columns, rows = (int(size) for size in sizes) if sizes else (200, 100)
    own = subprocess.run(
        [binary, str(columns), str(rows)], check=True, capture_output=True, text=True
    )
    speed = json.loads(own.stdout.strip().splitlines()[-1])["link_steps_per_second"]
    other = peer(columns, rows)
    print(json.dumps({"own": speed, "peer": other, "ratio": speed / other}))


if __name__ == "__main__":
    main()
