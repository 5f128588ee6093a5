//! Solids of large strain are `kind = "solid"` with `strain = "finite"`; inside the program they are a kind of their own.

use std::borrow::Cow;

use toml::de::DeValue;

use super::large_strain::KIND;
use super::locate::{Path, Source};

/// Gives solids with `strain = "finite"` the name of their own kind.
pub fn name_kinds(source: &mut Source) {
    let bodies = Path::default().key("body");
    let Some(DeValue::Table(table)) = source.value(&bodies) else { return };
    let paths: Vec<Path> = table.keys().map(|name| bodies.key(name.get_ref())).collect();
    for path in paths {
        let says = |key: &str| source.value(&path.key(key)).and_then(DeValue::as_str);
        if says("kind") == Some("solid") && says("strain") == Some("finite") {
            source.replace(&path.key("kind"), DeValue::String(Cow::Borrowed(KIND)));
        }
    }
}
