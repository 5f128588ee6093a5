//! Whether walls lie below droplets and are cut into cells that fit them.

use super::{Checker, load, start};
use crate::scene::droplet::{Droplet, Wall};
use crate::scene::locate::Path;
use crate::scene::types::{CellValues, Footprint};

pub fn check(checker: &mut Checker) {
    for (i, wall) in checker.scene.wall.iter().enumerate() {
        let path = Path::default().key("wall").index(i);
        let before = checker.problems.len();
        load::footprint(checker, &path.at("footprint"), &wall.footprint);
        cells(checker, &path.at("footprint"), &wall.footprint);
        let has_cells = checker.problems.len() == before;
        let positive = wall.effusivity.is_none_or(|effusivity| effusivity > 0.0);
        let message = "the effusivity √(kρc) of what lies below is positive";
        checker.require(positive, &path.at("effusivity"), message, "> 0 (W √s/(m² K))");
        if has_cells {
            temperatures(checker, &path.at("start.temperature"), wall);
        }
        let Some(droplet) = checker.droplet(&path.at("under"), &wall.under) else { continue };
        if let Some(first) = checker.scene.wall_under(&wall.under).filter(|&first| first != i) {
            let message = format!("`{}` has wall[{first}] below it already", wall.under);
            checker.refuse(&path.at("under"), message, "one wall a droplet");
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

fn temperatures(checker: &mut Checker, path: &Path, wall: &Wall) {
    let Some(values) = &wall.start.temperature else { return };
    start::cells(checker, path, values, wall.footprint.cells());
    match values {
        CellValues::Uniform(value) => checker.temperature(path, *value),
        CellValues::Rings(list) => {
            for (i, &value) in list.iter().enumerate() {
                checker.temperature(&path.index(i), value);
            }
        }
        CellValues::Tiles(rows) => {
            for (i, row) in rows.iter().enumerate() {
                for (j, &value) in row.iter().enumerate() {
                    checker.temperature(&path.index(i).index(j), value);
                }
            }
        }
    }
}

/// Rings are for what is round about the axis, a row of tiles for what is plane.
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
        }
        _ => {}
    }
}
