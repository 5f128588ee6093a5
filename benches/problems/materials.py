"""Constants of solids and liquids, by the names that scenes give them."""

from math import sqrt


def thermal(density: float, specific_heat: float, conductivity: float) -> dict:
    return {"density": density, "specific_heat": specific_heat, "conductivity": conductivity}


def thermoelastic(*constants: dict) -> dict:
    material = {"model": "thermoelastic"}
    for some in constants:
        material |= some
    return material


ALUMINA = thermal(3950.0, 900.0, 10.0)
ELASTIC_ALUMINA = {"young": 300e9, "poisson": 0.21, "expansion": 8.1e-6}
STEEL = thermal(7900.0, 500.0, 15.0)
COPPER = thermal(8960.0, 385.0, 400.0)


def diffusivity(material: dict) -> float:
    """a = k/(ρc) [m²/s]"""
    return material["conductivity"] / (material["density"] * material["specific_heat"])


def effusivity(material: dict) -> float:
    """√(kρc) [W √s/(m² K)]"""
    return sqrt(material["density"] * material["specific_heat"] * material["conductivity"])


def liquid(
    density: float,
    viscosity: float,
    specific_heat: float = 4180.0,
    conductivity: float = 0.6,
    surface_tension: float = 0.072,
) -> dict:
    """Water's constants unless others are given."""
    return {
        "density": density,
        "viscosity": viscosity,
        "specific_heat": specific_heat,
        "conductivity": conductivity,
        "surface_tension": surface_tension,
    }


INK = liquid(1000.0, 4e-3, surface_tension=0.05)
