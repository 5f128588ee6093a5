//! The cantilever of Timoshenko & Goodier: deflection of its end and stresses at its middle.
//!
//! Nodes, supports and multipliers are those of Petersson (2007), An implementation of mesh free methods for
//! mechanical problems at large strains, M.Sc. thesis, Lund University, tables 3.1 and 4.1, whose own errors level out
//! near 0.5 %; the expected numbers are an independent program's.

use impinge::space::{
    Form, Functions, Integration, Kernel, Mesh, Reproducing, Row, Shape, Side, Space, Value,
    finite_elements, particles, reproducing,
};

use super::closed_forms::Cantilever;
use super::linear::{
    Elastic, Essential, System, displacements, elasticity, perturb, prescribe, pull, strains,
};

const BEAM: Cantilever =
    Cantilever { length: 48.0, height: 12.0, young: 3e7, poisson: 0.3, force: -1000.0 };

fn elastic() -> Elastic {
    Elastic::plane_stress(BEAM.young, BEAM.poisson)
}

fn mesh(nx: usize, nz: usize) -> Mesh {
    let half = BEAM.height / 2.0;
    Mesh::of_box(Form::Plane, [0.0, 0.0, -half], [BEAM.length, 0.0, half], [nx - 1, 0, nz - 1])
}

fn loaded(space: &Space) -> System {
    let mut system = elasticity(space, elastic());
    pull(&mut system, space, |side| side == Side::Right, |x, _| BEAM.end_traction(x));
    system
}

/// Coefficients with the root held by multipliers that are linear between its nodes.
fn with_multipliers(space: &Space, nz: usize) -> Vec<f64> {
    let mut system = loaded(space).bordered(2 * nz);
    let boundary = &space.boundary.samples;
    for p in (0..boundary.len()).filter(|&p| space.boundary.sides[p] == Side::Left) {
        let at = boundary.at[p];
        let place = (at[2] / BEAM.height + 0.5) * (nz - 1) as f64;
        let (before, part) = (place.floor() as usize, place.fract());
        let mut hats = Vec::new();
        for (n, hat) in [(before, 1.0 - part), (before + 1, part)] {
            hats.push((2 * (space.nodes.len() + n), [hat, 0.0, 0.0]));
            hats.push((2 * (space.nodes.len() + n) + 1, [0.0, 0.0, hat]));
        }
        let u = displacements(space.form, boundary.row(p));
        system.add(boundary.weights[p], &u, &hats);
        system.add(boundary.weights[p], &hats, &u);
        system.load(boundary.weights[p], &hats, BEAM.displacement(at));
    }
    system.solve()
}

fn with_nitsche(space: &Space, nx: usize, basis: usize) -> Vec<f64> {
    let mut system = loaded(space);
    let factor = if basis == 1 { 10.0 } else { 30.0 };
    let penalty = Essential::Nitsche(factor * BEAM.young * (nx - 1) as f64 / BEAM.length);
    let root = |side| side == Side::Left;
    prescribe(&mut system, space, elastic(), penalty, root, |x| BEAM.displacement(x));
    system.solve()
}

/// (u_exact − u)/u of the end [%].
fn tip_error(mesh: &Mesh, settings: Reproducing, d: &[f64]) -> f64 {
    let functions = Functions::of(mesh, settings).unwrap();
    let at = [BEAM.length, 0.0, 0.0];
    let mut row = Row::default();
    functions.evaluate(at, false, &mut row).unwrap();
    let u: f64 = row.values().map(|value| value.value * d[2 * value.node as usize + 1]).sum();
    100.0 * (BEAM.displacement(at)[2] - u) / u
}

#[test]
fn multipliers_with_wide_supports() {
    let quartic = Reproducing {
        kernel: Kernel::QuarticSpline,
        integration: Integration::Gauss(8),
        ..Reproducing::default()
    };
    let round = Reproducing {
        shape: Shape::Round,
        support: 2.0,
        integration: Integration::Gauss(16),
        ..quartic
    };
    for (nx, nz, efg, four, two) in [
        (7, 5, 0.5689, 0.0463, 0.7773),
        (11, 5, 0.1112, 0.0252, 0.2396),
        (16, 7, 0.0405, 0.0045, 0.0751),
    ] {
        let mesh = mesh(nx, nz);
        let error = |settings: Reproducing| {
            tip_error(
                &mesh,
                settings,
                &with_multipliers(&reproducing(&mesh, settings).unwrap(), nz),
            )
        };
        let found = [
            error(round),
            error(Reproducing { support: 4.0, ..quartic }),
            error(Reproducing { support: 2.0, ..quartic }),
        ];
        for (found, expected) in found.into_iter().zip([efg, four, two]) {
            assert!((found - expected).abs() < 3e-4, "{nx} x {nz}: {found} {expected}");
        }
    }
}

#[test]
fn nodal_integration() {
    // Smoothing over whole cells makes bending too soft; stabilised points are as stiff as Gauss points.
    for (nx, nz, smoothed, stabilised, quadratic) in [
        (7, 5, 5.7, 1.7, 0.04),
        (11, 5, 5.3, 0.54, 0.011),
        (16, 7, 2.6, 0.18, 1e-3),
        (30, 14, 0.6, 0.028, 1e-4),
    ] {
        let mesh = mesh(nx, nz);
        let error = |basis: usize, support: f64, integration: Integration| {
            let settings = Reproducing { basis, support, integration, ..Reproducing::default() };
            tip_error(
                &mesh,
                settings,
                &with_nitsche(&reproducing(&mesh, settings).unwrap(), nx, basis),
            )
        };
        let found = [
            error(1, 1.75, Integration::Scni),
            error(1, 1.75, Integration::Nsni),
            error(2, 2.5, Integration::Nsni),
            error(1, 1.75, Integration::Gauss(4)),
        ];
        println!("cantilever, nodal, {nx} x {nz}: {found:?}");
        let limits = [smoothed, stabilised, quadratic];
        assert!(found.iter().zip(limits).all(|(found, limit)| found.abs() < limit), "{found:?}");
        assert!(found[1].abs() < found[3].abs(), "{found:?}");
    }
}

/// The finest nodes of the source, whose own errors are 0.52 to 0.56 %.
#[test]
fn nodal_integration_of_many_nodes() {
    let mesh = mesh(60, 29);
    for (basis, support, integration, limit) in [
        (1, 1.75, Integration::Scni, 0.14),
        (1, 1.75, Integration::Nsni, 0.005),
        (2, 2.5, Integration::Nsni, 1e-5),
    ] {
        let settings = Reproducing { basis, support, integration, ..Reproducing::default() };
        let space = reproducing(&mesh, settings).unwrap();
        let found = tip_error(&mesh, settings, &with_nitsche(&space, 60, basis));
        println!("cantilever, 60 x 29, basis {basis}, {integration:?}: {found}");
        assert!(found.abs() < limit, "{basis} {integration:?}: {found}");
    }
}

/// Deflection of the middle of the end, whose nodes have displacements as coefficients: (u_exact − u)/u [%].
fn error_at_nodes(space: &Space, nz: usize) -> f64 {
    let d = with_multipliers(space, nz);
    let near =
        |at: &[f64; 3]| at[0] == BEAM.length && at[2].abs() < 0.51 * BEAM.height / (nz - 1) as f64;
    let middle: Vec<usize> = (0..space.nodes.len()).filter(|&n| near(&space.nodes[n])).collect();
    let of_node = |&n: &usize| BEAM.displacement(space.nodes[n])[2] / d[2 * n + 1] - 1.0;
    100.0 * middle.iter().map(of_node).sum::<f64>() / middle.len() as f64
}

/// Particles are too soft: on few nodes by less than elements are too stiff.
#[test]
fn smoothed_particles() {
    for (nx, nz, wanted, of_elements) in
        [(7, 5, -5.00, 17.78), (16, 7, -4.56, 3.09), (30, 14, -2.01, 0.81)]
    {
        let mesh = mesh(nx, nz);
        let found = error_at_nodes(&particles(&mesh, 2.2).unwrap(), nz);
        let elements = error_at_nodes(&finite_elements(&mesh), nz);
        assert!((found - wanted).abs() < 0.01, "{nx} x {nz}: {found}");
        assert!((elements - of_elements).abs() < 0.01, "{nx} x {nz}: {elements}");
    }
}

/// Root mean square errors of σ_xx, σ_zz and σ_xz at the middle of 30 × 14 irregular nodes, over the largest σ_xx
/// there.
#[test]
fn stresses_on_irregular_nodes() {
    let mut mesh = mesh(30, 14);
    perturb(&mut mesh, 0.3);
    for (basis, support, limit) in [(1, 1.75, 2e-2), (2, 2.5, 1e-3)] {
        let settings = Reproducing { basis, support, ..Reproducing::default() };
        let d = with_nitsche(&reproducing(&mesh, settings).unwrap(), 30, basis);
        let functions = Functions::of(&mesh, settings).unwrap();
        let mut squares = [0.0; 3];
        let mut row = Row::default();
        for n in 0..=60 {
            let at = [24.0, 0.0, -6.0 + 0.2 * n as f64];
            functions.evaluate(at, true, &mut row).unwrap();
            let values: Vec<Value> = row.values().collect();
            let mut e = [0.0; 6];
            for (n, unit) in strains(Form::Plane, at, &values) {
                (0..6).for_each(|k| e[k] += unit[k] * d[n]);
            }
            let stress = elastic().stress(e);
            let exact = BEAM.stress(at);
            for (square, k) in squares.iter_mut().zip([0, 2, 4]) {
                *square += (stress[k] - exact[k]).powi(2) / 61.0;
            }
        }
        let most = BEAM.stress([24.0, 0.0, -6.0])[0].abs();
        let errors = squares.map(|square| square.sqrt() / most);
        assert!(errors.iter().all(|&error| error < limit), "{errors:?}");
    }
}
