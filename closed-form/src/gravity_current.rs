//! Fixed volume of viscous fluid that spreads over a horizontal wall under its own weight.
//!
//! The film is thin, so that its pressure is hydrostatic and its flow that of lubrication. Its surface bears no shear.
//! With g gravity [m/s²] and ν the kinematic viscosity [m²/s], the thickness h [m] obeys
//! `∂h/∂t = g/(3ν) x^{−m} ∂/∂x (x^m h³ ∂h/∂x)`, with m = 0 for the plane current and m = 1 for the axisymmetric one.
//! Its similarity solution is `h = h₀(t) (1 − x²/x_N²)^{1/3}`: the front advances at
//! `dx_N/dt = 2g h₀³/(9ν x_N)`, and the volume fixes h₀. Hence
//!
//! - axisymmetric, volume V [m³]: `r_N = 0.893914 (gV³/3ν)^{1/8} t^{1/8}`;
//! - plane, area q [m²] on one side of the origin: `x_N = 1.411245 (gq³/3ν)^{1/5} t^{1/5}`.
//!
//! Valid once the initial shape is forgotten, for `h₀ ≪ x_N`, negligible inertia (`ẋ_N h₀²/(ν x_N) ≪ 1`) and
//! negligible surface tension (`ρg x_N²/σ ≫ 1`).
//!
//! Source: H. E. Huppert (1982), J. Fluid Mech. 121, 43–58, doi 10.1017/S0022112082001797.

use std::f64::consts::PI;

/// Integral of the shape, `∫₀¹ (1 − s²)^{1/3} ds = √π Γ(4/3)/(2 Γ(11/6))`.
fn plane_shape() -> f64 {
    0.5 * PI.sqrt() * libm::tgamma(4.0 / 3.0) / libm::tgamma(11.0 / 6.0)
}

/// Integral of the shape over a disc, `2π ∫₀¹ s (1 − s²)^{1/3} ds`.
const DISC_SHAPE: f64 = 0.75 * PI;

/// Geometry and volume of a current.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Spreading {
    /// From a point, with the volume V [m³].
    Axisymmetric { volume: f64 },
    /// From a line to one side, with the volume per length q [m²].
    Plane { area: f64 },
}

/// The current and its fluid.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct GravityCurrent {
    pub spreading: Spreading,
    /// Gravity g [m/s²].
    pub gravity: f64,
    /// Kinematic viscosity ν [m²/s].
    pub viscosity: f64,
}

impl GravityCurrent {
    /// Distance x_N of the front from the origin [m].
    pub fn front(&self, t: f64) -> f64 {
        let rate = self.mobility() * t;
        match self.spreading {
            Spreading::Axisymmetric { volume } => {
                let factor = 16.0 / 3.0 / DISC_SHAPE.powi(3);
                (factor * rate * volume.powi(3)).powf(0.125)
            }
            Spreading::Plane { area } => {
                let factor = 10.0 / 3.0 / plane_shape().powi(3);
                (factor * rate * area.powi(3)).powf(0.2)
            }
        }
    }

    /// Speed of the front [m/s].
    pub fn speed(&self, t: f64) -> f64 {
        let exponent = match self.spreading {
            Spreading::Axisymmetric { .. } => 0.125,
            Spreading::Plane { .. } => 0.2,
        };
        exponent * self.front(t) / t
    }

    /// Thickness h₀ at the origin [m].
    pub fn height(&self, t: f64) -> f64 {
        let front = self.front(t);
        match self.spreading {
            Spreading::Axisymmetric { volume } => volume / (DISC_SHAPE * front * front),
            Spreading::Plane { area } => area / (plane_shape() * front),
        }
    }

    /// Thickness h [m] at the distance x from the origin: 0 beyond the front.
    pub fn thickness(&self, x: f64, t: f64) -> f64 {
        let inside = 1.0 - (x / self.front(t)).powi(2);
        self.height(t) * inside.max(0.0).cbrt()
    }

    /// Mean speed over the thickness [m/s], `−g/(3ν) h² ∂h/∂x`: proportional to the distance.
    pub fn mean_speed(&self, x: f64, t: f64) -> f64 {
        let front = self.front(t);
        if x > front { 0.0 } else { self.speed(t) * x / front }
    }

    /// `g/(3ν)` [1/(m s)].
    fn mobility(&self) -> f64 {
        self.gravity / (3.0 * self.viscosity)
    }
}

#[cfg(test)]
mod tests {
    use super::super::checks::{assert_close, derivative};
    use super::super::quadrature::integrate;
    use super::*;

    const DROP: GravityCurrent = GravityCurrent {
        spreading: Spreading::Axisymmetric { volume: 2e-5 },
        gravity: 9.81,
        viscosity: 1e-2,
    };
    const BANK: GravityCurrent =
        GravityCurrent { spreading: Spreading::Plane { area: 3e-4 }, ..DROP };

    #[test]
    fn prefactors_by_quadrature() {
        let unit = |spreading| GravityCurrent { spreading, gravity: 3.0, viscosity: 1.0 };
        let shape = |s: f64| (1.0 - s * s).cbrt();
        let disc = 2.0 * PI * integrate(|s| s * shape(s), &[0.0, 1.0]);
        let point = unit(Spreading::Axisymmetric { volume: 1.0 });
        assert_close(point.front(1.0), (16.0 / 3.0 / disc.powi(3)).powf(0.125), 1e-11);
        assert_close(point.front(1.0), 0.893914, 5e-7);
        let half = integrate(shape, &[0.0, 1.0]);
        let line = unit(Spreading::Plane { area: 1.0 });
        assert_close(line.front(1.0), (10.0 / 3.0 / half.powi(3)).powf(0.2), 1e-11);
        assert_close(line.front(1.0), 1.411245, 5e-7);
    }

    #[test]
    fn volume_is_conserved() {
        for t in [1.0, 100.0] {
            let around = |r: f64| 2.0 * PI * r * DROP.thickness(r, t);
            assert_close(integrate(around, &[0.0, DROP.front(t)]), 2e-5, 1e-10);
            let area = integrate(|x| BANK.thickness(x, t), &[0.0, BANK.front(t)]);
            assert_close(area, 3e-4, 1e-10);
        }
    }

    #[test]
    fn thickness_obeys_the_lubrication_equation() {
        let t = 20.0;
        for (current, power) in [(DROP, 1), (BANK, 0)] {
            for share in [0.2, 0.5, 0.8] {
                let x = share * current.front(t);
                let step = 1e-3 * x;
                let flux = |x: f64| {
                    let slope = derivative(|x| current.thickness(x, t), x, step);
                    -current.mobility() * x.powi(power) * current.thickness(x, t).powi(3) * slope
                };
                let outflow = derivative(flux, x, step) / x.powi(power);
                let rate = derivative(|t| current.thickness(x, t), t, 1e-3 * t);
                assert_close(-outflow, rate, 1e-6);
                let carried = x.powi(power) * current.thickness(x, t) * current.mean_speed(x, t);
                assert_close(flux(x), carried, 1e-9);
            }
        }
    }

    #[test]
    fn front_moves_at_its_speed_and_nothing_lies_beyond() {
        for current in [DROP, BANK] {
            assert_close(derivative(|t| current.front(t), 5.0, 0.01), current.speed(5.0), 1e-9);
            let beyond = 1.01 * current.front(5.0);
            assert_eq!([current.thickness(beyond, 5.0), current.mean_speed(beyond, 5.0)], [0.0; 2]);
        }
    }

    /// Finite volumes of the equation, from a block: the similarity solution attracts it.
    #[test]
    fn block_of_fluid_approaches_the_similarity_solution() {
        const CELLS: usize = 100;
        let (length, block) = (0.06, 0.018);
        let dx = length / CELLS as f64;
        let mut h = [0.0; CELLS];
        let filled = (block / dx).round() as usize;
        h[..filled].fill(3e-4 / (filled as f64 * dx));
        let (mut t, end) = (0.0, 4.0);
        while t < end {
            let highest = h.iter().fold(0.0, |a: f64, b| a.max(*b));
            let dt = (0.2 * dx * dx / (BANK.mobility() * highest.powi(3))).min(end - t);
            let flux = |n: usize| {
                let mean = (0..4).map(|k| h[n].powi(k) * h[n + 1].powi(3 - k)).sum::<f64>() / 4.0;
                BANK.mobility() * mean * (h[n] - h[n + 1]) / dx
            };
            let fluxes: Vec<f64> = (0..CELLS - 1).map(flux).collect();
            for (n, flux) in fluxes.iter().enumerate() {
                h[n] -= dt / dx * flux;
                h[n + 1] += dt / dx * flux;
            }
            t += dt;
        }
        assert_close(h[0], BANK.height(end), 0.01);
        let front = h.iter().filter(|h| **h > 1e-6).count() as f64 * dx;
        assert_close(front, BANK.front(end), 0.03);
    }
}
