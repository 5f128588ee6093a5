"""The schedule of a printer as a unit: `pythonfmu build -f schedule.py`."""

from math import floor

from pythonfmu import Fmi2Causality, Fmi2Slave, Fmi2Variability, Integer, Real


class Schedule(Fmi2Slave):
    """Counts drops up, one every `interval` from `start` on, and moves along a line between them.

    Outputs are those of the end of a step: a master gives counts to the printer at the beginning
    of its next one. Drops are at least two steps apart, as places go ahead of counts by one.
    """

    description = "When and where drops fall: a count, and the place of the last one"

    def __init__(self, **kwargs):
        super().__init__(**kwargs)
        self.start, self.interval = 0.0, 1.0  # s
        self.first, self.pitch = 0.0, 0.0  # m, place of the first drop and way to the next
        self.count, self.release, self.x = 1, 0, 0.0
        fixed = {"causality": Fmi2Causality.parameter, "variability": Fmi2Variability.fixed}
        for name in ("start", "interval", "first", "pitch"):
            self.register_variable(Real(name, **fixed))
        self.register_variable(Integer("count", **fixed))
        told = {"causality": Fmi2Causality.output, "variability": Fmi2Variability.discrete}
        self.register_variable(Integer("release", **told))
        self.register_variable(Real("x", causality=Fmi2Causality.output))

    def exit_initialization_mode(self):
        self._look(0.0)

    def do_step(self, current_time, step_size):
        self._look(current_time + step_size)
        return True

    def _look(self, time):
        due = floor((time - self.start) / self.interval + 1e-6) + 1
        self.release = min(max(due, 0), self.count)
        self.x = self.first + self.pitch * max(self.release - 1, 0)
