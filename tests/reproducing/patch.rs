//! Constant stresses balance: the integration constraint and the linear patch test.

use impinge::space::{
    Form, Integration, Mesh, Refused, Reproducing, Shape, Side, Sides, Space, reproducing,
};

use super::linear::{
    Elastic, Essential, Random, body_force, elasticity, errors, perturb, prescribe, pull,
};

const NODAL: [Integration; 2] = [Integration::Scni, Integration::Nsni];
const BASES: [(usize, f64); 2] = [(1, 1.75), (2, 2.75)];

fn space(mesh: &Mesh, basis: usize, support: f64, integration: Integration) -> Space {
    reproducing(mesh, Reproducing { basis, support, integration, ..Reproducing::default() })
        .unwrap()
}

/// Meshes without planes of symmetry, and rings.
fn whole() -> Vec<Mesh> {
    vec![
        Mesh::of_box(Form::Plane, [0.0; 3], [1.0, 0.0, 1.0], [6, 0, 6]),
        Mesh::of_ball(Form::Plane, 1.0, 3, 3, [false; 2]),
        Mesh::of_box(Form::Axisymmetric, [0.4, 0.0, -1.0], [1.4, 0.0, 0.0], [6, 0, 5]),
        Mesh::of_box(Form::Axisymmetric, [0.0, 0.0, -1.0], [1.0, 0.0, 0.0], [5, 0, 5]),
        Mesh::of_ball(Form::Axisymmetric, 1.0, 3, 3, [true, false]),
        Mesh::of_box(Form::Solid, [0.0; 3], [1.0; 3], [4, 4, 4]),
        Mesh::of_ball(Form::Solid, 1.0, 1, 2, [false; 2]),
    ]
}

fn halved() -> Vec<Mesh> {
    vec![
        Mesh::of_ball(Form::Plane, 1.0, 3, 3, [true, false]),
        Mesh::of_ball(Form::Solid, 1.0, 2, 2, [true, true]),
    ]
}

/// Largest remainder of Σ w (q ∇Ψ_I + Ψ_I ∇q) = Σ q Ψ_I n over volume and boundary, over the sum of the sizes of its
/// terms, where q is 1 or a coordinate. In rings the radial gradient has Ψ/r.
fn imbalance(space: &Space, coordinate: Option<usize>) -> f64 {
    let ring = space.form == Form::Axisymmetric;
    let q = |at: [f64; 3]| coordinate.map_or(1.0, |k| at[k]);
    let mut sums = vec![[0.0; 3]; space.nodes.len()];
    let mut sizes = vec![0.0; space.nodes.len()];
    let mut add = |node: u32, vector: [f64; 3]| {
        for (sum, x) in sums[node as usize].iter_mut().zip(vector) {
            *sum += x;
            sizes[node as usize] += x.abs();
        }
    };
    for p in 0..space.volume.len() {
        let (at, w) = (space.volume.at[p], space.volume.weights[p]);
        for value in space.volume.row(p) {
            let mut vector = value.gradient.map(|x| w * q(at) * x);
            if ring {
                vector[0] += w * value.value / at[0];
            }
            if let Some(k) = coordinate {
                vector[k] += w * value.value;
            }
            add(value.node, vector);
        }
    }
    let boundary = &space.boundary.samples;
    for p in 0..boundary.len() {
        let flux = q(boundary.at[p]) * boundary.weights[p];
        for value in boundary.row(p) {
            add(value.node, space.boundary.normals[p].map(|n| -flux * value.value * n));
        }
    }
    let mut largest = 0.0_f64;
    for (n, (sum, size)) in sums.iter().zip(&sizes).enumerate() {
        for &k in space.form.axes() {
            // The surface lacks the axis, where nodes have no radial displacement.
            if !(ring && k == 0 && space.nodes[n][0] == 0.0) {
                largest = largest.max(sum[k].abs() / size);
            }
        }
    }
    largest
}

#[test]
fn divergence_theorem_in_sums() {
    for mut mesh in whole() {
        perturb(&mut mesh, 0.25);
        for (basis, support) in BASES {
            for integration in NODAL {
                let space = space(&mesh, basis, support, integration);
                let mut weights = vec![None];
                if integration == Integration::Nsni && mesh.form != Form::Axisymmetric {
                    weights.extend(mesh.form.axes().iter().map(|&k| Some(k)));
                }
                for weight in weights {
                    let found = imbalance(&space, weight);
                    assert!(
                        found < 1e-13,
                        "{:?} {basis} {integration:?} {weight:?} {found:e}",
                        mesh.form
                    );
                }
            }
        }
    }
}

/// Relative error in L2 of the displacement under a linear one that Nitsche's method prescribes on the boundary.
fn error(
    mesh: &Mesh,
    basis: usize,
    support: f64,
    integration: Integration,
    symmetric: bool,
) -> f64 {
    let space = space(mesh, basis, support, integration);
    let young = 3e7;
    let c = Elastic::strain(young, 0.3);
    let gradient = match (mesh.form, symmetric) {
        (Form::Plane, false) => [[0.2, 0.0, 0.3], [0.0; 3], [0.1, 0.0, 0.4]],
        (Form::Solid, false) => [[0.2, 0.1, 0.3], [-0.2, 0.1, 0.2], [0.1, -0.3, 0.4]],
        (Form::Axisymmetric, _) => [[0.2, 0.0, 0.0], [0.0; 3], [0.0, 0.0, 0.4]],
        (_, true) => [[0.2, 0.0, 0.0], [0.0, 0.3, 0.0], [0.0, 0.0, 0.4]],
    };
    let shift = if symmetric { [0.0, 0.0, 0.1] } else { [0.2, -0.1, 0.1] };
    let linear = |x: [f64; 3]| {
        [0, 1, 2].map(|a| {
            let sum = (0..3).map(|b| gradient[a][b] * x[b]).sum::<f64>();
            if mesh.form.axes().contains(&a) { sum + shift[a] } else { 0.0 }
        })
    };
    let mut system = elasticity(&space, c);
    let penalty = if basis == 1 { 100.0 } else { 400.0 } * young;
    prescribe(&mut system, &space, c, Essential::Nitsche(penalty), |_| true, linear);
    let axes = mesh.form.axes();
    system.fix(|i| {
        let (node, a) = (i / axes.len(), axes[i % axes.len()]);
        (symmetric && a < 2 && mesh.nodes[node][a] == 0.0).then_some(0.0)
    });
    let fine = self::space(mesh, basis, support, Integration::Gauss(2));
    errors(mesh.form, &fine.volume, &system.solve(), linear, |_| gradient)[0]
}

#[test]
fn linear_displacements_are_exact_with_nodal_integration() {
    let cases = whole().into_iter().map(|mesh| (mesh.form == Form::Axisymmetric, mesh));
    for (symmetric, mut mesh) in cases.chain(halved().into_iter().map(|mesh| (true, mesh))) {
        perturb(&mut mesh, 0.25);
        for (basis, support) in BASES {
            for integration in NODAL {
                let error = error(&mesh, basis, support, integration, symmetric);
                // Rounding grows with the condition of the stiffness of wide supports.
                let limit = if basis == 1 { 2e-13 } else { 5e-12 };
                assert!(error < limit, "{:?} {basis} {integration:?} {error:e}", mesh.form);
            }
        }
    }
}

/// Stresses that are linear balance a constant force, as stabilised points obey the divergence theorem with linear
/// weights.
#[test]
fn quadratic_displacements_are_exact_with_stabilised_points() {
    for mut mesh in whole().into_iter().filter(|mesh| mesh.form != Form::Axisymmetric) {
        perturb(&mut mesh, 0.25);
        let axes = mesh.form.axes();
        let mut random = Random::new();
        // u_a = Σ Q_abc x_b x_c.
        let mut q = [[[0.0; 3]; 3]; 3];
        for &a in axes {
            for &b in axes {
                for &c in axes.iter().filter(|&&c| c <= b) {
                    q[a][b][c] = random.next();
                    q[a][c][b] = q[a][b][c];
                }
            }
        }
        let twice = |f: &dyn Fn(usize) -> f64| 2.0 * (0..3).map(f).sum::<f64>();
        let gradient =
            |x: [f64; 3]| [0, 1, 2].map(|a| [0, 1, 2].map(|b| twice(&|c| q[a][b][c] * x[c])));
        let exact = |x: [f64; 3]| {
            let slope = gradient(x);
            [0, 1, 2].map(|a| 0.5 * (0..3).map(|b| slope[a][b] * x[b]).sum::<f64>())
        };
        let c = Elastic::strain(1.0, 0.3);
        let force = [0, 1, 2]
            .map(|a| -(c.lambda + c.mu) * twice(&|b| q[b][b][a]) - c.mu * twice(&|b| q[a][b][b]));
        let space = space(&mesh, 2, 2.75, Integration::Nsni);
        let mut system = elasticity(&space, c);
        body_force(&mut system, &space, |_| force);
        prescribe(&mut system, &space, c, Essential::Nitsche(400.0), |_| true, exact);
        let fine = self::space(&mesh, 2, 2.75, Integration::Gauss(2));
        let [error, _] = errors(mesh.form, &fine.volume, &system.solve(), exact, gradient);
        assert!(error < 5e-12, "{:?} {error:e}", mesh.form);
    }
}

/// Nodes of held sides prescribe displacements without a method for the boundary.
#[test]
fn held_sides_prescribe_linear_displacements() {
    for (form, high) in [(Form::Plane, [1.0, 0.0, 1.0]), (Form::Solid, [1.0; 3])] {
        let mut mesh = Mesh::of_box(form, [0.0; 3], high, [4; 3]);
        perturb(&mut mesh, 0.25);
        let gradient = [[0.2, 0.1, 0.3], [-0.2, 0.1, 0.2], [0.1, -0.3, 0.4]];
        let axes = form.axes();
        let gradient = [0, 1, 2].map(|a| {
            [0, 1, 2]
                .map(|b| if axes.contains(&a) && axes.contains(&b) { gradient[a][b] } else { 0.0 })
        });
        let exact = |x: [f64; 3]| [0, 1, 2].map(|a| (0..3).map(|b| gradient[a][b] * x[b]).sum());
        let c = Elastic::strain(1.0, 0.3);
        let stress = c.stress_of(gradient);
        for (basis, support) in BASES {
            let held = Sides::of(&[Side::Bottom, Side::Top, Side::Left]);
            let settings = Reproducing { basis, support, held, ..Reproducing::default() };
            let space = reproducing(&mesh, settings).unwrap();
            let mut system = elasticity(&space, c);
            pull(
                &mut system,
                &space,
                |side| !held.contains(side),
                |_, normal| [0, 1, 2].map(|a| (0..3).map(|b| stress[a][b] * normal[b]).sum()),
            );
            system.fix(|i| {
                let at = mesh.nodes[i / axes.len()];
                let is_held = at[0] == 0.0 || at[2] == 0.0 || at[2] == 1.0;
                is_held.then(|| exact(at)[axes[i % axes.len()]])
            });
            let fine = Reproducing { integration: Integration::Gauss(2), ..settings };
            let fine = reproducing(&mesh, fine).unwrap();
            let [error, _] = errors(form, &fine.volume, &system.solve(), exact, |_| gradient);
            assert!(error < 2e-13, "{form:?} {basis} {error:e}");
        }
    }
    // Corners of three held sides have one function, and all nodes functions that sum to 1.
    let sides = [Side::Left, Side::Right, Side::Front, Side::Back, Side::Bottom, Side::Top];
    let mesh = Mesh::of_box(Form::Solid, [0.0; 3], [1.0; 3], [2; 3]);
    for shape in [Shape::Box, Shape::Round] {
        let settings =
            Reproducing { held: Sides::of(&sides), shape, support: 2.5, ..Reproducing::default() };
        let at_nodes = reproducing(&mesh, settings).unwrap().at_nodes.unwrap();
        for node in 0..mesh.nodes.len() {
            let sum: f64 = at_nodes.row(node).iter().map(|value| value.value).sum();
            assert!((sum - 1.0).abs() < 1e-13, "{shape:?} {node} {sum}");
        }
    }
    let mesh = Mesh::of_ball(Form::Plane, 1.0, 2, 2, [false; 2]);
    let settings = Reproducing { held: Sides::of(&[Side::Round]), ..Reproducing::default() };
    assert!(matches!(reproducing(&mesh, settings), Err(Refused::Setting(_))));
}

/// Gauss points miss the integration constraint (Chen, Wu, Yoon & You 2001).
#[test]
fn linear_displacements_are_not_exact_with_gauss_points() {
    let mut mesh = Mesh::of_box(Form::Plane, [0.0; 3], [1.0, 0.0, 1.0], [6, 0, 6]);
    perturb(&mut mesh, 0.25);
    let [coarse, fine] = [2, 6].map(|n| error(&mesh, 1, 1.75, Integration::Gauss(n), false));
    assert!((1e-5..1e-1).contains(&coarse) && fine < 0.3 * coarse, "{coarse:e} {fine:e}");
}
