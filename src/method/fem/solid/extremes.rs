//! The highest and lowest values of a solid, and their places.

use std::borrow::Cow;

use super::{Deformation, SolidFem, SolidLoads, Temperatures};
use crate::laws::stress::{max_principal, von_mises};
use crate::method::mesh::Geometry;

/// The highest of some values over a body, and its place [m]. Among places whose values differ only by rounding, it is
/// the one nearest to the centre of the top, or else the first. A symmetric body then favours neither side.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Extreme {
    pub value: f64,
    pub at: [f64; 3],
}

/// Relative differences of values due to rounding and iterations.
const ROUNDING: f64 = 1e-9;

/// A highest value with the square of its distance from the centre of the top [m²].
struct Candidate {
    extreme: Extreme,
    distance: f64,
    slack: f64,
}

impl Extreme {
    /// Highest of values with places by their numbers; NaN counts as the highest.
    fn of(values: &[f64], place: impl Fn(usize) -> [f64; 3]) -> Self {
        Candidate::of(values, place).extreme
    }
}

impl Candidate {
    fn of(values: &[f64], place: impl Fn(usize) -> [f64; 3]) -> Self {
        let (mut value, mut largest) = (f64::NEG_INFINITY, 0.0_f64);
        for &other in values {
            // Not `max`, which would ignore NaN.
            if !(value >= other || value.is_nan()) {
                value = other;
            }
            largest = largest.max(other.abs());
        }
        let slack = ROUNDING * largest;
        let (mut at, mut distance) = ([0.0; 3], f64::INFINITY);
        let high = values.iter().enumerate().filter(|(_, other)| **other >= value - slack);
        for (number, _) in high {
            let other = place(number);
            let square = other.iter().map(|coordinate| coordinate * coordinate).sum();
            if square < distance {
                (at, distance) = (other, square);
            }
        }
        Self { extreme: Extreme { value, at }, distance, slack }
    }

    /// Returns the highest of several candidates.
    fn highest(all: Vec<Self>) -> Extreme {
        let values: Vec<f64> = all.iter().map(|own| own.extreme.value).collect();
        let Extreme { value, .. } = Extreme::of(&values, |_| [0.0; 3]);
        let slack = all.iter().fold(0.0_f64, |most, own| most.max(own.slack));
        let high = all.iter().filter(|own| own.extreme.value >= value - slack);
        let nearest = high.reduce(|one, two| if two.distance < one.distance { two } else { one });
        Extreme { value, at: nearest.map_or([0.0; 3], |own| own.extreme.at) }
    }
}

impl SolidFem {
    /// Highest nodal temperature [K].
    pub fn hottest(&self, temperatures: &Temperatures) -> Extreme {
        self.hottest_within(temperatures, f64::INFINITY)
    }

    /// Highest nodal temperature that exceeds a limit by no more than rounding [K].
    pub fn hottest_within(&self, temperatures: &Temperatures, limit: f64) -> Extreme {
        let zero = self.initial_temperature;
        let most = limit + ROUNDING * limit.abs() - zero;
        let of_image = |image| {
            let mut rises = self.rise_of_image(temperatures, image);
            // Nodes above the limit count as if at absolute zero.
            rises.iter_mut().filter(|rise| **rise > most).for_each(|rise| *rise = -zero);
            Candidate::of(&rises, |node| self.place_of_sided(node, image))
        };
        let rise =
            Candidate::highest(self.images(temperatures).into_iter().map(of_image).collect());
        Extreme { value: self.initial_temperature + rise.value, ..rise }
    }

    /// Lowest nodal temperature [K].
    pub fn min_temperature(&self, temperatures: &Temperatures) -> f64 {
        let mut lowest = f64::INFINITY;
        for image in self.images(temperatures) {
            let rise = self.rise_of_image(temperatures, image);
            lowest = rise.into_iter().fold(lowest, f64::min);
        }
        self.initial_temperature + lowest
    }

    /// Lowest and highest temperature of the nodes of top and bottom [K].
    pub fn range_of_ends(&self, state: &[f64], loads: &SolidLoads) -> [f64; 2] {
        let plane = self.mesh.axes[0].len() * self.mesh.axes[1].len();
        let mut range = [f64::INFINITY, f64::NEG_INFINITY];
        for high in [false, true] {
            let classes = self.end_rise(state, loads, high);
            for image in self.images(&classes) {
                for rise in self.sum_at_image(&classes, image, plane) {
                    range = [range[0].min(rise), range[1].max(rise)];
                }
            }
        }
        range.map(|rise| self.initial_temperature + rise)
    }

    /// Highest von Mises and largest principal stress over all nodes [Pa].
    pub fn most_stressed(
        &self,
        temperatures: &Temperatures,
        deformation: &Deformation,
    ) -> [Extreme; 2] {
        let nodal = self.nodal_strains(deformation);
        let images = self.images(&deformation.displacement).into_iter();
        self.most_stressed_of(images.map(|image| {
            (image, Cow::Owned(self.stress_in(temperatures, deformation, &nodal, image)))
        }))
    }

    /// The same of known stresses at the nodes of images.
    pub fn most_stressed_of<'s>(
        &self,
        stresses: impl Iterator<Item = ([bool; 2], Cow<'s, [[f64; 6]]>)>,
    ) -> [Extreme; 2] {
        let mut found = [Vec::new(), Vec::new()];
        for (image, stresses) in stresses {
            let measures: [fn([f64; 6]) -> f64; 2] = [von_mises, max_principal];
            for (measure, found) in measures.into_iter().zip(&mut found) {
                let values: Vec<f64> = stresses.iter().map(|stress| measure(*stress)).collect();
                found.push(Candidate::of(&values, |node| self.place_of_sided(node, image)));
            }
        }
        found.map(Candidate::highest)
    }

    /// Highest of values at the nodes of images.
    pub(super) fn highest_of(&self, all: &[(Vec<f64>, [bool; 2])]) -> Extreme {
        let of_image = |(values, image): &(Vec<f64>, [bool; 2])| {
            Candidate::of(values, |node| self.place_of_sided(node, *image))
        };
        Candidate::highest(all.iter().map(of_image).collect())
    }

    /// Place of a node of an image, by its number in the list with doubled interfaces [m].
    fn place_of_sided(&self, number: usize, image: [bool; 2]) -> [f64; 3] {
        let [nx, ny, _] = self.mesh.sided_counts();
        let [x, y, z] = self.mesh.axes.each_ref();
        let signed = |coordinate: f64, image: bool| if image { -coordinate } else { coordinate };
        let along_y = match self.mesh.geometry {
            Geometry::Box => signed(y.nodes[number / nx % ny], image[1]),
            Geometry::Axisymmetric => 0.0,
        };
        let level = self.nodes_of_sided[number / (nx * ny)];
        [signed(x.nodes[number % nx], image[0]), along_y, z.nodes[level]]
    }
}
