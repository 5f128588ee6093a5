"""How well rings of units are resolved by steps, judged by what came of these."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from math import floor, log10, nan

import numpy as np

from impinge.master.any_unit import AnyUnit
from impinge.master.connection import Link
from impinge.master.energy import Balance
from impinge.master.graph import unit_components

MOST = 0.1  # of a link's range: the mean error of paths above which a run is warned of
_FEWEST = 3  # steps that say something
_NOISE = 1e-9  # of magnitudes: what rings at rest show; or iterations leave, times their tolerance
_LEFT = 10
_SETTLED = (0.1, 1e-3)  # factors of what is at rest after one iterated step: held paths, others
_EARLY = 5  # steps after a jump, or the start, that follow it
_CALM = 1 / 3  # change of a step that is known to be within `MOST`, of what is left of a change


@dataclass
class Course:
    """What one link has passed on so far.

    `error` is the mean error of its paths over steps, each weighted by itself, as a share of the
    range of its values: `Σ e² / (r Σ e)`. A mode that changes by the factor λ a step, held over
    steps, has `e = |1 − λ| |λ|ⁿ / 2` and so `error = (1 − λ)/(1 + λ)/2` where it decays and
    `1/(1 + |λ|)/2` where it jumps to and fro; `factor` is the λ that consecutive changes show.
    After n steps such a mode has come `1 − λⁿ` of its way, and the share is of the whole of it: a
    run that ends early is not off by more for that.
    """

    link: Link
    low: np.ndarray
    high: np.ndarray
    first: float = 0.0
    second: float = 0.0
    early: float = 0.0
    since_jump: int = 0
    steps: int = 0
    last: float = 0.0
    change: np.ndarray | None = None
    like: float = 0.0
    square: float = 0.0
    noise: float = _NOISE

    @property
    def range(self) -> float:
        return float((self.high - self.low).max())

    @property
    def change_share(self) -> float:
        """The range over the largest value."""
        return self.range / self.link.largest if self.link.largest else 0.0

    @property
    def is_at_rest(self) -> bool:
        return self.range <= self.noise * self.link.largest

    @property
    def error(self) -> float:
        if self.steps < _FEWEST or self.is_at_rest or not self.first:
            return 0.0
        way = 1.0 - self.factor**self.steps if 0.0 < self.factor < 1.0 else 1.0
        return way * self.second / self.first / self.range

    @property
    def factor(self) -> float:
        return self.like / self.square if self.square else 0.0

    @property
    def follows_jumps(self) -> bool:
        """True if most of the error arises in the steps after the start and jumps."""
        return self.steps > 2 * _EARLY and self.early > 0.5 * self.second

    def forget_change(self) -> None:
        """Called after a jump: changes across it say nothing of the ring."""
        self.change = None
        self.since_jump = 0

    def add(self, before: np.ndarray, after: np.ndarray, error: np.ndarray | None) -> None:
        """A step that was accepted: all inputs at its ends, and how far the link's path was off."""
        before, after = before[self.link.place], after[self.link.place]
        self.low = np.minimum(self.low, after)
        self.high = np.maximum(self.high, after)
        change = after - before
        with np.errstate(over="ignore"):  # what grows without end has said what it has to
            if self.change is not None:
                self.like += float(change @ self.change)
                self.square += float(self.change @ self.change)
            if error is not None:
                self.first += float(error.sum())
                self.second += float(error @ error)
                if self.since_jump < _EARLY:
                    self.early += float(error @ error)
                self.since_jump += 1
                self.last = float(error.max(initial=0.0))
                self.steps += 1
        self.change = change


class Watch:
    """The courses of all links within rings of units; others cannot feed back what they err by."""

    def __init__(
        self,
        units: Mapping[str, AnyUnit],
        links: Sequence[Link],
        loops: Sequence[Sequence[Link]],
        scheme: str,
        tolerance: float,
    ):
        """`loops` are algebraic: what these pass on is solved for at the ends of steps."""
        solved = {id(link) for loop in loops for link in loop}
        inner = [link for link in links if link.is_real and id(link) not in solved]
        self._units = units
        self._links = _in_rings(units, inner)
        self._scheme = scheme
        self._noise = max(_NOISE, _LEFT * tolerance if scheme == "iterate" else 0.0)
        self.courses: list[Course] = []

    def begin(self, inputs: np.ndarray) -> None:
        """Called at the start of the run."""
        for link in self._links:
            values = inputs[link.place]
            self.courses.append(Course(link, values.copy(), values.copy(), noise=self._noise))

    def jump(self) -> None:
        """Called where inputs jump."""
        for course in self.courses:
            course.forget_change()

    @property
    def worst(self) -> Course | None:
        """The course whose paths were off most, of rings in which all that is passed on moves."""
        moving = {id(c.link): c for c in self.courses if not c.is_at_rest}
        links = [course.link for course in moving.values()]
        rings = [moving[id(link)] for link in _in_rings(self._units, links)]
        return max(rings, key=lambda course: course.error, default=None)

    def error(self, steps: int) -> float:
        """Of the worst course, zero where nothing feeds back; no number after too few `steps`."""
        if steps < _FEWEST and self.courses:
            return nan
        worst = self.worst
        return 0.0 if worst is None else worst.error

    def warning(self, step: float, order: int, is_graded: bool = False) -> str:
        """Return what to say of steps that are too long, with a remedy; nothing if they are not.

        order: degree of the paths, whose error grows as its successor. After a jump it does not,
        and steps that are shorter there alone do more (`is_graded`: they already are).
        """
        worst = self.worst
        if worst is None or worst.error <= MOST:
            return ""
        factor = worst.factor
        if self._scheme == "iterate" and abs(factor) < _SETTLED[order > 0]:
            return ""
        share = min((MOST / worst.error) ** (1 / (order + 1)), _CALM / max(1 - factor, _CALM))
        if abs(factor) > 1:
            shown = (
                f"values change {abs(factor):.2g} times as much in every step: this is not stable"
            )
        elif factor < 0:
            shown = "values jump to and fro from step to step"
        else:
            shown = f"a change shrinks to {factor:.2g} of itself in every step"
        wanted = f"steps of {_rounded(step * share)} s or less"
        if self._scheme != "iterate":
            wanted += ', or scheme="iterate" with some between,'
        after_jumps = ""
        if worst.follows_jumps and not is_graded:
            after_jumps = (
                "; most of it comes right after the start or a jump, where it may fall more slowly"
                f" than the step: graded=Graded({step:.3g}, 4) takes shorter steps there alone"
            )
        link = worst.link.connection
        return (
            f"{link.source} -> {link.target}: what is passed on over steps of {step:.6g} s is off"
            f" by {100 * worst.error:.0f} % of its range on its way, above {100 * MOST:.0f} %, and"
            f" by {100 * worst.last / worst.range:.2g} % in the last step; {shown}; {wanted} are"
            f" needed{after_jumps}"
        )

    def warning_of_energy(self, balances: Sequence[Balance], step: float, order: int) -> str:
        """What to say of energy that units which swing together gain or lose between them, with a
        step that would do; nothing if that is little.

        Held forces and velocities bring `(ωH)²` of the energy of a swing in every step, however
        close to the truth each path is.
        """
        worst = max(balances, key=lambda balance: balance.share, default=None)
        if worst is None or worst.share <= MOST:
            return ""
        share = (MOST / worst.share) ** (1 / (order + 1))
        wanted = f"steps of {_rounded(step * share)} s or less"
        if self._scheme != "iterate":
            wanted += ', or scheme="iterate",'
        return (
            f"{worst.name}: {worst.largest:.2g} {worst.unit} are gained or lost on the way,"
            f" {100 * worst.share:.0f} % of what swings between the units, above"
            f" {100 * MOST:.0f} %: what one gives the other does not get; {wanted} are needed"
        )

    def warning_of_few(self, steps: int) -> str:
        """What to say of a run of too few steps to be judged in which much has changed."""
        # Held over steps, a mode is off by half of what it changes by in each.
        moving = [
            course
            for course in self.courses
            if not course.is_at_rest
            and course.change_share > MOST
            and course.factor < 1.0 - 2.0 * MOST
        ]
        if steps >= _FEWEST or not moving:
            return ""
        most = max(moving, key=lambda course: course.change_share)
        link = most.link.connection
        return (
            f"{link.source} -> {link.target}: {steps} step{'s' if steps > 1 else ''} cannot tell"
            f" whether what is passed on, which changed by {100 * most.change_share:.0f} % of its"
            f" largest value, is resolved: {_FEWEST} steps or more are needed"
        )


def _rounded(step: float) -> str:
    """To one digit, downward."""
    digit = 10.0 ** floor(log10(step))
    return f"{floor(step / digit) * digit:.1g}"


def _in_rings(units: Mapping[str, AnyUnit], links: Sequence[Link]) -> list[Link]:
    """Those of the links that lead back to where they come from, by way of the others."""
    place = {name: i for i, group in enumerate(unit_components(units, links)) for name in group}
    return [link for link in links if place[link.source_unit] == place[link.target_unit]]
