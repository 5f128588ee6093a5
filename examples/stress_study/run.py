"""What governs the peak stress of a ceramic under a hot spot: Sobol's indices, a response chart."""

import argparse
import sys
import time
from math import pi, sqrt
from pathlib import Path

import numpy as np
import xarray as xr

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
import shared  # noqa: E402
from impinge import Study  # noqa: E402
from impinge.study import Grid, Sobol, sobol_indices  # noqa: E402

NAME = "stress_study"
SCENE = Path(__file__).parent / "scene.toml"
STOP = 2e-3  # s under the spot
DENSITY = 3950.0  # kg/m³, as in scene.toml

# What may be known of a ceramic and of the process, and how it is called in the picture
THICKNESS = "body.plate.shape.disc.thickness"  # a key of the scene; the others are variables
RANGES = {
    "spot.heat_flux": ((2e7, 4e7), "heat flux 20–40 MW/m²"),
    "spot.radius": ((100e-6, 300e-6), "radius of the spot 100–300 µm"),
    "plate.conductivity": ((5.0, 30.0), "conductivity 5–30 W/(m K)"),
    "plate.specific_heat": ((750.0, 1050.0), "specific heat 750–1050 J/(kg K)"),
    "plate.expansion": ((6e-6, 9e-6), "expansion 6–9 ppm/K"),
    "plate.young": ((280e9, 400e9), "Young's modulus 280–400 GPa"),
    "plate.poisson": ((0.20, 0.28), "Poisson's ratio 0.20–0.28"),
    THICKNESS: ((0.4e-3, 1.2e-3), "thickness 0.4–1.2 mm"),
}
STRESS, TEMPERATURE = "plate.max_von_mises", "centre.temperature"


def exact_rise(flux, radius, conductivity, specific_heat, t=STOP):
    """Temperature rise [K] in the middle of a Gaussian spot on a half space,

        ΔT = q W / (k √(2π)) · arctan(√(8 a t) / W),  a = k / (ρ c)

    with the flux q [W/m²] in the middle and the radius W [m] of 1/e² (after M. Lax 1977,
    doi 10.1063/1.324265, integrated over time)."""
    diffusivity = conductivity / (DENSITY * specific_heat)
    return (
        flux
        * radius
        / (conductivity * sqrt(2 * pi))
        * np.arctan(np.sqrt(8 * diffusivity * t) / radius)
    )


def held_stress(rise, expansion, young, poisson):
    """Stress [Pa] of a surface that is hot in a thin layer and held by the cold below it."""
    return young * expansion * rise / (1.0 - poisson)


def exact(table: xr.Dataset) -> tuple[np.ndarray, np.ndarray]:
    """Rise and held stress of the half space, for all rows."""
    p = {name: table[name].values for name in RANGES if name in table.coords}
    rise = exact_rise(
        p["spot.heat_flux"], p["spot.radius"], p["plate.conductivity"], p["plate.specific_heat"]
    )
    return rise, held_stress(rise, p["plate.expansion"], p["plate.young"], p["plate.poisson"])


def run_sobol(source: Path, samples: int, folder: Path) -> xr.Dataset:
    ranges = {name: limits for name, (limits, _) in RANGES.items()}
    if source.suffix != ".toml":
        del ranges[THICKNESS]  # a packed unit has its thickness
    study = Study(source, ranges, outputs=[STRESS, TEMPERATURE], sampler=Sobol(samples, seed=1))
    began = time.perf_counter()
    table = study.run(folder=folder)
    seconds = time.perf_counter() - began
    print(f"{len(study.rows)} runs in {seconds:.1f} s, {int(table.attrs['failed'])} failed")
    return table


def run_chart(source: Path, levels: int) -> xr.Dataset:
    """Peak stress over radius and conductivity, all else as in the scene but 30 MW/m²."""
    chart = {name: RANGES[name][0] for name in ("plate.conductivity", "spot.radius")}
    study = Study(
        source,
        {**chart, "spot.heat_flux": 3e7},
        outputs=[STRESS, TEMPERATURE],
        sampler=Grid(levels),
    )
    return study.run()


def report(table: xr.Dataset, indices: xr.Dataset, by_form: xr.Dataset) -> None:
    rows = []
    order = np.argsort(-indices["total"].values[0])
    for name in indices.parameter.values[order]:
        here = indices.sel(parameter=name).isel(output=0)
        form = by_form.sel(parameter=name).isel(output=0)
        first = f"{here['first'].item():.2f} ± {here['first_confidence'].item():.2f}"
        total = f"{here['total'].item():.2f} ± {here['total_confidence'].item():.2f}"
        rows.append([str(name), first, total, f"{form['total'].item():.2f}"])
    shared.print_table(["peak stress follows", "first", "total", "total, held layer"], rows)
    rise, stress = exact(table)
    seen = table[TEMPERATURE].values - 293.15
    peak = table[STRESS].values / 1e6
    print(f"peak stress {peak.min():.0f} to {peak.max():.0f} MPa", end="")
    print(f"; rise beside a half space {np.ptp(seen / rise):.1%} apart,", end="")
    print(f" {np.median(seen / rise) - 1:+.1%} in the median")
    share = table[STRESS].values / stress
    print(f"of the stress of a held layer {share.min():.2f} to {share.max():.2f}")


def closed_form_indices(table: xr.Dataset) -> xr.Dataset:
    """Indices of the held stress, on the same rows."""
    _, stress = exact(table)
    return sobol_indices(table.assign({STRESS: ("row", stress)}), [STRESS])


def draw(
    table: xr.Dataset, indices: xr.Dataset, by_form: xr.Dataset, chart: xr.Dataset, folder: Path
) -> Path:
    figure, axes = shared.new_figure(1, 3, height=6.0, width_ratios=[1.25, 1, 1])
    draw_indices(axes[0], indices, by_form)
    draw_chart(axes[1], chart)
    draw_collapse(axes[2], table)
    figure.suptitle(
        f"Peak stress of a ceramic after {STOP * 1e3:.0f} ms under a hot spot: "
        "conductivity governs more than half of it, thickness nothing"
    )
    return shared.save(figure, folder, NAME)


def draw_indices(plot, indices: xr.Dataset, by_form: xr.Dataset) -> None:
    here = indices.isel(output=0)
    order = np.argsort(here["total"].values)
    names = [RANGES[str(name)][1] for name in here.parameter.values[order]]
    places = np.arange(len(order))
    for kind, shift, colour in (("total", 0.2, 0), ("first", -0.2, 2)):
        plot.barh(
            places + shift,
            here[kind].values[order],
            0.38,
            xerr=here[f"{kind}_confidence"].values[order],
            color=shared.COLOURS[colour],
            error_kw={"linewidth": 1, "ecolor": "0.4"},
            label=f"{kind} index",
        )
    form = by_form.isel(output=0)["total"].values[order]
    plot.plot(form, places + 0.2, "kd", markersize=5, label="total, thin held layer")
    plot.set_yticks(places, names)
    plot.set(xlabel="share of the variance", xlim=(0, None))
    plot.set_title("What governs it")
    plot.legend(loc="lower right")


def draw_chart(plot, chart: xr.Dataset) -> None:
    radius = chart["spot.radius"].values * 1e6
    conductivity = chart["plate.conductivity"].values
    peak = chart[STRESS].transpose("plate.conductivity", "spot.radius").values / 1e6
    filled = plot.contourf(radius, conductivity, peak, levels=12, cmap="inferno")
    lines = plot.contour(radius, conductivity, peak, levels=filled.levels[::2], colors="white")
    plot.clabel(lines, fmt="%.0f", fontsize=9)
    plot.figure.colorbar(filled, ax=plot, label="peak stress / MPa", location="bottom")
    plot.set(xlabel="radius of the spot / µm", ylabel="conductivity / W/(m K)")
    plot.set_title("Response at 30 MW/m²")


def draw_collapse(plot, table: xr.Dataset) -> None:
    _, stress = exact(table)
    diffusivity = table["plate.conductivity"] / (DENSITY * table["plate.specific_heat"])
    depth = np.sqrt(4 * diffusivity.values * STOP) / table["spot.radius"].values
    points = plot.scatter(
        depth, table[STRESS].values / stress, c=table["plate.poisson"].values, s=9, cmap="viridis"
    )
    plot.figure.colorbar(points, ax=plot, label="Poisson's ratio", location="bottom")
    plot.set(xlabel="depth of heat √(4at) / radius", ylabel="σ (1 − ν) / (E α ΔT)")
    plot.set(ylim=(0, None), xlim=(0, None))
    plot.set_title("All runs near one line")


def main(given: list[str] | None = None) -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--fmu", type=Path, help="a unit of the scene, without its thickness")
    parser.add_argument("--samples", type=int, default=128, help="a power of two [default: 128]")
    parser.add_argument("--levels", type=int, default=9, help="of the chart [default: 9]")
    parser.add_argument("--out", type=Path, default=shared.ROOT / "out" / NAME, help="folder")
    options = parser.parse_args(given)
    options.out.mkdir(parents=True, exist_ok=True)
    source = options.fmu or SCENE
    began = time.perf_counter()
    table = run_sobol(source, options.samples, options.out)
    indices, by_form = sobol_indices(table, [STRESS]), closed_form_indices(table)
    chart = run_chart(source, options.levels)
    report(table, indices, by_form)
    draw(table, indices, by_form, chart, options.out)
    print(f"{time.perf_counter() - began:.1f} s in all")


if __name__ == "__main__":
    main()
