"""Energies that coupled units pass on: areas of fluxes, and units of measurement."""

from math import pi

import numpy as np
import pytest
from impinge import Function, Master
from impinge.master import Bond, MasterError
from impinge.reporting.coupled import coupled
from linear_unit import make


def test_a_power_is_multiplied_by_no_area(pack):
    """A load that carries watts takes them whole, wherever its cells have areas."""
    patch = "footprint = { tiles = { count = [2, 3], size = [1.1e-4, 0.9e-4] } }"
    watts = {
        patch: "footprint = { disc = { radius = 1e-4 } }",
        'carries = ["heat_flux", "pressure", "shear"]': 'carries = ["power"]',
    }
    law = Function(lambda u: 3e-3 + 0.0 * u, {"u": "K"}, {"y": "W"})
    links = [("plate.centre.temperature", "law.u"), ("law.y", "plate.patch.power")]
    options = {"step": 1e-5, "energy": ["law.y"]}
    with Master({"law": law, "plate": pack("tiles", watts)}, links, **options) as master:
        passed = master.run(1e-4)["energy_passed.law.y"].values[-1]
    assert passed == pytest.approx(3e-7, rel=1e-9)


FLAT = {"stop_time = 1e-4": 'stop_time = 1e-4\nnaming = "flat"'}


@pytest.mark.parametrize(
    ("fmi", "edits", "flux", "heat"),
    [
        (2, {}, "patch.heat_flux[2,3]", "block.heat_in"),
        (3, {}, "patch.heat_flux[2,3]", "block.heat_in"),
        (2, FLAT, "patch_heat_flux_2_3", "block_heat_in"),
        (3, FLAT, "patch_heat_flux[2,3]", "block_heat_in"),
    ],
)
def test_a_flux_into_one_tile_has_the_area_of_that(pack, fmi, edits, flux, heat):
    """Names are structured or flat; what passes is what the plate itself counts."""
    law = Function(lambda: 1e6, {}, {"y": "W/m2"}, name="law")
    options = {"step": 1e-5, "energy": ["law.y"], "outputs": [f"plate.{heat}"]}
    units = {"law": law, "plate": pack("tiles", edits, fmi)}
    with Master(units, [("law.y", f"plate.{flux}")], **options) as master:
        result = master.run(1e-4)
    known = 1e6 * 1e-4 * 1.1e-4 * 0.9e-4 / 6
    assert result["energy_passed.law.y"].values[-1] == pytest.approx(known, rel=1e-9)
    assert result[f"plate.{heat}"].values[-1] == pytest.approx(known, rel=1e-9)


@pytest.mark.parametrize("fmi", [2, 3])
@pytest.mark.parametrize("naming", ["structured", "flat"])
def test_areas_of_a_flux_follow_the_radius_of_its_load(pack, fmi, naming):
    """What passes is what the plate counts: the radius is set before the run, held or driven."""
    edits = {"stop_time = 1e-4": f'stop_time = 1e-4\nnaming = "{naming}"'}
    mark = "." if naming == "structured" else "_"
    edits["rings = { count = 4, radius = 8e-5 }"] = "ring = { inner = 2e-5, outer = 6e-5 }"
    plate, name = pack("rings", edits, fmi), f"splat{mark}radius"
    law = Function(lambda: 1e6, {}, {"y": "W/m2"}, name="law")
    links = [("law.y", f"plate.splat{mark}heat_flux")]
    count = f"plate.plate{mark}heat_in"
    energy = ["law.y", Bond(links[0][1], total=count)]
    options = {"step": 1e-5, "energy": energy, "outputs": [count]}
    for given, inputs, mean_square in (
        ({name: 9e-5}, {}, 8.1e-9),
        ({}, {f"plate.{name}": 9e-5}, 8.1e-9),
        ({}, {f"plate.{name}": lambda t: 4e-5 + 0.6 * t}, 5.2e-9),
    ):
        units = {"law": law, "plate": plate}
        options |= {"inputs": inputs, "parameters": {"plate": given}}
        with Master(units, links, **options) as master:
            result = master.run(1e-4)
        known = 1e6 * 1e-4 * pi * mean_square * (1.0 - 1.0 / 9.0)
        assert result[count].values[-1] == pytest.approx(known, rel=2e-3)
        passed = result["energy_passed.law.y"].values[-1]
        assert passed == pytest.approx(result[count].values[-1], rel=1e-3)
        assert result.attrs[f"energy_residual.{links[0][1]}"] < 1e-3


PLANE = {
    "spacing = 1e-5": "spacing = 1e-5\ndimension = 2",
    "rings = { count = 4, radius = 1e-4 }": "tiles = { count = [20, 1], size = [8e-4, 1e-4] }",
}


@pytest.mark.parametrize("fmi", [2, 3])
def test_energies_of_plane_drops_are_per_metre_of_depth(pack, fmi):
    """What its wall gets is what the drop counts, in the same unit of measurement."""
    law = Function(lambda q: 300.0 + 0.0 * q, {"q": ("W/m2", (20, 1))}, {"T": ("K", (20, 1))})
    units = {"drop": pack("drop", PLANE, fmi), "law": law}
    links = [("drop.wall.heat_flux", "law.q"), ("law.T", "drop.wall.temperature")]
    for given in ("drop.wall.heat_flux", Bond("drop.wall.heat_flux", total="drop.drop.heat")):
        options = {"step": 1e-7, "energy": [given], "outputs": ["drop.drop.heat"]}
        with Master(units, links, **options) as master:
            result = master.run(2e-6)
        passed, heat = result["energy_passed.drop.wall.heat_flux"], result["drop.drop.heat"]
        assert heat.values[-1] > 1e-4
        assert passed.values[-1] == pytest.approx(heat.values[-1], rel=1e-9)
        assert passed.attrs["units"] == heat.attrs["units"] == "J/m"
        assert result["energy_residual.drop.wall.heat_flux"].attrs["units"] == "J/m"
        assert [balance["unit"] for balance in coupled(result)["balances"]] == ["J/m"]


def per_depth_or_not(power, energy, **more):
    """In what a power of this unit passes on whose total is in `energy`."""
    law = Function(
        lambda time: {"y": 3.0, "e": 3.0 * time}, {}, {"y": power, "e": energy}, name="law"
    )
    sink = Function(lambda q: q, {"q": power}, {"p": power}, name="sink")
    options = {"step": 1.0, "energy": [Bond("law.y", total="law.e", **more)]}
    with Master({"law": law, "sink": sink}, [("law.y", "sink.q")], **options) as master:
        passed = master.run(2.0)["energy_passed.law.y"]
    assert passed.values[-1] == pytest.approx(6.0)
    return passed.attrs["units"]


@pytest.mark.parametrize(
    ("power", "energy", "more", "wrong"),
    [
        ("W", "J", {}, "J/m"),
        ("W/m", "J/m", {}, "J"),
        ("W/m3", "J/m3", {}, "J"),
        ("W/m2", "J/m", {"area": 0.1}, "K"),
        ("W/m2", "J", {"area": 0.1}, "J/m2"),
        ("W/m", "J", {"area": 0.1}, "J/m2"),
        ("W/m2", "J/m", {}, "W"),
    ],
)
def test_powers_per_metre_have_energies_per_metre(power, energy, more, wrong):
    """An area that is given is in m2 or in m, as the total needs it."""
    assert per_depth_or_not(power, energy, **more) == energy
    allowed = "J or J/m" if power == "W/m2" or more else energy
    with pytest.raises(MasterError, match=f"the total law.e is in .*, not in {allowed}$"):
        per_depth_or_not(power, wrong, **more)


def test_rings_of_flat_names_have_radii(pack):
    drop = pack("drop", {"step = 1e-7": 'step = 1e-7\nnaming = "flat"'}, 3)
    with Master({"drop": drop}, outputs=["drop.wall_heat_flux"], step=1e-7) as master:
        outer = master.run(2e-7)["drop.wall_heat_flux:outer"]
    assert np.diff(outer.values, prepend=0.0) == pytest.approx(np.full(4, outer.values[0]))


def test_fluxes_of_unknown_area_are_warned_of(tmp_path):
    law = Function(lambda: 1e6, {}, {"y": "W/m2"}, name="law")
    store = make(tmp_path, "plain", [0.0], [1.0], [1.0], x=[0.0], u_unit="W/m2")
    for given, notes in (("law.y", 1), (Bond("law.y", area=1.0), 0)):
        options = {"step": 0.1, "energy": [given]}
        with Master({"law": law, "store": store}, [("law.y", "store.u")], **options) as master:
            assert sum("no unit tells the area of law.y" in note for note in master.notes) == notes
            assert master.run(1.0)["energy_passed.law.y"].values[-1] == pytest.approx(1e6)
