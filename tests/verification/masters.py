"""Runs the two units of `robin_split.py` in a master of others, in a process of its own.

    masters.py '{"tool": …, "plate": …, "law": …, "step": …, "steps": …, "options": {…}}'

prints `rows [[time, temperature], …]` and `unit steps N`, the steps that the plate has taken.
"""

import ctypes
import json
import sys
import tempfile
from pathlib import Path

TEMPERATURE, FLUX = "centre.temperature", "patch.heat_flux[1,1]"


def libcosimpy(job):
    """libcosimpy: fixed steps, Jacobi, inputs held."""
    from libcosimpy.CosimExecution import CosimExecution
    from libcosimpy.CosimObserver import CosimObserver
    from libcosimpy.CosimSlave import CosimLocalSlave

    execution = CosimExecution.from_step_size(round(1e9 * job["step"]))
    names = {"plate": TEMPERATURE, "law": "y"}
    slaves, references = {}, {}
    for name in names:
        slave = CosimLocalSlave(fmu_path=job[name], instance_name=name)
        slaves[name] = execution.add_local_slave(slave)
        variables = execution.slave_variables(slaves[name])
        references[name] = {v.name.decode(): v.reference for v in variables}
    for one, other, target in (("plate", "law", "u"), ("law", "plate", FLUX)):
        source = references[one][names[one]]
        execution.connect_real_variables(
            slaves[one], source, slaves[other], references[other][target]
        )
    observer = CosimObserver.create_last_value()
    execution.add_observer(observer)
    rows = []
    for i in range(job["steps"]):
        assert execution.step()
        value = observer.last_real_values(slaves["plate"], [references["plate"][TEMPERATURE]])
        rows.append([(i + 1) * job["step"], value[0]])
    return rows, job["steps"]


def ecospy(job):
    """ecospy: fixed steps, inputs held."""
    ctypes.CDLL(str(Path(sys.prefix) / "lib/libtbb.so.12"), mode=ctypes.RTLD_GLOBAL)
    from ecospy import EcosSimulation, EcosSimulationStructure

    with EcosSimulationStructure() as structure:
        for name in ("plate", "law"):
            structure.add_model(name, job[name])
        structure.make_real_connection(f"plate::{TEMPERATURE}", "law::u")
        structure.make_real_connection("law::y", f"plate::{FLUX}")
        with EcosSimulation(job["step"], structure=structure) as simulation:
            assert simulation.init(0)
            rows = []
            for i in range(job["steps"]):
                simulation.step()
                value = simulation.get_real(f"plate::{TEMPERATURE}")
                rows.append([(i + 1) * job["step"], value])
            simulation.terminate()
    return rows, job["steps"]


def syssimx(job):
    """syssimx: Jacobi or Gauss-Seidel over generations, algebraic loops by its IJCSA.

    It begins with a step of length zero, which FMI 2.0 forbids and units refuse; that one is left
    out here.
    """
    from syssimx.components.fmu import FMUComponent
    from syssimx.system.algorithms import GaussSeidelAlgorithm, JacobiAlgorithm
    from syssimx.system.connection import Connection
    from syssimx.system.system import System

    class Component(FMUComponent):
        def _do_step_internal(self, t, dt):
            if dt > 0:
                super()._do_step_internal(t, dt)

    system = System("robin")
    for name in ("plate", "law"):
        system.add_component(Component(name, job[name]))
    system.add_connection(Connection("plate", TEMPERATURE, "law", "u"))
    system.add_connection(Connection("law", "y", "plate", FLUX))
    chosen = {"jacobi": JacobiAlgorithm, "gauss-seidel": GaussSeidelAlgorithm}
    system.set_algorithm(chosen[job["options"]["method"]]())
    system.initialize(0.0)
    end = job["step"] * job["steps"]
    system.run(0.0, end, job["step"])
    times, values = system.get_history()["plate"]
    told = zip(times, values[TEMPERATURE], strict=True)
    rows = [[float(t), float(getattr(v, "magnitude", v))] for t, v in told if t > 0]
    return rows, job["steps"]


def cofmupy(job):
    """CoFMUPy: Jacobi or Gauss-Seidel, iterated to 1e-3 in at most ten iterations if asked."""
    from cofmupy.coordinator import Coordinator

    def end(name, variable):
        return {"id": name, "variable": variable, "unit": ""}

    connections = [
        {"source": end("plate", TEMPERATURE), "target": end("law", "u")},
        {"source": end("law", "y"), "target": end("plate", FLUX)},
    ]
    config = {
        "root": str(Path(job["plate"]).parent),
        "edge_sep": " -> ",
        "cosim_method": job["options"]["method"].replace("-", "_"),
        "iterative": job["options"]["iterative"],
        "fmus": [{"id": n, "path": job[n], "initialization": {}} for n in ("plate", "law")],
        "connections": connections,
        "data_storages": [],
    }
    coordinator = Coordinator()
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "config.json"
        path.write_text(json.dumps(config))
        coordinator.start(str(path))
    handler = coordinator.master.fmu_handlers["plate"]
    step, count = handler.step, 0

    def counted(*arguments):
        nonlocal count
        count += 1
        return step(*arguments)

    handler.step = counted
    rows = []
    for i in range(job["steps"]):
        coordinator.do_step(job["step"])
        value = coordinator.master.get_outputs()["plate"][TEMPERATURE]
        rows.append([(i + 1) * job["step"], float(value[0])])
    return rows, count


if __name__ == "__main__":
    task = json.loads(sys.argv[1])
    found, taken = globals()[task["tool"]](task)
    print("rows", json.dumps(found))
    print("unit steps", taken)
