//! modelDescription.xml of a scene's unit for FMI 3.0, section 2.4 of the standard.

use std::collections::BTreeSet;
use std::io;

use crate::fmi::description::{
    self, Attributes, Description, Xml, kind, kind_of, leaf, number, parent, type_attributes,
    whole_number,
};
use crate::fmi::unit::highest_output_derivative;
use crate::scene::Scene;
use crate::variables::{
    ArrayRegistry, ArrayVariable, Causality, Content, Quantity, Registry, Value, Variable,
};

/// Returns the modelDescription.xml of a checked scene; `scene_text` is the scene text stored in the unit. The
/// instantiation token is the GUID of the same unit under FMI 2.0.
pub fn model_description(scene: &Scene, scene_text: &str) -> String {
    let registry = &Registry::of(scene);
    let unit = Arrays { scene, registry, arrays: ArrayRegistry::of(scene) };
    description::model_description(&unit, scene, registry, scene_text)
}

/// A unit whose variables are arrays where possible.
struct Arrays<'a> {
    scene: &'a Scene,
    registry: &'a Registry,
    arrays: ArrayRegistry,
}

impl Description for Arrays<'_> {
    const VERSION: &'static str = "3.0";
    const GUID: &'static str = "instantiationToken";
    const MORE: &'static [(&'static str, &'static str)] = &[];

    fn quantities(&self) -> BTreeSet<Quantity> {
        let variables = self.arrays.variables.iter();
        variables.filter_map(|variable| variable.quantity(self.registry)).collect()
    }

    fn co_simulation(&self) -> Attributes {
        let reports_progress = self.scene.reports_progress().to_string();
        // Modal heat advances by any step at once, with constant inputs.
        let has_long_steps = self.scene.has_particles();
        let has_events = self.scene.has_events();
        vec![
            ("modelIdentifier", self.scene.name.clone()),
            ("needsExecutionTool", "false".into()),
            ("canBeInstantiatedOnlyOncePerProcess", "false".into()),
            ("canGetAndSetFMUState", "true".into()),
            ("canSerializeFMUState", "true".into()),
            ("providesDirectionalDerivatives", "true".into()),
            ("providesAdjointDerivatives", "true".into()),
            ("providesPerElementDependencies", "true".into()),
            ("canHandleVariableCommunicationStepSize", "true".into()),
            ("maxOutputDerivativeOrder", highest_output_derivative(self.scene).to_string()),
            ("providesIntermediateUpdate", reports_progress.clone()),
            ("mightReturnEarlyFromDoStep", (has_long_steps || has_events).to_string()),
            ("canReturnEarlyAfterIntermediateUpdate", reports_progress),
            ("hasEventMode", has_events.to_string()),
        ]
    }

    fn type_definition(&self, xml: &mut Xml, quantity: Quantity) -> io::Result<()> {
        let name = [("name", quantity.type_name().to_owned())];
        leaf(xml, "Float64Type", &[&name[..], &type_attributes(quantity)].concat())
    }

    fn variables(&self, xml: &mut Xml) -> io::Result<()> {
        self.arrays.variables.iter().enumerate().try_for_each(|(reference, variable)| {
            let mut attributes: Attributes = vec![
                ("name", variable.name.clone()),
                ("valueReference", reference.to_string()),
                ("description", variable.description.clone()),
            ];
            attributes.extend(self.kind(variable));
            if let Some(quantity) = variable.quantity(self.registry) {
                attributes.push(("declaredType", quantity.type_name().into()));
            }
            let (element, details) = match (&variable.content, self.elements(variable)) {
                (Content::Constants(_, values), _) => ("Float64", vec![("start", list(values))]),
                (_, []) => ("Float64", Vec::new()),
                (_, elements) => typed(elements),
            };
            if element == "String" {
                return parent(xml, element, &attributes, |xml| leaf(xml, "Start", &details));
            }
            attributes.extend(details);
            if variable.dimensions.is_empty() {
                return leaf(xml, element, &attributes);
            }
            parent(xml, element, &attributes, |xml| {
                let mut counts = variable.dimensions.iter();
                counts.try_for_each(|n| leaf(xml, "Dimension", &[("start", n.to_string())]))
            })
        })
    }

    /// Lists outputs with the inputs that they follow without delay. At initialisation an output may follow all
    /// parameters and inputs, which an omitted list means.
    fn structure(&self, xml: &mut Xml) -> io::Result<()> {
        let is_output = |v: &ArrayVariable| v.causality(self.registry) == Some(Causality::Output);
        let mut outputs = self.arrays.variables.iter().enumerate().filter(|(_, v)| is_output(v));
        let dependencies = self.arrays.all_dependencies(self.scene, self.registry);
        dependencies.iter().try_for_each(|(reference, inputs)| {
            let inputs: Vec<String> = inputs.iter().map(usize::to_string).collect();
            let attributes: Attributes = vec![
                ("valueReference", reference.to_string()),
                ("dependencies", inputs.join(" ")),
                ("dependenciesKind", vec!["dependent"; inputs.len()].join(" ")),
            ];
            leaf(xml, "Output", &attributes)
        })?;
        outputs.try_for_each(|(reference, _)| {
            leaf(xml, "InitialUnknown", &[("valueReference", reference.to_string())])
        })
    }
}

impl Arrays<'_> {
    /// Causality, variability and the way of initialisation of a variable.
    fn kind(&self, variable: &ArrayVariable) -> Attributes {
        let first = self.elements(variable).first();
        match variable.causality(self.registry) {
            Some(causality) => {
                let is_tunable = first.is_some_and(|element| element.is_tunable);
                kind(causality, is_tunable, first.and_then(|element| element.quantity))
            }
            None if variable.content == Content::Time => kind_of("independent", "continuous", None),
            None => kind_of("local", "constant", Some("exact")),
        }
    }

    fn elements(&self, variable: &ArrayVariable) -> &[Variable] {
        variable.elements(self.registry)
    }
}

/// Element and attributes for type, bounds and start values; all elements have the same bounds.
fn typed(elements: &[Variable]) -> (&'static str, Attributes) {
    let variable = &elements[0];
    let start = &variable.start;
    if let Some(Value::Text(text)) = start {
        return ("String", vec![("value", text.clone())]);
    }
    let (element, write): (_, fn(f64) -> String) = match start {
        Some(Value::Integer(_)) => ("Int32", whole_number),
        _ => ("Float64", number),
    };
    let mut attributes = Attributes::new();
    attributes.extend(variable.min().map(|bound| ("min", write(bound))));
    attributes.extend(variable.max().map(|bound| ("max", write(bound))));
    let starts: Vec<String> = elements.iter().filter_map(start_value).collect();
    if !starts.is_empty() {
        attributes.push(("start", starts.join(" ")));
    }
    (element, attributes)
}

fn start_value(variable: &Variable) -> Option<String> {
    match variable.start.as_ref()? {
        Value::Real(value) => Some(number(*value)),
        Value::Integer(value) => Some(value.to_string()),
        Value::Text(text) => Some(text.clone()),
    }
}

fn list(values: &[f64]) -> String {
    values.iter().map(|value| number(*value)).collect::<Vec<_>>().join(" ")
}
