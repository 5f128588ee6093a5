//! Supports and load of a strip that moves, as combinations of its motion that are prescribed.

use super::arrangement::{Particles, Strip};
use super::frame::{Bearings, COMPONENTS, Combination, Faces, Support};

/// A combination of components of motion whose value is prescribed.
#[derive(Debug, Clone, PartialEq)]
pub struct Held {
    /// Components, three for each particle, with their parts.
    pub parts: Combination,
    /// Value of the combination over the displacement of the load: zero at supports.
    pub rate: f64,
}

/// Everything outside that acts on a strip, and the gauge of its notch.
#[derive(Debug, Clone, PartialEq)]
pub struct Holding {
    pub held: Vec<Held>,
    /// Particles at supports and loads.
    pub loaded: Vec<usize>,
    /// The opening of the notch.
    pub mouth: Option<Combination>,
}

impl Holding {
    pub fn new(particles: &Particles, strip: &Strip, support: Support) -> Self {
        let faces = Faces::new(particles, strip);
        let held = match support {
            Support::ThreePoint { span } => three_point(&faces.bearings(span)),
            Support::Ends => ends(particles, &faces.in_platens()),
        };
        let components = held.iter().flat_map(|held| &held.parts);
        let mut loaded: Vec<usize> = components.map(|(at, _)| at / COMPONENTS).collect();
        loaded.dedup();
        let all: Vec<_> = (0..COMPONENTS * particles.places.len()).map(Some).collect();
        let mouth = strip.notch.and_then(|notch| faces.mouth(notch, &all));
        Self { held, loaded, mouth }
    }
}

/// Supports hold w, and the load pushes down.
fn three_point(Bearings { top, supports }: &Bearings) -> Vec<Held> {
    let of = |particles: &[(usize, f64)], rate: f64| {
        let parts = particles.iter().map(|&(i, part)| (COMPONENTS * i + 1, part));
        Held { parts: parts.collect(), rate }
    };
    vec![of(top, -1.0), of(&supports[0], 0.0), of(&supports[1], 0.0)]
}

/// Platens hold u and the rotation, and the right one moves along x; particles slide along them.
fn ends(particles: &Particles, is_end: &[bool]) -> Vec<Held> {
    let in_platens = particles.places.iter().enumerate().filter(|(i, _)| is_end[*i]);
    let of_particle = |(i, place): (usize, &[f64; 2])| {
        let of = |component: usize, rate: f64| Held {
            parts: vec![(COMPONENTS * i + component, 1.0)],
            rate,
        };
        [of(0, if place[0] > 0.0 { 1.0 } else { 0.0 }), of(2, 0.0)]
    };
    in_platens.flat_map(of_particle).collect()
}
