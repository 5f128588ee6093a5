//! The known course of one drop: computed once by the first caller, shared within a process, and stored in units.

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

/// Number of sample times of a course, and largest number of rings.
pub const SAMPLES: usize = 200;
const MOST_RINGS: usize = 64;
/// Rings of a film.
const RINGS_OF_FILM: usize = 32;
/// Width of a ring over Δx; narrower rings would resolve single particles.
const RING: f64 = 2.0;
/// Recording radius over the expected spread radius of the drop.
const BEYOND: f64 = 1.25;
/// Largest ratio between the speeds of the scene's drop and of films released by inputs, and number of speeds known
/// over this range.
const RANGE_OF_FILM: f64 = 4.0;
const SPEEDS_OF_FILM: usize = 17;
/// Temperature of the recorded drop [K]; the record does not depend on it.
const WARM: f64 = 400.0;
/// Version of the records; to be raised when their contents change.
const VERSION: u32 = 4;

static COURSES: SharedValues<String, Course> = SharedValues::new();

/// Keeps a course available to the units of this process while it is held.
pub struct Kept {
    _course: Arc<Course>,
}

/// All data that determine a course.
#[derive(Serialize)]
struct Key {
    version: u32,
    /// Drops as returned by [`computed`], one for each speed.
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

    /// Returns the plans of the recordings, with their times.
    fn plans(&self) -> impl Iterator<Item = (DropletPlan, f64)> {
        let cells = WallCells::Rings { count: self.rings, radius: self.radius };
        let plan = move |drop: &Droplet| plan_of(drop, Some(cells.clone()), self.effusivity);
        self.drops.iter().map(plan).zip(self.durations.iter().copied())
    }

    /// Records all drops, and again on a larger radius if one spread beyond the expected radius.
    fn compute(&self, threads: usize) -> Result<Course, Failure> {
        let course = self.record(threads)?;
        let widest = course.profiles().map(Profile::largest_spread).fold(0.0, f64::max);
        let is_within = 0.5 * widest <= self.radius;
        if is_within || self.drops.iter().any(|drop| !drop.has_particles()) {
            return Ok(course);
        }
        // Rings do not act on the flow, so it spreads equally far again.
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

/// Returns the known course of a scene's drops.
pub fn course(
    scene: &Scene,
    named: (&str, &Droplet),
    threads: usize,
) -> Result<Arc<Course>, Failure> {
    let key = Key::of(scene, named);
    COURSES.get_or_make(&key.text(), || aside(|| key.compute(threads)))
}

/// Returns the records that the drops of a scene need, as bytes, each with the name of its body.
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

/// Makes a record available to this process and refuses damaged bytes. Units with other drops compute their own record.
pub fn keep_record(bytes: &[u8]) -> Result<Kept, String> {
    let (key, course) = Course::from_bytes(bytes)?;
    let course = COURSES.get_or_make(&key, || Ok::<_, String>(course))?;
    Ok(Kept { _course: course })
}

/// Returns true if this process holds the record that the drops of a scene need.
pub fn is_known(scene: &Scene, named: (&str, &Droplet)) -> bool {
    COURSES.has(&Key::of(scene, named).text())
}

/// Drops all records that are no longer held.
pub fn forget_unused_records() {
    COURSES.forget_unused();
}

/// Returns the recordings that a scene's droplet needs, as plans with their times; none for a film.
pub fn plans(scene: &Scene, named: (&str, &Droplet)) -> Vec<(DropletPlan, f64)> {
    if !named.1.has_particles() {
        return Vec::new();
    }
    Key::of(scene, named).plans().collect()
}

/// Speeds at wall contact for which drops are known [m/s].
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

/// The representative drop: alone, at the origin, just above the wall. A quarter of it is computed, whatever is below.
/// Rings would take a fifth to an eighth of the time. For ink (Re 500, We 800) they transfer the same heat to 1.1 %.
/// Recoiling mercury (4 m/s) transfers 6 % less after 6 D/U, with up to 38 % more impulse.
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
        // The watched points do not affect a record.
        fluid: Fluid {
            freezes_at: None,
            boils_at: None,
            evaporation: None,
            ..droplet.fluid.clone()
        },
        ..droplet.clone()
    }
}

/// Number of rings below drops of this spread diameter [m], and the outermost radius [m].
fn rings(drops: &[Droplet], spread: f64) -> (usize, f64) {
    let spacing = drops.iter().map(|drop| drop.spacing).fold(0.0, f64::max);
    let radius = BEYOND * 0.5 * spread + RING * spacing;
    let count = (radius / (RING * spacing)).ceil() as usize;
    (count.min(MOST_RINGS), radius)
}

fn film_radius(drop: &Droplet) -> f64 {
    Film::largest_radius(&drop.impact())
}
