"""Terminals and icons of units: the schema, and whether all they name is there."""

from collections import Counter
from io import BytesIO
from pathlib import Path
from zipfile import ZipFile

import fmpy
import pytest
from conftest import every_scene
from fmpy import read_model_description
from lxml import etree
from PIL import Image

SCHEMA = Path(fmpy.__file__).parent / "schema/fmi3/fmi3TerminalsAndIcons.xsd"
FOLDER = "terminalsAndIcons"


@pytest.mark.parametrize("fmi", [2, 3])
@every_scene
def test_terminals_are_valid_and_hold_every_input_and_output_once(pack_small, scene, fmi):
    file = pack_small(scene, fmi)
    with ZipFile(file) as archive:
        document = etree.fromstring(archive.read(f"{FOLDER}/terminalsAndIcons.xml"))
        icons = {Path(n).stem for n in archive.namelist() if n.startswith(FOLDER)}
        Image.open(archive.open(f"{FOLDER}/icon.png")).verify()
        pictures = [archive.read(f"{FOLDER}/{icon}.png") for icon in used(document)]
    etree.XMLSchema(etree.parse(SCHEMA)).assertValid(document)
    assert used(document) <= icons
    assert all(Image.open(BytesIO(picture)).size == (64, 64) for picture in pictures)
    found = Counter(m.get("variableName") for m in document.iter("TerminalMemberVariable"))
    variables = read_model_description(file).modelVariables
    wanted = [v.name for v in variables if v.causality in ("input", "output")]
    assert found == Counter(wanted)
    for terminal in document.iter("Terminal"):
        names = [m.get("memberName") for m in terminal.iter("TerminalMemberVariable")]
        assert len(set(names)) == len(names)


def used(document):
    return {look.get("iconBaseName") for look in document.iter("TerminalGraphicalRepresentation")}


def test_flat_names_are_identifiers_and_run_the_same(pack):
    from master import run

    said = "step = 1e-5\n"
    flat = pack("tiles", {said: said + 'naming = "flat"\n'})
    plain = pack("tiles")
    a, b = (read_model_description(file) for file in (flat, plain))
    assert (a.variableNamingConvention, b.variableNamingConvention) == ("flat", "structured")
    pairs = list(zip(a.modelVariables, b.modelVariables, strict=True))
    for one, other in pairs:
        assert one.name.isidentifier()
        assert (one.valueReference, one.causality) == (other.valueReference, other.causality)
    names = {other.name: one.name for one, other in pairs}
    assert len(set(names.values())) == len(names)
    assert names["patch.heat_flux[1,2]"] == "patch_heat_flux_1_2"
    assert names["centre.stress_xx"] == "centre_stress_xx"
    inputs = {"patch.heat_flux[1,2]": 1e8, "patch.pressure[2,3]": 1e6}
    wanted = run(plain, inputs)
    found = run(flat, {names[name]: value for name, value in inputs.items()})
    assert found == {names[name]: value for name, value in wanted.items()}
