//! Inputs that release drops on demand.

use std::f64::consts::FRAC_PI_2;
use std::ops::Range;

use crate::body::BodyError;
use crate::inputs::{InputLayout, InputPath};
use crate::method::record::{Course, Falling};
use crate::method::sph::Release;
use crate::scene::{Droplet, Footprint, Scene, Shape, lateral_extents, velocity};

/// Places and limits of these inputs.
pub struct DropInputs {
    /// Places of the inputs, in the order of [`Droplet::inputs`]; y and a direction only in three dimensions.
    places: Range<usize>,
    in_space: bool,
    most: usize,
    /// Largest speed [m/s].
    fastest: f64,
    /// Largest distance from the origin at which drops may land along x and y [m], with the reason. At zero they must
    /// land at the origin, straight down.
    reach: [f64; 2],
    why: String,
    /// The scene's droplet.
    droplet: Droplet,
    /// Temperature above which drops are liquid, of a fluid that freezes [K].
    liquidus: Option<f64>,
    /// A drop at the origin.
    at_origin: Release,
}

/// Present values of the inputs.
struct Values {
    count: f64,
    centre: [f64; 2],
    speed: f64,
    temperature: f64,
    angle: f64,
    direction: f64,
}

impl Values {
    fn velocity(&self) -> [f64; 3] {
        velocity(self.speed, self.angle, self.direction)
    }
}

impl DropInputs {
    /// Returns `None` if the scene itself releases the drops. `farthest` is the largest allowed start distance from the
    /// origin [m].
    pub fn of(
        scene: &Scene,
        layout: &InputLayout,
        (name, droplet): (&str, &Droplet),
        farthest: f64,
    ) -> Option<Self> {
        if !droplet.is_on_demand() {
            return None;
        }
        let (reach, why) = reach(scene, (name, droplet), farthest);
        Some(Self {
            places: layout.of_body(name),
            in_space: droplet.dimension == 3,
            most: droplet.drops(),
            fastest: match droplet.is_replayed() {
                true => f64::INFINITY,
                false => droplet.fastest_release(),
            },
            reach,
            why,
            droplet: droplet.clone(),
            liquidus: scene.freezing_of(name).map(|freezing| freezing.melting.liquidus),
            at_origin: super::plan::release_at(droplet, &Default::default()),
        })
    }

    fn values(&self, inputs: &[f64]) -> Values {
        let own = &inputs[self.places.clone()];
        let rest = if self.in_space { &own[3..] } else { &own[2..] };
        let y = if self.in_space { own[2] } else { 0.0 };
        Values {
            count: own[0],
            centre: [own[1], y],
            speed: rest[0],
            temperature: rest[1],
            angle: rest[2],
            direction: if self.in_space { rest[3] } else { 0.0 },
        }
    }

    /// Refuses impossible values of a drop, and more drops than allowed.
    pub fn check(&self, inputs: &[f64]) -> Result<(), BodyError> {
        let values = self.values(inputs);
        let Values { count, centre, speed, temperature, angle, .. } = values;
        let first = self.places.start;
        let after_places = first + if self.in_space { 3 } else { 2 };
        let refuse = |index: usize, message: String| Err(BodyError::Input { index, message });
        if count.fract() != 0.0 || count < 0.0 {
            return refuse(
                first,
                format!("{} is no number of drops (allowed: 0, 1, 2, …)", plain(count)),
            );
        }
        if count > self.most as f64 {
            let most = self.most;
            return refuse(
                first,
                format!("{count} drops, of which there are {most} at most (`most` of the scene)"),
            );
        }
        if angle.abs() >= FRAC_PI_2 {
            let message = format!(
                "at {} rad a drop does not come down (allowed: between -1.5708 and 1.5708 rad)",
                plain(angle)
            );
            return refuse(after_places + 2, message);
        }
        if self.reach == [0.0; 2] && angle != 0.0 {
            let message =
                format!("a drop that comes at {} rad: {} (allowed: 0)", plain(angle), self.why);
            return refuse(after_places + 2, message);
        }
        let landing = self.droplet.landing(centre, values.velocity());
        for (axis, (x, reach)) in landing.into_iter().zip(self.reach).enumerate() {
            if x.abs() > reach.max(ROUNDING * self.droplet.diameter) * (1.0 + ROUNDING) {
                let allowed = match reach {
                    0.0 => "0".to_owned(),
                    reach => format!("{} to {} m", -short(reach), short(reach)),
                };
                let (at, why) = (plain(x), &self.why);
                let message =
                    format!("a drop that comes down at {at} m: {why} (allowed: {allowed})");
                return refuse(first + 1 + axis, message);
            }
        }
        if speed < 0.0 || speed > self.fastest {
            let message = format!(
                "a drop at {} m/s, where the speed of sound is that of slower ones (allowed: 0 to {} m/s; more with \
                 a higher `impact_velocity` or `fluid.sound_speed` of the scene)",
                plain(speed),
                short(self.fastest)
            );
            return refuse(after_places, message);
        }
        if temperature <= 0.0 {
            return refuse(after_places + 1, format!("{temperature} K is not above absolute zero"));
        }
        if let Some(liquidus) = self.liquidus.filter(|&liquidus| temperature <= liquidus) {
            let message = format!(
                "a drop at {} K, where drops are liquid when released (allowed: above {} K)",
                plain(temperature),
                short(liquidus)
            );
            return refuse(after_places + 1, message);
        }
        Ok(())
    }

    /// Refuses a speed or direction for which no drop is known.
    pub fn check_speed(&self, inputs: &[f64], course: &Course) -> Result<(), BodyError> {
        let values = self.values(inputs);
        // The speed follows the places.
        let index = self.places.start + 3;
        if values.angle != 0.0 {
            let message = format!(
                "at {} rad: what is known of a drop is that of one straight down (allowed: 0)",
                plain(values.angle)
            );
            return Err(BodyError::Input { index: index + 2, message });
        }
        if !course.knows(self.droplet.contact(values.speed).0) {
            let [slowest, fastest] = course.speeds().map(short);
            let message = format!(
                "a drop at {} m/s, of which nothing is known (allowed: speeds at which it touches the wall at {slowest} to \
                 {fastest} m/s; others with `record.speeds` of the scene)",
                plain(values.speed)
            );
            return Err(BodyError::Input { index, message });
        }
        Ok(())
    }

    /// The requested drop at a time [s].
    pub fn falling(&self, inputs: &[f64], time: f64) -> Falling {
        let values = self.values(inputs);
        let (speed, fall) = self.droplet.contact(values.speed);
        let place = self.release(inputs).centre;
        Falling {
            contact: time + fall,
            place: [place[0], place[1]],
            speed,
            temperature: values.temperature,
        }
    }

    /// Number of drops requested beyond the earlier ones, at the beginning of a path.
    pub fn further(&self, path: &InputPath, asked: f64) -> Result<usize, BodyError> {
        let index = self.places.start;
        let (inputs, rates) = path.derivatives().split_first().expect("inputs stand first");
        if rates.iter().any(|rates| rates[index] != 0.0) {
            let message = "a count has no time derivative: drops are asked for one by one (allowed: a count that \
                           is held over a step)";
            return Err(BodyError::Input { index, message: message.to_owned() });
        }
        let count = self.values(inputs).count;
        if count < asked {
            let message = format!(
                "{count} drops, where {asked} have been asked for: the count of all drops does not fall (allowed: {asked} \
                 to {})",
                self.most
            );
            return Err(BodyError::Input { index, message });
        }
        Ok((count - asked) as usize)
    }

    /// The requested drop.
    pub fn release(&self, inputs: &[f64]) -> Release {
        let values = self.values(inputs);
        let Values { centre, temperature, .. } = values;
        // A centre moved off the middle by rounding is set back to it.
        let [x, y] = [0, 1].map(|axis| if self.reach[axis] == 0.0 { 0.0 } else { centre[axis] });
        let [_, _, z] = self.at_origin.centre;
        Release { centre: [x, y, z], velocity: values.velocity(), temperature, ..self.at_origin }
    }
}

/// Relative rounding of a place.
const ROUNDING: f64 = 1e-9;

/// A number in plain notation, or with an exponent if that would need many zeros.
fn plain(value: f64) -> String {
    match value.abs() {
        size if size == 0.0 || (1e-6..1e9).contains(&size) => value.to_string(),
        _ => format!("{value:e}"),
    }
}

/// A number rounded for display.
fn short(value: f64) -> f64 {
    format!("{value:.5e}").parse().unwrap_or(value)
}

/// Largest start distance of drops from the origin along x and y [m], with the reason for that limit.
fn reach(scene: &Scene, (name, droplet): (&str, &Droplet), farthest: f64) -> ([f64; 2], String) {
    let rings = scene
        .wall_under(name)
        .is_some_and(|wall| matches!(scene.wall[wall].footprint, Footprint::Rings { .. }));
    let below = scene.coupling_from(name).and_then(|coupling| scene.coupling[coupling].solid());
    let solid = below.and_then(|name| Some((name, scene.solid(name)?.shape)));
    let centred = |what: &str| ([0.0; 2], format!("{what} drops straight down at x = 0, y = 0"));
    match solid {
        _ if rings => centred("a wall of rings needs"),
        Some((_, Shape::Disc(_))) => centred("a disc, which is modelled axisymmetric, needs"),
        _ if droplet.even() != [false; 2] => centred("a model of a part of the drops needs"),
        Some((name, shape)) => {
            let reach = lateral_extents(&shape).map(|extent| 0.5 * (extent - droplet.diameter));
            (reach, format!("that is beside `{name}`"))
        }
        None => ([farthest; 2], "places are lost in rounding there".to_owned()),
    }
}
