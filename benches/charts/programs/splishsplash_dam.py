"""A column of water that is let go, by SPlisHSPlasH (https://splishsplash.physics-simulation.org).

`splishsplash_dam.py '{"across": 32, "stop": 2.5, "names": {…}}'`: particles over the width, up to
so many √(a/2g). Its incompressible method DFSPH (Bender & Koschier 2015, doi
10.1145/2786784.2786796) in the plane, single precision, walls of particles (Akinci et al. 2012, doi
10.1145/2185520.2185558), no viscosity, one thread.
"""

import json
import os
import sys
import time
from itertools import pairwise
from pathlib import Path
from tempfile import TemporaryDirectory

from telling import peak

GRAVITY, TALL, TANK = 9.81, 2.0, 4.0
GL_DISPATCH = "/usr/lib/x86_64-linux-gnu/libGLdispatch.so.0"
"""Its wheel does not load it by itself."""


def scene(across: int, models: Path) -> dict:
    """A column of 1 m by 2 m in a tank of 4 m: walls lie a radius behind where the fluid ends."""
    radius = 0.5 / across
    edge = TANK + 2.0 * radius
    return {
        "Configuration": {
            "particleRadius": radius,
            "sim2D": True,
            "simulationMethod": 4,
            "gravitation": [0.0, -GRAVITY, 0.0],
            "cflMethod": 1,
            "cflFactor": 0.4,
            "cflMaxTimeStepSize": 0.005,
            "timeStepSize": 1e-4,
            "boundaryHandlingMethod": 0,
        },
        "Materials": [{"id": "Fluid", "density0": 1000.0, "viscosityMethod": 0}],
        "RigidBodies": [
            {
                "geometryFile": str(models / "UnitBox.obj"),
                "translation": [TANK / 2.0, TANK / 2.0, 0.0],
                "scale": [edge, edge, 1.0],
                "isDynamic": False,
                "isWall": True,
            }
        ],
        # The first layer of a block is left out.
        "FluidBlocks": [
            {
                "id": "Fluid",
                "denseMode": 0,
                "start": [0.0, 0.0, -1.0],
                "end": [1.0 + 2.0 * radius, TALL + 2.0 * radius, 1.0],
                "translation": [-radius, -radius, 0.0],
            }
        ],
    }


class Column:
    """Front and middle of the fluid along x at the last ends of steps, as (time, front, middle)."""

    def __init__(self, sph, stop: float):
        self.model = sph.Simulation.getCurrent().getFluidModel(0)
        self.clock, self.stop = sph.TimeManager.getCurrent(), stop
        self.rows = [self.places()]

    def places(self) -> tuple[float, float, float]:
        count = self.model.numActiveParticles()
        along = [float(self.model.getPosition(i)[0]) for i in range(count)]
        return self.clock.getTime(), max(along), sum(along) / count

    def after_step(self) -> None:
        if self.clock.getTime() > self.stop - 0.01:
            self.rows.append(self.places())

    def gone(self) -> list[float]:
        """How far front and middle have gone at the stop, linear between ends of steps."""
        (begin, *earlier), (end, *later) = next(
            pair for pair in pairwise(self.rows) if pair[1][0] >= self.stop
        )
        share = (self.stop - begin) / (end - begin)
        now = [a + share * (b - a) for a, b in zip(earlier, later, strict=True)]
        return [a - b for a, b in zip(now, self.rows[0][1:], strict=True)]


def run(asked: dict, folder: str) -> dict:
    import pysplishsplash as sph

    before, begin = peak(), time.perf_counter()
    across, stop = asked["across"], asked["stop"] / (2.0 * GRAVITY) ** 0.5
    file = Path(folder) / "scene.json"
    file.write_text(json.dumps(scene(across, Path(sys.prefix) / "bin/data/models")))
    base = sph.Exec.SimulatorBase()
    base.init(
        sceneFile=str(file), outputDir=folder, useGui=False, useCache=False, initialPause=False
    )
    base.initSimulation()
    column = Column(sph, stop)
    base.setTimeStepCB(column.after_step)
    base.setValueFloat(base.STOP_AT, stop)
    started = time.perf_counter()
    base.runSimulation()
    ended = time.perf_counter()
    count = column.model.numActiveParticles()
    if count != TALL * across**2:
        raise SystemExit(f"{count} particles, not {TALL * across**2:g}")
    front, middle = column.gone()
    names = asked["names"]
    return {
        "values": {names["front"]: 1.0 + front, names["middle"]: 0.5 + middle},
        "start": started - begin,
        "steps": ended - started,
        "memory": peak() - before,
    }


def main() -> None:
    if os.environ.get("LD_PRELOAD") != GL_DISPATCH:
        told = os.environ | {"LD_PRELOAD": GL_DISPATCH}
        os.execve(sys.executable, [sys.executable, *sys.argv], told)
    with TemporaryDirectory() as folder:
        told = run(json.loads(sys.argv[1]), folder)
    print(json.dumps(told))


if __name__ == "__main__":
    main()
