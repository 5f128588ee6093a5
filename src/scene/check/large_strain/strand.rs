//! Checks that a path is that of a strand.

use super::super::Checker;
use crate::scene::large_strain::{LargeStrain, Strand};
use crate::scene::locate::Path;
use crate::space::BadPath;

/// Most points of a path, each of whose pieces is compared with all others.
const MOST_POINTS: usize = 1000;

/// Refuses a path that is that of no strand; returns true if it is that of one.
pub fn check(checker: &mut Checker, path: &Path, solid: &LargeStrain, own: &Strand) -> bool {
    let path = path.at("shape.strand.path");
    let message = "the path has too few or too many points";
    let fine = (2..=MOST_POINTS).contains(&own.path.len());
    let allowed = format!("2 to {MOST_POINTS} points");
    // A number that is none is reason enough.
    let has_radius = own.radius > 0.0 && own.radius.is_finite();
    if !checker.is_fine(&path) || !checker.require(fine, &path, message, allowed) || !has_radius {
        return false;
    }
    if solid.dimension == 2
        && let Some(point) = own.path.iter().position(|at| at[1] != 0.0)
    {
        let at = path.index(point).index(1);
        checker.refuse(&at, "a strip lies in the plane y = 0", "0, or `dimension = 3`");
        return false;
    }
    let Some(fault) = own.sweep(solid.form()).fault() else { return true };
    let (point, message, allowed) = match fault {
        BadPath::Twice { point } => {
            (point, "this point is at the place of the one before".to_owned(), "another place")
        }
        BadPath::Sharp { point } => {
            let message = "the bend is too sharp: on its inner side too little of the pieces beside it is left";
            let allowed = "longer pieces, a smaller `radius`, or a bend of several points with a radius above that of \
                           the strand";
            (point, message.to_owned(), allowed)
        }
        BadPath::Meets { points: [first, second] } => {
            let message = format!("the strand meets its piece from point {first} on");
            (second, message, "pieces a diameter apart")
        }
    };
    checker.refuse(&path.index(point), message, allowed);
    false
}
