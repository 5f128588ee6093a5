"""One step of all units: Jacobi, Gauss–Seidel, or iterated until what is guessed comes out."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from impinge.errors import FunctionError, UnitError
from impinge.jumps import Watched
from impinge.master import waveform
from impinge.master.acceleration import Acceleration
from impinge.master.connection import Link
from impinge.master.participant import Participant

_BACK = 6  # how often a guess that a unit refuses is halved


@dataclass
class Component:
    """Units that advance together, in order; `guessed` are the links whose values are not known
    when their target advances, `places` where these stand among all inputs."""

    members: list[Participant]
    guessed: list[Link]
    iterates: bool = False
    acceleration: Acceleration = field(default_factory=Acceleration)

    def __post_init__(self) -> None:
        spans = [np.arange(k.place.start, k.place.stop) for k in self.guessed]
        self.places = np.concatenate(spans) if spans else np.zeros(0, int)
        real = [np.full(k.size, k.is_real) for k in self.guessed]
        self.real = np.concatenate(real) if real else np.zeros(0, bool)

    @property
    def has_guesses_left(self) -> bool:
        """True for targets that may keep guesses after a step because they were not iterated."""
        return bool(self.guessed) and not (self.iterates and self.real.all())


class NoConvergence(Exception):
    """A step whose iterations found no end. `is_final` if nothing can go on from what they left."""

    def __init__(self, what: str, is_final: bool = False):
        super().__init__(what)
        self.is_final = is_final


class Engine:
    """The state of a coupled run: paths of inputs since the last jump, and how steps are taken.

    order: degree of the polynomials in time through values that are known or iterated.
    extrapolation: degree of those through earlier values alone.
    drives: inputs that functions of time give: (place, function). Of those that jump within the
        next step, `means` holds what they are held at; elsewhere it is not a number.
    """

    def __init__(
        self,
        participants: Sequence[Participant],
        links: Sequence[Link],
        components: Sequence[Component],
        drives: Sequence[tuple[slice, Watched]],
        order: int,
        extrapolation: int,
        max_iterations: int,
    ):
        self.participants, self.links, self.components = participants, links, components
        self.drives = drives
        self.order, self.extrapolation = order, extrapolation
        self.max_iterations = max_iterations
        count = sum(p.place.stop - p.place.start for p in participants)
        self.inputs = np.zeros(count)
        self.history = waveform.History(3)
        self.iterations = 0
        self.last_iterations = 0
        self.means: np.ndarray | None = None
        self._driven = np.zeros(count, bool)
        for place, _ in drives:
            self._driven[place] = True
        self.paths = np.zeros(count, bool)  # inputs that may follow polynomials
        for participant in participants:
            self.paths[participant.place] = participant.paths
        guessed = [k for c in components if not c.iterates for k in c.guessed]
        self._extrapolated = self._mask(guessed)
        self._whole = self._mask([k for k in links if k.is_mean])
        self._stale = np.zeros(count, bool)
        self._discrete = self._mask([k for k in links if not k.is_real])
        self._discrete |= self._driven & ~self.paths
        self._driven &= self.paths

    def _mask(self, links: Sequence[Link]) -> np.ndarray:
        mask = np.zeros(len(self.inputs), bool)
        for link in links:
            mask[link.place] = True
        return mask

    def begin(self, time: float) -> None:
        """Takes the present inputs as the only ones known, after a start or a jump."""
        self.history.begin(time, self.inputs)
        late = [p.name for p in self.participants if p.answers_late]
        self._stale = self._mask([k for k in self.links if k.source_unit in late])

    @property
    def is_stale(self) -> bool:
        """Whether what some outputs said as the step began was no answer to the inputs then."""
        return bool(self._stale.any())

    def drive_after(self, inputs: np.ndarray, time: float, size: float) -> None:
        """Puts the values of functions of time in as a step of `size` begins."""
        for place, function in self.drives:
            inputs[place] = function.after(time, size)

    def _drive_before(self, inputs: np.ndarray, time: float, size: float) -> None:
        for place, function in self.drives:
            inputs[place] = function.before(time, size)

    def weights(self, present: np.ndarray) -> np.ndarray:
        """One over the scale of each input, where these are the `present` ones."""
        weight = np.ones(len(self.inputs))
        for link in self.links:
            weight[link.place] = 1 / link.scale(present)
        return weight

    def see(self, inputs: np.ndarray) -> None:
        """Remembers magnitudes of what is accepted. Guesses may be larger by any factor: a scale
        that kept them would call wrong values converged."""
        for link in self.links:
            link.largest = max(link.largest, float(np.abs(inputs[link.place]).max()))

    # A step

    def advance(self, time: float, end: float, tolerance: float, is_strict: bool = True) -> None:
        """Takes all units from `time` to `end`; what they then are is not yet accepted.

        Functions of time are evaluated just before the end. Afterwards `guess` holds the inputs
        that paths end at, `true` those that outputs say, `arrived` the means of what targets
        followed. `NoConvergence` that is not strict, nor final, leaves all units at the end, too.
        """
        size = end - time
        self.guess = self._extrapolate(end)
        self._drive_before(self.guess, end, size)
        self.true = self.guess.copy()
        self.arrived = np.zeros_like(self.inputs)
        self.last_iterations = 0
        middle = None
        if self.order == 2 and self.drives:
            middle = np.zeros_like(self.inputs)
            for place, function in self.drives:
                middle[place] = function((time + end) / 2)
        unsettled: list[NoConvergence] = []
        for component in self.components:
            if not component.iterates:
                self._sweep(component, time, end, size, middle)
                continue
            try:
                self._iterate(component, time, end, size, tolerance, middle)
            except NoConvergence as error:
                if is_strict or error.is_final:
                    raise
                unsettled.append(error)
        self.iterations += self.last_iterations
        if unsettled:
            raise NoConvergence("; ".join(map(str, unsettled)))

    def _extrapolate(self, end: float) -> np.ndarray:
        nodes = self.history.last(max(self.extrapolation, self.order) + 1)
        guess = waveform.path(nodes, end)[0].copy()
        if self._extrapolated.any():
            own = waveform.path(self.history.last(self.extrapolation + 1), end)[0]
            guess[self._extrapolated] = own[self._extrapolated]
        guess[self._discrete] = self.history.nodes[-1][1][self._discrete]
        return guess

    def _sweep(
        self, component: Component, time: float, end: float, size: float, middle: np.ndarray | None
    ) -> None:
        for participant in component.members:
            place = participant.place
            if participant.writer is not None:
                path = self._path(place, time, end, middle)
                last = self._last(place)
                self.arrived[place] = participant.write_path(*path, last, size)
            participant.step_to(end)
            if participant.is_direct and participant.held != "end":
                participant.write(self.guess[place])
            values = participant.read()
            for link in participant.links_out:
                new = link.transfer(values[participant.sources[link.source]])
                if not (component.iterates or np.isfinite(new).all()):
                    source = link.connection.source
                    raise NoConvergence(f"values of {source} are not finite", is_final=True)
                self.true[link.place] = new
                if link not in component.guessed:
                    self.guess[link.place] = new

    def _last(self, place: slice) -> np.ndarray:
        """Returns values of some inputs at the end of the step; where means are held, those."""
        if self.means is None:
            return self.guess[place]
        return np.where(np.isfinite(self.means[place]), self.means[place], self.guess[place])

    def _path(
        self, place: slice, time: float, end: float, middle: np.ndarray | None
    ) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """The path of some inputs over the step: through the guess at its end, where it is more
        than what earlier values say."""
        past = [(at, values[place]) for at, values in self.history.last(self.order)]
        a, b, c = waveform.path([*past, (end, self.guess[place])], time)
        changes = [
            (self._whole | self._stale, [(end, self.guess)]),
            (self._extrapolated, self.history.last(self.extrapolation + 1)),
            (self._discrete, self.history.last(1)),
        ]
        if middle is not None:
            now = self.history.nodes[-1]
            changes.append((self._driven, [now, ((time + end) / 2, middle), (end, self.guess)]))
        elif self.order:
            changes.append((self._driven, [self.history.nodes[-1], (end, self.guess)]))
        if self.means is not None:
            changes.append((np.isfinite(self.means), [(end, self.means)]))
        for mask, nodes in changes:
            mask = mask[place]
            if mask.any():
                other = waveform.path([(at, values[place]) for at, values in nodes], time)
                a, b, c = (
                    np.where(mask, new, old) for new, old in zip(other, (a, b, c), strict=True)
                )
        return a, b, c

    def _iterate(
        self,
        component: Component,
        time: float,
        end: float,
        size: float,
        tolerance: float,
        middle: np.ndarray | None,
    ) -> None:
        places, real = component.places, component.real
        iterated = places[real]
        component.acceleration.begin()
        last = self.history.nodes[-1][1][places]  # a guess that units have borne
        step = (component, time, end, size, middle)
        for count in range(1, self.max_iterations + 1):
            if count > 1:
                self._go_back(component)
            x = self._bear(step, last)
            g = self.true[places]
            if not np.isfinite(g).all():
                raise NoConvergence("values are not finite", is_final=True)
            weight = self.weights(self.true)[iterated]
            residual = np.abs(g - x)[real] * weight
            if (residual <= tolerance).all():
                component.acceleration.end()
                return
            self.guess[places] = x
            self.guess[iterated] = component.acceleration.next(x[real], g[real], weight)
            last = x
        self.guess[places] = last  # what units have borne, not what would be tried next
        raise NoConvergence(
            f"the residual is {residual.max():.2g}, not {tolerance:.2g}, of the scale after"
            f" {self.max_iterations} iterations"
        )

    def _bear(self, step: tuple[Any, ...], last: np.ndarray) -> np.ndarray:
        """Takes the step on the present guess, or, as long as a unit refuses that, on guesses
        half-way back to one that it has borne. Returns the guess."""
        component, *_ = step
        places = component.places
        for attempt in range(_BACK + 1):
            x = self.guess[places].copy()
            self.last_iterations += 1
            try:
                self._sweep(*step)
                return x
            except UnitError as error:
                if attempt == _BACK or not refused(error):
                    raise
                component.acceleration.forget()
                self._go_back(component)
                self.guess[places] = (x + last) / 2
        raise AssertionError("unreachable")

    def _go_back(self, component: Component) -> None:
        for participant in component.members:
            participant.restore()

    # After a step

    def error(self, end: float, size: float) -> tuple[float, str]:
        """The largest error in time of the last step's paths, and of which input: of connections as
        a share of their scales, of functions of time as one of their ranges."""
        begin = self.history.nodes[-1][0]
        found = [(f.error(begin, end, self.order), f.name) for _, f in self.drives]
        for link in self.links:
            if link.is_mean or not link.is_real or self._stale[link.place].any():
                continue
            error = float(self._path_error(link, end, size).max())
            found.append((error / link.step_scale(self.true), link.connection.target))
        return max(found, default=(0.0, ""))

    def _path_error(self, link: Link, end: float, size: float) -> np.ndarray:
        nodes = [(at, values[link.place]) for at, values in self.history.nodes]
        true = self.true[link.place]
        if self._extrapolated[link.place].any():
            return np.abs(true - waveform.path(nodes[-self.extrapolation - 1 :], end)[0])
        nodes.append((end, true))
        return waveform.interpolation_error(nodes, self.order, end - size, size)

    def mean_error(
        self, link: Link, earlier: waveform.Nodes, end: float, size: float
    ) -> np.ndarray | None:
        """By how much the path that a link's target followed over the last step was off, nearly; of
        extrapolated ones half of what they are off by at the end. None where it is not known.

        earlier: all inputs at the nodes before the step, where the last step has been accepted.
        """
        nodes = [(at, values[link.place]) for at, values in earlier]
        now = self.history.nodes[-1][1][link.place]
        if self._extrapolated[link.place].any():
            error = np.abs(now - waveform.path(nodes[-self.extrapolation - 1 :], end)[0])
            return error * (1.0 if link.is_mean else 0.5)
        if link.is_mean:
            return None
        if not self.order:
            return 0.5 * np.abs(now - nodes[-1][1])
        return waveform.interpolation_error([*nodes, (end, now)], self.order, end - size, size)

    def given(self, end: float, size: float) -> np.ndarray:
        """Means over the last step of what outputs say: of the polynomials through their values,
        or what they are where they are means, or were where they hold over steps."""
        nodes = [*self.history.last(max(self.order, 1)), (end, self.true)]
        means = waveform.mean(*waveform.path(nodes, end - size), size)
        means = np.where(self._whole | self._stale, self.true, means)
        return np.where(self._discrete, self.history.nodes[-1][1], means)

    def accept(self, end: float) -> None:
        """Goes on from the step's end. Iterated paths go on from where they ended, others, and
        whole numbers and the like, from what outputs say."""
        if self._stale.any():  # what was not known at the beginning counts from now on
            first = self.history.nodes[-1]
            first[1][self._stale] = self.guess[self._stale]
            self._stale[:] = False
        self.see(self.true)
        self.inputs[:] = self.true
        for component in self.components:
            if component.iterates:
                places = component.places[component.real]
                self.inputs[places] = self.guess[places]
        self.history.add(end, self.inputs)


def refused(error: Exception) -> bool:
    """True if a shorter step, or a guess nearer to the last values, may succeed."""
    if isinstance(error, FunctionError):
        return error.is_refusal
    return isinstance(error, NoConvergence | UnitError)
