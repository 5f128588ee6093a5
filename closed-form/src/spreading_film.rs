//! Heat flux of a film that spreads over a wall, such as a drop after impact.
//!
//! Above its viscous layer the fluid flows outward with `u = r/t`, so downward with `w = −2z/t`. With `η = z/√(νt)`,
//! `u = F′(η) r/t`, `w = −2F √(ν/t)` and Prandtl's number `Pr = ν/a`, the Navier–Stokes equations and that of heat
//! become
//!
//! `F‴ + (2F + η/2) F″ + F′ − F′² = 0`, `F(0) = F′(0) = 0`, `F′(∞) = 1`,
//! `Θ″ + Pr (2F + η/2) Θ′ = 0`, `Θ(0) = 0`, `Θ(∞) = 1`.
//!
//! So the flux is that of fluid at rest times a number that depends on Pr alone, and the wall's temperature remains
//! constant, as under fluid at rest.
//!
//! Sources: I. V. Roisman (2009), Phys. Fluids 21, 052104, doi 10.1063/1.3129283, and (2010), J. Fluid Mech. 656,
//! 189–204, doi 10.1017/S0022112010001126.

use std::f64::consts::PI;

/// Step in η, and η at the end of the viscous layer.
const STEP: f64 = 2e-3;
const OUTSIDE: f64 = 10.0;

/// Flux of the spreading film relative to that of the same fluid at rest: √5 for Pr → 0, and decreasing with Pr.
pub fn flux_over_rest(prandtl: f64) -> f64 {
    let flow = flow();
    // Beyond the viscous layer F = η − δ.
    let displacement = OUTSIDE - flow[flow.len() - 1][0];
    let stream = |n: usize| flow.get(n).map_or(n as f64 * STEP - displacement, |state| state[0]);
    let (mut exponent, mut integral, mut n) = (0.0, 0.0, 0);
    let slope = |n: usize| prandtl * (2.0 * stream(n) + 0.5 * n as f64 * STEP);
    while exponent < 40.0 {
        let next = exponent + 0.5 * STEP * (slope(n) + slope(n + 1));
        integral += 0.5 * STEP * (f64::exp(-exponent) + f64::exp(-next));
        (exponent, n) = (next, n + 1);
    }
    (PI / prandtl).sqrt() / integral
}

/// F, F′ and F″ at multiples of the step.
fn flow() -> Vec<[f64; 3]> {
    let [mut low, mut high] = [0.0, 4.0];
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        let end = shoot(middle).last().map_or(0.0, |state| state[1]);
        *(if end < 1.0 { &mut low } else { &mut high }) = middle;
    }
    shoot(0.5 * (low + high))
}

/// Flow for a value of F″(0), by a Runge–Kutta method, until it departs from the outer flow.
fn shoot(curvature: f64) -> Vec<[f64; 3]> {
    let rate = |eta: f64, [f, slope, bend]: [f64; 3]| {
        [slope, bend, -(2.0 * f + 0.5 * eta) * bend - slope + slope * slope]
    };
    let ahead =
        |state: [f64; 3], rate: [f64; 3], step: f64| [0, 1, 2].map(|n| state[n] + step * rate[n]);
    let mut states = vec![[0.0, 0.0, curvature]];
    for n in 0..(OUTSIDE / STEP).round() as usize {
        let (eta, state) = (n as f64 * STEP, states[n]);
        let a = rate(eta, state);
        let b = rate(eta + 0.5 * STEP, ahead(state, a, 0.5 * STEP));
        let c = rate(eta + 0.5 * STEP, ahead(state, b, 0.5 * STEP));
        let d = rate(eta + STEP, ahead(state, c, STEP));
        let mean = [0, 1, 2].map(|n| (a[n] + 2.0 * b[n] + 2.0 * c[n] + d[n]) / 6.0);
        let next = ahead(state, mean, STEP);
        states.push(next);
        if !(-1.0..3.0).contains(&next[1]) {
            break;
        }
    }
    states
}

#[cfg(test)]
mod tests {
    use super::super::checks::{ALUMINA, WATER, assert_close};
    use super::*;

    #[test]
    fn inviscid_film_has_root_five_times_the_flux() {
        assert_close(flux_over_rest(1e-6), 5f64.sqrt(), 2e-3);
    }

    #[test]
    fn flow_satisfies_its_equation_and_end_conditions() {
        let flow = flow();
        assert_close(flow[flow.len() - 1][1], 1.0, 1e-9);
        let n = 700;
        let third = (flow[n + 1][2] - flow[n - 1][2]) / (2.0 * STEP);
        let [f, slope, bend] = flow[n];
        let eta = n as f64 * STEP;
        let sum = third + (2.0 * f + 0.5 * eta) * bend + slope - slope * slope;
        assert!(sum.abs() < 1e-5, "{sum}");
    }

    #[test]
    fn park_water_on_alumina() {
        let [water, alumina] = [WATER, ALUMINA].map(|body| body.effusivity());
        let factor = flux_over_rest(3e-4 / 1000.0 / WATER.diffusivity());
        let share = factor * water / (factor * water + alumina);
        assert_close(20.0 + 80.0 * share, 42.383, 1e-4);
    }

    #[test]
    fn numbers_of_an_independent_solution() {
        // Collocation (SciPy's solve_bvp) to 1e-8.
        for (prandtl, factor) in [(0.5, 1.69735), (1.0, 1.59460), (2.0, 1.49514), (7.0, 1.33747)] {
            assert_close(flux_over_rest(prandtl), factor, 1e-5);
        }
    }
}
