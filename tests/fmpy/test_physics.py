"""Physics as a master sees it: closed forms, balances, symmetries."""

from math import erfc, exp, pi, sqrt

import numpy as np
import pytest
from master import Unit, run

CONDUCTIVITY, CAPACITY = 10.0, 3950.0 * 900.0
DIFFUSIVITY = CONDUCTIVITY / CAPACITY
YOUNG, POISSON, EXPANSION = 300e9, 0.21, 8.1e-6
COLD = 293.15

SPOT = {"spot.heat_flux": 1e8, "spot.pressure": 25e6, "spot.shear_x": 5e6, "spot.shear_y": -2e6}
ASIDE = {"spot.x": 9e-5, "spot.y": 4.5e-5}


def random_steps(total, count, seed):
    """Steps of very different sizes."""
    sizes = np.random.default_rng(seed).lognormal(0.0, 1.5, count)
    return list(sizes * total / sizes.sum())


def half_space_rise(flux, depth, t):
    s = sqrt(4 * DIFFUSIVITY * t)
    u = depth / s
    ierfc = exp(-u * u) / sqrt(pi) - u * erfc(u)
    return flux * s / CONDUCTIVITY * ierfc


def test_uniform_flux_on_a_half_space(pack):
    with Unit(pack("slab")) as unit:
        for step in [1e-5, 9e-5, 3e-4, 6e-4]:
            unit.step(step)
            exact = half_space_rise(1e7, 0.0, unit.time)
            assert exact == pytest.approx(2e7 * sqrt(DIFFUSIVITY * unit.time / pi) / CONDUCTIVITY)
            assert unit["surface.temperature"] - COLD == pytest.approx(exact, rel=1e-3)
            assert unit["corner.temperature"] == pytest.approx(unit["surface.temperature"], 1e-12)
            deep = half_space_rise(1e7, 5e-5, unit.time)
            assert unit["deep.temperature"] - COLD == pytest.approx(deep, abs=3e-4 * exact)


def test_stress_of_a_surface_that_cannot_move_sideways(pack):
    values = run(pack("slab"), steps=[1e-3])
    for probe in ("surface", "deep"):
        rise = values[f"{probe}.temperature"] - COLD
        exact = -YOUNG * EXPANSION * rise / (1 - POISSON)
        assert values[f"{probe}.stress_xx"] == pytest.approx(exact, rel=2e-3)
        assert values[f"{probe}.stress_yy"] == pytest.approx(exact, rel=2e-3)
        for component in ("zz", "xy", "yz", "xz"):
            assert abs(values[f"{probe}.stress_{component}"]) < 1e-3 * abs(exact), component


def test_the_flux_of_a_face_is_an_input(pack):
    with Unit(pack("slab"), {"slab.top.flux": -2e7}) as unit:
        unit.step(1e-3)
        exact = half_space_rise(-2e7, 0.0, 1e-3)
        assert unit["surface.temperature"] - COLD == pytest.approx(exact, rel=1e-3)
        assert unit["slab.heat_in"] == pytest.approx(-2e7 * 1e-6 * 1e-3, rel=1e-12)


FACES = {
    "insulated": "",
    "flux": "sides = { flux = 1e5 }\nbottom = { flux = -2e6 }",
    "convective": """
        top = { convection = { coefficient = 2e4, ambient = 350.0 } }
        sides = { convection = { coefficient = 1e5, ambient = 280.0 } }""",
    "prescribed": "left = { temperature = 310.0 }",
    "all": """
        left = { temperature = 290.0 }
        right = { convection = { coefficient = 1e5, ambient = 320.0 } }
        front = { flux = 1e6 }
        bottom = { convection = { coefficient = 3e4, ambient = 250.0 } }""",
    "prescribed all around": "sides = { temperature = 310.0 }",
}


@pytest.mark.parametrize("faces", FACES)
def test_heat_balance_under_moving_loads_and_uneven_steps(pack, faces):
    file = pack("balance", {"# FACES": FACES[faces]})
    random = np.random.default_rng(7)
    sent = 0.0
    with Unit(file) as unit:
        own = unit["box.heat_in"], unit["box.heat_stored"], unit["box.heat_lost"]
        assert own == (0.0, 0.0, 0.0)
        for step in random_steps(1e-2, 25, 1):
            flux, back = random.uniform(-2e7, 5e7, 2)
            unit["spot.heat_flux"], unit["back.heat_flux"] = flux, back
            unit["spot.x"], unit["spot.y"], unit["back.x"] = random.uniform(-1e-4, 1e-4, 3)
            unit["back.radius"] = radius = random.uniform(2e-5, 9e-5)
            for name, variable in unit.variables.items():
                if variable.causality == "input" and name.startswith("box."):
                    unit[name] = float(variable.start) * random.uniform(0.9, 1.1)
            unit.step(step)
            sent += step * back * pi * radius**2
            total, stored, lost = unit.get(["box.heat_in", "box.heat_stored", "box.heat_lost"])
            scale = abs(total) + abs(stored) + abs(lost)
            assert total == pytest.approx(stored + lost, abs=1e-9 * scale)
        if faces == "insulated":
            assert lost == 0.0
    with Unit(file) as unit:
        unit["back.heat_flux"], unit["back.radius"] = 1e7, 5e-5
        before = unit["box.heat_in"]
        unit.step(1e-4)
        if "flux" not in FACES[faces]:
            assert unit["box.heat_in"] - before == pytest.approx(1e7 * pi * 25e-10 * 1e-4, 1e-9)
    assert sent != 0.0


@pytest.mark.parametrize("faces", FACES)
def test_cutting_a_span_into_steps_changes_nothing(pack, faces):
    file = pack("balance", {"# FACES": FACES[faces]})
    inputs = {"spot.heat_flux": 3e7, "spot.x": 4e-5, "back.heat_flux": 1e7}
    whole = run(file, inputs, steps=[1e-3])
    parts = run(file, inputs, steps=random_steps(1e-3, 37, 2))
    for name, value in whole.items():
        base = 300.0 if "temperature" in name else 0.0
        assert parts[name] - base == pytest.approx(value - base, rel=1e-10), name


def test_cutting_a_span_into_steps_changes_no_stress(pack):
    whole = run(pack("plate"), {**SPOT, **ASIDE}, steps=[2e-4])
    parts = run(pack("plate"), {**SPOT, **ASIDE}, steps=random_steps(2e-4, 37, 3))
    for name, value in whole.items():
        scale = {"K": 1.0, "Pa": 1e6, "m": 1e-10, "J": 1e-9}[unit_of(name)]
        assert parts[name] == pytest.approx(value, rel=1e-10, abs=1e-9 * scale), name


def unit_of(name):
    quantity = name.split(".")[1]
    if "temperature" in quantity:
        return "K"
    if "displacement" in quantity:
        return "m"
    return "J" if "heat" in quantity else "Pa"


def test_pressure_acts_into_the_body(pack):
    values = run(pack("plate"), {"spot.pressure": 25e6})
    # The stress that the coarse mesh of linear elements has under the middle of the footprint
    assert values["centre.stress_zz"] == pytest.approx(-25e6, rel=0.1)
    assert values["centre.displacement_z"] < 0.0
    assert values["centre.temperature"] == COLD
    pull = run(pack("plate"), {"spot.pressure": -25e6})
    assert pull["centre.displacement_z"] == -values["centre.displacement_z"]


def test_shear_along_x_moves_the_surface_along_x(pack):
    values = run(pack("plate"), {"spot.shear_x": 1e6})
    assert values["centre.displacement_x"] > 0.0
    scale = values["centre.displacement_x"]
    assert abs(values["centre.displacement_y"]) < 1e-9 * scale
    assert abs(values["centre.displacement_z"]) < 1e-9 * scale
    # The traction on the top face, whose normal is z, is σ_xz.
    assert values["centre.stress_xz"] == pytest.approx(1e6, rel=0.1)


LINEAR = ["temperature", "stress", "displacement", "heat"]


def linear(values):
    """Outputs that are linear in the loads, as differences from rest."""
    names = [n for n in values if n.split(".")[1].split("_")[0].split("[")[0] in LINEAR]
    return {n: values[n] - (COLD if unit_of(n) == "K" else 0.0) for n in names}


def assert_close(a, b, relative):
    """Each value differs by no more than this part of the largest value of its unit, but for
    estimates of errors, which belong to the footprints that are tried."""
    a, b = ({n: v for n, v in one.items() if not n.endswith(".estimated_error")} for one in (a, b))
    assert a.keys() == b.keys()
    for kind in {unit_of(name) for name in a}:
        names = [name for name in a if unit_of(name) == kind]
        scale = max(abs(a[name]) for name in names)
        for name in names:
            assert b[name] == pytest.approx(a[name], abs=relative * scale), name


def test_loads_superpose(pack):
    parts = [linear(run(pack("plate"), {name: value, **ASIDE})) for name, value in SPOT.items()]
    every = linear(run(pack("plate"), {**SPOT, **ASIDE}))
    assert_close(every, {name: sum(part[name] for part in parts) for name in every}, 1e-11)
    tripled = {name: 3.0 * value for name, value in SPOT.items()}
    assert_close(
        linear(run(pack("plate"), {**tripled, **ASIDE})),
        {name: 3.0 * value for name, value in every.items()},
        1e-11,
    )


def mirrored_in_x(values):
    """Outputs as the plane x = 0 mirrors them."""
    turned = {}
    for name, value in values.items():
        if name.startswith("surface"):
            quantity, place = name[:-1].split("[")
            i, j = map(int, place.split(","))
            name = f"{quantity}[{5 - i},{j}]"
        elif name.startswith(("left", "right")):
            side, quantity = name.split(".")
            name = f"{'right' if side == 'left' else 'left'}.{quantity}"
        odd = name.endswith(("stress_xy", "stress_xz", "displacement_x"))
        turned[name] = -value if odd else value
    return turned


@pytest.mark.parametrize("symmetry", ["auto", "none"])
def test_a_mirrored_load_mirrors_the_fields(pack, symmetry):
    file = pack("plate", {'symmetry = "auto"': f'symmetry = "{symmetry}"'})
    here = run(file, {**SPOT, **ASIDE})
    mirrored = {**SPOT, **ASIDE, "spot.x": -9e-5, "spot.shear_x": -5e6}
    there = mirrored_in_x(run(file, mirrored))
    assert_close(here, {name: there[name] for name in here}, 1e-9)


@pytest.mark.parametrize("order", [1, 2])
def test_symmetry_neglects_nothing(pack, order):
    """The coarse mesh of the whole body is the mirrored one of its quarter."""
    quadratic = {
        "spacing = 3e-5, depth_spacing = 3e-5, growth = 1.2, order = 1": "order = 2, "
        "spacing = 6e-5, depth_spacing = 6e-5, growth = 1.2"
    }
    edits = quadratic if order == 2 else {}
    quarter = pack("plate", edits)
    whole = pack("plate", {**edits, 'symmetry = "auto"': 'symmetry = "none"'})
    a, b = (linear(run(file, {**SPOT, **ASIDE}, steps=[5e-5])) for file in (quarter, whole))
    assert_close(a, b, 1e-8)


def tile_inputs(value, count):
    return {
        f"patch.{kind}[{i},{j}]": amount * value
        for kind, amount in {"heat_flux": 1e8, "pressure": 1e7, "shear_x": 3e6}.items()
        for i in range(1, count[0] + 1)
        for j in range(1, count[1] + 1)
    }


def test_equal_tiles_are_one_rectangle(pack):
    place = {"patch.x": 3e-5, "patch.y": -2e-5}
    one = pack("tiles", {"count = [2, 3]": "count = [1, 1]"})
    single = run(one, {**tile_inputs(1.0, [1, 1]), **place})
    assert_close(single, run(pack("tiles"), {**tile_inputs(1.0, [2, 3]), **place}), 1e-11)


def test_tiles_stand_in_their_places(pack):
    """Tile [2,1] alone is a rectangle at its own place."""
    one = {"count = [2, 3], size = [1.1e-4, 0.9e-4]": "count = [1, 1], size = [0.55e-4, 0.3e-4]"}
    names = {"patch.heat_flux[2,1]": 1e8, "patch.pressure[2,1]": 1e7}
    tile = run(pack("tiles"), names)
    place = {"patch.x": 0.275e-4, "patch.y": -0.3e-4}
    fine = {
        **one,
        "x = [-1e-4, 1e-4], y = [-1e-4, 1e-4]": "x = [-1.275e-4, 1.275e-4], y = [-1.3e-4, 1.3e-4]",
    }
    single = run(
        pack("tiles", fine), {**tile_inputs(1.0, [1, 1]), **place, "patch.shear_x[1,1]": 0.0}
    )
    assert_close(single, tile, 1e-9)


@pytest.mark.parametrize("scene", ["rings", "plate"])
def test_equal_rings_are_a_disc(pack, scene):
    if scene == "rings":
        edits = {"rings = { count = 4, radius": "disc = { radius"}
        rings, disc = pack("rings"), pack("rings", edits)
        load = "splat"
    else:
        carried = {'"heat_flux", "pressure", "shear"': '"heat_flux", "pressure"'}
        edits = {"disc = { radius = 6e-5 }": "rings = { count = 4, radius = 6e-5 }"}
        rings, disc = pack("plate", {**carried, **edits}), pack("plate", carried)
        load = "spot"
    amounts = {f"{load}.heat_flux": 1e8, f"{load}.pressure": 1e7}
    place = ASIDE if scene == "plate" else {}
    each = {f"{name}[{i}]": value for name, value in amounts.items() for i in range(1, 5)}
    assert_close(run(disc, {**amounts, **place}), run(rings, {**each, **place}), 1e-9)


def test_rings_heat_what_they_cover(pack):
    width = 2e-5
    for i in range(1, 5):
        values = run(pack("rings"), {f"splat.heat_flux[{i}]": 1e7}, steps=[1e-4])
        area = pi * width**2 * (i**2 - (i - 1) ** 2)
        assert values["plate.heat_in"] == pytest.approx(1e7 * area * 1e-4, rel=1e-9)
