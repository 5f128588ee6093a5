//! Lattices whose links store more than their law takes, or resist bending by themselves; and the errors of lattices by
//! the number of their particles.

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
    let excess = times(stored);
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

/// A part of something in words: `40 % of` or `130 times`.
fn times(part: f64) -> String {
    match part < 2.0 {
        true => format!("{} of", percent(part)),
        false => format!("{} times", two_digits(part)),
    }
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
        let (ratio, share) = (number(lattice.material.poisson), times(stiffening));
        let above = number(least_ratio(lattice));
        let finer = match fine < lattice.least_spacing() {
            true => String::new(),
            false => format!(", or a `spacing` of {} m or less", two_digits_below(fine)),
        };
        let found = warning::links_stiffen_bending(ratio, share, above, finer);
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

/// Errors of a lattice that come from its number of particles, as parts: measured relative to finer ones
/// (`docs/theory/lattice.md`).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LatticeErrors {
    /// Stiffness: of a bent strip in bending, of a pulled one along it.
    pub stiffness: f64,
    /// Energy of a crack.
    pub energy: f64,
    /// Largest load of a bent strip.
    pub peak: Option<f64>,
    /// Number of particles over the depth, and the number that suffices if that is larger.
    pub rows: f64,
    pub enough: Option<f64>,
}

/// Error of the stiffness in bending times the number of particles over the depth, at ratios from −0.9 on: half a row
/// at each face is missing. Of random ones the error is that of samples, whatever their number.
const BENT: [f64; 2] = [1.4, 0.8];
const BENT_RANDOM: f64 = 0.06;
/// Error of the stiffness of a pulled strip times the number of particles along it: half a column at each end.
const PULLED: f64 = 2.0;
/// Spacings that a crack has to go up to which the largest load has an error, and that of hexagons across and of
/// others.
const PEAKS: [(f64, [f64; 2]); 3] =
    [(8.0, [0.05, 0.15]), (16.0, [0.03, 0.1]), (f64::INFINITY, [0.02, 0.05])];
/// Part by which the energies of cracks of pulled strips differ from sample to sample.
const SAMPLES: f64 = 0.25;
/// Error of the work of a break times the square of the spacings that a crack has to go.
const WORK: f64 = 20.0;
/// Spacings that a crack has to go from which on more of them hardly count: 24 over a depth of which a third is
/// notched.
const ENOUGH: f64 = 16.0;

impl LatticeErrors {
    pub fn of(lattice: &Lattice) -> Self {
        let (rows, way) = (lattice.depth / lattice.spacing, lattice.ligament());
        let stored = stored(lattice).unwrap_or(0.0);
        let (across, along) = match lattice.arrangement {
            LatticeArrangement::Across => (true, BENT[0] / rows),
            LatticeArrangement::Along => (false, BENT[1] / rows),
            LatticeArrangement::Random => (false, BENT_RANDOM),
        };
        let LatticeSupport::ThreePoint(_) = lattice.support else {
            let stiffness = PULLED * lattice.spacing / lattice.length;
            return Self { stiffness, energy: SAMPLES.max(stored), peak: None, rows, enough: None };
        };
        let stiffness = along.max(stiffening(lattice));
        let peaks = PEAKS.iter().find(|(most, _)| way < *most).map_or([0.0; 2], |row| row.1);
        // Loads of brittle strips grow with the root of the energy of a crack.
        let peak = if across { peaks[0] } else { peaks[1] }.max((1.0 + stored).sqrt() - 1.0);
        let enough = (way < ENOUGH * (1.0 - 1e-9)).then(|| (rows * ENOUGH / way).ceil());
        let energy = (WORK / (way * way)).max(stored);
        Self { stiffness, energy, peak: Some(peak), rows, enough }
    }
}
