//! Nodal vectors of loads on a face: `∫ N f dA` over a footprint, whatever the mesh.
//!
//! Integrals are exact to rounding, so the nodal values sum to the total heat or force; those of
//! tractions away from a centre, where the direction is singular, to about 1e-7 of it.

mod cells;
mod motion;

use std::f64::consts::{FRAC_PI_2, TAU};

use crate::math::gauss::{gauss_legendre, gauss_on};
use crate::method::mesh::{Axis, Weight};
use crate::scene::{Footprint, Profile};

pub use cells::{SparseVector, cells_on_plane, cells_on_radius};

/// Position of a footprint on its face [m].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Placement {
    pub x: f64,
    pub y: f64,
    /// Outer radius of round footprints.
    pub radius: f64,
}

/// Distribution of values over a footprint's cells.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Pattern {
    /// The value itself.
    Scalar,
    /// The component along an axis (0 = x, 1 = y) of a vector that points away from the centre.
    Outward(usize),
}

impl Placement {
    /// The place as seen in the mirror planes x = 0 and y = 0.
    fn mirrored(&self, image: [bool; 2]) -> Self {
        let turn = |value: f64, mirror: bool| if mirror { -value } else { value };
        Self { x: turn(self.x, image[0]), y: turn(self.y, image[1]), ..*self }
    }
}

impl Pattern {
    /// Nodal vector on the face with axes `x` and `y` (x fastest) of the load at the mirror image of each point.
    /// `values` holds one value per cell, the first index slowest.
    pub fn on_plane(
        self,
        [x, y]: [&Axis; 2],
        footprint: &Footprint,
        place: &Placement,
        values: &[f64],
        image: [bool; 2],
    ) -> Vec<f64> {
        let place = place.mirrored(image);
        match footprint.profile(place.radius, values) {
            Profile::Discs(discs) => {
                let turned = matches!(self, Pattern::Outward(axis) if image[axis]);
                let mut sum = vec![0.0; x.len() * y.len()];
                for (radius, value) in discs {
                    let part = disc([x, y], &place, radius, self);
                    add_scaled(&mut sum, &part, if turned { -value } else { value });
                }
                sum
            }
            Profile::Gaussian(value) => {
                let along_x = gaussian(x, place.x, place.radius);
                outer(&scaled(along_x, value), &gaussian(y, place.y, place.radius))
            }
            Profile::Tiles { count, size } => tiles([x, y], &place, count, size, values, image),
        }
    }

    /// Nodal vector on the face with the radial axis of an axisymmetric body.
    pub fn on_radius(
        self,
        axis: &Axis,
        footprint: &Footprint,
        radius: f64,
        values: &[f64],
    ) -> Vec<f64> {
        match footprint.profile(radius, values) {
            Profile::Discs(discs) => {
                let mut sum = vec![0.0; axis.len()];
                for (radius, value) in discs {
                    add_scaled(&mut sum, &axis.integrate(0.0, radius, |_| 1.0), value);
                }
                sum
            }
            Profile::Gaussian(value) => scaled(gaussian(axis, 0.0, radius), value),
            // Scenes with tiles on a disc are refused.
            Profile::Tiles { .. } => vec![0.0; axis.len()],
        }
    }
}

/// `∫ N dA` over a disc, by exact integrals along chords and Gauss points over the angle.
///
/// With `y = y_c + R sin φ` the chord is `x_c ± R cos φ`. Between the angles at which a chord's end
/// or the chord itself meets a node the integrand is smooth, so each such piece converges fast.
fn disc([x, y]: [&Axis; 2], place: &Placement, radius: f64, pattern: Pattern) -> Vec<f64> {
    let mut out = vec![0.0; x.len() * y.len()];
    let along_x = |from: f64, to: f64, height: f64| match pattern {
        Pattern::Scalar => chord(x, from, to),
        Pattern::Outward(axis) => {
            let direction = move |at: f64| {
                let offset = [at - place.x, height - place.y];
                let distance = offset[0].hypot(offset[1]);
                if distance > 0.0 { offset[axis] / distance } else { 0.0 }
            };
            // The direction turns over a length of about the chord's distance from the centre.
            let turn = (height - place.y).abs();
            let mut ends = vec![from, place.x, to];
            for steps in TURN_STEPS {
                ends.extend([place.x - steps * turn, place.x + steps * turn]);
            }
            ends.retain(|end| (from..=to).contains(end));
            ends.sort_by(f64::total_cmp);
            let mut sum = vec![0.0; x.len()];
            for piece in ends.windows(2) {
                add_scaled(&mut sum, &x.integrate(piece[0], piece[1], direction), 1.0);
            }
            sum
        }
    };
    for piece in chord_angles([x, y], place, radius, pattern).windows(2) {
        for (angle, w) in gauss_on(GAUSS_OVER_ANGLE, piece[0], piece[1]) {
            let height = place.y + radius * angle.sin();
            if height < y.start() || height > y.end() {
                continue;
            }
            let half = radius * angle.cos();
            let (from, to) = ((place.x - half).max(x.start()), (place.x + half).min(x.end()));
            if from >= to {
                continue;
            }
            let row = along_x(from, to, height);
            let at = y.shape_at(height);
            for j in 0..at.count {
                let weight = w * half * at.values[j];
                add_scaled(&mut out[(at.first + j) * x.len()..][..x.len()], &row, weight);
            }
        }
    }
    out
}

/// Ends of the pieces of a quadrature that must resolve a turn of unit width.
const TURN_STEPS: [f64; 5] = [1.0, 4.0, 16.0, 64.0, 256.0];

const GAUSS_OVER_ANGLE: usize = 8;

/// Ascending angles between which chords of the disc meet no new node.
fn chord_angles([x, y]: [&Axis; 2], place: &Placement, radius: f64, pattern: Pattern) -> Vec<f64> {
    // Over half of a circle, Gauss points would leave 1e-10 of the area.
    let mut angles = vec![-FRAC_PI_2, 0.0, FRAC_PI_2];
    let ends = |axis: &Axis| (0..=axis.elements()).map(|e| axis.nodes[e * axis.order]).collect();
    let (columns, rows): (Vec<f64>, Vec<f64>) = (ends(x), ends(y));
    for node in rows {
        let sine = (node - place.y) / radius;
        if sine.abs() < 1.0 {
            angles.push(sine.asin());
        }
    }
    for node in columns {
        let cosine = (node - place.x).abs() / radius;
        if cosine < 1.0 {
            angles.extend([cosine.acos(), -cosine.acos()]);
        }
    }
    if pattern != Pattern::Scalar {
        // Chords near the centre, where the direction turns increasingly fast.
        for steps in TURN_STEPS {
            angles.extend([1e-3 * steps, -1e-3 * steps]);
        }
    }
    angles.sort_by(f64::total_cmp);
    angles.dedup();
    angles
}

/// `∫ N dx` over `[from, to]` for every node; two Gauss points are exact up to cubics.
fn chord(axis: &Axis, from: f64, to: f64) -> Vec<f64> {
    let mut out = vec![0.0; axis.len()];
    let points = gauss_two();
    let first = axis.shape_at(from).first / axis.order;
    for element in first..axis.elements() {
        let [a, b] = axis.bounds(element);
        if a >= to {
            break;
        }
        let (a, b) = (a.max(from), b.min(to));
        for (xi, w) in points {
            let at = axis.shape_in(element, 0.5 * (a + b) + 0.5 * (b - a) * xi);
            for i in 0..at.count {
                out[at.first + i] += 0.5 * (b - a) * w * at.values[i];
            }
        }
    }
    out
}

fn gauss_two() -> [(f64, f64); 2] {
    let x = 1.0 / 3f64.sqrt();
    [(-x, 1.0), (x, 1.0)]
}

/// `∫ N e^{−2 (x − c)²/w²} dx` for every node (over the circle for a radius), the tails beyond five
/// radii left out (they are below 1e-21 of the peak).
fn gaussian(axis: &Axis, centre: f64, radius: f64) -> Vec<f64> {
    gaussian_moment(axis, centre, radius, |_| 1.0)
}

/// `∫ N f(u) e^{−2u²} dx` with `u = (x − c)/w`, as [`gaussian`].
fn gaussian_moment(axis: &Axis, centre: f64, radius: f64, f: impl Fn(f64) -> f64) -> Vec<f64> {
    let mut out = vec![0.0; axis.len()];
    let points = gauss_legendre(10);
    let reach = 5.0 * radius;
    for element in 0..axis.elements() {
        let [a, b] = axis.bounds(element);
        let (a, b) = (a.max(centre - reach), b.min(centre + reach));
        if a >= b {
            continue;
        }
        let parts = ((b - a) / (0.5 * radius)).ceil().max(1.0);
        let step = (b - a) / parts;
        for part in 0..parts as usize {
            let middle = a + (part as f64 + 0.5) * step;
            for &(xi, w) in &points {
                let x = middle + 0.5 * step * xi;
                let at = axis.shape_in(element, x);
                let u = (x - centre) / radius;
                let value = f(u) * (-2.0 * u * u).exp();
                let measure = match axis.weight {
                    Weight::Uniform => 1.0,
                    Weight::Radial => TAU * x,
                };
                for i in 0..at.count {
                    out[at.first + i] += 0.5 * step * w * measure * value * at.values[i];
                }
            }
        }
    }
    out
}

/// Nodal vector of tiles, from the integrals of their columns and rows.
fn tiles(
    axes: [&Axis; 2],
    place: &Placement,
    count: [usize; 2],
    size: [f64; 2],
    values: &[f64],
    image: [bool; 2],
) -> Vec<f64> {
    let [columns, rows] = tile_strips(axes, place, count, size);
    tile_sum(&columns, &rows, values, image)
}

/// `∫ N dx` over each column of tiles, and over each row.
fn tile_strips(
    [x, y]: [&Axis; 2],
    place: &Placement,
    [nx, ny]: [usize; 2],
    size: [f64; 2],
) -> [Vec<Vec<f64>>; 2] {
    let strips = |axis: &Axis, centre: f64, n: usize, length: f64| -> Vec<Vec<f64>> {
        let end = |i: usize| centre + length * (i as f64 / n as f64 - 0.5);
        let inside = |v: f64| v.clamp(axis.start(), axis.end());
        (0..n)
            .map(|i| {
                let (from, to) = (inside(end(i)), inside(end(i + 1)));
                if from < to { chord(axis, from, to) } else { vec![0.0; axis.len()] }
            })
            .collect()
    };
    [strips(x, place.x, nx, size[0]), strips(y, place.y, ny, size[1])]
}

/// Sum over tiles of the value times the product of the factors of their column and row.
fn tile_sum(columns: &[Vec<f64>], rows: &[Vec<f64>], values: &[f64], image: [bool; 2]) -> Vec<f64> {
    // In a mirror, the tiles are in reverse order.
    let index = |i: usize, n: usize, mirror: bool| if mirror { n - 1 - i } else { i };
    let (nx, ny, width) = (columns.len(), rows.len(), columns[0].len());
    let mut out = vec![0.0; width * rows[0].len()];
    for (j, row) in rows.iter().enumerate() {
        let mut along_x = vec![0.0; width];
        for (i, column) in columns.iter().enumerate() {
            let value = values[index(i, nx, image[0]) * ny + index(j, ny, image[1])];
            if value != 0.0 {
                add_scaled(&mut along_x, column, value);
            }
        }
        for (k, weight) in row.iter().enumerate().filter(|(_, w)| **w != 0.0) {
            add_scaled(&mut out[k * width..][..width], &along_x, *weight);
        }
    }
    out
}

fn outer(along_x: &[f64], along_y: &[f64]) -> Vec<f64> {
    along_y.iter().flat_map(|b| along_x.iter().map(move |a| a * b)).collect()
}

fn scaled(mut values: Vec<f64>, factor: f64) -> Vec<f64> {
    values.iter_mut().for_each(|v| *v *= factor);
    values
}

fn add_scaled(target: &mut [f64], values: &[f64], factor: f64) {
    for (t, v) in target.iter_mut().zip(values) {
        *t += factor * v;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::PI;

    fn axis(order: usize) -> Axis {
        let ends = [-1.0, -0.6, -0.55, -0.1, 0.0, 0.03, 0.2, 0.7, 1.0];
        Axis::from_element_ends(&ends, order, Weight::Uniform)
    }

    fn total(v: &[f64]) -> f64 {
        v.iter().sum()
    }

    fn first_moment(v: &[f64], x: &Axis) -> f64 {
        v.iter().enumerate().map(|(i, v)| v * x.nodes[i % x.len()]).sum()
    }

    const NO_IMAGE: [bool; 2] = [false; 2];

    #[test]
    fn disc_has_exact_area_and_centre_on_any_mesh() {
        for order in [1, 2] {
            let x = axis(order);
            for (cx, cy, radius) in [(0.0, 0.0, 0.5), (0.13, -0.2, 0.77), (0.21, 0.4, 0.011)] {
                let place = Placement { x: cx, y: cy, radius };
                let v = Pattern::Scalar.on_plane(
                    [&x, &x],
                    &Footprint::Disc { radius },
                    &place,
                    &[1.0],
                    NO_IMAGE,
                );
                let area = PI * radius * radius;
                assert!((total(&v) / area - 1.0).abs() < 1e-12, "{}", total(&v) / area - 1.0);
                assert!((first_moment(&v, &x) - cx * area).abs() < 1e-12);
            }
        }
    }

    #[test]
    fn disc_across_the_edge_has_the_area_on_the_face() {
        let x = Axis::from_element_ends(&[0.0, 0.3, 1.0], 1, Weight::Uniform);
        let place = Placement { x: 0.0, y: 0.0, radius: 0.4 };
        let footprint = Footprint::Disc { radius: 0.4 };
        let v = Pattern::Scalar.on_plane([&x, &x], &footprint, &place, &[2.0], NO_IMAGE);
        assert!((total(&v) - 2.0 * PI * 0.04).abs() < 1e-12);
    }

    #[test]
    fn ring_has_exact_area_on_any_mesh_at_any_width() {
        for order in [1, 2] {
            let (x, r) = (
                axis(order),
                Axis::from_element_ends(&[0.0, 0.1, 0.5, 1.0], order, Weight::Radial),
            );
            for (inner, outer) in [(0.2, 0.5), (1e-6, 0.3), (0.599, 0.6), (0.01, 0.011)] {
                let footprint = Footprint::Ring { inner, outer };
                let area = |scale: f64| PI * scale * scale * (outer - inner) * (outer + inner);
                // Unchanged, and enlarged by its input.
                for scale in [1.0, 1.3] {
                    let place = Placement { x: 0.03, y: -0.12, radius: scale * outer };
                    let v = Pattern::Scalar.on_plane([&x; 2], &footprint, &place, &[2.0], NO_IMAGE);
                    let whole = 2.0 * area(scale);
                    let exact = 1e-12 * 2.0 * PI * (scale * outer).powi(2);
                    assert!(
                        (total(&v) - whole).abs() < exact,
                        "{inner} {outer}: {}",
                        total(&v) - whole
                    );
                    assert!((first_moment(&v, &x) - 0.03 * whole).abs() < exact);
                    let v = Pattern::Scalar.on_radius(&r, &footprint, scale * outer, &[2.0]);
                    assert!(
                        (total(&v) - whole).abs() < exact,
                        "{inner} {outer}: {}",
                        total(&v) - whole
                    );
                }
            }
        }
    }

    #[test]
    fn gaussian_has_exact_power_on_coarse_meshes() {
        let place = Placement { x: 0.1, y: 0.05, radius: 0.08 };
        let footprint = Footprint::Gaussian { radius: 0.08 };
        for order in [1, 2] {
            let x = axis(order);
            let v = Pattern::Scalar.on_plane([&x, &x], &footprint, &place, &[3.0], NO_IMAGE);
            let power = 3.0 * PI * 0.08 * 0.08 / 2.0;
            assert!((total(&v) / power - 1.0).abs() < 1e-12);
        }
        let r = Axis::from_element_ends(&[0.0, 0.5, 1.0], 2, Weight::Radial);
        let v = Pattern::Scalar.on_radius(&r, &footprint, 0.08, &[3.0]);
        assert!((total(&v) / (3.0 * PI * 0.08 * 0.08 / 2.0) - 1.0).abs() < 1e-12);
    }

    #[test]
    fn rings_and_tiles_carry_the_sum_of_their_cells() {
        let x = axis(2);
        let place = Placement { x: 0.02, y: -0.1, radius: 0.6 };
        let rings = Footprint::Rings { count: 3, radius: 0.6 };
        let v = Pattern::Scalar.on_plane([&x, &x], &rings, &place, &[1.0, -2.0, 0.5], NO_IMAGE);
        let area = |i: f64| PI * 0.04 * (2.0 * i + 1.0);
        assert!((total(&v) - (area(0.0) - 2.0 * area(1.0) + 0.5 * area(2.0))).abs() < 1e-12);

        let tiles = Footprint::Tiles { count: [2, 3], size: [0.4, 0.6] };
        let values = [1.0, 2.0, 3.0, 4.0, 5.0, 6.0];
        let v = Pattern::Scalar.on_plane([&x, &x], &tiles, &place, &values, NO_IMAGE);
        assert!((total(&v) - 21.0 * 0.04).abs() < 1e-13);
    }

    #[test]
    fn images_are_mirror_images() {
        let x = axis(1);
        let mirrored_nodes: Vec<f64> = x.nodes.iter().rev().map(|v| -v).collect();
        let back = Axis::from_element_ends(&mirrored_nodes, 1, Weight::Uniform);
        let place = Placement { x: 0.17, y: -0.1, radius: 0.3 };
        let values = [1.0, 2.0, 3.0, 4.0, 5.0, 6.0];
        let cases = [
            (Footprint::Tiles { count: [2, 3], size: [0.4, 0.6] }, Pattern::Scalar),
            (Footprint::Rings { count: 6, radius: 0.3 }, Pattern::Outward(0)),
            (Footprint::Rings { count: 6, radius: 0.3 }, Pattern::Outward(1)),
            (Footprint::Disc { radius: 0.3 }, Pattern::Scalar),
        ];
        for (footprint, pattern) in cases {
            let image = pattern.on_plane([&x, &x], &footprint, &place, &values, [true, false]);
            let direct = pattern.on_plane([&back, &x], &footprint, &place, &values, NO_IMAGE);
            let n = x.len();
            for j in 0..n {
                for i in 0..n {
                    let (a, b) = (image[i + n * j], direct[n - 1 - i + n * j]);
                    assert!((a - b).abs() < 1e-12, "{footprint:?} {pattern:?}: {a} {b}");
                }
            }
        }
    }

    #[test]
    fn outward_traction_has_a_first_moment_and_no_resultant() {
        let x = axis(2);
        let place = Placement { x: 0.05, y: 0.0, radius: 0.4 };
        let rings = Footprint::Rings { count: 2, radius: 0.4 };
        let v = Pattern::Outward(0).on_plane([&x, &x], &rings, &place, &[1.0, 1.0], NO_IMAGE);
        // ∫ cos θ · r cos θ dA = π R³/3.
        assert!(total(&v).abs() < 1e-7, "{}", total(&v));
        assert!((first_moment(&v, &x) - PI * 0.064 / 3.0).abs() < 1e-7);
    }
}
