"""Gradient damage beside a program of the same algorithm in scikit-fem with PARDISO, in one run.

    make .venv/ready-verify; cargo build --release --bench cracks
    .venv/bin/python benches/cracks_peer.py [NODES_PER_LENGTH PART ...]

Both compute the edge crack of `tests/verification/cracks.rs` on one core to the same tolerances,
which is 91 698 nodes at the default of 16 nodes per length of damage, and print the dissipated
energy, the processor time and the alternations of every step. impinge needs fewer alternations,
because it accelerates them; times per alternation compare the rest.
"""

import json
import os
import subprocess
import sys
import time

os.environ.update(
    dict.fromkeys(("MKL_NUM_THREADS", "OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS"), "1")
)

from built import ROOT, newest  # noqa: E402

sys.path.insert(0, str(ROOT / "tests/verification"))

from cracks_peer import Plane, pardiso  # noqa: E402


def own(per_length, parts):
    """Steps of impinge."""
    numbers = [str(number) for number in (per_length, *parts)]
    run = subprocess.run([newest("cracks"), *numbers], check=True, capture_output=True, text=True)
    return [json.loads(line) for line in run.stdout.splitlines()]


def peer(per_length, parts):
    """Steps of the program in scikit-fem."""
    if pardiso is None:
        raise SystemExit("pypardiso is missing: make .venv/ready-verify")
    plane = Plane(per_length)
    for part in parts:
        begun = time.process_time()
        count = plane.advance(plane.cold(part))
        yield count, plane.dissipated(), time.process_time() - begun


def main(per_length=16.0, *parts):
    parts = parts or (0.98, 1.0, 1.02)
    sums, counts = [0.0, 0.0], [0, 0]
    steps = own(per_length, parts)
    print(f"{steps[0]['nodes']} nodes")
    for step, (count, dissipated, took) in zip(steps, peer(per_length, parts), strict=True):
        sums = [sums[0] + step["processor_time"], sums[1] + took]
        counts = [counts[0] + step["alternations"], counts[1] + count]
        off = step["dissipated"] / dissipated - 1
        print(
            f"{step['part']}: {step['alternations']} and {count} alternations, "
            f"{step['processor_time']:.1f} and {took:.1f} s, energy {off:+.1e}",
            flush=True,
        )
    print(f"{sums[0]:.1f} and {sums[1]:.1f} s: {sums[1] / sums[0]:.1f} times as long")
    each = [took / count for took, count in zip(sums, counts, strict=True)]
    print(
        f"{counts[0]} and {counts[1]} alternations of {each[0]:.2f} and {each[1]:.2f} s: "
        f"{each[1] / each[0]:.1f} times as long each"
    )


if __name__ == "__main__":
    main(*(float(value) for value in sys.argv[1:]))
