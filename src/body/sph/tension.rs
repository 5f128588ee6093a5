//! Strength of the pair force that makes a surface tension.

use std::f64::consts::PI;

use crate::kernel::Kernel;
use crate::math::gauss::gauss_on;

/// A pair force that makes a surface tension and nothing else: the force a volume between two
/// particles is `V_i V_j g(q)` along their line, with
/// `g(q) = A cos(3πq/2) − 2 b F(q) q`, F = σ w′(q)/q of the kernel.
///
/// The cosine attracts from afar and alone would put the fluid under a pressure many times that of
/// any drop; the second part, which acts like a pressure b in the fluid, cancels it.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct PairForce {
    /// A over ρ₀c₀²/H.
    pub amplitude: f64,
    /// b over ρ₀c₀².
    pub background: f64,
}

impl PairForce {
    /// The force for a surface tension over ρ₀c₀²H.
    ///
    /// Filled evenly with pairs, a fluid has the pressure `2π/3 ∫ q³ g dq`, here zero, and parting it
    /// takes twice the tension `σ = −π/8 ∫ q⁴ g dq`; in the plane these are `π/2 ∫ q² g dq` and
    /// `−1/3 ∫ q³ g dq`.
    ///
    /// Source: Fowler (1937), Proc. R. Soc. Lond. A 159, 229–246, doi 10.1098/rspa.1937.0068.
    pub fn of(tension: f64, kernel: Kernel, dimension: usize) -> Self {
        let power = dimension as i32;
        let cosine = |n: i32| integral(|q| q.powi(n) * (1.5 * PI * q).cos());
        let slope = |q: f64| -q * kernel.gradient_factor(q, 1.0, dimension);
        let [pressure, parting] =
            if dimension == 2 { [PI / 2.0, 1.0 / 3.0] } else { [2.0 * PI / 3.0, PI / 8.0] };
        // Background for each amplitude, then the tension that both make.
        let background = -pressure * cosine(power);
        let tension_made = -parting
            * (cosine(power + 1) + 2.0 * background * integral(|q| q.powi(power + 1) * slope(q)));
        let amplitude = tension / tension_made;
        Self { amplitude, background: amplitude * background }
    }
}

/// ∫ f(q) dq over the support, piece by piece between the knots of the splines.
fn integral(f: impl Fn(f64) -> f64) -> f64 {
    let piece = |n: i32| gauss_on(12, f64::from(n) / 6.0, f64::from(n + 1) / 6.0);
    (0..6).flat_map(piece).map(|(q, weight)| weight * f(q)).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn force(kernel: Kernel, dimension: usize) -> impl Fn(f64) -> f64 {
        let PairForce { amplitude, background } = PairForce::of(1.0, kernel, dimension);
        move |q| {
            amplitude * (1.5 * PI * q).cos()
                - 2.0 * background * q * kernel.gradient_factor(q, 1.0, dimension)
        }
    }

    /// Pairs across a plane, summed by brute force over directions and distances.
    #[test]
    fn parting_two_half_spaces_takes_twice_the_tension() {
        for kernel in Kernel::ALL {
            let force = force(kernel, 3);
            let potential =
                |q: f64| -> f64 { gauss_on(40, q, 1.0).map(|(s, w)| w * force(s)).sum() };
            let mut work = 0.0;
            for (cosine, weight) in gauss_on(10, 0.0, 1.0) {
                for (q, w) in gauss_on(40, 0.0, 1.0) {
                    let crossing = q * cosine; // Pairs a unit of area whose line crosses the plane.
                    work -= 2.0 * PI * weight * w * q * q * crossing * potential(q);
                }
            }
            assert!((work - 2.0).abs() < 1e-5, "{kernel:?}: {work}");
        }
    }

    #[test]
    fn inside_the_fluid_the_forces_cancel() {
        for kernel in Kernel::ALL {
            for dimension in [2, 3] {
                let force = force(kernel, dimension);
                let virial = integral(|q| q.powi(dimension as i32) * force(q));
                let part = integral(|q| q.powi(dimension as i32) * force(q).abs());
                assert!(virial.abs() < 1e-12 * part, "{kernel:?} {dimension}-D");
            }
        }
    }
}
