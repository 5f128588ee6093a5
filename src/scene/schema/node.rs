//! Nodes of the JSON schema as the reader of scenes uses them.

use std::collections::BTreeMap;

use serde::de::{Deserializer, IgnoredAny, MapAccess, SeqAccess, Visitor};
use serde::{Deserialize, de};

use super::number::Limits;

/// The part of a schema that reading scenes needs.
#[derive(Default)]
pub struct Node<'s> {
    pub reference: Option<&'s str>,
    pub definitions: BTreeMap<&'s str, Node<'s>>,
    pub kind: Option<&'s str>,
    pub constant: Option<&'s str>,
    pub properties: BTreeMap<&'s str, Node<'s>>,
    /// Schema of all other keys.
    pub others: Option<Box<Node<'s>>>,
    pub required: Vec<&'s str>,
    pub items: Option<Box<Node<'s>>>,
    /// Smallest and largest length of a list.
    pub length: [Option<usize>; 2],
    /// Alternative schemas, one of which a value must satisfy.
    pub choices: Vec<Node<'s>>,
    pub limits: Limits<'s>,
}

impl<'s> Node<'s> {
    /// Schema of the value under a key.
    pub fn of_key(&self, key: &str) -> Option<&Node<'s>> {
        self.properties.get(key).or(self.others.as_deref())
    }

    pub fn is_number(&self) -> bool {
        matches!(self.kind, Some("number" | "integer"))
    }

    /// Returns true if lists may have more than one length.
    pub fn is_of_any_length(&self) -> bool {
        self.length[0].is_none() || self.length[0] != self.length[1]
    }
}

/// A type, or the first of several, of which the others are shorthand for it.
struct Kinds<'s>(Option<&'s str>);

impl<'de> Deserialize<'de> for Kinds<'de> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Reader;

        impl<'de> Visitor<'de> for Reader {
            type Value = Kinds<'de>;

            fn expecting(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
                f.write_str("a type or a list of types")
            }

            fn visit_borrowed_str<E: de::Error>(self, kind: &'de str) -> Result<Self::Value, E> {
                Ok(Kinds(Some(kind)))
            }

            fn visit_seq<A: SeqAccess<'de>>(self, mut list: A) -> Result<Self::Value, A::Error> {
                let first = list.next_element()?;
                while list.next_element::<IgnoredAny>()?.is_some() {}
                Ok(Kinds(first))
            }
        }

        deserializer.deserialize_any(Reader)
    }
}

/// Written by hand, because keywords of numbers are mixed with all others.
impl<'de> Deserialize<'de> for Node<'de> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Reader;

        impl<'de> Visitor<'de> for Reader {
            type Value = Node<'de>;

            fn expecting(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
                f.write_str("a schema")
            }

            /// `false` marks keys that do not exist.
            fn visit_bool<E: de::Error>(self, _: bool) -> Result<Self::Value, E> {
                Ok(Node::default())
            }

            fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<Self::Value, A::Error> {
                let mut node = Node::default();
                while let Some(key) = map.next_key::<&str>()? {
                    match key {
                        "$ref" => node.reference = map.next_value()?,
                        "$defs" => node.definitions = map.next_value()?,
                        "type" => node.kind = map.next_value::<Kinds>()?.0,
                        "const" => node.constant = map.next_value()?,
                        "properties" => node.properties = map.next_value()?,
                        "additionalProperties" => {
                            let other: Node = map.next_value()?;
                            node.others = other.reference.is_some().then(|| Box::new(other));
                        }
                        "required" => node.required = map.next_value()?,
                        "items" => node.items = map.next_value()?,
                        "minItems" => node.length[0] = map.next_value()?,
                        "maxItems" => node.length[1] = map.next_value()?,
                        "oneOf" | "anyOf" => node.choices = map.next_value()?,
                        key => {
                            if !node.limits.read(key, &mut map)? {
                                map.next_value::<IgnoredAny>()?;
                            }
                        }
                    }
                }
                Ok(node)
            }
        }

        deserializer.deserialize_any(Reader)
    }
}
