//! Fluid that freezes on a wall across a contact that resists: a numerical oracle in one dimension.
//!
//! The enthalpy per volume H of each cell changes by the fluxes through its faces. The temperature T follows from it:
//! `H = C_s (T − T_s)` below the solidus T_s, `H = Λ + C_l (T − T_l)` above the liquidus T_l, linear between them,
//! with the volumetric heat capacities C [J/(m³ K)] of the phases and `Λ = ρL + ½(C_s + C_l)(T_l − T_s)`. Between
//! wall and fluid the flux is `h_c` times the difference of their surface temperatures. Both outer faces are
//! insulated: a body thicker than some `6√(at)` is a half space.
//!
//! Each implicit Euler step is solved by Newton's method on the enthalpies. Cells grow with the distance from the
//! contact, steps in proportion to the root of the time. Doubling both numbers halves the error, which is of first
//! order, and the sum of all enthalpies is constant to rounding.
//!
//! Valid for fluid at rest whose phases have one density, and without undercooling: the fluid is frozen below the
//! solidus whatever its history.
//!
//! Source: V. R. Voller and M. Cross (1981), Int. J. Heat Mass Transfer 24, 545–556, doi 10.1016/0017-9310(81)90062-4,
//! for the enthalpy method and its front from the latent heat.

use super::freezing_contact::FreezingContact;
use super::medium::Conductor;
use super::tridiagonal;

/// Largest number of Newton's iterations of a step.
const MOST_ITERATIONS: usize = 200;
/// Change of a temperature at which iterations end [K].
const TOLERANCE: f64 = 1e-10;
/// Width of the last cell of a body over that of its first.
const GRADING: f64 = 40.0;

/// Wall and fluid, and the grid.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FreezingColumn {
    /// The bodies, their temperatures at first, and the liquidus T_l as `melts_at`.
    pub bodies: FreezingContact,
    /// Solidus T_s [K]: the liquidus, or below it.
    pub solidus: f64,
    /// Conductance of the contact h_c [W/(m² K)], infinite for perfect contact.
    pub conductance: f64,
    /// Thicknesses of wall and fluid [m].
    pub wall_thickness: f64,
    pub fluid_thickness: f64,
    /// Number of cells of each body.
    pub cells: usize,
}

/// State of the column at a time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Frozen {
    /// Time [s].
    pub time: f64,
    /// Thickness of the frozen layer [m], a partly frozen cell by its part.
    pub front: f64,
    /// Surface temperature of the wall [K].
    pub wall_surface: f64,
    /// Temperature of the fluid's lower surface [K].
    pub fluid_surface: f64,
    /// Flux into the wall, mean over the last step [W/m²].
    pub flux: f64,
    /// Heat that the wall has received [J/m²].
    pub heat: f64,
}

/// Piecewise linear relation of temperature and enthalpy.
struct Phases {
    capacities: [f64; 2],
    solidus: f64,
    liquidus: f64,
    /// Enthalpy of the liquidus over that of the solidus [J/m³].
    change: f64,
}

impl Phases {
    fn temperature(&self, enthalpy: f64) -> f64 {
        match enthalpy {
            h if h <= 0.0 => self.solidus + h / self.capacities[0],
            h if h >= self.change => self.liquidus + (h - self.change) / self.capacities[1],
            h => self.solidus + (self.liquidus - self.solidus) * h / self.change,
        }
    }

    /// dT/dH
    fn slope(&self, enthalpy: f64) -> f64 {
        match enthalpy {
            h if h < 0.0 => 1.0 / self.capacities[0],
            h if h > self.change => 1.0 / self.capacities[1],
            _ => (self.liquidus - self.solidus) / self.change,
        }
    }

    fn enthalpy(&self, temperature: f64) -> f64 {
        if temperature < self.solidus {
            return self.capacities[0] * (temperature - self.solidus);
        }
        if temperature >= self.liquidus {
            return self.change + self.capacities[1] * (temperature - self.liquidus);
        }
        self.change * (temperature - self.solidus) / (self.liquidus - self.solidus)
    }

    fn molten_fraction(&self, enthalpy: f64) -> f64 {
        (enthalpy / self.change).clamp(0.0, 1.0)
    }
}

/// Cells from the back of the wall, across the contact, to the top of the fluid.
struct Cells<'a> {
    column: &'a FreezingColumn,
    fluid: Phases,
    widths: Vec<f64>,
    /// Enthalpies per volume [J/m³]; those of the wall are relative to 0 K.
    enthalpies: Vec<f64>,
    /// Heat that the wall has received [J/m²].
    heat: f64,
}

impl FreezingColumn {
    /// States after each of a number of steps up to a time [s]. The n-th of N steps ends at `(n/N)²` of it.
    ///
    /// # Panics
    /// If Newton's iterations do not converge.
    pub fn run(&self, end: f64, steps: usize) -> Vec<Frozen> {
        let mut cells = Cells::new(self);
        let time = |n: usize| end * (n as f64 / steps as f64).powi(2);
        (1..=steps).map(|n| cells.step(time(n - 1), time(n))).collect()
    }
}

impl<'a> Cells<'a> {
    fn new(column: &'a FreezingColumn) -> Self {
        let bodies = column.bodies;
        let [solid, liquid] = [bodies.frozen, bodies.molten].map(|body| body.heat_capacity);
        let (solidus, liquidus) = (column.solidus, bodies.melts_at);
        let change = bodies.latent + 0.5 * (solid + liquid) * (liquidus - solidus);
        let fluid = Phases { capacities: [solid, liquid], solidus, liquidus, change };
        let count = column.cells;
        let mut widths = graded(column.wall_thickness, count);
        widths.reverse();
        widths.extend(graded(column.fluid_thickness, count));
        let wall = bodies.wall.heat_capacity * bodies.wall_temperature;
        let mut enthalpies = vec![wall; count];
        enthalpies.resize(2 * count, fluid.enthalpy(bodies.fluid_temperature));
        Self { column, fluid, widths, enthalpies, heat: 0.0 }
    }

    fn is_wall(&self, cell: usize) -> bool {
        cell < self.column.cells
    }

    fn temperature(&self, cell: usize, enthalpy: f64) -> f64 {
        match self.is_wall(cell) {
            true => enthalpy / self.column.bodies.wall.heat_capacity,
            false => self.fluid.temperature(enthalpy),
        }
    }

    fn slope(&self, cell: usize, enthalpy: f64) -> f64 {
        match self.is_wall(cell) {
            true => 1.0 / self.column.bodies.wall.heat_capacity,
            false => self.fluid.slope(enthalpy),
        }
    }

    /// Resistance of half a cell [m² K/W], of both phases in series.
    fn half_resistance(&self, cell: usize) -> f64 {
        let FreezingContact { wall, frozen, molten, .. } = self.column.bodies;
        let resistivity = |body: Conductor| 1.0 / body.conductivity;
        let mean = if self.is_wall(cell) {
            resistivity(wall)
        } else {
            let part = self.fluid.molten_fraction(self.enthalpies[cell]);
            part * resistivity(molten) + (1.0 - part) * resistivity(frozen)
        };
        0.5 * self.widths[cell] * mean
    }

    /// Conductances between each cell and the next [W/(m² K)], for the phases before the step.
    fn conductances(&self) -> Vec<f64> {
        let halves: Vec<f64> = (0..self.widths.len()).map(|n| self.half_resistance(n)).collect();
        let contact = |n: usize| {
            if n + 1 == self.column.cells { 1.0 / self.column.conductance } else { 0.0 }
        };
        (0..halves.len() - 1).map(|n| 1.0 / (halves[n] + contact(n) + halves[n + 1])).collect()
    }

    fn step(&mut self, from: f64, to: f64) -> Frozen {
        let step = to - from;
        let conductances = self.conductances();
        let next = self.solve(step, &conductances);
        let (below, above) = (self.column.cells - 1, self.column.cells);
        let ends = [below, above].map(|n| self.temperature(n, next[n]));
        let flux = conductances[below] * (ends[1] - ends[0]);
        let wall_surface = ends[0] + flux * self.half_resistance(below);
        let fluid_surface = ends[1] - flux * self.half_resistance(above);
        self.enthalpies = next;
        self.heat += step * flux;
        Frozen { time: to, front: self.front(), wall_surface, fluid_surface, flux, heat: self.heat }
    }

    fn front(&self) -> f64 {
        let frozen = |n: usize| 1.0 - self.fluid.molten_fraction(self.enthalpies[n]);
        (self.column.cells..self.widths.len()).map(|n| self.widths[n] * frozen(n)).sum()
    }

    /// Enthalpies after an implicit step.
    fn solve(&self, step: f64, conductances: &[f64]) -> Vec<f64> {
        let mut enthalpies = self.enthalpies.clone();
        for _ in 0..MOST_ITERATIONS {
            let changes = self.newton_changes(step, conductances, &enthalpies);
            let mut largest: f64 = 0.0;
            for (n, enthalpy) in enthalpies.iter_mut().enumerate() {
                let moved = self.stop_at_phase(n, *enthalpy, *enthalpy + changes[n]);
                largest = largest.max((moved - *enthalpy).abs() / self.capacity(n));
                *enthalpy = moved;
            }
            if largest < TOLERANCE {
                return enthalpies;
            }
        }
        panic!("Newton's iterations do not converge in a step of {step} s");
    }

    /// Newton's changes of the enthalpies: the tridiagonal system of the linearised balances of all cells.
    fn newton_changes(&self, step: f64, conductances: &[f64], enthalpies: &[f64]) -> Vec<f64> {
        let count = self.widths.len();
        let each = |f: fn(&Self, usize, f64) -> f64| -> Vec<f64> {
            (0..count).map(|n| f(self, n, enthalpies[n])).collect()
        };
        let [temperatures, slopes] = [each(Self::temperature), each(Self::slope)];
        let (mut lower, mut upper) = (vec![0.0; count], vec![0.0; count]);
        let mut diagonal = vec![1.0; count];
        let mut right: Vec<f64> = (0..count).map(|n| self.enthalpies[n] - enthalpies[n]).collect();
        for (face, conductance) in conductances.iter().enumerate() {
            let (below, above) = (face, face + 1);
            let [to_below, to_above] =
                [below, above].map(|cell| step * conductance / self.widths[cell]);
            let difference = temperatures[above] - temperatures[below];
            right[below] += to_below * difference;
            right[above] -= to_above * difference;
            diagonal[below] += to_below * slopes[below];
            diagonal[above] += to_above * slopes[above];
            upper[below] = -to_below * slopes[above];
            lower[above] = -to_above * slopes[below];
        }
        tridiagonal::solve(&lower, &diagonal, &upper, &right)
    }

    /// Heat capacity per volume that converts changes of enthalpy to those of temperature.
    fn capacity(&self, cell: usize) -> f64 {
        let bodies = self.column.bodies;
        if self.is_wall(cell) { bodies.wall.heat_capacity } else { bodies.frozen.heat_capacity }
    }

    /// A new enthalpy, stopped just past the edge of the phase that the old one lies in.
    fn stop_at_phase(&self, cell: usize, old: f64, new: f64) -> f64 {
        if self.is_wall(cell) {
            return new;
        }
        let nudge = 1e-9 * self.fluid.change;
        for edge in [0.0, self.fluid.change] {
            if old < edge - nudge && new > edge + nudge {
                return edge + nudge;
            }
            if old > edge + nudge && new < edge - nudge {
                return edge - nudge;
            }
        }
        new
    }
}

/// Widths of cells in geometric progression, from the contact.
fn graded(thickness: f64, count: usize) -> Vec<f64> {
    let ratio = GRADING.powf(1.0 / (count.max(2) - 1) as f64);
    let parts: Vec<f64> = (0..count).map(|n| ratio.powi(n as i32)).collect();
    let sum: f64 = parts.iter().sum();
    parts.iter().map(|part| thickness * part / sum).collect()
}

#[cfg(test)]
mod tests {
    use super::super::checks::{TIN_ON_STEEL, assert_close, assert_within};
    use super::super::contact::Contact;
    use super::super::resistive_contact::ResistiveContact;
    use super::*;

    const END: f64 = 1e-3;

    fn column(conductance: f64, fluid_temperature: f64, cells: usize) -> FreezingColumn {
        FreezingColumn {
            bodies: FreezingContact { fluid_temperature, ..TIN_ON_STEEL },
            solidus: TIN_ON_STEEL.melts_at,
            conductance,
            wall_thickness: 6.0 * TIN_ON_STEEL.wall.diffusion_length(END),
            fluid_thickness: 6.0 * TIN_ON_STEEL.frozen.diffusion_length(END),
            cells,
        }
    }

    fn last(column: FreezingColumn, steps: usize) -> Frozen {
        *column.run(END, steps).last().unwrap()
    }

    #[test]
    fn perfect_contact_is_the_closed_form() {
        for (wall_temperature, fluid_temperature) in
            [(298.15, 505.0), (298.15, 513.0), (423.15, 505.0), (423.15, 513.0)]
        {
            let mut column = column(f64::INFINITY, fluid_temperature, 400);
            column.bodies.wall_temperature = wall_temperature;
            let (state, exact) = (last(column, 400), column.bodies);
            assert_close(state.front, exact.front(END), 4e-3);
            assert_close(state.flux, exact.flux(END), 4e-3);
            assert_close(state.heat, 2.0 * END * exact.flux(END), 2e-3);
            assert_within(state.wall_surface, exact.temperature_of_contact(), 0.1);
            assert_close(state.wall_surface, state.fluid_surface, 1e-12);
        }
    }

    #[test]
    fn errors_are_of_first_order_with_and_without_resistance() {
        let exact = column(f64::INFINITY, 513.0, 1).bodies;
        let state = |conductance, n| last(column(conductance, 513.0, n), n);
        let perfect = [100, 200, 400].map(|n| state(f64::INFINITY, n));
        let errors = perfect.map(|state| 1.0 - state.heat / (2.0 * END * exact.flux(END)));
        for pair in errors.windows(2) {
            assert!((1.9..2.2).contains(&(pair[0] / pair[1])), "{errors:?}");
        }
        let fronts = perfect.map(|state| 1.0 - state.front / exact.front(END));
        assert!(fronts[0] > 3.0 * fronts[2] && fronts[2] > 0.0, "{fronts:?}");
        let resisting = [100, 200, 400].map(|n| state(1e5, n).heat);
        let ratio = (resisting[1] - resisting[0]) / (resisting[2] - resisting[1]);
        assert!((1.8..2.3).contains(&ratio), "{ratio}");
    }

    #[test]
    fn front_tends_to_that_of_perfect_contact_as_the_resistance_vanishes() {
        let front = |conductance| last(column(conductance, 505.0, 100), 100).front;
        let perfect = front(f64::INFINITY);
        assert_close(front(1e14), perfect, 1e-6);
        let lag = [3e5, 3e6, 3e7].map(|conductance| 1.0 - front(conductance) / perfect);
        assert!(lag[0] > 5.0 * lag[1] && lag[1] > 5.0 * lag[2] && lag[2] > 0.0, "{lag:?}");
    }

    #[test]
    fn flux_obeys_the_contact_law_and_enthalpy_is_conserved() {
        let column = column(8e4, 520.0, 60);
        let mut cells = Cells::new(&column);
        let sum = |cells: &Cells, range: std::ops::Range<usize>| {
            range.map(|n| cells.widths[n] * cells.enthalpies[n]).sum::<f64>()
        };
        let before = [sum(&cells, 0..60), sum(&cells, 60..120)];
        for n in 0..80 {
            let state = cells.step(f64::from(n) * 1e-5, f64::from(n + 1) * 1e-5);
            let law = 8e4 * (state.fluid_surface - state.wall_surface);
            assert_close(state.flux, law, 1e-9);
        }
        assert!(cells.front() > 1e-5);
        assert_close(sum(&cells, 0..60) - before[0], cells.heat, 1e-6);
        assert_close(before[1] - sum(&cells, 60..120), cells.heat, 1e-6);
    }

    /// Until its surface has cooled to the melting point, the fluid is a body without freezing.
    #[test]
    fn superheated_fluid_freezes_once_its_surface_has_cooled() {
        let column = column(5e4, 540.0, 400);
        let FreezingContact { wall, molten, wall_temperature, .. } = column.bodies;
        let bodies = Contact {
            first: molten,
            first_temperature: 540.0,
            second: wall,
            second_temperature: wall_temperature,
        };
        let contact = ResistiveContact { bodies, conductance: 5e4 };
        let states = column.run(END, 800);
        let begins = states.iter().position(|state| state.front > 0.0).unwrap();
        let surface = contact.surfaces(states[begins].time)[0];
        assert_within(surface, 505.0, 0.5);
        for state in states[..begins].iter().rev().step_by(20).take(5) {
            let [fluid, wall] = contact.surfaces(state.time);
            assert_within(state.fluid_surface, fluid, 0.3);
            assert_within(state.wall_surface, wall, 0.3);
            assert_close(state.flux, contact.flux(state.time), 5e-3);
        }
        assert!(begins > 100 && states[799].front > 1e-6);
    }

    #[test]
    fn thin_layer_freezes_and_comes_to_the_temperature_of_the_heat_balance() {
        let mut column = column(2e4, 520.0, 40);
        (column.fluid_thickness, column.wall_thickness, column.solidus) = (50e-6, 400e-6, 503.0);
        let state = *column.run(1.0, 400).last().unwrap();
        let FreezingContact { wall, frozen, molten, latent, .. } = column.bodies;
        let [wall, solid, liquid] = [
            wall.heat_capacity * 400e-6,
            frozen.heat_capacity * 50e-6,
            molten.heat_capacity * 50e-6,
        ];
        let released = liquid * 15.0 + latent * 50e-6 + 0.5 * (solid + liquid) * 2.0;
        let balance = (wall * 298.15 + solid * 503.0 + released) / (wall + solid);
        assert_close(state.front, 50e-6, 1e-12);
        assert_within(state.wall_surface, balance, 1e-4);
        assert_within(state.fluid_surface, balance, 1e-4);
    }

    #[test]
    fn narrow_range_of_melting_is_almost_a_melting_point() {
        let sharp = column(1e5, 513.0, 100);
        let range = FreezingColumn { solidus: 504.8, ..sharp };
        assert_close(last(range, 100).front, last(sharp, 100).front, 1e-2);
        let phases = Cells::new(&range).fluid;
        for temperature in [400.0, 504.9, 505.0, 600.0] {
            assert_close(phases.temperature(phases.enthalpy(temperature)), temperature, 1e-14);
        }
        let rise = |temperature: f64| phases.enthalpy(temperature) - phases.enthalpy(504.8);
        let mean = 0.5 * (phases.capacities[0] + phases.capacities[1]);
        assert_close(rise(505.0), range.bodies.latent + mean * 0.2, 1e-12);
    }

    #[test]
    fn iterations_converge_over_many_fluids() {
        for conductance in [1e2, 1e4, 1e7, f64::INFINITY] {
            for wall_temperature in [77.0, 400.0, 504.0, 600.0] {
                for (fluid_temperature, solidus) in [(505.0, 505.0), (900.0, 505.0), (504.0, 500.0)]
                {
                    let mut column = column(conductance, fluid_temperature, 30);
                    column.bodies.wall_temperature = wall_temperature;
                    column.solidus = solidus;
                    for steps in [3, 40] {
                        let state = last(column, steps);
                        assert!(state.front >= 0.0 && state.heat.is_finite());
                    }
                }
            }
        }
    }
}
