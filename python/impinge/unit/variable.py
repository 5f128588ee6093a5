"""Variables of a unit: single ones and families `name[i,j]`, which count as one array."""

import re
from collections.abc import Iterable
from dataclasses import dataclass, field
from math import prod
from typing import Any

import numpy as np

from impinge.unit.identities import check_identities

# What FMPy calls a variable's type, by what its values are here. FMI 2.0 knows the first row only.
NUMBERS: dict[str, Any] = {
    "Real": np.float64,
    "Integer": np.int32,
    "Boolean": np.int32,
    "Enumeration": np.int32,
    "Float64": np.float64,
    "Float32": np.float32,
    "Int8": np.int8,
    "UInt8": np.uint8,
    "Int16": np.int16,
    "UInt16": np.uint16,
    "Int32": np.int32,
    "UInt32": np.uint32,
    "Int64": np.int64,
    "UInt64": np.uint64,
}
_LARGEST_REFERENCE = 2**32 - 1
_INDICES = re.compile(r"^(?P<stem>.+)\[(?P<indices>\d+(?:,\s*\d+)*)\]$")


@dataclass(frozen=True, eq=False)
class Variable:
    """A variable of a unit, or a family of them that fills an array.

    `references` are FMI's value references: one for each element in FMI 2.0, last index fastest,
    one in all in FMI 3.0. `element` is the place within the array of FMI 3.0 for what stands for
    one of its elements. `start`, `nominal`, `min` and `max` are in the unit `unit`.
    """

    name: str
    causality: str
    variability: str
    kind: str
    unit: str | None
    quantity: str | None
    start: Any
    nominal: float
    min: float | None
    max: float | None
    shape: tuple[int, ...]
    description: str
    references: np.ndarray = field(repr=False)
    element: int | None = field(default=None, repr=False)

    @property
    def size(self) -> int:
        """How many values there are."""
        return prod(self.shape)

    @property
    def is_number(self) -> bool:
        """Whether values are numbers (or true and false), not texts or bytes."""
        return self.kind in NUMBERS or self.kind == "Boolean"

    @property
    def is_discrete(self) -> bool:
        """True if values hold over a step: whole numbers and the like, and counts among reals."""
        return not (self.is_real or self.kind == "Float32") or self.variability == "discrete"

    @property
    def is_real(self) -> bool:
        """Whether values are real numbers of double precision."""
        return self.kind in ("Real", "Float64")


@dataclass(frozen=True)
class Capabilities:
    """What a unit says it can do.

    `interpolates` is the order of the polynomials in time that inputs may follow over a step: 0
    where they are held. `output_derivatives` is the highest order of these.
    """

    states: bool
    serialise: bool
    interpolates: int
    output_derivatives: int
    variable_steps: bool
    directional_derivatives: bool
    adjoint_derivatives: bool
    early_return: bool
    once_per_process: bool


def read_variables(description: Any, fmi: int) -> tuple[dict[str, Variable], dict[str, Variable]]:
    """Variables by name, families as one; and apart from them the elements of families.

    Raises `ValueError` for variables that contradict each other, or themselves.
    """
    kinds = {definition.name: definition for definition in description.typeDefinitions}
    singles = [_single(variable, kinds) for variable in description.modelVariables]
    check_identities(singles, fmi)
    families = _families(singles)
    variables: dict[str, Variable] = {}
    elements: dict[str, Variable] = {}
    for single in singles:
        stem = families.get(single.name)
        if stem is None:
            variables[single.name] = single
            continue
        elements[single.name] = single
        if stem not in variables:
            variables[stem] = single  # keeps the place of the family
    members: dict[str, list[Variable]] = {}
    for name, stem in families.items():
        members.setdefault(stem, []).append(elements[name])
    for stem, list_ in members.items():
        variables[stem] = _join(stem, list_)
    return variables, elements


def element_of(array: Variable, name: str) -> Variable | None:
    """The element `name` = `array[i,j]` of an array of FMI 3.0, counted from 1."""
    indices = [index - 1 for index in indices_of(name)]
    if not indices or not array.shape or len(array.references) != 1:
        return None
    if len(indices) != len(array.shape):
        return None
    if any(not 0 <= i < count for i, count in zip(indices, array.shape, strict=True)):
        return None
    place = int(np.ravel_multi_index(indices, array.shape))
    start = None if array.start is None else np.ravel(array.start)[place]
    return Variable(
        **{
            **vars(array),
            "name": name,
            "shape": (),
            "start": start,
            "element": place,
        }
    )


def stem_of(name: str) -> str:
    """The name without indices."""
    found = _INDICES.match(name)
    return found["stem"] if found else name


def indices_of(name: str) -> tuple[int, ...]:
    """The indices that a name ends with, counted from 1; none of a whole array."""
    found = _INDICES.match(name)
    return tuple(int(index) for index in found["indices"].split(",")) if found else ()


def _number(text: Any) -> float | None:
    try:
        return float(text)
    except (TypeError, ValueError):
        return None


def _reference(variable: Any) -> int:
    reference = int(variable.valueReference)
    if not 0 <= reference <= _LARGEST_REFERENCE:
        allowed = f"0 to {_LARGEST_REFERENCE}"
        raise ValueError(f"`{variable.name}`: valueReference is {reference} (allowed: {allowed})")
    return reference


def _start(name: str, text: Any, kind: str, shape: tuple[int, ...]) -> Any:
    try:
        return _start_of(text, kind, shape)
    except (ValueError, OverflowError) as error:
        raise ValueError(f"`{name}`: start: {error}") from None


def _start_of(text: Any, kind: str, shape: tuple[int, ...]) -> Any:
    if text is None:
        return None
    if kind in ("String", "Binary"):
        return text
    words = text if isinstance(text, list) else str(text).split()
    if kind == "Boolean":
        values = np.array([word in ("true", "1") for word in words])
    else:
        numbers = np.array([float(word) for word in words])
        if not np.isfinite(numbers).all():
            raise ValueError(f"{text} is not finite")
        values = numbers.astype(NUMBERS.get(kind, np.float64))
    if not shape:
        return values[0].item() if len(values) else None
    return np.broadcast_to(values, prod(shape)).reshape(shape) if len(values) else None


def _single(variable: Any, kinds: dict[str, Any]) -> Variable:
    declared = variable.declaredType
    declared = kinds.get(declared) if isinstance(declared, str) else declared

    def said(key: str) -> Any:
        own = getattr(variable, key, None)
        return own if own is not None else getattr(declared, key, None)

    shape = tuple(variable.shape or ())
    kind = variable.type
    return Variable(
        name=variable.name,
        causality=variable.causality or "local",
        variability=variable.variability or "continuous",
        kind=kind,
        unit=said("unit"),
        quantity=said("quantity"),
        start=_start(variable.name, variable.start, kind, shape),
        nominal=_number(said("nominal")) or 1.0,
        min=_number(said("min")),
        max=_number(said("max")),
        shape=shape,
        description=variable.description or "",
        references=np.array([_reference(variable)], dtype=np.uint32),
    )


def _families(singles: Iterable[Variable]) -> dict[str, str]:
    """The stem of every variable that, with others, fills an array whose indices count from 1."""
    groups: dict[str, list[tuple[tuple[int, ...], Variable]]] = {}
    taken = set()
    for single in singles:
        found = _INDICES.match(single.name)
        if not found or single.shape:
            taken.add(single.name)
            continue
        groups.setdefault(found["stem"], []).append((indices_of(single.name), single))
    stems = {}
    for stem, group in groups.items():
        ranks = {len(indices) for indices, _ in group}
        alike = {(v.kind, v.causality, v.variability) for _, v in group}
        if stem in taken or len(ranks) != 1 or len(alike) != 1:
            continue
        shape = tuple(
            max(indices) for indices in zip(*(indices for indices, _ in group), strict=True)
        )
        if len({indices for indices, _ in group}) != len(group) or prod(shape) != len(group):
            continue
        if any(min(indices) < 1 for indices, _ in group):
            continue
        stems.update({single.name: stem for _, single in group})
    return stems


def _join(stem: str, members: list[Variable]) -> Variable:
    members = sorted(members, key=lambda member: indices_of(member.name))
    first = members[0]
    shape = indices_of(members[-1].name)
    starts = [member.start for member in members]
    start = None if any(s is None for s in starts) else np.array(starts).reshape(shape)
    return Variable(
        **{
            **vars(first),
            "name": stem,
            "start": start,
            "shape": shape,
            "references": np.concatenate([member.references for member in members]),
        }
    )
