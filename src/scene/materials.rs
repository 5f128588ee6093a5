//! Named materials, and the layers of solids.

use std::borrow::Cow;
use std::f64::consts::PI;
use std::fmt;

use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::de::value::MapAccessDeserializer;
use serde::de::{Deserialize, Deserializer, Error, MapAccess, Visitor};
use serde::{Serialize, Serializer};

use super::locate::Path;
use super::shorthand::NamedSubstance;
use super::types::{Body, Layer, Probe, Scene, Shape, Side, Solid};
use crate::laws::{Constants, Material, Thermoelastic, Weibull};

/// Tolerance, relative to a body's thickness, for points on an interface and for the sum of layers.
pub const SLACK: f64 = 1e-9;

/// Name of one of the scene's materials, or a separate material.
#[derive(Debug, Clone, PartialEq)]
pub struct MaterialChoice {
    /// The name; `None` for a separate material.
    pub name: Option<String>,
    /// A copy of the named material, or the body's own one; `None` until the name has been resolved.
    material: Option<Material>,
}

/// A substance whose constants are not known at a temperature.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BeyondSubstance {
    /// Its name in scenes.
    pub substance: &'static str,
    /// The end of the range that the temperature is beyond [K].
    pub end: f64,
    /// True if it is the lower end.
    pub is_cold: bool,
    /// Melting point below the temperature, if the model keeps the body solid [K].
    pub unmelted: Option<f64>,
}

impl Scene {
    /// The substance of a solid whose range a temperature [K] is farthest beyond.
    pub fn beyond_substance(&self, body: &str, temperature: f64) -> Option<BeyondSubstance> {
        let melts = match self.body.get(body)? {
            Body::Solid(solid) => solid.melts(),
            Body::LargeStrain(_) => false,
            _ => return None,
        };
        let below = |named: &NamedSubstance| named.valid[0] - NamedSubstance::ROUNDED - temperature;
        let beyond = |named: &NamedSubstance| below(named).max(temperature - named.valid[1]);
        let all = self.substances_of(body).filter(|named| beyond(named) > 0.0);
        let named = all.min_by(|a, b| beyond(b).total_cmp(&beyond(a)))?;
        let is_cold = below(named) > 0.0;
        Some(BeyondSubstance {
            substance: named.substance.name,
            end: named.valid[usize::from(!is_cold)],
            is_cold,
            unmelted: named.melts.filter(|&point| temperature > point && !melts),
        })
    }

    /// The substances of the library that a body consists of.
    pub fn substances_of<'s>(
        &'s self,
        body: &'s str,
    ) -> impl Iterator<Item = &'s NamedSubstance> + use<'s> {
        let choices = self.body.get(body).map_or(Vec::new(), Body::materials);
        let own = Path::default().key("body").key(body);
        let materials = Path::default().key("material");
        self.substances.iter().filter(move |named| {
            let names = choices.iter().filter_map(|choice| choice.name.as_deref());
            let mut tables = names.map(|name| materials.key(name));
            named.table.is_within(&own) || tables.any(|table| table == named.table)
        })
    }
}

impl MaterialChoice {
    /// A separate material.
    pub fn of(material: Material) -> Self {
        Self { name: None, material: Some(material) }
    }

    /// Resolves the name among the scene's materials; returns true if it is one of them.
    pub(super) fn look_up<'a>(&mut self, find: impl Fn(&str) -> Option<&'a Material>) -> bool {
        if let Some(name) = &self.name {
            self.material = find(name).cloned();
        }
        self.material.is_some()
    }

    /// The material.
    ///
    /// # Panics
    /// If the scene has not been decoded, which resolves all names.
    pub fn material(&self) -> &Material {
        self.material.as_ref().expect("a decoded scene's names of materials are looked up")
    }

    /// Mutable access to the material.
    ///
    /// # Panics
    /// If the scene has not been decoded, which resolves all names.
    pub fn material_mut(&mut self) -> &mut Material {
        self.material.as_mut().expect("a decoded scene's names of materials are looked up")
    }
}

impl<'de> Deserialize<'de> for MaterialChoice {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Reader;

        impl<'de> Visitor<'de> for Reader {
            type Value = MaterialChoice;

            fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
                f.write_str("the name of a material or a table")
            }

            fn visit_str<E: Error>(self, name: &str) -> Result<Self::Value, E> {
                Ok(MaterialChoice { name: Some(name.to_owned()), material: None })
            }

            fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<Self::Value, A::Error> {
                let material = Material::deserialize(MapAccessDeserializer::new(map))?;
                Ok(MaterialChoice { name: None, material: Some(material) })
            }
        }

        deserializer.deserialize_any(Reader)
    }
}

impl JsonSchema for MaterialChoice {
    fn schema_name() -> Cow<'static, str> {
        "MaterialChoice".into()
    }

    fn inline_schema() -> bool {
        true
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        json_schema!({ "anyOf": [{ "type": "string" }, generator.subschema_for::<Material>()] })
    }
}

impl Serialize for MaterialChoice {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match (&self.material, &self.name) {
            (Some(material), _) => material.serialize(serializer),
            (None, name) => name.serialize(serializer),
        }
    }
}

/// A layer at its position in the body; a body of one material is one layer.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stratum {
    pub constants: Constants,
    /// Its bottom and its top [m].
    pub z: [f64; 2],
    /// Thermal resistance of its contact with the layer above [m² K/W].
    pub contact_resistance: f64,
}

impl Stratum {
    pub fn thickness(&self) -> f64 {
        self.z[1] - self.z[0]
    }
}

/// Bottom and top of each layer of a body whose bottom is at a height [m].
pub(super) fn heights(layers: &[Layer], bottom: f64) -> Vec<[f64; 2]> {
    let (mut depth, mut top) = (0.0, 0.0);
    let place = |(i, layer): (usize, &Layer)| {
        depth += layer.thickness;
        // The lowest layer ends at the body's bottom to the bit.
        let low = if i + 1 == layers.len() { bottom } else { -depth };
        let z = [low, top];
        top = low;
        z
    };
    layers.iter().enumerate().map(place).collect()
}

impl Solid {
    /// The layers, from the top.
    ///
    /// Constants that depend on the temperature are those at time zero.
    pub fn strata(&self) -> Vec<Stratum> {
        let start = self.initial_temperature;
        let bottom = -self.shape.thickness();
        let Some(layers) = &self.layers else {
            let own = self.material.iter().map(|choice| choice.material().at(start));
            return own
                .map(|constants| Stratum { constants, z: [bottom, 0.0], contact_resistance: 0.0 })
                .collect();
        };
        let place = |(layer, z): (&Layer, [f64; 2])| {
            let contact_resistance = layer.contact_resistance.unwrap_or(0.0);
            Stratum { constants: layer.material.material().at(start), z, contact_resistance }
        };
        layers.iter().zip(heights(layers, bottom)).map(place).collect()
    }

    /// Area of the top [m²].
    pub fn top_area(&self) -> f64 {
        match self.shape {
            Shape::Box([x, y, _]) => x * y,
            Shape::Disc(disc) => PI * disc.radius * disc.radius,
        }
    }

    /// Heat capacity of the whole body at its initial temperature [J/K].
    pub fn heat_capacity(&self) -> f64 {
        let area = self.top_area();
        let of_layer = |layer: &Stratum| layer.constants.heat_capacity() * layer.thickness();
        area * self.strata().iter().map(of_layer).sum::<f64>()
    }

    /// Returns true if part of the body melts.
    pub fn melts(&self) -> bool {
        self.materials_of_layers().iter().any(|own| own.heat.melting.is_some())
    }

    /// Coordinates of the interfaces between layers, from the top [m].
    pub fn interfaces(&self) -> Vec<f64> {
        let strata = self.strata();
        strata.iter().take(strata.len().saturating_sub(1)).map(|layer| layer.z[0]).collect()
    }

    /// The interface at a coordinate, within rounding [m].
    pub fn interface_at(&self, z: f64) -> Option<f64> {
        let slack = SLACK * self.shape.thickness();
        self.interfaces().into_iter().find(|interface| (z - interface).abs() <= slack)
    }

    /// Moves a point on an interface to the layer of `side`: above the interface it keeps its coordinate, below it gets
    /// the next lower number.
    pub fn on_side(&self, [x, y, z]: [f64; 3], side: Side) -> [f64; 3] {
        let z = match (self.interface_at(z), side) {
            (None, _) => z,
            (Some(interface), Side::Above) => interface,
            (Some(interface), Side::Below) => interface.next_down(),
        };
        [x, y, z]
    }

    /// Materials of the body in the order of layers, with their paths in the scene, below the body's `path`. A named
    /// material has the path of its definition.
    pub(crate) fn materials(&self, path: &Path) -> Vec<(Path, &Material)> {
        let place = |own: Path, choice: &MaterialChoice| match &choice.name {
            Some(name) => Path::default().key("material").key(name),
            None => own,
        };
        let layers = self.layers.iter().flatten().enumerate();
        let own = self.material.iter().map(|choice| (path.key("material"), choice));
        let all = own
            .chain(layers.map(|(i, l)| (path.key("layers").index(i).key("material"), &l.material)));
        let mut list: Vec<(Path, &Material)> = Vec::new();
        for (own, choice) in all {
            let place = place(own, choice);
            if list.iter().all(|(known, _)| *known != place) {
                list.push((place, choice.material()));
            }
        }
        list
    }

    /// Material of each layer, from the top.
    pub fn materials_of_layers(&self) -> Vec<&Material> {
        let layers = self.layers.iter().flatten().map(|layer| &layer.material);
        self.material.iter().chain(layers).map(MaterialChoice::material).collect()
    }

    /// Returns true if heat obeys a linear equation with constant coefficients: no constant depends on the temperature,
    /// nothing melts, no face radiates, and no bath wets more and more of the body.
    pub fn conducts_linearly(&self) -> bool {
        let mut materials = self.materials_of_layers().into_iter();
        materials.all(|material| material.heat.is_linear())
            && self.faces.values().all(|face| face.radiation.is_none())
            && self.bath.is_none()
    }

    /// Returns true if stress depends linearly on deformation and temperature.
    pub fn deforms_linearly(&self) -> bool {
        let mut materials = self.materials_of_layers().into_iter();
        materials.all(|material| material.law.deformation().is_linear())
    }

    /// Returns true if part of the body yields.
    pub fn yields(&self) -> bool {
        self.materials_of_layers().into_iter().any(Material::yields)
    }

    /// Returns true if moduli of part of the body relax.
    pub fn relaxes(&self) -> bool {
        let mut materials = self.materials_of_layers().into_iter();
        materials.any(|material| material.law.deformation().relaxing().is_some())
    }

    /// Returns true if stress is linear but for the relaxation of moduli.
    pub fn only_relaxes(&self) -> bool {
        let is_linear = |material: &Material| {
            let law = material.law.deformation();
            !law.yields() && law.properties().iter().all(|(_, own)| own.is_constant())
        };
        self.relaxes() && self.materials_of_layers().into_iter().all(is_linear)
    }

    /// Returns true if part of the body has a distribution of flaws.
    pub fn has_flaws(&self) -> bool {
        self.has_flaws_of(|_| true)
    }

    /// Returns true if a material has a distribution of flaws of a kind.
    pub fn has_flaws_of(&self, kind: impl Fn(&Weibull) -> bool) -> bool {
        let mut materials = self.materials_of_layers().into_iter();
        materials.any(|own| own.fracture.weibull.as_ref().is_some_and(&kind))
    }

    /// Temperature at which the body is free of thermal stress [K].
    pub fn temperature_without_stress(&self) -> f64 {
        self.stress_free_temperature.unwrap_or(self.initial_temperature)
    }

    /// Deformation laws of all layers, from the top; `None` if one of them lacks elastic constants.
    pub fn laws(&self) -> Option<Vec<Thermoelastic>> {
        self.strata().iter().map(|layer| layer.constants.law()).collect()
    }

    /// Returns true if the materials have all constants of elasticity.
    pub fn is_elastic(&self) -> bool {
        self.laws().is_some()
    }
}

impl Scene {
    /// Paths of materials in bodies that are unmodified named ones, of which a scene's text may hold copies.
    pub(crate) fn copied_materials(&self) -> Vec<Path> {
        let is_copy = |choice: &MaterialChoice| {
            let named = choice.name.as_ref().and_then(|name| self.material.get(name));
            named.is_some_and(|named| named == choice.material())
        };
        let of_body = |(name, solid): (&str, &Solid)| {
            let path = Path::default().key("body").key(name);
            let layers = solid.layers.iter().flatten().enumerate();
            let layers = layers.map(|(i, layer)| (path.key("layers").index(i), &layer.material));
            let own = solid.material.iter().map(|choice| (path.clone(), choice));
            let copies = own.chain(layers).filter(|(_, choice)| is_copy(choice));
            copies.map(|(path, _)| path.key("material")).collect::<Vec<_>>()
        };
        self.solids().flat_map(of_body).collect()
    }

    /// Position at which a probe reads its body.
    pub fn point_of(&self, probe: &Probe) -> [f64; 3] {
        let side = probe.side.unwrap_or_default();
        self.solid(&probe.body).map_or(probe.at, |solid| solid.on_side(probe.at, side))
    }
}
