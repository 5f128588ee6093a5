//! The scene to scale: bodies, drops, walls, loads, probes and supports, from the side and from above.

mod acting;
mod body;
mod view;

use impinge::model::forecast;
use impinge::scene::{Scene, Solid};

use super::document::Sketch;
use view::Views;

/// Largest number of drops that are drawn, evenly chosen.
const MOST_DROPS: usize = 500;

/// A sketch of each solid with what acts on it, and of each droplet above a wall of its own.
pub fn sketches(scene: &Scene) -> Vec<Sketch> {
    let solids: Vec<(&str, &Solid)> = scene.solids().collect();
    let walls: Vec<_> = scene.wall.iter().collect();
    let is_only = solids.len() + walls.len() == 1;
    let title = |name: &str| if is_only { String::new() } else { name.to_owned() };
    let forecast = forecast(scene);
    let mut sketches = Vec::new();
    for (name, solid) in solids {
        let mut views = Views::default();
        body::draw(name, solid, &mut views);
        acting::loads(scene, name, solid, &mut views);
        acting::fields(scene, name, solid, &mut views);
        for (coupling, droplet) in scene.drops_on(name) {
            acting::drops(&coupling.from, droplet, &mut views);
        }
        let own = forecast.bodies.iter().find(|body| body.name == name);
        if own.is_some_and(body::is_quarter) {
            body::draw_symmetry(solid, &mut views);
        }
        acting::probes(scene, name, &mut views);
        sketches.push(views.sketch(title(name)));
    }
    for wall in walls {
        let Some(droplet) = scene.droplet(&wall.under) else { continue };
        let mut views = Views::default();
        acting::wall(wall, &mut views);
        acting::drops(&wall.under, droplet, &mut views);
        sketches.push(views.sketch(title(&wall.name)));
    }
    sketches
}
