"""A hot droplet's heat and blow on an alumina plate, against closed forms."""

import sys
import time
from dataclasses import dataclass
from math import erfc, exp, pi, sqrt
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
import shared  # noqa: E402
from impinge import Unit  # noqa: E402

NAME = "alumina_plate"
STOP, STEPS = 3.5e-6, 60  # s; step n ends at STOP (n / STEPS)³: fine while the flux is steep

# Alumina, as in scene.toml, and the footprint
DENSITY, SPECIFIC_HEAT, CONDUCTIVITY = 3950.0, 900.0, 10.0
YOUNG, POISSON, EXPANSION = 300e9, 0.21, 8.1e-6
DIFFUSIVITY = CONDUCTIVITY / (DENSITY * SPECIFIC_HEAT)
COLD, RADIUS = 20.0, 30e-6  # °C, m
SIZE = 100  # µm: the field of the scene
DEPTHS = [0, 1, 2, 3, 5, 8, 12, 20]  # µm, the probes of the scene

# Water at 100 °C that arrives at 50 m/s
WATER_DENSITY, WATER_SPEED_OF_SOUND, SPEED, HOT = 1000.0, 1480.0, 50.0, 100.0
EFFUSIVITY = sqrt(CONDUCTIVITY * DENSITY * SPECIFIC_HEAT)
WATER_EFFUSIVITY = sqrt(0.6 * WATER_DENSITY * 4000.0)
HAMMER = WATER_DENSITY * WATER_SPEED_OF_SOUND * SPEED  # Pa, the first blow
STAGNATION = 0.5 * WATER_DENSITY * SPEED**2  # Pa, what remains of it
RELEASE = RADIUS / WATER_SPEED_OF_SOUND  # s, a sound wave crosses the footprint

JUMP = (HOT - COLD) * WATER_EFFUSIVITY / (EFFUSIVITY + WATER_EFFUSIVITY)  # K, of the surface
# Flux between the two half spaces is FLUX_SCALE / √t.
FLUX_SCALE = JUMP * EFFUSIVITY / sqrt(pi)  # W √s / m²


def mean_flux(start: float, end: float) -> float:
    """Mean over a step of the contact flux: the plate gets all of its heat."""
    return 2 * FLUX_SCALE * (sqrt(end) - sqrt(start)) / (end - start)


def pressure(t: float) -> float:
    """An illustrative load: a water hammer that decays to the stagnation pressure."""
    return STAGNATION + (HAMMER - STAGNATION) * exp(-t / RELEASE)


def exact_temperature(depth: float, t: float) -> float:
    """Two half spaces brought together [°C]; depth in m."""
    return COLD + JUMP * erfc(depth / sqrt(4 * DIFFUSIVITY * t))


def thermal_stress(depth: float, t: float) -> float:
    """σ_xx of the heat on the axis of a half space [Pa]: a hot layer and its rim.

    Held sideways by the cold around it, the layer has −E α ΔT/(1 − ν). At its rim it pushes the
    body outward with E α/(1 − ν) ∫ ΔT dz a length, a radial line load of the surface. The sum is
    right to first order in the depth of the layer over the radius of the footprint.
    """
    modulus = YOUNG * EXPANSION / (1 - POISSON)
    held = -modulus * (exact_temperature(depth, t) - COLD)
    push = modulus * JUMP * sqrt(4 * DIFFUSIVITY * t / pi)
    square = RADIUS**2 + depth**2
    return held + push * RADIUS**2 / square**1.5 * (1 + POISSON - 1.5 * depth**2 / square)


def pressure_stress(depth: float, t: float) -> float:
    """σ_xx of the pressure on the axis of a half space [Pa] (Love 1929)."""
    cosine = depth / sqrt(RADIUS**2 + depth**2)
    return -pressure(t) / 2 * (1 + 2 * POISSON - 2 * (1 + POISSON) * cosine + cosine**3)


def exact_stress(depth: float, t: float) -> float:
    return thermal_stress(depth, t) + pressure_stress(depth, t)


@dataclass
class Result:
    times: np.ndarray  # s, ends of steps
    temperatures: np.ndarray  # °C, a row a time, a column a depth
    stresses: np.ndarray  # Pa, σ_xx likewise
    normal_stress: np.ndarray  # Pa, σ_zz of the surface
    surface_temperature: np.ndarray  # °C, at the end
    surface_von_mises: np.ndarray  # Pa, at the end
    heat_balance: float  # relative


def simulate(fmu: Path) -> Result:
    times = STOP * (np.arange(1, STEPS + 1) / STEPS) ** 3
    probes = ["centre"] + [f"depth_{depth}" for depth in DEPTHS[1:]]
    temperatures, stresses, normal = [], [], []
    with Unit(fmu) as unit:
        for t in times:
            # Heat is what counts over the step, traction what counts at its end.
            unit.set({"spot.heat_flux": mean_flux(unit.time, t), "spot.pressure": pressure(t)})
            unit.step_to(t)
            temperatures.append(unit.get([f"{p}.temperature" for p in probes]))
            stresses.append(unit.get([f"{p}.stress_xx" for p in probes]))
            normal.append(unit["centre.stress_zz"])
        brought, stored, lost = unit.get(["plate.heat_in", "plate.heat_stored", "plate.heat_lost"])
        return Result(
            times,
            np.array(temperatures) - shared.ZERO_CELSIUS,
            np.array(stresses),
            np.array(normal),
            unit["surface.temperature"] - shared.ZERO_CELSIUS,
            unit["surface.von_mises"],
            abs(brought - stored - lost) / brought,
        )


def report(result: Result):
    rows = []
    for step in [1, 2, 3, 5, 10, 15, 20, 30, 40, STEPS]:
        t, temperature = result.times[step - 1], result.temperatures[step - 1, 0]
        exact, stress = exact_temperature(0.0, t), result.stresses[step - 1, 0]
        values = [temperature, exact, temperature - exact, stress / 1e6, exact_stress(0.0, t) / 1e6]
        rows.append([str(step), f"{t * 1e9:.3g}"] + [f"{v:.3f}" for v in values])
    print("Centre of the surface")
    shared.print_table(["step", "t/ns", "T/°C", "closed", "error/K", "σ_xx/MPa", "closed"], rows)
    print(f"σ_zz at the end {result.normal_stress[-1] / 1e6:.3f} MPa,", end=" ")
    print(f"pressure {pressure(STOP) / 1e6:.3f} MPa; heat balance to {result.heat_balance:.0e}")


def draw(result: Result, folder: Path) -> Path:
    figure, axes = shared.new_figure(2, 3)
    draw_fields(axes[:, 0], result)
    draw_histories(axes[:, 1], result)
    draw_profiles(axes[:, 2], result)
    figure.suptitle(
        f"Water of {HOT:.0f} °C hits alumina of {COLD:.0f} °C at {SPEED:.0f} m/s: "
        f"{STEPS} steps of the unit (dots) on closed forms (dashed)"
    )
    return shared.save(figure, folder, NAME)


def draw_fields(axes, result: Result):
    temperature, stress = result.surface_temperature, result.surface_von_mises / 1e6
    image = shared.show_field(axes[0], temperature, (SIZE, SIZE), cmap="inferno")
    shared.add_colour_bar(image, "°C")
    image = shared.show_field(axes[1], stress, (SIZE, SIZE), cmap="viridis")
    shared.add_colour_bar(image, "MPa")
    axes[0].set_title(f"Temperature after {STOP * 1e6:.1f} µs")
    axes[1].set_title(f"Von Mises stress after {STOP * 1e6:.1f} µs")
    for plot in axes:
        ticks = [-40, -20, 0, 20, 40]
        plot.set(xlabel="x / µm", ylabel="y / µm", xticks=ticks, yticks=ticks)


def draw_histories(axes, result: Result):
    shown = result.times > 1e-9
    times = result.times[shown] * 1e6
    fine = np.geomspace(times[0], times[-1], 300)
    plot = axes[0]
    for depth in [0, 1, 2, 5]:
        values = result.temperatures[shown, DEPTHS.index(depth)]
        colour = plot.plot(times, values, "o", markersize=4)[0].get_color()
        exact = [exact_temperature(depth * 1e-6, t * 1e-6) for t in fine]
        plot.plot(fine, exact, **shared.CLOSED_FORM)
        name = "surface" if depth == 0 else f"{depth} µm deep"
        plot.text(times[-1] * 1.3, values[-1], name, color=colour, va="center")
    plot.set(ylabel="temperature / °C")
    plot.set_title(f"The surface jumps to {COLD + JUMP:.1f} °C and stays")

    plot = axes[1]
    for part, name, place, lift in [
        (thermal_stress, "heat alone", 0.01, 3),
        (pressure_stress, "pressure alone", 0.15, -7),
    ]:
        values = [part(0.0, t * 1e-6) / 1e6 for t in fine]
        plot.plot(fine, values, color="0.65", linewidth=1.2)
        plot.text(place, part(0.0, place * 1e-6) / 1e6 + lift, name, color="0.45")
    plot.plot(times, result.stresses[shown, 0] / 1e6, "o", markersize=4, label="unit")
    exact = [exact_stress(0.0, t * 1e-6) / 1e6 for t in fine]
    plot.plot(fine, exact, **shared.CLOSED_FORM, label="closed form")
    plot.set(
        xscale="log",
        xlim=(1e-3, 60),
        xlabel="time / µs",
        ylabel=r"$\sigma_{xx}$ at the centre / MPa",
    )
    plot.set_title("First the blow, then the heat")
    plot.legend(loc="lower right")
    for plot in axes:
        plot.set(xscale="log", xlim=(1e-3, 60), xlabel="time / µs")
        plot.set_xticks([1e-3, 1e-2, 0.1, 1, 10], ["0.001", "0.01", "0.1", "1", "10"])


def draw_profiles(axes, result: Result):
    fine = np.linspace(0, DEPTHS[-1], 200)
    chosen = [int(np.argmin(abs(result.times - t))) for t in (0.03e-6, 0.3e-6, 3.5e-6)]
    temperature = (result.temperatures, exact_temperature, 1.0)
    stress = (result.stresses, exact_stress, 1e-6)
    for plot, (values, exact, scale) in zip(axes, (temperature, stress), strict=True):
        for step in chosen:
            t = result.times[step]
            plot.plot(DEPTHS, values[step] * scale, "o", label=f"{t * 1e6:.2g} µs")
            plot.plot(fine, [exact(z * 1e-6, t) * scale for z in fine], **shared.CLOSED_FORM)
        plot.set(xlabel="depth / µm")
    axes[0].set(ylabel="temperature / °C")
    axes[0].set_title("Heat goes 6 µm deep")
    axes[0].legend()
    axes[1].axhline(0, color="0.8", linewidth=0.8, zorder=0)
    axes[1].set(ylabel=r"$\sigma_{xx}$ on the axis / MPa")
    axes[1].set_title("Tension below the hot layer")


def main(given: list[str] | None = None) -> Result:
    options = shared.arguments(NAME, __doc__, given)
    started = time.perf_counter()
    result = simulate(options.fmu)
    print(f"{STEPS} steps in {time.perf_counter() - started:.1f} s")
    report(result)
    draw(result, options.out)
    return result


if __name__ == "__main__":
    main()
