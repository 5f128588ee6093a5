//! Choice between a factorised stiffness and conjugate gradients, with the memory of each.

use super::brick_solver::BrickSolver;
use crate::laws::Thermoelastic;
use crate::method::mesh::{Geometry, Mesh};

/// Entries of the factor of a solid mesh per unknown^(4/3), and of a meridian section per
/// unknown · log₂(unknowns), measured on the example scenes.
const ENTRIES_3D: f64 = 21.0;
const ENTRIES_2D: f64 = 3.1;

/// Estimates the number of entries of a factor of this many unknowns.
pub fn expected_entries(geometry: Geometry, unknowns: usize) -> f64 {
    let n = unknowns as f64;
    match geometry {
        _ if unknowns == 0 => 0.0,
        Geometry::Axisymmetric => ENTRIES_2D * n * n.log2(),
        Geometry::Box => ENTRIES_3D * n.powf(4.0 / 3.0),
    }
}

/// Memory to factor this many unknowns, most of which the factor keeps [B].
pub fn factor_memory(geometry: Geometry, unknowns: usize) -> f64 {
    8.0 * (1.2 * expected_entries(geometry, unknowns) + 60.0 * unknowns as f64)
}

/// Number of unknowns of a box from which on conjugate gradients are used. There a factor takes half a second longer to
/// make, and a reading a sixtieth less; with twice as many unknowns both are slower.
const MANY: usize = 20_000;
/// Poisson's ratio up to which conjugate gradients need few iterations.
const MOST_POISSON: f64 = 0.45;
/// Ratio of Young's moduli of layers up to which they need at most half as many more: the preconditioner includes the
/// layers of each component, but not their coupling.
const MOST_CONTRAST: f64 = 1e4;
/// Ratio of lengths along x and y that are equal to rounding.
const EQUAL: f64 = 1.0 + 1e-6;
/// Length along x or y over the least length up to which linear bricks of unequal lengths need few iterations. The
/// preconditioner includes their enhanced strains only for equal lengths, and misses more the flatter they are. At that
/// ratio they need 130 iterations, at ten times that 700, which is still less than a factor of so many unknowns.
const FLATTEST: f64 = 50.0;
const FLATTEST_OF_MANY: f64 = 500.0;
const TOO_MANY_TO_FACTOR: usize = 400_000;
const FLAT: &str = "linear elements of unequal lengths along the surface and many times as long as thick (few with `order = 2`)";

/// Returns true if conjugate gradients suit a body.
pub fn suits_conjugate_gradients(mesh: &Mesh, laws: &[Thermoelastic]) -> bool {
    is_large_box(mesh) && reason_for_factor(mesh, laws).is_none()
}

/// Notes the solver for the displacements of a large box, with the reason; `None` for other bodies, whose factors are
/// cheap.
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

/// Returns true if elements have unequal lengths along x or y, the longest this many times the least length of all.
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

/// Memory of the solver of one symmetry class [B].
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
