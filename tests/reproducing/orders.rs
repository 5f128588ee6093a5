//! Orders of convergence on smooth fields: n + 1 in L2 and n in H1 for bases of order n.

use impinge::space::{
    Form, Functions, Integration, Mesh, Reproducing, Row, Side, Sides, finite_elements, reproducing,
};

use super::closed_forms::{ring_waves_body_force, waves, widening_of_tube};
use super::linear::{Elastic, Essential, body_force, elasticity, errors, perturb, prescribe, pull};

/// Relative errors in L2 and H1 on a mesh of `n` cells along an edge or radius.
fn error(mut mesh: Mesh, n: usize, basis: usize, integration: Integration) -> [f64; 2] {
    let c = Elastic::strain(1.0, 0.3);
    perturb(&mut mesh, if integration == Integration::Scni { 0.0 } else { 0.25 });
    let support = if basis == 1 { 1.75 } else { 2.5 };
    let settings = Reproducing { basis, support, integration, ..Reproducing::default() };
    let space = reproducing(&mesh, settings).unwrap();
    let mut system = elasticity(&space, c);
    body_force(&mut system, &space, |x| match mesh.form {
        Form::Axisymmetric => ring_waves_body_force(x, c.lambda, c.mu),
        _ => waves::body_force(x, c.lambda, c.mu),
    });
    let penalty = if basis == 1 { 30.0 } else { 60.0 } * n as f64;
    prescribe(&mut system, &space, c, Essential::Nitsche(penalty), |_| true, waves::displacement);
    let is_half = mesh.nodes.iter().all(|x| x[0] >= 0.0);
    system.fix(|i| (is_half && i % 2 == 0 && mesh.nodes[i / 2][0] == 0.0).then_some(0.0));
    let d = system.solve();
    let fine = Reproducing { integration: Integration::Gauss(4), ..settings };
    let fine = reproducing(&mesh, fine).unwrap();
    errors(mesh.form, &fine.volume, &d, waves::displacement, waves::gradient)
}

fn square(n: usize) -> Mesh {
    Mesh::of_box(Form::Plane, [0.2, 0.0, -0.3], [1.2, 0.0, 0.9], [n, 0, n])
}

fn half_disc(n: usize) -> Mesh {
    Mesh::of_ball(Form::Plane, 1.0, n / 2, n / 2, [true, false])
}

fn cylinder(n: usize) -> Mesh {
    Mesh::of_box(Form::Axisymmetric, [0.0, 0.0, -0.3], [1.0, 0.0, 0.9], [n, 0, n])
}

fn ball(n: usize) -> Mesh {
    Mesh::of_ball(Form::Axisymmetric, 1.0, n / 2, n / 2, [true, false])
}

/// Mean orders from 6 to 24 cells.
fn orders(mesh: fn(usize) -> Mesh, basis: usize, integration: Integration) -> [f64; 2] {
    let [coarse, fine] = [6, 24].map(|n| error(mesh(n), n, basis, integration));
    let orders = [0, 1].map(|k| (coarse[k] / fine[k]).log2() / 2.0);
    println!("{basis} {integration:?} {coarse:?} {fine:?} {orders:?}");
    orders
}

#[test]
fn stabilised_points_on_irregular_nodes() {
    for mesh in [square, half_disc, cylinder, ball] {
        for basis in [1, 2] {
            let [l2, h1] = orders(mesh, basis, Integration::Nsni);
            assert!(l2 > basis as f64 + 0.8 && h1 > basis as f64 - 0.2, "{basis} {l2} {h1}");
        }
    }
}

/// Means over cells leave an error of second order, whatever the basis; only regular nodes keep the order of gradients.
#[test]
fn smoothed_points_on_regular_nodes() {
    for mesh in [square, cylinder] {
        for basis in [1, 2] {
            let [l2, h1] = orders(mesh, basis, Integration::Scni);
            assert!((1.9..2.1).contains(&l2) && h1 > 1.0, "{basis} {l2} {h1}");
        }
    }
}

#[test]
fn gauss_points_on_irregular_nodes() {
    let [l2, h1] = orders(square, 1, Integration::Gauss(5));
    assert!(l2 > 1.8 && h1 > 0.9, "{l2} {h1}");
    // Points are about as good as many of Gauss.
    let [gauss, nodal] =
        [Integration::Gauss(5), Integration::Nsni].map(|i| error(square(12), 12, 1, i));
    assert!((0..2).all(|k| nodal[k] < 1.05 * gauss[k]), "{nodal:?} {gauss:?}");
}

/// Linear and quadratic elements on a smoothly bent mesh, in a plane and in a ball's meridian, held at their boundary.
#[test]
fn elements_on_bent_meshes() {
    let bend =
        |[x, y, z]: [f64; 3]| [x + 0.06 * (3.0 * z).sin() * x, y, z + 0.05 * (4.0 * x).cos()];
    let square = |order: usize, n: usize| {
        let ends = [[0.2, 0.0, -0.3], [1.2, 0.0, 0.9]];
        Mesh::of_box_by((Form::Plane, order), ends[0], ends[1], [n, 0, n]).mapped(bend)
    };
    let ball = |order: usize, n: usize| {
        Mesh::of_ball_by((Form::Axisymmetric, order), 1.0, [n / 2, n / 2], [true, false])
    };
    let error = |mesh: Mesh| {
        let c = Elastic::strain(1.0, 0.3);
        let space = finite_elements(&mesh);
        let mut system = elasticity(&space, c);
        body_force(&mut system, &space, |x| match mesh.form {
            Form::Axisymmetric => ring_waves_body_force(x, c.lambda, c.mu),
            _ => waves::body_force(x, c.lambda, c.mu),
        });
        let outer: Vec<u32> = mesh.faces.iter().flat_map(|(_, face)| face.clone()).collect();
        system.fix(|i| {
            let (node, axis) = (i / 2, [0, 2][i % 2]);
            let is_on_axis = mesh.form == Form::Axisymmetric && mesh.nodes[node][0] == 0.0;
            if is_on_axis && axis == 0 {
                return Some(0.0);
            }
            outer.contains(&(node as u32)).then(|| waves::displacement(mesh.nodes[node])[axis])
        });
        errors(mesh.form, &space.volume, &system.solve(), waves::displacement, waves::gradient)
    };
    for order in [1, 2] {
        for mesh in [&square as &dyn Fn(usize, usize) -> Mesh, &ball] {
            let [coarse, fine] = [6, 24].map(|n| error(mesh(order, n)));
            let [l2, h1] = [0, 1].map(|k| (coarse[k] / fine[k]).log2() / 2.0);
            println!("order {order}: {coarse:?} {fine:?}, {l2} and {h1}");
            let wanted = order as f64;
            assert!(l2 > wanted + 0.8 && (h1 - wanted).abs() < 0.2, "{order}: {l2} {h1}");
        }
    }
}

/// A tube between held ends, under pressure inside.
#[test]
fn tube_under_pressure() {
    let (a, b) = (0.4, 1.0);
    for (integration, limit) in [(Integration::Scni, 4e-3), (Integration::Nsni, 2e-4)] {
        let mut mesh = Mesh::of_box(Form::Axisymmetric, [a, 0.0, 0.0], [b, 0.0, 0.5], [12, 0, 10]);
        perturb(&mut mesh, 0.2);
        let held = Sides::of(&[Side::Bottom, Side::Top]);
        let settings = Reproducing { integration, held, ..Reproducing::default() };
        let space = reproducing(&mesh, settings).unwrap();
        let mut system = elasticity(&space, Elastic::strain(1.0, 0.3));
        pull(&mut system, &space, |side| side == Side::Left, |_, normal| normal.map(|n| -n));
        let is_end = |node: usize| [0.0, 0.5].contains(&mesh.nodes[node][2]);
        system.fix(|i| (i % 2 == 1 && is_end(i / 2)).then_some(0.0));
        let d = system.solve();
        let mut row = Row::default();
        let functions = Functions::of(&mesh, settings).unwrap();
        functions.evaluate([a, 0.0, 0.23], false, &mut row).unwrap();
        let found: f64 = row.values().map(|value| value.value * d[2 * value.node as usize]).sum();
        let error = found / widening_of_tube(a, b, 1.0, 0.3) - 1.0;
        println!("tube {integration:?} {error:e}");
        assert!(error.abs() < limit, "{integration:?} {error:e}");
    }
}
