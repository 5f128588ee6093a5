"""How long steps are: of one length, graded after jumps, or as long as an error allows."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import inf, ulp

from impinge.master.errors import MasterError

SLIVER = 1e-6  # of a step: what is left of the time and shorter is no step of its own


@dataclass(frozen=True)
class Graded:
    """Steps that grow after the start and after jumps: `t_k = over · (k/n)^exponent`.

    n is such that the last of them is as long as the steps that follow. What starts like √t is then
    followed to second order by steps that are all halved together if `exponent` is above 4/3.

    over: time [s] for which steps grow.
    """

    over: float
    exponent: float = 2.0

    def times(self, step: float) -> list[float]:
        """Ends of the graded steps, from the jump."""
        if not (0 < self.over < inf and 1 <= self.exponent < inf):
            raise MasterError(f"{self}: `over` must be above 0 and `exponent` at least 1")
        count = max(1, round(self.exponent * self.over / step))
        return [self.over * (k / count) ** self.exponent for k in range(1, count + 1)]


class Schedule:
    """Ends of steps: jumps, graded starts, and multiples of a step in between.

    With an error estimate, `step` is the first proposal and `propose` the next.
    """

    def __init__(
        self,
        step: float,
        graded: Graded | None,
        jumps: Sequence[float],
        adaptive: bool,
        least: float,
        largest: float,
    ):
        self.step, self.graded, self.adaptive = step, graded, adaptive
        self.least, self.largest = least, largest
        self.jumps = sorted(jumps)
        self._begin = 0.0
        self._count = 0  # steps of one length since the graded ones
        self._ends: list[float] = []
        self._size = step

    def restart(self, time: float) -> None:
        """Begins anew after a jump."""
        self._begin, self._count = time, 0
        graded = self.graded.times(self.step) if self.graded and not self.adaptive else []
        self._ends = [time + each for each in graded]
        if graded:
            self._begin = self._ends[-1]
        if self.adaptive:
            self._size = self.step

    def limit(self, time: float, stop: float) -> float:
        """The next jump, or the stop."""
        return min([stop, *(jump for jump in self.jumps if jump > time)])

    def end_of_step(self, time: float, stop: float) -> float:
        """When the step from `time` on ends."""
        length = min(self._size, self.largest) if self.adaptive else self.step
        if length < 64 * ulp(time):  # times can tell such steps apart no more
            raise MasterError(f"a step of {length:.3g} s is lost in rounding at {time:.6g} s")
        limit = self.limit(time, stop)
        if self.adaptive:
            rest = limit - time
            size = min(self._size, self.largest)
            if rest <= size * (1 + 1e-9):
                return limit
            return time + (rest / 2 if rest < 2 * size else size)
        while self._ends and self._ends[0] <= time:
            self._ends.pop(0)
        if self._ends:
            end = self._ends[0]
        else:
            end = self._begin + self.step * (self._count + 1)
            while end <= time + 1e-14 * abs(time):
                self._count += 1
                end = self._begin + self.step * (self._count + 1)
        return limit if end > limit - SLIVER * self.step else end

    def propose(self, size: float, error: float, order: int, is_accepted: bool) -> None:
        """The next length from an error in shares of what is allowed, that grows as
        `size^(order + 1)`."""
        factor = 0.9 * max(error, 1e-12) ** (-1 / (order + 1))
        most = 2.5 if is_accepted else 0.7
        self._size = min(size * min(max(factor, 0.2), most), self.largest)

    def shrink(self, size: float) -> None:
        """Halves a step that could not be taken."""
        self._size = size / 2
