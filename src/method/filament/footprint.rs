//! Place of a segment on the cells of the plate.
//!
//! The lower side of a segment, a rectangle along its direction, is cut into nearly square parts; each is replaced by a
//! square of the same area along the axes of the cells. So everything arrives where cells partition unity.

use super::Segment;
use crate::port::WallCells;

/// Largest number of parts along and across a segment.
const MOST: [f64; 2] = [16.0, 4.0];

/// Weights of the cells below a segment; with the part outside they sum to 1.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Footprint {
    pub cells: Vec<(usize, f64)>,
    pub outside: f64,
}

impl Footprint {
    pub fn of(segment: &Segment, cells: &WallCells) -> Self {
        let (length, width) = (segment.length(), segment.width());
        let along = (length / width).round().clamp(1.0, MOST[0]);
        let across = (width / length).round().clamp(1.0, MOST[1]);
        let half = 0.5 * (length * width / (along * across)).sqrt();
        let (direction, middle) = (segment.direction(), segment.middle());
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
                let cover = cells.cover(at.map(|x| [x - half, x + half]));
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
        assert!((footprint.outside - 0.5).abs() < 0.02, "{footprint:?}");
    }
}
