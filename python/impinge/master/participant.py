"""A unit among others: what it takes and gives, in flat arrays that are made once."""

from __future__ import annotations

from collections.abc import Collection, Sequence

import numpy as np

from impinge.errors import UnitError
from impinge.function.unit import FunctionState
from impinge.master import waveform
from impinge.master.any_unit import AnyUnit
from impinge.master.connection import Link
from impinge.master.graph import follows
from impinge.unit import State

_TOLD = ("output", "local")  # causalities of what may follow inputs


class Participant:
    """A unit, the inputs that the master sets, and the outputs that others take or that are
    recorded beside these (`recorded`).

    `place` is where its inputs stand among all of them. `held` says what a unit gets that cannot
    follow polynomials over a step: "mean", or "end" where its outputs come from its step alone.
    """

    def __init__(self, name: str, unit: AnyUnit, recorded: Sequence[str] = ()):
        self.name, self.unit, self.recorded = name, unit, recorded
        self.place = slice(0, 0)
        self.links_in: list[Link] = []
        self.links_out: list[Link] = []
        self.constants: set[str] = set()  # inputs that stay what they are
        self.held = "mean"
        self.steps = 0
        self.answers_late = False  # outputs follow inputs, but not before the next step
        self.state: State | FunctionState | None = None
        self.memoryless = False  # follows inputs, and has nothing to go back to

    def connect(self, names: Sequence[str], paths: np.ndarray, order: int) -> None:
        """Makes the calls; `paths` tells which values among the inputs may follow polynomials."""
        self.names = list(names)
        self.writer = self.unit.writer(names) if names else None
        self.order = min(order, self.unit.can.interpolates) if paths.any() else 0
        self.paths = paths
        self.path_writer, self._rest = None, None
        if self.order:
            self._connect_paths(names)
        self._connect_outputs()
        self.is_direct = bool(self._followers(names))
        moving = [name for name in names if name not in self.constants]
        told = self._followers(moving)
        self._probed = self.unit.reader(dict.fromkeys([*self.sources, *told])) if told else None
        self._moves = self.paths & ~self._of(self.constants)

    def _followers(self, names: Sequence[str]) -> list[str]:
        """Returns outputs, connected or recorded, that follow one of these inputs at once."""
        told = dict.fromkeys([*(link.source for link in self.links_out), *self.recorded])
        return [
            each
            for each in told
            if self.unit.variable(each).causality in _TOLD
            and any(follows(self.unit, name, each) for name in names)
        ]

    def _of(self, names: Collection[str]) -> np.ndarray:
        """True where its values are those of these inputs."""
        masks = [np.full(self.unit.variable(name).size, name in names) for name in self.names]
        return np.concatenate(masks) if masks else np.zeros(0, bool)

    def _connect_outputs(self) -> None:
        sources: dict[str, slice] = {}
        count = 0
        for link in self.links_out:
            if link.source not in sources:
                size = self.unit.variable(link.source).size
                sources[link.source] = slice(count, count + size)
                count += size
        self.sources = sources
        self.reader = self.unit.reader(sources) if sources else None

    def _connect_paths(self, names: Sequence[str]) -> None:
        """Inputs that follow paths are set apart from whole numbers and the like."""
        sizes = [self.unit.variable(name).size for name in names]
        begins = np.cumsum([0, *sizes[:-1]])
        follows = [bool(self.paths[begin]) for begin in begins]
        chosen = [name for name, does in zip(names, follows, strict=True) if does]
        others = [name for name, does in zip(names, follows, strict=True) if not does]
        self.path_writer = self.unit.path_writer(chosen, self.order)
        if others:
            self._rest = self.unit.writer(others)

    @property
    def can_go_back(self) -> bool:
        """Whether a step can be taken again."""
        return self.memoryless or self.unit.can.states

    def save(self) -> None:
        """Keeps the present state for `restore`."""
        if self.memoryless:
            self._time = self.unit.time
        else:
            self.state = self.unit.state(self.state)

    def restore(self) -> None:
        """Goes back to the state that was kept. A memoryless unit stays where it is if its outputs
        follow inputs without a step; else it has to take the same step again."""
        if self.memoryless and self.answers_late:
            self.unit.time = self._time
        elif self.state is not None:
            self.unit.restore(self.state)

    def free(self) -> None:
        """Gives up the state that was kept."""
        if self.state is not None:
            self.state.free()
            self.state = None

    def read(self) -> np.ndarray:
        """What others take of it, now."""
        return self.reader() if self.reader is not None else np.zeros(0)

    def write(self, values: np.ndarray) -> None:
        """Sets its inputs as they are now."""
        if self.writer is not None:
            self.writer.values[:] = values
            self.writer()

    def write_path(
        self, a: np.ndarray, b: np.ndarray, c: np.ndarray, end: np.ndarray, size: float
    ) -> np.ndarray:
        """Sets its inputs over the next step: a path as good as the unit can follow, and what
        whole numbers and the like are at its beginning. Returns the means of what it follows."""
        if self.writer is None:
            return a
        if self.path_writer is None:
            held = end if self.held == "end" else waveform.mean(a, b, c, size)
            self.writer.values[:] = np.where(self.paths, held, a)
            self.writer()
            return self.writer.values
        means = waveform.mean(a, b, c, size)
        if self._rest is not None:
            self._rest.values[:] = a[~self.paths]
            self._rest()
            means = np.where(self.paths, means, a)
            a, b, c = a[self.paths], b[self.paths], c[self.paths]
        writer = self.path_writer
        writer.values[:] = a
        if writer.second is not None:
            writer.first[:] = b
            writer.second[:] = c
        else:  # the straight line of the same mean
            writer.first[:] = b + c * (size / 3)
        writer()
        return means

    def step_to(self, time: float) -> None:
        """Advances to a time, unless it is memoryless and has been there already."""
        if self.memoryless and self.unit.time >= time:
            return
        self.steps += 1
        self.unit.step_to(time)

    def probe(self, values: np.ndarray, weight: np.ndarray, step: float) -> str | None:
        """Finds out whether outputs follow inputs at once, as the unit declares or leaves open.

        Where they do not, they are states, which inputs reach as time goes, or values that the unit
        computes in its steps alone. For those, what is held over a step is its end, so that outputs
        at the end of a step belong to inputs then; states follow its mean to second order. Steps
        far below `step` [s] tell one from the other, if the unit can go back; returns what remains
        unknown.
        """
        if self._probed is None or self.path_writer is not None or not self._moves.any():
            return None
        nudge = np.where(self._moves, 1e-3 * np.abs(values) + 1e-6 / weight, 0.0)
        self.answers_late = not self._responds(values, nudge)
        unknown = None
        if self.answers_late and not self.memoryless:
            nudge = np.where(self._moves, 1e-3 * (np.abs(values) + 1 / weight), 0.0)
            try:
                self.answers_late = self._computes_in_steps(values, nudge, step)
            except _Unknown as reason:
                unknown = str(reason)
        if self.answers_late:
            self.held = "end"
        return unknown

    def _responds(self, values: np.ndarray, nudge: np.ndarray) -> bool:
        self.write(values)
        before = self._probed().copy()
        self.write(values + nudge)
        after = self._probed().copy()
        self.write(values)
        return not np.array_equal(before, after)

    def _computes_in_steps(self, values: np.ndarray, nudge: np.ndarray, step: float) -> bool:
        """Whether outputs respond as much to a step of 1/1000 as to one of 1/100 of `step`. States
        respond at most a tenth as much."""
        if not (self.unit.can.states and self.unit.can.variable_steps):
            raise _Unknown("cannot go back" if not self.unit.can.states else "takes equal steps")
        responses, size = [], np.zeros(0)
        with self.unit.state() as state:
            try:
                for length in (1e-2 * step, 1e-3 * step):
                    ends = []
                    for given in (values, values + nudge):
                        self.write(given)
                        self.unit.step(length)
                        ends.append(self._probed().copy())
                        self.unit.restore(state)
                    size = np.abs(ends[0])
                    responses.append(np.abs(ends[1] - ends[0]))
            except UnitError:
                raise _Unknown("refuses short steps") from None
            finally:
                self.unit.restore(state)
                self.write(values)
        longer, shorter = responses
        return bool(((longer > 1e-10 * size) & (shorter > 0.5 * longer)).any())


class _Unknown(Exception):
    """Why a unit does not tell what its outputs are."""
