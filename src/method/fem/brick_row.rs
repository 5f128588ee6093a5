//! Forces of a row of bricks along x from nodal values.
//!
//! Coefficients of Legendre polynomials are stored in vectors of [`WIDTH`] elements. Padding elements beyond the last
//! one have neither length nor volume, so they contribute no forces.

use super::brick_polynomials::{PolynomialModuli, legendre, slope_factor};
use crate::math::eight::Eight;

/// Number of elements processed at once.
const WIDTH: usize = 8;

/// One value for each of these elements.
type Lanes = [f64; WIDTH];

/// The elements of every row of a box.
pub struct RowLengths {
    /// `1/h` along x [1/m].
    inverse: Vec<Lanes>,
    /// Length along x [m].
    length: Vec<Lanes>,
}

impl RowLengths {
    pub fn new(lengths: &[f64]) -> Self {
        let lanes = |of: fn(f64) -> f64| {
            let mut all = vec![[0.0; WIDTH]; lengths.len().div_ceil(WIDTH)];
            all.as_flattened_mut().iter_mut().zip(lengths).for_each(|(lane, &h)| *lane = of(h));
            all
        };
        Self { inverse: lanes(f64::recip), length: lanes(|h| h) }
    }

    /// Length of the nodal values of one kind, corners or middles, along the row.
    pub fn strand(&self) -> usize {
        (self.length.len() + 1) * WIDTH
    }
}

/// Coefficients of the elements of a row and the forces on them: of component c and the product of polynomials of
/// degrees i, j and k at `i + N (j + N (k + N c))`; `N` nodes along an edge.
pub struct Row {
    coefficients: Vec<Lanes>,
    forces: Vec<Lanes>,
}

/// Data common to all elements of a row.
#[derive(Clone, Copy)]
pub struct RowPlace<'a> {
    pub lengths: &'a RowLengths,
    /// Lengths along y and z [m].
    pub across: [f64; 2],
    pub moduli: &'a [PolynomialModuli],
    /// `2µ` [Pa]
    pub two_shear: f64,
}

impl Row {
    pub fn new(lengths: &RowLengths, order: usize) -> Self {
        let n = order + 1;
        let zeros = || vec![[0.0; WIDTH]; 3 * n * n * n * lengths.length.len()];
        Self { coefficients: zeros(), forces: zeros() }
    }

    /// Coefficients from values that are polynomials along y and z and stand at nodes along x: those of corners first,
    /// then those of middles. Every list has the length of a strand.
    #[inline(always)]
    pub fn read<E: Eight, const N: usize>(&mut self, lengths: &RowLengths, nodes: &[f64]) {
        let (strand, blocks) = (lengths.strand(), lengths.length.len());
        let matrix = legendre(N - 1);
        let nodes = nodes.chunks_exact((N - 1) * strand);
        for (nodes, out) in nodes.zip(self.coefficients.chunks_exact_mut(N * blocks)) {
            for b in 0..blocks {
                let mut values = [E::splat(0.0); N];
                for (a, value) in values.iter_mut().enumerate() {
                    *value = E::load(lanes(nodes, at::<N>(a, b, strand)));
                }
                for (l, weights) in matrix.iter().enumerate().take(N) {
                    let mut sum = E::splat(weights[0]) * values[0];
                    for (weight, value) in weights.iter().zip(&values).skip(1) {
                        sum = sum + E::splat(*weight) * *value;
                    }
                    sum.store(&mut out[l * blocks + b]);
                }
            }
        }
    }

    /// The adjoint of [`Self::read`]: forces on nodes from those on the coefficients.
    #[inline(always)]
    pub fn write<E: Eight, const N: usize>(&self, lengths: &RowLengths, nodes: &mut [f64]) {
        let (strand, blocks) = (lengths.strand(), lengths.length.len());
        let matrix = legendre(N - 1);
        nodes.fill(0.0);
        let nodes = nodes.chunks_exact_mut((N - 1) * strand);
        for (nodes, forces) in nodes.zip(self.forces.chunks_exact(N * blocks)) {
            for b in 0..blocks {
                let mut values = [E::splat(0.0); N];
                for (l, value) in values.iter_mut().enumerate() {
                    *value = E::load(&forces[l * blocks + b]);
                }
                for a in 0..N {
                    let nodes = lanes_mut(nodes, at::<N>(a, b, strand));
                    let mut sum = E::load(nodes);
                    for (weights, value) in matrix.iter().zip(&values) {
                        sum = sum + E::splat(weights[a]) * *value;
                    }
                    sum.store(nodes);
                }
            }
        }
    }

    /// Computes the forces of displacements.
    #[inline(always)]
    pub fn stress<E: Eight, const N: usize>(&mut self, place: RowPlace) {
        let RowPlace { lengths, across, moduli, two_shear } = place;
        let blocks = lengths.length.len();
        let two_shear = E::splat(two_shear);
        self.forces.fill([0.0; WIDTH]);
        for moduli in moduli {
            let slopes = Slopes::<N>::new(moduli.degrees, across);
            let norm = E::splat(moduli.norm * across[0] * across[1]);
            let lame = E::splat(moduli.lame);
            let [shear_xy, shear_yz, shear_xz] = moduli.shear;
            for b in 0..blocks {
                let inverse = E::load(&lengths.inverse[b]);
                let [[xx, yx, zx], [xy, yy, zy], [xz, yz, zz]] =
                    slopes.gradient(&self.coefficients, (blocks, b), inverse);
                let volume = norm * E::load(&lengths.length[b]);
                let pressure = lame * (xx + yy + zz);
                let normal = [
                    volume * (two_shear * xx + pressure),
                    volume * (two_shear * yy + pressure),
                    volume * (two_shear * zz + pressure),
                ];
                let shears = [
                    volume * E::splat(shear_xy) * (xy + yx),
                    volume * E::splat(shear_yz) * (yz + zy),
                    volume * E::splat(shear_xz) * (xz + zx),
                ];
                slopes.deposit(&mut self.forces, (blocks, b), inverse, (normal, shears));
            }
        }
    }

    /// Computes the thermal forces at constant strain; temperature is the only component.
    #[inline(always)]
    pub fn thermal_stress<E: Eight, const N: usize>(&mut self, place: RowPlace) {
        let RowPlace { lengths, across, moduli, .. } = place;
        let blocks = lengths.length.len();
        self.forces.fill([0.0; WIDTH]);
        for moduli in moduli {
            let slopes = Slopes::<N>::new(moduli.degrees, across);
            let weight = E::splat(moduli.norm * moduli.thermal * across[0] * across[1]);
            let row = index::<N>(moduli.degrees);
            for b in 0..blocks {
                let temperature = E::load(&self.coefficients[row * blocks + b]);
                let stress = weight * E::load(&lengths.length[b]) * temperature;
                let inverse = E::load(&lengths.inverse[b]);
                let stress = ([stress; 3], [E::splat(0.0); 3]);
                slopes.deposit(&mut self.forces, (blocks, b), inverse, stress);
            }
        }
    }
}

/// Position of the values of a node of the first element of a block: corners come before middles.
const fn at<const N: usize>(node: usize, block: usize, strand: usize) -> usize {
    node % (N - 1) * strand + node / (N - 1) + block * WIDTH
}

#[inline(always)]
fn lanes(list: &[f64], first: usize) -> &Lanes {
    list[first..].first_chunk().expect("strands are longer than their rows")
}

#[inline(always)]
fn lanes_mut(list: &mut [f64], first: usize) -> &mut Lanes {
    list[first..].first_chunk_mut().expect("strands are longer than their rows")
}

/// Row of a product of polynomials.
const fn index<const N: usize>([x, y, z]: [usize; 3]) -> usize {
    x + N * (y + N * z)
}

/// Coefficients whose derivatives have the degrees of a product of polynomials.
struct Slopes<const N: usize> {
    /// Along x, y and z; `None` where the degree is the highest.
    along: [Option<Along<N>>; 3],
}

/// Coefficients along an axis.
struct Along<const N: usize> {
    /// Row of the first component.
    row: usize,
    /// `2 (2 l + 1)`, along y and z over the length.
    factor: f64,
}

impl<const N: usize> Along<N> {
    /// Position of a component of a block of elements.
    const fn place(&self, (blocks, block): (usize, usize), component: usize) -> usize {
        (self.row + N * N * N * component) * blocks + block
    }

    #[inline(always)]
    fn slope<E: Eight>(&self, axis: usize, inverse: E) -> E {
        let factor = E::splat(self.factor);
        if axis == 0 { factor * inverse } else { factor }
    }
}

impl<const N: usize> Slopes<N> {
    fn new(degrees: [usize; 3], across: [f64; 2]) -> Self {
        let along = [0, 1, 2].map(|axis| {
            let mut from = degrees;
            from[axis] += 1;
            let length = if axis == 0 { 1.0 } else { across[axis - 1] };
            let factor = slope_factor(degrees, axis) / length;
            (from[axis] < N).then(|| Along { row: index::<N>(from), factor })
        });
        Self { along }
    }

    /// Derivatives of all components along x, those along y, those along z.
    #[inline(always)]
    fn gradient<E: Eight>(
        &self,
        coefficients: &[Lanes],
        block: (usize, usize),
        inverse: E,
    ) -> [[E; 3]; 3] {
        let mut gradient = [[E::splat(0.0); 3]; 3];
        for (axis, gradient) in gradient.iter_mut().enumerate() {
            if let Some(along) = &self.along[axis] {
                let slope = along.slope(axis, inverse);
                for (component, derivative) in gradient.iter_mut().enumerate() {
                    let place = along.place(block, component);
                    *derivative = slope * E::load(&coefficients[place]);
                }
            }
        }
        gradient
    }

    /// Adds the forces of stresses times volume: xx, yy, zz and xy, yz, xz.
    #[inline(always)]
    fn deposit<E: Eight>(
        &self,
        forces: &mut [Lanes],
        block: (usize, usize),
        inverse: E,
        ([xx, yy, zz], [xy, yz, xz]): ([E; 3], [E; 3]),
    ) {
        let stresses = [[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]];
        for (axis, stresses) in stresses.iter().enumerate() {
            if let Some(along) = &self.along[axis] {
                let slope = along.slope(axis, inverse);
                for (component, stress) in stresses.iter().enumerate() {
                    let force = &mut forces[along.place(block, component)];
                    (E::load(force) + slope * *stress).store(force);
                }
            }
        }
    }
}
