"""Closed forms of half spaces: heated and pressed discs, and two that touch."""

from math import erfc, exp, hypot, pi, sqrt

from scipy.special import erfcx

from problems.materials import diffusivity, effusivity


def ierfc(x: float) -> float:
    return exp(-x * x) / sqrt(pi) - x * erfc(x)


def disc_flux_rise(flux: float, radius: float, depth: float, time: float, material: dict) -> float:
    """Rise on the axis of a disc of flux [K] (Carslaw & Jaeger 1959, § 10.5).

    `2q√(at)/k [ierfc(z/(2√(at))) − ierfc(√(z² + R²)/(2√(at)))]`."""
    reach = 2.0 * sqrt(diffusivity(material) * time)
    shape = ierfc(depth / reach) - ierfc(hypot(depth, radius) / reach)
    return flux * reach / material["conductivity"] * shape


def pressed_disc_stress(
    pressure: float, radius: float, depth: float, poisson: float
) -> tuple[float, float]:
    """Axial and side stress on the axis below a pressed disc [Pa].

    `σ_zz = −p (1 − c³)`, `σ_rr = −p/2 [1 + 2ν − 2(1 + ν) c + c³]`, `c = z/√(R² + z²)`: Love
    (1929), Phil. Trans. R. Soc. A 228, 377–420, doi 10.1098/rsta.1929.0009."""
    c = depth / hypot(depth, radius)
    side = 1.0 + 2.0 * poisson - 2.0 * (1.0 + poisson) * c + c**3
    return -pressure * (1.0 - c**3), -0.5 * pressure * side


def reciprocal_effusivities(one: dict, other: dict) -> float:
    """1/e₁ + 1/e₂"""
    return 1.0 / effusivity(one) + 1.0 / effusivity(other)


def heat_through_contact(
    conductance: float, difference: float, time: float, one: dict, other: dict
) -> float:
    """Heat that has passed between two half spaces of unlike temperature [J/m²].

    `q = h ΔT e^(b²t) erfc(b√t)`, `b = h (1/e₁ + 1/e₂)`; its integral over time is
    `h ΔT/b² (e^(b²t) erfc(b√t) − 1 + 2b√(t/π))` (Carslaw & Jaeger 1959, § 2.7)."""
    rate = conductance * reciprocal_effusivities(one, other)
    reach = rate * sqrt(time)
    shape = erfcx(reach) - 1.0 + 2.0 * reach / sqrt(pi)
    return float(conductance * difference / rate**2 * shape)


def face_at_contact(
    conductance: float, hot: float, cold: float, time: float, hot_body: dict, cold_body: dict
) -> float:
    """Temperature of the hot half space's face [K], which it falls to as heat passes (ibid.)."""
    own, others = effusivity(hot_body), effusivity(cold_body)
    reach = conductance * reciprocal_effusivities(hot_body, cold_body) * sqrt(time)
    moved = (hot - cold) * (1.0 - float(erfcx(reach))) / (own + others)
    return hot - others * moved
