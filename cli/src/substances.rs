//! The command `impinge substances`.

use std::fmt::Write;

use clap::Args;
use impinge::substances::{Kind, Substance};

use super::CliError;

/// List the substances that scenes may name, or show the constants and sources of one
#[derive(Args)]
pub struct Substances {
    /// Name of a substance
    name: Option<String>,
}

impl Substances {
    pub fn execute(&self) -> Result<String, CliError> {
        match &self.name {
            None => Ok(list()),
            Some(name) => shown(name),
        }
    }
}

fn list() -> String {
    let mut out = String::new();
    for (kind, heading) in [(Kind::Solid, "Solids"), (Kind::Fluid, "Fluids")] {
        let _ = writeln!(out, "{heading}:");
        for substance in kind.all() {
            let sheet = substance.sheet();
            let [low, high] = sheet.valid;
            let _ =
                writeln!(out, "  {:<20} {low:>7} to {high:>7} K  {}", substance.name, sheet.title);
        }
    }
    out
}

/// All substances of a name: that of a solid may be that of its melt, too.
fn shown(name: &str) -> Result<String, CliError> {
    let kinds = [(Kind::Solid, "solid"), (Kind::Fluid, "fluid")];
    let found: Vec<(Substance, &str)> = kinds
        .into_iter()
        .filter_map(|(kind, word)| kind.find(name).map(|substance| (substance, word)))
        .collect();
    if found.is_empty() {
        let names = || [Kind::Solid, Kind::Fluid].into_iter().flat_map(|kind| kind.all());
        let names = names().map(|substance| substance.name);
        return Err(CliError::UnknownSubstance {
            name: name.to_owned(),
            hint: impinge::scene::hint(name, names),
        });
    }
    let texts = found
        .into_iter()
        .map(|(substance, word)| format!("# {} ({word})\n{}", substance.name, substance.text));
    Ok(texts.collect::<Vec<_>>().join("\n"))
}
