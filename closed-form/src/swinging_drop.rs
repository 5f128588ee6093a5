//! Small oscillations of a viscous drop in empty space about a sphere, between prolate and oblate.
//!
//! The shape `r = R (1 + ε P_l(cos θ) e^(−st))` of the mode l oscillates, without viscosity, at Rayleigh's frequency
//! `ω₀² = l(l − 1)(l + 2) σ/(ρR³)`. With viscosity the surface carries no shear, so a layer of vorticity forms below
//! it, and `s = q² ν/R²` with a root q of
//!
//! `q⁴ + α⁴ = 2(l − 1) q² [l + (l + 1)(q − 2l Q)/(q − 2Q)]`,  `Q = J_{l+3/2}(q)/J_{l+1/2}(q)`,
//!
//! where `α² = ω₀R²/ν`: the root near `q² = (l − 1)(2l + 1) + i α²`, Lamb's solution for low viscosity.
//!
//! Sources: Lord Rayleigh (1879), Proc. R. Soc. 29, 71–97, doi 10.1098/rspl.1879.0015; H. Lamb (1932), Hydrodynamics,
//! 6th edition, §355; W. H. Reid (1960), Q. Appl. Math. 18, 86–89, doi 10.1090/qam/114449.

use std::f64::consts::PI;
use std::ops::{Add, Div, Mul, Sub};

/// Mode number of prolate–oblate oscillations.
const MODE: f64 = 2.0;

/// A drop that oscillates in the mode l = 2.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SwingingDrop {
    /// R [m].
    pub radius: f64,
    /// ρ [kg/m³].
    pub density: f64,
    /// µ [Pa s].
    pub viscosity: f64,
    /// σ [N/m].
    pub surface_tension: f64,
}

impl SwingingDrop {
    /// Ohnesorge's number `Oh = µ/√(ρσR)`.
    pub fn ohnesorge(&self) -> f64 {
        self.viscosity / (self.density * self.surface_tension * self.radius).sqrt()
    }

    /// Rayleigh's period `T = 2π √(ρR³/8σ)` of a drop without viscosity [s].
    pub fn rayleigh_period(&self) -> f64 {
        2.0 * PI * (self.density * self.radius.powi(3) / (8.0 * self.surface_tension)).sqrt()
    }

    /// Decay rate of the oscillations [1/s], and their angular frequency [rad/s]; the latter is 0 for a drop so viscous
    /// that its motion is overdamped.
    pub fn decay_and_frequency(&self) -> [f64; 2] {
        let rate = self.viscosity / (self.density * self.radius * self.radius);
        let square = root(8f64.sqrt() / self.ohnesorge());
        [rate * square.0, (rate * square.1).abs()]
    }

    /// Fraction of the amplitude that remains after one of Rayleigh's periods.
    pub fn kept(&self) -> f64 {
        (-self.decay_and_frequency()[0] * self.rayleigh_period()).exp()
    }
}

/// q² for α² by Newton's method, from Lamb's solution, or by steps of α² where that is far away.
fn root(alpha_square: f64) -> Complex {
    let mut of = alpha_square.max(100.0);
    let mut q = Complex((MODE - 1.0) * (2.0 * MODE + 1.0), of).root();
    loop {
        for _ in 0..50 {
            let step = 1e-6 * q.size();
            let ahead = defect(q + real(step), of);
            let slope = (ahead - defect(q - real(step), of)) / real(2.0 * step);
            let change = defect(q, of) / slope;
            q = q - change;
            if change.size() < 1e-13 * q.size() {
                break;
            }
        }
        if of == alpha_square {
            return q * q;
        }
        of = alpha_square.max(0.9 * of);
    }
}

/// Right less left side of Reid's equation.
fn defect(q: Complex, alpha_square: f64) -> Complex {
    let square = q * q;
    let ratio = bessel_ratio(q);
    let layer = (q - real(2.0 * MODE) * ratio) / (q - real(2.0) * ratio);
    let bracket = real(MODE) + real(MODE + 1.0) * layer;
    real(2.0 * (MODE - 1.0)) * square * bracket - square * square - real(alpha_square.powi(2))
}

/// J_{7/2}(q)/J_{5/2}(q), that of the spherical functions j₃ and j₂, from `tan q`.
fn bessel_ratio(q: Complex) -> Complex {
    // j₀ : j₁ as 1 : 1/q − 1/tan q, and upward by j_{n+1} = (2n + 1) j_n/q − j_{n−1}.
    let first = real(1.0) / q - real(1.0) / tangent(q);
    let second = real(3.0) * first / q - real(1.0);
    let third = real(5.0) * second / q - first;
    third / second
}

/// tan q, also where sin and cos overflow.
fn tangent(Complex(x, y): Complex) -> Complex {
    let (sine, cosine) = (2.0 * x).sin_cos();
    let small = (-2.0 * y.abs()).exp();
    let over = 0.5 * (1.0 + small * small) + small * cosine;
    let across = 0.5 * (1.0 - small * small) * y.signum();
    Complex(small * sine / over, across / over)
}

#[derive(Debug, Clone, Copy, PartialEq)]
struct Complex(f64, f64);

fn real(x: f64) -> Complex {
    Complex(x, 0.0)
}

impl Complex {
    fn size(self) -> f64 {
        self.0.hypot(self.1)
    }

    /// The square root with a positive real part.
    fn root(self) -> Self {
        let x = (0.5 * (self.size() + self.0)).sqrt();
        Self(x, 0.5 * self.1 / x)
    }
}

impl Add for Complex {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Self(self.0 + other.0, self.1 + other.1)
    }
}

impl Sub for Complex {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        Self(self.0 - other.0, self.1 - other.1)
    }
}

impl Mul for Complex {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        Self(self.0 * other.0 - self.1 * other.1, self.0 * other.1 + self.1 * other.0)
    }
}

impl Div for Complex {
    type Output = Self;
    fn div(self, other: Self) -> Self {
        let scale = 1.0 / (other.0 * other.0 + other.1 * other.1);
        let Self(x, y) = self * Self(other.0, -other.1);
        Self(scale * x, scale * y)
    }
}

#[cfg(test)]
mod tests {
    use super::super::checks::assert_close;
    use super::*;

    fn of(ohnesorge: f64) -> SwingingDrop {
        let viscosity = ohnesorge * 0.072f64.sqrt();
        SwingingDrop { radius: 1e-3, density: 1e3, viscosity, surface_tension: 0.072 }
    }

    #[test]
    fn little_viscosity_gives_lambs_decay_at_rayleighs_period() {
        let drop = of(1e-6);
        assert_close(drop.ohnesorge(), 1e-6, 1e-12);
        assert_close(drop.rayleigh_period(), 8.278e-3, 1e-3);
        let [decay, frequency] = drop.decay_and_frequency();
        assert_close(decay, 5.0 * drop.viscosity / (1e3 * 1e-6), 2e-3);
        assert_close(frequency * drop.rayleigh_period(), 2.0 * PI, 1e-6);
    }

    #[test]
    fn numbers_of_an_independent_solution() {
        // Roots with Bessel functions of complex order by another program, to 4 digits.
        let table = [
            (0.004, 0.9579, 0.9998),
            (0.03, 0.7393, 0.9950),
            (0.1, 0.4052, 0.9727),
            (0.3, 0.0874, 0.8893),
        ];
        for (ohnesorge, kept, slower) in table {
            let drop = of(ohnesorge);
            assert!((drop.kept() - kept).abs() < 1e-4, "{ohnesorge}: {}", drop.kept());
            let [_, frequency] = drop.decay_and_frequency();
            assert_close(frequency * drop.rayleigh_period() / (2.0 * PI), slower, 1e-4);
        }
    }

    #[test]
    fn root_satisfies_the_characteristic_equation() {
        for ohnesorge in [1e-4, 0.01, 0.1, 0.5] {
            let alpha_square = 8f64.sqrt() / ohnesorge;
            let q = root(alpha_square).root();
            assert!(defect(q, alpha_square).size() < 1e-7 * alpha_square.powi(2), "{ohnesorge}");
        }
    }
}
