"""Scenes of one solid, and closed forms that several maps measure against."""

import math

ALUMINA = {
    "model": "thermoelastic",
    "density": 3950.0,
    "specific_heat": 900.0,
    "conductivity": 10.0,
}
ELASTIC = {"young": 300e9, "poisson": 0.21, "expansion": 8.1e-6}
DIFFUSIVITY = ALUMINA["conductivity"] / (ALUMINA["density"] * ALUMINA["specific_heat"])  # m²/s
START = 293.15  # K


def scene(body: dict, stop: float, step: float, **tables) -> dict:
    """A plate alone, with what acts on it and what is read of it."""
    whole = {"kind": "solid", "material": ALUMINA, "initial_temperature": START} | body
    return {"name": "Plate", "stop_time": stop, "step": step, "body": {"plate": whole}} | tables


def probe(name: str, at: list[float], *gives: str) -> dict:
    return {"name": name, "in": "plate", "at": at, "gives": list(gives)}


def load(footprint: dict, carries: str, value: float, **more) -> dict:
    start = {carries: value} | more.pop("start", {})
    own = {"name": "spot", "on": "plate.top", "footprint": footprint, "carries": [carries]}
    return own | {"start": start} | more


def slab_surface_rise(flux: float, thickness: float, time: float) -> float:
    """`ΔT = q L/k [F + 1/3 − 2/π² Σ e^{−n²π²F}/n²]`, `F = a t/L²`: flux in, insulated back [K].

    Carslaw & Jaeger (1959), Conduction of Heat in Solids, § 3.8."""
    fourier = DIFFUSIVITY * time / thickness**2
    terms = (math.exp(-((n * math.pi) ** 2) * fourier) / n**2 for n in range(1, 200))
    settled = fourier + 1.0 / 3.0 - 2.0 / math.pi**2 * sum(terms)
    return flux * thickness / ALUMINA["conductivity"] * settled


def ierfc(x: float) -> float:
    return math.exp(-x * x) / math.sqrt(math.pi) - x * math.erfc(x)


def disc_flux_rise(flux: float, radius: float, depth: float, time: float) -> float:
    """On the axis of a disc of flux on a half space [K] (Carslaw & Jaeger 1959, § 10.5)."""
    reach = 2.0 * math.sqrt(DIFFUSIVITY * time)
    shape = ierfc(depth / reach) - ierfc(math.hypot(depth, radius) / reach)
    return flux * reach / ALUMINA["conductivity"] * shape


def geometric(low: float, high: float, count: int) -> list[float]:
    """Values in a constant ratio, in three digits, so that tables name them."""
    return [float(f"{low * (high / low) ** (place / (count - 1)):.3g}") for place in range(count)]
