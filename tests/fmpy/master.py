"""A small co-simulation master on top of FMPy, for tests that step units themselves."""

import shutil
from tempfile import mkdtemp

import numpy as np
from fmpy import calloc, extract, free, read_model_description
from fmpy.fmi2 import (
    FMU2Slave,
    fmi2CallbackAllocateMemoryTYPE,
    fmi2CallbackFreeMemoryTYPE,
    fmi2CallbackFunctions,
    fmi2CallbackLoggerTYPE,
)


class Unit:
    """One initialised instance of a unit; use it in a `with` statement."""

    def __init__(self, file, start=None, stop_time=None, folder=None):
        self._temporary = None if folder else mkdtemp()
        folder = folder or self._temporary
        extract(file, folder)
        description = read_model_description(file)
        self.variables = {variable.name: variable for variable in description.modelVariables}
        self.outputs = [v.name for v in description.modelVariables if v.causality == "output"]
        self.log = []
        # FMPy keeps no reference to these.
        self._callbacks = fmi2CallbackFunctions(
            logger=fmi2CallbackLoggerTYPE(self._hear),
            allocateMemory=fmi2CallbackAllocateMemoryTYPE(calloc),
            freeMemory=fmi2CallbackFreeMemoryTYPE(free),
        )
        self.slave = FMU2Slave(
            guid=description.guid,
            modelIdentifier=description.coSimulation.modelIdentifier,
            unzipDirectory=str(folder),
            instanceName="unit",
        )
        self.slave.instantiate(callbacks=self._callbacks, loggingOn=True)
        self.initialize(start, stop_time)

    def _hear(self, _environment, _instance, _status, _category, message):
        self.log.append(message.decode())

    def initialize(self, start=None, stop_time=None):
        self.time = 0.0
        self.slave.setupExperiment(startTime=0.0, stopTime=stop_time)
        for name, value in (start or {}).items():
            self[name] = value
        self.slave.enterInitializationMode()
        self.slave.exitInitializationMode()

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.slave.terminate()
        self.slave.freeInstance()
        if self._temporary:
            shutil.rmtree(self._temporary)

    def __getitem__(self, name):
        return self.read([name])[0]

    def __setitem__(self, name, value):
        variable = self.variables[name]
        reference = [variable.valueReference]
        match variable.type:
            case "Real":
                self.slave.setReal(reference, [value])
            case "Integer":
                self.slave.setInteger(reference, [value])
            case "String":
                self.slave.setString(reference, [value])

    def set(self, values):
        for name, value in values.items():
            self[name] = value

    def read(self, names):
        return self.slave.getReal(self.references(names))

    def references(self, names):
        return [self.variables[name].valueReference for name in names]

    def all_outputs(self):
        return np.array(self.read(self.outputs))

    def step(self, size):
        self.slave.doStep(self.time, size)
        self.time += size


def run(file, inputs=None, start=None, steps=(1e-5,) * 5):
    """All outputs by name after steps under held inputs."""
    with Unit(file, start) as unit:
        unit.set(inputs or {})
        for step in steps:
            unit.step(step)
        return dict(zip(unit.outputs, unit.all_outputs(), strict=True))
