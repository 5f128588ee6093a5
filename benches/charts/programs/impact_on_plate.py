"""The course of an impact on a plate, for programs that step one of their own through it."""


def follow(plate) -> dict[str, float]:
    """What `readings` of its case ask for, each after a step at a depth.

    `schedule` has a row for each step: its end [s], the flux [W/m²] and the pressure [Pa] over it;
    within one, heat advances in `parts` of it. A plate has `advance(flux, duration, parts)`,
    `temperature(depth)`, the rise [K], and `stresses(pressure, depth)`, two on the axis [Pa]: that
    across it and that along it."""
    case, values, begin = plate.case, {}, 0.0
    for number, (end, flux, pressure) in enumerate(case["schedule"], 1):
        plate.advance(flux, end - begin, case["parts"])
        begin = end
        for name, (step, depth, what) in case["readings"].items():
            if step == number:
                values[name] = read(plate, what, pressure, depth)
    return values


def read(plate, what: str, pressure: float, depth: float) -> float:
    if what == "temperature":
        return plate.case["initial"] + plate.temperature(depth)
    across, axial = plate.stresses(pressure, depth)
    return {"stress": across, "von_mises": abs(across - axial)}[what]
