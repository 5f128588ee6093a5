//! The unit that is driven: its variables, what it offers, where its resources lie.

use std::ffi::CString;

use impinge::fmi::guid;
use impinge::fmi::two::xml::model_description;
use impinge::scene;
use impinge::variables::{Causality, Registry, Value, Variable};

use crate::master::{Arguments, Folder};

const SCENE: &str = include_str!("scene.toml");

/// The types of FMI.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Kind {
    Real,
    Integer,
    Boolean,
    String,
}

pub struct World {
    pub variables: Vec<Variable>,
    /// What the capability flags of the XML declare.
    pub offers: Offers,
    folder: Folder,
    guid: CString,
}

pub struct Offers {
    pub states: bool,
    pub bytes: bool,
    pub directional: bool,
    pub input_derivatives: bool,
    pub output_derivatives: bool,
}

impl World {
    pub fn new() -> Self {
        let scene = scene::parse(SCENE, "scene.toml").unwrap();
        let registry = Registry::of(&scene);
        let guid = CString::new(guid::guid(SCENE, &registry)).unwrap();
        let xml = model_description(&scene, SCENE);
        let is_true = |flag: &str| xml.contains(&format!(" {flag}=\"true\""));
        let has_order = xml.contains(" maxOutputDerivativeOrder=\"");
        let offers = Offers {
            states: is_true("canGetAndSetFMUstate"),
            bytes: is_true("canSerializeFMUstate"),
            directional: is_true("providesDirectionalDerivative"),
            input_derivatives: is_true("canInterpolateInputs"),
            output_derivatives: has_order && !xml.contains(" maxOutputDerivativeOrder=\"0\""),
        };
        let folder = Folder::with_scene("fuzz", SCENE);
        Self { variables: registry.variables, offers, folder, guid }
    }

    /// Good arguments of fmi2Instantiate.
    pub fn arguments(&self) -> Arguments {
        Arguments { guid: Some(self.guid.clone()), ..Arguments::good(&self.folder) }
    }

    pub fn variable(&self, reference: u32) -> Option<&Variable> {
        self.variables.get(reference as usize)
    }

    pub fn kind(&self, reference: u32) -> Option<Kind> {
        self.variable(reference).map(kind_of)
    }

    pub fn references(&self, kind: Kind) -> Vec<u32> {
        let all = 0..self.variables.len() as u32;
        all.filter(|&reference| self.kind(reference) == Some(kind)).collect()
    }

    pub fn reals_of(&self, wanted: impl Fn(Causality) -> bool) -> Vec<u32> {
        let is_wanted = |r: &u32| self.variable(*r).is_some_and(|v| wanted(v.causality()));
        self.references(Kind::Real).into_iter().filter(is_wanted).collect()
    }

    /// Values under which every model can be built and every step be done.
    pub fn plain_values(&self, reference: u32) -> (f64, f64) {
        let Some(variable) = self.variable(reference) else { return (0.0, 0.0) };
        let (low, high) = match variable.start {
            Some(Value::Integer(_)) => (0.0, 3.0),
            Some(Value::Real(start)) if start != 0.0 => (0.5 * start, 1.5 * start),
            _ if variable.name.ends_with(".x") || variable.name.ends_with(".y") => (-2e-5, 2e-5),
            _ => (-1e6, 1e6),
        };
        let low = variable.min().map_or(low, |min| low.max(min));
        (low, variable.max().map_or(high, |max| high.min(max)))
    }
}

fn kind_of(variable: &Variable) -> Kind {
    match (variable.quantity, &variable.start) {
        (Some(_), _) => Kind::Real,
        (None, Some(Value::Text(_))) => Kind::String,
        (None, _) => Kind::Integer,
    }
}
