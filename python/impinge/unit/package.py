"""What a unit's file holds: unzipped and read once for each process and content."""

from __future__ import annotations

import copy
import hashlib
import os
import re
import shutil
import tempfile
from codecs import getincrementaldecoder
from collections.abc import Mapping
from dataclasses import replace
from functools import cached_property
from pathlib import Path
from typing import Any

import fmpy

from impinge.errors import UnitError
from impinge.measure import BASE, Measure
from impinge.proposal import proposal
from impinge.reading import LARGEST_JSON, open_file, read_bytes, reading
from impinge.unit import cells
from impinge.unit.archive import open_archive, unpack
from impinge.unit.build import build
from impinge.unit.temporary import temporary_folder
from impinge.unit.variable import Capabilities, Variable, element_of, read_variables, stem_of


class Package:
    """An unzipped unit and its description; instances share it.

    `folder` is where it is, `digest` the SHA-256 of its content, `fmi` the version of the standard.
    """

    def __init__(self, folder: Path, digest: str, source: str):
        self.folder = folder
        self.digest = digest
        self.source = source
        with reading(f"{source}: modelDescription.xml", UnitError):
            _check_encoding(folder / "modelDescription.xml")
            self.description: Any = fmpy.read_model_description(str(folder), validate=False)
        version = str(self.description.fmiVersion)
        if version[:1] not in ("2", "3"):
            raise UnitError(f"{source} is a unit of FMI {version}; it may be of 2.0 or 3.0")
        self.fmi = int(version[0])
        if self.description.coSimulation is None:
            raise UnitError(f"{source} offers no co-simulation")
        with reading(f"{source}: modelDescription.xml", UnitError):
            self.variables, self._elements = read_variables(self.description, self.fmi)

    def reshaped(self, structural: Mapping[str, Any]) -> Package:
        """This package, with the shapes that arrays of FMI 3.0 have for structural parameters."""
        other = copy.copy(self)
        other.variables = dict(self.variables)
        given = {
            self.variable(name).references[0]: int(value) for name, value in structural.items()
        }
        for described in self.description.modelVariables:
            shape = tuple(
                given.get(size.valueReference, int(size.start or size.variable.start))
                for size in described.dimensions
            )
            known = other.variables.get(described.name)
            if known is not None and shape and known.shape != shape:
                other.variables[described.name] = replace(known, shape=shape, start=None)
        return other

    @property
    def name(self) -> str:
        """The model's name."""
        return self.description.modelName

    def variable(self, name: str) -> Variable:
        """The variable, family, or element of a family of this name."""
        found = self.variables.get(name) or self._elements.get(name)
        if found is None:
            array = self.variables.get(stem_of(name))
            found = element_of(array, name) if array is not None else None
        if found is None:
            near = proposal(name, [*self.variables, *self._elements])
            raise UnitError(f"{self.name} has no variable `{name}`{near}")
        return found

    def measure(self, name: str | None) -> Measure | None:
        """The unit of measurement of this name, as far as the description defines it."""
        for definition in self.description.unitDefinitions:
            base = definition.baseUnit
            if definition.name == name and base is not None:
                exponents = tuple(int(getattr(base, key) or 0) for key in BASE)
                return Measure(exponents, float(base.factor or 1.0), float(base.offset or 0.0))
        return None

    @property
    def is_own(self) -> bool:
        """True if impinge has made the unit."""
        return (self.description.generationTool or "").startswith("impinge")

    def of_causality(self, *causalities: str) -> dict[str, Variable]:
        """Variables by name."""
        return {n: v for n, v in self.variables.items() if v.causality in causalities}

    @cached_property
    def can(self) -> Capabilities:
        """What the description says the unit can do."""
        offers = self.description.coSimulation
        # FMI 2.0 does not say up to which order; that of impinge's own is known.
        order = (2 if self.is_own else 1) if self.fmi == 2 and offers.canInterpolateInputs else 0
        return Capabilities(
            states=offers.canGetAndSetFMUstate,
            serialise=offers.canSerializeFMUstate,
            interpolates=order,
            output_derivatives=int(offers.maxOutputDerivativeOrder or 0),
            variable_steps=offers.canHandleVariableCommunicationStepSize,
            directional_derivatives=self._says_yes("providesDirectionalDerivatives?"),
            adjoint_derivatives=offers.providesAdjointDerivatives,
            early_return=offers.mightReturnEarlyFromDoStep,
            once_per_process=offers.canBeInstantiatedOnlyOncePerProcess,
        )

    def _says_yes(self, attribute: str) -> bool:
        """An attribute of the element `CoSimulation`, of those that FMPy passes over."""
        with open(self.folder / "modelDescription.xml", encoding="utf-8") as file:
            text = ""
            while len(block := file.read(65536)):
                text += block
                if found := re.search(r"<CoSimulation\b[^>]*>", text):
                    return bool(re.search(rf"\b{attribute}\s*=\s*[\"'](true|1)", found[0]))
        return False

    @cached_property
    def dependencies(self) -> dict[str, set[str]]:
        """The inputs that each output follows at once; families go by their one name."""
        inputs = set(self.of_causality("input"))
        found: dict[str, set[str]] = {name: set() for name in self.of_causality("output")}
        for unknown in self.description.outputs:
            name = self._family(unknown.variable.name)
            if name not in found:
                continue
            if unknown.dependencies is None:  # not told: it may follow any of them
                found[name] |= inputs
            else:
                found[name] |= {self._family(v.name) for v in unknown.dependencies} & inputs
        return found

    def _family(self, name: str) -> str:
        return name if name in self.variables else stem_of(name)

    @cached_property
    def cell_families(self) -> dict[str, dict[str, Any]]:
        """The families of cells of `resources/cells.json`; none where there is no such file.

        Beside what the file says each has `quantities`, the names of its inputs and outputs, and
        where it is made of equal cells their `width` [m].
        """
        path = self.folder / cells.PLACE
        told: dict[str, dict[str, Any]] = {}
        with reading(f"{self.source}: {cells.PLACE}", UnitError):
            if path.exists():
                told = cells.parse_cells(read_bytes(path, LARGEST_JSON))
        return {
            name: {
                **family,
                "quantities": [*family.get("inputs", []), *family.get("outputs", [])],
                **({"width": family["size"]} if "size" in family else {}),
            }
            for name, family in told.items()
        }


_PACKAGES: dict[str, Package] = {}  # by digest
_DIGESTS: dict[tuple[str, int, int], str] = {}  # of files, by path, time and size
_BLOCK = 1 << 20


def open_package(source: str | os.PathLike[str], fmi: int | None = None) -> Package:
    """The package of a scene, of a `.fmu` file, or of a folder that one has been unzipped into."""
    path = Path(source)
    if path.suffix == ".toml":
        path = build(path, fmi=fmi)
    if path.is_dir():
        return _of_folder(path)
    digest = _digest_of_file(path)
    if digest not in _PACKAGES:
        folder = _unzip(path, digest)
        try:
            _PACKAGES[digest] = Package(folder, digest, str(source))
        except BaseException:
            shutil.rmtree(folder, ignore_errors=True)
            raise
    package = _PACKAGES[digest]
    if fmi is not None and package.fmi != fmi:
        raise UnitError(f"{source} is a unit of FMI {package.fmi}, not {fmi}")
    return package


def _digest_of_file(path: Path) -> str:
    with reading(path, UnitError), open_file(path) as file:
        status = os.fstat(file.fileno())
        key = (str(path.resolve()), status.st_mtime_ns, status.st_size)
        if key not in _DIGESTS:
            _DIGESTS[key] = hashlib.file_digest(file, "sha256").hexdigest()
        return _DIGESTS[key]


def _unzip(path: Path, digest: str) -> Path:
    """The folder of a unit's content. Threads and forked processes share it: the first names it."""
    folder = temporary_folder().path / digest[:16]
    if folder.is_dir():
        return folder
    with tempfile.TemporaryDirectory(dir=folder.parent) as own:
        made = Path(own, "unit")
        with open_archive(path, path) as archive:
            unpack(archive, made)
        try:
            made.rename(folder)
        except OSError:
            if not folder.is_dir():
                raise
    return folder


def _check_encoding(path: Path) -> None:
    """Raises `ValueError` for a description that is not in UTF-8, as FMI asks for."""
    decoder = getincrementaldecoder("utf-8")()
    with open_file(path) as file:
        while block := file.read(_BLOCK):
            decoder.decode(block)
        decoder.decode(b"", final=True)


def _of_folder(path: Path) -> Package:
    description = path / "modelDescription.xml"
    if not description.is_file():
        raise UnitError(f"{path} holds no modelDescription.xml")
    content = str(path.resolve()).encode() + description.read_bytes()
    digest = hashlib.sha256(content).hexdigest()
    if digest not in _PACKAGES:
        _PACKAGES[digest] = Package(path.resolve(), digest, str(path))
    return _PACKAGES[digest]
