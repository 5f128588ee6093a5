//! Contact with a rigid plane below the body.
//!
//! Points of the boundary that penetrate the plane are pushed out by a pressure per reference area in proportion to
//! their depth. It has an energy, so that contact neither makes nor takes any.

use super::Deformable;

/// The plane z = 0.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Plane {
    /// Pressure per depth [Pa/m].
    pub stiffness: f64,
    /// Height of the body's reference configuration above its place in space [m].
    pub height: f64,
    /// Distance of points of the boundary, over which each spreads its force [m].
    pub width: f64,
    /// Coefficient of friction; `None` if the body slides without.
    pub friction: Option<f64>,
}

/// A point in contact.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Spot {
    /// Number of the point of the boundary.
    pub point: usize,
    /// x and y in space [m].
    pub at: [f64; 2],
    /// Extent over which it presses [m].
    width: f64,
    /// [N]
    pub force: f64,
}

impl Spot {
    /// Rectangle over which the point and its images press, for the signs of x and y [m].
    pub fn rectangle(&self, signs: [f64; 2]) -> [[f64; 2]; 2] {
        [0, 1].map(|axis| {
            let at = signs[axis] * self.at[axis];
            [at - 0.5 * self.width, at + 0.5 * self.width]
        })
    }
}

/// Contact forces at a moment.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Touch {
    /// Force on the body [N].
    pub force: f64,
    /// Energy of the penetration [J].
    pub energy: f64,
    pub spots: Vec<Spot>,
    /// x and y of all points of the boundary, touching or not, where there is friction [m].
    pub places: Vec<[f64; 2]>,
    /// Force on each node along z, where any acts.
    nodes: Vec<(u32, f64)>,
}

impl Touch {
    pub fn add_to(&self, forces: &mut [[f64; 3]]) {
        self.nodes.iter().for_each(|&(node, force)| forces[node as usize][2] += force);
    }
}

impl Plane {
    /// Contact of a body displaced by u.
    pub fn touch(&self, body: &Deformable, u: &[[f64; 3]]) -> Touch {
        let samples = &body.space.boundary.samples;
        let mut touch = Touch::default();
        for point in 0..samples.len() {
            let mut at = samples.at[point];
            at[2] += self.height;
            for value in samples.row(point) {
                let u = u[value.node as usize];
                (0..3).for_each(|a| at[a] += value.value * u[a]);
            }
            if self.friction.is_some() {
                touch.places.push([at[0], at[1]]);
            }
            if at[2] >= 0.0 {
                continue;
            }
            let force = self.stiffness * -at[2] * samples.weights[point];
            touch.force += force;
            touch.energy += 0.5 * force * -at[2];
            touch.spots.push(Spot { point, at: [at[0], at[1]], width: self.width, force });
            let row = samples.row(point).iter();
            touch.nodes.extend(row.map(|value| (value.node, force * value.value)));
        }
        touch
    }
}
