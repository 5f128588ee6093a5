//! Finds every number of a scene together with its schema.

use toml::de::{DeTable, DeValue};

use super::node::Node;
use super::{Limits, Place, Schema};
use crate::scene::locate::Source;
use crate::scene::shorthand::is_meant_as_number;

impl Schema {
    /// Calls `visit` with every number of a decoded scene's text.
    pub fn numbers<'s, 'v>(
        &'s self,
        source: &'v Source<'v>,
        visit: &mut dyn FnMut(&Place<'v>, &'s Limits<'static>, f64),
    ) {
        Walk { schema: self, source, visit }.value(
            &mut Place::default(),
            &self.root,
            source.root(),
        );
    }

    /// Returns true if a value is of the schema's kind, without checking all its contents.
    fn fits(&self, node: &Node<'static>, value: &DeValue) -> bool {
        let node = self.resolved(node);
        if !node.choices.is_empty() {
            return node.choices.iter().any(|choice| self.fits(choice, value));
        }
        match (node.kind, value) {
            (Some("object"), DeValue::Table(_)) => is_table(node, value),
            (Some("array"), DeValue::Array(list)) => {
                let first = list.first().zip(node.items.as_deref());
                first.is_none_or(|(first, items)| self.fits(items, first.get_ref()))
            }
            (Some("number"), DeValue::Float(_) | DeValue::Integer(_)) => true,
            (Some("number"), DeValue::String(text)) => is_meant_as_number(text),
            (Some("integer"), DeValue::Integer(_)) => true,
            (Some("string"), DeValue::String(_)) => true,
            (Some("boolean"), DeValue::Boolean(_)) => true,
            _ => false,
        }
    }
}

/// Returns true if a table has its required keys and constants.
fn is_table(node: &Node, table: &DeValue) -> bool {
    let has_required = node.required.iter().all(|key| table.get(*key).is_some());
    let has_constants = node.properties.iter().all(|(key, own)| {
        let said = own.constant.zip(table.get(*key));
        said.is_none_or(|(said, value)| value.get_ref().as_str() == Some(said))
    });
    has_required && has_constants
}

struct Walk<'w, 's, 'v> {
    schema: &'s Schema,
    source: &'v Source<'v>,
    visit: &'w mut dyn FnMut(&Place<'v>, &'s Limits<'static>, f64),
}

impl<'s, 'v> Walk<'_, 's, 'v> {
    fn value(&mut self, place: &mut Place<'v>, node: &'s Node<'static>, value: &'v DeValue<'v>) {
        let node = self.schema.resolved(node);
        if !node.choices.is_empty() {
            let chosen = node.choices.iter().find(|choice| self.schema.fits(choice, value));
            chosen.into_iter().for_each(|choice| self.value(place, choice, value));
            return;
        }
        match value {
            DeValue::Table(table) => self.table(place, node, table),
            DeValue::Array(list) => self.list(place, node, list),
            DeValue::Float(float) if node.is_number() => {
                let value = float.as_str().parse().ok();
                value.into_iter().for_each(|value| (self.visit)(place, &node.limits, value));
            }
            DeValue::Integer(integer) if node.is_number() => {
                let value = i64::from_str_radix(integer.as_str(), integer.radix()).ok();
                value.into_iter().for_each(|value| (self.visit)(place, &node.limits, value as f64));
            }
            DeValue::String(_) if node.is_number() => {
                let value = self.source.number(&place.path());
                value.into_iter().for_each(|value| (self.visit)(place, &node.limits, value));
            }
            _ => {}
        }
    }

    fn table(&mut self, place: &mut Place<'v>, node: &'s Node<'static>, table: &'v DeTable<'v>) {
        for (key, value) in table {
            if let Some(own) = node.of_key(key.get_ref()) {
                place.at_key(key.get_ref(), |place| self.value(place, own, value.get_ref()));
            }
        }
    }

    fn list(
        &mut self,
        place: &mut Place<'v>,
        node: &'s Node<'static>,
        list: &'v [toml::Spanned<DeValue<'v>>],
    ) {
        let Some(items) = node.items.as_deref() else { return };
        let items = self.schema.resolved(items);
        let holds_numbers = items.is_number() || items.items.is_some();
        let mut elements = |place: &mut Place<'v>| {
            for (i, element) in list.iter().enumerate() {
                place.at_index(i, |place| self.value(place, items, element.get_ref()));
            }
        };
        if node.is_of_any_length() && holds_numbers {
            place.in_list(elements);
        } else {
            elements(place);
        }
    }
}
