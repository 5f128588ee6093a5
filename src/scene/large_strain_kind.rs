//! Solids of large strain are `kind = "solid"` with `strain = "finite"`; inside the program they are a kind of their
//! own.

use std::borrow::Cow;

use toml::de::DeValue;

use super::large_strain::KIND;
use super::locate::{Path, Source};

/// Gives solids with `strain = "finite"` the name of their own kind while `work` reads the scene.
pub fn with_names<R>(source: &mut Source, work: impl FnOnce(&Source) -> R) -> R {
    let bodies = Path::default().key("body");
    let names = match source.value(&bodies) {
        Some(DeValue::Table(table)) => {
            table.keys().map(|name| bodies.key(name.get_ref())).collect()
        }
        _ => Vec::new(),
    };
    let is_one = |path: &Path| {
        let says = |key: &str| source.value(&path.key(key)).and_then(DeValue::as_str);
        says("kind") == Some("solid") && says("strain") == Some("finite")
    };
    let own: Vec<Path> = names.into_iter().filter(is_one).map(|path| path.key("kind")).collect();
    own.iter().for_each(|path| source.replace(path, DeValue::String(Cow::Borrowed(KIND))));
    let result = work(source);
    own.iter().for_each(|path| source.replace(path, DeValue::String(Cow::Borrowed("solid"))));
    result
}
