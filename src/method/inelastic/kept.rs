//! Solvers of linear systems that are kept for steps with the same tangents.
//!
//! The tangent of a body whose moduli relax depends on the length of a step alone, if temperatures shift nothing, and
//! so does that of a body that does not yield yet. What is kept changes no bit: a solver follows from its key.

use std::sync::Arc;

use crate::laws::PointTangent;
use crate::runtime::fork_lock::ForkLock;

/// Values by their keys, those used last at the end.
pub struct Kept<K, V> {
    values: ForkLock<Vec<(K, Arc<V>)>>,
    most: usize,
}

impl<K: PartialEq, V> Kept<K, V> {
    /// Creates an empty list that keeps at most this number of values.
    pub fn new(most: usize) -> Self {
        Self { values: ForkLock::new(Vec::new()), most }
    }

    pub fn most(&self) -> usize {
        self.most
    }

    pub fn get(&self, key: &K) -> Option<Arc<V>> {
        let mut values = self.values.lock();
        let place = values.iter().position(|(own, _)| own == key)?;
        let found = values.remove(place);
        let value = found.1.clone();
        values.push(found);
        Some(value)
    }

    pub fn keep(&self, key: K, value: Arc<V>) {
        let mut values = self.values.lock();
        if values.len() >= self.most {
            values.remove(0);
        }
        values.push((key, value));
    }
}

/// Tangents of all points as runs of equal ones; `None` if there are more than `most` runs.
pub fn runs(tangents: &[PointTangent], most: usize) -> Option<Vec<(PointTangent, usize)>> {
    let mut runs: Vec<(PointTangent, usize)> = Vec::new();
    for tangent in tangents {
        let full = runs.len() == most;
        match runs.last_mut() {
            Some((own, count)) if own == tangent => *count += 1,
            _ if full => return None,
            _ => runs.push((*tangent, 1)),
        }
    }
    Some(runs)
}

/// Elastic tangent that represents some points: their own if they have one in common, otherwise their mean, rounded to
/// a power of √2 so that it recurs while they change little.
pub fn representative(tangents: &[PointTangent]) -> PointTangent {
    let own = PointTangent { along: 0.0, direction: [0.0; 6], ..tangents[0] };
    if tangents.iter().all(|other| *other == own) {
        return own;
    }
    let mean = |modulus: fn(&PointTangent) -> f64| {
        let sum: f64 = tangents.iter().map(modulus).sum();
        (0.5 * (2.0 * (sum / tangents.len() as f64).log2()).round()).exp2()
    };
    PointTangent { bulk: mean(|own| own.bulk), all: mean(|own| own.all), ..own }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn tangent(all: f64) -> PointTangent {
        PointTangent { bulk: 3.0, all, along: 0.0, direction: [0.0; 6] }
    }

    #[test]
    fn values_used_last_are_kept() {
        let kept = Kept::new(2);
        for key in [1, 2] {
            kept.keep(key, Arc::new(10 * key));
        }
        assert_eq!(kept.get(&1).as_deref(), Some(&10));
        kept.keep(3, Arc::new(30));
        assert_eq!(kept.get(&2), None);
        assert_eq!([1, 3].map(|key| kept.get(&key).map(|value| *value)), [Some(10), Some(30)]);
    }

    #[test]
    fn tangents_of_layers_are_few_runs() {
        let tangents = [1.0, 1.0, 2.0, 2.0, 2.0].map(tangent);
        assert_eq!(runs(&tangents, 2), Some(vec![(tangent(1.0), 2), (tangent(2.0), 3)]));
        assert_eq!(runs(&tangents, 1), None);
    }

    #[test]
    fn points_alike_are_represented_exactly_and_others_by_a_power_of_the_root_of_two() {
        assert_eq!(representative(&[0.7, 0.7].map(tangent)), tangent(0.7));
        let found = representative(&[0.9, 1.0, 1.2].map(tangent));
        assert_eq!(found.all, 1.0);
    }
}
