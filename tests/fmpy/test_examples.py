"""Every example runs to its end as a user would run it, those that take long in coarser units.

The units as they are run a step in `make verify`; `make examples` runs them to their end.
"""

import re
import subprocess
import sys

import pytest
from conftest import EXAMPLES, ROOT, name_of

FEWER = {
    "bend": ["--simulations", "12"],
    "cook_membrane": ["--finest", "6"],
    "moving_spot": ["--frames", "8"],
    "printer_control": ["--drops", "1", "--after", "0.15"],
    "notched_beam": ["--points", "20"],
    "paste_bead": ["--steps", "12"],
    "spoked_ring": ["--stop", "0.011"],
    "quench_cracks": ["--steps", "6"],
    "crack_network": ["--steps", "6"],
    "glass_strip": ["--steps", "4"],
    "thermal_fatigue": ["--drops", "2"],
    "stress_study": ["--samples", "4", "--levels", "3"],
    "wax_layers": ["--stop", "4"],
}
# Examples that draw the points of the grid that their scene has.
GRIDDED = ["moving_spot", "printed_line"]


@pytest.mark.parametrize("scene", EXAMPLES, ids=name_of)
def test_the_example_runs(pack_coarse, pack_small, tmp_path, scene):
    unit = (pack_coarse if name_of(scene) in GRIDDED else pack_small)(scene)
    command = [sys.executable, scene.parent / "run.py", "--fmu", unit, "--out", tmp_path]
    command += FEWER.get(name_of(scene), [])
    ran = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False)
    assert ran.returncode == 0, ran.stdout + ran.stderr
    assert list(tmp_path.rglob("*.png")), "no picture"


def test_the_example_of_two_units_runs(pack, tmp_path):
    folder = ROOT / "examples/droplet_on_plate_two_units"
    coarse = {
        "drop": {"\nspacing = 3.5e-6": "\nspacing = 10e-6"},
        "plate": {"spacing = 5e-6, depth_spacing = 0.1e-6": "spacing = 2e-5, depth_spacing = 5e-7"},
    }
    command = [sys.executable, folder / "run.py", "--step", "2.5e-7", "--out", tmp_path]
    for name in ("drop", "plate", "together"):
        edits = coarse.get(name, coarse["drop"] | coarse["plate"])
        command += [f"--{name}", pack(folder / f"{name}.toml", edits)]
    ran = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False)
    assert ran.returncode == 0, ran.stdout + ran.stderr
    assert list(tmp_path.rglob("*.png")), "no picture"


def test_the_gel_and_its_plate_run_as_two_units(pack, tmp_path):
    folder = ROOT / "examples/gel_drop_on_plate"
    coarse = {
        "gel": {"spacing = 0.35e-3": "spacing = 1e-3"},
        "plate": {"spacing = 0.1e-3, depth_spacing = 3e-6": "spacing = 1e-3, depth_spacing = 2e-5"},
    }
    command = [sys.executable, folder / "two_units.py", "--out", tmp_path]
    for name in ("gel", "plate", "together"):
        edits = coarse.get(name, coarse["gel"] | coarse["plate"])
        command += [f"--{name}", pack(folder / f"{name}.toml", edits)]
    ran = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False)
    assert ran.returncode == 0, ran.stdout + ran.stderr
    for balanced in ("that of the gel to", "given by the gel to"):
        off = re.search(rf"{balanced} (\S+)", ran.stdout)
        assert off and abs(float(off[1])) < 1e-9, ran.stdout
    assert list(tmp_path.rglob("*.png")), "no picture"
