"""Draws drop and plate over time from the ParaView files of a run of the scene."""

import argparse
import sys
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
import paraview  # noqa: E402
import shared  # noqa: E402
from matplotlib.colors import LogNorm  # noqa: E402

DIAMETER, TIME = 100.0, 2.0  # µm, µs: the drop and the time in which it flies that far
SHARES = np.arange(0.25, 1.76, 0.25)  # of TIME
REACH, DEPTH = 250.0, 22.0  # µm
HOT = 373.15  # K, of the drop as it comes
MIDDLE = 40.0  # µm, radius of what counts as the middle of the surface
COLOURS = shared.plt.cm.viridis(np.linspace(0, 0.92, len(SHARES)))


def at_time(folder: Path, body: str, share: float) -> dict[str, np.ndarray]:
    """What a body was at a share of the time."""
    series = paraview.files(folder, body).items()
    found = [path for time, path in series if abs(time * 1e6 / TIME - share) < 1e-6]
    if len(found) != 1:
        sys.exit(f"{folder}/{body}.pvd: no time {share * TIME} µs; run the scene with --step 5e-7")
    return paraview.read(found[0])


class Plate:
    """Temperature [°C] and von Mises stress [MPa] along x at the top, and down the axis."""

    def __init__(self, arrays: dict[str, np.ndarray]):
        self.x, y, z = (1e6 * arrays[axis] for axis in "xyz")
        self.depth = z.max() - z
        middle, centre, top = np.abs(y).argmin(), np.abs(self.x).argmin(), z.argmax()
        shape = (len(z), len(y), len(self.x))
        temperature = arrays["temperature"].reshape(shape) - shared.ZERO_CELSIUS
        stress = 1e-6 * arrays["von_mises"].reshape(shape)
        self.temperature, self.stress = temperature[top, middle], stress[top, middle]
        weights = np.outer(np.gradient(y), np.gradient(self.x))
        weights[np.hypot(*np.meshgrid(self.x, y)) > MIDDLE] = 0.0
        self.mean_temperature = np.average(temperature[top], weights=weights)
        self.deep_temperature = temperature[:, middle, centre]
        self.deep_stress = stress[:, middle, centre]

    def patch(self) -> float:
        """Diameter over D within which the surface is warmer than half way to its warmest [-]."""
        rise = self.temperature - 20.0
        return 2 * np.abs(self.x[rise > 0.5 * rise.max()]).max() / DIAMETER


def draw_drop(drops: list[dict], folder: Path):
    """The section through the axis: on the left what the wall has cooled, on the right the flow.

    Both halves of the drop are alike. Nearly all of it is as hot as it came, so that cooling is
    drawn over powers of ten."""
    figure, axes = shared.new_figure(4, 2, height=8.4)
    for panel, share, drop in zip(axes.flat, SHARES, drops, strict=False):
        x, y, z = 1e6 * drop["position"].T
        near = np.abs(y) < 2.6  # a particle on each side of the section
        left, right = near & (x < 0), near & (x >= 0)
        cooled = np.clip(HOT - drop["temperature"], 1e-3, None)
        speed = np.linalg.norm(drop["velocity"], axis=1)
        norm = LogNorm(0.1, 50.0)
        cold = panel.scatter(x[left], z[left], c=cooled[left], s=6, cmap="YlGnBu", norm=norm, lw=0)
        fast = panel.scatter(
            x[right], z[right], c=speed[right], s=6, cmap="YlOrRd", vmin=0, vmax=80, lw=0
        )
        panel.axvline(0, color="0.5", linewidth=0.8)
        panel.set(aspect="equal", xlim=(-REACH, REACH), ylim=(0, 105), ylabel="z / µm")
        panel.set_facecolor("0.93")
        panel.set_title(f"t = {share:.2f} D/U")
    axes[3, 0].set_xlabel("x / µm")
    axes[2, 1].set_xlabel("x / µm")
    axes[3, 1].axis("off")
    bars = [axes[3, 1].inset_axes([0.05, place, 0.9, 0.13]) for place in (0.72, 0.12)]
    for bar, dots, label, extend in (
        (bars[0], cold, "left half: cooled by / K", "both"),
        (bars[1], fast, "right half: speed / (m/s)", "max"),
    ):
        figure.colorbar(dots, cax=bar, orientation="horizontal", extend=extend, label=label)
    figure.suptitle("The drop cools in a layer of one particle, and its rim outruns the impact")
    shared.save(figure, folder, "drop_over_time")


def draw_plate(plates: list[Plate], folder: Path):
    figure, axes = shared.new_figure(2, 2)
    for share, plate, colour in zip(SHARES, plates, COLOURS, strict=True):
        style = {"color": colour, "label": f"t = {share:.2f} D/U", "lw": 1.5}
        near, shallow = np.abs(plate.x) < REACH, plate.depth < DEPTH
        axes[0, 0].plot(plate.x[near], plate.temperature[near], **style)
        axes[1, 0].plot(plate.x[near], plate.stress[near], **style)
        axes[0, 1].plot(plate.depth[shallow], plate.deep_temperature[shallow], **style)
        axes[1, 1].plot(plate.depth[shallow], plate.deep_stress[shallow], **style)
    for plot in axes[0]:
        plot.set(ylabel="temperature / °C")
    for plot in axes[1]:
        plot.set(ylabel="von Mises stress / MPa", ylim=(0, None))
    for plot in axes[:, 0]:
        plot.set(xlabel="x / µm")
    for plot in axes[:, 1]:
        plot.set(xlabel="depth / µm")
    axes[0, 0].set_title("Surface of the plate")
    axes[0, 1].set_title("Under the middle of the drop")
    axes[0, 1].legend()
    shared.save(figure, folder, "plate_over_time")


def report(plates: list[Plate]):
    head = [
        "t U/D",
        "centre/°C",
        "middle/°C",
        "warmest/°C",
        "warm patch/D",
        "centre/MPa",
        "most/MPa",
        "10 µm/MPa",
    ]
    rows = []
    for share, plate in zip(SHARES, plates, strict=True):
        order = np.argsort(plate.depth)
        values = [
            plate.deep_temperature[order[0]],
            plate.mean_temperature,
            plate.temperature.max(),
            plate.patch(),
            plate.deep_stress[order[0]],
            plate.stress.max(),
            np.interp(10.0, plate.depth[order], plate.deep_stress[order]),
        ]
        rows.append([f"{share:.2f}"] + [f"{value:.2f}" for value in values])
    shared.print_table(head, rows)


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("folder", type=Path, help="what `impinge run --step 5e-7` wrote")
    parser.add_argument("out", type=Path, help="folder of the pictures")
    given = parser.parse_args()
    drops = [at_time(given.folder, "drop", share) for share in SHARES]
    plates = [Plate(at_time(given.folder, "plate", share)) for share in SHARES]
    given.out.mkdir(parents=True, exist_ok=True)
    report(plates)
    draw_drop(drops, given.out)
    draw_plate(plates, given.out)


if __name__ == "__main__":
    main()
