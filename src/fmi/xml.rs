//! modelDescription.xml of a scene's unit, section 2.2 and 4.3 of the standard.

use std::collections::{BTreeSet, HashMap};
use std::io;

use quick_xml::Writer;
use quick_xml::events::{BytesDecl, Event};

use super::guid::guid;
use super::log::Category;
use super::rates::highest_output_derivative;
use crate::scene::Scene;
use crate::variables::{Causality, DisplayUnit, Quantity, Registry, Value, Variable};

pub(super) type Xml = Writer<Vec<u8>>;
pub(super) type Attributes = Vec<(&'static str, String)>;

/// The modelDescription.xml of a checked scene; `scene_text` is what the unit carries.
pub fn model_description(scene: &Scene, scene_text: &str) -> String {
    let registry = Registry::of(scene);
    let guid = guid(scene_text, &registry);
    let mut xml = Writer::new_with_indent(Vec::new(), b' ', 2);
    document(&mut xml, scene, &registry, guid).expect("a vector takes whatever is written");
    let mut text = String::from_utf8(xml.into_inner()).expect("made from strings");
    text.push('\n');
    text
}

/// Name of a causality in the XML.
pub(super) fn causality(causality: Causality) -> &'static str {
    match causality {
        Causality::Parameter => "parameter",
        Causality::Input => "input",
        Causality::Output => "output",
    }
}

fn document(xml: &mut Xml, scene: &Scene, registry: &Registry, guid: String) -> io::Result<()> {
    xml.write_event(Event::Decl(BytesDecl::new("1.0", Some("UTF-8"), None)))?;
    let mut root: Attributes =
        vec![("fmiVersion", "2.0".into()), ("modelName", scene.name.clone()), ("guid", guid)];
    if !scene.description.is_empty() {
        root.push(("description", scene.description.clone()));
    }
    root.extend([
        ("license", env!("CARGO_PKG_LICENSE").into()),
        ("generationTool", concat!("impinge ", env!("CARGO_PKG_VERSION")).into()),
        ("variableNamingConvention", scene.naming.name().into()),
        ("numberOfEventIndicators", "0".into()),
    ]);
    let used: BTreeSet<Quantity> = registry.variables.iter().filter_map(|v| v.quantity).collect();
    parent(xml, "fmiModelDescription", &root, |xml| {
        co_simulation(xml, scene)?;
        parent(xml, "UnitDefinitions", &[], |xml| units(xml, &used))?;
        parent(xml, "TypeDefinitions", &[], |xml| types(xml, &used))?;
        parent(xml, "LogCategories", &[], log_categories)?;
        default_experiment(xml, scene)?;
        parent(xml, "ModelVariables", &[], |xml| variables(xml, registry))?;
        parent(xml, "ModelStructure", &[], |xml| structure(xml, scene, registry))
    })
}

fn co_simulation(xml: &mut Xml, scene: &Scene) -> io::Result<()> {
    let attributes: Attributes = vec![
        ("modelIdentifier", scene.name.clone()),
        ("needsExecutionTool", "false".into()),
        ("canHandleVariableCommunicationStepSize", "true".into()),
        ("canInterpolateInputs", "true".into()),
        ("maxOutputDerivativeOrder", highest_output_derivative(scene).to_string()),
        ("canBeInstantiatedOnlyOncePerProcess", "false".into()),
        ("canNotUseMemoryManagementFunctions", "true".into()),
        ("canGetAndSetFMUstate", "true".into()),
        ("canSerializeFMUstate", "true".into()),
        ("providesDirectionalDerivative", "true".into()),
    ];
    leaf(xml, "CoSimulation", &attributes)
}

/// One definition per unit; quantities of one unit may be shown in different ways.
pub(super) fn units(xml: &mut Xml, used: &BTreeSet<Quantity>) -> io::Result<()> {
    let mut written = BTreeSet::new();
    for quantity in used {
        let unit = quantity.unit();
        if !written.insert(unit) {
            continue;
        }
        parent(xml, "Unit", &[("name", unit.into())], |xml| {
            leaf(xml, "BaseUnit", &base_unit(*quantity))?;
            let same_unit = used.iter().filter(|other| other.unit() == unit);
            same_unit
                .filter_map(|other| other.display_unit())
                .try_for_each(|display| leaf(xml, "DisplayUnit", &display_unit(display)))
        })?;
    }
    Ok(())
}

fn base_unit(quantity: Quantity) -> Attributes {
    let exponents = ["kg", "m", "s", "K"].into_iter().zip(quantity.base_exponents());
    let angle = ("rad", i32::from(quantity == Quantity::Angle));
    let all = exponents.chain([angle]).filter(|(_, e)| *e != 0);
    all.map(|(name, e)| (name, e.to_string())).collect()
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

fn types(xml: &mut Xml, used: &BTreeSet<Quantity>) -> io::Result<()> {
    for quantity in used {
        let mut real: Attributes =
            vec![("quantity", quantity.type_name().into()), ("unit", quantity.unit().into())];
        if let Some(display) = quantity.display_unit() {
            real.push(("displayUnit", display.name.into()));
        }
        real.push(("nominal", number(quantity.nominal())));
        let name = [("name", quantity.type_name().into())];
        parent(xml, "SimpleType", &name, |xml| leaf(xml, "Real", &real))?;
    }
    Ok(())
}

pub(super) fn log_categories(xml: &mut Xml) -> io::Result<()> {
    Category::ALL.into_iter().try_for_each(|category| {
        let attributes: Attributes =
            vec![("name", category.name().into()), ("description", category.description().into())];
        leaf(xml, "Category", &attributes)
    })
}

pub(super) fn default_experiment(xml: &mut Xml, scene: &Scene) -> io::Result<()> {
    let attributes: Attributes = vec![
        ("startTime", "0.0".into()),
        ("stopTime", number(scene.stop_time)),
        ("stepSize", number(scene.step)),
    ];
    leaf(xml, "DefaultExperiment", &attributes)
}

fn variables(xml: &mut Xml, registry: &Registry) -> io::Result<()> {
    for (reference, variable) in registry.variables.iter().enumerate() {
        let (variability, initial) = match variable.causality() {
            Causality::Parameter if variable.is_tunable => ("tunable", Some("exact")),
            Causality::Parameter => ("fixed", Some("exact")),
            Causality::Input => (variability(variable.quantity), None),
            Causality::Output => ("continuous", Some("calculated")),
        };
        let mut attributes: Attributes = vec![
            ("name", variable.name.clone()),
            ("valueReference", reference.to_string()),
            ("description", variable.description.clone()),
            ("causality", causality(variable.causality()).into()),
            ("variability", variability.into()),
        ];
        attributes.extend(initial.map(|initial| ("initial", initial.to_owned())));
        parent(xml, "ScalarVariable", &attributes, |xml| typed(xml, variable))?;
    }
    Ok(())
}

/// How an input may change: counts in steps alone.
pub(super) fn variability(quantity: Option<Quantity>) -> &'static str {
    if quantity == Some(Quantity::Count) { "discrete" } else { "continuous" }
}

/// The element that tells type, bounds and start value.
fn typed(xml: &mut Xml, variable: &Variable) -> io::Result<()> {
    let declared = variable.quantity.map(|q| ("declaredType", q.type_name().to_owned()));
    let bound =
        |name, value: Option<f64>, write: fn(f64) -> String| value.map(|v| (name, write(v)));
    let bounds = |write| [bound("min", variable.min(), write), bound("max", variable.max(), write)];
    let start = |text: String| Some(("start", text));
    let (element, attributes) = match &variable.start {
        None => ("Real", [&[declared][..], &bounds(number)].concat()),
        Some(Value::Real(value)) => {
            ("Real", [&[declared][..], &bounds(number), &[start(number(*value))]].concat())
        }
        Some(Value::Integer(value)) => {
            ("Integer", [&bounds(whole_number)[..], &[start(value.to_string())]].concat())
        }
        Some(Value::Text(value)) => ("String", vec![start(value.clone())]),
    };
    let attributes: Attributes = attributes.into_iter().flatten().collect();
    leaf(xml, element, &attributes)
}

/// More entries than these are not written for the outputs that share one list of dependencies:
/// XML holds a list for every output, and tools take a second or more to read ten megabytes.
const MOST_DEPENDENCIES: usize = 100_000;

/// Outputs with the inputs that they follow at once. A list that is left out means all inputs, so it
/// stands for that list, and for those that would take too much room. Kinds that are left out are all
/// `dependent`. At initialisation an output may follow all parameters and inputs. Directional
/// derivatives serve all of these.
fn structure(xml: &mut Xml, scene: &Scene, registry: &Registry) -> io::Result<()> {
    let dependencies = registry.all_dependencies(scene);
    let inputs = registry.of_causality(Causality::Input).count();
    let mut sharing: HashMap<*const usize, usize> = HashMap::new();
    for (_, list) in &dependencies {
        *sharing.entry(list.as_ptr()).or_default() += list.len();
    }
    parent(xml, "Outputs", &[], |xml| {
        dependencies.iter().try_for_each(|(reference, list)| {
            let mut attributes: Attributes = vec![("index", index(*reference))];
            let is_all = !list.is_empty() && list.len() == inputs;
            if !is_all && sharing[&list.as_ptr()] <= MOST_DEPENDENCIES {
                let indices: Vec<String> = list.iter().map(|input| index(*input)).collect();
                attributes.push(("dependencies", indices.join(" ")));
            }
            leaf(xml, "Unknown", &attributes)
        })
    })?;
    parent(xml, "InitialUnknowns", &[], |xml| {
        let mut outputs = registry.of_causality(Causality::Output);
        outputs.try_for_each(|output| leaf(xml, "Unknown", &[("index", index(output))]))
    })
}

/// The XML counts variables from one.
fn index(reference: usize) -> String {
    (reference + 1).to_string()
}

pub(super) fn number(value: f64) -> String {
    format!("{value:?}")
}

pub(super) fn whole_number(value: f64) -> String {
    format!("{value:.0}")
}

pub(super) fn leaf(
    xml: &mut Xml,
    name: &str,
    attributes: &[(&'static str, String)],
) -> io::Result<()> {
    let pairs = attributes.iter().map(|(key, value)| (*key, value.as_str()));
    xml.create_element(name).with_attributes(pairs).write_empty().map(drop)
}

pub(super) fn parent(
    xml: &mut Xml,
    name: &str,
    attributes: &[(&'static str, String)],
    content: impl FnOnce(&mut Xml) -> io::Result<()>,
) -> io::Result<()> {
    let pairs = attributes.iter().map(|(key, value)| (*key, value.as_str()));
    xml.create_element(name).with_attributes(pairs).write_inner_content(content).map(drop)
}
