//! Quantities of a solid with running maxima.

use super::SolidBody;
use super::linear::SolidChange;
use super::memo::SolidMemo;
use super::reader::SolidReader;
use crate::body::{BodyError, Descriptor, Direct, Extreme, Memo};
use crate::quantity::Quantity;
use crate::scene::{PeakOf, Shape, Solid};

/// Tolerance of places for rounding, relative to the body's extents.
const SLACK: f64 = 1e-9;

/// Returns the running maxima kept for a solid of a scene. They follow no input without delay: jumps caused by an input
/// are noted when a step begins, but for the stress of a body with prescribed temperatures.
pub fn kept_peaks(solid: &Solid) -> Vec<Descriptor> {
    let descriptor = |of: &PeakOf| {
        let (key, words, quantity) = match of {
            PeakOf::Temperature => ("peak_temperature", "temperature", Quantity::Temperature),
            PeakOf::VonMises => ("peak_von_mises", "von Mises stress", Quantity::Stress),
            PeakOf::MaxPrincipal => {
                ("peak_max_principal", "principal stress, tension positive", Quantity::Stress)
            }
        };
        Descriptor { key, words, quantity, direct: Direct::Nothing }
    };
    solid.peaks.iter().map(descriptor).collect()
}

impl SolidBody {
    /// Present maximum over the body, with its place.
    pub(super) fn highest(
        &self,
        reader: &mut SolidReader,
        which: usize,
    ) -> Result<Extreme, BodyError> {
        Ok(match self.peaks[which] {
            PeakOf::Temperature => reader.hottest(),
            PeakOf::VonMises => reader.most_stressed()?[0],
            PeakOf::MaxPrincipal => reader.most_stressed()?[1],
        })
    }

    /// Highest temperature just after prescribed ones may have jumped, from that of the nodes `now`. Nodes next to a
    /// face that has cooled balance the heat of its nodes at once, and may be hotter than the body was and its faces
    /// are.
    pub(super) fn possible_after_jump(
        &self,
        now: Extreme,
        (state, inputs): (&[f64], &[f64]),
        memo: &mut Memo,
        so_far: Option<Extreme>,
    ) -> Extreme {
        let before = so_far.map_or(self.plan.initial_temperature, |highest| highest.value);
        let limit = self.loads.temperatures_of_faces(inputs).fold(before, f64::max);
        let exceeds = now.value > limit * (1.0 + SLACK);
        if !exceeds {
            return now;
        }
        let memo = SolidMemo::of_mut(memo);
        let Extreme { at, .. } = self.solid.hottest_within(memo.heat(self, state), limit);
        Extreme { value: limit, at }
    }

    /// Rate of change of that maximum.
    pub(super) fn highest_rate(
        &self,
        both: &mut SolidChange,
        which: usize,
    ) -> Result<f64, BodyError> {
        Ok(match self.peaks[which] {
            PeakOf::Temperature => both.max_temperature_rate(),
            PeakOf::VonMises => both.max_stress_rate()?[0],
            PeakOf::MaxPrincipal => both.max_stress_rate()?[1],
        })
    }

    /// Returns true if it follows from displacements.
    pub(super) fn is_stress_peak(&self, which: usize) -> bool {
        self.peaks[which].is_mechanical()
    }

    /// Refuses impossible values, and places outside the body.
    pub(super) fn check_highest(&self, which: usize, peak: &Extreme) -> Result<(), String> {
        let Extreme { value, at } = *peak;
        let is_value = match self.peaks[which] {
            PeakOf::Temperature => value > 0.0,
            PeakOf::VonMises => value >= 0.0,
            PeakOf::MaxPrincipal => value > f64::MIN,
        };
        if !is_value {
            return Err(format!("{value} as a running maximum of {}", self.name));
        }
        let [x, y, z] = at;
        let reaches = |coordinate: f64, extent: f64| coordinate.abs() <= extent * (1.0 + SLACK);
        let within = match self.shape {
            Shape::Box([lx, ly, _]) => reaches(x, lx / 2.0) && reaches(y, ly / 2.0),
            Shape::Disc(disc) => reaches(x.hypot(y), disc.radius),
        };
        let thickness = self.shape.thickness();
        match within && reaches(z, thickness) && z <= SLACK * thickness {
            true => Ok(()),
            false => Err(format!("a running maximum of {} at {at:?}, outside of it", self.name)),
        }
    }
}
