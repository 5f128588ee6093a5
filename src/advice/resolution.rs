//! Measured errors of particles of some spacing for a drop that hits a wall.
//!
//! Drops of six liquids were computed (water, tin, mercury, wax, glycerol, molten steel; 0.1 mm, 1.5 to 50 m/s, so Re 2
//! to 44 000, We 3 to 7000, Pe 8 to 57 000) with 10 to 40 particles over the diameter and compared with 56, on a wall
//! of constant temperature, until 3 D/U (`docs/limits.md`). The law holds from Re 6 on, within the other ranges
//! ([`OF_HEAT`]): at Re 2 glycerol has +15 % and silicone oil −10 % with n = 20, where it predicts +5 %. Below Re 2
//! drops rest on a flat into which they have sunk by some Δx, so the heat depends on which columns of the lattice
//! touch. Beyond its ranges the estimate is the interval [`CAUTIOUS`]. The error `e` of the heat transferred, with
//! `n = D/Δx` and `τ = Ut/D`, is
//!
//! `e = y/sinh y · (0.055 (20/n)^1.7 min(1, v/v₀) − 0.5 √(20/n) τ^0.2 max(0, 1 − v/v₀))`, `v = n/√Re`, `v₀ = 0.9`
//!
//! - `v` is the number of particles across the viscous layer `√(νD/U)`. With fewer than one, the spreading sheet is too
//!   thick and too small. Thinner particles carry heat away too fast, as their layer at the wall slips.
//! - `y = 34 √(τ/Pe)`, Pe = UD/a, measures how far the film has cooled through: a film that has transferred all its
//!   heat has no deficit.
//!
//! These results are for a wall or a solid that conducts at least as well as the fluid. On poorer conductors drops do
//! not cool, and heat is proportional to the wetted area. The errors of the same liquids on aerogel, PMMA and glass are
//! −57 % to 22 %, largest where films break up (`docs/maps/coupling.md`). Drops with less than 0.35 particles across
//! the viscous layer (mercury and tin at n = 20) lose 5 % to 57 %. The error is 10 % at most with 0.48 and more (molten
//! steel, water, wax, glycerol), except on near-insulators. There (water, wax and molten steel on aerogel, 0.1 mm at 5
//! to 40 m/s and 1 mm at 3 m/s, compared with 56 particles) the error of heat is −30 % to 21 %, of either sign, with
//! 0.36 to 0.75 particles across it, and 5 % at most with 0.9 and more.
//!
//! Below the middle of a drop whose thermal layer `√(aD/U)` is thinner than half a particle the temperature rises 11 %
//! to 35 % too high at n = 20, and some per cent at 50, on solids that conduct at least as well (water, wax and
//! glycerol at 15 m/s, `docs/maps/coupling.md`); with 0.54, 0.62 and 0.73 particles across it 9 % to 19 %, 11 % to 16 %
//! and 6 % to 15 % (0.1 mm of water at 2, 1.5 and 1.1 m/s on glass, compared with n = 50).
//!
//! The coefficients are those for which `(1 + e(n))/(1 + e(56)) − 1` fits the measurements best. The residual is 6 %
//! (root mean square): 8 % at n = 10, 5 % at 20, 3 % at 40. At Re 17 000, compared with 226 particles, it predicts 8 %
//! to 9 % too little at any n.

use crate::closed_form::FittedRange;
use crate::closed_form::fitted_range::outside;
use crate::scene::{Droplet, Scene};

/// Ranges over which the law of heat was fitted. Above We 3 tension has no effect, so drops without tension are within.
const OF_HEAT: [FittedRange; 4] = [
    FittedRange::of("Re", [6.0, 44_000.0]),
    FittedRange::of("We", [3.0, f64::INFINITY]),
    FittedRange::of("Pe", [8.0, 57_000.0]),
    FittedRange::of("D/Δx", [10.0, f64::INFINITY]),
];
/// Range over which drops were seen to overheat in the middle: under honey of Re 0.7 it rises 3 % too high.
const OF_MIDDLE: FittedRange = FittedRange::of("Re", [6.0, 44_000.0]);
/// Ranges over which the errors of the spread were measured.
const OF_SPREAD: [FittedRange; 2] =
    [FittedRange::of("Re", [27.0, 2000.0]), FittedRange::of("We", [27.0, 400.0])];
/// Range over which the errors of force were measured.
const OF_FORCE: [FittedRange; 1] = [FittedRange::of("Re", [2.0, 44_000.0])];

/// Factors of the law above.
const TOO_LITTLE: f64 = 0.5;
const TOO_MUCH: f64 = 0.055;
const OF_SLIP: f64 = 1.7;
const USUAL: f64 = 20.0;
const LAYER: f64 = 0.9;
const GROWTH: f64 = 0.2;
const COOLED: f64 = 34.0;
/// Interval of τ over which the law was measured.
const TIMES: [f64; 2] = [0.5, 3.0];
/// τ before which there is no estimate.
const EARLIEST: f64 = 0.25;
/// Residual scatter of the law, times √n.
const SCATTER: f64 = 0.25;
/// Particles across the thermal layer below which the middle overheats; particles over the drop below which it is known
/// to overheat, and a number that is known to suffice.
const THIN_LAYER: f64 = 0.75;
const TOO_FEW_FOR_MIDDLE: f64 = 45.0;
const FOR_MIDDLE: f64 = 50.0;
/// Effusivity of the material below over that of the fluid from which on the middle overheats: glass under water.
const WARMED: f64 = 0.85;
/// Particles across the viscous layer below which films on poor conductors break up, and with which they stay intact.
const BROKEN: f64 = 0.35;
const WHOLE: f64 = 0.48;
/// Effusivity of the material below over that of the fluid below which it nearly insulates, and particles across the
/// viscous layer that then resolve the wetted area.
const INSULATES: f64 = 0.1;
const WETTED: f64 = 0.9;
/// Errors of the largest spread over Δx/D, lowest and highest: at We 30, Re 500 relative to finer particles, and at Re
/// 27 relative to volumes of fluid (`tests/verification/README.md`).
const SPREAD: [f64; 2] = [0.7, 2.4];
/// The same errors elsewhere: the map of spreads at n = 20 (We 3 to 1000, Oh 0.003 to 0.3, relative to a fit of
/// measurements, `docs/maps/fluids.md`) has errors of up to 29 % except where the film tears.
const SPREAD_ANYWHERE: [f64; 2] = [0.7, 5.8];
/// Errors of mean forces over 0.1 D/U (root mean square), times n², of particles and of rings, which form columns at
/// the axis; and the smallest error seen for any number of particles.
const FORCE: f64 = 22.0;
const FORCE_OF_RINGS: f64 = 40.0;
const LEAST_FORCE: f64 = 0.01;

/// Half width of the interval of errors of heat outside of the fitted ranges, and the D/Δx from which on it decreases
/// as 1/n. Relative to D/Δx 40 to 80, drops of Re 0.1 to 0.7 had −39 % to +48 % with D/Δx 10 to 28, and the map of
/// films −57 % with D/Δx 6.
const CAUTIOUS: f64 = 0.6;
const CAUTIOUS_UNTIL: f64 = 40.0;

/// Estimate of the relative error of heat.
#[derive(Debug, Clone, PartialEq)]
pub struct HeatError {
    pub expected: f64,
    /// Half width of the interval about it.
    pub half: f64,
    /// Numbers of the drop outside of the ranges of the fitted law; the interval is then a conservative one.
    pub outside: Option<String>,
}

/// A drop, its particles, and its time on the wall.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Resolution {
    /// D/Δx
    across: f64,
    reynolds: f64,
    /// ρU²D/σ; infinite without tension.
    weber: f64,
    /// UD/a; `None` for a fluid that does not conduct.
    peclet: Option<f64>,
    /// Time on the wall over D/U.
    time: f64,
    /// Thickness of the film over D at that time.
    thickness: f64,
    is_of_rings: bool,
    /// Effusivity of the material below over that of the fluid; `None` for a wall of constant temperature.
    contrast: Option<f64>,
}

impl Resolution {
    /// Resolution of the first drop of a droplet of particles in space, at the stop time of a scene; `None` if no drop
    /// lands by then.
    pub fn of(scene: &Scene, (name, droplet): (&str, &Droplet)) -> Option<Self> {
        if droplet.dimension == 2 || !droplet.has_particles() {
            return None;
        }
        let begin = droplet.arrivals().first().map_or(0.0, |arrival| arrival.time);
        let (speed, fall) = droplet.contact(droplet.normal_speed());
        let on_wall = match droplet.is_replayed() {
            true => droplet.recorded_time(speed),
            false => scene.stop_time - begin - fall,
        };
        if !(on_wall > 0.0 && speed > 0.0) {
            return None;
        }
        let fluid = &droplet.fluid;
        let time = on_wall * speed / droplet.diameter;
        // The area grows as `√(3Ut/D)` at first.
        let area = (3.0 * time).min((droplet.spread_diameter() / droplet.diameter).powi(2));
        let capacity = fluid.density * fluid.specific_heat;
        let peclet = speed * droplet.diameter * capacity / fluid.conductivity;
        Some(Self {
            across: droplet.diameter / droplet.spacing,
            reynolds: fluid.density * speed * droplet.diameter / droplet.reference_viscosity(),
            weber: fluid.density * speed.powi(2) * droplet.diameter / fluid.surface_tension,
            peclet: Some(peclet).filter(|peclet| peclet.is_finite()),
            time,
            thickness: 2.0 / 3.0 / area.max(1.0),
            is_of_rings: droplet.is_axisymmetric(),
            contrast: scene.effusivity_below(name).map(|below| below / fluid.effusivity()),
        })
    }

    pub fn across(&self) -> f64 {
        self.across
    }

    /// Final thickness of the film over D.
    pub fn thickness(&self) -> f64 {
        self.thickness
    }

    /// Particles across the final film, and across its viscous layer.
    pub fn layers(&self) -> [f64; 2] {
        [self.thickness, 1.0 / self.reynolds.sqrt()].map(|length| length * self.across)
    }

    /// Particles across the thermal layer √(aD/U), if the fluid conducts.
    pub fn thermal_layers(&self) -> Option<f64> {
        self.peclet.map(|peclet| self.across / peclet.sqrt())
    }

    /// Returns true if the material below conducts at least as well as the fluid.
    pub fn conducts(&self) -> bool {
        self.conducts_at_least(1.0)
    }

    fn conducts_at_least(&self, contrast: f64) -> bool {
        self.contrast.is_none_or(|own| own >= contrast)
    }

    /// Number of particles over the diameter that keeps a film on a poor conductor intact, if the present number does
    /// not.
    pub fn across_for_film(&self) -> Option<f64> {
        let viscous = self.layers()[1];
        let breaks = !self.conducts() && viscous < BROKEN && self.time >= EARLIEST;
        breaks.then(|| self.across * WHOLE / viscous)
    }

    /// Number of particles over the diameter that resolves the wetted area of a film, if only that limits the heat and
    /// the present number does not resolve it.
    pub fn across_for_area(&self) -> Option<f64> {
        let viscous = self.layers()[1];
        let insulates = !self.conducts_at_least(INSULATES) && self.time >= EARLIEST;
        (insulates && viscous < WETTED).then(|| self.across * WETTED / viscous)
    }

    /// Expected error of the heat transferred by the stop time, if any estimate exists: by the fitted law, or outside
    /// its ranges the interval of [`CAUTIOUS`].
    pub fn heat(&self) -> Option<HeatError> {
        if self.time < EARLIEST {
            return None;
        }
        let peclet = self.peclet?;
        let [reynolds, weber, peclet_range, across] = OF_HEAT;
        let numbers = [
            (reynolds, self.reynolds),
            (weber, self.weber),
            (peclet_range, peclet),
            // A drop of ten particles has ten up to rounding.
            (across, (1e6 * self.across).round() / 1e6),
        ];
        if let Some(outside) = outside(&numbers) {
            let half = CAUTIOUS * (CAUTIOUS_UNTIL / self.across).min(1.0);
            return Some(HeatError { expected: 0.0, half, outside: Some(outside) });
        }
        if !self.conducts() {
            return None;
        }
        let half = SCATTER / self.across.sqrt();
        Some(HeatError { expected: self.fitted_heat(peclet), half, outside: None })
    }

    /// The fitted law, see above.
    fn fitted_heat(&self, peclet: f64) -> f64 {
        let viscous = self.layers()[1] / LAYER;
        let time = self.time.clamp(TIMES[0], TIMES[1]);
        let cooled = COOLED * (self.time.max(TIMES[0]) / peclet).sqrt();
        let left = if cooled > 0.0 { cooled / cooled.sinh() } else { 1.0 };
        let coarse = USUAL / self.across;
        let much = TOO_MUCH * coarse.powf(OF_SLIP) * viscous.min(1.0);
        let little = TOO_LITTLE * coarse.sqrt() * time.powf(GROWTH) * (1.0 - viscous).max(0.0);
        left * (much - little)
    }

    /// Number of particles over the diameter that resolves the temperature rise under the middle of the drop, if the
    /// present number does not.
    pub fn across_for_middle(&self) -> Option<f64> {
        let is_thin = self.thermal_layers().is_some_and(|layers| layers < THIN_LAYER);
        let is_warmed = self.conducts_at_least(WARMED) && self.time >= EARLIEST;
        let is_off = is_thin
            && is_warmed
            && self.across < TOO_FEW_FOR_MIDDLE
            && OF_MIDDLE.contains(self.reynolds);
        is_off.then_some(FOR_MIDDLE)
    }

    /// Smallest number of particles over the diameter that is expected to keep an error of heat, if one is known.
    pub fn across_for_heat(&self, error: f64) -> Option<f64> {
        let mut finer = *self;
        while finer.across <= MOST {
            let heat = finer.heat()?;
            let size = if heat.outside.is_some() { heat.half } else { heat.expected.abs() };
            if size <= error {
                return Some(finer.across);
            }
            finer.across *= FINER;
        }
        None
    }

    /// Error of the largest spread, lowest and highest: as measured, or within the errors of the whole map of spreads.
    pub fn spread(&self) -> [f64; 2] {
        let rates = if self.outside_of_spread().is_some() { SPREAD_ANYWHERE } else { SPREAD };
        rates.map(|rate| rate / self.across)
    }

    /// Describes the numbers outside of the ranges over which errors of the spread were measured. Without tension only
    /// viscosity stops a drop, as at the largest We.
    pub fn outside_of_spread(&self) -> Option<String> {
        let [reynolds, weber] = OF_SPREAD;
        let own = if self.weber.is_finite() { self.weber } else { weber.bounds[1] };
        outside(&[(reynolds, self.reynolds), (weber, own)])
    }

    /// Error of mean forces over 0.1 D/U.
    pub fn force(&self) -> f64 {
        (self.force_rate() / self.across.powi(2)).max(LEAST_FORCE)
    }

    /// Describes the number outside of the range over which errors of force were measured.
    pub fn outside_of_force(&self) -> Option<String> {
        outside(&[(OF_FORCE[0], self.reynolds)])
    }

    /// Number of particles over the diameter that keeps an error of force, if one is known.
    pub fn across_for_force(&self, error: f64) -> Option<f64> {
        (error >= LEAST_FORCE).then(|| (self.force_rate() / error).sqrt())
    }

    fn force_rate(&self) -> f64 {
        if self.is_of_rings { FORCE_OF_RINGS } else { FORCE }
    }
}

/// Largest proposed number of particles over a diameter, and the ratio between successive trials.
const MOST: f64 = 200.0;
const FINER: f64 = 1.05;
