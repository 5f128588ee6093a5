//! Parts into which broken links divide a lattice.

use super::link::Link;

/// Number of parts of so many particles that unbroken links connect.
pub fn fragments(particles: usize, links: &[Link], damage: &[f64]) -> usize {
    let mut parent: Vec<usize> = (0..particles).collect();
    let unbroken = links.iter().zip(damage).filter(|(_, damage)| **damage < 1.0);
    let mut parts = particles;
    for (link, _) in unbroken {
        let [a, b] = link.ends.map(|end| root(&mut parent, end));
        if a != b {
            parent[a.max(b)] = a.min(b);
            parts -= 1;
        }
    }
    parts
}

/// First particle of the part that a particle is in; halves the way there.
fn root(parent: &mut [usize], mut at: usize) -> usize {
    while parent[at] != at {
        parent[at] = parent[parent[at]];
        at = parent[at];
    }
    at
}
