"""What a study would find out in every row, told before any of them runs."""

from __future__ import annotations

import warnings
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from impinge.errors import UnitError
from impinge.points import tell_of_points
from impinge.unit import Variable

from .runner import Row
from .signals import Table, timeline

if TYPE_CHECKING:
    from .study import Study


def check_values(study: Study) -> None:
    """Refuses parameters both ends of which the unit or the scene refuses, with its own words; if
    it refuses one of them, warns of rows that will fail.

    Other scenes are described for that, in milliseconds each. What only an initialised unit finds
    fails in its rows.
    """
    scenes: dict[str, str] = {}
    for name in study.parameters:
        if study.kinds[name] == "scene":
            _check_ends(study, name, lambda row: _refusal_of_scene(study, row, scenes))
        elif study.kinds[name] in ("parameter", "input"):
            variable = study.package.variable(name)
            _check_kind(study, variable)
            low, high = variable.min, variable.max
            _check_ends(study, name, _out_of(name, study, low, high))


def _check_kind(study: Study, variable: Variable) -> None:
    """Refuses values that are none of the variable's type; every one of them, as no range holds
    such values."""
    allowed = _allowed(variable)
    for row in study.design.rows:
        value = row[variable.name]
        if not _is_of_kind(value, variable):
            raise UnitError(f"{variable.name} = {value!r} (allowed: {allowed})")


def _allowed(variable: Variable) -> str:
    if not variable.is_number:
        return "texts"
    if variable.kind == "Boolean":
        return "true and false"
    return "numbers" if _is_float(variable) else "whole numbers"


def _is_of_kind(value: Any, variable: Variable) -> bool:
    if not variable.is_number:
        return isinstance(value, str)
    if not isinstance(value, int | float):
        return False
    if variable.kind == "Boolean":
        return value in (0, 1)
    return _is_float(variable) or float(value).is_integer()


def _is_float(variable: Variable) -> bool:
    return variable.kind in ("Real", "Float64", "Float32")


def _check_ends(study: Study, name: str, refusal: Callable[[Row], str]) -> None:
    values = [row[name] for row in study.design.rows]
    is_number = all(isinstance(value, int | float) for value in values)
    order = sorted(range(len(values)), key=values.__getitem__) if is_number else range(len(values))
    if not len(order):
        return
    ends = dict.fromkeys((order[0], order[-1]))
    told = [(place, refusal(study.rows[place])) for place in ends]
    refused = [(place, why) for place, why in told if why]
    if len(refused) == len(told):
        raise UnitError(f"{name} = {values[refused[0][0]]!r}: {refused[0][1]}")
    for place, why in refused:
        note = f"rows with {name} = {values[place]!r} will fail: {why}"
        study.notes.append(note)
        warnings.warn(note, stacklevel=4)


def _out_of(name: str, study: Study, low: float | None, high: float | None) -> Callable[[Row], str]:
    def refusal(row: Row) -> str:
        value: Any = study.design.rows[row.index][name]
        if not isinstance(value, int | float):
            return ""
        if (low is None or value >= low) and (high is None or value <= high):
            return ""
        allowed = [f"at least {low:g}"] if low is not None else []
        allowed += [f"at most {high:g}"] if high is not None else []
        return f"the unit refuses it (allowed: {', '.join(allowed)})"

    return refusal


def _refusal_of_scene(study: Study, row: Row, known: dict[str, str]) -> str:
    assert study.scene
    if row.scene not in known:
        try:
            study.scene.variant(study.texts[row.scene])
            known[row.scene] = ""
        except UnitError as error:
            known[row.scene] = str(error)
    return known[row.scene]


def warn_of_inputs(study: Study) -> None:
    """Says what functions and tables do, in the first row, that steps cannot follow."""
    experiment = study.experiment
    moving = {n: s for n, s in experiment.inputs.items() if callable(s) or isinstance(s, Table)}
    if not moving or not study.rows:
        return
    cut = study.package.can.variable_steps
    discrete = [name for name in moving if study.package.variable(name).is_discrete]
    sampled = study.rows[0].sampled
    try:
        line = timeline(experiment.stop, experiment.step, moving, cut, sampled, discrete)
    except Exception:  # rows keep what their functions raise
        return
    for note in line.notes:
        study.notes.append(note)
        warnings.warn(note, stacklevel=3)


def warn_of_points(study: Study) -> None:
    """Points to means where an output is the value in the middle of a drop or a spot."""
    experiment = study.experiment
    outputs = [name for output in experiment.outputs for name in output.needs]
    moved = [*study.parameters, *experiment.inputs]
    study.notes += tell_of_points(study.package, outputs, moved, stacklevel=3)
