"""State-space models whose responses are those of a linear map."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from impinge.errors import ImpingeError, extra, need

if TYPE_CHECKING:
    from .map import LinearMap


class NotRealised(ImpingeError):
    """No model of the orders that the horizon allows is good enough; `error` is the best one's."""

    def __init__(self, what: str, error: float):
        super().__init__(what)
        self.error = error


@dataclass(frozen=True, eq=False)
class StateSpace:
    """x_{k+1} = A x_k + B v_k,  w_k = C x_k + D v_k, from x_0 = 0.

    v = u − u_b are changes of the inputs from the map's base, held over a step, w = y − f those of
    outputs from the free response, read under the inputs of their time. A (n, n), B (n, inputs),
    C (outputs, n), D (outputs, inputs); `step` in s.

    As f starts from the unit's present state, x_0 is zero wherever a controller begins: with f from
    `LinearMap.free_response` as a time-varying parameter, in do-mpc for instance

        model = do_mpc.model.Model("discrete")
        x = model.set_variable("_x", "x", shape=(space.order, 1))
        v = model.set_variable("_u", "v", shape=(len(space.inputs), 1))
        f = model.set_variable("_tvp", "f", shape=(len(space.outputs), 1))
        model.set_rhs("x", casadi.DM(space.A) @ x + casadi.DM(space.B) @ v)
        model.set_expression("y", casadi.DM(space.C) @ x + f)

    error: the largest error of any output under any inputs within ± `changes` of the map over its
    horizon, relative to the largest response that such inputs make.
    hankel: the Hankel singular values, of scaled inputs and outputs.
    """

    A: np.ndarray
    B: np.ndarray
    C: np.ndarray
    D: np.ndarray
    step: float
    inputs: tuple[str, ...]
    outputs: tuple[str, ...]
    error: float
    hankel: np.ndarray

    def __repr__(self) -> str:
        return (
            f"<impinge.linear.StateSpace of {named(self.inputs)} to {named(self.outputs)}:"
            f" {self.order} states, step {self.step:g} s, error {self.error:.1e}>"
        )

    @property
    def order(self) -> int:
        """The number of states."""
        return len(self.A)

    @property
    def spectral_radius(self) -> float:
        """The largest magnitude of an eigenvalue: below 1 where changes die out."""
        return float(np.abs(np.linalg.eigvals(self.A)).max())

    def responses(self, steps: int) -> np.ndarray:
        """C A^{k−1} B for k = 1 … steps, shape (steps, outputs, inputs)."""
        rows = np.empty((steps, len(self.C), self.B.shape[1]))
        state = self.B
        for number in range(steps):
            rows[number] = self.C @ state
            state = self.A @ state
        return rows

    def simulate(self, changes: np.ndarray) -> np.ndarray:
        """w (n, outputs) at the beginnings of steps under v (n, inputs)."""
        state = np.zeros(self.order)
        rows = np.empty((len(changes), len(self.C)))
        for number, change in enumerate(changes):
            rows[number] = self.C @ state + self.D @ change
            state = self.A @ state + self.B @ change
        return rows

    def to_control(self) -> Any:
        """As `control.StateSpace` of python-control, with names and step."""
        control = need("control", extra("control"), "to_control()")
        return control.ss(
            self.A,
            self.B,
            self.C,
            self.D,
            self.step,
            inputs=[_plain(name) for name in self.inputs],
            outputs=[_plain(name) for name in self.outputs],
        )

    def to_casadi(self) -> Any:
        """As a CasADi function (x, v) to (the next x, w)."""
        casadi = need("casadi", "pip install casadi", "to_casadi()")
        state = casadi.SX.sym("x", self.order)
        change = casadi.SX.sym("v", len(self.inputs))
        a, b, c, d = (casadi.DM(m) for m in (self.A, self.B, self.C, self.D))
        return casadi.Function(
            "step",
            [state, change],
            [a @ state + b @ change, c @ state + d @ change],
            ["x", "v"],
            ["next", "w"],
        )


def realise(found: LinearMap, tolerance: float, order: int | None = None) -> StateSpace:
    """The balanced realisation of least order n, or of the order given, whose error is within
    `tolerance`, by the eigensystem realisation algorithm: with the block Hankel matrices H₀ of
    h_{i+j+1} and H₁ of h_{i+j+2}, inputs in parts of `changes` and outputs in parts of their
    largest response,

        H₀ ≈ U Σ Vᵀ,  A = Σ^{-1/2} Uᵀ H₁ V Σ^{-1/2},  B = Σ^{1/2} Vᵀ E₁,  C = E₁ᵀ U Σ^{1/2}

    with the n largest singular values. A map of N steps can tell no more than some N / 2 states for
    each of its outputs. Raises `NotRealised`.

    J.-N. Juang, R. S. Pappa, J. Guid. Control Dyn. 8 (1985), doi 10.2514/3.20031; B. L. Ho,
    R. E. Kalman, Automatisierungstechnik 14 (1966), doi 10.1524/auto.1966.14.112.545.
    """
    if found.steps < 2:
        raise ValueError(f"{found.steps} step (allowed: at least 2)")
    given = np.abs(found.changes)
    largest = np.abs(found.held * given).max(axis=(0, 2))
    received = np.where(largest > 0.0, largest, 1.0)
    scaled = found.held * given / received[:, None]
    rows = found.steps // 2
    columns = found.steps - rows
    u, values, vt = np.linalg.svd(_hankel(scaled, 0, rows, columns), full_matrices=False)
    shifted = u.T @ _hankel(scaled, 1, rows, columns) @ vt.T
    count = max(1, int((values > np.finfo(float).eps * len(vt) * values[0]).sum()))
    if order is not None and not 1 <= order <= count:
        raise ValueError(f"order = {order} (allowed: 1 to {count})")
    best = np.inf
    for n in [order] if order else range(1, count + 1):
        root = np.sqrt(values[:n])
        scale = np.where(root > 0.0, root, 1.0)  # all are 0 without dynamics, and so is A
        space = StateSpace(
            A=shifted[:n, :n] / scale[:, None] / scale,
            B=root[:, None] * vt[:n, : len(given)] / given,
            C=received[:, None] * u[: len(received), :n] * root,
            D=found.direct,
            step=found.step,
            inputs=found.inputs,
            outputs=found.outputs,
            error=0.0,
            hankel=values,
        )
        error = _error(found, space, given)
        best = min(best, error)
        if error <= tolerance:
            object.__setattr__(space, "error", error)
            return space
    told = f"order {order}" if order else f"up to {count} states, as many as the horizon tells of,"
    raise NotRealised(
        f"no realisation of {told} meets {tolerance:g}: the best errs by {best:.1e}"
        " (a longer horizon, more outputs or another tolerance may help)",
        best,
    )


def _hankel(responses: np.ndarray, first: int, rows: int, columns: int) -> np.ndarray:
    """Blocks (i, j) of h_{first+i+j+1}, shape (rows·outputs, columns·inputs)."""
    _, outputs, inputs = responses.shape
    places = first + np.arange(rows)[:, None] + np.arange(columns)[None, :]
    return responses[places].transpose(0, 2, 1, 3).reshape(rows * outputs, columns * inputs)


def _error(found: LinearMap, space: StateSpace, given: np.ndarray) -> float:
    """Worst over outputs: Σ_{k,j} |Δh_kj| a_j / Σ_{k,j} |h_kj| a_j for inputs within ± a."""
    with np.errstate(over="ignore", invalid="ignore"):
        missed = np.abs(space.responses(found.steps) - found.held) @ given
    gain = np.abs(found.held) @ given
    total = gain.sum(axis=0)
    relative = missed.sum(axis=0)[total > 0.0] / total[total > 0.0]
    error = float(relative.max(initial=0.0))
    return error if np.isfinite(error) else np.inf


def named(names: tuple[str, ...]) -> str:
    """Names for one line: all where they are few."""
    return ", ".join(names) if len(names) <= 3 else f"{names[0]} and {len(names) - 1} more"


def _plain(name: str) -> str:
    """A name without dots, which python-control keeps for its own use."""
    return name.replace(".", "_")
