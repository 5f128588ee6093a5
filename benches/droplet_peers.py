"""Particle updates a second of droplets beside those of two other codes, in turn on one machine.

`make bench-droplet`, or `python benches/droplet_peers.py [--side 47] [--steps 20] [--runs 3]`.
A cube of side³ particles with a support radius of three distances makes as many steps in every
code; an update is a particle advanced by one time step, neighbour search included.

- impinge: `cargo bench --bench droplet`, single precision for pairs.
- PySPH (doi 10.1145/3460773): its example `cube`, weakly compressible with a cubic spline and
  artificial viscosity, double precision, OpenMP.
- SPlisHSPlasH: its weakly compressible method with a cubic spline and viscosity, single precision,
  AVX and OpenMP. Its support radius is two distances of particles: the block is shrunk by 2/3 and
  the masses by its cube.
"""

import argparse
import json
import os
import re
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
# SPlisHSPlasH's wheel does not load it by itself.
GL_DISPATCH = "/usr/lib/x86_64-linux-gnu/libGLdispatch.so.0"


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--side", type=int, default=47, help="particles along an edge of the cube")
    parser.add_argument("--steps", type=int, default=20)
    parser.add_argument("--runs", type=int, default=3)
    parser.add_argument("--threads", type=int, nargs="+", default=[1, 2])
    parser.add_argument("--splishsplash", type=int, help=argparse.SUPPRESS)
    options = parser.parse_args()
    if options.splishsplash:
        print(json.dumps(splishsplash(options.splishsplash, options.steps)))
        return
    binary = built_bench()
    rates: dict[tuple[str, int], list[float]] = {}
    for _ in range(options.runs):
        for threads in options.threads:
            size = (options.side, threads, options.steps)
            for measured in (ours(binary, *size), pysph(*size), in_process(*size)):
                for what, rate in measured.items():
                    rates.setdefault((what, threads), []).append(rate)
    print_table(rates, options)


def built_bench() -> str:
    command = ["cargo", "bench", "--bench", "droplet", "--no-run", "--message-format=json"]
    output = subprocess.run(command, cwd=ROOT, check=True, capture_output=True, text=True).stdout
    messages = [json.loads(line) for line in output.splitlines()]
    made = [m for m in messages if m.get("executable") and m["target"]["name"] == "droplet"]
    return made[-1]["executable"]


def ours(binary: str, side: int, threads: int, steps: int) -> dict[str, float]:
    output = printed([binary, *map(str, (side, threads, steps, 1))], {})
    lines = re.findall(r"^(.*): ([\d.]+) million", output, re.MULTILINE)
    return {f"impinge: {what}": 1e6 * float(rate) for what, rate in lines}


def pysph(side: int, threads: int, steps: int) -> dict[str, float]:
    with tempfile.TemporaryDirectory() as folder:
        # The example's time step is 1e-4 s.
        arguments = ["--np", str(side**3), "--tf", str(1e-4 * steps), "--openmp"]
        arguments += ["--disable-output", "--directory", folder]
        command = [sys.executable, "-m", "pysph.examples.cube", *arguments]
        output = printed(command, {"OMP_NUM_THREADS": str(threads)})
    particles = int(re.search(r"Number of particles: (\d+)", output)[1])
    seconds = float(re.search(r"Run took: ([\d.]+)", output)[1])
    return {"PySPH: cube": particles * steps / seconds}


def in_process(side: int, threads: int, steps: int) -> dict[str, float]:
    """SPlisHSPlasH in a process of its own, which starts with the library preloaded."""
    command = [sys.executable, __file__, "--splishsplash", str(side), "--steps", str(steps)]
    output = printed(command, {"OMP_NUM_THREADS": str(threads), "LD_PRELOAD": GL_DISPATCH})
    return {"SPlisHSPlasH: WCSPH": json.loads(output.splitlines()[-1])["rate"]}


def printed(command: list[str], environment: dict[str, str]) -> str:
    result = subprocess.run(command, env=os.environ | environment, capture_output=True, text=True)
    if result.returncode != 0:
        raise SystemExit(f"{' '.join(command)} failed:\n{result.stdout}{result.stderr}")
    return result.stdout


def splishsplash(side: int, steps: int) -> dict[str, float]:
    import pysplishsplash as sph

    radius, time_step = 0.01, 1e-5
    edge = 2.0 * radius * (side + 1)  # It leaves one layer out.
    scene = {
        "Configuration": {
            "particleRadius": radius,
            "simulationMethod": int(sph.SimulationMethods.WCSPH),
            "cflMethod": 0,
            "timeStepSize": time_step,
            "gravitation": [0.0, -9.81, 0.0],
        },
        "Materials": [{"id": "Fluid", "viscosityMethod": 1, "viscosity": 0.01}],
        "FluidBlocks": [{"id": "Fluid", "denseMode": 0, "start": [0.0] * 3, "end": [edge] * 3}],
    }
    ticks = []

    def after_step() -> None:
        ticks.append(time.perf_counter())
        if len(ticks) == 1:
            shrink(sph.Simulation.getCurrent().getFluidModel(0), 2.0 / 3.0, 2.0 * radius)

    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "scene.json"
        path.write_text(json.dumps(scene))
        base = sph.Exec.SimulatorBase()
        base.init(
            sceneFile=str(path), outputDir=folder, useGui=False, useCache=False, initialPause=False
        )
        base.initSimulation()
        base.setTimeStepCB(after_step)
        # The first step shrinks the block, the second one does what is done once.
        base.setValueFloat(base.STOP_AT, (steps + 3.5) * time_step)
        base.runSimulation()
    simulation = sph.Simulation.getCurrent()
    count = simulation.getFluidModel(0).numActiveParticles()
    neighbours = sum(simulation.numberOfNeighbors(0, 0, i) for i in range(count)) / count
    seconds = ticks[steps + 1] - ticks[1]
    return {"rate": count * steps / seconds, "particles": count, "neighbours": neighbours}


def shrink(fluid, factor: float, distance: float) -> None:
    mass = fluid.getDensity0() * (factor * distance) ** 3
    for i in range(fluid.numActiveParticles()):
        fluid.setPosition(i, [factor * x for x in fluid.getPosition(i)])
        fluid.setMass(i, mass)


def print_table(rates: dict[tuple[str, int], list[float]], options: argparse.Namespace) -> None:
    print(f"{options.side**3} particles, {options.steps} steps, medians of {options.runs} runs\n")
    print("| million updates a second |", *(f"{t} threads |" for t in options.threads))
    print("|---|" + "---|" * len(options.threads))
    for what in dict.fromkeys(what for what, _ in rates):
        medians = [1e-6 * statistics.median(rates[what, t]) for t in options.threads]
        print(f"| {what} |", *(f"{median:.3f} |" for median in medians))


if __name__ == "__main__":
    main()
