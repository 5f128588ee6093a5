//! Checks that loads act on suitable faces, and stay on them throughout their range.

use super::{Checker, MOST_ELEMENTS, fits, number, start};
use crate::scene::grid::lateral_extents;
use crate::scene::locate::Path;
use crate::scene::types::{Carries, FaceName, Footprint, Load, Shape, Solid};

pub fn check(checker: &mut Checker) {
    for (i, load) in checker.scene.load.iter().enumerate() {
        let path = Path::default().key("load").index(i);
        checker.distinct(&path.at("carries"), &load.carries);
        check_power(checker, &path.at("carries"), load);
        check_ring(checker, &path.at("footprint.ring"), &load.footprint);
        start::check(checker, &path, load);
        let lengths_are_fine =
            ["footprint", "start", "range"].iter().all(|key| checker.is_fine(&path.key(key)));
        let Some((face, solid)) = checker.face(&path.at("on"), &load.on, loaded_faces) else {
            continue;
        };
        held_face(checker, &path.at("carries"), load, face, solid);
        if let Shape::Disc(_) = solid.shape {
            axisymmetry(checker, &path, load);
        }
        if lengths_are_fine {
            reach(checker, &path, load, &solid.shape);
            fineness(checker, &path, load, solid);
        }
    }
}

/// The faces on which loads may act.
pub fn loaded_faces(_: &Shape) -> Vec<FaceName> {
    vec![FaceName::Top, FaceName::Bottom]
}

/// Largest inner radius of a ring over its outer one: the ring is the difference of two discs.
const WIDEST_HOLE: f64 = 0.999;

/// Refuses rings that are too thin.
pub fn check_ring(checker: &mut Checker, path: &Path, footprint: &Footprint) {
    let Footprint::Ring { inner, outer } = *footprint else { return };
    if checker.is_fine(path) {
        let most = WIDEST_HOLE * outer;
        let allowed = format!("0 < inner <= {}", number(most));
        let message = "the ring is thinner than it can be told";
        checker.require(fits(inner, most), &path.at("inner"), message, allowed);
    }
}

/// Refuses a power on footprints of many values, and beside a heat flux of the same load.
fn check_power(checker: &mut Checker, path: &Path, load: &Load) {
    let Some(i) = load.carries.iter().position(|carries| *carries == Carries::Power) else {
        return;
    };
    let name = load.footprint.name();
    if load.footprint.cells().is_some() {
        let message =
            format!("a power is one value of the whole footprint, and `{name}` have many");
        let allowed = format!("disc, gaussian, ring; or `heat_flux` on `{name}`");
        checker.refuse(&path.index(i), message, allowed);
    } else if load.carries.contains(&Carries::HeatFlux) {
        let message = "a load carries its heat as a power or as a heat flux, not as both";
        checker.refuse(&path.index(i), message, "power or heat_flux; or two loads");
    }
}

/// Refuses a load on a prescribed quantity of its face, which would remove the load at once.
fn held_face(checker: &mut Checker, path: &Path, load: &Load, name: FaceName, solid: &Solid) {
    let face = solid.face(name);
    let name = name.as_str();
    for (i, carries) in load.carries.iter().enumerate() {
        let (reason, allowed) = match carries {
            Carries::HeatFlux | Carries::Power if face.temperature.is_some() => (
                "the face has a prescribed temperature: the heat would leave at once",
                "pressure, shear",
            ),
            Carries::Pressure | Carries::Shear if face.clamped => {
                ("the face is clamped: the traction would move nothing", "heat_flux, power")
            }
            Carries::Pressure if face.roller => {
                let message = "the face is on rollers: the pressure would move nothing";
                (message, "heat_flux, power, shear")
            }
            _ => continue,
        };
        let allowed = format!("{allowed}; or a `{name}` without that condition");
        checker.refuse(&path.index(i), reason, allowed);
    }
}

/// Checks that loads on a disc, which is modelled in its meridian section, are centred and axisymmetric.
fn axisymmetry(checker: &mut Checker, path: &Path, load: &Load) {
    let footprint = &load.footprint;
    if let Footprint::Tiles { .. } = footprint {
        let message = "a disc is modelled axisymmetric, which tiles are not";
        checker.refuse(&path.at("footprint.tiles"), message, "disc, gaussian, ring, rings");
    }
    if !footprint.shears_outward()
        && let Some(i) = load.carries.iter().position(|carries| *carries == Carries::Shear)
    {
        let message = "a disc is modelled axisymmetric, which shear along x or y is not";
        checker.refuse(&path.at("carries").index(i), message, "shear with `rings` only (radial)");
    }
    for (key, given) in [
        ("start.x", load.start.x.is_some()),
        ("start.y", load.start.y.is_some()),
        ("range.x", load.range.x.is_some()),
        ("range.y", load.range.y.is_some()),
    ] {
        let message = "a disc is modelled axisymmetric: its loads stay centred";
        checker.require(!given, &path.at(key), message, "no `x` and `y` on a disc");
    }
}

/// Refuses footprints so small that the face would hold too many elements to count. Without a spacing of its own, the
/// mesh is as fine as the smallest footprint requires.
fn fineness(checker: &mut Checker, path: &Path, load: &Load, solid: &Solid) {
    let [x, y] = lateral_extents(&solid.shape);
    let least = x.max(y) / (0.1 * MOST_ELEMENTS);
    let (key, smallest) = match (load.footprint, load.range.radius) {
        (Footprint::Rings { .. }, Some([lowest, _])) => ("range.radius", lowest),
        (footprint, Some([lowest, _])) if footprint.radius().is_some() => {
            ("range.radius", footprint.finest(Some(lowest)))
        }
        (footprint, _) => ("footprint", footprint.finest(None)),
    };
    let fine = solid.mesh.spacing.is_some() || smallest >= least;
    let message = format!("a part of this footprint is only {} m wide", number(smallest));
    let allowed = format!(">= {}, or `mesh.spacing` in the body", number(least));
    checker.require(fine, &path.at(key), message, allowed);
}

/// An axis along which a footprint must stay on its face.
struct Reach {
    axis: &'static str,
    /// Position of the centre at the start, and its bounds [m].
    start: f64,
    range: Option<[f64; 2]>,
    /// Extent of the face on both sides of its centre [m].
    half: f64,
    /// Extent of the footprint on both sides of its centre, at the start and at most [m].
    half_start: f64,
    half_most: f64,
}

/// Refuses footprints that leave their face at the start or in a corner of their range. For a Gaussian its radius
/// counts, not its tails.
fn reach(checker: &mut Checker, path: &Path, load: &Load, shape: &Shape) {
    let tried = reaches(load, shape).into_iter().find_map(|reach| {
        let key = reach.key_at_fault(load)?;
        Some((key, reach))
    });
    let Some((key, reach)) = tried else { return };
    let (axis, half) = (reach.axis, number(reach.half));
    let extent = load.footprint.radius().map_or("half of the size", |_| "radius");
    let allowed = match shape {
        Shape::Box(_) => format!("|{axis}| + {extent} <= {half}"),
        Shape::Disc(_) => format!("{extent} <= {half}"),
    };
    checker.refuse(&path.at(&key), "the footprint does not stay on the face", allowed);
}

fn reaches(load: &Load, shape: &Shape) -> Vec<Reach> {
    let half = lateral_extents(shape).map(|extent| extent / 2.0);
    let along = |axis: usize| {
        let (half_start, half_most) = half_extents(load, axis);
        let name = ["x", "y"][axis];
        let start = [load.start.x, load.start.y][axis].unwrap_or(0.0);
        let range = [load.range.x, load.range.y][axis];
        Reach { axis: name, start, range, half: half[axis], half_start, half_most }
    };
    match (shape, &load.footprint) {
        (Shape::Box(_), _) => vec![along(0), along(1)],
        (Shape::Disc(_), Footprint::Tiles { .. }) => Vec::new(),
        (Shape::Disc(_), _) => vec![Reach { start: 0.0, range: None, ..along(0) }],
    }
}

/// Extent of a footprint on both sides of its centre, at the start and at most [m].
fn half_extents(load: &Load, axis: usize) -> (f64, f64) {
    let start = load.footprint.half_extents(load.start.radius)[axis];
    match (load.footprint.radius(), load.range.radius) {
        (Some(_), Some([_, most])) => (start, most.max(start)),
        _ => (start, start),
    }
}

impl Reach {
    /// The key that lets the footprint leave its face.
    fn key_at_fault(&self, load: &Load) -> Option<String> {
        let farthest =
            self.range.map_or(self.start.abs(), |range| range[0].abs().max(range[1].abs()));
        let leaves = |centre: f64, extent: f64| !fits(centre + extent, self.half);
        if leaves(self.start.abs(), self.half_start) {
            Some(self.key_of_start(load))
        } else if leaves(farthest, self.half_start) {
            Some(format!("range.{}", self.axis))
        } else if leaves(farthest, self.half_most) {
            Some("range.radius".to_owned())
        } else {
            None
        }
    }

    fn key_of_start(&self, load: &Load) -> String {
        if self.start != 0.0 && fits(self.half_start, self.half) {
            format!("start.{}", self.axis)
        } else if load.start.radius.is_some() {
            "start.radius".to_owned()
        } else {
            format!("footprint.{}.{}", load.footprint.name(), load.footprint.key_of_extent())
        }
    }
}
