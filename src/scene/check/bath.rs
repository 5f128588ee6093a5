//! Checks baths: the mesh that a moving surface needs, and faces for it to wet.

use super::Checker;
use crate::scene::locate::Path;
use crate::scene::types::Solid;

pub fn check(checker: &mut Checker) {
    for (name, solid) in checker.scene.solids() {
        if solid.bath.is_some() {
            let path = Path::default().key("body").key(name);
            mesh(checker, &path, solid);
            let message = "a bath, and no face that it could wet";
            let allowed = "a face without `temperature`, `flux`, `convection` and `radiation`";
            let fine = !solid.wetted_faces().is_empty();
            checker.require(fine, &path.key("bath"), message, allowed);
        }
    }
}

/// Requires equal elements along z, as the surface passes all heights.
fn mesh(checker: &mut Checker, path: &Path, solid: &Solid) {
    let keys = &solid.mesh;
    let fine = solid.cracks() || keys.depth_spacing.is_some() && keys.growth == Some(1.0);
    let message = "the surface of a bath passes all heights of the body, whose elements are to be of one size";
    let allowed = "`depth_spacing` and `growth = 1.0`, or a body that cracks";
    checker.require(fine, &path.key("mesh"), message, allowed);
}
