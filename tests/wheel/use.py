"""Uses the package after `pip install impinge-….whl matplotlib`, in a folder with a scene."""

import sys
import time
from pathlib import Path

import fmpy
import matplotlib
import numpy as np

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402  # needs the choice above
from impinge import Master, Unit  # noqa: E402

ROOM = 293.15
HEATER = {"heater.heat_flux": 7e3}


def run_and_plot():
    outputs = ["rim.temperature", "thermocouple.temperature"]
    result = fmpy.simulate_fmu("unit.fmu", start_values=HEATER, output=outputs)
    assert result["rim.temperature"][-1] > ROOM + 10.0
    for name in outputs:
        plt.plot(result["time"], result[name], label=name)
    plt.xlabel("time [s]")
    plt.ylabel("temperature [K]")
    plt.legend()
    plt.savefig("picture.png")
    assert Path("picture.png").read_bytes().startswith(b"\x89PNG")
    with Unit("scene.toml") as unit:  # packed by the program of the wheel
        unit.set(HEATER)
        while unit.time < unit.default_stop:
            unit.step(unit.default_step)
        assert np.isclose(unit["rim.temperature"], result["rim.temperature"][-1], rtol=1e-9)


def couple():
    connections = [
        ("drop.wall.heat_flux", "plate.drop.heat_flux"),
        ("plate.face.temperature", "drop.wall.temperature"),
    ]
    units = {"drop": "drop.toml", "plate": "plate.toml"}
    with Master(units, connections, outputs=["plate.face.temperature"], step=1e-6) as master:
        result = master.run(1e-5)
    assert result["plate.face.temperature"].max() > 400.0


def study():
    from impinge import Study
    from impinge.study import Grid, maximum

    parameters = {"heater.heat_flux": [3e3, 9e3]}
    outputs = ["rim.temperature", maximum("bed.max_temperature")]
    grid = Grid(levels=2)
    study = Study("scene.toml", parameters, outputs=outputs, stop=600.0, step=600.0, sampler=grid)
    table = study.run(processes=2, folder="study")
    low, high = table["rim.temperature"].values.ravel()
    assert high - ROOM > 2.0 * (low - ROOM)


def refuse_studies():
    try:
        from impinge import Study  # noqa: F401
    except ImportError as refusal:
        assert "studies need Linux or macOS" in str(refusal)
    else:
        raise AssertionError("studies are not refused")


if __name__ == "__main__":
    last = refuse_studies if sys.platform == "win32" else study
    for task in (run_and_plot, couple, last):
        begun = time.perf_counter()
        task()
        print(f"{task.__name__}: {time.perf_counter() - begun:.1f} s")
