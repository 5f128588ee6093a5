"""What a parameter of a study may be: one value, levels, or a range with a density."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from numbers import Real
from statistics import NormalDist
from typing import Any

import numpy as np


@dataclass(frozen=True)
class Levels:
    """Values that are all equally likely: numbers, or texts of a scene."""

    values: tuple[Any, ...]

    def __post_init__(self) -> None:
        if not self.values:
            raise ValueError("no values (allowed: at least one)")
        own = (v.item() if isinstance(v, np.generic) else v for v in self.values)
        object.__setattr__(self, "values", tuple(own))

    def quantile(self, probability: np.ndarray) -> np.ndarray:
        """Values as they are, whatever others are among them."""
        index = np.minimum((probability * len(self.values)).astype(int), len(self.values) - 1)
        return np.array(self.values, object)[index]

    def levels(self, _count: int) -> Sequence[Any]:
        return self.values


@dataclass(frozen=True)
class Uniform:
    """Uniform from `low` to `high`."""

    low: float
    high: float

    def __post_init__(self) -> None:
        _check_order(self.low, self.high)

    def quantile(self, probability: np.ndarray) -> np.ndarray:
        return self.low + (self.high - self.low) * probability

    def levels(self, count: int) -> Sequence[float]:
        return np.linspace(self.low, self.high, count).tolist()


@dataclass(frozen=True)
class LogUniform:
    """Uniform in the logarithm from `low` to `high`, both above zero."""

    low: float
    high: float

    def __post_init__(self) -> None:
        _check_order(self.low, self.high)
        if self.low <= 0.0:
            raise ValueError(f"{self.low} has no logarithm (allowed: a range above 0)")

    def quantile(self, probability: np.ndarray) -> np.ndarray:
        return self.low * (self.high / self.low) ** probability

    def levels(self, count: int) -> Sequence[float]:
        return np.geomspace(self.low, self.high, count).tolist()


@dataclass(frozen=True)
class Normal:
    """Normal about `mean`; `widest` standard deviations from it the tails are cut."""

    mean: float
    deviation: float
    widest: float = 4.0

    def __post_init__(self) -> None:
        if not (self.deviation > 0.0 and self.widest > 0.0 and math.isfinite(self.mean)):
            raise ValueError(f"{self} (allowed: a finite mean, a deviation and a width above 0)")

    def quantile(self, probability: np.ndarray) -> np.ndarray:
        normal = NormalDist()
        tail = normal.cdf(-self.widest)
        inner = tail + (1.0 - 2.0 * tail) * np.asarray(probability, float)
        unit = np.array([normal.inv_cdf(p) for p in inner.ravel()]).reshape(inner.shape)
        return self.mean + self.deviation * unit

    def levels(self, count: int) -> Sequence[float]:
        return self.quantile((np.arange(count) + 0.5) / count).tolist()


Distribution = Levels | Uniform | LogUniform | Normal


def distribution_of(name: str, given: Any) -> Distribution:
    """What `given` means: a pair of numbers is a range, a list or an array are levels, a single
    value is held."""
    try:
        if isinstance(given, Distribution):
            return given
        if isinstance(given, tuple) and len(given) == 2 and all(map(_is_number, given)):
            return Uniform(float(given[0]), float(given[1]))
        if isinstance(given, list | tuple | np.ndarray | range):
            return Levels(tuple(_plain(value) for value in given))
        return Levels((_plain(given),))
    except ValueError as error:
        raise ValueError(f"parameter {name}: {error}") from None


def is_held(distribution: Distribution) -> bool:
    """Whether the parameter is the same in all rows."""
    return isinstance(distribution, Levels) and len(distribution.values) == 1


def _plain(value: Any) -> Any:
    """A value of Python's own types, so that equal values have equal hashes on any machine."""
    if isinstance(value, np.generic):
        value = value.item()
    if isinstance(value, bool | int | str):
        return value
    if isinstance(value, Real) and math.isfinite(value):
        return float(value)
    raise ValueError(f"{value!r} (allowed: finite numbers, texts, truth values)")


def _is_number(value: Any) -> bool:
    return isinstance(value, Real) and not isinstance(value, bool)


def _check_order(low: float, high: float) -> None:
    if not (math.isfinite(low) and math.isfinite(high) and low < high):
        raise ValueError(f"{low} to {high} (allowed: a finite range that grows)")
