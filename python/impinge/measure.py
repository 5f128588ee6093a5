"""Units of measurement: exponents of SI's base units, a factor and an offset."""

from __future__ import annotations

import re
from decimal import Decimal
from typing import Any, NamedTuple

from impinge.proposal import proposal

BASE = ("kg", "m", "s", "A", "K", "mol", "cd", "rad")
_MOST = 9  # of an exponent
_SUPERSCRIPTS = str.maketrans("⁰¹²³⁴⁵⁶⁷⁸⁹⁻", "0123456789-")


class Measure(NamedTuple):
    """A unit of measurement: `value in base units = factor · value + offset`, as FMI defines it."""

    exponents: tuple[int, ...]
    factor: float = 1.0
    offset: float = 0.0


def conversion(source: Measure | None, target: Measure | None) -> tuple[float, float]:
    """Returns factor and shift from one unit of measurement to another: 1 and 0 if one is unknown.

    Raises `ValueError` for quantities of different kinds.
    """
    if source is None or target is None:
        return 1.0, 0.0
    if source.exponents != target.exponents:
        raise ValueError("these are quantities of different kinds")
    return source.factor / target.factor, (source.offset - target.offset) / target.factor


def _of(factor: float = 1.0, offset: float = 0.0, **exponents: int) -> Measure:
    return Measure(tuple(exponents.get(base, 0) for base in BASE), factor, offset)


KELVIN = _of(K=1)
# With prefixes of SI
_PREFIXED = {
    "m": _of(m=1),
    "g": _of(1e-3, kg=1),
    "s": _of(s=1),
    "A": _of(A=1),
    "K": KELVIN,
    "mol": _of(mol=1),
    "cd": _of(cd=1),
    "rad": _of(rad=1),
    "Hz": _of(s=-1),
    "N": _of(kg=1, m=1, s=-2),
    "Pa": _of(kg=1, m=-1, s=-2),
    "J": _of(kg=1, m=2, s=-2),
    "W": _of(kg=1, m=2, s=-3),
    "C": _of(s=1, A=1),
    "V": _of(kg=1, m=2, s=-3, A=-1),
    "F": _of(kg=-1, m=-2, s=4, A=2),
    "ohm": _of(kg=1, m=2, s=-3, A=-2),
    "Ω": _of(kg=1, m=2, s=-3, A=-2),
    "S": _of(kg=-1, m=-2, s=3, A=2),
    "Wb": _of(kg=1, m=2, s=-2, A=-1),
    "T": _of(kg=1, s=-2, A=-1),
    "H": _of(kg=1, m=2, s=-2, A=-2),
    "bar": _of(1e5, kg=1, m=-1, s=-2),
    "L": _of(1e-3, m=3),
    "l": _of(1e-3, m=3),
}
_PREFIXES = {
    "n": 1e-9,
    "u": 1e-6,
    "µ": 1e-6,  # the sign for micro
    "μ": 1e-6,  # the Greek letter
    "m": 1e-3,
    "c": 1e-2,
    "d": 1e-1,
    "k": 1e3,
    "M": 1e6,
    "G": 1e9,
}
_RADIANS = 0.017453292519943295
_PLAIN = {
    "kg": _of(kg=1),
    "t": _of(1e3, kg=1),
    "in": _of(0.0254, m=1),
    "ft": _of(0.3048, m=1),
    "mil": _of(2.54e-5, m=1),
    "micron": _of(1e-6, m=1),
    "microns": _of(1e-6, m=1),
    "Å": _of(1e-10, m=1),
    "%": _of(1e-2),
    "min": _of(60.0, s=1),
    "h": _of(3600.0, s=1),
    "d": _of(86400.0, s=1),
    "deg": _of(_RADIANS, rad=1),
    "°": _of(_RADIANS, rad=1),
    "degC": _of(1.0, 273.15, K=1),
    "°C": _of(1.0, 273.15, K=1),
    "degF": _of(5.0 / 9.0, 459.67 * 5.0 / 9.0, K=1),
    "°F": _of(5.0 / 9.0, 459.67 * 5.0 / 9.0, K=1),
}
_QUANTITY = re.compile(r"\s*([-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?)\s*(\D.*?)\s*")
_TOKEN = re.compile(
    r"\s*(?:(?P<symbol>[^\W\d_]+|[°%][CF]?)(?:\s*(?:\^|\*\*)\s*|)(?P<power>[-+]?\d+|)"
    r"|(?P<one>1)(?![\d.])|(?P<open>\()|(?P<close>\))|(?P<times>[.*·])|(?P<over>/))"
)


def parse(text: str) -> Measure:
    """Returns the unit of measurement that a text such as `W/(m2.K)` or `kJ/(kg K)` names.

    Factors are joined by `.`, `*`, `·` or a space, exponents follow their symbol (`m2`, `m^-2`,
    `m²`), and `1` is the unit of pure numbers. Raises `ValueError` for what is no unit.
    """
    if not isinstance(text, str) or not text.strip():
        raise ValueError(f"{text!r} is no unit of measurement (allowed: a text such as 'W/(m2.K)')")
    found, _ = _product(_tokens(text), text)
    return found


def metres(value: Any) -> float | None:
    """Returns a length of a scene, a number in m or a text such as `8 mm`; None if it is none."""
    if isinstance(value, int | float):
        return float(value)
    parts = _QUANTITY.fullmatch(value.replace("−", "-")) if isinstance(value, str) else None
    if parts is None:
        return None
    try:
        measure = parse(parts[2])
    except ValueError:
        return None
    if measure.exponents != _PREFIXED["m"].exponents:
        return None
    return float(Decimal(parts[1]) * Decimal(repr(measure.factor)))  # to the bit


def _tokens(text: str) -> list[re.Match[str]]:
    plain, at, tokens = text.strip().translate(_SUPERSCRIPTS), 0, []
    while at < len(plain):
        token = _TOKEN.match(plain, at)
        if token is None:
            raise _fault(text, f"`{plain[at:].strip()[:20]}` is no part of one")
        tokens.append(token)
        at = token.end()
    return tokens


def _product(
    tokens: list[re.Match[str]], text: str, is_inner: bool = False
) -> tuple[Measure, list[re.Match[str]]]:
    """Factors up to the end, or to the parenthesis that closes."""
    factors: list[tuple[Measure, int]] = []
    sign, is_over = 1, False
    wants_factor = True
    while tokens:
        token, *tokens = tokens
        if token["times"] or token["over"]:
            if wants_factor:
                raise _fault(text, f"a factor is missing before `{token[0].strip()}`")
            sign, wants_factor = (-1 if token["over"] else 1), True
            is_over = is_over or bool(token["over"])
            continue
        if token["close"]:
            if not is_inner or wants_factor:
                raise _fault(text, "a parenthesis closes without need")
            return _joined(factors, text), tokens
        if is_over and sign > 0:
            raise _fault(text, "a product follows `/`; write W/(m2 K), or m2 K/W")
        if token["open"]:
            inner, tokens = _product(tokens, text, is_inner=True)
            factors.append((inner, sign))
        else:
            factors.append((_single(token, text), sign))
        sign, wants_factor = 1, False
    if is_inner:
        raise _fault(text, "a parenthesis stays open")
    if wants_factor:
        raise _fault(text, "a factor is missing at the end")
    return _joined(factors, text), tokens


def _single(token: re.Match[str], text: str) -> Measure:
    if token["one"]:
        return _of()
    base, power = _symbol(token["symbol"], text), int(token["power"] or 1)
    if not 0 < abs(power) <= _MOST:
        raise _fault(text, f"the exponent {power} is beyond ±{_MOST}, or 0")
    if base.offset and power != 1:
        raise _fault(text, f"`{token['symbol']}` has no powers; differences are in K")
    return Measure(tuple(power * n for n in base.exponents), base.factor**power, base.offset)


def _symbol(name: str, text: str) -> Measure:
    known = _PLAIN.get(name) or _PREFIXED.get(name)
    if known is not None:
        return known
    base = _PREFIXED.get(name[1:])
    if base is None or name[0] not in _PREFIXES:
        raise _fault(text, f"`{name}` is no unit that is known here{_hint(name)}")
    return base._replace(factor=_PREFIXES[name[0]] * base.factor)


def _hint(name: str) -> str:
    names = [*_PLAIN, *_PREFIXED]
    allowed = f" (allowed: {', '.join(_PLAIN)}, and with prefixes {', '.join(_PREFIXED)})"
    return proposal(name, names) or allowed


def _joined(factors: list[tuple[Measure, int]], text: str) -> Measure:
    if len(factors) == 1 and factors[0][1] == 1:
        return factors[0][0]
    exponents, factor = [0] * len(BASE), 1.0
    for each, sign in factors:
        if each.offset:
            raise _fault(text, "temperatures with an offset have no products; differences are in K")
        exponents = [n + sign * m for n, m in zip(exponents, each.exponents, strict=True)]
        factor = factor * each.factor if sign > 0 else factor / each.factor
    return Measure(tuple(exponents), factor)


def _fault(text: str, why: str) -> ValueError:
    return ValueError(f"`{text}` is no unit of measurement: {why}")
