"""How many planted defects `build-fmu --lint`, FMPy and the FMU Manipulation Toolbox find.

The units come from the table in build-fmu/tests/lint.rs; prints the table of build-fmu/README.md.
"""

import os
import subprocess
import sys
import tempfile
from pathlib import Path

from fmpy.validation import validate_fmu

ROOT = Path(__file__).resolve().parents[2]
PROGRAM = ROOT / "target/debug/build-fmu"
TOOL = Path(sys.executable).parent / "fmutool"


def run(*command, **more):
    return subprocess.run(command, capture_output=True, text=True, check=False, cwd=ROOT, **more)


def by_lint(unit):
    return run(PROGRAM, "--lint", unit).returncode != 0


def by_fmpy(unit):
    return bool(validate_fmu(str(unit)))


def by_fmutool(unit):
    """It is taken to find something if it says anything else than of a good unit."""
    check = run(TOOL, "-input", unit, "-check")
    said = check.stdout + check.stderr
    good = "seems to be compliant with FMI-2.0" in said and "No semantic error" in said
    return check.returncode != 0 or not good or "WARNING" in said or "ERROR" in said


CHECKERS = {"build-fmu --lint": by_lint, "fmpy validate": by_fmpy, "fmutool -check": by_fmutool}


def defective_units(folder):
    """The units with one defect each, by name."""
    test = ["--test", "lint", "every_planted_defect_is_found_and_nothing_else"]
    made = run(
        "cargo", "test", "-p", "build-fmu", *test, env={**os.environ, "KEEP_DEFECTS": folder}
    )
    if made.returncode:
        sys.exit(made.stdout + made.stderr)
    return sorted(Path(folder).glob("*.fmu"))


def main():
    with tempfile.TemporaryDirectory() as folder:
        units = defective_units(folder)
        found = {name: [find(unit) for unit in units] for name, find in CHECKERS.items()}
    print(f"| defect | {' | '.join(f'`{name}`' for name in CHECKERS)} |")
    print("|---|" + "---|" * len(CHECKERS))
    for i, unit in enumerate(units):
        marks = ["found" if found[name][i] else "–" for name in CHECKERS]
        print(f"| {unit.stem} | {' | '.join(marks)} |")
    counts = [f"**{sum(found[name])} of {len(units)}**" for name in CHECKERS]
    print(f"| | {' | '.join(counts)} |")


if __name__ == "__main__":
    main()
