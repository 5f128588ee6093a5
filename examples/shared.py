"""What the examples share: options, tables and the look of the pictures."""

import argparse
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402
import numpy as np  # noqa: E402
from PIL import Image  # noqa: E402

ROOT = Path(__file__).resolve().parents[1]
ZERO_CELSIUS = 273.15  # K

# Colours that people with colour-blindness tell apart, dark to light
COLOURS = ["#20306b", "#b0303c", "#e08214", "#2a8a7f", "#7b7b7b"]
CLOSED_FORM = {"color": "black", "linestyle": (0, (4, 3)), "linewidth": 1.2, "zorder": 5}


def arguments(name: str, purpose: str, given: list[str] | None, **more: dict) -> argparse.Namespace:
    """The options of an example: the unit, the folder of the pictures, and `more` of its own."""
    parser = argparse.ArgumentParser(description=purpose)
    parser.add_argument(
        "--fmu", type=Path, default=ROOT / "out" / f"{name}.fmu", help="unit [default: %(default)s]"
    )
    parser.add_argument(
        "--out", type=Path, default=ROOT / "out" / name, help="folder [default: %(default)s]"
    )
    for option, settings in more.items():
        parser.add_argument(f"--{option}", **settings)
    options = parser.parse_args(given)
    if not options.fmu.is_file():
        parser.exit(
            2,
            f"{options.fmu}: no such file; build it from the root of the repository with\n"
            f"  build-fmu examples/{name}/scene.toml -o out/{name}.fmu\n",
        )
    options.out.mkdir(parents=True, exist_ok=True)
    return options


def print_table(head: list[str], rows: list[list[str]]):
    """Prints columns, numbers to the right."""
    widths = [max(len(row[i]) for row in [head, *rows]) for i in range(len(head))]
    for row in [head, *rows]:
        print("  ".join(text.rjust(width) for text, width in zip(row, widths, strict=True)))


def new_figure(rows: int, columns: int, height: float = 7.5, **options):
    """A figure in the format of a slide, in the style of all examples."""
    plt.rcParams.update(
        {
            "font.size": 11,
            "axes.titlesize": 12,
            "axes.titlelocation": "left",
            "axes.titleweight": "bold",
            "axes.spines.top": False,
            "axes.spines.right": False,
            "axes.prop_cycle": plt.cycler(color=COLOURS),
            "lines.linewidth": 2.0,
            "legend.frameon": False,
        }
    )
    figure, axes = plt.subplots(
        rows, columns, figsize=(13.3, height), layout="constrained", **options
    )
    figure.get_layout_engine().set(w_pad=0.1, h_pad=0.08)
    return figure, axes


def show_field(axes, values: np.ndarray, size: tuple[float, float], **options):
    """Draws a field sampled on a centred grid over `size` [µm or mm]."""
    x, y = (extent / 2 for extent in size)
    axes.spines[:].set_visible(True)
    return axes.imshow(
        values.T, origin="lower", extent=(-x, x, -y, y), interpolation="bicubic", **options
    )


def add_colour_bar(image, label: str):
    """A colour bar as high as the field."""
    axes = image.axes
    axes.figure.colorbar(image, cax=axes.inset_axes([1.03, 0, 0.04, 1]), label=label)


def save(figure, folder: Path, name: str, smooth: bool = False) -> Path:
    """Writes the picture and says where it is: of few colours and thus small, or `smooth`."""
    path = folder / f"{name}.png"
    figure.savefig(path, dpi=110)
    with Image.open(path) as image:
        drawn = image.convert("RGB")
    if not smooth:
        coverage = Image.Quantize.MAXCOVERAGE
        drawn = drawn.quantize(256, coverage, kmeans=3, dither=Image.Dither.NONE)
    drawn.save(path, optimize=True)
    plt.close(figure)
    print(f"picture: {path}")
    return path
