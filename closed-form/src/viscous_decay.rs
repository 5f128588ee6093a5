//! Flows that viscosity alone brings to rest: a shear wave and the vortices of Taylor and Green.
//!
//! Both solve the Navier–Stokes equations of an incompressible fluid exactly, at any Reynolds number: the inertia of
//! the shear wave vanishes, that of the vortices is balanced by the pressure. They decay with the kinematic viscosity
//! ν [m²/s] and their wavenumber, and need periodic or unbounded fluid.
//!
//! Implicit Euler steps Δt of `dA/dt = −cA` leave `A (1 + c Δt)^{−n}` after n steps, which separates the error in time
//! from that in space.
//!
//! Source: G. I. Taylor and A. E. Green (1937), Proc. R. Soc. A 158, 499–521, doi 10.1098/rspa.1937.0036; the shear
//! wave follows from `∂u/∂t = ν ∂²u/∂y²`.

use std::f64::consts::PI;

/// Part of an amplitude that remains after `steps` implicit Euler steps of the length `step` [s], for a decay rate
/// [1/s].
pub fn kept_by_implicit_euler(rate: f64, step: f64, steps: u32) -> f64 {
    (1.0 + rate * step).powf(-f64::from(steps))
}

/// Wave `u_x = U sin(ky)`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ShearWave {
    /// Initial amplitude U [m/s].
    pub speed: f64,
    /// Wavelength 2π/k [m].
    pub wavelength: f64,
    /// Kinematic viscosity ν [m²/s].
    pub viscosity: f64,
}

impl ShearWave {
    /// Decay rate νk² [1/s].
    pub fn rate(&self) -> f64 {
        self.viscosity * (2.0 * PI / self.wavelength).powi(2)
    }

    /// Velocity u_x [m/s] at the height y.
    pub fn velocity(&self, y: f64, t: f64) -> f64 {
        self.speed * (2.0 * PI * y / self.wavelength).sin() * (-self.rate() * t).exp()
    }

    /// Kinetic energy per mass [J/kg].
    pub fn energy(&self, t: f64) -> f64 {
        0.25 * self.speed.powi(2) * (-2.0 * self.rate() * t).exp()
    }
}

/// Vortices `u = (U sin kx cos ky, −U cos kx sin ky)` in a periodic square of side L, k = 2π/L.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TaylorGreen {
    /// Initial amplitude U [m/s].
    pub speed: f64,
    /// Side L [m]: each vortex fills a quarter of the square.
    pub side: f64,
    /// Kinematic viscosity ν [m²/s].
    pub viscosity: f64,
}

impl TaylorGreen {
    /// Decay rate of the velocity `2νk² = 8π²ν/L²` [1/s].
    pub fn rate(&self) -> f64 {
        2.0 * self.viscosity * self.wavenumber().powi(2)
    }

    /// Velocity [m/s].
    pub fn velocity(&self, [x, y]: [f64; 2], t: f64) -> [f64; 2] {
        let (amplitude, k) = (self.amplitude(t), self.wavenumber());
        let [(sin_x, cos_x), (sin_y, cos_y)] = [(k * x).sin_cos(), (k * y).sin_cos()];
        [amplitude * sin_x * cos_y, -amplitude * cos_x * sin_y]
    }

    /// Pressure over density [m²/s²], with the mean 0: `U²/4 (cos 2kx + cos 2ky)`.
    pub fn pressure(&self, at: [f64; 2], t: f64) -> f64 {
        let waves = at.map(|x| (2.0 * self.wavenumber() * x).cos());
        0.25 * self.amplitude(t).powi(2) * (waves[0] + waves[1])
    }

    /// Kinetic energy per mass [J/kg], `U²/4 e^{−16π²νt/L²}`.
    pub fn energy(&self, t: f64) -> f64 {
        0.25 * self.amplitude(t).powi(2)
    }

    fn amplitude(&self, t: f64) -> f64 {
        self.speed * (-self.rate() * t).exp()
    }

    fn wavenumber(&self) -> f64 {
        2.0 * PI / self.side
    }
}

#[cfg(test)]
mod tests {
    use super::super::checks::{assert_close, assert_within, derivative, second_derivative};
    use super::super::quadrature::integrate;
    use super::*;

    const WAVE: ShearWave = ShearWave { speed: 0.7, wavelength: 0.3, viscosity: 2e-3 };
    const VORTICES: TaylorGreen = TaylorGreen { speed: 1.3, side: 0.8, viscosity: 0.01 };

    #[test]
    fn shear_wave_diffuses() {
        let (y, t) = (0.04, 0.5);
        let rate = derivative(|t| WAVE.velocity(y, t), t, 1e-3);
        let bend = second_derivative(|y| WAVE.velocity(y, t), y, 1e-3);
        assert_close(rate, WAVE.viscosity * bend, 1e-9);
        let mean = integrate(|y| 0.5 * WAVE.velocity(y, t).powi(2), &[0.0, 0.3]) / 0.3;
        assert_close(WAVE.energy(t), mean, 1e-11);
    }

    #[test]
    fn vortices_obey_the_navier_stokes_equations() {
        let (at, t, h) = ([0.13, 0.31], 0.4, 1e-3);
        let moved = |axis: usize, x: f64| {
            let mut point = at;
            point[axis] = x;
            point
        };
        let divergence: f64 =
            (0..2).map(|n| derivative(|x| VORTICES.velocity(moved(n, x), t)[n], at[n], h)).sum();
        assert_within(divergence, 0.0, 1e-9);
        let velocity = VORTICES.velocity(at, t);
        for n in 0..2 {
            let component = |axis: usize, x: f64| VORTICES.velocity(moved(axis, x), t)[n];
            let rate = derivative(|t| VORTICES.velocity(at, t)[n], t, 1e-3);
            let carried: f64 =
                (0..2).map(|m| velocity[m] * derivative(|x| component(m, x), at[m], h)).sum();
            let push = -derivative(|x| VORTICES.pressure(moved(n, x), t), at[n], h);
            let drag: f64 = (0..2).map(|m| second_derivative(|x| component(m, x), at[m], h)).sum();
            assert_within(rate + carried - push - VORTICES.viscosity * drag, 0.0, 1e-8);
        }
    }

    #[test]
    fn energy_of_vortices_is_lost_to_viscosity() {
        let (t, side) = (0.3, VORTICES.side);
        let kinetic = |x: f64, y: f64| {
            let [u, v] = VORTICES.velocity([x, y], t);
            0.5 * (u * u + v * v)
        };
        let mean = integrate(|x| integrate(|y| kinetic(x, y), &[0.0, side]), &[0.0, side]);
        assert_close(mean / (side * side), VORTICES.energy(t), 1e-10);
        let exponent = -16.0 * PI * PI * VORTICES.viscosity * t / (side * side);
        assert_close(VORTICES.energy(t) / VORTICES.energy(0.0), exponent.exp(), 1e-13);
    }

    /// Finite differences of `∂u/∂t = ν ∂²u/∂y²` on N points have the rate `ν (2/Δ sin(kΔ/2))²`. Implicit steps of
    /// them decay by the factor of that rate, and converge to the exponential in first order.
    #[test]
    fn implicit_euler_leaves_its_power() {
        const POINTS: usize = 12;
        let (spacing, step) = (WAVE.wavelength / POINTS as f64, 0.05);
        let row = |n: usize| (n as f64 + 0.3) * spacing;
        let start: Vec<f64> = (0..POINTS).map(|n| WAVE.velocity(row(n), 0.0)).collect();
        let mobility = WAVE.viscosity * step / spacing.powi(2);
        let mut velocity = start.clone();
        for _ in 0..3 {
            let before = velocity.clone();
            for _ in 0..400 {
                for n in 0..POINTS {
                    let sides = velocity[(n + 1) % POINTS] + velocity[(n + POINTS - 1) % POINTS];
                    velocity[n] = (before[n] + mobility * sides) / (1.0 + 2.0 * mobility);
                }
            }
        }
        let discrete = WAVE.viscosity * (2.0 / spacing * (PI / POINTS as f64).sin()).powi(2);
        for (old, new) in start.iter().zip(&velocity) {
            assert_close(new / old, kept_by_implicit_euler(discrete, step, 3), 1e-11);
        }
        let error = |steps: u32| {
            let kept = kept_by_implicit_euler(WAVE.rate(), 1.0 / f64::from(steps), steps);
            kept / (-WAVE.rate()).exp() - 1.0
        };
        assert_close(error(2000) / error(4000), 2.0, 1e-3);
    }
}
