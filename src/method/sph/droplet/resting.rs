//! Heat of fluid at rest, which takes no part in steps of the flow.
//!
//! The wall exchanges heat with it in each of these steps, as with all fluid. Conduction within it and to the fluid
//! that is held beside it, and its heat to the air, follow for the time by which the flow has advanced, in explicit
//! steps. Each pair of particles counts once, in the flow or here, so that heat is conserved; the split has the first
//! order of that time, which is at most a step of conduction: fluid at the wall that waits longer is as cold as that.

use super::{DropletSph, Run};
use crate::method::sph::cloud::Cloud;
use crate::method::sph::failure::Failure;
use crate::method::sph::feed::ASLEEP;
use crate::method::sph::neighbours::{Displacements, Neighbours};
use crate::method::sph::order::space_order;
use crate::method::sph::resting_heat::RestingHeat;
use crate::method::sph::stepper::conducting;
use crate::method::sph::wall_heat::Touching;

impl DropletSph {
    /// Longest time for which the flow may advance before heat of fluid outside its cloud does [s].
    pub(super) fn longest_part(&self, rest: &Cloud) -> f64 {
        match rest.len() > 0 && self.method.conduction > 0.0 {
            true => self.method.conductive_step() * self.method.units.time(),
            false => f64::INFINITY,
        }
    }

    /// Names fluid outside the cloud of a run to the wall that it touches.
    pub(super) fn lay_on_wall(&self, run: &mut Run, rest: &Cloud) {
        let (Some(points), Some(heat)) = (&mut run.points, &self.method.wall_heat) else { return };
        let contents = rest.contents();
        let touching = (0..rest.len()).filter_map(|particle| {
            let share = heat.share(rest.position[particle][2]);
            (share > 0.0).then(|| Touching {
                particle,
                at: self.method.place(rest.position[particle]),
                share,
                mass: rest.mass[particle],
                content: contents[particle],
                initial: rest.initial[particle],
            })
        });
        points.resting = touching.collect();
    }

    /// Changes the heat of fluid outside the cloud of a run, and of that held beside it, over a time [s] by which the
    /// flow has advanced.
    pub(super) fn warm_resting(
        &self,
        run: &mut Run,
        rest: &mut Cloud,
        duration: f64,
    ) -> Result<(), Failure> {
        if rest.len() == 0 || self.method.conduction == 0.0 {
            return Ok(());
        }
        let phases = self.method.phases.as_ref();
        for Touching { particle, content, initial, .. } in
            run.points.iter_mut().flat_map(|points| std::mem::take(&mut points.resting))
        {
            rest.heat(particle, content - rest.contents()[particle], phases);
            rest.initial[particle] = initial;
        }
        let all = duration / self.method.units.time();
        if let Some(cooling) = &self.method.cooling {
            let time = run.ledger.time;
            let air = run.air.mean([time - duration, time]);
            cooling.act(&self.method, rest, &mut run.ledger, (all, air));
        }
        let beside = held_beside(&run.cloud);
        let place = |n: usize| match n.checked_sub(rest.len()) {
            None => rest.position[n],
            Some(n) => run.cloud.position[beside[n]],
        };
        let places: Vec<_> = (0..rest.len() + beside.len()).map(place).collect();
        let order = space_order(&places, &run.team);
        let places: Vec<_> = order.iter().map(|&n| places[n as usize]).collect();
        let mut neighbours = Neighbours::of(&places, &run.team);
        neighbours.prepare(
            &places,
            &Displacements::none(places.len()),
            &self.method.images,
            &run.team,
        );
        if let Some(at) = neighbours.crowded() {
            let at = at.map(|x| x * self.method.units.length);
            return Err(Failure::Crowded { at, time: run.ledger.time });
        }
        let steps = (all / self.method.conductive_step()).ceil().max(1.0);
        for _ in 0..steps as usize {
            self.conduct(run, rest, (&order, &beside, &neighbours), all / steps);
        }
        Ok(())
    }

    /// Conducts heat in a step of a time over H/c₀: `order` numbers the particles of `rest`, then those of the run's
    /// cloud `beside`, as their `neighbours` do.
    fn conduct(
        &self,
        run: &mut Run,
        rest: &mut Cloud,
        (order, beside, neighbours): (&[u32], &[usize], &Neighbours),
        dt: f64,
    ) {
        let method = &self.method;
        let phases = method.phases.as_ref();
        let cloud = &mut run.cloud;
        let records: Vec<_> = (order.iter())
            .map(|&n| {
                let (from, i, left) = match (n as usize).checked_sub(rest.len()) {
                    None => (&*rest, n as usize, 1.0),
                    Some(n) => (&*cloud, beside[n], 0.0),
                };
                let [x, y, z] = from.position[i];
                let potential = match phases {
                    Some(phases) => phases.potential(from.contents()[i]),
                    None => from.temperature[i],
                };
                [x, y, z, left, 0.0, 0.0, from.volume(i), potential]
            })
            .collect();
        let conduction = method.conduction / conducting(method, &cloud.moment);
        let pass = RestingHeat {
            images: &method.images,
            records: &records,
            scale: 2.0 * conduction * method.normalisation,
        };
        let rates = pass.rates(&neighbours.blocks, method.pairs(), &run.team);
        for (&n, rate) in order.iter().zip(rates) {
            let (into, i) = match (n as usize).checked_sub(rest.len()) {
                None => (&mut *rest, n as usize),
                Some(n) => (&mut *cloud, beside[n]),
            };
            into.heat(i, dt * rate / (1.0 + into.density[i]), phases);
        }
    }
}

/// Returns the numbers of the particles at rest in the cloud of a run.
fn held_beside(cloud: &Cloud) -> Vec<usize> {
    let Some(origin) = &cloud.origin else { return Vec::new() };
    (0..cloud.len()).filter(|&i| origin.hold[i] == ASLEEP).collect()
}
