"""Every example runs to its end as a user would run it, those that take long in coarser units.

The units as they are run a few steps in test_standard.py; `make examples` runs them to their end.
"""

import subprocess
import sys

import pytest
from conftest import EXAMPLES, ROOT

COARSE = {
    "alumina_plate": {"spacing = 5e-6, depth_spacing": "spacing = 1e-5, depth_spacing"},
    "droplet_impact": {
        "\nspacing = 2.5e-6": "\nspacing = 4e-6",
        "spacing = 7.5e-6, depth_spacing": "spacing = 12e-6, depth_spacing",
    },
    "moving_spot": {"spacing = 40e-6, depth_spacing": "spacing = 80e-6, depth_spacing"},
    "printed_line": {"\nspacing = 3e-6": "\nspacing = 6e-6"},
}
FEWER = {
    "printer_control": ["--drops", "1", "--after", "0.15"],
    "stress_study": ["--samples", "4", "--levels", "3"],
}


@pytest.mark.parametrize("scene", EXAMPLES, ids=lambda path: path.parent.name)
def test_the_example_runs(pack, tmp_path, scene):
    unit = pack(scene, COARSE.get(scene.parent.name))
    command = [sys.executable, scene.parent / "run.py", "--fmu", unit, "--out", tmp_path]
    command += FEWER.get(scene.parent.name, [])
    ran = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False)
    assert ran.returncode == 0, ran.stdout + ran.stderr
    assert list(tmp_path.rglob("*.png")), "no picture"


def test_the_example_of_two_units_runs(pack, tmp_path):
    folder = ROOT / "examples/droplet_on_plate_two_units"
    coarse = {
        "drop": {"\nspacing = 3.5e-6": "\nspacing = 10e-6"},
        "plate": {"mesh = { spacing = 5e-6,": "mesh = { spacing = 20e-6,"},
    }
    command = [sys.executable, folder / "run.py", "--step", "2.5e-7", "--out", tmp_path]
    for name in ("drop", "plate", "together"):
        edits = coarse.get(name, coarse["drop"] | coarse["plate"])
        command += [f"--{name}", pack(folder / f"{name}.toml", edits)]
    ran = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False)
    assert ran.returncode == 0, ran.stdout + ran.stderr
    assert list(tmp_path.rglob("*.png")), "no picture"
