//! What the fluid gives to the wall.

use super::cloud::Ledger;
use super::images::copies;
use super::wall::{WallCells, WallExchange};

/// Adds heat [J] and impulse [N s] at a place of the wall and at its images at `mirrors`, which have to
/// lie in the same cells.
pub fn deposit(
    cells: &WallCells,
    ledger: &mut Ledger,
    [x, y]: [f64; 2],
    heat: f64,
    impulse: [f64; 3],
    mirrors: [bool; 2],
) {
    let exchange: &mut WallExchange = &mut ledger.exchange;
    let share = cells.share(x, y);
    let images = copies(mirrors);
    let (heat, impulse) = (images * heat, impulse.map(|p| images * p));
    ledger.heat_to_wall += heat;
    // What the images give along a mirrored axis cancels.
    let along = |n: usize| if n < 2 && mirrors[n] { 0.0 } else { impulse[n] };
    (0..3).for_each(|n| ledger.impulse_to_wall[n] += along(n));
    if share.outside {
        exchange.heat_outside += heat;
        (0..3).for_each(|n| exchange.impulse_outside[n] += along(n));
        return;
    }
    let radius = x.hypot(y);
    let impulse = match cells {
        WallCells::Tiles { .. } | WallCells::Nodes { .. } => impulse,
        _ if radius > 0.0 => [(x * impulse[0] + y * impulse[1]) / radius, 0.0, impulse[2]],
        _ => [0.0, 0.0, impulse[2]],
    };
    for (cell, weight) in share.cells {
        exchange.heat[cell] += weight * heat;
        (0..3).for_each(|n| exchange.impulse[cell][n] += weight * impulse[n]);
    }
}
