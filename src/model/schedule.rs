//! Order in which bodies advance, and exchanges between linked bodies.

use std::borrow::Cow;

use super::joints::{Beginning, Extent, Settled};
use super::{Cache, Model, ModelError, State};
use crate::body::{Acts, BodyError, Given, Link, MOST_PARTS, Received};
use crate::inputs::InputPath;
use crate::port::Surface;
use crate::runtime::allowance::Allowance;
use crate::scene::FaceName;

/// Bodies that advance together because of links or joints, or a single body.
pub struct Group {
    /// Places of the bodies.
    pub(super) bodies: Vec<usize>,
    /// Places of the links.
    links: Vec<usize>,
    /// Places of the joints.
    pub(super) joints: Vec<usize>,
}

impl Group {
    /// Groups bodies by links and by pairs of bodies.
    pub fn all(bodies: usize, links: &[Link], joints: &[[usize; 2]]) -> Vec<Self> {
        let mut of: Vec<usize> = (0..bodies).collect();
        for [from, to] in links.iter().map(|link| [link.from, link.to]).chain(joints.to_vec()) {
            let (old, new) = (of[from], of[to]);
            of.iter_mut().filter(|group| **group == old).for_each(|group| *group = new);
        }
        let group = |number: usize| Self {
            bodies: (0..bodies).filter(|&body| of[body] == number).collect(),
            links: (0..links.len()).filter(|&link| of[links[link].from] == number).collect(),
            joints: (0..joints.len()).filter(|&joint| of[joints[joint][0]] == number).collect(),
        };
        (0..bodies).map(group).filter(|group| !group.bodies.is_empty()).collect()
    }
}

/// Transfer to a body through one of its faces.
pub(super) struct Exchange {
    pub body: usize,
    pub face: FaceName,
    pub given: Given,
}

impl Exchange {
    /// Returns the transfers to one body.
    pub fn with<'a>(
        exchanges: impl IntoIterator<Item = &'a Self>,
        body: usize,
    ) -> Vec<Received<'a>> {
        let own = exchanges.into_iter().filter(|exchange| exchange.body == body);
        own.map(|exchange| Received { face: exchange.face, given: &exchange.given }).collect()
    }
}

/// A part of a step for a group: the inputs from its beginning on, and its length [s].
pub(super) type Part<'a> = (&'a InputPath, f64);

/// Shortest part, over the step, of a step that is cut at the moments bodies ask for.
const SHORTEST: f64 = 1e-6;

impl Model {
    /// Advances all bodies by `dt` [s] under inputs that follow a path.
    ///
    /// Linked bodies advance in turn over each part of the step: first the upper one, with the temperatures of the face
    /// below during that part, then the lower one, with the heat and force that it receives. All heat that leaves one
    /// body enters the other, and the time error is of first order in the parts.
    pub(super) fn advance(
        &self,
        states: &mut [Vec<f64>],
        cache: &mut Cache,
        (path, dt): Part,
        allowance: &Allowance,
    ) -> Result<(), ModelError> {
        let mut groups = self.schedule.iter();
        let advanced = groups
            .try_for_each(|group| self.advance_group(group, states, cache, (path, dt), allowance));
        Ok(advanced?)
    }

    /// Returns the transfers through all links during the last step.
    pub(super) fn through_links(&self, state: &State) -> Vec<Exchange> {
        let given = self.links.iter().filter_map(|link| {
            let given = self.bodies[link.from].given(&state.bodies[link.from])?;
            Some(Exchange { body: link.to, face: link.face, given })
        });
        given.collect()
    }

    fn advance_group(
        &self,
        group: &Group,
        states: &mut [Vec<f64>],
        cache: &mut Cache,
        (path, dt): Part,
        allowance: &Allowance,
    ) -> Result<(), BodyError> {
        for &body in &group.bodies {
            self.bodies[body].foresee(&states[body], dt, allowance)?;
        }
        let of_links = group.links.iter().map(|&link| self.links[link].parts(dt));
        let of_joints = group.joints.iter().map(|&joint| self.joints[joint].parts(dt));
        let parts = of_links.chain(of_joints).max().unwrap_or(1);
        // Bodies whose own exchanges cut the step ask for no moments.
        let is_asked = |link: &&usize| self.links[**link].parts(dt) == 1;
        let asked: Vec<usize> = group.links.iter().filter(is_asked).copied().collect();
        let moments = self.cut(&asked, states, (path, dt)).len() - 1;
        self.foresee_exchanges(group, states, (dt, parts + moments), allowance)?;
        let mut start = 0.0;
        for _ in 0..parts {
            let rest = rest_of(path, start);
            for length in self.cut(&asked, states, (&rest, dt / parts as f64)) {
                self.advance_over(group, states, cache, (path, start, length), allowance)?;
                start += length;
            }
        }
        Ok(())
    }

    /// Advances from a time after the beginning of a path on, over a length [s].
    ///
    /// Solids in contact exchange as seldom as the error of their exchanges allows, but at least as often as
    /// [`ladder`](Self::ladder) has parts where it does not. Fluids on such solids leave no part to be taken again, so
    /// there the parts are those of the ladder.
    fn advance_over(
        &self,
        group: &Group,
        states: &mut [Vec<f64>],
        cache: &mut Cache,
        (path, begin, length): (&InputPath, f64, f64),
        allowance: &Allowance,
    ) -> Result<(), BodyError> {
        let ladder = self.ladder(group, length);
        let is_free = !group.joints.is_empty() && group.links.is_empty();
        let (mut start, mut wanted, mut allowed) = (0.0, length, None);
        let mut least = ladder.iter().copied();
        while start < length {
            let left = length - start;
            let least = least.next().unwrap_or(left).min(left);
            let rest = rest_of(path, begin + start);
            let from = &*rest;
            let tried = if is_free { fitting(wanted.max(least), left) } else { least };
            let beginning = self.beginning(group, states, cache, from, allowance)?;
            let allowed = *allowed.get_or_insert(beginning.allowed);
            let mut extent = Extent { tried, least, allowed, is_sudden: tried <= least };
            let error = loop {
                let part = (from, extent.tried);
                match self.advance_part(
                    group,
                    states,
                    cache,
                    part,
                    (&extent, &beginning),
                    allowance,
                )? {
                    Ok(error) => break error,
                    Err(shorter) => extent = Extent { tried: shorter, is_sudden: true, ..extent },
                }
            };
            let taken = extent.tried;
            start = if taken == left { length } else { start + taken };
            wanted = taken * extent.growth(error);
        }
        Ok(())
    }

    /// Parts of a part of a step at whose ends the transfers of the upper bodies of these links are evaluated.
    fn cut(&self, links: &[usize], states: &[Vec<f64>], (path, dt): Part) -> Vec<f64> {
        let above = links.iter().map(|&link| self.links[link].from);
        let moments = above.flat_map(|body| self.bodies[body].moments(&states[body], path, dt));
        let mut moments: Vec<f64> = moments.collect();
        moments.sort_by(f64::total_cmp);
        // With many moments, as under a printer in a long step, only those that are further apart.
        let apart = if moments.len() < MOST_PARTS { SHORTEST } else { 1.0 / MOST_PARTS as f64 };
        let (mut parts, mut start) = (Vec::new(), 0.0);
        for moment in moments {
            if moment - start > apart * dt && dt - moment > apart * dt {
                parts.push(moment - start);
                start = moment;
            }
        }
        parts.push(dt - start);
        parts
    }

    /// Least lengths of successive parts of a part of a step: one, or growing ones if solids in contact might overshoot
    /// equilibrium.
    fn ladder(&self, group: &Group, part: f64) -> Vec<f64> {
        let halvings = group.joints.iter().map(|&joint| self.joints[joint].halvings(part));
        let halvings = halvings.max().unwrap_or(0);
        let first = part / (halvings as f64).exp2();
        let grown = (0..halvings).map(|n| first * (n as f64).exp2());
        std::iter::once(first).chain(grown).collect()
    }

    fn foresee_exchanges(
        &self,
        group: &Group,
        states: &[Vec<f64>],
        (dt, parts): (f64, usize),
        allowance: &Allowance,
    ) -> Result<(), BodyError> {
        let of_links = group.links.iter().map(|&link| self.links[link].to);
        let of_joints = group.joints.iter().map(|&joint| self.joints[joint].sides[1].body);
        for below in of_links.chain(of_joints) {
            let size = states[below].len();
            let what = "exchanges between bodies";
            let foreseen = allowance.foresee_step(dt, parts as f64, what, size);
            let body = || self.bodies[below].name().to_owned();
            foreseen.map_err(|halt| BodyError::Halted { body: body(), halt })?;
        }
        Ok(())
    }

    /// Advances over a part of a step, and returns the error of its exchanges, see [`Settled`]; or, having changed
    /// nothing, the length of a shorter part to be tried instead.
    fn advance_part(
        &self,
        group: &Group,
        states: &mut [Vec<f64>],
        cache: &mut Cache,
        part: Part,
        (extent, beginning): (&Extent, &Beginning),
        allowance: &Allowance,
    ) -> Result<Result<f64, f64>, BodyError> {
        let surfaces = self.surfaces(group, states, cache, part, allowance)?;
        let below = |body: usize| {
            let place = group.links.iter().position(|&link| self.links[link].from == body)?;
            Some(&surfaces[place])
        };
        // Upper bodies advance first.
        let is_above = |&&body: &&usize| below(body).is_some();
        let mut given: Vec<(usize, Given)> = Vec::new();
        for &body in group.bodies.iter().filter(is_above) {
            let acts = acts(part, &[], below(body));
            let state = &mut states[body];
            let gave = self.bodies[body].advance(state, cache.memo(body), &acts, allowance)?;
            given.extend(gave.map(|gave| (body, gave)));
        }
        let mut exchanges: Vec<Exchange> = (given.into_iter())
            .filter_map(|(from, given)| {
                let link = self.links.iter().find(|link| link.from == from)?;
                Some(Exchange { body: link.to, face: link.face, given })
            })
            .collect();
        let joints = (group, extent, beginning);
        let settled = self.settle_joints(joints, states, cache, part, &exchanges, allowance)?;
        let Settled { passed, error } = match settled {
            Ok(settled) => settled,
            Err(shorter) => return Ok(Err(shorter)),
        };
        exchanges.extend(passed);
        for &body in group.bodies.iter().filter(|body| !is_above(body)) {
            let received = Exchange::with(&exchanges, body);
            let acts = acts(part, &received, None);
            self.bodies[body].advance(&mut states[body], cache.memo(body), &acts, allowance)?;
        }
        Ok(Ok(error))
    }

    /// Returns the faces below over a part of a step without received heat, one for each link of a group.
    fn surfaces(
        &self,
        group: &Group,
        states: &[Vec<f64>],
        cache: &mut Cache,
        part: Part,
        allowance: &Allowance,
    ) -> Result<Vec<Surface>, BodyError> {
        let of_links = group.links.iter().map(|&link| (self.links[link].to, self.links[link].face));
        let faces: Vec<_> = of_links.collect();
        let mut surfaces = vec![Surface::default(); faces.len()];
        for &body in &group.bodies {
            let on_it: Vec<_> =
                faces.iter().enumerate().filter(|(_, (other, _))| *other == body).collect();
            let Some(conductor) = self.bodies[body].conductor().filter(|_| !on_it.is_empty())
            else {
                continue;
            };
            let faces: Vec<FaceName> = on_it.iter().map(|(_, (_, face))| *face).collect();
            let (state, acts) = (&states[body], acts(part, &[], None));
            let found = conductor.surfaces(state, cache.memo(body), &faces, &acts, allowance)?;
            on_it.iter().zip(found).for_each(|((place, _), surface)| surfaces[*place] = surface);
        }
        Ok(surfaces)
    }
}

/// Remainder of a path from a time after its beginning on [s].
fn rest_of(path: &InputPath, start: f64) -> Cow<'_, InputPath> {
    match path.is_held() || start == 0.0 {
        true => Cow::Borrowed(path),
        false => Cow::Owned(path.from(start)),
    }
}

/// Returns the wanted length of a part within the remaining one, so that no remainder is much shorter than it [s].
fn fitting(wanted: f64, left: f64) -> f64 {
    match wanted {
        long if long >= left * (1.0 - 1e-9) => left,
        long if 2.0 * long > left => 0.5 * left,
        short => short,
    }
}

pub(super) fn acts<'a>(
    (path, duration): Part<'a>,
    received: &'a [Received<'a>],
    below: Option<&'a Surface>,
) -> Acts<'a> {
    Acts { path, duration, received, below }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn links_join_bodies_into_groups() {
        let face = FaceName::Top;
        let link = |from, to| Link { from, to, face, interval: 1.0, traction: true };
        let groups = Group::all(8, &[link(0, 3), link(5, 3), link(1, 2)], &[[3, 6]]);
        let found: Vec<_> = groups.iter().map(|g| (g.bodies.clone(), g.links.clone())).collect();
        let wanted = [
            (vec![1, 2], vec![2]),
            (vec![4], vec![]),
            (vec![0, 3, 5, 6], vec![0, 1]),
            (vec![7], vec![]),
        ];
        assert_eq!(found, wanted);
    }
}
