//! modelDescription.xml of a scene's unit for FMI 3.0, section 2.4 of the standard.

use std::collections::BTreeSet;
use std::io;

use quick_xml::Writer;
use quick_xml::events::{BytesDecl, Event};

use crate::fmi::guid::guid;
use crate::fmi::rates::highest_output_derivative;
use crate::fmi::xml::{
    Attributes, Xml, causality, default_experiment, leaf, log_categories, number, parent, units,
    variability as variability_of, whole_number,
};
use crate::scene::Scene;
use crate::variables::{
    ArrayRegistry, ArrayVariable, Causality, Content, Quantity, Registry, Value, Variable,
};

/// The modelDescription.xml of a checked scene; `scene_text` is what the unit carries. The
/// instantiation token is the GUID of the same unit under FMI 2.0.
pub fn model_description(scene: &Scene, scene_text: &str) -> String {
    let registry = Registry::of(scene);
    let token = guid(scene_text, &registry);
    let unit = Description { scene, arrays: ArrayRegistry::of(scene), registry };
    let mut xml = Writer::new_with_indent(Vec::new(), b' ', 2);
    unit.document(&mut xml, token).expect("a vector takes whatever is written");
    let mut text = String::from_utf8(xml.into_inner()).expect("made from strings");
    text.push('\n');
    text
}

/// What is described.
struct Description<'a> {
    scene: &'a Scene,
    registry: Registry,
    arrays: ArrayRegistry,
}

impl Description<'_> {
    fn document(&self, xml: &mut Xml, token: String) -> io::Result<()> {
        xml.write_event(Event::Decl(BytesDecl::new("1.0", Some("UTF-8"), None)))?;
        let mut root: Attributes = vec![
            ("fmiVersion", "3.0".into()),
            ("modelName", self.scene.name.clone()),
            ("instantiationToken", token),
        ];
        if !self.scene.description.is_empty() {
            root.push(("description", self.scene.description.clone()));
        }
        root.extend([
            ("license", env!("CARGO_PKG_LICENSE").into()),
            ("generationTool", concat!("impinge ", env!("CARGO_PKG_VERSION")).into()),
            ("variableNamingConvention", self.scene.naming.name().into()),
        ]);
        let variables = self.arrays.variables.iter();
        let used: BTreeSet<Quantity> =
            variables.filter_map(|variable| variable.quantity(&self.registry)).collect();
        parent(xml, "fmiModelDescription", &root, |xml| {
            self.co_simulation(xml)?;
            parent(xml, "UnitDefinitions", &[], |xml| units(xml, &used))?;
            parent(xml, "TypeDefinitions", &[], |xml| types(xml, &used))?;
            parent(xml, "LogCategories", &[], log_categories)?;
            default_experiment(xml, self.scene)?;
            parent(xml, "ModelVariables", &[], |xml| self.variables(xml))?;
            parent(xml, "ModelStructure", &[], |xml| self.structure(xml))
        })
    }

    fn co_simulation(&self, xml: &mut Xml) -> io::Result<()> {
        let has_droplets = self.scene.has_drops();
        // Modes of heat take a step of any length in one, and inputs are held.
        let has_long_steps = self.scene.has_particles();
        let attributes: Attributes = vec![
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
            ("providesIntermediateUpdate", has_droplets.to_string()),
            ("mightReturnEarlyFromDoStep", has_long_steps.to_string()),
            ("canReturnEarlyAfterIntermediateUpdate", has_droplets.to_string()),
            ("hasEventMode", "false".into()),
        ];
        leaf(xml, "CoSimulation", &attributes)
    }

    fn variables(&self, xml: &mut Xml) -> io::Result<()> {
        self.arrays.variables.iter().enumerate().try_for_each(|(reference, variable)| {
            let mut attributes: Attributes = vec![
                ("name", variable.name.clone()),
                ("valueReference", reference.to_string()),
                ("description", variable.description.clone()),
            ];
            attributes.extend(self.kind(variable));
            if let Some(quantity) = variable.quantity(&self.registry) {
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

    /// Causality, variability and how the variable is initialised.
    fn kind(&self, variable: &ArrayVariable) -> Attributes {
        let (causality, variability, initial) = match variable.causality(&self.registry) {
            Some(Causality::Parameter) => {
                let is_tunable = self.elements(variable)[0].is_tunable;
                let variability = if is_tunable { "tunable" } else { "fixed" };
                (causality(Causality::Parameter), variability, Some("exact"))
            }
            Some(Causality::Input) => {
                let quantity = self.elements(variable).first().and_then(|element| element.quantity);
                (causality(Causality::Input), variability_of(quantity), None)
            }
            Some(Causality::Output) => {
                (causality(Causality::Output), "continuous", Some("calculated"))
            }
            None if variable.content == Content::Time => ("independent", "continuous", None),
            None => ("local", "constant", Some("exact")),
        };
        let mut attributes: Attributes =
            vec![("causality", causality.into()), ("variability", variability.into())];
        attributes.extend(initial.map(|initial| ("initial", initial.to_owned())));
        attributes
    }

    fn elements(&self, variable: &ArrayVariable) -> &[Variable] {
        variable.elements(&self.registry)
    }

    /// Outputs with the inputs that they follow at once. At initialisation an output may follow all
    /// parameters and inputs, which is what a list that is left out means.
    fn structure(&self, xml: &mut Xml) -> io::Result<()> {
        let is_output = |v: &ArrayVariable| v.causality(&self.registry) == Some(Causality::Output);
        let mut outputs = self.arrays.variables.iter().enumerate().filter(|(_, v)| is_output(v));
        let dependencies = self.arrays.all_dependencies(self.scene, &self.registry);
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

fn types(xml: &mut Xml, used: &BTreeSet<Quantity>) -> io::Result<()> {
    used.iter().try_for_each(|quantity| {
        let mut attributes: Attributes = vec![
            ("name", quantity.type_name().into()),
            ("quantity", quantity.type_name().into()),
            ("unit", quantity.unit().into()),
        ];
        if let Some(display) = quantity.display_unit() {
            attributes.push(("displayUnit", display.name.into()));
        }
        attributes.push(("nominal", number(quantity.nominal())));
        leaf(xml, "Float64Type", &attributes)
    })
}

/// Element and attributes that tell type, bounds and start values; all elements have the same bounds.
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
