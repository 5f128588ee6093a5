"""A box that a spot heats into yield, in impinge, CalculiX and scikit-fem on the same nodes.

CalculiX (`ccx`, Debian's package calculix-ccx) takes the temperatures of impinge at the ends of the
same increments. Its elements are C3D20R: 20 of the 27 nodes, eight points in each, at which its
stress and plastic strain are compared with those of scikit-fem's points, taken there in each
element by the best linear polynomials. Elements of different kinds agree about fields sooner than
about the highest value of any point: fields are asserted, those values are told.
Exit code 1 if they differ; without ccx nothing is compared, and it says so.
"""

import shutil
import subprocess
import sys
from dataclasses import replace
from math import sqrt
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
from plasticity import CASES, COLD, STEEL, run_impinge
from yield_peer import Body, products, von_mises

LIMIT = 1.0  # percent
HARDENING = 6e9
MESH = "spacing = 6e-4, depth_spacing = 2e-4, growth = 1.2, order = 2"

# Corners, then edges, as C3D20 has them, in thirds of an element's nodes along x, y, z.
CORNERS = [(0, 0, 0), (2, 0, 0), (2, 2, 0), (0, 2, 0), (0, 0, 2), (2, 0, 2), (2, 2, 2), (0, 2, 2)]
EDGES = [(0, 1), (1, 2), (2, 3), (3, 0), (4, 5), (5, 6), (6, 7), (7, 4)]
EDGES += [(0, 4), (1, 5), (2, 6), (3, 7)]
MIDDLES = [tuple((np.add(CORNERS[a], CORNERS[b]) // 2).tolist()) for a, b in EDGES]


def study():
    """The box between rollers, each increment a part of the course, with isotropic hardening."""
    box = next(case for case in CASES if "box" in case.shape)
    metal = replace(STEEL, isotropic_hardening=HARDENING, kinematic_hardening=0.0)
    course = ((1.0, 0.02, 1),) * 5 + ((0.0, 0.08, 1),) * 5
    return replace(box, metal=metal, course=course, mesh=MESH)


def elements(axes):
    """Numbers of the 20 nodes of each element on the grid, x fastest."""
    counts = [len(axis) for axis in axes]
    first = np.array(
        [
            (i, j, k)
            for k in range(0, counts[2] - 1, 2)
            for j in range(0, counts[1] - 1, 2)
            for i in range(0, counts[0] - 1, 2)
        ]
    )
    stride = np.array([1, counts[0], counts[0] * counts[1]])
    return first @ stride[:, None] + (np.array(CORNERS + MIDDLES) @ stride)


def lines(rows):
    return "\n".join(", ".join(str(value) for value in row) for row in rows) + "\n"


def deck(case, axes, moments):
    """The input file."""
    z, y, x = np.meshgrid(*reversed([np.asarray(axis) for axis in axes]), indexing="ij")
    places = np.column_stack([x.ravel(), y.ravel(), z.ravel()])
    own = elements(axes)
    used = np.unique(own)
    metal = case.metal
    temperatures, moduli = metal.young
    text = "*NODE, NSET=ALL\n" + lines([[n + 1, *map(repr, places[n].tolist())] for n in used])
    text += "*ELEMENT, TYPE=C3D20R, ELSET=BODY\n"
    for number, nodes in enumerate(own + 1):
        text += lines([[number + 1, *nodes[:10]]]).rstrip("\n") + ",\n" + lines([nodes[10:]])
    text += "*BOUNDARY\n"
    for n in used:
        held = [c + 1 for c in range(3) if case.held(places, c)[n]]
        text += lines([[n + 1, c, c] for c in held]) if held else ""
    text += "*MATERIAL, NAME=METAL\n*ELASTIC\n"
    text += lines([[e, metal.poisson, t] for t, e in zip(temperatures, moduli, strict=True)])
    text += f"*EXPANSION, ZERO={COLD}\n{metal.expansion}\n*PLASTIC\n"
    for t, strength in zip(*metal.yield_stress, strict=True):
        text += lines([[strength, 0.0, t], [strength + HARDENING, 1.0, t]])
    text += "*SOLID SECTION, ELSET=BODY, MATERIAL=METAL\n"
    text += f"*INITIAL CONDITIONS, TYPE=TEMPERATURE\nALL, {COLD}\n"
    for number, moment in enumerate(moments):
        text += "*STEP, INC=100\n*STATIC, DIRECT\n1.0, 1.0\n"
        text += "*CONTROLS, PARAMETERS=FIELD\n1e-7, 1e-5, , , 1e-7\n*TEMPERATURE\n"
        text += lines([[n + 1, repr(float(moment.temperature[n]))] for n in used])
        if number + 1 in (5, len(moments)):
            text += "*NODE PRINT, NSET=ALL\nU\n*EL PRINT, ELSET=BODY\nS, PEEQ\n"
        text += "*END STEP\n"
    return text, used


def tables(path):
    """Those of a .dat file, each as an array without the numbers in front."""
    found, rows = [], []
    for line in path.read_text().splitlines():
        values = line.split()
        if values and not any(c.isalpha() and c not in "Ee" for c in line):
            rows.append([float(value) for value in values])
        elif values and rows:
            found, rows = [*found, np.array(rows)], []
    return [*found, np.array(rows)]


def run_calculix(case, axes, moments):
    """Displacements, stresses and plastic strains at the end of heating and of cooling."""
    with TemporaryDirectory() as folder:
        folder = Path(folder)
        text, used = deck(case, axes, moments)
        (folder / "box.inp").write_text(text)
        ran = subprocess.run(
            ["ccx", "-i", "box"], cwd=folder, capture_output=True, text=True, check=False
        )
        if ran.returncode or not (folder / "box.dat").exists() or "*ERROR" in ran.stdout:
            raise RuntimeError(ran.stdout[-2000:])
        parts = tables(folder / "box.dat")
    # What is asked for once is printed in all later steps, too.
    return used, [parts[:3], parts[-3:]]


def at_points(body, values):
    """The peer's values at eight points of each element, sorted by element of the grid."""
    corners = body.places[body.element_nodes]
    centre, size = corners.mean(axis=1), np.ptp(corners, axis=1)
    half = sqrt(1 / 12)
    accurate = np.array(
        [(x, y, z) for z in (-half, half) for y in (-half, half) for x in (-half, half)]
    )
    terms = products((body.coordinates[0] - centre[0]) / size[0], 1)
    through = products(accurate, 1) @ np.linalg.pinv(terms)
    found = np.einsum("pq,eq...->ep...", through, values)
    return found[np.lexsort(np.round(centre, 12).T)]


def compare(case):
    """Differences in percent by name, of the hot and of the cold box."""
    axes, moments = run_impinge(case)
    used, theirs = run_calculix(case, axes, moments)
    body = Body(tuple(axes), case.metal, COLD, case.held)
    found = []
    for number, moment in enumerate(moments):
        body.advance(moment.temperature)
        if number + 1 not in (5, len(moments)):
            continue
        displacement, stress, strain = theirs[len(found)]
        # xx, yy, zz, xy, xz, yz to shears times √2.
        stress = stress[:, 2:][:, [0, 1, 2, 3, 5, 4]] * ([1.0] * 3 + [sqrt(2)] * 3)
        stress = stress.reshape(-1, 8, 6)
        own = at_points(body, body.stress)
        plastic = at_points(body, body.points.accumulated)
        strain = strain[:, 2].reshape(plastic.shape)
        largest = von_mises(own).max()
        u = moment.displacement[used]
        found.append(
            {
                "displacements, impinge": np.abs(u - displacement[:, 1:]).max() / np.abs(u).max(),
                "stresses (root mean square)": sqrt(((own - stress) ** 2).sum(axis=-1).mean())
                / largest,
                "plastic strains (root mean square)": sqrt(((plastic - strain) ** 2).mean())
                / plastic.max(),
                "highest von Mises stress": von_mises(stress).max() / largest - 1,
                "largest plastic strain": strain.max() / plastic.max() - 1,
            }
        )
    return axes, [{name: 100 * value for name, value in part.items()} for part in found]


def main():
    if shutil.which("ccx") is None:
        print("CalculiX is not installed (ccx, Debian's calculix-ccx): nothing compared with it")
        return False
    axes, (hot, cold) = compare(study())
    nodes = " × ".join(str(len(axis)) for axis in axes)
    print(f"\nCalculiX, C3D20R on {nodes} nodes, differences in percent")
    print(f"{'':34}{'hot':>12}{'cold':>12}")
    for name in hot:
        print(f"{name:34}{hot[name]:12.3f}{cold[name]:12.3f}")
    fields = [name for name in hot if "est " not in name]
    worst = max(part[name] for part in (hot, cold) for name in fields)
    print(
        f"fields: at most {worst:.3f} % apart: {'ok' if worst < LIMIT else f'more than {LIMIT} %'}"
    )
    return not worst < LIMIT


if __name__ == "__main__":
    sys.exit(main())
