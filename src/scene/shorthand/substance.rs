//! Substances of the library in place of a material's or a fluid's table.

use std::borrow::Cow;
use std::collections::BTreeMap;
use std::ops::Range;

use toml::Spanned;
use toml::de::{DeTable, DeValue};

use super::quantity::{self, Wanted};
use crate::laws::{Property, Table};
use crate::scene::error::Problem;
use crate::scene::locate::{Path, Source};
use crate::scene::spelling::hint;
use crate::substances::{Kind, Substance};

/// Key of a table that names a substance; its other keys replace or extend the substance's constants.
const KEY: &str = "substance";
/// Key of the temperature at which constants are taken [K]; without it, those of solids depend on the temperature.
const AT: &str = "at";

/// A substance that a scene names.
#[derive(Debug, Clone, PartialEq)]
pub struct NamedSubstance {
    /// Place of the table that has the substance's constants.
    pub table: Path,
    pub kind: Kind,
    pub substance: Substance,
    /// Temperatures between which the constants hold [K].
    pub valid: [f64; 2],
    /// Temperature at which a solid begins to melt or a fluid to freeze [K].
    pub melts: Option<f64>,
    /// Temperature at which the scene takes the constants [K].
    pub at: Option<f64>,
    /// Temperature at which constants of a fluid are taken [K]: the given one, or that of the drop.
    pub taken: Option<f64>,
    /// True if the coefficient of expansion is that of the library.
    pub expands: bool,
    /// Temperatures without stress of the bodies that have its mean coefficient from there to `at` [K].
    pub stress_free: BTreeMap<String, f64>,
}

impl NamedSubstance {
    /// Distance from the range up to which constants hold, as its ends are rounded [K].
    pub const ROUNDED: f64 = 1.0;

    fn new(table: Path, kind: Kind, substance: Substance) -> Self {
        let sheet = substance.sheet();
        let end = if kind == Kind::Solid { "solidus" } else { "liquidus" };
        let melting = sheet.constants.get("melting").and_then(|melting| melting.get(end));
        let melts = melting.and_then(toml::Value::as_float);
        Self {
            table,
            kind,
            substance,
            valid: sheet.valid,
            melts,
            at: None,
            taken: None,
            expands: true,
            stress_free: BTreeMap::new(),
        }
    }

    /// Constants at a temperature [K], of those that depend on it.
    pub fn constants_at(&self, temperature: f64) -> Vec<(&'static str, f64)> {
        take_at(&mut constants(self.substance, &(0..0)), temperature, None)
    }

    /// Mean coefficient of expansion between a temperature without stress [K] and the one at which constants are taken
    /// [1/K]; `None` unless the substance has one that counts from a reference.
    pub fn mean_expansion_from(&self, free: f64) -> Option<f64> {
        let at = self.at.filter(|_| self.expands)?;
        let mut table = constants(self.substance, &(0..0));
        table.get("expansion_reference")?;
        let taken = take_at(&mut table, at, Some(free));
        taken.into_iter().find(|(key, _)| *key == "expansion").map(|(_, mean)| mean)
    }
}

/// Puts constants in the place of names; returns what is wrong with them.
pub fn expand(source: &mut Source) -> Vec<(Path, Problem)> {
    let mut problems = Vec::new();
    let materials = Path::default().key("material");
    for name in keys(source, &materials) {
        let free = user_of(source, &name).and_then(|body| without_stress(source, &body));
        expand_table(source, &materials.key(&name), Kind::Solid, [None, free], &mut problems);
    }
    let bodies = Path::default().key("body");
    for name in keys(source, &bodies) {
        let body = bodies.key(&name);
        let free = without_stress(source, &body);
        for place in materials_of(source, &body) {
            name_material(source, &place);
            match text(source, &body.key("kind")).as_deref() {
                Some("lattice") => expand_links(source, &body, &mut problems),
                _ => expand_table(source, &place, Kind::Solid, [None, free], &mut problems),
            }
        }
        let start = number(source, &body.key("initial_temperature"))
            .or_else(|| number(source, &body.key("nozzle").key("temperature")));
        let fluid = body.key("fluid");
        let own = source.value(&fluid.key("melting")).is_some();
        expand_table(source, &fluid, Kind::Fluid, [start, None], &mut problems);
        let is_repeated = text(source, &body.key("method"))
            .is_some_and(|method| !["sph", "line", "particles"].contains(&method.as_str()));
        let insulates = number(source, &fluid.key("conductivity")) == Some(0.0);
        // A strand comes molten; one that does not is refused.
        let is_laid = source.value(&body.key("nozzle")).is_some();
        if !own {
            let start = start.filter(|_| !is_laid);
            stay_liquid(source, &fluid, (start, is_repeated || insulates));
        }
    }
    problems
}

/// Leaves out the freezing of a substance that never freezes, as its drops are repeated or conduct no heat, or that is
/// liquid below its melting point: these are warned of.
fn stay_liquid(source: &mut Source, fluid: &Path, (start, is_never_frozen): (Option<f64>, bool)) {
    let Some(named) = source.substances().iter().find(|named| named.table == *fluid) else {
        return;
    };
    let is_undercooled = start.zip(named.melts).is_some_and(|(start, melts)| start <= melts);
    if !is_never_frozen && !is_undercooled {
        return;
    }
    if let Some(DeValue::Table(mut table)) = source.value(fluid).cloned() {
        table.remove("melting");
        table.remove("frozen");
        source.replace(fluid, DeValue::Table(table));
    }
}

/// Places of the materials of a body and of its layers.
fn materials_of(source: &Source, body: &Path) -> Vec<Path> {
    let layers = body.key("layers");
    let count = match source.value(&layers) {
        Some(DeValue::Array(list)) => list.len(),
        _ => 0,
    };
    let of_layers = (0..count).map(|i| layers.index(i).key("material"));
    of_layers.chain([body.key("material")]).collect()
}

/// The first body of a material.
fn user_of(source: &Source, material: &str) -> Option<Path> {
    let bodies = Path::default().key("body");
    let uses = |body: &Path| {
        let places = materials_of(source, body);
        places.iter().any(|place| text(source, place).is_some_and(|name| name == material))
    };
    keys(source, &bodies).iter().map(|name| bodies.key(name)).find(uses)
}

/// Temperature of a body without stress [K].
fn without_stress(source: &Source, body: &Path) -> Option<f64> {
    let own = number(source, &body.key("stress_free_temperature"));
    own.or_else(|| number(source, &body.key("initial_temperature")))
}

fn keys(source: &Source, path: &Path) -> Vec<String> {
    let Some(DeValue::Table(table)) = source.value(path) else { return Vec::new() };
    table.keys().map(|key| key.get_ref().clone().into_owned()).collect()
}

/// Adds the substance that a body or layer names to the scene's materials, unless one of them has that name.
fn name_material(source: &mut Source, place: &Path) {
    let Some(name) = text(source, place) else { return };
    let materials = Path::default().key("material");
    if source.value(&materials.key(&name)).is_some() {
        return;
    }
    let (Some(substance), Some(span)) = (Kind::Solid.find(&name), source.span(place)) else {
        return;
    };
    let name = identifier(&name);
    let path = materials.key(&name);
    source.replace(place, DeValue::String(Cow::Owned(name.clone())));
    if source.value(&path).is_some() {
        return;
    }
    let mut table = constants(substance, &span);
    table.insert(spanned("model", &span), Spanned::new(span.clone(), string("thermoelastic")));
    source.insert(["material", &name], &span, DeValue::Table(table));
    source.add_substance(NamedSubstance::new(path, Kind::Solid, substance));
}

/// The name of a substance as one of a material, which is part of the names of parameters: `steel-304` is `steel_304`.
fn identifier(name: &str) -> String {
    let name = name.replace(|c: char| !c.is_ascii_alphanumeric(), "_");
    if name.starts_with(|c: char| c.is_ascii_digit()) { format!("_{name}") } else { name }
}

/// Leaves a lattice those constants of a substance that links have, at its own temperature.
fn expand_links(source: &mut Source, body: &Path, problems: &mut Vec<(Path, Problem)>) {
    const OF_LINKS: [&str; 3] = ["density", "young", "poisson"];
    const ROOM: f64 = 293.15;
    let place = body.key("material");
    let own = keys(source, &place);
    let at = number(source, &body.key("initial_temperature")).unwrap_or(ROOM);
    expand_table(source, &place, Kind::Solid, [Some(at), None], problems);
    if let Some(DeValue::Table(mut table)) = source.value(&place).cloned() {
        for key in keys(source, &place) {
            if !OF_LINKS.contains(&key.as_str()) && !own.contains(&key) {
                table.remove(key.as_str());
            }
        }
        source.replace(&place, DeValue::Table(table));
    }
}

/// Replaces a fluid's name, or a table with the key `substance`, by all constants. `start` is the temperature at which
/// they are taken where the table has none, and `free` that of a solid without stress [K].
fn expand_table(
    source: &mut Source,
    place: &Path,
    kind: Kind,
    [start, free]: [Option<f64>; 2],
    problems: &mut Vec<(Path, Problem)>,
) {
    let (named, own) = match source.value(place) {
        Some(DeValue::String(_)) if kind == Kind::Fluid => (place.clone(), DeTable::new()),
        Some(DeValue::Table(table)) if table.contains_key(KEY) => (place.key(KEY), table.clone()),
        _ => return,
    };
    let Some(name) = text(source, &named) else {
        let message = "this is not the name of a substance".to_owned();
        let allowed = "a text such as \"copper\" (`impinge substances`)".to_owned();
        problems.push((place.clone(), source.problem(&named, message, allowed)));
        return;
    };
    let Some(substance) = kind.find(&name) else {
        problems.push((place.clone(), unknown(source, &named, &name, kind)));
        return;
    };
    let Some(span) = source.span(place) else { return };
    let given = if own.contains_key(AT) {
        match number(source, &place.key(AT)).filter(|at| *at > 0.0 && at.is_finite()) {
            Some(at) => Some(at),
            None => {
                let message = "this is not a temperature".to_owned();
                let allowed = "a number in K, or a text such as \"90 °C\"".to_owned();
                let problem = source.problem(&place.key(AT), message, allowed);
                problems.push((place.clone(), problem));
                return;
            }
        }
    } else {
        None
    };
    let at = given.or(start);
    let mut known: DeTable<'static> = constants(substance, &span);
    if kind == Kind::Solid {
        known.insert(spanned("model", &span), Spanned::new(span.clone(), string("thermoelastic")));
    }
    if kind == Kind::Solid && at.is_some() {
        known.remove("melting");
    }
    let expands = !own.contains_key("expansion");
    if !expands {
        // It is that of the substance's coefficient.
        known.remove("expansion_reference");
    }
    let mut taken = at.map(|at| take_at(&mut known, at, free)).unwrap_or_default();
    taken.retain(|(key, _)| !own.contains_key(*key));
    let mut table: DeTable = known;
    for (key, value) in
        own.into_iter().filter(|(key, _)| !matches!(key.get_ref().as_ref(), KEY | AT))
    {
        replace(&mut table, key, value);
    }
    source.replace(place, DeValue::Table(table));
    for (key, value) in taken {
        source.set_number(place.key(key), value);
    }
    let named = NamedSubstance::new(place.clone(), kind, substance);
    source.add_substance(NamedSubstance { at: given, taken: at, expands, ..named });
}

/// Replaces a constant; of tables within the substance's, such as `frozen`, single keys.
fn replace<'a>(table: &mut DeTable<'a>, key: Spanned<Cow<'a, str>>, value: Spanned<DeValue<'a>>) {
    let is_of_phases = matches!(key.get_ref().as_ref(), "melting" | "frozen");
    let known = if is_of_phases { table.get_mut(key.get_ref().as_ref()) } else { None };
    match (known.map(Spanned::get_mut), value.get_ref()) {
        (Some(DeValue::Table(known)), DeValue::Table(own)) => known.extend(own.clone()),
        _ => {
            table.insert(key, value);
        }
    }
}

fn unknown(source: &Source, place: &Path, name: &str, kind: Kind) -> Problem {
    let names = || kind.all().iter().map(|one| one.name);
    let word = kind.word();
    let message = format!("the library has no {word} `{name}`{}", hint(name, names()));
    let allowed =
        format!("a table of constants, or one of {}", names().collect::<Vec<_>>().join(", "));
    source.problem(place, message, allowed)
}

/// A substance's constants, all at one place of the scene's text.
fn constants(substance: Substance, span: &Range<usize>) -> DeTable<'static> {
    let sheet = DeTable::parse(substance.text).expect("a substance's file is TOML").into_inner();
    match sheet.get("constants").map(|value| moved(value.get_ref(), span)) {
        Some(DeValue::Table(table)) => table,
        _ => DeTable::new(),
    }
}

fn moved(value: &DeValue<'static>, span: &Range<usize>) -> DeValue<'static> {
    let element = |value: &Spanned<DeValue<'static>>| {
        Spanned::new(span.clone(), moved(value.get_ref(), span))
    };
    match value {
        DeValue::Array(list) => DeValue::Array(list.iter().map(element).collect()),
        DeValue::Table(table) => {
            let entries = table.iter();
            let entries = entries.map(|(key, value)| {
                (Spanned::new(span.clone(), key.get_ref().clone()), element(value))
            });
            DeValue::Table(entries.collect())
        }
        other => other.clone(),
    }
}

/// Takes tables over the temperature at one temperature; returns the constants.
fn take_at(table: &mut DeTable<'static>, at: f64, free: Option<f64>) -> Vec<(&'static str, f64)> {
    const KEYS: [&str; 7] = [
        "density",
        "viscosity",
        "specific_heat",
        "conductivity",
        "surface_tension",
        "young",
        "expansion",
    ];
    let reference = table.remove("expansion_reference").and_then(|value| float(value.get_ref()));
    let mut taken = Vec::new();
    for key in KEYS {
        let Some(value) = table.get_mut(key) else { continue };
        let Some(property) = over_temperature(value.get_ref()) else { continue };
        *value.get_mut() = string(key);
        let found = match (key, reference, free) {
            ("expansion", Some(reference), Some(free)) => {
                mean_expansion(&property, reference, [free, at])
            }
            _ => property.value(at),
        };
        taken.push((key, found));
    }
    taken
}

/// Mean coefficient of expansion between two temperatures, of one that is measured from a third [1/K].
fn mean_expansion(property: &Property, reference: f64, [from, to]: [f64; 2]) -> f64 {
    /// Between temperatures that are closer the mean is the slope in their middle [K].
    const CLOSEST: f64 = 1.0;
    let (middle, half) = (0.5 * (from + to), 0.5 * (to - from).abs().max(CLOSEST));
    let strain = |temperature: f64| property.value(temperature) * (temperature - reference);
    (strain(middle + half) - strain(middle - half)) / (2.0 * half)
}

/// A table over the temperature: linear between its knots, held outside.
fn over_temperature(table: &DeValue) -> Option<Property> {
    let list = |key: &str| -> Option<Vec<f64>> {
        let DeValue::Array(list) = table.get(key)?.get_ref() else { return None };
        list.iter().map(|value| float(value.get_ref())).collect()
    };
    let property =
        Property::Table(Table { temperature: list("temperature")?, value: list("value")? });
    property.check().ok().map(|()| property)
}

fn float(value: &DeValue) -> Option<f64> {
    value.as_float()?.as_str().parse().ok()
}

fn number(source: &Source, path: &Path) -> Option<f64> {
    match source.value(path)? {
        DeValue::Float(float) => float.as_str().parse().ok(),
        DeValue::Integer(integer) => integer.as_str().parse().ok(),
        DeValue::String(text) => {
            quantity::read(text, Wanted { unit: "K", is_temperature: true }).ok()
        }
        _ => None,
    }
}

fn text(source: &Source, path: &Path) -> Option<String> {
    source.value(path).and_then(DeValue::as_str).map(str::to_owned)
}

fn string(text: &'static str) -> DeValue<'static> {
    DeValue::String(Cow::Borrowed(text))
}

fn spanned(key: &'static str, span: &Range<usize>) -> Spanned<Cow<'static, str>> {
    Spanned::new(span.clone(), Cow::Borrowed(key))
}
