//! Describes a scene in sentences.

use impinge::scene::{
    Carries, Coupling, Disc, Droplet, Face, FaceName, Field, Load, Plane, Probe, Scene, Shape,
    Solid, Wall,
};

/// One sentence or two for each body, load, probe, field, wall and coupling.
pub fn of(scene: &Scene) -> Vec<String> {
    let solids = scene.solids().map(|(name, body)| solid(name, body));
    let droplets = scene.droplets().map(|(name, body)| droplet(name, body));
    let loads = scene.load.iter().map(load);
    let probes = scene.probe.iter().map(probe);
    let fields = scene.field.iter().map(field);
    let walls = scene.wall.iter().map(wall);
    let couplings = scene.coupling.iter().map(coupling);
    let lumps = scene.lumps().map(|(name, words)| format!("{name}: {words}."));
    let bodies = solids.chain(droplets).chain(lumps);
    bodies.chain(loads).chain(probes).chain(fields).chain(walls).chain(couplings).collect()
}

/// A number in its shortest notation: `5e7`.
pub fn number(value: f64) -> String {
    if value.abs() < 1e5 { format!("{value:?}") } else { format!("{value:e}") }
}

/// A number with a suitable prefix: `2.5 µm`.
pub fn quantity(value: f64, unit: &str) -> String {
    const PREFIXES: [(f64, &str); 5] =
        [(1.0, ""), (1e-3, "m"), (1e-6, "µ"), (1e-9, "n"), (1e-12, "p")];
    let fits = |(scale, _): &&(f64, &str)| value.abs() >= 0.999_999 * scale;
    let (scale, prefix) = match PREFIXES.iter().find(fits) {
        Some(fitting) if value.abs() < 1e4 => *fitting,
        _ => (1.0, ""),
    };
    // Six digits hide the rounding of the division by the scale.
    let digits: f64 = format!("{:.5e}", value / scale).parse().unwrap_or(value);
    format!("{digits} {prefix}{unit}")
}

fn metres(value: f64) -> String {
    quantity(value, "m")
}

fn solid(name: &str, solid: &Solid) -> String {
    let shape = match solid.shape {
        Shape::Box([x, y, z]) => {
            format!("plate of {} × {} × {}", metres(x), metres(y), metres(z))
        }
        Shape::Disc(Disc { radius, thickness }) => {
            format!("round plate of radius {}, {} thick", metres(radius), metres(thickness))
        }
    };
    let faces: Vec<String> = solid.faces.iter().map(|(name, how)| face(*name, how)).collect();
    let faces = if faces.is_empty() { String::new() } else { format!(" {}.", faces.join("; ")) };
    format!(
        "{name}: a {shape}, initially at {} K, with Fourier conduction and linear \
         thermo-elasticity.{faces} Elsewhere it is insulated and free.",
        solid.initial_temperature
    )
}

fn face(name: FaceName, face: &Face) -> String {
    let name = match name {
        FaceName::Top => "Top",
        FaceName::Bottom => "Bottom",
        FaceName::Sides => "Sides",
        FaceName::Left => "Left",
        FaceName::Right => "Right",
        FaceName::Front => "Front",
        FaceName::Back => "Back",
    };
    let conditions = [
        face.temperature.map(|value| format!("held at {value} K")),
        face.flux.map(|value| format!("heated by {value:?} W/m²")),
        face.convection
            .map(|c| format!("cooled by {} W/(m² K) towards {} K", c.coefficient, c.ambient)),
        face.clamped.then(|| "clamped".to_owned()),
        face.roller.then(|| "kept from moving along the normal".to_owned()),
    ];
    let conditions: Vec<String> = conditions.into_iter().flatten().collect();
    let conditions = if conditions.is_empty() { "free".into() } else { conditions.join(", ") };
    format!("{name}: {conditions}")
}

fn load(load: &Load) -> String {
    let carried: Vec<&str> = load
        .carries
        .iter()
        .map(|what| match what {
            Carries::HeatFlux => "heat flux",
            Carries::Power => "heating power",
            Carries::Pressure => "pressure",
            Carries::Shear => "shear",
        })
        .collect();
    let place = load.footprint.words(metres);
    format!("{}: {} on {}, over {place}.", load.name, carried.join(", "), load.on)
}

fn droplet(name: &str, droplet: &Droplet) -> String {
    let drops = match droplet.drops() {
        count if droplet.is_on_demand() => format!("up to {count} drops, released by inputs, each"),
        1 => "a drop".to_owned(),
        count => format!("{count} drops, each"),
    };
    let angle = match droplet.is_straight() {
        true => String::new(),
        false => format!(", {:.1}° from straight down", droplet.impact_angle.to_degrees()),
    };
    let model = if droplet.dimension == 2 { "plane, one metre deep, " } else { "" };
    format!(
        "{name}: {drops} of diameter {}, initially at {} K, that arrives at {} m/s{angle}; {model}by \
         weakly compressible smoothed particle hydrodynamics with particles {} apart.",
        metres(droplet.diameter),
        droplet.initial_temperature,
        droplet.impact_velocity,
        metres(droplet.spacing)
    )
}

fn wall(wall: &Wall) -> String {
    format!(
        "{}: the wall under {}, whose temperatures are inputs and whose heat fluxes and tractions are \
         outputs, on {}.",
        wall.name,
        wall.under,
        wall.footprint.words(metres)
    )
}

fn coupling(coupling: &Coupling) -> String {
    if let Some(conductance) = coupling.conductance {
        return format!(
            "Heat passes from {} to {} at {conductance} W/(m2 K).",
            coupling.from, coupling.to
        );
    }
    let carried = if coupling.traction { "heat, pressure and shear" } else { "heat" };
    format!(
        "{} transfers {carried} to {} and receives its temperature.",
        coupling.from, coupling.to
    )
}

fn probe(probe: &Probe) -> String {
    let [x, y, z] = probe.at.map(metres);
    format!("{}: a probe in {} at x = {x}, y = {y}, z = {z}.", probe.name, probe.body)
}

fn field(field: &Field) -> String {
    let body = field.body.as_deref().unwrap_or_default();
    let place = match (&field.on, field.plane) {
        (Some(face), _) => face.clone(),
        (None, Some(Plane::X(at))) => format!("the section x = {} of {body}", metres(at)),
        (None, Some(Plane::Y(at))) => format!("the section y = {} of {body}", metres(at)),
        (None, Some(Plane::Z(at))) => format!("the section z = {} of {body}", metres(at)),
        (None, None) => body.to_owned(),
    };
    match (&field.footprint, field.grid) {
        (Some(footprint), _) => {
            format!("{}: means over {} on {place}.", field.name, footprint.words(metres))
        }
        (None, grid) => {
            let [nx, ny] = grid.unwrap_or_default();
            format!("{}: a grid of {nx} × {ny} points on {place}.", field.name)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quantities_carry_the_prefix_that_keeps_them_short() {
        for (value, text) in [
            (2.6e-4, "260 µm"),
            (1e-3, "1 mm"),
            (3.5e-6, "3.5 µm"),
            (0.0, "0 m"),
            (-2e-5, "-20 µm"),
            (12.0, "12 m"),
            (1e-8, "10 nm"),
        ] {
            assert_eq!(quantity(value, "m"), text);
        }
    }
}
