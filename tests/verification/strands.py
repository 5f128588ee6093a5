"""Heat that strands give to a plate, in impinge and by an enthalpy method in their section.

A strand of 0.7 mm × 0.6 mm is laid along 16 mm within 20 ms on a plate of 1 mm, and cools there.
Exit code 1 if heat differs by more than 4 % from half a second on, frozen parts by more than 0.03,
or if the plate becomes warmer than the strand was.
"""

import sys
from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
from impinge import Unit

WIDTH, HEIGHT, LENGTH, THICKNESS = 0.7e-3, 0.6e-3, 16e-3, 1e-3  # m
LAID, STEP, COLD = 0.02, 0.1, 293.15  # s, s and K
HALF = 6e-3  # m of plate beside the middle of the strand, in the section
OUTLET = (4 * WIDTH * HEIGHT / np.pi) ** 0.5  # m: a nozzle as wide as the strand
LIMIT, OF_FROZEN, SETTLED = 4.0, 0.03, 0.5  # percent, 1 and s


@dataclass(frozen=True)
class Fluid:
    """A fluid; specific heats and conductivities are those of the molten and of the frozen one."""

    density: float
    heats: tuple[float, float]
    conductivities: tuple[float, float]
    melting: tuple[float, float] | None = None
    latent: float = 0.0

    def toml(self) -> str:
        text = f"density = {self.density}, viscosity = 1e3, specific_heat = {self.heats[0]}, "
        text += f"conductivity = {self.conductivities[0]}"
        if self.melting:
            solidus, liquidus = self.melting
            text += f", melting = {{ solidus = {solidus}, liquidus = {liquidus}, "
            text += f"latent_heat = {self.latent} }}, frozen = {{ specific_heat = "
            text += f"{self.heats[1]}, conductivity = {self.conductivities[1]} }}"
        return text

    def state(self, enthalpy: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Temperature and frozen part at an enthalpy above the solidus [J/kg]."""
        solidus, liquidus = self.melting or (0.0, 1e-9)
        melts = self.latent + 0.5 * sum(self.heats) * (liquidus - solidus)
        molten = liquidus + (enthalpy - melts) / self.heats[0]
        cold = solidus + enthalpy / self.heats[1]
        between = solidus + (liquidus - solidus) * enthalpy / melts
        warm = np.where(enthalpy >= melts, molten, np.where(enthalpy <= 0, cold, between))
        return warm, np.clip(1 - enthalpy / melts, 0, 1)

    def enthalpy(self, temperature: float) -> float:
        """Enthalpy of the molten fluid above the solidus [J/kg]."""
        solidus, liquidus = self.melting or (0.0, 1e-9)
        melts = self.latent + 0.5 * sum(self.heats) * (liquidus - solidus)
        return melts + self.heats[0] * (temperature - liquidus)


@dataclass(frozen=True)
class Case:
    """A strand on a plate: temperatures in K, the plate's density, specific heat, conductivity."""

    fluid: Fluid
    hot: float
    plate: tuple[float, float, float]
    cell: float  # m
    times: tuple[float, ...]  # s


WAX = Fluid(780.0, (2200.0, 1900.0), (0.15, 0.3), (309.0, 310.0), 247e3)
PASTE = Fluid(1050.0, (1500.0, 1500.0), (0.25, 0.25))
SOLDER = Fluid(7200.0, (240.0, 230.0), (30.0, 58.0), (490.0, 493.0), 59e3)
CASES = {
    "wax on glass": Case(WAX, 343.0, (2500.0, 800.0, 1.0), 25e-6, (0.1, 0.5, 2.0, 4.0)),
    "wax on copper": Case(WAX, 343.0, (8960.0, 385.0, 400.0), 50e-6, (0.1, 0.5)),
    "paste on steel": Case(PASTE, 360.0, (7900.0, 480.0, 15.0), 25e-6, (0.1, 0.5, 2.0, 4.0)),
    "solder on FR4": Case(SOLDER, 520.0, (1850.0, 1100.0, 0.35), 50e-6, (0.1, 0.5, 2.0)),
}


def by_section(case: Case) -> np.ndarray:
    """Heat per length [J/m] and frozen part at each time, in half of the section."""
    fluid, (density, heat, conducts), dx = case.fluid, case.plate, case.cell
    plate = np.full((round(HALF / dx), round(THICKNESS / dx)), COLD)
    strand = np.full((round(0.5 * WIDTH / dx), round(HEIGHT / dx)), fluid.enthalpy(case.hot))
    across = len(strand)
    liquid = fluid.conductivities[0] / (fluid.density * fluid.heats[0])
    frozen = fluid.conductivities[1] / (fluid.density * fluid.heats[1])
    most = 0.2 * dx**2 / max(conducts / (density * heat), liquid, frozen)
    time, given, rows = 0.0, 0.0, []
    for end in case.times:
        count = int(np.ceil((end - time) / most))
        dt = (end - time) / count
        for _ in range(count):
            warm, part = fluid.state(strand)
            k = fluid.conductivities[0] + part * np.subtract(*fluid.conductivities[::-1])
            down = (warm[:, 0] - plate[:across, 0]) / (0.5 / k[:, 0] + 0.5 / conducts)
            gain = divergence(warm, k)
            gain[:, 0] -= down
            into = divergence(plate, np.full_like(plate, conducts))
            into[:across, 0] += down
            strand += dt * gain / (fluid.density * dx**2)
            plate += dt * into / (density * heat * dx**2)
            given += 2 * dt * down.sum()
        time = end
        rows.append([given, fluid.state(strand)[1].mean()])
    return np.array(rows)


def divergence(warm: np.ndarray, k: np.ndarray) -> np.ndarray:
    """Heat that conduction brings to each cell per length and time [W/m]."""
    gain = np.zeros_like(warm)
    for axis in (0, 1):
        w, c, g = (np.moveaxis(of, axis, 0) for of in (warm, k, gain))
        flow = 2 * c[1:] * c[:-1] / (c[1:] + c[:-1]) * (w[1:] - w[:-1])
        g[:-1] += flow
        g[1:] -= flow
    return gain


def by_impinge(case: Case) -> tuple[np.ndarray, float]:
    """The same of a unit, and the highest temperature of its plate [K]."""
    flow = WIDTH * HEIGHT * LENGTH / LAID
    density, heat, conducts = case.plate
    text = f"""
name = "Strand"
stop_time = {case.times[-1] + STEP}
step = {STEP}
[body.ink]
kind = "filament"
fluid = {{ {case.fluid.toml()} }}
nozzle = {{ diameter = {OUTLET}, height = {HEIGHT}, temperature = {case.hot}, flow = {flow} }}
path = {{ time = [0.0, {LAID}], x = [{-0.5 * LENGTH}, {0.5 * LENGTH}], y = [0.0, 0.0] }}
most = {flow * (case.times[-1] + 2 * STEP)}
gravity = 0.0
[body.plate]
kind = "solid"
shape = {{ box = [24e-3, 12e-3, {THICKNESS}] }}
initial_temperature = {COLD}
[body.plate.material]
model = "thermoelastic"
density = {density}
specific_heat = {heat}
conductivity = {conducts}
[[coupling]]
from = "ink"
to = "plate.top"
traction = false
"""
    rows, hottest = [], 0.0
    with TemporaryDirectory() as folder:
        scene = Path(folder, "strand.toml")
        scene.write_text(text)
        with Unit(scene) as unit:
            unit.step(LAID)
            unit["ink.flow"] = 0.0
            for time in case.times:
                # Sections have been on the plate for half of the time of laying, as a mean.
                end = time + 0.5 * LAID
                count = max(1, round((end - unit.time) / STEP))
                size = (end - unit.time) / count
                for _ in range(count):
                    unit.step(size)
                    hottest = max(hottest, unit["plate.max_temperature"])
                part = unit["ink.solid_fraction"] if case.fluid.melting else 0.0
                rows.append([unit["ink.heat"] / LENGTH, part])
    return np.array(rows), hottest


def main() -> int:
    bad = 0
    for name, case in CASES.items():
        ours, hottest = by_impinge(case)
        exact = by_section(case)
        off = 100 * (ours[:, 0] / exact[:, 0] - 1)
        apart = abs(ours[:, 1] - exact[:, 1])
        settled = np.array(case.times) >= SETTLED
        for row in zip(case.times, off, ours[:, 1], exact[:, 1], strict=True):
            time, heat, *parts = row
            frozen = " ".join(f"{part:.4f}" for part in parts)
            print(f"{name:15} {time:4.1f} s  heat {heat:+6.2f} %  frozen {frozen}")
        print(f"{name:15} plate at most {hottest:.1f} K below a strand of {case.hot:.0f} K")
        fine = (abs(off[settled]) <= LIMIT).all() and (apart[settled] <= OF_FROZEN).all()
        bad += not (fine and hottest <= case.hot)
    return int(bad > 0)


if __name__ == "__main__":
    sys.exit(main())
