//! Converts inputs to the drives of a reduced model: amounts of loads, values of faces, and moving footprints.
//!
//! A footprint that moves within its range is interpolated by a product of polynomials in place and radius, through
//! footprints at Chebyshev points. The drives are the amount times the weight of each of these.

use std::f64::consts::PI;

use crate::channel::{Channel, Direction};
use crate::inputs::{FaceInputKind, InputLayout, LoadInputs};
use crate::scene::{Load, Scene};

/// All drives of a body.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Drives {
    pub list: Vec<Drive>,
    pub families: Vec<Family>,
    /// Inputs that are constant at their start values: the place in the list, the value [m] and the load's name.
    pub fixed: Vec<(usize, f64, String)>,
}

/// Kind of a drive, with its unit; drives of one kind are comparable.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum DriveKind {
    /// [W/m²]
    Flux,
    /// [W]
    Power,
    /// [Pa]
    Traction,
    /// [K]
    Temperature,
}

impl DriveKind {
    fn of(channel: Channel) -> Self {
        match channel.direction() {
            Direction::Heat if channel.is_of_whole() => Self::Power,
            Direction::Heat => Self::Flux,
            Direction::Inward | Direction::Along(_) | Direction::Outward => Self::Traction,
        }
    }
}

/// A scalar drive of the model.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Drive {
    pub kind: DriveKind,
    /// Place of its input.
    pub index: usize,
    /// Value of the input at which the drive is zero.
    pub base: f64,
    /// The family of footprints, and the member of it.
    pub member: Option<(usize, usize)>,
}

/// Footprints of a load at points of its range.
#[derive(Debug, Clone, PartialEq)]
pub struct Family {
    /// Places of the inputs x, y and radius, if they exist.
    pub places: [Option<usize>; 3],
    pub points: [Points; 3],
}

/// Chebyshev points over a range.
#[derive(Debug, Clone, PartialEq)]
pub struct Points {
    pub range: [f64; 2],
    pub count: usize,
}

impl Points {
    pub fn at(&self, point: usize) -> f64 {
        let [low, high] = self.range;
        0.5 * (low + high) - 0.5 * (high - low) * angle(point, self.count).cos()
    }

    /// A place between two points, or at an end of the range.
    fn between(&self, number: usize) -> f64 {
        let [low, high] = self.range;
        0.5 * (low + high) - 0.5 * (high - low) * (PI * number as f64 / self.count as f64).cos()
    }

    /// Weight of each point at a place, and its derivative by the place.
    fn weights(&self, place: f64) -> Vec<[f64; 2]> {
        let of_point = |point: usize| {
            let at = self.at(point);
            let (mut value, mut slope) = (1.0, 0.0);
            for other in (0..self.count).filter(|&other| other != point) {
                let factor = [place - self.at(other), 1.0].map(|part| part / (at - self.at(other)));
                slope = slope * factor[0] + value * factor[1];
                value *= factor[0];
            }
            [value, slope]
        };
        (0..self.count).map(of_point).collect()
    }
}

fn angle(point: usize, count: usize) -> f64 {
    PI * (point as f64 + 0.5) / count as f64
}

impl Family {
    /// Bound on the sum of the sizes of all weights: the Lebesgue constant of Chebyshev points along each axis (T. J.
    /// Rivlin, *Chebyshev Polynomials*, Wiley 1990, §1.3).
    fn spread(&self) -> f64 {
        let along = |points: &Points| 1.0 + 2.0 / PI * (points.count as f64).ln();
        self.points.iter().map(along).product()
    }

    pub fn len(&self) -> usize {
        self.points.iter().map(|points| points.count).product()
    }

    /// Returns x, y and radius of a member; `None` where there is no input.
    pub fn place(&self, member: usize) -> [Option<f64>; 3] {
        let numbers = self.numbers(member);
        [0, 1, 2].map(|a| self.places[a].map(|_| self.points[a].at(numbers[a])))
    }

    fn numbers(&self, member: usize) -> [usize; 3] {
        let [x, y, _] = &self.points;
        [member % x.count, member / x.count % y.count, member / (x.count * y.count)]
    }

    /// Weights of all members under inputs, with their rates of change for rates of the inputs.
    fn weights(&self, inputs: &[f64], rates: Option<&[f64]>) -> Vec<[f64; 2]> {
        let along = [0, 1, 2].map(|a| match self.places[a] {
            Some(index) => self.points[a].weights(inputs[index]),
            None => vec![[1.0, 0.0]],
        });
        let speed = |a: usize| match (self.places[a], rates) {
            (Some(index), Some(rates)) => rates[index],
            _ => 0.0,
        };
        let of_member = |member: usize| {
            let numbers = self.numbers(member);
            let parts = [0, 1, 2].map(|a| along[a][numbers[a]]);
            let [x, y, z] = parts.map(|part| part[0]);
            let change = speed(0) * parts[0][1] * y * z
                + speed(1) * x * parts[1][1] * z
                + speed(2) * x * y * parts[2][1];
            [x * y * z, change]
        };
        (0..self.len()).map(of_member).collect()
    }
}

impl Drives {
    /// Drives of a body's loads and faces; `points` returns the number of footprints over a load's range of x, y and
    /// radius.
    pub fn of(
        scene: &Scene,
        layout: &InputLayout,
        body: &str,
        points: impl Fn(&Load) -> [usize; 3],
    ) -> Self {
        let mut out = Self::default();
        let own = scene.load.iter().zip(&layout.loads);
        for (load, places) in own.filter(|(load, _)| load.body_and_face().0 == body) {
            out.add_load(load, places, points(load));
        }
        let initial = scene.body[body].initial_temperature();
        for face in layout.faces.iter().filter(|face| face.body == body) {
            let (kind, base) = match face.kind {
                FaceInputKind::Flux => (DriveKind::Flux, 0.0),
                _ => (DriveKind::Temperature, initial),
            };
            out.list.push(Drive { kind, index: face.index, base, member: None });
        }
        out
    }

    fn add_load(&mut self, load: &Load, places: &LoadInputs, counts: [usize; 3]) {
        let inputs = [places.x, places.y, places.radius];
        let ranges = [load.range.x, load.range.y, load.range.radius];
        let start = &load.start;
        let radius = start.radius.or(load.footprint.radius()).unwrap_or(0.0);
        let starts = [start.x.unwrap_or(0.0), start.y.unwrap_or(0.0), radius];
        let mut moving = [None; 3];
        let mut points = starts.map(|start| Points { range: [start; 2], count: 1 });
        for a in 0..3 {
            let Some(index) = inputs[a] else { continue };
            match ranges[a].filter(|[low, high]| low < high) {
                Some(range) => {
                    moving[a] = Some(index);
                    points[a] = Points { range, count: counts[a].max(1) };
                }
                None => self.fixed.push((index, starts[a], load.name.clone())),
            }
        }
        let family = moving.iter().any(Option::is_some).then(|| {
            self.families.push(Family { places: moving, points });
            self.families.len() - 1
        });
        let members = family.map_or(1, |family| self.families[family].len());
        for (channel, range) in &places.amounts {
            let kind = DriveKind::of(*channel);
            for index in range.clone() {
                for member in 0..members {
                    let member = family.map(|family| (family, member));
                    self.list.push(Drive { kind, index, base: 0.0, member });
                }
            }
        }
    }

    /// Returns inputs with a unit of one amount on a footprint between the supporting ones, and the place of that
    /// amount. At these places the interpolation error is largest; places along one axis at a time are sufficient.
    pub fn trials(&self, start: &[f64]) -> Vec<(usize, Vec<f64>)> {
        let mut still = start.to_vec();
        self.list.iter().for_each(|drive| still[drive.index] = drive.base);
        let mut trials = Vec::new();
        let firsts = self.list.iter().filter_map(|drive| match drive.member {
            Some((family, 0)) => Some((drive.index, family)),
            _ => None,
        });
        for (index, family) in firsts {
            let Family { places, points } = &self.families[family];
            for axis in 0..3 {
                let Some(_) = places[axis] else { continue };
                for between in 0..=points[axis].count {
                    let mut inputs = still.clone();
                    inputs[index] = 1.0;
                    for (other, place) in places.iter().enumerate() {
                        let Some(place) = place else { continue };
                        let own = &points[other];
                        inputs[*place] = if other == axis {
                            own.between(between)
                        } else {
                            // Off the middle, which is a supporting point if their number is odd.
                            0.35 * own.range[0] + 0.65 * own.range[1]
                        };
                    }
                    trials.push((index, inputs));
                }
            }
        }
        trials
    }

    /// Size of the amount of each drive under inputs, wherever its footprint is.
    pub fn amounts(&self, inputs: &[f64]) -> Vec<f64> {
        self.list.iter().map(|drive| (inputs[drive.index] - drive.base).abs()).collect()
    }

    /// Largest sum of the weights of a drive's footprints at any place: 1 for those that do not move.
    pub fn spread(&self, drive: usize) -> f64 {
        self.list[drive].member.map_or(1.0, |(family, _)| self.families[family].spread())
    }

    /// Sets of drives of one amount: its footprints where it moves, else one drive.
    pub fn groups(&self) -> Vec<Vec<usize>> {
        let key = |drive: &Drive| (drive.index, drive.member.map(|(family, _)| family));
        let mut groups: Vec<Vec<usize>> = Vec::new();
        for (place, drive) in self.list.iter().enumerate() {
            let own = groups.iter_mut().find(|group| key(&self.list[group[0]]) == key(drive));
            match own.filter(|_| drive.member.is_some()) {
                Some(group) => group.push(place),
                None => groups.push(vec![place]),
            }
        }
        groups
    }

    /// Largest sum over the drives of some values per unit of each, under amounts that may be anywhere in their ranges.
    pub fn largest(&self, amounts: &[f64], value: impl Fn(usize) -> f64) -> f64 {
        let of_group = |group: &Vec<usize>| {
            let most = group.iter().map(|&drive| value(drive)).fold(0.0, f64::max);
            // Not zero times infinity.
            let amount = amounts[group[0]];
            if amount == 0.0 { 0.0 } else { amount * self.spread(group[0]) * most }
        };
        self.groups().iter().map(of_group).sum()
    }

    /// Values of the drives under inputs.
    pub fn values(&self, inputs: &[f64]) -> Vec<f64> {
        let weights = self.weights(inputs, None);
        let value = |drive: &Drive| {
            let amount = inputs[drive.index] - drive.base;
            drive.member.map_or(amount, |(family, member)| amount * weights[family][member][0])
        };
        self.list.iter().map(value).collect()
    }

    /// Rates of the drives when the inputs change at `rates`.
    pub fn changes(&self, inputs: &[f64], rates: &[f64]) -> Vec<f64> {
        let weights = self.weights(inputs, Some(rates));
        let change = |drive: &Drive| match drive.member {
            None => rates[drive.index],
            Some((family, member)) => {
                let [weight, change] = weights[family][member];
                rates[drive.index] * weight + inputs[drive.index] * change
            }
        };
        self.list.iter().map(change).collect()
    }

    fn weights(&self, inputs: &[f64], rates: Option<&[f64]>) -> Vec<Vec<[f64; 2]>> {
        self.families.iter().map(|family| family.weights(inputs, rates)).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn family() -> Drives {
        let points = |range, count| Points { range, count };
        let family = Family {
            places: [Some(1), None, Some(2)],
            points: [points([-1.0, 2.0], 5), points([0.0; 2], 1), points([0.5, 1.0], 4)],
        };
        let kind = DriveKind::Flux;
        let drive = |member| Drive { kind, index: 0, base: 0.0, member: Some((0, member)) };
        Drives { list: (0..20).map(drive).collect(), families: vec![family], fixed: Vec::new() }
    }

    #[test]
    fn families_repeat_polynomials_of_place_and_radius() {
        let drives = family();
        let f = |x: f64, r: f64| (1.0 - x + 0.3 * x.powi(4)) * (2.0 + r.powi(3));
        for [x, r] in [[-0.9, 0.51], [0.3, 0.77], [2.0, 1.0]] {
            let values = drives.values(&[3.0, x, r]);
            let at = |member: usize| {
                let [x, _, r] = drives.families[0].place(member);
                f(x.unwrap(), r.unwrap())
            };
            let sum: f64 = values.iter().enumerate().map(|(m, value)| value * at(m)).sum();
            assert!((sum - 3.0 * f(x, r)).abs() < 1e-12);
        }
    }

    #[test]
    fn changes_are_the_limit_of_differences() {
        let drives = family();
        let (inputs, rates, h) = ([3.0, 0.4, 0.8], [0.7, -2.0, 0.3], 1e-6);
        let moved = |sign: f64| {
            drives.values(&std::array::from_fn::<_, 3, _>(|i| inputs[i] + sign * h * rates[i]))
        };
        let found = drives.changes(&inputs, &rates);
        for ((high, low), change) in moved(1.0).iter().zip(moved(-1.0)).zip(found) {
            assert!(((high - low) / (2.0 * h) - change).abs() < 1e-8);
        }
    }
}
