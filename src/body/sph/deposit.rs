//! What the fluid gives to the wall.

use super::cloud::Ledger;
use super::images::copies;
use super::wall::{WallCells, WallExchange, WallShare};
use crate::math::parallel::Team;

/// Heat [J] and impulse [N s] for the wall, and where [m].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Gift {
    pub at: [f64; 2],
    pub heat: f64,
    pub impulse: [f64; 3],
}

impl Gift {
    /// Where mirrors turn it.
    fn turned(&self, [along_x, along_y]: [f64; 2]) -> Self {
        let ([x, y], [u, v, w]) = (self.at, self.impulse);
        let (at, impulse) = ([along_x * x, along_y * y], [along_x * u, along_y * v, w]);
        Self { at, impulse, ..*self }
    }
}

/// Adds gifts and their images at `mirrors`.
pub fn give(
    gifts: &[Gift],
    cells: &WallCells,
    ledger: &mut Ledger,
    mirrors: [bool; 2],
    team: &Team,
) {
    // All images are equally far out, and push alike along their radius.
    let (together, apart) = match cells.are_radial() {
        true => (mirrors, [false; 2]),
        false => ([false; 2], mirrors),
    };
    let sides = |mirrored: bool| if mirrored { &[1.0, -1.0][..] } else { &[1.0][..] };
    for &along_x in sides(apart[0]) {
        for &along_y in sides(apart[1]) {
            let turned = |gift: &Gift| gift.turned([along_x, along_y]);
            let shares = team.map(gifts.len(), |i| {
                let [x, y] = turned(&gifts[i]).at;
                cells.share(x, y)
            });
            for (gift, share) in gifts.iter().zip(&shares) {
                deposit(&turned(gift), share, cells, ledger, together);
            }
        }
    }
}

/// Adds what is given at one place and at its images at `mirrors`, which have to lie in the same cells.
fn deposit(
    gift: &Gift,
    share: &WallShare,
    cells: &WallCells,
    ledger: &mut Ledger,
    mirrors: [bool; 2],
) {
    let Gift { at: [x, y], heat, impulse } = *gift;
    let exchange: &mut WallExchange = &mut ledger.exchange;
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
    let impulse = if cells.are_radial() { radially([x, y], impulse) } else { impulse };
    for (cell, weight) in share.cells {
        exchange.heat[cell] += weight * heat;
        (0..3).for_each(|n| exchange.impulse[cell][n] += weight * impulse[n]);
    }
}

/// The impulse at a place along its radius from the origin, 0, and along z.
fn radially([x, y]: [f64; 2], [u, v, w]: [f64; 3]) -> [f64; 3] {
    let radius = x.hypot(y);
    if radius > 0.0 { [(x * u + y * v) / radius, 0.0, w] } else { [0.0, 0.0, w] }
}
