//! Preconditioner of a box: its stiffness without the coupling between displacement components.
//!
//! Each diagonal block is a sum of products of matrices of the three axes, nearly `(λ + 2µ) K⊗M⊗M + µ (M⊗K⊗M + M⊗M⊗K)`.
//! The eigenvectors of K and M along x and y leave one banded system along z for each pair of them (after R. E. Lynch,
//! J. R. Rice and D. H. Thomas 1964, doi 10.1007/BF01386067), so grading through the depth is met exactly. Enhanced
//! strains and projected dilatations keep some parts of K and M from some moduli; of these, what stands on the
//! diagonal between eigenvectors is taken along x and y, which is all on equal elements.
//!
//! It is applied in single precision, which costs half: conjugate gradients keep their residual in double precision and
//! need no iteration more, a few per cent more through layers whose moduli differ a hundredfold. Double precision is
//! left for numbers beyond the range.

use std::ops::Range;

use faer::{Mat, MatRef};
use num_traits::{AsPrimitive, Float};

use super::brick_polynomials::{PolynomialModuli, legendre, moduli, strain_of};
use super::modes::{AxisModes, EndCondition};
use crate::laws::Thermoelastic;
use crate::math::product::product;
use crate::method::mesh::Axis;
use crate::method::mesh::Mesh;
use crate::runtime::parallel::Team;

/// Eigenvectors of the axes for each component, and the factors of the remaining systems along z.
pub struct BrickInverse {
    nodes: [usize; 3],
    blocks: Blocks,
}

/// The inverse for each component of displacement.
enum Blocks {
    Single([Block<f32>; 3]),
    Double([Block<f64>; 3]),
}

struct Block<T> {
    /// Eigenvectors along x and y, over their largest entries.
    shapes: [Mat<T>; 2],
    /// Factor that restores the scale of the inverse.
    scale: f64,
    /// Free nodes along z.
    free: Range<usize>,
    /// For each mode along y, those of all modes along x.
    columns: Vec<Columns<T>>,
}

/// Factors `A = L D Lᵀ` of adjacent systems along z: for each node a row of `1/D` and one of each diagonal of L.
struct Columns<T> {
    inverse: Vec<T>,
    lower: Vec<Vec<T>>,
}

/// Ratio of the smallest to the largest number down to which single precision is used; residuals and their modes have a
/// separate range.
const SINGLE_RANGE: f64 = 1e-15;

/// Integrals over an axis of the squares of Legendre parts of degree l, of functions and of their derivatives.
struct Parts<T> {
    values: Vec<T>,
    slopes: Vec<T>,
}

/// Diagonals of a symmetric matrix: the main one and those below.
type Band = Vec<Vec<f64>>;

impl BrickInverse {
    pub fn new(
        mesh: &Mesh,
        laws: &[Thermoelastic],
        free: &[[Range<usize>; 3]; 3],
        team: &Team,
    ) -> Self {
        let layers: Vec<_> = laws
            .iter()
            .enumerate()
            .map(|(layer, law)| {
                let depth = bands(&mesh.axes[2], mesh.layer_elements(layer));
                (moduli(mesh.order(), law), 2.0 * law.shear_modulus(), depth)
            })
            .collect();
        let blocks = [0, 1, 2].map(|component| {
            let [x, y, z] = &free[component];
            let shapes = [eigenvectors(&mesh.axes[0], x), eigenvectors(&mesh.axes[1], y)];
            let lateral = [0, 1].map(|axis| rayleigh(&mesh.axes[axis], &shapes[axis]));
            let columns = team.map(shapes[1].ncols(), |q| {
                let terms: Vec<_> = layers
                    .iter()
                    .map(|(moduli, two_shear, depth)| {
                        (weights(component, &lateral, q, moduli, *two_shear), depth)
                    })
                    .collect();
                Columns::factor(&terms, z)
            });
            Block { shapes, scale: 1.0, free: z.clone(), columns }.normalized()
        });
        let blocks = match blocks.iter().all(Block::fits_single) {
            true => Blocks::Single(blocks.map(|block| block.in_single())),
            false => Blocks::Double(blocks),
        };
        Self { nodes: mesh.node_counts(), blocks }
    }

    /// Number of stored entries of all systems along z.
    pub fn entries(&self) -> usize {
        match &self.blocks {
            Blocks::Single(blocks) => blocks.iter().map(Block::entries).sum(),
            Blocks::Double(blocks) => blocks.iter().map(Block::entries).sum(),
        }
    }

    #[cfg(test)]
    pub fn is_single(&self) -> bool {
        matches!(self.blocks, Blocks::Single(_))
    }

    /// Computes `out ≈ K⁻¹ residual`, zero at held nodes.
    pub fn apply(&self, residual: &[f64], out: &mut [f64], team: &Team) {
        match &self.blocks {
            Blocks::Single(blocks) => apply(blocks, self.nodes, residual, out, team),
            Blocks::Double(blocks) => apply(blocks, self.nodes, residual, out, team),
        }
    }
}

fn apply<T: Real>(
    blocks: &[Block<T>; 3],
    nodes: [usize; 3],
    residual: &[f64],
    out: &mut [f64],
    team: &Team,
) where
    f64: AsPrimitive<T>,
{
    let component = residual.len() / 3;
    let parts = residual.chunks_exact(component).zip(out.chunks_exact_mut(component));
    for (block, (residual, out)) in blocks.iter().zip(parts) {
        block.apply(nodes, residual, out, team);
    }
}

/// Single or double precision.
trait Real: Float + AsPrimitive<f64> + Send + Sync {}

impl<T: Float + AsPrimitive<f64> + Send + Sync> Real for T {}

impl Block<f64> {
    /// Scales the numbers to about one.
    fn normalized(mut self) -> Self {
        if self.is_empty() {
            return self;
        }
        for shapes in &mut self.shapes {
            let largest = shapes.norm_max();
            *shapes *= faer::Scale(largest.recip());
            self.scale *= largest * largest;
        }
        let all = || self.columns.iter().flat_map(|columns| &columns.inverse);
        let largest = all().fold(0.0_f64, |largest, d| largest.max(*d));
        self.columns
            .iter_mut()
            .flat_map(|columns| &mut columns.inverse)
            .for_each(|d| *d /= largest);
        self.scale *= largest;
        self
    }

    /// Returns true if the numbers fit the range of single precision.
    fn fits_single(&self) -> bool {
        let is_in_range = |d: &f64| *d > SINGLE_RANGE && d.is_finite();
        self.columns.iter().all(|columns| columns.inverse.iter().all(is_in_range))
    }

    fn in_single(&self) -> Block<f32> {
        let single = |list: &Vec<f64>| list.iter().map(|&value| value as f32).collect();
        let columns = self.columns.iter().map(|Columns { inverse, lower }| Columns {
            inverse: single(inverse),
            lower: lower.iter().map(single).collect(),
        });
        Block {
            shapes: self.shapes.each_ref().map(|shapes| {
                Mat::from_fn(shapes.nrows(), shapes.ncols(), |i, j| shapes[(i, j)] as f32)
            }),
            scale: self.scale,
            free: self.free.clone(),
            columns: columns.collect(),
        }
    }
}

impl<T: Real> Block<T>
where
    f64: AsPrimitive<T>,
{
    /// Returns true if all nodes are held in this direction.
    fn is_empty(&self) -> bool {
        self.free.is_empty() || self.shapes.iter().any(|shapes| shapes.ncols() == 0)
    }

    fn entries(&self) -> usize {
        let of = |columns: &Columns<T>| (1 + columns.lower.len()) * columns.inverse.len();
        self.columns.iter().map(of).sum()
    }

    fn apply(&self, [nx, ny, _]: [usize; 3], residual: &[f64], out: &mut [f64], team: &Team) {
        if self.is_empty() {
            out.fill(0.0);
            return;
        }
        let [x, y] = self.shapes.each_ref().map(Mat::as_ref);
        let (mx, my) = (x.ncols(), y.ncols());
        // Planes of modes: those of one mode along y are together in each of them.
        let planes = self.free.clone();
        let mut modes = vec![T::zero(); mx * my * planes.len()];
        let mut slabs: Vec<_> = modes
            .chunks_exact_mut(mx * my)
            .zip(residual.chunks_exact(nx * ny).skip(planes.start))
            .collect();
        team.for_pieces(&mut slabs, |_, slabs| {
            let (mut nodes, mut along_x) = (vec![T::zero(); nx * ny], vec![T::zero(); mx * ny]);
            for (modes, residual) in slabs {
                nodes.iter_mut().zip(*residual).for_each(|(node, value)| *node = value.as_());
                let nodes = MatRef::from_column_major_slice(&nodes, nx, ny);
                product(&mut along_x, x.transpose(), nodes);
                product(modes, MatRef::from_column_major_slice(&along_x, mx, ny), y);
            }
        });
        let mut rows: Vec<Vec<&mut [T]>> = (0..my).map(|_| Vec::new()).collect();
        for plane in modes.chunks_exact_mut(mx * my) {
            rows.iter_mut().zip(plane.chunks_exact_mut(mx)).for_each(|(row, part)| row.push(part));
        }
        team.for_each(&mut rows, |q, rows| self.columns[q].solve_in_place(rows));
        drop(rows);
        out[..planes.start * nx * ny].fill(0.0);
        out[planes.end * nx * ny..].fill(0.0);
        let mut slabs: Vec<_> = modes
            .chunks_exact(mx * my)
            .zip(out.chunks_exact_mut(nx * ny).skip(planes.start))
            .collect();
        team.for_pieces(&mut slabs, |_, slabs| {
            let (mut nodes, mut along_x) = (vec![T::zero(); nx * ny], vec![T::zero(); nx * my]);
            for (modes, out) in slabs {
                product(&mut along_x, x, MatRef::from_column_major_slice(modes, mx, my));
                let half = MatRef::from_column_major_slice(&along_x, nx, my);
                product(&mut nodes, half, y.transpose());
                out.iter_mut().zip(&nodes).for_each(|(out, node)| *out = self.scale * node.as_());
            }
        });
    }
}

impl Columns<f64> {
    /// Factors `Σ_t w_t A_t` between the free nodes, for weights of every mode along x, of all layers.
    fn factor(layers: &[(Parts<Vec<f64>>, &Parts<Band>)], free: &Range<usize>) -> Self {
        let pairs = || {
            layers.iter().flat_map(|(weights, depth)| {
                let values = weights.values.iter().zip(&depth.values);
                values.chain(weights.slopes.iter().zip(&depth.slopes))
            })
        };
        let (weights, depth) = &layers[0];
        let (modes, reach) = (weights.values[0].len(), depth.values[0].len() - 1);
        // Row of a node and one `below` nodes before it.
        let entry = |node: usize, below: usize| {
            let mut row = vec![0.0; modes];
            for (weights, band) in pairs() {
                let value = band[below][node - below];
                row.iter_mut().zip(weights).for_each(|(entry, weight)| *entry += weight * value);
            }
            row
        };
        let mut factor = Self { inverse: Vec::new(), lower: vec![Vec::new(); reach] };
        let Self { inverse, lower } = &mut factor;
        for (n, node) in free.clone().enumerate() {
            // `L_{n,n−j} D_{n−j}` for j = 1, 2 …, the farthest first.
            let mut scaled: Vec<Vec<f64>> = (1..=reach.min(n)).map(|j| entry(node, j)).collect();
            for j in (0..scaled.len()).rev() {
                let (near, far) = scaled.split_at_mut(j + 1);
                for (far, lower) in far.iter().zip(&*lower) {
                    subtract_product(&mut near[j], far, &lower[(n - j - 1) * modes..]);
                }
            }
            let mut main = entry(node, 0);
            for (j, lower) in lower.iter_mut().enumerate() {
                let Some(scaled) = scaled.get(j) else {
                    lower.extend(vec![0.0; modes]);
                    continue;
                };
                let before = &inverse[(n - j - 1) * modes..][..modes];
                let row: Vec<f64> =
                    scaled.iter().zip(before).map(|(s, inverse)| s * inverse).collect();
                subtract_product(&mut main, scaled, &row);
                lower.extend(row);
            }
            inverse.extend(main.iter().map(|d| d.recip()));
        }
        factor
    }
}

impl<T: Float> Columns<T> {
    /// Replaces the values of each node, in ascending order, by the solution.
    fn solve_in_place(&self, rows: &mut [&mut [T]]) {
        let modes = rows.first().map_or(0, |row| row.len());
        for n in 0..rows.len() {
            let (before, rest) = rows.split_at_mut(n);
            for (j, lower) in self.lower.iter().enumerate().take_while(|(j, _)| *j < n) {
                subtract_product(rest[0], before[n - j - 1], &lower[n * modes..]);
            }
        }
        for n in (0..rows.len()).rev() {
            let (rest, after) = rows.split_at_mut(n + 1);
            let inverse = &self.inverse[n * modes..][..modes];
            rest[n].iter_mut().zip(inverse).for_each(|(x, inverse)| *x = *x * *inverse);
            for (j, lower) in self.lower.iter().enumerate().take_while(|(j, _)| *j < after.len()) {
                subtract_product(rest[n], after[j], &lower[(n + j + 1) * modes..]);
            }
        }
    }
}

/// `target −= a b`, entry by entry.
fn subtract_product<T: Float>(target: &mut [T], a: &[T], b: &[T]) {
    target.iter_mut().zip(a).zip(b).for_each(|((t, a), b)| *t = *t - *a * *b);
}

fn eigenvectors(axis: &Axis, free: &Range<usize>) -> Mat<f64> {
    let end = |held: bool| match held {
        true => EndCondition::Prescribed,
        false => EndCondition::Natural,
    };
    AxisModes::of(axis, [end(free.start > 0), end(free.end < axis.len())]).shapes
}

/// Weight of each matrix along z for modes p, all together, and q.
fn weights(
    component: usize,
    [along_x, along_y]: &[Parts<Vec<f64>>; 2],
    q: usize,
    moduli: &[PolynomialModuli],
    two_shear: f64,
) -> Parts<Vec<f64>> {
    let modes = along_x.values[0].len();
    let zeros = || vec![vec![0.0; modes]; along_x.values.len()];
    let mut weights = Parts { values: zeros(), slopes: zeros() };
    for PolynomialModuli { degrees: [lx, ly, lz], lame, shear, .. } in moduli {
        for axis in 0..3 {
            let modulus = match axis == component {
                true => two_shear + lame,
                false => shear[strain_of(component, axis) - 3],
            };
            let x = if axis == 0 { &along_x.slopes[*lx] } else { &along_x.values[*lx] };
            let y = if axis == 1 { &along_y.slopes[*ly] } else { &along_y.values[*ly] };
            let z = if axis == 2 { &mut weights.slopes[*lz] } else { &mut weights.values[*lz] };
            z.iter_mut().zip(x).for_each(|(weight, x)| *weight += modulus * x * y[q]);
        }
    }
    weights
}

/// Coefficients of each element's shape functions, scaled so that their squares are integrals: `of(l, a)` for functions
/// and for derivatives.
fn element_parts(order: usize, [a, b]: [f64; 2]) -> Parts<[f64; 3]> {
    let matrix = legendre(order);
    let root = |l: usize| ((b - a) / (2 * l + 1) as f64).sqrt();
    let value = |l: usize| matrix[l].map(|weight| weight * root(l));
    let slope = |l: usize| match l < order {
        true => matrix[l + 1].map(|weight| weight * root(l) * 2.0 * (2 * l + 1) as f64 / (b - a)),
        false => [0.0; 3],
    };
    Parts { values: (0..=order).map(value).collect(), slopes: (0..=order).map(slope).collect() }
}

/// Returns the integrals of each mode of an axis.
fn rayleigh(axis: &Axis, shapes: &Mat<f64>) -> Parts<Vec<f64>> {
    let zeros = || vec![vec![0.0; shapes.ncols()]; axis.order + 1];
    let mut sums = Parts { values: zeros(), slopes: zeros() };
    for element in 0..axis.elements() {
        let parts = element_parts(axis.order, axis.bounds(element));
        let add = |sums: &mut Vec<Vec<f64>>, parts: &[[f64; 3]]| {
            for (sums, part) in sums.iter_mut().zip(parts) {
                for (mode, sum) in sums.iter_mut().enumerate() {
                    let node = |i: usize| shapes[(element * axis.order + i, mode)];
                    *sum += (0..=axis.order).map(|i| part[i] * node(i)).sum::<f64>().powi(2);
                }
            }
        };
        add(&mut sums.values, &parts.values);
        add(&mut sums.slopes, &parts.slopes);
    }
    sums
}

/// Returns the integrals between nodes of an axis over some of its elements.
fn bands(axis: &Axis, elements: Range<usize>) -> Parts<Band> {
    let zeros = || vec![vec![vec![0.0; axis.len()]; axis.order + 1]; axis.order + 1];
    let mut sums = Parts { values: zeros(), slopes: zeros() };
    for element in elements {
        let parts = element_parts(axis.order, axis.bounds(element));
        let add = |sums: &mut Vec<Band>, parts: &[[f64; 3]]| {
            for (band, part) in sums.iter_mut().zip(parts) {
                for i in 0..=axis.order {
                    for j in 0..=i {
                        band[i - j][element * axis.order + j] += part[i] * part[j];
                    }
                }
            }
        };
        add(&mut sums.values, &parts.values);
        add(&mut sums.slopes, &parts.slopes);
    }
    sums
}
