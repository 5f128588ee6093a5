//! Splits of the elastic energy: into the part that a crack releases and the part that it leaves.
//!
//! All are isotropic functions of the elastic strain, quadratic between the bounds of a few cases, so that stress and
//! tangent follow in principal axes.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Part of the elastic energy that cracks release.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Split {
    /// The whole energy: cracks also run under compression, and their faces penetrate each other.
    None,
    /// The energy that a material without tensile strength does not store (F. Freddi & G. Royer-Carfagni 2010, doi
    /// 10.1016/j.jmps.2010.02.010): closed cracks transmit compression.
    #[default]
    NoTension,
    /// The energy of positive principal strains and of a positive change of volume (C. Miehe, M. Hofacker & F.
    /// Welschinger 2010, doi 10.1016/j.cma.2010.04.011).
    Spectral,
    /// The energy of shear and of a positive change of volume (H. Amor, J.-J. Marigo & C. Maurini 2009, doi
    /// 10.1016/j.jmps.2009.04.011).
    Volumetric,
    /// The same, less a multiple of the energy of a negative change of volume that follows from `compressive_strength`
    /// (F. Vicentini, C. Zolesi, P. Carrara, C. Maurini & L. De Lorenzis 2024, doi 10.1007/s10704-024-00763-w).
    StarConvex,
}

/// Isotropic elasticity in principal axes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Principal {
    /// Young's modulus [Pa] and Poisson's ratio.
    pub young: f64,
    pub poisson: f64,
    /// True if the third principal stress is zero; the third strain then has no part in anything.
    pub is_plane_stress: bool,
}

/// Energy that a crack leaves, with its first and second derivatives by the principal strains.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Remaining {
    /// [J/m³]
    pub energy: f64,
    /// [Pa]
    pub stress: [f64; 3],
    /// [Pa]
    pub tangent: [[f64; 3]; 3],
}

impl Remaining {
    /// `½ e·C e` of a constant tangent.
    fn quadratic(tangent: [[f64; 3]; 3], strain: [f64; 3]) -> Self {
        let stress = tangent.map(|row| dot(row, strain));
        Self { energy: 0.5 * dot(stress, strain), stress, tangent }
    }
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

impl Principal {
    /// First Lamé constant [Pa].
    fn lame_first(&self) -> f64 {
        self.young * self.poisson / ((1.0 + self.poisson) * (1.0 - 2.0 * self.poisson))
    }

    /// Twice the shear modulus [Pa].
    fn shear_twice(&self) -> f64 {
        self.young / (1.0 + self.poisson)
    }

    /// Derivatives of principal stresses by principal strains of the intact material [Pa].
    pub fn intact_tangent(&self) -> [[f64; 3]; 3] {
        match self.is_plane_stress {
            true => self.in_plane([0, 1]),
            false => {
                let [first, twice] = [self.lame_first(), self.shear_twice()];
                std::array::from_fn(|i| {
                    std::array::from_fn(|j| if i == j { first + twice } else { first })
                })
            }
        }
    }

    /// Energy of the intact material [J/m³].
    pub fn intact(&self, strain: [f64; 3]) -> Remaining {
        Remaining::quadratic(self.intact_tangent(), strain)
    }

    /// Stiffness of two strains if stress along the third axis is zero.
    fn in_plane(&self, [a, b]: [usize; 2]) -> [[f64; 3]; 3] {
        let mut tangent = [[0.0; 3]; 3];
        let own = self.young / (1.0 - self.poisson * self.poisson);
        (tangent[a][a], tangent[b][b]) = (own, own);
        (tangent[a][b], tangent[b][a]) = (self.poisson * own, self.poisson * own);
        tangent
    }

    /// Stiffness of one strain if stress along both other axes is zero.
    fn along(&self, axis: usize) -> [[f64; 3]; 3] {
        let mut tangent = [[0.0; 3]; 3];
        tangent[axis][axis] = self.young;
        tangent
    }
}

impl Split {
    /// Energy that a crack leaves at the principal elastic strains. Under pressure it leaves a multiple of the bulk
    /// modulus; that of [`Split::StarConvex`] is [`pressed_of`].
    pub fn remaining(self, elastic: &Principal, pressed: f64, strain: [f64; 3]) -> Remaining {
        match self {
            Split::None => Remaining::default(),
            Split::NoTension => no_tension(elastic, strain),
            Split::Spectral => spectral(elastic, strain),
            Split::Volumetric | Split::StarConvex => {
                let is_compressed = strain.iter().sum::<f64>() < 0.0;
                let multiple = if self == Split::StarConvex { pressed } else { 1.0 };
                let bulk = multiple * (elastic.lame_first() + elastic.shear_twice() / 3.0);
                let tangent = if is_compressed { [[bulk; 3]; 3] } else { [[0.0; 3]; 3] };
                Remaining::quadratic(tangent, strain)
            }
        }
    }

    /// Returns true if the split is defined in plane stress: others leave stress along the free normal.
    pub fn suits_plane_stress(self) -> bool {
        matches!(self, Split::None | Split::NoTension)
    }
}

/// Bulk modulus under pressure that a crack leaves, over that of the material, with which the strength under uniaxial
/// compression is a multiple of that under tension: `1 + γ` with `γ = (2 (1 + ν) − 3/ratio²)/(1 − 2ν)`.
///
/// Damage begins where the released energy `½ κ (⟨tr ε⟩₊² − γ ⟨tr ε⟩₋²) + µ |dev ε|²` reaches a value, which uniaxial
/// tension does at `σ²/(2E)`.
pub fn pressed_of(poisson: f64, ratio: f64) -> f64 {
    1.0 + (2.0 * (1.0 + poisson) - 3.0 / (ratio * ratio)) / (1.0 - 2.0 * poisson)
}

/// Energy of a material that bears no tension: it opens along as many axes as it must for no stress to be positive.
fn no_tension(elastic: &Principal, strain: [f64; 3]) -> Remaining {
    let nu = elastic.poisson;
    if elastic.is_plane_stress {
        let [high, low] = if strain[0] >= strain[1] { [0, 1] } else { [1, 0] };
        return match () {
            () if strain[low] >= 0.0 => Remaining::default(),
            () if strain[high] + nu * strain[low] >= 0.0 => {
                Remaining::quadratic(elastic.along(low), strain)
            }
            () => elastic.intact(strain),
        };
    }
    let mut axes = [0, 1, 2];
    axes.sort_by(|&a, &b| strain[b].total_cmp(&strain[a]));
    let [high, middle, low] = axes;
    match () {
        () if strain[low] >= 0.0 => Remaining::default(),
        () if strain[middle] + nu * strain[low] >= 0.0 => {
            Remaining::quadratic(elastic.along(low), strain)
        }
        () if (1.0 - nu) * strain[high] + nu * (strain[middle] + strain[low]) >= 0.0 => {
            Remaining::quadratic(elastic.in_plane([middle, low]), strain)
        }
        () => elastic.intact(strain),
    }
}

fn spectral(elastic: &Principal, strain: [f64; 3]) -> Remaining {
    let is_compressed = strain.iter().sum::<f64>() < 0.0;
    let volume = if is_compressed { elastic.lame_first() } else { 0.0 };
    let own = |i: usize| if strain[i] < 0.0 { elastic.shear_twice() } else { 0.0 };
    let tangent = std::array::from_fn(|i| {
        std::array::from_fn(|j| volume + if i == j { own(i) } else { 0.0 })
    });
    Remaining::quadratic(tangent, strain)
}

#[cfg(test)]
mod tests {
    use super::*;

    const SPLITS: [Split; 5] =
        [Split::None, Split::NoTension, Split::Spectral, Split::Volumetric, Split::StarConvex];

    fn states() -> Vec<[f64; 3]> {
        let values = [-1.3, -0.4, -0.05, 0.02, 0.7];
        let pairs = values.iter().flat_map(|&a| values.iter().map(move |&b| [a, b]));
        pairs.flat_map(|[a, b]| values.iter().map(move |&c| [a, b + 1e-3, c - 2e-3])).collect()
    }

    fn elastic(is_plane_stress: bool) -> Principal {
        Principal { young: 2.0, poisson: 0.3, is_plane_stress }
    }

    #[test]
    fn stress_and_tangent_are_derivatives_of_the_energy() {
        const H: f64 = 1e-6;
        for split in SPLITS {
            for plane in [false, true] {
                if plane && !split.suits_plane_stress() {
                    continue;
                }
                let elastic = elastic(plane);
                for strain in states() {
                    let own = split.remaining(&elastic, 4.0, strain);
                    for axis in 0..if plane { 2 } else { 3 } {
                        let at = |h: f64| {
                            let mut moved = strain;
                            moved[axis] += h;
                            split.remaining(&elastic, 4.0, moved)
                        };
                        let slope = (at(H).energy - at(-H).energy) / (2.0 * H);
                        assert!((slope - own.stress[axis]).abs() < 1e-6, "{split:?} {strain:?}");
                        for i in 0..3 {
                            let slope = (at(H).stress[i] - at(-H).stress[i]) / (2.0 * H);
                            let tangent = own.tangent[i][axis];
                            assert!((slope - tangent).abs() < 1e-6, "{split:?} {strain:?}");
                        }
                    }
                }
            }
        }
    }

    #[test]
    fn material_without_tensile_strength_has_the_least_energy_over_all_openings() {
        // The energy is the least of the elastic energy over opening strains that are not negative.
        for plane in [false, true] {
            let elastic = elastic(plane);
            for strain in states() {
                let own = no_tension(&elastic, strain);
                assert!(own.stress.iter().all(|&stress| stress <= 1e-12), "{strain:?} {own:?}");
                // Coordinate descent on a convex function.
                let mut opened = strain;
                for _ in 0..200 {
                    for axis in 0..if plane { 2 } else { 3 } {
                        let now = elastic.intact(opened);
                        opened[axis] -= now.stress[axis] / now.tangent[axis][axis];
                        opened[axis] = opened[axis].min(strain[axis]);
                    }
                }
                let least = elastic.intact(opened).energy;
                assert!((own.energy - least).abs() < 1e-9, "{strain:?} {} {least}", own.energy);
            }
        }
    }

    #[test]
    fn released_energy_is_never_negative_without_a_compressive_strength() {
        for split in SPLITS.into_iter().filter(|split| *split != Split::StarConvex) {
            for strain in states() {
                let elastic = elastic(false);
                let released =
                    elastic.intact(strain).energy - split.remaining(&elastic, 1.0, strain).energy;
                assert!(released >= -1e-12, "{split:?} {strain:?} {released}");
            }
        }
    }

    /// Uniaxial tension and compression release the same energy at strengths of the given ratio.
    #[test]
    fn strengths_have_their_ratio() {
        for poisson in [-0.3, 0.0, 0.22, 0.45] {
            let elastic = Principal { young: 2.0, poisson, is_plane_stress: false };
            for ratio in [1.0, 3.0, 10.0, 1e3] {
                let pressed = pressed_of(poisson, ratio);
                let released = |stress: f64| {
                    let strain = [1.0, -poisson, -poisson].map(|part| part * stress / 2.0);
                    let left = Split::StarConvex.remaining(&elastic, pressed, strain).energy;
                    elastic.intact(strain).energy - left
                };
                let (tension, compression) = (released(0.7), released(-0.7 * ratio));
                // Near the largest ratios energies cancel.
                let off = (compression / tension - 1.0).abs();
                assert!(off < 1e-13 * ratio * ratio + 1e-12, "{poisson} {ratio}: {off:e}");
            }
        }
    }
}
