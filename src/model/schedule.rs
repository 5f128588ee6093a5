//! In which order bodies advance, and how often those that are linked meet.

use super::{Cache, Model, ModelError};
use crate::body::{Acts, BodyError, Given, Link, Received};
use crate::inputs::InputPath;
use crate::math::allowance::Allowance;
use crate::math::thread::aside;
use crate::method::sph::Surface;

/// Bodies that advance together because links join them, or one alone.
pub struct Group {
    /// Places of the bodies.
    bodies: Vec<usize>,
    /// Places of the links.
    links: Vec<usize>,
}

impl Group {
    /// Joins so many bodies by links.
    pub fn all(bodies: usize, links: &[Link]) -> Vec<Self> {
        let mut of: Vec<usize> = (0..bodies).collect();
        for link in links {
            let (old, new) = (of[link.from], of[link.to]);
            of.iter_mut().filter(|group| **group == old).for_each(|group| *group = new);
        }
        let group = |number: usize| Self {
            bodies: (0..bodies).filter(|&body| of[body] == number).collect(),
            links: (0..links.len()).filter(|&link| of[links[link].from] == number).collect(),
        };
        (0..bodies).map(group).filter(|group| !group.bodies.is_empty()).collect()
    }
}

/// A part of a step for a group: the inputs from its beginning on, and its length [s].
type Part<'a> = (&'a InputPath, f64);

impl Model {
    /// Advances all bodies by `dt` [s] under inputs that follow a path.
    ///
    /// Bodies that are linked take turns: over each part of the step the one above advances above the temperatures
    /// that the face below has meanwhile, then the one below under the heat and force that it got. So all heat that
    /// leaves the one enters the other, and the time error is of first order in the parts.
    pub(super) fn advance(
        &self,
        states: &mut [Vec<f64>],
        cache: &mut Cache,
        (path, dt): Part,
        allowance: &Allowance,
    ) -> Result<(), ModelError> {
        let mut all = || {
            let groups = self.schedule.iter();
            groups
                .map(|group| self.advance_group(group, states, cache, (path, dt), allowance))
                .collect::<Result<(), BodyError>>()
        };
        let advanced = match self.bodies.iter().any(|body| body.steps_are_deep()) {
            true => aside(all),
            false => all(),
        };
        Ok(advanced?)
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
        let parts = group.links.iter().map(|&link| self.links[link].parts(dt)).max().unwrap_or(1);
        self.foresee_exchanges(group, states, parts, allowance)?;
        let part = dt / parts as f64;
        for n in 0..parts {
            let rest;
            let from = match path.is_held() || n == 0 {
                true => path,
                false => {
                    rest = path.from(n as f64 * part);
                    &rest
                }
            };
            self.advance_part(group, states, cache, (from, part), allowance)?;
        }
        Ok(())
    }

    fn foresee_exchanges(
        &self,
        group: &Group,
        states: &[Vec<f64>],
        parts: usize,
        allowance: &Allowance,
    ) -> Result<(), BodyError> {
        for &link in &group.links {
            let below = self.links[link].to;
            let size = states[below].len();
            let foreseen = allowance.foresee(parts as f64, "exchanges between bodies", size);
            let body = || self.bodies[below].name().to_owned();
            foreseen.map_err(|halt| BodyError::Halted { body: body(), halt })?;
        }
        Ok(())
    }

    fn advance_part(
        &self,
        group: &Group,
        states: &mut [Vec<f64>],
        cache: &mut Cache,
        part: Part,
        allowance: &Allowance,
    ) -> Result<(), BodyError> {
        let surfaces = self.surfaces(group, states, cache, part, allowance)?;
        let below = |body: usize| {
            let place = group.links.iter().position(|&link| self.links[link].from == body)?;
            Some(&surfaces[place])
        };
        // Those that stand on others give first.
        let is_above = |&&body: &&usize| below(body).is_some();
        let mut given: Vec<(usize, Given)> = Vec::new();
        for &body in group.bodies.iter().filter(is_above) {
            let acts = acts(part, &[], below(body));
            let state = &mut states[body];
            let gave = self.bodies[body].advance(state, cache.memo(body), &acts, allowance)?;
            given.extend(gave.map(|gave| (body, gave)));
        }
        for &body in group.bodies.iter().filter(|body| !is_above(body)) {
            let received: Vec<Received> = (given.iter())
                .filter_map(|(from, given)| {
                    let link = self.links.iter().find(|link| link.from == *from)?;
                    (link.to == body).then_some(Received { port: link.port, given })
                })
                .collect();
            let acts = acts(part, &received, None);
            self.bodies[body].advance(&mut states[body], cache.memo(body), &acts, allowance)?;
        }
        Ok(())
    }

    /// The faces below over a part of a step if nothing is given to them, one for each link of a group.
    fn surfaces(
        &self,
        group: &Group,
        states: &[Vec<f64>],
        cache: &mut Cache,
        part: Part,
        allowance: &Allowance,
    ) -> Result<Vec<Surface>, BodyError> {
        let mut surfaces = vec![Surface::default(); group.links.len()];
        for &body in &group.bodies {
            let links = group.links.iter().map(|&link| &self.links[link]).enumerate();
            let on_it: Vec<_> = links.filter(|(_, link)| link.to == body).collect();
            let Some(conductor) = self.bodies[body].conductor().filter(|_| !on_it.is_empty())
            else {
                continue;
            };
            let ports: Vec<usize> = on_it.iter().map(|(_, link)| link.port).collect();
            let (state, acts) = (&states[body], acts(part, &[], None));
            let found = conductor.surfaces(state, cache.memo(body), &ports, &acts, allowance)?;
            on_it.iter().zip(found).for_each(|((place, _), surface)| surfaces[*place] = surface);
        }
        Ok(surfaces)
    }
}

fn acts<'a>(
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
        let link = |from, to| Link { from, to, port: 0, interval: 1.0, traction: true };
        let groups = Group::all(6, &[link(0, 3), link(5, 3), link(1, 2)]);
        let found: Vec<_> = groups.iter().map(|g| (g.bodies.clone(), g.links.clone())).collect();
        let wanted = [(vec![1, 2], vec![2]), (vec![0, 3, 5], vec![0, 1]), (vec![4], vec![])];
        assert_eq!(found, wanted);
    }
}
