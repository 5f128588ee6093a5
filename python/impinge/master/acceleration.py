"""Fixed points of `x = G(x)`: relaxation, Aitken, Anderson and IQN-ILS.

`r = G(x) − x` is the residual. Inner products take shares: each component counts times `weight`,
one over its scale, so that fluxes and temperatures count alike.
"""

from __future__ import annotations

from collections import deque

import numpy as np

from impinge.master.errors import MasterError

_FARTHEST = 1e3  # times a residual that a step may be long


def _norm(values: np.ndarray) -> float:
    return float(np.sqrt(values @ values))


class Acceleration:
    """Fixed-point iteration with a constant factor: `x + ω r`."""

    def __init__(self, relaxation: float = 1.0):
        self.relaxation = relaxation

    def begin(self) -> None:
        """Called before the first iteration of a step."""

    def next(self, x: np.ndarray, g: np.ndarray, weight: np.ndarray) -> np.ndarray:
        """The next guess after `G(x) = g` has been found."""
        return x + self.relaxation * (g - x)

    def forget(self) -> None:
        """Called when a guess was such that a unit refused it."""

    def end(self) -> None:
        """Called when a step has been accepted."""


class Aitken(Acceleration):
    """Dynamic relaxation with one factor: `ω ← −ω r₀·(r₁ − r₀)/|r₁ − r₀|²`.

    The first factor of a step is the last of the step before, at most `relaxation`.
    U. Küttler, W. A. Wall (2008), doi 10.1007/s00466-008-0255-5.
    """

    def __init__(self, relaxation: float = 0.5):
        super().__init__(relaxation)
        self._omega = relaxation
        self._last: np.ndarray | None = None

    def begin(self) -> None:
        self._last = None
        size = min(abs(self._omega), self.relaxation)
        self._omega = float(np.copysign(max(size, 1e-6), self._omega))

    def next(self, x: np.ndarray, g: np.ndarray, weight: np.ndarray) -> np.ndarray:
        residual = g - x
        if self._last is not None:
            change = (residual - self._last) * weight
            square = change @ change
            if square > 0:
                self._omega *= -((self._last * weight) @ change) / square
        self._last = residual
        return x + self._omega * residual


class LeastSquares(Acceleration):
    """Quasi-Newton by least squares over earlier differences: Anderson mixing and IQN-ILS.

    With columns V of differences of residuals and W of differences of G(x), `V c ≈ −r` by least
    squares and `x ← G(x) + W c`. Columns that are nearly combinations of newer ones are left out.

    depth: columns of one step at most. reuse: how many earlier steps lend theirs.
    Anderson mixing (H. Walker, P. Ni, 2011, doi 10.1137/10078356X) is depth 5 without reuse;
    IQN-ILS (J. Degroote, K.-J. Bathe, J. Vierendeels, 2009, doi 10.1016/j.compstruc.2008.11.013)
    keeps all columns of a step and, if asked to, those of earlier ones.
    """

    def __init__(self, depth: int, reuse: int, relaxation: float = 0.5, filter: float = 1e-3):
        super().__init__(relaxation)
        self._noise = 1e-9  # share of scales below which differences say nothing
        self._depth, self._filter = depth, filter
        self._past: deque[list[tuple[np.ndarray, np.ndarray]]] = deque(maxlen=max(reuse, 0))
        self._columns: list[tuple[np.ndarray, np.ndarray]] = []
        self._last: tuple[np.ndarray, np.ndarray] | None = None

    def begin(self) -> None:
        self._columns, self._last = [], None

    def next(self, x: np.ndarray, g: np.ndarray, weight: np.ndarray) -> np.ndarray:
        residual = g - x
        if self._last is not None:
            change = residual - self._last[0]
            if change.any():
                self._columns = [(change, g - self._last[1]), *self._columns][: self._depth]
        self._last = residual, g
        columns = [*self._columns, *(column for step in self._past for column in step)]
        if not columns:
            return x + self.relaxation * residual
        c, kept = self._solve([change * weight for change, _ in columns], residual * weight)
        new = g + sum((share * columns[i][1] for share, i in zip(c, kept, strict=True)), 0 * g)
        if _norm((new - x) * weight) > _FARTHEST * _norm(residual * weight):
            self._past.clear()  # such columns tell of something else
            self._columns = []
            return x + self.relaxation * residual
        return new

    def _solve(
        self, columns: list[np.ndarray], residual: np.ndarray
    ) -> tuple[np.ndarray, list[int]]:
        """Coefficients of the columns that a QR decomposition, newest first, keeps."""
        basis: list[np.ndarray] = []
        kept: list[int] = []
        for i, change in enumerate(columns):
            if len(basis) == len(residual):
                break
            rest = change.copy()
            for _ in range(2):  # twice is enough
                for vector in basis:
                    rest -= (vector @ rest) * vector
            length = _norm(rest)
            if length > max(self._filter * _norm(change), self._noise):
                basis.append(rest / length)
                kept.append(i)
        if not kept:
            return np.zeros(0), []
        q = np.array(basis).T
        r = q.T @ np.array([columns[i] for i in kept]).T
        return np.linalg.solve(np.triu(r), -(q.T @ residual)), kept

    def forget(self) -> None:
        self._past.clear()
        self._columns, self._last = [], None

    def end(self) -> None:
        if self._past.maxlen and self._columns:
            self._past.appendleft(self._columns)


def acceleration(name: str, relaxation: float | None, reuse: int | None) -> Acceleration:
    """The acceleration of this name; `reuse` is of IQN-ILS alone."""
    given = {} if relaxation is None else {"relaxation": relaxation}
    match name:
        case "none":
            return Acceleration(**given)
        case "aitken":
            return Aitken(**given)
        case "anderson":
            return LeastSquares(depth=5, reuse=0, **given)
        case "iqn-ils":
            return LeastSquares(depth=100, reuse=8 if reuse is None else reuse, **given)
    raise MasterError(f"acceleration is `{name}`; it may be none, aitken, anderson or iqn-ils")
