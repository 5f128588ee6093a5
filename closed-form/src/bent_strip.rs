//! Strip of bonded neo-Hookean layers that expand differently and bend by any angle, in plane strain, away from its
//! ends (numerical).
//!
//! Lines across the strip stay straight and turn about one centre at the distance ρ(z): stretches are κρ along the
//! strip, −dρ/dz across it and 1 along the third direction. With the nominal stresses P of the energy of [`Rubber`],
//! taken of stretches over the free stretch ϑ of the layer, equilibrium is `dP_z/dz = −κ P_x` from a face without
//! force, and neither force `∫ P_x dz` nor moment acts across the strip: a boundary value problem, solved by shooting.
//! Small strains are those of [`BondedPlate`](super::BondedPlate).

use super::Rubber;

/// A layer of the strip.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BentLayer {
    pub material: Rubber,
    /// ϑ.
    pub free_stretch: f64,
    /// Thickness before it expands [m].
    pub thickness: f64,
}

/// The strip, from its bottom upward; positive curvature turns the ends upward.
#[derive(Debug, Clone, PartialEq)]
pub struct BentStrip {
    pub layers: Vec<BentLayer>,
}

/// Values at a height; see [`BentStrip::unbalanced`].
type Column = [f64; 5];

/// Steps of the integration through a layer.
const STEPS: usize = 200;
/// Newton's iterations, and the change of an unknown for its derivative.
const ITERATIONS: usize = 50;
const CHANGE: f64 = 1e-6;

impl BentStrip {
    /// Curvature of the unloaded strip over its length before it expands [1/m], from an estimate of it.
    pub fn curvature(&self, estimate: f64) -> f64 {
        let height: f64 = self.layers.iter().map(|layer| layer.thickness).sum();
        // Unknowns of order 1: the stretch of the bottom along the strip, and κ times the height.
        let mut unknowns = [1.0, estimate * height];
        for _ in 0..ITERATIONS {
            let of = |[stretch, bent]: [f64; 2]| self.unbalanced(stretch, bent / height);
            let now = of(unknowns);
            let [a, b] = [0, 1].map(|n| {
                let mut moved = unknowns;
                moved[n] += CHANGE;
                let moved = of(moved);
                [0, 1].map(|m| (moved[m] - now[m]) / CHANGE)
            });
            let determinant = a[0] * b[1] - a[1] * b[0];
            let change = [
                (now[0] * b[1] - now[1] * b[0]) / determinant,
                (a[0] * now[1] - a[1] * now[0]) / determinant,
            ];
            unknowns = [unknowns[0] - change[0], unknowns[1] - change[1]];
            if change[0].abs() + change[1].abs() < 1e-13 {
                break;
            }
        }
        unknowns[1] / height
    }

    /// Force and moment about the bottom for a stretch of the bottom along the strip and a curvature.
    fn unbalanced(&self, stretch: f64, curvature: f64) -> [f64; 2] {
        // κρ, P_z, height above the bottom, force and moment, by the classical Runge–Kutta method.
        let mut now = [stretch, 0.0, 0.0, 0.0, 0.0];
        let height: f64 = self.layers.iter().map(|layer| layer.thickness).sum();
        for layer in &self.layers {
            let dz = layer.thickness / STEPS as f64;
            for _ in 0..STEPS {
                let slope = |at: Column| layer.slopes(at, curvature);
                let along = |at: Column, by: Column, part: f64| -> Column {
                    std::array::from_fn(|n| at[n] + part * dz * by[n])
                };
                let first = slope(now);
                let second = slope(along(now, first, 0.5));
                let third = slope(along(now, second, 0.5));
                let last = slope(along(now, third, 1.0));
                now = std::array::from_fn(|n| {
                    now[n] + dz / 6.0 * (first[n] + 2.0 * (second[n] + third[n]) + last[n])
                });
            }
        }
        let scale = self.layers[0].material.shear * height;
        [now[3] / scale, now[4] / (scale * height)]
    }
}

impl BentLayer {
    /// Derivatives over z.
    fn slopes(&self, [along, across, height, ..]: Column, curvature: f64) -> Column {
        let Self { material, free_stretch, .. } = *self;
        let nominal = |stretches: [f64; 3]| {
            free_stretch.powi(2) * material.nominal(stretches.map(|own| own / free_stretch))
        };
        // P_z rises with the stretch across.
        let (mut low, mut high) = (0.05, 20.0);
        while high - low > 1e-15 * high {
            let middle = 0.5 * (low + high);
            if middle == low || middle == high {
                break;
            }
            if nominal([middle, along, 1.0]) > across { high = middle } else { low = middle }
        }
        let thick = 0.5 * (low + high);
        let stress = nominal([along, thick, 1.0]);
        [-curvature * thick, -curvature * stress, thick, stress, stress * height]
    }
}

#[cfg(test)]
mod tests {
    use super::super::checks::assert_close;
    use super::super::{BondedLayer, BondedPlate};
    use super::*;

    fn pair(scale: f64) -> [BentLayer; 2] {
        [(3.0, 0.3, 0.0, 1e-3), (7.0, 0.2, 1.0, 0.6e-3)].map(|(young, poisson, more, thickness)| {
            BentLayer {
                material: Rubber::of_young(young, poisson),
                free_stretch: 1.0 + scale * more,
                thickness,
            }
        })
    }

    #[test]
    fn small_strains_are_those_of_bonded_plates() {
        let scale = 1e-6;
        let layer = |young: f64, poisson: f64, free: f64, thickness: f64| BondedLayer {
            modulus: young / (1.0 - poisson * poisson),
            free_strain: (1.0 + poisson) * free,
            thickness,
        };
        let plate = BondedPlate {
            layers: vec![layer(3.0, 0.3, 0.0, 1e-3), layer(7.0, 0.2, scale, 0.6e-3)],
        };
        // Strain that grows with z turns the ends down.
        let expected = -plate.free()[1];
        let strip = BentStrip { layers: pair(scale).to_vec() };
        assert_close(strip.curvature(expected), expected, 1e-5);
    }

    #[test]
    fn exchanged_layers_reverse_the_curvature() {
        let [lower, upper] = pair(0.08);
        let one = BentStrip { layers: vec![lower, upper] }.curvature(-60.0);
        let other = BentStrip { layers: vec![upper, lower] }.curvature(60.0);
        assert!(one < -30.0, "{one} {other}");
        assert_close(other, -one, 1e-9);
    }
}
