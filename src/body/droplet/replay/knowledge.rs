//! What is known of one drop: computed once, by whoever asks first, shared in one process, and stored by units.

use std::sync::Arc;

use serde::Serialize;

use super::super::plan_of;
use crate::body::BodyError;
use crate::laws::Fluid;
use crate::method::record::{Course, Film, Profile, Recorder, film_profile, record_profile};
use crate::method::sph::{DropletPlan, Failure};
use crate::port::WallCells;
use crate::runtime::shared_values::SharedValues;
use crate::runtime::thread::aside;
use crate::scene::{Droplet, DropletMethod, DropletSymmetry, ReleaseBy, Scene};

/// Times at which a course is known, and most rings.
pub const SAMPLES: usize = 200;
const MOST_RINGS: usize = 64;
/// Rings of a film.
const RINGS_OF_FILM: usize = 32;
/// Width of a ring over Δx: narrower ones would tell particles.
const RING: f64 = 2.0;
/// Radius out to which is recorded, over that to which the drop is expected to spread.
const BEYOND: f64 = 1.25;
/// How much slower and faster than the scene's drop those may be that inputs release as films, and speeds that are
/// known over this range.
const RANGE_OF_FILM: f64 = 4.0;
const SPEEDS_OF_FILM: usize = 17;
/// Temperature of the drop that is recorded [K]; none follows from it.
const WARM: f64 = 400.0;
/// Changes with what is recorded.
const VERSION: u32 = 3;

static COURSES: SharedValues<String, Course> = SharedValues::new();

/// A course that units of this process find as long as it is held.
pub struct Kept {
    _course: Arc<Course>,
}

/// All that a course follows from.
#[derive(Serialize)]
struct Key {
    version: u32,
    /// As [`computed`]; one for each speed.
    drops: Vec<Droplet>,
    effusivity: Option<f64>,
    durations: Vec<f64>,
    rings: usize,
    radius: f64,
    samples: usize,
}

impl Key {
    fn of(scene: &Scene, (name, droplet): (&str, &Droplet)) -> Self {
        let speeds = speeds(droplet);
        let drops: Vec<Droplet> = speeds.iter().map(|&speed| computed(droplet, speed)).collect();
        let (rings, radius) = match droplet.has_particles() {
            true => rings(&drops, drops.iter().map(Droplet::spread_diameter).fold(0.0, f64::max)),
            false => (RINGS_OF_FILM, drops.iter().map(film_radius).fold(0.0, f64::max)),
        };
        Self {
            version: VERSION,
            durations: speeds.iter().map(|&speed| droplet.recorded_time(speed)).collect(),
            drops,
            effusivity: scene.effusivity_below(name),
            rings,
            radius,
            samples: SAMPLES,
        }
    }

    fn text(&self) -> String {
        serde_json::to_string(self).unwrap_or_default()
    }

    /// The plans of what is recorded, with the times.
    fn plans(&self) -> impl Iterator<Item = (DropletPlan, f64)> {
        let cells = WallCells::Rings { count: self.rings, radius: self.radius };
        let plan = move |drop: &Droplet| plan_of(drop, Some(cells.clone()), self.effusivity);
        self.drops.iter().map(plan).zip(self.durations.iter().copied())
    }

    /// Records all drops; once more on wider rings where one spread beyond those that it was expected to stay on.
    fn compute(&self, threads: usize) -> Result<Course, Failure> {
        let course = self.record(threads)?;
        let widest = course.profiles().map(Profile::largest_spread).fold(0.0, f64::max);
        let is_within = 0.5 * widest <= self.radius;
        if is_within || self.drops.iter().any(|drop| !drop.has_particles()) {
            return Ok(course);
        }
        // Rings do not act on the flow, so it spreads as far again.
        let (rings, radius) = rings(&self.drops, widest);
        Self {
            rings,
            radius,
            drops: self.drops.clone(),
            durations: self.durations.clone(),
            ..*self
        }
        .record(threads)
    }

    fn record(&self, threads: usize) -> Result<Course, Failure> {
        let mut profiles = Vec::new();
        for ((plan, duration), drop) in self.plans().zip(&self.drops) {
            let heat_capacity = drop.mass() * drop.fluid.specific_heat;
            if !drop.has_particles() {
                profiles.push(film_profile(&self.film(drop, duration)));
                continue;
            }
            let samples = self.samples;
            let speed = drop.impact_velocity;
            let recorder = Recorder { speed, heat_capacity, duration, samples, threads };
            profiles.push(record_profile(plan, recorder)?);
        }
        Course::new(profiles).map_err(|reason| Failure::Unrecorded { reason })
    }

    fn film(&self, drop: &Droplet, duration: f64) -> Film {
        Film {
            impact: drop.impact(),
            specific_heat: drop.fluid.specific_heat,
            conductivity: drop.fluid.conductivity,
            effusivity: self.effusivity,
            duration,
            samples: self.samples,
            rings: self.rings,
            radius: self.radius,
        }
    }
}

/// What is known of the drops of a scene.
pub fn course(
    scene: &Scene,
    named: (&str, &Droplet),
    threads: usize,
) -> Result<Arc<Course>, Failure> {
    let key = Key::of(scene, named);
    COURSES.get_or_make(&key.text(), || aside(|| key.compute(threads)))
}

/// The records that the drops of a scene need, each with the name of its body, as bytes.
pub fn records(scene: &Scene, threads: usize) -> Result<Vec<(String, Vec<u8>)>, BodyError> {
    let recorded = scene.droplets().filter(|(_, drop)| drop.method == DropletMethod::Record);
    let bytes = |(name, droplet): (&str, &Droplet)| {
        let course = course(scene, (name, droplet), threads.max(1));
        let course =
            course.map_err(|failure| BodyError::Droplet { name: name.to_owned(), failure })?;
        Ok((name.to_owned(), course.to_bytes(&Key::of(scene, (name, droplet)).text())))
    };
    recorded.map(bytes).collect()
}

/// Makes a record known to this process; refuses bytes that are damaged. Units whose drops it does not fit compute
/// their own.
pub fn keep_record(bytes: &[u8]) -> Result<Kept, String> {
    let (key, course) = Course::from_bytes(bytes)?;
    let course = COURSES.get_or_make(&key, || Ok::<_, String>(course))?;
    Ok(Kept { _course: course })
}

/// Whether this process holds what the drops of a scene need.
pub fn is_known(scene: &Scene, named: (&str, &Droplet)) -> bool {
    COURSES.has(&Key::of(scene, named).text())
}

/// Forgets what nobody holds any more.
pub fn forget_unused_records() {
    COURSES.forget_unused();
}

/// What is computed ahead for a scene's droplet: plans with the times that are recorded; nothing of a film.
pub fn plans(scene: &Scene, named: (&str, &Droplet)) -> Vec<(DropletPlan, f64)> {
    if !named.1.has_particles() {
        return Vec::new();
    }
    Key::of(scene, named).plans().collect()
}

/// Speeds at which drops are known, as they touch the wall [m/s].
fn speeds(droplet: &Droplet) -> Vec<f64> {
    let touching = |speed: f64| droplet.contact(speed).0;
    if droplet.has_particles() || droplet.record.as_ref().is_some_and(|r| r.speeds.is_some()) {
        return droplet.recorded_speeds().into_iter().map(touching).collect();
    }
    let own = touching(droplet.impact_velocity);
    if !droplet.is_on_demand() {
        return vec![own];
    }
    let last = (SPEEDS_OF_FILM - 1) as f64;
    let exponent = |n: usize| 2.0 * n as f64 / last - 1.0;
    (0..SPEEDS_OF_FILM).map(|n| own * RANGE_OF_FILM.powf(exponent(n))).collect()
}

/// The drop that stands for all: alone, at the origin, just above the wall. A quarter of it is computed, whatever is
/// below: rings take a fifth to an eighth of the time, and ink (Re 500, We 800) gives the same heat to 1.1 %, but mercury
/// (4 m/s), which recoils, 6 % less of it after 6 D/U, and up to 38 % more impulse.
fn computed(droplet: &Droplet, speed: f64) -> Droplet {
    Droplet {
        impact_velocity: speed,
        initial_temperature: WARM,
        symmetry: DropletSymmetry::Auto,
        is_on_round: false,
        height: None,
        release: ReleaseBy::Arrivals,
        most: None,
        arrivals: None,
        record: None,
        // Nothing of a record follows from what is watched.
        fluid: Fluid { freezes_at: None, boils_at: None, ..droplet.fluid },
        ..droplet.clone()
    }
}

/// Number of rings below drops that spread so far [m], and the outermost radius [m].
fn rings(drops: &[Droplet], spread: f64) -> (usize, f64) {
    let spacing = drops.iter().map(|drop| drop.spacing).fold(0.0, f64::max);
    let radius = BEYOND * 0.5 * spread + RING * spacing;
    let count = (radius / (RING * spacing)).ceil() as usize;
    (count.min(MOST_RINGS), radius)
}

fn film_radius(drop: &Droplet) -> f64 {
    Film::largest_radius(&drop.impact())
}
