"""Runs a scene as a unit in this process, and keeps what it said."""

import logging
from itertools import repeat
from pathlib import Path
from tempfile import TemporaryDirectory

import tomli_w
from plan import Answer, Work

logging.getLogger("impinge").setLevel(logging.ERROR)


def unit_work(
    scene: dict,
    outputs: list[str],
    steps: list[float],
    inputs: dict | None = None,
    slopes: dict | None = None,
    about: str = "",
) -> Work:
    """Work of `run_unit`: lengths of steps [s]; an input is a number, or a list with one a step.

    `slopes` are time derivatives of inputs at the beginning of each step; only warnings with
    `about` in them count."""
    work = {"scene": scene, "outputs": outputs, "steps": steps, "inputs": inputs or {}}
    more = {"slopes": slopes, "about": about}
    return work | {name: value for name, value in more.items() if value}


def run_unit(work: Work) -> Answer:
    """Values of each output at the start and after every step, as lists."""
    from impinge import Unit
    from impinge.errors import UnitError

    heard = []

    def listen(status: int, _: str, message: str) -> None:
        if status == 1 and work.get("about", "") in message:
            heard.append(message)

    values = {name: [] for name in work["outputs"]}
    try:
        with TemporaryDirectory() as folder:
            path = Path(folder, "scene.toml")
            path.write_text(tomli_w.dumps(work["scene"]))
            with Unit(path, logger=listen) as unit:
                note(unit, work, values)
                for place, length in enumerate(work["steps"]):
                    for name, path_of in work["inputs"].items():
                        unit[name] = path_of[place] if isinstance(path_of, list) else path_of
                    if slopes := work.get("slopes"):
                        unit.set_input_derivatives(
                            {name: [path_of[place]] for name, path_of in slopes.items()}
                        )
                    unit.step(length)
                    note(unit, work, values)
    except (UnitError, RuntimeError) as refusal:
        return Answer(values, first(heard), refused=str(refusal))
    return Answer(values, first(heard))


def note(unit, work: Work, values: dict) -> None:
    for name in work["outputs"]:
        values[name].append(float(unit[name]))


def first(messages: list[str]) -> str:
    return messages[0] if messages else ""


def equal_steps(stop: float, count: int) -> list[float]:
    return list(repeat(stop / count, count))
