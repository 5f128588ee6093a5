"""Motion by G-code with an acceleration beside pyGCodeDecode, which plans as firmware does."""

import numpy as np
import pytest
from impinge import Unit

decoder = pytest.importorskip(
    "pyGCodeDecode.gcode_interpreter",
    reason="no pyGCodeDecode (python/requirements-verify.txt)",
)

# Corners of 90°, 45° and 30°, the last leg slower.
CODE = """G21
G90
M82
G92 E0
G0 X0 Y0 Z0.4 F6000
G1 X20 Y0 E1 F6000
G1 X20 Y12 E1.6 F6000
G1 X30 Y22 E2.3071 F6000
G1 X39.659 Y24.588 E2.8071 F3000
"""
ACCELERATION, CORNER_SPEED, SECTION = 5.0, 8e-3, 0.25 * np.pi * 1.75e-3**2  # m/s², m/s, m²

SCENE = f"""
name = "Corners"
stop_time = 1.0
step = 0.01
[body.melt]
kind = "filament"
fluid = {{ density = 1240.0, viscosity = 1e3, specific_heat = 1800.0, conductivity = 0.0 }}
nozzle = {{ diameter = 0.4e-3, height = 0.4e-3, temperature = 473.15 }}
path = {{ file = "corners.gcode", acceleration = {ACCELERATION}, corner_speed = {CORNER_SPEED} }}
most = 1e-8
"""

MACHINE = f"""
machine:
  firmware: junction_deviation
  p_vel: 100
  p_acc: {1e3 * ACCELERATION}
  jerk: {1e3 * CORNER_SPEED}
  vX: 10000
  vY: 10000
  vZ: 10000
  vE: 10000
  nozzle_diam: 0.4
  filament_diam: 1.75
  initial_position: {{ X: 0, Y: 0, Z: 0.4, E: 0 }}
"""


@pytest.fixture(scope="module")
def plan(tmp_path_factory):
    """The plan of pyGCodeDecode, and the folder with the scene."""
    folder = tmp_path_factory.mktemp("corners")
    (folder / "corners.gcode").write_text(CODE)
    (folder / "corners.toml").write_text(SCENE)
    (folder / "machine.yaml").write_text(MACHINE)
    settings = decoder.setup(folder / "machine.yaml", printer="machine", verbosity_level=0)
    code = folder / "corners.gcode"
    return decoder.simulation(code, initial_machine_setup=settings, verbosity_level=0), folder


def test_volumes_over_time_are_those_of_another_planner(plan):
    """Volume that has come, hence the way along the path, at the ends of its parts of constant
    acceleration and between them. Its corner speeds are 0.02 % lower: it rounds √2 − 1 to 0.414."""
    peer, folder = plan
    parts = [part for block in peer.blocklist for part in block.get_segments()]
    ends = np.array([float(part.t_end) for part in parts])
    assert len(ends) >= 12 and np.all(np.diff(ends) > 1e-3)
    times = np.sort(np.r_[ends, 0.5 * (ends[1:] + ends[:-1])])
    fed = [peer.get_values(min(time, ends[-1] - 1e-9))[1][3] for time in times]
    with Unit(folder / "corners.toml") as unit:
        found = []
        for time in times:
            unit.step_to(time)
            found.append(unit["melt.volume"])
    off = np.array(found) / SECTION - 1e-3 * np.array(fed)  # m of filament
    # A length of filament is 20 times as long on the plate.
    assert 20.0 * np.abs(off).max() < 0.4e-6
    assert found[-1] == pytest.approx(2.8071e-3 * SECTION, rel=1e-6)
