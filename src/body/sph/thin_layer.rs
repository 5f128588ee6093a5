//! Heat of contact while the thermal layer at the wall is thinner than a particle.

use std::f64::consts::PI;

use super::plan::DropletPlan;
use super::units::Units;

/// Heights over Δx below which a particle's middle is all at the wall, and above which it is not at all.
/// Shares of evenly spread fluid sum to one layer of particles.
const AT_WALL: [f64; 2] = [0.75, 1.25];
/// Part of the difference of temperatures by which this heat may change the surface of a solid between
/// two exchanges.
const CHANGE_BETWEEN_EXCHANGES: f64 = 0.25;

/// What images at the wall miss of the flux into it.
///
/// Fluid of temperature T∞ that meets a wall of T_w has the flux `q = k (T∞ − T_w)/√(πκt)` after a time
/// t, and has lost the heat `2 k (T∞ − T_w) √(t/(πκ))` (H. S. Carslaw and J. C. Jaeger, *Conduction of
/// Heat in Solids*, Oxford 1959, §2.4). Where it cools no further up than a particle is thick, that heat is
/// `ρc Δx (T∞ − T)`, and with `θ = (T∞ − T)/(T∞ − T_w)` the flux needs no time of contact:
///
/// `q = (2/π) k (T∞ − T_w)/(Δx θ)`.
///
/// Images find a difference of temperatures over a distance of particles instead. They miss the share
/// `(1 − θ)^p`, `p = 1 + 6 Δx/H`, of q: all where nothing has cooled, and nothing where θ nears 1
/// because the layer is thicker than a particle. With this p, found on lattices, the sum of both has
/// given the heat of a half space to 1 % at any time for H from 2.5 to 5 Δx. As θ nears 1 with Δx, what
/// is added is of second order.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ThinLayer {
    /// Δx over H.
    thickness: f64,
    /// κ over c₀H.
    conduction: f64,
    /// p.
    power: f64,
    /// Largest rate of θ over c₀/H, times the root of the time between two exchanges [√s].
    fastest: f64,
}

impl ThinLayer {
    /// Nothing without wall or heat, and where droplets differ in temperature, so that none is that
    /// before contact.
    ///
    /// A flux q changes the surface of a solid of effusivity e by `2q √(t/π)/e` (Carslaw and Jaeger,
    /// §2.9 (7)), of which the fluid learns at the next exchange only; so what is added to the flux stays
    /// below a quarter of `e (T∞ − T_w) √(π/t)/2`, with t from one exchange to the next.
    pub fn of(plan: &DropletPlan, units: &Units) -> Option<Self> {
        let fluid = &plan.fluid;
        let effusivity = plan.wall.as_ref()?.effusivity;
        let before = plan.releases.first()?.temperature;
        if fluid.conductivity <= 0.0 || plan.releases.iter().any(|r| r.temperature != before) {
            return None;
        }
        let capacity = fluid.density * fluid.specific_heat;
        let most = 0.5 * CHANGE_BETWEEN_EXCHANGES * PI.sqrt() / (capacity * plan.spacing);
        Some(Self {
            thickness: 1.0 / plan.support,
            conduction: fluid.conductivity / (capacity * units.speed * units.length),
            power: 1.0 + 6.0 / plan.support,
            fastest: effusivity.map_or(f64::INFINITY, |e| units.time() * most * e),
        })
    }

    /// The same between two exchanges that are this far apart [s].
    pub fn between_exchanges(self, duration: f64) -> Self {
        Self { fastest: self.fastest / duration.sqrt(), ..self }
    }

    /// Rate of temperature [K c₀/H] that the images miss, as a mean over `dt`, of a particle at a height
    /// above the wall; temperatures of both above T∞ [K].
    ///
    /// While images take no part, θ² grows evenly, so that a step of any length takes the heat of a half
    /// space. A particle of which the share φ is at the wall has lost `φθ`.
    pub fn heating(&self, height: f64, temperature: f64, wall: f64, dt: f64) -> f64 {
        let [all, none] = AT_WALL;
        let share = ((none - height / self.thickness) / (none - all)).clamp(0.0, 1.0);
        let whole = share * wall;
        let deficit = temperature / whole;
        if !(0.0..1.0).contains(&deficit) {
            return 0.0;
        }
        let missed = (1.0 - deficit).powf(self.power);
        let diffusion = self.conduction * dt / (self.thickness * self.thickness);
        let grown = (deficit * deficit + 4.0 / PI * missed * diffusion).sqrt();
        whole * ((grown - deficit) / dt).min(self.fastest)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const LAYER: ThinLayer =
        ThinLayer { thickness: 0.25, conduction: 1e-4, power: 3.0, fastest: f64::INFINITY };
    const WALL: f64 = -80.0;

    #[test]
    fn a_step_takes_the_heat_of_a_half_space_whatever_its_length() {
        for dt in [1e-3, 1e-2] {
            let lost = -dt * LAYER.heating(0.125, 0.0, WALL, dt);
            let exact = 2.0 * 80.0 * (LAYER.conduction * dt / PI).sqrt() / LAYER.thickness;
            assert!((lost / exact - 1.0).abs() < 1e-12, "{lost} {exact}");
        }
    }

    #[test]
    fn two_halves_of_a_layer_lose_what_the_whole_loses() {
        let dt = 1e-3;
        let [half, whole] = [0.25, 0.125].map(|z| LAYER.heating(z, 0.0, WALL, dt));
        // θ² grows at a rate that does not know of the share, and the heat is a share of θ.
        assert!((2.0 * half / whole - 1.0).abs() < 1e-12);
        assert_eq!(LAYER.heating(0.375, 0.0, WALL, dt), 0.0);
    }

    #[test]
    fn nothing_is_missed_where_there_is_no_thin_layer() {
        let heating = |temperature, wall| LAYER.heating(0.125, temperature, wall, 1e-3);
        // As warm as the wall or beyond it, warmer than before, and a wall as warm as the fluid.
        for (temperature, wall) in
            [(WALL, WALL), (-90.0, WALL), (1.0, WALL), (0.0, 0.0), (-1.0, 0.0)]
        {
            assert_eq!(heating(temperature, wall), 0.0, "{temperature} {wall}");
        }
        assert!(heating(-0.9 * 80.0, WALL) > 1e-3 * heating(-8.0, WALL));
        assert!(heating(8.0, 80.0) > 0.0);
    }

    #[test]
    fn no_step_goes_beyond_the_wall() {
        // The longest that is stable: 0.02 H²/κ.
        let dt = 0.02 / LAYER.conduction;
        for part in 0..100 {
            let temperature = 0.01 * WALL * f64::from(part);
            let after = temperature + dt * LAYER.heating(0.125, temperature, WALL, dt);
            assert!(after > WALL, "{temperature}: {after}");
        }
    }

    #[test]
    fn a_solid_limits_what_it_gets_before_it_can_answer() {
        let slow = ThinLayer { fastest: 1e-3, ..LAYER }.between_exchanges(0.25);
        assert_eq!(slow.heating(0.125, 0.0, WALL, 1e-3), 2e-3 * WALL);
    }
}
