"""What the examples share: driving a unit by names, and the look of the pictures."""

import argparse
import shutil
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402
import numpy as np  # noqa: E402
from fmpy import extract, read_model_description  # noqa: E402
from fmpy.fmi2 import FMU2Slave  # noqa: E402

ROOT = Path(__file__).resolve().parents[1]
ZERO_CELSIUS = 273.15  # K

# Colours that people with colour-blindness tell apart, dark to light
COLOURS = ["#20306b", "#b0303c", "#e08214", "#2a8a7f", "#7b7b7b"]
CLOSED_FORM = {"color": "black", "linestyle": (0, (4, 3)), "linewidth": 1.2, "zorder": 5}


def arguments(name: str, purpose: str, given: list[str] | None) -> argparse.Namespace:
    """The options of an example: the unit and the folder of the pictures."""
    parser = argparse.ArgumentParser(description=purpose)
    parser.add_argument(
        "--fmu", type=Path, default=ROOT / "out" / f"{name}.fmu", help="unit [default: %(default)s]"
    )
    parser.add_argument(
        "--out", type=Path, default=ROOT / "out" / name, help="folder [default: %(default)s]"
    )
    options = parser.parse_args(given)
    if not options.fmu.is_file():
        parser.exit(
            2,
            f"{options.fmu}: no such file; build it from the root of the repository with\n"
            f"  build-fmu examples/{name}/scene.toml -o out/{name}.fmu\n",
        )
    options.out.mkdir(parents=True, exist_ok=True)
    return options


class Unit:
    """An FMI 2.0 co-simulation unit whose variables go by their names."""

    def __init__(self, path: Path):
        description = read_model_description(path)
        self.references = {v.name: v.valueReference for v in description.modelVariables}
        self.folder = extract(path)
        self.slave = FMU2Slave(
            guid=description.guid,
            unzipDirectory=self.folder,
            modelIdentifier=description.coSimulation.modelIdentifier,
            instanceName=path.stem,
        )
        self.time = 0.0

    def __enter__(self):
        self.slave.instantiate()
        self.slave.setupExperiment(startTime=0.0)
        self.slave.enterInitializationMode()
        self.slave.exitInitializationMode()
        return self

    def __exit__(self, *_):
        self.slave.terminate()
        self.slave.freeInstance()
        shutil.rmtree(self.folder, ignore_errors=True)

    def set(self, values: dict[str, float]):
        """Sets inputs; they hold until they are set again."""
        self.slave.setReal([self.references[name] for name in values], list(values.values()))

    def step_to(self, time: float):
        """Advances the unit under its present inputs."""
        self.slave.doStep(
            currentCommunicationPoint=self.time, communicationStepSize=time - self.time
        )
        self.time = time

    def get(self, *names: str) -> np.ndarray:
        """Values of outputs."""
        return np.array(self.slave.getReal([self.references[name] for name in names]))

    def field(self, name: str, shape: tuple[int, int]) -> np.ndarray:
        """A sampled field; the first index runs along the first axis of the grid."""
        cells = [f"{name}[{i + 1},{j + 1}]" for i in range(shape[0]) for j in range(shape[1])]
        return self.get(*cells).reshape(shape)


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


def save(figure, folder: Path, name: str) -> Path:
    """Writes the picture and says where it is."""
    path = folder / f"{name}.png"
    figure.savefig(path, dpi=110)
    plt.close(figure)
    print(f"picture: {path}")
    return path
