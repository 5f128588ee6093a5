//! modelDescription.xml of a scene's unit for FMI 2.0, section 2.2 and 4.3 of the standard.

use std::collections::{BTreeSet, HashMap};
use std::io;

use crate::fmi::description::{
    self, Attributes, Description, Xml, kind, leaf, number, parent, type_attributes, whole_number,
};
use crate::fmi::unit::highest_output_derivative;
use crate::scene::Scene;
use crate::variables::{Causality, Quantity, Registry, Value, Variable};

/// Returns the modelDescription.xml of a checked scene; `scene_text` is the scene text stored in the unit.
pub fn model_description(scene: &Scene, scene_text: &str) -> String {
    let registry = &Registry::of(scene);
    description::model_description(&Scalars { scene, registry }, scene, registry, scene_text)
}

/// A unit whose variables are scalars.
struct Scalars<'a> {
    scene: &'a Scene,
    registry: &'a Registry,
}

impl Description for Scalars<'_> {
    const VERSION: &'static str = "2.0";
    const GUID: &'static str = "guid";
    const MORE: &'static [(&'static str, &'static str)] = &[("numberOfEventIndicators", "0")];

    fn quantities(&self) -> BTreeSet<Quantity> {
        self.registry.variables.iter().filter_map(|variable| variable.quantity).collect()
    }

    fn co_simulation(&self) -> Attributes {
        vec![
            ("modelIdentifier", self.scene.name.clone()),
            ("needsExecutionTool", "false".into()),
            ("canHandleVariableCommunicationStepSize", "true".into()),
            ("canInterpolateInputs", "true".into()),
            ("maxOutputDerivativeOrder", highest_output_derivative(self.scene).to_string()),
            ("canBeInstantiatedOnlyOncePerProcess", "false".into()),
            ("canNotUseMemoryManagementFunctions", "true".into()),
            ("canGetAndSetFMUstate", "true".into()),
            ("canSerializeFMUstate", "true".into()),
            ("providesDirectionalDerivative", "true".into()),
        ]
    }

    fn type_definition(&self, xml: &mut Xml, quantity: Quantity) -> io::Result<()> {
        let name = [("name", quantity.type_name().into())];
        parent(xml, "SimpleType", &name, |xml| leaf(xml, "Real", &type_attributes(quantity)))
    }

    fn variables(&self, xml: &mut Xml) -> io::Result<()> {
        for (reference, variable) in self.registry.variables.iter().enumerate() {
            let mut attributes: Attributes = vec![
                ("name", variable.name.clone()),
                ("valueReference", reference.to_string()),
                ("description", variable.description.clone()),
            ];
            attributes.extend(kind(variable.causality(), variable.is_tunable, variable.quantity));
            parent(xml, "ScalarVariable", &attributes, |xml| typed(xml, variable))?;
        }
        Ok(())
    }

    /// Lists outputs with the inputs that they follow without delay. An omitted list means all inputs; it replaces a
    /// list of all inputs and lists that would be too long. Omitted kinds are all `dependent`. At initialisation an
    /// output may follow all parameters and inputs. Directional derivatives exist for all of these.
    fn structure(&self, xml: &mut Xml) -> io::Result<()> {
        let registry = self.registry;
        let dependencies = registry.all_dependencies(self.scene);
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
}

/// Element for type, bounds and start value.
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

/// Largest number of entries written for the outputs that share one list of dependencies. XML repeats the list for
/// every output, and tools take a second or more to read ten megabytes.
const MOST_DEPENDENCIES: usize = 100_000;

/// The XML numbers variables from one.
fn index(reference: usize) -> String {
    (reference + 1).to_string()
}
