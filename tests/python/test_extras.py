"""What is imported when it is first asked for, where its extra is not installed."""

import subprocess
import sys

import pytest

ASKS = "import sys; sys.modules['{}'] = None; from impinge import {}"


@pytest.mark.parametrize(
    ("module", "name", "extra"),
    [("cloudpickle", "Study", "study"), ("scipy", "Surface", "surface")],
)
def test_the_command_that_installs_an_extra_is_told(module, name, extra):
    """One that works: the package is in no index."""
    command = [sys.executable, "-c", ASKS.format(module, name)]
    environment = {"PYTHONPATH": ":".join(filter(None, sys.path))}
    ran = subprocess.run(command, capture_output=True, text=True, env=environment)
    last = ran.stderr.strip().splitlines()[-1]
    assert last.startswith(f"ImportError: impinge.{name} needs `{module}")
    assert last.endswith(f': pip install "./python[{extra}]", in the checkout of impinge')
