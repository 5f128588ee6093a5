"""A motion planner and the machine that follows it as a unit: `pythonfmu build -f planner.py`."""

from bisect import bisect_right
from math import cos, exp, hypot, pi, sin, sqrt

from pythonfmu import Fmi2Causality, Fmi2Slave, Fmi2Variability, Real

# The drawing [m]: corners of 90°, 45° and 45°.
DRAWING = [(0.0, 0.0), (20e-3, 0.0), (20e-3, 12e-3), (30e-3, 22e-3), (40e-3, 22e-3)]
HEIGHT = 0.2e-3  # m, of the outlet


class Motion:
    """Motion along a drawing with trapezoids of speed, from rest to rest.

    A corner is passed at v² = v_c² (√2 − 1) s/(1 − s), with the sine s of half of the angle between
    both legs (rule of the junction deviation). `kinks` are the times [s] at which velocities [m/s]
    and accelerations [m/s²] jump, with these jumps along x and y.
    """

    def __init__(self, drawing, speed, acceleration, corner_speed):
        self.start = drawing[0]
        self.kinks = []
        self.end = 0.0
        self._velocity = self._acceleration = (0.0, 0.0)
        ways = [(b[0] - a[0], b[1] - a[1]) for a, b in zip(drawing, drawing[1:], strict=False)]
        lengths = [hypot(*way) for way in ways]
        along = [(x / length, y / length) for (x, y), length in zip(ways, lengths, strict=True)]
        speeds = _passed(along, lengths, speed, acceleration, corner_speed)
        for n, length in enumerate(lengths):
            begins, ends = speeds[n], speeds[n + 1]
            most = min(speed, sqrt(acceleration * length + 0.5 * (begins**2 + ends**2)))
            slowing = 0.5 * (2 * most**2 - begins**2 - ends**2) / acceleration  # m
            self._add(along[n], begins, acceleration, (most - begins) / acceleration)
            self._add(along[n], most, 0.0, (length - slowing) / most)
            self._add(along[n], most, -acceleration, (most - ends) / acceleration)
        self._jump((0.0, 0.0), (0.0, 0.0))
        self.times = [time for time, _, _ in self.kinks]

    def _add(self, along, speed, acceleration, duration):
        """A part of constant acceleration."""
        if duration <= 1e-12:
            return
        velocity = tuple(speed * part for part in along)
        rate = tuple(acceleration * part for part in along)
        self._jump(velocity, rate)
        self._velocity = tuple(v + a * duration for v, a in zip(velocity, rate, strict=True))
        self._acceleration = rate
        self.end += duration

    def _jump(self, velocity, acceleration):
        jumps = [
            tuple(new - old for new, old in zip(*pair, strict=True))
            for pair in ((velocity, self._velocity), (acceleration, self._acceleration))
        ]
        self.kinks.append((self.end, *jumps))

    def at(self, time):
        """Place [m] and velocity [m/s] of the planner."""
        place, velocity = list(self.start), [0.0, 0.0]
        for kink, jump, bend in self.kinks[: bisect_right(self.times, time)]:
            since = time - kink
            for axis in range(2):
                place[axis] += jump[axis] * since + 0.5 * bend[axis] * since**2
                velocity[axis] += jump[axis] + bend[axis] * since
        return place, velocity

    def ringing(self, time, frequency, damping):
        """Distance of both axes from the planner's place [m].

        Each is a mass on a spring and a damper, e″ + 2ζω e′ + ω² e = −c″ with the place c of the
        planner: −Δv exp(−ζωτ) sin(ω_d τ)/ω_d follows a jump of the velocity, and
        −Δa/ω² (1 − exp(−ζωτ) (cos ω_d τ + ζω/ω_d sin ω_d τ)) one of the acceleration.
        """
        undamped = 2 * pi * frequency
        decay, swing = damping * undamped, undamped * sqrt(1 - damping**2)
        off = [0.0, 0.0]
        for kink, jump, bend in self.kinks[: bisect_right(self.times, time)]:
            since = time - kink
            faded = exp(-decay * since)
            wave = faded * sin(swing * since) / swing
            rest = (1 - faded * cos(swing * since) - decay * wave) / undamped**2
            for axis in range(2):
                off[axis] -= jump[axis] * wave + bend[axis] * rest
        return off


def _passed(along, lengths, speed, acceleration, corner_speed):
    """Speeds [m/s] at the beginning, at all corners and at the end."""
    speeds = [0.0]
    for a, b in zip(along, along[1:], strict=False):
        sine = sqrt(max(0.0, 0.5 * (1 + a[0] * b[0] + a[1] * b[1])))
        most = corner_speed * sqrt((sqrt(2) - 1) * sine / max(1 - sine, 1e-15))
        speeds.append(min(speed, most))
    speeds.append(0.0)
    for n, length in enumerate(lengths):
        speeds[n + 1] = min(speeds[n + 1], sqrt(speeds[n] ** 2 + 2 * acceleration * length))
    for n, length in reversed(list(enumerate(lengths))):
        speeds[n] = min(speeds[n], sqrt(speeds[n + 1] ** 2 + 2 * acceleration * length))
    return speeds


def shaper(frequency, damping):
    """Two impulses that leave an axis at rest, as parts and delays [s]: the second one comes half a
    period later (N. C. Singer & W. P. Seering 1990, doi 10.1115/1.2894142)."""
    root = sqrt(1 - damping**2)
    second = exp(-pi * damping / root)
    return [(1 / (1 + second), 0.0), (second / (1 + second), 0.5 / (frequency * root))]


class Planner(Fmi2Slave):
    """Place of a nozzle over time along the drawing, and the flow that follows its planned speed.

    `frequency` is that of the axes, 0 of a stiff machine. With `shaped` above 0 the planner mixes
    its motion with a later one, so that the axes do not ring. Outputs are those of the end of a
    step.
    """

    description = "Motion of a nozzle along a drawing, by a machine whose axes ring"

    def __init__(self, **kwargs):
        super().__init__(**kwargs)
        self.speed, self.acceleration, self.corner_speed = 0.1, 5.0, 8e-3  # m/s, m/s², m/s
        self.frequency, self.damping, self.shaped = 0.0, 0.05, 0.0  # Hz
        self.section = 0.088e-6  # m², of the strand
        fixed = {"causality": Fmi2Causality.parameter, "variability": Fmi2Variability.fixed}
        names = ["speed", "acceleration", "corner_speed", "frequency", "damping", "shaped"]
        for name in [*names, "section"]:
            self.register_variable(Real(name, **fixed))
        (self.x, self.y), self.z, self.flow = DRAWING[0], HEIGHT, 0.0
        for name in ("x", "y", "z", "flow"):
            self.register_variable(Real(name, causality=Fmi2Causality.output))

    def exit_initialization_mode(self):
        self.motion = Motion(DRAWING, self.speed, self.acceleration, self.corner_speed)
        is_shaped = self.frequency > 0.0 and self.shaped > 0.0
        self.impulses = shaper(self.frequency, self.damping) if is_shaped else [(1.0, 0.0)]
        self._look(0.0)

    def do_step(self, current_time, step_size):
        self._look(current_time + step_size)
        return True

    def _look(self, time):
        place, velocity = [0.0, 0.0], [0.0, 0.0]
        for part, delay in self.impulses:
            told, speeds = self.motion.at(time - delay)
            off = [0.0, 0.0]
            if self.frequency > 0.0:
                off = self.motion.ringing(time - delay, self.frequency, self.damping)
            for axis in range(2):
                place[axis] += part * (told[axis] + off[axis])
                velocity[axis] += part * speeds[axis]
        self.x, self.y = place
        self.flow = self.section * hypot(*velocity)
