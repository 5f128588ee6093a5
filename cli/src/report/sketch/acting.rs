//! Sketches of loads, drops and walls on solids, and of probes and fields in them.

use impinge::scene::{Droplet, FaceName, Footprint, Load, Place, Plane, Scene, Solid, Wall};

use super::MOST_DROPS;
use super::body::half_widths;
use super::view::{Drawing, Views, Words};
use crate::check::bodies::speed;
use crate::check::words::{keys, metres};
use crate::report::fields::thinned;
use crate::units::kelvin;

/// Most rings or tiles whose edges are drawn.
const MOST_CELLS: usize = 24;

/// Draws the loads on a solid.
pub fn loads(scene: &Scene, body: &str, solid: &Solid, views: &mut Views) {
    for load in scene.loads_on(body) {
        let is_below = load.on.ends_with(FaceName::Bottom.as_str());
        let at = [load.start.x, load.start.y].map(Option::unwrap_or_default);
        let [half, _] = load.footprint.half_extents(load.start.radius);
        let label = format!("{} on {}: {}", load.name, load.on, words(load));
        let text = || Words { label: label.clone(), short: &load.name };
        let z = if is_below { -solid.shape.thickness() } else { 0.0 };
        views.side.rectangle("load", [at[0] - half, z, at[0] + half, z], text());
        let down = if is_below { 1.0 } else { -1.0 };
        views.side.arrow("load", [at[0], z], [0.0, down], Words::none());
        footprint(&mut views.top, "load", &load.footprint, load.start.radius, at, text());
    }
}

fn words(load: &Load) -> String {
    format!("{}, {}", load.footprint.label(metres), keys(&load.carries))
}

/// Draws a footprint from above.
fn footprint(
    drawing: &mut Drawing,
    role: &str,
    shape: &Footprint,
    radius: Option<f64>,
    [x, y]: [f64; 2],
    words: Words,
) {
    match *shape {
        Footprint::Tiles { count: [columns, rows], size: [width, height] } => {
            let (left, bottom) = (x - 0.5 * width, y - 0.5 * height);
            drawing.rectangle(role, [left, bottom, left + width, bottom + height], words);
            if columns.max(rows) > MOST_CELLS {
                return;
            }
            for i in 1..columns {
                let at = left + width * i as f64 / columns as f64;
                drawing.line("field", [[at, bottom], [at, bottom + height]], Words::none());
            }
            for j in 1..rows {
                let at = bottom + height * j as f64 / rows as f64;
                drawing.line("field", [[left, at], [left + width, at]], Words::none());
            }
        }
        Footprint::Rings { count, radius } => {
            drawing.disc(role, [x, y], radius, words);
            let rings = if count > MOST_CELLS { 0..0 } else { 1..count };
            for i in rings {
                drawing.disc("field", [x, y], radius * i as f64 / count as f64, Words::none());
            }
        }
        Footprint::Ring { inner, outer } => {
            let outer_now = radius.unwrap_or(outer);
            drawing.disc(role, [x, y], outer_now, words);
            drawing.disc("field", [x, y], inner * outer_now / outer, Words::none());
        }
        Footprint::Disc { radius: own } | Footprint::Gaussian { radius: own } => {
            drawing.disc(role, [x, y], radius.unwrap_or(own), words);
        }
    }
}

/// Draws the drops of a droplet above z = 0, with their velocity.
pub fn drops(name: &str, droplet: &Droplet, views: &mut Views) {
    let radius = 0.5 * droplet.diameter;
    let height = droplet.gap() + radius;
    let label = format!(
        "{name}: {} at {}, {}",
        metres(droplet.diameter),
        speed(droplet),
        kelvin(droplet.initial_temperature)
    );
    let mut places: Vec<[f64; 2]> =
        droplet.arrivals().iter().map(|drop| [drop.x, drop.y]).collect();
    if places.is_empty() {
        places.push([0.0; 2]);
    }
    places.dedup();
    let [u, _, w] = droplet.velocity();
    let drawn = thinned(places.len(), MOST_DROPS);
    let label = match drawn.len() {
        1 => label,
        some if some < places.len() => format!("{label}; {some} of {} places", places.len()),
        all => format!("{label}; {all} places"),
    };
    for (i, [x, y]) in drawn.into_iter().map(|place| places[place]).enumerate() {
        let words = || Words { label: label.clone(), short: if i == 0 { name } else { "" } };
        views.side.disc("drop", [x, height], radius, words());
        views.side.arrow("velocity", [x, height - radius], [u, w], Words::none());
        views.top.disc("drop", [x, y], radius, words());
    }
}

/// Draws the wall below a droplet.
pub fn wall(wall: &Wall, views: &mut Views) {
    let [half, _] = wall.footprint.half_extents(None);
    let label = format!("{}: {}", wall.name, wall.footprint.label(metres));
    let text = || Words { label: label.clone(), short: &wall.name };
    views.side.rectangle("wall", [-half, -0.05 * half, half, 0.0], text());
    footprint(&mut views.top, "wall", &wall.footprint, None, [0.0; 2], text());
}

/// Draws the probes of a solid.
pub fn probes(scene: &Scene, body: &str, views: &mut Views) {
    for probe in scene.probe.iter().filter(|probe| probe.body == body) {
        let [x, y, z] = probe.at;
        let at = probe.at.map(metres).join(", ");
        let label = format!("{} at {at}: {}", probe.name, keys(&probe.gives));
        let words = || Words { label: label.clone(), short: &probe.name };
        views.side.point("probe", [x, z], words());
        views.top.point("probe", [x, y], words());
    }
}

/// Draws the fields of outputs of a solid.
pub fn fields(scene: &Scene, body: &str, solid: &Solid, views: &mut Views) {
    for field in scene.field.iter().filter(|field| field.body_and_place().0 == body) {
        let (thickness, [half_x, half_y]) = (solid.shape.thickness(), half_widths(solid));
        let words =
            |name| Words { label: format!("{}: {}", field.name, keys(&field.gives)), short: name };
        if let Some(footprint_of) = &field.footprint {
            let at = field.at.unwrap_or_default();
            footprint(&mut views.top, "field", footprint_of, None, at, words(&field.name));
            continue;
        }
        let half = |axis: usize, whole: f64| field.size.map_or(whole, |size| 0.5 * size[axis]);
        match field.body_and_place().1 {
            Place::Face(FaceName::Top | FaceName::Bottom) | Place::Section(Plane::Z(_)) => {
                let (x, y) = (half(0, half_x), half(1, half_y));
                views.top.rectangle("field", [-x, -y, x, y], words(&field.name));
            }
            Place::Section(Plane::Y(_)) | Place::Face(FaceName::Front | FaceName::Back) => {
                let (x, z) = (half(0, half_x), half(1, 0.5 * thickness));
                let middle = -0.5 * thickness;
                views.side.rectangle("field", [-x, middle - z, x, middle + z], words(&field.name));
            }
            Place::Section(Plane::X(_)) | Place::Face(_) => {}
        }
    }
}
