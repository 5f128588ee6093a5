//! Temperature through the thickness of a plate that cools in a fluid.

use std::f64::consts::FRAC_PI_2;

/// Number of halvings of an interval of the angle, to rounding.
const HALVINGS: usize = 60;

/// Difference between the temperatures in the middle and at the surfaces of a plate, over that between its middle and
/// the fluid: `1 − cos ζ` of its slowest mode, `ζ tan ζ = Bi`. `biot` is `h W/(2k)`, of a plate of thickness W that is
/// wetted on both sides (H. S. Carslaw & J. C. Jaeger 1959, §3.11).
pub fn unevenness(biot: f64) -> f64 {
    let (mut low, mut high) = (0.0, FRAC_PI_2);
    for _ in 0..HALVINGS {
        let middle = 0.5 * (low + high);
        // Without the pole of the tangent.
        if middle * middle.sin() < biot * middle.cos() {
            low = middle;
        } else {
            high = middle;
        }
    }
    1.0 - low.cos()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Roots of the table of Carslaw & Jaeger 1959, appendix IV, table I.
    #[test]
    fn angles_are_those_of_tables() {
        for (biot, root) in [(0.1, 0.3111), (1.0, 0.8603), (10.0, 1.4289), (100.0, 1.5552)] {
            assert!((unevenness(biot) - (1.0 - f64::cos(root))).abs() < 1e-4, "{biot}");
        }
        assert!((unevenness(1e-4) / 0.5e-4 - 1.0).abs() < 1e-3);
        assert_eq!(unevenness(0.0), 0.0);
    }
}
