//! Response of a damaged point: stress, tangent and the energy that drives damage.

use super::section::Components;
use crate::laws::{Principal, Split};

/// Local part of the energy of cracks.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Dissipation {
    /// `w = d`: elastic up to a limit, cracks of finite width.
    At1,
    /// `w = d²`: damage from the first load on.
    At2,
}

/// Part of the stiffness that a broken point keeps, so that equilibrium has one solution.
const RESIDUAL: f64 = 1e-6;

/// Constants of a material that cracks.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DamageLaw {
    pub elastic: Principal,
    /// Coefficient of thermal expansion [1/K].
    pub expansion: f64,
    pub split: Split,
    pub dissipation: Dissipation,
    /// Energy of cracks per area G_c [J/m²].
    pub energy: f64,
    /// Regularisation length ℓ [m].
    pub length: f64,
}

/// Response of a point.
#[derive(Debug, Clone, Copy)]
pub struct Response {
    /// [Pa]
    pub stress: Components,
    /// Derivatives of the stress by the strain [Pa].
    pub tangent: [Components; 4],
    /// Energy that cracks release, and that which they leave [J/m³].
    pub released: f64,
    pub remaining: f64,
}

/// `g(d) = (1 − d)²`, plus the residual part.
pub fn degradation(damage: f64) -> f64 {
    (1.0 - damage) * (1.0 - damage) + RESIDUAL
}

impl DamageLaw {
    /// Energy of damage and of its gradient per volume, `G_c/c_w (w/ℓ + ℓ|∇d|²)` [J/m³], in an element of a size [m].
    pub fn dissipated(&self, size: f64, damage: f64, gradient: [f64; 2]) -> f64 {
        let [local, spread] = self.weights(size);
        let own = match self.dissipation {
            Dissipation::At1 => damage,
            Dissipation::At2 => damage * damage,
        };
        local * own + spread * gradient.map(|g| g * g).iter().sum::<f64>()
    }

    /// Factors of w [J/m³] and of |∇d|² [J/m] in elements of a size h [m].
    ///
    /// A crack breaks a row of elements, whose local energy `G_c h/(c_w ℓ)` comes on top of that of the profile on both
    /// sides: cracks would dissipate `G_c (1 + h/(c_w ℓ))` (B. Bourdin, G. A. Francfort & J.-J. Marigo 2008, doi
    /// 10.1007/s10659-007-9107-3, §8.1). With G_c and ℓ multiplied by `1 − h/(c_w ℓ)` they dissipate G_c, and the
    /// strength, which follows from G_c/ℓ, is the same.
    pub fn weights(&self, size: f64) -> [f64; 2] {
        let normalisation = self.normalisation();
        let own = self.energy / normalisation;
        let part = 1.0 - size / (normalisation * self.length);
        [own / self.length, own * self.length * part * part]
    }

    /// `c_w = 4 ∫₀¹ √w ds`.
    fn normalisation(&self) -> f64 {
        match self.dissipation {
            Dissipation::At1 => 8.0 / 3.0,
            Dissipation::At2 => 2.0,
        }
    }

    /// Largest stress that a uniform bar of the material bears [Pa]: the elastic limit `√(3EG_c/(8ℓ))` of AT1, the peak
    /// `9/16 √(EG_c/(3ℓ))` of AT2 (K. Pham, H. Amor, J.-J. Marigo & C. Maurini 2011, doi 10.1177/1056789510386852).
    pub fn strength(&self) -> f64 {
        let stress = (self.elastic.young * self.energy / self.length).sqrt();
        match self.dissipation {
            Dissipation::At1 => (3.0_f64 / 8.0).sqrt() * stress,
            Dissipation::At2 => 9.0 / 16.0 / 3.0_f64.sqrt() * stress,
        }
    }

    /// Response to the elastic strain of a point.
    pub fn respond(&self, strain: Components, damage: f64) -> Response {
        let [along, across, third, shear] = strain;
        let (mean, half) = (0.5 * (along + across), 0.5 * (along - across));
        let radius = half.hypot(0.5 * shear);
        // Cosine and sine of twice the angle of the first principal axis.
        let [cosine, sine] = match radius > 0.0 {
            true => [half / radius, 0.5 * shear / radius],
            false => [1.0, 0.0],
        };
        let principal = [mean + radius, mean - radius, third];
        let intact = self.elastic.intact(principal);
        let left = self.split.remaining(&self.elastic, principal);
        let factor = degradation(damage);
        let mix = |intact: f64, left: f64| factor * (intact - left) + left;
        let p: [f64; 3] = std::array::from_fn(|i| mix(intact.stress[i], left.stress[i]));
        let h: [[f64; 3]; 3] = std::array::from_fn(|i| {
            std::array::from_fn(|j| mix(intact.tangent[i][j], left.tangent[i][j]))
        });
        let turning = match radius > 1e-9 * (mean.abs() + third.abs()) && radius > 0.0 {
            true => (p[0] - p[1]) / (4.0 * radius),
            false => 0.25 * (h[0][0] + h[1][1]) - 0.5 * h[0][1],
        };
        let (centre, spread) = (0.5 * (p[0] + p[1]), 0.5 * (p[0] - p[1]));
        let stress = [centre + spread * cosine, centre - spread * cosine, p[2], spread * sine];
        let (high, low) = (0.5 * (1.0 + cosine), 0.5 * (1.0 - cosine));
        let axes: [Components; 3] = [
            [high, low, 0.0, 0.5 * sine],
            [low, high, 0.0, -0.5 * sine],
            [0.0, 0.0, 1.0, 0.0],
        ];
        let turn = [-sine, sine, 0.0, cosine];
        let tangent = std::array::from_fn(|a| {
            let rows: [f64; 3] =
                std::array::from_fn(|j| (0..3).map(|i| axes[i][a] * h[i][j]).sum());
            std::array::from_fn(|b| {
                let normal: f64 = (0..3).map(|j| rows[j] * axes[j][b]).sum();
                normal + turning * turn[a] * turn[b]
            })
        });
        Response {
            stress,
            tangent,
            released: intact.energy - left.energy,
            remaining: left.energy,
        }
    }
}
