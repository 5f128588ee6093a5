//! Motion through moves: at their speed, or with a limited acceleration as firmware plans it.
//!
//! With an acceleration a, speeds are trapezoids over time. A corner is passed at the speed at which a circle of the
//! acceleration a would pass a right angle with the speed v_c, `v² = v_c² (√2 − 1) s/(1 − s)`, with the sine s of half
//! of the angle between both moves (rule of the junction deviation). The flow follows the speed.

use std::f64::consts::SQRT_2;

use super::Step;
use crate::scene::filament::PathFile;
use crate::scene::route::{Leg, Route};

/// A move with the speeds at its ends [m/s].
struct Ride {
    from: [f64; 3],
    along: [f64; 3],
    length: f64,
    volume: f64,
    speed: f64,
    begins: f64,
    ends: f64,
}

/// The motion through all steps.
pub fn route(steps: &[Step], settings: &PathFile) -> Route {
    let mut builder = Builder::default();
    let mut rides = Vec::new();
    for step in steps {
        match *step {
            Step::Move { from, to, volume, speed } => rides.push(ride(from, to, volume, speed)),
            Step::Rest { at, duration, volume } => {
                builder.ride(std::mem::take(&mut rides), settings);
                let flow = if duration > 0.0 { volume / duration } else { 0.0 };
                builder.add(duration, [at, [0.0; 3], [0.0; 3]], [flow, 0.0]);
            }
        }
    }
    builder.ride(rides, settings);
    Route { legs: builder.legs }
}

fn ride(from: [f64; 3], to: [f64; 3], volume: f64, speed: f64) -> Ride {
    let way = [0, 1, 2].map(|axis| to[axis] - from[axis]);
    let length = dot(way, way).sqrt();
    let along = way.map(|part| part / length);
    Ride { from, along, length, volume, speed, begins: speed, ends: speed }
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// Speed at which the corner between two moves may be passed [m/s].
fn at_corner(a: &Ride, b: &Ride, corner_speed: f64) -> f64 {
    let sine = (0.5 * (1.0 + dot(a.along, b.along))).max(0.0).sqrt();
    let most = corner_speed * ((SQRT_2 - 1.0) * sine / (1.0 - sine).max(f64::EPSILON)).sqrt();
    most.min(a.speed).min(b.speed)
}

/// Sets the speeds at the ends of moves that follow each other, from rest to rest.
fn plan(rides: &mut [Ride], acceleration: f64, corner_speed: f64) {
    let corners: Vec<f64> =
        rides.windows(2).map(|pair| at_corner(&pair[0], &pair[1], corner_speed)).collect();
    let gain = |ride: &Ride| 2.0 * acceleration * ride.length;
    let mut next = 0.0_f64;
    for (n, ride) in rides.iter_mut().enumerate().rev() {
        ride.ends = next;
        let corner = if n == 0 { 0.0 } else { corners[n - 1] };
        ride.begins = corner.min((next * next + gain(ride)).sqrt());
        next = ride.begins;
    }
    let mut before = 0.0_f64;
    for ride in rides {
        ride.begins = before;
        ride.ends = ride.ends.min((before * before + gain(ride)).sqrt());
        before = ride.ends;
    }
}

#[derive(Default)]
struct Builder {
    legs: Vec<Leg>,
}

impl Builder {
    fn add(&mut self, duration: f64, place: [[f64; 3]; 3], flow: [f64; 2]) {
        if duration > 0.0 {
            let start = self.legs.last().map_or(0.0, Leg::stop);
            self.legs.push(Leg { start, duration, place, flow: Some(flow) });
        }
    }

    /// Adds moves that follow each other without a rest.
    fn ride(&mut self, mut rides: Vec<Ride>, settings: &PathFile) {
        if let Some(acceleration) = settings.acceleration {
            plan(&mut rides, acceleration, settings.corner_speed);
        }
        for ride in &rides {
            self.trapezoid(ride, settings.acceleration);
        }
    }

    /// Adds the parts of a move: faster, even, slower.
    fn trapezoid(&mut self, ride: &Ride, acceleration: Option<f64>) {
        let Ride { length, begins, ends, .. } = *ride;
        let Some(a) = acceleration else {
            self.part(ride, 0.0, [ride.speed, 0.0], length / ride.speed);
            return;
        };
        let most = a * length + 0.5 * (begins * begins + ends * ends);
        let top = ride.speed.min(most.sqrt());
        let up = (top * top - begins * begins) / (2.0 * a);
        let down = (top * top - ends * ends) / (2.0 * a);
        let even = (length - up - down).max(0.0);
        self.part(ride, 0.0, [begins, a], (top - begins) / a);
        self.part(ride, up, [top, 0.0], even / top);
        self.part(ride, length - down, [top, -a], (top - ends) / a);
    }

    fn part(&mut self, ride: &Ride, way: f64, [speed, rate]: [f64; 2], duration: f64) {
        let of = |factor: f64| ride.along.map(|part| factor * part);
        let place = [0, 1, 2].map(|axis| ride.from[axis] + way * ride.along[axis]);
        let section = ride.volume / ride.length;
        self.add(duration, [place, of(speed), of(rate)], [section * speed, section * rate]);
    }
}
