"""A map of values on one surface to values on another."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from scipy.sparse import csr_matrix

from .errors import SurfaceError
from .series import Series

if TYPE_CHECKING:
    from .surface import Surface

# Of the sum of all amounts: less is rounding
NOTHING = 1e-12


@dataclass(frozen=True, eq=False)
class Map:
    """``values of target = matrix · values of source``.

    Call it with values of the source: an array whose last axes have the shape ``source.shape`` or
    are one axis of ``source.size``; further axes before them, such as time, are kept. A
    :class:`Series` gives a series.

    Attributes
    ----------
    matrix
        Sparse, shape (target.size, source.size).
    kind
        "conservative" or "consistent".
    quantity
        "intensive" (per area, as W/m2) or "extensive" (an amount per cell or point, as W).
    outside
        What is done with what lies off the other surface.
    source_weights, target_weights
        Of conservative maps: the integral is the sum of weights times values, on either side; [m2]
        for intensive quantities, 1 for extensive ones. Of the source's depth where that has one.
    off
        Of consistent maps: which places of the target lie off the source and get NaN.
    """

    source: Surface
    target: Surface
    matrix: csr_matrix
    kind: str
    quantity: str = "intensive"
    outside: str = "error"
    source_weights: np.ndarray | None = None
    target_weights: np.ndarray | None = None
    off: np.ndarray | None = None

    def __call__(self, values: Any) -> Any:
        """Values on the target.

        Raises
        ------
        SurfaceError
            If values have another shape or are not finite, or, of conservative maps with
            ``outside="error"``, if part of them falls beside the target.
        """
        if isinstance(values, Series):
            return Series(values.times, self(values.values))
        flat, before = self._flat(values)
        if self.source_weights is not None and self.outside == "error":
            self._refuse_lost(flat)
        result = (self.matrix @ flat.T).T
        if self.off is not None and self.off.any():
            result[:, self.off] = np.nan
        return result.reshape(*before, *self.target.shape)

    def lost(self, values: Any) -> np.ndarray | float:
        """What falls beside the target: integral of the source less that of the target, of values
        as the map itself takes them; in units of the values times m2, or of the values if
        extensive.

        Raises
        ------
        SurfaceError
            If the map is not conservative.
        """
        if self.source_weights is None:
            raise SurfaceError("a consistent map keeps values, no integral: nothing is lost")
        flat, before = self._flat(values)
        lost = flat @ self._lost_weights
        return lost.reshape(before) if before else float(lost[0])

    def integral(self, values: Any) -> np.ndarray | float:
        """Integral of values of the source, as :meth:`lost` gives what of it is lost."""
        if self.source_weights is None:
            raise SurfaceError("a consistent map has no integral")
        flat, before = self._flat(values)
        total = flat @ self.source_weights
        return total.reshape(before) if before else float(total[0])

    @property
    def transpose(self) -> Map:
        """The map back that keeps products: ``(M u) · w = u · (Mᵀ w)``. That of a consistent map
        carries amounts without loss; that of a conservative one of amounts gives means.
        """
        kind = "consistent" if self.kind == "conservative" else "conservative"
        quantity = "extensive" if kind == "conservative" else self.quantity
        return Map(self.target, self.source, csr_matrix(self.matrix.T), kind, quantity, "drop")

    @property
    def _lost_weights(self) -> np.ndarray:
        return self.source_weights - self.matrix.T @ self.target_weights

    def _flat(self, values: Any) -> tuple[np.ndarray, tuple[int, ...]]:
        values = np.asarray(values, float)
        shape, size = self.source.shape, self.source.size
        if values.shape[-len(shape) :] == shape:
            before = values.shape[: values.ndim - len(shape)]
        elif values.ndim and values.shape[-1] == size:
            before = values.shape[:-1]
        else:
            raise SurfaceError(f"values: of shape {values.shape}, for a surface of shape {shape}")
        flat = values.reshape(-1, size)
        if not np.isfinite(flat).all():
            row, place = np.argwhere(~np.isfinite(flat))[0]
            raise SurfaceError(f"values: {flat[row, place]} at place {place} of {size}")
        return flat, before

    def _refuse_lost(self, flat: np.ndarray) -> None:
        weights = self._lost_weights
        amounts = np.abs(flat) @ np.abs(self.source_weights)
        gone = np.abs(flat) @ np.abs(weights)
        worst = int(np.argmax(gone - NOTHING * amounts))
        if gone[worst] <= NOTHING * amounts[worst]:
            return
        lost, total = flat[worst] @ weights, flat[worst] @ self.source_weights
        place = int(np.argmax(np.abs(flat[worst] * weights)))
        at = ", ".join(f"{x:.6g}" for x in self.source.coordinates[place])
        share = f" ({lost / total:.3g} of it)" if total else ""
        raise SurfaceError(
            f"{lost:.6g} of {total:.6g}{share} lies off the target, most of it at "
            f"place {place}, ({at}) m; "
            'outside="drop" leaves it out'
        )
