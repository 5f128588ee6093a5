//! Key of an assessment: a checksum of all data that it follows from.

use impinge::scene::Scene;
use sha2::{Digest, Sha256};

use super::environment::environment;

/// Version of the stored form; to be raised when it changes.
const FORM: &str = "1";

/// SHA-256 in hexadecimal digits.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Key(pub String);

impl Key {
    /// Key of an assessment of this kind. A scene names no files, so it is all that an assessment is of. Its debugging
    /// form has every field, those that a text leaves out as well, and every number to the bit.
    pub fn of(kind: &str, scene: &Scene) -> Self {
        let mut checksum = Sha256::new();
        for part in [FORM, kind, &environment(), &format!("{scene:?}")] {
            checksum.update((part.len() as u64).to_le_bytes());
            checksum.update(part);
        }
        Self(hexadecimal(&checksum.finalize()))
    }
}

pub fn hexadecimal(bytes: &[u8]) -> String {
    bytes.iter().map(|byte| format!("{byte:02x}")).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use impinge::scene::parse;

    const SCENE: &str = include_str!("../../tests/fmi/scene.toml");

    #[test]
    fn any_change_of_a_number_of_the_scene_changes_the_key() {
        let key = |text: &str| Some(Key::of("meshes", &parse(text, "scene.toml").ok()?));
        let own = key(SCENE).unwrap();
        assert_eq!(key(SCENE), Some(own.clone()));
        assert_ne!(Key::of("levels", &parse(SCENE, "scene.toml").unwrap()), own);
        let digits: Vec<usize> =
            SCENE.match_indices(|c: char| c.is_ascii_digit()).map(|(at, _)| at).collect();
        let mut changed = 0;
        for at in digits {
            let other = if &SCENE[at..=at] == "1" { "2" } else { "1" };
            let text = format!("{}{other}{}", &SCENE[..at], &SCENE[at + 1..]);
            let values = |text: &str| text.parse::<toml::Table>().unwrap();
            if values(&text) == values(SCENE) {
                continue;
            }
            let Some(key) = key(&text) else { continue };
            assert_ne!(key, own, "{text}");
            changed += 1;
        }
        assert!(changed > 20, "{changed}");
    }

    #[test]
    fn fields_that_no_text_has_change_the_key() {
        let scene = parse(SCENE, "scene.toml").unwrap();
        let own = Key::of("meshes", &scene);
        let mut zero = scene.clone();
        zero.load[0].start.radius = Some(0.0);
        let mut negative = scene.clone();
        negative.load[0].start.radius = Some(-0.0);
        assert_ne!(Key::of("meshes", &zero), Key::of("meshes", &negative));
        let mut described = scene;
        described.description.push('.');
        assert_ne!(Key::of("meshes", &described), own);
    }
}
