"""Temperature, stress and displacement of a unit's bodies on meshes of other tools."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from ..reading import reading
from ..surface import Placement, SurfaceError
from ..surface.arrays import check_finite
from ..surface.errors import need
from ..surface.files import lattice, load_mesh
from ..surface.vtk_xml import read_pvd, read_vtk_xml

# Order of the six components of a stress, and their places in a matrix
STRESS = ((0, 0), (1, 1), (2, 2), (0, 1), (1, 2), (0, 2))


@dataclass(frozen=True)
class Body:
    """Fields at the nodes of a box, or of a disc by its section (.vtr) or turned about its axis
    (.vts), at one time.

    Attributes
    ----------
    axes
        Coordinates of the nodes along x, y, z, or along r, z of a disc [m].
    fields
        Arrays of shape (nodes along each axis…, components); of a disc in the half plane at angle
        0.
    """

    axes: tuple[np.ndarray, ...]
    fields: dict[str, np.ndarray]

    @classmethod
    def read(cls, path: str | Path) -> Body:
        """Reads a file of a series that a unit writes to ``output.directory``."""
        path = Path(path)
        with reading(path, SurfaceError):
            return cls._read(path)

    @classmethod
    def _read(cls, path: Path) -> Body:
        file = read_vtk_xml(path)
        points, shape = lattice(path, file)
        if file.kind == "StructuredGrid":
            kept = np.arange(len(points)).reshape(shape, order="F")[:, 0, :]
            axes = points[kept[:, 0], 0], points[kept[0, :], 2]
            if (
                np.abs(points[kept, 1]).max() > 0
                or (np.diff(axes[0]) <= 0).any()
                or axes[0][0] != 0
            ):
                raise SurfaceError(f"{path}: no disc turned round the z axis")
        else:
            kept = np.arange(len(points)).reshape(shape, order="F")
            axes = tuple(file.geometry[name] for name in ("x", "y", "z"))
            if len(axes[1]) == 1:
                # The meridian section of a disc; a box has nodes along y.
                kept, axes = kept[:, 0, :], (axes[0], axes[2])
        check_finite({"points": points, **file.points})
        fields = {
            name: np.asarray(v, float).reshape(len(points), -1)[kept]
            for name, v in file.points.items()
        }
        return cls(tuple(np.asarray(axis, float) for axis in axes), fields)

    def __call__(self, name: str, points: np.ndarray, tolerance: float) -> np.ndarray:
        """A field at `points`, shape (n, 3) [m]: linear between nodes along each axis; shape (n,
        components).

        Of discs, components are turned to the angle of the point.

        Raises
        ------
        SurfaceError
            If there is no such field, or if a point lies farther than the tolerance [m] off the
            body.
        """
        if name not in self.fields:
            raise SurfaceError(f"no field `{name}`; there are {', '.join(self.fields)}")
        is_disc = len(self.axes) == 2
        at = (
            np.column_stack([np.hypot(points[:, 0], points[:, 1]), points[:, 2]])
            if is_disc
            else points
        )
        values = _interpolate(self.axes, self.fields[name], self._inside(at, points, tolerance))
        return _turned(values, points) if is_disc else values

    def _inside(self, at: np.ndarray, points: np.ndarray, tolerance: float) -> np.ndarray:
        low = np.array([axis[0] for axis in self.axes])
        high = np.array([axis[-1] for axis in self.axes])
        beyond = np.maximum(low - at, at - high).max(axis=1)
        if beyond.max() > tolerance:
            worst = int(np.argmax(beyond))
            place = ", ".join(f"{x:.6g}" for x in points[worst])
            raise SurfaceError(
                f"{(beyond > tolerance).sum()} of {len(at)} points lie off the body, "
                f"point {worst} at ({place}) m by "
                f"{beyond[worst]:.3g} m (tolerance {tolerance:.3g} m)"
            )
        return np.clip(at, low, high)


def _interpolate(axes: tuple[np.ndarray, ...], values: np.ndarray, at: np.ndarray) -> np.ndarray:
    result = 0.0
    parts = []
    for k, axis in enumerate(axes):
        if len(axis) == 1:
            parts.append([(np.zeros(len(at), int), np.ones(len(at)))])
            continue
        left = np.clip(np.searchsorted(axis, at[:, k], side="right") - 1, 0, len(axis) - 2)
        share = (at[:, k] - axis[left]) / (axis[left + 1] - axis[left])
        parts.append([(left, 1 - share), (left + 1, share)])
    for corner in np.ndindex(*(len(part) for part in parts)):
        chosen = [part[c] for part, c in zip(parts, corner, strict=True)]
        weight = np.prod([weight for _, weight in chosen], axis=0)
        result = result + weight[:, None] * values[tuple(index for index, _ in chosen)]
    return result


def _turned(values: np.ndarray, points: np.ndarray) -> np.ndarray:
    """Components at the angle 0 turned to that of the points: u' = R u, σ' = R σ Rᵀ."""
    if values.shape[1] == 1:
        return values
    angle = np.arctan2(points[:, 1], points[:, 0])
    turn = np.zeros((len(points), 3, 3))
    turn[:, 0, 0] = turn[:, 1, 1] = np.cos(angle)
    turn[:, 1, 0] = np.sin(angle)
    turn[:, 0, 1] = -turn[:, 1, 0]
    turn[:, 2, 2] = 1.0
    if values.shape[1] == 3:
        return np.einsum("nij,nj->ni", turn, values)
    tensor = np.empty((len(points), 3, 3))
    for k, (i, j) in enumerate(STRESS):
        tensor[:, i, j] = tensor[:, j, i] = values[:, k]
    tensor = turn @ tensor @ turn.transpose(0, 2, 1)
    return np.column_stack([tensor[:, i, j] for i, j in STRESS])


def onto_mesh(
    series: str | Path,
    mesh: Any,
    fields: Sequence[str],
    *,
    times: Sequence[float] | None = None,
    placement: Placement | None = None,
    tolerance: float | None = None,
) -> Iterable[tuple[float, dict[str, np.ndarray]]]:
    """Fields of a unit's ParaView series at the nodes of a mesh; yields a time [s] and arrays, one
    row a node.

    Parameters
    ----------
    series
        ``BODY.pvd`` of ``output.directory``, or one .vtr or .vts file (time 0).
    mesh
        A mesh of meshio, or the path of one.
    fields
        Such as temperature [K], stress [Pa] (xx, yy, zz, xy, yz, xz), displacement [m], von_mises.
    times
        Those of the series that are wanted, to 1e-9 of the last; by default all.
    placement
        Where the body's top lies in the mesh's coordinates. Vectors and tensors are turned into the
        mesh's axes; lengths of displacement stay in m.
    tolerance
        How far nodes may lie off the body [m]; by default 1e-6 of its extent.
    """
    series = Path(series)
    frames = read_pvd(series) if series.suffix == ".pvd" else [(0.0, series)]
    placement = placement or Placement()
    points = placement.to_face(
        load_mesh(Path(mesh)).points if isinstance(mesh, str | Path) else mesh.points
    )
    for time, path in _wanted(series, frames, times):
        body = Body.read(path)
        reach = (
            tolerance if tolerance is not None else 1e-6 * max(np.ptp(axis) for axis in body.axes)
        )
        try:
            values = {
                name: _in_axes(body(name, points, reach), placement.matrix.T) for name in fields
            }
        except SurfaceError as error:
            raise SurfaceError(f"{path}: {error}") from None
        yield time, values


def _wanted(
    series: Path, frames: list[tuple[float, Any]], times: Sequence[float] | None
) -> list[tuple[float, Any]]:
    if times is None:
        return frames
    kept = []
    for time in times:
        near = min(frames, key=lambda frame: abs(frame[0] - time))
        if abs(near[0] - time) > 1e-9 * max(abs(frames[-1][0]), 1e-300):
            known = f"{len(frames)} from {frames[0][0]} to {frames[-1][0]} s, the nearest is "
            f"{near[0]} s"
            raise SurfaceError(f"{series}: has no time {time} s; it has {known}")
        kept.append(near)
    return kept


def _in_axes(values: np.ndarray, turn: np.ndarray) -> np.ndarray:
    """Components in axes whose directions are the rows of `turn`'s transpose."""
    if values.shape[1] == 1:
        return values[:, 0]
    if np.array_equal(turn, np.eye(3)):
        return values
    if values.shape[1] == 3:
        return values @ turn.T
    tensor = np.empty((len(values), 3, 3))
    for k, (i, j) in enumerate(STRESS):
        tensor[:, i, j] = tensor[:, j, i] = values[:, k]
    tensor = turn @ tensor @ turn.T
    return np.column_stack([tensor[:, i, j] for i, j in STRESS])


def write_frames(
    out: str | Path, mesh: Any, frames: Iterable[tuple[float, dict[str, np.ndarray]]]
) -> list[Path]:
    """Writes a mesh with fields over time: .xdmf and .pvd hold all times, other formats of meshio
    one.

    Returns the files that were written.
    """
    meshio = need("meshio")

    out, frames = Path(out), list(frames)
    if not frames:
        raise SurfaceError(f"{out}: no times to write")
    if out.suffix == ".xdmf":
        with meshio.xdmf.TimeSeriesWriter(out, data_format="XML") as writer:
            writer.write_points_cells(mesh.points, mesh.cells)
            for time, fields in frames:
                writer.write_data(time, point_data=fields)
        return [out]
    if out.suffix == ".pvd":
        return _write_pvd(out, mesh, frames)
    if len(frames) > 1:
        raise SurfaceError(
            f"{out}: holds one time of {len(frames)}; choose one, or write .xdmf or .pvd"
        )
    try:
        meshio.Mesh(mesh.points, mesh.cells, point_data=frames[0][1]).write(out)
    except (meshio.WriteError, meshio.ReadError, KeyError) as error:
        raise SurfaceError(f"{out}: {str(error) or 'meshio knows no such format'}") from None
    return [out]


def _write_pvd(
    out: Path, mesh: Any, frames: list[tuple[float, dict[str, np.ndarray]]]
) -> list[Path]:
    meshio = need("meshio")

    files, sets = [], []
    for k, (time, fields) in enumerate(frames):
        files.append(out.with_name(f"{out.stem}_{k:06}.vtu"))
        meshio.Mesh(mesh.points, mesh.cells, point_data=fields).write(files[-1])
        sets.append(f'    <DataSet timestep="{time!r}" part="0" file="{files[-1].name}"/>\n')
    head = '<?xml version="1.0"?>\n<VTKFile type="Collection" version="1.0">\n'
    out.write_text(f"{head}  <Collection>\n{''.join(sets)}  </Collection>\n</VTKFile>\n")
    return [*files, out]
