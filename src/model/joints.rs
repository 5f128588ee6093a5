//! Heat between solids that touch.

use super::schedule::{Exchange, Group, Part, acts};
use super::{Cache, Model};
use crate::body::{BodyError, Given, Joint};
use crate::math::allowance::Allowance;
use crate::math::anderson::Anderson;
use crate::method::sph::{Surface, SurfaceResponse};

/// Parts of a step at whose ends the law of the contact holds: those of the method Radau IIA of third order (E. Hairer
/// and G. Wanner, *Solving Ordinary Differential Equations II*, Springer 1996, §IV.5). Between them the flux is linear.
const STAGES: [f64; 2] = [1.0 / 3.0, 1.0];

/// What is left of the fluxes, over the largest.
const TOLERANCE: f64 = 1e-10;
/// Difference of temperatures that is rounding, over the temperatures.
const ROUNDING: f64 = 1e-12;
/// What steps of bodies that are not exact may change of temperatures from one try to the next, over their tolerance.
const NOISE: f64 = 0.1;
/// More iterations than any contact was seen to take.
const MOST_ITERATIONS: usize = 100;

/// Two fluxes at each common place of each joint [W/m²].
type Fluxes = Vec<[f64; 2]>;

impl Model {
    /// What passes through the joints of a group over a part of a step, all found together; nothing has advanced yet.
    /// `surfaces` end with those of the joints' sides, `others` is what comes from elsewhere.
    ///
    /// The law holds exactly between the bodies as they are at the stages, whatever these conduct within: iterations
    /// correct the fluxes as if heat went straight down from each place, which is nearly so.
    pub(super) fn settle_joints(
        &self,
        (group, surfaces): (&Group, &[Surface]),
        states: &[Vec<f64>],
        cache: &mut Cache,
        (path, dt): Part,
        others: &[Exchange],
        allowance: &Allowance,
    ) -> Result<Vec<Exchange>, BodyError> {
        let joints: Vec<&Joint> = group.joints.iter().map(|&joint| &self.joints[joint]).collect();
        if joints.is_empty() {
            return Ok(Vec::new());
        }
        let sides = surfaces[surfaces.len() - 2 * joints.len()..].chunks_exact(2);
        let corrections: Vec<_> = joints
            .iter()
            .zip(sides)
            .map(|(joint, sides)| correction(joint, sides.iter().map(|s| &s.response), dt))
            .collect();
        let places: usize = joints.iter().map(|joint| joint.cells.len()).sum();
        let mut fluxes: Fluxes = vec![[0.0; 2]; places];
        let mut anderson = Anderson::default();
        let noise = NOISE * self.tolerance_of(group);
        for _ in 0..MOST_ITERATIONS {
            let passed = exchanges(&joints, &fluxes, dt);
            let all: Vec<&Exchange> = others.iter().chain(&passed).collect();
            let mut wrong: Fluxes = Vec::with_capacity(places);
            let mut is_settled = true;
            let temperatures = self.at_stages(group, states, cache, (path, dt), &all, allowance)?;
            let largest = fluxes.as_flattened().iter().fold(0.0_f64, |m, q| m.max(q.abs()));
            let mut first = 0;
            for (n, joint) in joints.iter().enumerate() {
                let own = &fluxes[first..first + joint.cells.len()];
                first += joint.cells.len();
                let sides = [0, 1].map(|side| {
                    [0, 1].map(|stage| joint.values(side, &temperatures[stage][2 * n + side]))
                });
                for (place, flux) in own.iter().enumerate() {
                    let [from, to] = sides.each_ref().map(|side| [side[0][place], side[1][place]]);
                    let off = [0, 1].map(|s| joint.conductance * (from[s] - to[s]) - flux[s]);
                    let corrected = product(corrections[n], off);
                    let rounding = ROUNDING * from[1].abs().max(to[1].abs());
                    let rounding = joint.conductance * rounding.max(noise);
                    // Not `>`, by which what is no number would be settled.
                    is_settled &= (0..2).all(|s| {
                        corrected[s].abs() <= TOLERANCE * largest || off[s].abs() <= rounding
                    });
                    wrong.push(corrected);
                }
            }
            if is_settled {
                return Ok(passed);
            }
            let next = anderson.next(fluxes.as_flattened(), wrong.as_flattened());
            fluxes = next.as_chunks().0.to_vec();
        }
        let sides = joints[0].sides.each_ref().map(|side| self.bodies[side.body].name().to_owned());
        Err(BodyError::Contact { sides })
    }

    /// What temperatures of bodies in a group may err by [K].
    fn tolerance_of(&self, group: &Group) -> f64 {
        let conductors = group.bodies.iter().filter_map(|&body| self.bodies[body].conductor());
        conductors.map(|conductor| conductor.tolerance()).fold(0.0, f64::max)
    }

    /// Temperatures of the sides of a group's joints at each stage.
    fn at_stages(
        &self,
        group: &Group,
        states: &[Vec<f64>],
        cache: &mut Cache,
        (path, dt): Part,
        exchanges: &[&Exchange],
        allowance: &Allowance,
    ) -> Result<[Vec<Vec<f64>>; 2], BodyError> {
        let sides: Vec<_> =
            group.joints.iter().flat_map(|&joint| &self.joints[joint].sides).collect();
        let mut all = [vec![Vec::new(); sides.len()], vec![Vec::new(); sides.len()]];
        for &body in &group.bodies {
            let own: Vec<usize> = (0..sides.len()).filter(|&n| sides[n].body == body).collect();
            let Some(conductor) = self.bodies[body].conductor().filter(|_| !own.is_empty()) else {
                continue;
            };
            let faces: Vec<_> = own.iter().map(|&n| sides[n].face).collect();
            let received = Exchange::with(exchanges.iter().copied(), body);
            for (temperatures, stage) in all.iter_mut().zip(STAGES) {
                let acts = acts((path, stage * dt), &received, None);
                let (state, memo) = (&states[body], cache.memo(body));
                let found = conductor.temperatures_after(state, memo, &faces, &acts, allowance)?;
                own.iter().zip(found).for_each(|(&n, found)| temperatures[n] = found);
            }
        }
        Ok(all)
    }

    /// What passes through all joints at one moment, as if it went on for a second.
    pub(super) fn through_joints(
        &self,
        states: &[Vec<f64>],
        cache: &mut Cache,
        inputs: &crate::inputs::InputPath,
    ) -> Result<Vec<Exchange>, BodyError> {
        let now = acts((inputs, 0.0), &[], None);
        let mut passed = Vec::new();
        for joint in &self.joints {
            let mut values = [Vec::new(), Vec::new()];
            for (side, values) in joint.sides.iter().zip(&mut values) {
                let Some(conductor) = self.bodies[side.body].conductor() else { continue };
                let (state, memo) = (&states[side.body], cache.memo(side.body));
                let allowance = Allowance::default();
                let found =
                    conductor.temperatures_after(state, memo, &[side.face], &now, &allowance)?;
                *values = found.into_iter().flatten().collect();
            }
            let [from, to] = [0, 1].map(|side| joint.values(side, &values[side]));
            let flux = |(from, to): (&f64, &f64)| [joint.conductance * (from - to); 2];
            let fluxes: Fluxes = from.iter().zip(&to).map(flux).collect();
            passed.extend(exchanges(&[joint], &fluxes, 1.0));
        }
        Ok(passed)
    }
}

/// What the bodies at both sides of joints get when these fluxes pass.
fn exchanges(joints: &[&Joint], fluxes: &[[f64; 2]], dt: f64) -> Vec<Exchange> {
    let mut first = 0;
    let mut all = Vec::new();
    for joint in joints {
        let own = fluxes[first..first + joint.cells.len()].iter().zip(&joint.cells.areas);
        first += joint.cells.len();
        // Of a flux that is linear through its values at the stages: the mean, and what it is above that at first.
        let (heat, falling): (Vec<f64>, Vec<f64>) = own
            .map(|([early, late], area)| {
                (area * dt * (0.75 * early + 0.25 * late), area * 0.75 * (early - late))
            })
            .unzip();
        for (n, side) in joint.sides.iter().enumerate() {
            let sign = if n == 0 { -1.0 } else { 1.0 };
            let signed = |amounts: &[f64]| {
                let amounts: Vec<f64> = amounts.iter().map(|amount| sign * amount).collect();
                joint.deposit(n, &amounts)
            };
            let given = Given {
                duration: dt,
                heat: signed(&heat),
                falling: signed(&falling),
                ..Given::default()
            };
            all.push(Exchange { body: side.body, face: side.face, given });
        }
    }
    all
}

/// What corrects the fluxes at a place for what they are wrong by, if heat goes straight down from there: the inverse of
/// `1 + h R`, R the rise of both sides at the stages by the fluxes there.
fn correction<'a>(
    joint: &Joint,
    responses: impl Iterator<Item = &'a SurfaceResponse>,
    dt: f64,
) -> [[f64; 2]; 2] {
    let mut matrix = [[1.0, 0.0], [0.0, 1.0]];
    for response in responses {
        for (row, stage) in matrix.iter_mut().zip(STAGES) {
            let time = stage * dt;
            let held = response.of_held_flux(time);
            let falling = held - 2.0 / dt * response.of_growing_flux(time);
            // The mean is ¾ and ¼ of the fluxes at the stages, what falls ¾ of their difference.
            row[0] += joint.conductance * 0.75 * (held + falling);
            row[1] += joint.conductance * (0.25 * held - 0.75 * falling);
        }
    }
    let [[a, b], [c, d]] = matrix;
    let determinant = a * d - b * c;
    [[d, -b], [-c, a]].map(|row| row.map(|entry| entry / determinant))
}

fn product(matrix: [[f64; 2]; 2], [x, y]: [f64; 2]) -> [f64; 2] {
    matrix.map(|row| row[0] * x + row[1] * y)
}
