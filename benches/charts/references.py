"""References that are measured: values of points take their place as soon as these are known."""

from dataclasses import replace

from chart import Chart, Measured, Outcome
from table import key

UNKNOWN = float("nan")


def value(chart: Chart, of: float | Measured, known: dict[tuple[str, str], Outcome]) -> float:
    """Not a number where the point is not measured yet."""
    if not isinstance(of, Measured):
        return of
    (method,) = (method for method in chart.methods if method.name == of.method)
    places = [(of.method, key(point)) for point in method.points if point.setting == of.setting]
    if not places:
        raise KeyError(f"{of.method} has no point {of.setting}")
    outcomes = (known[place] for place in places if place in known)
    return next((o.values[of.quantity] for o in outcomes if of.quantity in o.values), UNKNOWN)


def resolved(chart: Chart, known: dict[tuple[str, str], Outcome]) -> Chart:
    """The chart, its references numbers."""
    quantities = []
    for quantity in chart.quantities:
        reference = value(chart, quantity.reference, known)
        scale = abs(reference) if quantity.scale is None else quantity.scale
        quantities.append(replace(quantity, reference=reference, scale=scale))
    methods = [
        replace(
            method,
            references={name: value(chart, of, known) for name, of in method.references.items()},
        )
        for method in chart.methods
    ]
    return replace(chart, quantities=quantities, methods=methods)
