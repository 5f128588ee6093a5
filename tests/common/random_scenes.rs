//! Random plates under spots, rings and tiles, and with faces that heat passes: the same for the same seed.

use std::time::Instant;

use fastrand::Rng;
use impinge::model::tolerance::choice::{Levels, Trials, factors, first_levels, search};
use impinge::model::tolerance::estimate::differences;
use impinge::model::tolerance::responses::{Responses, responses};
use impinge::model::tolerance::twin::{Physics, Twin};
use impinge::scene;

/// Density [kg/m³], specific heat capacity [J/(kg K)], conductivity [W/(m K)], Young's modulus [Pa], expansion [1/K].
const MATERIALS: [(&str, [f64; 5]); 8] = [
    ("copper", [8960.0, 385.0, 398.0, 120e9, 17e-6]),
    ("aluminium", [2700.0, 900.0, 237.0, 70e9, 23e-6]),
    ("steel", [7900.0, 490.0, 16.0, 200e9, 16e-6]),
    ("alumina", [3950.0, 900.0, 30.0, 370e9, 8e-6]),
    ("zirconia", [6000.0, 450.0, 2.5, 200e9, 10e-6]),
    ("glass", [2500.0, 840.0, 1.0, 70e9, 9e-6]),
    ("acrylic", [1180.0, 1450.0, 0.19, 3e9, 70e-6]),
    ("aerogel", [120.0, 1000.0, 0.015, 1e6, 4e-6]),
];

/// What of a scene was drawn.
pub struct Drawn {
    pub text: String,
    /// In a few words.
    pub words: String,
    pub is_disc: bool,
    /// Whether stresses are asked for.
    pub is_mechanical: bool,
}

fn log_uniform(rng: &mut Rng, [low, high]: [f64; 2]) -> f64 {
    low * (high / low).powf(rng.f64())
}

/// Extents 0.2 mm to 20 cm, thickness 0.02 to 1 of these, diffusion length at the end 0.03 to 5 thicknesses, 3 to 300
/// steps, footprints of 0.03 (on boxes 0.1) to
/// 0.45 of the half width anywhere on the top.
pub fn random_scene(seed: u64, wants_stress: bool) -> Drawn {
    let mut rng = Rng::with_seed(seed);
    let (material, [density, heat, conductivity, young, expansion]) = MATERIALS[rng.usize(0..8)];
    let is_disc = wants_stress || rng.f64() < 0.7;
    let width = log_uniform(&mut rng, [2e-4, 0.2]);
    let thickness = width * log_uniform(&mut rng, [0.02, 1.0]);
    let half = 0.5 * width;
    let depth = width * rng.f64().mul_add(0.4, 0.6);
    let diffusivity = conductivity / (density * heat);
    let reach = thickness * log_uniform(&mut rng, [0.03, 5.0]);
    let stop = reach * reach / diffusivity;
    let step = stop / log_uniform(&mut rng, [3.0, 300.0]).round();
    let radius = half * log_uniform(&mut rng, [if is_disc { 0.03 } else { 0.1 }, 0.45]);
    let [mut x, mut y] = [0.0, 0.0];
    if !is_disc && rng.bool() {
        x = (rng.f64() - 0.5) * (width - 2.2 * radius);
        y = (rng.f64() - 0.5) * (depth - 2.2 * radius).max(0.0);
    }
    let flux = 100.0 * conductivity / radius.min(reach);
    let kind = rng.usize(0..10);
    let (name, footprint) = match kind {
        0..3 => ("disc", Some(format!("disc = {{ radius = {radius:e} }}"))),
        3..5 => ("gaussian", Some(format!("gaussian = {{ radius = {radius:e} }}"))),
        5 => {
            let inner = radius * (0.1 + 0.8 * rng.f64());
            ("ring", Some(format!("ring = {{ inner = {inner:e}, outer = {radius:e} }}")))
        }
        6 => (
            "rings",
            Some(format!("rings = {{ count = {}, radius = {radius:e} }}", rng.usize(2..6))),
        ),
        7 if !is_disc => {
            let count = [rng.usize(1..5), rng.usize(1..5)];
            let size = 1.4 * radius;
            ("tiles", Some(format!("tiles = {{ count = {count:?}, size = [{size:e}, {size:e}] }}")))
        }
        _ => ("faces", None),
    };
    let mut faces = Vec::new();
    let face = |rng: &mut Rng| match rng.usize(0..4) {
        0 => format!("temperature = {:.1}", 250.0 + 200.0 * rng.f64()),
        1 => {
            let number = log_uniform(rng, [0.05, 50.0]);
            format!(
                "convection = {{ coefficient = {:e}, ambient = 350.0 }}",
                number * conductivity / thickness
            )
        }
        2 => format!("flux = {:e}", 50.0 * conductivity / thickness),
        _ => String::new(),
    };
    for (name, chance) in
        [("top", if footprint.is_none() { 0.8 } else { 0.2 }), ("bottom", 0.6), ("sides", 0.25)]
    {
        if rng.f64() < chance {
            let condition = face(&mut rng);
            let loaded =
                name == "top" && footprint.is_some() && condition.starts_with("temperature");
            if !condition.is_empty() && !loaded {
                faces.push((name, condition));
            }
        }
    }
    if footprint.is_none() && faces.is_empty() {
        faces.push(("top", "temperature = 400.0".to_owned()));
    }
    let shape = match is_disc {
        true => format!("disc = {{ radius = {half:e}, thickness = {thickness:e} }}"),
        false => format!("box = [{width:e}, {depth:e}, {thickness:e}]"),
    };
    let mut text = format!(
        "name = \"Random\"\nstop_time = {stop:e}\nstep = {step:e}\n[body.plate]\nkind = \"solid\"\nshape = {{ {shape} \
         }}\nmaterial = {{ model = \"thermoelastic\", density = {density}, specific_heat = {heat}, conductivity = \
         {conductivity}, young = {young:e}, poisson = 0.25, expansion = {expansion:e} }}\ninitial_temperature = 300.0\n\
         [body.plate.faces]\n"
    );
    if wants_stress && !faces.iter().any(|(name, _)| *name == "bottom") {
        faces.push(("bottom", String::new()));
    }
    for (name, condition) in &faces {
        // What bears stress is held.
        let held = if wants_stress && *name == "bottom" { "roller = true" } else { "" };
        let comma = if held.is_empty() || condition.is_empty() { "" } else { ", " };
        let condition = format!("{condition}{comma}{held}");
        text.push_str(&format!("{name} = {{ {condition} }}\n"));
    }
    if let Some(footprint) = &footprint {
        let place = if is_disc { String::new() } else { format!("x = {x:e}, y = {y:e}, ") };
        text.push_str(&format!(
            "[[load]]\nname = \"spot\"\non = \"plate.top\"\nfootprint = {{ {footprint} }}\ncarries = \
             [\"heat_flux\"]\nstart = {{ {place}heat_flux = {flux:e} }}\n"
        ));
    }
    let room = 0.999;
    let points = [
        [x, y, 0.0],
        [x + radius, y, 0.0],
        [
            (rng.f64() - 0.5) * room * width,
            if is_disc { 0.0 } else { (rng.f64() - 0.5) * room * depth },
            0.0,
        ],
        [x, y, -thickness * rng.f64()],
        [x + radius * rng.f64(), y, -reach.min(thickness) * rng.f64()],
    ];
    let gives = if wants_stress {
        "[\"temperature\", \"stress\", \"displacement\"]"
    } else {
        "[\"temperature\"]"
    };
    for (i, [x, y, z]) in points.into_iter().enumerate() {
        text.push_str(&format!(
            "[[probe]]\nname = \"p{i}\"\nin = \"plate\"\nat = [{x:e}, {y:e}, {z:e}]\ngives = {gives}\n"
        ));
    }
    let conditions: Vec<String> =
        faces.iter().map(|(name, what)| format!("{name} {what}")).collect();
    let shape = if is_disc { "disc" } else { "box" };
    let words = format!(
        "{seed} {material} {shape} L/R {:.1} H/R {:.2} √(at)/H {:.2} steps {:.0} {name} {}",
        half / radius,
        thickness / radius,
        reach / thickness,
        stop / step,
        conditions.join(", ")
    );
    Drawn { text, words, is_disc, is_mechanical: wants_stress }
}

/// What came of a scene at a tolerance.
pub struct Outcome {
    pub estimated: f64,
    /// Largest error of an output against the reference.
    pub found: f64,
    /// Nodes over those of the cheapest mesh that keeps the tolerance; none where the chosen one does not.
    pub cost: Option<f64>,
    /// That the choice took [s].
    pub seconds: f64,
}

/// Nodes of references, at most.
const MOST_NODES: f64 = 1.5e5;

/// Chooses a mesh for a tolerance and compares with meshes finer along the surface and through the thickness: by two
/// levels of √2, of discs along the surface by four. Nothing where the reference would be too large.
pub fn outcome(drawn: &Drawn, tolerance: f64) -> Option<Outcome> {
    let scene =
        scene::parse(&drawn.text, "scene").unwrap_or_else(|e| panic!("{e}\n{}", drawn.text));
    let physics = if drawn.is_mechanical { Physics::Deformation } else { Physics::Heat };
    let twin = Twin::of(&scene, "plate", physics)?;
    let mut trials = Trials::new(&twin, physics);
    let begun = Instant::now();
    let start = first_levels(tolerance, [true; 2]);
    let (levels, estimated) = search(&mut trials, start, [true; 2], tolerance);
    let seconds = begun.elapsed().as_secs_f64();
    let [i, j] = levels;
    let finer = [[i + if drawn.is_disc { 4 } else { 2 }, j], [i, j + 2]];
    let most = if drawn.is_mechanical { 0.2 * MOST_NODES } else { MOST_NODES };
    if finer.iter().any(|finer| trials.nodes(*finer) > most) {
        return None;
    }
    let watched = trials.watched.clone();
    let run = |levels: Levels| responses(&twin.on_mesh(factors(levels)), &watched).unwrap();
    let chosen = run(levels);
    let reference = sum(&run(finer[0]), &run(finer[1]), &chosen);
    let error_of = |found: &Responses| {
        differences(&reference, found, &watched).into_iter().fold(0.0, f64::max)
    };
    let found = error_of(&chosen);
    let cost = (found <= tolerance).then(|| {
        let mut cheapest = levels;
        // Down from the chosen mesh, as long as a coarser one keeps the tolerance.
        loop {
            let [a, b] = cheapest;
            let mut coarser = [[a - 1, b - 1], [a - 1, b], [a, b - 1]];
            coarser.sort_by(|x, y| trials.nodes(*x).total_cmp(&trials.nodes(*y)));
            let nodes = trials.nodes(cheapest);
            let mut cheaper = coarser.into_iter().filter(|one| trials.nodes(*one) < nodes);
            match cheaper.find(|one| error_of(&run(*one)) <= tolerance) {
                Some(found) => cheapest = found,
                None => return trials.nodes(levels) / nodes,
            }
        }
    });
    Some(Outcome { estimated: estimated.unwrap_or(f64::INFINITY), found, cost, seconds })
}

/// `a + b − c`: errors of two ways on their own, which hardly depend on each other.
fn sum(a: &Responses, b: &Responses, c: &Responses) -> Responses {
    let mut out = a.clone();
    let all = out.iter_mut().flatten().flatten();
    let others = b.iter().flatten().flatten().zip(c.iter().flatten().flatten());
    all.zip(others).for_each(|(value, (b, c))| *value += b - c);
    out
}
