"""Participants that connections join, and the groups that step together."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from typing import Any

import numpy as np

from impinge.function import FunctionUnit
from impinge.jumps import Watched
from impinge.master.acceleration import acceleration as make_acceleration
from impinge.master.any_unit import AnyUnit
from impinge.master.checks import check_input, check_set, flat_numbers
from impinge.master.connection import Link, split
from impinge.master.engine import Component
from impinge.master.errors import MasterError
from impinge.master.function_participant import FunctionParticipant
from impinge.master.graph import best_order, unit_components
from impinge.master.participant import Participant

# An input that follows a function of time: its place among all inputs, and the function.
Drive = tuple[slice, Watched]


def join(
    units: Mapping[str, AnyUnit],
    links: Sequence[Link],
    inputs: Mapping[str, Any],
    memoryless: Collection[str],
    order: int,
    recorded: Sequence[str] = (),
) -> tuple[dict[str, Participant], list[Drive]]:
    """Makes the participants and gives each input its place; also returns the driven inputs.

    recorded: outputs beside the sources of links that are to belong to inputs at the ends of steps.
    """
    told: dict[str, list[str]] = {name: [] for name in units}
    for each in recorded:
        name, variable = split(each, units)
        told[name].append(variable)
    participants = {name: _participant(name, unit, told[name]) for name, unit in units.items()}
    for link in links:
        participants[link.source_unit].links_out.append(link)
        participants[link.target_unit].links_in.append(link)
    driven = _driven(units, links, inputs)
    drives: list[Drive] = []
    count = 0
    for name, participant in participants.items():
        participant.memoryless = name in memoryless
        begin, names, paths = count, [], []
        for link in participant.links_in:
            link.place = slice(count, count + link.size)
            count += link.size
            names.append(link.target)
            paths.append(np.full(link.size, link.is_real))
        for variable, value in driven.get(name, []):
            target = units[name].variable(variable)
            place = slice(count, count + target.size)
            count += target.size
            function = _function(f"{name}.{variable}", value, target.shape)
            drives.append((place, function))
            if function.is_constant:
                participant.constants.add(variable)
            names.append(variable)
            real = target.is_real and target.variability == "continuous"
            paths.append(np.full(target.size, real))
        participant.place = slice(begin, count)
        mask = np.concatenate(paths) if paths else np.zeros(0, bool)
        participant.connect(names, mask, order)
    return participants, drives


def _driven(
    units: Mapping[str, AnyUnit], links: Sequence[Link], inputs: Mapping[str, Any]
) -> dict[str, list[tuple[str, Any]]]:
    """Inputs that no connection sets, with their values, by unit."""
    targets = {link.connection.target for link in links}
    driven: dict[str, list[tuple[str, Any]]] = {}
    for name, value in inputs.items():
        unit, variable = split(name, units)
        if name in targets:
            raise MasterError(f"{name} is set by a connection already")
        check_input(units[unit], name, variable)
        driven.setdefault(unit, []).append((variable, value))
    for name, unit in units.items():
        if isinstance(unit, FunctionUnit):
            connected = {link.target for link in links if link.target_unit == name}
            check_set(unit, connected | {variable for variable, _ in driven.get(name, [])})
    return driven


def components(
    participants: Mapping[str, Participant],
    links: Sequence[Link],
    scheme: str,
    acceleration: str,
    relaxation: float | None,
    reuse: int | None,
) -> list[Component]:
    """Groups of units that a scheme advances together, in their order."""
    if scheme == "jacobi":
        groups = [list(participants)]
    else:
        units = {name: participant.unit for name, participant in participants.items()}
        groups = [best_order(units, group, links) for group in unit_components(units, links)]
    found = []
    for group in groups:
        place = {name: i for i, name in enumerate(group)}
        inner = [link for link in links if link.source_unit in place and link.target_unit in place]
        guessed = [
            link
            for link in inner
            if scheme == "jacobi" or place[link.source_unit] >= place[link.target_unit]
        ]
        iterates = scheme == "iterate" and any(link.is_real for link in guessed)
        made = make_acceleration(acceleration, relaxation, reuse)
        members = [participants[name] for name in group]
        found.append(Component(members, guessed, iterates, made))
    return found


def _participant(name: str, unit: AnyUnit, recorded: Sequence[str]) -> Participant:
    kind = FunctionParticipant if isinstance(unit, FunctionUnit) else Participant
    return kind(name, unit, recorded)


def _function(name: str, value: Any, shape: tuple[int, ...]) -> Watched:
    """A constant or a function of time as a function of time that gives a flat array."""
    if callable(value):

        def at(time: float) -> np.ndarray:
            try:
                given = value(time)
            except Exception as error:
                error.add_note(f"from the function of the input `{name}` at {time!r} s")
                raise
            return flat_numbers(name, given, shape)

        return Watched(name, at)
    constant = flat_numbers(name, value, shape)
    return Watched(name, lambda _: constant, is_constant=True)
