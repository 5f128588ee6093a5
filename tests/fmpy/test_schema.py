"""The JSON schema of scenes against an independent validator."""

import json
import re
import subprocess
import tomllib
from pathlib import Path

import pytest
from jsonschema import Draft202012Validator

ROOT = Path(__file__).parents[2]
SCENES = sorted(
    path
    for folder in ["examples/*", "tests/scenes", "tests/fmi", "tests/fmpy/scenes"]
    for path in ROOT.glob(f"{folder}/*.toml")
    if path.name != "refusals.toml"
)

# Refusals of a key, a type or a single value, by what they say.
OF_ONE_VALUE = [
    r"unknown key",
    r"is not available",
    r"the key `\w+` is missing; allowed: (a |one of|solid|thermo)",
    r"this is not ",
    r"must be positive",
    r"is beyond all bounds",
    r"is not negative",
    r"is above absolute zero",
    r"is out of bounds",
    r"must stay (above|below)",
    r"is not a C identifier",
    r"an emissivity is a part",
    r"the tolerance is relative",
    r"too many threads",
    r"grow by a modest ratio",
    r"no shape functions of this order",
    r"no model of this dimension",
    r"does not soften",
    r"there is no arrival",
    r"a table has 1 temperatures",
    r"the list is empty",
    r"this is named twice",
    r"reaches too few or too many",
    r"of what lies below is positive",
    r"a body of 0 layers",
]
# Names of tables are for the parser, and so are keys that only some models need.
OTHERS = re.compile(r"body\.1st: |the key `yield_stress`|its saturated yield stress")


@pytest.fixture(scope="module")
def validator(programs):
    printed = subprocess.run(
        [programs / "impinge", "schema"], capture_output=True, check=True, text=True
    ).stdout
    assert printed == (ROOT / "docs/scene.schema.json").read_text()
    schema = json.loads(printed)
    Draft202012Validator.check_schema(schema)
    return Draft202012Validator(schema)


@pytest.mark.parametrize("path", SCENES, ids=lambda path: str(path.relative_to(ROOT)))
def test_scenes_are_valid(validator, path):
    validator.validate(tomllib.loads(path.read_text()))


def refusals():
    folder = ROOT / "tests/scenes"
    for refusal in tomllib.loads((folder / "refusals.toml").read_text())["refused"]:
        text = (folder / f"{refusal['scene']}.toml").read_text()
        for old, new in refusal["edits"]:
            text = text.replace(old, new)
        yield refusal["what"], text, refusal["says"]


def test_what_is_wrong_with_a_single_value_is_not_valid(validator):
    accepted, count = [], 0
    for what, text, says in refusals():
        of_one_value = any(re.search(pattern, says) for pattern in OF_ONE_VALUE)
        if not of_one_value or OTHERS.search(says):
            continue
        count += 1
        if validator.is_valid(tomllib.loads(text)):
            accepted.append(f"{what}: {says}")
    assert not accepted, "\n".join(accepted)
    assert count > 150


def keys(schema, place="scene"):
    """The keys of all tables, with what the schema says of each."""
    if isinstance(schema, dict):
        for key, value in schema.get("properties", {}).items():
            if isinstance(value, dict) and "const" not in value:
                yield f"{place}.{key}", value
        for key, value in schema.items():
            yield from keys(value, key if key[:1].isupper() else place)
    elif isinstance(schema, list):
        for value in schema:
            yield from keys(value, place)


def test_numbers_with_units_may_be_texts(validator):
    units = {"K", "m", "s", "Pa", "W/m²"}
    measured = {key: own for key, own in keys(validator.schema) if own.get("unit") in units}
    assert len(measured) > 60 and "Face.temperature" in measured
    deaf = [key for key, own in measured.items() if own.get("type") in ("number", "integer")]
    assert not deaf, deaf


def test_every_key_is_described(validator):
    """A hover in an editor says what the key is."""
    found = dict(keys(validator.schema))
    # Of these, the alternatives are described.
    alternatives = ("Footprint.", "Shape.", "SolidShape.", "Plane.", "LatticeSupport.")
    lacking = [key for key, own in found.items() if "description" not in own]
    assert all(key.startswith(alternatives) for key in lacking), lacking
    assert len(found) > 100
