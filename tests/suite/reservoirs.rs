//! Bodies of one temperature, alone and below or above solids.

use crate::common::{Trial, off};

/// Density, specific heat and conductivity.
type Material = [f64; 3];

const COPPER: Material = [8960.0, 385.0, 400.0];
const ALUMINA: Material = [3950.0, 900.0, 10.0];
const AEROGEL: Material = [100.0, 1000.0, 0.015];
const MERCURY: Material = [13534.0, 139.5, 8.3];
const GLASS: Material = [2500.0, 840.0, 1.0];
const DIAMOND: Material = [3515.0, 510.0, 2200.0];

fn reservoir(name: &str, capacity: f64, temperature: f64, rest: &str) -> String {
    format!(
        "[body.{name}]\nkind = \"reservoir\"\nheat_capacity = {capacity:e}\ninitial_temperature = {temperature:?}\n{rest}\n"
    )
}

fn plate(
    name: &str,
    shape: &str,
    [density, heat, conductivity]: Material,
    mesh: &str,
    temperature: f64,
) -> String {
    format!(
        "[body.{name}]\nkind = \"solid\"\nshape = {{ {shape} }}\ninitial_temperature = {temperature:?}\n\
         mesh = {{ {mesh} }}\nmaterial = {{ model = \"thermoelastic\", density = {density:?}, \
         specific_heat = {heat:?}, conductivity = {conductivity:?} }}\n"
    )
}

fn scene(bodies: &str, rest: &str) -> String {
    format!("name = \"Lumps\"\nstop_time = 1.0\nstep = 0.1\n{bodies}{rest}")
}

fn coupling(from: &str, to: &str, conductance: f64, interval: f64) -> String {
    format!(
        "[[coupling]]\nfrom = \"{from}\"\nto = \"{to}\"\nconductance = {conductance:e}\ninterval = {interval:e}\n"
    )
}

fn probe(name: &str, body: &str, z: f64) -> String {
    format!(
        "[[probe]]\nname = \"{name}\"\nin = \"{body}\"\nat = [0.0, 0.0, {z:?}]\ngives = [\"temperature\"]\n"
    )
}

#[test]
fn a_lump_decays_as_the_exponential_in_any_step() {
    // Of a thimble, a chuck, an ocean; decay that is slow, of a step and at once.
    for capacity in [1e-6, 400.0, 1e20] {
        for rate in [1e-9, 0.3, 1.0, 1.0 + 1e-9, 40.0, 1e7] {
            let conductance = rate * capacity;
            let rest = format!(
                "conductance = {conductance:e}\nambient = 280.0\nheating = {:e}",
                20.0 * conductance
            );
            let text = scene(&reservoir("chuck", capacity, 350.0, &rest), "");
            let [mut once, mut often] = [1, 7].map(|parts| {
                let mut trial = Trial::new(&text);
                (0..parts).for_each(|_| trial.step(1.0 / f64::from(parts)));
                trial
            });
            // It comes to 280 K and what the heating makes of it.
            let wanted = 300.0 + 50.0 * (-rate).exp();
            for trial in [&mut once, &mut often] {
                let found = trial.get("chuck.temperature");
                assert!(
                    (found - wanted).abs() < 1e-12 * wanted,
                    "{capacity} {rate}: {found} {wanted}"
                );
                let lost = capacity * (20.0 * rate + 50.0 * -(-rate).exp_m1());
                assert!(off(trial.get("chuck.heat_lost"), lost) < 1e-11, "{capacity} {rate}");
                assert!(trial.heat_residual("chuck") < 1e-11, "{capacity} {rate}");
            }
        }
    }
}

#[test]
fn a_lump_follows_inputs_that_are_quadratic_in_time() {
    // With P = P₀ + P₁ t + P₂ t²/2 and T∞ = A₀ + A₁ t the source of T' = −λT + s is s₀ + s₁ t + s₂ t²/2.
    let (capacity, rate) = (2.0, 0.7);
    let conductance: f64 = rate * capacity;
    let rest = format!("conductance = {conductance:?}\nambient = 290.0\nheating = 30.0");
    let mut trial = Trial::new(&scene(&reservoir("bath", capacity, 320.0, &rest), ""));
    trial.set_derivative("bath.heating", 1, -12.0);
    trial.set_derivative("bath.heating", 2, 8.0);
    trial.set_derivative("bath.ambient", 1, 3.0);
    let names =
        ["temperature", "heat_in", "heat_stored", "heat_lost"].map(|key| format!("bath.{key}"));
    let rates = trial.rates(&names);
    let lost = conductance * 30.0;
    for (found, wanted) in rates.iter().zip([(30.0 - lost) / capacity, 30.0, 30.0 - lost, lost]) {
        assert!((found - wanted).abs() < 1e-12 * lost, "{rates:?}");
    }
    let s = [30.0 / capacity + rate * 290.0, -12.0 / capacity + rate * 3.0, 8.0 / capacity];
    // A particular solution a + b t + c t²/2.
    let c = s[2] / rate;
    let b = (s[1] - c) / rate;
    let a = (s[0] - b) / rate;
    let exact = |t: f64| a + b * t + 0.5 * c * t * t + (320.0 - a) * (-rate * t).exp();
    for step in [0.4, 1.3, 0.3] {
        trial.step(step);
        let wanted = exact(trial.state.time);
        let found = trial.get("bath.temperature");
        assert!((found - wanted).abs() < 1e-12 * wanted, "{found} {wanted}");
    }
    let t = trial.state.time;
    assert!(off(trial.get("bath.heat_in"), 30.0 * t - 6.0 * t * t + 8.0 / 6.0 * t.powi(3)) < 1e-12);
    assert!(trial.heat_residual("bath") < 1e-12);
}

/// Temperatures of two lumps after a time: their system has two eigenvalues.
fn two_lumps(
    [c1, c2]: [f64; 2],
    link: f64,
    loss: f64,
    [t1, t2]: [f64; 2],
    ambient: f64,
    time: f64,
) -> [f64; 2] {
    let (a, b, c, d) = ((link + loss) / c1, -link / c1, -link / c2, link / c2);
    let (half, root) = (0.5 * (a + d), (0.25 * (a - d) * (a - d) + b * c).sqrt());
    let [fast, slow] = [half + root, half - root];
    let (u, v) = (t1 - ambient, t2 - ambient);
    // exp(−M t) = (e₁ (M − λ₂) − e₂ (M − λ₁))/(λ₁ − λ₂)
    let [e1, e2] = [(-fast * time).exp(), (-slow * time).exp()];
    let of = |m: [f64; 2], own: f64| {
        let applied = m[0] * u + m[1] * v;
        (e1 * (applied - slow * own) - e2 * (applied - fast * own)) / (fast - slow)
    };
    [ambient + of([a, b], u), ambient + of([c, d], v)]
}

#[test]
fn a_thin_plate_on_a_reservoir_goes_by_two_eigenvalues_at_third_order() {
    let (link, loss) = (1.0, 0.4);
    for (side, low) in [("below", 0.0), ("above", -2.0)] {
        let error = |parts: f64| {
            let bodies = reservoir("chuck", 0.5, 400.0, "conductance = 0.4\nambient = 290.0")
                + &plate(
                    "plate",
                    "box = [1.0, 1.0, 2.0]",
                    [1.0, 1.0, 1e9],
                    "spacing = 0.5, depth_spacing = 0.5",
                    300.0,
                );
            let contact = match side {
                "below" => coupling("chuck.top", "plate.bottom", link, 1.0 / parts),
                _ => coupling("plate.top", "chuck.bottom", link, 1.0 / parts),
            };
            let mut trial = Trial::new(&scene(&bodies, &(contact + &probe("spot", "plate", low))));
            trial.step(1.0);
            let [inward, outward] = ["plate.heat_in", "chuck.heat_in"].map(|name| trial.get(name));
            assert!((inward + outward).abs() < 1e-12 * inward.abs());
            assert!(trial.heat_residual("plate") < 1e-9 && trial.heat_residual("chuck") < 1e-9);
            let [chuck, wanted] = two_lumps([0.5, 2.0], link, loss, [400.0, 300.0], 290.0, 1.0);
            let off = (trial.get("chuck.temperature") - chuck).abs();
            off.max((trial.get("spot.temperature") - wanted).abs())
        };
        let errors = [4.0, 8.0, 16.0].map(error);
        for pair in errors.windows(2) {
            let order = (pair[0] / pair[1]).log2();
            assert!((2.7..3.3).contains(&order), "{side}: {errors:?}");
        }
        assert!(errors[2] < 1e-2, "{side}: {errors:?}");
    }
}

#[test]
fn a_reservoir_without_bounds_is_a_convective_face() {
    for material in [COPPER, ALUMINA, AEROGEL, MERCURY, GLASS, DIAMOND] {
        let [density, heat, conductivity] = material;
        let thickness = 1e-3;
        let time = thickness * thickness * density * heat / conductivity;
        // As much resistance as that of the plate.
        let conductance = conductivity / thickness;
        for shape in ["box = [4e-3, 3e-3, 1e-3]", "disc = { radius = 2e-3, thickness = 1e-3 }"] {
            let mesh = "spacing = 1e-3, depth_spacing = 1e-4, growth = 1.2";
            let own = plate("plate", shape, material, mesh, 300.0);
            let contact = coupling("bath.top", "plate.bottom", conductance, time / 64.0);
            let probes = probe("low", "plate", -thickness) + &probe("high", "plate", 0.0);
            let one =
                scene(&(own.clone() + &reservoir("bath", 1e25, 400.0, "")), &(contact + &probes));
            let face = format!(
                "[body.plate.faces]\nbottom = {{ convection = {{ coefficient = {conductance:e}, ambient = 400.0 }} }}\n"
            );
            let two = scene(&(own + &face), &probes);
            let [mut one, mut two] = [one, two].map(|text| Trial::new(&text));
            for trial in [&mut one, &mut two] {
                (0..4).for_each(|_| trial.step(time / 4.0));
            }
            for name in ["low.temperature", "high.temperature"] {
                let (found, wanted) = (one.get(name), two.get(name));
                assert!(
                    (found - wanted).abs() < 1e-4 * 100.0,
                    "{shape} {material:?} {name}: {found} {wanted}"
                );
            }
            let (found, wanted) = (one.get("plate.heat_in"), -two.get("plate.heat_lost"));
            assert!(off(found, wanted) < 1e-4, "{found} {wanted}");
            assert!(one.heat_residual("plate") < 1e-9 && one.heat_residual("bath") < 1e-9);
        }
    }
}

#[test]
fn several_solids_on_one_reservoir_share_its_heat() {
    let bodies = reservoir("bed", 3e-3, 380.0, "heating = 2.0\nconductance = 0.1\nambient = 290.0")
        + &plate("chip", "box = [4e-3, 3e-3, 1e-3]", ALUMINA, "spacing = 1e-3", 300.0)
        + &plate(
            "coin",
            "disc = { radius = 3e-3, thickness = 2e-3 }",
            COPPER,
            "spacing = 1e-3",
            290.0,
        )
        + &plate("lid", "box = [2e-3, 2e-3, 5e-4]", MERCURY, "spacing = 5e-4", 350.0);
    let contacts = coupling("bed.top", "chip.bottom", 3e3, 0.5)
        + &coupling("bed.top", "coin.bottom", 8e3, 0.5)
        + &coupling("lid.top", "bed.bottom", 1e3, 0.5);
    // Balances hold on any mesh.
    let coarse = |body| format!("[refinement.{body}]\nalong = 0.4\nthrough = 1.0\n");
    let text = scene(&bodies, &(contacts + &["chip", "lid"].map(coarse).concat()));
    let mut trial = Trial::new(&text);
    for _ in 0..5 {
        trial.step(0.2);
        let of_solids: f64 =
            ["chip", "coin", "lid"].map(|body| trial.get(&format!("{body}.heat_in"))).iter().sum();
        let heating = 2.0 * trial.state.time;
        let bed = trial.get("bed.heat_in");
        assert!(
            (bed - heating + of_solids).abs() < 1e-12 * of_solids.abs().max(heating),
            "{bed} {of_solids}"
        );
        for body in ["bed", "chip", "coin", "lid"] {
            assert!(trial.heat_residual(body) < 1e-9, "{body}");
        }
    }
    // In time all of them come to where the heating is lost: 290 K and P/G.
    (0..7).for_each(|_| trial.step(5.0));
    for name in
        ["bed.temperature", "chip.max_temperature", "coin.max_temperature", "lid.max_temperature"]
    {
        assert!((trial.get(name) - 310.0).abs() < 1e-3, "{name} {}", trial.get(name));
    }
    // On any number of threads, and from a saved state.
    let [mut one, mut other] = [1, 3].map(|threads| Trial::on_threads(&text, threads));
    for trial in [&mut one, &mut other] {
        trial.step(0.3);
    }
    assert_eq!(one.state, other.state);
    let saved = one.state.clone();
    one.step(0.3);
    other.restart(&saved);
    other.step(0.3);
    assert_eq!(one.state, other.state);
    one.model.check_state(&saved).unwrap();
}

#[test]
fn a_reservoir_is_not_cooled_below_absolute_zero() {
    let mut trial = Trial::new(&scene(&reservoir("chuck", 1.0, 300.0, "heating = -299.0"), ""));
    trial.step(1.0);
    let before = trial.state.clone();
    let refused = trial.try_step(1.0).unwrap_err().to_string();
    assert!(refused.contains("chuck") && refused.contains("absolute zero"), "{refused}");
    assert_eq!(trial.state.bodies, before.bodies);
}
