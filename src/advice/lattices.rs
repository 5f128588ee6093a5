//! Lattices whose links store more than their law takes, or resist bending by themselves.

use super::Reviewer;
use crate::limits::{number, two_digits, two_digits_below};
use crate::quantity::percent;
use crate::scene::locate::Path;
use crate::scene::{Lattice, LatticeArrangement, LatticeSupport};
use crate::warning;

/// Energy that links store up to their strength, over the area below their law, from which on cracks take too much.
const MOST_STORED: f64 = 0.25;
/// Share of its stiffness in bending that links may add to that of a strip: up to there it is that of Timoshenko's
/// beams to 15 %.
const MOST_STIFFENING: f64 = 0.2;
/// Stiffening of random links over that of hexagons, measured at ratios of −0.95 and −0.99 with 12 and 24 rows.
const UNEVEN: f64 = 1.5;

pub fn review(reviewer: &mut Reviewer) {
    for (name, lattice) in reviewer.scene.lattices() {
        let path = Path::default().key("body").key(name);
        storing(reviewer, &path, lattice);
        bending(reviewer, &path, lattice);
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

/// Warns of bent strips that their links stiffen.
fn bending(reviewer: &mut Reviewer, path: &Path, lattice: &Lattice) {
    let LatticeSupport::ThreePoint(_) = lattice.support else { return };
    let stiffening = stiffening(lattice);
    if stiffening > MOST_STIFFENING {
        let fine = lattice.spacing * (MOST_STIFFENING / stiffening).sqrt();
        let (ratio, share) = (number(lattice.material.poisson), percent(stiffening));
        let (fine, above) = (two_digits_below(fine), number(least_ratio(lattice)));
        let found = warning::links_stiffen_bending(ratio, share, fine, above);
        reviewer.warn(&path.at("material.poisson"), found);
    }
}

/// Stiffness in bending that links add, over that of the strip: curvature bends links, too, and theirs is that of
/// `√3 EI/s` per length, so that it is `(s/d)² (1 − 3ν)/(1 − ν²)`.
fn stiffening(lattice: &Lattice) -> f64 {
    let ratio = lattice.material.poisson;
    uneven(lattice) * (lattice.spacing / lattice.depth).powi(2) * (1.0 - 3.0 * ratio)
        / (1.0 - ratio * ratio)
}

fn uneven(lattice: &Lattice) -> f64 {
    if lattice.arrangement == LatticeArrangement::Random { UNEVEN } else { 1.0 }
}

/// Least ratio of two decimals at which links add no more than they may: the root of `1 − 3ν = q (1 − ν²)`.
fn least_ratio(lattice: &Lattice) -> f64 {
    let q = MOST_STIFFENING / uneven(lattice) * (lattice.depth / lattice.spacing).powi(2);
    let root = (3.0 - (9.0 - 4.0 * q * (1.0 - q)).sqrt()) / (2.0 * q);
    (100.0 * root).ceil() / 100.0
}
