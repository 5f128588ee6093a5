//! Loads on faces, split into the symmetry classes of a mesh.

use crate::method::mesh::Mesh;

/// Splits a load on a face into nodal vectors of the mesh's symmetry classes, in their order.
///
/// `of_image(image)` integrates shape functions of the meshed part against the load at the mirror image of each point.
/// `flips` contains the axes along which a mirror reverses the sign of the quantity: x for a traction along x, none for
/// heat. A class without load gets an empty vector.
pub fn split_load(
    mesh: &Mesh,
    flips: [bool; 2],
    of_image: impl Fn([bool; 2]) -> Vec<f64>,
) -> Vec<Vec<f64>> {
    let choices = |mirrored: bool| if mirrored { vec![false, true] } else { vec![false] };
    let mut images = Vec::new();
    for y in choices(mesh.mirrored[1]) {
        for x in choices(mesh.mirrored[0]) {
            images.push(([x, y], of_image([x, y])));
        }
    }
    let share = 1.0 / images.len() as f64;
    let part = |odd: [bool; 2]| {
        let mut sum = vec![0.0; images[0].1.len()];
        for (image, vector) in &images {
            let minus = (0..2).filter(|&a| image[a] && odd[a] != flips[a]).count() % 2 == 1;
            let factor = if minus { -share } else { share };
            for (s, v) in sum.iter_mut().zip(vector) {
                *s += factor * v;
            }
        }
        if sum.iter().all(|&v| v == 0.0) { Vec::new() } else { sum }
    };
    mesh.parities().into_iter().map(|parity| part(parity.odd)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::method::mesh::{Axis, Geometry, Layering, Weight};

    fn quarter() -> Mesh {
        let axis = Axis::from_element_ends(&[0.0, 1.0], 1, Weight::Uniform);
        Mesh {
            axes: [axis.clone(), axis.clone(), axis],
            mirrored: [true; 2],
            geometry: Geometry::Box,
            layering: Layering::default(),
        }
    }

    #[test]
    fn central_load_has_no_odd_part() {
        let parts = split_load(&quarter(), [false; 2], |_| vec![1.0; 4]);
        assert_eq!(parts, [vec![1.0; 4], vec![], vec![], vec![]]);
        let shear = split_load(&quarter(), [true, false], |_| vec![1.0; 4]);
        assert_eq!(shear, [vec![], vec![1.0; 4], vec![], vec![]]);
    }

    #[test]
    fn parts_sum_to_the_load_at_every_image() {
        let mesh = quarter();
        let value = |image: [bool; 2]| match image {
            [false, false] => 3.0,
            [true, false] => 1.0,
            [false, true] => -2.0,
            [true, true] => 0.5,
        };
        let parts = split_load(&mesh, [false; 2], |image| vec![value(image)]);
        for image in [[false, false], [true, false], [false, true], [true, true]] {
            let sum: f64 =
                mesh.parities().iter().zip(&parts).map(|(p, v)| p.sign(image) * v[0]).sum();
            assert!((sum - value(image)).abs() < 1e-15);
        }
    }
}
