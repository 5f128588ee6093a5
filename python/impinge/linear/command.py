"""The command `impinge-linear-map`."""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

from impinge.errors import ImpingeError
from impinge.unit import Unit

from .identify import linear_map
from .realisation import StateSpace


def main(given: list[str] | None = None) -> int:
    """Writes the linear map of a unit or a scene; says what came of it."""
    options = _arguments(given)
    try:
        parameters = dict(_assignment(text) for text in options.set)
        with Unit(options.unit, parameters=parameters) as unit:
            found = linear_map(
                unit,
                options.inputs,
                options.outputs,
                options.step or _proposed(unit),
                options.steps,
                ramps=options.ramps,
                tolerance=options.tolerance,
            )
        found.save(options.output)
        print(
            f"{options.output}: {len(found.inputs)} inputs, {len(found.outputs)} outputs,"
            f" {found.steps} steps of {found.step:g} s; superposition misses {found.defect:.1e}"
        )
        if options.states is not None:
            space = found.state_space(options.states)
            path = options.output.with_suffix(".states.npz")
            _save(space, path)
            print(
                f"{path}: {space.order} states, error {space.error:.1e},"
                f" spectral radius {space.spectral_radius:.9f}"
            )
    except (ImpingeError, ValueError, OSError) as error:
        print(f"impinge-linear-map: {error}", file=sys.stderr)
        return 1
    return 0


def _arguments(given: list[str] | None) -> argparse.Namespace:
    parser = argparse.ArgumentParser(
        prog="impinge-linear-map",
        description="Find what a linear unit makes of its inputs, held over steps, as matrices.",
    )
    parser.add_argument("unit", metavar="UNIT", help="a .fmu file, or a scene (.toml)")
    parser.add_argument("--inputs", required=True, nargs="+", action="extend", metavar="NAME")
    parser.add_argument("--outputs", required=True, nargs="+", action="extend", metavar="NAME")
    parser.add_argument("--step", type=float, metavar="SECONDS", help="[default: the unit's]")
    parser.add_argument("--steps", type=int, default=60, metavar="N", help="[default: 60]")
    parser.add_argument(
        "--set", action="append", default=[], metavar="NAME=VALUE", help="a parameter of the unit"
    )
    parser.add_argument("--ramps", action="store_true", help="inputs that go straight over a step")
    parser.add_argument(
        "--states",
        type=float,
        metavar="TOLERANCE",
        help="write A, B, C, D of this error beside it, as OUTPUT.states.npz",
    )
    parser.add_argument(
        "--tolerance",
        type=float,
        default=1e-9,
        help="what superposition may miss, relative [default: 1e-9]",
    )
    parser.add_argument("-o", "--output", type=Path, default=Path("map.npz"), metavar="FILE.npz")
    return parser.parse_args(given)


def _assignment(text: str) -> tuple[str, float]:
    name, sign, value = text.partition("=")
    try:
        if sign:
            return name.strip(), float(value)
    except ValueError:
        pass
    raise ValueError(f"--set {text} (allowed: NAME=VALUE with a number)")


def _proposed(unit: Unit) -> float:
    if unit.default_step is None:
        raise ValueError("the unit proposes no step (allowed: --step SECONDS)")
    return unit.default_step


def _save(space: StateSpace, path: Path) -> None:
    import numpy as np

    np.savez(
        path,
        A=space.A,
        B=space.B,
        C=space.C,
        D=space.D,
        step=space.step,
        error=space.error,
        inputs=np.array(space.inputs),
        outputs=np.array(space.outputs),
    )
