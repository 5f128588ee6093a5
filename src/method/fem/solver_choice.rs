//! How displacements are found: by a factor of stiffness or by conjugate gradients, and what that takes.

use super::brick_solver::BrickSolver;
use crate::laws::Thermoelastic;
use crate::method::mesh::{Geometry, Mesh};

/// Entries of the factor of a solid mesh per unknown^(4/3), and of a meridian section per
/// unknown · log₂(unknowns), measured on the example scenes.
const ENTRIES_3D: f64 = 21.0;
const ENTRIES_2D: f64 = 3.1;

/// About how many entries the factor of so many unknowns has.
pub fn expected_entries(geometry: Geometry, unknowns: usize) -> f64 {
    let n = unknowns as f64;
    match geometry {
        _ if unknowns == 0 => 0.0,
        Geometry::Axisymmetric => ENTRIES_2D * n * n.log2(),
        Geometry::Box => ENTRIES_3D * n.powf(4.0 / 3.0),
    }
}

/// Memory that it takes to factor so many unknowns, most of which the factor keeps [B].
pub fn factor_memory(geometry: Geometry, unknowns: usize) -> f64 {
    8.0 * (1.2 * expected_entries(geometry, unknowns) + 60.0 * unknowns as f64)
}

/// Unknowns of a box from which on conjugate gradients are taken: there a factor takes half a second more to make and a
/// sixtieth less a reading, and both are slower from twice as many on.
const MANY: usize = 20_000;
/// Poisson's ratio up to which they need few iterations.
const MOST_POISSON: f64 = 0.45;
/// Ratio of Young's moduli of layers up to which they need up to half as many more: the preconditioner knows the layers
/// of each component, not how they couple.
const MOST_CONTRAST: f64 = 1e4;
/// Ratio of lengths along x and y that are equal to rounding.
const EQUAL: f64 = 1.0 + 1e-6;
/// Length along x or y over the least length up to which linear bricks on unequal lengths need few: the preconditioner
/// knows their enhanced strains on equal lengths only, and misses more the flatter they are. At that ratio they need 130,
/// at ten times that 700, which is still less than a factor of so many unknowns.
const FLATTEST: f64 = 50.0;
const FLATTEST_OF_MANY: f64 = 500.0;
const TOO_MANY_TO_FACTOR: usize = 400_000;
const FLAT: &str = "linear elements of unequal lengths along the surface and many times as long as thick (few with `order = 2`)";

/// Whether a body is one for conjugate gradients.
pub fn suits_conjugate_gradients(mesh: &Mesh, laws: &[Thermoelastic]) -> bool {
    is_large_box(mesh) && reason_for_factor(mesh, laws).is_none()
}

/// How the displacements of a large box are found, and why; nothing of other bodies, whose factors take little.
pub fn note_on_solver(mesh: &Mesh, laws: &[Thermoelastic]) -> Option<String> {
    is_large_box(mesh).then(|| match reason_for_factor(mesh, laws) {
        None if mesh.order() == 1 && is_unequal_and_flat(mesh, FLATTEST) => format!(
            "displacements follow from conjugate gradients, which take many iterations, longer than is forecast, with {FLAT}"
        ),
        None => "displacements follow from conjugate gradients: nothing is factored".into(),
        Some(reason) => {
            format!("stiffness is factored: conjugate gradients would take many iterations with {reason}")
        }
    })
}

fn is_large_box(mesh: &Mesh) -> bool {
    mesh.geometry == Geometry::Box && mesh.nodes().saturating_mul(3) >= MANY
}

fn reason_for_factor(mesh: &Mesh, laws: &[Thermoelastic]) -> Option<&'static str> {
    if laws.iter().any(|law| law.poisson > MOST_POISSON) {
        return Some("a Poisson's ratio above 0.45");
    }
    let moduli = laws.iter().map(|law| law.young);
    let [least, most] = moduli.fold([f64::INFINITY, 0.0_f64], |[l, m], e| [l.min(e), m.max(e)]);
    if most > MOST_CONTRAST * least {
        return Some("layers whose Young's moduli differ more than 1:10 000");
    }
    let flattest = match mesh.nodes().saturating_mul(3) > TOO_MANY_TO_FACTOR {
        true => FLATTEST_OF_MANY,
        false => FLATTEST,
    };
    (mesh.order() == 1 && is_unequal_and_flat(mesh, flattest)).then_some(FLAT)
}

/// Whether elements have unequal lengths along x or y, the longest so many times the least length of all.
fn is_unequal_and_flat(mesh: &Mesh, flattest: f64) -> bool {
    let lengths = mesh.axes.each_ref().map(|axis| {
        let lengths = axis.nodes.windows(2).map(|pair| pair[1] - pair[0]);
        lengths.fold([f64::INFINITY, 0.0_f64], |[least, most], h| [least.min(h), most.max(h)])
    });
    let [x, y, z] = lengths;
    let longest = x[1].max(y[1]);
    let is_unequal = [x, y].iter().any(|[least, most]| *most > EQUAL * least);
    is_unequal && longest > flattest * x[0].min(y[0]).min(z[0])
}

/// Memory that the solver of one symmetry class takes [B].
pub fn solver_memory(mesh: &Mesh, laws: &[Thermoelastic]) -> f64 {
    let unknowns = mesh.nodes().saturating_mul(mesh.geometry.degrees());
    match suits_conjugate_gradients(mesh, laws) {
        true => BrickSolver::memory(mesh.order(), unknowns),
        false => factor_memory(mesh.geometry, unknowns),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::method::mesh::{Axis, Layering, Weight};

    fn plate(order: usize, growth: f64, thickness: f64) -> Mesh {
        let axis = |length: f64, growth: f64| {
            let mut ends = vec![0.0];
            (0..20).for_each(|e| ends.push(ends[e] + growth.powi(e as i32)));
            let scale = length / ends[20];
            ends.iter_mut().for_each(|end| *end *= scale);
            Axis::from_element_ends(&ends, order, Weight::Uniform)
        };
        let axes = [axis(1.0, growth), axis(1.0, growth), axis(thickness, 1.0)];
        Mesh { axes, mirrored: [false; 2], geometry: Geometry::Box, layering: Layering::default() }
    }

    #[test]
    fn flat_linear_elements_of_unequal_lengths_are_factored() {
        let law = [Thermoelastic { young: 2e11, poisson: 0.3, expansion: 1e-5 }];
        for (order, growth, thickness, suits) in
            [(1, 1.0, 1e-3, true), (1, 1.1, 1.0, true), (1, 1.1, 0.01, false), (2, 1.1, 0.01, true)]
        {
            let mesh = plate(order, growth, thickness);
            let found = suits_conjugate_gradients(&mesh, &law);
            assert_eq!(found, suits, "order {order}, growth {growth}, thickness {thickness}");
        }
    }
}
