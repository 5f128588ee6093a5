"""Notched beams of concrete of three sizes: load over crack opening, energy, crack, size effect."""

import sys
import time
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from scipy.optimize import curve_fit

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
import paraview  # noqa: E402
import shared  # noqa: E402
from impinge import Unit  # noqa: E402

NAME = "notched_beam"
SCENE = Path(__file__).parent / "scene.toml"
STEP = 0.02  # s, as in the scene
WIDTH, STRENGTH = 152.4e-3, 4.5e6  # m, Pa
# Depth, length, span, depth of the notch and distance of particles [m]
SIZES = {
    "D3": (76.2e-3, 0.25, 228.6e-3, 25.4e-3, 4.7625e-3),
    "D6": (152.4e-3, 0.50, 457.2e-3, 50.8e-3, 9.525e-3),
    "D9": (228.6e-3, 0.75, 685.8e-3, 76.2e-3, 14.2875e-3),
}
OUTPUTS = ["force", "displacement", "mechanical_work", "dissipated_energy", "elastic_energy"]
OUTPUTS = [f"beam.{key}" for key in [*OUTPUTS, "released_energy", "energy_drift"]]


@dataclass
class Beam:
    depth: float  # m
    openings: np.ndarray  # m
    outputs: dict[str, np.ndarray]
    fields: Path

    @property
    def peak(self) -> float:
        return self.outputs["force"].max()

    @property
    def nominal(self) -> float:
        """Nominal strength [Pa]: load over width and depth."""
        return self.peak / (WIDTH * self.depth)


def scaled(name: str, folder: Path) -> Path:
    """The scene of a beam of another size."""
    text = SCENE.read_text()
    for key, old, new in zip(
        ["\ndepth = ", "length = ", "span = ", "notch = { depth = ", "spacing = "],
        ["152.4e-3", "0.50", "457.2e-3", "50.8e-3", "9.525e-3"],
        SIZES[name],
        strict=True,
    ):
        assert text.count(key + old) == 1
        text = text.replace(key + old, key + repr(new))
    path = folder / f"{name}.toml"
    path.write_text(text)
    return path


def simulate(source: Path, name: str, openings: np.ndarray, folder: Path) -> Beam:
    """Opens the notch of a beam step by step; the last step leaves a file of its particles."""
    rows = []
    with Unit(source, parameters={"output.directory": str(folder)}) as unit:
        for opening in openings:
            unit.set({"beam.opening": opening})
            unit.step_to(unit.time + STEP)
            rows.append(unit.get(OUTPUTS))
    columns = np.array(rows).T
    outputs = {
        key.removeprefix("beam."): column for key, column in zip(OUTPUTS, columns, strict=True)
    }
    return Beam(SIZES[name][0], openings, outputs, folder)


def size_law(depth, strength, transition):
    """Nominal strength after Z. P. Bažant (1984), doi 10.1061/(ASCE)0733-9399(1984)110:4(518)."""
    return strength / np.sqrt(1 + depth / transition)


def report(beams: dict[str, Beam]) -> None:
    rows = []
    for name, beam in beams.items():
        at_peak = beam.openings[beam.outputs["force"].argmax()]
        work = beam.outputs["mechanical_work"][-1]
        drift = abs(beam.outputs["energy_drift"]).max() / work
        rows.append(
            [
                name,
                f"{beam.peak / 1e3:.2f} kN",
                f"{at_peak * 1e6:.0f} µm",
                f"{beam.nominal / 1e6:.2f} MPa",
                f"{work:.2f} J",
                f"{drift:.0e}",
            ]
        )
    head = ["beam", "largest load", "at an opening of", "nominal strength", "work", "drift"]
    shared.print_table(head, rows)


def draw(beams: dict[str, Beam], folder: Path) -> Path:
    figure, axes = shared.new_figure(2, 2, height=8.0)
    loads, energies, crack, sizes = axes.flat
    for name, beam in beams.items():
        force = np.concatenate([[0.0], beam.outputs["force"]])
        opening = np.concatenate([[0.0], beam.openings])
        loads.plot(opening * 1e6, force / 1e3, label=f"{name}, {beam.depth * 1e3:.0f} mm")
    loads.set(
        xlabel="opening of the notch [µm]", ylabel="load [kN]", title="Larger beams fall steeper"
    )
    loads.legend()
    shown = beams["D6"]
    stored = shown.outputs["elastic_energy"]
    dissipated, released = shown.outputs["dissipated_energy"], shown.outputs["released_energy"]
    energies.stackplot(
        shown.openings * 1e6,
        [dissipated, released, stored],
        labels=["dissipated", "released by sudden breaks", "stored"],
        colors=["#b0303c", "#7b7b7b", "#2a8a7f"],
    )
    work = shown.outputs["mechanical_work"]
    energies.plot(shown.openings * 1e6, work, **shared.CLOSED_FORM, label="work of the load")
    energies.set(
        xlabel="opening of the notch [µm]",
        ylabel="energy [J]",
        title="D6: all work is accounted for",
    )
    energies.legend(loc="upper left")
    draw_crack(crack, shown)
    depths = np.array([beam.depth for beam in beams.values()])
    strengths = np.array([beam.nominal for beam in beams.values()])
    (plastic, transition), _ = curve_fit(size_law, depths, strengths, p0=[strengths[0], depths[1]])
    line = np.geomspace(0.03, 0.6, 50)
    law = f"Bažant's law, transition at {transition * 1e3:.0f} mm"
    sizes.loglog(line, size_law(line, plastic, transition) / 1e6, **shared.CLOSED_FORM, label=law)
    sizes.loglog(depths, strengths / 1e6, "o", markersize=9)
    for name, beam in beams.items():
        sizes.annotate(name, (beam.depth, beam.nominal / 1e6), (8, 4), textcoords="offset points")
    sizes.set(
        xlabel="depth [m]",
        ylabel="nominal strength [MPa]",
        title="Twice as large is not twice as strong",
    )
    sizes.legend()
    sizes.set(xticks=[0.05, 0.1, 0.2, 0.5], yticks=[0.2, 0.3, 0.4, 0.5])
    for axis in (sizes.xaxis, sizes.yaxis):
        axis.set_major_formatter("{x:g}")
        axis.set_minor_formatter("")
    figure.suptitle(
        "Notched concrete beams in three-point bending, as lattices of links that soften"
    )
    return shared.save(figure, folder, NAME)


def draw_crack(axes, beam: Beam) -> None:
    """Damage of the particles of a beam in its middle, on places moved a hundred times too far."""
    *_, last = sorted(paraview.files(beam.fields, "beam").items())
    particles = paraview.read(last[1])
    place = particles["position"]
    inside = abs(place[:, 0]) < 0.6 * beam.depth
    image = axes.scatter(
        place[inside, 0] * 1e3,
        place[inside, 2] * 1e3,
        c=particles["damage"][inside],
        cmap="inferno_r",
        vmin=0,
        vmax=1,
        s=60,
        marker="h",
    )
    axes.set_aspect("equal")
    axes.set(xlabel="x [mm]", ylabel="z [mm]")
    axes.set_title(f"D6 at an opening of {beam.openings[-1] * 1e6:.0f} µm")
    shared.add_colour_bar(image, "damage")


def main(given: list[str] | None = None) -> None:
    points = {"type": int, "default": 60, "help": "steps of the opening [default: %(default)s]"}
    last = {"type": float, "default": 300.0, "help": "last opening [µm; default: %(default)s]"}
    options = shared.arguments(NAME, __doc__, given, points=points, last=last)
    openings = options.last * 1e-6 * np.linspace(0, 1, options.points + 1)[1:] ** 1.5
    began = time.perf_counter()
    beams = {}
    for name in SIZES:
        source = options.fmu if name == "D6" else scaled(name, options.out)
        beams[name] = simulate(source, name, openings, options.out / name)
    report(beams)
    print(f"three beams in {time.perf_counter() - began:.1f} s")
    draw(beams, options.out)


if __name__ == "__main__":
    main()
