//! Finds every number of a scene together with what the schema says of it.

use serde_json::Value;
use toml::de::{DeTable, DeValue};

use super::{Number, Place, Schema, choices, of_key};
use crate::limits::is_number;
use crate::scene::locate::Source;

impl Schema {
    /// Calls `visit` with every number of a decoded scene's text.
    pub fn numbers<'s, 'v>(
        &'s self,
        source: &'v Source<'v>,
        visit: &mut dyn FnMut(&Place<'v>, &Number<'s>, f64),
    ) {
        Walk { schema: self, visit }.value(&mut Place::default(), &self.root, source.root());
    }

    /// Whether a value is of the kind that the schema is of, without a look at what is in it.
    fn fits(&self, schema: &Value, value: &DeValue) -> bool {
        let schema = self.resolved(schema);
        if let Some(list) = choices(schema) {
            return list.iter().any(|choice| self.fits(choice, value));
        }
        match (schema.get("type").and_then(Value::as_str), value) {
            (Some("object"), DeValue::Table(_)) => is_table(schema, value),
            (Some("array"), DeValue::Array(list)) => {
                let items = schema.get("items");
                list.first()
                    .zip(items)
                    .is_none_or(|(first, items)| self.fits(items, first.get_ref()))
            }
            (Some("number"), DeValue::Float(_) | DeValue::Integer(_)) => true,
            (Some("integer"), DeValue::Integer(_)) => true,
            (Some("string"), DeValue::String(_)) => true,
            (Some("boolean"), DeValue::Boolean(_)) => true,
            _ => false,
        }
    }
}

/// Whether a table has the keys that it must have, and says what it must say.
fn is_table(schema: &Value, table: &DeValue) -> bool {
    let required = schema.get("required").and_then(Value::as_array);
    required.into_iter().flatten().filter_map(Value::as_str).all(|key| {
        let Some(value) = table.get(key) else { return false };
        let said = of_key(schema, key).and_then(|own| own.get("const")).and_then(Value::as_str);
        said.is_none_or(|said| value.get_ref().as_str() == Some(said))
    })
}

struct Walk<'w, 's, 'v> {
    schema: &'s Schema,
    visit: &'w mut dyn FnMut(&Place<'v>, &Number<'s>, f64),
}

impl<'s, 'v> Walk<'_, 's, 'v> {
    fn value(&mut self, place: &mut Place<'v>, schema: &'s Value, value: &'v DeValue<'v>) {
        let schema = self.schema.resolved(schema);
        if let Some(list) = choices(schema) {
            let chosen = list.iter().find(|choice| self.schema.fits(choice, value));
            chosen.into_iter().for_each(|choice| self.value(place, choice, value));
            return;
        }
        match value {
            DeValue::Table(table) => self.table(place, schema, table),
            DeValue::Array(list) => self.list(place, schema, list),
            _ => self.number(place, schema, value),
        }
    }

    fn table(&mut self, place: &mut Place<'v>, schema: &'s Value, table: &'v DeTable<'v>) {
        for (key, value) in table {
            if let Some(own) = of_key(schema, key.get_ref()) {
                place.at_key(key.get_ref(), |place| self.value(place, own, value.get_ref()));
            }
        }
    }

    fn list(
        &mut self,
        place: &mut Place<'v>,
        schema: &'s Value,
        list: &'v [toml::Spanned<DeValue<'v>>],
    ) {
        let Some(items) = schema.get("items") else { return };
        let items = self.schema.resolved(items);
        let is_any_length =
            schema.get("minItems") != schema.get("maxItems") || schema.get("minItems").is_none();
        let number = items.as_object().filter(|items| is_number(items)).map(Number::new);
        let mut elements = |place: &mut Place<'v>| {
            for (i, element) in list.iter().enumerate() {
                place.at_index(i, |place| match &number {
                    Some(number) => self.visit_number(place, number, element.get_ref()),
                    None => self.value(place, items, element.get_ref()),
                });
            }
        };
        if is_any_length && (number.is_some() || items.get("items").is_some()) {
            place.in_list(elements);
        } else {
            elements(place);
        }
    }

    fn number(&mut self, place: &mut Place<'v>, schema: &'s Value, value: &'v DeValue<'v>) {
        if let Some(keywords) = schema.as_object().filter(|keywords| is_number(keywords)) {
            self.visit_number(place, &Number::new(keywords), value);
        }
    }

    fn visit_number(&mut self, place: &Place<'v>, number: &Number<'s>, value: &DeValue) {
        let value = match value {
            DeValue::Float(float) => float.as_str().parse().ok(),
            DeValue::Integer(integer) => {
                let parsed = i64::from_str_radix(integer.as_str(), integer.radix()).ok();
                parsed.map(|integer| integer as f64)
            }
            _ => None,
        };
        value.into_iter().for_each(|value| (self.visit)(place, number, value));
    }
}
