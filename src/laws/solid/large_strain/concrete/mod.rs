//! Concrete: the law of Karagozian & Case with three strength surfaces.
//!
//! Elastic strain is logarithmic, `b_e = F C_p⁻¹ Fᵀ`, `ε = ½ ln b_e`, and linear in the Kirchhoff stress, `τ = κ tr ε 1 + 2 µ dev
//! ε`, so that the law is objective, its energy is elastic, and its return is that of small strains in principal axes (J. C.
//! Simo 1992, doi 10.1016/0045-7825(92)90123-2). With the pressure `p = −⅓ tr τ` and `q = √(3 J₂)`:
//!
//! - Strength: `q ≤ r(θ, p) Δσ(p, λ)`, `Δσ = η Δσ_m + (1 − η) Δσ_y` up to the peak λ_m of the damage function η(λ),
//!   beyond it `η Δσ_m + (1 − η) Δσ_r` ([`Surfaces`], [`DamageFunction`]).
//! - Flow: the deviator returns radially, and the volume grows by `ω r Δσ′` per `Δε̄`, with the dilatancy ω: 0 keeps
//!   the volume, 1 flows along the normal. Δσ′ is a mean slope ([`Concrete::slope`]).
//! - Damage: `dλ = dε̄ᵖ/(1 + p/f_t)^b`, b = b₁ in compression and b₂ in tension, with `ε̄ᵖ = ∫ √(⅔ ε̇ᵖ:ε̇ᵖ)`; with b₂ > 0
//!   `1 + p/f_t` counts as ⅔ at least, its value in uniaxial tension.
//! - Opening: `p ≥ −f_t`, beyond the peak `p ≥ −η f_t`; volume that opens there damages, `dλ = b₃ dε_v`. The source
//!   does so only close to the axis of pressure, where it is needed.
//! - Compaction: `p ≤ p_c(ε_c)` over the plastic change of volume ε_c, if there is a table.
//!
//! Over a step dλ/dε̄ᵖ is the mean of its ends and Δσ′ that of its middle, of second order in the step: softening that is
//! nearly as fast as elastic strain recovers makes errors of λ grow.
//!
//! Sources: L. J. Malvar et al. 1997, doi 10.1016/S0734-743X(97)00023-7; Y. Wu, D. Wang & C.-T. Wu 2014 use the law in
//! meshfree bodies. Effects of the rate are left out.

mod damage;
pub mod energy;
mod surfaces;

pub use damage::DamageFunction;
pub use surfaces::Surfaces;

use super::{Deformed, Isochoric, Tangent};
use crate::math::matrix3::{Matrix3, eigen, full, packed, product, transposed};

/// Constants of concrete.
#[derive(Debug, Clone, PartialEq)]
pub struct Concrete {
    pub surfaces: Surfaces,
    pub function: DamageFunction,
    /// b₁ and b₂.
    pub exponents: [f64; 2],
    /// b₃.
    pub opening: f64,
    /// ω.
    pub dilatancy: f64,
    /// Damage from which on a node counts as broken.
    pub broken: f64,
    /// p_c [Pa] over ε_c, linear between its points and beyond the last; elastic if empty.
    pub compaction: Vec<[f64; 2]>,
}

/// A point while it returns.
struct Point {
    /// [Pa]
    p: f64,
    q: f64,
    /// ε̄ᵖ, λ and ε_c.
    strain: f64,
    lambda: f64,
    compaction: f64,
}

/// Elastic strains of a point in principal axes.
struct Principal {
    /// Deviators [1].
    deviator: [f64; 3],
    /// Columns are the axes.
    axes: Matrix3,
}

impl Concrete {
    /// `C_p⁻¹ − 1` (xx, yy, zz, xy, yz, xz), ε̄ᵖ, λ, ε_c and p.
    pub const HISTORY: usize = 10;
    /// Place of ε̄ᵖ.
    pub const STRAIN: usize = 6;
    /// Place of λ.
    pub const LAMBDA: usize = 7;
    const COMPACTION: usize = 8;
    const PRESSURE: usize = 9;

    /// Returns true if a run may produce a history of a point.
    pub fn is_sound(history: &[f64]) -> bool {
        history[Self::STRAIN..=Self::COMPACTION].iter().all(|own| *own >= 0.0)
    }

    /// Part of the strength that a history of a point has lost.
    pub fn damage(&self, history: &[f64]) -> f64 {
        self.function.damage(history[Self::LAMBDA])
    }

    /// Change of η on the way of a point from a history to another.
    pub fn passed(&self, from: &[f64], to: &[f64]) -> f64 {
        self.function.passed(to[Self::LAMBDA]) - self.function.passed(from[Self::LAMBDA])
    }

    /// Advances the history; returns the whole stress, that of the dilatation included.
    pub fn respond(&self, moduli: [f64; 2], at: &Deformed, history: &mut [f64]) -> Isochoric {
        let [bulk, shear] = moduli;
        let mut plastic = full(std::array::from_fn(|n| history[n]));
        (0..3).for_each(|a| plastic[a][a] += 1.0);
        let trial = product(&product(&at.gradient, &plastic), &transposed(&at.gradient));
        let (strains, axes) = logarithms(trial);
        let volume: f64 = strains.iter().sum();
        let principal = Principal { deviator: strains.map(|own| own - volume / 3.0), axes };
        let squares: f64 = principal.deviator.iter().map(|own| own * own).sum();
        let trial = Point {
            p: -bulk * volume,
            q: 2.0 * shear * (1.5 * squares).sqrt(),
            strain: history[Self::STRAIN],
            lambda: history[Self::LAMBDA],
            compaction: history[Self::COMPACTION],
        };
        let before = [trial.p, trial.q];
        let from = history[Self::PRESSURE];
        let point = self.returned(moduli, cosine(&principal.deviator), from, trial);
        let left = if before[1] > 0.0 { point.q / before[1] } else { 1.0 };
        let deviator = principal.deviator.map(|own| left * own);
        if before != [point.p, point.q] {
            let mean = -point.p / (3.0 * bulk);
            let squared = deviator.map(|own| (2.0 * (own + mean)).exp());
            let b = turned(&principal.axes, squared);
            let back = transposed(&at.inverse_transposed);
            let plastic = packed(&product(&product(&back, &b), &at.inverse_transposed));
            for (n, value) in plastic.into_iter().enumerate() {
                history[n] = if n < 3 { value - 1.0 } else { value };
            }
        }
        history[Self::STRAIN] = point.strain;
        history[Self::LAMBDA] = point.lambda;
        history[Self::COMPACTION] = point.compaction;
        history[Self::PRESSURE] = point.p;
        let stress = turned(&principal.axes, deviator.map(|own| 2.0 * shear * own - point.p));
        let square: f64 = deviator.iter().map(|own| own * own).sum();
        Isochoric {
            stress: product(&stress, &at.inverse_transposed),
            energy: 0.5 * point.p * point.p / bulk + shear * square,
            wave: (bulk + 4.0 / 3.0 * shear) * at.steepest(),
        }
    }

    /// `∂P/∂F` over a step from a history, by central differences.
    pub fn tangent(&self, moduli: [f64; 2], at: &Deformed, before: &[f64]) -> Tangent {
        let mut tangent = [[0.0; 9]; 9];
        for column in 0..9 {
            let stress = |by: f64| {
                let mut gradient = at.gradient;
                gradient[column / 3][column % 3] += by;
                let mut history: [f64; Self::HISTORY] = std::array::from_fn(|n| before[n]);
                self.respond(moduli, &Deformed::of(gradient), &mut history).stress
            };
            let (up, down) = (stress(DIFFERENCE), stress(-DIFFERENCE));
            for (row, line) in tangent.iter_mut().enumerate() {
                let (a, b) = (row / 3, row % 3);
                line[column] = (up[a][b] - down[a][b]) / (2.0 * DIFFERENCE);
            }
        }
        tangent
    }

    /// Δσ.
    fn strength(&self, p: f64, lambda: f64) -> f64 {
        let eta = self.function.value(lambda);
        if lambda > self.function.peak {
            return self.softened(p, eta);
        }
        eta * self.surfaces.strength(p) + (1.0 - eta) * self.surfaces.yielding(p)
    }

    /// Δσ beyond the peak.
    fn softened(&self, p: f64, eta: f64) -> f64 {
        eta * self.surfaces.strength(p) + (1.0 - eta) * self.surfaces.residual(p)
    }

    /// Δσ′, the slope of a surface over the pressure: in compression its mean over the last f_t, as a slope that jumped
    /// where parts of a surface meet would have stress jump over strain. In tension surfaces are straight.
    fn slope(&self, p: f64, surface: impl Fn(f64) -> f64) -> f64 {
        let (p, tensile) = (p.max(0.0), self.surfaces.tensile);
        (surface(p) - surface(p - tensile)) / tensile
    }

    /// Tension that the material bears from all sides.
    fn cut_off(&self, lambda: f64) -> f64 {
        let left = if lambda <= self.function.peak { 1.0 } else { self.function.value(lambda) };
        left * self.surfaces.tensile
    }

    /// Change of λ per ε̄ᵖ at a pressure.
    fn damaging(&self, p: f64) -> f64 {
        let [compressed, drawn] = self.exponents;
        let base = 1.0 + p / self.surfaces.tensile;
        // Beyond uniaxial tension a positive exponent would have damage grow without bound.
        let least = if drawn > 0.0 { OF_UNIAXIAL_TENSION } else { NO_PRESSURE };
        if p >= 0.0 { base.powf(-compressed) } else { base.max(least).powf(-drawn) }
    }

    /// Brings a point back to the surfaces, in a step from a pressure.
    fn returned(&self, moduli: [f64; 2], cosine: f64, from: f64, trial: Point) -> Point {
        let mut point = trial;
        self.compact(moduli[0], &mut point);
        // Flow that dilates closes what would open, so it comes first.
        for _ in 0..PASSES {
            self.flow(moduli, cosine, from, &mut point);
            if !self.open(moduli[0], &mut point) {
                break;
            }
        }
        point
    }

    fn compact(&self, bulk: f64, point: &mut Point) {
        if self.compaction.is_empty() || point.p <= crushing(&self.compaction, point.compaction) {
            return;
        }
        let (p, own) = (point.p, point.compaction);
        let excess = |change: f64| p - bulk * change - crushing(&self.compaction, own + change);
        let change = root(&excess, p / bulk);
        point.p -= bulk * change;
        point.compaction += change;
    }

    /// Opens a point beyond the tension that it bears; returns true if it opened.
    fn open(&self, bulk: f64, point: &mut Point) -> bool {
        let (p, lambda) = (point.p, point.lambda);
        if -p <= (1.0 + ROUNDING) * self.cut_off(lambda) {
            return false;
        }
        let excess =
            |change: f64| -p - bulk * change - self.cut_off(lambda + self.opening * change);
        let change = root(&excess, -p / bulk);
        point.p += bulk * change;
        point.lambda += self.opening * change;
        point.strain += 2.0_f64.sqrt() / 3.0 * change;
        true
    }

    /// Lets a point flow beyond its strength, in a step from a pressure.
    fn flow(&self, moduli: [f64; 2], cosine: f64, from: f64, point: &mut Point) {
        let section = |p: f64| Surfaces::section(self.surfaces.ratio(p), cosine);
        let (p, q, lambda) = (point.p, point.q, point.lambda);
        if q <= (1.0 + ROUNDING) * section(p) * self.strength(p, lambda) {
            return;
        }
        let growth = |p: f64, lambda: f64| {
            self.dilatancy * section(p) * self.slope(p, |p| self.strength(p, lambda))
        };
        let (mut middle, mut flowed) = ([p, lambda], None);
        for _ in 0..MIDDLES {
            let own = self.flowed(moduli, &section, (growth(middle[0], middle[1]), from), point);
            middle = [0.5 * (from + own.p), 0.5 * (lambda + own.lambda)];
            flowed = Some(own);
        }
        if let Some(own) = flowed {
            *point = own;
        }
    }

    /// A point after its flow with a growth of the volume per flow of the deviator.
    fn flowed(
        &self,
        [bulk, shear]: [f64; 2],
        section: &dyn Fn(f64) -> f64,
        (growth, from): (f64, f64),
        &Point { p, q, strain, lambda, compaction }: &Point,
    ) -> Point {
        // ε̄ᵖ per flow of the deviator.
        let whole = (1.0 + 2.0 / 9.0 * growth * growth).sqrt();
        let pressed = |flow: f64| p + bulk * growth * flow;
        let at_first = self.damaging(from);
        let damaged =
            |flow: f64| lambda + 0.5 * (at_first + self.damaging(pressed(flow))) * whole * flow;
        let excess = |flow: f64| {
            let pressure = pressed(flow);
            let bound = section(pressure) * self.strength(pressure, damaged(flow));
            q - 3.0 * shear * flow - bound
        };
        let flow = root(&excess, q / (3.0 * shear));
        Point {
            p: pressed(flow),
            q: (q - 3.0 * shear * flow).max(0.0),
            strain: strain + whole * flow,
            lambda: damaged(flow),
            compaction,
        }
    }
}

/// Rounds in which the middle of a flow is found.
const MIDDLES: usize = 2;
/// Change of an entry of F in differences.
const DIFFERENCE: f64 = 1e-7;
/// Part of a strength that is rounding.
const ROUNDING: f64 = 1e-12;
/// Rounds of opening and flow, each of which damages the other's bound.
const PASSES: usize = 30;
/// Smallest `1 + p/f_t`, and that of uniaxial tension at its peak.
const NO_PRESSURE: f64 = 1e-6;
const OF_UNIAXIAL_TENSION: f64 = 2.0 / 3.0;
/// Iterations of a root, and the share of the first excess at which it is found.
const ITERATIONS: usize = 100;
const CONVERGED: f64 = 1e-14;

/// Smallest root that bracketing finds between 0, where a function is positive, and `most`, where it is not: regula
/// falsi with halved weights (Illinois), and a bisection in every third iteration.
fn root(function: &dyn Fn(f64) -> f64, most: f64) -> f64 {
    let (mut low, mut high) = ([0.0, function(0.0)], [most, function(most)]);
    let enough = CONVERGED * low[1].abs().max(high[1].abs());
    let mut side = 0;
    for n in 0..ITERATIONS {
        let x = match n % 3 {
            2 => 0.5 * (low[0] + high[0]),
            _ => (low[0] * high[1] - high[0] * low[1]) / (high[1] - low[1]),
        };
        let value = function(x);
        if value.abs() <= enough || high[0] - low[0] <= CONVERGED * most * f64::EPSILON {
            return x;
        }
        if value > 0.0 {
            low = [x, value];
            high[1] *= if side == 1 { 0.5 } else { 1.0 };
            side = 1;
        } else {
            high = [x, value];
            low[1] *= if side == -1 { 0.5 } else { 1.0 };
            side = -1;
        }
    }
    high[0]
}

/// Pressure that compacts [Pa].
fn crushing(table: &[[f64; 2]], compaction: f64) -> f64 {
    let segments = || table.windows(2);
    let pair = segments().find(|pair| compaction < pair[1][0]).or(segments().last());
    pair.map_or(table[0][1], |pair| {
        let slope = (pair[1][1] - pair[0][1]) / (pair[1][0] - pair[0][0]);
        pair[0][1] + slope * (compaction - pair[0][0])
    })
}

/// Logarithmic strains `½ ln b` and their axes, as columns.
fn logarithms(b: Matrix3) -> ([f64; 3], Matrix3) {
    let beyond: Matrix3 =
        std::array::from_fn(|i| std::array::from_fn(|j| b[i][j] - if i == j { 1.0 } else { 0.0 }));
    let (values, axes) = eigen(&beyond);
    (values.map(|value| 0.5 * value.ln_1p()), axes)
}

/// `Σ v_a n_a ⊗ n_a`.
fn turned(axes: &Matrix3, values: [f64; 3]) -> Matrix3 {
    std::array::from_fn(|i| {
        std::array::from_fn(|j| (0..3).map(|a| values[a] * axes[i][a] * axes[j][a]).sum())
    })
}

/// Cosine of the Lode angle of a deviator, 1 in triaxial extension and ½ in triaxial compression.
fn cosine(deviator: &[f64; 3]) -> f64 {
    let half: f64 = 0.5 * deviator.iter().map(|own| own * own).sum::<f64>();
    if half == 0.0 {
        return 1.0;
    }
    let largest = deviator.iter().fold(f64::NEG_INFINITY, |most, own| most.max(*own));
    (0.75_f64.sqrt() * largest / half.sqrt()).clamp(0.5, 1.0)
}

#[cfg(test)]
mod tests;
