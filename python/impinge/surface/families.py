"""Surfaces of the cells and points that units and scenes declare."""

from __future__ import annotations

import math
import tomllib
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from ..errors import UnitError
from ..measure import metres
from ..reading import LARGEST_JSON, LARGEST_SCENE, read_bytes, reading
from ..unit.archive import open_archive
from ..unit.cells import PLACE, is_per_depth, parse_cells
from .cells import Scattered
from .errors import SurfaceError
from .surface import Surface


def family(unit: Any, name: str, z: float | None = None) -> Surface:
    """The surface of a family of a unit: of a load, wall or field `name`.

    `unit` has a method ``cells(name)`` (an :class:`impinge.Unit`, whose loads are where, and as
    large as, its inputs say now), or is the path of a .fmu file or of a folder it was unzipped
    into, whose ``resources/cells.json`` is read, or of a scene (.toml), both with loads as they
    start. Of a scene `name` may be a face, ``plate.bottom``, too, which is one cell. `z` is the
    height of the face [m] where they do not tell it: 0, that of tops, if it is not given.

    Raises
    ------
    SurfaceError
        If there is no such family, or if its footprint has no cells, as a Gaussian has none.
    """
    if hasattr(unit, "cells"):
        return from_cells(_present_cells(unit, name), name, z)
    path = Path(unit)
    with reading(path, SurfaceError):
        if path.suffix == ".toml":
            surface = _of_scene(path, name)
            return surface if z is None else replace(surface, z=z)
        families = _read_cells(path)
        if name not in families:
            raise SurfaceError(f"{path}: `{name}` is none of its families: {', '.join(families)}")
        return from_cells(families[name], name, z)


def _present_cells(unit: Any, name: str) -> dict[str, Any]:
    """The cells of a unit; of an open one those of a load where, and as large as, it is now."""
    cells = dict(unit.cells(name))
    inputs = unit.placement(name) if getattr(unit, "is_open", False) else {}
    present = {key: unit[variable.name] for key, variable in inputs.items()}
    at = cells.get("at", (0.0, 0.0))
    if inputs:
        cells["at"] = [present.get(axis, start) for axis, start in zip("xy", at, strict=True)]
    for axis, start in zip("xy", at, strict=True):
        if axis in present and axis in cells:
            cells[axis] = np.add(cells[axis], present[axis] - start)
    if "radius" in present:
        growth = present["radius"] / inputs["radius"].start
        for key, power in (("inner", 1), ("outer", 1), ("area", 2)):
            cells[key] = np.multiply(cells[key], growth**power)
    return cells


def _read_cells(path: Path) -> dict[str, Any]:
    try:
        content = _cells_file(path)
    except (KeyError, FileNotFoundError):
        what = f"no {PLACE}" if path.exists() else "no such file"
        raise SurfaceError(f"{path}: {what}; a scene (.toml) tells its cells, too") from None
    except UnitError as error:
        raise SurfaceError(f"{error}; neither a unit (.fmu) nor a scene (.toml)") from None
    with reading(f"{path}: {PLACE}", SurfaceError):
        return parse_cells(content)


def _cells_file(path: Path) -> bytes:
    if path.is_dir():
        return read_bytes(path / PLACE, LARGEST_JSON)
    with open_archive(path, path) as archive:
        if PLACE in archive.namelist():
            return archive.read(PLACE)
    raise KeyError(PLACE)


def from_cells(cells: dict[str, Any], name: str, z: float | None = None) -> Surface:
    """The surface of an entry of ``resources/cells.json``."""
    with reading(name, SurfaceError):
        return _from_cells(cells, name, z)


def _from_cells(cells: dict[str, Any], name: str, z: float | None) -> Surface:
    footprint = cells["footprint"]
    x, y = (np.asarray(cells.get(axis, []), float).ravel() for axis in "xy")
    heights = np.asarray(cells.get("z", []), float).ravel()
    at = cells.get("at", (x[0], y[0]) if len(x) else (0.0, 0.0))
    if z is None and not len(heights) and cells.get("on", "").endswith(".bottom"):
        raise SurfaceError(
            f"{name}: lies on {cells['on']}, whose height it does not tell; give z [m]"
        )
    if z is None:
        z = float(heights[0]) if len(heights) else 0.0
    match footprint:
        case "rings" | "disc" | "ring":
            outer = np.asarray(cells["outer"], float).ravel()
            inner = np.asarray(cells.get("inner", np.zeros(len(outer))), float).ravel()
            surface = Surface.ring_edges([inner[0], *outer], at, z=z)
        case "tiles":
            size = np.asarray(cells.get("size", cells.get("width")), float).ravel()
            count = tuple(int(n) for n in cells["count"])
            middle = 0.5 * (x.min() + x.max()), 0.5 * (y.min() + y.max())
            surface = Surface.tiles(count, size * count, middle, z=z)
            if is_per_depth(cells):
                surface = replace(surface, depth=float(size[1]))
        case "grid":
            surface = _grid(cells, x, y, name)
        case _:
            raise SurfaceError(
                f"{name}: a footprint `{footprint}` has no cells to map to; take rings or tiles"
            )
    if isinstance(surface.cells, Scattered):
        return surface
    areas = np.asarray(cells.get("area", surface.areas), float).ravel()
    if areas.shape == surface.areas.ravel().shape:
        apart = np.abs(areas / surface.areas.ravel() - 1).max()
        if apart > 1e-9:
            raise SurfaceError(
                f"{name}: areas of the unit differ from those of its cells by {apart:.3g} of them"
            )
    return surface


def _grid(cells: dict[str, Any], x: np.ndarray, y: np.ndarray, name: str) -> Surface:
    """Points on a face, or, where they vary through the depth, in a section."""
    z = np.asarray(cells.get("z", [0.0]), float).ravel()
    count = tuple(int(n) for n in cells["count"])
    if np.ptp(z) > 1e-9 * max(np.ptp(x), np.ptp(y), np.ptp(z)) or len(count) != 2:
        return Surface.points(np.column_stack([np.broadcast_to(a, len(x)) for a in (x, y, z)]))
    x, y = x.reshape(count), y.reshape(count)
    steps = cells.get("size") or cells.get("width")
    if steps is None:
        steps = [np.ptp(a) / max(n - 1, 1) for a, n in zip((x, y), count, strict=True)]
        steps = [s or max(steps) or 1.0 for s in steps]
    middle = 0.5 * (x.min() + x.max()), 0.5 * (y.min() + y.max())
    surface = Surface.grid(count, np.array(steps) * count, middle, z=float(z[0]))
    places = np.column_stack([x.ravel(), y.ravel()])
    if np.abs(surface.coordinates[:, :2] - places).max() > 1e-9 * max(steps) * max(count):
        raise SurfaceError(f"{name}: its points are no grid along x and y")
    return surface


def _of_scene(path: Path, name: str) -> Surface:
    """Loads and walls with rings, tiles or a disc, and fields with a size, as the scene has
    them.
    """
    scene = tomllib.loads(read_bytes(path, LARGEST_SCENE).decode())
    kinds = ("load", "wall", "field")
    entries = {
        e.get("name", scene.get("name", "")): e for kind in kinds for e in scene.get(kind, [])
    }
    if name not in entries and name.partition(".")[2] in ("top", "bottom"):
        return _of_face(scene, name, path)
    if name not in entries:
        raise SurfaceError(
            f"{path}: `{name}` is none of its loads, walls and fields: {', '.join(entries)}"
        )
    entry = entries[name]
    at = _middle(entry)
    z = _height(scene, entry, path, name)
    footprint = entry.get("footprint", {})
    if "grid" in entry:
        return Surface.grid(entry["grid"], _size(scene, entry, path, name), z=z)
    match footprint:
        case {"rings": {"count": count, "radius": radius}}:
            return Surface.rings(count, _outer(entry, radius), at, z=z)
        case {"tiles": {"count": count, "size": size}}:
            size = _metres(*size)
            depth = size[1] if _is_plane_wall(scene, entry) else 1.0
            return replace(Surface.tiles(count, size, at, z=z), depth=depth)
        case {"disc": {"radius": radius}}:
            return Surface.rings(1, _outer(entry, radius), at, z=z)
        case {"ring": {"inner": inner, "outer": outer}}:
            inner, own = _metres(inner, outer)
            outer = _outer(entry, outer)
            return Surface.ring_edges((inner * (outer / own), outer), at, z=z)
    raise SurfaceError(
        f"{path}: `{name}` has no rings, tiles, disc or grid to map to, but {footprint or entry}"
    )


def _is_plane_wall(scene: dict[str, Any], entry: dict[str, Any]) -> bool:
    """True for the wall of a plane drop, which has a single row of tiles."""
    return scene.get("body", {}).get(entry.get("under"), {}).get("dimension") == 2


def _metres(*given: Any) -> tuple[float, ...]:
    """Lengths of a scene, numbers or texts with a unit [m]."""
    found = []
    for value in given:
        length = metres(value)
        if length is None:
            raise SurfaceError(f'{value!r} is no length (allowed: metres, or a text as in "8 mm")')
        found.append(length)
    return tuple(found)


def _middle(entry: dict[str, Any]) -> tuple[float, ...]:
    """Returns the middle of the footprint of a field, or of a load at the start [m]."""
    start = entry.get("start", {})
    return _metres(*entry.get("at", (start.get("x", 0.0), start.get("y", 0.0))))


def _outer(entry: dict[str, Any], own: Any) -> float:
    """Outer radius [m] of a round footprint: its own, or that of a load at the start."""
    (radius,) = _metres(entry.get("start", {}).get("radius", own))
    return radius


def _size(scene: dict[str, Any], entry: dict[str, Any], path: Path, name: str) -> tuple[float, ...]:
    """Extents of a grid [m]: its own, or those of the face; of the inscribed square of a disc."""
    if "size" in entry:
        return _metres(*entry["size"])
    x, y, _ = _extent(scene, entry, path, name)
    is_round = "disc" in scene["body"][entry["on"].partition(".")[0]]["shape"]
    return (x / math.sqrt(2.0), y / math.sqrt(2.0)) if is_round else (x, y)


def _of_face(scene: dict[str, Any], name: str, path: Path) -> Surface:
    """A whole top or bottom as one cell."""
    entry = {"on": name}
    z, (lx, ly, _) = _height(scene, entry, path, name), _extent(scene, entry, path, name)
    if "disc" in scene["body"][name.partition(".")[0]]["shape"]:
        return Surface.rings(1, 0.5 * lx, z=z)
    return Surface.tiles((1, 1), (lx, ly), z=z)


def _height(scene: dict[str, Any], entry: dict[str, Any], path: Path, name: str) -> float:
    """Height [m] of the top or bottom of a body; a wall lies at 0."""
    face = entry.get("on", "").partition(".")[2]
    if face == "bottom":
        return -_extent(scene, entry, path, name)[2]
    if face == "top" or "under" in entry:
        return 0.0
    raise SurfaceError(
        f"{path}: `{name}` lies on {entry.get('on', 'a section')}; surfaces are tops and bottoms"
    )


def _extent(
    scene: dict[str, Any], entry: dict[str, Any], path: Path, name: str
) -> tuple[float, ...]:
    body = entry["on"].partition(".")[0]
    match scene.get("body", {}).get(body, {}).get("shape", {}):
        case {"box": [x, y, z]}:
            return _metres(x, y, z)
        case {"disc": {"radius": r, "thickness": z}}:
            radius, thickness = _metres(r, z)
            return 2 * radius, 2 * radius, thickness
    raise SurfaceError(f"{path}: `{name}`: body `{body}` has no box or disc")
