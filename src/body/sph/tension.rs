//! Strength of the pair force that makes a surface tension.

use std::f64::consts::PI;

use crate::math::gauss::gauss_on;

/// Amplitude A of the force a volume, `Σ V_i V_j A cos(3πq/2)` along the line of two particles, that
/// makes a surface tension σ, with σ over ρ₀c₀²H.
///
/// Half the work that it takes to part two half spaces filled evenly, a potential φ(q) between volumes:
/// `σ = π/8 ∫ q⁴ φ′ dq` in space and `σ = 1/3 ∫ q³ φ′ dq` in the plane, with φ′ = −A cos(3πq/2).
///
/// Source: Fowler (1937), Proc. R. Soc. Lond. A 159, 229–246, doi 10.1098/rspa.1937.0068.
pub fn amplitude(tension: f64, dimension: usize) -> f64 {
    let moment = |power: i32| -> f64 {
        gauss_on(16, 0.0, 1.0).map(|(q, w)| w * q.powi(power) * (1.5 * PI * q).cos()).sum()
    };
    match dimension {
        2 => -3.0 * tension / moment(3),
        _ => -8.0 / PI * tension / moment(4),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Pairs across a plane, summed by brute force over directions and distances.
    #[test]
    fn parting_two_half_spaces_takes_twice_the_tension() {
        let amplitude = amplitude(1.0, 3);
        let potential = |q: f64| -> f64 {
            let force = |s: f64| amplitude * (1.5 * PI * s).cos();
            gauss_on(20, q, 1.0).map(|(s, w)| w * force(s)).sum()
        };
        let mut work = 0.0;
        for (cosine, weight) in gauss_on(10, 0.0, 1.0) {
            for (q, w) in gauss_on(20, 0.0, 1.0) {
                let crossing = q * cosine; // Pairs a unit of area whose line crosses the plane.
                work -= 2.0 * PI * weight * w * q * q * crossing * potential(q);
            }
        }
        assert!((work - 2.0).abs() < 1e-10, "{work}");
    }
}
