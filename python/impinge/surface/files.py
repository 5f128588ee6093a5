"""Reading surfaces with their fields, at one time or over time."""

from __future__ import annotations

import xml.etree.ElementTree as ElementTree
from collections.abc import Callable
from contextlib import redirect_stderr, redirect_stdout
from dataclasses import replace
from io import StringIO
from math import prod
from pathlib import Path
from typing import Any

import numpy as np

from ..reading import open_file, reading
from .arrays import check_corners, check_fields, check_finite, check_points, read_datasets
from .csv_files import read_table
from .doubles import double
from .errors import SurfaceError, need
from .placement import Placement
from .series import Series
from .surface import Surface, plane
from .vtk_xml import read_pvd, read_vtk_xml
from .vtu import VtuCells, check_vtu

# Cells of meshio that lie on surfaces, and how many of their nodes are corners
FACES = {"triangle": 3, "triangle6": 3, "triangle7": 3, "quad": 4, "quad8": 4, "quad9": 4}
HDF5 = {".h5", ".hdf5", ".hdf"}
# Points of a grid, at most
MOST_POINTS = 10**8


def read(
    path: str | Path,
    placement: Placement | None = None,
    *,
    values: str | None = None,
    face: float | None = None,
    tolerance: float | None = None,
) -> Surface:
    """A surface of a file, with its fields in ``surface.data``.

    ============================  ==============================================================
    .csv, .txt                    columns x, y (and z) and fields: scattered points; numbers
                                  under a unit, ``q [kW/m2]``, become those of SI
    .h5, .hdf5                    ``points`` (n, 2 or 3), ``cells`` (m, 3 or 4) unless scattered,
                                  fields of n or m rows; where n = m, `values` says which
    .vtp, .vts, .vtr              VTK's XML of polygons and of grids that are flat
    .vtu, .vtk, .msh, .stl, …     formats of meshio: triangles and quadrilaterals
    ============================  ==============================================================

    Parameters
    ----------
    placement
        Where the face lies in the file's coordinates, and their unit.
    values
        "cells" or "points": which fields are read. By default those of cells, if there are any.
    face
        Read only the cells that lie at this height z of the placed coordinates [m], to the
        tolerance.
    tolerance
        How far nodes may lie off a plane [m]; by default 1e-6 of their extent.

    Raises
    ------
    SurfaceError
        With the file, and of tables line and column, of what cannot be read.
    """
    path = Path(path)
    surface, series = _read_file(path, placement, values, face, tolerance)
    many = [name for name, one in series.items() if len(one) > 1]
    if many:
        raise SurfaceError(
            f"{path}: `{many[0]}` has {len(series[many[0]])} times; read_series reads them"
        )
    return replace(
        surface, data={**surface.data, **{name: one.values[0] for name, one in series.items()}}
    )


def read_series(
    path: str | Path,
    placement: Placement | None = None,
    *,
    values: str | None = None,
    face: float | None = None,
    tolerance: float | None = None,
) -> tuple[Surface, dict[str, Series]]:
    """A surface and its fields over time: of a .csv with a column ``time``, an HDF5 file with
    ``time`` (n,) and fields of n frames, a .pvd, an .xdmf series, or a single time, which is taken
    as 0 s.

    All frames are to have the same places.
    """
    path = Path(path)
    surface, series = _read_file(path, placement, values, face, tolerance)
    fixed = {name: Series(np.zeros(1), field[None]) for name, field in surface.data.items()}
    return replace(surface, data={}), {**fixed, **series}


def _read_file(
    path: Path,
    placement: Placement | None,
    values: str | None,
    face: float | None,
    tolerance: float | None,
) -> tuple[Surface, dict[str, Series]]:
    make = _Maker(path, placement or Placement(), values, face, tolerance)
    with reading(path, SurfaceError):
        return _read_any(path, make)


def _read_any(path: Path, make: _Maker) -> tuple[Surface, dict[str, Series]]:
    open_file(path).close()
    suffix = path.suffix.lower()
    if suffix in (".csv", ".txt"):
        return _read_csv(path, make)
    if suffix in HDF5:
        return _read_hdf5(path, make)
    if suffix == ".pvd":
        return _join(path, [(time, lambda p=p: _read_mesh(p, make)) for time, p in read_pvd(path)])
    if suffix == ".xdmf":
        return _read_xdmf(path, make)
    return _read_mesh(path, make), {}


class _Maker:
    """Makes a surface of points, cells and fields as one file brings them."""

    def __init__(
        self,
        path: Path,
        placement: Placement | None,
        values: str | None,
        face: float | None,
        tolerance: float | None,
    ) -> None:
        self.path, self.placement = path, placement
        self.values, self.face, self.tolerance = values, face, tolerance
        self.is_checked = False  # frames of a series have one mesh
        if values not in (None, "cells", "points"):
            raise SurfaceError(f"values: `{values}` is none of cells, points")

    def __call__(
        self, points: np.ndarray, cells: np.ndarray | None, at_points: dict, at_cells: dict
    ) -> Surface:
        try:
            points = check_points(points)
            cells = None if cells is None else check_corners(cells, len(points))
            at_points = check_fields(at_points, len(points), "points")
            at_cells = check_fields(at_cells, 0 if cells is None else len(cells), "cells")
            surface = self._make(points, cells, at_points, at_cells)
            check_finite(surface.data)
            return surface
        except SurfaceError as error:
            raise SurfaceError(f"{self.path}: {error}") from None

    def _make(
        self,
        points: np.ndarray,
        cells: np.ndarray | None,
        at_points: dict[str, np.ndarray],
        at_cells: dict[str, np.ndarray],
    ) -> Surface:
        if cells is None:
            return replace(Surface.points(points, self.placement), data=at_points)
        kept = np.arange(len(cells)) if self.face is None else self._on_face(points, cells)
        values = self.values or ("cells" if at_cells or not at_points else "points")
        options = {"values": values, "tolerance": self.tolerance}
        used, corners = np.unique(cells[kept], return_inverse=True)
        corners = corners.reshape(-1, cells.shape[1])
        # Here, so that the error tells the file's own number of the node
        plane(self.placement.to_face(points), used, self.tolerance)
        surface = Surface.triangles(points[used], corners, self.placement, **options)
        self._refuse_doubles(surface, kept)
        if values == "cells":
            data = {name: field[kept] for name, field in at_cells.items()}
        else:
            data = {name: field[used] for name, field in at_points.items()}
        return replace(surface, data=data)

    def _refuse_doubles(self, surface: Surface, numbers: np.ndarray) -> None:
        """What lies on cells that overlap would count twice."""
        pair = None if self.is_checked else double(surface.cells)
        self.is_checked = True
        if pair is not None:
            first, second = pair
            at = ", ".join(f"{x:.6g}" for x in surface.cells.centroids[second])
            raise SurfaceError(
                f"cells {numbers[first]} and {numbers[second]} overlap at ({at}) m (allowed: cells"
                " that share sides alone)"
            )

    def _on_face(self, points: np.ndarray, cells: np.ndarray) -> np.ndarray:
        placed = self.placement.to_face(points)
        tolerance = self.tolerance or 1e-6 * np.ptp(placed[:, :2], axis=0).max()
        kept = np.flatnonzero((np.abs(placed[cells, 2] - self.face) <= tolerance).all(axis=1))
        if not len(kept):
            low, high = placed[:, 2].min(), placed[:, 2].max()
            raise SurfaceError(
                f"no cell lies at z = {self.face:.6g} m (tolerance "
                f"{tolerance:.3g} m); "
                f"they lie from {low:.6g} to {high:.6g} m"
            )
        return kept


def _read_csv(path: Path, make: _Maker) -> tuple[Surface, dict[str, Series]]:
    names, rows = read_table(path, (make.placement or Placement()).metres)
    axes = [name for name in ("x", "y", "z") if name in names]
    if axes[:2] != ["x", "y"]:
        raise SurfaceError(f"{path}: columns x and y are needed; there are {', '.join(names)}")
    columns = dict(zip(names, rows.T, strict=True))
    fields = [name for name in names if name not in (*axes, "time")]
    places = np.column_stack([columns[axis] for axis in axes])
    if "time" not in columns:
        return make(places, None, {name: columns[name] for name in fields}, {}), {}
    times, frame = np.unique(columns["time"], return_inverse=True)
    order = np.lexsort((*places.T[::-1], frame))
    many = len(rows) // len(times)
    by_frame = (
        places[order].reshape(len(times), -1, len(axes)) if many * len(times) == len(rows) else None
    )
    if by_frame is None or (np.bincount(frame) != many).any() or (by_frame != by_frame[0]).any():
        raise SurfaceError(f"{path}: times have different places; every time needs all of them")
    surface = make(by_frame[0], None, {}, {})
    return surface, {n: Series(times, columns[n][order].reshape(len(times), many)) for n in fields}


def _read_hdf5(path: Path, make: _Maker) -> tuple[Surface, dict[str, Series]]:
    h5py = need("h5py")

    with h5py.File(path) as file:
        content = read_datasets(file)
    if "points" not in content:
        raise SurfaceError(
            f"{path}: no dataset `points` of shape (n, 2 or 3); there are {', '.join(content)}"
        )
    points, cells = content.pop("points"), content.pop("cells", None)
    times = content.pop("time", None)
    if times is not None and times.ndim != 1:
        raise SurfaceError(f"{path}: `time` of shape {times.shape} (allowed: one axis)")
    frames, still = {}, {}
    for name, field in content.items():
        is_frames = times is not None and field.ndim >= 2 and len(field) == len(times)
        (frames if is_frames else still)[name] = np.moveaxis(field, 0, 1) if is_frames else field
    # Places first: frames become columns of one field.
    fields = {**still, **frames}
    for name, field in fields.items():
        if field.ndim == 0 or len(field) not in (len(points), 0 if cells is None else len(cells)):
            raise SurfaceError(
                f"{path}: `{name}` of shape {content[name].shape} fits neither points nor cells"
            )
    is_open = cells is not None and len(cells) == len(points)
    if is_open and fields and make.values is None:
        raise SurfaceError(
            f"{path}: `{next(iter(fields))}` has {len(points)} rows, and there are as many points"
            ' as cells; values="cells" or "points" says whose they are (--values)'
        )
    of_cells = make.values == "cells" if is_open else None
    at_points = {n: f for n, f in fields.items() if len(f) == len(points) and not of_cells}
    at_cells = {n: f for n, f in fields.items() if n not in at_points}
    surface = make(points, cells, at_points, at_cells)
    series = {
        n: Series(times, np.moveaxis(surface.data[n], 1, 0)) for n in frames if n in surface.data
    }
    return replace(surface, data={n: f for n, f in surface.data.items() if n not in frames}), series


def _read_xdmf(path: Path, make: _Maker) -> tuple[Surface, dict[str, Series]]:
    meshio = need("meshio")

    try:
        with meshio.xdmf.TimeSeriesReader(path) as reader:
            points, blocks = reader.read_points_cells()
            frames = []
            for k in range(reader.num_steps):
                time, at_points, at_cells = reader.read_data(k)
                frames.append((time, at_points, at_cells))
    except (meshio.ReadError, ElementTree.ParseError, AttributeError, KeyError, OSError):
        return _read_mesh(path, make), {}
    if not frames:
        return _read_mesh(path, make), {}

    def load(frame: tuple[float, dict, dict]) -> Callable[[], Surface]:
        mesh = meshio.Mesh(points, blocks, frame[1], frame[2])
        return lambda: _of_mesh(path, mesh, make)

    return _join(path, [(frame[0], load(frame)) for frame in frames])


def _join(
    path: Path, frames: list[tuple[float, Callable[[], Surface]]]
) -> tuple[Surface, dict[str, Series]]:
    """One surface and the series of its fields, of frames each on its own."""
    surface = frames[0][1]()
    data: dict[str, list] = {name: [field] for name, field in surface.data.items()}
    for time, load in frames[1:]:
        other = load()
        if (
            other.shape != surface.shape
            or np.abs(other.coordinates - surface.coordinates).max() > 0
        ):
            raise SurfaceError(
                f"{path}: the places at {time} s are others than at {frames[0][0]} s"
            )
        if set(other.data) != set(data):
            raise SurfaceError(
                f"{path}: at {time} s there are {', '.join(other.data)}, before {', '.join(data)}"
            )
        for name, field in other.data.items():
            data[name].append(field)
    times = np.array([time for time, _ in frames])
    return replace(surface, data={}), {
        name: Series(times, np.array(fields)) for name, fields in data.items()
    }


def _read_mesh(path: Path, make: _Maker) -> Surface:
    if not path.is_file():
        raise SurfaceError(f"{path}: no such file")
    if path.suffix.lower() in (".vtp", ".vts", ".vtr"):
        return _of_vtk(path, make)
    return _of_mesh(path, load_mesh(path), make)


def load_mesh(path: Path) -> Any:
    """A mesh as meshio reads it."""
    meshio = need("meshio")
    with reading(path, SurfaceError):
        open_file(path).close()
        if not path.stat().st_size:
            raise SurfaceError("is empty")
        told = check_vtu(path) if path.suffix.lower() == ".vtu" else None
        mesh = _read_by_meshio(meshio, path)
        if told:
            _refuse_cells_left_out(mesh, told)
        return mesh


def _read_by_meshio(meshio: Any, path: Path) -> Any:
    """meshio prints why it does not read a file, and leaves by `sys.exit`."""
    printed = StringIO()
    try:
        with redirect_stdout(printed), redirect_stderr(StringIO()):
            return meshio.read(path)
    except SystemExit:
        why = printed.getvalue().strip() or "it is damaged, or of another format"
        raise SurfaceError(f"meshio does not read it as {path.suffix}: {why}") from None


def _refuse_cells_left_out(mesh: Any, told: VtuCells) -> None:
    missing = told.count - sum(len(block.data) for block in mesh.cells)
    if missing > 0:
        kinds = ", ".join(map(str, told.types))
        raise SurfaceError(
            f"{missing} of {told.count} cells are of types that are not read; VTK's types in the"
            f" file are {kinds}"
        )


def _of_mesh(path: Path, mesh: Any, make: _Maker) -> Surface:
    blocks = [k for k, block in enumerate(mesh.cells) if block.type in FACES]
    at_points = dict(mesh.point_data)
    if not blocks:
        kinds = {block.type for block in mesh.cells}
        if kinds <= {"vertex"}:
            return make(mesh.points, None, at_points, {})
        raise SurfaceError(
            f"{path}: no triangles or quadrilaterals, but {', '.join(sorted(kinds))}"
        )
    cells = []
    for k in blocks:
        corners = mesh.cells[k].data[:, : FACES[mesh.cells[k].type]]
        cells.append(
            corners if corners.shape[1] == 4 else np.column_stack([corners, corners[:, 2]])
        )
    at_cells = {
        name: np.concatenate([np.asarray(data[k]) for k in blocks])
        for name, data in mesh.cell_data.items()
    }
    return make(mesh.points, np.concatenate(cells).astype(np.int64), at_points, at_cells)


def _of_vtk(path: Path, make: _Maker) -> Surface:
    file = read_vtk_xml(path)
    if file.kind == "PolyData":
        ends, nodes = file.geometry["Polys.offsets"], file.geometry["Polys.connectivity"]
        begin = np.concatenate([[0], ends[:-1]]).astype(int)
        many = ends - begin
        if not np.isin(many, (3, 4)).all():
            cell = int(np.flatnonzero(~np.isin(many, (3, 4)))[0])
            raise SurfaceError(f"{path}: polygon {cell} has {many[cell]} corners, not 3 or 4")
        fourth = begin + np.minimum(3, many - 1)
        cells = nodes[np.column_stack([begin, begin + 1, begin + 2, fourth])].astype(np.int64)
        return make(file.geometry["Points"], cells, file.points, file.cells)
    shape = file.dimensions or ()
    if shape and sorted(shape)[:2].count(1) != 1:
        raise SurfaceError(f"{path}: a grid of {' × '.join(map(str, shape))} points is no surface")
    points, shape = lattice(path, file)
    number = np.arange(len(points)).reshape(shape, order="F").squeeze()
    cells = np.stack([number[:-1, :-1], number[1:, :-1], number[1:, 1:], number[:-1, 1:]], axis=2)
    at_cells = {name: field for name, field in file.cells.items()}
    return make(points, cells.transpose(1, 0, 2).reshape(-1, 4), file.points, at_cells)


def lattice(path: Path, file: Any) -> tuple[np.ndarray, tuple[int, int, int]]:
    """Points of a grid, shape (n, 3), the first index fastest, and how many there are along each
    index.
    """
    count = prod(file.dimensions or ())
    if count > MOST_POINTS:
        raise SurfaceError(f"{path}: {count} points (allowed: at most {MOST_POINTS})")
    if file.kind == "RectilinearGrid" and len(file.geometry) == 3:
        axes = list(file.geometry.values())
        shape = tuple(len(axis) for axis in axes)
        grid = np.meshgrid(*axes, indexing="ij")
        return np.column_stack([a.ravel(order="F") for a in grid]), shape
    if file.kind == "StructuredGrid" and file.dimensions and "Points" in file.geometry:
        return file.geometry["Points"], file.dimensions
    raise SurfaceError(f"{path}: a {file.kind} is neither a grid nor polygons")
