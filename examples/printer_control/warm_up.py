"""The bed warms up: a plan by its linear map, the plan made anew at each step, and PI control."""

import time
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from impinge import Connection, Master, Unit
from impinge.linear import LinearMap, Plan, linear_map, plan

MOVE, MOVES = 0.1, 60  # s, moves of a plan
SAMPLE = 0.05  # s, step of the PI controller
PAD = 20e-3 * 12e-3  # m², area of the heater
HIGHEST = 60.0  # W of the heater at most
ROOM, WANTED = 298.15, 393.15  # K
HOTTEST = 423.15  # K, what the middle may have
PROBES = ["thermocouple.temperature", "middle.temperature"]
SMOOTH = 1e-10  # K²/(W/m²)², what a change of the flux costs beside what temperatures miss
# Of 30 gains from 0.5 to 4 W/K and times from 2 to 12 s the one that comes within 1 K first
SEARCHED = {"gain": 1.0, "integral_time": 5.0}
# A bed that is not what the map was made of
OTHER = {"bed.specific_heat": 1.1 * 896.0, "bed.bottom.coefficient": 1.3 * 250.0}


@dataclass
class Run:
    """Times [s], temperatures [K] then in the order of PROBES, power [W] over the step from it."""

    times: np.ndarray
    temperatures: np.ndarray
    powers: np.ndarray

    @property
    def energy(self) -> float:
        """Heat brought in [J]."""
        return float(self.powers[:-1] @ np.diff(self.times))

    @property
    def rise_time(self) -> float:
        """From 10 % to 90 % of the change at the thermocouple [s]; not a number if it never is."""
        share = (self.temperatures[:, 0] - ROOM) / (WANTED - ROOM)
        return float(np.subtract(*(self._reaches(share, level) for level in (0.9, 0.1))))

    @property
    def settling_time(self) -> float:
        """When the thermocouple has come within 1 K for good [s]; not a number if it has not."""
        outside = int(np.flatnonzero(np.abs(self.temperatures[:, 0] - WANTED) > 1.0)[-1])
        return float(self.times[outside + 1]) if outside + 1 < len(self.times) else np.nan

    @property
    def overshoot(self) -> float:
        """Highest temperature at the thermocouple above the set point [K]."""
        return max(0.0, float(self.temperatures[:, 0].max() - WANTED))

    def _reaches(self, share: np.ndarray, level: float) -> float:
        after = int(np.argmax(share >= level))
        if after == 0:
            return np.nan  # never
        around = slice(after - 1, after + 1)
        return float(np.interp(level, share[around], self.times[around]))


def learn(bed: Unit) -> LinearMap:
    """What the heater does to both probes, from the bed's present state."""
    return linear_map(bed, ["heater.heat_flux"], PROBES, MOVE, MOVES)


def tune(found: LinearMap) -> dict[str, float]:
    """Gain [W/K] and integral time [s] of a PI controller by the SIMC rule for slow processes,

        K = 1 / (s (τ + θ)),  T = 4 (τ + θ),  τ = θ

    with the steepest slope s [K/(s W)] of the thermocouple's step response and the delay θ [s]
    where its tangent there begins, and half a sample (S. Skogestad 2003,
    doi 10.1016/S0959-1524(02)00062-8).
    """
    response = np.concatenate([[0.0], found.step_response[:, 0, 0] / PAD])  # K/W
    slopes = np.diff(response) / found.step
    steepest = int(np.argmax(slopes))
    middle = (steepest + 0.5) * found.step
    level = 0.5 * (response[steepest] + response[steepest + 1])
    delay = middle - level / slopes[steepest] + SAMPLE / 2
    return {"gain": 1 / (slopes[steepest] * 2 * delay), "integral_time": 8 * delay}


def make_plan(found: LinearMap, previous: float = 0.0, free: np.ndarray | None = None) -> Plan:
    """Heat fluxes of the next 60 moves: the thermocouple at the set point as soon as may be, the
    middle never above its limit, the heater within its own."""
    return plan(
        found,
        WANTED,
        weights=[1.0, 0.0],
        changes=SMOOTH,
        lower=0.0,
        upper=HIGHEST / PAD,
        highest=[np.inf, HOTTEST],
        previous=previous,
        free=free,
    )


def follow(bed: Unit, fluxes: np.ndarray) -> Run:
    """The bed under a plan, as it was made."""
    rows = [bed.get(PROBES)]
    for flux in fluxes.ravel():
        bed["heater.heat_flux"] = flux
        bed.step(MOVE)
        rows.append(bed.get(PROBES))
    powers = np.append(fluxes.ravel(), np.nan) * PAD
    return Run(MOVE * np.arange(len(rows)), np.array(rows), powers)


def replan(bed: Unit, model: Unit, found: LinearMap) -> tuple[Run, list[float]]:
    """The bed under the first move of a plan that is made anew at each step, and the seconds that
    each took: from the state of a model that gets the same heat, shifted by what was measured."""
    rows, powers, seconds = [bed.get(PROBES)], [], []
    flux = 0.0
    for _ in range(MOVES):
        began = time.perf_counter()
        free = found.free_response(model) + (rows[-1] - model.get(PROBES))
        flux = float(make_plan(found, flux, free).inputs[0, 0])
        seconds.append(time.perf_counter() - began)
        for unit in (bed, model):
            unit["heater.heat_flux"] = flux
            unit.step(MOVE)
        rows.append(bed.get(PROBES))
        powers.append(flux * PAD)
    times = MOVE * np.arange(len(rows))
    return Run(times, np.array(rows), np.array([*powers, np.nan])), seconds


def under_pi(bed: Unit, controller: Path, settings: dict[str, float]) -> Run:
    """The bed under the controller's unit, joined by a master."""
    master = Master(
        {"bed": bed, "controller": controller},
        [
            ("bed.thermocouple.temperature", "controller.measured"),
            Connection("controller.power", "bed.heater.heat_flux[1,1]", gain=1 / PAD),
        ],
        scheme="gauss-seidel",
        order=0,
        step=SAMPLE,
        inputs={"controller.wanted": WANTED},
        outputs=[f"bed.{probe}" for probe in PROBES],
        parameters={"controller": {**settings, "highest": HIGHEST}},
    )
    with master:
        table = master.run(MOVE * MOVES, progress=False)
    temperatures = np.stack([table[f"bed.{probe}"].values for probe in PROBES], axis=1)
    return Run(table["time"].values, temperatures, table["controller.power"].values)
