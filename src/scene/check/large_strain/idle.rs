//! Constants of a material without effect in a solid of large strain.

use super::Checker;
use crate::laws::{Material, Property};
use crate::scene::locate::Path;
use crate::scene::{LargeStrain, MaterialChoice};

/// Refuses constants that a scene sets to no effect. Those that a substance of the library brings along, and those of a
/// named material that other bodies share, are left alone.
pub fn check(checker: &mut Checker, name: &str, solid: &LargeStrain) {
    let path = Path::default().key("body").key(name);
    let layers = solid.layers.iter().flatten().enumerate();
    let of_layers =
        layers.map(|(n, layer)| (path.key("layers").index(n).key("material"), &layer.material));
    let own = solid.material.iter().map(|choice| (path.key("material"), choice));
    for (place, choice) in own.chain(of_layers).collect::<Vec<_>>() {
        // Another law has other constants.
        let is_sound = checker.is_fine(&place);
        let table = table(checker, name, &place, choice).filter(|_| is_sound);
        let Some(table) = table else { continue };
        for (key, message, allowed) in idle(solid, choice.material()) {
            let place = table.key(key);
            let fine = !checker.sets(&table, key) || !checker.is_fine(&place);
            checker.require(fine, &place, message, allowed);
        }
    }
}

/// The table of a material that no other body names.
fn table(checker: &Checker, body: &str, place: &Path, choice: &MaterialChoice) -> Option<Path> {
    let Some(name) = &choice.name else { return Some(place.clone()) };
    let mut others = checker.scene.body.iter().filter(|(other, _)| *other != body);
    let is_shared = others.any(|(_, other)| {
        other.materials().iter().any(|choice| choice.name.as_ref() == Some(name))
    });
    (!is_shared).then(|| Path::default().key("material").key(name))
}

/// Constants of a material without effect, each with the reason and what is allowed.
fn idle(
    solid: &LargeStrain,
    material: &Material,
) -> Vec<(&'static str, &'static str, &'static str)> {
    let mut idle = Vec::new();
    if material.fracture.toughness.is_some() {
        let message =
            "a toughness is that of flaws and cracks, and solids of large strain have neither";
        idle.push(("toughness", message, "no `toughness`"));
    }
    if solid.conducts() {
        return idle;
    }
    let expansion = &material.law.deformation().elasticity().expansion;
    let expands = expansion.as_ref().is_some_and(|own| *own != Property::Constant(0.0));
    if expands && !solid.has_temperature() {
        let message = "the body keeps its initial temperature, so nothing expands";
        let allowed = if solid.inertia {
            "no `expansion`; a thermal condition on a face; or `inertia = false`, with the temperature as input"
        } else {
            "no `expansion`; a thermal condition on a face; or constants that do not depend on the temperature, which is then an input"
        };
        idle.push(("expansion", message, allowed));
    }
    if material.heat.melting.is_some() {
        let message = "no heat flows in the body, so nothing melts";
        idle.push(("melting", message, "no `melting`"));
    }
    idle
}
