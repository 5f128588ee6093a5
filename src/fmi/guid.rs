//! The GUID of a unit: it identifies the scene and the library that belong to a modelDescription.xml.

use sha2::{Digest, Sha256};

use crate::model::tolerance::PACKED;
use crate::variables::Registry;

/// The first half of the SHA-256 of scene text, variables (name and causality, in their order) and
/// version of this program, written like a UUID in braces.
pub fn guid(scene_text: &str, registry: &Registry) -> String {
    let mut hash = Sha256::new();
    let mut add = |part: &str| {
        hash.update((part.len() as u64).to_le_bytes());
        hash.update(part);
    };
    add(env!("CARGO_PKG_VERSION"));
    // The text added by packing follows from the rest.
    add(scene_text.split(PACKED).next().unwrap_or_default());
    for variable in &registry.variables {
        add(&variable.name);
        add(super::description::causality(variable.causality()));
    }
    let digits: String = hash.finalize()[..16].iter().map(|byte| format!("{byte:02x}")).collect();
    let [a, b, c, d, e] = [0..8, 8..12, 12..16, 16..20, 20..32].map(|range| &digits[range]);
    format!("{{{a}-{b}-{c}-{d}-{e}}}")
}

#[cfg(test)]
mod tests {
    use super::*;

    const SCENE: &str = r#"
        name = "Plate"
        stop_time = 1e-6
        step = 1e-8
        [body.plate]
        kind = "solid"
        shape = { box = [2e-3, 2e-3, 0.26e-3] }
        material = { model = "thermoelastic", density = 3950.0, specific_heat = 900.0, conductivity = 10.0, young = 300e9, poisson = 0.21, expansion = 8.1e-6 }
        initial_temperature = 293.15
    "#;

    #[test]
    fn guid_is_a_uuid_of_text_and_variables() {
        let scene = crate::scene::parse(SCENE, "scene.toml").unwrap();
        let mut registry = Registry::of(&scene);
        let first = guid(SCENE, &registry);
        let dashes: Vec<_> = first.match_indices('-').map(|(at, _)| at).collect();
        assert_eq!((first.len(), dashes), (38, vec![9, 14, 19, 24]));
        assert_eq!(first, guid(SCENE, &registry));
        assert_ne!(first, guid(&format!("{SCENE}\n"), &registry));
        registry.variables.swap(0, 1);
        assert_ne!(first, guid(SCENE, &registry));
    }
}
