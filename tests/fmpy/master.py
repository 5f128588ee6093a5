"""`impinge.Unit` for tests of units of FMI 2.0: each value by a name of its own; whole runs."""

import impinge
import numpy as np


class Unit(impinge.Unit):
    """A unit with start values; `every_output` names outputs one by one, families too."""

    def __init__(self, file, start=None, stop_time=None):
        super().__init__(file, parameters=start, stop_time=stop_time)
        self.every_output = [
            v.name for v in self.package.description.modelVariables if v.causality == "output"
        ]

    def read(self, names):
        return self.get(names)

    def all_outputs(self):
        return self.get(self.every_output)

    def references(self, names):
        return np.concatenate([self.variable(name).references for name in names]).tolist()


def run(file, inputs=None, start=None, steps=(1e-5,) * 5):
    """All outputs by name after steps under held inputs."""
    with Unit(file, start) as unit:
        unit.set(inputs or {})
        for step in steps:
            unit.step(step)
        return dict(zip(unit.every_output, unit.all_outputs(), strict=True))
