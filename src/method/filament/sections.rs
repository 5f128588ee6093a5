//! Sections and widths with which fluid is laid: of strands at any speed of the nozzle, and of heaps where it stands.
//!
//! A strand has the section `A = Q/v` of the flow Q and the speed v of the nozzle. The nozzle presses up to the section
//! A_l at the limit of slow nozzles to the gap; more rises beside it. A strand begins with up to A_l at once, and grows
//! along the path s by `dA/ds ≤ A/w` with its width w. What comes beyond that makes a heap, which is longer than its
//! path: its section is that of the volume over its length. Lengths, areas and widths go evenly from heaps to strands.

use super::line::Line;
use super::{Segment, Strand};

/// Speed of the nozzle over that of the fluid in it at which the section of the strand is the largest that the nozzle
/// presses to the gap and from which on a strand may begin at once.
pub const SLOW: f64 = 0.25;
/// Volume that a strand does not hold over its section, as length of a heap at most.
const HEAPED: f64 = 4.0;
/// Least gap above an older segment, over the diameter of the nozzle, with which a strand lies on that.
pub const CLEARANCE: f64 = 0.1;
/// Rounding that a comparison of volumes leaves room for, and one of places.
pub const SLACK: f64 = 1e-9;
pub const EDGE: f64 = 1e-6;

impl Line {
    /// Section of a strand at the limit of slow nozzles [m²].
    pub(super) fn thick(&self) -> f64 {
        self.plan.outlet() / SLOW
    }

    /// Returns true for a segment that a slow nozzle laid.
    pub(super) fn is_thick(&self, segment: &Segment) -> bool {
        segment.volume > self.thick() * segment.path
    }

    /// Largest length of a segment [m], if it is a heap; 0 for a strand. A strand holds up to a section at the limit,
    /// or that of the segment before it, which may grow by a factor e over its width. What does not fit in lengthens
    /// the segment, until its path is as long as the strand of its volume is wide.
    pub(super) fn longest(
        &self,
        (strand, index): (&Strand, usize),
        segment: &Segment,
        gap: f64,
    ) -> f64 {
        let Segment { volume, path, .. } = *segment;
        if !self.is_thick(segment) {
            return 0.0;
        }
        let goes_on = |before: &Segment| {
            let rise = (segment.outlet - before.outlet).abs();
            before.end == segment.start && rise < CLEARANCE * self.plan.diameter
        };
        let before = index.checked_sub(1).map(|n| strand.segment(n)).filter(goes_on);
        let of_before = before.map(|before| {
            let laid = self.laid(strand, &before);
            (laid.section(), laid.width())
        });
        let of_limit = (self.thick(), self.strand_width((self.thick(), 1.0), gap));
        let (section, width) =
            of_before.filter(|(section, _)| *section > self.thick()).unwrap_or(of_limit);
        let held = section * (1.0 + path / width) * (1.0 + SLACK);
        let excess = volume / held - path;
        let left = 1.0 - path / self.strand_width((volume, path), gap);
        if excess > 0.0 && left > 0.0 { path + HEAPED * excess * left } else { 0.0 }
    }

    /// A segment before it spread.
    pub(super) fn laid(&self, strand: &Strand, segment: &Segment) -> Segment {
        let width = self.laid_width(segment, segment.outlet - floor(strand, segment));
        Segment { half_width: 0.5 * width, ..*segment }
    }

    /// Width with which a segment is laid above a gap [m].
    pub(super) fn laid_width(&self, segment: &Segment, gap: f64) -> f64 {
        let Segment { volume, path, longest, .. } = *segment;
        if volume == 0.0 {
            return 0.0;
        }
        let of = |length: f64| self.strand_width((volume, length), gap);
        if !segment.is_heap() {
            return of(path);
        }
        let square = volume.cbrt().max((volume / gap).sqrt().min(self.thick() / gap));
        match square {
            square if square < path => of(path),
            square if square > longest => of(longest),
            _ => square,
        }
    }

    /// Width with which a volume [m³] is laid along a length [m] above a gap: as wide as high, or pressed. The nozzle
    /// presses up to the section at the limit of slow nozzles; more rises beside it.
    pub(super) fn strand_width(&self, (volume, length): (f64, f64), gap: f64) -> f64 {
        let pressed = volume.min(self.thick() * length);
        (volume / length).sqrt().max(pressed / (length * gap))
    }
}

/// Height above which the outlet presses a segment [m]: that of its base, or that of the outlet which laid what carries
/// it, if that has risen around the nozzle.
pub fn floor(strand: &Strand, segment: &Segment) -> f64 {
    let outlets = segment.below.iter().map(|(n, _)| strand.outlet_of(n));
    let highest = outlets.fold(0.0, f64::max);
    match segment.below.is_empty() || segment.base <= highest * (1.0 + EDGE) {
        true => segment.base,
        false => highest,
    }
}
