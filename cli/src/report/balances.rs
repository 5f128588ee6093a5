//! Balances of heat, mass, momentum and energy, from the variables of a run.

use impinge::scene::{Droplet, Scene};

use super::document::{Balance, Term};
use super::names::name;
use super::outputs::Outputs;
use crate::summary::expected_residual;

/// Balances of all bodies.
pub fn balances(scene: &Scene, outputs: &Outputs) -> Vec<Balance> {
    let solids = scene.solids().filter_map(|(name, _)| heat(scene, name, outputs));
    let droplets = scene.droplets().flat_map(|(body, droplet)| {
        let of = Of { scene, body, droplet, outputs };
        [of.heat(), of.mass(), of.momentum(), of.energy()]
    });
    let filaments = scene.filaments().filter_map(|(name, _)| of_filament(scene, name, outputs));
    let lattices = scene.lattices().filter_map(|(name, _)| of_lattice(scene, name, outputs));
    solids.chain(droplets.flatten()).chain(filaments).chain(lattices).collect()
}

fn term(label: &str, value: f64) -> Term {
    Term { label: label.to_owned(), value }
}

/// A balance of amounts whose `missing` part should be zero; `largest` is what it is compared with.
fn balance(title: String, unit: &str, terms: Vec<Term>, [missing, largest]: [f64; 2]) -> Balance {
    let residual = Some(if largest == 0.0 { 0.0 } else { missing.abs() / largest });
    Balance { title, unit: unit.to_owned(), terms, residual, expected: None, about: String::new() }
}

/// Heat of a solid: supplied, stored, lost.
fn heat(scene: &Scene, body: &str, outputs: &Outputs) -> Option<Balance> {
    let column = |key: &str| outputs.values(&name(scene, body, key));
    let [supplied, stored, lost] =
        [column("heat_in")?, column("heat_stored")?, column("heat_lost")?];
    let last = |values: &[f64]| values.last().copied().unwrap_or(0.0);
    let largest =
        [supplied, stored, lost].into_iter().flatten().fold(0.0, |most, v| v.abs().max(most));
    let missing = last(supplied) - last(stored) - last(lost);
    let terms = vec![
        term("supplied", last(supplied)),
        term("stored", last(stored)),
        term("lost", last(lost)),
    ];
    let expected = Some(expected_residual(scene, body));
    Some(Balance { expected, ..balance(format!("Heat of {body}"), "J", terms, [missing, largest]) })
}

/// Heat of a filament: stored since its fluid came, given to what lies below and lost to the air.
fn of_filament(scene: &Scene, body: &str, outputs: &Outputs) -> Option<Balance> {
    let last = |key: &str| outputs.last(&name(scene, body, key));
    let stored = last("heat_stored")?;
    let [given, lost] = ["heat", "heat_lost"].map(|key| last(key).unwrap_or(0.0));
    let largest = [stored, given, lost].into_iter().fold(0.0, |most: f64, v| most.max(v.abs()));
    let terms = vec![
        term("given to what lies below", given),
        term("lost to the air", lost),
        term("stored since the fluid came", stored),
    ];
    Some(balance(format!("Heat of {body}"), "J", terms, [stored + given + lost, largest]))
}

/// Energy of a lattice: work of its load, stored and dissipated, released by sudden breaks or of motion.
fn of_lattice(scene: &Scene, body: &str, outputs: &Outputs) -> Option<Balance> {
    let last = |key: &str| outputs.last(&name(scene, body, key));
    let work = last("mechanical_work")?;
    let parts = [
        ("stored", "elastic_energy"),
        ("dissipated by damage", "dissipated_energy"),
        ("released by sudden breaks", "released_energy"),
        ("of motion", "kinetic_energy"),
        ("taken by damping", "damped_energy"),
    ];
    let parts: Vec<_> =
        parts.iter().filter_map(|(words, key)| Some((*words, last(key)?))).collect();
    let missing = work - parts.iter().map(|(_, energy)| energy).sum::<f64>();
    let largest = parts.iter().fold(work.abs(), |most, (_, energy)| most.max(energy.abs()));
    let own = parts.into_iter().map(|(words, energy)| term(words, energy));
    let terms = [term("work of the load", work)].into_iter().chain(own).collect();
    Some(balance(format!("Energy of {body}"), "J", terms, [missing, largest]))
}

/// A droplet and its variables.
struct Of<'o> {
    scene: &'o Scene,
    body: &'o str,
    droplet: &'o Droplet,
    outputs: &'o Outputs,
}

impl Of<'_> {
    fn first(&self, key: &str) -> Option<f64> {
        self.outputs.first(&name(self.scene, self.body, key))
    }

    fn last(&self, key: &str) -> Option<f64> {
        self.outputs.last(&name(self.scene, self.body, key))
    }

    /// True of a single drop that is there from the start: later ones add to mass and momentum.
    fn is_alone(&self) -> bool {
        let droplet = self.droplet;
        let is_there = || self.first("mass").is_some_and(|mass| mass > 0.0);
        !droplet.is_on_demand() && !droplet.is_replayed() && droplet.drops() == 1 && is_there()
    }

    /// Unit of an amount, per metre of depth in a plane model.
    fn unit(&self, whole: &'static str, per_depth: &'static str) -> &'static str {
        if self.droplet.dimension == 2 { per_depth } else { whole }
    }

    /// Heat: what the droplet has given is what it stores less.
    fn heat(&self) -> Option<Balance> {
        let (given, stored) = (self.last("heat")?, self.last("heat_stored")?);
        let terms =
            vec![term("given to what lies below", given), term("stored since the start", stored)];
        let largest = given.abs().max(stored.abs());
        let title = format!("Heat of {}", self.body);
        Some(balance(title, self.unit("J", "J/m"), terms, [given + stored, largest]))
    }

    fn mass(&self) -> Option<Balance> {
        let (first, last) = (self.first("mass")?, self.last("mass")?);
        let terms = vec![term("at the start", first), term("at the end", last)];
        let title = format!("Mass of {}", self.body);
        let made = balance(title, self.unit("kg", "kg/m"), terms, [last - first, first]);
        self.is_alone().then_some(made)
    }

    /// Momentum towards the wall: what the drop has lost is the wall's impulse.
    fn momentum(&self) -> Option<Balance> {
        let (first, last) = (self.first("momentum_z")?, self.last("momentum_z")?);
        let (impulse, time) = (self.last("impulse_z")?, self.outputs.times.last()?);
        let weight = -self.droplet.gravity * time * self.last("mass")?;
        let mut terms = vec![
            term("of the drop at the start", first),
            term("of the drop at the end", last),
            term("given to the wall", impulse),
        ];
        if weight != 0.0 {
            terms.push(term("impulse of its weight", weight));
        }
        let missing = last + impulse - first - weight;
        let title = format!("Momentum of {} along z", self.body);
        let unit = self.unit("kg.m/s", "kg/s");
        let made = balance(title, unit, terms, [missing, first.abs().max(impulse.abs())]);
        self.is_alone().then_some(made)
    }

    /// Mechanical energy, which viscosity dissipates.
    fn energy(&self) -> Option<Balance> {
        self.first("kinetic_energy")?;
        let kinds = ["kinetic", "compression", "surface"];
        let all = |at: &dyn Fn(&str) -> Option<f64>| {
            kinds.map(|kind| at(&format!("{kind}_energy")).unwrap_or(0.0))
        };
        let (first, last) = (all(&|key| self.first(key)), all(&|key| self.last(key)));
        let sum = |all: [f64; 3]| all.iter().sum::<f64>();
        let mut terms = vec![term("at the start", sum(first))];
        let ends = kinds.iter().zip(last);
        terms.extend(ends.map(|(kind, value)| term(&format!("{kind}, at the end"), value)));
        terms.push(term("dissipated, or lost at the wall", sum(first) - sum(last)));
        (self.is_alone() && self.droplet.gravity == 0.0).then(|| Balance {
            title: format!("Mechanical energy of {}", self.body),
            unit: self.unit("J", "J/m").to_owned(),
            terms,
            residual: None,
            expected: None,
            about: "Dissipated energy does not warm the fluid in the model.".to_owned(),
        })
    }
}
