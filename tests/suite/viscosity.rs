//! Laws of viscosity in scenes: their forms and parameters, and results that equal those of a plain number.

use impinge::advice;
use impinge::laws::{Table, Viscosity};
use impinge::scene::{Body, Constant, Droplet, Scene, parse};

use crate::common::Trial;

const IMPACT: &str = include_str!("../scenes/impact.toml");

fn with(viscosity: &str) -> Scene {
    let text = IMPACT.replace("viscosity = 1e-3", &format!("viscosity = {viscosity}"));
    assert!(viscosity == "1e-3" || text != IMPACT);
    parse(&text, "scene.toml").unwrap_or_else(|error| panic!("{error}"))
}

fn droplet(scene: &Scene) -> &Droplet {
    scene.droplets().next().unwrap().1
}

/// The impact with a viscosity over the temperature.
fn over_temperature(temperature: [f64; 2], value: [f64; 2]) -> Scene {
    let mut scene = with("1e-3");
    for body in scene.body.values_mut() {
        if let Body::Droplet(droplet) = body {
            let (temperature, value) = (temperature.to_vec(), value.to_vec());
            droplet.fluid.viscosity = Viscosity::Table(Table { temperature, value });
        }
    }
    scene
}

#[test]
fn every_form_of_a_constant_viscosity_gives_the_same_bits() {
    let run = |viscosity: &str| {
        let scene = with(viscosity);
        let step = scene.step;
        let mut trial = Trial::of(scene);
        (0..3).for_each(|_| trial.step(step));
        trial.state.bodies
    };
    let number = run("1e-3");
    for form in [
        "\"1 mPa s\"",
        "{ law = \"newtonian\", value = 1e-3 }",
        "{ law = \"newtonian\", value = \"1 mPa s\", arrhenius = { energy = \"0 kJ/mol\", reference = \"20 °C\" } }",
        "{ law = \"power\", consistency = 1e-3, exponent = 1.0 }",
        "{ law = \"bingham\", yield_stress = \"0 Pa\", plastic_viscosity = \"1 mPa s\" }",
        "{ law = \"herschel_bulkley\", yield_stress = 0.0, consistency = 1e-3, exponent = 1.0 }",
        "{ law = \"carreau_yasuda\", zero_shear = 1e-3, infinite_shear = 1e-3, time = \"1 ms\", exponent = 0.5 }",
    ] {
        assert!(run(form) == number, "{form}");
    }
}

#[test]
fn constants_of_laws_are_parameters_that_the_check_bounds() {
    let keys = |scene: &Scene| {
        let (name, body) =
            scene.body.iter().find(|(_, body)| matches!(body, Body::Droplet(_))).unwrap();
        let keys = body.constants(name).into_iter().map(|offered| offered.key);
        keys.filter(|key| !["diameter", "impact_velocity", "density"].contains(&key.as_str()))
            .take_while(|key| key != "initial_temperature")
            .collect::<Vec<_>>()
    };
    let common = ["specific_heat", "conductivity", "surface_tension", "sound_speed"];
    let of_number = ["viscosity"].into_iter().chain(common).collect::<Vec<_>>();
    assert_eq!(keys(&with("1e-3")), of_number);
    assert_eq!(keys(&with("{ law = \"newtonian\", value = 2e-3 }")), of_number);
    let mut paste = with(
        "{ law = \"herschel_bulkley\", yield_stress = 0.0, consistency = 1e-3, exponent = 1.0 }",
    );
    let of_law = common.into_iter().chain(["yield_stress", "consistency", "exponent"]);
    assert_eq!(keys(&paste), of_law.collect::<Vec<_>>());
    assert_eq!(keys(&over_temperature([300.0, 400.0], [2e-3, 1e-3])), common);
    for (name, body) in &mut paste.body {
        let offered = body.constants(name);
        let Some(stress) = offered.iter().find(|offered| offered.key == "yield_stress") else {
            continue;
        };
        assert!(matches!(stress.constant, Constant::Material(_)));
        body.places_of(&stress.constant).into_iter().for_each(|place| *place = 7.0);
    }
    assert_eq!(droplet(&paste).fluid.viscosity.yield_stress(), 7.0);
}

#[test]
fn reference_viscosity_is_that_at_the_initial_temperature_and_rate() {
    let scene = over_temperature([300.0, 400.0], [4e-3, 1e-3]);
    let drop = droplet(&scene);
    let part = (drop.initial_temperature - 300.0) / 100.0;
    let wanted = 4e-3 * 0.25_f64.powf(part);
    assert!((drop.reference_viscosity() / wanted - 1.0).abs() < 1e-13);
    assert_eq!(drop.impact().viscosity, drop.reference_viscosity());
    let mut thin = drop.clone();
    let law = "law = \"power\"\nconsistency = 1.0\nexponent = 0.5";
    thin.fluid.viscosity = toml::from_str(law).unwrap();
    let rate = thin.fastest_flow() / thin.diameter;
    assert!((thin.reference_viscosity() * rate.sqrt() - 1.0).abs() < 1e-12);
}

#[test]
fn fluid_beyond_the_table_of_its_viscosity_warns_before_and_during_a_run() {
    let said = |scene: &Scene| {
        let found = advice::warnings(scene).into_iter().map(|warning| warning.to_string());
        found.filter(|warning| warning.contains("table of viscosity")).collect::<Vec<_>>()
    };
    let steps = |scene: Scene| {
        let step = scene.step;
        let mut trial = Trial::of(scene);
        (0..5).for_each(|_| trial.step(step));
        let found = trial.model.phase_warnings(&trial.state, |_| false);
        found.into_iter().map(|warning| warning.to_string()).collect::<Vec<_>>()
    };
    let wide = || over_temperature([100.0, 1000.0], [1.1e-3, 1e-3]);
    assert_eq!(said(&wide()), [""; 0]);
    assert_eq!(steps(wide()), [""; 0]);
    let start = droplet(&wide()).initial_temperature;
    let hot = || over_temperature([100.0, start - 10.0], [1.1e-3, 1e-3]);
    assert!(said(&hot())[0].contains(&format!("the drop is at {start} K")), "{:?}", said(&hot()));
    assert!(steps(hot())[0].contains(&format!("beyond the {} K", start - 10.0)));
    let cold = || over_temperature([start + 10.0, 1000.0], [1.1e-3, 1e-3]);
    assert_eq!(said(&cold()).len(), 1);
    assert!(steps(cold())[0].contains(&format!("beyond the {} K", start + 10.0)));
}

/// A small drop of fluid that thins by five decades as it meets a hot wall.
#[test]
fn fluid_that_thins_in_heat_stays_incompressible() {
    let text = r#"
name = "Thinning"
stop_time = 5e-6
step = 1e-6
[body.drop]
kind = "droplet"
diameter = 2e-4
impact_velocity = 1.0
initial_temperature = 300.0
spacing = 1e-5
fluid = { density = 1000.0, viscosity = { temperature = [300.0, 400.0], value = [100.0, 1e-3] }, specific_heat = 2000.0, conductivity = 100.0, surface_tension = 0.03 }
[[wall]]
name = "wall"
under = "drop"
footprint = { rings = { count = 8, radius = 5e-4 } }
start = { temperature = 420.0 }
"#;
    let scene = parse(text, "scene.toml").unwrap_or_else(|error| panic!("{error}"));
    let mut trial = Trial::of(scene);
    (0..5).for_each(|_| trial.step(1e-6));
    let [low, high] = ["drop.min_density", "drop.max_density"].map(|name| trial.get(name) / 1000.0);
    assert!(low > 0.95 && high < 1.05, "{low} {high}");
}
