//! Dimensionless numbers of a plan of droplets, its limits of time steps, and their use on single
//! particles.

use std::f64::consts::PI;

use super::cloud::Part;
use super::continuity::ContinuityRates;
use super::cooling::Cooling;
use super::free_surface::Setting;
use super::frozen::STICKING_PAIR;
use super::images::Images;
use super::loops::PairKind;
use super::moment::{filled, renormalised};
use super::phases::Phases;
use super::plan::{DropletPlan, Viscous};
use super::units::Units;
use super::viscous::FlowCurves;
use super::wall_heat::WallHeat;
use super::wall_points::PointLattice;
use crate::kernel::Kernel;
use crate::port::WallCells;
use crate::scene::Precision;

/// Dimensionless numbers of the method, fixed by a plan.
pub struct Method {
    pub units: Units,
    pub dimension: usize,
    pub kernel: Kernel,
    pub precision: Precision,
    pub normalisation: f64,
    pub mirrors: [bool; 2],
    /// Axes along which there is no motion as a whole, and whether particles are rings.
    pub even: [bool; 2],
    pub rings: bool,
    pub images: Images,
    /// ν over c₀H; of a law of viscosity, its reference.
    pub viscosity: f64,
    /// Flow curves of the fluid, and its stress over ρ₀c₀² at the reference rate.
    pub flow: FlowCurves,
    pub reference_stress: f64,
    /// True if viscosity is solved at the end of a step, see [`viscous`](super::viscous).
    pub implicit: bool,
    /// True if pressure is solved with it.
    pub solves_pressure: bool,
    /// Images of fluid without weight.
    pub weightless: Images,
    /// True if no fluid may be thinner than the reference.
    uniform: bool,
    /// Coefficient of viscosity in the sums over pairs, see
    /// [`Momentum`](super::momentum::Momentum); 0 where viscosity is implicit.
    pub pair_viscosity: f64,
    pub conduction: f64,
    /// Phases of a fluid that freezes.
    pub phases: Option<Phases>,
    pub diffusion: f64,
    /// True if density diffusion is corrected by renormalised gradients.
    pub corrects: bool,
    /// Surface tension over ρ₀c₀²H, and its settings where there is any.
    pub tension: f64,
    pub surface: Option<Setting>,
    pub gravity: [f64; 3],
    /// c₀²/c of the fluid [K], which converts energy per mass into temperature.
    pub heat_unit: f64,
    pub spacing: f64,
    pub shifts: bool,
    pub wall: Option<WallCells>,
    /// Points of the wall, and their heat exchange; `None` without a wall, and without heat.
    pub points: PointLattice,
    pub wall_heat: Option<WallHeat>,
    shares: StepShares,
    /// True if the fluid comes from a nozzle.
    pub fed: bool,
    /// Heat that passes to the air; `None` if there is none.
    pub cooling: Option<Cooling>,
    /// Largest stable step of density diffusion, over H/c₀.
    diffusive_step: f64,
}

/// Position [m] and value [N s] of an impulse on the wall.
pub type Push = ([f64; 2], [f64; 3]);

/// Fractions of the bounds of a time step that are used.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StepShares {
    /// Fraction of H/c₀.
    pub courant: f64,
    /// Fraction of the largest step at which viscosity amplifies no flow.
    pub viscous: f64,
    /// Fraction of the largest step at which density diffusion amplifies no wave.
    pub diffusive: f64,
    /// Fraction of H²/κ.
    pub conductive: f64,
    /// Fraction of √(H/a).
    pub forced: f64,
    /// Fraction of √(ρλ³/16πσ), in which the shortest capillary wave passes half its length λ
    /// (Brackbill, Kothe & Zemach 1992, J. Comput. Phys. 100, 335–354, doi
    /// 10.1016/0021-9991(92)90240-Y).
    pub capillary: f64,
}

impl Default for StepShares {
    /// Shares used by every scene.
    fn default() -> Self {
        Self {
            courant: 0.2,
            viscous: 0.85,
            diffusive: 0.85,
            conductive: 0.02,
            forced: 0.18,
            capillary: 0.25,
        }
    }
}

/// Largest ratio of a step to the one before where sound limits none.
const LENGTHENED: f64 = 1.5;
/// Largest distance over H that particles move in a time step with implicit viscosity.
const MOST_WAY: f64 = 0.05;
/// The same of fluid from a nozzle, which is slow where its shape is made: widths change by 0.8 % from half of it, and
/// it takes 0.7 times the products.
const MOST_WAY_OF_STRANDS: f64 = 0.1;
/// `s λ/ω²` of sound over ν/c₀², see [`Method::damped`].
const DAMPED_SOUND: f64 = 0.9;
/// Fraction of the damping of sound by the viscosity of volume alone, which never falls below the reference:
/// `1 + 2/3` of 3.
const BY_VOLUME: f64 = 5.0 / 9.0;
/// `s λ/ω²` of the shortest capillary wave over `µΛ/σ`, with its length Λ and the s of its undamped step.
const DAMPED_TENSION: f64 = 0.0245;

/// Damping of a particle's motion against its neighbours over ν/H².
const DAMPED_PARTICLE: f64 = 2.5;

/// Cost of the set-up of a viscous system, and of a product with it, over that of a time step: measured on drops of
/// rings and quarters of 150 to 540 particles.
const SETUP_COST: f64 = 3.5;
const PRODUCT_COST: f64 = 0.7;
/// Products of a viscous step for νΔt = H², and their exponent of νΔt/H²: measured were 6, 13, 29 and 51 for 0.007,
/// 0.046, 0.35 and 3.3. Laws of the shear rate take several systems in turn.
const PRODUCTS: f64 = 38.0;
const PRODUCTS_BY_STIFFNESS: f64 = 0.35;
const TURNS: f64 = 20.0;
/// Products of a step with pressure, each of twice as many sums: measured were 1 to 3 at rest and 17 to 31 in films of
/// 0.01 to 10 Pa s.
const PRODUCTS_WITH_PRESSURE: f64 = 50.0;
/// Largest νΔt/H² of a viscous step, with some 700 products: conjugate gradients end at a thousand.
const STIFFEST: f64 = 4000.0;

/// Largest number of steps between impulses of surface tension, which changes slowly relative to
/// sound. Impulses between steps conserve its energy (reversible reference system propagator,
/// Tuckerman, Berne & Martyna 1992, J. Chem. Phys. 97, 1990–2001, doi 10.1063/1.463137).
const MOST_STEPS_PER_IMPULSE: f64 = 10.0;

impl Method {
    pub fn of(plan: &DropletPlan) -> Self {
        Self::with_shares(plan, StepShares::default())
    }

    pub fn with_shares(plan: &DropletPlan, shares: StepShares) -> Self {
        let units = Units::of(plan);
        let fluid = &plan.fluid;
        let (h, c) = (units.length, units.speed);
        let normalisation = plan.kernel.scale(1.0, plan.dimension);
        let tension = fluid.surface_tension / (units.density * c * c * h);
        let gravity = plan.gravity.map(|g| g * h / (c * c));
        let images = Images::of(plan, h, gravity);
        let points = PointLattice::of(plan);
        let flow = FlowCurves::of(plan, &units);
        let (rate, implicit) = match plan.viscous {
            Viscous::Explicit => (1.0, false),
            Viscous::Implicit { rate } | Viscous::WithPressure { rate } => {
                (rate * units.time(), true)
            }
        };
        let viscosity = match fluid.viscosity.constant() {
            Some(value) => value / (units.density * c * h),
            None => flow.viscosity(0.0, rate),
        };
        Self {
            units,
            dimension: plan.dimension,
            kernel: plan.kernel,
            precision: plan.precision,
            normalisation,
            mirrors: plan.mirrors,
            even: plan.even(),
            rings: plan.axisymmetric,
            images: images.clone(),
            viscosity,
            flow,
            reference_stress: viscosity * rate,
            implicit,
            solves_pressure: matches!(plan.viscous, Viscous::WithPressure { .. }),
            weightless: Images::of(plan, h, [0.0; 3]),
            uniform: fluid.viscosity.constant().is_some(),
            pair_viscosity: match implicit {
                true => 0.0,
                false => pair_viscosity(plan, viscosity),
            },
            conduction: fluid.conductivity / (units.density * fluid.specific_heat * c * h),
            phases: plan.phases(),
            diffusion: plan.density_diffusion,
            corrects: plan.corrected_diffusion && plan.density_diffusion > 0.0,
            tension,
            surface: (tension > 0.0).then(|| Setting::of(plan, tension, &images)),
            gravity,
            heat_unit: c * c / fluid.specific_heat,
            spacing: 1.0 / plan.support,
            shifts: plan.shifting,
            wall: plan.wall.as_ref().map(|wall| wall.cells.clone()),
            wall_heat: WallHeat::of(plan, &units, points.area),
            points,
            shares,
            fed: plan.feed.is_some(),
            cooling: Cooling::of(plan, &units),
            diffusive_step: diffusive_step(plan),
        }
    }

    /// Properties common to all sums over pairs.
    pub fn pairs(&self) -> PairKind {
        let Self { kernel, precision, rings, .. } = *self;
        PairKind { kernel, precision, rings }
    }

    /// Returns true if the moments of the particles' neighbours are needed.
    pub fn needs_moments(&self) -> bool {
        self.corrects || self.shifts || (self.surface.is_some() && self.diffusion > 0.0)
    }

    /// Advances density and temperature of the k-th particle of a part at its rates.
    pub fn change<const MOMENTS: bool>(
        &self,
        part: &mut Part,
        k: usize,
        rate: &ContinuityRates,
        dt: f64,
    ) {
        if MOMENTS {
            let moment = filled(rate.moment, self.dimension);
            part.moment[k] = moment;
            if self.corrects {
                part.gradient[k] = renormalised(&moment, rate.gradient);
            }
        }
        part.density[k] += dt * rate.density;
        self.heat(part, k, dt * rate.temperature);
    }

    /// Heat potential of the k-th particle of a part, by which heat is conducted, over its conductivity [K].
    pub fn potential(&self, part: &Part, k: usize) -> f64 {
        match (&self.phases, &part.content) {
            (Some(phases), Some(content)) => phases.potential(content[k]),
            _ => part.temperature[k],
        }
    }

    /// Changes the heat content of the k-th particle of a part.
    pub fn heat(&self, part: &mut Part, k: usize, change: f64) {
        match (&self.phases, &mut part.content) {
            (Some(phases), Some(content)) => {
                phases.heat(&mut content[k], &mut part.temperature[k], change);
            }
            _ => part.temperature[k] += change,
        }
    }

    /// Point of the wall below a particle [m].
    pub fn place(&self, mut position: [f64; 3]) -> [f64; 2] {
        self.images.wrap(&mut position);
        [position[0], position[1]].map(|x| x * self.units.length)
    }

    /// Exchanges a particle that meets its image at a plane with it: two mirror images that pass
    /// through each other do exactly that.
    pub fn rebound(&self, part: &mut Part, pushes: &mut Vec<Push>) {
        let momentum = self.units.mass() * self.units.speed;
        for k in 0..part.mass.len() {
            let below = part.position[k][2] < 0.0;
            let signs = self.images.reflect_back(&mut part.position[k]);
            if signs == [1.0; 3] {
                continue;
            }
            (0..3).for_each(|a| part.velocity[k][a] *= signs[a]);
            // Without a wall nothing receives the impulse.
            if below && signs[2] < 0.0 {
                let impulse = -2.0 * momentum * part.mass[k] * part.velocity[k][2];
                pushes.push((self.place(part.position[k]), [0.0, 0.0, impulse]));
            }
        }
    }

    /// First step of an advance where sound limits none: fluid that is let go is slow, and gains speed within it.
    pub fn first_step(&self, most_accelerated: f64) -> f64 {
        match self.solves_pressure {
            true => (2.0 * self.way() / most_accelerated).sqrt(),
            false => f64::INFINITY,
        }
    }

    /// Largest distance over H that particles move in a time step with implicit viscosity.
    fn way(&self) -> f64 {
        if self.fed { MOST_WAY_OF_STRANDS } else { MOST_WAY }
    }

    /// Longest step after one.
    pub fn next_step(&self, dt: f64) -> f64 {
        if self.solves_pressure { LENGTHENED * dt } else { f64::INFINITY }
    }

    /// Largest stable step, over H/c₀.
    pub fn stable_step(&self, fastest: f64, most_accelerated: f64) -> f64 {
        let advective = match self.implicit {
            true => self.way() / fastest,
            false => f64::INFINITY,
        };
        [
            self.acoustic_step(fastest),
            advective,
            self.viscous_step(),
            self.diffusive_step(),
            self.conductive_step(),
            self.forced_step(most_accelerated),
            self.capillary_step(),
        ]
        .into_iter()
        .fold(f64::INFINITY, f64::min)
    }

    /// Time step at a speed of the flow [m/s], over H/c₀.
    pub fn step_at(&self, fastest: f64) -> f64 {
        self.stable_step(fastest / self.units.speed, 0.0)
    }

    /// Expected cost of a time step over that of one with explicit viscosity.
    pub fn step_cost(&self) -> f64 {
        if !self.implicit {
            return 1.0;
        }
        1.0 + SETUP_COST + PRODUCT_COST * self.products(self.step_at(0.0))
    }

    /// Expected number of products with the matrix of implicit viscosity in a time step.
    fn products(&self, dt: f64) -> f64 {
        let turns = if self.flow.is_newtonian() { 1.0 } else { TURNS };
        if self.solves_pressure {
            return turns * PRODUCTS_WITH_PRESSURE;
        }
        turns * PRODUCTS * (self.viscosity * dt).powf(PRODUCTS_BY_STIFFNESS)
    }

    /// Acoustic limit of the time step; without viscosity, a fraction of H/c₀. There is none where pressure is solved
    /// at the end of a step.
    ///
    /// A wave of frequency ω under the damping λ of implicit viscosity grows in no step with
    /// `ω²Δt² < 4 + 2λΔt`. As sound is damped by `λ = 3ν k²`, `λ/ω² = 3ν/c²` for all wave numbers k.
    fn acoustic_step(&self, fastest: f64) -> f64 {
        if self.solves_pressure {
            return f64::INFINITY;
        }
        let undamped = self.shares.courant / (1.0 + fastest);
        let part = if self.uniform { 1.0 } else { BY_VOLUME };
        self.damped(undamped, part * DAMPED_SOUND * self.viscosity)
    }

    /// Step that implicit viscosity allows in place of an undamped one, from the ratio `s λ/ω²` of a
    /// wave's damping and the square of its frequency, with the share s in `ω²Δt² < 4s + 2sλΔt`.
    fn damped(&self, undamped: f64, ratio: f64) -> f64 {
        if !self.implicit {
            return undamped;
        }
        ratio + (ratio * ratio + undamped * undamped).sqrt()
    }

    /// Same, for motion that shear viscosity damps: fluid may be thinner than the reference where that depends on
    /// temperature or rate, so nothing is relied upon there.
    fn damped_by_shear(&self, undamped: f64, ratio: f64) -> f64 {
        if self.uniform { self.damped(undamped, ratio) } else { undamped }
    }

    /// Limit of the time step at which no acceleration moves a particle by more than a fraction of
    /// H; implicit viscosity resists what differs between neighbours.
    fn forced_step(&self, most_accelerated: f64) -> f64 {
        let share = if self.fed { (2.0 * self.way()).sqrt() } else { self.shares.forced };
        let undamped = share / most_accelerated.sqrt();
        self.damped_by_shear(undamped, 0.5 * undamped * undamped * DAMPED_PARTICLE * self.viscosity)
    }

    /// Conductive limit of the time step, for the phase of the larger diffusivity.
    pub fn conductive_step(&self) -> f64 {
        let fastest = self.phases.map_or(1.0, |phases| phases.fastest());
        self.shares.conductive / (fastest * self.conduction)
    }

    /// Diffusive limit of the time step; implicit viscosity reduces the diffusion instead.
    fn diffusive_step(&self) -> f64 {
        if self.implicit {
            return f64::INFINITY;
        }
        self.shares.diffusive * self.diffusive_step
    }

    /// δ of the density diffusion in a time step: at most what is stable.
    pub fn diffusion(&self, dt: f64) -> f64 {
        if !self.implicit {
            return self.diffusion;
        }
        self.diffusion * (self.shares.diffusive * self.diffusive_step / dt).min(1.0)
    }

    /// Viscous limit of the time step; that of implicit viscosity is its solver's. The sums of viscosity have no rate
    /// above twice their diagonal, `(4d/m) ν`, with m the kernel's second moment. Accelerations use velocities
    /// predicted ahead, so nothing grows whose rate times the step is below 1.
    fn viscous_step(&self) -> f64 {
        if self.implicit {
            return STIFFEST / self.viscosity;
        }
        let sticking = if self.phases.is_some() { STICKING_PAIR } else { 1.0 };
        self.shares.viscous / (2.0 * self.pair_viscosity * sticking)
    }

    /// Capillary limit of the time step, for the shortest wave that surface tension, smoothed over
    /// h, still drives.
    fn capillary_step(&self) -> f64 {
        let Some(Setting { energy, .. }) = &self.surface else { return f64::INFINITY };
        let wave = energy.smoothing.reach;
        let undamped = self.shares.capillary * (wave.powi(3) / (16.0 * PI * self.tension)).sqrt();
        self.damped_by_shear(undamped, DAMPED_TENSION * self.viscosity * wave / self.tension)
    }

    /// Number of steps between impulses of surface tension.
    pub fn turn(&self, dt: f64) -> f64 {
        if self.surface.is_none() {
            return 1.0;
        }
        (self.capillary_step() / dt).floor().clamp(1.0, MOST_STEPS_PER_IMPULSE)
    }
}

/// Diffusive limit of the time step. The sums of density diffusion have no rate above twice their
/// diagonal, `δ ∫ −F dV`. Their steps are explicit Euler steps, so nothing grows whose rate times
/// the step is below 2.
fn diffusive_step(plan: &DropletPlan) -> f64 {
    1.0 / (plan.density_diffusion * plan.kernel.mean_slope(plan.dimension))
}

/// Pair coefficient of a viscosity over c₀H.
fn pair_viscosity(plan: &DropletPlan, viscosity: f64) -> f64 {
    let moment = plan.kernel.second_moment(plan.dimension);
    2.0 * plan.dimension as f64 / moment * viscosity
}
