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
        assert!(order < 100, "{}: {order} numbers in a state", case.name);
        let mut worst: f64 = 0.0;
        let mut largest: f64 = 0.0;
        let mut n = 0;
        // Short steps and long ones, held and as polynomials.
        for (count, dt) in [(10, 1e-7), (10, 1e-5), (6, 2e-4), (3, 1.0)] {
            for _ in 0..count {
                for trial in [&mut full, &mut reduced] {
                    trial.state.derivatives.clear();
                    for (i, input) in case.inputs.iter().enumerate() {
                        let kind = noise(n + 1 + 100 * i as u32);
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
        // The bound says something. Where faces jump, heat stored decides on the order, and temperatures are better
        // yet.
        assert!(worst > 1e-3 || case.size == 0.0, "{}: {worst}", case.name);
    }
}

const DISC: &str = r#"
name = "Reduced"
stop_time = 2.0
step = 0.01
[body.plate]
kind = "solid"
shape = { disc = { radius = 20e-3, thickness = 3e-3 } }
layers = [
    { material = { model = "thermoelastic", density = 6050.0, specific_heat = 450.0, conductivity = 2.5 }, thickness = 0.5e-3 },
    { material = { model = "thermoelastic", density = 7850.0, specific_heat = 470.0, conductivity = 45.0 }, thickness = 2.5e-3, contact_resistance = 1e-5 },
]
initial_temperature = 300.0
mesh = { spacing = 1e-3, depth_spacing = 0.1e-3, growth = 1.5 }
[body.plate.faces]
bottom = { convection = { coefficient = 1e3, ambient = 300.0 } }
[[load]]
name = "spot"
on = "plate.top"
carries = ["heat_flux"]
footprint = { rings = { count = 4, radius = 8e-3 } }
start = { heat_flux = [1e5, 2e5, 0.0, 1e5] }
[[probe]]
name = "a"
in = "plate"
at = [1e-3, 0.0, -0.5e-3]
gives = ["temperature"]
[[field]]
name = "rim"
on = "plate.top"
footprint = { rings = { count = 3, radius = 15e-3 } }
gives = ["temperature"]
"#;

#[test]
fn layers_rings_and_means_stay_within_their_bounds() {
    let [mut full, mut reduced] =
        ["full", "reduced"].map(|level| Trial::new(&at(level, DISC, 1e-3)));
    for n in 0..30 {
        for trial in [&mut full, &mut reduced] {
            for ring in 1..=4 {
                trial.set(&format!("spot.heat_flux[{ring}]"), 3e5 * noise(7 * n + ring));
            }
            trial.step(if n < 20 { 0.02 } else { 3.0 });
        }
        let bound = reduced.get("plate.error_bound_temperature");
        for name in ["a.temperature", "rim.temperature[1]", "rim.temperature[3]"] {
            let (wanted, found) = (full.get(name), reduced.get(name));
            assert!((wanted - found).abs() <= bound + 1e-9, "{name}: {wanted} {found}, {bound:e}");
        }
        assert!(bound < 1.0, "{bound}");
        assert!(reduced.heat_residual("plate") < 1e-12);
    }
}

fn mechanical(range: &str) -> String {
    let material = "{ model = \"thermoelastic\", density = 3950.0, specific_heat = 900.0, conductivity = 10.0, \
                    young = 300e9, poisson = 0.21, expansion = 8.1e-6 }";
    let faces = "stress_free_temperature = 340.0\n[body.plate.faces]\nsides = { clamped = true }";
    let rest = format!(
        "[[load]]\nname = \"spot\"\non = \"plate.top\"\ncarries = [\"heat_flux\", \"pressure\", \"shear\"]\n\
         footprint = {{ gaussian = {{ radius = 2e-4 }} }}\nstart = {{ x = 1e-4, y = -5e-5 }}\n{range}\n\
         [[probe]]\nname = \"a\"\nin = \"plate\"\nat = [0.5e-4, 0.0, -2e-5]\n\
         gives = [\"temperature\", \"stress\", \"max_principal\", \"displacement\"]\n"
    );
    boxed(material, faces, &rest)
}

#[test]
fn stress_and_displacement_stay_within_their_bounds() {
    let text = mechanical("");
    let [mut full, mut reduced] =
        ["full", "reduced"].map(|level| Trial::new(&at(level, &text, 1e-3)));
    let keys =
        ["stress_xx", "stress_zz", "stress_xy", "stress_yz", "displacement_x", "displacement_z"];
    for n in 0..6 {
        for trial in [&mut full, &mut reduced] {
            trial.set("spot.heat_flux", 3e7 * noise(n));
            trial.set("spot.pressure", 1e6 * noise(n + 10));
            trial.set("spot.shear_x", 1e6 * noise(n + 20));
            // What acts at once is within the bounds before the step, too.
            if n % 2 == 0 {
                trial.step(1e-4);
            }
        }
        for key in keys {
            let name = format!("a.{key}");
            let (wanted, found) = (full.get(&name), reduced.get(&name));
            let (kind, rounding) =
                if key.starts_with("stress") { ("stress", 1.0) } else { ("displacement", 1e-15) };
            let bound = reduced.get(&format!("plate.error_bound_{kind}"));
            assert!(
                (wanted - found).abs() <= bound + rounding,
                "{name}: {wanted} {found}, {bound:e}"
            );
        }
        // A measure of stress moves by no more than thrice its components.
        let bound = 3.0 * reduced.get("plate.error_bound_stress") + 10.0;
        for key in ["von_mises", "max_principal"] {
            let name = format!("a.{key}");
            assert!((full.get(&name) - reduced.get(&name)).abs() <= bound, "{name}");
        }
    }
    assert!(reduced.get("plate.error_bound_stress") < 1e6);
}

#[test]
fn footprints_move_within_their_range() {
    let text = mechanical("range = { x = [-3e-4, 3e-4] }")
        .replace("\"stress\", \"max_principal\", \"displacement\"", "\"stress\"");
    let [mut full, mut reduced] =
        ["full", "reduced"].map(|level| Trial::new(&at(level, &text, 1e-3)));
    for n in 0..12 {
        for trial in [&mut full, &mut reduced] {
            trial.state.derivatives.clear();
            trial.set("spot.heat_flux", 3e7);
            trial.set("spot.x", -3e-4 + 5e-5 * f64::from(n));
            trial.set_derivative("spot.x", 1, 0.5);
            trial.step(1e-4);
        }
        let bound = reduced.get("plate.error_bound_temperature");
        let (wanted, found) = (full.get("a.temperature"), reduced.get("a.temperature"));
        assert!((wanted - found).abs() <= bound, "{n}: {wanted} {found}, {bound:e}");
        assert!(bound < 10.0, "{bound}");
    }
    // Nor is there a rate by a place that is held.
    let names = ["a.temperature".to_owned()];
    assert!(reduced.try_changes(&names, &[("spot.x", 1.0)]).is_ok());
    assert!(reduced.try_changes(&names, &[("spot.y", 1.0)]).is_err());
    let place = reduced.input("spot.y");
    reduced.state.inputs[place] += 1e-5;
    let refused = reduced.try_step(1e-4).unwrap_err().to_string();
    assert!(refused.contains("moves spot, whose footprint a reduced model holds"), "{refused}");
}

/// Loads that start with an amount, on planes of symmetry, at other supporting points of their ranges and between them,
/// keep the tolerance wherever they go.
#[test]
fn footprints_keep_the_tolerance_off_the_place_where_they_start() {
    const TOLERANCE: f64 = 1e-3;
    for [x, least] in [[0.0, -3e-4], [1e-4, -3e-4], [0.0, 0.0]] {
        let start = format!("start = {{ x = {x:e}, y = 0.0, heat_flux = 3e7 }}");
        let text = mechanical(&format!("range = {{ x = [{least:e}, 3e-4] }}"))
            .replace("\"stress\", \"max_principal\", \"displacement\"", "\"stress\"")
            .replace("\"pressure\", \"shear\"", "")
            .replace("start = { x = 1e-4, y = -5e-5 }", &start);
        for place in [3e-4, 0.8 * least, 1.3e-4, x] {
            let [mut full, mut reduced] =
                ["full", "reduced"].map(|level| Trial::new(&at(level, &text, TOLERANCE)));
            let (mut apart, mut range) = ([0.0_f64; 2], [0.0_f64; 2]);
            for _ in 0..10 {
                for trial in [&mut full, &mut reduced] {
                    trial.set("spot.x", place);
                    trial.step(1e-4);
                }
                for (n, key) in ["temperature", "stress_xx"].into_iter().enumerate() {
                    let [wanted, found] =
                        [&mut full, &mut reduced].map(|trial| trial.get(&format!("a.{key}")));
                    let rest = if n == 0 { 300.0 } else { 0.0 };
                    apart[n] = apart[n].max((wanted - found).abs());
                    range[n] = range[n].max((wanted - rest).abs());
                }
            }
            for n in 0..2 {
                let part = apart[n] / range[n];
                assert!(part < TOLERANCE, "{x:e} to {place:e}: {part:e} of {n}");
            }
            let bound = reduced.get("plate.error_bound_temperature");
            assert!(apart[0] <= bound && bound < 0.1 * range[0], "{bound:e} of {}", range[0]);
            assert!(reduced.heat_residual("plate") < 1e-12);
        }
    }
}

#[test]
fn derivatives_are_the_limit_of_differences_and_states_go_on_to_the_bit() {
    let text = at("reduced", &mechanical(""), 1e-3);
    let mut trial = Trial::new(&text);
    trial.set("spot.heat_flux", 3e7);
    trial.set("spot.pressure", 1e6);
    trial.step(2e-4);
    let names: Vec<String> =
        ["a.temperature", "a.stress_xx", "a.von_mises", "plate.heat_stored", "plate.heat_in"]
            .map(String::from)
            .to_vec();
    let (saved, rates) = (trial.state.clone(), trial.rates(&names));
    let values = |trial: &mut Trial| names.iter().map(|name| trial.get(name)).collect::<Vec<f64>>();
    let before = values(&mut trial);
    let h = 1e-8;
    trial.step(h);
    let after = values(&mut trial);
    trial.restart(&saved);
    trial.step(2.0 * h);
    let later = values(&mut trial);
    for (i, name) in names.iter().enumerate() {
        let difference = (4.0 * after[i] - later[i] - 3.0 * before[i]) / (2.0 * h);
        assert!(
            (difference - rates[i]).abs() <= 1e-3 * rates[i].abs(),
            "{name}: {difference} {}",
            rates[i]
        );
    }
    trial.restart(&saved);
    trial.step(h);
    assert_eq!(values(&mut trial), after);
    // Unknowns that no loads lead to are refused.
    let mut forged = saved.clone();
    forged.bodies[0][1] = 1e3 * forged.bodies[0][1].abs().max(1e9);
    assert!(trial.model.check_state(&saved).is_ok());
    assert!(trial.model.check_state(&forged).is_err());
}
