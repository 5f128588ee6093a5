//! Plane flow of a Bingham fluid between plates in time, such as its cessation: a numerical oracle without
//! regularisation.
//!
//! With the half-width h [m], y from the middle, the density ρ, the viscosity µ and the yield stress τ₀,
//! `ρ ∂u/∂t = G + ∂τ/∂y`, `τ = µ ∂u/∂y + τ₀ sign(∂u/∂y)` where the fluid yields, `|τ| ≤ τ₀` where it does not. The
//! flow that a pressure gradient G drove comes to rest at a finite time after G has fallen below τ₀/h, while every
//! regularised law lets it decay for ever.
//!
//! Each implicit Euler step minimises a convex function whose kinks are the unyielded faces between cells. Its dual,
//! in the stresses of the faces, is piecewise linear and monotone: Newton's method with the set of yielded faces
//! finds the solution to rounding after a few tridiagonal systems. It is of first order in the step and second in the
//! cells. A fluid at rest has the velocity 0 to rounding.
//!
//! Sources: R. Glowinski, *Numerical Methods for Nonlinear Variational Problems*, Springer 1984,
//! doi 10.1007/978-3-662-12613-4 (variational form, finite stopping time); M. Chatzimina, G. C. Georgiou,
//! I. Argyropaidas, E. Mitsoulis and R. R. Huilgol (2005), J. Non-Newtonian Fluid Mech. 129, 117–127 (stopping times).

use super::tridiagonal;

/// Largest number of Newton's iterations of a step.
const MOST_ITERATIONS: usize = 500;

/// A Bingham fluid.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bingham {
    /// Density ρ [kg/m³].
    pub density: f64,
    /// Viscosity µ [Pa s].
    pub viscosity: f64,
    /// Yield stress τ₀ [Pa].
    pub yield_stress: f64,
}

impl Bingham {
    /// Shear rate [1/s] at a stress [Pa], with its sign.
    fn rate(&self, stress: f64) -> f64 {
        (stress.abs() - self.yield_stress).max(0.0).copysign(stress) / self.viscosity
    }
}

/// Half of the channel, in cells of equal width.
#[derive(Debug, Clone, PartialEq)]
pub struct CeasingFlow {
    fluid: Bingham,
    /// Width of a cell [m].
    spacing: f64,
    /// Velocities of the cells, from the middle to the plate [m/s].
    velocity: Vec<f64>,
    /// Stresses of the faces, each on the plate's side of its cell [Pa].
    stress: Vec<f64>,
    /// Time [s].
    time: f64,
}

impl CeasingFlow {
    /// Flow with the initial velocity `start(y)` [m/s], y from the middle to the half-width [m].
    pub fn new(fluid: Bingham, half_width: f64, cells: usize, start: impl Fn(f64) -> f64) -> Self {
        let spacing = half_width / cells as f64;
        let velocity = (0..cells).map(|i| start((i as f64 + 0.5) * spacing)).collect();
        Self { fluid, spacing, velocity, stress: vec![0.0; cells], time: 0.0 }
    }

    /// Velocities of the cells, from the middle to the plate [m/s].
    pub fn velocity(&self) -> &[f64] {
        &self.velocity
    }

    /// Stresses of the faces between cells and of the plate, after the last step [Pa]. They are negative where the
    /// flow is positive.
    pub fn stress(&self) -> &[f64] {
        &self.stress
    }

    /// Time [s].
    pub fn time(&self) -> f64 {
        self.time
    }

    /// Returns true if no face has yielded in the last step.
    pub fn is_at_rest(&self) -> bool {
        self.stress.iter().all(|stress| stress.abs() <= self.fluid.yield_stress)
    }

    /// Flow per width through the half channel [m²/s].
    pub fn flow(&self) -> f64 {
        self.spacing * self.velocity.iter().sum::<f64>()
    }

    /// Advances by a step [s] under a pressure gradient G [Pa/m].
    ///
    /// # Panics
    /// If the sets of yielded faces cycle.
    pub fn step(&mut self, step: f64, gradient: f64) {
        let mobility = step / (self.fluid.density * self.spacing);
        let push = mobility * gradient * self.spacing;
        let mut yielded = self.yielded();
        for _ in 0..MOST_ITERATIONS {
            self.stress = self.stresses(mobility, push, &yielded);
            let next = self.yielded();
            if next == yielded {
                self.accelerate(mobility, push);
                self.time += step;
                return;
            }
            yielded = next;
        }
        panic!("no set of yielded faces found at {} s", self.time);
    }

    /// Time at which the flow comes to rest without a pressure gradient [s], with steps of a given length: too late
    /// by up to a step.
    pub fn stopping_time(mut self, step: f64) -> f64 {
        loop {
            self.step(step, 0.0);
            if self.is_at_rest() {
                return self.time;
            }
        }
    }

    /// Direction in which each face yields, 0 if it does not.
    fn yielded(&self) -> Vec<i8> {
        let direction = |stress: &f64| match self.fluid.rate(*stress) {
            rate if rate > 0.0 => 1,
            rate if rate < 0.0 => -1,
            _ => 0,
        };
        self.stress.iter().map(direction).collect()
    }

    /// Stresses for a set of yielded faces: the rate of each face, times its distance between velocities, is the
    /// difference of the velocities after the step.
    fn stresses(&self, mobility: f64, push: f64, yielded: &[i8]) -> Vec<f64> {
        let (count, fluid) = (self.velocity.len(), self.fluid);
        let (mut diagonal, mut right) = (vec![0.0; count], vec![0.0; count]);
        for face in 0..count {
            let at_plate = face + 1 == count;
            let compliance = self.distance(face) / fluid.viscosity;
            let (active, direction) = (f64::from(yielded[face].abs()), f64::from(yielded[face]));
            let sides = if at_plate { 1.0 } else { 2.0 };
            diagonal[face] = compliance * active + sides * mobility;
            let next = if at_plate { -push } else { self.velocity[face + 1] };
            right[face] = next - self.velocity[face] + compliance * direction * fluid.yield_stress;
        }
        let coupling = vec![-mobility; count];
        tridiagonal::solve(&coupling, &diagonal, &coupling, &right)
    }

    /// Distance of the velocities on both sides of a face; the plate is half a cell from the last one.
    fn distance(&self, face: usize) -> f64 {
        if face + 1 == self.velocity.len() { 0.5 * self.spacing } else { self.spacing }
    }

    fn accelerate(&mut self, mobility: f64, push: f64) {
        let mut before = 0.0;
        for (velocity, stress) in self.velocity.iter_mut().zip(&self.stress) {
            *velocity += push + mobility * (stress - before);
            before = *stress;
        }
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;

    use super::super::checks::{assert_close, assert_within};
    use super::super::herschel_bulkley::HerschelBulkley;
    use super::super::yielding_channel::YieldingChannel;
    use super::*;

    fn unit(yield_stress: f64) -> Bingham {
        Bingham { density: 1.0, viscosity: 1.0, yield_stress }
    }

    /// Steady flow under the gradient 2 between plates 2 apart.
    fn steady(yield_stress: f64) -> YieldingChannel {
        let fluid = HerschelBulkley { yield_stress, consistency: 1.0, exponent: 1.0 };
        YieldingChannel { fluid, gradient: 2.0, width: 2.0 }
    }

    fn driven(yield_stress: f64, cells: usize) -> CeasingFlow {
        let channel = steady(yield_stress);
        CeasingFlow::new(unit(yield_stress), 1.0, cells, |y| channel.velocity(1.0 - y))
    }

    #[test]
    fn stopping_times_of_two_bingham_numbers() {
        for (yield_stress, bingham, stop) in [(0.5, 1.185, 0.4082), (1.0, 4.8, 0.1484)] {
            let mean = 0.5 * steady(yield_stress).flow();
            assert_close(yield_stress / mean, bingham, 5e-4);
            let time = driven(yield_stress, 200).stopping_time(5e-5);
            assert_close(time, stop, 1e-3);
            // ∫|∂u/∂y| ≥ ‖u‖ and ∫(∂u/∂y)² ≥ π²/4 ‖u‖² bound the decay of the energy (Glowinski 1984).
            let flow = driven(yield_stress, 200);
            let norm = (flow.velocity.iter().map(|u| u * u).sum::<f64>() / 200.0).sqrt();
            let rate = PI * PI / 4.0;
            let bound = (rate * norm / yield_stress).ln_1p() / rate;
            assert!(time < bound && time > 0.5 * bound, "{time} {bound}");
        }
    }

    /// The same flow by tracking the edge s of the plug: `du/dt = −τ₀/s` in the plug, `∂u/∂t = ∂²u/∂y²` between it and
    /// the plate, `∂u/∂y = 0` at the edge, which fixes s.
    struct TrackedPlug {
        yield_stress: f64,
        edge: f64,
        /// Velocities at equally spaced points from the edge to the plate.
        velocity: Vec<f64>,
    }

    impl TrackedPlug {
        fn new(yield_stress: f64, intervals: usize) -> Self {
            let edge = 0.5 * yield_stress;
            let velocity = (0..=intervals)
                .map(|i| (1.0 - edge).powi(2) * (1.0 - (i as f64 / intervals as f64).powi(2)))
                .collect();
            Self { yield_stress, edge, velocity }
        }

        /// Velocity at y, by a parabola through the closest points.
        fn at(&self, y: f64) -> f64 {
            let last = self.velocity.len() - 1;
            let place = (y - self.edge) / (1.0 - self.edge) * last as f64;
            if place <= 0.0 {
                return self.velocity[0];
            }
            let middle = (place as usize).clamp(1, last - 1);
            let [a, b, c] = [middle - 1, middle, middle + 1].map(|n| self.velocity[n]);
            let x = place - middle as f64;
            b + 0.5 * x * (c - a) + 0.5 * x * x * (c - 2.0 * b + a)
        }

        /// Velocities after an implicit step that ends with the plug's edge at `edge`, and their slope there.
        fn try_step(&self, edge: f64, step: f64) -> (Vec<f64>, f64) {
            let count = self.velocity.len();
            let spacing = (1.0 - edge) / (count - 1) as f64;
            let diffusion = step / spacing.powi(2);
            let inner = |n: usize| n > 0 && n + 1 < count;
            let band = |n: usize| if inner(n) { -diffusion } else { 0.0 };
            let coupling: Vec<f64> = (0..count).map(band).collect();
            let diagonal: Vec<f64> = coupling.iter().map(|c| 1.0 - 2.0 * c).collect();
            let right = |n: usize| match n {
                0 => self.velocity[0] - step * self.yield_stress / edge,
                n if inner(n) => self.at(edge + n as f64 * spacing),
                _ => 0.0,
            };
            let right: Vec<f64> = (0..count).map(right).collect();
            let velocity = tridiagonal::solve(&coupling, &diagonal, &coupling, &right);
            let slope = (4.0 * velocity[1] - velocity[2] - 3.0 * velocity[0]) / (2.0 * spacing);
            (velocity, slope)
        }

        /// Time at which the plug reaches the plate: the last part of it at the deceleration τ₀/h.
        fn stopping_time(mut self, step: f64) -> f64 {
            let mut time = 0.0;
            while self.edge < 0.97 {
                let (mut low, mut high) = (0.99 * self.edge, 1.0 - 1e-6);
                for _ in 0..40 {
                    let middle = 0.5 * (low + high);
                    let slope = self.try_step(middle, step).1;
                    *(if slope > 0.0 { &mut low } else { &mut high }) = middle;
                }
                self.velocity = self.try_step(low, step).0;
                self.edge = low;
                time += step;
            }
            time + self.velocity[0] / self.yield_stress
        }
    }

    #[test]
    fn tracked_plugs_stop_at_the_same_times() {
        for (yield_stress, stop) in [(0.5, 0.4082), (1.0, 0.1484)] {
            let time = |step| TrackedPlug::new(yield_stress, 60).stopping_time(step);
            let [coarse, fine] = [2e-3, 1e-3].map(time);
            assert_close(2.0 * fine - coarse, stop, 1.5e-3);
        }
    }

    #[test]
    fn stopping_time_converges_with_steps_and_cells() {
        let time = |cells, step| driven(0.5, cells).stopping_time(step);
        let [coarse, middle, fine] = [1.6e-3, 4e-4, 1e-4].map(|step| time(50, step));
        assert!((coarse - fine).abs() < 4e-3 && (middle - fine).abs() < 1e-3);
        let [coarse, middle, fine] = [10, 20, 80].map(|cells| time(cells, 1e-5));
        assert!((coarse - fine).abs() > 3.0 * (middle - fine).abs(), "{coarse} {middle} {fine}");
    }

    #[test]
    fn steady_flow_persists_and_attracts() {
        let mut flow = CeasingFlow::new(unit(0.5), 1.0, 100, |_| 0.0);
        for _ in 0..40 {
            flow.step(0.5, 2.0);
        }
        for (i, velocity) in flow.velocity().iter().enumerate() {
            let y = (i as f64 + 0.5) / 100.0;
            assert_within(*velocity, steady(0.5).velocity(1.0 - y), 1e-4);
            assert_close(flow.stress()[i], -2.0 * (i as f64 + 1.0) / 100.0, 1e-9);
        }
        assert_close(flow.flow(), 0.5 * steady(0.5).flow(), 1e-3);
    }

    #[test]
    fn momentum_changes_by_gradient_and_wall_stress_only() {
        let mut flow = driven(0.5, 40);
        for _ in 0..50 {
            let before = flow.flow();
            flow.step(2e-3, 0.3);
            let wall = flow.stress()[39];
            assert_close(flow.flow() - before, 2e-3 * (0.3 + wall), 1e-11);
        }
    }

    #[test]
    fn newtonian_flow_decays_exponentially_and_never_rests() {
        let mut flow = CeasingFlow::new(unit(0.0), 1.0, 200, |y| (0.5 * PI * y).cos());
        for _ in 0..1000 {
            flow.step(1e-3, 0.0);
        }
        assert!(!flow.is_at_rest());
        assert_close(flow.velocity()[0], (-0.25 * PI * PI).exp(), 4e-3);
    }

    #[test]
    fn fluid_below_its_yield_stress_stays_at_rest_to_rounding() {
        let mut flow = driven(1.0, 60);
        for _ in 0..400 {
            flow.step(1e-2, 0.9);
        }
        assert!(flow.is_at_rest());
        assert!(flow.velocity().iter().all(|u| u.abs() < 1e-12), "{:?}", flow.velocity());
    }

    /// The same step by an augmented Lagrangian: another algorithm, of the primal problem.
    fn augmented_lagrangian(flow: &CeasingFlow, step: f64) -> Vec<f64> {
        let (count, fluid, weight) = (flow.velocity.len(), flow.fluid, 3.0);
        let inertia = fluid.density * flow.spacing / step;
        let stiffness: Vec<f64> = (0..count).map(|face| weight / flow.distance(face)).collect();
        let side = |face: usize| if face == 0 { 0.0 } else { stiffness[face - 1] };
        let diagonal: Vec<f64> = (0..count).map(|i| inertia + stiffness[i] + side(i)).collect();
        let lower: Vec<f64> = (0..count).map(|i| -side(i)).collect();
        let upper: Vec<f64> = stiffness.iter().map(|s| -s).collect();
        let (mut rate, mut stress) = (vec![0.0; count], vec![0.0; count]);
        let mut velocity = flow.velocity.clone();
        for _ in 0..20_000 {
            let pull: Vec<f64> = (0..count).map(|n| stress[n] - weight * rate[n]).collect();
            let before = |i: usize| if i == 0 { 0.0 } else { pull[i - 1] };
            let right: Vec<f64> =
                (0..count).map(|i| inertia * flow.velocity[i] + pull[i] - before(i)).collect();
            velocity = tridiagonal::solve(&lower, &diagonal, &upper, &right);
            for n in 0..count {
                let next = velocity.get(n + 1).copied().unwrap_or(0.0);
                let strain = (next - velocity[n]) / flow.distance(n);
                let trial: f64 = stress[n] + weight * strain;
                let excess = (trial.abs() - fluid.yield_stress).max(0.0).copysign(trial);
                rate[n] = excess / (fluid.viscosity + weight);
                stress[n] += weight * (strain - rate[n]);
            }
        }
        velocity
    }

    #[test]
    fn augmented_lagrangian_takes_the_same_steps() {
        let mut flow =
            CeasingFlow::new(unit(0.3), 1.0, 20, |y| 1.0 - y * y + 0.4 * (9.0 * y).sin());
        for step in [1e-3, 0.02, 0.05] {
            let expected = augmented_lagrangian(&flow, step);
            flow.step(step, 0.0);
            for (velocity, expected) in flow.velocity.iter().zip(&expected) {
                assert_within(*velocity, *expected, 1e-10);
            }
        }
        assert!(flow.yielded().contains(&0) && !flow.is_at_rest());
    }
}
