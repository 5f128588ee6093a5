//! Checks that a solid can be solved by the method that the scene sets and that its constants and faces need.

use super::Checker;
use crate::scene::locate::Path;
use crate::scene::lookup::split_place;
use crate::scene::types::{CellValues, HeatMethod, Layer, Scene, Solid, SolverMethod, Symmetry};

/// Returns true if Newton's method advances the heat of a solid.
pub fn takes_newton(scene: &Scene, solid: &Solid) -> bool {
    match scene.solver.method {
        SolverMethod::Newton => true,
        SolverMethod::Modal => false,
        SolverMethod::Auto => !solid.conducts_linearly(),
    }
}

/// Refuses loads without the symmetry of a nonlinear body's modelled part, which then cannot represent the whole.
fn even_loads(checker: &mut Checker, path: &Path) {
    let name = path.last_key().to_owned();
    for (i, load) in checker.scene.load.iter().enumerate() {
        if split_place(&load.on).is_none_or(|(body, _)| body != name) {
            continue;
        }
        let path = Path::default().key("load").index(i);
        for (key, value) in [("start.x", load.start.x), ("start.y", load.start.y)] {
            let message =
                "a quarter of a nonlinear body requires loads symmetric about x = 0 and y = 0";
            let fine = value.is_none_or(|value| value == 0.0);
            checker.require(
                fine,
                &path.at(key),
                message,
                "0, or `symmetry = \"none\"` for the body",
            );
        }
        for (key, value) in
            [("start.shear_x", &load.start.shear_x), ("start.shear_y", &load.start.shear_y)]
        {
            let fine = !matches!(value, Some(CellValues::Uniform(value)) if *value != 0.0);
            let message = "shear along one direction is not even about the planes of a quarter";
            let allowed = "0, or `symmetry = \"none\"` for the body";
            checker.require(fine, &path.at(key), message, allowed);
        }
        for (key, values) in
            [("start.heat_flux", &load.start.heat_flux), ("start.pressure", &load.start.pressure)]
        {
            let Some(CellValues::Tiles(rows)) = values else { continue };
            let message =
                "a quarter of a nonlinear body requires tiles symmetric about x = 0 and y = 0";
            let allowed = "such values, or `symmetry = \"none\"` for the body";
            checker.require(are_even(rows), &path.at(key), message, allowed);
        }
    }
}

/// Returns true if values of tiles are those of their mirror images.
fn are_even(rows: &[Vec<f64>]) -> bool {
    let is_even = |row: &Vec<f64>| row.iter().eq(row.iter().rev());
    rows.iter().eq(rows.iter().rev()) && rows.iter().all(is_even)
}

pub fn check(checker: &mut Checker, path: &Path, solid: &Solid) {
    let method = checker.scene.solver.method;
    if method == SolverMethod::Modal && !solid.conducts_linearly() {
        let message = "modes need constants independent of temperature, nothing that melts, no face that radiates and \
                       no bath";
        checker.refuse(&Path::default().at("solver.method"), message, "auto, newton");
    }
    if takes_newton(checker.scene, solid) && solid.heat == HeatMethod::Sph {
        let message = "particles conduct heat only with constants independent of temperature, and without Newton's method";
        checker.refuse(&path.key("heat"), message, "fem");
    }
    let is_part = solid.symmetry == Symmetry::Quarter;
    if is_part
        && (takes_newton(checker.scene, solid) || !solid.deforms_linearly() || solid.cracks())
    {
        even_loads(checker, path);
    }
    let resists = |layer: &Layer| layer.contact_resistance.is_some_and(|r| r > 0.0);
    if !solid.deforms_linearly() && solid.layers.iter().flatten().any(resists) {
        let message = "layers of a body that yields or relaxes, or whose elastic constants depend on the temperature, touch \
                       without resistance";
        checker.refuse(&path.key("layers"), message, "no `contact_resistance`");
    }
}
