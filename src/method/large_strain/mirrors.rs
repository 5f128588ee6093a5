//! Planes of symmetry and axes, at x = 0 and y = 0, which mirror a body that is modelled on their positive side.

use super::{Deformable, Failure};
use crate::space::Form;

/// Axes along which a node is at rest: those that the model lacks, and normals of planes in which it lies.
pub fn fixed(form: Form, mirrored: [bool; 2], at: [f64; 3]) -> [bool; 3] {
    let in_plane = |axis: usize| mirrored[axis] && at[axis] == 0.0;
    [in_plane(0), form != Form::Solid || in_plane(1), false]
}

/// Refuses coefficients u of displacements that take a node through a plane of symmetry or an axis.
pub fn stay_beside_mirrors(body: &Deformable, u: &[[f64; 3]]) -> Result<(), Failure> {
    through_mirror(body, u).map_or(Ok(()), |at| Err(Failure::Mirrored { at }))
}

/// Finds a node that coefficients u of displacements take through a plane of symmetry or an axis: two stretches that
/// change their signs leave the dilatation positive.
pub fn through_mirror(body: &Deformable, u: &[[f64; 3]]) -> Option<[f64; 3]> {
    if body.mirrored == [false; 2] {
        return None;
    }
    let moved = body.displacements(u);
    let is_through = |at: &[f64; 3], u: &[f64; 3]| {
        (0..2).any(|a| body.mirrored[a] && at[a] > 0.0 && at[a] + u[a] < 0.0)
    };
    let through = body.space.nodes.iter().zip(&moved).find(|(at, u)| is_through(at, u));
    through.map(|(&at, _)| at)
}
