"""Instances: parameters, reset, several at once, refusals and files."""

import math
import xml.etree.ElementTree as ET

import numpy as np
import pytest
from fmpy import simulate_fmu
from impinge import UnitError
from master import Unit, run

STEP = 1e-5
LOADS = {"spot.heat_flux": 1e8, "spot.pressure": 25e6, "spot.shear_x": 1e6, "spot.x": 4e-5}


def trajectory(unit, steps=5):
    rows = []
    for _ in range(steps):
        unit.step(STEP)
        rows.append(unit.all_outputs())
    return np.array(rows)


def test_two_interleaved_instances_are_independent(pack):
    file = pack("plate")
    other = {"spot.heat_flux": -3e7, "spot.pressure": 1e6, "spot.x": -1e-4}
    alone = []
    for inputs in (LOADS, other):
        with Unit(file, inputs) as unit:
            alone.append(trajectory(unit))
    with Unit(file, LOADS) as a, Unit(file, other) as b, Unit(file, LOADS) as c:
        rows = [[], [], []]
        for _ in range(5):
            for unit, into in zip((a, b, c), rows, strict=True):
                unit.step(STEP)
                into.append(unit.all_outputs())
    assert np.array_equal(rows[0], alone[0])
    assert np.array_equal(rows[1], alone[1])
    assert np.array_equal(rows[2], alone[0])


def test_reset_gives_the_same_trajectory_bit_for_bit(pack):
    with Unit(pack("plate"), LOADS) as unit:
        first = trajectory(unit)
        unit.set({"spot.heat_flux": 7e8, "spot.y": 1e-5})
        unit.step(STEP)
        unit.reset()
        assert np.array_equal(trajectory(unit), first)
        unit.reset({"plate.conductivity": 20.0})
        assert not np.array_equal(trajectory(unit), first)
        unit.reset()
        assert np.array_equal(trajectory(unit), first)


PARAMETERS = {
    "density": ("density = 3950.0", 5000.0),
    "specific_heat": ("specific_heat = 900.0", 700.0),
    "conductivity": ("conductivity = 10.0", 20.0),
    "young": ("young = 300e9", 200e9),
    "poisson": ("poisson = 0.21", 0.3),
    "expansion": ("expansion = 8.1e-6", 12e-6),
    "initial_temperature": ("initial_temperature = 293.15", 400.0),
}


def test_parameters_act_as_if_the_scene_said_them(pack):
    """All at once; each that were not taken would leave other bits than the scene that says it."""
    says = pack("plate", {was: f"{name} = {value}" for name, (was, value) in PARAMETERS.items()})
    values = {f"plate.{name}": value for name, (_, value) in PARAMETERS.items()}
    assert run(pack("plate"), LOADS, values) == run(says, LOADS)

    def watched(parameters):
        with Unit(pack("plate"), parameters) as unit:
            unit.set(LOADS)
            unit.step(STEP)
            return unit.get(["centre.temperature", "centre.stress_xx"]).tolist()

    all_set = watched(values)
    for name in values:
        others = {other: value for other, value in values.items() if other != name}
        assert watched(others) != all_set, name


def test_start_values_reach_the_unit_through_fmpy(pack):
    def rise(**start):
        start = {name.replace("__", "."): value for name, value in start.items()}
        return (
            simulate_fmu(
                str(pack("plate")),
                start_values={"spot.heat_flux": 1e8, **start},
                stop_time=2e-4,
                output=["plate.heat_in", "plate.max_temperature"],
            )["plate.max_temperature"][-1]
            - 293.15
        )

    # Twice the capacity at twice the conductivity: half the rise at the same diffusivity.
    both = rise(plate__conductivity=20.0, plate__density=2 * 3950.0)
    assert both == pytest.approx(rise() / 2, rel=1e-9)
    assert rise(plate__conductivity=20.0) < 0.8 * rise()


def test_a_convection_coefficient_is_a_parameter(pack):
    inputs = {f"splat.heat_flux[{i}]": 5e7 for i in range(1, 5)}
    says = pack("rings", {"coefficient = 5e4": "coefficient = 1e5"})
    assert run(pack("rings"), inputs, {"plate.bottom.coefficient": 1e5}) == run(says, inputs)


def test_threads_change_no_bit(pack):
    one, two = (run(pack("plate"), LOADS, {"solver.threads": threads}) for threads in (1, 2))
    assert one == two


def test_fields_are_written_where_asked(pack, tmp_path):
    folder = tmp_path / "new" / "fields"
    with Unit(pack("plate"), {**LOADS, "output.directory": str(folder)}) as unit:
        for _ in range(3):
            unit.step(STEP)
    (collection,) = folder.glob("*.pvd")
    entries = ET.parse(collection).getroot().iter("DataSet")
    times = {float(entry.get("timestep")): entry.get("file") for entry in entries}
    assert list(times) == pytest.approx([0.0, STEP, 2 * STEP, 3 * STEP], abs=1e-18)
    assert all((folder / file).is_file() for file in times.values())


@pytest.mark.parametrize(
    ("name", "value"),
    [
        ("spot.heat_flux", math.nan),
        ("spot.pressure", math.inf),
        ("spot.shear_y", -math.inf),
        ("spot.x", 1.9e-4),
        ("spot.y", math.nan),
        ("spot.radius", -1e-6),
        ("plate.young", 1e11),
        ("centre.temperature", 300.0),
        ("solver.threads", 1),
        ("output.directory", "fields"),
    ],
)
def test_a_wrong_set_is_refused_by_name_and_changes_nothing(pack, name, value):
    with Unit(pack("plate"), LOADS) as unit:
        unit.step(STEP)
        before = unit.all_outputs()
        with pytest.raises(UnitError):
            unit[name] = value
        assert any(name in line for line in unit.log), unit.log
        assert np.array_equal(unit.all_outputs(), before)
        unit.step(STEP)


@pytest.mark.parametrize("size", [0.0, -1e-6, math.nan, math.inf])
def test_a_wrong_step_is_refused(pack, size):
    with Unit(pack("plate"), LOADS) as unit:
        with pytest.raises(UnitError):
            unit.slave.do_step(unit.time, size)  # past `step`, which refuses most of these itself
        assert any("step size" in line for line in unit.log), unit.log
        unit.step(STEP)


def test_a_footprint_that_grows_off_its_face_is_refused(pack):
    with Unit(pack("plate"), LOADS) as unit:
        with pytest.raises(UnitError):
            unit["spot.radius"] = 2e-3
            unit.step(STEP)
        assert any("footprint of spot" in line for line in unit.log), unit.log
