"""Equilibria of a sheared block of rubber, compared with FElupe on the same mesh, in one run.

    cargo build --release --workspace
    python -m venv out/felupe
    out/felupe/bin/pip install felupe==11.3.0 pypardiso==0.4.7 FMPy==0.3.32
    PYTHONPATH=python IMPINGE_BIN=target/release out/felupe/bin/python benches/large_strain_peer.py

A cube of 20 mm is clamped below; its upper face moves sideways by 30 % of its height in five equal
steps. Both programs use the same stored energy, trilinear hexahedra with one mean dilatation each
and a residual of 1e-10 of the forces, on one thread. Every step is taken by each program in turn.
FElupe assembles by NumPy and solves by MKL PARDISO: as its guide recommends (`spsolve`, for general
matrices), and for symmetric matrices, analysed anew only where their pattern changes (`symmetric`).
Printed are the median processor time of a step, iterations, the last reaction force along the
motion, and its error relative to the extrapolation from the meshes of half and quarter the number
of cells.
"""

import argparse
import os
import statistics
import time
from tempfile import TemporaryDirectory

THREADS = ("MKL_NUM_THREADS", "OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS")
os.environ.update(dict.fromkeys(THREADS, "1"))

import felupe  # noqa: E402
import numpy as np  # noqa: E402
import pypardiso  # noqa: E402
from impinge import Unit  # noqa: E402
from scipy import sparse  # noqa: E402

SIZE, YOUNG = 20e-3, 1e6  # m, Pa
SHEAR, STEPS = 0.3, 5
TOLERANCE = 1e-10
SCENE = """
name = "ShearedBlock"
stop_time = {steps}.0
step = 1.0
solver = {{ threads = 1 }}
[body.pad]
kind = "solid"
strain = "finite"
initial_temperature = 293.15
material = {{ model = "neo_hookean", density = 1000.0, specific_heat = 1900.0, conductivity = 0.2, \
young = {young}, poisson = {poisson} }}
shape = {{ box = [{size}, {size}, {size}] }}
symmetry = "none"
mesh = {{ spacing = {spacing} }}
faces = {{ bottom = {{ clamped = true }}, top = {{ displacement = [0.0, 0.0, 0.0] }} }}
"""


class Own:
    """The block as a unit."""

    def __init__(self, folder, cells, poisson):
        file = os.path.join(folder, f"block_{cells}_{poisson}.toml")
        values = {"size": SIZE, "young": YOUNG, "poisson": poisson, "spacing": SIZE / cells}
        with open(file, "w", encoding="utf-8") as scene:
            scene.write(SCENE.format(steps=STEPS, **values))
        self.unit = Unit(file)

    def step(self, displacement):
        """Moves the upper face there; returns the force on it."""
        self.unit.set({"pad.top.displacement_x": displacement})
        self.unit.step(1.0)
        return float(self.unit.get("pad.top.force_x")[0])


class Block(felupe.SolidBodyNearlyIncompressible):
    """FElupe's body of mean dilatation with U = κ (½ (J² − 1) − ln J)/2."""

    def __init__(self, field, bulk, shear):
        self.kappa = bulk
        super().__init__(felupe.NeoHooke(mu=shear), field, bulk=bulk)

    def _extract(self, field, parallel=False):
        state = self.results.state
        self.field = field
        self.results.kinematics = state.F = field.extract(out=self.results.kinematics)
        dilatation = state.volume() / self.V
        state.J[:], state.u[:] = dilatation, field[0].values
        state.p[:] = 0.5 * self.kappa * (dilatation - 1.0 / dilatation)
        self.bulk = 0.5 * self.kappa * (1.0 + dilatation**-2)
        return self.results.kinematics

    def _vector(self, field=None, parallel=False, items=None, args=(), kwargs=None, block=True):
        # p follows J exactly, so no constraint is left over.
        self.results.stress = self._gradient(field, parallel, args, kwargs)
        form = self._form(fun=self.results.stress, v=self.field, dV=self.field.region.dV)
        values = form.integrate(parallel=parallel, out=self.results.force_values)
        self.results.force_values = values
        self.results.force = form.assemble(values=values, block=block)
        return self.results.force


class Symmetric:
    """PARDISO for symmetric positive matrices, which analyses a pattern once while it stays."""

    def __init__(self):
        self.solver, self.pattern = pypardiso.PyPardisoSolver(mtype=2), None

    def __call__(self, matrix, load):
        upper = sparse.triu(matrix, format="csr")
        upper.sort_indices()
        load = np.ascontiguousarray(load.ravel())
        pattern = (upper.indptr, upper.indices)
        is_known = self.pattern is not None and all(map(np.array_equal, pattern, self.pattern))
        self.pattern = pattern
        self.solver.set_phase(22 if is_known else 12)
        self.solver._call_pardiso(upper, load)
        self.solver.set_phase(33)
        return self.solver._call_pardiso(upper, load)


class Peer:
    """The block in FElupe."""

    def __init__(self, cells, poisson, solver):
        bulk, shear = YOUNG / (3 * (1 - 2 * poisson)), YOUNG / (2 * (1 + poisson))
        region = felupe.RegionHexahedron(felupe.Cube(b=(SIZE,) * 3, n=cells + 1))
        self.field = felupe.FieldContainer([felupe.Field(region, dim=3)])
        self.body, self.solver, self.iterations = Block(self.field, bulk, shear), solver, []

    def step(self, displacement):
        """Moves the upper face there; returns the force on it."""
        field = self.field[0]
        bottom = felupe.Boundary(field, fz=0.0)
        top = felupe.Boundary(field, fz=SIZE, skip=(1, 0, 0))
        moved = felupe.Boundary(field, fz=SIZE, skip=(0, 1, 1), value=displacement)
        bounds = {"bottom": bottom, "top": top, "moved": moved}
        of_held, of_free = felupe.dof.partition(self.field, bounds)
        prescribed = felupe.dof.apply(self.field, bounds, of_held)
        found = felupe.newtonraphson(
            items=[self.body],
            x0=self.field,
            dof0=of_held,
            dof1=of_free,
            ext0=prescribed,
            solver=self.solver,
            tol=TOLERANCE,
            verbose=0,
        )
        self.field = found.x
        self.iterations.append(found.iterations)
        forces = np.asarray(found.fun.toarray() if sparse.issparse(found.fun) else found.fun)
        return float(forces.reshape(-1, 3)[moved.points, 0].sum())


def compare(folder, cells, poisson, with_peers):
    """Takes all steps by all programs in turn; returns their times, last forces, iterations."""
    programs = {"impinge": Own(folder, cells, poisson)}
    if with_peers:
        programs["FElupe, spsolve"] = Peer(cells, poisson, pypardiso.spsolve)
        programs["FElupe, symmetric"] = Peer(cells, poisson, Symmetric())
    times, forces = {name: [] for name in programs}, {}
    for n in range(1, STEPS + 1):
        for name, program in programs.items():
            begun = time.process_time()
            forces[name] = program.step(SHEAR * SIZE * n / STEPS)
            times[name].append(time.process_time() - begun)
    programs["impinge"].unit.close()
    counts = {name: getattr(program, "iterations", "") for name, program in programs.items()}
    return times, forces, counts


def limit(coarse, middle, fine):
    """Limit of a sequence whose differences fall by one factor, by which they fell last."""
    first, second = middle - coarse, fine - middle
    return fine + second * second / (first - second)


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--cells", type=int, nargs="+", default=[10, 20])
    parser.add_argument("--poisson", type=float, nargs="+", default=[0.3, 0.49])
    options = parser.parse_args()
    for poisson in options.poisson:
        largest = max(options.cells)
        meshes = {largest // 4, largest // 2, largest, *options.cells}
        results = {}
        for cells in sorted(meshes):
            with TemporaryDirectory() as folder:
                results[cells] = compare(folder, cells, poisson, cells in options.cells)
        of_own = [results[cells][1]["impinge"] for cells in (largest // 4, largest // 2, largest)]
        exact = limit(*of_own)
        print(f"Poisson's ratio {poisson}: force {exact:.5f} N by extrapolation")
        for cells in options.cells:
            times, forces, counts = results[cells]
            own = statistics.median(times["impinge"])
            for name, of_steps in times.items():
                median = statistics.median(of_steps)
                print(
                    f"{cells} cells a side, {name}: {median:.3f} s a step ({median / own:.2f}), "
                    f"force {forces[name]:.9f} N, error {forces[name] / exact - 1:+.2e} "
                    f"{counts[name]}",
                    flush=True,
                )


if __name__ == "__main__":
    main()
