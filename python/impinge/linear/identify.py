"""Finds the linear map of a unit from roll-outs, and checks that it is one."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from impinge.errors import UnitError
from impinge.points import tell_of_points
from impinge.unit import Unit

from .map import LinearMap
from .rollout import NotLinear, Rollout, sizes_of_changes

_SMALLER = 4  # times that changes which a unit refuses are made ten times smaller


def linear_map(
    source: Unit | str | os.PathLike[str],
    inputs: Sequence[str],
    outputs: Sequence[str],
    step: float,
    steps: int,
    *,
    ramps: bool = False,
    changes: Mapping[str, float] | None = None,
    parameters: Mapping[str, Any] | None = None,
    tolerance: float = 1e-9,
) -> LinearMap:
    """The exact map of inputs, held over steps, to outputs at the ends of `steps` steps of `step`
    [s], from the unit's present state under its present inputs:

        y_k = f_k + Σ_{i<k} h_{k−i} (u_i − u_b) + D (u_{k−1} − u_b)

    with the free response f (steps + 1, outputs) under the base inputs u_b, responses h_k (outputs,
    inputs) to a unit pulse over a step, and D what outputs follow at once. One roll-out for each
    input finds them, and two more under random inputs check that they add up.

    source: a unit, which is left as it was, or what `Unit` takes, with `parameters`.
    inputs, outputs: names; those of families stand for all their elements.
    ramps: also finds what inputs do that go straight over a step, where the unit can take these.
    changes: sizes of the pulses by input; nominal values if left out.
    tolerance: what superposition may miss, relative to the largest response of an output; above 0.

    Raises `NotLinear`, with the defect, where superposition misses that; `UnitError` for units
    without states.
    """
    if not isinstance(source, Unit):
        with Unit(source, parameters=parameters) as unit:
            return linear_map(
                unit,
                inputs,
                outputs,
                step,
                steps,
                ramps=ramps,
                changes=changes,
                tolerance=tolerance,
            )
    if not tolerance > 0.0:
        raise ValueError(f"tolerance = {tolerance} (allowed: above 0)")
    if parameters:
        raise ValueError("parameters go with a file (allowed with an open unit: none)")
    if ramps and not source.can.interpolates:
        raise UnitError(f"{source.name} holds its inputs over a step (allowed: ramps=False)")
    tell_of_points(source.package, outputs, inputs)
    with Rollout(source, inputs, outputs, step, steps) as rollout:
        tunable = [v.name for v in rollout.inputs if v.causality != "input"]
        if ramps and tunable:
            raise ValueError(f"{', '.join(tunable)}: tunable parameters (allowed: ramps=False)")
        sizes = _sizes(rollout, changes or {})
        for attempt in range(_SMALLER + 1):
            try:
                return _find(rollout, sizes / 10.0**attempt, ramps, tolerance)
            except UnitError:
                if attempt == _SMALLER:
                    raise
    raise AssertionError("unreachable")


def _sizes(rollout: Rollout, changes: Mapping[str, float]) -> np.ndarray:
    sizes = sizes_of_changes(rollout)
    unknown = set(changes) - {variable.name for variable in rollout.inputs}
    if unknown:
        raise ValueError(f"changes of {', '.join(sorted(unknown))} (allowed: of the inputs)")
    for variable, place in zip(rollout.inputs, rollout.write.slices, strict=True):
        if variable.name in changes:
            sizes[place] = changes[variable.name]
    if np.any(sizes == 0.0) or not np.all(np.isfinite(sizes)):
        raise ValueError(f"changes {sizes} (allowed: finite, not 0)")
    return sizes


def _find(rollout: Rollout, sizes: np.ndarray, ramps: bool, tolerance: float) -> LinearMap:
    free = rollout.free()
    shape = (rollout.steps, free.shape[1], len(sizes))
    held, direct = np.empty(shape), np.empty(shape[1:])
    ramp = np.empty(shape) if ramps else None
    for column, size in enumerate(sizes):
        begin, rows = rollout.pulse(column, size)
        direct[:, column] = (begin - free[0]) / size
        held[:, :, column] = (rows - free[1:]) / size
        if ramp is not None:
            ramp[:, :, column] = (rollout.pulse(column, size, ramp=True)[1] - free[1:]) / size
    names = rollout.input_names + rollout.output_names
    found = LinearMap(
        inputs=tuple(rollout.input_names),
        outputs=tuple(rollout.output_names),
        units={name: rollout.unit.variable(name).unit or "" for name in names},
        step=rollout.step,
        start=rollout.start.time,
        base=rollout.base.copy(),
        free=free,
        direct=direct,
        held=held,
        ramp=ramp,
        changes=sizes.copy(),
        defect=0.0,
    )
    object.__setattr__(found, "defect", _defect(rollout, found, sizes, tolerance))
    return found


def _defect(rollout: Rollout, found: LinearMap, sizes: np.ndarray, tolerance: float) -> float:
    """By how much roll-outs under random inputs differ from what the map says of them, relative to
    the largest response of each output, or to one that rounding of the output would blur."""
    random = np.random.default_rng(0)
    shape = (rollout.steps, len(sizes))
    has_room = _room(rollout, sizes)
    worst, culprit = 0.0, ""
    for part in (1.0, 0.5):
        low = np.where(has_room, -1.0, 0.0) if part == 0.5 else np.zeros(len(sizes))
        begins = rollout.base + part * sizes * random.uniform(low, 1.0, shape)
        ends = None
        if found.ramp is not None:
            ends = rollout.base + part * sizes * random.uniform(low, 1.0, shape)
        seen = rollout.run(begins, ends)
        said = found.predict(begins, ends)
        response = np.abs(seen - found.free).max(axis=0)
        rounding = 100.0 * np.finfo(float).eps * np.sqrt(begins.size) * np.abs(seen).max(axis=0)
        missed = np.abs(seen - said).max(axis=0)
        # Where rounding would reach the tolerance, a response is too small to be looked at.
        size = np.maximum(response, rounding / tolerance)
        relative = missed / np.where(size > 0.0, size, 1.0)
        if relative.max() > worst:
            worst, culprit = float(relative.max()), found.outputs[int(relative.argmax())]
    if worst > tolerance:
        raise NotLinear(
            f"{rollout.unit.name} is not linear: responses of {culprit} to random inputs differ by"
            f" {worst:.1e} of their size from what its responses to single pulses add up to"
            f" (allowed: {tolerance:g}); step_sensitivity takes any unit",
            worst,
        )
    return worst


def _room(rollout: Rollout, sizes: np.ndarray) -> np.ndarray:
    """Whether inputs may change by as much to the other side."""
    rooms = []
    for variable, place in zip(rollout.inputs, rollout.write.slices, strict=True):
        other = rollout.base[place] - sizes[place]
        below = variable.min is None or other > variable.min
        above = variable.max is None or other < variable.max
        rooms.append(np.broadcast_to(np.logical_and(below, above), other.shape))
    return np.concatenate(rooms)
