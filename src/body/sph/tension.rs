//! Surface tension as an energy: the area of the surfaces of equal smoothed volume fraction.

use super::images::{Images, Source};
use super::lanes::{Lanes, WIDTH, lanes};
use super::loops::{Local, PairSum};
use super::neighbours::Block;
use crate::kernel::{Kernel, Shape};

/// Support radius h of the smoothed volume fraction over the distance of particles: at 3 the energy of
/// a lattice that is cut along steps is 2 % above that of its plane surfaces, here half of that.
const REACH: f64 = 4.0;
/// Volume fraction c above which no surfaces are counted, so that the unevenness of the bulk has no
/// energy.
const FULL: f64 = 0.95;
/// Volume fraction below which surfaces have no weight to speak of.
const FAINTEST: f64 = 0.02;
/// How much particles that stand unevenly lower the volume fraction beyond what its slope tells.
const UNEVENNESS: f64 = 0.03;
/// Share of 1/h below which a gradient of the volume fraction has no certain direction.
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
/// [`FreeSurface`](super::free_surface::FreeSurface), and forces the exact derivatives of the sums.
/// A plane surface has the energy σ a unit of area with nothing fitted; that of a sphere of radius R
/// is counted Δx/6 outside of it.
///
/// The outermost particles have to be pressed onto the others, or they come loose and take the energy
/// of the flow: f begins and ends smoothly, and favours the outer surfaces.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct SurfaceEnergy {
    /// σ over ρ₀c₀²H, and cos θ.
    tension: f64,
    cosine: f64,
    /// h over H.
    pub reach: f64,
    /// Scale of the kernel of support h.
    scale: f64,
}

/// What the energy asks of the particles round one point of the grid: its derivatives by ∇C and by
/// C, and itself.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Slopes {
    pub by_gradient: [f64; 3],
    pub by_fraction: f64,
    pub energy: f64,
}

/// Smoothed volume fraction and its gradient at a point.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Fraction {
    pub value: f64,
    pub gradient: [f64; 3],
}

impl SurfaceEnergy {
    /// For a surface tension over ρ₀c₀²H and a distance of particles over H.
    pub fn of(tension: f64, cosine: f64, kernel: Kernel, spacing: f64, dimension: usize) -> Self {
        let reach = REACH * spacing;
        Self { tension, cosine, reach, scale: kernel.scale(reach, dimension) }
    }

    /// Whether the wall has a share.
    pub fn wets(&self) -> bool {
        self.cosine.abs() > 1e-12
    }

    /// Whether the surface may pass within `distance` of a point.
    pub fn is_near(&self, fraction: &Fraction, distance: f64) -> bool {
        // Twice the slope, for it grows towards the surface.
        let change = 2.0 * norm(fraction.gradient, 0.0) * distance;
        fraction.value + change > FAINTEST && fraction.value - change < FULL + UNEVENNESS
    }

    /// Of a point that stands for a volume in the space above the wall.
    pub fn of_free(&self, fraction: &Fraction, volume: f64) -> Slopes {
        let [x, y, z] = fraction.gradient;
        let faint = FAINT / self.reach;
        let length = norm(fraction.gradient, faint);
        let [_, weight, change] = weights(fraction.value);
        let along = self.tension * volume * weight / length;
        Slopes {
            by_gradient: [along * x, along * y, along * z],
            by_fraction: self.tension * volume * change * (length - faint),
            energy: self.tension * volume * weight * (length - faint),
        }
    }

    /// Of a point that stands for an area of the wall.
    pub fn of_wall(&self, fraction: &Fraction, area: f64) -> Slopes {
        let [share, weight, _] = weights(fraction.value);
        let pull = -self.tension * self.cosine * area;
        Slopes { by_gradient: [0.0; 3], by_fraction: pull * weight, energy: pull * share }
    }
}

fn norm([x, y, z]: [f64; 3], least: f64) -> f64 {
    (x * x + y * y + z * z + least * least).sqrt()
}

/// F, f and f′ of a volume fraction.
fn weights(fraction: f64) -> [f64; 3] {
    let s = (fraction / FULL).clamp(0.0, 1.0);
    let (t, width) = (1.0 - s, FULL);
    [
        s * s * s * (15.0 - 30.0 * s + 21.0 * s * s - 5.0 * s * s * s),
        15.0 * s * s * t * t * (1.0 + 2.0 * t) / width,
        30.0 * s * t * ((1.0 + 2.0 * t) * (t - s) - s * t) / (width * width),
    ]
}

/// Volume fractions at points among the particles.
pub struct Fractions<'a> {
    pub images: &'a Images,
    /// Position and, as the seventh number, volume at rest of every particle.
    pub records: &'a [[f64; 8]],
    pub points: &'a [[f64; 3]],
    pub energy: SurfaceEnergy,
}

impl PairSum for Fractions<'_> {
    type Output = Fraction;

    #[inline(always)]
    fn records(&self) -> &[[f64; 8]] {
        self.records
    }

    #[inline(always)]
    fn images(&self) -> &Images {
        self.images
    }

    #[inline(always)]
    fn sum<L: Lanes, S: Shape>(&self, block: &Block, k: usize, local: &Local<L::Real>) -> Fraction {
        let SurfaceEnergy { reach, scale, .. } = self.energy;
        let at = about::<L>(self.points[block.first + k], block);
        let nearer = L::constant(1.0 / reach);
        let mut gradient = [L::constant(0.0); 3];
        let mut value = L::constant(0.0);
        for places in block.neighbours(k).into_iter().flatten() {
            let [x, y, z, _, _, _, volume, _] = local.gather(places);
            let d = [at[0] - x, at[1] - y, at[2] - z];
            let q = (d[0] * d[0] + d[1] * d[1] + d[2] * d[2]).sqrt() * nearer;
            let slope = volume * S::slope_over_q(q);
            value = value + volume * S::value(q);
            for a in 0..3 {
                gradient[a] = gradient[a] + slope * d[a];
            }
        }
        let steep = scale / (reach * reach);
        let [x, y, z] = gradient;
        Fraction {
            value: scale * value.sum().into(),
            gradient: [steep * x.sum().into(), steep * y.sum().into(), steep * z.sum().into()],
        }
    }
}

/// What the grid's points do to a particle, over its volume at rest.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Pull {
    /// By points on the fluid's side of the wall, and by their images beyond it.
    pub by_fluid: [f64; 3],
    pub by_wall: [f64; 3],
    /// φ, the derivative of the energy by the particle's volume.
    pub potential: f64,
}

/// The pull of the grid's points on particles.
///
/// With the slopes A, b of a point and d from the particle to it,
/// `f = Σ [∇∇W(d) A + b ∇W(d)]`,  `φ = Σ [A·∇W(d) + b W(d)]`.
pub struct Pulls<'a> {
    pub images: &'a Images,
    /// Position, A and b of every point, and 0.
    pub records: &'a [[f64; 8]],
    /// Of the particles.
    pub points: &'a [[f64; 3]],
    pub energy: SurfaceEnergy,
}

impl PairSum for Pulls<'_> {
    type Output = Pull;

    #[inline(always)]
    fn records(&self) -> &[[f64; 8]] {
        self.records
    }

    #[inline(always)]
    fn images(&self) -> &Images {
        self.images
    }

    #[inline(always)]
    fn record(&self, source: Source) -> [f64; 8] {
        let image = self.images.get(source.code());
        let [x, y, z, a, b, c, by_fraction, _] = self.records[source.particle()];
        let ([x, y, z], [a, b, c]) = (image.place([x, y, z]), image.turn([a, b, c]));
        [x, y, z, a, b, c, by_fraction, 0.0]
    }

    #[inline(always)]
    fn sum<L: Lanes, S: Shape>(&self, block: &Block, k: usize, local: &Local<L::Real>) -> Pull {
        let at = about::<L>(self.points[block.first + k], block);
        let [free, wall] = block.neighbours(k);
        let [x, y, z, p] = self.total::<L, S>(free, at, local);
        let [u, v, w, q] = self.total::<L, S>(wall, at, local);
        Pull { by_fluid: [x, y, z], by_wall: [u, v, w], potential: p + q }
    }
}

impl Pulls<'_> {
    /// Force and potential of a list of points.
    #[inline(always)]
    fn total<L: Lanes, S: Shape>(
        &self,
        neighbours: &[[u16; WIDTH]],
        at: [L; 3],
        local: &Local<L::Real>,
    ) -> [f64; 4] {
        let SurfaceEnergy { reach, scale, .. } = self.energy;
        let nearer = L::constant(1.0 / reach);
        let bends = L::constant(1.0 / (reach * reach));
        let steep = scale / (reach * reach);
        let mut force = [L::constant(0.0); 3];
        let mut along_slopes = L::constant(0.0);
        let mut by_fractions = L::constant(0.0);
        for places in neighbours {
            let [x, y, z, a, b, c, by_fraction, _] = local.gather::<L>(places);
            let d = [x - at[0], y - at[1], z - at[2]];
            let slopes = [a, b, c];
            let q = (d[0] * d[0] + d[1] * d[1] + d[2] * d[2]).sqrt() * nearer;
            let slope = S::slope_over_q(q);
            let down = d[0] * a + d[1] * b + d[2] * c;
            let along = bends * S::bend_over_q(q) * down + by_fraction * slope;
            for n in 0..3 {
                force[n] = force[n] + (along * d[n] + slope * slopes[n]);
            }
            along_slopes = along_slopes + slope * down;
            by_fractions = by_fractions + by_fraction * S::value(q);
        }
        let [x, y, z] = force;
        [
            steep * x.sum().into(),
            steep * y.sum().into(),
            steep * z.sum().into(),
            steep * along_slopes.sum().into() + scale * by_fractions.sum().into(),
        ]
    }
}

/// A point about the centre of a block, in all lanes.
#[inline(always)]
fn about<L: Lanes>(point: [f64; 3], block: &Block) -> [L; 3] {
    let [x, y, z] = block.centre;
    lanes([point[0] - x, point[1] - y, point[2] - z])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn weights_are_an_integral_its_derivative_and_that_of_it() {
        const STEP: f64 = 1e-6;
        for fraction in [0.02, 0.2, 0.4, 0.7, 0.93] {
            let [low, here, high] = [-STEP, 0.0, STEP].map(|step| weights(fraction + step));
            for n in 0..2 {
                let slope = (high[n] - low[n]) / (2.0 * STEP);
                assert!((slope - here[n + 1]).abs() < 1e-6, "{fraction} {slope} {here:?}");
            }
        }
        assert_eq!(weights(-0.1), [0.0; 3]);
        assert!((weights(1.1)[0] - 1.0).abs() < 1e-14 && weights(1.1)[1] == 0.0);
    }

    /// Two steps within a layer of particles in a volume 1 each, the way from one layer to the next above
    /// it, and their gap.
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

    /// A plane surface of layers, its energy and the depth at which it is counted.
    fn surface(layers: &Layers) -> [f64; 2] {
        const POINTS: i32 = 12;
        let energy = SurfaceEnergy::of(1.0, 0.0, Kernel::WendlandC2, 1.0, 3);
        let Layers { steps: [a, b], aside, gap } = layers;
        let fraction = |x: f64, y: f64, z: f64| {
            let mut sum = Fraction::default();
            for k in 0..8 {
                let k = f64::from(k);
                for (i, j) in (-8..=8).flat_map(|i| (-8..=8).map(move |j| (i, j))) {
                    let (i, j) = (f64::from(i), f64::from(j));
                    // Layers are as wide as needed about the axis, whatever they are moved by.
                    let shift = [0, 1].map(|n| -k * aside[n]);
                    let back = (k / 3.0).floor();
                    let at = [0, 1].map(|n| (i + back) * a[n] + (j + back) * b[n] + shift[n]);
                    let d = [x - at[0], y - at[1], z + gap * (k + 0.5)];
                    let r = norm(d, 0.0);
                    let slope = Kernel::WendlandC2.gradient_factor(r, REACH, 3);
                    sum.value += Kernel::WendlandC2.value(r, REACH, 3);
                    (0..3).for_each(|n| sum.gradient[n] += slope * d[n]);
                }
            }
            sum
        };
        let step = REACH / f64::from(POINTS);
        let mut sums = [0.0; 2];
        for (m, n) in [(0.0, 0.0), (0.5, 0.0), (0.25, 0.5), (0.75, 0.25)] {
            let [x, y] = [0, 1].map(|axis| m * a[axis] + n * b[axis]);
            for k in -POINTS..POINTS {
                let z = step * (f64::from(k) + 0.5);
                let part = 0.25 * energy.of_free(&fraction(x, y, z), step).energy;
                sums[0] += part;
                sums[1] += z * part;
            }
        }
        [sums[0], sums[1] / sums[0]]
    }

    #[test]
    fn surfaces_of_all_lattices_have_the_energy_asked_for() {
        let [triangles, squares] = closest();
        for layers in [cubic(), triangles, squares] {
            let [energy, height] = surface(&layers);
            assert!((energy - 1.0).abs() < 0.012, "{energy}");
            assert!((0.0..0.25).contains(&height), "{height}");
        }
    }
}
