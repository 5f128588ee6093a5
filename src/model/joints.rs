//! Heat transfer between solids in contact.

use super::schedule::{Exchange, Group, Part, acts};
use super::{Cache, Model};
use crate::body::{BodyError, Given, Joint};
use crate::inputs::InputPath;
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
/// The same after a number of iterations, above that of contacts without noise.
const LOUD_NOISE: f64 = 1.0;
const PATIENCE: usize = 10;
/// Upper limit of iterations, above the number that any contact needed.
const MOST_ITERATIONS: usize = 100;

/// Error allowed for exchanges, over the scene's tolerance and the differences between faces in contact at the
/// beginning of a step; and, where these vanish, over the temperatures.
const OF_TOLERANCE: f64 = 0.1;
const ROUGH: f64 = 1e-6;
/// Ratio of the predicted error of a part to the allowed one beyond which its fluxes are not settled at all.
const HOPELESS: f64 = 4.0;
/// Target error of a part over the allowed one, and limits of the ratio of the lengths of successive parts.
const AIM: f64 = 0.9;
const SHRINK: f64 = 0.02;
const GROWTH: f64 = 8.0;
/// Ratio of the lengths of successive parts of which the first has no solution.
const RETREAT: f64 = 0.1;

/// Two fluxes at each place of each joint [W/m²].
type Fluxes = Vec<[f64; 2]>;

/// Length of a part of a step whose exchanges are to be settled.
#[derive(Debug, Clone, Copy)]
pub(super) struct Extent {
    /// [s]
    pub tried: f64,
    /// Length that is accepted whatever its error is [s].
    pub least: f64,
    /// Error allowed for temperatures [K].
    pub allowed: f64,
    /// True if fluxes may change by much over it: it is the least part, or longer ones have shown it.
    pub is_sudden: bool,
}

impl Extent {
    fn is_least(&self) -> bool {
        self.tried <= self.least
    }

    /// Length to be tried after a part with an error that is not allowed [s].
    fn shorter(&self, error: f64) -> f64 {
        // The error hardly depends on the length of a part that is far too long, so that no power of it is used. After
        // NaN comes the least length.
        let ratio = (0.5 * self.allowed / error).clamp(SHRINK, 0.5);
        (ratio * self.tried).max(self.least)
    }

    /// Length to be tried after a part without a solution [s].
    fn retreat(&self) -> f64 {
        (RETREAT * self.tried).max(self.least)
    }

    /// Ratio of the length of the next part to that of one with this error, which grows as the third power.
    pub fn growth(&self, error: f64) -> f64 {
        (AIM * (self.allowed / error).cbrt()).min(GROWTH)
    }
}

/// Joints at the beginning of a part of a step.
pub(super) struct Beginning {
    /// Fluxes of the contact law [W/m²].
    fluxes: Vec<f64>,
    /// Error allowed for temperatures over a step that begins here [K].
    pub allowed: f64,
}

/// Transfers through joints over a part of a step.
pub(super) struct Settled {
    pub passed: Vec<Exchange>,
    /// Estimated error of temperatures [K].
    pub error: f64,
}

/// Accepts settled fluxes of a part, unless the error is larger than allowed for one that may be shorter.
fn accept(
    joints: &[&Joint],
    extent: &Extent,
    beginning: &Beginning,
    (fluxes, dt): (Fluxes, f64),
) -> Result<Settled, f64> {
    let error = error(joints, beginning, (&fluxes, dt));
    if error <= extent.allowed || extent.is_least() {
        return Ok(Settled { passed: exchanges(joints, &fluxes, dt), error });
    }
    Err(extent.shorter(error))
}

/// Estimates the error of temperatures at the end of a part of `dt` [s] with these fluxes [K].
fn error(joints: &[&Joint], beginning: &Beginning, (fluxes, dt): (&Fluxes, f64)) -> f64 {
    let mut places = beginning.fluxes.iter().zip(fluxes);
    let mut error = 0.0;
    for joint in joints {
        let factor = joint.error(dt);
        for (law, [early, late]) in places.by_ref().take(joint.cells.fluxes()) {
            // The line through the stages, extended to the beginning.
            let off = factor * (law - (1.5 * early - 0.5 * late)).abs();
            // Not `max`, which ignores NaN.
            error = if off <= error { error } else { off };
        }
    }
    error
}

impl Model {
    /// Computes the transfers through all joints of a group over a part of a step, before anything has advanced.
    /// `others` holds the transfers from elsewhere. The result is the length of a shorter part instead if the part is
    /// too long: the change of fluxes over it is not linear, see [`Joint::error`].
    ///
    /// The contact law holds exactly between the bodies as they are at the stages, whatever their internal conduction.
    /// Iterations correct the fluxes as if both bodies ended at the contact. In long parts they begin with
    /// the fluxes of the contact law, so that hardly any are needed where fluxes hardly change.
    pub(super) fn settle_joints(
        &self,
        (group, extent, beginning): (&Group, &Extent, &Beginning),
        states: &[Vec<f64>],
        cache: &mut Cache,
        (path, dt): Part,
        others: &[Exchange],
        allowance: &Allowance,
    ) -> Result<Result<Settled, f64>, BodyError> {
        let joints: Vec<&Joint> = group.joints.iter().map(|&joint| &self.joints[joint]).collect();
        if joints.is_empty() {
            return Ok(Ok(Settled { passed: Vec::new(), error: 0.0 }));
        }
        let corrections: Vec<_> = joints.iter().map(|joint| Correction::of(joint, dt)).collect();
        let mut fluxes: Fluxes = beginning.fluxes.iter().map(|&flux| [flux; 2]).collect();
        if extent.is_sudden {
            // The fluxes between bodies that end at the contact, at rest until now.
            let mut rest = &fluxes[..];
            let corrected = joints.iter().zip(&corrections).flat_map(|(joint, correction)| {
                let (own, others) = rest.split_at(joint.cells.fluxes());
                rest = others;
                correction.apply(own)
            });
            fluxes = corrected.collect();
        }
        let places = fluxes.len();
        let mut anderson = Anderson::default();
        let mut best: Option<(f64, Fluxes)> = None;
        let tolerance = self.tolerance_of(group);
        let mut is_first = true;
        for iteration in 0..MOST_ITERATIONS {
            let noise = if iteration < PATIENCE { NOISE } else { LOUD_NOISE } * tolerance;
            let passed = exchanges(&joints, &fluxes, dt);
            let all: Vec<&Exchange> = others.iter().chain(&passed).collect();
            let mut wrong: Fluxes = Vec::with_capacity(places);
            let mut is_settled = true;
            allowance.note_exchange();
            let found = self.at_times(group, states, cache, (path, dt), (&STAGES, &all), allowance);
            let temperatures = match found {
                Ok(found) => found,
                Err(halted @ BodyError::Halted { .. }) => return Err(halted),
                // Fluxes far beyond any solution.
                Err(_) if !extent.is_least() => return Ok(Err(extent.retreat())),
                Err(_) if is_first => {
                    is_first = false;
                    fluxes.fill([0.0; 2]);
                    continue;
                }
                Err(error) => return Err(error),
            };
            let largest = fluxes.as_flattened().iter().fold(0.0_f64, |m, q| m.max(q.abs()));
            let mut first = 0;
            for (n, joint) in joints.iter().enumerate() {
                let own = &fluxes[first..first + joint.cells.fluxes()];
                first += joint.cells.fluxes();
                let sides = [0, 1].map(|side| {
                    [0, 1].map(|stage| joint.values(side, &temperatures[stage][2 * n + side]))
                });
                let means =
                    [0, 1].map(|stage| joint.means(sides.each_ref().map(|of| &of[stage][..])));
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
                return Ok(accept(&joints, extent, beginning, (fluxes, dt)));
            }
            if is_first && !extent.is_least() {
                let predicted: Fluxes =
                    fluxes.iter().zip(&wrong).map(|(q, by)| [q[0] + by[0], q[1] + by[1]]).collect();
                let error = error(&joints, beginning, (&predicted, dt));
                if error.is_nan() || error > HOPELESS * extent.allowed {
                    return Ok(Err(extent.shorter(error)));
                }
            }
            is_first = false;
            let left = wrong.as_flattened().iter().fold(0.0_f64, |m, q| m.max(q.abs())) / largest;
            let next = anderson.next(fluxes.as_flattened(), wrong.as_flattened());
            if best.as_ref().is_none_or(|(least, _)| left < *least) {
                best = Some((left, fluxes));
            }
            fluxes = next.as_chunks().0.to_vec();
        }
        if let Some((_, fluxes)) = best.filter(|(left, _)| *left <= GOOD_ENOUGH) {
            return Ok(accept(&joints, extent, beginning, (fluxes, dt)));
        }
        if !extent.is_least() {
            return Ok(Err(extent.retreat()));
        }
        let sides = joints[0].sides.each_ref().map(|side| self.bodies[side.body].name().to_owned());
        Err(BodyError::Contact { sides })
    }

    /// Returns the joints of a group at the beginning of a part of a step.
    pub(super) fn beginning(
        &self,
        group: &Group,
        states: &[Vec<f64>],
        cache: &mut Cache,
        path: &InputPath,
        allowance: &Allowance,
    ) -> Result<Beginning, BodyError> {
        let now = self.at_times(group, states, cache, (path, 0.0), (&[0.0], &[]), allowance)?;
        let mut fluxes = Vec::new();
        let mut range = [f64::INFINITY, f64::NEG_INFINITY];
        for (n, &joint) in group.joints.iter().enumerate() {
            let joint = &self.joints[joint];
            let sides = [0, 1].map(|side| joint.values(side, &now[0][2 * n + side]));
            for t in sides.iter().flatten() {
                range = [range[0].min(*t), range[1].max(*t)];
            }
            let means = joint.means(sides.each_ref().map(|side| &side[..]));
            fluxes.extend(means.into_iter().map(|mean| joint.conductance * mean));
        }
        let relative = OF_TOLERANCE * self.scene.fidelity.tolerance * (range[1] - range[0]);
        let allowed = relative.max(ROUGH * range[1]).max(self.tolerance_of(group));
        Ok(Beginning { fluxes, allowed })
    }

    /// Largest error of temperatures of bodies in a group [K].
    fn tolerance_of(&self, group: &Group) -> f64 {
        let conductors = group.bodies.iter().filter_map(|&body| self.bodies[body].conductor());
        conductors.map(|conductor| conductor.tolerance()).fold(0.0, f64::max)
    }

    /// Temperatures of the sides of a group's joints at times of a part of a step, given over its length.
    fn at_times(
        &self,
        group: &Group,
        states: &[Vec<f64>],
        cache: &mut Cache,
        (path, dt): Part,
        (times, exchanges): (&[f64], &[&Exchange]),
        allowance: &Allowance,
    ) -> Result<Vec<Vec<Vec<f64>>>, BodyError> {
        let sides: Vec<_> =
            group.joints.iter().flat_map(|&joint| &self.joints[joint].sides).collect();
        let mut all = vec![vec![Vec::new(); sides.len()]; times.len()];
        for &body in &group.bodies {
            let own: Vec<usize> = (0..sides.len()).filter(|&n| sides[n].body == body).collect();
            let Some(conductor) = self.bodies[body].conductor().filter(|_| !own.is_empty()) else {
                continue;
            };
            let faces: Vec<_> = own.iter().map(|&n| sides[n].face).collect();
            let received = Exchange::with(exchanges.iter().copied(), body);
            for (temperatures, time) in all.iter_mut().zip(times) {
                let acts = acts((path, time * dt), &received, None);
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
        inputs: &InputPath,
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
            let means = joint.means([&from, &to]).into_iter();
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
