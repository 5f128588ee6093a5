//! Random plates under spots, rings and tiles, and with faces that heat passes: the same for the same seed.

use fastrand::Rng;

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
    for (name, condition) in &faces {
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
    Drawn { text, words, is_disc }
}
