//! Map of the unit square or cube to a cell, linear along each edge.

use super::super::finite_elements::shape;
use super::super::{Form, Mesh};
use crate::math::gauss::gauss_on;
use crate::math::matrix3::cross;

/// A place of a cell with the derivatives of the map there.
pub(super) struct Place {
    pub at: [f64; 3],
    /// ∂x_a/∂ξ_b.
    jacobian: [[f64; 3]; 3],
    /// Volume per volume of the unit cell, negative in cells that are mirror images.
    determinant: f64,
}

impl Place {
    /// Maps coordinates of the unit cell.
    pub(super) fn of(mesh: &Mesh, cell: &[u32], local: [f64; 3]) -> Self {
        let (mut at, mut jacobian) = ([0.0; 3], [[0.0; 3]; 3]);
        for (n, &node) in cell.iter().enumerate() {
            let (value, slope) = shape((mesh.form, 1), n, local);
            let x = mesh.nodes[node as usize];
            for a in 0..3 {
                at[a] += value * x[a];
                (0..3).for_each(|b| jacobian[a][b] += x[a] * slope[b]);
            }
        }
        if mesh.form != Form::Solid {
            jacobian[1][1] = 1.0;
        }
        let mut place = Self { at, jacobian, determinant: 1.0 };
        let (along, area) = (place.column(0), place.area(0));
        place.determinant = (0..3).map(|a| along[a] * area[a]).sum();
        place
    }

    /// Volume per volume of the unit cell.
    pub(super) fn volume(&self) -> f64 {
        self.determinant.abs()
    }

    /// Area vector per area of the unit cell of the surface on which the coordinate `axis` is constant; it points to
    /// where that increases.
    pub(super) fn area(&self, axis: usize) -> [f64; 3] {
        let area = cross(self.column((axis + 1) % 3), self.column((axis + 2) % 3));
        area.map(|x| self.determinant.signum() * x)
    }

    /// ∂x/∂ξ along a coordinate of the unit cell.
    fn column(&self, axis: usize) -> [f64; 3] {
        [0, 1, 2].map(|a| self.jacobian[a][axis])
    }
}

/// Gauss points and weights of the part `low` to `high` of the unit cell, `count` along each of the coordinates
/// `along`; the others are `low`.
pub(super) fn gauss_points(
    along: &[usize],
    low: [f64; 3],
    high: [f64; 3],
    count: usize,
) -> Vec<([f64; 3], f64)> {
    let mut points = vec![(low, 1.0)];
    for &axis in along {
        let rule: Vec<(f64, f64)> = gauss_on(count, low[axis], high[axis]).collect();
        let split = |(place, weight): ([f64; 3], f64)| {
            rule.clone().into_iter().map(move |(x, w)| {
                let mut place = place;
                place[axis] = x;
                (place, weight * w)
            })
        };
        points = points.into_iter().flat_map(split).collect();
    }
    points
}
