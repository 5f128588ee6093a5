"""Values over time."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .errors import SurfaceError


@dataclass(frozen=True, eq=False)
class Series:
    """Values at `times` [s], shape (n,), ascending: an array of shape (n, …), linear between."""

    times: np.ndarray
    values: np.ndarray

    def __post_init__(self) -> None:
        times, values = np.asarray(self.times, float), np.asarray(self.values, float)
        if times.ndim != 1 or not len(times) or values.shape[:1] != times.shape:
            raise SurfaceError(f"series: {times.shape} times for values of shape {values.shape}")
        if not np.isfinite(times).all() or not (np.diff(times) > 0).all():
            at = int(np.flatnonzero(~(np.diff(times) > 0))[0]) if len(times) > 1 else 0
            raise SurfaceError(
                f"series: time {times[min(at + 1, len(times) - 1)]} s does not ascend"
            )
        object.__setattr__(self, "times", times)
        object.__setattr__(self, "values", values)

    def __len__(self) -> int:
        return len(self.times)

    def __call__(self, time: float) -> np.ndarray:
        """Values at a time [s], linear between those of the series.

        Raises
        ------
        SurfaceError
            If the time is not within the series.
        """
        self._check(time)
        right = int(np.clip(np.searchsorted(self.times, time), 1, max(len(self.times) - 1, 1)))
        if len(self.times) == 1:
            return self.values[0]
        begin, end = self.times[right - 1], self.times[right]
        share = (time - begin) / (end - begin)
        return (1 - share) * self.values[right - 1] + share * self.values[right]

    def integral(self, begin: float, end: float) -> np.ndarray:
        """``∫ v dt`` from `begin` to `end` [s], exact for what is linear between the times."""
        if end < begin:
            return -self.integral(end, begin)
        self._check(begin)
        self._check(end)
        within = self.times[(self.times > begin) & (self.times < end)]
        times = np.concatenate([[begin], within, [end]])
        values = np.stack([self(time) for time in times])
        return np.tensordot(np.diff(times), 0.5 * (values[1:] + values[:-1]), axes=1)

    def mean(self, begin: float, end: float) -> np.ndarray:
        """Mean from `begin` to `end` [s]: what a step of that length takes in."""
        return self(begin) if end == begin else self.integral(begin, end) / (end - begin)

    def means(self, times: np.ndarray) -> Series:
        """Means over the intervals between `times` [s], each at its beginning; one less than
        times.
        """
        times = np.asarray(times, float)
        values = [self.mean(a, b) for a, b in zip(times, times[1:], strict=False)]
        return Series(times[:-1], np.array(values))

    def _check(self, time: float) -> None:
        if not self.times[0] <= time <= self.times[-1]:
            raise SurfaceError(
                f"{time} s is not within the series from {self.times[0]} to {self.times[-1]} s"
            )
