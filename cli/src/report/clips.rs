//! Droplets over time: the particles of a section, or of the whole seen from the side.

use std::path::Path;

use impinge::scene::{Droplet, Scene};

use super::document::{Clip, Values};
use super::error::ReportError;
use super::fields::{FieldFile, Frames};
use super::packed::Array;

/// Most dots of all droplets together.
const MOST_DOTS: usize = 60_000;
/// Most times, and fewest if each has many dots.
const TIMES: [usize; 2] = [60, 8];
/// Half the thickness of a section over the distance of particles: layers on a lattice lie half of it beside the
/// middle.
const HALF_SECTION: f64 = 0.75;
/// Shares of positions at either end that do not widen the picture: fluid that has come off.
const STRAY: f64 = 0.005;

/// The droplets of a scene whose particles are in a folder.
pub fn clips(scene: &Scene, folder: &Path) -> Result<Vec<Clip>, ReportError> {
    let mut found = Vec::new();
    let drawn: Vec<_> = scene.droplets().filter(|(name, _)| scene.is_drawn(name)).collect();
    for (name, droplet) in &drawn {
        if let Some(frames) = Frames::read(folder, name)? {
            found.extend(clip(name, droplet, &frames, MOST_DOTS / drawn.len())?);
        }
    }
    Ok(found)
}

/// Particles of one time.
#[derive(Default)]
struct Frame {
    time: f64,
    /// x, y, z [m].
    position: Vec<f64>,
    temperature: Vec<f64>,
    speed: Vec<f64>,
    pressure: Vec<f64>,
}

impl Frame {
    fn read(time: f64, path: &Path) -> Result<Self, ReportError> {
        let mut file = FieldFile::open(path)?;
        let position = file.read("position")?;
        let velocity = file.read("velocity")?;
        let speed = velocity.chunks_exact(3).map(|v| v.iter().map(|c| c * c).sum::<f64>().sqrt());
        let speed = speed.collect();
        Ok(Self {
            time,
            position,
            temperature: file.read("temperature")?,
            speed,
            pressure: file.read("pressure")?,
        })
    }

    fn count(&self) -> usize {
        let lengths = [&self.temperature, &self.speed, &self.pressure].map(Vec::len);
        lengths.into_iter().fold(self.position.len() / 3, usize::min)
    }

    fn at(&self, particle: usize) -> [f64; 3] {
        [0, 1, 2].map(|axis| self.position[3 * particle + axis])
    }

    /// Keeps these particles.
    fn keep(&mut self, kept: &[usize]) {
        self.position = kept.iter().flat_map(|&i| self.at(i)).collect();
        for values in [&mut self.temperature, &mut self.speed, &mut self.pressure] {
            *values = kept.iter().map(|&i| values[i]).collect();
        }
    }
}

/// Part of a droplet that is shown.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Part {
    /// Rings, whose radius is x.
    Meridian,
    /// A plane model.
    Plane,
    /// Particles near y = 0.
    Section,
    /// All particles along y, thinned.
    Side,
}

impl Part {
    fn of(droplet: &Droplet, frames: &[Frame]) -> Self {
        let all = || frames.iter().flat_map(|frame| (0..frame.count()).map(move |i| frame.at(i)));
        if droplet.dimension == 2 {
            return Self::Plane;
        }
        if all().all(|[x, y, _]| x >= 0.0 && y == 0.0) {
            return Self::Meridian;
        }
        let is_central = !droplet.is_on_demand() && droplet.landings().all(|[_, y]| y == 0.0);
        if is_central { Self::Section } else { Self::Side }
    }

    fn about(self) -> &'static str {
        match self {
            Self::Meridian => "meridian section, mirrored at the axis",
            Self::Plane => "plane model",
            Self::Section => "section through y = 0",
            Self::Side => "seen along y, particles thinned",
        }
    }

    /// The particles of a frame that are shown, at most so many.
    fn shown(self, frame: &Frame, spacing: f64, most: usize) -> Vec<usize> {
        let is_near =
            |i: &usize| self != Self::Section || frame.at(*i)[1].abs() <= HALF_SECTION * spacing;
        let near: Vec<usize> = (0..frame.count()).filter(is_near).collect();
        let every = near.len().div_ceil(most.max(1)).max(1);
        near.into_iter().step_by(every).collect()
    }
}

fn clip(
    name: &str,
    droplet: &Droplet,
    frames: &Frames,
    dots: usize,
) -> Result<Option<Clip>, ReportError> {
    let chosen = frames.thinned(TIMES[0]);
    let mut read = Vec::new();
    for (time, path) in chosen {
        read.push(Frame::read(*time, path)?);
    }
    let part = Part::of(droplet, &read);
    let shown = |frame: &Frame, most| part.shown(frame, droplet.spacing, most);
    let largest = read.iter().map(|frame| shown(frame, usize::MAX).len()).max().unwrap_or(0);
    if largest == 0 {
        return Ok(None);
    }
    // Fewer times first, fewer dots only where that is not enough.
    let times = (dots / largest).clamp(TIMES[1].min(read.len()), read.len().max(1));
    let kept = super::fields::thinned(read.len(), times);
    let mut read: Vec<Frame> = read
        .into_iter()
        .enumerate()
        .filter_map(|(place, frame)| kept.contains(&place).then_some(frame))
        .collect();
    for frame in &mut read {
        let shown = shown(frame, dots / times);
        frame.keep(&shown);
    }
    Ok(Some(assembled(name, droplet, part, &read)))
}

fn assembled(name: &str, droplet: &Droplet, part: Part, frames: &[Frame]) -> Clip {
    let joined = |of: fn(&Frame) -> &Vec<f64>| -> Vec<f64> {
        frames.iter().flat_map(|frame| of(frame).iter().copied()).collect()
    };
    let position = joined(|frame| &frame.position);
    let along =
        |axis: usize| -> Vec<f64> { position.iter().skip(axis).step_by(3).copied().collect() };
    let (x, z) = (along(0), along(2));
    let is_mirrored = part == Part::Meridian;
    let values = |name: &str, unit: &str, values: Vec<f64>| Values {
        name: name.to_owned(),
        unit: unit.to_owned(),
        values: Array::packed(&values),
    };
    Clip {
        title: name.to_owned(),
        about: part.about().to_owned(),
        axes: [if is_mirrored { "r" } else { "x" }, "z"].map(str::to_owned),
        bounds: bounds(&x, &z, is_mirrored, droplet.spacing),
        size: droplet.spacing,
        is_mirrored,
        times: frames.iter().map(|frame| frame.time).collect(),
        counts: frames.iter().map(Frame::count).collect(),
        fields: vec![
            values("temperature", "K", joined(|frame| &frame.temperature)),
            values("speed", "m/s", joined(|frame| &frame.speed)),
            values("pressure", "Pa", joined(|frame| &frame.pressure)),
        ],
        x: Array::packed(&x),
        y: Array::packed(&z),
    }
}

/// Ends of the picture: all but strays, with a margin and a strip of the wall.
fn bounds(x: &[f64], z: &[f64], is_mirrored: bool, spacing: f64) -> [f64; 4] {
    let ends = |values: &[f64]| {
        let mut sorted: Vec<f64> = values.to_vec();
        sorted.sort_by(f64::total_cmp);
        let last = sorted.len().saturating_sub(1);
        let at =
            |share: f64| sorted.get((share * last as f64).round() as usize).copied().unwrap_or(0.0);
        [at(STRAY), at(1.0 - STRAY)]
    };
    let ([mut left, right], [_, top]) = (ends(x), ends(z));
    if is_mirrored {
        left = -right;
    }
    let (margin, top) = (0.05 * (right - left) + spacing, 1.08 * top + spacing);
    [left - margin, -0.06 * top.max(0.3 * (right - left)), right + margin, top]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn fluid_that_has_come_off_does_not_widen_the_picture() {
        let mut x: Vec<f64> = (0..1000).map(|i| f64::from(i) * 1e-6 - 0.5e-3).collect();
        x.push(1.0);
        let z = vec![1e-4; x.len()];
        let [left, bottom, right, top] = bounds(&x, &z, false, 1e-6);
        assert!(-6e-4 < left && right < 6e-4 && bottom < 0.0 && top < 1.2e-4);
    }

    #[test]
    fn sections_keep_the_layers_beside_the_middle() {
        let spacing = 1e-6;
        let y = [-1.5, -0.5, 0.5, 1.5].map(|layers| layers * spacing);
        let frame = Frame {
            position: y.iter().flat_map(|y| [0.0, *y, 0.0]).collect(),
            temperature: vec![300.0; 4],
            speed: vec![0.0; 4],
            pressure: vec![0.0; 4],
            ..Frame::default()
        };
        assert_eq!(Part::Section.shown(&frame, spacing, usize::MAX), [1, 2]);
        assert_eq!(Part::Side.shown(&frame, spacing, 2), [0, 2]);
    }
}
