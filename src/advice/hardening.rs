//! Hardening that no metal has: more stress per plastic strain than per elastic strain.

use super::Reviewer;
use crate::laws::Material;
use crate::limits::number;
use crate::scene::locate::Path;
use crate::warning;

const MODULI: [&str; 2] = ["isotropic_hardening", "kinematic_hardening"];

pub fn review(reviewer: &mut Reviewer) {
    let scene = reviewer.scene;
    let body = |name: &str| Path::default().key("body").key(name);
    for (name, solid) in scene.solids() {
        for (path, own) in solid.materials(&body(name)) {
            material(reviewer, &path, own, solid.initial_temperature);
        }
    }
    for (name, solid) in scene.large_strains() {
        for own in solid.materials_of_layers() {
            material(reviewer, &body(name).key("material"), own, solid.initial_temperature);
        }
    }
}

fn material(reviewer: &mut Reviewer, path: &Path, material: &Material, temperature: f64) {
    let properties = material.properties();
    let value = |key: &str| {
        let mut all = properties.iter().filter(|(own, _)| *own == key);
        all.next().map(|(_, property)| property.value(temperature))
    };
    let Some(young) = value("young") else { return };
    for key in MODULI {
        if let Some(modulus) = value(key).filter(|&modulus| modulus > young) {
            let finding = warning::hardens_beyond_young(key, number(modulus), number(young));
            reviewer.warn(&path.key(key), finding);
        }
    }
}
