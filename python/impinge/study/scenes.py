"""Scenes whose keys a study changes, and units of them that share one library.

`build-fmu --xml` checks a changed scene and tells its description in milliseconds. With the scene
itself and the library of the unchanged unit that is a unit.
"""

from __future__ import annotations

import copy
import hashlib
import json
import subprocess
import tempfile
import tomllib
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

import tomli_w

from impinge.errors import UnitError
from impinge.reading import LARGEST_SCENE, read_bytes, reading
from impinge.unit import Package
from impinge.unit.build import files_of, find_program
from impinge.unit.temporary import temporary_folder

# What the study itself decides, or what names the library.
_KEPT = {"name": "names the library", "stop_time": "is the study's stop", "step": "is its step"}


@dataclass(frozen=True)
class Variant:
    """A scene that differs from the study's own, and the description of its unit."""

    scene: str
    description: str

    def unpack(self, base: Path, folder: Path) -> Package:
        """Its unit in `folder`, with the library of the unit in `base`."""
        (folder / "resources").mkdir()
        (folder / "resources/scene.toml").write_text(self.scene)
        (folder / "modelDescription.xml").write_text(self.description)
        (folder / "binaries").symlink_to((base / "binaries").resolve())
        digest = hashlib.sha256(self.description.encode()).hexdigest()
        return Package(folder, digest, "a changed scene")


class Scene:
    """A scene whose keys go by dotted paths: `body.plate.shape.box.2`, `load.0.start.heat_flux`.

    Lists take indices from 0 or, where their tables have names, these: `load.spot.footprint`.
    """

    def __init__(self, path: Path, fmi: int):
        self.path = path
        self.fmi = fmi
        with reading(path, UnitError):
            self.text = read_bytes(path, LARGEST_SCENE).decode()
            self.content = tomllib.loads(self.text)
        if files := files_of(self.text.encode(), path.parent):
            self.content["files"] = {name: file.decode() for name, file in files.items()}

    def has(self, key: str) -> bool:
        """Whether the scene has this key, or a table below its top in which it may stand."""
        if "." not in key:
            return key in self.content
        try:
            parent, last = self._find(self.content, key)
        except KeyError:
            return False
        return isinstance(parent, dict) or (isinstance(last, int) and last < len(parent))

    def changed(self, values: Mapping[str, Any]) -> str:
        """The scene with other values of keys, as TOML."""
        content = copy.deepcopy(self.content)
        for key, value in values.items():
            if key in _KEPT:
                raise ValueError(f"{key} {_KEPT[key]} (allowed: other keys)")
            try:
                parent, last = self._find(content, key)
                parent[last] = value
            except (KeyError, IndexError, TypeError):
                raise ValueError(f"{self.path} has no key `{key}`") from None
        return tomli_w.dumps(content)

    def variant(self, text: str) -> Variant:
        """The description of a changed scene; raises `UnitError` if the scene is refused."""
        with tempfile.TemporaryDirectory(dir=temporary_folder().path) as name:
            folder = Path(name)
            (folder / "scene.toml").write_text(text)
            command = [str(find_program()), str(folder / "scene.toml"), "--fmi", str(self.fmi)]
            command += ["--xml", str(folder / "unit.xml")]
            ran = subprocess.run(command, capture_output=True, text=True, check=False)
            if ran.returncode != 0:
                said = ran.stderr.replace(f"{folder}/scene.toml", str(self.path))
                raise UnitError("a scene that is changed makes no unit", said.strip().splitlines())
            return Variant(text, (folder / "unit.xml").read_text())

    def unit_of(self, key: str) -> str:
        """The unit of measurement of a key by the schema of scenes, empty where it has none."""
        node: Any = self._schema
        for word in self._names(key):
            node = _below(self._schema, node, word)
        return next((n["unit"] for n in _meanings(self._schema, node) if "unit" in n), "")

    @cached_property
    def _schema(self) -> dict[str, Any]:
        try:
            program = find_program("impinge")
            ran = subprocess.run([program, "schema"], capture_output=True, text=True, check=True)
            return json.loads(ran.stdout)
        except (UnitError, OSError, subprocess.CalledProcessError, ValueError):
            return {}

    def _names(self, key: str) -> list[str | int]:
        """The words of a path, with indices in place of the names of tables in lists."""
        parent: Any = self.content
        words: list[str | int] = []
        for word in key.split("."):
            place = _place(parent, word)
            words.append(place)
            parent = _item(parent, place)
        return words

    @staticmethod
    def _find(content: Any, key: str) -> tuple[Any, str | int]:
        """The table or list that holds a key, and its place there."""
        *above, last = key.split(".")
        for word in above:
            content = content[_place(content, word)]
        if not isinstance(content, dict | list):
            raise KeyError(key)
        return content, _place(content, last)


def _place(parent: Any, word: str) -> str | int:
    if not isinstance(parent, list):
        return word
    if word.isdigit() and int(word) < len(parent):
        return int(word)
    for index, item in enumerate(parent):
        if isinstance(item, dict) and item.get("name") == word:
            return index
    raise KeyError(word)


def _item(parent: Any, place: str | int) -> Any:
    if isinstance(parent, dict):
        return parent.get(place)
    return parent[int(place)] if isinstance(parent, list) else None


def _meanings(schema: dict[str, Any], node: Any) -> list[dict[str, Any]]:
    """What a node of a JSON schema may be: itself, and what it refers to and offers."""
    if not isinstance(node, dict):
        return []
    found = [node]
    if "$ref" in node:
        target: Any = schema
        for word in node["$ref"].removeprefix("#/").split("/"):
            target = target.get(word, {})
        found += _meanings(schema, target)
    for kind in ("anyOf", "oneOf", "allOf"):
        for choice in node.get(kind, []):
            found += _meanings(schema, choice)
    return found


def _below(schema: dict[str, Any], node: Any, word: str | int) -> Any:
    """What the schema says of a key of a table, or of a place in a list."""
    choices = []
    for meaning in _meanings(schema, node):
        if isinstance(word, int):
            prefix = meaning.get("prefixItems", [])
            choices.append(prefix[word] if word < len(prefix) else meaning.get("items"))
        else:
            named = meaning.get("properties", {}).get(word)
            choices.append(named or meaning.get("additionalProperties"))
    return {"anyOf": [choice for choice in choices if isinstance(choice, dict)]}
