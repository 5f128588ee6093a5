//! Shared parts of the tests of closed forms: alumina, comparison, finite differences.

use super::{Conductor, Elastic, FreezingContact};

/// Alumina of Park §2.4.6.3 as a conductor.
pub const ALUMINA: Conductor = Conductor { conductivity: 10.0, heat_capacity: 3950.0 * 900.0 };
/// Water of Park §2.4.6.3 as a conductor.
pub const WATER: Conductor = Conductor { conductivity: 0.6, heat_capacity: 1000.0 * 4000.0 };
/// Alumina of Park §2.4.6.3 as an elastic body.
pub const ALUMINA_ELASTIC: Elastic = Elastic { young: 300e9, poisson: 0.21 };
/// Expansion coefficient of alumina [1/K].
pub const ALUMINA_EXPANSION: f64 = 8.1e-6;

/// Molten tin at its melting point on stainless steel at room temperature.
pub const TIN_ON_STEEL: FreezingContact = FreezingContact {
    wall: Conductor { conductivity: 14.9, heat_capacity: 7900.0 * 477.0 },
    frozen: Conductor { conductivity: 62.0, heat_capacity: 6970.0 * 244.0 },
    molten: Conductor { conductivity: 33.0, heat_capacity: 6970.0 * 244.0 },
    latent: 6970.0 * 59e3,
    melts_at: 505.0,
    wall_temperature: 298.15,
    fluid_temperature: 505.0,
};

/// Asserts that two numbers agree to a relative tolerance.
#[track_caller]
pub fn assert_close(actual: f64, expected: f64, relative: f64) {
    assert_within(actual, expected, relative * expected.abs());
}

/// Asserts that two numbers agree to an absolute tolerance.
#[track_caller]
pub fn assert_within(actual: f64, expected: f64, absolute: f64) {
    assert!(
        (actual - expected).abs() <= absolute,
        "{actual:e} is {:e} off {expected:e}, allowed {absolute:e}",
        actual - expected
    );
}

/// First derivative, central, sixth order.
pub fn derivative(f: impl Fn(f64) -> f64, x: f64, h: f64) -> f64 {
    let odd = |m: f64| f(x + m * h) - f(x - m * h);
    (45.0 * odd(1.0) - 9.0 * odd(2.0) + odd(3.0)) / (60.0 * h)
}

/// Second derivative, central, sixth order.
pub fn second_derivative(f: impl Fn(f64) -> f64, x: f64, h: f64) -> f64 {
    let even = |m: f64| f(x + m * h) + f(x - m * h);
    (270.0 * even(1.0) - 27.0 * even(2.0) + 2.0 * even(3.0) - 490.0 * f(x)) / (180.0 * h * h)
}

/// First derivative at the left end of an interval, one-sided, fifth order.
pub fn derivative_at_left(f: impl Fn(f64) -> f64, x: f64, h: f64) -> f64 {
    const WEIGHTS: [f64; 6] = [-137.0, 300.0, -300.0, 200.0, -75.0, 12.0];
    let terms = WEIGHTS.iter().enumerate().map(|(i, w)| w * f(x + i as f64 * h));
    terms.sum::<f64>() / (60.0 * h)
}

/// Asserts `∂T/∂t = a ∇²T` at a point, relative to the size of `∂T/∂t`.
#[track_caller]
pub fn assert_heat_equation(
    temperature: impl Fn([f64; 3], f64) -> f64,
    diffusivity: f64,
    at: [f64; 3],
    t: f64,
    h: f64,
) {
    let rate = derivative(|t| temperature(at, t), t, 0.01 * t);
    let laplacian: f64 = (0..3)
        .map(|axis| {
            let along = |x: f64| {
                let mut point = at;
                point[axis] = x;
                temperature(point, t)
            };
            second_derivative(along, at[axis], h)
        })
        .sum();
    assert_close(diffusivity * laplacian, rate, 1e-5);
}
