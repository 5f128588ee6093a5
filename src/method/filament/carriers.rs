//! The segments that carry another.

/// Largest number of segments that carry another.
pub const MOST_CARRIERS: usize = 8;

/// Segments on which a segment lies, each with its share of the lower side; none on the plate.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Carriers {
    /// Numbers of segments, where the share is not 0.
    pub segments: [usize; MOST_CARRIERS],
    /// Shares, which sum to 1, the largest first; all 0 on the plate.
    pub shares: [f64; MOST_CARRIERS],
}

impl Carriers {
    /// Carriers with shares in proportion to how often they were found under places of the lower side.
    pub fn of(found: impl IntoIterator<Item = usize>) -> Self {
        let mut counts: Vec<(usize, usize)> = Vec::new();
        for segment in found {
            match counts.iter_mut().find(|(own, _)| *own == segment) {
                Some((_, count)) => *count += 1,
                None => counts.push((segment, 1)),
            }
        }
        counts.sort_unstable_by_key(|&(segment, count)| (usize::MAX - count, segment));
        counts.truncate(MOST_CARRIERS);
        let all: usize = counts.iter().map(|(_, count)| count).sum();
        let mut carriers = Self::default();
        for (n, (segment, count)) in counts.into_iter().enumerate() {
            carriers.segments[n] = segment;
            carriers.shares[n] = count as f64 / all as f64;
        }
        carriers
    }

    /// Returns true for a segment on the plate.
    pub fn is_empty(&self) -> bool {
        self.shares[0] == 0.0
    }

    /// Segments and their shares.
    pub fn iter(&self) -> impl Iterator<Item = (usize, f64)> + use<> {
        self.segments.into_iter().zip(self.shares).filter(|(_, share)| *share > 0.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shares_are_those_of_the_places_found() {
        let carriers = Carriers::of([7, 3, 7, 7, 5, 3]);
        let found: Vec<_> = carriers.iter().collect();
        assert_eq!(found, [(7, 0.5), (3, 1.0 / 3.0), (5, 1.0 / 6.0)]);
        assert!(Carriers::of([]).is_empty() && Carriers::of([]).iter().next().is_none());
        // The smallest share of too many goes to the others.
        let many = Carriers::of((0..MOST_CARRIERS).flat_map(|n| [9 - n, 9 - n]).chain([90]));
        assert_eq!(many.segments, [2, 3, 4, 5, 6, 7, 8, 9]);
        assert_eq!(many.shares, [1.0 / 8.0; MOST_CARRIERS]);
    }
}
