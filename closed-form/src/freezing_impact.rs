//! Largest spread of a drop that freezes from below while it spreads over a wall.
//!
//! With the diameter D, the speed U, `We = ρU²D/σ`, `Re = ρUD/µ` and the advancing contact angle θ, over D:
//! `ξ² = (We + 12)/(⅜ We s* + 3(1 − cos θ) + 4We/√Re)`. s* is the thickness of the frozen layer over D after the time
//! `t* D/U`, t* = 8/3: `s* = (2/√π) Ste √(t* γ_w/(Pe γ_d))`, with `Ste = c(T_m − T_w)/L`, `Pe = UD/a_d` and γ = kρc
//! of wall and drop. The fluid's conductivity and specific heat cancel: `s* D = 2 e_w (T_m − T_w) √t/(√π ρL)`, the
//! latent heat that a half space with its surface at T_m takes up. The frozen layer, half as wide as the spread on
//! average, keeps its kinetic energy; without freezing ξ is [`DropImpact::spread_by_energy`].
//!
//! It is a fit rather than a solution: the time of spreading and the share of the frozen layer are estimates of order
//! one. The sources compare it with tin drops of 2.7 mm at 1 to 4 m/s on stainless steel of 25 to 240 °C (We 35 to
//! 550, Re 10⁴ to 4·10⁴). It leaves out the contact resistance, superheat, and the resistance of the frozen layer
//! itself: that makes s* of tin on steel at 25 °C larger by a third than [`FreezingContact::front`].
//!
//! Sources: M. Pasandideh-Fard, R. Bhola, S. Chandra and J. Mostaghimi (1998), Int. J. Heat Mass Transfer 41,
//! 2929–2945, doi 10.1016/S0017-9310(98)00023-4; S. D. Aziz and S. Chandra (2000), Int. J. Heat Mass Transfer 43,
//! 2841–2857, doi 10.1016/S0017-9310(99)00350-6.

use std::f64::consts::PI;

use super::drop_impact::DropImpact;
use super::freezing_contact::FreezingContact;

/// Time t* of spreading, over D/U.
const SPREADING_TIME: f64 = 8.0 / 3.0;

/// The drop, and the wall it freezes on.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FreezingImpact {
    pub drop: DropImpact,
    pub contact: FreezingContact,
}

impl FreezingImpact {
    /// Thickness s* of the frozen layer at the end of spreading, over D: 0 on a wall above the melting point.
    pub fn frozen_layer(&self) -> f64 {
        let FreezingContact { wall, latent, melts_at, wall_temperature, .. } = self.contact;
        let cooling = (melts_at - wall_temperature).max(0.0);
        let heat = 2.0 * wall.effusivity() * cooling * (self.spreading_time() / PI).sqrt();
        heat / latent / self.drop.diameter
    }

    /// Largest diameter ξ over D.
    pub fn spread(&self) -> f64 {
        let (weber, root) = (self.drop.weber(), self.drop.reynolds().sqrt());
        let wetting = 3.0 * (1.0 - self.drop.contact_angle.cos());
        let resisting = 0.375 * weber * self.frozen_layer() + wetting + 4.0 * weber / root;
        ((weber + 12.0) / resisting).sqrt()
    }

    /// Time of spreading [s].
    fn spreading_time(&self) -> f64 {
        SPREADING_TIME * self.drop.diameter / self.drop.speed
    }
}

#[cfg(test)]
mod tests {
    use super::super::checks::{TIN_ON_STEEL, assert_close, assert_within};
    use super::super::half_space_surface::SuddenSurface;
    use super::super::quadrature::integrate;
    use super::*;

    /// Tin of 2.7 mm on steel at 25 °C.
    fn tin(speed: f64) -> FreezingImpact {
        let drop = DropImpact {
            diameter: 2.7e-3,
            speed,
            density: 6970.0,
            viscosity: 1.92e-3,
            surface_tension: 0.544,
            contact_angle: 140f64.to_radians(),
        };
        FreezingImpact { drop, contact: TIN_ON_STEEL }
    }

    #[test]
    fn eight_spreads_of_tin_on_steel() {
        let digits = [
            (1.0, 34.6, 2.35, 2.64),
            (2.0, 138.0, 3.26, 4.03),
            (3.0, 311.0, 3.87, 5.07),
            (4.0, 554.0, 4.32, 5.86),
        ];
        for (speed, weber, frozen, liquid) in digits {
            let impact = tin(speed);
            assert_close(impact.drop.weber(), weber, 3e-3);
            assert_within(impact.spread(), frozen, 5.1e-3);
            let contact = FreezingContact { wall_temperature: 513.0, ..TIN_ON_STEEL };
            let warm = FreezingImpact { contact, ..impact };
            assert_eq!(warm.frozen_layer(), 0.0);
            assert_within(warm.spread(), liquid, 5.1e-3);
            assert_close(warm.spread(), impact.drop.spread_by_energy(), 1e-14);
        }
    }

    #[test]
    fn frozen_layer_in_the_numbers_of_stefan_and_peclet() {
        for speed in [1.0, 4.0] {
            let impact = tin(speed);
            let FreezingContact { wall, frozen, latent, .. } = impact.contact;
            let stefan = frozen.heat_capacity * (505.0 - 298.15) / latent;
            let peclet = speed * 2.7e-3 / frozen.diffusivity();
            let ratio = (wall.effusivity() / frozen.effusivity()).powi(2);
            let layer = 2.0 / PI.sqrt() * stefan * (8.0 / 3.0 * ratio / peclet).sqrt();
            assert_close(impact.frozen_layer(), layer, 1e-13);
        }
    }

    #[test]
    fn frozen_layer_releases_the_heat_that_the_wall_takes_up() {
        let impact = tin(2.0);
        let wall = SuddenSurface { body: impact.contact.wall, step: 505.0 - 298.15 };
        // t = x² removes the singular start of the flux.
        let end = impact.spreading_time().sqrt();
        let heat = integrate(|x| 2.0 * x * wall.flux(x * x), &[0.0, end]);
        let layer = impact.frozen_layer() * impact.drop.diameter;
        assert_close(layer * impact.contact.latent, heat, 1e-10);
        let exact = impact.contact.front(impact.spreading_time());
        assert!((1.25..1.4).contains(&(layer / exact)), "{}", layer / exact);
    }

    /// `E_k + E_s = E_s' + W + ΔE_k` at the largest spread, with the mean area of the frozen layer a quarter of the
    /// splat's.
    #[test]
    fn energies_balance_at_the_largest_spread() {
        let impact = tin(3.0);
        let DropImpact { diameter, speed, density, surface_tension, contact_angle, .. } =
            impact.drop;
        let splat = PI / 4.0 * (impact.spread() * diameter).powi(2);
        let dynamic = 0.5 * density * speed.powi(2);
        let before =
            dynamic * PI / 6.0 * diameter.powi(3) + PI * diameter.powi(2) * surface_tension;
        let surface = splat * surface_tension * (1.0 - contact_angle.cos());
        // The viscous work is that of the layer 2D/√Re over the volume of the splat (Pasandideh-Fard et al. 1996).
        let viscous = dynamic * 8.0 / 3.0 * splat * diameter / impact.drop.reynolds().sqrt();
        let frozen = dynamic * 0.25 * splat * impact.frozen_layer() * diameter;
        assert_close(surface + viscous + frozen, before, 1e-12);
    }
}
