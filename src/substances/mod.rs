//! Library of substances: constants of solids and fluids from published sources, one file per substance.
//!
//! A file has the substance's title, aliases, sources and range of validity, and its constants under the keys of a
//! scene.

mod list;
mod schema;
mod sheet;

pub use list::{FLUIDS, SOLIDS};
pub use schema::schema;
pub use sheet::Sheet;

/// A substance of the library.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Substance {
    /// Name in scenes, as `steel-304`.
    pub name: &'static str,
    /// Text of its file.
    pub text: &'static str,
}

/// Kind of a substance: material of a solid or fluid of a droplet.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    Solid,
    Fluid,
}

impl Kind {
    /// All substances of the kind, by name.
    pub fn all(self) -> &'static [Substance] {
        match self {
            Self::Solid => SOLIDS,
            Self::Fluid => FLUIDS,
        }
    }

    /// Word for the kind in messages.
    pub fn word(self) -> &'static str {
        match self {
            Self::Solid => "solid",
            Self::Fluid => "fluid",
        }
    }

    /// The substance of a name or an alias, in capitals or not, with `_` or `-` between words; fluids of a solid's name
    /// are its melt.
    pub fn find(self, name: &str) -> Option<Substance> {
        let name = name.replace('_', "-").to_lowercase();
        let melt = format!("molten-{name}");
        let is_meant = |own: &str| own == name || self == Self::Fluid && own == melt;
        let is_named = |substance: &&Substance| {
            is_meant(substance.name) || substance.sheet().aliases.iter().any(|own| is_meant(own))
        };
        self.all().iter().find(is_named).copied()
    }
}

impl Substance {
    /// The contents of its file.
    ///
    /// # Panics
    /// If the file is not a sheet, which a test excludes for each.
    pub fn sheet(&self) -> Sheet {
        toml::from_str(self.text).expect("a substance's file is a sheet")
    }
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;
    use std::fs;

    use super::*;

    #[test]
    fn all_files_are_listed() {
        for (kind, folder) in [(Kind::Solid, "solids"), (Kind::Fluid, "fluids")] {
            let path = format!("{}/src/substances/{folder}", env!("CARGO_MANIFEST_DIR"));
            let files: BTreeSet<String> = fs::read_dir(path)
                .unwrap()
                .map(|entry| entry.unwrap().file_name().into_string().unwrap())
                .map(|name| name.trim_end_matches(".toml").to_owned())
                .collect();
            let listed: BTreeSet<_> = kind.all().iter().map(|one| one.name.to_owned()).collect();
            assert_eq!(files, listed);
        }
    }

    #[test]
    fn names_and_aliases_are_unique() {
        let mut seen = BTreeSet::new();
        for one in [SOLIDS, FLUIDS].concat() {
            for name in one.sheet().aliases.into_iter().chain([one.name.to_owned()]) {
                assert!(seen.insert(name.clone()), "{name} of {}", one.name);
            }
        }
    }

    #[test]
    fn fluids_are_found_by_the_name_of_their_solid() {
        assert_eq!(Kind::Fluid.find("tin").unwrap().name, "molten-tin");
        assert_eq!(Kind::Solid.find("tin").unwrap().name, "tin");
        assert_eq!(Kind::Fluid.find("solder").unwrap().name, "molten-sac305");
        assert_eq!(Kind::Solid.find("FR-4").unwrap().name, "fr4");
        assert!(Kind::Solid.find("unobtainium").is_none());
    }
}
