//! Particles that are rings about the axis x = y = 0, and sums over pairs of them.
//!
//! A ring is uniform around the axis, so a pair of rings interacts as one place of the first with
//! all places of the second. All laws are those of three dimensions. Hoop strain, the second
//! curvature of a surface and the behaviour at the axis follow from the sum.

use super::lanes::Lanes;

/// Form of a particle.
pub trait Form: Send + Sync + 'static {
    /// True for a ring about the axis.
    const ROUND: bool;
}

/// A particle at a point.
pub struct Point;

/// A ring about the axis. Its position has y = 0 and its radius as x. Mass and volume are those of
/// the whole ring.
pub struct Ring;

impl Form for Point {
    const ROUND: bool = false;
}

impl Form for Ring {
    const ROUND: bool = true;
}

/// Calls a generic function with the form of particles.
macro_rules! with_form {
    ($rings:expr, $form:ident => $call:expr) => {
        match $rings {
            false => {
                type $form = $crate::method::sph::rings::Point;
                $call
            }
            true => {
                type $form = $crate::method::sph::rings::Ring;
                $call
            }
        }
    };
}
pub(crate) use with_form;

/// Quadrature points on half of an arc.
pub const PLACES: usize = 4;
/// sin²θ and cos θ at the middles θ of equal parts of a right angle.
const SQUARES: [f64; PLACES] =
    [0.03806023374435663, 0.3086582838174551, 0.6913417161825449, 0.9619397662556434];
const COSINES: [f64; PLACES] =
    [0.9807852804032304, 0.8314696123025452, 0.5555702330196022, 0.19509032201612825];
/// Product of two radii below which the arc degenerates.
const LEAST: f64 = 1e-12;

/// The arc of a ring within a distance of 1 of a place on another ring, as half of a symmetric arc.
///
/// At an angle φ between both, their distance is `√(d² + 4 r r′ t²)`, with t = sin(φ/2) and d the
/// distance at φ = 0. So the arc ends at `t_m² = min(1, (1 − d²)/(4 r r′))`. With `t = t_m sin θ` a
/// sum over the ring is
///
/// `1/(2π) ∫ f dφ = (2/π) ∫ f t_m cos θ/√(1 − t²) dθ` over a right angle.
///
/// The integrand continues evenly beyond both ends, so the midpoint rule with four points is
/// accurate to some 1e-3, for all arcs and for whole rings (L. N. Trefethen and J. A. C. Weideman,
/// SIAM Rev. 56 (2014) 385–458, doi 10.1137/130932132). Arcs are the same from both ends, so that
/// sums over pairs stay symmetric.
#[derive(Clone, Copy)]
pub struct Arc<L> {
    /// t_m and t_m².
    end: L,
    square: L,
    /// Radius of the ring that the arc belongs to.
    radius: L,
}

/// A place on an arc, by its angle φ.
#[derive(Clone, Copy)]
pub struct Turn<L> {
    /// Fraction of the ring that it represents, together with its mirror image at −φ.
    pub weight: L,
    /// 1 − cos φ and sin φ.
    back: L,
    aside: L,
    radius: L,
}

impl<L: Lanes> Arc<L> {
    /// Arc of a ring about a place at another radius, at a squared distance within the plane.
    #[inline(always)]
    pub fn about(own: L, radius: L, distance_squared: L) -> Self {
        let one = L::constant(1.0);
        let within = (one - distance_squared).max(L::constant(0.0));
        let both = (L::constant(4.0) * own * radius).max(L::constant(LEAST));
        let square = within / both;
        let square = square.choose_below(1.0, square, one);
        Self { end: square.sqrt(), square, radius }
    }

    #[inline(always)]
    pub fn turn(&self, place: usize) -> Turn<L> {
        let square = self.square * L::constant(SQUARES[place]);
        let root = (L::constant(1.0) - square).sqrt();
        let along = L::constant(2.0 * SQUARES[place].sqrt());
        Turn {
            weight: self.end * L::constant(COSINES[place] / PLACES as f64) / root,
            back: L::constant(2.0) * square,
            aside: along * self.end * root,
            radius: self.radius,
        }
    }
}

impl<L: Lanes> Turn<L> {
    /// Rotates a position in the plane y = 0, relative to any origin in it, about the axis.
    #[inline(always)]
    pub fn place(&self, [x, _, z]: [L; 3]) -> [L; 3] {
        [x - self.radius * self.back, self.radius * self.aside, z]
    }

    /// Rotates a vector in the plane y = 0 along with its place.
    #[inline(always)]
    pub fn vector(&self, [x, _, z]: [L; 3]) -> [L; 3] {
        [x - x * self.back, x * self.aside, z]
    }

    /// Expresses a vector in the axes of the turned place.
    #[inline(always)]
    pub fn seen(&self, [x, y, z]: [L; 3]) -> [L; 3] {
        [x - x * self.back + y * self.aside, y - y * self.back - x * self.aside, z]
    }

    /// Rotates a record of position, velocity, volume and one more number.
    #[inline(always)]
    pub fn record(&self, [x, y, z, u, v, w, volume, last]: [L; 8]) -> [L; 8] {
        let ([x, y, z], [u, v, w]) = (self.place([x, y, z]), self.vector([u, v, w]));
        [x, y, z, u, v, w, volume * self.weight, last]
    }

    /// Rotates an annex of a vector and one more number.
    #[inline(always)]
    pub fn annex(&self, [x, y, z, last]: [L; 4]) -> [L; 4] {
        let [x, y, z] = self.vector([x, y, z]);
        [x, y, z, last]
    }
}

/// Removes the y component, which a ring does not have.
#[inline(always)]
pub fn flat<F: Form>([x, y, z]: [f64; 3]) -> [f64; 3] {
    [x, if F::ROUND { 0.0 } else { y }, z]
}

#[cfg(test)]
mod tests {
    use super::super::lanes::{Array, Lanes};
    use super::*;
    use crate::kernel::{Kernel, Number};

    /// Mean over a ring of a function of the distance to a place at another radius, `d` away within
    /// the plane.
    fn mean(f: impl Fn(f64) -> f64, [own, radius]: [f64; 2], d: f64) -> f64 {
        let lanes = Array::<f64>::constant;
        let arc = Arc::about(lanes(own), lanes(radius), lanes(d * d));
        let place = |place: usize| {
            let turn = arc.turn(place);
            // From the place at x = own to the rotated place at x = radius.
            let [x, y, _] = turn.place([lanes(radius), lanes(0.0), lanes(0.0)]);
            let [x, y, weight] = [x, y, turn.weight].map(|l| l.to_array()[0]);
            let height = d * d - (own - radius).powi(2);
            weight * f(((x - own).powi(2) + y * y + height).sqrt())
        };
        (0..PLACES).map(place).sum()
    }

    /// Reference value from very many places.
    fn exact(f: impl Fn(f64) -> f64, [own, radius]: [f64; 2], d: f64) -> f64 {
        const COUNT: usize = 400_000;
        let place = |n: usize| {
            let half = std::f64::consts::PI * (n as f64 + 0.5) / COUNT as f64 / 2.0;
            f((d * d + 4.0 * own * radius * half.sin().powi(2)).sqrt())
        };
        (0..COUNT).map(place).sum::<f64>() / COUNT as f64
    }

    #[test]
    fn quadrature_on_arcs_matches_fine_quadrature() {
        for own in [0.05_f64, 0.17, 0.5, 1.5, 20.0] {
            for d in [0.05_f64, 0.3, 0.6, 0.9] {
                for part in [0.0, 0.7, -0.7] {
                    let radii = [own, (own + part * d).abs().max(0.01)];
                    let apart = d.max((radii[0] - radii[1]).abs());
                    let value = |q: f64| Kernel::WendlandC2.value(q, 1.0, 3);
                    let slope = |q: f64| -Kernel::WendlandC2.gradient_factor(q, 1.0, 3);
                    let largest = [exact(value, [own; 2], 0.0), exact(slope, [own; 2], 0.0)];
                    let off = [
                        mean(value, radii, apart) - exact(value, radii, apart),
                        mean(slope, radii, apart) - exact(slope, radii, apart),
                    ];
                    assert!(off[0].abs() < 0.012 * largest[0], "{radii:?} {apart}: {off:?}");
                    assert!(off[1].abs() < 0.06 * largest[1], "{radii:?} {apart}: {off:?}");
                }
            }
        }
    }

    #[test]
    fn weights_of_whole_rings_sum_to_one() {
        // The farthest place is within reach.
        for radii in [[0.1_f64, 0.2], [0.3, 0.3], [0.01, 0.6]] {
            let d = (radii[0] - radii[1]).abs();
            assert!((mean(|_| 1.0, radii, d) - 1.0).abs() < 1e-12, "{radii:?}");
        }
    }

    #[test]
    fn arcs_are_symmetric_in_both_rings() {
        let value = |q: f64| Kernel::WendlandC2.value(q, 1.0, 3);
        for radii in [[0.2, 0.7], [2.0, 2.3], [0.0, 0.5]] {
            let [a, b] = [radii, [radii[1], radii[0]]].map(|radii| mean(value, radii, 0.6));
            assert!((a - b).abs() < 1e-12 && a > 0.0, "{radii:?}: {a} {b}");
        }
    }
}
