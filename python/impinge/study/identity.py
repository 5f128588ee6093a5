"""Hashes that identify a row by its unit and by all that is done with it."""

from __future__ import annotations

import hashlib
import inspect
import json
from pathlib import Path
from typing import Any

import numpy as np

from .functions import hash_of_function, word
from .outputs import Output
from .runner import Experiment, Row
from .signals import Table


def hash_of_unit(folder: Path) -> str:
    """SHA-256 of an unzipped unit: its description, resources and libraries, names and contents."""
    digest = hashlib.sha256()
    for path in sorted(p for p in folder.rglob("*") if p.is_file()):
        place = path.relative_to(folder).as_posix()
        if place == "modelDescription.xml" or place.startswith(("binaries/", "resources/")):
            digest.update(word(place.encode()) + hashlib.sha256(path.read_bytes()).digest())
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
    return f"function {head}, sha256 {hash_of_function(signal)}" + (f"\n{source}" * bool(source))


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
        return ["function", hash_of_function(thing)]
    return thing
