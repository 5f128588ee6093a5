"""Samplers: which rows a study has."""

from __future__ import annotations

import itertools
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Protocol

import numpy as np

from impinge.errors import extra, need

from .distributions import Distribution, Levels, is_held


@dataclass(frozen=True)
class Design:
    """The rows of a study.

    `rows[i]` are the values of row i by parameter. `dimensions` are the axes of the table: one per
    parameter that varies for a grid, one of all rows elsewhere; their lengths multiply to the
    number of rows, the last index runs fastest.
    """

    rows: list[dict[str, Any]]
    dimensions: dict[str, int]


class Sampler(Protocol):
    """Makes rows of distributions."""

    def design(self, parameters: Mapping[str, Distribution]) -> Design: ...


@dataclass(frozen=True)
class Grid:
    """All combinations; ranges are cut into `levels`, ends included, lists taken as they are."""

    levels: int = 5

    def design(self, parameters: Mapping[str, Distribution]) -> Design:
        _check_count("levels", self.levels, 2)
        axes = {name: list(d.levels(self.levels)) for name, d in parameters.items()}
        rows = [dict(zip(axes, row, strict=True)) for row in itertools.product(*axes.values())]
        varying = {n: len(axes[n]) for n, d in parameters.items() if not is_held(d)}
        return Design(rows, varying or {"row": 1})


@dataclass(frozen=True)
class Paired:
    """Row i takes value i of every list; single values are held."""

    def design(self, parameters: Mapping[str, Distribution]) -> Design:
        lists = {}
        for name, distribution in parameters.items():
            if not isinstance(distribution, Levels):
                raise ValueError(f"parameter {name}: {distribution} (allowed with Paired: lists)")
            lists[name] = distribution.values
        counts = {name: len(values) for name, values in lists.items() if len(values) > 1}
        if len(set(counts.values())) > 1:
            raise ValueError(f"lists of unlike lengths {counts} (allowed with Paired: one length)")
        count = max(counts.values(), default=1)
        full = {n: values * count if len(values) == 1 else values for n, values in lists.items()}
        rows = [{name: values[i] for name, values in full.items()} for i in range(count)]
        return Design(rows, {"row": count})


@dataclass(frozen=True)
class LatinHypercube:
    """`samples` rows of which every one of as many slices of each parameter has one.

    M. D. McKay, R. J. Beckman, W. J. Conover, Technometrics 21 (1979), doi 10.2307/1268522.
    """

    samples: int
    seed: int = 0

    def design(self, parameters: Mapping[str, Distribution]) -> Design:
        _check_count("samples", self.samples, 1)
        random = np.random.default_rng(self.seed)
        columns = {}
        for name in parameters:
            slices = random.permutation(self.samples)
            columns[name] = (slices + random.random(self.samples)) / self.samples
        return _rows(columns, parameters, self.samples)


@dataclass(frozen=True)
class Sobol:
    """Saltelli's rows for Sobol's indices: `samples` times the number of parameters that vary and
    two, or twice that number and two with `second_order`; `samples` is a power of two.

    A. Saltelli et al., Comput. Phys. Commun. 181 (2010), doi 10.1016/j.cpc.2009.09.018.
    """

    samples: int
    seed: int = 0
    second_order: bool = False

    def design(self, parameters: Mapping[str, Distribution]) -> Design:
        sobol = need("SALib.sample.sobol", extra("study"), "Sobol")

        _check_count("samples", self.samples, 2)
        if self.samples & (self.samples - 1):
            raise ValueError(f"samples = {self.samples} (allowed: powers of two)")
        varying = [name for name, d in parameters.items() if not is_held(d)]
        if not varying:
            raise ValueError("no parameter varies (allowed: at least one range or list)")
        problem = unit_problem(varying)
        points = sobol.sample(
            problem, self.samples, calc_second_order=self.second_order, seed=self.seed
        )
        columns = dict(zip(varying, points.T, strict=True))
        held = {name: np.zeros(len(points)) for name in parameters if name not in columns}
        return _rows(columns | held, parameters, len(points))


def unit_problem(names: list[str]) -> dict[str, Any]:
    """SALib's description of parameters that all go from 0 to 1."""
    return {"num_vars": len(names), "names": names, "bounds": [[0.0, 1.0]] * len(names)}


def _rows(
    columns: Mapping[str, np.ndarray], parameters: Mapping[str, Distribution], count: int
) -> Design:
    values = {name: d.quantile(columns[name]).tolist() for name, d in parameters.items()}
    return Design([{n: v[i] for n, v in values.items()} for i in range(count)], {"row": count})


def _check_count(name: str, value: int, least: int) -> None:
    if value < least:
        raise ValueError(f"{name} = {value} (allowed: at least {least})")
