//! Checks that walls lie below droplets and have suitable cells.

use super::coupling::resists;
use super::{Checker, start};
use crate::scene::droplet::Droplet;
use crate::scene::locate::Path;
use crate::scene::types::Footprint;

pub fn check(checker: &mut Checker) {
    for (i, wall) in checker.scene.wall.iter().enumerate() {
        let path = Path::default().key("wall").index(i);
        cells(checker, &path.at("footprint"), &wall.footprint);
        let has_cells = checker.is_fine(&path.at("footprint"));
        if let Some(values) = wall.start.temperature.as_ref().filter(|_| has_cells) {
            start::cells(checker, &path.at("start.temperature"), values, wall.footprint.cells());
        }
        let Some(droplet) = checker.droplet(&path.at("under"), &wall.under) else { continue };
        if let Some(first) = checker.scene.wall_under(&wall.under).filter(|&first| first != i) {
            let message = format!("`{}` has wall[{first}] below it already", wall.under);
            checker.refuse(&path.at("under"), message, "one wall a droplet");
        }
        if wall.conductance.is_some() {
            resists(checker, &path.at("conductance"), droplet);
        }
        if has_cells {
            fit(checker, &path.at("footprint"), &wall.footprint, droplet);
        }
    }
}

fn cells(checker: &mut Checker, path: &Path, footprint: &Footprint) {
    let message = "a wall is cut into cells, each with a temperature and a flux of its own";
    let path = path.key(footprint.name());
    checker.require(footprint.cells().is_some(), &path, message, "rings, tiles");
}

/// Checks the cells of a wall: rings for axisymmetric models, a row of tiles for plane ones.
fn fit(checker: &mut Checker, path: &Path, footprint: &Footprint, droplet: &Droplet) {
    let path = path.key(footprint.name());
    match footprint {
        Footprint::Tiles { count, .. } if droplet.dimension == 2 => {
            let message = "a plane model has a single row of tiles along x";
            checker.require(count[1] == 1, &path.at("count").index(1), message, "1");
        }
        Footprint::Rings { .. } if droplet.dimension == 2 => {
            checker.refuse(&path, "rings are not for a plane model", "tiles");
        }
        Footprint::Rings { .. } => {
            let message = "rings need all drops to arrive at x = 0, y = 0";
            checker.require(droplet.is_centred(), &path, message, "tiles");
            let message = "rings need all drops to come straight down";
            checker.require(droplet.is_straight(), &path, message, "tiles, or impact_angle = 0.0");
        }
        _ => {}
    }
}
