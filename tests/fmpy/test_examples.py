"""Every example runs to its end as a user would run it."""

import subprocess
import sys

import pytest
from conftest import EXAMPLES, ROOT


@pytest.mark.parametrize("scene", EXAMPLES, ids=lambda path: path.parent.name)
def test_the_example_runs(pack, tmp_path, scene):
    command = [sys.executable, scene.parent / "run.py", "--fmu", pack(scene), "--out", tmp_path]
    ran = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False)
    assert ran.returncode == 0, ran.stdout + ran.stderr
    assert list(tmp_path.rglob("*.png")), "no picture"
