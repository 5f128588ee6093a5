"""What the Python package adds to a unit: calls by names beside those of bare FMPy.

The unit is small (`tests/fmpy/scenes/plate.toml`), so that calls are a large part of a step.
"""

import statistics
import time
from pathlib import Path

from fmpy import extract, read_model_description, simulate_fmu
from fmpy.fmi2 import FMU2Slave
from impinge import Master, Unit
from impinge.unit import build

ROOT = Path(__file__).resolve().parents[1]
SCENE = ROOT / "tests/fmpy/scenes/plate.toml"
INPUTS = {"spot.heat_flux": 1e7, "spot.x": 1e-5, "spot.y": 0.0}
OUTPUTS = ["centre.temperature", "plate.heat_in", "plate.heat_stored"]
STEP, ROUNDS, REPEATS = 1e-5, 7, 300


def best(call, repeats=REPEATS):
    """The median over rounds of the time [µs] of a call."""
    call()
    rounds = []
    for _ in range(ROUNDS):
        begin = time.perf_counter()
        for _ in range(repeats):
            call()
        rounds.append((time.perf_counter() - begin) / repeats)
    return 1e6 * statistics.median(rounds)


class Bare:
    """The same unit by FMPy, as its documentation drives units."""

    def __init__(self, folder, description):
        self.slave = FMU2Slave(
            guid=description.guid,
            unzipDirectory=folder,
            modelIdentifier=description.coSimulation.modelIdentifier,
            instanceName="bare",
        )
        references = {v.name: v.valueReference for v in description.modelVariables}
        self.inputs = [references[name] for name in INPUTS]
        self.outputs = [references[name] for name in OUTPUTS]
        self.slave.instantiate()
        self.initialise()
        self.kept = self.slave.getFMUstate()  # which keeps the model for instances that are reset

    def initialise(self):
        self.slave.setupExperiment()
        self.slave.enterInitializationMode()
        self.slave.exitInitializationMode()
        self.time = 0.0

    def reset(self):
        self.slave.reset()
        self.initialise()

    def step(self):
        self.slave.doStep(self.time, STEP)
        self.time += STEP

    def write(self):
        self.slave.setReal(self.inputs, list(INPUTS.values()))

    def read(self):
        return self.slave.getReal(self.outputs)

    def back(self):
        state = self.slave.getFMUstate()
        self.slave.setFMUstate(state)
        self.slave.freeFMUstate(state)


def main():
    file = build(SCENE)
    folder = extract(str(file))
    bare, unit = Bare(folder, read_model_description(file)), Unit(file)
    writer, reader, state = unit.writer(INPUTS), unit.reader(OUTPUTS), unit.state()
    writer.values[:] = list(INPUTS.values())

    def back():
        unit.state(into=state)
        unit.restore(state)

    rows = [
        ("step", bare.step, lambda: unit.step(STEP), None),
        ("set 3 inputs", bare.write, lambda: unit.set(INPUTS), writer),
        ("read 3 outputs", bare.read, lambda: unit.get(OUTPUTS), reader),
        ("save a state and go back", bare.back, back, None),
        ("reset and initialise", bare.reset, unit.reset, None),
    ]
    print(f"{'µs':26s}{'FMPy':>10s}{'Unit':>10s}{'arrays':>10s}")
    for name, theirs, ours, arrays in rows:
        times = [best(call) if call else None for call in (theirs, ours, arrays)]
        print(f"{name:26s}" + "".join(f"{t:10.1f}" if t else f"{'':10s}" for t in times))
    begin = time.perf_counter()
    for _ in range(5):
        simulate_fmu(str(file), stop_time=10 * STEP, output_interval=STEP, output=OUTPUTS)
    whole = (time.perf_counter() - begin) / 5

    def run():
        with Unit(file) as another:
            for _ in range(10):
                another.step(STEP)
                another.get(OUTPUTS)

    print(f"ten steps from the file: simulate_fmu {1e3 * whole:.0f} ms,", end=" ")
    print(f"Unit {best(run, 20) / 1e3:.1f} ms")
    with Master({"unit": unit}, step=STEP, outputs=[f"unit.{name}" for name in OUTPUTS]) as master:
        master.run(unit.time + STEP)
        begin, first = time.perf_counter(), master.steps
        master.run(unit.time + 1000 * STEP)
        spent = (time.perf_counter() - begin) / (master.steps - first)
    alone = best(lambda: (unit.step(STEP), reader()))
    print(f"a step in a Master {1e6 * spent:.0f} µs, of these {alone:.0f} µs the unit's own")
    unit.close()


if __name__ == "__main__":
    main()
