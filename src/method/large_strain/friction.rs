//! Coulomb friction on the plane below.
//!
//! A point that presses on the plane clings to a place there by a spring as stiff as that of the contact. Where the
//! shear `t = k |x − g|` would exceed `μ N`, the place g follows the point until it does not (Wriggers 2006,
//! Computational Contact Mechanics, section 10.5, doi 10.1007/978-3-540-32609-0). Slip makes heat, clinging stores energy.

use std::slice::from_mut;

use super::{Deformable, Plane, Touch};
use crate::state::{Field, Per};

/// State of the friction of a body; empty without.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Friction {
    /// Place on the plane to which each point of the boundary clings, or above which it was last [m].
    pub grips: Vec<[f64; 2]>,
    /// Heat that slip has made: the work done against shear that the springs do not store [J].
    pub heat: f64,
    /// Impulse on the plane along x and y [N s].
    pub impulse: [f64; 2],
    /// Impulse of the last step on each cell of the plane along x and y, or r [N s].
    pub exchange: Vec<[f64; 2]>,
}

/// Shear at the points in contact at a moment.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Shear {
    /// Force on the body at each spot of the contact, along x and y [N].
    pub spots: Vec<[f64; 2]>,
    /// Energy of the springs [J].
    pub energy: f64,
    /// Force on each node, where any acts.
    nodes: Vec<(u32, [f64; 2])>,
}

impl Friction {
    /// Friction of a body that is not deformed, with this many cells below.
    pub fn of(body: &Deformable, cells: usize) -> Self {
        let grips = body.space.boundary.samples.at.iter().map(|&[x, y, _]| [x, y]).collect();
        Self { grips, exchange: vec![[0.0; 2]; cells], ..Self::default() }
    }

    pub fn fields(&mut self) -> Vec<(Field, &mut [f64])> {
        if self.grips.is_empty() {
            return Vec::new();
        }
        let of = |name, words, per, width| Field { name, words, per, width };
        vec![
            (
                of("grips", "place on the plane to which it clings [m]", Per::Point, 2),
                self.grips.as_flattened_mut(),
            ),
            (of("slip_heat", "heat of slip [J]", Per::Body, 1), from_mut(&mut self.heat)),
            (of("shear", "impulse along the plane [N s]", Per::Body, 2), &mut self.impulse),
            (
                of("sheared", "impulse along the plane in the last step [N s]", Per::Cell, 2),
                self.exchange.as_flattened_mut(),
            ),
        ]
    }
}

impl Shear {
    pub fn add_to(&self, forces: &mut [[f64; 3]]) {
        for &(node, force) in &self.nodes {
            (0..2).for_each(|a| forces[node as usize][a] += force[a]);
        }
    }

    /// Work on the body on a way of its nodes [J].
    fn work(&self, way: &[[f64; 3]]) -> f64 {
        let along = |&(node, force): &(u32, [f64; 2])| {
            let [x, y, _] = way[node as usize];
            force[0] * x + force[1] * y
        };
        self.nodes.iter().map(along).sum()
    }

    /// Heat of slip on a way of the nodes at the end of which this is the shear, and `before` at its beginning [J]: by the
    /// trapezoidal rule, as steps change the kinetic energy.
    pub fn heat(&self, before: &Self, way: &[[f64; 3]]) -> f64 {
        before.energy - self.energy - 0.5 * (before.work(way) + self.work(way))
    }
}

impl Plane {
    /// Lets the points in contact cling or slip. Those above the plane take their grips along, so that one that lands
    /// bears the shear of its way since.
    pub fn rub(&self, body: &Deformable, touch: &Touch, friction: &mut Friction) -> Shear {
        let mut shear = Shear::default();
        let (Some(coefficient), samples) = (self.friction, &body.space.boundary.samples) else {
            return shear;
        };
        let before = std::mem::replace(&mut friction.grips, touch.places.clone());
        for spot in &touch.spots {
            let [x, y] = spot.at;
            let [grip_x, grip_y] = before[spot.point];
            let stretch = [x - grip_x, y - grip_y];
            let length = stretch[0].hypot(stretch[1]);
            let spring = self.stiffness * samples.weights[spot.point];
            let most = coefficient * spot.force / spring;
            let kept = if length > most { most / length } else { 1.0 };
            let stretch = stretch.map(|part| kept * part);
            friction.grips[spot.point] = [x - stretch[0], y - stretch[1]];
            let force = stretch.map(|part| -spring * part);
            shear.energy += 0.5 * spring * (kept * length).powi(2);
            let row = samples.row(spot.point).iter();
            shear.nodes.extend(row.map(|value| (value.node, force.map(|f| f * value.value))));
            shear.spots.push(force);
        }
        shear
    }
}
