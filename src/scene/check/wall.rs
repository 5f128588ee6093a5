//! Checks that walls lie below droplets or solids of large strain that fall, and have suitable cells.

use super::coupling::resists;
use super::{Checker, list_or, start};
use crate::scene::coupling::Wall;
use crate::scene::droplet::Droplet;
use crate::scene::large_strain::{LargeStrain, LargeStrainSymmetry};
use crate::scene::locate::Path;
use crate::scene::spelling::hint;
use crate::scene::types::Footprint;

pub fn check(checker: &mut Checker) {
    for (i, wall) in checker.scene.wall.iter().enumerate() {
        let path = Path::default().key("wall").index(i);
        cells(checker, &path.at("footprint"), &wall.footprint);
        let has_cells = checker.is_fine(&path.at("footprint"));
        if let Some(values) = wall.start.temperature.as_ref().filter(|_| has_cells) {
            start::cells(checker, &path.at("start.temperature"), values, wall.footprint.cells());
        }
        if !has_body(checker, &path.at("under"), &wall.under) {
            continue;
        }
        if let Some(first) = checker.scene.wall_under(&wall.under).filter(|&first| first != i) {
            let message = format!("`{}` has wall[{first}] below it already", wall.under);
            checker.refuse(&path.at("under"), message, "one wall a body");
        }
        if let Some(droplet) = checker.scene.droplet(&wall.under) {
            under_droplet(checker, &path, wall, droplet, has_cells);
        }
        if let Some(solid) = checker.scene.large_strain(&wall.under) {
            under_solid(checker, &path, wall, solid, has_cells);
        }
    }
}

fn cells(checker: &mut Checker, path: &Path, footprint: &Footprint) {
    let message = "a wall is cut into cells, each with a temperature and a flux of its own";
    let path = path.key(footprint.name());
    checker.require(footprint.cells().is_some(), &path, message, "rings, tiles");
}

/// Refuses a name of nothing that may fall on a wall; returns true if there is a body to check.
fn has_body(checker: &mut Checker, path: &Path, name: &str) -> bool {
    let scene = checker.scene;
    if scene.droplet(name).is_some() || scene.large_strain(name).is_some() {
        return true;
    }
    let droplets = scene.droplets().map(|(name, _)| name);
    let solids = scene.large_strains().filter(|(_, solid)| solid.is_above());
    let known: Vec<&str> = droplets.chain(solids.map(|(name, _)| name)).collect();
    let hint = hint(name, known.iter().copied());
    let message = format!("there is no droplet or solid of large strain `{name}`{hint}");
    checker.refuse(path, message, list_or(known.join(", "), FALLING));
    false
}

/// Bodies that may fall on a wall.
const FALLING: &str = "a droplet, or a solid of large strain with explicit motion";

fn under_droplet(
    checker: &mut Checker,
    path: &Path,
    wall: &Wall,
    droplet: &Droplet,
    has_cells: bool,
) {
    if wall.conductance.is_some() {
        resists(checker, &path.at("conductance"), droplet);
    }
    let path = path.at("footprint").key(wall.footprint.name());
    if !has_cells || !is_of_form(checker, &path, &wall.footprint, droplet.dimension) {
        return;
    }
    if matches!(wall.footprint, Footprint::Rings { .. }) {
        let message = "rings need all drops to arrive at x = 0, y = 0";
        checker.require(droplet.is_centred(), &path, message, "tiles");
        let message = "rings need all drops to come straight down";
        checker.require(droplet.is_straight(), &path, message, "tiles, or impact_angle = 0.0");
    }
}

fn under_solid(
    checker: &mut Checker,
    path: &Path,
    wall: &Wall,
    solid: &LargeStrain,
    has_cells: bool,
) {
    let message = match solid.inertia {
        true => "a body that moves implicitly touches nothing below",
        false => "a body in equilibrium does not fall",
    };
    if !checker.require(solid.is_above(), &path.at("under"), message, FALLING) {
        return;
    }
    let message = "heat passes from a solid of large strain through a `conductance` alone, which does not follow the \
                   response of what lies below";
    let fine = wall.effusivity.is_none();
    checker.require(fine, &path.at("effusivity"), message, "no `effusivity`; `conductance`");
    let path = path.at("footprint").key(wall.footprint.name());
    if !has_cells || !is_of_form(checker, &path, &wall.footprint, solid.dimension) {
        return;
    }
    match wall.footprint {
        Footprint::Rings { .. } => {
            let message = "rings need a body that falls straight down at x = 0, y = 0";
            checker.require(solid.falls_centred(), &path, message, "tiles");
        }
        _ => {
            let message = "a meridian section of the body meets no tiles";
            let fine = solid.symmetry != LargeStrainSymmetry::Axisymmetric;
            let allowed = "rings; or `symmetry` of the body: auto, none, quarter";
            checker.require(fine, &path, message, allowed);
        }
    }
}

/// Requires a row of tiles below a plane model; returns true if the cells fit the dimension of the model.
fn is_of_form(checker: &mut Checker, path: &Path, footprint: &Footprint, dimension: usize) -> bool {
    match footprint {
        Footprint::Tiles { count, .. } if dimension == 2 => {
            let message = "a plane model has a single row of tiles along x";
            checker.require(count[1] == 1, &path.at("count").index(1), message, "1")
        }
        Footprint::Rings { .. } if dimension == 2 => {
            checker.refuse(path, "rings are not for a plane model", "tiles");
            false
        }
        _ => true,
    }
}
