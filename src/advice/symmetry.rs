//! Planes of symmetry on which conditions of faces act that they have not.

use super::Reviewer;
use crate::scene::locate::Path;
use crate::scene::{FaceName, Solid};
use crate::warning;

pub fn review(reviewer: &mut Reviewer) {
    for (name, solid) in reviewer.scene.solids() {
        let path = Path::default().key("body").key(name).key("faces");
        for face in wet_planes(solid) {
            let finding = warning::bath_wets_symmetry(face.as_str());
            reviewer.warn(&path.key(face.as_str()), finding);
        }
    }
}

/// Lateral faces on rollers that a bath wets; a bottom on rollers stands on something.
fn wet_planes(solid: &Solid) -> Vec<FaceName> {
    if solid.bath.is_none() {
        return Vec::new();
    }
    let is_plane = |&face: &FaceName| {
        face.is_one_of_four_sides() && solid.faces.get(&face).is_some_and(|own| own.roller)
    };
    solid.wetted_faces().into_iter().filter(is_plane).collect()
}
