//! Fluid that comes from a nozzle.

use super::{DropletSph, Run};
use crate::inputs::{Motion, Trend};
use crate::method::sph::cloud::{Cloud, Ledger, cloud_of, ledger_of};
use crate::method::sph::failure::Failure;
use crate::method::sph::feed::{ASLEEP, BY_NOZZLE, Column, FREE, Fed};
use crate::method::sph::frozen::RIGID;
use crate::method::sph::plan::Feed;
use crate::port::Surface;
use crate::runtime::allowance::Allowance;
use crate::runtime::parallel::Team;
use crate::state::store;

/// Largest speed of nozzle and fluid over that of sound.
const FASTEST: f64 = 0.2;
/// Largest distance over the diameter that the nozzle moves evenly in place of its path.
const EVEN: f64 = 0.5;
/// Part of a volume that counts as rounding.
const SLACK: f64 = 1e-9;

/// Particles that have left a nozzle, and the state of that.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Laid {
    pub fed: Fed,
    /// Velocity of the column in the nozzle in the last part of a step [m/s].
    pub drive: [f64; 3],
    /// Particles outside the nozzle: places [m], velocities [m/s] and volumes at rest [m³], with the number of the
    /// layer in which each came.
    pub position: Vec<[f64; 3]>,
    pub velocity: Vec<[f64; 3]>,
    pub volume: Vec<f64>,
    pub layer: Vec<usize>,
    /// Number of them that rest, and take no part in steps.
    pub resting: usize,
}

impl DropletSph {
    /// Puts the first layers into the nozzle.
    pub(super) fn begin_feed(
        &self,
        feed: &Feed,
        ledger: &mut Ledger,
        cloud: &mut Cloud,
    ) -> Result<(), Failure> {
        ledger.fed = Some(Fed { nozzle: feed.outlet, ..Fed::default() });
        for _ in 0..self.column().layers {
            self.add_layer(ledger, cloud, [0.0; 3], feed.temperature);
        }
        self.prime(ledger, cloud)
    }

    fn column(&self) -> &Column {
        self.column.as_ref().expect("a plan with a nozzle")
    }

    /// Advances by motions of the nozzle one after the other, above a surface that responds to heat. Returns the rises
    /// of its cells due to the heat at the end [K m²]. A failure leaves the state unchanged.
    ///
    /// # Panics
    /// If the plan has no nozzle.
    pub fn advance_fed(
        &self,
        state: &mut Vec<f64>,
        motions: &[Motion],
        (surface, air): (&Surface, Trend),
        allowance: &Allowance,
    ) -> Result<Vec<f64>, Failure> {
        let duration = motions.iter().map(|motion| motion.duration).sum();
        self.advance_by(state, surface, duration, allowance, |run| {
            run.air = air.above(self.reference_temperature());
            motions.iter().try_for_each(|motion| self.follow(run, motion))
        })
    }

    /// State of the nozzle.
    pub fn fed(&self, state: &[f64]) -> Fed {
        ledger_of(state, self.head()).fed.unwrap_or_default()
    }

    /// Time of a state [s].
    pub fn time(&self, state: &[f64]) -> f64 {
        ledger_of(state, self.head()).time
    }

    /// Notes that the nozzle approaches a place that an input set without derivatives.
    pub fn note_late(&self, state: &mut [f64]) {
        let mut ledger = ledger_of(state, self.head());
        ledger.fed.iter_mut().for_each(|fed| fed.late = 1.0);
        store(&mut ledger, state);
    }

    /// The fluid that has left the nozzle.
    pub fn laid(&self, state: &[f64]) -> Laid {
        let cloud = cloud_of(state, self.head(), &Team::new(1));
        let mut laid = Laid { fed: self.fed(state), ..Laid::default() };
        let Some(origin) = &cloud.origin else { return laid };
        let units = &self.method.units;
        let held = origin.hold.iter().position(|hold| *hold == BY_NOZZLE);
        laid.drive = held.map_or([0.0; 3], |i| cloud.velocity[i].map(|v| v * units.speed));
        for i in (0..cloud.len()).filter(|&i| origin.hold[i] != BY_NOZZLE) {
            laid.position.push(cloud.position[i].map(|x| x * units.length));
            laid.velocity.push(cloud.velocity[i].map(|v| v * units.speed));
            laid.volume.push(cloud.mass[i] * units.mass() / units.density);
            laid.layer.push(origin.layer[i] as usize);
            laid.resting += usize::from(origin.hold[i] == ASLEEP);
        }
        laid
    }

    /// Returns true if fluid that comes is frozen within a distance of particles below the outlet.
    pub fn freezes_at_outlet(&self, state: &[f64]) -> bool {
        let fed = self.fed(state);
        let (Some(phases), true) = (&self.method.phases, fed.flowing == 1.0) else { return false };
        let cloud = cloud_of(state, self.head(), &Team::new(1));
        let Some(origin) = &cloud.origin else { return false };
        let outlet = fed.nozzle.map(|x| x / self.method.units.length);
        let radius =
            0.5 * self.plan.feed.map_or(0.0, |feed| feed.diameter) / self.method.units.length;
        let is_below = |[x, y, z]: [f64; 3]| {
            let down = outlet[2] - z;
            (x - outlet[0]).hypot(y - outlet[1]) < radius
                && (0.0..self.method.spacing).contains(&down)
        };
        (0..cloud.len()).any(|i| {
            let is_frozen = phases.frozen(cloud.contents()[i]) >= RIGID;
            origin.hold[i] != BY_NOZZLE && is_frozen && is_below(cloud.position[i])
        })
    }

    /// Thickness of a layer in the nozzle [m].
    pub fn layer_thickness(&self) -> f64 {
        self.column().thickness
    }

    fn follow(&self, run: &mut Run, motion: &Motion) -> Result<(), Failure> {
        let start = run.ledger.time;
        let before = fed(&mut run.ledger).clone();
        let comes = motion.volume(motion.duration) > 0.0;
        let begin = motion.outlet(0.0);
        let jump = [0, 1, 2].map(|a| begin[a] - before.nozzle[a]);
        self.shift_column(run, jump);
        let now = fed(&mut run.ledger);
        if comes && before.flowing == 1.0 {
            let way = jump.iter().map(|part| part * part).sum::<f64>().sqrt();
            now.jump = now.jump.max(way);
        }
        now.flowing = if comes { 1.0 } else { 0.0 };
        let passages = self.passages(before.volume, motion);
        for ends in passages.windows(2).filter(|ends| ends[1] > ends[0]) {
            // Too fast in the mean is too fast somewhere; too many parts to count may lie between.
            self.check_speed(self.velocity(motion, [ends[0], ends[1]]), start + ends[0])?;
        }
        for [mut from, last] in self.parts(&passages, motion) {
            while from < last {
                from = self.follow_part(run, (motion, start, before.volume), [from, last])?;
            }
        }
        Ok(())
    }

    /// Follows a motion, which began at a time [s] and after a volume [m³], from a time of it on at most to another
    /// [s]; returns the time that it reaches. The nozzle moves evenly.
    fn follow_part(
        &self,
        run: &mut Run,
        (motion, start, before): (&Motion, f64, f64),
        [from, last]: [f64; 2],
    ) -> Result<f64, Failure> {
        let mut rest = self.put_to_sleep(run);
        let count = ((last - from) / self.longest_part(&rest)).ceil();
        let to = if count > 1.0 { from + (last - from) / count } else { last };
        let velocity = self.velocity(motion, [from, to]);
        self.check_speed(velocity, run.ledger.time)?;
        self.drive_column(run, velocity, motion.temperature_at(0.5 * (from + to)));
        self.weigh(run, &rest, to - from);
        self.lay_on_wall(run, &rest);
        run.advance(to - from)?;
        self.warm_resting(run, &mut rest, to - from)?;
        run.cloud.append(rest);
        run.ledger.time = start + to;
        let now = fed(&mut run.ledger);
        (now.nozzle, now.volume) = (motion.outlet(to), before + motion.volume(to));
        self.pass_layers(run, velocity, motion.temperature_at(to));
        Ok(to)
    }

    /// Mean velocity of the column between two times of a motion [m/s].
    fn velocity(&self, motion: &Motion, [from, to]: [f64; 2]) -> [f64; 3] {
        let [begin, end] = [from, to].map(|s| motion.outlet(s));
        let volume = motion.volume(to) - motion.volume(from);
        let mut velocity = [0, 1, 2].map(|a| (end[a] - begin[a]) / (to - from));
        velocity[2] -= volume / (self.column().section * (to - from));
        velocity
    }

    /// Times of a motion at which a layer passes the outlet, with its beginning and its end [s].
    fn passages(&self, before: f64, motion: &Motion) -> Vec<f64> {
        let all = motion.volume(motion.duration);
        let mut cuts = vec![0.0];
        let mut layer = self.column().passed(before);
        while self.column().passage(layer) - before < all * (1.0 - SLACK) {
            let last = cuts[cuts.len() - 1];
            cuts.push(motion.time_of(self.column().passage(layer) - before, last));
            layer += 1;
        }
        cuts.push(motion.duration);
        cuts
    }

    /// Parts between such times in which the nozzle moves evenly.
    fn parts(&self, passages: &[f64], motion: &Motion) -> Vec<[f64; 2]> {
        let longest = EVEN * self.plan.feed.map_or(0.0, |feed| feed.diameter);
        let even = |ends: &[f64]| {
            let [from, to] = [ends[0], ends[1]];
            let [a, b] = [from, to].map(|s| motion.outlet(s));
            let way = (0..3).map(|n| (b[n] - a[n]).powi(2)).sum::<f64>().sqrt();
            let count = (way / longest).ceil().max(1.0) as usize;
            let at = move |n: usize| from + (to - from) * n as f64 / count as f64;
            (0..count).map(move |n| [at(n), if n + 1 == count { to } else { at(n + 1) }])
        };
        let passages = passages.windows(2).filter(|ends| ends[1] > ends[0]);
        passages.flat_map(even).collect()
    }

    fn check_speed(&self, velocity: [f64; 3], time: f64) -> Result<(), Failure> {
        let speed = velocity.iter().map(|v| v * v).sum::<f64>().sqrt();
        let most = FASTEST * self.method.units.speed;
        match speed <= most {
            true => Ok(()),
            false => Err(Failure::NozzleTooFast { speed, most, time }),
        }
    }

    /// Moves the column at once [m].
    fn shift_column(&self, run: &mut Run, way: [f64; 3]) {
        if way == [0.0; 3] {
            return;
        }
        for i in in_nozzle(&run.cloud) {
            let x = &mut run.cloud.position[i];
            (0..3).for_each(|a| x[a] += way[a] / self.method.units.length);
        }
    }

    /// Gives the column a velocity [m/s] and a temperature [K]: the nozzle supplies momentum and heat.
    fn drive_column(&self, run: &mut Run, velocity: [f64; 3], temperature: f64) {
        let Run { cloud, ledger, .. } = run;
        let units = &self.method.units;
        let velocity = velocity.map(|v| v / units.speed);
        let rise = temperature - self.reference_temperature();
        let [momentum, heat] = [units.mass() * units.speed, units.energy() / self.method.heat_unit];
        for i in in_nozzle(cloud) {
            let (mass, given) = (cloud.mass[i], &mut fed(ledger).impulse);
            (0..3).for_each(|a| given[a] += momentum * mass * (velocity[a] - cloud.velocity[i][a]));
            cloud.velocity[i] = velocity;
            // In the nozzle fluid is molten, where contents are temperatures.
            ledger.heat_released += mass * heat * (rise - cloud.contents()[i]);
            cloud.temperature[i] = rise;
            cloud.initial[i] = rise;
            cloud.content.iter_mut().for_each(|content| content[i] = rise);
        }
    }

    /// Frees the layers that have passed the outlet, and adds as many on top of the column.
    fn pass_layers(&self, run: &mut Run, velocity: [f64; 3], temperature: f64) {
        let passed = self.column().passed(fed(&mut run.ledger).volume);
        let before = run.ledger.released as usize - self.column().layers;
        if passed == before {
            return;
        }
        let origin = run.cloud.origin.as_mut().expect("particles of a nozzle");
        for (hold, layer) in origin.hold.iter_mut().zip(&origin.layer) {
            if *hold == BY_NOZZLE && (*layer as usize) < passed {
                *hold = FREE;
            }
        }
        for _ in before..passed {
            self.add_layer(&mut run.ledger, &mut run.cloud, velocity, temperature);
        }
        run.team = self.team(run.cloud.len());
    }

    /// Adds a layer on top of the column, with a velocity [m/s] and a temperature [K].
    fn add_layer(
        &self,
        ledger: &mut Ledger,
        cloud: &mut Cloud,
        velocity: [f64; 3],
        temperature: f64,
    ) {
        let (column, units) = (self.column(), &self.method.units);
        let layer = ledger.released;
        let Fed { volume, nozzle, .. } = *fed(ledger);
        let height = column.height(layer as usize, volume);
        let own = velocity.map(|v| v / units.speed);
        let rise = temperature - self.reference_temperature();
        for &([x, y], mass) in &column.places {
            let about = [x, y, height / units.length];
            let place = [0, 1, 2].map(|a| nozzle[a] / units.length + about[a]);
            cloud.push(place, own, mass, rise);
            if let Some(origin) = &mut cloud.origin {
                *origin.layer.last_mut().expect("one was just added") = layer;
                *origin.hold.last_mut().expect("one was just added") = BY_NOZZLE;
            }
        }
        let mass = column.layer_mass();
        let given = &mut fed(ledger).impulse;
        let momentum = mass * units.mass();
        (0..3).for_each(|a| given[a] += momentum * velocity[a]);
        ledger.heat_released += mass * units.energy() / self.method.heat_unit * rise;
        ledger.released += 1.0;
    }
}

/// State of the nozzle.
fn fed(ledger: &mut Ledger) -> &mut Fed {
    ledger.fed.as_mut().expect("the state of a nozzle")
}

/// Numbers of the particles in the nozzle.
fn in_nozzle(cloud: &Cloud) -> Vec<usize> {
    let holds = cloud.origin.iter().flat_map(|origin| origin.hold.iter().enumerate());
    holds.filter(|(_, hold)| **hold == BY_NOZZLE).map(|(i, _)| i).collect()
}
