//! Measures of a stress state, given as xx, yy, zz, xy, yz, xz [Pa].

/// Von Mises stress `√(3 J₂)` [Pa] (R. von Mises 1913).
pub fn von_mises(stress: [f64; 6]) -> f64 {
    let scale = scale(stress);
    let [xx, yy, zz, xy, yz, xz] = stress.map(|s| s / scale);
    let normal = (xx - yy).powi(2) + (yy - zz).powi(2) + (zz - xx).powi(2);
    scale * (0.5 * normal + 3.0 * (xy * xy + yz * yz + xz * xz)).sqrt()
}

/// Largest principal stress [Pa], tension positive: the trigonometric solution of the
/// characteristic cubic (O. K. Smith 1961, doi 10.1145/355578.366316).
pub fn max_principal(stress: [f64; 6]) -> f64 {
    let scale = scale(stress);
    let [xx, yy, zz, xy, yz, xz] = stress.map(|s| s / scale);
    let mean = (xx + yy + zz) / 3.0;
    let (a, b, c) = (xx - mean, yy - mean, zz - mean);
    let spread = ((a * a + b * b + c * c + 2.0 * (xy * xy + yz * yz + xz * xz)) / 6.0).sqrt();
    if spread == 0.0 {
        return scale * mean;
    }
    let determinant = a * (b * c - yz * yz) - xy * (xy * c - yz * xz) + xz * (xy * yz - b * xz);
    let ratio = (determinant / (2.0 * spread.powi(3))).clamp(-1.0, 1.0);
    scale * (mean + 2.0 * spread * (ratio.acos() / 3.0).cos())
}

/// Principal stresses in descending order [Pa], the first of which is [`max_principal`].
pub fn principals(stress: [f64; 6]) -> [f64; 3] {
    let first = max_principal(stress);
    let scale = scale(stress);
    let [xx, yy, zz, xy, yz, xz] = stress.map(|s| s / scale);
    // The other two are the roots of a quadratic: sum and product follow from trace and second invariant.
    let high = first / scale;
    let sum = xx + yy + zz - high;
    let second = xx * yy + yy * zz + zz * xx - xy * xy - yz * yz - xz * xz;
    let product = second - high * sum;
    let half = 0.5 * sum;
    let root = (half * half - product).max(0.0).sqrt();
    [first, scale * (half + root).min(high), scale * (half - root)]
}

/// Power of two below the largest component. Scaled squares and cubes neither overflow nor underflow, and scaling
/// causes no rounding. NaN if a component is not finite.
fn scale(stress: [f64; 6]) -> f64 {
    const EXPONENT: u64 = 0x7ff0_0000_0000_0000;
    if !stress.iter().all(|s| s.is_finite()) {
        return f64::NAN;
    }
    let largest = stress.iter().fold(f64::MIN_POSITIVE, |largest, s| largest.max(s.abs()));
    f64::from_bits(largest.to_bits() & EXPONENT)
}

/// Converts a stress in cylindrical components rr, tt, zz, rz at the angle of `(x, y)` to Cartesian ones.
pub fn from_cylindrical([rr, tt, zz, rz]: [f64; 4], x: f64, y: f64) -> [f64; 6] {
    let r = x.hypot(y);
    let (c, s) = if r > 0.0 { (x / r, y / r) } else { (1.0, 0.0) };
    [rr * c * c + tt * s * s, rr * s * s + tt * c * c, zz, (rr - tt) * s * c, rz * s, rz * c]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn uniaxial_and_hydrostatic_states_have_their_textbook_values() {
        assert!((von_mises([5.0, 0.0, 0.0, 0.0, 0.0, 0.0]) - 5.0).abs() < 1e-15);
        assert_eq!(von_mises([-3.0, -3.0, -3.0, 0.0, 0.0, 0.0]), 0.0);
        assert!((max_principal([-5.0, 0.0, 0.0, 0.0, 0.0, 0.0])).abs() < 1e-14);
        assert!((max_principal([0.0, 0.0, 0.0, 2.0, 0.0, 0.0]) - 2.0).abs() < 1e-14);
        assert_eq!(max_principal([-3.0, -3.0, -3.0, 0.0, 0.0, 0.0]), -3.0);
    }

    #[test]
    fn largest_principal_stress_is_an_eigenvalue() {
        let s = [3.0, -1.0, 2.0, 0.7, -0.4, 1.1];
        let m = nalgebra::Matrix3::new(s[0], s[3], s[5], s[3], s[1], s[4], s[5], s[4], s[2]);
        let largest = m.symmetric_eigenvalues().max();
        assert!((max_principal(s) - largest).abs() < 1e-13);
    }

    #[test]
    fn principals_are_eigenvalues_in_descending_order() {
        let states = [
            [3.0, -1.0, 2.0, 0.7, -0.4, 1.1],
            [2.0, 2.0, 0.0, 0.0, 0.0, 0.0],
            [-2.0, -2.0, 0.0, 0.0, 0.0, 0.0],
            [-2.0, -2.0, -2.0, 0.0, 0.0, 0.0],
            [0.0, 0.0, 0.0, 1.0, 1.0, 1.0],
            [0.0; 6],
        ];
        for s in states {
            let m = nalgebra::Matrix3::new(s[0], s[3], s[5], s[3], s[1], s[4], s[5], s[4], s[2]);
            let mut wanted: Vec<f64> = m.symmetric_eigenvalues().iter().copied().collect();
            wanted.sort_by(|a, b| b.total_cmp(a));
            for (found, wanted) in principals(s).into_iter().zip(wanted) {
                assert!((found - wanted).abs() < 2e-8, "{s:?}: {found} {wanted}");
            }
        }
    }

    #[test]
    fn measures_of_huge_and_tiny_stresses_are_right_and_those_of_no_numbers_are_none() {
        let s = [3.0, -1.0, 2.0, 0.7, -0.4, 1.1];
        for power in [-900, -300, 353, 600, 1000] {
            let factor = 2f64.powi(power);
            let scaled = s.map(|s| s * factor);
            assert_eq!(von_mises(scaled), factor * von_mises(s));
            assert_eq!(max_principal(scaled), factor * max_principal(s));
        }
        for bad in [f64::NAN, f64::INFINITY] {
            let stress = [1.0, bad, 0.0, 0.0, 0.0, 0.0];
            assert!(von_mises(stress).is_nan() && max_principal(stress).is_nan());
        }
    }

    #[test]
    fn turning_the_axes_keeps_the_von_mises_stress() {
        let cylinder = [4.0, -2.0, 1.0, 0.5];
        let along_x = from_cylindrical(cylinder, 1.0, 0.0);
        assert_eq!(along_x, [4.0, -2.0, 1.0, 0.0, 0.0, 0.5]);
        let turned = from_cylindrical(cylinder, 0.5, 0.75_f64.sqrt());
        assert!((von_mises(turned) - von_mises(along_x)).abs() < 1e-13);
    }
}
