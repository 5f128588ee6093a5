//! Flow that begins and ends within a step, and layers of different laws in one body, against integrations of their own.

use crate::common::{Trial, off};

/// A disc that is held at its rim, and may slide on its bottom.
fn film(made_of: &str, keys: &str) -> String {
    format!(
        "name = \"Film\"\nstop_time = 100.0\nstep = 10.0\nfidelity.tolerance = 1e-3\n[body.film]\nkind = \"solid\"\n{made_of}\n\
         {keys}\n[[probe]]\nname = \"p\"\nin = \"film\"\nat = [2e-4, 0.0, -5e-5]\ngives = [\"stress\"]\n"
    )
}

const TABLE: [[f64; 4]; 2] = [[300.0, 360.0, 370.0, 380.0], [110e6, 60e6, 2e6, 1e6]];

fn yield_stress(temperature: f64) -> f64 {
    let [at, values] = TABLE;
    let n = (0..3).rfind(|&n| temperature >= at[n]).unwrap_or(0);
    let part = ((temperature - at[n]) / (at[n + 1] - at[n])).clamp(0.0, 1.0);
    values[n] + part * (values[n + 1] - values[n])
}

/// A held film of a polymer cools through its glass transition: it flows while it is warm, and at the end its yield
/// stress is far above its stress.
#[test]
fn polymers_that_cool_flow_while_they_are_warm() {
    let (young, poisson, expansion) = (3e9, 0.35, 7e-5);
    let (mut stress, count) = (0.0_f64, 120_000);
    for n in 1..=count {
        let step = 120.0 / f64::from(count);
        stress += young / (1.0 - poisson) * expansion * step;
        stress = stress.min(yield_stress(420.0 - step * f64::from(n)));
    }
    let made_of = format!(
        "shape = {{ disc = {{ radius = 1e-3, thickness = 1e-4 }} }}\ninitial_temperature = 420.0\n\
         mesh = {{ spacing = 5e-4, depth_spacing = 5e-5 }}\nmaterial = {{ model = \"elastoplastic\", density = 1190.0, \
         specific_heat = 1470.0, conductivity = 0.19, young = {young:e}, poisson = {poisson}, expansion = {expansion:e}, \
         yield_stress = {{ temperature = {:?}, value = {:?} }} }}",
        TABLE[0], TABLE[1]
    );
    let faces = "[body.film.faces]\ntop = { temperature = 420.0 }\nbottom = { temperature = 420.0, roller = true }\n\
                 sides = { roller = true }";
    for steps in [1, 2, 5, 20] {
        let mut trial = Trial::new(&film(&made_of, faces));
        for n in 0..steps {
            for face in ["film.top.temperature", "film.bottom.temperature"] {
                trial.set(face, 420.0 - 120.0 * f64::from(n) / f64::from(steps));
                trial.set_derivative(face, 1, -1.2);
            }
            trial.step(100.0 / f64::from(steps));
        }
        let found = trial.get("p.stress_xx");
        assert!(off(found, stress) < 0.02, "{steps} steps: {found} instead of {stress}");
    }
}

/// A layer that relaxes errs no more beside one that creeps, but by nothing, than beside an elastic one.
#[test]
fn layers_that_relax_keep_the_tolerance_beside_creep() {
    let constants = "density = 8000.0, specific_heat = 400.0, conductivity = 400.0, young = 3e9";
    let visco = format!(
        "model = \"viscoelastic\", {constants}, poisson = 0.36, expansion = 6e-5, \
         shear_relaxation = [{{ fraction = 0.9, time = 2.0 }}]"
    );
    let faces = "[body.film.faces]\ntop = { temperature = 300.0 }\nbottom = { temperature = 300.0, roller = true }";
    let changes = [[300.0, 390.0], [390.0, 390.0], [390.0, 310.0], [310.0, 300.0], [300.0, 380.0]];
    let stresses = |law: &str| {
        let made_of = format!(
            "shape = {{ disc = {{ radius = 2e-2, thickness = 2e-4 }} }}\ninitial_temperature = 300.0\n\
             mesh = {{ spacing = 5e-3, depth_spacing = 1e-4 }}\nlayers = [{{ material = {{ {visco} }}, thickness = 1e-4 }}, \
             {{ material = {{ {law}, {constants}, poisson = 0.2, expansion = 4e-6 }}, thickness = 1e-4 }}]"
        );
        let mut trial = Trial::new(&film(&made_of, faces));
        changes.map(|[from, to]| {
            for face in ["film.top.temperature", "film.bottom.temperature"] {
                trial.set(face, from);
                trial.set_derivative(face, 1, (to - from) / 10.0);
            }
            trial.step(10.0);
            trial.get("p.stress_xx")
        })
    };
    let alone = stresses("model = \"thermoelastic\"");
    let beside =
        stresses("model = \"viscoplastic\", creep = { coefficient = 1e-60, exponent = 5.0 }");
    let most = alone.iter().fold(0.0_f64, |most, own| most.max(own.abs()));
    for (alone, beside) in alone.iter().zip(&beside) {
        assert!((alone - beside).abs() < 2e-3 * most, "{alone:?} {beside:?}");
    }
}

/// A bar in plane strain whose lateral stress turns while it flows: with a step for each leg of a cycle it is 6 % off,
/// its plastic strain 0.5 % (`docs/limits.md`).
#[test]
fn stress_that_turns_follows_the_step() {
    let text = "name = \"Bar\"\nstop_time = 60.0\nstep = 10.0\n[body.bar]\nkind = \"solid\"\nshape = { box = [1e-3, 1e-3, 1e-3] }\n\
                initial_temperature = 400.0\nsymmetry = \"none\"\nmesh = { spacing = 5e-4, depth_spacing = 5e-4 }\n\
                material = { model = \"elastoplastic\", density = 8000.0, specific_heat = 400.0, conductivity = 40.0, \
                young = 200e9, poisson = 0.3, expansion = 1e-5, yield_stress = 200e6, kinematic_hardening = 10e9, \
                isotropic_hardening = 5e9 }\n[body.bar.faces]\nbottom = { roller = true }\nleft = { roller = true }\n\
                front = { roller = true }\nback = { roller = true }\n[[load]]\nname = \"press\"\non = \"bar.top\"\n\
                footprint = { tiles = { count = [1, 1], size = [1e-3, 1e-3] } }\ncarries = [\"pressure\"]\n\
                start.pressure = 0.0\n[[probe]]\nname = \"p\"\nin = \"bar\"\nat = [2e-4, 1e-4, -5e-4]\n\
                gives = [\"stress\", \"plastic_strain\"]\n";
    let legs = [[0.0, 250e6], [250e6, -300e6], [-300e6, -300e6], [-300e6, 350e6]];
    let [whole, fine] = [1, 20].map(|steps| {
        let mut trial = Trial::new(text);
        for [from, to] in legs {
            for n in 0..steps {
                let part = f64::from(n) / f64::from(steps);
                trial.set("press.pressure[1,1]", from + part * (to - from));
                trial.set_derivative("press.pressure[1,1]", 1, (to - from) / 10.0);
                trial.step(10.0 / f64::from(steps));
            }
        }
        ["stress_yy", "plastic_strain"].map(|key| trial.get(&format!("p.{key}")))
    });
    let [stress, strain] = [0, 1].map(|n| off(whole[n], fine[n]));
    assert!((0.05..0.07).contains(&stress) && strain < 6e-3, "{whole:?} {fine:?}");
}

/// The work of flow takes the yield stress of the end of each step: where two steps heat a held film, it is a third
/// too low (`docs/limits.md`), while stress is right.
#[test]
fn work_of_flow_with_a_table_follows_the_step() {
    let made_of = "shape = { disc = { radius = 1e-3, thickness = 1e-4 } }\ninitial_temperature = 300.0\n\
                   mesh = { spacing = 5e-4, depth_spacing = 5e-5 }\nmaterial = { model = \"elastoplastic\", density = 8000.0, \
                   specific_heat = 400.0, conductivity = 400.0, young = 160e9, poisson = 0.3, expansion = 12e-6, \
                   yield_stress = { temperature = [300.0, 700.0], value = [300e6, 80e6] }, kinematic_hardening = 5e9 }";
    let faces = "[body.film.faces]\ntop = { temperature = 300.0 }\nbottom = { temperature = 300.0, roller = true }\n\
                 sides = { roller = true }";
    let [whole, fine] = [1, 64].map(|steps| {
        let mut trial = Trial::new(&film(made_of, faces));
        for [from, to] in [[300.0, 400.0], [400.0, 650.0]] {
            for n in 0..steps {
                for face in ["film.top.temperature", "film.bottom.temperature"] {
                    trial.set(face, from + (to - from) * f64::from(n) / f64::from(steps));
                    trial.set_derivative(face, 1, to - from);
                }
                trial.step(1.0 / f64::from(steps));
            }
        }
        [trial.get("p.stress_xx"), trial.get("film.plastic_work")]
    });
    assert!(off(whole[0], fine[0]) < 1e-4, "{whole:?} {fine:?}");
    assert!((0.25..0.4).contains(&off(whole[1], fine[1])), "{whole:?} {fine:?}");
}
