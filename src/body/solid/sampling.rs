//! Times at which loads are sampled over a step in which footprints move or grow.

use super::BodyLoads;
use crate::inputs::InputPath;

/// Number of parts of a step while a footprint moves or grows by its own size.
pub const PARTS_OF_A_FOOTPRINT: f64 = 8.0;
/// Ratio of a footprint's largest to its smallest radius below which a piece of a step has equal parts.
const RATIO: f64 = 2.0;
/// Pieces are halved up to this number of times.
const MOST_HALVINGS: usize = 64;

/// Division of a step into parts, over each of which loads are quadratics in time.
///
/// A step is first halved into pieces in which no radius changes by a factor of 2 or more. A piece has equal parts, in
/// each of which a footprint moves or grows by at most an eighth of its least size there. A radius that falls evenly
/// from `r₀` to `r₁` thus takes some `12 log₂(r₀/r₁)` parts, not `8 r₀/r₁`.
pub struct Sampling {
    pieces: Vec<Piece>,
}

/// Equal parts from one time of a step to another [s].
#[derive(Debug, Clone, Copy, PartialEq)]
struct Piece {
    begin: f64,
    end: f64,
    /// Number of parts, a whole number.
    parts: f64,
}

/// A part of a step: its begin, middle, end and duration [s].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Part {
    pub begin: f64,
    pub middle: f64,
    pub end: f64,
    pub duration: f64,
}

impl Sampling {
    /// Divides a step of a duration [s].
    pub fn of(loads: &BodyLoads, path: &InputPath, duration: f64) -> Self {
        let mut sampling = Self { pieces: Vec::new() };
        sampling.divide(loads, path, [0.0, duration], MOST_HALVINGS);
        sampling
    }

    fn divide(
        &mut self,
        loads: &BodyLoads,
        path: &InputPath,
        [begin, end]: [f64; 2],
        halvings: usize,
    ) {
        let (rest, duration) = (path.from(begin), end - begin);
        let middle = begin + 0.5 * duration;
        let is_cut = begin < middle && middle < end;
        if is_cut && halvings > 0 && loads.ratio_of_radii(&rest, duration) >= RATIO {
            self.divide(loads, path, [begin, middle], halvings - 1);
            self.divide(loads, path, [middle, end], halvings - 1);
            return;
        }
        let travel = loads.travel(&rest, duration);
        let parts = (PARTS_OF_A_FOOTPRINT * travel).ceil().max(1.0);
        self.pieces.push(Piece { begin, end, parts });
    }

    /// Number of parts.
    pub fn count(&self) -> f64 {
        self.pieces.iter().map(|piece| piece.parts).sum()
    }

    /// Parts in the order of time.
    pub fn parts(&self) -> impl Iterator<Item = Part> {
        self.pieces.iter().flat_map(|&Piece { begin, end, parts }| {
            let duration = (end - begin) / parts;
            let at = move |part: f64| begin + part * duration;
            (0..parts as usize).map(|n| n as f64).map(move |n| Part {
                begin: at(n),
                middle: at(n + 0.5),
                end: at(n + 1.0),
                duration,
            })
        })
    }
}

#[cfg(test)]
mod tests {
    use super::super::loads::tests::{BOX, loads};
    use super::*;

    /// Parts of a step of 1 s in which the radius and the place of a disc change.
    fn sampling(radii: [f64; 2], way: f64) -> Sampling {
        let (loads, _) = loads(BOX, "disc = { radius = 0.3 }", "range = { x = [-0.2, 0.2] }");
        let path =
            InputPath::new(&[1.0, 0.0, 0.0, radii[0]], &[vec![0.0, way, 0.0, radii[1] - radii[0]]]);
        Sampling::of(&loads, &path, 1.0)
    }

    #[test]
    fn parts_follow_each_other_through_the_step() {
        for (radii, way) in [([0.3, 0.3], 0.0), ([0.3, 0.02], 0.1), ([1e-9, 0.3], 0.1)] {
            let sampling = sampling(radii, way);
            let mut time = 0.0;
            for part in sampling.parts() {
                assert!(
                    (part.begin - time).abs() < 1e-12 && part.duration > 0.0,
                    "{part:?} {time}"
                );
                time = part.end;
            }
            assert!((time - 1.0).abs() < 1e-12);
            assert_eq!(sampling.parts().count() as f64, sampling.count());
        }
    }

    #[test]
    fn footprints_change_by_an_eighth_of_themselves_in_a_part() {
        for (radii, way) in [([0.3, 0.3], 0.2), ([0.3, 0.02], 0.1), ([0.02, 0.3], 0.0)] {
            for part in sampling(radii, way).parts() {
                let at = |s: f64| radii[0] + s * (radii[1] - radii[0]);
                let least = at(part.begin).min(at(part.end));
                let change = ((radii[1] - radii[0]).abs() + way) * part.duration;
                assert!(change <= 0.125 * least * (1.0 + 1e-9), "{change} of {least}");
            }
        }
    }

    /// Equal parts of the whole step would be a billion.
    #[test]
    fn parts_grow_with_the_logarithm_of_the_ratio_of_radii() {
        let parts = [1e-3, 1e-6, 1e-9].map(|ratio| sampling([0.3, 0.3 * ratio], 0.0).count());
        assert!(parts[0] < 150.0, "{parts:?}");
        assert!((parts[2] - parts[1] - (parts[1] - parts[0])).abs() < 20.0, "{parts:?}");
    }
}
