//! Checks that a scene makes sense and can be modelled. Each file covers one subject.

mod bath;
mod body;
mod coupling;
mod droplet;
mod field;
mod filament;
mod fidelity;
mod fracture;
mod flaw;
mod field_cells;
mod freezing;
mod header;
mod large_strain;
mod lattice;
mod layers;
mod limits;
mod material;
mod nonlinear;
mod notches;
mod load;
mod probe;
mod replayed;
mod reservoir;
mod start;
mod support;
mod values;
mod viscosity;
mod wall;

pub use crate::limits::number;
pub use nonlinear::takes_newton;

use std::collections::BTreeSet;

use super::droplet::Droplet;
use super::error::{Problem, SceneError};
use super::locate::{Path, Source};
use super::lookup::split_place;
use super::schema::Schema;
use super::spelling::hint;
use super::types::{Body, FaceName, Scene, Shape, Solid};

/// Largest number of elements along an axis, if the mesh were as fine everywhere as in its finest place.
const MOST_ELEMENTS: f64 = 1e6;

/// Relative tolerance of comparisons of computed lengths.
const SLACK: f64 = 1e-9;

/// Finds all errors of a scene whose numbers are all finite.
pub fn check(scene: &Scene, source: &Source, schema: &Schema) -> Result<(), SceneError> {
    let mut checker = Checker { scene, source, problems: Vec::new(), refused: BTreeSet::new() };
    limits::check(&mut checker, schema);
    header::check(&mut checker);
    body::check(&mut checker);
    bath::check(&mut checker);
    fracture::check(&mut checker);
    droplet::check(&mut checker);
    reservoir::check(&mut checker);
    large_strain::check(&mut checker);
    filament::check(&mut checker);
    lattice::check(&mut checker);
    load::check(&mut checker);
    probe::check(&mut checker);
    field::check(&mut checker);
    flaw::check(&mut checker);
    wall::check(&mut checker);
    values::check(&mut checker);
    coupling::check(&mut checker);
    support::check(&mut checker);
    fidelity::check(&mut checker);
    SceneError::unless_empty(checker.problems)
}

/// Collects the problems of a scene.
struct Checker<'a> {
    scene: &'a Scene,
    source: &'a Source<'a>,
    problems: Vec<Problem>,
    /// Positions of these problems.
    refused: BTreeSet<Path>,
}

impl<'a> Checker<'a> {
    /// Records a problem with the value at `path`.
    fn refuse(&mut self, path: &Path, message: impl Into<String>, allowed: impl Into<String>) {
        self.problems.push(self.source.problem(path, message.into(), allowed.into()));
        self.refused.insert(path.clone());
    }

    /// Positions of refused values within the value at `path`.
    fn refused_in(&self, path: &Path) -> impl Iterator<Item = &Path> {
        let all = path.clone();
        self.refused.range(path..).take_while(move |refused| refused.is_within(&all))
    }

    /// Returns true if nothing in the value at `path` has been refused.
    fn is_fine(&self, path: &Path) -> bool {
        self.refused_in(path).next().is_none()
    }

    /// Records a problem unless `fine`; returns `fine`.
    fn require(
        &mut self,
        fine: bool,
        path: &Path,
        message: impl Into<String>,
        allowed: impl Into<String>,
    ) -> bool {
        if !fine {
            self.refuse(path, message, allowed);
        }
        fine
    }

    /// Returns true if the scene itself sets a key of a table, which no substance of the library brings along.
    fn sets(&self, table: &Path, key: &str) -> bool {
        let is_of_substance = self.scene.substances.iter().any(|named| named.table == *table);
        let place = |path: &Path| self.source.span(path);
        // Constants of a substance stand where its table is; a scene that was changed is written with all of them.
        let has_places = !self.source.substances().is_empty();
        !is_of_substance || has_places && place(&table.key(key)) != place(table)
    }

    /// Refuses empty lists and repetitions in lists of names.
    fn distinct<T: PartialEq>(&mut self, path: &Path, names: &[T]) {
        self.require(!names.is_empty(), path, "the list is empty", "at least one name");
        for (i, name) in names.iter().enumerate() {
            let fine = !names[..i].contains(name);
            self.require(fine, &path.index(i), "this is named twice", "each name once");
        }
    }

    /// Returns the body of that name; refuses an unknown name. Also returns `None` for bodies with a refused shape, on
    /// which no position can be checked.
    fn body(&mut self, path: &Path, name: &str) -> Option<&'a Solid> {
        let solid = self.scene.solid(name);
        if solid.is_none() {
            let known = self.scene.solids().map(|(name, _)| name).collect::<Vec<_>>().join(", ");
            let hint = hint(name, self.scene.solids().map(|(name, _)| name));
            let message = self.not_a_solid(name, format!("there is no body `{name}`{hint}"));
            self.refuse(path, message, list_or(known, "a body of kind `solid`"));
        }
        solid.filter(|solid| is_sound(&solid.shape))
    }

    /// Returns the face that `BODY.FACE` names; refuses a face that is not among those that `offered` returns for the
    /// shape. Also returns `None` on bodies with a refused shape.
    fn face(
        &mut self,
        path: &Path,
        place: &str,
        offered: fn(&Shape) -> Vec<FaceName>,
    ) -> Option<(FaceName, &'a Solid)> {
        let named = split_place(place).and_then(|(body, face)| {
            let solid = self.scene.solid(body)?;
            offered(&solid.shape).contains(&face).then_some((face, solid))
        });
        if named.is_none() {
            let known = self.scene.solids().flat_map(|(body, solid)| {
                let faces = offered(&solid.shape).into_iter();
                faces.map(move |face| format!("{body}.{}", face.as_str()))
            });
            let known = known.collect::<Vec<_>>().join(", ");
            let body = place.rsplit_once('.').map_or(place, |(body, _)| body);
            let hint = match self.scene.solid(body) {
                Some(_) => String::new(),
                None => hint(body, self.scene.solids().map(|(name, _)| name)),
            };
            let message = self.not_a_solid(body, format!("`{place}` is no face for this{hint}"));
            self.refuse(path, message, list_or(known, "a face of a body of kind `solid`"));
        }
        named.filter(|(_, solid)| is_sound(&solid.shape))
    }

    /// Message for a body that is used where a solid is expected.
    fn not_a_solid(&self, body: &str, otherwise: String) -> String {
        match self.scene.body.get(body) {
            Some(Body::Reservoir(_)) => format!(
                "`{body}` is a reservoir, whose values are always outputs and which can be in contact with solids only"
            ),
            Some(Body::LargeStrain(_)) => format!(
                "`{body}` is a solid of large strain, whose faces have their loads and which probes and fields read, and nothing else"
            ),
            Some(Body::Filament(_)) => format!(
                "`{body}` is a filament, on which nothing else acts and whose values are outputs by themselves"
            ),
            Some(Body::Lattice(_)) => format!(
                "`{body}` is a lattice, on which its own input acts and whose values are outputs by themselves"
            ),
            Some(Body::Droplet(_)) => format!(
                "`{body}` is a droplet, on which nothing else acts and whose values are outputs by \
                 themselves"
            ),
            _ => otherwise,
        }
    }

    /// Returns the droplet of that name; refuses an unknown name.
    fn droplet(&mut self, path: &Path, name: &str) -> Option<&'a Droplet> {
        let droplet = self.scene.droplet(name);
        if droplet.is_none() {
            let known = self.scene.droplets().map(|(name, _)| name).collect::<Vec<_>>().join(", ");
            let hint = hint(name, self.scene.droplets().map(|(name, _)| name));
            let message = format!("there is no droplet `{name}`{hint}");
            self.refuse(path, message, list_or(known, "a body of kind `droplet`"));
        }
        droplet
    }
}

/// Returns a list, or another text if it is empty.
fn list_or(list: String, otherwise: &str) -> String {
    if list.is_empty() { otherwise.to_owned() } else { list }
}

/// Returns true if all extents of a shape are positive.
fn is_sound(shape: &Shape) -> bool {
    match shape {
        Shape::Box(extents) => extents.iter().all(|&extent| extent > 0.0),
        Shape::Disc(disc) => disc.radius > 0.0 && disc.thickness > 0.0,
    }
}

/// Returns true if a length is at most as large as another.
pub(crate) fn fits(length: f64, limit: f64) -> bool {
    length <= limit * (1.0 + SLACK)
}

/// Returns true if `z` lies within the body's thickness.
fn is_in_depth(z: f64, thickness: f64) -> bool {
    z <= SLACK * thickness && fits(-z, thickness)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lengths_compare_with_tolerance() {
        assert!(fits(1.0 + 1e-10, 1.0) && !fits(1.0 + 1e-8, 1.0));
        assert!(is_in_depth(1e-10, 1.0) && !is_in_depth(1e-8, 1.0));
        assert!(is_in_depth(-1.0 - 1e-10, 1.0) && !is_in_depth(-1.0 - 1e-8, 1.0));
    }
}
