"""A cold drop of water falls on hot glass: probability of failure, and a scratch."""

import sys
from dataclasses import dataclass
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
import shared  # noqa: E402
from impinge import Unit  # noqa: E402

NAME = "drop_on_hot_glass"
STOP, STEP = 20e-3, 0.1e-3  # s
RINGS, RADIUS = 24, 6e-3  # m
TOUGHNESS = 0.77e6  # Pa √m
SHOWN = [0.5e-3, 2e-3, 6e-3, 20e-3]  # s


@dataclass
class Result:
    times: np.ndarray  # s
    risks: np.ndarray  # B so far and of the moment
    scratch: np.ndarray  # Pa √m
    worst: np.ndarray  # Pa √m and m
    stress: np.ndarray  # Pa, xx of each ring at each time: the mean of radial and hoop stress
    density: np.ndarray  # 1/m², risk so far over the area of each ring, in the end


def simulate(fmu: Path) -> Result:
    names = ["plate.failure_risk", "plate.present_failure_risk", "scratch.stress_intensity"]
    names += ["worst.stress_intensity", "worst.depth"]
    rings = [f"face.stress_xx[{i}]" for i in range(1, RINGS + 1)]
    densities = [f"face.surface_failure_density[{i}]" for i in range(1, RINGS + 1)]
    rows = []
    with Unit(fmu) as unit:
        for step in range(round(STOP / STEP)):
            unit.step_to((step + 1) * STEP)
            rows.append([unit.time, *unit.get(names + rings)])
        density = np.array(unit.get(densities))
    rows = np.array(rows)
    return Result(rows[:, 0], rows[:, 1:3], rows[:, 3], rows[:, 4:6], rows[:, 6:], density)


def shares(result: Result) -> np.ndarray:
    """Parts of the risk so far that lie within the outer radius of each ring."""
    edges = np.linspace(0.0, RADIUS, RINGS + 1)
    risks = result.density * np.pi * np.diff(edges**2)
    return np.cumsum(risks) / result.risks[-1, 0]


def report(result: Result):
    rows = []
    for time in SHOWN:
        at = np.argmin(abs(result.times - time))
        risk, present = result.risks[at]
        worst, depth = result.worst[at]
        rows.append(
            [f"{time * 1e3:.1f}", f"{-np.expm1(-risk):.2e}", f"{-np.expm1(-present):.2e}"]
            + [f"{result.scratch[at] * 1e-6:.3f}", f"{worst * 1e-6:.3f}", f"{depth * 1e6:.0f}"]
        )
    shared.print_table(["t/ms", "P", "P now", "K/(MPa √m)", "worst K", "at µm"], rows)
    within = shares(result)
    half, most = [RADIUS / RINGS * (np.argmax(within > part) + 1) * 1e3 for part in [0.5, 0.95]]
    print(f"half of the risk lies within {half:.2f} mm, 95 % within {most:.2f} mm")


def draw(result: Result, folder: Path):
    figure, axes = shared.new_figure(1, 3, height=5.0)
    middles = (np.arange(RINGS) + 0.5) * RADIUS / RINGS * 1e3
    for time, colour in zip(SHOWN, shared.COLOURS, strict=False):
        at = np.argmin(abs(result.times - time))
        label = f"{time * 1e3:.1f} ms"
        axes[0].plot(middles, result.stress[at] * 1e-6, color=colour, label=label)
    axes[0].axhline(0, color="0.6", lw=1)
    axes[0].set(xlabel="radius / mm", ylabel="stress of the surface, mean / MPa")
    axes[0].set_title("The film pulls what it cools")
    axes[0].legend()
    times = result.times * 1e3
    axes[1].semilogy(times, -np.expm1(-result.risks[:, 0]), label="so far")
    axes[1].semilogy(times, -np.expm1(-result.risks[:, 1]), label="by the stress now")
    axes[1].set(xlabel="time / ms", ylabel="probability of failure P")
    axes[1].set_title("P rises as the film spreads")
    axes[1].legend(loc="lower right")
    axes[2].plot(times, result.scratch * 1e-6, label="scratch of 50 µm")
    axes[2].plot(times, result.worst[:, 0] * 1e-6, label="worst depth")
    axes[2].axhline(TOUGHNESS * 1e-6, color="0.5", lw=1)
    axes[2].text(times[-1], 0.78, "toughness without water", ha="right", color="0.4")
    at = len(times) // 2
    axes[2].annotate(
        f"{result.worst[at, 1] * 1e6:.0f} µm deep",
        (times[at], result.worst[at, 0] * 1e-6),
        (times[at] + 1, result.worst[at, 0] * 1e-6 + 0.1),
        color="0.3",
        arrowprops={"arrowstyle": "-", "color": "0.6"},
    )
    axes[2].set(xlabel="time / ms", ylabel="stress intensity / (MPa √m)", ylim=(0, 0.9))
    axes[2].set_title("Scratches open, and none grows")
    axes[2].legend(loc="lower right")
    figure.suptitle("Water of 20 °C (2 mm, 0.7 m/s) on soda-lime glass of 95 °C")
    shared.save(figure, folder, NAME)


def check(result: Result):
    """The risk so far never falls, and no depth is worse than the worst."""
    so_far, present = result.risks.T
    assert np.all(np.diff(so_far) >= 0), "the risk falls"
    assert np.all(so_far >= present * (1 - 1e-2)), "more at once than ever"
    assert np.all(result.worst[:, 0] >= result.scratch * (1 - 1e-3)), "a depth is worse"
    assert result.scratch.max() > 0.0, "the cold film opens the scratch"
    assert abs(shares(result)[-1] - 1) < 0.05, "the risk is not that of the surface"
    # The skin cannot be pulled more than if it took the temperature of the water.
    most = 70e9 * 9e-6 * 75.0 / 0.8
    assert result.stress.max() < most, result.stress.max()


def main(given: list[str] | None = None):
    options = shared.arguments(NAME, __doc__, given)
    result = simulate(options.fmu)
    report(result)
    check(result)
    draw(result, options.out)


if __name__ == "__main__":
    main()
