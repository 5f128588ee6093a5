"""Meridian sections of a round drop on a disc, from the ParaView files of a run."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np
import paraview
import shared
from scipy.ndimage import gaussian_filter
from scipy.spatial import cKDTree

DARK, PALE = "#111116", "#e8e6e3"


@dataclass
class View:
    """The section of a panel [mm] and the colours of its temperatures [°C]."""

    reach: float
    height: float
    depth: float
    colours: dict


class Drop:
    """The meridian section of a drop of rings, mirrored on its axis."""

    def __init__(self, path: Path):
        arrays = paraview.read(path)
        radius, z = 1e3 * arrays["position"][:, 0], 1e3 * arrays["position"][:, 2]  # mm
        self.places = np.concatenate([np.c_[radius, z], np.c_[-radius, z]])
        self.temperature = np.tile(arrays["temperature"], 2) - shared.ZERO_CELSIUS
        frozen = arrays.get("solid_fraction", np.zeros(len(radius)))
        self.solid_fraction = np.tile(frozen, 2)
        self.tree = cKDTree(self.places)
        apart = self.tree.query(self.places, k=7)[0][:, 1:].mean(axis=1)
        usual = np.median(apart)
        # Rings near the axis, which came from farther out, are wider than the others.
        self.reach = np.clip(apart, usual, 2.2 * usual)

    def section(self, x: np.ndarray, z: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """The share of fluid around points of a grid [mm], its temperature [°C] and frozen part."""
        distance, nearest = self.tree.query(np.c_[x.ravel(), z.ravel()], k=12)
        inside = (distance < 0.85 * self.reach[nearest]).any(axis=1).reshape(x.shape)
        smoothing = np.median(self.reach) / (x[0, 1] - x[0, 0])  # pixels
        # The fluid goes on below the wall, so that its edge there stays where it is.
        share = gaussian_filter(inside.astype(float), smoothing, mode="nearest")
        weight = np.maximum(1 - (distance / (2.5 * self.reach[nearest])) ** 2, 1e-9) ** 3

        def mean(values: np.ndarray) -> np.ndarray:
            return ((weight * values[nearest]).sum(axis=1) / weight.sum(axis=1)).reshape(x.shape)

        return share, mean(self.temperature), mean(self.solid_fraction)


def plate_section(path: Path) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """x, z [mm] and temperature [°C] of the plate's meridian section on both sides of its axis."""
    arrays = paraview.read(path)
    radius, z = 1e3 * arrays["x"], 1e3 * arrays["z"]
    temperature = arrays["temperature"].reshape(len(z), len(radius)) - shared.ZERO_CELSIUS
    both = np.hstack([temperature[:, :0:-1], temperature])
    return np.r_[-radius[:0:-1], radius], z, both


def draw(axes, view: View, drop: Path, plate: Path):
    """Draws drop and plate; a pale line bounds the fluid, a dark one what of it is frozen."""
    x, z, temperature = plate_section(plate)
    axes.pcolormesh(x, z, temperature, shading="gouraud", rasterized=True, **view.colours)
    across, up = np.linspace(-view.reach, view.reach, 720), np.linspace(0, view.height, 450)
    x, z = np.meshgrid(across, up)
    share, temperature, frozen = Drop(drop).section(x, z)
    fluid = np.ma.masked_where(share < 0.5, temperature)
    extent = (-view.reach, view.reach, 0, view.height)
    image = axes.imshow(
        fluid, extent=extent, origin="lower", interpolation="bilinear", **view.colours
    )
    axes.contour(x, z, share, levels=[0.5], colors=PALE, linewidths=0.6)
    if frozen.max() > 0.5:
        solid = np.where(share < 0.5, 0.0, frozen)
        axes.contourf(
            x, z, solid, levels=[0.5, 1.1], colors="none", hatches=["////"]
        ).set_edgecolor(PALE)
    axes.set(xlim=(-view.reach, view.reach), ylim=(-view.depth, view.height), aspect="equal")
    axes.set(facecolor=DARK)
    axes.tick_params(colors=PALE)
    return image


def series(folder: Path, bodies: list[str], moments: list[float]) -> list[list[Path]]:
    """The files of the bodies nearest to some moments [s]."""
    files = [paraview.files(folder, body) for body in bodies]
    return [[min(of.items(), key=lambda at: abs(at[0] - m))[1] for of in files] for m in moments]


def add_bar(figure, axes, image, label: str):
    """A colour bar on a dark page."""
    figure.set_facecolor(DARK)
    bar = figure.colorbar(image, ax=axes, aspect=18, pad=0.015)
    bar.set_label(label, color=PALE)
    bar.ax.tick_params(colors=PALE)
