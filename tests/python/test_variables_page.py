"""docs/variables.md has every variable that a unit may have, with its unit, and no other."""

import re
import subprocess
import xml.etree.ElementTree as ET
from dataclasses import dataclass
from pathlib import Path

import pytest
from impinge.unit.build import find_program

ROOT = Path(__file__).parents[2]
FACES = "(top|bottom|sides|left|right|front|back)"


@dataclass(frozen=True)
class Row:
    """A name of the page, the causality of its section and its unit."""

    causality: str
    name: str
    unit: str

    def describes(self, causality: str, name: str, unit: str) -> bool:
        pattern = re.escape(self.name).replace("FACE", FACES).replace(r"\[i\]", r"\[\d+\]")
        pattern = re.sub(r"\b[A-Z]+\b", r"\\w+", pattern) + r"(\[[\d,]+\])?"
        return (causality, unit) == (self.causality, self.unit) and re.fullmatch(pattern, name)


def rows() -> list[Row]:
    found = []
    sections = re.split(r"^## ", (ROOT / "docs/variables.md").read_text(), flags=re.M)[1:]
    for section in sections:
        causality = section.split()[0].lower().rstrip("s")
        for line in re.findall(r"^\| `.*$", section, re.M):
            names, unit = (cell.strip() for cell in line.split("|")[1:3])
            first, *others = re.findall(r"`([^`]+)`", names)
            stem = re.sub(r"x+$", "", first)  # `stress_xx`, `_yy`: the others replace its end
            found.append(Row(causality, first, unit))
            for name in others:
                full = f"{stem}{name[1:]}" if name.startswith("_") else name
                found.append(Row(causality, full, unit))
    return found


def variables(description: str) -> set[tuple[str, str, str]]:
    """Causality, name and unit of each variable, of tunable inputs and of layers as of others."""
    root = ET.fromstring(description)
    units = {of.get("name"): of[0].get("unit", "") for of in root.iter("SimpleType")}
    found = set()
    for variable in root.iter("ScalarVariable"):
        kind = variable[0]
        unit = kind.get("unit") or units.get(kind.get("declaredType"), "")
        causality, name = variable.get("causality"), variable.get("name")
        if variable.get("variability") == "tunable":
            causality = "input"
        if causality == "parameter":
            of_layer = re.fullmatch(r"(\w+)\.(\w+|layer\[\d+\])\.(\w+)", name)
            if of_layer and of_layer[3] not in ("coefficient", "contact_resistance"):
                name = f"{of_layer[1]}.{of_layer[3]}"
        found.add((causality, name, unit))
    return {variable for variable in found if variable[0] != "independent"}


@pytest.fixture(scope="module")
def every_variable(tmp_path_factory):
    """Those of the examples, and of scenes with every kind of body."""
    folder = tmp_path_factory.mktemp("descriptions")
    for scene in (ROOT / "tests/python/variables").glob("*.toml"):
        command = [find_program("build-fmu"), scene, "--xml", folder / f"{scene.stem}.xml"]
        subprocess.run(command, check=True, capture_output=True)
    files = [*folder.glob("*.xml"), *(ROOT / "modelDescription").glob("*.xml")]
    return set().union(*(variables(file.read_text()) for file in files))


def test_every_variable_stands_in_the_page_with_its_unit(every_variable):
    page = rows()
    missing = {of for of in every_variable if not any(row.describes(*of) for row in page)}
    assert not missing


def test_the_page_has_no_variable_that_no_unit_has(every_variable):
    unused = {row.name for row in rows() if not any(row.describes(*of) for of in every_variable)}
    assert not unused
