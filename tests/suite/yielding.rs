//! Bodies that yield: against closed forms, and what holds for all of them.

use std::f64::consts::TAU;

use impinge::closed_form::{Bilinear, YieldingCylinder};
use impinge::laws::{Elastoplastic, Thermoelastic, constant};
use impinge::method::fem::elastic::{ElasticProblem, ElasticSetup, Support};
use impinge::method::fem::{Axis, Geometry, Layering, Mesh, MeshFace, Weight};
use impinge::method::inelastic::{InelasticError, InelasticProblem};

const FREE_OF_STRESS: f64 = 300.0;

/// E, ν, α, σ_y, H_i, H_k of steel, aluminium, copper, soft lead, titanium and glass.
const MATERIALS: [[f64; 6]; 6] = [
    [210e9, 0.3, 12e-6, 250e6, 2e9, 0.0],
    [70e9, 0.33, 23e-6, 95e6, 0.0, 1e9],
    [120e9, 0.34, 17e-6, 70e6, 0.5e9, 0.5e9],
    [12e9, 0.44, 29e-6, 3e6, 0.0, 0.0],
    [115e9, 0.32, 9e-6, 880e6, 1e9, 2e9],
    [65e9, 0.2, 3e-6, 1e15, 0.0, 0.0],
];
const STEEL: [f64; 6] = MATERIALS[0];

fn thermoelastic([young, poisson, expansion, ..]: [f64; 6]) -> Thermoelastic {
    Thermoelastic { young, poisson, expansion }
}

fn law(material: [f64; 6]) -> Elastoplastic {
    let [.., yield_stress, isotropic, kinematic] = material;
    Elastoplastic {
        yield_stress: constant(yield_stress),
        isotropic: constant(isotropic),
        kinematic: constant(kinematic),
        ..Elastoplastic::elastic(&thermoelastic(material), FREE_OF_STRESS)
    }
}

fn even(from: f64, to: f64, count: usize) -> Vec<f64> {
    (0..=count).map(|i| from + (to - from) * i as f64 / count as f64).collect()
}

fn brick(ends: [Vec<f64>; 3], order: usize) -> Mesh {
    let axes = ends.map(|ends| Axis::from_element_ends(&ends, order, Weight::Uniform));
    Mesh { axes, mirrored: [false; 2], geometry: Geometry::Box, layering: Layering::default() }
}

fn section(r: &[f64], z: &[f64], order: usize) -> Mesh {
    let radius = Axis::from_element_ends(r, order, Weight::Radial);
    let height = Axis::from_element_ends(z, order, Weight::Uniform);
    let axes = [radius, Axis::point(), height];
    Mesh {
        axes,
        mirrored: [false; 2],
        geometry: Geometry::Axisymmetric,
        layering: Layering::default(),
    }
}

const fn roller(axis: usize, high: bool) -> (MeshFace, Support) {
    (MeshFace { axis, high }, Support::Roller)
}

/// Small bodies of both kinds and orders, with whether they are boxes.
fn small_bodies() -> Vec<(Mesh, bool)> {
    let mut all = Vec::new();
    for order in [1, 2] {
        let z = vec![0.0, 0.1, 0.3, 0.4];
        all.push((brick([even(0.0, 1.0, 3), even(0.0, 0.7, 2), z.clone()], order), true));
        all.push((section(&[0.0, 0.2, 0.5, 0.6], &z, order), false));
    }
    all
}

fn uniform(mesh: &Mesh, temperature: f64) -> Vec<f64> {
    vec![temperature; mesh.nodes()]
}

fn largest(values: &[f64]) -> f64 {
    values.iter().fold(0.0, |most, v| most.max(v.abs()))
}

#[test]
fn a_clamped_bar_and_film_go_the_bilinear_way_when_heated_and_cooled() {
    for material in MATERIALS {
        let [young, poisson, expansion, yield_stress, isotropic, kinematic] = material;
        for (mesh, is_box) in small_bodies() {
            let ends = [roller(2, false), roller(2, true)];
            let sides = if is_box {
                vec![roller(0, false), roller(0, true), roller(1, false), roller(1, true)]
            } else {
                vec![roller(0, true)]
            };
            let bar_sides = if is_box { vec![roller(0, false), roller(1, false)] } else { vec![] };
            let bar = Bilinear::bar(young, yield_stress, isotropic, kinematic);
            let film = Bilinear::film(young, poisson, yield_stress, isotropic, kinematic);
            // Plastic strain is accumulated as its part along the bar, or twice that in the film.
            for (exact, supports, component, share) in [
                (bar, [ends.to_vec(), bar_sides].concat(), 2, 1.0),
                (film, [sides, vec![roller(2, false)]].concat(), 0, 2.0),
            ] {
                let problem =
                    InelasticProblem::new(&mesh, vec![law(material)], &supports, 2).unwrap();
                let yields_at = yield_stress / (exact.modulus * expansion);
                // Glass never does.
                let first_yield = if yields_at > 1e4 { 200.0 } else { yields_at };
                let rises =
                    [0.9, 1.0, 1.5, 1.2, 2.5, 0.0, -0.3, 0.5].map(|part| part * first_yield);
                let strains = rises.map(|rise| -expansion * rise);
                let mut state = problem.initial_state();
                let (mut before, mut accumulated) = ([0.0; 2], 0.0);
                for (rise, wanted) in rises.into_iter().zip(exact.stresses(&strains)) {
                    let now = [-expansion * rise, wanted];
                    let [strain, stress] = [0, 1].map(|i| now[i] - before[i]);
                    accumulated += share * (strain - stress / exact.modulus).abs();
                    before = now;
                    let temperatures = uniform(&mesh, FREE_OF_STRESS + rise);
                    problem.advance(&mut state, &temperatures, &[]).unwrap();
                    let values = problem.nodal_values(&state, &temperatures).unwrap();
                    for stress in values.stress {
                        let off = (stress[component] - wanted).abs();
                        let scale = exact.modulus * expansion * first_yield;
                        assert!(
                            off < 1e-9 * scale,
                            "{young:e} at {rise}: {stress:?}, not {wanted}"
                        );
                        let other = largest(&stress[3..])
                            .max(stress[if component == 2 { 0 } else { 2 }].abs());
                        assert!(other < 1e-9 * scale, "{young:e}: {stress:?}");
                    }
                    let plastic = values.plastic_strain;
                    // What does not harden leaves strain to what is left of the forces.
                    let bound = 1e-8 * expansion * first_yield;
                    let off = plastic.iter().map(|p| (p - accumulated).abs()).fold(0.0, f64::max);
                    assert!(off < bound, "{young:e} at {rise}: {off:e} off {accumulated}");
                }
            }
        }
    }
}

/// A plate that is held flat, hotter by `rise` on its top and colder by that on its bottom, then even again.
#[test]
fn a_flat_plate_yields_from_its_faces_inwards() {
    let [young, poisson, expansion, yield_stress, ..] = STEEL;
    let exact = Bilinear::film(young, poisson, yield_stress, 2e9, 1e9);
    let material = [young, poisson, expansion, yield_stress, 2e9, 1e9];
    // The faces come to three times the strain of first yield, so back and half a yield stress beyond.
    let rise = 3.0 * yield_stress / (exact.modulus * expansion);
    let sides =
        [roller(0, false), roller(0, true), roller(1, false), roller(1, true), roller(2, false)];
    // Elements end where yield does: at a third of the half thickness, and when it is even again, at two thirds.
    let mesh = brick([even(0.0, 1.0, 2), even(0.0, 1.0, 1), even(-1.0, 1.0, 6)], 2);
    let height = |node: usize| mesh.axes[2].nodes[node / (mesh.axes[0].len() * mesh.axes[1].len())];
    let problem = InelasticProblem::new(&mesh, vec![law(material)], &sides, 2).unwrap();
    let mut state = problem.initial_state();
    let hot: Vec<f64> = (0..mesh.nodes()).map(|n| FREE_OF_STRESS + rise * height(n)).collect();
    let scale = yield_stress;
    for (n, temperatures) in [hot, uniform(&mesh, FREE_OF_STRESS)].iter().enumerate() {
        problem.advance(&mut state, temperatures, &[]).unwrap();
        let points = problem.points(&state, temperatures).unwrap();
        for (p, point) in points.iter().enumerate() {
            // Points of an element run x, y, then z, three each.
            let (element, level) = (p / 27 / 2, p % 27 / 9);
            let at = [-0.6f64.sqrt(), 0.0, 0.6f64.sqrt()][level];
            let z = -1.0 + (element as f64 + 0.5 * (1.0 + at)) / 3.0;
            let strain = -expansion * rise * z;
            let wanted = exact.stresses(&[strain, 0.0])[n];
            for component in 0..3 {
                let wanted = if component == 2 { 0.0 } else { wanted };
                let off = (point.stress[component] - wanted).abs();
                assert!(off < 1e-9 * scale, "{n} at {z}: {:?}, not {wanted}", point.stress);
            }
        }
    }
}

/// Nodal forces of a pressure on the inner face of a cylinder.
fn inner_pressure(mesh: &Mesh, pressure: f64) -> Vec<f64> {
    let along = mesh.axes[2].integrals();
    let mut forces = vec![0.0; 2 * mesh.nodes()];
    for (k, length) in along.iter().enumerate() {
        forces[2 * k * mesh.axes[0].len()] = pressure * TAU * mesh.axes[0].start() * length;
    }
    forces
}

const CYLINDER: YieldingCylinder = YieldingCylinder {
    shear: 210e9 / (2.0 * (1.0 + POISSON)),
    yield_stress: 250e6,
    inner: 0.1,
    outer: 0.2,
    front: 0.15,
};
const POISSON: f64 = 0.49999;

fn cylinder(elements: usize, order: usize) -> (Mesh, InelasticProblem) {
    let mesh = section(&even(0.1, 0.2, elements), &[0.0, 0.01], order);
    let law = law([210e9, POISSON, 0.0, 250e6, 0.0, 0.0]);
    let ends = [roller(2, false), roller(2, true)];
    let problem = InelasticProblem::new(&mesh, vec![law], &ends, 2).unwrap();
    (mesh, problem)
}

#[test]
fn a_thick_cylinder_yields_as_hill_found_and_nothing_locks() {
    for order in [1, 2] {
        let errors: Vec<f64> = [10, 20, 40]
            .into_iter()
            .map(|elements| {
                let (mesh, problem) = cylinder(elements, order);
                let mut state = problem.initial_state();
                let temperatures = uniform(&mesh, FREE_OF_STRESS);
                for part in [0.6, 0.8, 1.0] {
                    let forces = inner_pressure(&mesh, part * CYLINDER.pressure());
                    problem.advance(&mut state, &temperatures, &forces).unwrap();
                }
                let u = problem.displacement(&state);
                let displacement = mesh.axes[0]
                    .nodes
                    .iter()
                    .enumerate()
                    .map(|(i, &r)| (u[2 * i] / CYLINDER.radial_displacement(r) - 1.0).abs());
                let stress = problem.nodal_values(&state, &temperatures).unwrap().stress;
                // Away from the front, where the hoop stress has a kink.
                for (i, &r) in
                    mesh.axes[0].nodes.iter().enumerate().filter(|(_, r)| (*r - 0.15).abs() > 0.015)
                {
                    let wanted = [
                        CYLINDER.radial_stress(r),
                        CYLINDER.hoop_stress(r),
                        CYLINDER.axial_stress(r),
                    ];
                    for (found, wanted) in stress[i].iter().zip(wanted) {
                        let off = (found - wanted).abs() / 250e6;
                        assert!(
                            elements < 40 || off < 4e-3,
                            "order {order} at {r}: {found:e} {wanted:e}"
                        );
                    }
                }
                displacement.fold(0.0, f64::max)
            })
            .collect();
        println!("order {order}: {errors:?}");
        // The front lies on ends of elements; ν < ½ leaves 2·10⁻⁵.
        assert!(errors[2] < 5e-4, "order {order}: {errors:?}");
        assert!(order == 2 || (errors[0] / errors[1]).log2() > 1.7, "order {order}: {errors:?}");
    }
}

#[test]
fn what_a_body_cannot_bear_is_refused_and_changes_nothing() {
    let (mesh, problem) = cylinder(10, 2);
    let mut state = problem.initial_state();
    let temperatures = uniform(&mesh, FREE_OF_STRESS);
    let limit = CYLINDER.limit_pressure();
    problem.advance(&mut state, &temperatures, &inner_pressure(&mesh, 0.98 * limit)).unwrap();
    let before = state.clone();
    let beyond = inner_pressure(&mesh, 1.02 * limit);
    let refused = problem.advance(&mut state, &temperatures, &beyond).unwrap_err();
    assert!(matches!(refused, InelasticError::NoEquilibrium { .. }), "{refused}");
    assert!(state == before);
    let nothing = vec![f64::NAN; mesh.nodes()];
    let refused = problem.advance(&mut state, &nothing, &[]).unwrap_err();
    assert!(matches!(
        refused,
        InelasticError::Constants { .. } | InelasticError::NoEquilibrium { .. }
    ));
    let short = problem.advance(&mut state, &temperatures[1..], &[]).unwrap_err();
    assert!(short.to_string().contains("nodal temperatures"), "{short}");
    assert!(state == before);
    problem.advance(&mut state, &temperatures, &[]).unwrap();
}

/// Temperatures of a hot spot in the middle of the top.
fn spot(mesh: &Mesh, rise: f64) -> Vec<f64> {
    let [nx, ny, _] = mesh.node_counts();
    let top = mesh.axes[2].end();
    let middle = match mesh.geometry {
        Geometry::Box => [0, 1].map(|a: usize| 0.5 * mesh.axes[a].end()),
        Geometry::Axisymmetric => [0.0; 2],
    };
    (0..mesh.nodes())
        .map(|node| {
            let at = [node % nx, node / nx % ny, node / (nx * ny)];
            let [x, y, z] = [0, 1, 2].map(|a: usize| mesh.axes[a].nodes[at[a]]);
            let far = (x - middle[0]).powi(2) + (y - middle[1]).powi(2) + (z - top).powi(2);
            FREE_OF_STRESS + rise * (-far / 0.15f64.powi(2)).exp()
        })
        .collect()
}

fn spot_bodies() -> Vec<Mesh> {
    let z = vec![0.0, 0.2, 0.3, 0.4];
    [1, 2]
        .into_iter()
        .flat_map(|order| {
            [
                brick([even(0.0, 0.6, 5), even(0.0, 0.7, 4), z.clone()], order),
                section(&even(0.0, 0.4, 5), &z, order),
            ]
        })
        .collect()
}

const CLAMPED_BELOW: (MeshFace, Support) = (MeshFace { axis: 2, high: false }, Support::Clamped);

#[test]
fn what_does_not_yield_deforms_as_in_elasticity() {
    let glass = MATERIALS[5];
    for mesh in spot_bodies() {
        let temperatures = spot(&mesh, 400.0);
        let rises: Vec<f64> = temperatures.iter().map(|t| t - FREE_OF_STRESS).collect();
        let elastic = ElasticProblem::new(ElasticSetup {
            mesh: mesh.clone(),
            laws: vec![thermoelastic(glass)],
            supports: vec![CLAMPED_BELOW],
            threads: 2,
        });
        let wanted = elastic.displacement(0, &rises, &Default::default()).unwrap();
        let problem = InelasticProblem::new(&mesh, vec![law(glass)], &[CLAMPED_BELOW], 2).unwrap();
        let mut state = problem.initial_state();
        problem.advance(&mut state, &temperatures, &[]).unwrap();
        let found = problem.displacement(&state);
        let off: Vec<f64> = found.iter().zip(&wanted).map(|(f, w)| f - w).collect();
        let scale = largest(&wanted);
        assert!(largest(&off) < 1e-12 * scale, "{:?}: {:e}", mesh.geometry, largest(&off) / scale);
        assert_eq!(problem.plastic_work(&state), 0.0);
        // And comes back to where it was.
        problem.advance(&mut state, &uniform(&mesh, FREE_OF_STRESS), &[]).unwrap();
        assert!(largest(&state) < 1e-12 * scale, "{:e}", largest(&state) / scale);
    }
}

#[test]
fn work_of_loads_and_heat_is_what_is_stored_and_dissipated() {
    for material in &MATERIALS[..5] {
        for mesh in spot_bodies() {
            let errors: Vec<f64> =
                [4, 16].map(|steps| energy_error(&mesh, *material, steps)).to_vec();
            let order = (errors[0] / errors[1]).log(4.0);
            assert!(
                errors[1] < 0.01 && order > 1.5,
                "{:?} {material:?}: {errors:?}",
                mesh.geometry
            );
        }
    }
}

/// What the balance of energy is off, relative to what is dissipated, when a spot is heated and cooled under a force.
fn energy_error(mesh: &Mesh, material: [f64; 6], steps: usize) -> f64 {
    let problem = InelasticProblem::new(mesh, vec![law(material)], &[CLAMPED_BELOW], 2).unwrap();
    let [young, _, expansion, yield_stress, ..] = material;
    let rise = 6.0 * yield_stress / (young * expansion);
    let degrees = mesh.geometry.degrees();
    let first = mesh.nodes() - mesh.node_counts()[0] * mesh.node_counts()[1];
    let force = |part: f64| {
        let mut forces = vec![0.0; degrees * mesh.nodes()];
        let each = 2e-3 * part * yield_stress / (mesh.nodes() - first) as f64;
        forces[degrees * first..]
            .iter_mut()
            .skip(degrees - 1)
            .step_by(degrees)
            .for_each(|f| *f = each);
        forces
    };
    let mut state = problem.initial_state();
    let cold = uniform(mesh, FREE_OF_STRESS);
    let (mut points, mut u) =
        (problem.points(&state, &cold).unwrap(), problem.displacement(&state).to_vec());
    let mut forces = force(0.0);
    let mut work = 0.0;
    for step in 1..=2 * steps {
        let part = 1.0 - (step as f64 / steps as f64 - 1.0).abs();
        let (temperatures, now) = (spot(mesh, rise * part), force(part));
        problem.advance(&mut state, &temperatures, &now).unwrap();
        let moved = problem.displacement(&state).to_vec();
        work += (0..u.len()).map(|i| 0.5 * (forces[i] + now[i]) * (moved[i] - u[i])).sum::<f64>();
        let read = problem.points(&state, &temperatures).unwrap();
        for (before, after) in points.iter().zip(&read) {
            let tension = 0.5 * (before.tension + after.tension);
            work -= after.volume * tension * (after.thermal_strain - before.thermal_strain);
        }
        (points, u, forces) = (read, moved, now);
    }
    let stored: f64 = points.iter().map(|point| point.volume * point.stored).sum();
    let dissipated = problem.plastic_work(&state);
    assert!(dissipated > 0.0 && stored > 0.0);
    (work - stored - dissipated).abs() / dissipated
}

#[test]
fn the_number_of_threads_changes_no_bit() {
    for mesh in spot_bodies() {
        let run = |threads: usize| {
            let problem =
                InelasticProblem::new(&mesh, vec![law(STEEL)], &[CLAMPED_BELOW], threads).unwrap();
            let mut state = problem.initial_state();
            for rise in [800.0, 0.0] {
                problem.advance(&mut state, &spot(&mesh, rise), &[]).unwrap();
            }
            let values = problem.nodal_values(&state, &uniform(&mesh, FREE_OF_STRESS));
            let stress = values.unwrap().stress;
            (state, stress)
        };
        let one = run(1);
        assert!(one == run(2) && one == run(5), "{:?}", mesh.geometry);
    }
}

#[test]
fn half_and_quarter_bodies_are_parts_of_the_whole() {
    for order in [1, 2] {
        let side = [-0.3, -0.1, 0.0, 0.1, 0.3];
        let z = vec![0.0, 0.2, 0.3, 0.4];
        let temperature = |x: f64, y: f64, z: f64| {
            300.0 + 700.0 * (-(x * x + 2.0 * y * y + (z - 0.4).powi(2)) / 0.02).exp()
        };
        let solve = |mesh: &Mesh| {
            let [nx, ny, _] = mesh.node_counts();
            let at = |n: usize| {
                [
                    mesh.axes[0].nodes[n % nx],
                    mesh.axes[1].nodes[n / nx % ny],
                    mesh.axes[2].nodes[n / (nx * ny)],
                ]
            };
            let hot: Vec<f64> =
                (0..mesh.nodes()).map(at).map(|[x, y, z]| temperature(x, y, z)).collect();
            let problem =
                InelasticProblem::new(mesh, vec![law(STEEL)], &[CLAMPED_BELOW], 2).unwrap();
            let mut state = problem.initial_state();
            problem.advance(&mut state, &hot, &[]).unwrap();
            let cold = uniform(mesh, 300.0);
            problem.advance(&mut state, &cold, &[]).unwrap();
            let stress = problem.nodal_values(&state, &cold).unwrap().stress;
            let list: Vec<([f64; 3], [f64; 6])> =
                (0..mesh.nodes()).map(|n| (at(n), stress[n])).collect();
            (list, problem.plastic_work(&state))
        };
        let (whole, dissipated) = solve(&brick([side.to_vec(), side.to_vec(), z.clone()], order));
        let mut quarter = brick([side[2..].to_vec(), side[2..].to_vec(), z], order);
        quarter.mirrored = [true; 2];
        let (quarter, of_quarter) = solve(&quarter);
        assert!((of_quarter / dissipated - 1.0).abs() < 1e-9);
        for (place, stress) in quarter {
            let (_, other) = whole.iter().find(|(at, _)| *at == place).unwrap();
            for (a, b) in stress.iter().zip(other) {
                assert!(
                    (a - b).abs() < 1e-6 * STEEL[3],
                    "order {order} {place:?}: {stress:?} {other:?}"
                );
            }
        }
    }
}

#[test]
fn layers_have_laws_of_their_own_and_constants_follow_temperature() {
    // A film of soft metal on glass, both held sideways: each layer goes its own bilinear way, of constants that fall.
    let (copper, glass) = (MATERIALS[2], MATERIALS[5]);
    let mut soft = law(copper);
    let falls = |t: f64| 1.0 - 1e-3 * (t - FREE_OF_STRESS);
    soft.yield_stress = std::sync::Arc::new(move |t| 70e6 * falls(t));
    soft.young = std::sync::Arc::new(move |t| 120e9 * falls(t));
    soft.isotropic = constant(0.0);
    soft.kinematic = constant(0.0);
    for order in [1, 2] {
        let mesh = brick([even(0.0, 1.0, 3), even(0.0, 1.0, 2), even(0.0, 0.4, 4)], order);
        let sides = [
            roller(0, false),
            roller(0, true),
            roller(1, false),
            roller(1, true),
            roller(2, false),
        ];
        let laws = vec![law(glass), law(glass), soft.clone(), soft.clone()];
        let problem = InelasticProblem::new(&mesh, laws, &sides, 2).unwrap();
        let mut state = problem.initial_state();
        for temperature in [600.0, 500.0, 300.0] {
            let temperatures = uniform(&mesh, temperature);
            problem.advance(&mut state, &temperatures, &[]).unwrap();
            let points = problem.points(&state, &temperatures).unwrap();
            let [below, above] = [points[0].stress[0], points[points.len() - 1].stress[0]];
            let elastic = -65e9 / 0.8 * 3e-6 * (temperature - 300.0);
            assert!(
                (below - elastic).abs() < 1e-9 * 65e9 / 0.8 * 9e-4,
                "order {order}: {below} {elastic}"
            );
            // It flows at 600 K; from there on stress is elastic in what changes, until it flows again.
            let modulus = |t: f64| 120e9 * falls(t) / (1.0 - 0.34);
            let flown = -17e-6 * 300.0 + 70e6 * falls(600.0) / modulus(600.0);
            let trial = modulus(temperature) * (-17e-6 * (temperature - 300.0) - flown);
            let limit = 70e6 * falls(temperature);
            let wanted = trial.clamp(-limit, limit);
            assert!((above - wanted).abs() < 1e-9 * limit, "order {order}: {above} {wanted}");
        }
    }
}
