//! Heat by particles: the operators alone, the cases of Park (2019) §2.4.5, and bodies of particles
//! beside the same bodies of finite elements.

use std::time::Instant;

use impinge::closed_form::{Conductor, DiscFlux, HeatedSlab, SuddenSurface, UniformFlux};
use impinge::kernel::Kernel;
use impinge::method::particle_heat::operators::{Neighbour, Tensor, corrected, plain};
use impinge::method::particle_heat::{
    Condition, End, Face, LatticeAxis, Operator, ParticleHeat, Settings, Setup, Sources,
};
use impinge::runtime::allowance::Allowance;

use crate::common::Trial;
use crate::study::{
    CONDUCTIVITY, HEAT_CAPACITY, Study, alumina, growth, keep, line_of_probes, relative_norm,
};

const BODY: Conductor = Conductor { conductivity: CONDUCTIVITY, heat_capacity: HEAT_CAPACITY };
const OPERATORS: [Operator; 2] = [Operator::Corrected, Operator::Plain];

/// The Laplacian of f at each point of a cloud in the unit box, and how many points the corrected
/// operator leaves to the plain one. Every point has the volume `spacing^d`.
fn laplacians(
    points: &[[f64; 3]],
    (dimension, spacing): (usize, f64),
    operator: Operator,
    f: impl Fn([f64; 3]) -> f64,
) -> (Vec<f64>, usize) {
    let mut identity: Tensor = [[0.0; 3]; 3];
    (0..dimension).for_each(|a| identity[a][a] = 1.0);
    let view = (Kernel::WendlandC2, 3.0, dimension);
    let mut fallback = 0;
    let at = |&here: &[f64; 3]| {
        // In units of the spacing, as the condition number asks.
        let offset = |there: &[f64; 3]| [0, 1, 2].map(|a| (there[a] - here[a]) / spacing);
        let seen = points.iter().filter_map(|there| {
            Neighbour::new(offset(there), 1.0, view).map(|neighbour| (neighbour, f(*there)))
        });
        let (neighbours, values): (Vec<Neighbour>, Vec<f64>) = seen.unzip();
        let coefficients = match operator {
            Operator::Corrected => {
                corrected(&neighbours, dimension, &identity).unwrap_or_else(|| {
                    fallback += 1;
                    plain(&neighbours, dimension, &identity)
                })
            }
            Operator::Plain => plain(&neighbours, dimension, &identity),
        };
        let own = f(here);
        let sum: f64 = coefficients.iter().zip(&values).map(|(c, value)| c * (value - own)).sum();
        sum / (spacing * spacing)
    };
    let values = points.iter().map(at).collect();
    (values, fallback)
}

/// A lattice in the unit box whose points are shaken by a share of their spacing, edges included.
fn cloud(dimension: usize, intervals: usize, disorder: f64) -> Vec<[f64; 3]> {
    let mut seed: u64 = 1;
    let mut random = || {
        seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        2.0 * ((seed >> 11) as f64 / (1u64 << 53) as f64) - 1.0
    };
    let count = intervals + 1;
    let mut points = Vec::new();
    for index in 0..count.pow(dimension as u32) {
        let mut point = [0.0; 3];
        for (a, x) in point.iter_mut().enumerate().take(dimension) {
            let node = index / count.pow(a as u32) % count;
            *x = (node as f64 + disorder * random()) / intervals as f64;
        }
        points.push(point);
    }
    points
}

/// Park Fig. 2.4: the Laplacian of (x² + y²)/2, which is 2, on 11 × 11 points.
#[test]
fn laplacian_on_a_small_lattice() {
    let points = cloud(2, 10, 0.0);
    let f = |[x, y, _]: [f64; 3]| 0.5 * (x * x + y * y);
    let [(exact, fallback), (plain, _)] =
        OPERATORS.map(|operator| laplacians(&points, (2, 0.1), operator, f));
    println!(
        "\n### Laplacian of (x² + y²)/2 on 11 × 11 points, H = 3Δx (Park Fig. 2.4), y = 0.5\n"
    );
    println!("| x | corrected | plain |\n|---|---|---|");
    let middle = points.iter().zip(exact.iter().zip(&plain)).filter(|(p, _)| p[1] == 0.5);
    for (point, (c, p)) in middle.clone() {
        println!("| {:.1} | {c:.12} | {p:.4} |", point[0]);
    }
    keep(
        "laplacian.csv",
        "x,corrected,plain",
        middle.map(|(point, (c, p))| vec![point[0], *c, *p]),
    );
    assert_eq!(fallback, 0);
    assert!(exact.iter().all(|value| (value - 2.0).abs() < 1e-11));
    // Halfway into the box the support is full; at its edge half of the plain sum is missing.
    assert!((plain[60] - 2.0).abs() < 0.2 && (plain[55] - 2.0).abs() > 0.7, "{}", plain[55]);
}

#[test]
fn laplacian_on_disordered_points() {
    for (dimension, intervals) in [(2, [10, 20, 40, 80]), (3, [8, 12, 16, 24])] {
        let title =
            format!("Laplacian of sin 2x · cos 3y · e^z on shaken points, {dimension}-D, H = 3Δx");
        let quantities = [
            "corrected, all points",
            "corrected, full supports",
            "plain, all points",
            "plain, full supports",
        ];
        let mut study = Study::new(&title, &quantities);
        for n in intervals {
            let spacing = 1.0 / n as f64;
            let points = cloud(dimension, n, 0.2);
            let f = |[x, y, z]: [f64; 3]| (2.0 * x).sin() * (3.0 * y).cos() * z.exp();
            // In the plane the factor e^z is one.
            let factor = if dimension == 2 { -13.0 } else { -12.0 };
            let wanted: Vec<f64> = points.iter().map(|&p| factor * f(p)).collect();
            let inner =
                |p: &[f64; 3]| p[..dimension].iter().all(|x| (x - 0.5).abs() < 0.5 - 3.2 * spacing);
            let inside: Vec<usize> = (0..points.len()).filter(|&i| inner(&points[i])).collect();
            let (mut errors, mut left) = (Vec::new(), 0);
            for operator in OPERATORS {
                let (values, fallback) = laplacians(&points, (dimension, spacing), operator, f);
                left += fallback;
                let pick = |list: &[f64]| inside.iter().map(|&i| list[i]).collect::<Vec<f64>>();
                errors.push(relative_norm(&values, &wanted));
                errors.push(relative_norm(&pick(&values), &pick(&wanted)));
            }
            study.add(&format!("{n} intervals a side, {left} fall back"), spacing, errors);
        }
        study.print();
        study.require(&[1], 0.9, 0.05);
        // Points that see nobody on one side have errors of first order with a wide spread, and some
        // of them fall back to the plain operator.
        assert!(study.finest(0) < 0.3 * study.finest(2));
        // Disorder makes the plain operator miss by an error that no refinement lowers.
        assert!(study.order(2) < 0.2 && study.order(3) < 0.2);
    }
}

/// A rod of unit length, conductivity and heat capacity between held ends.
fn rod(particles: usize, operator: Operator) -> (Vec<f64>, Vec<f64>) {
    let last = (particles - 1) as f64;
    let nodes: Vec<f64> = (0..particles).map(|i| i as f64 / last).collect();
    let share = |i: usize| if i == 0 || i + 1 == particles { 0.5 / last } else { 1.0 / last };
    let ends = [End::Mirror; 2];
    let point = || LatticeAxis { nodes: vec![0.0], measures: vec![1.0], ends, radial: false };
    let line = LatticeAxis {
        nodes: nodes.clone(),
        measures: (0..particles).map(share).collect(),
        ends,
        radial: false,
    };
    let face = |high| Face { axis: 2, high, condition: Condition::Held };
    let setup = Setup {
        axes: [point(), point(), line],
        settings: Settings { operator, kernel: Kernel::WendlandC2, support: 3.0 },
        capacity: 1.0,
        conductivity: 1.0,
        faces: vec![face(false), face(true)],
        classes: vec![[false; 2]],
        copies: 1.0,
    };
    let heat = ParticleHeat::new(setup, 1);
    let mut state = vec![0.0; heat.layout().len()];
    let faces = [vec![1.0, 0.0]];
    let sources = Sources { surface: &[[vec![], vec![]]], faces: &faces };
    heat.advance(&mut state, &[sources], 0.03, &Allowance::default()).unwrap();
    (nodes, heat.temperatures(&state, &faces).swap_remove(0))
}

/// Park Fig. 2.7, with the images of the far end that her closed form leaves out.
#[test]
fn rod_with_a_sudden_end_temperature() {
    let unit = Conductor { conductivity: 1.0, heat_capacity: 1.0 };
    let half_space = SuddenSurface { body: unit, step: 1.0 };
    let exact = |x: f64| half_space.rise(x, 0.03) - half_space.rise(2.0 - x, 0.03);
    let mut study = Study::new(
        "Rod with a sudden end temperature, t = 0.03, H = 3Δx (Park Fig. 2.7), norm of the error",
        &["corrected", "plain"],
    );
    let mut table: Vec<Vec<f64>> = Vec::new();
    for particles in [80, 160, 320] {
        let runs = OPERATORS.map(|operator| rod(particles, operator));
        let wanted: Vec<f64> = runs[0].0.iter().map(|&x| exact(x)).collect();
        let errors = runs.each_ref().map(|(_, values)| relative_norm(values, &wanted));
        let rows = runs[0].0.iter().zip(runs[0].1.iter().zip(&runs[1].1)).zip(&wanted);
        table.extend(rows.map(|((x, (c, p)), e)| vec![particles as f64, *x, *c, *p, *e]));
        study.add(&format!("{particles} particles"), 1.0 / particles as f64, errors.into());
    }
    keep("rod.csv", "particles,x,corrected,plain,exact", table);
    study.print();
    study.require(&[0], 1.9, 1e-4);
    assert!(study.overall_order(1) < 0.3 && study.finest(1) > 1e-3);
}

/// A scene of particles.
fn with_particles(text: &str, settings: &str) -> String {
    text.replace("mesh = {", &format!("heat = \"sph\"\nsph = {{ {settings} }}\nmesh = {{"))
}

fn depths(count: usize, step: f64) -> Vec<[f64; 3]> {
    (0..count).map(|i| [0.0, 0.0, -step * i as f64]).collect()
}

fn rises(trial: &mut Trial, count: usize) -> Vec<f64> {
    (0..count).map(|i| trial.get(&format!("p{i}.temperature")) - 293.15).collect()
}

/// A column under a flux, as particles at equal distances.
fn column(spacing: f64, thickness: f64, settings: &str, points: &[[f64; 3]]) -> Trial {
    let width = 4.0 * spacing;
    let shape = format!("box = [{width:e}, {width:e}, {thickness:e}]");
    let mesh = format!("spacing = {spacing:e}, growth = 1.0");
    let probes = line_of_probes("p", points, "\"temperature\"");
    let text = alumina(&shape, &mesh, "top = { flux = 5e7 }", &probes);
    Trial::new(&with_particles(&text, settings))
}

#[test]
fn uniform_flux_and_heated_slab() {
    let points = depths(20, 1.13e-6);
    let half_space = UniformFlux { body: BODY, flux: 5e7 };
    let early: Vec<f64> = points.iter().map(|p| half_space.rise(-p[2], 1e-5)).collect();
    let slab = HeatedSlab { body: BODY, flux: 5e7, thickness: 24e-6 };
    let late: Vec<f64> =
        points.iter().map(|p| slab.rise_with_insulated_back(-p[2], 3e-4)).collect();
    for operator in ["corrected", "plain"] {
        let settings = format!("operator = \"{operator}\"");
        let mut study = Study::new(
            &format!("Particles under a uniform flux, {operator} operator"),
            &[
                "half space, 10 µs: surface",
                "half space: norm",
                "slab of 24 µm, 0.3 ms: surface",
                "slab: norm",
            ],
        );
        for spacing in [4e-6, 2e-6, 1e-6, 0.5e-6] {
            let mut trial = column(spacing, 80e-6, &settings, &points);
            trial.step(1e-5);
            let values = rises(&mut trial, points.len());
            let mut errors = vec![values[0] / early[0] - 1.0, relative_norm(&values, &early)];
            let mut trial = column(spacing, 24e-6, &settings, &points);
            trial.step(3e-4);
            let values = rises(&mut trial, points.len());
            errors.extend([values[0] / late[0] - 1.0, relative_norm(&values, &late)]);
            assert!(trial.heat_residual("plate") < 1e-9);
            study.add(&format!("Δx = {:.1} µm", spacing * 1e6), spacing, errors);
        }
        study.print();
        if operator == "corrected" {
            study.require(&[0, 1, 2, 3], 1.8, 1e-2);
        } else {
            // What is left is the share by which the kernel sums of the lattice miss the conductivity.
            assert!(study.order(3) < 0.7, "{}", study.order(3));
        }
    }
}

const SPOT: &str = "[[load]]\nname = \"spot\"\non = \"plate.top\"\nfootprint = { disc = { radius = 50e-6 } }\ncarries = [\"heat_flux\"]\nstart = { heat_flux = 1e8 }\n";

/// Particles beside linear elements on the same graded mesh: accuracy, drift and cost.
#[test]
fn disc_flux_beside_finite_elements() {
    let exact = DiscFlux { body: BODY, flux: 1e8, radius: 50e-6 };
    let points = depths(12, 10e-6);
    let wanted: Vec<f64> = points.iter().map(|p| exact.rise_on_axis(-p[2], 1e-3)).collect();
    let mut table = Vec::new();
    let shapes = [
        ("disc", "disc = { radius = 1e-3, thickness = 1e-3 }"),
        ("box", "box = [2e-3, 2e-3, 1e-3]"),
    ];
    for (shape, extents) in shapes {
        for method in ["fem", "sph"] {
            let title =
                format!("Disc flux R 50 µm on a {shape}, graded mesh, order 1, heat by {method}");
            let quantities = [
                "surface (371.74 K)",
                "20 µm deep (211.72 K)",
                "110 µm of depth (norm)",
                "heat drift",
                "seconds: build",
                "seconds: ten steps",
            ];
            let mut study = Study::new(&title, &quantities);
            for spacing in [16e-6, 8e-6, 4e-6] {
                let mesh = format!(
                    "spacing = {spacing:e}, growth = {}, order = 1",
                    growth(spacing, 16e-6)
                );
                let rest = SPOT.to_owned() + &line_of_probes("p", &points, "\"temperature\"");
                let mut text = alumina(extents, &mesh, "", &rest);
                if method == "sph" {
                    text = with_particles(&text, "");
                }
                let start = Instant::now();
                let mut trial = Trial::new(&text);
                let built = start.elapsed().as_secs_f64();
                (0..10).for_each(|_| trial.step(1e-4));
                let ran = start.elapsed().as_secs_f64() - built;
                let values = rises(&mut trial, points.len());
                let stored = trial.get("plate.heat_stored") / trial.get("plate.heat_in") - 1.0;
                let errors = vec![
                    values[0] / wanted[0] - 1.0,
                    values[2] / wanted[2] - 1.0,
                    relative_norm(&values, &wanted),
                    stored,
                    built,
                    ran,
                ];
                let kinds =
                    [f64::from(u8::from(shape == "box")), f64::from(u8::from(method == "sph"))];
                table.push([kinds.as_slice(), &[spacing], &errors].concat());
                study.add(&format!("h = {:.1} µm", spacing * 1e6), spacing, errors);
            }
            study.print();
            study.require(&[0, 2], 1.0, 1e-2);
            if method == "sph" {
                study.require(&[3], 0.8, 2e-2);
            }
        }
    }
    keep("plate.csv", "box,sph,spacing,surface,deep,norm,drift,build,steps", table);
}

/// The balance of heat against resolution: the corrected operator loses it where distances are
/// unlike, and less so the finer; at equal distances both operators keep it.
#[test]
fn drift_against_resolution() {
    let exact = DiscFlux { body: BODY, flux: 1e8, radius: 50e-6 };
    let wanted = exact.rise_on_axis(0.0, 1e-3 / 16.0);
    let probe = line_of_probes("p", &[[0.0; 3]], "\"temperature\"");
    let runs = [
        ("corrected, graded", "operator = \"corrected\"", true),
        ("corrected, equal", "operator = \"corrected\"", false),
        ("plain, equal", "operator = \"plain\"", false),
    ];
    let mut table = Vec::new();
    for (column, (title, settings, graded)) in runs.into_iter().enumerate() {
        let title = format!("Particles under a disc flux, 62.5 µs, {title} distances");
        let mut study = Study::new(&title, &["heat drift", "surface temperature"]);
        for spacing in [12e-6, 6e-6, 3e-6] {
            let growth = if graded { 1.0 + 0.2 * spacing / 12e-6 } else { 1.0 };
            let mesh = format!("spacing = {spacing:e}, growth = {growth}");
            let text =
                alumina("box = [300e-6, 300e-6, 150e-6]", &mesh, "", &(SPOT.to_owned() + &probe));
            let mut trial = Trial::new(&with_particles(&text, settings));
            trial.step(1e-3 / 16.0);
            let drift = trial.get("plate.heat_drift") / trial.get("plate.heat_in");
            let surface = rises(&mut trial, 1)[0] / wanted - 1.0;
            table.push(vec![column as f64, spacing, drift, surface]);
            study.add(&format!("Δx = {:.1} µm", spacing * 1e6), spacing, vec![drift, surface]);
        }
        study.print();
        study.require(&[1], 1.5, 1e-2);
        if graded {
            study.require(&[0], 1.0, 1e-2);
        } else {
            assert!(study.finest(0) < 1e-10, "{}", study.finest(0));
        }
    }
    // At equal distances both operators differ by one factor, 3e-4 off one in 3-D.
    let [corrected, plain] = [5, 8].map(|row: usize| table[row][3].abs());
    assert!(plain > corrected + 1e-4, "{corrected} {plain}");
    keep("drift.csv", "run,spacing,drift,surface", table);
}
