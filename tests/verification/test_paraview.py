"""Files of a run open in a viewer: one list has all bodies at all times, and is rendered."""

import os
import subprocess
from pathlib import Path

import numpy as np
import pytest

ROOT = Path(__file__).resolve().parents[2]
pyvista = pytest.importorskip("pyvista", reason="no PyVista (python/requirements-verify.txt)")

TABLE = "time,drop.release\n0,0\n1e-6,1\n"
SCENE = """
name = "Drops"
stop_time = 4e-6
step = 1e-6
[body.plate]
kind = "solid"
shape = { box = [4e-4, 4e-4, 1e-4] }
material = { model = "thermoelastic", density = 3950.0, specific_heat = 900.0, conductivity = 10.0 }
initial_temperature = 293.15
mesh = { spacing = 2e-5, depth_spacing = 5e-6, growth = 1.5 }
[body.drop]
kind = "droplet"
diameter = 1e-4
impact_velocity = 20.0
initial_temperature = 350.0
spacing = 10e-6
release = "input"
most = 1
fluid = { density = 1000.0, viscosity = 1e-3, specific_heat = 4180.0, conductivity = 0.6 }
[[coupling]]
from = "drop"
to = "plate.top"
"""


@pytest.fixture(scope="module")
def run(tmp_path_factory):
    """The folder of a run in which a drop is released after the first step."""
    folder = tmp_path_factory.mktemp("paraview")
    (folder / "scene.toml").write_text(SCENE)
    (folder / "table.csv").write_text(TABLE)
    program = Path(os.environ.get("IMPINGE_BIN", ROOT / "target/release")) / "impinge"
    command = [program, "run", "scene.toml", "--inputs", "table.csv", "--between", "held"]
    command += ["--out", "run", "--fields-every", "1"]
    subprocess.run(command, cwd=folder, check=True, capture_output=True)
    return folder / "run"


def at(run, time):
    """Reads all bodies at a time [s] as a viewer does."""
    reader = pyvista.get_reader(run / "all-bodies.pvd")
    reader.set_active_time_value(time)
    return [block for block in reader.read() if block is not None and block.n_points]


def test_one_list_opens_all_bodies_over_time(run):
    reader = pyvista.get_reader(run / "all-bodies.pvd")
    assert reader.time_values == pytest.approx([0.0, 1e-6, 2e-6, 3e-6, 4e-6])
    (plate,) = at(run, 0.0)
    assert plate.n_cells > 100 and "temperature" in plate.point_data
    bodies = at(run, reader.time_values[-1])
    assert len(bodies) == 2, "the plate, and the drop that was released"
    (drop,) = [body for body in bodies if "velocity" in body.point_data]
    assert drop.n_points > 100 and drop.bounds[4] > 0.0
    # The drop heats the plate below it.
    (plate,) = [body for body in bodies if body is not drop]
    hottest = plate.points[np.argmax(plate.point_data["temperature"])]
    assert plate.point_data["temperature"].max() > 294.0 and np.hypot(*hottest[:2]) < 1e-4


def test_no_file_of_a_run_is_without_points(run):
    files = [path for path in run.iterdir() if path.suffix in (".vtr", ".vtp")]
    assert len(files) > 5
    assert all(pyvista.read(path).n_points > 0 for path in files)


def test_a_run_is_rendered(run, tmp_path):
    plotter = pyvista.Plotter(off_screen=True, window_size=(300, 200))
    for body in at(run, 4e-6):
        plotter.add_mesh(body, scalars="temperature", clim=(293.0, 350.0))
    plotter.view_xz()
    picture = plotter.screenshot(tmp_path / "run.png", return_img=True)
    background = picture[0, 0]
    drawn = (picture != background).any(axis=2)
    assert 0.05 < drawn.mean() < 0.95
    assert len(np.unique(picture[drawn], axis=0)) > 50
