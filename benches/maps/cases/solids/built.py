"""Programs of `benches/` that print JSON, built once."""

import json
import subprocess
from functools import cache
from pathlib import Path

ROOT = Path(__file__).resolve().parents[4]


@cache
def built_bench(name: str) -> str:
    command = ["cargo", "bench", "--bench", name, "--no-run", "--message-format=json"]
    output = subprocess.run(command, cwd=ROOT, check=True, capture_output=True, text=True).stdout
    messages = [json.loads(line) for line in output.splitlines()]
    made = [m for m in messages if m.get("executable") and m["target"]["name"] == name]
    return made[-1]["executable"]


def printed(name: str, *words) -> dict:
    """What a program prints for its arguments."""
    command = [built_bench(name), *map(str, words)]
    ran = subprocess.run(command, check=True, capture_output=True, text=True)
    return json.loads(ran.stdout)
