"""A Python function among units: it knows what compiled ones have to be asked or tried for."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from impinge.function import FunctionUnit
from impinge.master import waveform
from impinge.master.participant import Participant


class FunctionParticipant(Participant):
    """The unit of a `Function`: it gets both ends of the paths of its inputs, and their means."""

    unit: FunctionUnit

    def connect(self, names: Sequence[str], paths: np.ndarray, order: int) -> None:
        """Makes the calls; `paths` marks the inputs whose values may follow polynomials."""
        self.names = list(names)
        self.writer = self.unit.writer(names) if names else None
        self.order = min(order, self.unit.can.interpolates)
        self.paths, self._places = paths, self.unit.places(names)
        self.path_writer = None
        self._connect_outputs()
        self.is_direct = self.unit.function.follows_inputs

    def write_path(
        self, a: np.ndarray, b: np.ndarray, c: np.ndarray, end: np.ndarray, size: float
    ) -> np.ndarray:
        """Sets its inputs over the next step: whole numbers and the like are what they are at its
        beginning. Returns the means of what it follows."""
        last = np.where(self.paths, waveform.at(a, b, c, size), a)
        means = np.where(self.paths, waveform.mean(a, b, c, size), a)
        self.unit.follow(self._places, a, last, means)
        return last if self.unit.takes_ends else means

    def probe(self, values: np.ndarray, weight: np.ndarray, step: float) -> str | None:
        """There is nothing to find out: a function says what its outputs follow."""
        return None
