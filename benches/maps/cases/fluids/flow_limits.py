"""Runs `benches/flow_limits.rs`: flows at settings that no scene reaches."""

import json
import subprocess
from math import inf
from pathlib import Path

from plan import Answer, Work

ROOT = Path(__file__).resolve().parents[4]


def program() -> Path:
    """What `cargo build --release --bench flow_limits` made last."""
    made = (ROOT / "target/release/deps").glob("flow_limits-*")
    made = [path for path in made if path.suffix != ".d"]
    if not made:
        raise FileNotFoundError("build it first: cargo build --release --bench flow_limits")
    return max(made, key=lambda path: path.stat().st_mtime)


def run_flow(work: Work) -> Answer:
    """Values of the program; a flow that fell to pieces has none, and says so."""
    ran = subprocess.run([program(), json.dumps(work)], check=True, capture_output=True, text=True)
    told = json.loads(ran.stdout)
    return Answer({"failure": told["failure"]} if told["failure"] else told["values"])


def value(name: str):
    """Judges by one value; what fell to pieces is as bad as can be."""
    return lambda answer, x, y: answer.values.get(name, inf) or 0.0
