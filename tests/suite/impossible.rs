//! What is physically impossible or beyond numbers is refused, in the run too, and changes nothing.

use crate::common::Trial;
use impinge::model::{BodyError, ModelError};

fn plate(material: &str, faces: &str, rest: &str) -> String {
    format!(
        r#"name = "Plate"
stop_time = 1e-3
step = 1e-4
[body.plate]
kind = "solid"
shape = {{ disc = {{ radius = 1e-3, thickness = 0.5e-3 }} }}
material = {{ model = "thermoelastic", density = 3950.0, specific_heat = 900.0, conductivity = 10.0{material} }}
initial_temperature = 300.0
[body.plate.faces]
{faces}
[[load]]
name = "spot"
on = "plate.top"
footprint = {{ disc = {{ radius = 4e-4 }} }}
carries = ["heat_flux"]
{rest}
"#
    )
}

const ELASTIC: &str = ", young = 300e9, poisson = 0.21, expansion = 8.1e-6";
const THERMAL_PROBE: &str = r#"
[[probe]]
name = "a"
in = "plate"
at = [0.0, 0.0, 0.0]
gives = ["temperature"]"#;
const STRESS_PROBE: &str = r#"
[[probe]]
name = "a"
in = "plate"
at = [0.0, 0.0, 0.0]
gives = ["temperature", "stress", "max_principal", "displacement"]"#;

#[test]
fn a_step_to_below_absolute_zero_is_refused_and_changes_nothing() {
    for (faces, input) in [("", "spot.heat_flux"), ("bottom = { flux = 0.0 }", "plate.bottom.flux")]
    {
        let mut trial = Trial::new(&plate("", faces, THERMAL_PROBE));
        trial.set(input, -1e7);
        trial.step(1e-4);
        let (before, cold) = (trial.state.clone(), trial.get("a.temperature"));
        trial.set(input, -1e10);
        let error = trial.try_step(1e-4).unwrap_err();
        let text = error.to_string();
        assert!(matches!(error, ModelError::Body(BodyError::BelowAbsoluteZero { .. })), "{text}");
        assert!(text.contains("plate would cool to -") && text.contains("heat flux"), "{text}");
        // Nobody reads hundreds of digits.
        trial.set(input, -1e250);
        let text = trial.try_step(1e-4).unwrap_err().to_string();
        assert!(text.contains("e2") && text.len() < 200, "{text}");
        trial.set(input, -1e7);
        assert_eq!(trial.state, before);
        assert_eq!(trial.get("a.temperature"), cold);
        trial.step(1e-4);
        assert!(trial.get("a.temperature") < 300.0);
    }
}

#[test]
fn a_flux_that_turns_negative_within_a_step_is_noticed() {
    let mut trial = Trial::new(&plate("", "", THERMAL_PROBE));
    trial.set("spot.heat_flux", 1e6);
    trial.set_derivative("spot.heat_flux", 1, -1e14);
    let error = trial.try_step(1e-4).unwrap_err();
    assert!(matches!(error, ModelError::Body(BodyError::BelowAbsoluteZero { .. })), "{error}");
}

#[test]
fn outputs_beyond_numbers_are_errors_and_large_ones_are_right() {
    let text = plate(ELASTIC, "sides = { clamped = true }", STRESS_PROBE);
    let text = text.replace("\"heat_flux\"", "\"heat_flux\", \"pressure\"");
    let mut trial = Trial::new(&text);
    let names = [
        "a.stress_zz",
        "a.stress_xx",
        "a.max_principal",
        "a.von_mises",
        "plate.max_principal",
        "plate.max_von_mises",
    ];
    trial.set("spot.pressure", 1e6);
    let usual = names.map(|name| trial.get(name));
    trial.set("spot.pressure", 1e106);
    for (name, usual) in names.into_iter().zip(usual) {
        let value = trial.get(name);
        assert!((value / 1e100 / usual - 1.0).abs() < 1e-9, "{name}: {value:e}, {usual:e}");
    }
    for pressure in [1e305, 1.7e308] {
        trial.set("spot.pressure", pressure);
        for name in names {
            let output = trial.output(name);
            let mut cache = impinge::model::Cache::default();
            match trial.model.output(&trial.state, &mut cache, &output) {
                Ok(value) => {
                    let wanted =
                        usual[names.iter().position(|n| *n == name).unwrap()] / 1e6 * pressure;
                    assert!((value / wanted - 1.0).abs() < 1e-9, "{name}: {value:e}");
                }
                Err(error) => {
                    assert!(matches!(error, ModelError::Body(BodyError::NotFinite(_))), "{error}")
                }
            }
        }
    }
    let output = trial.output("plate.max_von_mises");
    trial.set("spot.pressure", 1.7e308);
    let mut cache = impinge::model::Cache::default();
    assert!(trial.model.output(&trial.state, &mut cache, &output).is_err());
}

#[test]
fn materials_without_elastic_constants_conduct_and_offer_nothing_mechanical() {
    let mut bare = Trial::new(&plate("", "", THERMAL_PROBE));
    let mut full = Trial::new(&plate(ELASTIC, "", THERMAL_PROBE));
    for trial in [&mut bare, &mut full] {
        trial.set("spot.heat_flux", 1e7);
        trial.step(1e-4);
        assert!(!trial.outputs().iter().any(|name| name.contains("von_mises")));
        assert_eq!(trial.model.factor_entries(), 0);
    }
    assert_eq!(bare.get("a.temperature"), full.get("a.temperature"));
}

#[test]
fn mechanics_without_its_constants_is_refused_by_the_key() {
    for key in ["young", "poisson", "expansion"] {
        let lacking = ELASTIC.split(", ").filter(|part| !part.starts_with(key)).collect::<Vec<_>>();
        let material = lacking.join(", ");
        let text = plate(&material, "sides = { clamped = true }", STRESS_PROBE);
        let error = impinge::scene::parse(&text, "scene.toml").unwrap_err().to_string();
        let wanted = format!("scene.toml:7: body.plate.material.{key}: the key `{key}` is missing");
        assert!(error.starts_with(&wanted), "{error}");
    }
}

#[test]
fn stiffness_is_factored_only_for_those_who_read_it() {
    // Traction is carried, but no probe or field gives stress. Of a material that no other test has: equal stiffness is
    // shared.
    let own = ELASTIC.replace("poisson = 0.21", "poisson = 0.2134");
    let text = plate(&own, "sides = { clamped = true }", THERMAL_PROBE);
    let text = text.replace("\"heat_flux\"", "\"heat_flux\", \"pressure\"");
    let mut trial = Trial::new(&text);
    trial.set("spot.pressure", 1e6);
    trial.step(1e-4);
    trial.get("a.temperature");
    assert_eq!(trial.model.factor_entries(), 0);
    assert!(trial.get("plate.max_von_mises") > 0.0);
    assert!(trial.model.factor_entries() > 0);
}

/// A film coefficient of 1e30 lets rounding make heat: such a step is refused before anyone reads what came of it,
/// while 1e12 is as good as a prescribed temperature.
#[test]
fn a_step_whose_heat_does_not_balance_is_refused_and_changes_nothing() {
    let slab = |coefficient: &str| {
        plate(
            "",
            &format!(
                "bottom = {{ temperature = 300.0 }}\ntop = {{ convection = {{ coefficient = {coefficient}, ambient = 400.0 }} }}"
            ),
            THERMAL_PROBE,
        )
    };
    let mut trial = Trial::new(&slab("1e12"));
    trial.step(1.0);
    assert!((trial.get("a.temperature") - 400.0).abs() < 1e-3);
    for coefficient in ["1e20", "1e30", "1e60"] {
        let mut trial = Trial::new(&slab(coefficient));
        let before = trial.state.clone();
        let error = trial.try_step(1.0).unwrap_err();
        assert!(matches!(error, ModelError::Body(BodyError::Unbalanced { .. })), "{error}");
        assert!(error.to_string().contains("the heat of plate does not balance"), "{error}");
        assert_eq!(trial.state, before);
    }
}
