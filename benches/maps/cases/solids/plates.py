"""Plates and loads that several maps of solids share."""

import math

from problems.materials import ALUMINA, diffusivity

DIFFUSIVITY = diffusivity(ALUMINA)  # m²/s


def slab_surface_rise(flux: float, thickness: float, time: float) -> float:
    """`ΔT = q L/k [F + 1/3 − 2/π² Σ e^{−n²π²F}/n²]`, `F = a t/L²`: flux in, insulated back [K].

    Carslaw & Jaeger (1959), Conduction of Heat in Solids, § 3.8."""
    fourier = DIFFUSIVITY * time / thickness**2
    terms = (math.exp(-((n * math.pi) ** 2) * fourier) / n**2 for n in range(1, 200))
    settled = fourier + 1.0 / 3.0 - 2.0 / math.pi**2 * sum(terms)
    return flux * thickness / ALUMINA["conductivity"] * settled


def geometric(low: float, high: float, count: int) -> list[float]:
    """Values in a constant ratio, in three digits, so that tables name them."""
    return [float(f"{low * (high / low) ** (place / (count - 1)):.3g}") for place in range(count)]
