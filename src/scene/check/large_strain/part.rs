//! Checks that a part has a file that describes a body, and a discretisation that suits it.

use super::super::Checker;
use crate::scene::large_strain::{LargeStrain, Mechanics};
use crate::scene::locate::Path;
use crate::scene::part::{BadPart, Part};

/// Refuses a part that cannot be modelled; returns true if its file describes a body.
pub fn check(checker: &mut Checker, path: &Path, solid: &LargeStrain, own: &Part) -> bool {
    let file = path.at("shape.part.file");
    let message = "the distance of nodes is that of the file";
    let fine = solid.mesh.spacing.is_none();
    checker.require(fine, &path.at("mesh.spacing"), message, "no `mesh.spacing`");
    let fine = own.is_known();
    if !checker.require(fine, &file, "a part has another kind of file", "a `.vtu` or a `.csv`") {
        return false;
    }
    let is_of_kernels = matches!(solid.mechanics, Mechanics::Rkpm | Mechanics::Efg);
    let message = match solid.mechanics {
        _ if is_of_kernels => {
            "kernels are integrated over cells about their nodes, which points do not have"
        }
        _ => "points have no elements",
    };
    let fine = !own.is_of_points() || solid.mechanics == Mechanics::Sph;
    let allowed = "`mechanics = \"sph\"`, or a `.vtu` file with cells";
    checker.require(fine, &path.key("mechanics"), message, allowed);
    if own.content.is_none() {
        let message = format!("the scene has no text of the file `{}`", own.file);
        checker.refuse(
            &file,
            message,
            "a scene that is read from a file, or the text in `[files]`",
        );
        return false;
    }
    if let Some(BadPart { line, text, message, allowed }) = own.bad() {
        let place = line.map_or(String::new(), |line| format!(":{line}"));
        let text = if text.is_empty() { String::new() } else { format!(" {text}:") };
        checker.refuse(&file, format!("{}{place}:{text} {message}", own.file), allowed);
    }
    own.body().is_some()
}
