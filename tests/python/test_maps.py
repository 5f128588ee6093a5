"""Theories of the maps in docs/maps, beside what was measured."""

import csv
import sys
from importlib.util import module_from_spec, spec_from_file_location
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]


def module(path):
    """A file of the maps, without the cases beside it and what these import."""
    spec = spec_from_file_location(path.stem, path)
    found = module_from_spec(spec)
    # Its data classes look themselves up there.
    sys.modules[path.stem] = found
    spec.loader.exec_module(found)
    return found


lattice = module(ROOT / "benches" / "maps" / "cases" / "fluids" / "lattice.py")


@pytest.mark.parametrize(
    ("name", "kernel", "sign", "support"),
    [
        ("tension", "wendland_c2", -1.0, 2.25),
        ("tension", "wendland_c2", -1.0, 3.0),
        ("pairing_cubic_spline", "cubic_spline", 1.0, 2.75),
        ("pairing_cubic_spline", "cubic_spline", 1.0, 6.0),
    ],
)
def test_noise_between_periods_grows_as_measured(name, kernel, sign, support):
    """Where it grows about a hundredfold."""
    with (ROOT / "docs" / "maps" / f"{name}.csv").open(newline="") as file:
        rows = [
            (float(row["y"]), float(row["outcome"]))
            for row in csv.DictReader(file)
            if float(row["x"]) == support
        ]
    pressure, grown = min(rows, key=lambda row: abs(row[1] - 100.0))
    of = lattice.Lattice(kernel, support, "hexagonal", 24)
    expected = lattice.noise_between_periods(of, 0.2, 300, pressure=sign * pressure)
    assert expected == pytest.approx(grown, rel=0.1)
