"""Newton's methods: a front that melts, and a block that is pressed up to its limit."""

import math

from plan import Answer, Axis, Boundary, Map, Work
from problems.materials import ALUMINA, ELASTIC_ALUMINA, thermoelastic
from problems.plates import probe, scene
from scipy.optimize import brentq
from unit_run import equal_steps, run_unit, unit_work

from cases.solids.plates import DIFFUSIVITY, geometric

MELTING, LATENT, DEEP = 1000.0, 2.0e5, 1e-3  # K, J/kg, m
WIDE = 0.2e-3
CAPACITY = ALUMINA["specific_heat"]
FRONT = 0.3e-3
"""How deep the front is to come [m]."""
COLD = 100.0  # K below melting


def growth(stefan: float) -> float:
    """λ of Neumann's front `s = 2λ√(at)`: Carslaw & Jaeger (1959), § 11.2.

    `e^{−λ²}/erf λ − (T_m − T_0)/(T_s − T_m) e^{−λ²}/erfc λ = √π λ/Ste`, one set of constants."""
    ratio = COLD / (stefan * LATENT / CAPACITY)

    def excess(x: float) -> float:
        bell = math.exp(-x * x)
        return bell / math.erf(x) - ratio * bell / math.erfc(x) - math.sqrt(math.pi) * x / stefan

    return brentq(excess, 1e-6, 4.0, xtol=1e-14)


def melted(stefan: float, part: float) -> Work:
    """A slab whose top is held above melting until the front is where it should be."""
    stop = (FRONT / (2.0 * growth(stefan))) ** 2 / DIFFUSIVITY
    melting = {"solidus": MELTING, "liquidus": MELTING, "latent_heat": LATENT}
    surface = MELTING + stefan * LATENT / CAPACITY
    thickness = max(DEEP, 6.0 * math.sqrt(DIFFUSIVITY * stop))
    body = {
        "shape": {"box": [WIDE, WIDE, thickness]},
        "material": thermoelastic(ALUMINA, {"melting": melting}),
        "initial_temperature": MELTING - COLD,
        "faces": {"top": {"temperature": surface}},
    }
    told = scene(body, stop, part * stop)
    return unit_work(told, ["plate.liquid_volume"], equal_steps(stop, round(1.0 / part)))


def of_front(answer: Answer, *_) -> float:
    return abs(answer.values["plate.liquid_volume"][-1] / (WIDE**2 * FRONT) - 1.0)


def melting_front() -> Map:
    return Map(
        name="melting_front",
        title="A melting front",
        x=Axis("Stefan number c (T − T_melt)/L", "1", [0.01, 0.03, 0.1, 0.3, 1.0, 3.0, 10.0]),
        y=Axis("communication step over the whole time", "1", [0.01, 0.03125, 0.1, 0.25, 0.5, 1.0]),
        outcome="error of the front's depth",
        unit="1",
        bad=0.05,
        work=melted,
        run=run_unit,
        judge=of_front,
        colours=(1e-4, 0.1),
    )


SIDE, YIELD, STOP = 1e-4, 200e6, 1.0  # m, Pa, s


def pressed(hardening: float):
    """A free block on rollers under pressure that grows to so many times what it bears."""

    def work(steps: float, over: float) -> Work:
        count = round(steps)
        law = {"model": "elastoplastic", "yield_stress": YIELD, "isotropic_hardening": hardening}
        rollers = dict.fromkeys(("bottom", "left", "front"), {"roller": True})
        body = {
            "shape": {"box": [SIDE] * 3},
            "material": ALUMINA | ELASTIC_ALUMINA | law,
            "mesh": {"spacing": SIDE / 4.0, "growth": 1.0},
            "faces": rollers,
        }
        tiles = {"tiles": {"count": [1, 1], "size": [SIDE, SIDE]}}
        press = {
            "name": "press",
            "on": "plate.top",
            "footprint": tiles,
            "carries": ["pressure"],
            "start": {"pressure": 0.0},
        }
        told = scene(
            body,
            STOP,
            STOP / count,
            load=[press],
            probe=[probe("corner", [0.5 * SIDE, 0.5 * SIDE, 0.0], "displacement")],
        )
        path = [over * YIELD * (place + 1) / count for place in range(count)]
        inputs = {"press.pressure[1,1]": path}
        return unit_work(told, ["corner.displacement_z"], equal_steps(STOP, count), inputs)

    return work


def shortening(over: float, hardening: float) -> float:
    """`ε = σ/E + (σ − σ_y)/H`: Hill (1950), The Mathematical Theory of Plasticity, § II [m]."""
    plastic = max(over - 1.0, 0.0) * YIELD / hardening if hardening else 0.0
    return SIDE * (over * YIELD / ELASTIC_ALUMINA["young"] + plastic)


def of_yield(hardening: float):
    def judge(answer: Answer, _: float, over: float) -> float:
        return abs(-answer.values["corner.displacement_z"][-1] / shortening(over, hardening) - 1.0)

    return judge


COUNTS = [1.0, 2.0, 4.0, 8.0, 16.0, 32.0]


def limit_load() -> Map:
    return Map(
        name="limit_load",
        title="A block pressed beyond what it bears",
        x=Axis("steps", "1", COUNTS),
        y=Axis("pressure over yield stress", "1", [0.5, 0.65, 0.8, 1.2, 1.5, 2.0, 3.0]),
        outcome="error of its shortening",
        unit="1",
        bad=1e-3,
        work=pressed(0.0),
        run=run_unit,
        judge=of_yield(0.0),
        theory=[Boundary("limit load", lambda _: 1.0, "yield stress")],
        refusal_is_edge=True,
        refine=1.01,
        colours=(1e-9, 1e-2),
    )


STIFF = 30e9  # Pa


def hardening_block() -> Map:
    return Map(
        name="hardening_block",
        title="A block that hardens, pressed in few steps or many",
        x=Axis("steps", "1", COUNTS),
        y=Axis("pressure over yield stress", "1", geometric(0.5, 100.0, 8)),
        outcome="error of its shortening",
        unit="1",
        bad=1e-3,
        work=pressed(STIFF),
        run=run_unit,
        judge=of_yield(STIFF),
        colours=(1e-9, 1e-2),
    )
