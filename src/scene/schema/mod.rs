//! The JSON schema of scenes: a single description of each key, for editors, checks, messages and tables.
//!
//! It is derived from the scene's types: doc comments are descriptions, and [`crate::limits`] bounds the numbers. Its
//! generator is larger than all code that reads scenes, so units carry the text, which a test compares.

mod derived;
mod node;
mod number;
mod place;
mod walk;

use super::locate::{Path, Source, Step};
use crate::limits::TEMPERATURE;
use node::Node;

pub use derived::derived_schema;
pub use number::Limits;
pub use place::Place;

/// The JSON schema of a scene, draft 2020-12.
pub const SCHEMA: &str = include_str!("../../../docs/scene.schema.json");

/// The parsed schema.
pub struct Schema {
    root: Node<'static>,
}

impl Schema {
    /// The schema of scenes.
    ///
    /// # Panics
    /// If [`SCHEMA`] is not a valid schema.
    pub fn of_scenes() -> Self {
        Self { root: serde_json::from_str(SCHEMA).expect("the schema is one") }
    }

    /// Follows a reference; returns other schemas unchanged.
    fn resolved<'s>(&'s self, node: &'s Node<'static>) -> &'s Node<'static> {
        let name = node.reference.and_then(|reference| reference.strip_prefix("#/$defs/"));
        name.and_then(|name| self.root.definitions.get(name)).unwrap_or(node)
    }

    /// The alternative schemas of a value, with references resolved.
    fn alternatives<'s>(&'s self, node: &'s Node<'static>) -> Vec<&'s Node<'static>> {
        let node = self.resolved(node);
        match &node.choices[..] {
            [] => vec![node],
            list => list.iter().flat_map(|choice| self.alternatives(choice)).collect(),
        }
    }

    /// Unit of the number that a text at a position may stand for, and whether it is a temperature.
    ///
    /// Tables that a key marks as another kind than the one at hand do not count.
    pub fn number_at(&self, source: &Source, path: &Path) -> Option<(&'static str, bool)> {
        let (mut nodes, mut at) = (self.alternatives(&self.root), Path::default());
        for step in path.steps() {
            let table = source.value(&at)?;
            nodes.retain(|node| {
                node.properties.iter().all(|(key, own)| {
                    let said = table.get(*key).and_then(|value| value.get_ref().as_str());
                    own.constant.is_none() || said.is_none() || own.constant == said
                })
            });
            let below = nodes.into_iter().filter_map(|node| match step {
                Step::Key(key) => node.of_key(key),
                Step::Index(_) => node.items.as_deref(),
            });
            nodes = below.flat_map(|node| self.alternatives(node)).collect();
            at = match step {
                Step::Key(key) => at.key(key),
                Step::Index(index) => at.index(*index),
            };
        }
        let node = nodes.into_iter().find(|node| node.is_number())?;
        Some((node.limits.unit?, node.limits.noun == Some(TEMPERATURE)))
    }

    /// Unit of the numbers at a position, or of the list that it is an element of.
    pub fn unit_at(&self, path: &Path) -> Option<&'static str> {
        let mut nodes = self.alternatives(&self.root);
        let mut unit = None;
        for step in path.steps() {
            let below = nodes.into_iter().filter_map(|node| match step {
                Step::Key(key) => node.of_key(key),
                Step::Index(_) => node.items.as_deref(),
            });
            let below: Vec<_> = below.collect();
            if let Step::Key(_) = step {
                unit = below.iter().find_map(|node| node.limits.unit);
            }
            nodes = below.into_iter().flat_map(|node| self.alternatives(node)).collect();
        }
        unit.filter(|unit| *unit != "1")
    }
}
