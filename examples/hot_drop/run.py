"""A drop of molten aluminium on a glowing plate: its section over time, as ParaView shows it."""

import shutil
import sys
import time
from pathlib import Path

import numpy as np
from scipy.ndimage import gaussian_filter
from scipy.spatial import cKDTree

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
import paraview  # noqa: E402
import shared  # noqa: E402
from impinge import Unit  # noqa: E402

NAME = "hot_drop"
STOP, STEP = 6e-4, 2e-5  # s
DIAMETER, SPEED = 0.5e-3, 2.0  # m, m/s
HOT, WARM = 1200.0, 1000.0  # K
SHOWN = [1e-4, 2e-4, 4e-4, 6e-4]  # s
REACH, HEIGHT, DEPTH = 0.6, 0.75, 0.3  # mm: what a panel shows
SCALE = {"cmap": "inferno", "vmin": 640.0, "vmax": 930.0}  # °C
DARK, PALE = "#111116", "#e8e6e3"


def simulate(fmu: Path, folder: Path) -> list[float]:
    """Runs the unit, which writes a file of each body for each step; the heat [J] of the drop."""
    shutil.rmtree(folder, ignore_errors=True)
    heat = []
    with Unit(fmu, parameters={"output.directory": str(folder)}) as unit:
        for step in range(1, round(STOP / STEP) + 1):
            unit.step_to(step * STEP)
            heat.append(unit["drop.heat"])
        taken = unit["plate.heat_in"]
    print(f"the drop gave {heat[-1] * 1e3:.3f} mJ, the plate took it to {taken / heat[-1] - 1:.0e}")
    return heat


class Drop:
    """The meridian section of a drop of rings, mirrored on its axis."""

    def __init__(self, path: Path):
        arrays = paraview.read(path)
        radius, z = 1e3 * arrays["position"][:, 0], 1e3 * arrays["position"][:, 2]  # mm
        self.places = np.concatenate([np.c_[radius, z], np.c_[-radius, z]])
        self.temperature = np.tile(arrays["temperature"], 2) - shared.ZERO_CELSIUS
        self.tree = cKDTree(self.places)
        apart = self.tree.query(self.places, k=7)[0][:, 1:].mean(axis=1)
        usual = np.median(apart)
        # Rings near the axis, which came from farther out, are wider than the others.
        self.reach = np.clip(apart, usual, 2.2 * usual)

    def section(self, x: np.ndarray, z: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """The share of fluid around points of a grid [mm] and its temperature [°C]."""
        distance, nearest = self.tree.query(np.c_[x.ravel(), z.ravel()], k=12)
        inside = (distance < 0.85 * self.reach[nearest]).any(axis=1).reshape(x.shape)
        smoothing = np.median(self.reach) / (x[0, 1] - x[0, 0])  # pixels
        # The fluid goes on below the wall, so that its edge there stays where it is.
        share = gaussian_filter(inside.astype(float), smoothing, mode="nearest")
        weight = np.maximum(1 - (distance / (2.5 * self.reach[nearest])) ** 2, 1e-9) ** 3
        mean = (weight * self.temperature[nearest]).sum(axis=1) / weight.sum(axis=1)
        return share, mean.reshape(x.shape)


def plate_section(path: Path) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """x, z [mm] and temperature [°C] of the plate's meridian section on both sides of its axis."""
    arrays = paraview.read(path)
    radius, z = 1e3 * arrays["x"], 1e3 * arrays["z"]
    temperature = arrays["temperature"].reshape(len(z), len(radius)) - shared.ZERO_CELSIUS
    both = np.hstack([temperature[:, :0:-1], temperature])
    return np.r_[-radius[:0:-1], radius], z, both


def draw_moment(axes, moment: float, drop: Path, plate: Path):
    x, z, temperature = plate_section(plate)
    axes.pcolormesh(x, z, temperature, shading="gouraud", rasterized=True, **SCALE)
    x, z = np.meshgrid(np.linspace(-REACH, REACH, 720), np.linspace(0, HEIGHT, 450))
    share, temperature = Drop(drop).section(x, z)
    fluid = np.ma.masked_where(share < 0.5, temperature)
    extent = (-REACH, REACH, 0, HEIGHT)
    image = axes.imshow(fluid, extent=extent, origin="lower", interpolation="bilinear", **SCALE)
    axes.contour(x, z, share, levels=[0.5], colors=PALE, linewidths=0.6)
    axes.set(xlim=(-REACH, REACH), ylim=(-DEPTH, HEIGHT), aspect="equal", facecolor=DARK)
    axes.set(xlabel="x / mm")
    axes.set_title(f"{moment * 1e3:.1f} ms", color=PALE)
    axes.tick_params(colors=PALE)
    axes.xaxis.label.set_color(PALE)
    return image


def draw(folder: Path, out: Path) -> Path:
    figure, axes = shared.new_figure(1, len(SHOWN), height=3.7, sharey=True)
    figure.set_facecolor(DARK)
    series = [paraview.files(folder, body) for body in ("drop", "plate")]
    for panel, moment in zip(axes, SHOWN, strict=True):
        drop, plate = (min(of.items(), key=lambda at: abs(at[0] - moment))[1] for of in series)
        image = draw_moment(panel, moment, drop, plate)
    axes[0].set_ylabel("z / mm", color=PALE)
    bar = figure.colorbar(image, ax=axes, aspect=18, pad=0.015)
    bar.set_label("temperature / °C", color=PALE)
    bar.ax.tick_params(colors=PALE)
    hot, warm = (value - shared.ZERO_CELSIUS for value in (HOT, WARM))
    figure.suptitle(
        f"Molten aluminium of {hot:.0f} °C ({DIAMETER * 1e3:.1f} mm, {SPEED:.0f} m/s) lands on "
        f"aluminium nitride of {warm:.0f} °C, warms it and comes off",
        color=PALE,
    )
    return shared.save(figure, out, NAME, smooth=True)


def main(given: list[str] | None = None):
    options = shared.arguments(NAME, __doc__, given)
    started = time.perf_counter()
    fields = options.out / "fields"
    heat = simulate(options.fmu, fields)
    print(f"{len(heat)} steps in {time.perf_counter() - started:.1f} s")
    draw(fields, options.out)
    return heat


if __name__ == "__main__":
    main()
