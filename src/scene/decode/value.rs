//! A serde deserializer over TOML values that records the position of each of them.

use std::collections::{BTreeMap, BTreeSet};

use serde::de::value::StrDeserializer;
use serde::de::{
    DeserializeSeed, Deserializer, EnumAccess, Error, Expected, IntoDeserializer, MapAccess,
    SeqAccess, Unexpected, VariantAccess, Visitor,
};
use serde::forward_to_deserialize_any;
use toml::de::{DeInteger, DeTable, DeValue};

use super::failure::Failure;
use crate::scene::locate::Path;

/// Modifications with which the values of a scene are read.
pub struct View<'a> {
    /// Values treated as absent.
    pub left_out: &'a BTreeSet<Path>,
    /// A key treated as present, with a value that fits no type.
    pub blank: Option<&'a Path>,
    /// Numbers in the place of texts.
    pub numbers: &'a BTreeMap<Path, f64>,
}

/// A value and its position.
#[derive(Clone)]
pub struct Node<'a> {
    /// `None` is the value that fits no type.
    value: Option<&'a DeValue<'a>>,
    path: Path,
    view: &'a View<'a>,
    keys: Keys,
}

/// The keys of a table that are read; the others read as if they were not there.
#[derive(Debug, Clone, Copy)]
pub enum Keys {
    All,
    /// All but one.
    But(&'static str),
    Among(&'static [&'static str]),
}

impl Keys {
    fn contain(self, key: &str) -> bool {
        match self {
            Self::All => true,
            Self::But(other) => key != other,
            Self::Among(list) => list.contains(&key),
        }
    }
}

impl<'a> Node<'a> {
    /// Node of the value at `path`.
    pub fn new(value: &'a DeValue<'a>, path: Path, view: &'a View<'a>) -> Self {
        Self { value: Some(value), path, view, keys: Keys::All }
    }

    /// The same table of which some keys are read.
    pub fn with(self, keys: Keys) -> Self {
        Self { keys, ..self }
    }

    fn read<T: DeserializeSeed<'a>>(self, seed: T) -> Result<T::Value, Failure> {
        let path = self.path.clone();
        seed.deserialize(self).map_err(|failure| failure.or_at(&path))
    }

    fn entries(&self, table: &'a DeTable<'a>) -> Vec<(&'a str, Node<'a>)> {
        let mut entries = Vec::new();
        for (key, value) in table {
            let key: &str = key.get_ref();
            let path = self.path.key(key);
            if self.keys.contain(key) && !self.view.left_out.contains(&path) {
                entries.push((key, Node::new(value.get_ref(), path, self.view)));
            }
        }
        entries
    }

    fn elements(&self, array: &'a [toml::Spanned<DeValue<'a>>]) -> Vec<Node<'a>> {
        let located = array.iter().enumerate().map(|(i, value)| (self.path.index(i), value));
        located
            .filter(|(path, _)| !self.view.left_out.contains(path))
            .map(|(path, value)| Node::new(value.get_ref(), path, self.view))
            .collect()
    }

    fn visit_table<V: Visitor<'a>>(
        &self,
        table: &'a DeTable<'a>,
        visitor: V,
    ) -> Result<V::Value, Failure> {
        let mut entries = self.entries(table);
        if let Some(blank) = self.view.blank.filter(|blank| blank.parent() == self.path) {
            let node = Node { value: None, path: blank.clone(), view: self.view, keys: Keys::All };
            entries.push((blank.last_key(), node));
        }
        visitor.visit_map(Entries { entries: entries.into_iter(), value: None })
    }

    fn visit_array<V: Visitor<'a>>(
        &self,
        array: &'a [toml::Spanned<DeValue<'a>>],
        visitor: V,
    ) -> Result<V::Value, Failure> {
        let expected = shown(&visitor);
        let mut elements = Elements(self.elements(array).into_iter());
        let value = visitor.visit_seq(&mut elements)?;
        if elements.0.next().is_some() { Err(Failure::expecting(expected)) } else { Ok(value) }
    }

    fn visit<V: Visitor<'a>>(&self, visitor: V) -> Result<V::Value, Failure> {
        match self.value {
            None if shown(&visitor) == "variant identifier" => visitor.visit_str(""),
            // Of an enum without tags, which describes itself when no variant fits.
            None if shown(&visitor) == "any value" => visitor.visit_unit(),
            None => Err(Failure::invalid_type(Unexpected::Unit, &visitor)),
            Some(DeValue::String(text)) => match self.view.numbers.get(&self.path) {
                Some(number) => visitor.visit_f64(*number),
                None => visitor.visit_str(text),
            },
            Some(DeValue::Integer(integer)) => match parsed(integer) {
                Some(integer) => visitor.visit_i64(integer),
                None => Err(Failure::invalid_value(Unexpected::Other("integer"), &visitor)),
            },
            Some(DeValue::Float(float)) => match float.as_str().parse() {
                Ok(float) => visitor.visit_f64(float),
                Err(_) => Err(Failure::invalid_value(Unexpected::Other("float"), &visitor)),
            },
            Some(DeValue::Boolean(boolean)) => visitor.visit_bool(*boolean),
            Some(DeValue::Datetime(_)) => {
                Err(Failure::invalid_type(Unexpected::Other("date"), &visitor))
            }
            Some(DeValue::Array(array)) => self.visit_array(array, visitor),
            Some(DeValue::Table(table)) => self.visit_table(table, visitor),
        }
    }

    /// The variant name: a plain string, or the only key of a table.
    fn choice(&self, known: &'static [&'static str]) -> Result<Choice<'a>, Failure> {
        let path = self.path.clone();
        match self.value {
            Some(DeValue::String(name)) => Ok(Choice { name, path, value: None }),
            Some(DeValue::Table(table)) => match &self.entries(table)[..] {
                [(name, node)] => {
                    Ok(Choice { name, path: node.path.clone(), value: Some(node.clone()) })
                }
                _ => Err(Failure::expecting(format!("one of {}", known.join(", ")))),
            },
            _ => Err(Failure::expecting(format!("one of {}", known.join(", ")))),
        }
    }
}

/// Describes the value that serde expects.
fn shown(expected: &dyn Expected) -> String {
    expected.to_string()
}

fn parsed(integer: &DeInteger) -> Option<i64> {
    i64::from_str_radix(integer.as_str(), integer.radix()).ok()
}

impl<'a> Deserializer<'a> for Node<'a> {
    type Error = Failure;

    fn deserialize_any<V: Visitor<'a>>(self, visitor: V) -> Result<V::Value, Failure> {
        self.visit(visitor).map_err(|failure| failure.or_at(&self.path))
    }

    fn deserialize_option<V: Visitor<'a>>(self, visitor: V) -> Result<V::Value, Failure> {
        visitor.visit_some(self)
    }

    fn deserialize_newtype_struct<V: Visitor<'a>>(
        self,
        _: &'static str,
        visitor: V,
    ) -> Result<V::Value, Failure> {
        visitor.visit_newtype_struct(self)
    }

    /// serde would also accept a list with the fields in their order.
    fn deserialize_struct<V: Visitor<'a>>(
        self,
        _: &'static str,
        _: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value, Failure> {
        match self.value {
            Some(DeValue::Array(_)) => {
                Err(Failure::invalid_type(Unexpected::Seq, &visitor).or_at(&self.path))
            }
            _ => self.deserialize_any(visitor),
        }
    }

    fn deserialize_enum<V: Visitor<'a>>(
        self,
        _: &'static str,
        known: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value, Failure> {
        let choice = self.choice(known).map_err(|failure| failure.or_at(&self.path))?;
        visitor.visit_enum(choice).map_err(|failure| failure.or_at(&self.path))
    }

    forward_to_deserialize_any! {
        <V: Visitor<'a>>
        bool i8 i16 i32 i64 i128 u8 u16 u32 u64 u128 f32 f64 char str string bytes byte_buf unit
        unit_struct seq tuple tuple_struct map identifier ignored_any
    }
}

struct Elements<'a>(std::vec::IntoIter<Node<'a>>);

impl<'a> SeqAccess<'a> for Elements<'a> {
    type Error = Failure;

    fn next_element_seed<T: DeserializeSeed<'a>>(
        &mut self,
        seed: T,
    ) -> Result<Option<T::Value>, Failure> {
        self.0.next().map(|node| node.read(seed)).transpose()
    }
}

struct Entries<'a> {
    entries: std::vec::IntoIter<(&'a str, Node<'a>)>,
    /// The value of the most recently read key.
    value: Option<Node<'a>>,
}

impl<'a> MapAccess<'a> for Entries<'a> {
    type Error = Failure;

    fn next_key_seed<K: DeserializeSeed<'a>>(
        &mut self,
        seed: K,
    ) -> Result<Option<K::Value>, Failure> {
        let Some((key, node)) = self.entries.next() else { return Ok(None) };
        let read = seed.deserialize(name(key)).map_err(|failure| failure.or_at(&node.path))?;
        self.value = Some(node);
        Ok(Some(read))
    }

    fn next_value_seed<T: DeserializeSeed<'a>>(&mut self, seed: T) -> Result<T::Value, Failure> {
        match self.value.take() {
            Some(node) => node.read(seed),
            None => Err(Failure::expecting("a key before its value")),
        }
    }
}

fn name(key: &str) -> StrDeserializer<'_, Failure> {
    key.into_deserializer()
}

/// A variant of an enum: its name, and the value under that name.
struct Choice<'a> {
    name: &'a str,
    path: Path,
    value: Option<Node<'a>>,
}

impl<'a> EnumAccess<'a> for Choice<'a> {
    type Error = Failure;
    type Variant = Self;

    fn variant_seed<V: DeserializeSeed<'a>>(self, seed: V) -> Result<(V::Value, Self), Failure> {
        let read =
            seed.deserialize(name(self.name)).map_err(|failure| failure.or_at(&self.path))?;
        Ok((read, self))
    }
}

impl<'a> Choice<'a> {
    fn under_the_name(self) -> Result<Node<'a>, Failure> {
        let Self { name, path, value } = self;
        let lacking = || Failure::expecting(format!("`{{ {name} = … }}`")).or_at(&path);
        value.ok_or_else(lacking)
    }
}

impl<'a> VariantAccess<'a> for Choice<'a> {
    type Error = Failure;

    fn unit_variant(self) -> Result<(), Failure> {
        match self.value {
            None => Ok(()),
            Some(_) => Err(Failure::expecting(format!("{:?}", self.name)).or_at(&self.path)),
        }
    }

    fn newtype_variant_seed<T: DeserializeSeed<'a>>(self, seed: T) -> Result<T::Value, Failure> {
        self.under_the_name()?.read(seed)
    }

    fn tuple_variant<V: Visitor<'a>>(self, _: usize, visitor: V) -> Result<V::Value, Failure> {
        self.under_the_name()?.deserialize_any(visitor)
    }

    fn struct_variant<V: Visitor<'a>>(
        self,
        fields: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value, Failure> {
        self.under_the_name()?.deserialize_struct("", fields, visitor)
    }
}
