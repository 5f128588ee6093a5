"""Sobol's indices: how much of an output's variance each parameter governs."""

from __future__ import annotations

import warnings
from collections.abc import Sequence

import numpy as np
import xarray as xr

from impinge.errors import extra, need
from impinge.results import words

from .sampling import unit_problem


def sobol_indices(
    results: xr.Dataset,
    outputs: Sequence[str] | None = None,
    *,
    confidence: float = 0.95,
    resamples: int = 200,
    seed: int = 0,
) -> xr.Dataset:
    """First and total indices of the outputs of a study with the sampler `Sobol`.

        S_i = V[E(y | x_i)] / V(y),    T_i = E[V(y | all but x_i)] / V(y)

    Variables `first`, `total` and the half widths of their confidence intervals `first_confidence`
    and `total_confidence`, dims (output, parameter), no unit; `second` (output, parameter,
    parameter_2) where the study has rows for it. Outputs that are arrays have indices for every
    element, called `name[i]`, counted from 1. Blocks of rows that belong together are left out,
    with a warning, where one of them failed.

    I. M. Sobol', Math. Comput. Simul. 55 (2001), doi 10.1016/S0378-4754(00)00270-6;
    A. Saltelli et al., Comput. Phys. Commun. 181 (2010), doi 10.1016/j.cpc.2009.09.018.
    """
    sobol = need("SALib.analyze.sobol", extra("study"), "sobol_indices")

    if results.attrs.get("sampler_kind") != "Sobol":
        kind = results.attrs.get("sampler_kind", "no sampler")
        raise ValueError(f"a study with {kind} (allowed: the sampler Sobol)")
    parameters = words(results.attrs["varying"])
    has_second = bool(results.attrs["second_order"])
    length = (2 * len(parameters) + 2) if has_second else len(parameters) + 2
    whole = _whole_blocks(results, length)
    series = _series(results, outputs or words(results.attrs["outputs"]))
    names = list(series)
    shape = (len(names), len(parameters))
    found = {key: np.full(shape, np.nan) for key in ("S1", "S1_conf", "ST", "ST_conf")}
    second = np.full((*shape, len(parameters)), np.nan)
    for number, values in enumerate(series.values()):
        values = values[whole]
        if np.ptp(values) == 0.0:
            warnings.warn(f"{names[number]} is the same in all rows", stacklevel=2)
            continue
        answer = sobol.analyze(
            unit_problem(parameters),
            values,
            calc_second_order=has_second,
            num_resamples=resamples,
            conf_level=confidence,
            seed=seed + 1,  # SALib takes 0 for none
        )
        for key, array in found.items():
            array[number] = answer[key]
        if has_second:
            second[number] = answer["S2"]
    dims = ("output", "parameter")
    data: dict[str, tuple[tuple[str, ...], np.ndarray]] = {
        "first": (dims, found["S1"]),
        "first_confidence": (dims, found["S1_conf"]),
        "total": (dims, found["ST"]),
        "total_confidence": (dims, found["ST_conf"]),
    }
    if has_second:
        data["second"] = ((*dims, "parameter_2"), second)
    coordinates = {"output": names, "parameter": parameters}
    if has_second:
        coordinates["parameter_2"] = parameters
    attributes = {"confidence": confidence, "resamples": resamples, "blocks": whole.sum() // length}
    return xr.Dataset(data, coordinates, attributes)


def _whole_blocks(results: xr.Dataset, length: int) -> np.ndarray:
    """Marks rows of blocks in which no row failed."""
    is_there = (results["status"].values == 0).reshape(-1, length)
    whole = is_there.all(axis=1)
    if not whole.all():
        lost = int((~whole).sum())
        warnings.warn(f"{lost} of {len(whole)} blocks have failed rows", stacklevel=3)
    if whole.sum() < 2:
        raise ValueError(f"{whole.sum()} blocks without failed rows (allowed: at least 2)")
    return np.repeat(whole, length)


def _series(results: xr.Dataset, outputs: Sequence[str]) -> dict[str, np.ndarray]:
    """Values of all rows by output, element by element of arrays."""
    series = {}
    for name in outputs:
        values = results[name].transpose("row", ...).values
        if values.ndim == 1:
            series[name] = values
            continue
        for place in np.ndindex(values.shape[1:]):
            series[f"{name}[{','.join(str(i + 1) for i in place)}]"] = values[(slice(None), *place)]
    return series
