//! Supports, loads and gauges of a strip.

use super::arrangement::{Notch, Particles, Strip};

/// Components of a particle's motion: u, w [m] and the rotation θ [rad].
pub const COMPONENTS: usize = 3;

/// Supports and load of a strip.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Support {
    /// On two supports at the lower face, at equal distances from x = 0, loaded downwards at the upper face at x = 0.
    ThreePoint {
        /// Distance of the supports [m].
        span: f64,
    },
    /// Both ends clamped in rigid platens that do not turn, the right one pulled along x; particles may slide along
    /// them.
    Ends,
}

/// A linear combination of the unknowns: their numbers with weights.
pub type Combination = Vec<(usize, f64)>;

/// The equations of a supported strip.
#[derive(Debug, Clone, PartialEq)]
pub struct Frame {
    /// Number of the unknown of each component of each particle; `None` where it is zero.
    pub unknown: Vec<Option<usize>>,
    pub unknowns: usize,
    /// Unit load; its product with the displacements is the displacement of the load.
    pub load: Combination,
    /// The opening of the notch.
    pub mouth: Option<Combination>,
    /// Particles at supports and loads.
    pub loaded: Vec<usize>,
}

/// Places of three-point bending: particles with their parts, of the load and of both supports.
pub struct Bearings {
    pub top: Vec<(usize, f64)>,
    pub supports: [Vec<(usize, f64)>; 2],
}

/// Depth of the rows at a face that supports and loads act on, over the spacing.
const FACE: f64 = 0.9;
/// Depth of the columns that platens hold, over the spacing: one of links across, two of links along.
const END: f64 = 0.6;

impl Frame {
    pub fn new(particles: &Particles, strip: &Strip, support: Support) -> Self {
        let faces = Faces::new(particles, strip);
        match support {
            Support::ThreePoint { span } => Self::three_point(&faces, span, strip.notch),
            Support::Ends => Self::ends(&faces, strip),
        }
    }

    /// The loads balance each other, so the three components that the first particle lacks bear nothing.
    fn three_point(faces: &Faces, span: f64, notch: Option<Notch>) -> Self {
        let places = &faces.particles.places;
        let mut unknown = vec![None; COMPONENTS * places.len()];
        let free = unknown.iter_mut().skip(COMPONENTS).enumerate();
        free.for_each(|(number, unknown)| *unknown = Some(number));
        let unknowns = unknown.len() - COMPONENTS;
        let Bearings { top, supports } = faces.bearings(span);
        let downwards = top.iter().map(|&(i, part)| (i, -part));
        let upwards = supports.iter().flatten().map(|&(i, part)| (i, 0.5 * part));
        let vertical: Vec<_> = downwards.chain(upwards).collect();
        let loaded = vertical.iter().map(|(i, _)| *i).collect();
        let load = combine(&unknown, 1, &vertical);
        let mouth = notch.and_then(|notch| faces.mouth(notch, &unknown));
        Self { unknown, unknowns, load, mouth, loaded }
    }

    fn ends(faces: &Faces, strip: &Strip) -> Self {
        let particles = faces.particles;
        let is_end = faces.in_platens();
        let mut unknown = Vec::with_capacity(COMPONENTS * particles.places.len());
        let mut loaded = Vec::new();
        // The right platen moves along x.
        let mut count = 1;
        let mut slides = false;
        for (i, &[x, _]) in particles.places.iter().enumerate() {
            let mut next = || {
                count += 1;
                Some(count - 1)
            };
            if is_end[i] {
                loaded.push(i);
                let w = if slides { next() } else { None };
                slides = true;
                unknown.extend([(x > 0.0).then_some(0), w, None]);
            } else {
                unknown.extend([next(), next(), next()]);
            }
        }
        let mouth = strip.notch.and_then(|notch| faces.mouth(notch, &unknown));
        Self { unknown, unknowns: count, load: vec![(0, 1.0)], mouth, loaded }
    }
}

/// Rows of particles at the faces of a strip.
pub struct Faces<'a> {
    particles: &'a Particles,
    depth: f64,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Face {
    Lower,
    Upper,
}

impl<'a> Faces<'a> {
    pub fn new(particles: &'a Particles, strip: &Strip) -> Self {
        Self { particles, depth: strip.depth }
    }

    /// Load in the middle of the upper face, and supports at a distance [m] below.
    pub fn bearings(&self, span: f64) -> Bearings {
        let at = |x: f64, face| self.at(x, face, |_| true);
        let supports = [-0.5, 0.5].map(|part| at(part * span, Face::Lower));
        Bearings { top: at(0.0, Face::Upper), supports }
    }

    /// Returns for each particle whether it is in a platen.
    pub fn in_platens(&self) -> Vec<bool> {
        let Particles { places, spacing, .. } = self.particles;
        let most = places.iter().fold(0.0_f64, |most, place| most.max(place[0].abs()));
        places.iter().map(|[x, _]| x.abs() > most - END * spacing).collect()
    }

    /// Particles nearest to a place x of a face on both sides, or beyond its ends the outermost ones, with parts of one
    /// that have their centre there; the nearest one first if all are on one side.
    fn at(&self, x: f64, face: Face, wanted: impl Fn(f64) -> bool) -> Vec<(usize, f64)> {
        let layer = FACE * self.particles.spacing;
        let rounding = 1e-9 * self.particles.spacing;
        let is_on = |y: f64| match face {
            Face::Lower => y < layer,
            Face::Upper => y > self.depth - layer,
        };
        let of_face = self.particles.places.iter().enumerate();
        let mut of_face: Vec<(usize, f64)> = of_face
            .filter(|(_, place)| is_on(place[1]) && wanted(place[0]))
            .map(|(i, place)| (i, place[0] - x))
            .collect();
        of_face.sort_by(|a, b| a.1.total_cmp(&b.1));
        let next = of_face.partition_point(|(_, from)| *from < -rounding);
        match (next.checked_sub(1).map(|before| of_face[before]), of_face.get(next)) {
            (_, Some(&(i, from))) if from < rounding => vec![(i, 1.0)],
            (Some((i, left)), Some(&(j, right))) => {
                vec![(i, right / (right - left)), (j, -left / (right - left))]
            }
            (Some(outermost), None) => beyond(outermost, next.checked_sub(2).map(|n| of_face[n])),
            (None, Some(&outermost)) => beyond(outermost, of_face.get(next + 1).copied()),
            (None, None) => Vec::new(),
        }
    }

    /// Horizontal distance of the sides of a notch at the lower face, which turn with their particles.
    pub fn mouth(&self, notch: Notch, unknown: &[Option<usize>]) -> Option<Combination> {
        let nearest = |side: f64| {
            let of_side = self.at(notch.at, Face::Lower, |x| notch.side(x) * side > 0.0);
            of_side.first().map(|(i, _)| *i)
        };
        let sides = [(nearest(-1.0)?, -1.0), (nearest(1.0)?, 1.0)];
        let turned = sides.map(|(i, sign)| (i, sign * self.particles.places[i][1]));
        let mut mouth = combine(unknown, 0, &sides);
        mouth.extend(combine(unknown, 2, &turned));
        Some(mouth)
    }
}

/// Parts of the outermost particles of a face at a place beyond them, from their distances to it: as the line through
/// both, so that a force there has its moment.
fn beyond((i, near): (usize, f64), inner: Option<(usize, f64)>) -> Vec<(usize, f64)> {
    match inner {
        Some((j, far)) => vec![(i, far / (far - near)), (j, -near / (far - near))],
        None => vec![(i, 1.0)],
    }
}

/// Combination of one component of several particles.
fn combine(unknown: &[Option<usize>], component: usize, parts: &[(usize, f64)]) -> Combination {
    let number = |i: usize| unknown[COMPONENTS * i + component];
    parts.iter().filter_map(|&(i, part)| Some((number(i)?, part))).collect()
}
