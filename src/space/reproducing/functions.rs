//! Functions of nodes that reproduce polynomials at any place.

use super::basis::{add_slope, monomials, slope, terms};
use super::kernel::{CubicSpline, Kernel, Profile, QuarticSpline};
use super::{Refused, Reproducing, Shape};
use crate::math::lanes::{LANES, Lanes};
use crate::space::bins::Bins;
use crate::space::factor::Factor;
use crate::space::{Form, Mesh, Value};

/// The functions Ψ_I(x) = Hᵀ(0) M⁻¹(x) H(x − x_I) φ_I(x − x_I) with M = Σ_I H Hᵀ φ_I, where H are the monomials of a
/// complete polynomial and φ_I the kernel of node I: Σ_I Ψ_I(x) p(x_I) = p(x) for each such polynomial p.
///
/// Functions of nodes off a plane of symmetry or a held side vanish on it, because their kernels end there; so fixing
/// the nodes of the plane fixes the plane, as with finite elements. The axis of an axisymmetric model is such a plane.
///
/// Source: Liu, Jun & Zhang (1995), Int. J. Numer. Methods Fluids 20, 1081–1106, doi 10.1002/fld.1650200824.
#[derive(Debug)]
pub struct Functions {
    form: Form,
    settings: Reproducing,
    nodes: Vec<Node>,
    /// Normal coordinate and place of each plane on which functions of other nodes vanish.
    planes: Vec<(usize, f64)>,
    /// Distance within which a place lies on a plane [m].
    tolerance: f64,
    /// Lowest and highest coordinates of each support.
    supports: Vec<[[f64; 3]; 2]>,
    bins: Bins,
}

#[derive(Debug, Clone, Copy)]
struct Node {
    at: [f64; 3],
    /// Inverse of the lengths of the support [1/m] towards lower and higher coordinates.
    inverse: [[f64; 3]; 2],
    /// Half of the width of the support where no plane cuts it [m].
    reach: [f64; 3],
}

/// Functions at a place, in ascending order of nodes. It is reused, so that no place allocates memory.
#[derive(Debug, Clone, Default)]
pub struct Row {
    pub nodes: Vec<u32>,
    pub values: Vec<f64>,
    /// Empty if only values are evaluated.
    pub gradients: Vec<[f64; 3]>,
    packs: Vec<Pack>,
}

/// Nodes that reach a place, eight at once.
#[derive(Debug, Clone, Copy, Default)]
struct Pack {
    /// (x − x_I) over the scale of the place.
    y: [Lanes; 3],
    /// (x − x_I) over the length of the support on that side.
    s: [Lanes; 3],
    kernel: Lanes,
    /// ∂s/∂y, then the derivatives of the kernel by y.
    slope: [Lanes; 3],
}

impl Row {
    /// The row in the form of samples.
    pub fn values(&self) -> impl Iterator<Item = Value> + '_ {
        let gradient = |n: usize| self.gradients.get(n).copied().unwrap_or_default();
        (0..self.nodes.len()).map(move |n| Value {
            node: self.nodes[n],
            value: self.values[n],
            gradient: gradient(n),
        })
    }
}

impl Functions {
    /// Creates the functions of a mesh's nodes; `planes` are those on which functions of other nodes vanish.
    pub(super) fn new(mesh: &Mesh, settings: Reproducing, planes: Vec<(usize, f64)>) -> Self {
        let axes = mesh.form.axes();
        let spacings = spacings(mesh, settings.shape);
        let mean = |a: usize| spacings.iter().map(|s| s[a]).sum::<f64>() / spacings.len() as f64;
        let tolerance = 1e-9 * axes.iter().map(|&a| mean(a)).fold(f64::INFINITY, f64::min);
        let node = |(at, spacing): (&[f64; 3], &[f64; 3])| {
            let reach = spacing.map(|s| settings.support * s);
            let mut lengths = [reach, reach];
            for &(a, place) in &planes {
                let distance = at[a] - place;
                if distance > tolerance {
                    lengths[0][a] = lengths[0][a].min(distance);
                } else if distance < -tolerance {
                    lengths[1][a] = lengths[1][a].min(-distance);
                }
            }
            Node { at: *at, inverse: lengths.map(|ends| ends.map(|length| 1.0 / length)), reach }
        };
        let nodes: Vec<Node> = mesh.nodes.iter().zip(&spacings).map(node).collect();
        let supports: Vec<[[f64; 3]; 2]> = nodes
            .iter()
            .map(|node| {
                [0, 1].map(|end| {
                    let sign = if end == 0 { -1.0 } else { 1.0 };
                    [0, 1, 2].map(|a| node.at[a] + sign / node.inverse[end][a])
                })
            })
            .collect();
        let bins = Bins::new(axes, &supports, [0, 1, 2].map(mean));
        Self { form: mesh.form, settings, nodes, planes, tolerance, supports, bins }
    }

    /// Evaluates the functions at a place, with their gradients or only their values. On a plane on which functions of
    /// other nodes vanish, derivatives across it are 0. Results are the same on all processors.
    pub fn evaluate(&self, at: [f64; 3], gradients: bool, row: &mut Row) -> Result<(), Refused> {
        #[cfg(target_arch = "x86_64")]
        {
            // SAFETY: the processor has the instructions that each function requires.
            if is_x86_feature_detected!("avx512f") {
                return unsafe { self.evaluate_avx512(at, gradients, row) };
            }
            if is_x86_feature_detected!("avx2") {
                return unsafe { self.evaluate_avx2(at, gradients, row) };
            }
        }
        self.evaluate_plain(at, gradients, row)
    }

    #[cfg(target_arch = "x86_64")]
    #[target_feature(enable = "avx512f")]
    fn evaluate_avx512(&self, at: [f64; 3], gradients: bool, row: &mut Row) -> Result<(), Refused> {
        self.evaluate_plain(at, gradients, row)
    }

    #[cfg(target_arch = "x86_64")]
    #[target_feature(enable = "avx2")]
    fn evaluate_avx2(&self, at: [f64; 3], gradients: bool, row: &mut Row) -> Result<(), Refused> {
        self.evaluate_plain(at, gradients, row)
    }

    #[inline(always)]
    fn evaluate_plain(&self, at: [f64; 3], gradients: bool, row: &mut Row) -> Result<(), Refused> {
        match self.settings.kernel {
            Kernel::CubicSpline => self.with_kernel::<CubicSpline>(at, gradients, row),
            Kernel::QuarticSpline => self.with_kernel::<QuarticSpline>(at, gradients, row),
        }
    }

    #[inline(always)]
    fn with_kernel<P: Profile>(
        &self,
        at: [f64; 3],
        gradients: bool,
        row: &mut Row,
    ) -> Result<(), Refused> {
        // On a plane only its own nodes have functions; they do not determine the coordinate across it.
        let on = |a: usize| {
            let here = |&(axis, place): &(usize, f64)| {
                axis == a && (at[a] - place).abs() <= self.tolerance
            };
            self.planes.iter().any(here)
        };
        let is_on = [0, 1, 2].map(on);
        let mut along = [0; 3];
        let mut count = 0;
        for &a in self.form.axes().iter().filter(|&&a| !is_on[a]) {
            along[count] = a;
            count += 1;
        }
        let [a, b, c] = along;
        let place = (at, is_on);
        match (count, self.settings.basis) {
            (3, 1) => self.fill::<3, 4, P>(place, [a, b, c], gradients, row),
            (3, _) => self.fill::<3, 10, P>(place, [a, b, c], gradients, row),
            (2, 1) => self.fill::<2, 3, P>(place, [a, b], gradients, row),
            (2, _) => self.fill::<2, 6, P>(place, [a, b], gradients, row),
            (1, 1) => self.fill::<1, 2, P>(place, [a], gradients, row),
            (1, _) => self.fill::<1, 3, P>(place, [a], gradients, row),
            _ => self.fill::<0, 1, P>(place, [], gradients, row),
        }
    }

    /// Evaluates the functions of the coordinates `axes`. With M b = H(0) and r_k = M,ₖ b, Ψ = H·b φ and
    /// Ψ,ₖ = (H,ₖ·b − H·M⁻¹r_k) φ + H·b φ,ₖ.
    #[inline(always)]
    fn fill<const D: usize, const N: usize, P: Profile>(
        &self,
        (at, on_plane): ([f64; 3], [bool; 3]),
        axes: [usize; D],
        gradients: bool,
        row: &mut Row,
    ) -> Result<(), Refused> {
        let scale = self.collect(at, axes, on_plane, row);
        let count = row.nodes.len();
        row.packs.truncate(count.div_ceil(LANES));
        for (number, pack) in row.packs.iter_mut().enumerate() {
            pack.weigh::<D, P>(self.settings.shape, count - number * LANES);
        }
        let factor = Factor::of(&moments::<D, N>(&row.packs)).ok_or(Refused::FewNeighbours {
            at,
            neighbours: count,
            terms: terms(D, self.settings.basis),
            support: self.settings.support,
        })?;
        let mut first = [0.0; N];
        first[0] = 1.0;
        let b = factor.solve(first);
        row.values.clear();
        row.gradients.clear();
        if gradients {
            let change = changes::<D, N>(&row.packs, &b).map(|r| factor.solve(r));
            let inverse_scale = scale.map(|scale| 1.0 / scale);
            for pack in &row.packs {
                let y = pack.along::<D>();
                let h = monomials::<D, N>(&y);
                let c = dot(&h, &b);
                let mut gradient = [Lanes::default(); 3];
                for k in 0..D {
                    let by_basis = (slope(k, &y, &b) - dot(&h, &change[k])) * pack.kernel;
                    let sum = by_basis + c * pack.slope[k];
                    gradient[axes[k]] = sum * Lanes::splat(inverse_scale[k]);
                }
                row.values.extend_from_slice(&(c * pack.kernel).0);
                let [x, y, z] = gradient;
                row.gradients.extend((0..LANES).map(|n| [x.0[n], y.0[n], z.0[n]]));
            }
            row.gradients.truncate(count);
        } else {
            for pack in &row.packs {
                let h = monomials::<D, N>(&pack.along::<D>());
                row.values.extend_from_slice(&(dot(&h, &b) * pack.kernel).0);
            }
        }
        row.values.truncate(count);
        Ok(())
    }

    /// Collects the nodes that reach a place. Returns the scale of the coordinates there [m].
    #[inline(always)]
    fn collect<const D: usize>(
        &self,
        at: [f64; 3],
        axes: [usize; D],
        on_plane: [bool; 3],
        row: &mut Row,
    ) -> [f64; D] {
        let candidates = self.bins.near(at);
        row.nodes.resize(candidates.len(), 0);
        let on_same_plane = |number: u32| {
            let node = &self.nodes[number as usize];
            (0..3).all(|a| !on_plane[a] || (at[a] - node.at[a]).abs() <= self.tolerance)
        };
        let any_plane = on_plane.contains(&true);
        let mut count = 0;
        for &number in candidates {
            let [low, high] = &self.supports[number as usize];
            let mut reaches = !any_plane || on_same_plane(number);
            for &a in &axes {
                reaches &= (low[a] < at[a]) & (at[a] < high[a]);
            }
            // The next place is overwritten unless the node reaches, which no branch has to predict.
            row.nodes[count] = number;
            count += usize::from(reaches);
        }
        row.nodes.truncate(count);
        if self.settings.shape == Shape::Round {
            row.nodes.retain(|&number| self.nodes[number as usize].reaches(at, &axes));
        }
        let count = row.nodes.len();
        let scale = row.nodes.first().map_or([1.0; 3], |&n| self.nodes[n as usize].reach);
        let scale = axes.map(|a| scale[a]);
        let inverse_scale = scale.map(|scale| 1.0 / scale);
        row.packs.resize(count.div_ceil(LANES), Pack::default());
        for (numbers, pack) in row.nodes.chunks(LANES).zip(&mut row.packs) {
            for (lane, &number) in numbers.iter().enumerate() {
                let node = &self.nodes[number as usize];
                for k in 0..D {
                    let difference = at[axes[k]] - node.at[axes[k]];
                    let inverse = node.inverse[usize::from(difference > 0.0)][axes[k]];
                    pack.y[k].0[lane] = difference * inverse_scale[k];
                    pack.s[k].0[lane] = difference * inverse;
                    pack.slope[k].0[lane] = inverse * scale[k];
                }
            }
        }
        scale
    }
}

impl Node {
    /// Returns true if the node's round support reaches a place.
    fn reaches(&self, at: [f64; 3], axes: &[usize]) -> bool {
        let square = |&a: &usize| {
            let difference = at[a] - self.at[a];
            (difference * self.inverse[usize::from(difference > 0.0)][a]).powi(2)
        };
        axes.iter().map(square).sum::<f64>() < 1.0
    }
}

impl Pack {
    /// Computes the kernels of the first `count` nodes; the others get zero.
    #[inline(always)]
    fn weigh<const D: usize, P: Profile>(&mut self, shape: Shape, count: usize) {
        for lane in count.min(LANES)..LANES {
            for k in 0..D {
                self.y[k].0[lane] = 0.0;
                self.s[k].0[lane] = 1.0;
                self.slope[k].0[lane] = 0.0;
            }
        }
        match shape {
            Shape::Box => {
                let parts: [Lanes; D] =
                    std::array::from_fn(|k| self.s[k].map(|s| P::value(s.abs().min(1.0))));
                self.kernel = product(&parts, D);
                for k in 0..D {
                    // Slopes are negative.
                    let slope = self.s[k].map(|s| P::slope(s.abs().min(1.0)).copysign(-s));
                    self.slope[k] = self.slope[k] * slope * product(&parts, k);
                }
            }
            Shape::Round => {
                let square = |sum: Lanes, k: usize| sum + self.s[k] * self.s[k];
                let length = (0..D).fold(Lanes::default(), square).map(|x| x.sqrt().min(1.0));
                self.kernel = length.map(P::value);
                let slope = length.map(P::slope_over_s);
                for k in 0..D {
                    self.slope[k] = self.slope[k] * slope * self.s[k];
                }
            }
        }
        // Where planes hold all coordinates, no kernel is left to vanish.
        self.kernel.0[count.min(LANES)..].fill(0.0);
    }

    #[inline(always)]
    fn along<const D: usize>(&self) -> [Lanes; D] {
        std::array::from_fn(|k| self.y[k])
    }
}

/// Product of all parts but one.
#[inline(always)]
fn product<const D: usize>(parts: &[Lanes; D], but: usize) -> Lanes {
    let mut product = Lanes::splat(1.0);
    for (k, &part) in parts.iter().enumerate() {
        if k != but {
            product = product * part;
        }
    }
    product
}

/// Lower triangle of M = Σ H Hᵀ φ.
#[inline(always)]
fn moments<const D: usize, const N: usize>(packs: &[Pack]) -> [[f64; N]; N] {
    let mut sums = [[Lanes::default(); N]; N];
    for pack in packs {
        let h = monomials::<D, N>(&pack.along::<D>());
        for i in 0..N {
            let weighted = h[i] * pack.kernel;
            for j in 0..=i {
                sums[i][j] = sums[i][j] + weighted * h[j];
            }
        }
    }
    sums.map(|row| row.map(Lanes::sum))
}

/// r_k = Σ (H,ₖ φ + H φ,ₖ) H·b + H φ H,ₖ·b.
#[inline(always)]
fn changes<const D: usize, const N: usize>(packs: &[Pack], b: &[f64; N]) -> [[f64; N]; D] {
    let mut sums = [[Lanes::default(); N]; D];
    for pack in packs {
        let y = pack.along::<D>();
        let h = monomials::<D, N>(&y);
        let c = dot(&h, b);
        for (k, sums) in sums.iter_mut().enumerate() {
            let along = slope(k, &y, b) * pack.kernel + c * pack.slope[k];
            for i in 0..N {
                sums[i] = sums[i] + h[i] * along;
            }
            add_slope(k, &y, c * pack.kernel, sums);
        }
    }
    sums.map(|row| row.map(Lanes::sum))
}

#[inline(always)]
fn dot<const N: usize>(h: &[Lanes; N], factors: &[f64; N]) -> Lanes {
    let mut sum = Lanes::splat(0.0);
    for i in 0..N {
        sum = sum + h[i] * Lanes::splat(factors[i]);
    }
    sum
}

/// Spacing of each node: the largest distance to nodes of the same cells, along each coordinate for supports that are
/// boxes, and in space for round ones.
pub(in crate::space) fn spacings(mesh: &Mesh, shape: Shape) -> Vec<[f64; 3]> {
    let mut spacings = vec![[0.0_f64; 3]; mesh.nodes.len()];
    for cell in &mesh.cells {
        for &node in cell {
            for &other in cell {
                let (x, y) = (mesh.nodes[node as usize], mesh.nodes[other as usize]);
                let apart = [0, 1, 2].map(|a| (x[a] - y[a]).abs());
                let spacing = &mut spacings[node as usize];
                match shape {
                    Shape::Box => (0..3).for_each(|a| spacing[a] = spacing[a].max(apart[a])),
                    Shape::Round => {
                        let distance = apart.iter().map(|x| x * x).sum::<f64>().sqrt();
                        *spacing = spacing.map(|s| s.max(distance));
                    }
                }
            }
        }
    }
    spacings
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn processors_agree_to_the_bit() {
        let mesh = Mesh::of_ball(Form::Solid, 1.0, 2, 2, [true, true]);
        for (basis, kernel, shape, support) in [
            (1, Kernel::CubicSpline, Shape::Box, 1.75),
            (2, Kernel::QuarticSpline, Shape::Box, 2.75),
            (1, Kernel::CubicSpline, Shape::Round, 1.6),
        ] {
            let settings = Reproducing { basis, kernel, shape, support, ..Reproducing::default() };
            let functions = Functions::of(&mesh, settings).unwrap();
            for n in 0..50 {
                let at = [0.01, 0.007, 0.012].map(|step| step * f64::from(n));
                let [mut fast, mut plain] = [Row::default(), Row::default()];
                functions.evaluate(at, true, &mut fast).unwrap();
                functions.evaluate_plain(at, true, &mut plain).unwrap();
                assert_eq!((&fast.nodes, &fast.values), (&plain.nodes, &plain.values));
                assert_eq!(fast.gradients, plain.gradients);
            }
        }
    }
}
