//! Whether a solid can be solved as the scene asks, and as its constants and faces need.

use super::Checker;
use crate::scene::locate::Path;
use crate::scene::types::{HeatMethod, Scene, Solid, SolverMethod};

/// Whether Newton's method advances the heat of a solid.
pub fn takes_newton(scene: &Scene, solid: &Solid) -> bool {
    match scene.solver.method {
        SolverMethod::Newton => true,
        SolverMethod::Modal => false,
        SolverMethod::Auto => !solid.conducts_linearly(),
    }
}

pub fn check(checker: &mut Checker, path: &Path, solid: &Solid) {
    let method = checker.scene.solver.method;
    if method == SolverMethod::Modal && !solid.conducts_linearly() {
        let message =
            "modes need constants that are numbers, nothing that melts and no face that radiates";
        checker.refuse(&Path::default().at("solver.method"), message, "auto, newton");
    }
    if takes_newton(checker.scene, solid) && solid.heat == HeatMethod::Sph {
        let message = "particles conduct heat with constants that are numbers alone, and by no Newton's method";
        checker.refuse(&path.key("heat"), message, "fem");
    }
    let resists =
        |layer: &crate::scene::types::Layer| layer.contact_resistance.is_some_and(|r| r > 0.0);
    if !solid.deforms_linearly() && solid.layers.iter().flatten().any(resists) {
        let message = "layers of a body that yields, or whose elastic constants depend on the temperature, touch \
                       without resistance";
        checker.refuse(&path.key("layers"), message, "no `contact_resistance`");
    }
}
