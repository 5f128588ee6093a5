//! Checks the materials of solids: one material, or layers that fill the thickness.

use super::{Checker, is_sound, material, number};
use crate::laws::Material;
use crate::scene::locate::Path;
use crate::scene::materials::MaterialChoice;
use crate::scene::types::{FaceName, HeatMethod, Layer, Solid, SolverMethod};

/// Largest number of layers of a body: each has elements of its own.
const MOST_LAYERS: usize = 100;
/// Tolerance on the sum of layers, relative to the thickness.
const SLACK: f64 = 1e-9;

/// Materials of a body, and the check of those that are not simply named ones.
#[derive(Clone, Copy)]
pub struct Materials<'a> {
    pub material: Option<&'a MaterialChoice>,
    pub layers: Option<&'a [Layer]>,
    pub check: Check,
}

/// Checks the materials of a body at `path` that is so thick [m], if this is sound.
pub fn materials(checker: &mut Checker, path: &Path, own: Materials, thickness: Option<f64>) {
    const EITHER: &str = "`material = …` or `layers = [{ material = …, thickness = … }, …]`";
    match (own.material, own.layers) {
        (None, None) => {
            checker.refuse(&path.key("material"), "the key `material` is missing", EITHER);
        }
        (Some(_), Some(_)) => {
            let message = "a body takes either one material or layers, not both";
            checker.refuse(&path.key("layers"), message, EITHER);
        }
        (Some(choice), None) => own_material(checker, &path.key("material"), choice, own.check),
        (None, Some(list)) => layers(checker, path, thickness, (list, own.check)),
    }
}

/// Checks the materials of the solid at `path`.
pub fn check(checker: &mut Checker, path: &Path, solid: &Solid) {
    let thickness = is_sound(&solid.shape).then(|| solid.shape.thickness());
    let (material, layers) = (solid.material.as_ref(), solid.layers.as_deref());
    materials(checker, path, Materials { material, layers, check: material::check }, thickness);
    if solid.heat == HeatMethod::Sph && solid.layers.as_ref().is_some_and(|list| list.len() > 1) {
        let message =
            "particles conduct heat in bodies of one material only, and this one has layers";
        checker.refuse(&path.key("heat"), message, "fem");
    }
    if solid.layers.is_some()
        && solid.conducts_linearly()
        && checker.scene.solver.method != SolverMethod::Newton
    {
        lateral_convection(checker, path, solid);
    }
}

/// Check of a material.
type Check = fn(&mut Checker, &Path, &Material);

fn layers(
    checker: &mut Checker,
    path: &Path,
    height: Option<f64>,
    (list, check): (&[Layer], Check),
) {
    let place = path.key("layers");
    let fine = (1..=MOST_LAYERS).contains(&list.len());
    let message = format!("a body of {} layers", list.len());
    checker.require(fine, &place, message, format!("1 to {MOST_LAYERS}"));
    let mut sound = !list.is_empty();
    for (i, layer) in list.iter().enumerate() {
        let place = place.index(i);
        own_material(checker, &place.key("material"), &layer.material, check);
        sound &= checker.is_fine(&place.key("thickness"));
        let message = "the top layer has no contact above it";
        let fine = i > 0 || layer.contact_resistance.is_none();
        let place = place.key("contact_resistance");
        checker.require(fine, &place, message, "a layer below another one");
    }
    one_kind_of_flaws(checker, &place, list);
    if let Some(height) = height.filter(|_| sound) {
        thickness(checker, &place, height, list);
    }
}

/// Refuses layers with flaws in the volume next to layers with flaws on faces, whose densities do not compare.
fn one_kind_of_flaws(checker: &mut Checker, path: &Path, list: &[Layer]) {
    let of = |layer: &Layer| {
        let weibull = layer.material.material().fracture.weibull?;
        Some(weibull.area.is_some())
    };
    let first = list.iter().find_map(of);
    let other = list.iter().position(|layer| of(layer).is_some_and(|own| Some(own) != first));
    if let Some(other) = other {
        let message = "flaws of one layer are in its volume, of another on its faces";
        let path = path.index(other).key("material");
        checker.refuse(&path, message, "`volume` in all layers, or `area` in all");
    }
}

/// Checks a material that is not simply a named one: the body's own, or a copy with modified constants.
fn own_material(checker: &mut Checker, path: &Path, choice: &MaterialChoice, check: Check) {
    let named = choice.name.as_ref().and_then(|name| checker.scene.material.get(name));
    if named != Some(choice.material()) {
        check(checker, path, choice.material());
    }
}

/// Checks that layers fill the shape.
fn thickness(checker: &mut Checker, path: &Path, wanted: f64, list: &[Layer]) {
    let sum: f64 = list.iter().map(|layer| layer.thickness).sum();
    let fine = (sum - wanted).abs() <= SLACK * wanted;
    let message = format!(
        "the layers are {} m thick together, the shape is {} m",
        number(sum),
        number(wanted)
    );
    checker.require(
        fine,
        path,
        message,
        format!("thicknesses that add up to {} m", number(wanted)),
    );
}

/// Checks lateral convection on layers. Its flux follows the temperature along the face, but lateral modes are common
/// to all layers only if these have equal conductivities.
fn lateral_convection(checker: &mut Checker, path: &Path, solid: &Solid) {
    let mut conductivities = solid.strata().into_iter().map(|layer| layer.constants.conductivity);
    let Some(first) = conductivities.next() else { return };
    let Some(other) = conductivities.find(|&other| other != first) else { return };
    for (&face, condition) in &solid.faces {
        if condition.convection.is_some() && !matches!(face, FaceName::Top | FaceName::Bottom) {
            let path = path.key("faces").key(face.as_str()).key("convection");
            let message = format!(
                "a lateral face of layers with different conductivities ({} and {} W/(m K)) cannot be convective",
                number(first),
                number(other)
            );
            let allowed = "`temperature`, `flux` or nothing, on top and bottom `convection` too; or `solver.method = \"newton\"`";
            checker.refuse(&path, message, allowed);
        }
    }
}
