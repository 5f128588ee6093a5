//! modelDescription.xml as plain data. Malformed parts are omitted here; the rule `schema` reports them.

use std::collections::HashMap;

use roxmltree::Node;

use super::combination;
use super::document::{Document, child, elements, list};
use super::vocabulary::{Causality, Initial, Kind, Variability};

pub struct Description<'a> {
    pub root: Node<'a, 'a>,
    pub guid: &'a str,
    pub interfaces: Vec<Interface<'a>>,
    pub units: Vec<Unit<'a>>,
    pub types: Vec<SimpleType<'a>>,
    /// Indices of the first types of each name.
    types_by_name: HashMap<&'a str, usize>,
    pub variables: Vec<Variable<'a>>,
    pub outputs: Vec<Unknown<'a>>,
    pub derivatives: Vec<Unknown<'a>>,
    pub initial_unknowns: Vec<Unknown<'a>>,
}

/// ModelExchange or CoSimulation.
pub struct Interface<'a> {
    pub node: Node<'a, 'a>,
    pub is_co_simulation: bool,
    pub identifier: &'a str,
}

pub struct Unit<'a> {
    pub node: Node<'a, 'a>,
    pub name: &'a str,
    pub display_units: Vec<&'a str>,
}

pub struct SimpleType<'a> {
    pub node: Node<'a, 'a>,
    pub name: &'a str,
    pub kind: Option<Kind>,
    /// The element with the attributes.
    pub details: Option<Node<'a, 'a>>,
}

pub struct Variable<'a> {
    pub node: Node<'a, 'a>,
    pub name: &'a str,
    pub reference: Option<u32>,
    pub kind: Option<Kind>,
    /// The element with the attributes of the kind.
    pub details: Option<Node<'a, 'a>>,
    /// The causality as written, or the default; `None` if the word is unknown.
    pub causality: Option<Causality>,
    pub variability: Option<Variability>,
    /// `initial` as written, or the default for causality and variability; `None` for inputs and similar variables.
    pub initial: Option<Initial>,
}

/// An entry of ModelStructure.
pub struct Unknown<'a> {
    pub node: Node<'a, 'a>,
    /// Index counted from one.
    pub index: Option<usize>,
    pub dependencies: Option<Vec<usize>>,
    pub kinds: Option<Vec<&'a str>>,
}

impl<'a> Description<'a> {
    pub fn read(document: &'a Document<'a>) -> Self {
        let root = document.root();
        let structure = child(root, "ModelStructure");
        let unknowns = |of| -> Vec<Unknown> {
            let nodes = structure.into_iter().flat_map(|node| list(node, of, "Unknown"));
            nodes.map(unknown).collect()
        };
        let types: Vec<SimpleType> =
            list(root, "TypeDefinitions", "SimpleType").map(simple_type).collect();
        let names = types.iter().enumerate().rev();
        let types_by_name = names.map(|(place, declared)| (declared.name, place)).collect();
        Self {
            root,
            guid: root.attribute("guid").unwrap_or_default(),
            interfaces: elements(root).filter_map(interface).collect(),
            units: list(root, "UnitDefinitions", "Unit").map(unit).collect(),
            types,
            types_by_name,
            variables: list(root, "ModelVariables", "ScalarVariable").map(variable).collect(),
            outputs: unknowns("Outputs"),
            derivatives: unknowns("Derivatives"),
            initial_unknowns: unknowns("InitialUnknowns"),
        }
    }

    /// The variable of an index, which the XML counts from one.
    pub fn variable(&self, index: usize) -> Option<&Variable<'a>> {
        self.variables.get(index.checked_sub(1)?)
    }

    pub fn declared_type(&self, variable: &Variable) -> Option<&SimpleType<'a>> {
        let name = variable.attribute("declaredType")?;
        self.types_by_name.get(name).map(|&place| &self.types[place])
    }

    /// An attribute of a variable, or of its declared type if it has none of its own.
    pub fn attribute(&self, variable: &Variable<'a>, name: &str) -> Option<&'a str> {
        variable.attribute(name).or_else(|| self.declared_type(variable)?.details?.attribute(name))
    }

    /// Indices of the states: the variables that have a derivative.
    pub fn states(&self) -> impl Iterator<Item = usize> {
        self.variables.iter().filter_map(Variable::derivative)
    }
}

impl<'a> Variable<'a> {
    /// An attribute of the element of its kind.
    pub fn attribute(&self, name: &str) -> Option<&'a str> {
        self.details?.attribute(name)
    }

    /// Index of the variable that this one is the derivative of.
    pub fn derivative(&self) -> Option<usize> {
        self.attribute("derivative")?.trim().parse().ok()
    }

    /// Returns true if a master may set it before or while the unit runs.
    pub fn is_settable(&self) -> bool {
        matches!(self.causality, Some(Causality::Parameter | Causality::Input))
            || self.variability != Some(Variability::Constant)
                && matches!(self.initial, Some(Initial::Exact | Initial::Approx))
    }
}

fn interface<'a>(node: Node<'a, 'a>) -> Option<Interface<'a>> {
    let is_co_simulation = match node.tag_name().name() {
        "CoSimulation" => true,
        "ModelExchange" => false,
        _ => return None,
    };
    let identifier = node.attribute("modelIdentifier").unwrap_or_default();
    Some(Interface { node, is_co_simulation, identifier })
}

fn unit<'a>(node: Node<'a, 'a>) -> Unit<'a> {
    let shown = elements(node).filter(|child| child.tag_name().name() == "DisplayUnit");
    Unit {
        node,
        name: node.attribute("name").unwrap_or_default(),
        display_units: shown.filter_map(|child| child.attribute("name")).collect(),
    }
}

fn simple_type<'a>(node: Node<'a, 'a>) -> SimpleType<'a> {
    let (kind, details) = details(node);
    SimpleType { node, name: node.attribute("name").unwrap_or_default(), kind, details }
}

fn details<'a>(node: Node<'a, 'a>) -> (Option<Kind>, Option<Node<'a, 'a>>) {
    let of_kind = |child: Node<'a, 'a>| Some((Kind::read(child.tag_name().name())?, child));
    elements(node).find_map(of_kind).unzip()
}

fn variable<'a>(node: Node<'a, 'a>) -> Variable<'a> {
    let (kind, details) = details(node);
    let causality = node.attribute("causality").map_or(Some(Causality::Local), Causality::read);
    // The schema's default is `continuous`, which only reals can be; masters treat others as discrete.
    let by_kind =
        if kind == Some(Kind::Real) { Variability::Continuous } else { Variability::Discrete };
    let variability = node.attribute("variability").map_or(Some(by_kind), Variability::read);
    let default = || {
        let allowed = combination::allowed(causality?, variability?)?;
        allowed.first().copied()
    };
    Variable {
        node,
        name: node.attribute("name").unwrap_or_default(),
        reference: node.attribute("valueReference").and_then(|text| text.trim().parse().ok()),
        kind,
        details,
        causality,
        variability,
        initial: node.attribute("initial").map_or_else(default, Initial::read),
    }
}

fn unknown<'a>(node: Node<'a, 'a>) -> Unknown<'a> {
    let indices = |text: &str| {
        text.split_whitespace().map(|item| item.parse()).collect::<Result<Vec<usize>, _>>().ok()
    };
    Unknown {
        node,
        index: node.attribute("index").and_then(|text| text.trim().parse().ok()),
        dependencies: node.attribute("dependencies").and_then(indices),
        kinds: node.attribute("dependenciesKind").map(|text| text.split_whitespace().collect()),
    }
}
