//! Supports that reach so far that uneven nodes bend too softly.

use super::{Reviewer, number};
use crate::scene::locate::Path;
use crate::scene::{KernelIntegration, LargeStrain, Mechanics};
use crate::warning;

/// Supports from which on cantilevers of 8 cells across, whose nodes are off a lattice by 0.1 to 0.45 of their
/// distance, sink by 5 % too much and more, by particles and by kernels with Gauss points (`docs/maps/solids.md`), and
/// the most.
const WIDE: [f64; 2] = [2.5, 4.0];
const MOST: &str = "up to 13 %";
/// Supports with which they err by 4.4 % and 3 % at most.
const FINE: [f64; 2] = [2.2, 3.0];

/// Warns of parts from files alone: the nodes of other shapes stand in rows.
pub fn review(reviewer: &mut Reviewer) {
    for (name, solid) in reviewer.scene.large_strains() {
        let Some((key, support, method)) = support(solid) else { continue };
        if solid.part().is_some() && support >= WIDE[method] {
            let path = Path::default().key("body").key(name).key(key).key("support");
            let found = warning::supports_soften(number(support), MOST, number(FINE[method]));
            reviewer.warn(&path, found);
        }
    }
}

/// The key of the supports of a method that softens, their size, and its place in the lists.
fn support(solid: &LargeStrain) -> Option<(&'static str, f64, usize)> {
    let kernels = solid.rkpm.unwrap_or_default();
    match solid.mechanics {
        Mechanics::Sph => Some(("sph", solid.sph.unwrap_or_default().support, 0)),
        Mechanics::Rkpm if kernels.integration == KernelIntegration::Gauss => {
            Some(("rkpm", kernels.support?, 1))
        }
        Mechanics::Rkpm | Mechanics::Efg | Mechanics::Fem => None,
    }
}
