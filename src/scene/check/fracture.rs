//! Checks bodies that crack: their material, their section, their mesh, and what cannot go with cracks.

use super::{Checker, notches, number};
use crate::laws::Material;
use crate::laws::fracture::{Cracking, Dissipation, Split};
use crate::laws::solid::Elasticity;
use crate::scene::grid::lateral_extents;
use crate::scene::locate::Path;
use crate::scene::lookup::split_place;
use crate::scene::types::{
    Carries, CellShape, FaceName, HeatMethod, Mesh, PlaneSection, Shape, Solid,
};

pub fn check(checker: &mut Checker) {
    for (name, solid) in checker.scene.solids() {
        let path = Path::default().key("body").key(name);
        if !solid.cracks() {
            let message = "a plane section is of bodies that crack, and nothing cracks here";
            let allowed = "no `section`, or a material with `fracture`";
            checker.require(solid.section.is_none(), &path.at("section"), message, allowed);
            let message = "notches are cracks of bodies that crack, and nothing cracks here";
            let allowed = "no `notches`, or a material with `fracture`";
            checker.require(solid.notches.is_empty(), &path.key("notches"), message, allowed);
            continue;
        }
        for (place, material) in solid.materials(&path) {
            constants(checker, &place, material, solid);
        }
        form(checker, &path, solid);
        neighbours(checker, name, solid);
        if solid.section.is_some() && matches!(solid.shape, Shape::Box(_)) {
            conditions_of_section(checker, &path, solid);
            loads_on_section(checker, name, solid);
        }
        notches::check(checker, &path.key("notches"), solid);
        mesh(checker, &path.at("mesh"), solid);
        number_of_nodes(checker, &path, solid);
    }
}

/// Checks the constants of a material that cracks.
fn constants(checker: &mut Checker, path: &Path, material: &Material, solid: &Solid) {
    let Some(cracking) = material.fracture.cracking else {
        let message = "another part of the body cracks";
        checker.refuse(path, message, "one material, without layers");
        return;
    };
    let own = path.key("fracture");
    sizes(checker, &own, &cracking);
    let is_known = cracking.energy.is_some() || material.fracture.toughness.is_some();
    let message = "neither the energy of cracks nor a toughness, from which it follows, is known";
    let allowed = "`energy = …` (J/m²), or `toughness = …` (Pa √m) of the material";
    checker.require(is_known, &own, message, allowed);
    let message = "elements differ by `scatter` only, of which `seed` numbers the sample";
    let fine = cracking.seed == 0 || cracking.scatter > 0.0;
    checker.require(fine, &own.key("seed"), message, "`scatter = 0.05`, or no `seed`");
    let is_plane = solid.section != Some(PlaneSection::PlaneStress);
    let fine = is_plane || cracking.split.suits_plane_stress();
    let message = "this split is not defined in plane stress";
    checker.require(fine, &own.at("split"), message, "none, no_tension, or plane_strain");
    compression(checker, &own, &cracking, solid);
    let law = material.law.deformation();
    let is_linear = law.is_linear();
    let message = "a body that cracks is thermoelastic with constants: nothing yields, relaxes or depends on the \
                   temperature";
    checker.require(
        is_linear,
        &own,
        message,
        "model = \"thermoelastic\" without tables, or no `fracture`",
    );
    if law.needs().is_empty() {
        super::material::needs(checker, path, material, Elasticity::needs("the body cracks"));
    }
    let message = "cracks take the place of a probability of failure";
    let fine = material.fracture.weibull.is_none();
    checker.require(fine, &path.key("weibull"), message, "either `weibull` or `fracture`");
}

/// Requires a compressive strength where the split follows from it, above that under tension.
fn compression(checker: &mut Checker, path: &Path, cracking: &Cracking, solid: &Solid) {
    let is_star_convex = cracking.split == Split::StarConvex;
    let Some(own) = cracking.compressive_strength else {
        let message = "this split follows from the strength under compression, which is not known";
        let allowed = "`compressive_strength = …` (Pa), or another split";
        checker.require(!is_star_convex, &path.at("split"), message, allowed);
        return;
    };
    let path = path.key("compressive_strength");
    let message = "the strength under compression is that of the split";
    let allowed = "`split = \"star_convex\"`, or no `compressive_strength`";
    if !checker.require(is_star_convex, &path, message, allowed) {
        return;
    }
    // Damage changes the balance of pressure and shear, so that only a body that is elastic up to its strength has this one.
    let message =
        "damage of AT2 begins with the first load, and breaks the body before this strength";
    let is_elastic = cracking.model == Dissipation::At1;
    if !checker.require(is_elastic, &path, message, "`model = \"at1\"`, or another split") {
        return;
    }
    let tensile = solid.damage().map(|law| law.strength());
    if let Some(tensile) = tensile.filter(|tensile| own < *tensile) {
        let message = "the material is weaker under compression than under tension";
        checker.refuse(&path, message, format!("{} Pa or more", number(tensile)));
    }
}

/// Requires one of strength and length.
fn sizes(checker: &mut Checker, path: &Path, cracking: &Cracking) {
    const EITHER: &str = "`strength = …` (Pa) or `length = …` (m)";
    match (cracking.strength, cracking.length) {
        (None, None) => checker.refuse(path, "neither strength nor length is known", EITHER),
        (Some(_), Some(_)) => {
            let message = "the length follows from the strength";
            checker.refuse(&path.key("length"), message, EITHER);
        }
        _ => {}
    }
}

/// Checks the body as a whole.
fn form(checker: &mut Checker, path: &Path, solid: &Solid) {
    let message = "a body of layers does not crack";
    let fine = solid.layers.is_none();
    checker.require(fine, &path.key("layers"), message, "one `material`, or no `fracture`");
    let message = "particles conduct heat in bodies that do not crack";
    let fine = solid.heat == HeatMethod::Fem;
    checker.require(fine, &path.key("heat"), message, "fem, or no `fracture`");
    let message = "a disc cracks in its meridian section";
    let fine = solid.section.is_none() || matches!(solid.shape, Shape::Box(_));
    checker.require(fine, &path.key("section"), message, "nothing");
}

/// Refuses flaws in a body that cracks, and bodies in contact with a plane section.
fn neighbours(checker: &mut Checker, name: &str, solid: &Solid) {
    let list = |key: &str, i: usize| Path::default().key(key).index(i);
    for (i, flaw) in checker.scene.flaw.iter().enumerate() {
        let message = format!(
            "`{name}` cracks, and the stress around a flaw is that of a body without cracks"
        );
        let allowed = "a flaw in a body without `fracture`";
        checker.require(flaw.body != name, &list("flaw", i).at("in"), message, allowed);
    }
    if solid.section.is_none() {
        return;
    }
    for (i, coupling) in checker.scene.coupling.iter().enumerate() {
        let touches = |place: &str| split_place(place).is_some_and(|(body, _)| body == name);
        let fine = !touches(&coupling.from) && !touches(&coupling.to);
        let message =
            format!("nothing varies along y in the section `{name}`, which no other body touches");
        let allowed = "loads and conditions on its faces, or a disc";
        checker.require(fine, &list("coupling", i), message, allowed);
    }
}

/// Refuses conditions that vary along y, or at the ends of y.
fn conditions_of_section(checker: &mut Checker, path: &Path, solid: &Solid) {
    for &face in solid.faces.keys() {
        let is_across = matches!(face, FaceName::Front | FaceName::Back | FaceName::Sides);
        let path = path.at("faces").key(face.as_str());
        let message =
            "nothing varies along y in a plane section, whose front and back are its planes";
        checker.require(!is_across, &path, message, "left, right, top, bottom");
    }
}

/// Refuses loads that vary along y.
fn loads_on_section(checker: &mut Checker, name: &str, solid: &Solid) {
    let [_, width] = lateral_extents(&solid.shape);
    for (i, load) in checker.scene.load.iter().enumerate() {
        if split_place(&load.on).is_none_or(|(body, _)| body != name) {
            continue;
        }
        let path = Path::default().key("load").index(i);
        let is_across = match load.footprint.cells() {
            Some(CellShape::Tiles([_, 1])) => {
                let half = load.footprint.half_extents(None);
                (2.0 * half[1] - width).abs() <= super::SLACK * width
            }
            _ => false,
        };
        let message = "a load on a plane section does not vary along y";
        let allowed = format!("{{ tiles = {{ count = [n, 1], size = […, {}] }} }}", exact(width));
        checker.require(is_across, &path.at("footprint"), message, allowed);
        let fine = load.start.y.is_none_or(|y| y == 0.0) && load.range.y.is_none();
        let message = "a load on a plane section does not move along y";
        checker.require(fine, &path.at("range"), message, "`range` along x");
        let place = load.carries.iter().position(|carried| *carried == Carries::Shear);
        if let Some(place) = place {
            let message =
                "shear has a component along y, to which a plane section does not respond";
            checker.refuse(&path.at("carries").index(place), message, "heat_flux, power, pressure");
        }
    }
}

/// A number with all its digits.
fn exact(value: f64) -> String {
    let plain = number(value);
    if plain.parse() == Ok(value) { plain } else { format!("{value:e}") }
}

/// Largest number of nodes of a section, and in space.
const MOST_NODES: [f64; 2] = [4e6, 1e6];

/// Requires a mesh that resolves the length of damage.
fn mesh(checker: &mut Checker, path: &Path, solid: &Solid) {
    let keys = &solid.mesh;
    let message = "a body that cracks has linear elements";
    checker.require(keys.order.is_none_or(|order| order == 1), &path.at("order"), message, "1");
    let message = "cracks may run anywhere, so that all elements of the body are of one size";
    let fine = keys.growth.is_none_or(|growth| growth == 1.0);
    checker.require(fine, &path.at("growth"), message, "1.0, or nothing");
    let Some(law) = solid.damage() else { return };
    let limit = law.length / Mesh::NODES_PER_LENGTH;
    let [x, _] = lateral_extents(&solid.shape);
    let extents = [x, solid.shape.thickness()];
    let counts = extents.map(|extent| Mesh::elements_of_cracks(extent, limit));
    let given = [("spacing", keys.spacing), ("depth_spacing", keys.depth_spacing)];
    for (key, spacing) in given {
        let fine = spacing.is_none_or(|spacing| Mesh::resolves_cracks(spacing, law.length));
        let message = format!(
            "nodes are too far apart for damage, which spreads over {}",
            number(law.length)
        );
        let allowed = format!(
            "at most {}, a third of it: {} elements along the surface, {} through the thickness",
            number(limit),
            counts[0],
            counts[1]
        );
        checker.require(fine, &path.at(key), message, allowed);
    }
}

/// Refuses cracks that are too short for a mesh.
fn number_of_nodes(checker: &mut Checker, path: &Path, solid: &Solid) {
    let Some(law) = solid.damage() else { return };
    let nodes = solid.nodes_of_cracks(law.length);
    let most = MOST_NODES[usize::from(solid.cracks_in_space())];
    let fine = nodes <= most;
    let model = match law.dissipation {
        Dissipation::At1 => "AT1",
        Dissipation::At2 => "AT2",
    };
    let message =
        format!("{} nodes resolve cracks of length {}", number(nodes.round()), number(law.length));
    let of_fracture = path.at("material").key("fracture");
    let strength =
        solid.material.as_ref().and_then(|own| own.material().fracture.cracking?.strength);
    let (place, larger) = match (solid.mesh.spacing, strength) {
        (Some(_), _) => (path.at("mesh").key("spacing"), "spacing".to_owned()),
        (None, Some(_)) => {
            (of_fracture.key("strength"), format!("`length` of {model}, with less strength"))
        }
        (None, None) => (of_fracture.key("length"), format!("`length` of {model}")),
    };
    let section = if solid.cracks_in_space() { ", or a plane `section`" } else { "" };
    let allowed = format!("at most {most:.0e}: a smaller body{section}, or a larger {larger}");
    checker.require(fine, &place, message, allowed);
}
