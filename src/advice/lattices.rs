//! Lattices whose links store more than their law takes.

use super::Reviewer;
use crate::limits::{two_digits, two_digits_below};
use crate::quantity::percent;
use crate::scene::locate::Path;
use crate::scene::Lattice;
use crate::warning;

/// Energy that links store up to their strength, over the area below their law, from which on cracks take too much.
const MOST_STORED: f64 = 0.25;
pub fn review(reviewer: &mut Reviewer) {
    for (name, lattice) in reviewer.scene.lattices() {
        let path = Path::default().key("body").key(name);
        storing(reviewer, &path, lattice);
    }
}

/// Warns of links so long that what they store up to their strength counts among what their break takes.
fn storing(reviewer: &mut Reviewer, path: &Path, lattice: &Lattice) {
    let area = lattice.material.softening.law().and_then(|law| law.area());
    let (Some(area), Some(stored)) = (area, stored(lattice)) else { return };
    if stored <= MOST_STORED {
        return;
    }
    let excess = match stored < 2.0 {
        true => format!("{} of", percent(stored)),
        false => format!("{} times", two_digits(stored)),
    };
    let fine = lattice.spacing * MOST_STORED / stored;
    let beyond = if fine < lattice.least_spacing() { BEYOND } else { "" };
    let (area, fine) = (two_digits(area), two_digits_below(fine));
    let found = warning::links_store_more_than_their_law(excess, area, fine, beyond);
    reviewer.warn(&path.key("spacing"), found);
}

/// Energy that links store up to their strength, over the area below a law over openings.
fn stored(lattice: &Lattice) -> Option<f64> {
    let law = lattice.material.softening.law()?;
    law.stored_share(lattice.spacing, lattice.material.young)
}

/// Remedy where that many particles are too many.
const BEYOND: &str = ", more than a million particles here: make the strip smaller, or take a solid with `fracture` \
                      for a material this brittle";
