//! Temperatures in °C, and scenes that are cold.

use super::{ALUMINA, FLUIDS, WATER, drop, edited, plate, warnings};
use impinge::scene::parse;
use impinge::variables::Registry;

const SAYS: &str = "cryogenic = true\n";

/// A plate with all kinds of temperatures that a scene may give, 293.15 K each.
fn everything() -> String {
    let text = edited(
        &plate(ALUMINA),
        "initial_temperature = 293.15\n",
        "initial_temperature = 293.15\nstress_free_temperature = 293.15\n",
    );
    let text = edited(
        &text,
        "sides = { clamped = true }",
        "sides = { clamped = true }\ntop = { radiation = { emissivity = 0.5, ambient = 293.15 } }",
    );
    let reservoir = "[body.bath]\nkind = \"reservoir\"\nheat_capacity = 10.0\ninitial_temperature = 293.15\nconductance = \
                     1.0\nambient = 293.15\n[body.block]\nkind = \"solid\"\nshape = { box = [2e-3, 2e-3, 1e-3] }\nmaterial \
                     = { model = \"thermoelastic\", density = 3950.0, specific_heat = { temperature = [250.0, 600.0], value \
                     = [800.0, 1000.0] }, conductivity = 10.0, melting = { solidus = 2300.0, liquidus = 2310.0, latent_heat \
                     = 1e6 } }\ninitial_temperature = 293.15\nmesh = { spacing = 1e-4 }\nfaces = { bottom = { temperature = \
                     293.15 } }\n[body.drop]";
    let drop = drop(WATER).replace("373.0", "293.15");
    let drop = &drop[drop.find("[body.drop]").unwrap()..];
    format!("{text}{}", drop.replacen("[body.drop]", reservoir, 1))
}

/// Places of a number in a text.
fn places(text: &str, number: &str) -> Vec<usize> {
    text.match_indices(number).map(|(at, _)| at).collect()
}

fn with(text: &str, at: usize, number: &str, value: &str) -> String {
    format!("{}{value}{}", &text[..at], &text[at + number.len()..])
}

#[test]
fn every_temperature_of_a_scene_in_celsius_is_warned_of() {
    let text = everything();
    assert_eq!(warnings(&text), [""; 0]);
    let all = places(&text, "293.15");
    assert_eq!(all.len(), 10);
    for at in all {
        for celsius in ["60.0", "90.0", "150.0", "199.9", "230.0", "249.9"] {
            let found = warnings(&with(&text, at, "293.15", celsius));
            let meant = format!("({} °C)?", celsius.trim_end_matches(".0"));
            let line = text[..at].lines().count();
            assert!(found.iter().any(|w| w.contains(&meant) && w.contains("K is −")), "{found:?}");
            assert!(found.iter().any(|w| w.contains(&format!("scene.toml:{line}:"))), "{found:?}");
        }
        for kelvin in ["250.0", "273.15", "363.15", "1900.0"] {
            let found = warnings(&with(&text, at, "293.15", kelvin));
            assert!(!found.iter().any(|w| w.contains("°C")), "{kelvin}: {found:?}");
        }
    }
}

#[test]
fn temperatures_with_their_unit_are_not_mistaken_for_others() {
    let text = everything();
    for at in places(&text, "293.15") {
        for given in ["\"-40 °C\"", "\"−170 °C\"", "\"-60 °F\""] {
            let found = warnings(&with(&text, at, "293.15", given));
            assert!(!found.iter().any(|w| w.contains("did you mean")), "{given}: {found:?}");
        }
        let found = warnings(&with(&text, at, "293.15", "\"0.5 K\""));
        assert!(found.iter().any(|w| w.contains("plausible")), "{found:?}");
    }
    // Nor in a scene whose other values are changed; a value set anew has no unit.
    let at = places(&text, "293.15")[0];
    let mut scene = parse(&with(&text, at, "293.15", "\"-40 °C\""), "scene.toml").unwrap();
    scene.stop_time *= 2.0;
    assert_eq!(super::of_changed(&scene), [""; 0]);
    scene.in_degrees.values_mut().for_each(|value| *value += 1.0);
    assert!(super::of_changed(&scene)[0].contains("(233.15 °C)?"));
}

#[test]
fn melting_points_and_tables_in_celsius_are_warned_of() {
    let text = everything();
    for (from, to, key) in [
        ("solidus = 2300.0", "solidus = 156.6", "solidus = 156.6"),
        ("solidus = 2300.0", "solidus = 231.9", "solidus = 231.9"),
        ("[250.0, 600.0]", "[20.0, 600.0]", "temperature[0] = 20.0"),
        ("[250.0, 600.0]", "[100.0, 600.0]", "temperature[0] = 100.0"),
    ] {
        let found = warnings(&edited(&text, from, to));
        assert!(found.len() == 1 && found[0].contains(key), "{found:?}");
        assert_eq!(warnings(&edited(&format!("{SAYS}{text}"), from, to)), [""; 0], "{to}");
    }
    // A data sheet from −50 °C on.
    assert_eq!(warnings(&edited(&text, "[250.0, 600.0]", "[223.15, 600.0]")), [""; 0]);
}

#[test]
fn scenes_that_say_that_they_are_cold_may_be() {
    let nitrogen = drop(FLUIDS[1]);
    let plain = nitrogen.replace(SAYS, "");
    assert_eq!(warnings(&nitrogen), [""; 0]);
    assert_eq!(warnings(&plain).len(), 2, "drop and wall");
    // On a wall at room temperature, too; dry ice; frozen mercury.
    for (drop_at, wall_at) in [("77.4", "293.15"), ("293.15", "194.7"), ("300.0", "77.0")] {
        let text = nitrogen
            .replace("initial_temperature = 77.4", &format!("initial_temperature = {drop_at}"));
        let text =
            text.replace("{ temperature = 77.4 }", &format!("{{ temperature = {wall_at} }}"));
        assert_eq!(warnings(&text), [""; 0]);
        assert!(!warnings(&text.replace(SAYS, "")).is_empty());
        assert!(parse(&text, "scene.toml").unwrap().cryogenic);
    }
}

#[test]
fn cold_scenes_of_the_usual_kind_are_not_warned_of() {
    // Ammonia, and a plate of ice; everything between 200 K and 250 K.
    assert_eq!(warnings(&drop(FLUIDS[2])), [""; 0]);
    for temperature in ["250.0", "263.15", "273.0"] {
        assert_eq!(warnings(&plate(ALUMINA).replace("293.15", temperature)), [""; 0]);
    }
    assert_eq!(warnings(&plate(ALUMINA).replace("293.15", "220.0")), [""; 0]);
    assert_eq!(warnings(&plate(ALUMINA).replace("293.15", "199.0")).len(), 2);
}

#[test]
fn values_of_inputs_in_celsius_are_warned_of() {
    for (text, names) in [
        (everything(), vec!["bath.ambient", "plate.bottom.ambient", "block.bottom.temperature"]),
        (drop(WATER), vec!["wall.temperature[1]", "wall.temperature[10]"]),
        (
            drop(WATER).replace("spacing = 5e-5", "spacing = 5e-5\nrelease = \"input\"\nmost = 3"),
            vec!["drop.temperature"],
        ),
    ] {
        for says in ["", SAYS] {
            let scene = parse(&format!("{says}{text}"), "scene.toml").unwrap();
            let registry = Registry::of(&scene);
            for name in &names {
                let variable = &registry.variables[registry.find(name).unwrap()];
                let told =
                    |value: f64| variable.implausible(&scene, value).map(|one| one.to_string());
                for value in [20.0, 60.0, 90.0, 150.0, 199.0, 249.0] {
                    let wanted = format!("did you mean {} ({value} °C)?", value + 273.15);
                    let is_told = told(value).is_some_and(|said| said.contains(&wanted));
                    assert_eq!(is_told, says.is_empty(), "{name} = {value}: {:?}", told(value));
                }
                for value in [250.0, 273.15, 400.0, 1900.0] {
                    assert_eq!(told(value), None, "{name}");
                }
            }
        }
    }
}

#[test]
fn points_of_freezing_and_boiling_in_celsius_are_warned_of() {
    let liquid = |temperature: &str, points: &str| {
        let text = drop(WATER).replace("373.0", temperature);
        warnings(&text.replace("fluid = {", &format!("fluid = {{ {points},")))
    };
    for (temperature, points, meant) in [
        ("550.0", "freezes_at = 231.9", "505.05 (231.9 °C)"),
        ("480.0", "freezes_at = 156.6", "429.75 (156.6 °C)"),
        ("350.0", "freezes_at = 60.0", "333.15 (60 °C)"),
        ("350.0", "boils_at = 100.0", "373.15 (100 °C)"),
    ] {
        let found = liquid(temperature, points);
        assert!(found.len() == 1 && found[0].contains(meant), "{found:?}");
    }
    // Ethanol, acetone, toluene, mercury, water, tin.
    for (temperature, points) in [
        ("293.0", "freezes_at = 159.0, boils_at = 351.4"),
        ("293.0", "freezes_at = 178.5, boils_at = 329.2"),
        ("350.0", "freezes_at = 178.0, boils_at = 383.8"),
        ("293.0", "freezes_at = 234.3, boils_at = 629.9"),
        ("293.0", "freezes_at = 273.15, boils_at = 373.15"),
        ("550.0", "freezes_at = 505.1, boils_at = 2875.0"),
    ] {
        assert_eq!(liquid(temperature, points), [""; 0], "{points}");
    }
    let found = liquid("300.0", "freezes_at = 310.0");
    assert!(found.len() == 1 && found[0].contains("drops of 300 K are frozen"), "{found:?}");
    let found = liquid("400.0", "boils_at = 373.15");
    assert!(found.len() == 1 && found[0].contains("boil at once"), "{found:?}");
}
