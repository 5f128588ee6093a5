//! Fluids whose viscosity depends on the shear rate, and those that yield.
//!
//! Their dissipation is a convex function Φ of the shear rate, `Φ′(γ̇) = τ(γ̇)`. The velocities of a step are those of
//! the saddle point of
//!
//! `Σ m (u − u*)²/(2 dt) + Σ V [Φ(|q|) + s·(y′ − q) + r/2 (y′ − q)²] + …`
//!
//! in u, in a shear rate q of each particle and in its stress s, with the deviator y′ of the strain rate of u and a
//! penalty r > 0. The method of multipliers takes turns: q and s of each particle by the flow curve, u by a linear
//! system with the viscosity r. No viscosity is regularised: where a fluid does not yield, q is zero, and s is any
//! stress up to the yield stress. What creeps there is the remainder y′, which the iteration reduces below its
//! tolerance.
//!
//! The slope dτ/dγ̇ of the flow curve before the step, not τ/γ̇, resists the remainder of the fits. Where a shear flow
//! has the curvature u″, the fits lose `Δx²/6 (dτ/dγ̇) u″²` of Φ, and pairs of the same slope compensate for it. With
//! τ/γ̇ the shear at a wall would have five times the error in a fluid of exponent ½.
//!
//! Stresses are kept from step to step, as a first guess of the next.
//!
//! Sources: R. Glowinski and P. Le Tallec, *Augmented Lagrangian and Operator-Splitting Methods in Nonlinear
//! Mechanics*, SIAM 1989; for yield stresses Roquet & Saramito (2003), Comput. Methods Appl. Mech. Eng. 192, 3317–3341,
//! doi 10.1016/S0045-7825(03)00262-7.

use super::super::cloud::Cloud;
use super::super::frozen::Pieces;
use super::super::method::Method;
use super::super::neighbours::Block;
use super::rate::length;
use super::strain::Elongation;
use super::system::{Moduli, Reactions, System};
use super::tensor::Products;
use super::{ViscousStep, norm, residual};
use crate::math::conjugate_gradients::{NotConverged, solve};
use crate::runtime::parallel::Team;

/// Residual of a turn's linear system over its initial one. A fifth fewer products than with 0.1.
const TURN: f64 = 0.3;
/// Residuals of forces and of shear rates at the end, over their sizes.
const TOLERANCE: f64 = 1e-3;
/// The same of fluid from a nozzle, whose widths it changes by less than 0.1 %.
const TOLERANCE_BY_NOZZLE: f64 = 5e-3;
/// Residual of forces of fluid from a nozzle over the impulses of its stresses, below which it does not count: where
/// these hold the fluid, they are far larger than its momenta, and rounding leaves more of them.
const STRESSED: f64 = 1e-4;
/// Residual of forces over momenta below which it is rounding.
const ROUNDING: f64 = 1e-5;
/// The same over momenta and `ν dt/Δx²`: pairs take differences of velocities in single precision.
const ROUNDING_OF_RATES: f64 = 4.0 * f32::EPSILON as f64;
/// Residual of forces of fluid from a nozzle over its weight, below which it does not count once it falls no more: fluid
/// that falls as one bears hardly any stress.
const WEIGHED: f64 = 1e-3;
/// Turns without a smaller residual of forces after which rounding has stalled it.
const STALLED: usize = 3;
/// Stress over that at the reference rate below which its accuracy does not matter.
const FAINT: f64 = 1e-2;
/// Over-relaxation of stresses; the method converges below (1 + √5)/2.
const RELAXATION: f64 = 1.6;
/// Fraction of the yield stress from which on fluid counts as yielding; the error of stresses is of this order.
pub const AT_YIELD: f64 = 0.999;
/// Range of penalties over the reference viscosity.
const PENALTIES: [f64; 2] = [0.1, 10.0];
/// Smallest viscosity of what the fits leave over, over `τ/γ̇`. It keeps fluid below its yield stress stiff.
const LEAST_SLOPE: f64 = 0.1;
const MOST_TURNS: usize = 1000;

/// Advances a fluid by its flow curves.
pub fn advance(
    method: &Method,
    cloud: &Cloud,
    frozen: &Pieces,
    blocks: &[Block],
    (dt, before): (f64, &[[f64; 3]]),
    team: &Team,
) -> Result<ViscousStep, NotConverged> {
    let moduli = vec![Moduli::newtonian(method.viscosity); cloud.len()];
    let mut system = System::of(method, cloud, frozen, blocks, dt, moduli, team);
    let guess = if method.solves_pressure { before } else { &cloud.velocity[..] };
    let mut velocity = guess.as_flattened().to_vec();
    let pairs = system.elongations(&velocity);
    let moduli = team.map(cloud.len(), |i| moduli_at(&system, &pairs, i));
    system.set_moduli(moduli);
    let mut turn = Turn {
        pairs: system.elongations(&velocity),
        stresses: cloud.stress.clone().unwrap_or_else(|| vec![[0.0; 6]; cloud.len()]),
        creep: 0.0,
        mismatch: 0.0,
    };
    // At rest it is what gravity gives in the step.
    let driven = cloud.velocity.as_flattened();
    let momentum = momentum(cloud, &velocity).max(momentum(cloud, driven));
    let weight = if method.fed { WEIGHED * impulse_of_weight(&system) } else { 0.0 };
    let floor = (rounding_of_rates(&system) * momentum).max(weight);
    let mut forces_left = Residual { floor, ..Residual::default() };
    let tolerance = if method.fed { TOLERANCE_BY_NOZZLE } else { TOLERANCE };
    let mut iterations = 0;
    for _ in 0..MOST_TURNS {
        let totals = turn.follow_curves(&system, team);
        let forces = system.forces(&turn.pairs, &system.forms_under(&turn.pairs, &totals));
        let load = residual(&system, &velocity, &forces);
        forces_left.follow(norm(&load, &cloud.mass));
        let rounding = match method.fed {
            true => (ROUNDING * momentum).max(STRESSED * turn.impulses(&system)),
            false => ROUNDING * momentum,
        };
        if turn.mismatch <= tolerance && forces_left.is_small(tolerance, rounding) {
            return Ok(turn.end(&system, &velocity, iterations));
        }
        let (changes, spent) = solve(&system, &load, TURN, team)?;
        iterations += spent;
        velocity.iter_mut().zip(&changes).for_each(|(v, change)| *v += change);
        turn.pairs = system.elongations(&velocity);
    }
    let residual = turn.mismatch.max(forces_left.relative());
    Err(NotConverged { residual, iterations, tolerance })
}

/// Size of what gravity gives in a step, as [`momentum`].
fn impulse_of_weight(system: &System) -> f64 {
    let gravity = system.method.gravity.iter().map(|g| g * g).sum::<f64>().sqrt();
    system.dt * gravity * system.cloud.mass.iter().sum::<f64>().sqrt()
}

/// Size of the momenta at velocities.
fn momentum(cloud: &Cloud, velocity: &[f64]) -> f64 {
    let moving = velocity.iter().enumerate().map(|(n, v)| v * cloud.mass[n / 3]);
    norm(&moving.collect::<Vec<f64>>(), &cloud.mass)
}

/// Residual of forces over the turns of a step.
#[derive(Default)]
struct Residual {
    first: Option<f64>,
    smallest: f64,
    last: f64,
    /// Turns since the smallest.
    stalled: usize,
    /// Bound of what rounding of rates, or the weight of fluid that falls, may leave.
    floor: f64,
}

impl Residual {
    fn follow(&mut self, size: f64) {
        let is_first = self.first.is_none();
        self.first.get_or_insert(size);
        self.last = size;
        let falls = is_first || size < self.smallest;
        self.stalled = if falls { 0 } else { self.stalled + 1 };
        self.smallest = if falls { size } else { self.smallest };
    }

    /// The last over the first.
    fn relative(&self) -> f64 {
        self.last / self.first.unwrap_or(1.0).max(f64::MIN_POSITIVE)
    }

    /// Returns true at the tolerance, below a size that is rounding, or where rounding of rates keeps it from falling.
    fn is_small(&self, tolerance: f64, rounding: f64) -> bool {
        let wanted = (tolerance * self.first.unwrap_or(0.0)).max(rounding);
        self.last <= wanted || (self.stalled >= STALLED && self.last <= self.floor)
    }
}

/// Residual of forces over momenta that the rounding of rates may leave.
fn rounding_of_rates(system: &System) -> f64 {
    let stiffness = |moduli: &Moduli| moduli.shear.max(moduli.pairs);
    let stiffest = system.moduli.iter().map(stiffness).fold(0.0, f64::max);
    ROUNDING_OF_RATES * system.dt * stiffest / system.method.spacing.powi(2)
}

/// Penalty and viscosities of a particle from its shear rate before the step.
fn moduli_at(system: &System, pairs: &[Elongation], i: usize) -> Moduli {
    let (flow, temperature) = (&system.method.flow, system.cloud.temperature[i]);
    let reference = system.method.viscosity;
    let [least, most] = PENALTIES.map(|penalty| penalty * reference);
    let rate = length(&system.axes.deviator(&system.rate(pairs, i)));
    let whole = (rate * rate + system.rest(pairs, i)).sqrt();
    let slope = flow.tangent(temperature, rate);
    let least_slope = LEAST_SLOPE * flow.viscosity(temperature, rate);
    Moduli {
        shear: flow.viscosity(temperature, whole).clamp(least, most),
        volume: reference,
        pairs: slope.max(least_slope).min(most),
    }
}

/// State of the iteration.
struct Turn {
    pairs: Vec<Elongation>,
    /// s of each particle, over ρ₀c₀².
    stresses: Vec<Products>,
    /// Largest shear rate of particles that do not yield.
    creep: f64,
    /// Norm of `r (y′ − q)` over that of s.
    mismatch: f64,
}

impl Turn {
    /// Updates q and s by the flow curve of each particle. Returns the stresses `s + r (y′ − q)` of the next linear
    /// system, with those of the volume.
    fn follow_curves(&mut self, system: &System, team: &Team) -> Vec<Products> {
        let flow = &system.method.flow;
        let pieces = team.map(self.pairs.len(), |i| {
            let Moduli { shear: penalty, volume, .. } = system.moduli[i];
            let y = system.rate(&self.pairs, i);
            let deviator = system.axes.deviator(&y);
            let load: Products =
                std::array::from_fn(|n| self.stresses[i][n] + penalty * deviator[n]);
            let size = length(&load);
            let rate = flow.rate_beyond(system.cloud.temperature[i], size, penalty);
            let part = if size > 0.0 { rate / size } else { 0.0 };
            let gap: Products = std::array::from_fn(|n| deviator[n] - part * load[n]);
            let stress: Products =
                std::array::from_fn(|n| self.stresses[i][n] + RELAXATION * penalty * gap[n]);
            let of_volume = system.axes.scaled(&y, 0.0, volume);
            let total = std::array::from_fn(|n| stress[n] + penalty * gap[n] + of_volume[n]);
            let is_at_yield = length(&stress) >= AT_YIELD * flow.yield_stress();
            let creep = if is_at_yield { 0.0 } else { length(&deviator) };
            let weight = system.volume(i);
            let sums =
                [weight * (penalty * length(&gap)).powi(2), weight * length(&stress).powi(2)];
            (stress, total, creep, sums)
        });
        let (mut gaps, mut whole) = (0.0, 0.0);
        self.creep = 0.0;
        let mut totals = Vec::with_capacity(pieces.len());
        for (i, (stress, total, creep, sums)) in pieces.into_iter().enumerate() {
            self.stresses[i] = stress;
            self.creep = self.creep.max(creep);
            (gaps, whole) = (gaps + sums[0], whole + sums[1]);
            totals.push(total);
        }
        let volume: f64 = (0..self.pairs.len()).map(|i| system.volume(i)).sum();
        let least = (FAINT * system.method.reference_stress).powi(2) * volume;
        self.mismatch = if gaps > 0.0 { (gaps / whole.max(least)).sqrt() } else { 0.0 };
        totals
    }

    /// Size of the impulses of stresses over the step, each across a distance of particles.
    fn impulses(&self, system: &System) -> f64 {
        let [dt, spacing] = [system.dt, system.method.spacing];
        let of = |i: usize| {
            let impulse = dt * system.volume(i) * length(&self.stresses[i]) / spacing;
            impulse * impulse / system.cloud.mass[i]
        };
        (0..self.stresses.len()).map(of).sum::<f64>().sqrt()
    }

    fn end(self, system: &System, velocity: &[f64], iterations: usize) -> ViscousStep {
        let before = system.cloud.velocity.as_flattened();
        let changes: Vec<f64> = velocity.iter().zip(before).map(|(v, before)| v - before).collect();
        let stresses: Vec<Products> = (0..self.pairs.len())
            .map(|i| {
                let y = system.rate(&self.pairs, i);
                let of_volume = system.axes.scaled(&y, 0.0, system.moduli[i].volume);
                std::array::from_fn(|n| self.stresses[i][n] + of_volume[n])
            })
            .collect();
        let forms = system.forms_under(&self.pairs, &stresses);
        let Reactions { by_wall, by_nozzle } =
            system.reactions(&system.forces(&self.pairs, &forms), &changes);
        ViscousStep {
            changes: changes.as_chunks().0.to_vec(),
            by_wall,
            by_nozzle,
            stresses: self.stresses,
            creep: self.creep,
            iterations,
        }
    }
}
