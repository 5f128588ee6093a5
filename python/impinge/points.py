"""Outputs that are values at one point in the middle of a load, and means to take instead."""

from __future__ import annotations

import re
import tomllib
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from math import hypot
from typing import Any

from impinge import measure
from impinge.errors import UnitError
from impinge.unit import Package

_ROUND = ("disc", "gaussian")
_SAME = 1e-3  # of a load's radius: a point nearer to its axis lies on it
_QUANTITY = re.compile(r"\s*([-+]?[\d.]+(?:e[-+]?\d+)?)\s*(\D.*?)?\s*", re.I)


@dataclass(frozen=True)
class Spot:
    """A round load on a face: its name, what its middle depends on, and where it is [m]."""

    name: str
    depends: str
    face: str
    centre: tuple[float, float]
    radius: float
    footprint: str


def notes_on_points(
    package: Package, outputs: Iterable[str], moved: Iterable[str] = ()
) -> list[str]:
    """Notes on outputs that are values of a probe on a loaded face in the middle of a drop or spot,
    with the mean to take instead; one note for each probe.

    moved: names of variables whose values are not those of the scene.
    """
    path = package.folder / "resources/scene.toml"
    try:
        scene = tomllib.loads(path.read_text(encoding="utf-8"))
    except (OSError, ValueError):
        return []  # a unit of another tool
    asked: dict[str, list[str]] = {}
    for name in dict.fromkeys(outputs):
        probe, _, quantity = name.rpartition(".")
        asked.setdefault(probe, []).append(quantity)
    found = []
    for probe in scene.get("probe", []):
        quantities = asked.get(probe.get("name"), [])
        spot = _spot_above(scene, probe, set(moved)) if quantities else None
        if spot:
            found.append(_note(package, scene, probe, quantities, spot))
    return found


def _note(
    package: Package,
    scene: Mapping[str, Any],
    probe: Mapping[str, Any],
    quantities: list[str],
    spot: Spot,
) -> str:
    name = str(probe["name"])
    told = ", ".join(f"{name}.{quantity}" for quantity in quantities)
    several = len(quantities) > 1
    begin = (
        f"{told} {'are values' if several else 'is the value'} at one point, under the axis of"
        f" `{spot.name}`, where {'they depend' if several else 'it depends'} most on"
        f" {spot.depends}; a mean over the footprint depends less on"
        f" {'these' if ' and ' in spot.depends else 'it'}:"
    )
    means = [_mean_of(package, scene, spot, quantity) for quantity in quantities]
    if all(means):
        return f"{begin} {', '.join(means)}"
    gives = [g for g in probe.get("gives", []) if any(q.startswith(g) for q in quantities)]
    table = [
        f'name = "{name}_mean"',
        f'on = "{spot.face}"',
        f"footprint = {{ {spot.footprint} = {{ radius = {spot.radius:g} }} }}",
        *([f"at = [{spot.centre[0]:g}, {spot.centre[1]:g}]"] if any(spot.centre) else []),
        "gives = [" + ", ".join(f'"{g}"' for g in gives) + "]",
    ]
    names = ", ".join(f"{name}_mean.{quantity}" for quantity in quantities)
    return f"{begin} {names}, with a table [[field]] in the scene of {', '.join(table)}"


def _mean_of(package: Package, scene: Mapping[str, Any], spot: Spot, quantity: str) -> str:
    """The mean of a quantity around the middle of a spot that the unit has already, or nothing."""
    for field in scene.get("field", []):
        footprint = field.get("footprint") or {}
        if field.get("on") != spot.face or not {*_ROUND, "rings"} & footprint.keys():
            continue
        centre = [_metres(x) for x in field.get("at", [0.0, 0.0])]
        if None in centre or not _is_at(centre, spot):
            continue
        name = f"{field.get('name')}.{quantity}" + ("[1]" if "rings" in footprint else "")
        try:
            return package.variable(name).name
        except UnitError:
            continue
    return ""


def _spot_above(scene: Mapping[str, Any], probe: Mapping[str, Any], moved: set[str]) -> Spot | None:
    """The drop or spot whose axis a probe lies on, on the face that it loads."""
    at = [_metres(x) for x in probe.get("at", [])]
    if len(at) != 3 or None in at:
        return None
    body = scene.get("body", {}).get(probe.get("in"), {})
    faces = {
        f"{probe.get('in')}.{face}"
        for face, z in (("top", 0.0), ("bottom", _thickness(body)))
        if z is not None and abs(at[2] + z) <= 1e-9 * (1.0 + abs(z))
    }
    spots = (spot for spot in (*_drops(scene), *_spots(scene, moved)) if spot.face in faces)
    return next((spot for spot in spots if _is_at(at, spot)), None)


def _drops(scene: Mapping[str, Any]) -> Iterator[Spot]:
    for coupling in scene.get("coupling", []):
        name = coupling.get("from")
        drop = scene.get("body", {}).get(name, {})
        diameter = _metres(drop.get("diameter"))
        if drop.get("kind") != "droplet" or diameter is None:
            continue
        has_particles = drop.get("method", "sph") == "sph"
        depends = "particles and mesh" if has_particles else "the mesh"
        for arrival in drop.get("arrivals", [{}]):
            centre = [_metres(arrival.get(key, 0.0)) for key in ("x", "y")]
            x, y = centre
            if x is not None and y is not None:
                face = str(coupling.get("to"))
                yield Spot(str(name), depends, face, (x, y), diameter / 2, "disc")


def _spots(scene: Mapping[str, Any], moved: set[str]) -> Iterator[Spot]:
    for load in scene.get("load", []):
        name = str(load.get("name"))
        if moved & {f"{name}.x", f"{name}.y"}:
            continue
        start = load.get("start", {})
        x, y = (_metres(start.get(key, 0.0)) for key in ("x", "y"))
        for kind in _ROUND:
            radius = _metres((load.get("footprint", {}).get(kind) or {}).get("radius"))
            if None not in (radius, x, y):
                yield Spot(name, "the mesh", str(load.get("on")), (x, y), radius, kind)


def _is_at(at: list[float | None], spot: Spot) -> bool:
    x, y = at[:2]
    return hypot((x or 0.0) - spot.centre[0], (y or 0.0) - spot.centre[1]) <= _SAME * spot.radius


def _thickness(body: Mapping[str, Any]) -> float | None:
    """Extent of a solid along z [m], where its shape says it."""
    shape = body.get("shape", {})
    if isinstance(box := shape.get("box"), list) and len(box) == 3:
        return _metres(box[2])
    return _metres((shape.get("disc") or {}).get("thickness"))


def _metres(value: Any) -> float | None:
    """A length of a scene: a number in m, or a text with a unit."""
    if isinstance(value, int | float):
        return float(value)
    parts = _QUANTITY.fullmatch(value) if isinstance(value, str) else None
    if not parts:
        return None
    try:
        return float(parts[1]) * (measure.parse(parts[2]).factor if parts[2] else 1.0)
    except ValueError:
        return None
