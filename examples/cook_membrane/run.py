"""Cook's membrane by five methods: error of the rise of its corner over spacing and over time."""

import sys
import time
from dataclasses import dataclass
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
import shared  # noqa: E402
from impinge import Unit  # noqa: E402

NAME = "cook_membrane"
SCENE = Path(__file__).parent / "scene.toml"
METHODS = {
    "fem": ("finite elements, linear", ""),
    "fem 2": ("finite elements, quadratic", ""),
    "rkpm": ("reproducing kernels, linear", ""),
    "rkpm 2": ("reproducing kernels, quadratic", "rkpm = { basis = 2 }"),
    "efg": ("element-free Galerkin, linear", ""),
    "sph": ("smoothed particles", ""),
}
SPACINGS = [6e-3, 4e-3, 3e-3, 2e-3, 1.5e-3, 1e-3]  # m
# Finest of a method, so that all of them together take a minute; 1 mm by default
FINEST = {"rkpm": 3e-3, "rkpm 2": 3e-3, "efg": 3e-3, "sph": 2e-3}  # m
FULL = 6.25e6  # Pa
SMALL = 1e-3 * FULL
STEPS = 5  # up to the full load
# Rise per load of linear elasticity, as Code_Aster and CalculiX have it within 0.3 % [m/Pa]
LINEAR = 32.2e-3 / FULL
CORNERS = np.array([[0.0, 0.0], [48.0, 44.0], [48.0, 60.0], [0.0, 44.0]])  # mm
ALONG = np.linspace(0.0, 1.0, 9)


@dataclass
class Run:
    method: str
    spacing: float  # m
    small: float  # m, the rise under a thousandth of the load
    rise: float  # m, under all of it
    seconds: float  # to start and to load
    edges: np.ndarray  # mm, places of the top and the bottom edge under the load


def edges() -> np.ndarray:
    """Places along the top and the bottom edge [mm]."""
    [a, b, c, d] = CORNERS
    share = ALONG[:, None]
    return np.array([d + share * (c - d), a + share * (b - a)])


def variant(method: str, spacing: float, folder: Path) -> Path:
    """The scene of another method and spacing, with probes along two edges."""
    text = SCENE.read_text()
    order = ", order = 2" if method == "fem 2" else ""
    of_method = f'mechanics = "{method.split()[0]}"\n{METHODS[method][1]}'
    for old, new in [
        ('mechanics = "fem"', of_method),
        ("mesh = { spacing = 2e-3 }", f"mesh = {{ spacing = {spacing!r}{order} }}"),
    ]:
        assert text.count(old) == 1
        text = text.replace(old, new)
    for edge, places in zip(["top", "bottom"], edges(), strict=True):
        for number, (x, z) in enumerate((places * 1e-3).tolist()):
            text += f'[[probe]]\nname = "{edge}{number}"\nin = "membrane"\n'
            text += f'at = [{x!r}, 0.0, {z!r}]\ngives = ["displacement"]\n'
    path = folder / f"{method.replace(' ', '_')}_{spacing * 1e3:g}mm.toml"
    path.write_text(text)
    return path


def load(source: Path, method: str, spacing: float) -> Run:
    """Loads a membrane by a little, then by all in equal steps."""
    start = time.perf_counter()
    with Unit(source) as unit:
        unit["membrane.right.traction_z"] = SMALL
        unit.step_to(1.0)
        small = unit["corner.displacement_z"]
        for step in range(1, STEPS + 1):
            unit["membrane.right.traction_z"] = FULL * step / STEPS
            unit.step_to(1.0 + step)
        seconds = time.perf_counter() - start
        rise = unit["corner.displacement_z"]
        moved = [
            [[unit[f"{edge}{n}.displacement_{axis}"] for axis in "xz"] for n in range(len(ALONG))]
            for edge in ["top", "bottom"]
        ]
    return Run(method, spacing, small, rise, seconds, edges() + 1e3 * np.array(moved))


def timed(source: Path, method: str, spacing: float) -> Run:
    """Loads a membrane twice, as the first time its unit is built."""
    load(source, method, spacing)
    return load(source, method, spacing)


def report(runs: list[Run], exact: float):
    print(f"Full load: the corner rises by {exact * 1e3:.3f} mm on the finest meshes.")
    rows = []
    for run in runs:
        errors = [run.small / (LINEAR * SMALL) - 1, run.rise / exact - 1]
        rows.append([METHODS[run.method][0], f"{run.spacing * 1e3:g}"])
        rows[-1] += [f"{100 * error:+.2f}" for error in errors] + [f"{run.seconds:.2f}"]
    shared.print_table(["method", "spacing/mm", "small/%", "full/%", "s"], rows)


def draw(runs: list[Run], exact: float, folder: Path) -> Path:
    figure, [shape, over_spacing, over_time] = shared.new_figure(1, 3, height=5.0)
    draw_shape(shape, min((run for run in runs if run.method == "fem"), key=lambda r: r.spacing))
    for colour, marker, method in zip([*shared.COLOURS, "black"], "osD^vP", METHODS, strict=True):
        own = [run for run in runs if run.method == method]
        errors = [100 * abs(run.rise / exact - 1) for run in own]
        style = {"color": colour, "marker": marker, "label": METHODS[method][0], "markersize": 5}
        over_spacing.loglog([1e3 * run.spacing for run in own], errors, **style)
        over_time.loglog([run.seconds for run in own], errors, **style)
    ticks = [1e3 * spacing for spacing in SPACINGS]
    over_spacing.set_xticks(ticks, [f"{tick:g}" for tick in ticks])
    over_spacing.minorticks_off()
    over_spacing.set(xlabel="distance of nodes / mm", ylabel="error of the rise / %")
    over_spacing.set_title("Error over the distance of nodes")
    over_time.set(xlabel="time to start and to load / s", ylabel="error of the rise / %")
    over_time.set_title("Error over time")
    figure.legend(*over_spacing.get_legend_handles_labels(), loc="outside lower center", ncols=3)
    figure.suptitle(
        "Cook's membrane of rubber, plane strain, by finite elements and without a mesh"
    )
    return shared.save(figure, folder, NAME)


def draw_shape(plot, run: Run):
    for [top, bottom], style in [
        (edges(), {"color": "0.6", "linewidth": 1}),
        (run.edges, {"color": shared.COLOURS[0]}),
    ]:
        outline = np.vstack([bottom, top[::-1], bottom[:1]])
        plot.plot(*outline.T, **style)
    plot.axvline(0.0, color="black", linewidth=3)
    plot.set(xlabel="x / mm", ylabel="z / mm")
    plot.set_aspect("equal", adjustable="datalim")
    plot.set_title("Its edges without load and with it")


def main(given: list[str] | None = None) -> list[Run]:
    settings = {"type": float, "default": min(SPACINGS) * 1e3, "help": "[mm; default: %(default)s]"}
    options = shared.arguments(NAME, __doc__, given, finest=settings)
    finest = 1e-3 * options.finest
    spacings = [spacing for spacing in SPACINGS if spacing >= 0.999 * finest]
    runs = [
        timed(variant(method, spacing, options.out), method, spacing)
        for method in METHODS
        for spacing in spacings
        if spacing >= 0.999 * FINEST.get(method, 0.0)
    ]
    fine = [load(variant("fem", h, options.out), "fem", h).rise for h in [finest, finest / 2]]
    # Its error falls with the square of the spacing.
    exact = fine[1] + (fine[1] - fine[0]) / 3
    report(runs, exact)
    draw(runs, exact, options.out)
    return runs


if __name__ == "__main__":
    main()
