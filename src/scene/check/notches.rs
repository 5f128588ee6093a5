//! Checks the notches of a body that cracks.

use std::collections::BTreeSet;

use super::{Checker, number};
use crate::math::parts::Parts;
use crate::math::segments::{Place, Segment, contact, distance, united};
use crate::scene::locate::Path;
use crate::scene::types::{Mesh, Shape, Solid, Symmetry};

/// Distance over the size of a section below which notches touch.
const TOUCHING: f64 = 1e-9;

/// Refuses notches outside of the meshed section, those without length, those that leave less than an element at an
/// edge, and those that cut the section in two.
pub fn check(checker: &mut Checker, path: &Path, solid: &Solid) {
    if solid.cracks_in_space() {
        let message = "notches are lines of a section, and this body cracks in space";
        let allowed = "none; or a disc, or a `section`";
        checker.require(solid.notches.is_empty(), path, message, allowed);
        return;
    }
    let is_half = solid.symmetry == Symmetry::Quarter;
    let [low, high] = match solid.shape {
        Shape::Box([x, _, _]) if !is_half => [-0.5 * x, 0.5 * x],
        Shape::Box([x, _, _]) => [0.0, 0.5 * x],
        Shape::Disc(disc) => [0.0, disc.radius],
    };
    let bottom = -solid.shape.thickness();
    let is_inside = |[x, z]: Place| (low..=high).contains(&x) && (bottom..=0.0).contains(&z);
    let whole = [[-high, bottom], [high, 0.0]];
    // Notches and their mirror images, with their places in the list.
    let mut inside = Vec::new();
    for (i, notch) in solid.notches.iter().enumerate() {
        let message = "a notch has a length";
        checker.require(notch.from != notch.to, &path.index(i), message, "`to` away from `from`");
        for (key, end) in [("from", notch.from), ("to", notch.to)] {
            let allowed = format!("[{} to {}, {} to 0]", number(low), number(high), number(bottom));
            let message = "a notch ends outside of the meshed section";
            checker.require(is_inside(end), &path.index(i).key(key), message, allowed);
        }
        if !is_inside(notch.from) || !is_inside(notch.to) {
            continue;
        }
        let own = [notch.from, notch.to];
        let corners = [[low, bottom], [high, 0.0]];
        ligaments(checker, &path.index(i), (own, corners), solid);
        let edges = if low == 0.0 { &[1, 2, 3][..] } else { &[0, 1, 2, 3] };
        let along = edges.iter().any(|&edge| own.iter().all(|at| is_on_edge(*at, corners, edge)));
        let message = "a notch along an edge of the section cuts nothing off, and breaks the elements along it";
        checker.require(!along, &path.index(i), message, "a notch into the section");
        let is_known = inside.iter().any(|(_, other)| is_same(own, *other));
        let message = "this notch is in the list before";
        checker.require(!is_known, &path.index(i), message, "each notch once");
        inside.push((i, own));
        // Half a section stands for a whole one; a notch in its plane of symmetry is its own image.
        if low == 0.0 && own.iter().any(|at| at[0] != 0.0) {
            inside.push((i, own.map(|[x, z]| [-x, z])));
        }
    }
    let (places, notches): (Vec<usize>, Vec<Segment>) = inside.into_iter().unzip();
    if let Some(first) = first_that_cuts(&notches, whole) {
        let message = "notches cut the section in two";
        checker.refuse(&path.index(places[first]), message, "notches that leave it in one piece");
    }
}

/// Returns true if a point is on an edge of a rectangle between two corners: the low and the high one along x, then
/// along z.
fn is_on_edge(at: Place, [low, high]: [Place; 2], edge: usize) -> bool {
    let [axis, end] = [edge / 2, edge % 2];
    let own = if end == 0 { low } else { high };
    (at[axis] - own[axis]).abs() <= TOUCHING * (high[axis] - low[axis])
}

/// Returns true if two notches have the same ends.
fn is_same([a, b]: Segment, other: Segment) -> bool {
    other == [a, b] || other == [b, a]
}

/// Refuses notches that are shorter than an element, and those of which an end is off an edge of the meshed section by less than an element,
/// all of which they break.
fn ligaments(
    checker: &mut Checker,
    path: &Path,
    (ends, [low, high]): (Segment, [Place; 2]),
    solid: &Solid,
) {
    let Some(law) = solid.damage() else { return };
    let spacing = solid.mesh.spacing_of_cracks(law.length);
    let sizes = [0, 1].map(|axis| {
        let extent = high[axis] - low[axis];
        extent / Mesh::elements_of_cracks(extent, spacing[axis]) as f64
    });
    let least = sizes[0].min(sizes[1]);
    let message = format!(
        "a notch of {} m is shorter than an element, all of which it breaks",
        short(distance(ends[0], ends[1]))
    );
    let is_long = distance(ends[0], ends[1]) >= least * (1.0 - TOUCHING);
    // A notch without length is refused as such.
    if ends[0] != ends[1] {
        checker.require(is_long, path, message, format!(">= {} m long", short(least)));
    }
    for (key, end) in ["from", "to"].into_iter().zip(ends) {
        for axis in 0..2 {
            let extent = high[axis] - low[axis];
            let size = sizes[axis];
            let left = (end[axis] - low[axis]).min(high[axis] - end[axis]);
            let message = format!(
                "a notch leaves {} m to the edge of the meshed section, less than an element, which is {} m long: it \
                 would break through",
                short(left),
                short(size)
            );
            let fine = left <= TOUCHING * extent || left > size * (1.0 + TOUCHING);
            let allowed = format!("an end on the edge, or more than {} m off it", short(size));
            checker.require(fine, &path.key(key), message, allowed);
        }
    }
}

/// A length to three digits.
fn short(length: f64) -> String {
    number(format!("{length:.2e}").parse().unwrap_or(length))
}

/// The first of some notches that, with those before it, cuts a rectangle in two.
fn first_that_cuts(notches: &[Segment], whole: [Place; 2]) -> Option<usize> {
    if !cut(notches, whole) {
        return None;
    }
    // What is cut stays so with more notches.
    let counts: Vec<usize> = (1..=notches.len()).collect();
    Some(counts.partition_point(|&count| !cut(&notches[..count], whole)))
}

/// Returns true if notches cut a rectangle between two corners in two: a way along them and its edge then closes. It does
/// if contacts of notches with each other and with the edge are no forest.
fn cut(notches: &[Segment], [low, high]: [Place; 2]) -> bool {
    let reach = TOUCHING * (high[0] - low[0]).max(high[1] - low[1]);
    let sides = |at: &Place| {
        [at[0] - low[0], high[0] - at[0], at[1] - low[1], high[1] - at[1]]
            .map(|own| own.abs() <= reach)
    };
    let is_along = |own: &Segment| {
        let [a, b] = [sides(&own[0]), sides(&own[1])];
        (0..4).any(|side| a[side] && b[side])
    };
    let inner: Vec<Segment> = notches.iter().copied().filter(|own| !is_along(own)).collect();
    let inner = united(&inner, reach);
    let (mut places, mut contacts) = (Vec::new(), BTreeSet::new());
    // The edge is number 0, and notches follow.
    let mut touch = |owners: [usize; 2], at: Place| {
        let known = places.iter().position(|own| distance(*own, at) <= reach);
        let place = known.unwrap_or_else(|| {
            places.push(at);
            places.len() - 1
        });
        contacts.extend(owners.map(|owner| (owner, place)));
    };
    for (i, own) in inner.iter().enumerate() {
        for &end in own.iter().filter(|end| sides(end).contains(&true)) {
            touch([0, i + 1], end);
        }
        for (j, other) in inner[..i].iter().enumerate() {
            if let Some(at) = contact(own, other, reach) {
                touch([i + 1, j + 1], at);
            }
        }
    }
    let owners = inner.len() + 1;
    let vertices = owners + places.len();
    let mut parts = Parts::new(vertices);
    contacts.iter().for_each(|&(owner, place)| parts.join([owner, owners + place]));
    contacts.len() + parts.count() > vertices
}

#[cfg(test)]
mod tests {
    use super::*;

    const SECTION: [Place; 2] = [[-2.0, -1.0], [2.0, 0.0]];

    #[test]
    fn notches_that_leave_one_piece_do_not_cut() {
        let edge = [[0.0, 0.0], [0.0, -0.4]];
        let cases: [&[Segment]; 7] = [
            &[edge],
            &[[[-1.0, -0.5], [1.0, -0.5]]],
            // Towards each other, and one that branches.
            &[edge, [[0.0, -1.0], [0.0, -0.6]]],
            &[edge, [[0.0, -0.4], [1.0, -0.6]], [[0.0, -0.4], [-1.0, -0.6]]],
            // A cross, the same notch twice, and one along an edge.
            &[[[-1.0, -0.5], [1.0, -0.5]], [[0.0, -0.2], [0.0, -0.8]]],
            &[edge, edge, [[0.0, -0.2], [0.0, -0.6]]],
            &[[[-2.0, 0.0], [1.0, 0.0]], edge],
        ];
        for notches in cases {
            assert!(!cut(notches, SECTION), "{notches:?}");
        }
    }

    #[test]
    fn notches_from_edge_to_edge_and_round_a_part_cut() {
        let cases: [&[Segment]; 5] = [
            &[[[0.5, 0.0], [0.5, -1.0]]],
            // Off a corner.
            &[[[1.5, 0.0], [2.0, -0.5]]],
            &[[[0.0, 0.0], [0.0, -0.6]], [[0.0, -1.0], [0.0, -0.6]]],
            &[[[0.0, 0.0], [0.2, -0.6]], [[-0.2, -1.0], [0.3, -0.4]]],
            // A triangle within.
            &[[[-1.0, -0.8], [1.0, -0.8]], [[1.0, -0.8], [0.0, -0.2]], [[0.0, -0.2], [-1.0, -0.8]]],
        ];
        for notches in cases {
            assert!(cut(notches, SECTION), "{notches:?}");
        }
    }
}
