//! Vibrations of free bodies: rigid motions are the only ones without energy, and none has too little.

use impinge::space::{Form, Integration, Mesh, Reproducing, Space, finite_elements, reproducing};

use super::linear::{Elastic, System, displacements, elasticity, generalised, perturb};

/// Ascending squared frequencies, with the mass of `mass`.
fn frequencies(space: &Space, mass: &Space) -> Vec<f64> {
    let stiffness = elasticity(space, Elastic::strain(1.0, 0.3));
    let mut system = System::of(stiffness.right.len());
    for p in 0..mass.volume.len() {
        let u = displacements(mass.form, mass.volume.row(p));
        system.add(mass.volume.weights[p], &u, &u);
    }
    generalised(&stiffness.matrix, &system.matrix)
}

#[test]
fn no_modes_without_energy_but_rigid_ones() {
    for (mut mesh, rigid) in [
        (Mesh::of_box(Form::Plane, [0.0; 3], [1.0, 0.0, 1.0], [6, 0, 6]), 3),
        (Mesh::of_ball(Form::Plane, 1.0, 3, 3, [false; 2]), 3),
        (Mesh::of_ball(Form::Axisymmetric, 1.0, 3, 3, [true, false]), 1),
        (Mesh::of_box(Form::Solid, [0.0; 3], [1.0; 3], [4, 4, 4]), 6),
    ] {
        perturb(&mut mesh, 0.25);
        let elements = finite_elements(&mesh);
        let expected = frequencies(&elements, &elements)[rigid];
        for (basis, support) in [(1, 1.75), (2, 2.5)] {
            let of = |integration: Integration| {
                let settings =
                    Reproducing { basis, support, integration, ..Reproducing::default() };
                reproducing(&mesh, settings).unwrap()
            };
            let mass = of(Integration::Gauss(5));
            let gauss = frequencies(&mass, &mass);
            for (integration, part) in [(Integration::Scni, 0.6), (Integration::Nsni, 0.97)] {
                let found = frequencies(&of(integration), &mass);
                let zero = found.iter().filter(|&&x| x.abs() < 1e-8 * expected).count();
                assert_eq!(
                    zero,
                    rigid,
                    "{:?} {basis} {integration:?} {:?}",
                    mesh.form,
                    &found[..8]
                );
                // The first modes, beside those of Gauss points and of finite elements.
                for k in rigid..rigid + 6 {
                    let ratio = found[k] / gauss[k];
                    assert!((part..1.0001).contains(&ratio), "{basis} {integration:?} {k} {ratio}");
                }
                assert!(found[rigid] > 0.75 * expected && found[rigid] < expected);
            }
        }
    }
}
