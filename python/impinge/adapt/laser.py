"""Maps of a beam's power on the cells of a unit."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from ..reading import open_file, reading
from ..surface import Series, Surface, SurfaceError
from ..surface.arrays import read_datasets
from ..surface.csv_files import read_matrix, read_table
from ..surface.errors import need

PICTURES = {".png", ".jpg", ".jpeg", ".tif", ".tiff", ".bmp", ".gif", ".pgm"}


def read_picture(path: str | Path) -> tuple[np.ndarray | None, np.ndarray]:
    """Times [s], if the file has them, and frames of intensities, shape (frames, rows, columns).

    Pictures (Pillow; colours are made grey, pages are frames), tables of numbers (.csv, .txt),
    .npy, and HDF5 files with a dataset ``intensity`` (rows, columns) or (frames, rows, columns),
    and ``time``.

    Raises
    ------
    SurfaceError
        With the file, and line and column of tables, of what is no intensity.
    """
    path = Path(path)
    with reading(path, SurfaceError):
        open_file(path).close()
        return _read_picture(path)


def _read_picture(path: Path) -> tuple[np.ndarray | None, np.ndarray]:
    times = None
    match path.suffix.lower():
        case ".csv" | ".txt":
            frames = read_matrix(path)
        case ".npy":
            frames = np.load(path, allow_pickle=False)
        case ".h5" | ".hdf5":
            times, frames = _read_hdf5(path)
        case suffix if suffix in PICTURES:
            frames = _read_image(path)
        case suffix:
            raise SurfaceError(
                f"{path}: `{suffix}` is no format of maps: "
                f"{', '.join(sorted(PICTURES))}, .csv, .npy, .h5"
            )
    frames = np.asarray(frames, float)
    if frames.ndim == 2:
        frames = frames[None]
    if frames.ndim != 3 or not frames.size:
        raise SurfaceError(
            f"{path}: of shape {frames.shape}; rows and columns of intensities are needed"
        )
    bad = ~(np.isfinite(frames) & (frames >= 0))
    if bad.any():
        frame, row, column = np.argwhere(bad)[0]
        at = f"line {row + 1}, column {column + 1}" + (
            f" of frame {frame + 1}" if len(frames) > 1 else ""
        )
        raise SurfaceError(f"{path}: {at}: {frames[frame, row, column]} is no intensity")
    return times, frames


def _read_hdf5(path: Path) -> tuple[np.ndarray | None, np.ndarray]:
    h5py = need("h5py")

    with h5py.File(path) as file:
        content = read_datasets(file)
    if "intensity" not in content:
        raise SurfaceError(f"{path}: no dataset `intensity`; there are {', '.join(content)}")
    return content.get("time"), content["intensity"]


def _read_image(path: Path) -> np.ndarray:
    Image, ImageSequence = need("PIL.Image"), need("PIL.ImageSequence")
    with Image.open(path) as image:
        pages = [_grey(page) for page in ImageSequence.Iterator(image)]
    if len({page.shape for page in pages}) > 1:
        raise SurfaceError(f"{path}: its pages have different sizes, so they are no frames")
    return np.array(pages)


def _grey(image: Any) -> np.ndarray:
    """Intensities of one page, with all their bits."""
    is_grey = image.mode in ("L", "I", "F") or image.mode.startswith("I;16")
    return np.array(image if is_grey else image.convert("L"), float)


def laser_frames(
    paths: Sequence[str | Path],
    target: Surface,
    size: Sequence[float],
    *,
    power: float | None = None,
    scale: float | None = None,
    at: Sequence[float] = (0.0, 0.0),
    angle: float = 0.0,
    interval: float | None = None,
    pulse: str | Path | None = None,
    upward: bool = False,
    outside: str = "error",
) -> Series:
    """Heat flux [W/m2] on the cells of `target` over time, whose integral is the beam's power.

    Parameters
    ----------
    paths
        Maps, one for each time; see :func:`read_picture`. The first row is the top one (largest y)
        unless `upward`; columns run along x.
    size
        Extent of a whole map along its columns and its rows [m].
    at, angle
        Where its middle lies on the face [m], and by how much it is turned from x towards y [rad].
    power
        Power that is absorbed [W]; maps are scaled to it, all by one factor, that of the map with
        the largest sum.
    scale
        Instead of `power`: W/m2 of an intensity of 1.
    interval
        Time between maps [s], where a file has no times, or those of several do not ascend.
    pulse
        With a single map: a table with columns time [s] and power [W], in place of `power`. Before
        the first time and after the last a unit holds what it has then.
    outside
        "error" or "drop" for what falls beside the target.
    """
    if (power is None) + (scale is None) + (pulse is None) != 2:
        raise SurfaceError("one of power [W], scale [W/m2] and pulse is needed")
    for name, given in {"power": power, "scale": scale}.items():
        if given is not None and not 0.0 < given < np.inf:
            raise SurfaceError(f"{name} = {given!r}: a finite number above 0 is needed")
    read = [read_picture(path) for path in paths]
    if len({frames.shape[1:] for _, frames in read}) != 1:
        raise SurfaceError(
            f"maps of different sizes: {', '.join(str(f.shape[1:]) for _, f in read)}"
        )
    frames = np.concatenate([frames for _, frames in read])
    # Rows from the top down become the second index, upwards; columns the first.
    frames = (frames if upward else frames[:, ::-1]).transpose(0, 2, 1)
    pixels = Surface.tiles(frames.shape[1:], size, z=target.z)
    cos, sin = np.cos(angle), np.sin(angle)
    nodes = pixels.cells.nodes @ np.array([[cos, sin], [-sin, cos]]) + np.asarray(at, float)
    if angle:
        placed = np.column_stack([nodes, np.full(len(nodes), target.z)])
        pixels = Surface.quads(placed, pixels.cells.corners)
        frames = frames.reshape(len(frames), -1)
    else:
        pixels = Surface.tiles(frames.shape[1:], size, at, z=target.z)
    sums = np.atleast_1d(pixels.integral(frames))
    if not sums.max() > 0:
        raise SurfaceError(f"{paths[0]}: is dark everywhere")
    if scale is not None:
        frames = frames * scale
    else:
        frames = frames * ((1.0 if power is None else power) / sums.max())
    flux = pixels.map_to(target, outside=outside)(frames)
    if pulse is not None:
        if len(frames) > 1:
            raise SurfaceError(f"{pulse}: a pulse shapes a single map; there are {len(frames)}")
        return _shaped(Path(pulse), flux[0])
    times = _times([times for times, _ in read])
    is_restarted = len(read) > 1 and times is not None and not (np.diff(times) > 0).all()
    if times is None or (is_restarted and interval):
        if len(flux) > 1 and not interval:
            raise SurfaceError("the time between maps (interval) is needed")
        times = np.arange(len(flux)) * (interval or 0.0)
    return Series(times, flux)


def _times(found: Sequence[np.ndarray | None]) -> np.ndarray | None:
    """Times of all maps, if all files have some."""
    known = [np.atleast_1d(times) for times in found if times is not None]
    return np.concatenate(known) if len(known) == len(found) else None


def _shaped(path: Path, flux: np.ndarray) -> Series:
    names, rows = read_table(path)
    if not {"time", "power"} <= set(names):
        raise SurfaceError(
            f"{path}: columns time and power are needed; there are {', '.join(names)}"
        )
    times, power = rows[:, names.index("time")], rows[:, names.index("power")]
    if not (power >= 0.0).all():
        raise SurfaceError(f"{path}: power = {power.min()!r}: a power of 0 or more is needed")
    return Series(times, np.multiply.outer(power, flux))
