"""Points in the middle of drops and spots, and the means that notes name in their place."""

import re
import warnings

import pytest
from impinge import Study, StudyWarning, Unit, step_sensitivity
from impinge.unit import open_package
from slab import SCENE

DROP = """
[body.drop]
kind = "droplet"
method = "film"
diameter = "1 mm"
impact_velocity = 5.0
initial_temperature = 350.0
fluid = { density = 1000.0, viscosity = 1e-3, specific_heat = 4000.0, conductivity = 0.6 }
arrivals = [{ x = 0.5e-3 }]
[[coupling]]
from = "drop"
to = "plate.top"
[[probe]]
name = "under"
in = "plate"
at = ["0.5 mm", 0.0, 0.0]
gives = ["temperature"]
"""
SPOT = """
[[load]]
name = "spot"
on = "plate.bottom"
footprint = { gaussian = { radius = "0.5 mm" } }
carries = ["heat_flux"]
start = { y = 0.0 }
[[probe]]
name = "below"
in = "plate"
at = [0.0, 0.0, "-1 mm"]
gives = ["temperature"]
"""


def with_parts(folder, *parts):
    """The path of a slab with further tables."""
    path = folder / "scene.toml"
    path.write_text(SCENE.replace("top = { flux = 0.0 }", "") + "".join(parts))
    return path


def notes_of(path, output, parameters=None):
    with warnings.catch_warnings(record=True) as told:
        warnings.simplefilter("always")
        study = Study(path, parameters or {}, outputs=[output], stop=0.01, step=0.01)
    return study.notes, [each.message for each in told]


def named_table(note):
    """The table that a note names, as text of a scene."""
    return "\n[[field]]\n" + re.sub(r", (?=on|footprint|at|gives)", "\n", note.split("scene: ")[1])


def test_the_mean_that_a_warning_of_a_drop_names_is_that_of_the_scene(tmp_path):
    path = with_parts(tmp_path, DROP)
    (note,), (warned,) = notes_of(path, "under.temperature")
    assert isinstance(warned, StudyWarning) and str(warned) == note
    path = with_parts(tmp_path, DROP, named_table(note))
    assert open_package(path).variable("under_mean.temperature").unit == "K"
    (note,), _ = notes_of(path, "under.temperature")
    assert note.endswith(": consider under_mean.temperature")
    assert notes_of(path, "under_mean.temperature") == ([], [])


def test_spots_are_noted_without_a_warning_and_those_that_move_are_not(tmp_path):
    path = with_parts(tmp_path, SPOT)
    (note,), told = notes_of(path, "below.temperature")
    assert told == [] and "gaussian = { radius = 0.0005 }" in note
    unit = open_package(with_parts(tmp_path, SPOT, named_table(note)))
    assert unit.variable("below_mean.temperature").unit == "K"
    path = with_parts(tmp_path, SPOT)
    for name in ("spot.x", "load.spot.start.y", "probe.below.at.0"):
        assert notes_of(path, "below.temperature", {name: [0.0, 1e-3]}) == ([], []), name


def test_points_elsewhere_are_not_noted(tmp_path):
    path = with_parts(tmp_path, DROP, SPOT)
    assert notes_of(path, "top.temperature") == ([], [])  # between the drop and the spot below
    assert notes_of(path, "plate.heat_in") == ([], [])


def test_sensitivities_point_to_means_too(tmp_path):
    path = with_parts(tmp_path, DROP, SPOT)
    with Unit(path) as unit, pytest.warns(StudyWarning, match="under_mean.temperature"):
        step_sensitivity(unit, ["spot.heat_flux"], ["under.temperature"], 0.01)
