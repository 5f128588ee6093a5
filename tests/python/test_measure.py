"""Units of measurement as texts, against their definitions in SI."""

import pytest
from impinge import Unit
from impinge.measure import BASE, conversion, parse


@pytest.mark.parametrize(
    ("text", "exponents", "factor", "offset"),
    [
        ("1", {}, 1.0, 0.0),
        ("%", {}, 0.01, 0.0),
        ("degC", {"K": 1}, 1.0, 273.15),
        ("°F", {"K": 1}, 5 / 9, 459.67 * 5 / 9),
        ("kg", {"kg": 1}, 1.0, 0.0),
        ("mm2", {"m": 2}, 1e-6, 0.0),
        ("µm", {"m": 1}, 1e-6, 0.0),
        ("ml/min", {"m": 3, "s": -1}, 1e-6 / 60, 0.0),
        ("MPa", {"kg": 1, "m": -1, "s": -2}, 1e6, 0.0),
        ("W/(m2.K)", {"kg": 1, "s": -3, "K": -1}, 1.0, 0.0),
        ("W m⁻² K^-1", {"kg": 1, "s": -3, "K": -1}, 1.0, 0.0),
        ("W/m**2/K", {"kg": 1, "s": -3, "K": -1}, 1.0, 0.0),
        ("kJ/(kg K)", {"m": 2, "s": -2, "K": -1}, 1e3, 0.0),
        ("V.A", {"kg": 1, "m": 2, "s": -3}, 1.0, 0.0),
        ("deg/s", {"rad": 1, "s": -1}, 0.017453292519943295, 0.0),
        ("in", {"m": 1}, 0.0254, 0.0),
        ("1/ft2", {"m": -2}, 0.3048**-2, 0.0),
        ("microns", {"m": 1}, 1e-6, 0.0),
    ],
)
def test_texts_mean_what_si_defines(text, exponents, factor, offset):
    found = parse(text)
    wanted = dict.fromkeys(BASE, 0) | exponents
    assert dict(zip(BASE, found.exponents, strict=True)) == wanted
    assert found.factor == pytest.approx(factor, rel=1e-15) and found.offset == offset


def test_every_unit_of_measurement_of_a_unit_is_read_as_the_unit_defines_it(pack):
    with Unit(pack("tiles")) as unit:
        names = {variable.unit for variable in unit.variables.values()} - {None}
        assert {"K", "W/m2", "W/(m.K)", "J/(kg.K)", "1/K"} <= names
        for name in names:
            assert parse(name) == unit.measure(name), name


def test_values_convert_with_their_offsets():
    factor, shift = conversion(parse("°F"), parse("°C"))
    assert factor * 212.0 + shift == pytest.approx(100.0)
    assert conversion(parse("kW"), None) == (1.0, 0.0)
    with pytest.raises(ValueError, match="different kinds"):
        conversion(parse("K"), parse("W"))


@pytest.mark.parametrize(
    ("text", "told"),
    [
        ("", "is no unit of measurement"),
        (None, "is no unit of measurement"),
        ("w/m2", "is it `W`?"),
        ("Kelvin", "is no unit that is known here"),
        ("W/m2 K", "a product follows `/`; write W/(m2 K)"),
        ("W//m", "a factor is missing before `/`"),
        ("(W", "a parenthesis stays open"),
        ("W)", "a parenthesis closes without need"),
        ("W/", "a factor is missing at the end"),
        ("3 m", "`3 m` is no part of one"),
        ("m99", "the exponent 99 is beyond"),
        ("degC/s", "temperatures with an offset have no products"),
        ("degC2", "`degC` has no powers"),
    ],
)
def test_texts_that_name_no_unit_are_refused(text, told):
    with pytest.raises(ValueError) as refused:
        parse(text)
    assert told in str(refused.value)
