//! Plane sections without stress across them: thin sheets.
//!
//! The stretch λ across the section is that at which the stress there vanishes, `P_yy(F, λ) = 0` (J. C. Simo and R. L.
//! Taylor 1986, doi 10.1002/nme.1620220310, of small strains). It is found by Newton's method in `ln λ`, anew at every
//! deformation, from the history before the step. The tangent is condensed: `A_mn − A_my A_yn / A_yy`.

use super::{Deformed, LargeStrainLaw, Tangent};
use crate::math::matrix3::Matrix3;

/// Place of yy in a tangent.
const ACROSS: usize = 4;
/// Iterations of Newton's method, and its longest step in `ln λ`.
const ITERATIONS: usize = 100;
const LONGEST: f64 = 0.5;
/// Change of `ln λ` at which it has converged; one more step is taken then.
const CONVERGED: f64 = 1e-9;

impl LargeStrainLaw {
    /// Finds the stretch across a section, whatever that of `gradient` is, over a step from a history; not a number
    /// where there is none.
    pub fn thinned(&self, gradient: Matrix3, dt: f64, before: &[f64]) -> Deformed {
        let [[a, _, b], _, [c, _, d]] = gradient;
        let area = a * d - b * c;
        // Of linear elasticity: ln λ = −ν/(1 − ν) ln (area).
        let lateral = (self.bulk - 2.0 / 3.0 * self.shear) / (self.bulk + 4.0 / 3.0 * self.shear);
        let mut logarithm = -lateral * area.ln();
        let at = |logarithm: f64| {
            let mut gradient = gradient;
            gradient[1][1] = logarithm.exp();
            Deformed::of(gradient)
        };
        let mut is_last = false;
        for _ in 0..ITERATIONS {
            let now = at(logarithm);
            let stretch = now.gradient[1][1];
            let [stress, slope] = self.across(&now, dt, before);
            // P_yy λ, and its derivative by ln λ.
            let change = -stress * stretch / (slope * stretch * stretch + stress * stretch);
            if !change.is_finite() {
                break;
            }
            logarithm += change.clamp(-LONGEST, LONGEST);
            if is_last {
                return at(logarithm);
            }
            is_last = change.abs() < CONVERGED;
        }
        at(f64::NAN)
    }

    /// P_yy and its derivative by F_yy.
    fn across(&self, at: &Deformed, dt: f64, before: &[f64]) -> [f64; 2] {
        let [stress, slope] = self.deviator_along(1, at, dt, before);
        let [pressure, stiffness] = self.pressure(at.dilatation);
        let cofactor = at.dilatation * at.inverse_transposed[1][1];
        // A cofactor does not depend on its own entry.
        [stress + pressure * cofactor, slope + stiffness * cofactor * cofactor]
    }

    /// ∂P/∂F of the whole stress, that of the point's own dilatation included.
    fn whole_tangent(&self, at: &Deformed, dt: f64, before: &[f64]) -> Tangent {
        let [pressure, stiffness] = self.pressure(at.dilatation);
        let mut tangent = self.tangent(at, dt, before, pressure);
        let cofactor = |n: usize| at.dilatation * at.inverse_transposed[n / 3][n % 3];
        for (m, row) in tangent.iter_mut().enumerate() {
            for (n, value) in row.iter_mut().enumerate() {
                *value += stiffness * cofactor(m) * cofactor(n);
            }
        }
        tangent
    }

    /// ∂P/∂F of the whole stress of a sheet at its deformation, whose stretch across follows.
    pub fn condensed_tangent(&self, at: &Deformed, dt: f64, before: &[f64]) -> Tangent {
        let whole = self.whole_tangent(at, dt, before);
        let own = whole[ACROSS][ACROSS];
        std::array::from_fn(|m| {
            std::array::from_fn(|n| whole[m][n] - whole[m][ACROSS] * whole[ACROSS][n] / own)
        })
    }
}

#[cfg(test)]
mod tests {
    use super::super::{Deviator, MaxwellBranch, Plastic, Relaxing};
    use super::*;

    const BULK: f64 = 7.0;
    const SHEAR: f64 = 3.0;

    /// Root of a rising function.
    fn root(of: impl Fn(f64) -> f64) -> f64 {
        let (mut low, mut high) = (1e-3, 1e3);
        for _ in 0..200 {
            let middle = 0.5 * (low + high);
            if of(middle) < 0.0 { low = middle } else { high = middle }
        }
        0.5 * (low + high)
    }

    /// Principal Kirchhoff stress of neo-Hooke along the first of three stretches.
    fn kirchhoff([a, b, c]: [f64; 3]) -> f64 {
        let j = a * b * c;
        let third = (a * a + b * b + c * c) / 3.0;
        SHEAR * j.powf(-2.0 / 3.0) * (a * a - third) + 0.5 * BULK * (j * j - 1.0)
    }

    /// P of the whole stress.
    fn stress(law: &LargeStrainLaw, at: &Deformed, dt: f64, before: &[f64]) -> Matrix3 {
        let own = law.respond(at, dt, &mut before.to_vec()).stress;
        let jp = at.dilatation * law.pressure(at.dilatation)[0];
        let entry = |a: usize, b: usize| own[a][b] + jp * at.inverse_transposed[a][b];
        std::array::from_fn(|a| std::array::from_fn(|b| entry(a, b)))
    }

    #[test]
    fn uniaxial_and_equibiaxial_tension_have_their_closed_forms() {
        let law = LargeStrainLaw::elastic(BULK, SHEAR);
        for stretch in [0.3, 0.7, 0.99, 1.0, 1.01, 1.5, 3.0, 6.0] {
            let lateral = root(|own| kirchhoff([own, stretch, own]));
            let across = root(|own| kirchhoff([own, stretch, stretch]));
            let uniaxial = kirchhoff([stretch, lateral, lateral]) / stretch;
            let biaxial = kirchhoff([stretch, stretch, across]) / stretch;
            let cases = [
                ([stretch, lateral], lateral, [uniaxial, 0.0]),
                ([stretch, stretch], across, [biaxial, biaxial]),
            ];
            for ([x, z], thick, wanted) in cases {
                let gradient = [[x, 0.0, 0.0], [0.0, 9.0, 0.0], [0.0, 0.0, z]];
                let at = law.thinned(gradient, 0.0, &[]);
                assert!((at.gradient[1][1] / thick - 1.0).abs() < 1e-12, "{stretch}");
                let found = stress(&law, &at, 0.0, &[]);
                let size = uniaxial.abs().max(biaxial.abs()).max(1e-3);
                assert!((found[0][0] - wanted[0]).abs() < 1e-10 * size, "{stretch} {found:?}");
                assert!((found[2][2] - wanted[1]).abs() < 1e-10 * size, "{stretch} {found:?}");
                assert!(found[1][1].abs() < 1e-12 * BULK, "{stretch} {found:?}");
            }
        }
    }

    #[test]
    fn condensed_tangents_match_differences() {
        let branches = vec![MaxwellBranch { fraction: 0.5, time: 0.3 }];
        let plastic = Plastic {
            yield_stress: 0.4,
            hardening: 0.3,
            saturation: 0.6,
            rate: 17.0,
            kinematic: 0.0,
        };
        let deviators = [
            Deviator::Relaxing(Relaxing::default()),
            Deviator::Relaxing(Relaxing { branches }),
            Deviator::Plastic(plastic),
            Deviator::Plastic(Plastic { kinematic: 0.5, ..plastic }),
        ];
        for deviator in deviators {
            let law = LargeStrainLaw { bulk: BULK, shear: SHEAR, deviator };
            let mut before = vec![0.0; law.history()];
            let first = [[1.1, 0.0, 0.1], [0.0, 1.0, 0.0], [0.0, 0.0, 0.95]];
            law.respond(&law.thinned(first, 0.1, &before), 0.1, &mut before);
            let second = [[1.2, 0.0, 0.3], [0.0, 1.0, 0.0], [-0.1, 0.0, 0.9]];
            let tangent = law.condensed_tangent(&law.thinned(second, 0.2, &before), 0.2, &before);
            for column in [0, 2, 6, 8] {
                let moved = |by: f64| {
                    let mut gradient = second;
                    gradient[column / 3][column % 3] += by;
                    stress(&law, &law.thinned(gradient, 0.2, &before), 0.2, &before)
                };
                let (up, down) = (moved(1e-6), moved(-1e-6));
                for row in [0, 2, 6, 8] {
                    let found = (up[row / 3][row % 3] - down[row / 3][row % 3]) / 2e-6;
                    let error = (found - tangent[row][column]).abs();
                    assert!(error < 2e-7, "{row} {column}: {found} {}", tangent[row][column]);
                }
            }
        }
    }

    /// A bar of perfect plasticity bears its yield stress: Kirchhoff's is σ_y at any stretch, and so is that of a sheet
    /// drawn along both axes.
    #[test]
    fn sheets_that_flow_bear_their_yield_stress() {
        let plastic = Plastic {
            yield_stress: 0.05,
            hardening: 0.0,
            saturation: 0.05,
            rate: 0.0,
            kinematic: 0.0,
        };
        let law = LargeStrainLaw { bulk: BULK, shear: SHEAR, deviator: Deviator::Plastic(plastic) };
        let mut uniaxial = vec![0.0; law.history()];
        let mut biaxial = uniaxial.clone();
        let mut lateral = 1.0;
        for n in 1..=40 {
            let stretch = 1.0 + 5e-3 * f64::from(n);
            // The edges of the bar are free: the stress along z is a rising function of its stretch.
            let across = |z: f64, history: &[f64]| {
                let gradient = [[stretch, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, z]];
                law.thinned(gradient, 0.0, history)
            };
            let (mut low, mut high) = (0.9 * lateral, 1.05 * lateral);
            for _ in 0..100 {
                let middle = 0.5 * (low + high);
                let found = stress(&law, &across(middle, &uniaxial), 0.0, &uniaxial);
                if found[2][2] < 0.0 { low = middle } else { high = middle }
            }
            lateral = 0.5 * (low + high);
            let at = across(lateral, &uniaxial);
            let found = stress(&law, &at, 0.0, &uniaxial)[0][0] * stretch;
            law.respond(&at, 0.0, &mut uniaxial);
            let equal = [[stretch, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, stretch]];
            let at = law.thinned(equal, 0.0, &biaxial);
            let both = stress(&law, &at, 0.0, &biaxial)[0][0] * stretch;
            law.respond(&at, 0.0, &mut biaxial);
            if n > 5 {
                assert!((found / 0.05 - 1.0).abs() < 1e-10, "{n}: {found}");
                assert!((both / 0.05 - 1.0).abs() < 1e-10, "{n}: {both}");
            }
        }
        assert!(uniaxial[Plastic::STRAIN] > 0.1 && biaxial[Plastic::STRAIN] > 0.1);
    }
}
