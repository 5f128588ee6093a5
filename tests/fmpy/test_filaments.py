"""Examples of filaments in FMPy: some steps under inputs that move, beside balances and states."""

from contextlib import contextmanager
from math import pi, sqrt
from shutil import rmtree

import numpy as np
import pytest
from conftest import COARSE, GRIDS, ROOT
from fmpy import extract, instantiate_fmu, read_model_description, simulate_fmu


class Slave:
    """A unit under FMPy's own functions, by names."""

    def __init__(self, file):
        self.folder = extract(str(file))
        description = read_model_description(self.folder)
        self.reference = {v.name: v.valueReference for v in description.modelVariables}
        self.slave = instantiate_fmu(self.folder, description, "CoSimulation")
        self.slave.setupExperiment(startTime=0.0)
        self.slave.enterInitializationMode()
        self.slave.exitInitializationMode()
        self.time = 0.0

    def step(self, step, values, rates=None):
        """A step with values at its beginning and first derivatives over it."""
        self.slave.setReal([self.reference[name] for name in values], list(values.values()))
        rates = rates or {}
        references = [self.reference[name] for name in rates]
        self.slave.setRealInputDerivatives(references, [1] * len(rates), list(rates.values()))
        self.slave.doStep(self.time, step)
        self.time += step

    def __getitem__(self, name):
        return self.slave.getReal([self.reference[name]])[0]

    def outputs(self, names):
        return self.slave.getReal([self.reference[name] for name in names])

    def close(self):
        self.slave.terminate()
        self.slave.freeInstance()
        rmtree(self.folder)


@contextmanager
def run(file):
    slave = Slave(file)
    try:
        yield slave
    finally:
        slave.close()


@pytest.fixture
def example(pack):
    """Makes the unit of an example, with a field of few points."""
    return lambda name: pack(ROOT / f"examples/{name}/scene.toml", GRIDS.get(name))


SPEED, FLOW, STEP = 20e-3, 9e-9, 0.05  # m/s, m³/s, s
STRAND = [
    "volume",
    "length",
    "width",
    "height",
    "touchdown_x",
    "deviation",
    "heat",
    "solid_fraction",
]
STRAND = [f"ink.{key}" for key in STRAND]


def lay_wax(slave, first, last):
    """Moves along the first leg of the drawing, the flow rising all the way."""
    for n in range(first, last):
        place = {"ink.nozzle_x": -14e-3 + SPEED * STEP * n, "ink.nozzle_y": -8e-3}
        values = {**place, "ink.nozzle_z": 0.7e-3, "ink.flow": FLOW * (1 + 0.1 * n)}
        slave.step(STEP, values, {"ink.nozzle_x": SPEED, "ink.flow": 0.1 * FLOW / STEP})


def test_wax_is_laid_where_the_nozzle_moves(example):
    with run(example("wax_line")) as slave:
        lay_wax(slave, 0, 6)
        state = slave.slave.getFMUState()
        lay_wax(slave, 6, 12)
        found = slave.outputs(STRAND)
        # The flow rises evenly, so that the volume is that of a parabola.
        volume = FLOW * STEP * (12 + 0.1 * 72)
        assert slave["ink.volume"] == pytest.approx(volume, rel=1e-12)
        way = SPEED * slave.time
        assert slave["ink.touchdown_x"] == pytest.approx(-14e-3 + way, abs=0.2e-3)
        assert slave["ink.length"] == pytest.approx(way, rel=0.05)
        assert slave["ink.deviation"] < 1e-9
        # Sections do not count the fluid between the last segment and the nozzle.
        section = slave["ink.width"] * slave["ink.height"] * slave["ink.length"]
        assert section == pytest.approx(volume, rel=0.1)
        assert slave["plate.heat_in"] == pytest.approx(slave["ink.heat"], rel=1e-9)
        assert slave["ink.heat"] > 0.0 and abs(slave["ink.heat_drift"]) < 1e-9
        assert 0.0 < slave["ink.solid_fraction"] < 1.0
        # Back to the state in the middle, by way of its bytes, and forth again.
        stored = slave.slave.serializeFMUState(state)
        slave.slave.freeFMUState(state)
        state = slave.slave.deserializeFMUState(stored)
        slave.slave.setFMUState(state)
        slave.time = 6 * STEP
        lay_wax(slave, 6, 12)
        assert slave.outputs(STRAND) == found
        slave.slave.freeFMUState(state)


def test_fmpy_moves_the_nozzle_by_its_signals(example):
    """`simulate_fmu` sends values without derivatives: the nozzle is a step late, with the whole
    volume."""
    times = np.arange(0.0, 0.5001, 0.05)
    rows = [(t, -14e-3 + SPEED * t, -8e-3, 0.7e-3, FLOW) for t in times]
    names = ["time", "ink.nozzle_x", "ink.nozzle_y", "ink.nozzle_z", "ink.flow"]
    signals = np.array(rows, [(name, float) for name in names])
    result = simulate_fmu(
        str(example("wax_line")),
        stop_time=0.5,
        output_interval=0.05,
        input=signals,
        output=["ink.volume", "ink.touchdown_x", "ink.lag"],
    )
    assert result["ink.volume"][-1] == pytest.approx(0.5 * FLOW, rel=1e-9)
    laid = result["ink.touchdown_x"][2:]
    assert np.diff(laid) == pytest.approx(0.05 * SPEED, rel=1e-3)
    assert laid[-1] + result["ink.lag"][-1] == pytest.approx(-14e-3 + SPEED * 0.45, abs=1e-9)


def test_layers_follow_their_code_over_a_bed_that_is_heated(example):
    with run(example("wax_layers")) as slave:
        volumes = []
        for n in range(12):
            bed = 293.15 + 2.0 * n
            slave.step(0.1, {"plate.bottom.ambient": bed}, {"plate.bottom.ambient": 20.0})
            volumes.append(slave["ink.volume"])
        # Moves of 12 mm at 15 mm/s with 2.2451 mm of filament: the last parts at full speed.
        full = 2.2451e-3 * 0.25 * pi * 1.75e-3**2 * 15e-3 / 12e-3 * 0.1
        assert np.diff(volumes)[5:7] == pytest.approx(full, rel=1e-6)
        assert slave["plate.heat_in"] == pytest.approx(slave["ink.heat"], rel=1e-9)
        # Heat of the bed counts as a loss below zero.
        stored, lost = slave["plate.heat_stored"], slave["plate.heat_lost"]
        assert slave["plate.heat_in"] == pytest.approx(stored + lost, rel=1e-6) and lost < -1.0
        # 24 K above the start in the end, behind the lag of 1.5 mm of glass on 2000 W/(m² K)
        assert 294.0 < slave["sensor.temperature"] < 296.0


def test_layers_of_concrete_load_the_lowest_one(example):
    """The bearing ratio is ρgH/(√3 τ_y), with the height H of all layers above the lowest base."""
    with run(example("concrete_layers")) as slave:
        volumes, ratios = [], []
        for n in range(24):
            slave.step(0.5, {"wall.nozzle_temperature": 293.15 + 0.5 * n})
            volumes.append(slave["wall.volume"])
            ratios.append(slave["wall.bearing_ratio"])
        # A layer lasts 5 s, and a second passes between two.
        assert volumes[9] == pytest.approx(5 * 4.8e-5, rel=1e-9) and volumes[11] == volumes[9]
        assert volumes[21] == pytest.approx(10 * 4.8e-5, rel=1e-9)
        one = 2200.0 * 9.81 * 12e-3 / (sqrt(3) * 600.0)
        assert ratios[9] == pytest.approx(one, rel=0.1)
        assert ratios[23] == pytest.approx(2 * one, rel=0.1)


def test_particles_and_line_follow_a_flow_that_falls(pack):
    coarse = pack(ROOT / "examples/paste_bead/scene.toml", COARSE["paste_bead"])
    with run(coarse) as slave:
        for n in range(6):
            flow = 1.57e-8 * (1 - 0.1 * n)
            rate = -0.1 * 1.57e-8 / 0.02
            values = {"bead.flow": flow, "line.flow": flow}
            slave.step(0.02, values, {"bead.flow": rate, "line.flow": rate})
        volume = 1.57e-8 * 0.02 * (6 - 0.1 * 18)
        assert slave["line.volume"] == pytest.approx(volume, rel=1e-12)
        assert slave["bead.volume"] == pytest.approx(volume, rel=1e-9)
        # Free particles have the volume to half of the newest layer.
        layer = 0.25 * pi * 1e-3**2 * 0.25e-3
        assert abs(slave["bead.volume_drift"]) < 0.51 * layer
        assert (
            0.96 * 1400.0 < slave["bead.min_density"] <= slave["bead.max_density"] < 1.04 * 1400.0
        )
        assert 0.0 < slave["bead.lag"] < 1e-3 and slave["line.lag"] < 1e-3
