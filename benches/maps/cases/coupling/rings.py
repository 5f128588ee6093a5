"""A drop's unit on a plate's unit, joined by rings, beside both in one unit: how wide may rings be?

Heat that a drop gives over a ring belongs to all of it, and so does the temperature that it meets.
Both units take turns; the plate is poor enough a conductor to warm by half of what there is.
"""

import warnings
from pathlib import Path
from tempfile import TemporaryDirectory

import tomli_w
from impinge import Master, Unit
from impinge.errors import UnitError
from impinge.master import MasterError
from plan import Answer, Axis, Map, Work
from problems.drops import droplet, on_plate, wall
from problems.materials import effusivity, liquid, thermal, thermoelastic
from problems.plates import CENTRE
from unit_run import equal_steps, run_unit, unit_work

DIAMETER, SPEED = 1e-4, 20.0
STOP, STEPS, REACH = 3e-6, 60, 2e-4
HOT, COLD = 373.15, 293.15
SOLID = thermal(1200.0, 1500.0, 0.2)
WIDTHS = [1.0, 1.5, 2.0, 3.0, 5.0]
ACROSS = [8.0, 12.0, 16.0]
FLUID = liquid(1000.0, 1e-3, 4000.0, surface_tension=0.059)


def work(width: float, across: float) -> Work:
    """One scene, and its halves."""
    spacing = DIAMETER / across
    general = {"name": "Halves", "stop_time": STOP, "step": STOP / STEPS}
    general["fidelity"] = {"tolerance": 0.9}
    drop = droplet(DIAMETER, SPEED, HOT, FLUID, symmetry="axisymmetric", spacing=spacing)
    plate = {
        "kind": "solid",
        "shape": {"disc": {"radius": 3e-4, "thickness": 5e-5}},
        "material": thermoelastic(SOLID),
        "initial_temperature": COLD,
        "mesh": {"spacing": 3e-6, "depth_spacing": 5e-7, "growth": 1.3, "order": 1},
    }
    count = max(2, round(REACH / (width * spacing)))
    wide = wall(count, count * width * spacing, COLD, effusivity=effusivity(SOLID))
    rings = wide["footprint"]
    load = {"name": "rings", "on": "plate.top", "footprint": rings, "carries": ["heat_flux"]}
    face = {"name": "face", "on": "plate.top", "footprint": rings, "gives": ["temperature"]}
    return {
        "whole": general
        | {
            "body": {"drop": drop, "plate": plate},
            "coupling": [on_plate(1.2e-4)],
            "probe": [CENTRE],
        },
        "drop": general | {"body": {"drop": drop}, "wall": [wide]},
        "plate": general
        | {"body": {"plate": plate}, "load": [load], "field": [face], "probe": [CENTRE]},
    }


def run(of: Work) -> Answer:
    """The centre's temperature in both, and what any unit or the master says."""
    steps = equal_steps(STOP, STEPS)
    whole = run_unit(unit_work(of["whole"], ["centre.temperature"], steps))
    told = []

    def listen(status: int, _: str, message: str) -> None:
        if status == 1:
            told.append(message)

    with TemporaryDirectory() as folder, warnings.catch_warnings(record=True) as heard:
        warnings.simplefilter("always")
        paths = {name: Path(folder, f"{name}.toml") for name in ("drop", "plate")}
        for name, path in paths.items():
            path.write_text(tomli_w.dumps(of[name]))
        links = [
            ("drop.wall.heat_flux", "plate.rings.heat_flux"),
            ("plate.face.temperature", "drop.wall.temperature"),
        ]
        options = {"scheme": "gauss-seidel", "step": STOP / STEPS}
        options["outputs"] = ["plate.centre.temperature"]
        try:
            units = {name: Unit(path, logger=listen) for name, path in paths.items()}
            with Master(units, links, **options) as master:
                result = master.run(STOP)
            for unit in units.values():
                unit.close()
        except (MasterError, UnitError) as refusal:
            return Answer(refused=str(refusal))
    told += [str(each.message) for each in heard if each.category.__module__[:7] == "impinge"]
    values = {"two": result["plate.centre.temperature"].values.tolist()}
    return Answer(whole.values | values, told[0] if told else "")


def error(answer: Answer, width: float, across: float) -> float:
    """Root mean square of the difference, over the rise."""
    pairs = list(zip(answer.values["two"], answer.values["centre.temperature"], strict=True))
    rise = max(one for _, one in pairs) - COLD
    return (sum((two - one) ** 2 for two, one in pairs) / len(pairs)) ** 0.5 / rise


def rings() -> Map:
    return Map(
        name="coupling_rings",
        title="Error in the middle where rings join a drop's unit to a plate's",
        x=Axis("width of a ring over the distance of particles", "1", WIDTHS),
        y=Axis("particles over the diameter", "1", ACROSS),
        outcome="relative error of the middle's rise (rms)",
        unit="1",
        bad=0.1,
        work=work,
        run=run,
        judge=error,
        colours=(0.003, 0.3),
    )
