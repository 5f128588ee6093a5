//! Gradient damage (B. Bourdin, G. A. Francfort & J.-J. Marigo 2008, doi 10.1007/s10659-007-9107-3): the energy of
//! cracks, and the response of a damaged point.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::principal_axes::PrincipalAxes;
use super::scatter::scattered;
use super::split::{Principal, Remaining, Split};
use crate::math::matrix3::Matrix3;

/// Local part w of the energy of cracks.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum Dissipation {
    /// `w = d`: elastic up to the strength, and cracks of finite width.
    At1,
    /// `w = d²`: damage from the first load on.
    At2,
}

impl Dissipation {
    /// `c_w = 4 ∫₀¹ √w ds`.
    pub fn normalisation(self) -> f64 {
        match self {
            Dissipation::At1 => 8.0 / 3.0,
            Dissipation::At2 => 2.0,
        }
    }

    /// Square of the strength over `EG_c/ℓ`: 3/8 of AT1, 27/256 of AT2.
    fn strength_factor(self) -> f64 {
        match self {
            Dissipation::At1 => 3.0 / 8.0,
            Dissipation::At2 => 27.0 / 256.0,
        }
    }
}

/// Part of the stiffness that a broken point keeps, so that equilibrium has one solution.
const RESIDUAL: f64 = 1e-6;

/// Constants of a material that cracks.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct GradientDamage {
    pub elastic: Principal,
    /// Coefficient of thermal expansion [1/K].
    pub expansion: f64,
    pub split: Split,
    /// Bulk modulus that a crack leaves under pressure, over that of the material, for [`Split::StarConvex`].
    pub pressed: f64,
    pub dissipation: Dissipation,
    /// Energy of cracks per area G_c [J/m²].
    pub energy: f64,
    /// Regularisation length ℓ [m].
    pub length: f64,
    /// Half the range of the energy of elements over its middle [1], and the number of the sample.
    pub scatter: f64,
    pub seed: u32,
}

/// Response of a point.
#[derive(Debug, Clone, Copy)]
pub struct PointResponse<const V: usize> {
    /// [Pa]
    pub stress: [f64; V],
    /// Energy that cracks release, and that which they leave [J/m³].
    pub released: f64,
    pub remaining: f64,
}

/// Part of the stiffness that damage takes: `g(d) = (1 − k)(1 − d)² + k`.
pub const DEGRADED: f64 = 1.0 - RESIDUAL;

/// `(1 − k)(1 − d)² + k`, with the residual part k.
pub fn degradation(damage: f64) -> f64 {
    DEGRADED * (1.0 - damage) * (1.0 - damage) + RESIDUAL
}

impl GradientDamage {
    /// Energy of damage and of its gradient per volume, `G_c/c_w (w/ℓ + ℓ|∇d|²)` [J/m³]; `weights` are those of
    /// the element.
    pub fn dissipated(&self, weights: [f64; 2], damage: f64, gradient: &[f64]) -> f64 {
        let [local, spread] = weights;
        let own = match self.dissipation {
            Dissipation::At1 => damage,
            Dissipation::At2 => damage * damage,
        };
        local * own + spread * gradient.iter().map(|g| g * g).sum::<f64>()
    }

    /// Factors of w [J/m³] and of |∇d|² [J/m] in an element of a size h [m].
    ///
    /// A crack breaks a row of elements, whose local energy `G_c h/(c_w ℓ)` comes on top of that of the profile on both
    /// sides: cracks would dissipate `G_c (1 + h/(c_w ℓ))` (B. Bourdin, G. A. Francfort & J.-J. Marigo 2008, doi
    /// 10.1007/s10659-007-9107-3, §8.1). With G_c and ℓ multiplied by `1 − h/(c_w ℓ)` they dissipate G_c, and the
    /// strength, which follows from G_c/ℓ, is the same.
    pub fn weights<const D: usize>(&self, size: f64, element: [usize; D]) -> [f64; 2] {
        let normalisation = self.dissipation.normalisation();
        let own = self.scattered(element) * self.energy / normalisation;
        let part = 1.0 - size / (normalisation * self.length);
        [own / self.length, own * self.length * part * part]
    }

    /// Factor of the energy in an element, from its place.
    fn scattered<const D: usize>(&self, element: [usize; D]) -> f64 {
        scattered(self.scatter, self.seed, element.map(|place| place as u64))
    }

    /// Largest uniaxial stress of a material without gradients of damage [Pa]: the elastic limit `√(3EG_c/(8ℓ))` of
    /// AT1, the peak `9/16 √(EG_c/(3ℓ))` of AT2 (K. Pham, H. Amor, J.-J. Marigo & C. Maurini 2011, doi
    /// 10.1177/1056789510386852), over the root of the part of the elastic energy that a crack releases.
    pub fn strength(&self) -> f64 {
        (self.elastic.young * self.energy * self.dissipation.strength_factor()
            / (self.released_part() * self.length))
            .sqrt()
    }

    /// Length with which the material has a strength [Pa], see [`Self::strength`] [m].
    pub fn length_of(&self, strength: f64) -> f64 {
        self.elastic.young * self.energy * self.dissipation.strength_factor()
            / (self.released_part() * strength * strength)
    }

    /// Part of the elastic energy of uniaxial tension that a crack releases. Lateral contraction is compression for
    /// splits by strain, whose energy stays.
    fn released_part(&self) -> f64 {
        let lateral = -self.elastic.poisson;
        let third = if self.elastic.is_plane_stress { 0.0 } else { lateral };
        let strain = [1.0, lateral, third];
        let intact = self.elastic.intact(strain).energy;
        1.0 - self.split.remaining(&self.elastic, self.pressed, strain).energy / intact
    }

    /// Energy that a crack releases at the elastic strain of a point, if any [J/m³]: where pressure makes it negative,
    /// nothing drives damage.
    pub fn released<A: PrincipalAxes<V>, const V: usize>(&self, strain: [f64; V]) -> f64 {
        let (_, principal) = A::of(strain);
        let [intact, left] = self.energies(principal);
        (intact.energy - left.energy).max(0.0)
    }

    /// Response to the elastic strain of a point.
    pub fn respond<A: PrincipalAxes<V>, const V: usize>(
        &self,
        strain: [f64; V],
        damage: f64,
    ) -> PointResponse<V> {
        let (axes, principal) = A::of(strain);
        let [intact, left] = self.energies(principal);
        PointResponse {
            stress: axes.stress(mixed(damage, intact.stress, left.stress)),
            released: intact.energy - left.energy,
            remaining: left.energy,
        }
    }

    /// Derivatives of the stress of a point by its elastic strain [Pa].
    pub fn tangent<A: PrincipalAxes<V>, const V: usize>(
        &self,
        strain: [f64; V],
        damage: f64,
    ) -> [[f64; V]; V] {
        let (axes, principal) = A::of(strain);
        let [intact, left] = self.energies(principal);
        let slopes: Matrix3 =
            std::array::from_fn(|i| mixed(damage, intact.tangent[i], left.tangent[i]));
        axes.tangent(mixed(damage, intact.stress, left.stress), &slopes)
    }

    /// Energy of the intact material, and the part of it that cracks leave.
    fn energies(&self, principal: [f64; 3]) -> [Remaining; 2] {
        [
            self.elastic.intact(principal),
            self.split.remaining(&self.elastic, self.pressed, principal),
        ]
    }
}

/// Returns what damage leaves of intact values: it degrades all but `left`.
fn mixed(damage: f64, intact: [f64; 3], left: [f64; 3]) -> [f64; 3] {
    let factor = degradation(damage);
    std::array::from_fn(|i| factor * (intact[i] - left[i]) + left[i])
}

#[cfg(test)]
mod tests {
    use super::super::principal_axes::{InPlane, InSpace};
    use super::*;

    const SPLITS: [Split; 5] =
        [Split::None, Split::NoTension, Split::Spectral, Split::Volumetric, Split::StarConvex];

    fn law(split: Split) -> GradientDamage {
        GradientDamage {
            elastic: Principal { young: 2.0, poisson: 0.3, is_plane_stress: false },
            expansion: 0.0,
            split,
            pressed: 4.0,
            dissipation: Dissipation::At1,
            energy: 1.0,
            length: 0.1,
            scatter: 0.0,
            seed: 0,
        }
    }

    /// Asserts that stress and tangent are derivatives of the energy at some strains.
    fn derivatives<A: PrincipalAxes<V>, const V: usize>(strains: &[[f64; V]]) {
        const H: f64 = 1e-6;
        for split in SPLITS {
            let law = law(split);
            let respond = |strain| law.respond::<A, V>(strain, 0.6);
            for strain in strains {
                let (own, tangent) = (respond(*strain), law.tangent::<A, V>(*strain, 0.6));
                for axis in 0..V {
                    let at = |h: f64| {
                        let mut moved = *strain;
                        moved[axis] += h;
                        respond(moved)
                    };
                    let energy =
                        |of: PointResponse<V>| degradation(0.6) * of.released + of.remaining;
                    let slope = (energy(at(H)) - energy(at(-H))) / (2.0 * H);
                    assert!((slope - own.stress[axis]).abs() < 1e-6, "{split:?} {strain:?} {axis}");
                    for (row, tangent) in tangent.iter().enumerate() {
                        let slope = (at(H).stress[row] - at(-H).stress[row]) / (2.0 * H);
                        let found = tangent[axis];
                        assert!((slope - found).abs() < 1e-5, "{split:?} {strain:?} {row} {axis}");
                    }
                }
            }
        }
    }

    #[test]
    fn stress_and_tangent_are_derivatives_of_the_energy() {
        derivatives::<InPlane, 4>(&[
            [0.4, -0.2, 0.1, 0.7],
            [-0.3, 0.2, -0.5, 0.01],
            [0.3, 0.3, -0.2, 0.0],
            [-0.1, -0.2, -0.3, 0.2],
        ]);
        // Two and three equal principal strains among them.
        derivatives::<InSpace, 6>(&[
            [0.4, -0.2, 0.1, 0.7, -0.3, 0.2],
            [-0.3, 0.2, -0.5, 0.01, 0.4, -0.6],
            [0.3, 0.3, -0.2, 0.0, 0.0, 0.0],
            [-0.2, -0.2, -0.2, 0.0, 0.0, 0.0],
            [0.1, 0.1, 0.1, 0.4, 0.4, 0.4],
            [-0.1, -0.2, -0.3, 0.2, 0.1, 0.05],
        ]);
    }

    #[test]
    fn response_in_space_is_that_of_a_section_whose_normal_is_y() {
        for split in SPLITS {
            let law = law(split);
            for [xx, zz, yy, xz] in [[0.4, -0.2, 0.1, 0.7], [-0.3, 0.2, -0.5, 0.01]] {
                let plane = law.respond::<InPlane, 4>([xx, zz, yy, xz], 0.3);
                let space = law.respond::<InSpace, 6>([xx, yy, zz, 0.0, 0.0, xz], 0.3);
                let [sx, sz, sy, sxz] = plane.stress;
                for (own, wanted) in space.stress.iter().zip([sx, sy, sz, 0.0, 0.0, sxz]) {
                    assert!((own - wanted).abs() < 1e-12, "{split:?} {own} {wanted}");
                }
                assert!((plane.released - space.released).abs() < 1e-12);
            }
        }
    }

    #[test]
    fn length_and_strength_are_inverse() {
        for dissipation in [Dissipation::At1, Dissipation::At2] {
            let law = GradientDamage { dissipation, ..law(Split::NoTension) };
            assert!((law.length_of(law.strength()) / law.length - 1.0).abs() < 1e-12);
        }
        // Alumina (E 340 GPa, G_c 42.47 J/m², ℓ 46 µm) without a split: 343.1 and 182.0 MPa.
        let alumina = GradientDamage {
            elastic: Principal { young: 340e9, poisson: 0.0, is_plane_stress: false },
            energy: 42.47,
            length: 46e-6,
            ..law(Split::None)
        };
        assert!((alumina.strength() / 343.1e6 - 1.0).abs() < 1e-3);
        let other = GradientDamage { dissipation: Dissipation::At2, ..alumina };
        assert!((other.strength() / 182.0e6 - 1.0).abs() < 1e-3);
    }

    #[test]
    fn scattered_energies_fill_their_range_evenly() {
        let law = GradientDamage { scatter: 0.3, seed: 7, ..law(Split::None) };
        let count = 10_000;
        let all: Vec<f64> = (0..count).map(|n| law.scattered([n % 100, n / 100])).collect();
        let mean = all.iter().sum::<f64>() / count as f64;
        let square = all.iter().map(|own| (own - mean).powi(2)).sum::<f64>() / count as f64;
        assert!(all.iter().all(|own| (0.7..=1.3).contains(own)));
        assert!(
            (mean - 1.0).abs() < 0.01
                && (square.sqrt() / (0.3 / 3.0_f64.sqrt()) - 1.0).abs() < 0.02
        );
    }
}
