"""The units of examples as they are, on meshes that take too long for every change."""

import numpy as np
import pytest
from conftest import COARSE, EXAMPLES, name_of
from fmpy import read_model_description, simulate_fmu

FINE = [scene for scene in EXAMPLES if name_of(scene) in COARSE]


@pytest.mark.parametrize("scene", FINE, ids=name_of)
def test_the_unit_runs(pack, scene):
    unit = str(pack(scene))
    experiment = read_model_description(unit).defaultExperiment
    result = simulate_fmu(unit, stop_time=float(experiment.stepSize))
    assert len(result) == 2
    for name in result.dtype.names:
        assert np.isfinite(result[name]).all(), name
