"""Model predictive control by a linear map: the best inputs of a horizon, a quadratic program."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from impinge.errors import ImpingeError, extra, need

from .map import LinearMap


@dataclass(frozen=True, eq=False)
class QuadraticProgram:
    """min ½ uᵀ P u + qᵀ u + c  subject to  lower ≤ A u ≤ upper.

    u are inputs (steps, inputs), one step after another; the first rows of A, the unit matrix, are
    their bounds.
    """

    P: np.ndarray
    q: np.ndarray
    c: float
    A: np.ndarray
    lower: np.ndarray
    upper: np.ndarray


@dataclass(frozen=True, eq=False)
class Plan:
    """Inputs (steps, inputs), the outputs (steps + 1, outputs) that they lead to, what is least,
    and how long it took to find [s]."""

    inputs: np.ndarray
    outputs: np.ndarray
    cost: float
    seconds: float

    def __repr__(self) -> str:
        steps, count = self.inputs.shape
        return (
            f"<impinge.linear.Plan: {steps} steps of {count} inputs,"
            f" {self.outputs.shape[1]} outputs, cost {self.cost:.6g}, {self.seconds * 1e3:.3g} ms>"
        )


def quadratic_program(
    found: LinearMap,
    target: Any,
    *,
    weights: Any = 1.0,
    effort: Any = 0.0,
    changes: Any = 0.0,
    lower: Any = -np.inf,
    upper: Any = np.inf,
    lowest: Any = -np.inf,
    highest: Any = np.inf,
    previous: Any = None,
    free: np.ndarray | None = None,
    steps: int | None = None,
) -> QuadraticProgram:
    """The quadratic program of a horizon, with y by `LinearMap.predict`:

        min Σ_k w (y_k − r_k)² + Σ_k e u_k² + Σ_k m (u_k − u_{k−1})²

    target: r, and lowest, highest: limits of y; numbers, (outputs,) or (steps, outputs) for ends of
    steps 1 …. weights: w, (outputs,) or (steps, outputs). effort, changes: e and m, (inputs,).
    lower, upper: limits of u, (inputs,) or (steps, inputs). previous: u_{−1}, (inputs,); without
    it the first change is free. free: the free response of another state (`free_response`).
    """
    count = found.steps if steps is None else steps
    outputs, inputs = found.direct.shape
    matrix, offset = found.matrices(count)
    if free is not None:
        offset = offset + (np.asarray(free, float) - found.free)[1 : count + 1].ravel()
    wanted = _full(target, count, outputs, "target")
    weight = _full(weights, count, outputs, "weights")
    spent = _full(effort, count, inputs, "effort")
    moved = _full(changes, count, inputs, "changes")
    if min(weight.min(), spent.min(), moved.min()) < 0.0:
        raise ValueError("weights, effort and changes (allowed: not below 0)")
    missed = offset - wanted
    difference = np.eye(count * inputs) - np.eye(count * inputs, k=-inputs)
    before = np.zeros(count * inputs)
    if previous is None:
        difference[:inputs] = 0.0
    else:
        before[:inputs] = np.broadcast_to(np.asarray(previous, float), (inputs,))
    weighted = matrix * weight[:, None]
    turned = difference * moved[:, None]
    square = 2.0 * (weighted.T @ matrix + np.diag(spent) + turned.T @ difference)
    linear = 2.0 * (weighted.T @ missed - turned.T @ before)
    constant = float(weight @ missed**2 + moved @ before**2)
    limits = [(np.eye(count * inputs), _full(lower, count, inputs), _full(upper, count, inputs))]
    low, high = _full(lowest, count, outputs), _full(highest, count, outputs)
    limited = np.isfinite(low) | np.isfinite(high)
    if limited.any():
        limits.append((matrix[limited], (low - offset)[limited], (high - offset)[limited]))
    rows, below, above = (np.concatenate(part) for part in zip(*limits, strict=True))
    if np.any(below > above):
        raise ValueError("a lower limit is above the upper one")
    return QuadraticProgram(square, linear, constant, rows, below, above)


def plan(
    found: LinearMap,
    target: Any,
    *,
    solver: str | None = None,
    free: np.ndarray | None = None,
    steps: int | None = None,
    **terms: Any,
) -> Plan:
    """The inputs that solve the `quadratic_program` of these terms.

    solver: `quadprog` (active sets, exact to rounding: D. Goldfarb, A. Idnani, Math. Program. 27
    (1983), doi 10.1007/BF02591962), `osqp` (many unknowns; to 1e-9) or `scipy` (limits of inputs
    alone); the first that is installed if left out.
    Raises `ImpingeError` where no inputs keep the limits.
    """
    began = time.perf_counter()
    program = quadratic_program(found, target, free=free, steps=steps, **terms)
    solution = _solver(solver, program)(_scaled(program))
    count = len(program.q)
    # Solvers keep limits to rounding; inputs keep them.
    values = np.clip(solution * _scales(program), program.lower[:count], program.upper[:count])
    inputs = values.reshape(-1, len(found.inputs))
    cost = float(0.5 * values @ program.P @ values + program.q @ values + program.c)
    outputs = found.predict(inputs, free=free)
    return Plan(inputs, outputs, cost, time.perf_counter() - began)


def _full(given: Any, steps: int, width: int, name: str = "limits") -> np.ndarray:
    try:
        return np.broadcast_to(np.asarray(given, float), (steps, width)).ravel()
    except ValueError:
        shape = np.shape(given)
        raise ValueError(f"{name} {shape} (allowed: up to ({steps}, {width}))") from None


def _scales(program: QuadraticProgram) -> np.ndarray:
    """Sizes of the unknowns by which the diagonal of P is 1."""
    diagonal = np.diag(program.P)
    return 1.0 / np.sqrt(np.where(diagonal > 0.0, diagonal, 1.0))


def _scaled(program: QuadraticProgram) -> QuadraticProgram:
    """The same in unknowns of like size, and with rows of like size."""
    scale = _scales(program)
    rows = program.A * scale
    size = np.abs(rows).max(axis=1)
    size = np.where(size > 0.0, size, 1.0)
    return QuadraticProgram(
        program.P * scale[:, None] * scale,
        program.q * scale,
        program.c,
        rows / size[:, None],
        program.lower / size,
        program.upper / size,
    )


def _solver(name: str | None, program: QuadraticProgram) -> Callable[..., np.ndarray]:
    if name is not None:
        if name not in _SOLVERS:
            raise ValueError(f"solver {name!r} (allowed: {', '.join(_SOLVERS)})")
        needed = {"osqp": "pip install osqp scipy"}.get(name, extra("control"))
        need(name, needed, f"solver={name!r}")
        return _SOLVERS[name]
    for module, solve in _SOLVERS.items():
        try:
            __import__(module)
        except ModuleNotFoundError:
            continue
        return solve
    raise ImportError(f"a plan needs a solver: {extra('control')}")


def _by_quadprog(program: QuadraticProgram) -> np.ndarray:
    import quadprog

    held = program.lower == program.upper
    low, high = np.isfinite(program.lower) & ~held, np.isfinite(program.upper) & ~held
    rows = np.vstack([program.A[held], program.A[low], -program.A[high]])
    sides = [program.lower[held], program.lower[low], -program.upper[high]]
    # A positive definite P is asked for; rounding is all that this adds.
    square = program.P + 1e-13 * np.trace(program.P) / len(program.P) * np.eye(len(program.P))
    try:
        return quadprog.solve_qp(square, -program.q, rows.T, np.concatenate(sides), held.sum())[0]
    except ValueError as error:
        raise ImpingeError(f"no inputs keep the limits: {error}") from None


def _by_scipy(program: QuadraticProgram) -> np.ndarray:
    from scipy.optimize import lsq_linear

    count = len(program.q)
    if len(program.A) > count:
        raise ImpingeError("limits of outputs (allowed with scipy: limits of inputs alone)")
    values, vectors = np.linalg.eigh(program.P)
    root = np.sqrt(np.maximum(values, 1e-13 * values[-1]))
    matrix, side = root[:, None] * vectors.T, -(vectors.T @ program.q) / root
    bounds = (program.lower / np.diag(program.A), program.upper / np.diag(program.A[:count]))
    found = lsq_linear(matrix, side, bounds, method="bvls", tol=1e-15)
    return found.x


def _by_osqp(program: QuadraticProgram) -> np.ndarray:
    import osqp
    from scipy.sparse import csc_matrix

    solver = osqp.OSQP()
    solver.setup(
        csc_matrix(np.triu(program.P)),
        program.q,
        csc_matrix(program.A),
        np.where(np.isfinite(program.lower), program.lower, -np.inf),
        np.where(np.isfinite(program.upper), program.upper, np.inf),
        eps_abs=1e-9,
        eps_rel=1e-9,
        max_iter=200_000,
        polishing=True,
        verbose=False,
    )
    found = solver.solve()
    if found.info.status not in ("solved", "solved inaccurate"):
        raise ImpingeError(f"no inputs keep the limits: {found.info.status}")
    return found.x


_SOLVERS: dict[str, Callable[[QuadraticProgram], np.ndarray]] = {
    "quadprog": _by_quadprog,
    "osqp": _by_osqp,
    "scipy": _by_scipy,
}
