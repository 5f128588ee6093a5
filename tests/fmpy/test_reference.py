"""Reference results inside units: read back, and reproduced from the inputs beside them."""

import csv
import xml.etree.ElementTree as ET
from io import StringIO
from zipfile import ZipFile

import numpy as np
import pytest
from master import Unit

FOLDER = "extra/org.fmi-standard.fmi-ls-ref"
LS = "{http://fmi-standard.org/fmi-ls-manifest}"


@pytest.fixture(params=["plate", "rings", "tiles", "drop"])
def unit(request, pack):
    return pack(request.param, None, 2, "--reference")


def table(text):
    """Columns by name; names have commas, so FMPy's own reader of CSV files does not do."""
    names, *rows = csv.reader(StringIO(text))
    values = np.array(rows, float)
    kinds = [(name, float) for name in names]
    return np.array([tuple(row) for row in values], kinds)


def test_the_manifest_names_files_that_are_there(unit):
    with ZipFile(unit) as archive:
        names = archive.namelist()
        manifest = ET.fromstring(archive.read(f"{FOLDER}/fmi-ls-manifest.xml"))
    assert manifest.tag == "fmiReferences"
    assert manifest.get(f"{LS}fmi-ls-name") == "org.fmi-standard.fmi-ls-ref"
    related = {element.get("source"): element.get("role") for element in manifest.iter("Related")}
    for source in related:
        path = f"{FOLDER}/{source}".replace(f"{FOLDER}/../../", "")
        assert path in names, source
    assert set(related.values()) == {"experiment/smoke-test", "result", "model", "other"}


def test_the_outputs_come_again_from_the_inputs(unit):
    with ZipFile(unit) as archive:
        read = {name: archive.read(f"{FOLDER}/{name}").decode() for name in find(archive)}
    experiment = ET.fromstring(read["experiments.exp"]).find("Experiment")
    stimuli = table(read[experiment.find("Stimuli").get("source")])
    wanted = table(read[experiment.find("References").get("source")])
    outputs, step = wanted.dtype.names[1:], float(experiment.get("stepSize"))
    assert wanted["time"][-1] == float(experiment.get("stopTime")) == stimuli["time"][-1]
    with Unit(unit) as again:
        again.set({name: stimuli[name][0] for name in stimuli.dtype.names[1:]})
        for row in wanted:
            if row["time"] > 0:
                again.step(step)
            assert again.time == pytest.approx(row["time"], rel=1e-12)
            found = again.get(outputs)
            differ = [n for n, v in zip(outputs, found, strict=True) if v != row[n]]
            assert not differ, (row["time"], differ)


def find(archive):
    start = f"{FOLDER}/"
    return [name.removeprefix(start) for name in archive.namelist() if name.startswith(start)]
