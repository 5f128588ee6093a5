"""A PI controller as a unit: `pythonfmu build -f controller.py`."""

from pythonfmu import Fmi2Causality, Fmi2Slave, Fmi2Variability, Real


class Controller(Fmi2Slave):
    """Power [W] = integral + gain · (wanted − measured), between 0 and `highest`, held over a step.

    The integral stands still while the power is at a limit and the error asks for more of it.
    """

    description = "PI controller of a heater, saturated, without wind-up"

    def __init__(self, **kwargs):
        super().__init__(**kwargs)
        self.gain, self.integral_time, self.highest = 1.0, 10.0, 100.0  # W/K, s, W
        self.wanted = self.measured = 298.15  # K
        self.power = self.integral = 0.0  # W
        fixed = {"causality": Fmi2Causality.parameter, "variability": Fmi2Variability.fixed}
        for name in ("gain", "integral_time", "highest"):
            self.register_variable(Real(name, **fixed))
        for name in ("wanted", "measured"):
            self.register_variable(Real(name, causality=Fmi2Causality.input))
        self.register_variable(Real("power", causality=Fmi2Causality.output))

    def do_step(self, current_time, step_size):
        error = self.wanted - self.measured
        asked = self.integral + self.gain * error
        self.power = min(max(asked, 0.0), self.highest)
        if self.power == asked or (asked - self.power) * error < 0.0:
            self.integral += self.gain * error * step_size / self.integral_time
        return True
