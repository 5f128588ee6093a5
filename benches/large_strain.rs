//! Time of solids of large strain on one thread: functions of a point, explicit steps, equilibria and implicit steps.
//!
//! `cargo bench --bench large_strain -- [functions] [explicit] [newton] [driven]` prints medians of processor time;
//! without names it runs all four. `cube CELLS` runs an equilibrium of elements alone, and
//! `driven BODY` one body, for profilers. The particles of `sph` count as nodes.

use std::env;
use std::hint::black_box;

use impinge::laws::solid::large_strain::{
    Deviator, LargeStrainLaw, MaxwellBranch, Plastic, Relaxing,
};
use impinge::method::large_strain::{
    Acting, Conditions, Course, Deformable, Drive, Dynamics, Equilibrium, FaceLoad,
    ImplicitDynamics, LoadedFaces, Plane,
};
use impinge::runtime::Usage;
use impinge::runtime::allowance::{Allowance, Interrupt};
use impinge::space::{
    Form, Functions, Mesh, Reproducing, Row, Side, Sides, Space, finite_elements, particles,
    reproducing,
};

/// Measurements of which the median is printed; one of a task that takes longer than `LONG` [s].
const REPEATS: usize = 3;
const LONG: f64 = 5.0;
/// Places at which functions are evaluated.
const EVALUATIONS: usize = 300_000;
/// Nodes times time steps of an explicit measurement.
const NODE_STEPS: f64 = 3e6;
/// Elements along each edge of the square and the cube: explicit steps, and steps with Newton's method.
const EXPLICIT: [(Form, usize); 2] = [(Form::Plane, 100), (Form::Solid, 24)];
const NEWTON: [(Form, usize); 2] = [(Form::Plane, 40), (Form::Solid, 10)];
const METHODS: [&str; 3] = ["fem", "sph", "rkpm"];

/// Steps of a driven body.
const DRIVEN_STEPS: usize = 5;

/// Gravity [m/s²], and the length of an implicit step [s].
const GRAVITY: f64 = 20.0;
const STEP: f64 = 0.02;

fn main() {
    let names: Vec<String> = env::args().skip(1).filter(|name| !name.starts_with('-')).collect();
    match &names.iter().map(String::as_str).collect::<Vec<_>>()[..] {
        ["cube", cells] => {
            return newton(Form::Solid, cells.parse().expect("a number of cells"), "fem");
        }
        ["driven", body] => return driven(body),
        _ => {}
    }
    let runs = |name: &str| names.is_empty() || names.iter().any(|wanted| wanted == name);
    if runs("functions") {
        functions();
    }
    if runs("driven") {
        driven("");
    }
    for (name, sizes, part) in
        [("explicit", EXPLICIT, explicit as fn(Form, usize, &str)), ("newton", NEWTON, newton)]
    {
        for (form, cells) in sizes.into_iter().filter(|_| runs(name)) {
            METHODS.iter().for_each(|method| part(form, cells, method));
        }
    }
}

/// Median processor time of a task [s], with the last value that it returned.
fn median<T>(mut task: impl FnMut() -> T) -> (f64, T) {
    let mut run = || {
        let before = Usage::now().processor_time;
        let value = black_box(task());
        (Usage::now().processor_time - before, value)
    };
    let mut runs = vec![run()];
    while runs.len() < REPEATS && runs[0].0 < LONG {
        runs.push(run());
    }
    runs.sort_by(|a, b| a.0.total_cmp(&b.0));
    let middle = runs.len() / 2;
    runs.swap_remove(middle)
}

fn block(form: Form, cells: usize) -> Mesh {
    let (across, width) = if form == Form::Plane { (1, 0.0) } else { (cells, 1.0) };
    Mesh::of_box(form, [0.0; 3], [1.0, width, 1.0], [cells, across, cells])
}

fn space(mesh: &Mesh, method: &str) -> Space {
    let held = Sides::of(&[Side::Bottom]);
    match method {
        "sph" => particles(mesh, 2.2).unwrap(),
        "rkpm" => reproducing(mesh, Reproducing { held, ..Reproducing::default() }).unwrap(),
        _ => finite_elements(mesh),
    }
}

/// A block of rubber.
fn body(form: Form, cells: usize, method: &str) -> Deformable {
    let law = LargeStrainLaw::elastic(1e6, 3e5);
    Deformable::new(space(&block(form, cells), method), law, 1000.0, [false; 2], 1)
}

/// Values and gradients of kernels with a linear basis at places within a cube, and the set-up of a body's points.
fn functions() {
    let mesh = block(Form::Solid, 20);
    let kernels = Functions::of(&mesh, Reproducing::default()).unwrap();
    let mut random = fastrand::Rng::with_seed(1);
    let mut place = || [0; 3].map(|_| 0.2 + 0.6 * random.f64());
    let places: Vec<[f64; 3]> = (0..EVALUATIONS).map(|_| place()).collect();
    let mut row = Row::default();
    let (time, count) = median(|| {
        let mut count = 0;
        for &at in &places {
            kernels.evaluate(at, true, &mut row).unwrap();
            count += black_box(row.values()).count();
        }
        count
    });
    let [time, count] = [time, count as f64].map(|sum| sum / EVALUATIONS as f64);
    println!("functions of a place in space: {:.3} µs, {count:.1} nodes on average", 1e6 * time);
    for method in METHODS {
        let (time, points) = median(|| space(&mesh, method).volume.len());
        println!("set-up of a point, {method}: {:.3} µs", 1e6 * time / points as f64);
    }
}

/// Explicit steps of a block that turns and rings above a plane.
fn explicit(form: Form, cells: usize, method: &str) {
    let body = body(form, cells, method);
    let (nodes, points) = (body.nodes() as f64, body.space.volume.len());
    let plane = Plane { stiffness: 1e6, height: 1.0, width: 0.1, friction: None };
    let dynamics = Dynamics::new((body, LoadedFaces::default()), plane, 0.0, [false; 2], None);
    let duration = (NODE_STEPS / nodes).ceil() * dynamics.usual_step();
    let interrupt = Interrupt::default();
    let acting = Acting { loads: &|_| Vec::new(), courses: None };
    let (time, steps) = median(|| {
        let mut motion = dynamics.start([0.0; 3]);
        let places = dynamics.body.space.nodes.iter();
        for (at, velocity) in places.zip(&mut motion.velocity) {
            *velocity = [at[0] - 0.5, 0.0, 0.5 - at[2]];
        }
        let allowance = Allowance::of_step(&interrupt);
        dynamics.advance(&mut motion, duration, &acting, None, &allowance).unwrap();
        motion.ledger.steps
    });
    println!(
        "explicit, {form:?}, {method}: {:.2} million node-steps/s, {nodes} nodes, {points} points, {steps} steps",
        1e-6 * nodes * steps / time
    );
}

/// The equilibrium of a block under its weight, and an implicit step in which it begins to sag.
fn newton(form: Form, cells: usize, method: &str) {
    let interrupt = Interrupt::default();
    let nodes = space(&block(form, cells), method).nodes;
    let held: Vec<[bool; 3]> = nodes.iter().map(|at| [at[2] == 0.0; 3]).collect();
    let displacements = vec![[0.0; 3]; nodes.len()];

    let of_body = body(form, cells, method);
    let equilibrium = Equilibrium::new(of_body, &held, LoadedFaces::default()).unwrap();
    let weights = equilibrium.body.mass.iter().map(|mass| [0.0, 0.0, -GRAVITY * mass]);
    let (forces, loads) = (weights.collect(), Vec::new());
    let to = Conditions { forces, displacements: displacements.clone(), loads };
    let over = equilibrium.body.in_all(Course::NONE);
    let (resting, iterations) = median(|| {
        let (mut rest, allowance) = (equilibrium.rest(), Allowance::of_step(&interrupt));
        equilibrium.step(&mut rest, &to, &over, &allowance).unwrap().residuals.len()
    });

    let of_body = body(form, cells, method);
    let dynamics = ImplicitDynamics::new(of_body, &held, LoadedFaces::default(), GRAVITY).unwrap();
    let drive = Drive { displacements, loads: Vec::new() };
    let (implicit, residuals) = median(|| {
        let (mut motion, allowance) = (dynamics.start([0.0; 3]), Allowance::of_step(&interrupt));
        dynamics.step(&mut motion, &drive, STEP, &allowance).unwrap().residuals.len()
    });
    println!(
        "newton, {form:?}, {method}: {} nodes, equilibrium {resting:.3} s in {iterations} iterations, implicit step \
         {implicit:.3} s in {}",
        nodes.len(),
        residuals - 1
    );
}

/// A body clamped at one face, the opposite one of which moves.
#[derive(Clone)]
struct Driven {
    name: &'static str,
    law: LargeStrainLaw,
    method: &'static str,
    /// Edges of the body and cells along them.
    size: [f64; 3],
    cells: [usize; 3],
    /// Displacement of the upper face at a part of the way, of a place there.
    moved: fn(f64, [f64; 3]) -> [f64; 3],
    /// Pressure on the face at the right at the end [Pa].
    pressure: f64,
}

/// Equilibria of driven bodies in steps, or of the one that is named: median time of a step, iterations and the last
/// force.
fn driven(wanted: &str) {
    let of = |young: f64, poisson: f64| {
        let (bulk, shear) =
            (young / (3.0 * (1.0 - 2.0 * poisson)), young / (2.0 * (1.0 + poisson)));
        LargeStrainLaw::elastic(bulk, shear)
    };
    let rubber = of(1e6, 0.3);
    let branches = vec![MaxwellBranch { fraction: 0.6, time: 0.5 }];
    let relaxing = Deviator::Relaxing(Relaxing { branches });
    let plastic =
        Plastic { yield_stress: 1e8, hardening: 1e9, saturation: 1e8, rate: 0.0, kinematic: 0.0 };
    let metal = LargeStrainLaw { deviator: Deviator::Plastic(plastic), ..of(70e9, 0.33) };
    let sheared = |part: f64, _| [0.3 * part, 0.0, 0.0];
    let cube = Driven {
        name: "rubber",
        law: rubber.clone(),
        method: "fem",
        size: [1.0; 3],
        cells: [20; 3],
        moved: sheared,
        pressure: 0.0,
    };
    let strip = Driven { name: "strip", size: [2.0, 1.0, 20.0], cells: [4, 6, 80], ..cube.clone() };
    let turned: fn(f64, [f64; 3]) -> [f64; 3] = |part, at| {
        let (sin, cos) = (1.5 * part).sin_cos();
        let along = at[0] - 1.0;
        [along * (cos - 1.0) + 12.0 * part, 0.0, -along * sin - 4.0 * part]
    };
    let bodies = [
        cube.clone(),
        Driven { name: "rubber 10", cells: [10; 3], ..cube.clone() },
        Driven { name: "0.49", law: of(1e6, 0.49), ..cube.clone() },
        Driven {
            name: "0.4999",
            law: of(1e6, 0.4999),
            moved: |part, _| [0.05 * part, 0.0, 0.0],
            ..cube.clone()
        },
        Driven {
            name: "viscoelastic",
            law: LargeStrainLaw { deviator: relaxing, ..rubber.clone() },
            ..cube.clone()
        },
        Driven {
            name: "metal",
            law: metal,
            moved: |part, _| [0.02 * part, 0.0, 0.0],
            ..cube.clone()
        },
        Driven { name: "kernels", method: "rkpm", cells: [10; 3], ..cube.clone() },
        Driven { name: "pressed", pressure: 1e5, cells: [10; 3], ..cube.clone() },
        Driven { name: "strip", moved: turned, ..strip.clone() },
        Driven { name: "0.49 strip", moved: turned, law: of(1e6, 0.49), ..strip.clone() },
        Driven { name: "column", moved: |part, _| [0.0, 0.0, -2.0 * part], ..strip },
    ];
    for body in bodies.iter().filter(|body| wanted.is_empty() || wanted == body.name) {
        drive(body);
    }
}

fn drive(driven: &Driven) {
    let Driven { name, law, method, size, cells, moved, pressure } = driven;
    let mesh = Mesh::of_box(Form::Solid, [0.0; 3], *size, *cells);
    let body = Deformable::new(space(&mesh, method), law.clone(), 1000.0, [false; 2], 1);
    let is_top = |at: &[f64; 3]| at[2] == size[2];
    let nodes = body.space.nodes.clone();
    let held: Vec<[bool; 3]> = nodes.iter().map(|at| [at[2] == 0.0 || is_top(at); 3]).collect();
    let faces: &[&dyn Fn(Side) -> bool] =
        if *pressure == 0.0 { &[] } else { &[&|side| side == Side::Right] };
    let loaded = LoadedFaces::new(&body, faces);
    let equilibrium = Equilibrium::new(body, &held, loaded).unwrap();
    let over = equilibrium.body.in_all(Course::of(0.2));
    let (interrupt, mut rest) = (Interrupt::default(), equilibrium.rest());
    let (mut times, mut iterations, mut force, mut unstable) = (Vec::new(), Vec::new(), 0.0, 0);
    for n in 1..=DRIVEN_STEPS {
        let part = n as f64 / DRIVEN_STEPS as f64;
        let place = |at: &[f64; 3]| if is_top(at) { moved(part, *at) } else { [0.0; 3] };
        let to = Conditions {
            forces: vec![[0.0; 3]; nodes.len()],
            displacements: nodes.iter().map(place).collect(),
            loads: faces.iter().map(|_| FaceLoad::of([part * pressure, 0.0, 0.0, 0.0])).collect(),
        };
        let before = Usage::now().processor_time;
        let allowance = Allowance::of_step(&interrupt);
        let found = equilibrium.step(&mut rest, &to, &over, &allowance);
        times.push(Usage::now().processor_time - before);
        match found {
            Ok(found) => {
                let of_top = nodes.iter().zip(&found.reactions).filter(|(at, _)| is_top(at));
                force = of_top.map(|(_, force)| force[0]).sum::<f64>();
                iterations.push(found.residuals.len());
                unstable += usize::from(found.is_unstable);
            }
            Err(failure) => {
                println!("driven, {name}: {failure}");
                break;
            }
        }
    }
    let total: f64 = times.iter().sum();
    times.sort_by(f64::total_cmp);
    println!(
        "driven, {name}: {:.3} s a step, {total:.2} s in all, {iterations:?} iterations, {unstable} unstable, force \
         {force:.12e}",
        times[times.len() / 2]
    );
}
