//! Stiffness of all bricks of a box at once, without a matrix.
//!
//! In every element, displacements are sums of products of Legendre polynomials along the edges, and so are strains;
//! as the polynomials are orthogonal, the energy is a sum over them, each with its own moduli:
//!
//! `E = ½ V Σ_l n_l [2µ Σ_i ε_ii² + λ_l (Σ_i ε_ii)² + Σ_{i<j} µ_l,ij γ_ij²]`, `n_l = Π 1/(2 l_k + 1)`.
//!
//! - Quadratic bricks project their dilatation on linear polynomials (see [`super::dilatation`]): λ_l = λ up to degree 1,
//!   0 beyond.
//! - Linear bricks have enhanced strains (see [`super::hexahedron`]) that are free to relieve the stresses of
//!   their own polynomials: a normal strain along i where l_i = 1, the shear ij for l = e_i and l = e_j. What is left
//!   are plane and uniaxial stress, and no energy of those shears.
//!
//! So an element costs a few hundred operations and nothing is stored.

use std::ops::Range;

use crate::material::Thermoelastic;
use crate::math::parallel::Team;
use crate::method::mesh::Layering;
use crate::method::mesh::Mesh;

/// Moduli of one product of Legendre polynomials.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PolynomialModuli {
    /// Degrees along x, y, z.
    pub degrees: [usize; 3],
    /// `n_l`
    pub norm: f64,
    /// λ_l [Pa]
    pub lame: f64,
    /// µ_l of the shears xy, yz, xz [Pa].
    pub shear: [f64; 3],
    /// Normal stress that holds back a degree of heating [Pa/K].
    pub thermal: f64,
}

/// The two axes of a shear strain xy, yz, xz.
const SHEARS: [[usize; 2]; 3] = [[0, 1], [1, 2], [0, 2]];

/// Moduli of all products of Legendre polynomials of an element, x fastest.
pub fn moduli(order: usize, law: &Thermoelastic) -> Vec<PolynomialModuli> {
    let (lame, shear) = (law.lame_first(), law.shear_modulus());
    let n = order + 1;
    let of = |index: usize| {
        let degrees = [index % n, index / n % n, index / (n * n)];
        let total: usize = degrees.iter().sum();
        let linear = order == 1;
        let lame = match (linear, total) {
            (_, 0) | (false, 1) => lame,
            (true, 1) => 2.0 * lame * shear / (lame + 2.0 * shear),
            (true, 2) => law.young - 2.0 * shear,
            _ => 0.0,
        };
        let relieved = |[i, j]: [usize; 2]| linear && total == 1 && degrees[i] + degrees[j] == 1;
        PolynomialModuli {
            degrees,
            norm: degrees.iter().map(|&l| 1.0 / (2 * l + 1) as f64).product(),
            lame,
            shear: SHEARS.map(|pair| if relieved(pair) { 0.0 } else { shear }),
            // Of linear bricks, those along axes whose strains are free are relieved.
            thermal: law.expansion
                * (2.0 * shear + lame * if linear { 3.0 - total as f64 } else { 3.0 }),
        }
    };
    (0..n * n * n).map(of).collect()
}

/// Legendre coefficients of a function from its values at the nodes of an element, by rows.
pub fn legendre(order: usize) -> [[f64; 3]; 3] {
    match order {
        1 => [[0.5, 0.5, 0.0], [-0.5, 0.5, 0.0], [0.0; 3]],
        _ => [
            [1.0 / 6.0, 4.0 / 6.0, 1.0 / 6.0],
            [-0.5, 0.0, 0.5],
            [1.0 / 3.0, -2.0 / 3.0, 1.0 / 3.0],
        ],
    }
}

/// What acts on the nodes: the stress of strains or of temperatures.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Cause {
    Displacement,
    Temperature,
}

/// The stiffness of a box. Vectors have all displacements along x, then along y, then along z, the x index of nodes
/// fastest.
pub struct BrickStiffness {
    order: usize,
    /// Lengths of elements along each axis [m].
    lengths: [Vec<f64>; 3],
    layering: Layering,
    /// Moduli and 2µ of each layer, from the lowest on.
    moduli: Vec<(Vec<PolynomialModuli>, f64)>,
    /// Nodes along each axis that are solved for, of each component.
    free: [[Range<usize>; 3]; 3],
}

/// Room for what one row of elements along x comes to.
struct Scratch {
    /// Legendre coefficients along y and z of each component, at the nodes along x: `n² · 3` rows.
    planes: Vec<f64>,
    /// Coefficients along all axes, `n³ · 3` rows of elements, and the forces on them.
    coefficients: Vec<f64>,
    forces: Vec<f64>,
    /// Six strains, then stresses.
    strains: [Vec<f64>; 6],
    volumes: Vec<f64>,
}

impl BrickStiffness {
    /// `laws` of the layers, from the lowest on.
    pub fn new(mesh: &Mesh, laws: &[Thermoelastic], free: [[Range<usize>; 3]; 3]) -> Self {
        let lengths = mesh.axes.each_ref().map(|axis| {
            let length = |e| {
                let [a, b] = axis.bounds(e);
                b - a
            };
            (0..axis.elements()).map(length).collect()
        });
        let order = mesh.order();
        let moduli = laws.iter().map(|law| (moduli(order, law), 2.0 * law.shear_modulus()));
        Self { order, lengths, layering: mesh.layering.clone(), moduli: moduli.collect(), free }
    }

    fn nodes(&self) -> [usize; 3] {
        self.lengths.each_ref().map(|lengths| lengths.len() * self.order + 1)
    }

    /// `out = K x`, zero where nothing is solved for.
    pub fn apply(&self, x: &[f64], out: &mut [f64], team: &Team) {
        self.add_forces(Cause::Displacement, x, out, team);
        self.hold(out, team);
    }

    /// Nodal forces of heated material that is held back, from temperatures above that without stress [K], on
    /// interfaces those of both layers; zero where nothing is solved for.
    pub fn thermal_forces(&self, temperature: &[f64], out: &mut [f64], team: &Team) {
        self.add_forces(Cause::Temperature, temperature, out, team);
        self.hold(out, team);
    }

    fn add_forces(&self, cause: Cause, x: &[f64], out: &mut [f64], team: &Team) {
        out.fill(0.0);
        let [columns, rows, _] = self.nodes();
        let plane = columns * rows;
        // Layers of elements that share no nodes: first those of even, then those of odd number.
        for colour in 0..2 {
            let mut layers = self.layers(out, plane, colour);
            team.for_pieces(&mut layers, |_, layers| {
                let mut scratch = Scratch::new(self.order, columns, self.lengths[0].len());
                for (layer, out) in layers {
                    self.add_layer(cause, *layer, x, out, &mut scratch);
                }
            });
        }
    }

    /// The planes of nodes of every second layer of elements, of each component.
    fn layers<'a>(
        &self,
        out: &'a mut [f64],
        plane: usize,
        colour: usize,
    ) -> Vec<(usize, [&'a mut [f64]; 3])> {
        let height = self.order * plane;
        let component = out.len() / 3;
        let mut parts = out.chunks_exact_mut(component);
        let mut parts = [0, 1, 2].map(|_| {
            let part = parts.next().expect("there are three");
            part[colour * height..].chunks_mut(2 * height)
        });
        let mut layers = Vec::new();
        for layer in (colour..self.lengths[2].len()).step_by(2) {
            layers.push((layer, parts.each_mut().map(|part| part.next().expect("one a layer"))));
        }
        layers
    }

    fn add_layer(
        &self,
        cause: Cause,
        layer: usize,
        x: &[f64],
        out: &mut [&mut [f64]; 3],
        scratch: &mut Scratch,
    ) {
        #[cfg(target_arch = "x86_64")]
        {
            if is_x86_feature_detected!("avx512f") {
                // SAFETY: the processor has what the function asks for.
                return unsafe { self.layer_avx512(cause, layer, x, out, scratch) };
            }
            if is_x86_feature_detected!("avx2") {
                // SAFETY: the processor has what the function asks for.
                return unsafe { self.layer_avx2(cause, layer, x, out, scratch) };
            }
        }
        self.layer(cause, layer, x, out, scratch);
    }

    #[cfg(target_arch = "x86_64")]
    #[target_feature(enable = "avx512f")]
    fn layer_avx512(
        &self,
        cause: Cause,
        layer: usize,
        x: &[f64],
        out: &mut [&mut [f64]; 3],
        scratch: &mut Scratch,
    ) {
        self.layer(cause, layer, x, out, scratch);
    }

    #[cfg(target_arch = "x86_64")]
    #[target_feature(enable = "avx2")]
    fn layer_avx2(
        &self,
        cause: Cause,
        layer: usize,
        x: &[f64],
        out: &mut [&mut [f64]; 3],
        scratch: &mut Scratch,
    ) {
        self.layer(cause, layer, x, out, scratch);
    }

    #[inline(always)]
    fn layer(
        &self,
        cause: Cause,
        layer: usize,
        x: &[f64],
        out: &mut [&mut [f64]; 3],
        scratch: &mut Scratch,
    ) {
        for row in 0..self.lengths[1].len() {
            match self.order {
                1 => self.row::<2>(cause, [row, layer], x, out, scratch),
                _ => self.row::<3>(cause, [row, layer], x, out, scratch),
            }
        }
    }

    /// Adds the forces of a row of elements along x; `N` nodes along an edge.
    #[inline(always)]
    fn row<const N: usize>(
        &self,
        cause: Cause,
        [row, layer]: [usize; 2],
        x: &[f64],
        out: &mut [&mut [f64]; 3],
        scratch: &mut Scratch,
    ) {
        let [columns, rows, _] = self.nodes();
        let (component, plane) = (self.nodes().iter().product::<usize>(), columns * rows);
        let below = self.layering.layer_of(layer);
        // Of temperatures, nodes on interfaces are there twice.
        let (components, doubled) = match cause {
            Cause::Displacement => (3, 0),
            Cause::Temperature => (1, below),
        };
        let matrix = legendre(N - 1);
        let Scratch { planes, coefficients, forces, strains, volumes } = scratch;
        for (c, planes) in planes.chunks_exact_mut(N * N * columns).enumerate().take(components) {
            planes.fill(0.0);
            for d in 0..N {
                for b in 0..N {
                    let from = c * component
                        + (layer * (N - 1) + d + doubled) * plane
                        + (row * (N - 1) + b) * columns;
                    let nodes = &x[from..from + columns];
                    for lz in 0..N {
                        for ly in 0..N {
                            let weight = matrix[ly][b] * matrix[lz][d];
                            let target = &mut planes[(ly + N * lz) * columns..][..columns];
                            add(target, weight, nodes);
                        }
                    }
                }
            }
        }
        let elements = self.lengths[0].len();
        let given = planes.chunks_exact(columns).take(components * N * N);
        for (plane, coefficients) in given.zip(coefficients.chunks_exact_mut(N * elements)) {
            to_elements::<N>(plane, coefficients, &matrix);
        }
        let across = [self.lengths[1][row], self.lengths[2][layer]];
        for (volume, length) in volumes.iter_mut().zip(&self.lengths[0]) {
            *volume = length * across[0] * across[1];
        }
        forces.fill(0.0);
        let (moduli, two_shear) = &self.moduli[below];
        for moduli in moduli {
            match cause {
                Cause::Displacement => {
                    self.stresses::<N>(
                        (moduli, *two_shear),
                        coefficients,
                        across,
                        strains,
                        volumes,
                    );
                }
                Cause::Temperature => {
                    thermal_stresses::<N>(moduli, coefficients, strains, volumes);
                }
            }
            deposit::<N>(moduli, forces, &self.lengths[0], across, strains);
        }
        for (plane, forces) in
            planes.chunks_exact_mut(columns).zip(forces.chunks_exact(N * elements))
        {
            to_nodes::<N>(forces, plane, &matrix);
        }
        for (c, planes) in planes.chunks_exact(N * N * columns).enumerate() {
            for d in 0..N {
                for b in 0..N {
                    let target =
                        &mut out[c][d * plane + (row * (N - 1) + b) * columns..][..columns];
                    for lz in 0..N {
                        for ly in 0..N {
                            let weight = matrix[ly][b] * matrix[lz][d];
                            add(target, weight, &planes[(ly + N * lz) * columns..][..columns]);
                        }
                    }
                }
            }
        }
    }

    /// Stresses times volume of one product of polynomials: xx, yy, zz, xy, yz, xz.
    #[inline(always)]
    fn stresses<const N: usize>(
        &self,
        (moduli, two_shear): (&PolynomialModuli, f64),
        coefficients: &[f64],
        across: [f64; 2],
        strains: &mut [Vec<f64>; 6],
        volumes: &[f64],
    ) {
        let lengths = &self.lengths[0];
        for strain in strains.iter_mut() {
            strain.fill(0.0);
        }
        for component in 0..3 {
            for axis in 0..3 {
                let Some(place) = derived::<N>(moduli.degrees, component, axis) else { continue };
                let source = &coefficients[place * lengths.len()..][..lengths.len()];
                let target = &mut strains[strain_of(component, axis)];
                slope(target, source, factor(moduli.degrees, axis), axis, lengths, across);
            }
        }
        let [xx, yy, zz, shears @ ..] = strains;
        let (lame, norm) = (moduli.lame, moduli.norm);
        for (((xx, yy), zz), volume) in xx.iter_mut().zip(yy).zip(zz).zip(volumes) {
            let pressure = lame * (*xx + *yy + *zz);
            let weight = norm * volume;
            *xx = weight * (two_shear * *xx + pressure);
            *yy = weight * (two_shear * *yy + pressure);
            *zz = weight * (two_shear * *zz + pressure);
        }
        for (shear, modulus) in shears.iter_mut().zip(moduli.shear) {
            for (strain, volume) in shear.iter_mut().zip(volumes) {
                *strain *= modulus * norm * volume;
            }
        }
    }

    /// Sets what is not solved for to zero.
    pub fn hold(&self, out: &mut [f64], team: &Team) {
        let [columns, rows, layers] = self.nodes();
        let mut planes: Vec<&mut [f64]> = out.chunks_exact_mut(columns * rows).collect();
        team.for_each(&mut planes, |n, plane| {
            let [x, y, z] = &self.free[n / layers];
            if !z.contains(&(n % layers)) {
                return plane.fill(0.0);
            }
            for (j, row) in plane.chunks_exact_mut(columns).enumerate() {
                match y.contains(&j) {
                    true => {
                        row[..x.start].fill(0.0);
                        row[x.end..].fill(0.0);
                    }
                    false => row.fill(0.0),
                }
            }
        });
    }
}

impl Scratch {
    fn new(order: usize, columns: usize, elements: usize) -> Self {
        let n = order + 1;
        let zeros = |rows: usize, length: usize| vec![0.0; rows * length];
        Self {
            planes: zeros(3 * n * n, columns),
            coefficients: zeros(3 * n * n * n, elements),
            forces: zeros(3 * n * n * n, elements),
            strains: [(); 6].map(|()| zeros(1, elements)),
            volumes: zeros(1, elements),
        }
    }
}

/// Stresses times volume that hold back the expansion of one product of polynomials.
#[inline(always)]
fn thermal_stresses<const N: usize>(
    moduli: &PolynomialModuli,
    coefficients: &[f64],
    stresses: &mut [Vec<f64>; 6],
    volumes: &[f64],
) {
    let [x, y, z] = moduli.degrees;
    let temperatures = &coefficients[(x + N * (y + N * z)) * volumes.len()..][..volumes.len()];
    let weight = moduli.norm * moduli.thermal;
    for (component, stresses) in stresses.iter_mut().enumerate() {
        // It is the same in all directions, without shear.
        let weight = if component < 3 { weight } else { 0.0 };
        for ((stress, temperature), volume) in stresses.iter_mut().zip(temperatures).zip(volumes) {
            *stress = weight * volume * temperature;
        }
    }
}

/// Index of a component of a symmetric tensor: xx, yy, zz, xy, yz, xz.
pub fn strain_of(i: usize, j: usize) -> usize {
    if i == j { i } else { [0, 3, 5, 4][i + j] }
}

/// Row of the coefficients of a component whose derivative along an axis has these degrees.
#[inline(always)]
fn derived<const N: usize>(degrees: [usize; 3], component: usize, axis: usize) -> Option<usize> {
    let mut from = degrees;
    from[axis] += 1;
    let [x, y, z] = from;
    (from[axis] < N).then(|| x + N * (y + N * (z + N * component)))
}

/// `d/dξ` of `P_{l+1}` has the part `2l + 1` of `P_l`; that along an edge of length h is `2/h` times as large.
fn factor(degrees: [usize; 3], axis: usize) -> f64 {
    2.0 * (2 * degrees[axis] + 1) as f64
}

/// `target += factor/h source`.
#[inline(always)]
fn slope(
    target: &mut [f64],
    source: &[f64],
    factor: f64,
    axis: usize,
    lengths: &[f64],
    across: [f64; 2],
) {
    if axis == 0 {
        for ((t, s), length) in target.iter_mut().zip(source).zip(lengths) {
            *t += factor / length * s;
        }
    } else {
        add(target, factor / across[axis - 1], source);
    }
}

/// Adds the forces that stresses put on the coefficients.
#[inline(always)]
fn deposit<const N: usize>(
    moduli: &PolynomialModuli,
    forces: &mut [f64],
    lengths: &[f64],
    across: [f64; 2],
    stresses: &[Vec<f64>; 6],
) {
    for component in 0..3 {
        for axis in 0..3 {
            let Some(place) = derived::<N>(moduli.degrees, component, axis) else { continue };
            let target = &mut forces[place * lengths.len()..][..lengths.len()];
            let stress = &stresses[strain_of(component, axis)];
            slope(target, stress, factor(moduli.degrees, axis), axis, lengths, across);
        }
    }
}

/// `target += weight source`.
#[inline(always)]
fn add(target: &mut [f64], weight: f64, source: &[f64]) {
    if weight != 0.0 {
        target.iter_mut().zip(source).for_each(|(t, s)| *t += weight * s);
    }
}

/// Legendre coefficients along x of every element, degree after degree.
#[inline(always)]
fn to_elements<const N: usize>(nodes: &[f64], out: &mut [f64], matrix: &[[f64; 3]; 3]) {
    let elements = out.len() / N;
    for (row, out) in matrix.iter().zip(out.chunks_exact_mut(elements)) {
        for (e, value) in out.iter_mut().enumerate() {
            let nodes: &[f64; N] = nodes[e * (N - 1)..][..N].try_into().expect("as many");
            let mut sum = 0.0;
            for a in 0..N {
                sum += row[a] * nodes[a];
            }
            *value = sum;
        }
    }
}

/// The adjoint of [`to_elements`].
#[inline(always)]
fn to_nodes<const N: usize>(elements: &[f64], out: &mut [f64], matrix: &[[f64; 3]; 3]) {
    out.fill(0.0);
    let count = elements.len() / N;
    for (row, elements) in matrix.iter().zip(elements.chunks_exact(count)) {
        for (e, value) in elements.iter().enumerate() {
            for a in 0..N {
                out[e * (N - 1) + a] += row[a] * value;
            }
        }
    }
}
