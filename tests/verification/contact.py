"""Draws what the studies in contact.rs kept: python contact.py TABLES PICTURE."""

import sys
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

sys.path.append(str(Path(__file__).resolve().parents[2] / "benches"))
from pictures import save  # noqa: E402

KINDS = {
    0: ("layers taken to be even", "0.5", "x", "--"),
    1: ("with the thin layer", "C0", "o", "-"),
    2: ("H = 4Δx", "C2", "^", "-"),
    3: ("sheared", "C3", "s", "-"),
}
COLD, CONTACT = 20.0, 36.499  # °C
STRENGTH = 5.550e4  # Flux of two half spaces times the root of time [W √s/m²].


def errors(axes, table, quantity, name):
    """Errors over spacings, from coarse to fine."""
    for kind, (label, colour, mark, line) in KINDS.items():
        run = table[table["kind"] == kind]
        error = 100 * np.abs(run[quantity])
        axes.loglog(run["fineness"], error, line, color=colour, marker=mark, label=label)
    axes.set(
        xlabel="thickness of the thermal layer √(πκt) over Δx",
        ylabel="error [%]",
        title=name,
        ylim=(1e-3, 200),
    )
    ticks = np.unique(table["fineness"])
    axes.set_xticks(ticks, [f"{tick:g}" for tick in ticks])
    axes.minorticks_off()


def over_time(axes, table, quantity, exact, name):
    """What the plate gets, for some spacings."""
    time = np.linspace(0.02, 3.5, 300)
    axes.plot(time, exact(1e-6 * time), color="0.2", lw=1, label="two half spaces")
    for fineness, colour in [(0.5, "C3"), (1, "C1"), (4, "C0")]:
        for thin, line in [(1, "-"), (0, "--")]:
            run = table[(table["fineness"] == fineness) & (table["thin"] == thin)]
            values = run[quantity] - 273.15 if quantity == "temperature" else 1e-6 * run[quantity]
            label = f"Δx = layer/{fineness:g}" + ("" if thin else ", layers taken to be even")
            # Temperatures are those after an exchange, fluxes means over it.
            back = 0 if quantity == "temperature" else 0.5 * run["time"][0]
            axes.plot(1e6 * (run["time"] - back), values, line, color=colour, label=label)
    axes.set(xlabel="time [µs]", title=name)


def main(tables: Path, picture: Path):
    def read(name):
        return np.genfromtxt(tables / f"{name}.csv", delimiter=",", names=True)

    figure, axes = plt.subplots(2, 2, figsize=(12, 9), layout="constrained")
    wall, plate = read("contact_wall"), read("contact_plate")
    errors(axes[0, 0], wall, "heat", "Heat given to a held wall after 3.5 µs")
    errors(axes[0, 1], wall, "flux", "Flux into it from 3.15 to 3.5 µs")
    surface = "Surface of an alumina plate under water, 70 exchanges"
    over_time(axes[1, 0], plate, "temperature", lambda t: CONTACT + 0 * t, surface)
    axes[1, 0].set(ylabel="temperature [°C]", ylim=(COLD, 46))
    over_time(axes[1, 1], plate, "flux", lambda t: 1e-6 * STRENGTH / np.sqrt(t), "Flux into it")
    axes[1, 1].set(ylabel="flux [MW/m²]", ylim=(0, 250))
    for panel in axes.flat:
        panel.grid(alpha=0.3)
        panel.legend(fontsize=8)
    picture.parent.mkdir(parents=True, exist_ok=True)
    save(figure, picture)
    print(picture)


if __name__ == "__main__":
    main(Path(sys.argv[1]), Path(sys.argv[2]))
