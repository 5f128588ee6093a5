//! Place of a segment on the cells of the plate.
//!
//! The lower side of a segment, a rectangle along its direction, becomes rectangles along the axes of the cells, where
//! cells partition unity: one of its size if it lies along an axis, otherwise one for each of nearly square parts, with
//! the same second moments along both axes.

use std::mem::take;
use std::sync::{Arc, Mutex};

use super::{Segment, Strand};
use crate::port::WallCells;

/// Parts of the shorter side of a segment that lies across the axes, and the largest numbers along and across it.
const PARTS: f64 = 3.0;
const MOST: [f64; 2] = [32.0, 12.0];
/// Cosine below which a segment lies along an axis.
const ALIGNED: f64 = 1e-6;

/// Weights of the cells below a segment; with the part outside they sum to 1.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Footprint {
    pub cells: Vec<(usize, f64)>,
    pub outside: f64,
}

/// Footprints of segments that have been found, with what they follow from. Most segments do not change any more.
#[derive(Debug, Default)]
pub struct Footprints(Mutex<Vec<(Outline, Arc<Footprint>)>>);

/// Place and extent of the lower side of a segment.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Outline {
    ends: [[f64; 2]; 2],
    extent: [f64; 2],
}

impl Footprints {
    /// The footprints of all segments of a strand; `cells` has none for a plane that does not conduct.
    pub fn of(&self, strand: &Strand, cells: Option<&WallCells>) -> Vec<Arc<Footprint>> {
        let Some(cells) = cells else { return vec![Arc::default(); strand.len()] };
        let mut known = self.0.lock().map(|mut known| take(&mut *known)).unwrap_or_default();
        known.truncate(strand.len());
        for (n, segment) in strand.segments().enumerate() {
            let extent = [segment.length(), segment.width()];
            let outline = Outline { ends: [segment.start, segment.end], extent };
            match known.get_mut(n) {
                Some((own, _)) if *own == outline => {}
                Some(own) => *own = (outline, Arc::new(Footprint::of(&segment, cells))),
                None => known.push((outline, Arc::new(Footprint::of(&segment, cells)))),
            }
        }
        let feet = known.iter().map(|(_, foot)| Arc::clone(foot)).collect();
        if let Ok(mut kept) = self.0.lock() {
            *kept = known;
        }
        feet
    }
}

impl Footprint {
    pub fn of(segment: &Segment, cells: &WallCells) -> Self {
        let (length, width) = (segment.length(), segment.width());
        let (direction, middle) = (segment.direction(), segment.middle());
        let is_along_axis = direction.iter().any(|cosine| cosine.abs() < ALIGNED);
        let parts = |extent: f64, most: f64| match is_along_axis {
            true => 1.0,
            false => (PARTS * extent / width.min(length)).round().clamp(1.0, most),
        };
        let (along, across) = (parts(length, MOST[0]), parts(width, MOST[1]));
        let [a, b] = [length / along, width / across];
        let half = [0, 1].map(|axis| 0.5 * (a * direction[axis]).hypot(b * direction[1 - axis]));
        let share = 1.0 / (along * across);
        let mut footprint = Self::default();
        for i in 0..along as usize {
            for j in 0..across as usize {
                let s = length * ((i as f64 + 0.5) / along - 0.5);
                let t = width * ((j as f64 + 0.5) / across - 0.5);
                let at = [
                    middle[0] + s * direction[0] - t * direction[1],
                    middle[1] + s * direction[1] + t * direction[0],
                ];
                let cover = cells.cover([0, 1].map(|n| [at[n] - half[n], at[n] + half[n]]));
                footprint.outside += share * cover.outside;
                cover.cells.iter().for_each(|&(cell, weight)| footprint.add(cell, share * weight));
            }
        }
        footprint
    }

    fn add(&mut self, cell: usize, weight: f64) {
        match self.cells.iter_mut().find(|(own, _)| *own == cell) {
            Some((_, sum)) => *sum += weight,
            None => self.cells.push((cell, weight)),
        }
    }

    /// Part on the cells.
    pub fn inside(&self) -> f64 {
        self.cells.iter().map(|(_, weight)| weight).sum()
    }

    /// Mean of a value of the cells; `None` beyond them.
    pub fn mean(&self, value: impl Fn(usize) -> f64) -> Option<f64> {
        let inside = self.inside();
        let sum: f64 = self.cells.iter().map(|&(cell, weight)| weight * value(cell)).sum();
        (inside > 0.0).then(|| sum / inside)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn amounts_and_their_middle_are_preserved() {
        let nodes: Vec<f64> = (0..41).map(|n| -2.0 + 0.1 * f64::from(n)).collect();
        let cells = WallCells::Nodes { x: nodes.clone(), y: nodes.clone() };
        let segment = Segment {
            start: [0.1, -0.3],
            end: [0.7, 0.2],
            half_width: 0.15,
            path: 0.781,
            ..Segment::default()
        };
        let footprint = Footprint::of(&segment, &cells);
        assert!((footprint.inside() - 1.0).abs() < 1e-12 && footprint.outside < 1e-12);
        for (axis, middle) in segment.middle().into_iter().enumerate() {
            let place = |cell: usize| nodes[if axis == 0 { cell % 41 } else { cell / 41 }];
            assert!((footprint.mean(place).unwrap() - middle).abs() < 1e-12);
        }
        let at_the_edge = Segment { start: [2.0, -0.4], end: [2.0, 0.4], path: 0.8, ..segment };
        let footprint = Footprint::of(&at_the_edge, &cells);
        assert!((footprint.outside - 0.5).abs() < 1e-9, "{footprint:?}");
    }
}
