//! Measures of a deformed solid of large strain.

use super::warming::Temperatures;
use crate::laws::solid::large_strain::Deformed;
use crate::method::large_strain::{Courses, Deformable, Failure, Fragments, Stresses, Touch};
use crate::method::sph::ParticleFields;
use crate::space::{Form, Space};

/// Measures of a deformed body, of the whole of it.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Snapshot {
    /// Extents along x and z [m].
    pub width: f64,
    pub height: f64,
    /// z of the centre of mass [m].
    pub centre: f64,
    /// [Pa]
    pub von_mises: f64,
    pub least_jacobian: f64,
    /// [J]
    pub stored: f64,
    pub kinetic: f64,
    /// [N s]
    pub momentum: [f64; 3],
    /// [kg]
    pub mass: f64,
    /// Largest distance of a point in contact from the middle of the contact [m].
    pub contact_radius: f64,
    /// Mean curvature of the middle half of a strip in the plane [1/m].
    pub curvature: f64,
    /// Damage and parts of a body of concrete.
    pub fragments: Fragments,
}

/// Number of mirror images of which a model is one.
pub fn copies(mirrors: [bool; 2]) -> f64 {
    mirrors.iter().map(|&mirrored| if mirrored { 2.0 } else { 1.0 }).product()
}

/// Lowest and highest node of each column of nodes within the middle half of a strip along x, in their order; none if
/// the model is no box in the plane.
pub fn columns(space: &Space, is_box: bool) -> Vec<[usize; 2]> {
    if !is_box || space.form != Form::Plane {
        return Vec::new();
    }
    let most = space.nodes.iter().map(|at| at[0].abs()).fold(0.0, f64::max);
    let inside = (0..space.nodes.len()).filter(|&n| space.nodes[n][0].abs() <= MIDDLE * most);
    let mut inside: Vec<usize> = inside.collect();
    let key = |n: usize| [space.nodes[n][0], space.nodes[n][2]];
    inside.sort_by(|&a, &b| key(a).partial_cmp(&key(b)).expect("places of nodes are numbers"));
    let columns = inside.chunk_by(|&a, &b| (key(a)[0] - key(b)[0]).abs() <= SAME * most);
    columns.map(|column| [column[0], column[column.len() - 1]]).collect()
}

/// Half of the length within which the curvature of a strip is read, over half of its length; slack against rounding.
const MIDDLE: f64 = 0.5 + SAME;
const SAME: f64 = 1e-9;

/// A state of a body, from which it is read.
pub struct Seen<'a> {
    pub body: &'a Deformable,
    pub mirrors: [bool; 2],
    /// Columns of a strip; see [`columns`].
    pub columns: &'a [[usize; 2]],
    /// Height of the reference configuration above its place in space [m].
    pub lifted: f64,
    pub displacement: &'a [[f64; 3]],
    /// Thermal stretches, over no time.
    pub over: &'a Courses,
    /// `None` for a body at rest.
    pub velocity: Option<&'a [[f64; 3]]>,
    pub history: &'a [f64],
    /// Forces of contact, with the energy stored there.
    pub touch: Option<&'a Touch>,
}

impl Seen<'_> {
    /// Stresses of the points.
    pub fn stresses(&self) -> Result<Stresses, Failure> {
        let mut history = self.history.to_vec();
        let team = &self.body.team();
        self.body.respond(self.displacement, self.over, &mut history, team)
    }

    pub fn snapshot(&self, stresses: &Stresses) -> Snapshot {
        let body = self.body;
        let team = &body.team();
        let copies = copies(self.mirrors);
        let moved = body.displacements(self.displacement);
        let places = || body.space.nodes.iter().zip(&moved);
        let range = |axis: usize| {
            let along = places().map(|(at, u)| at[axis] + u[axis]);
            let start = (f64::INFINITY, f64::NEG_INFINITY);
            along.fold(start, |(low, high), x| (low.min(x), high.max(x)))
        };
        let ((left, right), (low, high)) = (range(0), range(2));
        let is_half = self.mirrors[0] || body.space.form == Form::Axisymmetric;
        let mass: f64 = body.mass.iter().sum();
        // Coefficients, not displacements: their moment is that of the body.
        let at_start = body.space.nodes.iter().zip(self.displacement).zip(&body.mass);
        let moment = at_start.map(|((at, u), m)| m * (at[2] + u[2])).sum::<f64>();
        let energy_of_contact = self.touch.map_or(0.0, |touch| touch.energy);
        let mut snapshot = Snapshot {
            width: if is_half { 2.0 * right } else { right - left },
            height: high - low,
            centre: moment / mass + self.lifted,
            von_mises: body.greatest_von_mises(self.displacement, stresses, team),
            least_jacobian: stresses.least,
            stored: copies * (stresses.energy + energy_of_contact),
            mass: copies * mass,
            contact_radius: self.touch.map_or(0.0, |touch| self.radius(touch)),
            curvature: self.curvature(&moved),
            fragments: self.fragments(),
            ..Snapshot::default()
        };
        if let Some(velocity) = self.velocity {
            for (v, m) in velocity.iter().zip(&body.mass) {
                let square: f64 = v.iter().map(|v| v * v).sum();
                snapshot.kinetic += 0.5 * copies * m * square;
                (0..3).for_each(|a| snapshot.momentum[a] += copies * m * v[a]);
            }
            // What images and rings move along mirrored axes cancels.
            let is_round = body.space.form == Form::Axisymmetric;
            for axis in (0..2).filter(|&axis| self.mirrors[axis] || is_round) {
                snapshot.momentum[axis] = 0.0;
            }
        }
        snapshot
    }

    fn fragments(&self) -> Fragments {
        self.body.fragments(self.history, self.velocity, self.mirrors).unwrap_or_default()
    }

    /// Change of the columns' directions over the length of the strip between them [1/m].
    fn curvature(&self, moved: &[[f64; 3]]) -> f64 {
        let nodes = &self.body.space.nodes;
        let direction = |&[bottom, top]: &[usize; 2]| {
            let along =
                |a: usize| nodes[top][a] + moved[top][a] - nodes[bottom][a] - moved[bottom][a];
            [along(0), along(2)]
        };
        let turn = |pair: &[[usize; 2]]| {
            let ([a, b], [c, d]) = (direction(&pair[0]), direction(&pair[1]));
            (b * c - a * d).atan2(a * c + b * d)
        };
        let turned: f64 = self.columns.windows(2).map(turn).sum();
        match (self.columns.first(), self.columns.last()) {
            (Some(first), Some(last)) if first != last => {
                -turned / (nodes[last[0]][0] - nodes[first[0]][0])
            }
            _ => 0.0,
        }
    }

    fn radius(&self, touch: &Touch) -> f64 {
        let count = touch.spots.len().max(1) as f64;
        let is_round = self.body.space.form == Form::Axisymmetric;
        let middle = [0, 1].map(|axis| match self.mirrors[axis] || is_round {
            true => 0.0,
            false => touch.spots.iter().map(|spot| spot.at[axis]).sum::<f64>() / count,
        });
        let distance = |at: [f64; 2]| (at[0] - middle[0]).hypot(at[1] - middle[1]);
        touch.spots.iter().map(|spot| distance(spot.at)).fold(0.0, f64::max)
    }

    /// All nodes as particles, mirror images included; a node of a ring has its radius as x.
    pub fn particles(&self, stresses: &Stresses, temperatures: Temperatures) -> ParticleFields {
        let body = self.body;
        let mut fields = ParticleFields::default();
        let swelling = self.swelling();
        let von_mises = self.von_mises(stresses);
        let is_concrete = body.layers.iter().any(|layer| layer.law.concrete().is_some());
        let damage = match is_concrete {
            true => body.damages_at_nodes(&body.damages(self.history)),
            false => Vec::new(),
        };
        let [density, pressure] = [0, 1].map(|n| swelling.iter().map(|s| s[n]).collect::<Vec<_>>());
        let temperature = temperatures.at_nodes(body);
        let count = body.nodes();
        let moved = body.displacements(self.displacement);
        let velocities = self.velocity.map(|velocity| body.displacements(velocity));
        let signs = |mirrored: bool| if mirrored { &[1.0, -1.0][..] } else { &[1.0][..] };
        for &sx in signs(self.mirrors[0]) {
            for &sy in signs(self.mirrors[1]) {
                let turn = |v: [f64; 3]| [sx * v[0], sy * v[1], v[2]];
                for node in 0..count {
                    let (at, u) = (body.space.nodes[node], moved[node]);
                    let place = [0, 1, 2].map(|a| at[a] + u[a]);
                    fields.position.push(turn([place[0], place[1], place[2] + self.lifted]));
                    let velocity = velocities.as_ref().map_or([0.0; 3], |all| all[node]);
                    fields.velocity.push(turn(velocity));
                    fields.displacement.push(turn(u));
                }
                fields.von_mises.extend(&von_mises);
                fields.mass.extend(&body.mass);
                fields.density.extend(&density);
                fields.pressure.extend(&pressure);
                fields.temperature.extend(&temperature);
                fields.damage.extend(&damage);
            }
        }
        fields
    }

    /// Von Mises stress at each node [Pa]: the mean over the points around it.
    fn von_mises(&self, stresses: &Stresses) -> Vec<f64> {
        let body = self.body;
        let of_points = body.von_mises(self.displacement, stresses, &body.team());
        let points = &body.space.volume;
        let mut sums = vec![[0.0; 2]; body.nodes()];
        for (point, stress) in of_points.into_iter().enumerate() {
            for value in points.row(point) {
                let share = body.space.influence(value.value) * points.weights[point];
                let sum = &mut sums[value.node as usize];
                sum[0] += share;
                sum[1] += share * stress;
            }
        }
        sums.into_iter().map(|[whole, stress]| stress / whole).collect()
    }

    /// Density [kg/m³] and pressure of the dilatation [Pa] at each node: means over the points around it.
    fn swelling(&self) -> Vec<[f64; 2]> {
        let body = self.body;
        let (deformed, dilatations) =
            body.deformations(self.displacement, (self.over, self.history), &body.team());
        let mut sums = vec![[0.0; 3]; body.nodes()];
        for (number, (group, shared)) in body.space.groups.iter().zip(&dilatations).enumerate() {
            let layer = body.layer_of_group[number];
            let stretch = self.over.at(body, number).stretch;
            let (free, density) = (stretch.powi(3), body.layers[layer].density);
            let pressure = body.pressure(number, body.law_of(number), shared);
            for (place, point) in group.clone().enumerate() {
                let Deformed { dilatation, .. } = deformed[point];
                for value in body.space.volume.row(point) {
                    let share =
                        body.space.influence(value.value) * body.space.volume.weights[point];
                    let sum = &mut sums[value.node as usize];
                    sum[0] += share;
                    sum[1] += share * density / (free * dilatation);
                    sum[2] -= share * pressure.at(place);
                }
            }
        }
        sums.into_iter()
            .map(|[whole, density, pressure]| [density / whole, pressure / whole])
            .collect()
    }
}
