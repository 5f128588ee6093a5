"""Values at one point of time: outputs that follow inputs at once, and algebraic loops of these."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from impinge.master.acceleration import LeastSquares
from impinge.master.any_unit import AnyUnit
from impinge.master.connection import Link
from impinge.master.errors import MasterError
from impinge.master.graph import components, follows_at_once
from impinge.master.participant import Participant

_MOST = 50
_ROUNDING = 1e-15  # of the largest magnitude of any guess


class Exchange:
    """Sets all inputs from outputs, in the order in which outputs follow inputs at once.

    `loops` are the algebraic loops: groups of connections that follow each other at once.
    """

    def __init__(
        self,
        participants: Mapping[str, Participant],
        links: Sequence[Link],
        units: Mapping[str, AnyUnit],
    ):
        self._participants = participants
        after = {
            id(one): [id(other) for other in links if follows_at_once(units, one, other)]
            for one in links
        }
        by_id = {id(link): link for link in links}
        groups = components(list(by_id), after)
        self._groups = [[by_id[key] for key in group] for group in groups]
        self.loops = [
            group
            for group, keys in zip(self._groups, groups, strict=True)
            if len(keys) > 1 or keys[0] in after[keys[0]]
        ]
        self._is_loop = [group in self.loops for group in self._groups]
        # All that follows nothing at once is passed on together.
        self._is_simple = not any(after.values())

    def __call__(self, inputs: np.ndarray, tolerance: float) -> None:
        """Replaces `inputs` by the present values of the outputs that drive them, and sets them."""
        # What follows inputs at once must see those that no connection sets.
        for participant in self._participants.values():
            if participant.is_direct:
                participant.write(inputs[participant.place])
        if self._is_simple:
            for group in self._groups:
                self._pass(group, inputs)
            for participant in self._participants.values():
                participant.write(inputs[participant.place])
            return
        for group, is_loop in zip(self._groups, self._is_loop, strict=True):
            if is_loop:
                self._solve(group, inputs, tolerance)
            else:
                self._pass(group, inputs)
                self._write(group, inputs)

    def _pass(self, group: Sequence[Link], inputs: np.ndarray) -> None:
        values: dict[str, np.ndarray] = {}
        for link in group:
            if link.source_unit not in values:
                values[link.source_unit] = self._participants[link.source_unit].read()
            place = self._participants[link.source_unit].sources[link.source]
            inputs[link.place] = link.transfer(values[link.source_unit][place])

    def _write(self, group: Sequence[Link], inputs: np.ndarray) -> None:
        for name in {link.target_unit for link in group}:
            participant = self._participants[name]
            participant.write(inputs[participant.place])

    def _solve(self, group: Sequence[Link], inputs: np.ndarray, tolerance: float) -> None:
        places = np.concatenate([np.arange(k.place.start, k.place.stop) for k in group])
        mixing = LeastSquares(depth=20, reuse=0, relaxation=1.0)
        mixing.begin()
        seen = np.zeros(len(places))
        for _ in range(_MOST):
            x = inputs[places].copy()
            self._write(group, inputs)
            self._pass(group, inputs)
            g = inputs[places].copy()
            scales = _scales(group, np.maximum(np.abs(g), np.abs(x)))
            seen = np.maximum(seen, scales)
            if (np.abs(g - x) <= np.maximum(tolerance * scales, _ROUNDING * seen)).all():
                # Units have x. What follows from it was not checked as an input itself, and in
                # loops of large gain is worse.
                inputs[places] = x
                return
            inputs[places] = mixing.next(x, g, 1 / scales)
        names = ", ".join(f"{k.connection.source} -> {k.connection.target}" for k in group)
        raise MasterError(f"the algebraic loop of {names} does not converge in {_MOST} iterations")


def _scales(group: Sequence[Link], sizes: np.ndarray) -> np.ndarray:
    """The scale of each input of a loop, where these are their present magnitudes: as given, else
    the largest magnitude of all inputs in the same unit of measurement, so that what should be
    zero is compared with others of its kind, and a pressure does not decide on a displacement."""
    ends = np.cumsum([link.size for link in group])
    own = [float(sizes[end - link.size : end].max()) for link, end in zip(group, ends, strict=True)]
    largest: dict[object, float] = {}
    kinds = [link.unit or id(link) for link in group]
    for kind, size in zip(kinds, own, strict=True):
        largest[kind] = max(largest.get(kind, 0.0), size)
    return np.concatenate(
        [
            np.full(link.size, link.connection.scale or largest[kind] or link.nominal)
            for link, kind in zip(group, kinds, strict=True)
        ]
    )
