//! Checks that a unit does not have more variables than tools can read.

use super::{Checker, number};
use crate::scene::locate::Path;
use crate::scene::types::{Carries, CellShape, Footprint, Gives};

/// Largest number of values of all loads, fields and walls together: a model description of some hundred megabytes.
const MOST_VALUES: usize = 500_000;

pub fn check(checker: &mut Checker) {
    let scene = checker.scene;
    let list = |key: &str, i: usize| Path::default().key(key).index(i);
    let loads = scene.load.iter().enumerate().map(|(i, load)| {
        let carried = load.carries.iter().map(|carries| match carries {
            Carries::HeatFlux | Carries::Power | Carries::Pressure => 1,
            Carries::Shear => 2,
        });
        (list("load", i).at("footprint"), cells(&load.footprint) * carried.sum::<usize>())
    });
    let fields = scene.field.iter().enumerate().map(|(i, field)| {
        let given = field.gives.iter().map(|gives| match gives {
            Gives::Temperature
            | Gives::VonMises
            | Gives::MaxPrincipal
            | Gives::PlasticStrain
            | Gives::Damage
            | Gives::FailureDensity
            | Gives::SurfaceFailureDensity => 1,
            Gives::Displacement => 3,
            Gives::Stress => 7,
        });
        let (key, points) = match (&field.footprint, field.grid) {
            (Some(footprint), _) => ("footprint", cells(footprint)),
            (None, grid) => {
                ("grid", grid.map_or(0, |[rows, columns]| rows.saturating_mul(columns)))
            }
        };
        (list("field", i).at(key), points.saturating_mul(given.sum()))
    });
    // A temperature, a heat flux and three tractions.
    let walls = scene.wall.iter().enumerate();
    let walls =
        walls.map(|(i, wall)| (list("wall", i).at("footprint"), 5 * cells(&wall.footprint)));
    let mut sum = 0_usize;
    for (path, values) in loads.chain(fields).chain(walls) {
        sum = sum.saturating_add(values);
        if sum > MOST_VALUES {
            let message = format!("this makes {} values of variables", number(sum as f64));
            let allowed = format!("at most {MOST_VALUES} of all loads, fields and walls together");
            checker.refuse(&path, message, allowed);
            return;
        }
    }
}

fn cells(footprint: &Footprint) -> usize {
    match footprint.cells() {
        None => 1,
        Some(CellShape::Rings(count)) => count,
        Some(CellShape::Tiles([rows, columns])) => rows.saturating_mul(columns),
    }
    .min(usize::MAX / 16)
}
