"""What tells one row from all others: a hash of its unit and of all that is done with it."""

from __future__ import annotations

import hashlib
import inspect
import json
import types
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

import numpy as np

from .outputs import Output
from .runner import Experiment, Row
from .signals import Table


def hash_of_unit(folder: Path) -> str:
    """SHA-256 of an unzipped unit: its description, resources and libraries, names and contents."""
    digest = hashlib.sha256()
    for path in sorted(p for p in folder.rglob("*") if p.is_file()):
        place = path.relative_to(folder).as_posix()
        if place == "modelDescription.xml" or place.startswith(("binaries/", "resources/")):
            digest.update(_word(place.encode()) + hashlib.sha256(path.read_bytes()).digest())
    return digest.hexdigest()


def hash_of_experiment(unit: str, experiment: Experiment) -> str:
    """SHA-256 of a unit, given by its own hash, and of what all rows share."""
    said = {
        "unit": unit,
        "stop": experiment.stop,
        "step": experiment.step,
        "inputs": {name: _tell(signal) for name, signal in sorted(experiment.inputs.items())},
        "outputs": [_tell(output) for output in experiment.outputs],
    }
    return hashlib.sha256(json.dumps(said, sort_keys=True).encode()).hexdigest()


def key_of_row(experiment: str, row: Row) -> str:
    """The key of a row of an experiment, given by its hash."""
    said = [experiment, row.scene, dict(row.parameters), dict(row.inputs), dict(row.sampled)]
    return hashlib.sha256(json.dumps(said, sort_keys=True).encode()).hexdigest()[:32]


def told(signal: Any) -> str:
    """An input over time in words: a function by its name, hash and, where it is known, source."""
    if not callable(signal):
        return repr(signal)
    name = getattr(signal, "__qualname__", type(signal).__qualname__)
    try:
        source = inspect.cleandoc(inspect.getsource(signal))
    except (OSError, TypeError):  # typed in, or not of Python
        source = ""
    head = f"{getattr(signal, '__module__', '') or ''}.{name}".lstrip(".")
    return f"function {head}, sha256 {_hash_of_function(signal)}" + (f"\n{source}" * bool(source))


def _tell(thing: Any) -> Any:
    """What JSON can hold and is the same for the same thing in any process."""
    if isinstance(thing, Table):
        return ["table", thing.times.tolist(), thing.values.tolist(), thing.hold]
    if isinstance(thing, Output):
        function = _tell(thing.function) if thing.function else None
        return [thing.name, list(thing.needs), thing.kind, function]
    if isinstance(thing, np.ndarray):
        return thing.tolist()
    if callable(thing):
        return ["function", _hash_of_function(thing)]
    return thing


def _hash_of_function(function: Callable[..., Any]) -> str:
    """A hash of a function's instructions, constants and what it holds from where it was made; not
    of what other functions that it calls do."""
    digest = hashlib.sha256()
    _add(digest, function, set())
    return digest.hexdigest()


def _add(digest: Any, thing: Any, seen: set[int]) -> None:
    if id(thing) in seen:
        return
    if isinstance(thing, types.MethodType):
        _add(digest, thing.__func__, seen)
        _add(digest, thing.__self__, seen)
    elif isinstance(thing, types.FunctionType):
        seen = seen | {id(thing)}
        _add(digest, thing.__code__, seen)
        cells = [cell.cell_contents for cell in thing.__closure__ or ()]
        for part in (cells, thing.__defaults__, thing.__kwdefaults__):
            _add(digest, part, seen)
        for name in sorted(set(thing.__code__.co_names) & set(thing.__globals__)):
            value = thing.__globals__[name]
            if isinstance(value, int | float | str | bytes | tuple | np.ndarray):
                _add(digest, (name, value), seen)
    elif isinstance(thing, types.CodeType):
        digest.update(_word(thing.co_code))
        names = (thing.co_names, thing.co_varnames, thing.co_freevars)
        digest.update(_word(repr(names).encode()))
        for constant in thing.co_consts:
            _add(digest, constant, seen)
    elif isinstance(thing, np.ndarray):
        digest.update(_word(str((thing.dtype, thing.shape)).encode() + thing.tobytes()))
    elif isinstance(thing, Mapping):
        for key in sorted(thing, key=repr):
            _add(digest, key, seen)
            _add(digest, thing[key], seen)
    elif isinstance(thing, set | frozenset):
        _add(digest, sorted(map(repr, thing)), seen)
    elif isinstance(thing, list | tuple):
        digest.update(_word(f"{type(thing).__name__} {len(thing)}".encode()))
        for item in thing:
            _add(digest, item, seen)
    elif isinstance(thing, int | float | complex | str | bytes | type(None)):
        digest.update(_word(repr(thing).encode()))
    elif hasattr(thing, "__dict__") and not isinstance(thing, type | types.ModuleType):
        seen = seen | {id(thing)}
        digest.update(_word(type(thing).__qualname__.encode()))
        _add(digest, vars(thing), seen)
    else:
        named = getattr(thing, "__qualname__", None) or getattr(thing, "__name__", None)
        digest.update(_word(str(named or type(thing).__qualname__).encode()))


def _word(content: bytes) -> bytes:
    return f"{len(content)} ".encode() + content
