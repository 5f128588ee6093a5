//! Places of a long list that represent all of it.

use std::collections::BTreeSet;

/// 1/φ of the golden ratio φ.
const GOLDEN: f64 = 0.618_033_988_749_895;

/// Returns at most `most` places of a list of `count`, ascending: all, or where the multiples of 1/φ modulo 1 fall
/// first, which lie evenly in every stretch of the list and follow no period of it (Kronecker's sequence of least
/// discrepancy).
pub fn sample(count: usize, most: usize) -> Vec<usize> {
    if count <= most {
        return (0..count).collect();
    }
    let mut places = BTreeSet::new();
    let mut position: f64 = 0.0;
    while places.len() < most {
        places.insert((position * count as f64) as usize);
        position = (position + GOLDEN).fract();
    }
    places.into_iter().collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn short_lists_are_taken_whole() {
        assert_eq!(sample(5, 5), [0, 1, 2, 3, 4]);
        assert!(sample(0, 5).is_empty());
    }

    #[test]
    fn samples_are_distinct_and_evenly_distributed() {
        for count in [257, 300, 1000, 65_536, 100_000] {
            let places = sample(count, 256);
            assert_eq!(places.len(), 256);
            assert!(places.is_sorted_by(|a, b| a < b) && places[255] < count, "{count}");
            let widest = places.windows(2).map(|pair| pair[1] - pair[0]).max().unwrap();
            assert!(widest <= 3 * count.div_ceil(256), "{count}: {widest}");
            for columns in [2, 5, 10, 16] {
                let mut hits = vec![0; columns];
                places.iter().for_each(|place| hits[place % columns] += 1);
                let fewest = hits.iter().min().unwrap();
                assert!(4 * fewest * columns >= 256, "{count}, {columns} columns: {hits:?}");
            }
        }
    }
}
