//! Segments by place: those that a new segment may lie on, found without a look at all.

use std::collections::HashMap;

use super::{Segment, Strand};

/// Squares of the plate with the segments that touch them, in the order in which these were laid.
#[derive(Debug, Default)]
pub struct Beneath {
    /// Side of a square [m].
    side: f64,
    squares: HashMap<[i64; 2], Vec<usize>>,
    /// Length of the strand from its beginning to the end of each segment [m].
    along: Vec<f64>,
    /// First segment of the piece without interruption that each segment belongs to.
    piece: Vec<usize>,
}

/// Largest number of squares along a side of a segment; a wider one counts everywhere.
const MOST: i64 = 64;
/// The square of segments that count everywhere.
const EVERYWHERE: [i64; 2] = [i64::MAX; 2];

impl Beneath {
    /// The first segments of a strand.
    pub fn of(strand: &Strand, count: usize) -> Self {
        let extents =
            strand.segments().take(count).map(|segment| segment.length() + segment.width());
        let side = extents.sum::<f64>() / count.max(1) as f64;
        let mut beneath = Self { side, ..Self::default() };
        beneath.extend(strand, count);
        beneath
    }

    /// Adds the segments of a strand up to a number.
    pub fn extend(&mut self, strand: &Strand, count: usize) {
        for n in self.along.len()..count {
            let segment = strand.segment(n);
            let before = n.checked_sub(1).map(|n| strand.segment(n));
            let goes_on = before.is_some_and(|before| before.end == segment.start);
            self.piece.push(if goes_on { self.piece[n - 1] } else { n });
            self.along.push(self.along.last().copied().unwrap_or(0.0) + segment.path);
            for square in self.squares_of(&segment) {
                self.squares.entry(square).or_default().push(n);
            }
        }
    }

    /// Segments that may be under one of some places, the newest first.
    pub fn near(&self, places: impl IntoIterator<Item = [f64; 2]>) -> Vec<usize> {
        let numbered = places.into_iter().map(|place| place.map(|at| self.number(at)));
        let mut squares: Vec<[i64; 2]> = numbered.chain([EVERYWHERE]).collect();
        squares.sort_unstable();
        squares.dedup();
        let lists = squares.iter().filter_map(|square| self.squares.get(square));
        let mut near: Vec<usize> = lists.flatten().copied().collect();
        near.sort_unstable_by(|a, b| b.cmp(a));
        near.dedup();
        near
    }

    /// Length of the strand between an older segment and one that would follow the last with this start; infinite if
    /// the strand is interrupted there.
    pub fn apart(&self, older: usize, (strand, next): (&Strand, [f64; 2])) -> f64 {
        let last = self.along.len() - 1;
        match strand.segment(last).end == next && self.piece[last] <= older {
            true => self.along[last] - self.along[older],
            false => f64::INFINITY,
        }
    }

    fn number(&self, at: f64) -> i64 {
        if self.side > 0.0 { (at / self.side).floor() as i64 } else { 0 }
    }

    fn squares_of(&self, segment: &Segment) -> Vec<[i64; 2]> {
        let ranges = [0, 1].map(|axis| {
            let (a, b) = (segment.start[axis], segment.end[axis]);
            let reach = segment.half_width;
            [a.min(b) - reach, a.max(b) + reach].map(|at| self.number(at))
        });
        if ranges.iter().any(|[low, high]| high.saturating_sub(*low) >= MOST) {
            return vec![EVERYWHERE];
        }
        let [[x, to_x], [y, to_y]] = ranges;
        (x..=to_x).flat_map(|x| (y..=to_y).map(move |y| [x, y])).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Every segment within its half-width of a place is found, on a random walk with a wide heap and interruptions.
    #[test]
    fn search_finds_all_segments_under_a_place() {
        let mut strand = Strand::new(0, [0.0; 3]);
        let mut seed = 7_u64;
        let mut random = || {
            seed = seed.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            (seed >> 11) as f64 / (1_u64 << 53) as f64 - 0.5
        };
        let mut end = [0.0; 2];
        for n in 0..400 {
            let start = if n % 50 == 0 { [random(), random()] } else { end };
            end = start.map(|at| at + 0.05 * random());
            let half_width = if n == 77 { 0.8 } else { 0.01 + 0.01 * random() };
            let path = (end[0] - start[0]).hypot(end[1] - start[1]);
            let volume = 1.0;
            strand.push(&Segment { start, end, half_width, path, volume, ..Segment::default() });
        }
        let beneath = Beneath::of(&strand, 400);
        for _ in 0..300 {
            let place = [random(), random()];
            let near = beneath.near([place]);
            for (n, segment) in strand.segments().enumerate() {
                let is_under = segment.distance(place) <= segment.half_width;
                assert!(!is_under || near.contains(&n), "{n} {segment:?}");
            }
            assert!(near.windows(2).all(|pair| pair[0] > pair[1]));
        }
        let next = strand.segment(399).end;
        let between: f64 = strand.segments().skip(381).map(|segment| segment.path).sum();
        assert!((beneath.apart(380, (&strand, next)) - between).abs() < 1e-12);
        assert!(beneath.apart(340, (&strand, next)).is_infinite());
        assert!(beneath.apart(380, (&strand, [9.0; 2])).is_infinite());
    }
}
