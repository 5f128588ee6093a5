//! Parts into which broken links divide a lattice.

use super::link::Link;
use crate::math::parts::Parts;

/// Number of parts of so many particles that unbroken links connect.
pub fn fragments(particles: usize, links: &[Link], damage: &[f64]) -> usize {
    let mut parts = Parts::new(particles);
    let unbroken = links.iter().zip(damage).filter(|(_, damage)| **damage < 1.0);
    unbroken.for_each(|(link, _)| parts.join(link.ends));
    parts.count()
}
