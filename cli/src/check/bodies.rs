//! Tables of a scene's bodies.

use impinge::scene::{Droplet, FilamentMethod, Layer, MaterialChoice, Scene, Shape, SolidShape};

use super::words::{key, metres};
use crate::table::table;
use crate::units::{engineering, kelvin};

pub fn bodies(scene: &Scene) -> String {
    let rows: Vec<_> = scene
        .solids()
        .map(|(name, solid)| {
            [
                name.to_owned(),
                shape(&solid.shape),
                law(solid.material.as_ref(), solid.layers.as_deref()),
                kelvin(solid.initial_temperature),
                key(&solid.heat),
                key(&solid.symmetry),
            ]
        })
        .collect();
    table(["body", "shape", "material", "initially", "heat", "symmetry"], &rows)
}

pub fn large_strains(scene: &Scene) -> String {
    let rows: Vec<_> = scene
        .large_strains()
        .map(|(name, solid)| {
            [
                name.to_owned(),
                match (&solid.shape, solid.plate()) {
                    (SolidShape::Ball(ball), _) => format!("ball, radius {}", metres(ball.radius)),
                    (SolidShape::Quadrilateral(own), _) => {
                        let [bottom, right, top, left] = own.edges().map(metres);
                        format!("quadrilateral, edges {bottom}, {right}, {top}, {left}")
                    }
                    (SolidShape::Strand(own), _) => {
                        format!(
                            "strand of {} points, radius {}",
                            own.path.len(),
                            metres(own.radius)
                        )
                    }
                    (SolidShape::Part(part), _) => format!("part of {}", part.file),
                    (_, Some(plate)) => shape(&plate),
                    (_, None) => String::new(),
                },
                law(solid.material.as_ref(), solid.layers.as_deref()),
                if solid.inertia { "yes" } else { "no" }.to_owned(),
                if solid.dimension == 2 { "plane" } else { "space" }.to_owned(),
                metres(solid.spacing()),
            ]
        })
        .collect();
    table(["body", "shape", "material", "inertia", "model", "distance of nodes"], &rows)
}

pub fn lumps(scene: &Scene) -> String {
    let rows: Vec<_> = scene.lumps().map(|(name, words)| [name.to_owned(), words]).collect();
    table(["body", "what"], &rows)
}

pub fn droplets(scene: &Scene) -> String {
    let rows: Vec<_> = scene
        .droplets()
        .map(|(name, droplet)| {
            let drops = match droplet.drops() {
                count if droplet.is_on_demand() => {
                    format!("up to {count} of {}", metres(droplet.diameter))
                }
                1 => metres(droplet.diameter),
                count => format!("{count} of {}", metres(droplet.diameter)),
            };
            [
                name.to_owned(),
                drops,
                speed(droplet),
                kelvin(droplet.initial_temperature),
                key(&droplet.method),
                if droplet.has_particles() { metres(droplet.spacing) } else { "none".to_owned() },
                key(&droplet.kernel),
            ]
        })
        .collect();
    let heading =
        ["droplet", "diameter", "speed", "initially", "method", "distance of particles", "kernel"];
    table(heading, &rows)
}

pub fn filaments(scene: &Scene) -> String {
    let rows: Vec<_> = scene
        .filaments()
        .map(|(name, filament)| {
            let by_inputs = filament.table().is_none();
            [
                name.to_owned(),
                metres(filament.nozzle.diameter),
                metres(filament.nozzle.height),
                kelvin(filament.nozzle.temperature),
                if by_inputs { "by inputs" } else { "by its table" }.to_owned(),
                metres(match filament.method {
                    FilamentMethod::Line => filament.segment_length(),
                    FilamentMethod::Particles => filament.particle_distance(),
                }),
            ]
        })
        .collect();
    table(["filament", "nozzle", "height", "comes at", "moves", "segments, particles"], &rows)
}

pub fn lattices(scene: &Scene) -> String {
    let rows: Vec<_> = scene
        .lattices()
        .map(|(name, lattice)| {
            [
                name.to_owned(),
                [lattice.length, lattice.depth, lattice.thickness].map(metres).join(" × "),
                lattice.notch.map_or("none".to_owned(), |notch| metres(notch.depth)),
                metres(lattice.spacing),
                key(&lattice.arrangement),
                key(&lattice.control),
            ]
        })
        .collect();
    table(["lattice", "extents", "notch", "spacing", "links", "prescribed"], &rows)
}

pub fn speed(droplet: &Droplet) -> String {
    let speed = engineering(droplet.impact_velocity, "m/s");
    match droplet.is_straight() {
        true => speed,
        false => format!("{speed} at {:.1}°", droplet.impact_angle.to_degrees()),
    }
}

pub fn shape(shape: &Shape) -> String {
    match shape {
        Shape::Box(extents) => format!("box {}", extents.map(metres).join(" × ")),
        Shape::Disc(disc) => {
            format!("disc, radius {}, thickness {}", metres(disc.radius), metres(disc.thickness))
        }
    }
}

/// Names the material of a body: its named material or constitutive law, or its layers.
pub fn law(own: Option<&MaterialChoice>, layers: Option<&[Layer]>) -> String {
    let own = own.into_iter().map(material);
    let layers = layers
        .into_iter()
        .flatten()
        .map(|layer| format!("{} {}", metres(layer.thickness), material(&layer.material)));
    own.chain(layers).collect::<Vec<_>>().join(" on ")
}

pub fn material(choice: &MaterialChoice) -> String {
    let table = toml::Value::try_from(choice.material()).ok();
    let model = table.as_ref().and_then(|table| table.get("model")?.as_str());
    choice.name.clone().unwrap_or_else(|| model.unwrap_or_default().to_owned())
}
