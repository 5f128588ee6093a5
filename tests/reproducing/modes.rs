//! Vibrations of free bodies: rigid motions are the only ones without energy, and none has too little.

use impinge::space::{
    Form, Integration, Mesh, Reproducing, Space, finite_elements, particles, reproducing,
};

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

/// Once more smoothed gradients of one point a node hardly resist short waves, down to none at all in rounding; what
/// they vary within cells does.
#[test]
fn second_smoothing_needs_what_gradients_vary_within_cells() {
    for (mesh, rigid, spacing, weak) in [
        (Mesh::of_box(Form::Plane, [0.0; 3], [1.0, 0.0, 1.0], [8, 0, 8]), 3, 0.125, 40),
        (Mesh::of_box(Form::Solid, [0.0; 3], [1.0; 3], [4, 4, 4]), 6, 0.25, 100),
    ] {
        let of = |integration: Integration, smoothing: Option<f64>| {
            let settings = Reproducing { integration, smoothing, ..Reproducing::default() };
            reproducing(&mesh, settings).unwrap()
        };
        let mass = of(Integration::Gauss(5), None);
        let first = frequencies(&mass, &mass)[rigid];
        for radius in [2.0, 3.0, 4.0] {
            let twice = |integration| frequencies(&of(integration, Some(radius * spacing)), &mass);
            let found = twice(Integration::Nsni);
            let zero = found.iter().filter(|&&x| x.abs() < 1e-8 * first).count();
            assert_eq!(zero, rigid, "{radius} {:?}", &found[..8]);
            assert!(found[rigid] > 0.35 * first, "{radius} {} {first}", found[rigid]);
            let below = twice(Integration::Scni).iter().filter(|&&x| x < 0.4 * first).count();
            assert!(radius < 3.0 || below > rigid + weak, "{radius} {below}");
        }
    }
}

/// One gradient a particle would leave dozens of modes without energy.
#[test]
fn particles_have_no_modes_without_energy_but_rigid_ones() {
    for (mut mesh, rigid, support) in [
        (Mesh::of_box(Form::Plane, [0.0; 3], [1.0, 0.0, 1.0], [6, 0, 6]), 3, 2.2),
        (Mesh::of_ball(Form::Plane, 1.0, 3, 3, [false; 2]), 3, 2.2),
        (Mesh::of_ball(Form::Axisymmetric, 1.0, 3, 3, [true, false]), 1, 2.2),
        (Mesh::of_box(Form::Solid, [0.0; 3], [1.0; 3], [3, 3, 3]), 6, 2.6),
        (Mesh::of_box(Form::Plane, [0.0; 3], [1.0, 0.0, 0.2], [5, 0, 1]), 3, 2.2),
        (Mesh::of_box(Form::Solid, [0.0; 3], [1.0, 0.3, 0.3], [3, 1, 1]), 6, 2.2),
    ] {
        perturb(&mut mesh, 0.25);
        let elements = finite_elements(&mesh);
        let expected = frequencies(&elements, &elements)[rigid];
        let found = frequencies(&particles(&mesh, support).unwrap(), &elements);
        let zero = found.iter().filter(|&&x| x.abs() < 1e-8 * expected).count();
        assert_eq!(zero, rigid, "{:?} {:?}", mesh.form, &found[..8]);
        // Uneven particles are soft: none is beyond what they lose at a few across.
        assert!(found[rigid] > 0.2 * expected, "{:?} {} {expected}", mesh.form, found[rigid]);
    }
}

/// Modes of regular particles are within 2 % of the exact ones from six of them across on, and finite elements 6 %
/// above.
#[test]
fn modes_of_particles_are_those_of_fine_elements() {
    let squares = [6, 12].map(|count| {
        let box_of = Mesh::of_box(Form::Plane, [0.0; 3], [1.0, 0.0, 1.0], [count, 0, count]);
        let elements = finite_elements(&box_of);
        [&particles(&box_of, 2.2).unwrap(), &elements].map(|space| frequencies(space, &elements)[3])
    });
    let exact = (4.0 * squares[1][1] - squares[0][1]) / 3.0;
    for [own, _] in squares {
        assert!((own / exact - 1.0).abs() < 0.02, "{own} {exact}");
    }
}
