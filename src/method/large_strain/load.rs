//! Loads on faces: pressure that stays normal to them while they deform, and tractions that stay as they are.
//!
//! A pressure p acts per present area, `−p J F^(−T) N dA`; with unit vectors s and t along the undeformed face, `s × t
//! = N`, that is `−p (F s) × (F t) dA` and needs only gradients along the face (K. Schweizerhof and E. Ramm 1984, doi
//! 10.1016/0045-7949(84)90191-8). Its derivative is not symmetric where the face has an edge that moves. A traction is
//! a force per area of the undeformed face.

use super::Deformable;
use crate::math::matrix3::{Matrix3, cross};
use crate::space::{Form, Side};

/// A load on a face.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct FaceLoad {
    /// Pressure that presses into the body [Pa].
    pub pressure: f64,
    /// Force per undeformed area along x, y and z [Pa].
    pub traction: [f64; 3],
}

impl FaceLoad {
    pub fn is_zero(&self) -> bool {
        *self == Self::default()
    }

    /// Returns true if a load follows its face as that turns, so that its stiffness is not symmetric.
    pub fn follows(&self) -> bool {
        self.pressure != 0.0
    }

    /// The load of these numbers: the pressure, then the traction [Pa].
    pub fn of([pressure, x, y, z]: [f64; 4]) -> Self {
        Self { pressure, traction: [x, y, z] }
    }

    pub fn numbers(&self) -> [f64; 4] {
        let [x, y, z] = self.traction;
        [self.pressure, x, y, z]
    }

    /// The load half-way to another.
    pub fn middle(&self, to: &Self) -> Self {
        let half = |a: f64, b: f64| 0.5 * (a + b);
        Self {
            pressure: half(self.pressure, to.pressure),
            traction: [0, 1, 2].map(|a| half(self.traction[a], to.traction[a])),
        }
    }
}

/// Faces of a body on which loads act.
#[derive(Debug, Clone, Default)]
pub struct LoadedFaces {
    /// Points of the boundary of each face.
    points: Vec<Vec<usize>>,
}

/// Stiffness of a pressure at a point of the boundary, by nodes and axes.
pub struct LoadStiffness {
    pub nodes: Vec<u32>,
    /// Row by row.
    pub matrix: Vec<f64>,
}

impl LoadStiffness {
    pub fn symmetric_part(&self) -> Self {
        let width = 3 * self.nodes.len();
        let mean = |n: usize| {
            let (row, column) = (n / width, n % width);
            0.5 * (self.matrix[n] + self.matrix[column * width + row])
        };
        Self { nodes: self.nodes.clone(), matrix: (0..width * width).map(mean).collect() }
    }
}

/// Unit vectors s and t along a face at a point, `s × t = N`, and their images `F s` and `F t`.
struct Frame {
    along: [[f64; 3]; 2],
    images: [[f64; 3]; 2],
}

impl LoadedFaces {
    /// Finds the points of faces, each of which consists of the sides that its predicate accepts.
    pub fn new(body: &Deformable, faces: &[&dyn Fn(Side) -> bool]) -> Self {
        let sides = &body.space.boundary.sides;
        let points_of = |is_on: &&dyn Fn(Side) -> bool| {
            (0..sides.len()).filter(|&point| is_on(sides[point])).collect()
        };
        Self { points: faces.iter().map(points_of).collect() }
    }

    /// Returns the nodes of each point, face by face, that a pressure couples.
    pub fn couplings(&self, body: &Deformable) -> Vec<Vec<u32>> {
        let nodes = |&point: &usize| {
            body.space.boundary.samples.row(point).iter().map(|value| value.node).collect()
        };
        self.points.iter().flatten().map(nodes).collect()
    }

    /// Adds the forces of loads, one for each face, on the nodes of a body displaced by u.
    pub fn add_forces(
        &self,
        body: &Deformable,
        u: &[[f64; 3]],
        loads: &[FaceLoad],
        forces: &mut [[f64; 3]],
    ) {
        let samples = &body.space.boundary.samples;
        for (points, load) in self.points.iter().zip(loads) {
            if load.is_zero() {
                continue;
            }
            for &point in points {
                let mut force = load.traction;
                if load.follows() {
                    let Frame { images: [s, t], .. } = frame(body, point, u);
                    let area = cross(s, t);
                    (0..3).for_each(|a| force[a] -= load.pressure * area[a]);
                }
                for value in samples.row(point) {
                    let share = samples.weights[point] * value.value;
                    (0..3).for_each(|a| forces[value.node as usize][a] += share * force[a]);
                }
            }
        }
    }

    /// Returns minus the derivatives of the forces, `scale` times, for each point of [`Self::couplings`].
    pub fn stiffness(
        &self,
        body: &Deformable,
        u: &[[f64; 3]],
        loads: &[FaceLoad],
        scale: f64,
    ) -> Vec<LoadStiffness> {
        let of_point = |point: usize, pressure: f64| {
            let row = body.space.boundary.samples.row(point);
            let nodes: Vec<u32> = row.iter().map(|value| value.node).collect();
            let width = 3 * nodes.len();
            let mut matrix = vec![0.0; width * width];
            if pressure != 0.0 {
                pressed(body, point, u, scale * pressure, &mut matrix);
            }
            LoadStiffness { nodes, matrix }
        };
        let all = self.points.iter().zip(loads);
        all.flat_map(|(points, load)| points.iter().map(|&p| of_point(p, load.pressure))).collect()
    }
}

/// Adds the stiffness of a pressure at a point.
fn pressed(body: &Deformable, point: usize, u: &[[f64; 3]], pressure: f64, matrix: &mut [f64]) {
    let samples = &body.space.boundary.samples;
    let row = samples.row(point);
    let width = 3 * row.len();
    let Frame { along, images: [s, t] } = frame(body, point, u);
    for (b, column) in row.iter().enumerate() {
        for c in 0..3 {
            // δF = e_c ⊗ ∇Ψ, and around an axis e_y ⊗ e_y Ψ/r.
            let mut change = [[0.0; 3]; 2];
            for (change, along) in change.iter_mut().zip(&along) {
                change[c] = (0..3).map(|a| column.gradient[a] * along[a]).sum();
            }
            if c == 0 && body.space.form == Form::Axisymmetric {
                change[1][1] += column.value / samples.at[point][0];
            }
            let (first, second) = (cross(change[0], t), cross(s, change[1]));
            for (a, own) in row.iter().enumerate() {
                let share = pressure * samples.weights[point] * own.value;
                for i in 0..3 {
                    matrix[(3 * a + i) * width + 3 * b + c] += share * (first[i] + second[i]);
                }
            }
        }
    }
}

/// Area that a point of the boundary represents on a body displaced by u [m²].
pub fn present_area(body: &Deformable, point: usize, u: &[[f64; 3]]) -> f64 {
    let Frame { images: [s, t], .. } = frame(body, point, u);
    let area = cross(s, t);
    body.space.boundary.samples.weights[point] * area.iter().map(|x| x * x).sum::<f64>().sqrt()
}

fn frame(body: &Deformable, point: usize, u: &[[f64; 3]]) -> Frame {
    let normal = body.space.boundary.normals[point];
    let along = match body.space.form {
        // The other is that across the plane.
        Form::Plane | Form::Axisymmetric => {
            let across = [0.0, 1.0, 0.0];
            [cross(across, normal), across]
        }
        Form::Solid => {
            let steepest = (0..3).max_by(|&a, &b| normal[b].abs().total_cmp(&normal[a].abs()));
            let mut other = [0.0; 3];
            other[steepest.unwrap_or(0)] = 1.0;
            let first = unit(cross(other, normal));
            [first, cross(normal, first)]
        }
    };
    let gradient = body.gradient(&body.space.boundary.samples, point, u);
    Frame { along, images: along.map(|along| image(&gradient, along)) }
}

fn image(gradient: &Matrix3, along: [f64; 3]) -> [f64; 3] {
    gradient.map(|row| row[0] * along[0] + row[1] * along[1] + row[2] * along[2])
}

fn unit(v: [f64; 3]) -> [f64; 3] {
    let length = v.iter().map(|x| x * x).sum::<f64>().sqrt();
    v.map(|x| x / length)
}

#[cfg(test)]
mod tests;
