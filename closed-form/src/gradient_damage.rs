//! Gradient damage: bars, the damage beside a crack (K. Pham, H. Amor, J.-J. Marigo & C. Maurini 2011, doi
//! 10.1177/1056789510386852), and the field around the tip of a crack (M. L. Williams 1957, J. Appl. Mech. 24, 109).

use std::f64::consts::TAU;

/// Elastic limit of a bar of AT1 [Pa], with Young's modulus [Pa], the energy of cracks [J/m²] and the length [m]:
/// `√(3EG/(8ℓ))`.
pub fn strength_of_at1(young: f64, energy: f64, length: f64) -> f64 {
    (3.0 * young * energy / (8.0 * length)).sqrt()
}

/// Largest stress of a bar of AT2 [Pa]: `9/16 √(EG/(3ℓ))`.
pub fn strength_of_at2(young: f64, energy: f64, length: f64) -> f64 {
    9.0 / 16.0 * (young * energy / (3.0 * length)).sqrt()
}

/// Damage of AT1 at a distance from a crack in units of the length: `(1 − x/2)²` within 2.
pub fn beside_at1(distance: f64) -> f64 {
    (1.0 - 0.5 * distance.abs()).max(0.0).powi(2)
}

/// Displacements around the tip of a crack along x < 0 in plane strain [m], at a place from the tip [m], under the
/// stress intensity K [Pa √m].
pub fn around_tip([x, z]: [f64; 2], intensity: f64, [young, poisson]: [f64; 2]) -> [f64; 2] {
    let (radius, angle) = (x.hypot(z), z.atan2(x));
    let shear = young / (2.0 * (1.0 + poisson));
    let size = intensity / (2.0 * shear) * (radius / TAU).sqrt();
    let opening = size * (3.0 - 4.0 * poisson - angle.cos());
    [opening * (0.5 * angle).cos(), opening * (0.5 * angle).sin()]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn strengths_are_the_largest_stresses_of_uniform_bars() {
        // At each strain e the energy ½(1 − d)²Ee² + G/c_w w/ℓ is the least over the damage.
        let [young, energy, length] = [7.0, 3.0, 0.2];
        let stress = |strain: f64, local: f64, squared: bool| {
            let psi = young * strain * strain;
            let damage = match squared {
                true => psi / (psi + 2.0 * local),
                false => (1.0 - local / psi).max(0.0),
            };
            (1.0 - damage).powi(2) * young * strain
        };
        for (squared, normalisation, wanted) in [
            (false, 8.0 / 3.0, strength_of_at1(young, energy, length)),
            (true, 2.0, strength_of_at2(young, energy, length)),
        ] {
            let local = energy / (normalisation * length);
            let all = (1..20_000).map(|i| stress(1e-4 * f64::from(i), local, squared));
            let found = all.fold(0.0, f64::max);
            assert!((found / wanted - 1.0).abs() < 1e-3, "{found} {wanted}");
        }
    }

    #[test]
    fn faces_open_as_the_energy_release_demands() {
        // Opening at a distance r behind the tip: 8 K/E' √(r/(2π)).
        let [young, poisson, distance] = [10.0, 0.3, 0.7];
        let [_, up] = around_tip([-distance, 1e-12], 2.0, [young, poisson]);
        let wanted = 4.0 * 2.0 * (1.0 - poisson * poisson) / young * (distance / TAU).sqrt();
        assert!((up / wanted - 1.0).abs() < 1e-6, "{up} {wanted}");
    }
}
