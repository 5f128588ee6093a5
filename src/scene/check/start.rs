//! Checks start values and bounds of a load's inputs.

use super::{Checker, number};
use crate::channel::{Channel, Direction};
use crate::scene::locate::Path;
use crate::scene::types::{Carries, CellShape, CellValues, Load};

pub fn check(checker: &mut Checker, path: &Path, load: &Load) {
    amounts(checker, &path.at("start"), load);
    radius(checker, path, load);
    ranges(checker, path, load);
}

fn amounts(checker: &mut Checker, path: &Path, load: &Load) {
    for channel in Channel::ALL {
        let Some(values) = load.start.amounts(channel) else { continue };
        let path = path.key(channel.key());
        if !load.carries.contains(&Carries::of(channel)) {
            let message = "a start value of an amount that the load does not carry";
            checker.refuse(&path, message, keys(load.channels()));
        } else if load.channels().any(|own| own == channel) {
            cells(checker, &path, &values, load.footprint.cells());
        } else {
            let message = match channel.direction() {
                Direction::Outward => "only shear on rings is radial",
                _ => "shear on rings is radial",
            };
            checker.refuse(&path, message, keys(load.channels().filter(|own| own.is_shear())));
        }
    }
}

fn keys(channels: impl Iterator<Item = Channel>) -> String {
    let keys: Vec<_> = channels.map(Channel::key).collect();
    if keys.is_empty() { "no amounts".to_owned() } else { keys.join(", ") }
}

/// Refuses lists that do not have one value per cell.
pub fn cells(checker: &mut Checker, path: &Path, values: &CellValues, cells: Option<CellShape>) {
    let allowed = match cells {
        None => "one number".to_owned(),
        Some(CellShape::Rings(count)) => format!("one number, or a list of {count}"),
        Some(CellShape::Tiles([rows, columns])) => {
            format!("one number, or a list of {rows} lists of {columns}")
        }
    };
    let fine = match (values, cells) {
        (CellValues::Uniform(_), _) => true,
        (CellValues::Rings(values), Some(CellShape::Rings(count))) => values.len() == count,
        (CellValues::Tiles(rows), Some(CellShape::Tiles(count))) => {
            rows.len() == count[0] && rows.iter().all(|row| row.len() == count[1])
        }
        _ => false,
    };
    checker.require(fine, path, "the values are not one for each cell of the footprint", allowed);
}

fn radius(checker: &mut Checker, path: &Path, load: &Load) {
    if load.footprint.radius().is_none() {
        for (key, given) in [
            ("start.radius", load.start.radius.is_some()),
            ("range.radius", load.range.radius.is_some()),
        ] {
            checker.require(!given, &path.at(key), "tiles have no radius", "x, y");
        }
    }
}

fn ranges(checker: &mut Checker, path: &Path, load: &Load) {
    let own_radius = load.footprint.radius().unwrap_or(0.0);
    for (key, range, start, otherwise) in [
        ("x", load.range.x, load.start.x, 0.0),
        ("y", load.range.y, load.start.y, 0.0),
        ("radius", load.range.radius, load.start.radius, own_radius),
    ] {
        let Some([lowest, highest]) = range else { continue };
        let at_range = path.at("range").key(key);
        if lowest > highest {
            checker.refuse(&at_range, "the bounds are in the wrong order", "[lowest, highest]");
            continue;
        }
        let value = start.unwrap_or(otherwise);
        let fine = lowest <= value && value <= highest;
        if start.is_some() {
            let allowed = format!("{} <= {key} <= {}", number(lowest), number(highest));
            let path = path.at("start").key(key);
            checker.require(fine, &path, "the start value is out of its range", allowed);
        } else if load.footprint.radius().is_some() || key != "radius" {
            let message = format!("the range leaves out the start value {}", number(value));
            let allowed = format!("a range with {0} in it, or `start.{key}`", number(value));
            checker.require(fine, &at_range, message, allowed);
        }
    }
}
