"""Functions of time that jump: their values on both sides of a time, and where they jump."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

_NEAR = 1e-9  # of a step: how far before and after a time "just before" and "just after" are
_SHARE = 1e-6  # of all that a function has shown: what counts as a jump
_STEEP = 0.1  # of the same: by how much a function may leave the path of its input without a word
_MOST = 64  # jumps that are looked for within one step
_KNOWN = 64  # values that are kept
_SHARES = (0.25, 0.5, 0.75)  # of a step: where a path is compared with its function
# Weights of a path's first, middle and last value at these, by degree in time.
_WEIGHTS = (
    ((0.0, 0.0, 1.0),) * 3,
    ((0.75, 0.0, 0.25), (0.5, 0.0, 0.5), (0.25, 0.0, 0.75)),
    ((0.375, 0.75, -0.125), (0.0, 1.0, 0.0), (-0.125, 0.75, 0.375)),
)


class Watched:
    """A function u of time [s] whose values are read one-sided.

    Over a step from t to t + H, inputs follow the parabola through u(t⁺), u(t + H/2) and
    u((t + H)⁻). What u is a quarter and three quarters of the way tells whether it does, too: where
    it does not, the half that is bent more is halved until nothing is bent any more, as in smooth
    functions, or what is left is a jump. A pulse that lies between these places goes unseen.

    Raises `ValueError` for values that are not finite.
    """

    def __init__(self, name: str, function: Callable[[float], Any], *, is_constant: bool = False):
        self.name, self.function, self.is_constant = name, function, is_constant
        self._low: np.ndarray | None = None
        self._high: np.ndarray | None = None
        self._known: dict[float, np.ndarray] = {}  # values that the same step asks for again
        self.range = self.rounding = self.tolerance = 0.0

    def __call__(self, time: float) -> np.ndarray:
        """The flat value at a time."""
        known = self._known.get(time)
        if known is not None:
            return known
        value = np.array(self.function(float(time)), float).ravel()
        if not np.isfinite(value).all():
            raise ValueError(f"input {self.name} is not finite at {time:.9g} s")
        if self._low is None or self._high is None:
            self._widen(value, value)
        elif (value < self._low).any() or (value > self._high).any():
            self._widen(np.minimum(self._low, value), np.maximum(self._high, value))
        if len(self._known) >= _KNOWN:
            self._known.clear()
        self._known[time] = value
        return value

    def _widen(self, low: np.ndarray, high: np.ndarray) -> None:
        """Takes in what the function has shown: `range`, how far apart values are, the largest of
        all elements, and `tolerance`, the least change that is a jump, above what `rounding` makes.
        """
        self._low, self._high = low, high
        self.range = float((high - low).max(initial=0.0))
        largest = float(max(np.abs(low).max(initial=0.0), np.abs(high).max(initial=0.0)))
        self.rounding = 1e-13 * largest
        self.tolerance = _SHARE * self.range + self.rounding

    def look(self, begin: float, end: float) -> None:
        """Takes values over a step, so that what is a jump is known from the first one on."""
        if self.is_constant:
            return
        for share in (0.0, 0.25, 0.5, 0.75, 1.0):
            self(begin + share * (end - begin))

    def before(self, time: float, size: float) -> np.ndarray:
        """u(t⁻), where a step of `size` [s] ends."""
        return self._beside(time, -near(time, size))

    def after(self, time: float, size: float) -> np.ndarray:
        """u(t⁺), where a step of `size` [s] begins."""
        return self._beside(time, near(time, size))

    def _beside(self, time: float, distance: float) -> np.ndarray:
        if self.is_constant:
            return self(time)
        at, beside = self(time), self(time + distance)
        return at if _change(at, beside) <= self.tolerance else beside

    def misfit(self, begin: float, end: float, order: int = 2) -> float:
        """Returns how far u is from its path at a quarter, the half and three quarters of a step.

        order: degree of the path in time: the value at the end, the chord, or the parabola.
        """
        size = end - begin
        first, last = self.after(begin, size), self.before(end, size)
        inner = [self(begin + share * size) for share in _SHARES]
        paths = (a * first + b * inner[1] + c * last for a, b, c in _WEIGHTS[order])
        return max(_change(value, path) for value, path in zip(inner, paths, strict=True))

    def error(self, begin: float, end: float, order: int) -> float:
        """The misfit above rounding as a share of the range of all that u has shown."""
        if self.is_constant or not self.range:
            return 0.0
        return max(self.misfit(begin, end, order) - self.rounding, 0.0) / self.range

    def jumps(self, begin: float, end: float) -> list[float]:
        """Times within a step just after which u is another than just before, ascending."""
        found: list[float] = []
        open_parts = [] if self.is_constant else [(begin, end)]
        apart = near(end, end - begin)
        while open_parts and len(found) < _MOST:
            first, last = open_parts.pop()
            if last - first <= 4 * apart or self.misfit(first, last) <= self.tolerance:
                continue
            time = self._find(first + apart, last - apart, apart / 1000)
            if time is not None:
                found.append(time)
                open_parts += [(first, time), (time, last)]
        return sorted(found)

    def _find(self, left: float, right: float, least: float) -> float | None:
        middle = (left + right) / 2
        u_left, u_middle, u_right = self(left), self(middle), self(right)
        while right - left > max(least, 4 * np.spacing(abs(right))):
            early, late = (left + middle) / 2, (middle + right) / 2
            u_early, u_late = self(early), self(late)
            bent_early = _change(2 * u_early, u_left + u_middle) / 2
            bent_late = _change(2 * u_late, u_middle + u_right) / 2
            if max(bent_early, bent_late) < self.tolerance / 4:
                return None
            if bent_early >= bent_late:
                right, u_right, middle, u_middle = middle, u_middle, early, u_early
            else:
                left, u_left, middle, u_middle = middle, u_middle, late, u_late
        return right if _change(u_left, u_right) > self.tolerance else None

    def mean(self, begin: float, end: float) -> np.ndarray:
        """The mean over a step: by Simpson's rule between jumps."""
        knots = [begin, *self.jumps(begin, end), end]
        total = np.zeros_like(self(begin))
        for first, last in zip(knots[:-1], knots[1:], strict=True):
            size = last - first
            values = self.after(first, size) + self.before(last, size)
            total += size / 6 * (values + 4 * self((first + last) / 2))
        return total / (end - begin)

    def is_steep(self, begin: float, end: float, order: int = 2) -> bool:
        """Returns True if u leaves its path by more than a tenth of the range that it has had."""
        if self.is_constant:
            return False
        return self.misfit(begin, end, order) > _STEEP * self.range + self.tolerance


def near(time: float, size: float) -> float:
    """Distance [s] of "just before" and "just after" from a time, for steps of `size` [s]."""
    return max(_NEAR * size, 8 * float(np.spacing(abs(time))))


def _change(one: np.ndarray, other: np.ndarray) -> float:
    return float(np.abs(one - other).max()) if one.size else 0.0
