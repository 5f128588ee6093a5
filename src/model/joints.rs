//! Heat transfer between solids in contact.

use super::schedule::{Exchange, Group, Part, acts};
use super::{Cache, Model};
use crate::body::{BodyError, Given, Joint};
use crate::math::anderson::Anderson;
use crate::port::SurfaceResponse;
use crate::runtime::allowance::Allowance;

/// Times of a step at which the contact law holds: those of the method Radau IIA of third order (E. Hairer and G.
/// Wanner, *Solving Ordinary Differential Equations II*, Springer 1996, §IV.5). Between them the flux is linear.
const STAGES: [f64; 2] = [1.0 / 3.0, 1.0];

/// Residual of the fluxes, over the largest flux.
const TOLERANCE: f64 = 1e-10;
/// Residual that is accepted where rounding prevents a smaller one, as for a contact of hardly any resistance; heat
/// balances whatever it is.
const GOOD_ENOUGH: f64 = 1e-5;
/// Difference of temperatures due to rounding, over the temperatures.
const ROUNDING: f64 = 1e-12;
/// Change of temperatures between iterations due to inexact steps of bodies, over their tolerance.
const NOISE: f64 = 0.1;
/// Upper limit of iterations, above the number that any contact needed.
const MOST_ITERATIONS: usize = 100;

/// Two fluxes at each place of each joint [W/m²].
type Fluxes = Vec<[f64; 2]>;

impl Model {
    /// Computes the transfers through all joints of a group over a part of a step, before anything has advanced.
    /// `others` holds the transfers from elsewhere.
    ///
    /// The contact law holds exactly between the bodies as they are at the stages, whatever their internal conduction.
    /// Iterations correct the fluxes as if both bodies ended at the contact.
    pub(super) fn settle_joints(
        &self,
        group: &Group,
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
        let corrections: Vec<_> = joints.iter().map(|joint| Correction::of(joint, dt)).collect();
        let places: usize = joints.iter().map(|joint| joint.cells.fluxes()).sum();
        let mut fluxes: Fluxes = vec![[0.0; 2]; places];
        let mut anderson = Anderson::default();
        let mut best: Option<(f64, Vec<Exchange>)> = None;
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
                let own = &fluxes[first..first + joint.cells.fluxes()];
                first += joint.cells.fluxes();
                let sides = [0, 1].map(|side| {
                    [0, 1].map(|stage| joint.values(side, &temperatures[stage][2 * n + side]))
                });
                let of_stage = |stage: usize| {
                    let [from, to] = [0, 1].map(|side| &sides[side][stage]);
                    let differences: Vec<f64> = from.iter().zip(to).map(|(a, b)| a - b).collect();
                    joint.cells.means(&differences)
                };
                let means = [of_stage(0), of_stage(1)];
                let conducted =
                    |s: usize, place: usize| joint.conductance * means[s][place] - own[place][s];
                let off: Vec<[f64; 2]> =
                    (0..own.len()).map(|place| [0, 1].map(|s| conducted(s, place))).collect();
                let hottest = sides.as_flattened().iter().flatten().fold(0.0_f64, |m, t| m.max(*t));
                let rounding = joint.conductance * (ROUNDING * hottest).max(noise);
                for (off, corrected) in off.iter().zip(corrections[n].apply(&off)) {
                    // Not `>`, with which NaN would count as settled.
                    is_settled &= (0..2).all(|s| {
                        corrected[s].abs() <= TOLERANCE * largest || off[s].abs() <= rounding
                    });
                    wrong.push(corrected);
                }
            }
            if !wrong.as_flattened().iter().all(|flux| flux.is_finite()) {
                break;
            }
            if is_settled {
                return Ok(passed);
            }
            let left = wrong.as_flattened().iter().fold(0.0_f64, |m, q| m.max(q.abs())) / largest;
            if best.as_ref().is_none_or(|(least, _)| left < *least) {
                best = Some((left, passed));
            }
            let next = anderson.next(fluxes.as_flattened(), wrong.as_flattened());
            fluxes = next.as_chunks().0.to_vec();
        }
        if let Some((_, passed)) = best.filter(|(left, _)| *left <= GOOD_ENOUGH) {
            return Ok(passed);
        }
        let sides = joints[0].sides.each_ref().map(|side| self.bodies[side.body].name().to_owned());
        Err(BodyError::Contact { sides })
    }

    /// Largest error of temperatures of bodies in a group [K].
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

    /// Returns the transfers through all joints at one moment, as if they lasted for a second.
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
            let differences: Vec<f64> = from.iter().zip(&to).map(|(from, to)| from - to).collect();
            let means = joint.cells.means(&differences).into_iter();
            let fluxes: Fluxes = means.map(|mean| [joint.conductance * mean; 2]).collect();
            passed.extend(exchanges(&[joint], &fluxes, 1.0));
        }
        Ok(passed)
    }
}

/// Returns the transfers to the bodies on both sides of joints for these fluxes.
fn exchanges(joints: &[&Joint], fluxes: &[[f64; 2]], dt: f64) -> Vec<Exchange> {
    let mut first = 0;
    let mut all = Vec::new();
    for joint in joints {
        let own = &fluxes[first..first + joint.cells.fluxes()];
        first += joint.cells.fluxes();
        let stage =
            |s: usize| joint.cells.spread(&own.iter().map(|flux| flux[s]).collect::<Vec<_>>());
        let both = stage(0).into_iter().zip(stage(1)).zip(&joint.cells.areas);
        // For a flux that is linear through its values at the stages: the mean, and the initial excess over the mean.
        let (heat, falling): (Vec<f64>, Vec<f64>) = both
            .map(|((early, late), area)| {
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

/// Correction of a joint's fluxes from their residuals: the inverse of `1 + h R`, where R is the rise of both sides at
/// the stages per flux. A flux that varies along the face like a mode of wave number κ causes the rise of a uniform
/// one, with decay rates λ + aκ² instead of λ. This is exact for bodies that end at the contact.
struct Correction<'a> {
    joint: &'a Joint,
    /// Inverse for each mode along the cells.
    inverses: Vec<[[f64; 2]; 2]>,
}

impl<'a> Correction<'a> {
    fn of(joint: &'a Joint, dt: f64) -> Self {
        let inverses = joint.modes.decay.iter().map(|&decay| inverse(joint, decay, dt)).collect();
        Self { joint, inverses }
    }

    /// Returns the correction to be added to the fluxes.
    fn apply(&self, off: &[[f64; 2]]) -> Fluxes {
        let modes = &self.joint.modes;
        let of_stage = |stage: usize| {
            let values: Vec<f64> = off.iter().map(|off| off[stage]).collect();
            modes.amplitudes(&values)
        };
        let [early, late] = [of_stage(0), of_stage(1)];
        let pairs = self.inverses.iter().zip(early.into_iter().zip(late));
        let (early, late): (Vec<f64>, Vec<f64>) = pairs
            .map(|([first, second], (x, y))| {
                (first[0] * x + first[1] * y, second[0] * x + second[1] * y)
            })
            .unzip();
        let [early, late] = [modes.values(&early), modes.values(&late)];
        early.into_iter().zip(late).map(|(early, late)| [early, late]).collect()
    }
}

fn inverse(joint: &Joint, decay: f64, dt: f64) -> [[f64; 2]; 2] {
    let mut matrix = [[1.0, 0.0], [0.0, 1.0]];
    for side in &joint.sides {
        let SurfaceResponse { rates, gains } = &side.response;
        let response = SurfaceResponse {
            rates: rates.iter().map(|rate| rate + side.diffusivity * decay).collect(),
            gains: gains.clone(),
        };
        for (row, stage) in matrix.iter_mut().zip(STAGES) {
            let time = stage * dt;
            let held = response.of_held_flux(time);
            let falling = held - 2.0 / dt * response.of_growing_flux(time);
            // The mean is ¾ and ¼ of the fluxes at the stages; the falling part is ¾ of their difference.
            row[0] += joint.conductance * 0.75 * (held + falling);
            row[1] += joint.conductance * (0.25 * held - 0.75 * falling);
        }
    }
    let [[a, b], [c, d]] = matrix;
    let determinant = a * d - b * c;
    [[d, -b], [-c, a]].map(|row| row.map(|entry| entry / determinant))
}
