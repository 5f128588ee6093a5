//! Order in which the places of a body break within a step.

use super::broken::broken;

/// The alternation in which each node first broke, with its damage then.
///
/// Alternations follow a crack from where it begins: damage of the first is that of the stress before the crack, and
/// each later one moves its tip by some elements.
#[derive(Debug, Clone, Default)]
pub struct BreakingOrder {
    first: Vec<Option<(usize, f64)>>,
}

impl BreakingOrder {
    /// Notes the nodes that are broken after an alternation.
    pub(super) fn note(&mut self, alternation: usize, damage: &[f64]) {
        self.first.resize(damage.len(), None);
        let broken = broken(damage);
        for (node, first) in self.first.iter_mut().enumerate().filter(|(node, _)| broken[*node]) {
            first.get_or_insert((alternation, damage[node]));
        }
    }

    /// The one of some nodes that broke first, with the largest damage among those of one alternation.
    pub fn first_of(&self, nodes: &[usize]) -> Option<usize> {
        let broken = nodes.iter().filter_map(|&node| Some((node, (*self.first.get(node)?)?)));
        let earlier = |(_, (a, one)): &(usize, (usize, f64)),
                       (_, (b, other)): &(usize, (usize, f64))| {
            a.cmp(b).then(other.total_cmp(one))
        };
        broken.min_by(earlier).map(|(node, _)| node)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn earliest_alternation_then_largest_damage_is_first() {
        let mut order = BreakingOrder::default();
        order.note(1, &[0.1, 0.2, 0.95, 0.3]);
        order.note(2, &[0.92, 0.97, 1.0, 0.5]);
        assert_eq!(order.first_of(&[0, 1, 2, 3]), Some(2));
        assert_eq!(order.first_of(&[0, 1, 3]), Some(1));
        assert_eq!(order.first_of(&[3]), None);
        assert_eq!(BreakingOrder::default().first_of(&[0]), None);
    }
}
