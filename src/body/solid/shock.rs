//! Sizes of a thermal shock that no flaw survives or every flaw survives: the critical length of the material, and the
//! depth that heat has gone before any flaw can grow.

use super::front::{temperatures_in_contact, temperatures_of};
use crate::limits::number;
use crate::scene::{Flaw, Scene, Solid};

/// Depth of heat over the critical length `(K_Ic/σ_s)²` before which no flaw of a suddenly cooled half space grows:
/// `1/1.34485²`, as K is at most 1.34485 σ_s√δ (see `docs/theory/fracture.md`).
const EARLIEST: f64 = 0.5529;

/// The note on a shock of a body with flaws; `None` without toughness or fall of the surface temperature. `σ_s =
/// EαΔT/(1 − ν)` is that of a half space of the first flaw's material whose surface falls at once to the coldest thing
/// that touches it; no surface of it is stressed more.
pub fn note(scene: &Scene, (name, solid): (&str, &Solid)) -> Option<String> {
    let flaw = scene.flaw.iter().find(|flaw| flaw.body == name)?;
    let drop = solid.initial_temperature - coldest(scene, (name, solid));
    if drop <= 0.0 {
        return None;
    }
    let shock = Shock::new(flaw, solid, drop)?;
    let [stress, critical, depth, time] =
        [shock.stress, shock.critical(), shock.depth(), shock.time()].map(rounded);
    Some(format!(
        "a surface that falls by {} K at once is stressed to σ_s = {stress} Pa, and l_c = (K_Ic/σ_s)² is {critical} m: no \
         flaw of any size grows before heat has gone 0.55 l_c = {depth} m, {time} s after the shock",
        rounded(drop)
    ))
}

/// Coldest temperature that faces, a bath, drops and bodies in contact bring to a solid at its start [K].
fn coldest(scene: &Scene, (name, solid): (&str, &Solid)) -> f64 {
    let of_faces = solid.faces.values().flat_map(temperatures_of);
    let of_drops = scene
        .couplings_to(name)
        .filter_map(|coupling| Some(scene.first_contact(&coupling.from)?.temperature));
    let of_bath = solid.bath.map(|bath| bath.ambient);
    let of_bodies = temperatures_in_contact(scene, name);
    of_faces.chain(of_drops).chain(of_bath).chain(of_bodies).fold(f64::INFINITY, f64::min)
}

/// A suddenly cooled half space.
struct Shock {
    /// `EαΔT/(1 − ν)` [Pa].
    stress: f64,
    /// [Pa √m]
    toughness: f64,
    /// [m²/s]
    diffusivity: f64,
}

impl Shock {
    /// A fall of temperature [K] of the material in which a flaw lies.
    fn new(flaw: &Flaw, solid: &Solid, drop: f64) -> Option<Self> {
        let layer = flaw.layer(solid);
        let layers = solid.materials_of_layers();
        let material = layers.get(layer)?;
        let constants = material.at(solid.initial_temperature);
        let (young, poisson, expansion) =
            (constants.young?, constants.poisson?, constants.expansion?);
        Some(Self {
            stress: young * expansion * drop / (1.0 - poisson),
            toughness: material.fracture.toughness?,
            diffusivity: constants.diffusivity(),
        })
        .filter(|shock| shock.stress > 0.0)
    }

    /// `l_c = (K_Ic/σ_s)²` [m].
    fn critical(&self) -> f64 {
        (self.toughness / self.stress).powi(2)
    }

    /// Depth `√(κt)` that heat has gone before any flaw grows [m].
    fn depth(&self) -> f64 {
        EARLIEST * self.critical()
    }

    /// Time in which heat goes that far [s].
    fn time(&self) -> f64 {
        self.depth().powi(2) / self.diffusivity
    }
}

/// A number of three digits.
fn rounded(value: f64) -> String {
    number(format!("{value:.2e}").parse().unwrap_or(value))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn alumina_has_the_lengths_of_its_shocks() {
        for (drop, wanted) in [(50.0, 432e-6), (100.0, 108e-6), (200.0, 27e-6), (280.0, 13.8e-6)] {
            // Plane stress: EαΔT.
            let stress = 340e9 * 8e-6 * drop;
            let shock = Shock { stress, toughness: 3.80e6, diffusivity: 8.85e-6 };
            assert!((shock.depth() / wanted - 1.0).abs() < 0.01, "{drop}: {}", shock.depth());
        }
    }
}
