//! Common parts of the model descriptions of both versions, sections 2.2 of FMI 2.0 and 2.4 of FMI 3.0.

use std::collections::BTreeSet;
use std::io;

use quick_xml::Writer;
use quick_xml::events::{BytesDecl, Event};

use super::gate::log::Category;
use super::guid::guid;
use crate::scene::Scene;
use crate::variables::{Causality, DisplayUnit, Quantity, Registry};

pub type Xml = Writer<Vec<u8>>;
pub type Attributes = Vec<(&'static str, String)>;

/// A modelDescription.xml: the parts that depend on the version of the standard.
pub trait Description {
    const VERSION: &'static str;
    /// Name of the attribute that holds the GUID.
    const GUID: &'static str;
    /// Attributes of the root that the other version lacks.
    const MORE: &'static [(&'static str, &'static str)];

    /// The quantities that variables have.
    fn quantities(&self) -> BTreeSet<Quantity>;

    /// Attributes of the element `CoSimulation`.
    fn co_simulation(&self) -> Attributes;

    /// Writes the type of variables of one quantity.
    fn type_definition(&self, xml: &mut Xml, quantity: Quantity) -> io::Result<()>;

    /// Writes the elements of `ModelVariables`.
    fn variables(&self, xml: &mut Xml) -> io::Result<()>;

    /// Writes the elements of `ModelStructure`.
    fn structure(&self, xml: &mut Xml) -> io::Result<()>;
}

/// Returns the text of a description; `scene_text` is the scene text stored in the unit.
pub fn model_description<D: Description>(
    description: &D,
    scene: &Scene,
    registry: &Registry,
    scene_text: &str,
) -> String {
    let mut root: Attributes = vec![
        ("fmiVersion", D::VERSION.into()),
        ("modelName", scene.name.clone()),
        (D::GUID, guid(scene_text, registry)),
    ];
    if !scene.description.is_empty() {
        root.push(("description", scene.description.clone()));
    }
    root.extend([
        ("license", env!("CARGO_PKG_LICENSE").into()),
        ("generationTool", concat!("impinge ", env!("CARGO_PKG_VERSION")).into()),
        ("variableNamingConvention", scene.naming.name().into()),
    ]);
    root.extend(D::MORE.iter().map(|(name, value)| (*name, (*value).to_owned())));
    let used = description.quantities();
    document("fmiModelDescription", &root, |xml| {
        leaf(xml, "CoSimulation", &description.co_simulation())?;
        parent(xml, "UnitDefinitions", &[], |xml| units(xml, &used))?;
        parent(xml, "TypeDefinitions", &[], |xml| {
            used.iter().try_for_each(|quantity| description.type_definition(xml, *quantity))
        })?;
        parent(xml, "LogCategories", &[], log_categories)?;
        default_experiment(xml, scene)?;
        parent(xml, "ModelVariables", &[], |xml| description.variables(xml))?;
        parent(xml, "ModelStructure", &[], |xml| description.structure(xml))
    })
}

/// The text of an XML document with this root.
pub fn document(
    root: &str,
    attributes: &[(&'static str, String)],
    content: impl FnOnce(&mut Xml) -> io::Result<()>,
) -> String {
    let mut xml = Writer::new_with_indent(Vec::new(), b' ', 2);
    let declared = xml.write_event(Event::Decl(BytesDecl::new("1.0", Some("UTF-8"), None)));
    let written = declared.and_then(|()| parent(&mut xml, root, attributes, content));
    written.expect("a vector takes whatever is written");
    let mut text = String::from_utf8(xml.into_inner()).expect("made from strings");
    text.push('\n');
    text
}

/// Name of a causality in the XML.
pub fn causality(causality: Causality) -> &'static str {
    match causality {
        Causality::Parameter => "parameter",
        Causality::Input => "input",
        Causality::Output => "output",
    }
}

/// Causality, variability and the way of initialisation of a variable.
pub fn kind(of: Causality, is_tunable: bool, quantity: Option<Quantity>) -> Attributes {
    let (variability, initial) = match of {
        Causality::Parameter if is_tunable => ("tunable", Some("exact")),
        Causality::Parameter => ("fixed", Some("exact")),
        // Counts change only in steps.
        Causality::Input if quantity == Some(Quantity::Count) => ("discrete", None),
        Causality::Input => ("continuous", None),
        Causality::Output => ("continuous", Some("calculated")),
    };
    kind_of(causality(of), variability, initial)
}

/// Returns the attributes of a variable for its causality, its variability and its initialisation.
pub fn kind_of(
    causality: &'static str,
    variability: &'static str,
    initial: Option<&'static str>,
) -> Attributes {
    let initial = initial.map(|initial| ("initial", initial));
    let all = [("causality", causality), ("variability", variability)].into_iter().chain(initial);
    all.map(|(name, value)| (name, value.to_owned())).collect()
}

/// Unit and size of a type, without its name.
pub fn type_attributes(quantity: Quantity) -> Attributes {
    let mut attributes: Attributes =
        vec![("quantity", quantity.type_name().into()), ("unit", quantity.unit().into())];
    if let Some(display) = quantity.display_unit() {
        attributes.push(("displayUnit", display.name.into()));
    }
    attributes.push(("nominal", number(quantity.nominal())));
    attributes
}

/// One definition per unit; quantities of one unit may be shown in different ways.
fn units(xml: &mut Xml, used: &BTreeSet<Quantity>) -> io::Result<()> {
    let mut written = BTreeSet::new();
    for quantity in used {
        let unit = quantity.unit();
        if !written.insert(unit) {
            continue;
        }
        parent(xml, "Unit", &[("name", unit.into())], |xml| {
            if let Some(base) = base_unit(*quantity) {
                leaf(xml, "BaseUnit", &base)?;
            }
            let same_unit = used.iter().filter(|other| other.unit() == unit);
            same_unit
                .filter_map(|other| other.display_unit())
                .try_for_each(|display| leaf(xml, "DisplayUnit", &display_unit(display)))
        })?;
    }
    Ok(())
}

/// Exponents of a unit, which FMI has only as whole numbers.
fn base_unit(quantity: Quantity) -> Option<Attributes> {
    let exponents = ["kg", "m", "s", "K"].into_iter().zip(quantity.base_exponents()?);
    let angle = ("rad", i32::from(quantity == Quantity::Angle));
    let all = exponents.chain([angle]).filter(|(_, e)| *e != 0);
    Some(all.map(|(name, e)| (name, e.to_string())).collect())
}

fn display_unit(unit: DisplayUnit) -> Attributes {
    let mut attributes: Attributes = vec![("name", unit.name.into())];
    if unit.factor != 1.0 {
        attributes.push(("factor", number(unit.factor)));
    }
    if unit.offset != 0.0 {
        attributes.push(("offset", number(unit.offset)));
    }
    attributes
}

fn log_categories(xml: &mut Xml) -> io::Result<()> {
    Category::ALL.into_iter().try_for_each(|category| {
        let attributes: Attributes =
            vec![("name", category.name().into()), ("description", category.description().into())];
        leaf(xml, "Category", &attributes)
    })
}

fn default_experiment(xml: &mut Xml, scene: &Scene) -> io::Result<()> {
    let attributes: Attributes = vec![
        ("startTime", "0.0".into()),
        ("stopTime", number(scene.stop_time)),
        ("stepSize", number(scene.step)),
    ];
    leaf(xml, "DefaultExperiment", &attributes)
}

/// A number as XML shows it.
pub fn number(value: f64) -> String {
    format!("{value:?}")
}

/// A whole number as XML shows it.
pub fn whole_number(value: f64) -> String {
    format!("{value:.0}")
}

/// Writes an element without content.
pub fn leaf(xml: &mut Xml, name: &str, attributes: &[(&'static str, String)]) -> io::Result<()> {
    let pairs = attributes.iter().map(|(key, value)| (*key, value.as_str()));
    xml.create_element(name).with_attributes(pairs).write_empty().map(drop)
}

/// Writes an element with content.
pub fn parent(
    xml: &mut Xml,
    name: &str,
    attributes: &[(&'static str, String)],
    content: impl FnOnce(&mut Xml) -> io::Result<()>,
) -> io::Result<()> {
    let pairs = attributes.iter().map(|(key, value)| (*key, value.as_str()));
    xml.create_element(name).with_attributes(pairs).write_inner_content(content).map(drop)
}
