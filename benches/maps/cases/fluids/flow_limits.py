"""Runs `benches/flow_limits.rs`: flows at settings that no scene reaches."""

import json
import subprocess
import sys
from pathlib import Path

from plan import Answer, Work

sys.path.append(str(Path(__file__).resolve().parents[3]))

from built import newest  # noqa: E402 - of the folder of all benches


def run_flow(work: Work) -> Answer:
    """Values of the program; a flow that fell to pieces has none, and says so."""
    command = [newest("flow_limits"), json.dumps(work)]
    ran = subprocess.run(command, check=True, capture_output=True, text=True)
    told = json.loads(ran.stdout)
    return Answer({"failure": told["failure"]} if told["failure"] else told["values"])
