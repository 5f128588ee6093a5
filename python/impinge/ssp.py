"""Units and their connections as a file of System Structure and Parameterization (SSP 1.0).

    from impinge import ssp

    ssp.write(
        "drop_on_plate.ssp",
        {"drop": "drop.toml", "plate": "plate.fmu"},
        [("drop.wall.heat_flux", "plate.rings.heat_flux")],
        parameters={"plate.plate.conductivity": 12.0},
        stop=2e-6,
    )

Arrays connect by one name, element by element. Units are of FMI 2.0: SSP 1.0 knows no arrays.

What those who run such files make of them: ecospy 0.7 takes connections with their linear
transformations, and the parameters by ``simulation.init(parameter_set="parameters")``. FMPy 0.3
(``fmpy.ssp``) holds inputs at 0 in the first step, whatever their start values are, and reads no
parameters or transformations from the file: it takes parameters as the argument `parameter_set`
of ``simulate_ssp``; connections of temperatures, of which 0 K is refused, want another master.

Source: *System Structure and Parameterization*, version 1.0, https://ssp-standard.org.
"""

from __future__ import annotations

import os
import shutil
import xml.etree.ElementTree as ElementTree
import zipfile
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from .errors import ImpingeError
from .unit import Unit, Variable
from .unit.build import build
from .unit.package import Package, open_package

NAMESPACES = {
    part: f"http://ssp-standard.org/SSP1/SystemStructure{name}"
    for part, name in (("ssd", "Description"), ("ssc", "Common"), ("ssv", "ParameterValues"))
}
ELEMENTS = {"Real": "Real", "Integer": "Integer", "Boolean": "Boolean", "String": "String"}


# One name for the sets of all units, by which they are chosen together
PARAMETERS = "parameters"


class SspError(ImpingeError):
    """A system that cannot be written."""


@dataclass(frozen=True)
class Link:
    """A connection from ``UNIT.OUTPUT`` to ``UNIT.INPUT``: input = factor · output + offset."""

    source: str
    target: str
    factor: float = 1.0
    offset: float = 0.0


def write(
    path: str | os.PathLike[str],
    units: Mapping[str, Any],
    connections: Iterable[tuple[str, str] | Link],
    *,
    parameters: Mapping[str, Any] | None = None,
    name: str | None = None,
    start: float = 0.0,
    stop: float | None = None,
) -> Path:
    """Writes a .ssp file and returns its path.

    Parameters
    ----------
    units
        By their names in the system: scenes (.toml, built for FMI 2.0), .fmu files, folders of
        unzipped ones, or instances of :class:`impinge.Unit`.
    connections
        Pairs ``("drop.wall.heat_flux", "plate.rings.heat_flux")``, the unit's name first, of arrays
        or of single variables; or links with a factor and an offset.
    parameters
        Values before initialisation, by unit and variable: numbers, texts, arrays of their shape.
        Inputs may be among them.
    name
        The system's, by default that of the file.
    start, stop
        Of the default experiment [s].

    Raises
    ------
    SspError
        With the names that are wrong and those that there are.
    """
    path = Path(path)
    for unit in units:
        if not unit or "." in unit or "/" in unit:
            raise SspError(
                f"units: `{unit}` is no name for a unit; it may have no dot and no slash"
            )
    packages = {unit: _package(unit, source) for unit, source in units.items()}
    links = [link if isinstance(link, Link) else Link(*link) for link in connections]
    pairs = [pair for link in links for pair in _expand(link, packages)]
    _refuse_double_targets(pairs)
    tree = _structure(path, packages, pairs, dict(parameters or {}), name, start, stop)
    part = path.with_name(path.name + ".part")
    with zipfile.ZipFile(part, "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr("SystemStructure.ssd", tree)
        for unit, source in units.items():
            _add(archive, f"resources/{unit}.fmu", source, packages[unit])
    part.replace(path)
    return path


def _package(unit: str, source: Any) -> Package:
    if isinstance(source, Unit):
        package = source.package
    elif isinstance(source, Package):
        package = source
    else:
        package = open_package(source)
    if package.fmi != 2:
        raise SspError(f"{unit}: is a unit of FMI {package.fmi}; SSP 1.0 connects those of FMI 2.0")
    return package


def _add(archive: zipfile.ZipFile, name: str, source: Any, package: Package) -> None:
    """Adds the unit's file, or a new one of the folder that it was unzipped into."""
    if isinstance(source, str | os.PathLike) and not Path(source).is_dir():
        file = build(source, fmi=2) if Path(source).suffix == ".toml" else Path(source)
        with archive.open(name, "w", force_zip64=True) as out, open(file, "rb") as content:
            shutil.copyfileobj(content, out)
        return
    with archive.open(name, "w", force_zip64=True) as out:
        with zipfile.ZipFile(out, "w", zipfile.ZIP_DEFLATED) as inner:
            for file in sorted(p for p in package.folder.rglob("*") if p.is_file()):
                inner.write(file, file.relative_to(package.folder).as_posix())


@dataclass(frozen=True)
class _End:
    """An element of a variable of a unit."""

    unit: str
    connector: str
    variable: Variable


def _expand(link: Link, packages: Mapping[str, Package]) -> list[tuple[_End, _End, Link]]:
    source, target = _ends(link.source, "output", packages), _ends(link.target, "input", packages)
    if len(source) != len(target):
        raise SspError(
            f"{link.source} has {len(source)} elements, {link.target} has "
            f"{len(target)}: they do not connect"
        )
    units = source[0].variable.unit, target[0].variable.unit
    if units[0] != units[1] and None not in units and link.factor == 1 and link.offset == 0:
        raise SspError(
            f"{link.source} is measured in {units[0]}, {link.target} in {units[1]}; a "
            "Link converts by factor and offset"
        )
    return [(a, b, link) for a, b in zip(source, target, strict=True)]


def _ends(name: str, causality: str, packages: Mapping[str, Package]) -> list[_End]:
    unit, _, variable_name = name.partition(".")
    if unit not in packages:
        raise SspError(f"{name}: `{unit}` is none of the units {', '.join(packages)}")
    variable = packages[unit].variable(variable_name)
    if variable.causality != causality:
        raise SspError(f"{name}: is no {causality}, but {variable.causality}")
    if variable.kind not in ELEMENTS:
        raise SspError(f"{name}: values of type {variable.kind} do not connect")
    return [_End(unit, label, variable) for label in _labels(variable)]


def _labels(variable: Variable) -> list[str]:
    """Names of the elements of an array, last index fastest."""
    if not variable.shape:
        return [variable.name]
    indices = np.ndindex(*variable.shape)
    return [f"{variable.name}[{','.join(str(i + 1) for i in index)}]" for index in indices]


def _refuse_double_targets(pairs: Sequence[tuple[_End, _End, Link]]) -> None:
    seen: dict[tuple[str, str], str] = {}
    for a, b, _ in pairs:
        key = b.unit, b.connector
        if key in seen:
            raise SspError(f"{b.unit}.{b.connector}: is connected to {seen[key]} already")
        seen[key] = f"{a.unit}.{a.connector}"


def _structure(
    path: Path,
    packages: Mapping[str, Package],
    pairs: Sequence[tuple[_End, _End, Link]],
    parameters: dict[str, Any],
    name: str | None,
    start: float,
    stop: float | None,
) -> bytes:
    for prefix, address in NAMESPACES.items():
        ElementTree.register_namespace(prefix, address)
    title = name or path.stem
    root = _child(None, "ssd:SystemStructureDescription", version="1.0", name=title)
    system = _child(root, "ssd:System", name=title)
    elements = _child(system, "ssd:Elements")
    own = {unit: _of_unit(unit, parameters) for unit in packages}
    if parameters:
        unknown = ", ".join(parameters)
        raise SspError(
            f"parameters: {unknown}: none of the units {', '.join(packages)} has that name"
        )
    for unit, package in packages.items():
        component = _child(
            elements, "ssd:Component", name=unit, type="application/x-fmu-sharedlibrary",
            source=f"resources/{unit}.fmu",
        )  # fmt: skip
        ends = {
            (e.connector, kind): e
            for a, b, _ in pairs
            for e, kind in ((a, "output"), (b, "input"))
            if e.unit == unit
        }
        if ends:
            connectors = _child(component, "ssd:Connectors")
            for (label, kind), end in ends.items():
                connector = _child(connectors, "ssd:Connector", name=label, kind=kind)
                _child(connector, f"ssc:{ELEMENTS[end.variable.kind]}")
        if own[unit]:
            _write_parameters(component, unit, package, own[unit])
    connections = _child(system, "ssd:Connections") if pairs else None
    for a, b, link in pairs:
        connection = _child(
            connections, "ssd:Connection", startElement=a.unit, startConnector=a.connector,
            endElement=b.unit, endConnector=b.connector,
        )  # fmt: skip
        if link.factor != 1 or link.offset != 0:
            _child(
                connection,
                "ssc:LinearTransformation",
                factor=repr(float(link.factor)),
                offset=repr(float(link.offset)),
            )
    times = {
        "startTime": repr(float(start)),
        **({} if stop is None else {"stopTime": repr(float(stop))}),
    }
    _child(root, "ssd:DefaultExperiment", **times)
    ElementTree.indent(root)
    return ElementTree.tostring(root, encoding="utf-8", xml_declaration=True)


def _of_unit(unit: str, parameters: dict[str, Any]) -> dict[str, Any]:
    """Takes the parameters of a unit out of all of them."""
    names = [key for key in parameters if key.startswith(f"{unit}.")]
    return {key.removeprefix(f"{unit}."): parameters.pop(key) for key in names}


def _write_parameters(
    component: ElementTree.Element, unit: str, package: Package, values: Mapping[str, Any]
) -> None:
    bindings = _child(component, "ssd:ParameterBindings")
    inline = _child(_child(bindings, "ssd:ParameterBinding"), "ssd:ParameterValues")
    inner = _child(
        _child(inline, "ssv:ParameterSet", version="1.0", name=PARAMETERS), "ssv:Parameters"
    )
    for name, value in values.items():
        variable = package.variable(name)
        if variable.causality not in ("parameter", "input"):
            raise SspError(f"{unit}.{name}: is no parameter or input, but {variable.causality}")
        given = np.broadcast_to(np.asarray(value, object), variable.shape).ravel()
        for label, one in zip(_labels(variable), given, strict=True):
            parameter = _child(inner, "ssv:Parameter", name=label)
            _child(parameter, f"ssv:{ELEMENTS[variable.kind]}", value=_text(variable.kind, one))


def _text(kind: str, value: Any) -> str:
    match kind:
        case "Real":
            return repr(float(value))
        case "Integer":
            return str(int(value))
        case "Boolean":
            return "true" if value else "false"
    return str(value)


def _child(
    parent: ElementTree.Element | None, element: str, /, **attributes: str
) -> ElementTree.Element:
    prefix, tag = element.split(":")
    full = f"{{{NAMESPACES[prefix]}}}{tag}"
    if parent is None:
        return ElementTree.Element(full, attributes)
    return ElementTree.SubElement(parent, full, attributes)
