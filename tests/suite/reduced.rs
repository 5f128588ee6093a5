//! Reduced models against the full ones, and their bounds.

use crate::common::Trial;

/// A scene and the names of its inputs that have sizes.
struct Case {
    name: &'static str,
    text: String,
    inputs: Vec<&'static str>,
    size: f64,
    outputs: Vec<&'static str>,
}

const HEAD: &str = "name = \"Reduced\"\n";

fn material(constants: [f64; 3]) -> String {
    let [density, specific_heat, conductivity] = constants;
    format!(
        "{{ model = \"thermoelastic\", density = {density:?}, specific_heat = {specific_heat:?}, conductivity = {conductivity:?} }}"
    )
}

fn probe(name: &str, at: [f64; 3]) -> String {
    format!(
        "[[probe]]\nname = \"{name}\"\nin = \"plate\"\nat = {at:?}\ngives = [\"temperature\"]\n"
    )
}

const SPOT: &str = "[[load]]\nname = \"spot\"\non = \"plate.top\"\ncarries = [\"heat_flux\"]\n";

/// The text with its level, as `full` or `reduced`.
fn at(level: &str, text: &str, tolerance: f64) -> String {
    format!("{text}\n[fidelity]\nlevel = \"{level}\"\ntolerance = {tolerance:e}\n")
}

fn boxed(material: &str, faces: &str, rest: &str) -> String {
    format!(
        "{HEAD}stop_time = 1e-3\nstep = 1e-5\n[body.plate]\nkind = \"solid\"\nshape = {{ box = [2e-3, 1.6e-3, 0.4e-3] }}\n\
         material = {material}\ninitial_temperature = 300.0\nmesh = {{ spacing = 6e-5, depth_spacing = 2e-5, growth = 1.5 }}\n\
         {faces}\n{rest}"
    )
}

fn cases() -> Vec<Case> {
    let probes =
        probe("a", [0.0; 3]) + &probe("b", [1e-4, 5e-5, -5e-5]) + &probe("c", [0.0, 0.0, -4e-4]);
    let outputs = vec!["a.temperature", "b.temperature", "c.temperature", "plate.heat_stored"];
    let gaussian = format!(
        "{SPOT}footprint = {{ gaussian = {{ radius = 2e-4 }} }}\nstart = {{ heat_flux = 3e7 }}\n"
    );
    let spot = |material: [f64; 3], name, faces: &str| Case {
        name,
        text: boxed(&self::material(material), faces, &format!("{gaussian}{probes}")),
        inputs: vec!["spot.heat_flux"],
        size: 3e7,
        outputs: outputs.clone(),
    };
    let convective = "[body.plate.faces]\ntop = { convection = { coefficient = 2e3, ambient = 300.0 } }\n\
                      bottom = { convection = { coefficient = 50.0, ambient = 300.0 } }";
    let held = "[body.plate.faces]\nbottom = { temperature = 300.0 }";
    let mut all = vec![
        spot([3950.0, 900.0, 10.0], "insulated alumina", ""),
        spot([13_500.0, 140.0, 8.3], "mercury, cooled", convective),
        spot([8960.0, 385.0, 400.0], "copper, held below", held),
        spot([100.0, 1000.0, 0.015], "aerogel", convective),
        spot([6050.0, 450.0, 2.5], "zirconia", held),
    ];
    // All faces, off the axes.
    let faces = "[body.plate.faces]\nbottom = { temperature = 300.0 }\nleft = { temperature = 300.0 }\n\
                 right = { flux = 0.0 }\nfront = { convection = { coefficient = 500.0, ambient = 300.0 } }";
    let off = format!(
        "{SPOT}footprint = {{ disc = {{ radius = 1.5e-4 }} }}\nstart = {{ x = 2e-4, y = -1e-4 }}\n{probes}"
    );
    all.push(Case {
        name: "all kinds of faces",
        text: boxed(&material([7850.0, 470.0, 45.0]), faces, &off),
        inputs: vec![
            "spot.heat_flux",
            "plate.left.temperature",
            "plate.bottom.temperature",
            "plate.right.flux",
            "plate.front.ambient",
        ],
        size: 0.0,
        outputs: outputs.clone(),
    });
    all
}

/// A level between 0 and 1 that looks random.
fn noise(n: u32) -> f64 {
    let x = (f64::from(n) * 12.9898).sin() * 43_758.547;
    x - x.floor()
}

#[test]
fn errors_stay_within_their_bounds_on_steps_and_on_random_inputs() {
    for case in cases() {
        let mut full = Trial::new(&at("full", &case.text, 1e-4));
        let mut reduced = Trial::new(&at("reduced", &case.text, 1e-4));
        let order = reduced.state.bodies[0].len();
        assert!(order < 80, "{}: {order} unknowns", case.name);
        let mut worst: f64 = 0.0;
        let mut largest: f64 = 0.0;
        let mut n = 0;
        // Short steps and long ones, held and as polynomials.
        for (count, dt) in [(10, 1e-7), (10, 1e-5), (6, 2e-4), (3, 1.0)] {
            for _ in 0..count {
                for trial in [&mut full, &mut reduced] {
                    trial.state.derivatives.clear();
                    for (i, input) in case.inputs.iter().enumerate() {
                        let kind = noise(n + 100 * i as u32);
                        let value = match input.rsplit('.').next() {
                            Some("heat_flux") => case.size.max(1e6) * kind,
                            Some("flux") => 1e4 * kind,
                            _ => 300.0 + 50.0 * kind,
                        };
                        trial.set(input, value);
                        if n % 3 == 0 && input.ends_with("flux") {
                            trial.set_derivative(input, 1, -0.5 * value / dt);
                        }
                    }
                    trial.step(dt);
                }
                n += 1;
                for name in &case.outputs {
                    let (wanted, found) = (full.get(name), reduced.get(name));
                    let key = if name.ends_with("stored") { "heat" } else { "temperature" };
                    let bound = reduced.get(&format!("plate.error_bound_{key}"));
                    let rounding = 1e-11 * wanted.abs();
                    let error = (found - wanted).abs();
                    assert!(
                        error <= bound + rounding,
                        "{} {name}: {error:e} beyond {bound:e}",
                        case.name
                    );
                    if key == "temperature" {
                        worst = worst.max(error / bound);
                        largest = largest.max(wanted - 300.0);
                    }
                }
                assert!(reduced.heat_residual("plate") < 1e-12);
                let (wanted, found) = (full.get("plate.heat_in"), reduced.get("plate.heat_in"));
                assert!(
                    (wanted - found).abs() <= 1e-12 * wanted.abs(),
                    "{}: {wanted} {found}",
                    case.name
                );
            }
        }
        let bound = reduced.get("plate.error_bound_temperature");
        println!(
            "{}: {order} unknowns, bound {bound:e} K of {largest} K, worst error over bound {worst}",
            case.name
        );
        // The bound says something.
        assert!(worst > 1e-3, "{}: {worst}", case.name);
    }
}
