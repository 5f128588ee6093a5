"""What comes of impacts in scenes, and how that depends on particles, kernels and sound."""

from collections.abc import Callable
from functools import partial

from plan import Answer, Axis, Map
from references import Reference
from unit_run import run_unit

from cases.fluids.drops import (
    DIAMETER,
    HEMISPHERE,
    impact,
    impact_work,
    largest_spread,
    ohnesorge_of,
    speed_of,
    viscous,
)

QUANTITIES = ["impulse_z", "spread_diameter", "height", "heat"]
LABELS = ["impulse", "spread", "height", "heat"]


def case(weber: float, reynolds: float, across: float, stop: float, **body) -> dict:
    fluid = viscous(ohnesorge_of(weber, reynolds)) | body.pop("fluid", {})
    return impact(across, speed_of(weber), fluid, stop, **body)


def largest(answer: Answer, name: str) -> float:
    return max(answer.values[f"drop.{name}"])


def last(answer: Answer, name: str) -> float:
    return answer.values[f"drop.{name}"][-1]


def off(reference: Reference, answer: Answer, x: float, y: float) -> float:
    """One of the quantities beside its reference."""
    return beside(reference, answer, QUANTITIES[round(y)])


def beside(reference: Reference, answer: Answer, name: str) -> float:
    return abs(last(answer, name) / reference.value(f"drop.{name}") - 1.0)


def of_quantities() -> Axis:
    return Axis("quantity", "", list(range(len(QUANTITIES))), False, LABELS)


def spreads() -> Map:
    """Largest spread beside a fit of measurements."""
    across, stop = 20.0, 4.0

    def work(weber: float, ohnesorge: float) -> dict:
        scene = case(weber, weber**0.5 / ohnesorge, across, stop, reach=10.0)
        return impact_work(scene, ["spread_diameter"])

    def of_fit(answer: Answer, weber: float, ohnesorge: float) -> float:
        expected = largest_spread(weber, weber**0.5 / ohnesorge, HEMISPHERE)
        return abs(largest(answer, "spread_diameter") / DIAMETER / expected - 1.0)

    return Map(
        name="spreads",
        title=f"Error of the largest spread, {across:g} particles across",
        x=Axis("Weber number", "1", [3, 10, 30, 100, 300, 1000]),
        y=Axis("Ohnesorge number", "1", [0.003, 0.01, 0.03, 0.1, 0.3]),
        outcome="relative difference to a fit of measurements",
        unit="1",
        bad=0.3,
        work=work,
        run=run_unit,
        judge=of_fit,
        colours=(0.0, 0.6),
    )


WEBER, REYNOLDS, STOP = 300.0, 1000.0, 2.0
FASTEST_SOUND, FINEST = 30.0, 64.0
"""Speed of sound over that of the drop, and particles across, of references."""


def by_sound() -> Reference:
    sound = {"sound_speed": FASTEST_SOUND * speed_of(WEBER)}
    work = impact_work(case(WEBER, REYNOLDS, 24.0, STOP, fluid=sound), QUANTITIES, 20)
    return Reference(f"{FASTEST_SOUND:g} U", work, run_unit)


def finest() -> Reference:
    work = impact_work(case(WEBER, REYNOLDS, FINEST, STOP), QUANTITIES, 20)
    return Reference(f"{FINEST:g} particles across", work, run_unit)


def sound_speed() -> Map:
    """What users read over the speed of sound that a scene asks for."""

    def work(x: float, y: float) -> dict:
        sound = {"sound_speed": x * speed_of(WEBER)}
        scene = case(WEBER, REYNOLDS, 24.0, STOP, fluid=sound)
        return impact_work(scene, [QUANTITIES[round(y)]], 20)

    return Map(
        name="sound_speed",
        title="Speed of sound that a scene asks for",
        x=Axis("speed of sound over that of the drop", "1", [4.0, 5.0, 7.0, 10.0, 14.0, 20.0]),
        y=of_quantities(),
        outcome="off that at thirty times the drop's speed",
        unit="1",
        bad=0.25,
        work=work,
        run=run_unit,
        judge=partial(off, by_sound()),
        references=[by_sound()],
        colours=(0.0, 0.4),
    )


def kernels() -> Map:
    """Heat over the support of each kernel."""
    names = ["wendland_c2", "wendland_c4", "cubic_spline", "quintic_spline"]

    def work(x: float, y: float) -> dict:
        scene = case(WEBER, REYNOLDS, 24.0, STOP, kernel=names[round(y)], support=x)
        return impact_work(scene, ["heat"], 20)

    return Map(
        name="kernels",
        title="Heat of an impact by kernel and support",
        x=Axis(
            "support H over the distance of particles Δx",
            "1",
            [2.0, 2.25, 2.5, 3.0, 3.5, 4.0, 5.0, 6.0],
        ),
        y=Axis("kernel", "", list(range(len(names))), False, names),
        outcome="heat, relative difference to 64 particles across",
        unit="1",
        bad=0.3,
        work=work,
        run=run_unit,
        judge=lambda answer, x, y: beside(finest(), answer, "heat"),
        references=[finest()],
        colours=(0.0, 0.5),
    )


def of_readings(name: str, title: str, x: Axis, work: Callable[[float, float], dict]) -> Map:
    """What users read over one setting, beside the finest particles."""
    return Map(
        name=name,
        title=title,
        x=x,
        y=of_quantities(),
        outcome="relative difference to 64 particles across",
        unit="1",
        bad=0.3,
        work=work,
        run=run_unit,
        judge=partial(off, finest()),
        references=[finest()],
        colours=(0.0, 0.5),
    )


def diffusion() -> Map:
    def work(x: float, y: float) -> dict:
        scene = case(WEBER, REYNOLDS, 24.0, STOP, density_diffusion=x)
        return impact_work(scene, [QUANTITIES[round(y)]], 20)

    axis = Axis("density diffusion δ", "1", [0.0, 0.03, 0.1, 0.3, 0.6, 1.0], False)
    return of_readings("diffusion", "Density diffusion that a scene asks for", axis, work)


def resolution() -> Map:
    def work(x: float, y: float) -> dict:
        return impact_work(case(WEBER, REYNOLDS, x, STOP), [QUANTITIES[round(y)]], 20)

    axis = Axis("particles across D/Δx", "1", [3, 6, 8, 10, 12, 16, 20, 24, 32])
    return of_readings(
        "resolution", "Error of what is read of a drop, by particles across", axis, work
    )


FILMS = [(10.0, 100.0), (30.0, 100.0), (30.0, 1000.0), (100.0, 1000.0), (300.0, 1000.0)]
"""Weber and Reynolds numbers."""
FILM_STOP, FINE_FILM = 3.0, 48.0


def fine_film(weber: float, reynolds: float) -> Reference:
    work = impact_work(case(weber, reynolds, FINE_FILM, FILM_STOP), ["heat"], 20)
    return Reference(f"We {weber:g}, Re {reynolds:g}, {FINE_FILM:g} across", work, run_unit)


def films() -> Map:
    """Heat over particles and the thickness of films."""

    def work(x: float, y: float) -> dict:
        return impact_work(case(*FILMS[round(y)], x, FILM_STOP), ["heat"], 20)

    def of_film(answer: Answer, x: float, y: float) -> float:
        return beside(fine_film(*FILMS[round(y)]), answer, "heat")

    return Map(
        name="films",
        title="Error of heat, by flow and particles across",
        x=Axis("particles across D/Δx", "1", [6, 8, 10, 12, 16, 20, 24]),
        y=Axis(
            "We, Re",
            "",
            list(range(len(FILMS))),
            False,
            [f"{weber:g}, {reynolds:g}" for weber, reynolds in FILMS],
        ),
        outcome="heat, relative difference to 48 particles across",
        unit="1",
        bad=0.3,
        work=work,
        run=run_unit,
        judge=of_film,
        references=[fine_film(*numbers) for numbers in FILMS],
        colours=(0.0, 0.5),
    )


MAPS = {of.__name__: of for of in (spreads, sound_speed, kernels, diffusion, resolution, films)}
