//! Bodies that creep, against closed forms.

use closed_form::quadrature::integrate;
use impinge::model::Cache;
use impinge::runtime::allowance::{Allowance, Interrupt};

use crate::common::{Trial, off};

/// E, ν, α, σ_y, and A, n, T_a of lead, tin, copper, steel, glass and aerogel near the temperatures at which they creep
/// within seconds.
struct Material {
    young: f64,
    poisson: f64,
    creep: [f64; 3],
    temperature: f64,
    /// Of the stress at time zero over the modulus.
    strain: f64,
}

const MATERIALS: [Material; 6] = [
    Material {
        young: 16e9,
        poisson: 0.44,
        creep: [3e-30, 4.5, 6e3],
        temperature: 400.0,
        strain: 4e-4,
    },
    Material {
        young: 40e9,
        poisson: 0.36,
        creep: [1e-42, 6.6, 5e3],
        temperature: 380.0,
        strain: 5e-4,
    },
    Material {
        young: 80e9,
        poisson: 0.35,
        creep: [1e-34, 4.8, 0.0],
        temperature: 900.0,
        strain: 3e-4,
    },
    Material {
        young: 150e9,
        poisson: 0.3,
        creep: [1e-45, 5.0, 9e3],
        temperature: 1100.0,
        strain: 4e-4,
    },
    Material {
        young: 65e9,
        poisson: 0.2,
        creep: [4e-12, 1.0, 0.0],
        temperature: 900.0,
        strain: 1e-3,
    },
    Material {
        young: 1e6,
        poisson: 0.2,
        creep: [2e-7, 1.0, 0.0],
        temperature: 300.0,
        strain: 1e-2,
    },
];

impl Material {
    /// A e^{−T_a/T}.
    fn rate(&self) -> f64 {
        let [coefficient, _, activation] = self.creep;
        coefficient * (-activation / self.temperature).exp()
    }

    fn text(&self, more: &str) -> String {
        let [coefficient, exponent, activation] = self.creep;
        format!(
            "model = \"viscoplastic\", density = 8000.0, specific_heat = 400.0, conductivity = 50.0, young = {:e}, \
             poisson = {:?}, expansion = 1e-5, creep = {{ coefficient = {coefficient:e}, exponent = {exponent:?}, \
             activation_temperature = {activation:e} }}{more}",
            self.young, self.poisson
        )
    }

    /// Time in which creep would make as much strain as there is elastic strain at first.
    fn time(&self) -> f64 {
        self.strain / (self.rate() * (self.young * self.strain).powf(self.creep[1]))
    }
}

fn scene(shape: &str, material: &str, [start, free]: [f64; 2], faces: &str, rest: &str) -> String {
    format!(
        "name = \"Creep\"\nstop_time = 1.0\nstep = 0.1\n[body.bar]\nkind = \"solid\"\nshape = {{ {shape} }}\n\
         initial_temperature = {start:?}\nstress_free_temperature = {free:?}\nmaterial = {{ {material} }}\n\
         mesh = {{ spacing = 5e-3, depth_spacing = 5e-3, growth = 1.0 }}\n[body.bar.faces]\n{faces}\n{rest}"
    )
}

const PROBE: &str = "[[probe]]\nname = \"inside\"\nin = \"bar\"\nat = [0.0, 0.0, -5e-3]\n\
                     gives = [\"stress\", \"plastic_strain\", \"displacement\"]\n";
const BAR: &str = "box = [2e-2, 1e-2, 1e-2]";
const HELD: &str = "left = { roller = true }\nright = { roller = true }\nfront = { roller = true }\nbottom = { roller = true }";

/// A bar that has been held since it was hotter.
fn held(material: &Material, more: &str, tolerance: f64) -> Trial {
    // An increment may err by a tenth of it.
    let tolerance = 10.0 * tolerance;
    let free = material.temperature + material.strain / 1e-5;
    let rest = format!("{PROBE}[fidelity]\ntolerance = {tolerance:e}\n");
    Trial::new(&scene(BAR, &material.text(more), [material.temperature, free], HELD, &rest))
}

/// Stress of a bar at fixed strain after some time.
fn relaxed(material: &Material, time: f64) -> f64 {
    let (first, n) = (material.young * material.strain, material.creep[1]);
    let rate = material.rate() * material.young;
    if n == 1.0 {
        return first * (-rate * time).exp();
    }
    (first.powf(1.0 - n) + (n - 1.0) * rate * time).powf(1.0 / (1.0 - n))
}

#[test]
fn a_held_bar_relaxes_as_norton_says() {
    for material in &MATERIALS {
        let mut trial = held(material, "", 1e-3);
        let first = material.young * material.strain;
        assert!(off(trial.get("inside.stress_xx"), first) < 1e-9, "{}", material.young);
        let mut time = 0.0;
        for step in [0.1, 0.9, 9.0].map(|part| part * material.time()) {
            trial.step(step);
            time += step;
            let (found, wanted) = (trial.get("inside.stress_xx"), relaxed(material, time));
            // Of the stress at first: what relaxes exponentially comes to nothing.
            assert!((found - wanted).abs() < 2e-3 * first, "{}: {found} {wanted}", material.young);
            // All that elastic strain has lost has become plastic.
            let plastic = (first - found) / material.young;
            assert!(off(trial.get("inside.plastic_strain"), plastic) < 1e-6, "{}", material.young);
            // So has its energy been dissipated, but for what is of second order in the inner steps.
            let work = 0.5 * (first * first - found * found) / material.young * 2e-6;
            assert!(off(trial.get("bar.plastic_work"), work) < 5e-3, "{}", material.young);
        }
    }
}

/// Flow in proportion to stress relaxes alike from any stress, however small.
#[test]
fn linear_creep_relaxes_alike_at_any_strain() {
    let linear = || MATERIALS.iter().filter(|material| material.creep[1] == 1.0);
    for material in linear() {
        for strain in [1e-7, 1e-9] {
            let faint = Material { strain, ..*material };
            let mut trial = held(&faint, "", 1e-3);
            trial.step(faint.time());
            let ratio = trial.get("inside.stress_xx") / (faint.young * strain);
            assert!((ratio - (-1.0_f64).exp()).abs() < 0.01, "{strain}: {ratio}");
        }
    }
}

/// Errors of steps go as the cube of their length, so those of all steps together as the power 2/3 of the tolerance.
#[test]
fn the_error_of_creep_falls_with_its_tolerance() {
    let material = &MATERIALS[0];
    let errors = [1e-3, 1e-4, 1e-5].map(|tolerance| {
        let mut trial = held(material, "", tolerance);
        trial.step(material.time());
        let wanted = relaxed(material, material.time());
        off(trial.get("inside.stress_xx"), wanted)
    });
    for pair in errors.windows(2) {
        let order = (pair[0] / pair[1]).log10();
        assert!((0.55..0.8).contains(&order), "{errors:?}");
    }
}

/// In one step a bar is loaded ever more while its temperature rises: `p = ∫ A e^{−T_a/T} (σ_b sinh(σ/σ_b))ⁿ dt`.
#[test]
fn creep_that_accelerates_keeps_the_tolerance() {
    let [coefficient, exponent, activation, breakdown] = [3.3e-27, 4.0, 8e3, 25e6_f64];
    let (duration, heating, [low, high]) = (1e3, 0.1, [5e6, 30e6]);
    let rate = |part: f64| {
        let temperature = 400.0 + heating * duration * part;
        let stress = breakdown * ((low + part * (high - low)) / breakdown).sinh();
        coefficient * (-activation / temperature).exp() * stress.powf(exponent)
    };
    let wanted = integrate(rate, &[0.0, 0.25, 0.5, 0.75, 1.0]) * duration;
    let material = format!(
        "model = \"viscoplastic\", density = 2700.0, specific_heat = 900.0, conductivity = 4000.0, young = 70e9, \
         poisson = 0.3, expansion = 2e-5, creep = {{ coefficient = {coefficient:e}, exponent = {exponent:?}, \
         activation_temperature = {activation:?}, breakdown = {breakdown:?} }}"
    );
    let faces = "left = { roller = true }\nfront = { roller = true }\nbottom = { roller = true, temperature = 400.0 }\n\
                 top = { temperature = 400.0 }";
    let load = "[[load]]\nname = \"pull\"\non = \"bar.top\"\nfootprint = { tiles = { count = [1, 1], size = [2e-2, 1e-2] } \
                }\ncarries = [\"pressure\"]\nstart = { pressure = -5e6 }\n";
    for tolerance in [1e-2, 1e-3, 1e-4] {
        let rest = format!("{load}{PROBE}[fidelity]\ntolerance = {tolerance:e}\n");
        let mut trial = Trial::new(&scene(BAR, &material, [400.0; 2], faces, &rest));
        for face in ["top", "bottom"] {
            trial.set_derivative(&format!("bar.{face}.temperature"), 1, heating);
        }
        trial.set_derivative("pull.pressure[1,1]", 1, -(high - low) / duration);
        trial.step(duration);
        let found = trial.get("inside.plastic_strain");
        assert!(off(found, wanted) < 0.3 * tolerance, "{tolerance}: {found} {wanted}");
    }
}

/// Elements of layers project their change of volume, so stress that is read differs from that in which they flow.
#[test]
fn layers_creep_in_long_steps_at_a_close_tolerance() {
    let strains = [1e-3, 1e-5].map(|tolerance| {
        let shared = "density = 8000.0, specific_heat = 400.0, conductivity = 5e3, poisson = 0.35";
        let layers = [
            "\"viscoplastic\", young = 40e9, expansion = 2.4e-5, creep = { coefficient = 1e-36, exponent = 4.5 }",
            "\"elastoplastic\", young = 110e9, expansion = 1.7e-5, yield_stress = 4e6, isotropic_hardening = 3e9",
            "\"thermoelastic\", young = 10e9, expansion = 1e-5",
        ]
        .map(|law| {
            format!("[[body.pad.layers]]\nthickness = 0.5e-3\nmaterial = {{ model = {law}, {shared} }}\n")
        });
        let mut trial = Trial::new(&format!(
            "name = \"Pad\"\nstop_time = 15.0\nstep = 5.0\nfidelity = {{ tolerance = {tolerance:e} }}\n[body.pad]\n\
             kind = \"solid\"\nshape = {{ disc = {{ radius = 2e-3, thickness = 1.5e-3 }} }}\n\
             initial_temperature = 400.0\nmesh = {{ spacing = 0.5e-3, depth_spacing = 0.25e-3, growth = 1.0 }}\n\
             [body.pad.faces]\nbottom = {{ temperature = 400.0, roller = true }}\ntop = {{ temperature = 400.0 }}\n{}\
             [[probe]]\nname = \"solder\"\nin = \"pad\"\nat = [1e-3, 0.0, -0.2e-3]\ngives = [\"plastic_strain\"]\n",
            layers.concat()
        ));
        for face in ["top", "bottom"] {
            trial.set_derivative(&format!("pad.{face}.temperature"), 1, 2.0);
        }
        (0..3).for_each(|_| trial.step(5.0));
        trial.get("solder.plastic_strain")
    });
    assert!(strains[1] > 1e-6 && off(strains[0], strains[1]) < 5e-3, "{strains:?}");
}

#[test]
fn under_a_constant_pressure_creep_is_steady() {
    for material in &MATERIALS {
        let pressure = material.young * material.strain;
        let load = format!(
            "[[load]]\nname = \"press\"\non = \"bar.top\"\nfootprint = {{ tiles = {{ count = [1, 1], size = [2e-2, 1e-2] }} }}\n\
             carries = [\"pressure\"]\nstart = {{ pressure = {pressure:e} }}\n"
        );
        let faces =
            "left = { roller = true }\nfront = { roller = true }\nbottom = { roller = true }";
        let top = PROBE.replace("-5e-3]", "0.0]");
        let text = scene(BAR, &material.text(""), [material.temperature; 2], faces, &(load + &top));
        let mut trial = Trial::new(&text);
        let rate = material.rate() * pressure.powf(material.creep[1]);
        for step in [0.2, 0.8, 2.0].map(|part| part * material.time()) {
            trial.step(step);
            let strain = rate * trial.state.time;
            assert!(off(trial.get("inside.plastic_strain"), strain) < 1e-8, "{}", material.young);
            let wanted = -1e-2 * (strain + material.strain);
            let found = trial.get("inside.displacement_z");
            assert!(off(found, wanted) < 1e-8, "{}: {found} {wanted}", material.young);
            assert!(off(trial.get("inside.stress_zz"), -pressure) < 1e-8, "{}", material.young);
            let work = pressure * strain * 2e-6;
            assert!(off(trial.get("bar.plastic_work"), work) < 1e-8, "{}", material.young);
        }
    }
}

/// Tin-silver-copper solder at 400 K: E, ν and a sinh law of the kind that measurements of it are fitted by.
#[test]
fn creep_beyond_the_power_law_is_steady() {
    let [coefficient, exponent, activation, breakdown] = [5e-35_f64, 6.0, 5e3, 10e6_f64];
    let material = Material {
        young: 45e9,
        poisson: 0.36,
        creep: [coefficient, exponent, activation],
        temperature: 400.0,
        strain: 0.0,
    };
    let text = material.text("").replace(
        "activation_temperature",
        &format!("breakdown = {breakdown:e}, activation_temperature"),
    );
    let faces = "left = { roller = true }\nfront = { roller = true }\nbottom = { roller = true }";
    let top = PROBE.replace("-5e-3]", "0.0]");
    for pressure in [1e6, 10e6, 40e6] {
        let load = format!(
            "[[load]]\nname = \"press\"\non = \"bar.top\"\nfootprint = {{ tiles = {{ count = [1, 1], size = [2e-2, 1e-2] }} }}\n\
             carries = [\"pressure\"]\nstart = {{ pressure = {pressure:e} }}\n"
        );
        let mut trial = Trial::new(&scene(BAR, &text, [400.0; 2], faces, &(load + &top)));
        let effective = breakdown * (pressure / breakdown).sinh();
        let rate = material.rate() * effective.powf(exponent);
        let elastic = pressure / material.young;
        for step in [0.2, 0.8, 2.0].map(|part| part * elastic / rate) {
            trial.step(step);
            let strain = rate * trial.state.time;
            let found = trial.get("inside.plastic_strain");
            assert!(off(found, strain) < 1e-8, "{pressure}: {found} {strain}");
            let found = trial.get("inside.displacement_z");
            assert!(off(found, -1e-2 * (strain + elastic)) < 1e-8, "{pressure}: {found}");
        }
    }
}

#[test]
fn flow_that_is_fast_is_plasticity_and_flow_that_is_slow_elasticity() {
    let plain = Material {
        young: 200e9,
        poisson: 0.3,
        creep: [1.0, 1.0, 0.0],
        temperature: 300.0,
        strain: 0.0,
    };
    let hardens = ", yield_stress = 250e6, isotropic_hardening = 2e9, kinematic_hardening = 1e9";
    let faces = HELD
        .replace("bottom = { roller = true }", "bottom = { roller = true, temperature = 300.0 }")
        + "\ntop = { temperature = 300.0 }";
    let of = |coefficient: f64, exponent: f64, model: &str| {
        let material = Material { creep: [coefficient, exponent, 0.0], ..plain };
        let text = match model {
            "viscoplastic" => material.text(hardens),
            _ => {
                let text = material.text(if model == "elastoplastic" { hardens } else { "" });
                let (first, rest) = text.split_once(", creep = ").unwrap();
                let more = rest.split_once('}').unwrap().1;
                first.replace("viscoplastic", model) + more
            }
        };
        let text = text.replace("conductivity = 50.0", "conductivity = 1e8");
        let probe = match model {
            "thermoelastic" => PROBE.replace("\"plastic_strain\", ", ""),
            _ => PROBE.to_owned(),
        };
        let mut trial = Trial::new(&scene(BAR, &text, [300.0; 2], &faces, &probe));
        let mut found = Vec::new();
        // Evenly warm and cold: what flows at once goes straight on in each step, what takes time does not.
        for rate in [1.0, 2.0, -3.0] {
            for face in ["top", "bottom"] {
                trial.set_derivative(&format!("bar.{face}.temperature"), 1, rate);
            }
            (0..2).for_each(|_| trial.step(50.0));
            found.push(trial.get("inside.stress_xx"));
        }
        found
    };
    let plastic = of(1.0, 1.0, "elastoplastic");
    for (fast, exponent) in [(1e-5, 1.0), (1e-12, 3.0)] {
        for (found, wanted) in of(fast, exponent, "viscoplastic").iter().zip(&plastic) {
            assert!((found - wanted).abs() < 1e-3 * 250e6, "{exponent}: {found} {wanted}");
        }
    }
    let elastic = of(1.0, 1.0, "thermoelastic");
    for (found, wanted) in of(1e-25, 1.0, "viscoplastic").iter().zip(&elastic) {
        assert!((found - wanted).abs() < 1e-6 * 250e6, "{found} {wanted}");
    }
}

#[test]
fn overstress_beyond_a_yield_stress_falls_exponentially() {
    // σ = σ_y + (σ₀ − σ_y) e^{−EAt} where n = 1.
    let material = Material {
        young: 100e9,
        poisson: 0.3,
        creep: [1e-11, 1.0, 0.0],
        temperature: 500.0,
        strain: 2e-3,
    };
    let mut trial = held(&material, ", yield_stress = 60e6", 1e-4);
    for _ in 0..3 {
        trial.step(0.6);
        let wanted = 60e6 + 140e6 * (-trial.state.time).exp();
        let found = trial.get("inside.stress_xx");
        assert!((found - wanted).abs() < 1e-3 * 200e6, "{found} {wanted}");
    }
}

#[test]
fn overstress_grows_from_first_yield_on_within_one_step() {
    // Strained at a rate r: σ = E r t up to σ_y at t_y, then σ_y + (r/A)(1 − e^{−EA(t − t_y)}).
    let material = Material {
        young: 100e9,
        poisson: 0.3,
        creep: [1e-11, 1.0, 0.0],
        temperature: 500.0,
        strain: 0.0,
    };
    let faces = HELD
        .replace("bottom = { roller = true }", "bottom = { roller = true, temperature = 500.0 }")
        + "\ntop = { temperature = 500.0 }";
    let text = material.text(", yield_stress = 60e6").replace("ivity = 50.0", "ivity = 1e8");
    let mut trial = Trial::new(&scene(BAR, &text, [500.0; 2], &faces, PROBE));
    for face in ["top", "bottom"] {
        trial.set_derivative(&format!("bar.{face}.temperature"), 1, -100.0);
    }
    trial.step(2.0);
    let wanted = 60e6 + 1e8 * (1.0 - (-1.4_f64).exp());
    let found = trial.get("inside.stress_xx");
    assert!((found - wanted).abs() < 0.01 * wanted, "{found} {wanted}");
}

#[test]
fn creep_goes_on_to_the_bit_and_what_cannot_be_borne_is_refused() {
    let material = &MATERIALS[0];
    let disc = scene(
        "disc = { radius = 1e-2, thickness = 1e-2 }",
        &material.text(""),
        [material.temperature, material.temperature + 40.0],
        "sides = { clamped = true }\nbottom = { convection = { coefficient = 1e3, ambient = 350.0 } }",
        PROBE,
    );
    let mut trial = Trial::new(&disc);
    trial.step(5.0);
    let saved = trial.state.clone();
    trial.step(5.0);
    assert!(trial.heat_residual("bar") < 1e-9);
    let mut other = Trial::on_threads(&disc, 3);
    other.restart(&saved);
    other.step(5.0);
    assert_eq!(other.state, trial.state);
    // A rate beyond all numbers.
    let mad = Material { creep: [1e300, 50.0, 0.0], ..MATERIALS[0] };
    let mut trial = held(&mad, "", 1e-3);
    let before = trial.state.clone();
    let refused = trial.try_step(1.0).unwrap_err().to_string();
    assert!(refused.contains("bar") && refused.contains("creep"), "{refused}");
    assert_eq!(trial.state.bodies, before.bodies);
}

/// Inner steps count: a step ends where they come to more than it may take, or when it is cancelled.
#[test]
fn steps_in_which_much_creeps_end_as_soon_as_they_are_not_wanted() {
    let material = &MATERIALS[3];
    let mut trial = held(material, "", 1e-3);
    let before = trial.state.clone();
    let Trial { model, state, .. } = &mut trial;
    let little = Allowance::of_updates(&Interrupt::default(), 2e6);
    let halted = model.step_within(
        &little,
        state,
        &mut Cache::default(),
        (material.time(), material.time()),
    );
    let message = halted.unwrap_err().to_string();
    assert!(message.contains("iterations of equilibrium"), "{message}");
    assert_eq!(state.bodies, before.bodies);
    let interrupt = Interrupt::default();
    let under_way = interrupt.begin();
    assert!(interrupt.interrupt());
    let allowance = Allowance::of_step(&interrupt);
    let cancelled = model.step_within(
        &allowance,
        state,
        &mut Cache::default(),
        (material.time(), material.time()),
    );
    assert!(cancelled.unwrap_err().to_string().contains("cancelled"));
    assert_eq!(state.bodies, before.bodies);
    drop(under_way);
    trial.step(material.time());
}
