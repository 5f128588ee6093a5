//! The parsed XML, and places in it.

use roxmltree::{Attribute, Node};

use super::DESCRIPTION;
use super::finding::{Fault, Place};

pub struct Document<'a>(roxmltree::Document<'a>);

impl<'a> Document<'a> {
    pub fn parse(text: &'a str) -> Result<Self, Fault> {
        roxmltree::Document::parse(text).map(Self).map_err(|error| {
            let place = Place { line: Some(error.pos().row), ..Place::file(DESCRIPTION) };
            Fault::new(place, error.to_string())
        })
    }

    pub fn root(&self) -> Node<'_, 'a> {
        self.0.root_element()
    }

    /// The place of an element.
    pub fn place(&self, node: Node) -> Place {
        self.at(node.range().start, node)
    }

    /// The place of an attribute, or of the element if it has no such attribute.
    pub fn place_of(&self, node: Node, attribute: &str) -> Place {
        let at = node.attribute_node(attribute).map_or(node.range().start, |a| a.range().start);
        self.at(at, node)
    }

    fn at(&self, offset: usize, node: Node) -> Place {
        Place {
            file: DESCRIPTION.into(),
            line: Some(self.0.text_pos_at(offset).row),
            element: title(node),
        }
    }
}

/// An element in words that find it: its name, and what tells it from its neighbours. The type of a
/// variable goes by the name of the variable.
pub fn title(node: Node) -> String {
    let named = |node: Node| {
        ["name", "index"].iter().find_map(|key| node.attribute(*key).map(str::to_owned))
    };
    let tag = |node: Node| node.tag_name().name().to_owned();
    match (named(node), node.parent_element().filter(|parent| named(*parent).is_some())) {
        (Some(name), _) => format!("{} {name:?}", tag(node)),
        (None, Some(parent)) => title(parent),
        (None, None) => tag(node),
    }
}

/// The children that are elements.
pub fn elements<'a, 'i: 'a>(node: Node<'a, 'i>) -> impl Iterator<Item = Node<'a, 'i>> {
    node.children().filter(Node::is_element)
}

/// The first child of this name.
pub fn child<'a, 'i: 'a>(node: Node<'a, 'i>, name: &str) -> Option<Node<'a, 'i>> {
    elements(node).find(|child| child.tag_name().name() == name)
}

/// The children of this name of a child: `list(root, "ModelVariables", "ScalarVariable")`.
pub fn list<'a, 'i: 'a>(
    node: Node<'a, 'i>,
    of: &str,
    name: &'static str,
) -> impl Iterator<Item = Node<'a, 'i>> {
    let children = child(node, of).into_iter().flat_map(elements);
    children.filter(move |child| child.tag_name().name() == name)
}

/// The attributes that belong to FMI, not to another namespace such as that of XML schemas.
pub fn attributes<'a, 'i: 'a>(node: Node<'a, 'i>) -> impl Iterator<Item = Attribute<'a, 'i>> {
    node.attributes().filter(|attribute| attribute.namespace().is_none())
}
