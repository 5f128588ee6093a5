//! Surface tension as an energy: the area of the surfaces of equal smoothed volume fraction.

use super::smoothing::Smoothing;
use crate::kernel::Number;

/// Support radius h of the smoothed volume fraction over the distance of particles. At 3 the energy
/// of a lattice cut along steps exceeds that of its plane surfaces by 2 %, here by half of that.
const REACH: f64 = 4.0;
/// Volume fraction c above which no surfaces count, so that the unevenness of the bulk has no
/// energy.
const FULL: f64 = 0.95;
/// Volume fraction below which surfaces have a negligible weight.
const FAINTEST: f64 = 0.02;
/// Distance from the outermost particles, over h, beyond which the volume fraction has no weight:
/// 1e-3 at a plane surface, Δx/2 beyond them.
const OUTSIDE: f64 = 0.75;
/// Reduction of the volume fraction by unevenly distributed particles, beyond the estimate from its
/// slope.
const UNEVENNESS: f64 = 0.03;
/// Fraction of 1/h below which the gradient of the volume fraction has no reliable direction.
const FAINT: f64 = 0.01;

/// The energy of free and wetted surface.
///
/// With the smoothed volume fraction `C(x) = Σ V_j W(x − x_j)`, of support radius h and volumes at rest,
/// the area of its surfaces of equal C, each with a weight f of `∫ f dC = 1`, is an integral over
/// space (coarea formula, Federer 1959, Trans. Am. Math. Soc. 93, 418–491, doi 10.2307/1993504):
///
/// `E = σ ∫ f(C) |∇C| dV − σ cos θ ∫ F(C) dA`,  `F = ∫ f dC`,  `f = 15 s² (1 − s)² (3 − 2s)/c`,  `s = C/c`,
///
/// the second part over the wall z = 0 with contact angle θ (Young 1805, Phil. Trans. R. Soc. 95,
/// 65–87, doi 10.1098/rstl.1805.0005). Both are sums over points of a grid, see
/// [`FreeSurface`](super::free_surface::FreeSurface), and the forces are the exact derivatives of
/// these sums. A plane surface has the energy σ per area without any fitted constant; that of a
/// sphere of radius R is evaluated Δx/6 outside of it.
///
/// The outermost particles must be pressed onto the others: otherwise they detach and absorb energy
/// of the flow. So f begins and ends smoothly, and favours the outer surfaces.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct SurfaceEnergy {
    /// σ over ρ₀c₀²H, and cos θ.
    tension: f64,
    cosine: f64,
    pub smoothing: Smoothing,
}

impl SurfaceEnergy {
    /// Energy for a surface tension over ρ₀c₀²H and a distance of particles over H.
    pub fn of(tension: f64, cosine: f64, spacing: f64, dimension: usize) -> Self {
        Self { tension, cosine, smoothing: Smoothing::of(REACH * spacing, dimension) }
    }

    /// Returns true if the wall contributes.
    pub fn wets(&self) -> bool {
        self.cosine.abs() > 1e-12
    }

    /// Distance from all particles beyond which no point contributes.
    pub fn farthest(&self) -> f64 {
        OUTSIDE * self.smoothing.reach
    }

    /// Returns true if the surface may pass within `distance` of a point, given the volume fraction
    /// and the length of its gradient there.
    pub fn is_near(&self, fraction: f64, length: f64, distance: f64) -> bool {
        // Twice the slope, because it grows towards the surface.
        let change = 2.0 * length * distance;
        fraction + change > FAINTEST && fraction - change < FULL + UNEVENNESS
    }

    /// Energy of points that represent a volume above the wall, from the fraction and its gradient:
    /// the derivatives of the energy by the gradient and by the fraction, and the energy.
    #[inline(always)]
    pub fn of_free<N: Number>(&self, fraction: N, gradient: [N; 3], volume: f64) -> ([N; 3], N, N) {
        let [x, y, z] = gradient;
        let faint = N::constant(FAINT / self.smoothing.reach);
        let length = (x * x + y * y + z * z + faint * faint).sqrt();
        let [_, weight, change] = weights(fraction);
        let whole = N::constant(self.tension * volume);
        let along = whole * weight / length;
        let energy = whole * (length - faint);
        ([along * x, along * y, along * z], energy * change, energy * weight)
    }

    /// Energy of points that represent an area of the wall: the derivative of the energy by the
    /// fraction, and the energy.
    #[inline(always)]
    pub fn of_wall<N: Number>(&self, fraction: N, area: f64) -> (N, N) {
        let [share, weight, _] = weights(fraction);
        let pull = N::constant(-self.tension * self.cosine * area);
        (pull * weight, pull * share)
    }
}

/// F, f and f′ of a volume fraction.
#[inline(always)]
fn weights<N: Number>(fraction: N) -> [N; 3] {
    let number = N::constant;
    let s = (number(1.0 / FULL) * fraction).max(number(0.0));
    let s = s.choose_below(1.0, s, number(1.0));
    let t = number(1.0) - s;
    let (outer, cube) = (number(1.0) + number(2.0) * t, s * s * s);
    [
        cube * (number(15.0) - number(30.0) * s + number(21.0) * s * s - number(5.0) * cube),
        number(15.0 / FULL) * s * s * t * t * outer,
        number(30.0 / (FULL * FULL)) * s * t * (outer * (t - s) - s * t),
    ]
}

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;

    use super::*;
    use crate::kernel::Kernel;

    #[test]
    fn weights_are_successive_derivatives() {
        const STEP: f64 = 1e-6;
        for fraction in [0.02f64, 0.2, 0.4, 0.7, 0.93] {
            let [low, here, high] = [-STEP, 0.0, STEP].map(|step| weights(fraction + step));
            for n in 0..2 {
                let slope = (high[n] - low[n]) / (2.0 * STEP);
                assert!((slope - here[n + 1]).abs() < 1e-6, "{fraction} {slope} {here:?}");
            }
        }
        assert_eq!(weights(-0.1f64), [0.0; 3]);
        let [share, weight, _] = weights(1.1f64);
        assert!((share - 1.0).abs() < 1e-14 && weight == 0.0);
    }

    /// Two steps within a layer of particles of volume 1 each, the offset from one layer to the
    /// next above it, and their gap.
    struct Layers {
        steps: [[f64; 2]; 2],
        aside: [f64; 2],
        gap: f64,
    }

    fn cubic() -> Layers {
        Layers { steps: [[1.0, 0.0], [0.0, 1.0]], aside: [0.0; 2], gap: 1.0 }
    }

    /// Closest packing along its closest layers, and along its square ones.
    fn closest() -> [Layers; 2] {
        let row = 2f64.powf(1.0 / 6.0);
        let steps = [[row, 0.0], [0.5 * row, 0.75f64.sqrt() * row]];
        let aside = [0.5 * row, row / 12f64.sqrt()];
        let triangles = Layers { steps, aside, gap: (2.0f64 / 3.0).sqrt() * row };
        let steps = [[row, 0.0], [0.0, row]];
        [triangles, Layers { steps, aside: [0.5 * row; 2], gap: row / 2f64.sqrt() }]
    }

    /// A plane surface of layers: its energy and the depth at which it lies.
    fn surface(layers: &Layers) -> [f64; 2] {
        const POINTS: i32 = 12;
        let energy = SurfaceEnergy::of(1.0, 0.0, 1.0, 3);
        let Layers { steps: [a, b], aside, gap } = layers;
        let fraction = |x: f64, y: f64, z: f64| {
            let (mut value, mut gradient) = (0.0, [0.0; 3]);
            for k in 0..8 {
                let k = f64::from(k);
                for (i, j) in (-8..=8).flat_map(|i| (-8..=8).map(move |j| (i, j))) {
                    let (i, j) = (f64::from(i), f64::from(j));
                    // Layers are wide enough about the axis for every offset.
                    let shift = [0, 1].map(|n| -k * aside[n]);
                    let back = (k / 3.0).floor();
                    let at = [0, 1].map(|n| (i + back) * a[n] + (j + back) * b[n] + shift[n]);
                    let d = [x - at[0], y - at[1], z + gap * (k + 0.5)];
                    let r = d.iter().map(|d| d * d).sum::<f64>().sqrt();
                    let slope = Kernel::WendlandC2.gradient_factor(r, REACH, 3);
                    value += Kernel::WendlandC2.value(r, REACH, 3);
                    (0..3).for_each(|n| gradient[n] += slope * d[n]);
                }
            }
            (value, gradient)
        };
        let step = REACH / f64::from(POINTS);
        let mut sums = [0.0; 2];
        for (m, n) in [(0.0, 0.0), (0.5, 0.0), (0.25, 0.5), (0.75, 0.25)] {
            let [x, y] = [0, 1].map(|axis| m * a[axis] + n * b[axis]);
            for k in -POINTS..POINTS {
                let z = step * (f64::from(k) + 0.5);
                let (fraction, gradient) = fraction(x, y, z);
                let part = 0.25 * energy.of_free(fraction, gradient, step).2;
                sums[0] += part;
                sums[1] += z * part;
            }
        }
        [sums[0], sums[1] / sums[0]]
    }

    #[test]
    fn surface_energy_of_lattices() {
        let [triangles, squares] = closest();
        for layers in [cubic(), triangles, squares] {
            let [energy, height] = surface(&layers);
            assert!((energy - 1.0).abs() < 0.012, "{energy}");
            assert!((0.0..0.25).contains(&height), "{height}");
        }
    }

    /// Surface energy over σ of an even film, as a function of its thickness over the distance of
    /// particles: `∫ f dC` of both surfaces up to the fraction in its middle.
    fn film(thickness: f64) -> f64 {
        const POINTS: usize = 400;
        let step = REACH / POINTS as f64;
        let middle = |k: usize| step * (k as f64 + 0.5);
        // Cylinders about the middle, and the fraction of each inside the film.
        let inside = |radius: f64| -> f64 {
            let heights = (0..POINTS).map(middle).filter(|&z| z < 0.5 * thickness);
            let weight = |z: f64| Kernel::WendlandC2.value(radius.hypot(z), REACH, 3);
            heights.map(weight).sum::<f64>() * 2.0 * step
        };
        let rings = (0..POINTS).map(middle).map(|r| 2.0 * PI * r * step * inside(r));
        2.0 * weights(rings.sum::<f64>())[0]
    }

    #[test]
    fn tension_decreases_in_thin_films() {
        let expected =
            [(5.0, 1.0), (3.5, 0.99), (3.0, 0.92), (2.5, 0.70), (2.0, 0.30), (1.5, -0.15)];
        for (thickness, share) in expected {
            // At constant volume a film that widens becomes thinner.
            let change = (film(thickness + 0.1) - film(thickness - 0.1)) / 0.2;
            let tension = film(thickness) - thickness * change;
            assert!((tension / 2.0 - share).abs() < 0.02, "{thickness}: {tension}");
        }
    }
}
