//! The parsed XML, and positions in it.

use roxmltree::{Attribute, Node};

use super::DESCRIPTION;
use super::finding::{Fault, Place};

pub struct Document<'a> {
    parsed: roxmltree::Document<'a>,
    /// Offsets of the line ends.
    ends: Vec<usize>,
}

/// Largest number of elements and texts in a description; they take about a gigabyte.
const MOST_NODES: u32 = 10_000_000;

impl<'a> Document<'a> {
    pub fn parse(text: &'a str) -> Result<Self, Fault> {
        let bytes = text.bytes().enumerate();
        let ends: Vec<usize> = bytes.filter(|&(_, byte)| byte == b'\n').map(|(at, _)| at).collect();
        let fault = |line, wrong: String| {
            Fault::new(Place { line: Some(line), ..Place::file(DESCRIPTION) }, wrong)
        };
        super::extent::check(text).map_err(|(at, wrong)| fault(line(&ends, at), wrong))?;
        let options = roxmltree::ParsingOptions { nodes_limit: MOST_NODES, ..Default::default() };
        let parsed = roxmltree::Document::parse_with_options(text, options);
        let parsed = parsed.map_err(|error| fault(error.pos().row, error.to_string()))?;
        Ok(Self { parsed, ends })
    }

    pub fn root(&self) -> Node<'_, 'a> {
        self.parsed.root_element()
    }

    /// The position of an element.
    pub fn place(&self, node: Node) -> Place {
        self.at(node.range().start, node)
    }

    /// The position of an attribute, or of the element if it has no such attribute.
    pub fn place_of(&self, node: Node, attribute: &str) -> Place {
        let at = node.attribute_node(attribute).map_or(node.range().start, |a| a.range().start);
        self.at(at, node)
    }

    fn at(&self, offset: usize, node: Node) -> Place {
        Place {
            file: DESCRIPTION.into(),
            line: Some(line(&self.ends, offset)),
            element: title(node),
        }
    }
}

/// The line of an offset, counted from one.
fn line(ends: &[usize], at: usize) -> u32 {
    u32::try_from(1 + ends.partition_point(|&end| end < at)).unwrap_or(u32::MAX)
}

/// Identifies an element: its name, and the attribute that distinguishes it from its neighbours. The type of a variable
/// is identified by the name of the variable.
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

/// The attributes of FMI, without those of other namespaces such as that of XML schemas.
pub fn attributes<'a, 'i: 'a>(node: Node<'a, 'i>) -> impl Iterator<Item = Attribute<'a, 'i>> {
    node.attributes().filter(|attribute| attribute.namespace().is_none())
}
