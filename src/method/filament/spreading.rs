//! The width of a strand of section A that spreads on a plate. Its points move in proportion to their distance from the
//! centre line, and the half-width x follows from the balance of generalised forces: −dE/dx of the energies E of the
//! section, and its dissipation over ẋ.
//!
//! Per length of the strand, with ρ density, g gravity, σ surface tension, θ_e contact angle and τ_y yield stress:
//! - gravity drives with `F_g = c ρgA²/x²`; c is 0.26108 of the profile `(1 − s²)^{1/3}` that a Newtonian current keeps
//!   (Huppert 1982, doi 10.1017/S0022112082001797), and 9/32 of the profile `(1 − |s|)^{1/2}` in which a yield stress
//!   holds it (Roussel and Coussot 2005, doi 10.1122/1.1879041), linear in `F_y/F_g` in between;
//! - surface tension drives with `F_c = 2σ (cos θ_e − cos θ)`, the angle θ being that of a circular segment of width
//!   2x;
//! - the yield stress resists with `F_y = τ_y x`;
//! - the viscous stress τ_v resists with `½ J x τ_v(γ̇)`, at the shear rate `γ̇ = 6 x ẋ/A` of the plate.
//!
//! Constants of the profile, J = 1.86562, make a Newtonian current under gravity spread exactly as Huppert's; a line at
//! rest under gravity is exact, too. Surface tension meets the friction of the contact line besides, `3µ ln(x/λ)/θ` a
//! line (O. V. Voinov 1976, doi 10.1007/BF01012963) with `ln(x/λ) = 10`; in proportion to its share of the forces.
//! The contact line advances and does not recede: a strand that was pressed wide stays so.
//!
//! Frozen crystals thicken the fluid by `(1 − f/f_m)^{−1.6}` of the frozen fraction f and hold it from `f_m = 0.64` on
//! (I. M. Krieger and T. J. Dougherty 1959, doi 10.1122/1.548848).

use std::f64::consts::PI;

use crate::laws::Fluid;

/// c of both profiles.
const CURRENT: f64 = 0.261_081_105_845_159_1;
const HELD: f64 = 9.0 / 32.0;
/// J.
const RESISTANCE: f64 = 1.865_622_203_212_338_6;
/// `(4/3) ln(x/λ)/J`: resistance of the contact lines over that of the flow.
const CONTACT_LINES: f64 = 4.0 / 3.0 * 10.0 / RESISTANCE;
/// f_m and its exponent.
pub const PACKED: f64 = 0.64;
const THICKENING: f64 = 1.6;
/// Largest number of iterations for a width, and the relative change that ends them.
const MOST_ITERATIONS: usize = 200;
const CLOSE: f64 = 1e-13;

/// A section that spreads.
#[derive(Debug, Clone, Copy)]
pub struct Spreading<'a> {
    pub fluid: &'a Fluid,
    /// [m/s²]
    pub gravity: f64,
    /// A [m²].
    pub section: f64,
    /// Temperature [K] and frozen fraction.
    pub temperature: f64,
    pub frozen: f64,
}

impl Spreading<'_> {
    /// Speed ẋ at a half-width [m/s].
    pub fn speed(&self, x: f64) -> f64 {
        let fluid = self.fluid;
        if self.frozen >= PACKED {
            return 0.0;
        }
        let curve = fluid.viscosity.at(self.temperature);
        let resting = curve.yield_stress() * x;
        let weight = fluid.density * self.gravity * (self.section / x).powi(2);
        let held = if weight > 0.0 { (resting / (CURRENT * weight)).min(1.0) } else { 1.0 };
        let gravity = (CURRENT + (HELD - CURRENT) * held) * weight;
        let tension = self.tension(x);
        let excess = gravity + tension - resting;
        if excess <= 0.0 {
            return 0.0;
        }
        let lines = CONTACT_LINES * tension.abs() / (gravity + tension.abs());
        let thickening = (1.0 - self.frozen / PACKED).powf(-THICKENING);
        let stress = 2.0 * excess / (RESISTANCE * x * (1.0 + lines) * thickening);
        curve.rate_beyond(curve.yield_stress() + stress, 0.0) * self.section / (6.0 * x)
    }

    /// F_c [N/m].
    fn tension(&self, x: f64) -> f64 {
        match self.fluid.surface_tension {
            0.0 => 0.0,
            sigma => {
                2.0 * sigma * (self.fluid.contact_angle.cos() - angle(self.section / (x * x)).cos())
            }
        }
    }

    /// Half-width after a time [s], from x: implicit in x⁵, of which Newtonian currents change the rate by nothing.
    pub fn advance(&self, x: f64, duration: f64) -> f64 {
        let change = |fifth: f64| {
            let x = fifth.powf(0.2);
            5.0 * x.powi(4) * self.speed(x) * duration
        };
        let start = x.powi(5);
        let first = change(start);
        if first <= CLOSE * start {
            return x;
        }
        let misses = |fifth: f64| fifth - start - change(fifth);
        let (mut low, mut high) = (start, start + first);
        let mut below = -first;
        let mut above = misses(high);
        while above < 0.0 && high.is_finite() {
            (low, below) = (high, above);
            high = start + 2.0 * (high - start);
            above = misses(high);
        }
        // Regula falsi with the Illinois rule.
        let mut last = 0;
        for _ in 0..MOST_ITERATIONS {
            if above <= 0.0 || high - low <= CLOSE * high {
                break;
            }
            let middle = (low * above - high * below) / (above - below);
            let miss = misses(middle);
            if miss < 0.0 {
                (low, below) = (middle, miss);
                above *= if last == -1 { 0.5 } else { 1.0 };
                last = -1;
            } else {
                (high, above) = (middle, miss);
                below *= if last == 1 { 0.5 } else { 1.0 };
                last = 1;
            }
        }
        high.powf(0.2)
    }
}

/// Angle of contact of a circular segment, from its area over the square of its half-width: `(θ − sin θ cos θ)/sin² θ`.
fn angle(ratio: f64) -> f64 {
    let area = |angle: f64| {
        let sine = angle.sin();
        match angle < 1e-2 {
            // 2θ/3 + 4θ³/45.
            true => angle * (2.0 / 3.0 + 4.0 / 45.0 * angle * angle),
            false => (angle - sine * angle.cos()) / (sine * sine),
        }
    };
    let [mut low, mut high] = [0.0, PI];
    let mut angle = (1.5 * ratio).min(0.5 * PI);
    for _ in 0..MOST_ITERATIONS {
        let miss = area(angle) - ratio;
        *(if miss < 0.0 { &mut low } else { &mut high }) = angle;
        let step = 1e-6 * angle.max(1e-6);
        let slope = (area(angle + step) - area(angle)) / step;
        let newton = angle - miss / slope;
        let next = if low < newton && newton < high { newton } else { 0.5 * (low + high) };
        if (next - angle).abs() <= CLOSE * next {
            return next;
        }
        angle = next;
    }
    angle
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::closed_form::{GravityCurrent, RestingPaste, Spreading as Shape};

    fn fluid(viscosity: &str, density: f64, surface_tension: f64, contact_angle: f64) -> Fluid {
        let text = format!(
            "density = {density}\nviscosity = {viscosity}\nspecific_heat = 2e3\nconductivity = 0.2\nsurface_tension = \
             {surface_tension}\ncontact_angle = {contact_angle}"
        );
        toml::from_str(&text).unwrap()
    }

    fn of(fluid: &Fluid, section: f64) -> Spreading<'_> {
        Spreading { fluid, gravity: 9.81, section, temperature: 300.0, frozen: 0.0 }
    }

    /// Water, glycerol and a thick oil reach Huppert's front to 1e-9 from its own width at an earlier time.
    #[test]
    fn newtonian_currents_are_those_of_huppert() {
        for (viscosity, density) in [(1e-3, 998.0), (1.4, 1260.0), (100.0, 970.0)] {
            let fluid = fluid(&viscosity.to_string(), density, 0.0, 1.0);
            let section = 2e-6;
            let spreading = Shape::Plane { area: 0.5 * section };
            let current =
                GravityCurrent { spreading, gravity: 9.81, viscosity: viscosity / density };
            let [from, to] = [3.0, 500.0];
            let found = of(&fluid, section).advance(current.front(from), to - from);
            assert!((found / current.front(to) - 1.0).abs() < 1e-9, "{viscosity}: {found}");
        }
    }

    /// Concrete and a silicone paste come to rest at the closed form, from a tenth of that width on, in one step or
    /// many.
    #[test]
    fn yield_stress_holds_strands_at_their_closed_width() {
        let laws = [
            ("{ law = \"bingham\", yield_stress = 500.0, plastic_viscosity = 20.0 }", 2300.0, 9e-4),
            (
                "{ law = \"herschel_bulkley\", yield_stress = 20.0, consistency = 30.0, exponent = 0.5 }",
                1050.0,
                1e-4,
            ),
        ];
        for (law, density, section) in laws {
            let fluid = fluid(law, density, 0.0, 1.0);
            let yield_stress = fluid.viscosity.yield_stress();
            let rest =
                RestingPaste { yield_stress, weight: density * 9.81 }.line_half_width(section);
            let mut x = 0.1 * rest;
            for _ in 0..200 {
                x = of(&fluid, section).advance(x, 100.0);
            }
            assert!((x / rest - 1.0).abs() < 1e-3, "{law}: {x} {rest}");
            let at_once = of(&fluid, section).advance(0.1 * rest, 1e9);
            assert!((at_once / rest - 1.0).abs() < 1e-3, "{law}: {at_once} {rest}");
            assert_eq!(of(&fluid, section).speed(1.001 * rest), 0.0);
        }
    }

    /// A small strand of solder rests as a circular segment at its contact angle, a wide puddle of water at the height
    /// `2 l_c sin(θ/2)`, to 3 %.
    #[test]
    fn surface_tension_holds_strands_at_their_angle() {
        let solder = fluid("2e-3", 7000.0, 0.55, 0.7);
        let section = 1e-10;
        let x = of(&solder, section).advance(1e-5, 1e3);
        let angle: f64 = 0.7;
        let area = x * x * (angle - angle.sin() * angle.cos()) / angle.sin().powi(2);
        assert!((area / section - 1.0).abs() < 1e-2, "{area}");
        let water = fluid("1e-3", 998.0, 0.072, 0.8);
        let section = 5e-4;
        let x = of(&water, section).advance(1e-2, 1e6);
        let height = section / (2.0 * x);
        let puddle = 2.0 * (0.072 / (998.0 * 9.81_f64)).sqrt() * 0.4_f64.sin();
        assert!((height / puddle - 1.0).abs() < 0.03, "{height} {puddle}");
    }

    /// Wetting strands of small Bond number widen with the power 1/7 of the time (L. H. Tanner 1979, plane case).
    #[test]
    fn wetting_strands_widen_as_tanner_observed() {
        let mut oil = fluid("10.0", 970.0, 0.021, 1e-6);
        oil.density = 1e-3;
        let width = |time: f64| {
            let (mut x, steps) = (1e-4, 400);
            let step = |n: i32| time * (f64::from(n) / f64::from(steps)).powi(3);
            (0..steps).for_each(|n| x = of(&oil, 1e-8).advance(x, step(n + 1) - step(n)));
            x
        };
        let exponent = (width(1e6) / width(1e5)).ln() / 10.0_f64.ln();
        assert!((exponent - 1.0 / 7.0).abs() < 0.01, "{exponent}");
    }

    #[test]
    fn crystals_hold_a_strand() {
        let wax = fluid("5e-3", 780.0, 0.0, 1.0);
        let of_fraction = |frozen| Spreading { frozen, ..of(&wax, 1e-6) };
        assert_eq!(of_fraction(PACKED).advance(3e-4, 1e3), 3e-4);
        let ratio = of_fraction(0.32).speed(1e-3) / of_fraction(0.0).speed(1e-3);
        assert!((ratio - 0.5_f64.powf(1.6)).abs() < 1e-12, "{ratio}");
    }

    #[test]
    fn angles_are_those_of_circular_segments() {
        for angle_ in [1e-4, 0.01, 0.5, 1.5, 2.5, 3.0_f64] {
            let ratio = (angle_ - angle_.sin() * angle_.cos()) / angle_.sin().powi(2);
            let ratio = if angle_ < 1e-3 { 2.0 / 3.0 * angle_ } else { ratio };
            assert!((angle(ratio) / angle_ - 1.0).abs() < 1e-6, "{angle_}");
        }
    }
}
