"""The linear map of a unit: responses, predictions, matrices."""

from __future__ import annotations

import json
import os
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from impinge.errors import ImpingeError, need
from impinge.reading import open_file, reading
from impinge.unit import Unit

from .realisation import StateSpace, named, realise
from .rollout import Rollout


@dataclass(frozen=True, eq=False)
class LinearMap:
    """What held inputs u (steps, inputs) make of outputs y (steps + 1, outputs):

        y_k = f_k + Σ_{i<k} h_{k−i} (u_i − u_b) + D (u_{k−1} − u_b)

    y_0 stands before the first step, under the base inputs u_b = `base`; y_k at the end of step k,
    as a master reads it there, before it sets the next inputs. f = `free`, shape (steps + 1,
    outputs); h = `held`, shape (steps, outputs, inputs), in units of the output per unit of the
    input; D = `direct`, shape (outputs, inputs); `ramp`, shape as `held`, are responses to inputs
    that grow from 0 to 1 over a step, if they were asked for.

    step: in s. start: time of y_0 [s]. changes: sizes of the pulses that were tried, (inputs,).
    defect: what superposition of random inputs missed, relative to the largest response.
    """

    inputs: tuple[str, ...]
    outputs: tuple[str, ...]
    units: dict[str, str]
    step: float
    start: float
    base: np.ndarray
    free: np.ndarray
    direct: np.ndarray
    held: np.ndarray
    ramp: np.ndarray | None
    changes: np.ndarray
    defect: float

    def __repr__(self) -> str:
        return (
            f"<impinge.linear.LinearMap of {named(self.inputs)} to {named(self.outputs)}:"
            f" {self.steps} steps of {self.step:g} s, defect {self.defect:.1e}>"
        )

    @property
    def steps(self) -> int:
        """The horizon."""
        return len(self.held)

    @property
    def times(self) -> np.ndarray:
        """Times [s] of the outputs, shape (steps + 1,)."""
        return self.start + self.step * np.arange(self.steps + 1)

    @property
    def step_response(self) -> np.ndarray:
        """Outputs at ends of steps 1 … under a unit of an input from the first step on, shape
        (steps, outputs, inputs)."""
        return np.cumsum(self.held, axis=0) + self.direct

    def free_response(self, unit: Unit) -> np.ndarray:
        """What outputs do from the unit's present state under the base inputs, shape (steps + 1,
        outputs): the `free` of a prediction from there. The unit is left as it was."""
        with Rollout(unit, self.inputs, self.outputs, self.step, self.steps) as rollout:
            rollout.base = self.base
            return rollout.free()

    def predict(self, inputs: Any, ends: Any = None, free: np.ndarray | None = None) -> np.ndarray:
        """Outputs (n + 1, outputs) under `inputs` (n, inputs), n up to `steps`, held over each step
        or, with `ends`, straight from the one to the other; `free` from another state than that of
        the map (`free_response`)."""
        begins = self._changes_of(inputs)
        count = len(begins)
        last = begins if ends is None else self._changes_of(ends)
        if last.shape != begins.shape:
            raise ValueError(f"ends {last.shape}, beginnings {begins.shape} (allowed: alike)")
        rows = np.array((self.free if free is None else free)[: count + 1], float)
        for number in range(count):
            response = np.tensordot(self.held[: count - number], begins[number], 1)
            if ends is not None:
                response += np.tensordot(
                    self._ramp[: count - number], last[number] - begins[number], 1
                )
            response[0] += self.direct @ last[number]
            rows[number + 1 :] += response
        return rows

    @property
    def _ramp(self) -> np.ndarray:
        if self.ramp is None:
            raise ValueError("the map knows held inputs alone (linear_map(…, ramps=True))")
        return self.ramp

    def _changes_of(self, inputs: Any) -> np.ndarray:
        values = np.asarray(inputs, float)
        if values.ndim == 1 and len(self.inputs) == 1:
            values = values[:, None]
        if values.ndim != 2 or values.shape[1] != len(self.inputs):
            raise ValueError(f"inputs {values.shape} (allowed: (steps, {len(self.inputs)}))")
        if not 1 <= len(values) <= self.steps:
            raise ValueError(f"{len(values)} steps (allowed: 1 to {self.steps})")
        return values - self.base

    def matrices(self, steps: int | None = None) -> tuple[np.ndarray, np.ndarray]:
        """The map as one matrix: G (n·outputs, n·inputs), lower block triangular, and g (n·outputs)
        such that `y[1:].ravel() = g + G @ u.ravel()` for held inputs u (n, inputs)."""
        count = self.steps if steps is None else steps
        if not 1 <= count <= self.steps:
            raise ValueError(f"{count} steps (allowed: 1 to {self.steps})")
        outputs, inputs = self.direct.shape
        whole = np.zeros((count, outputs, count, inputs))
        for row in range(count):
            whole[row, :, : row + 1, :] = np.moveaxis(self.held[row::-1], 0, 1)
            whole[row, :, row, :] += self.direct
        matrix = whole.reshape(count * outputs, count * inputs)
        offset = self.free[1 : count + 1].ravel() - matrix @ np.tile(self.base, count)
        return matrix, offset

    def state_space(self, tolerance: float = 1e-6, order: int | None = None) -> StateSpace:
        """A balanced realisation of the least order, or of a given one, whose error over the
        horizon is within `tolerance`; see `realise`. Raises `NotRealised`."""
        return realise(self, tolerance, order)

    def to_control(self, tolerance: float = 1e-6) -> Any:
        """The realisation as `control.StateSpace` of python-control."""
        return self.state_space(tolerance).to_control()

    def to_casadi(self, steps: int | None = None) -> Any:
        """A CasADi function of all inputs (inputs, n) and the free response (outputs, n) at ends of
        steps 1 … n, to outputs (outputs, n) there; `self.free[1:].T` is the map's own."""
        casadi = need("casadi", "pip install casadi", "to_casadi()")
        count = self.steps if steps is None else steps
        matrix, _ = self.matrices(count)
        inputs = casadi.SX.sym("inputs", len(self.inputs), count)
        free = casadi.SX.sym("free", len(self.outputs), count)
        change = casadi.vec(inputs) - casadi.DM(np.tile(self.base, count))
        outputs = free + casadi.reshape(casadi.DM(matrix) @ change, len(self.outputs), count)
        names = (["inputs", "free"], ["outputs"])
        return casadi.Function("linear_map", [inputs, free], [outputs], *names)

    def save(self, path: str | os.PathLike[str]) -> None:
        """Writes the map as `.npz`, arrays by the names of its attributes."""
        texts = {"inputs": self.inputs, "outputs": self.outputs, "units": self.units}
        ramp: dict[str, Any] = {} if self.ramp is None else {"ramp": self.ramp}
        np.savez(
            path,
            about=json.dumps(texts),
            step=self.step,
            start=self.start,
            base=self.base,
            free=self.free,
            direct=self.direct,
            held=self.held,
            changes=self.changes,
            defect=self.defect,
            **ramp,
        )

    @classmethod
    def load(cls, path: str | os.PathLike[str]) -> LinearMap:
        """What `save` has written."""
        with (
            reading(path, ImpingeError),
            open_file(Path(path)) as file,
            np.load(file, allow_pickle=False) as stored,
        ):
            about = json.loads(str(stored["about"]))
            return cls(
                inputs=tuple(about["inputs"]),
                outputs=tuple(about["outputs"]),
                units=about["units"],
                step=float(stored["step"]),
                start=float(stored["start"]),
                base=stored["base"],
                free=stored["free"],
                direct=stored["direct"],
                held=stored["held"],
                ramp=stored["ramp"] if "ramp" in stored else None,
                changes=stored["changes"],
                defect=float(stored["defect"]),
            )
