"""A slab under a uniform flux, of which closed forms tell everything."""

SCENE = """
name = "Slab"
stop_time = 1.0
step = 0.1

[body.plate]
kind = "solid"
shape = { box = [4e-3, 4e-3, 1e-3] }
material = { model = "thermoelastic", density = 4000.0, specific_heat = 900.0, conductivity = 10.0 }
initial_temperature = 300.0
mesh = { spacing = 1e-3, depth_spacing = 0.05e-3, growth = 1.0 }

[body.plate.faces]
top = { flux = 0.0 }

[[probe]]
name = "top"
in = "plate"
at = [0.0, 0.0, 0.0]
gives = ["temperature"]
"""
AREA = 16e-6  # m2
HEAT_CAPACITY = 4000.0 * 900.0  # J/(m3 K)


def top_temperature(flux, time, thickness=1e-3, conductivity=10.0):
    """Temperature [K] of the heated face once the start has died out, insulated below:
    T = T₀ + q t / (ρ c L) + q L / (3 k)  (Carslaw & Jaeger 1959, §3.8)."""
    return 300.0 + flux * time / (HEAT_CAPACITY * thickness) + flux * thickness / 3 / conductivity
