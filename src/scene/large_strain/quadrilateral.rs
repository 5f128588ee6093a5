//! Bodies of four corners in x and z, all alike along y.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::limits::{length, plausible, signed};
use crate::scene::types::FaceName;

/// A body whose section in x and z has four corners; its coordinates are those of the scene.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Quadrilateral {
    /// Corners `[x, z]`: bottom left, bottom right, top right, top left [m].
    #[schemars(transform = signed("m", "a corner").condition("all angles below 180°"))]
    pub corners: [[f64; 2]; 4],
    /// Extent along y, half of it on each side of y = 0 [m].
    #[schemars(transform = length("the depth of a body").plausible(&plausible::EXTENT)
        .condition("with `dimension = 3`"))]
    pub depth: Option<f64>,
}

impl Quadrilateral {
    /// Place in x and z at shares of the way from left to right and from bottom to top [m].
    pub fn place(&self, u: f64, w: f64) -> [f64; 2] {
        let weights = [(1.0 - u) * (1.0 - w), u * (1.0 - w), u * w, (1.0 - u) * w];
        let corners = weights.iter().zip(&self.corners);
        corners.fold([0.0; 2], |[x, z], (weight, corner)| {
            [x + weight * corner[0], z + weight * corner[1]]
        })
    }

    /// Lengths of the edges: bottom, right, top, left [m].
    pub fn edges(&self) -> [f64; 4] {
        [0, 1, 2, 3].map(|n| {
            let [x, z] = self.edge(n);
            x.hypot(z)
        })
    }

    /// Lowest and highest x and z [m].
    pub fn ranges(&self) -> [[f64; 2]; 2] {
        [0, 1].map(|axis| {
            let along = self.corners.map(|corner| corner[axis]);
            let low = along.into_iter().fold(f64::INFINITY, f64::min);
            [low, along.into_iter().fold(f64::NEG_INFINITY, f64::max)]
        })
    }

    /// Returns true if the corners go round once, against the clock seen with x to the right and z up, and every angle
    /// is below 180°.
    pub fn is_convex(&self) -> bool {
        (0..4).all(|n| {
            let ([a, b], [c, d]) = (self.edge(n), self.edge((n + 1) % 4));
            a * d - b * c > 1e-9 * a.hypot(b) * c.hypot(d)
        })
    }

    /// Returns true if the first corner is the lower left one: the bottom is below the top, and the left side left of
    /// the right one.
    pub fn begins_below(&self) -> bool {
        let middle =
            |axis: usize, n: usize| self.corners[n][axis] + self.corners[(n + 1) % 4][axis];
        middle(1, 0) < middle(1, 2) && middle(0, 3) < middle(0, 1)
    }

    /// Returns true if a point in x and z is inside or on the boundary.
    pub fn contains(&self, [x, z]: [f64; 2]) -> bool {
        (0..4).all(|n| {
            let ([a, b], [from_x, from_z]) = (self.edge(n), self.corners[n]);
            let [c, d] = [x - from_x, z - from_z];
            a * d - b * c >= -1e-9 * a.hypot(b) * self.edges().into_iter().fold(0.0, f64::max)
        })
    }

    /// Returns true if a face is normal to an axis.
    pub fn is_straight(&self, face: FaceName) -> bool {
        let along = |n: usize, axis: usize| {
            let edge = self.edge(n);
            edge[axis].abs() <= 1e-12 * edge[0].hypot(edge[1])
        };
        match face {
            FaceName::Bottom => along(0, 1),
            FaceName::Right => along(1, 0),
            FaceName::Top => along(2, 1),
            FaceName::Left => along(3, 0),
            FaceName::Front | FaceName::Back => true,
            FaceName::Sides => along(1, 0) && along(3, 0),
        }
    }

    /// Vector from a corner to the next [m].
    fn edge(&self, n: usize) -> [f64; 2] {
        let [[x, z], [to_x, to_z]] = [self.corners[n], self.corners[(n + 1) % 4]];
        [to_x - x, to_z - z]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const COOK: [[f64; 2]; 4] = [[0.0, 0.0], [48.0, 44.0], [48.0, 60.0], [0.0, 44.0]];

    #[test]
    fn corners_in_order_make_a_body_and_others_do_not() {
        let of = |corners| Quadrilateral { corners, depth: None };
        let [a, b, c, d] = COOK;
        assert!(of(COOK).is_convex() && of(COOK).begins_below());
        assert!(of([b, c, d, a]).is_convex() && !of([b, c, d, a]).begins_below());
        for wrong in [[d, c, b, a], [a, c, b, d], [a, b, b, d], [a, b, [10.0, 30.0], d]] {
            assert!(!of(wrong).is_convex(), "{wrong:?}");
        }
    }

    #[test]
    fn places_are_inside_and_sides_are_straight_or_not() {
        let body = Quadrilateral { corners: COOK, depth: None };
        assert_eq!([body.place(0.0, 1.0), body.place(1.0, 0.0)], [COOK[3], COOK[1]]);
        for n in 0..25 {
            let [u, w] = [f64::from(n % 5) / 4.0, f64::from(n / 5) / 4.0];
            assert!(body.contains(body.place(u, w)));
        }
        assert!(!body.contains([24.0, 10.0]) && !body.contains([49.0, 50.0]));
        let straight = [FaceName::Left, FaceName::Right].map(|face| body.is_straight(face));
        let slanted = [FaceName::Bottom, FaceName::Top].map(|face| body.is_straight(face));
        assert_eq!((straight, slanted), ([true; 2], [false; 2]));
        assert_eq!(body.ranges(), [[0.0, 48.0], [0.0, 60.0]]);
    }
}
