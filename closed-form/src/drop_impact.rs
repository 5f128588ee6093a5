//! Impact of a drop of diameter D and speed U on a dry wall: its spread and its force.
//!
//! With `Re = ρUD/µ`, `We = ρU²D/σ` and the contact angle θ:
//! - largest diameter over D, from the energies of motion, surface and viscous losses:
//!   `β = √((We + 12)/(3(1 − cos θ) + 4We/√Re))` (M. Pasandideh-Fard, Y. M. Qiao, S. Chandra and J. Mostaghimi 1996,
//!   Phys. Fluids 8, 650, doi 10.1063/1.868850);
//! - where viscosity stops the drop, `β = 0.61 (Re² Oh)^{1/6}`, `Oh = √We/Re` (B. L. Scheller and D. W. Bousfield 1995,
//!   AIChE J. 41, 1357, doi 10.1002/aic.690410602), and `β = 0.87 Re^{1/5} − 0.40 Re^{2/5} We^{−1/2}`
//!   (I. V. Roisman 2009, Phys. Fluids 21, 052104, doi 10.1063/1.3129283);
//! - base of the cap of the drop at rest, over D: `2 (tan(θ/2) (3 + tan²(θ/2)))^{−1/3}`, from its volume;
//! - width of the footprint just after the impact, `2.8 √τ`, τ = Ut/D, over D (R. Rioboo, M. Marengo and C. Tropea
//!   2002, Exp. Fluids 33, 112, doi 10.1007/s00348-002-0431-x);
//! - tension accelerates a drop slower than `√(2σ/(ρD))` to that speed, which replaces U in all times;
//! - force, with its maximum at 0.167 D/U (L. Gordillo, T.-P. Sun and X. Cheng 2018, J. Fluid Mech. 840, 190,
//!   doi 10.1017/jfm.2017.901): `F = A √t e^{−t/(0.334 D/U)}` with A such that `∫F dt = mU`.
//!
//! The energies were compared with water and tin (Re 200 to 35 000, We 26 to 640), Scheller and Bousfield's fit with
//! liquids of up to 0.3 Pa s (Re 19 to 16 400, Oh 0.002 to 0.58). Roisman's law and the force are those of large Re and
//! We. Together they were compared with drops of particles over [`FITTED`]. Below Re 1 the drop comes to rest on a
//! small flat, which none of them describes: the footprint is then several times too large.

use std::f64::consts::PI;

use super::fitted_range::{FittedRange, outside};

/// The drop and the numbers of its fluid.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DropImpact {
    /// D [m]
    pub diameter: f64,
    /// U [m/s]
    pub speed: f64,
    /// ρ [kg/m³]
    pub density: f64,
    /// µ [Pa s]
    pub viscosity: f64,
    /// σ [N/m]
    pub surface_tension: f64,
    /// θ [rad]
    pub contact_angle: f64,
}

/// Ranges over which footprints and the heat of films were compared with drops of particles (`docs/fidelity.md`).
pub const FITTED: [FittedRange; 2] =
    [FittedRange::of("Re", [4.0, 13_300.0]), FittedRange::of("We", [8.0, 800.0])];

/// Time of the maximum force over D/U.
const PEAK: f64 = 0.167;
/// Initial width of the footprint over D√τ.
const EARLY_SPREAD: f64 = 2.8;
/// Reynolds number above which footprints grow at their initial rate until they are widest.
const SUDDEN: f64 = 50.0;
/// Lower bound of contact angles: drops that wet better take impractically long to come to rest [rad].
const LEAST_ANGLE: f64 = 0.26;
/// F″(0) of the spreading film, see [`super::spreading_film`].
const WALL_SHEAR: f64 = 1.0354;
/// Lead of the film's flow u = r/(t + τ) over the impact, over D/U (Roisman 2009).
const LEAD: f64 = 0.25;

impl DropImpact {
    pub fn reynolds(&self) -> f64 {
        self.density * self.speed * self.diameter / self.viscosity
    }

    /// Weber number; infinite without tension.
    pub fn weber(&self) -> f64 {
        self.density * self.speed.powi(2) * self.diameter / self.surface_tension
    }

    /// Describes which numbers of the drop lie outside of [`FITTED`]; `None` if all lie within. A drop without tension
    /// has the spread of a large We.
    pub fn outside_of_fitted(&self) -> Option<String> {
        let [reynolds, weber] = FITTED;
        let own = if self.surface_tension > 0.0 { self.weber() } else { weber.bounds[1] };
        outside(&[(reynolds, self.reynolds()), (weber, own)])
    }

    /// Time scale of the impact [s]: D/U, or that of the motion by tension.
    pub fn time(&self) -> f64 {
        let pulled = (2.0 * self.surface_tension / (self.density * self.diameter)).sqrt();
        self.diameter / self.speed.max(pulled)
    }

    /// Time at which the footprint has come to rest to a hundredth [s].
    pub fn time_to_rest(&self) -> f64 {
        let largest = 0.5 * self.diameter * self.largest_spread();
        self.time_of_wetting(largest, 0.99 * largest)
    }

    /// Volume [m³].
    pub fn volume(&self) -> f64 {
        PI / 6.0 * self.diameter.powi(3)
    }

    /// Momentum mU [N s].
    pub fn momentum(&self) -> f64 {
        self.density * self.volume() * self.speed
    }

    /// Pasandideh-Fard's β.
    pub fn spread_by_energy(&self) -> f64 {
        let (weber, root) = (self.weber(), self.reynolds().sqrt());
        let wetting = 3.0 * (1.0 - self.contact_angle.cos());
        match weber.is_finite() {
            true => ((weber + 12.0) / (wetting + 4.0 * weber / root)).sqrt(),
            false => (0.25 * root).sqrt(),
        }
    }

    /// Scheller and Bousfield's β.
    pub fn spread_by_viscosity(&self) -> f64 {
        0.61 * (self.reynolds() * self.weber().sqrt()).powf(1.0 / 6.0)
    }

    /// Roisman's β.
    pub fn spread_by_inertia(&self) -> f64 {
        let reynolds = self.reynolds();
        0.87 * reynolds.powf(0.2) - 0.40 * reynolds.powf(0.4) / self.weber().sqrt()
    }

    /// β of a drop at rest: a cap with tension; without tension the diameter of the drop.
    pub fn spread_at_rest(&self) -> f64 {
        if self.surface_tension == 0.0 {
            return 1.0;
        }
        let slope = (0.5 * self.contact_angle.max(LEAST_ANGLE)).tan();
        2.0 / (slope * (3.0 + slope.powi(2))).cbrt()
    }

    /// Largest β: Roisman's where inertia dominates, that of the energies where it falls below (slow drops), Scheller
    /// and Bousfield's where viscosity stops the drop first. It is no less than β at rest, and no less than the drop's
    /// own width.
    pub fn largest_spread(&self) -> f64 {
        let inertial = self.spread_by_inertia().max(self.spread_by_energy());
        // For a drop that does not fall all three are NaN or zero; `max` then returns the following values.
        inertial.min(self.spread_by_viscosity()).max(self.spread_at_rest()).max(1.0)
    }

    /// Radius [m] of the footprint, which grows at first as `1.4 D√τ` and comes to rest at `R_max`:
    /// `R_max (1 − e^{−xᵖ})^{1/p}`, x = 1.4 D√τ/R_max, `p = 2 + 2 Re/(Re + 50)`: viscous drops come to rest gradually.
    /// The exponent is fitted to drops of particles (40 over D, Re 4 to 13 000, We 8 to 650): within 10 % where neither
    /// their films tear nor `R_max` falls short.
    pub fn wetted_radius(&self, largest: f64, time: f64) -> f64 {
        let sharpness = self.sharpness();
        let root = (time.max(0.0) / self.time()).sqrt();
        let power = (0.5 * EARLY_SPREAD * self.diameter * root / largest).powf(sharpness);
        largest * (-(-power).exp_m1()).powf(1.0 / sharpness)
    }

    /// Time at which the footprint reaches a radius [s]; infinite for `R_max` and beyond.
    pub fn time_of_wetting(&self, largest: f64, radius: f64) -> f64 {
        let sharpness = self.sharpness();
        let part = (radius / largest).powf(sharpness);
        if part >= 1.0 {
            return f64::INFINITY;
        }
        let root = (-(-part).ln_1p()).powf(1.0 / sharpness) * largest
            / (0.5 * EARLY_SPREAD * self.diameter);
        root.powi(2) * self.time()
    }

    fn sharpness(&self) -> f64 {
        let reynolds = self.reynolds();
        2.0 + 2.0 * if reynolds.is_finite() { reynolds / (reynolds + SUDDEN) } else { 1.0 }
    }

    /// Remaining fraction of the flow: zero when the footprint has come to rest.
    pub fn flows(&self, largest: f64, time: f64) -> f64 {
        1.0 - (self.wetted_radius(largest, time) / largest).powi(2)
    }

    /// Fraction of the momentum transferred to the wall, ∫F dt/(mU) = erf √x − 2√(x/π) e^{−x}, x = t/(0.334 D/U).
    pub fn momentum_given(&self, time: f64) -> f64 {
        let x = (time / (2.0 * PEAK * self.time())).max(0.0);
        libm::erf(x.sqrt()) - 2.0 * (x / PI).sqrt() * (-x).exp()
    }

    /// Age t + τ [s] of the flow u = r/(t + τ) of the spreading film.
    pub fn age(&self, time: f64) -> f64 {
        time + LEAD * self.time()
    }

    /// Shear at the wall under the spreading film [Pa], `F″(0) ρ √ν r (t + τ)^{−3/2}` (Roisman 2009).
    pub fn shear(&self, radius: f64, time: f64) -> f64 {
        let viscosity = self.viscosity / self.density;
        WALL_SHEAR * self.density * viscosity.sqrt() * radius * self.age(time).powf(-1.5)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const WATER: DropImpact = DropImpact {
        diameter: 2e-3,
        speed: 1.5,
        density: 998.0,
        viscosity: 1e-3,
        surface_tension: 0.072,
        contact_angle: 1.57,
    };

    /// Water at We 62, Re 3000: drops spread to 2.9 to 3.3 diameters (Clanet et al. 2004; Laan et al. 2014).
    #[test]
    fn spread_of_water_drops() {
        for spread in [WATER.spread_by_energy(), WATER.spread_by_inertia()] {
            assert!((2.6..3.5).contains(&spread), "{spread}");
        }
        let thick = DropImpact { viscosity: 0.5, ..WATER };
        assert!((1.0..1.5).contains(&thick.spread_by_viscosity()));
    }

    /// A hemisphere's base is 2^{1/3} D wide; mercury at We 5.6 spreads to 1.8 D, where Roisman's fit has 0.6 D.
    #[test]
    fn slow_drops_spread_by_tension() {
        let resting = DropImpact { speed: 0.0, contact_angle: 0.5 * PI, ..WATER };
        assert!((resting.largest_spread() / 2f64.cbrt() - 1.0).abs() < 1e-12);
        assert_eq!(DropImpact { surface_tension: 0.0, ..resting }.largest_spread(), 1.0);
        let wetting = DropImpact { contact_angle: 0.0, ..resting };
        assert!((2.0..3.0).contains(&wetting.largest_spread()));
        let mercury = DropImpact {
            diameter: 2e-4,
            speed: 1.0,
            density: 13_500.0,
            viscosity: 1.5e-3,
            surface_tension: 0.485,
            contact_angle: 0.5 * PI,
        };
        assert!(mercury.spread_by_inertia() < 0.7);
        assert!((1.8..2.3).contains(&mercury.largest_spread()), "{}", mercury.largest_spread());
    }

    #[test]
    fn footprint_growth_at_early_times() {
        let (largest, early) = (3e-3, 1e-6);
        let radius = WATER.wetted_radius(largest, early);
        let width = 2.8 * (early / WATER.time()).sqrt() * WATER.diameter;
        assert!((2.0 * radius / width - 1.0).abs() < 1e-3);
        assert!((WATER.wetted_radius(largest, 1.0) / largest - 1.0).abs() < 1e-12);
        let back = WATER.time_of_wetting(largest, radius);
        assert!((back / early - 1.0).abs() < 1e-9);
    }

    /// Tension pulls a drop of 5 µm at 0.3 m/s (We 0.006) down at 5.4 m/s. A drop of 3 mm at 80 m/s spreads to eleven
    /// diameters, which takes longer than usual.
    #[test]
    fn slow_drops_accelerate_by_tension_and_wide_ones_spread_longer() {
        let slow = DropImpact { diameter: 5e-6, speed: 0.3, ..WATER };
        assert!((slow.time() / (5e-6 / 5.37) - 1.0).abs() < 1e-3, "{}", slow.time());
        assert!((slow.momentum_given(5.0 * slow.time()) - 1.0).abs() < 1e-5);
        assert_eq!(WATER.time(), 2e-3 / 1.5);
        let wide = DropImpact { diameter: 3e-3, speed: 80.0, ..WATER };
        assert!((10.0..12.0).contains(&wide.largest_spread()));
        let rest = wide.time_to_rest();
        let reached = 2.0 * wide.wetted_radius(1.5e-3 * wide.largest_spread(), rest) / 3e-3;
        assert!((reached / wide.largest_spread() - 0.99).abs() < 1e-9);
        assert!(rest > 20.0 * wide.time() && WATER.time_to_rest() < 5.0 * WATER.time());
    }

    #[test]
    fn force_integrates_to_the_momentum_and_peaks_at_the_stated_time() {
        assert!((WATER.momentum_given(1.0) - 1.0).abs() < 1e-12);
        let time = WATER.time();
        let force = |x: f64| {
            let h = 1e-4 * time;
            (WATER.momentum_given(x * time + h) - WATER.momentum_given(x * time - h)) / (2.0 * h)
        };
        assert!(force(PEAK) > force(PEAK - 0.02) && force(PEAK) > force(PEAK + 0.02));
        // Of ρU²D²: 0.81 to 0.85 were measured (Zhang et al. 2022, doi 10.1103/PhysRevLett.129.104501).
        let peak = force(PEAK) * PI / 6.0 * time;
        assert!((0.7..0.9).contains(&peak), "{peak}");
    }
}
