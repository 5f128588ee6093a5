"""A drop as a master sees it: alone above a wall, and on a plate in the same unit."""

from math import pi

import numpy as np
import pytest
from impinge import StepDiscarded, UnitError
from master import Unit
from test_fmi3 import Unit as Unit3

STEP = 1e-7
AREAS = pi * 2.5e-5**2 * np.array([1, 3, 5, 7])


def rings(name):
    return [f"wall.{name}[{ring}]" for ring in range(1, 5)]


def test_the_rings_and_what_lies_beyond_them_take_all_that_the_drop_gives(pack):
    given = 0.0
    with Unit(pack("drop")) as unit:
        momentum = unit["drop.momentum_z"]
        for _ in range(20):
            unit.step(STEP)
            flow = unit["wall.heat_flux"] @ AREAS
            given += STEP * (flow + unit["wall.heat_flow_outside"])
            force = unit["wall.pressure"] @ AREAS + unit["wall.force_outside"]
            assert force == pytest.approx(unit["drop.force"], rel=1e-9)
        assert given == pytest.approx(unit["drop.heat"], rel=1e-9)
        assert unit["drop.impulse_z"] == pytest.approx(momentum - unit["drop.momentum_z"], rel=1e-4)


def test_wall_temperatures_are_inputs(pack):
    heats = []
    for temperature in (300.0, 325.0, 350.0):
        with Unit(pack("drop"), dict.fromkeys(rings("temperature"), temperature)) as unit:
            for _ in range(5):
                unit.step(STEP)
            heats.append(unit["drop.heat"])
    assert heats[1] == pytest.approx(heats[0] / 2, rel=1e-3)
    assert abs(heats[2]) < 1e-9 * heats[0]


def test_the_drop_and_its_fluid_are_parameters(pack):
    with Unit(pack("drop"), {"drop.diameter": 8e-5, "drop.density": 800.0}) as unit:
        assert unit["drop.mass"] == pytest.approx(800.0 * pi / 6 * 8e-5**3, rel=1e-9)
    with pytest.raises(UnitError):
        Unit(pack("drop"), {"drop.diameter": 3e-5})


def test_heat_passes_whole_from_drop_to_plate(pack):
    with Unit(pack("impact")) as unit:
        for step in (0.3e-7, 2.7e-7, 1e-7, 6e-7):
            unit.step(step)
        given = unit["drop.heat"]
        assert given > 0
        assert unit["plate.heat_in"] == pytest.approx(given, rel=1e-12)
        assert unit["plate.heat_stored"] == pytest.approx(given, rel=1e-9)
        assert unit["drop.heat_stored"] == pytest.approx(-given, rel=1e-5)
        assert 300.0 < unit["centre.temperature"] < 350.0
        assert unit["centre.stress_xx"] < 0


def test_a_step_without_meaning_is_discarded(pack):
    with Unit(pack("drop")) as unit:
        unit.step(STEP)
        before = unit["drop.heat"]
        with pytest.raises(StepDiscarded):
            unit.step(1e3)
        assert any("drop: " in line and "time steps" in line for line in unit.log), unit.log
        assert unit["drop.heat"] == before


def asked_for(unit):
    """Three drops in two places, one of which has to wait."""
    unit.set({"drop.release": 1, "drop.x": -8e-5, "drop.speed": 30.0})
    unit.step(STEP)
    unit.set({"drop.release": 3, "drop.x": 8e-5, "drop.temperature": 360.0})
    unit.step(STEP)


def test_a_master_releases_drops(pack):
    mass = 1000.0 * pi / 6 * 6e-5**3
    with Unit(pack("demand")) as unit:
        for _ in range(3):
            unit.step(STEP)
        assert unit["drop.mass"] == unit["drop.released"] == unit["drop.steps"] == 0
        asked_for(unit)
        assert (unit["drop.released"], unit["drop.waiting"]) == (2, 1)
        assert unit["drop.mass"] == pytest.approx(2 * mass, rel=1e-9)
        for _ in range(10):
            unit.step(STEP)
        released = unit["drop.released"]
        momentum = unit["drop.momentum_z"] + unit["drop.impulse_z"]
        assert momentum == pytest.approx(-mass * 30.0 * released, rel=1e-4)
        scale = mass * 4180.0 * 60.0
        assert unit["drop.heat_stored"] == pytest.approx(-unit["drop.heat"], abs=1e-6 * scale)
        wanted = {"drop.release": "discrete", "drop.x": "continuous", "drop.speed": "continuous"}
        assert {name: unit.variables[name].variability for name in wanted} == wanted
        unit["drop.release"] = 2
        with pytest.raises(UnitError):
            unit.step(STEP)
        assert any("the count of all drops does not fall" in line for line in unit.log), unit.log


def test_drops_on_demand_are_the_same_in_both_versions(pack, tmp_path):
    with Unit(pack("demand")) as two, Unit3(pack("demand", fmi=3), tmp_path) as three:
        for unit in (two, three):
            asked_for(unit)
            for _ in range(5):
                unit.step(STEP)
        assert three.variables["drop.release"].variability == "discrete"
        names = [name for name in two.outputs if name.startswith("drop.")]
        assert (three.read(names) == np.array(two.read(names))).all()


def test_particles_are_written_beside_the_plate(pack, tmp_path):
    with Unit(pack("impact"), {"output.directory": str(tmp_path)}) as unit:
        unit.step(STEP)
    for name in ("drop.pvd", "drop_000001.vtp", "plate.pvd", "plate_000001.vtr"):
        assert (tmp_path / name).is_file(), name
