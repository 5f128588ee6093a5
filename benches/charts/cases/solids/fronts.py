"""Slabs that vary along their depth alone, with closed forms: two layers, and one that melts."""

import cmath
import math

from chart import Chart, Method, Point, Quantity, UnitRun
from problems import plates
from problems.materials import ALUMINA, STEEL, diffusivity, thermal, thermoelastic
from problems.plates import START, probe

FLUX, STOP, STEPS, WIDE = 1e6, 1e-3, 10, 0.1e-3  # W/m², s, 1, m
POLYMER = thermal(1200.0, 1200.0, 0.2)
FILM, BASE, RESISTANCE = 10e-6, 190e-6, 5e-6  # m, m, m² K/W
TOP, INTERFACE = "temperature of the top", "temperature below the interface"


def layered_image(s: complex) -> tuple[complex, complex]:
    """Laplace transforms of the rises of the top and of the second layer's upper side [K s].

    A layer is a two-port: `[T, q]` at its upper side is `[[cosh, sinh/(ke)], [ke sinh, cosh]]` of
    those at its lower side, `e = √(s/a)`; a contact adds R q to T; no heat leaves below (Carslaw &
    Jaeger 1959, § 3.7)."""
    rise, flux = 1.0 + 0j, 0j
    sides = []
    for material, thickness, contact in ((ALUMINA, BASE, RESISTANCE), (POLYMER, FILM, 0.0)):
        k = material["conductivity"]
        root = cmath.sqrt(s * material["density"] * material["specific_heat"] / k)
        over, under = cmath.cosh(root * thickness), cmath.sinh(root * thickness)
        rise, flux = over * rise + under / (k * root) * flux, k * root * under * rise + over * flux
        sides.append(rise)
        rise = rise + contact * flux
    scale = FLUX / s / flux
    return rise * scale, sides[0] * scale


def inverted(part: int, time: float, terms: int = 24) -> float:
    """By Talbot's contour (Weideman 2006, doi 10.1137/050625837)."""
    total = 0j
    for place in range(terms):
        angle = -math.pi + (place + 0.5) * 2.0 * math.pi / terms
        turn = 0.6407 * angle
        s = terms / time * (0.5017 * angle / cmath.tan(turn) - 0.6122 + 0.2645j * angle)
        slope = 0.5017 / cmath.tan(turn) - 0.5017 * turn / cmath.sin(turn) ** 2 + 0.2645j
        total += cmath.exp(s * time) * layered_image(s)[part] * slope
    return (total / (1j * time)).real


def layers_scene(**more) -> dict:
    plate = {
        "kind": "solid",
        "shape": {"box": [WIDE, WIDE, FILM + BASE]},
        "layers": [
            {"material": thermoelastic(POLYMER), "thickness": FILM},
            {
                "material": thermoelastic(ALUMINA),
                "thickness": BASE,
                "contact_resistance": RESISTANCE,
            },
        ],
        "initial_temperature": START,
        "faces": {"top": {"flux": FLUX}},
    } | more.pop("body", {})
    at_interface = [0.0, 0.0, -FILM]
    probes = [
        probe("top", [0.0, 0.0, 0.0], "temperature"),
        probe("film", at_interface, "temperature", side="below"),
    ]
    general = {"name": "Layers", "stop_time": STOP, "step": STOP / STEPS}
    return general | {"body": {"plate": plate}, "probe": probes} | more


def layers() -> Chart:
    outputs = {TOP: "top.temperature", INTERFACE: "film.temperature"}
    rises = [inverted(part, STOP) for part in (0, 1)]
    source = "Laplace transform, inverted on Talbot's contour"
    quantities = [
        Quantity(name, "K", START + rise, rise, source)
        for name, rise in zip(outputs, rises, strict=True)
    ]

    def asked(tolerance: float) -> UnitRun:
        return UnitRun(layers_scene(fidelity={"tolerance": tolerance}), outputs, steps=STEPS)

    def spaced(order: int, spacing: float) -> UnitRun:
        mesh = {"spacing": spacing, "depth_spacing": spacing, "growth": 1.0, "order": order}
        return UnitRun(layers_scene(body={"mesh": mesh}), outputs, steps=STEPS)

    spacings = [10e-6, 5e-6, 2.5e-6]
    methods = [Method("by tolerance", [Point(f"{t:g}", asked(t), t) for t in (1e-1, 3e-2, 1e-2)])]
    for order, name in ((2, "quadratic elements"), (1, "linear elements")):
        points = [Point(f"{1e6 * spacing:g} µm", spaced(order, spacing)) for spacing in spacings]
        methods.append(Method(name, points))
    points = "At the ends of curves: tolerance, or distance of nodes."
    title = "A polymer film on alumina, heated for 1 ms"
    return Chart("layers", title, quantities, methods, points)


MELTING, LATENT, HOT, DEEP, MELTING_STOP = 1000.0, 2.0e5, 1500.0, 1e-3, 5e-3
MELTED = "volume that is liquid"


def front() -> float:
    """Neumann's one-phase front [m] (Carslaw & Jaeger 1959, § 11.2).

    `s = 2λ√(at)`, `√π λ e^{λ²} erf λ = c ΔT/L`."""
    stefan = STEEL["specific_heat"] * (HOT - MELTING) / LATENT
    low, high = 0.0, 5.0
    for _ in range(100):
        middle = 0.5 * (low + high)
        grown = math.sqrt(math.pi) * middle * math.exp(middle**2) * math.erf(middle)
        low, high = (middle, high) if grown < stefan else (low, middle)
    return 2.0 * low * math.sqrt(diffusivity(STEEL) * MELTING_STOP)


def melting_scene(**more) -> dict:
    melts = {"solidus": MELTING, "liquidus": MELTING, "latent_heat": LATENT}
    plate = {
        "shape": {"box": [WIDE, WIDE, DEEP]},
        "material": thermoelastic(STEEL, {"melting": melts}),
        "initial_temperature": MELTING,
        "faces": {"top": {"temperature": HOT}},
    } | more.pop("body", {})
    return plates.scene(plate, MELTING_STOP, MELTING_STOP / STEPS, "Melting") | more


def melting() -> Chart:
    outputs = {MELTED: "plate.liquid_volume"}
    volume = front() * WIDE**2
    quantity = Quantity(MELTED, "m³", volume, volume, "closed form, Neumann, over the face")

    def asked(tolerance: float) -> UnitRun:
        return UnitRun(melting_scene(fidelity={"tolerance": tolerance}), outputs, steps=STEPS)

    def spaced(spacing: float) -> UnitRun:
        mesh = {"spacing": spacing, "depth_spacing": spacing, "growth": 1.0, "order": 1}
        return UnitRun(melting_scene(body={"mesh": mesh}), outputs, steps=STEPS)

    methods = [
        Method("by tolerance", [Point(f"{t:g}", asked(t), t) for t in (1e-1, 1e-2, 1e-3, 1e-4)]),
        Method(
            "equal distances",
            [Point(f"{1e6 * s:g} µm", spaced(s)) for s in (40e-6, 20e-6, 10e-6)],
        ),
    ]
    points = "At the ends of curves: tolerance, or distance of nodes."
    return Chart("melting", "Steel that melts from its hot face", [quantity], methods, points)
