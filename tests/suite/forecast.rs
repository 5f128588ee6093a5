//! Droplets take the steps that are said.

use impinge::model::forecast;
use impinge::scene::parse;

use crate::forecast_cases::{CASES, scene, steps_of};

#[test]
fn droplets_take_the_steps_that_were_said() {
    for case in CASES {
        let scene = scene(case);
        let ratio = steps_of(&scene) / forecast(&scene).droplets[0].steps;
        assert!((0.8..1.25).contains(&ratio), "{}: {ratio} of the steps said", case.0);
    }
}

/// Solved pressure is offered where it shortens a run that is not short anyway, and where the fluid may have it.
#[test]
fn solved_pressure_is_offered_to_slow_thick_drops() {
    let honey = |keys: &str, of_fluid: &str, stop: f64| {
        let text = format!(
            "name = \"Honey\"\nstop_time = {stop:e}\nstep = 2e-3\n[body.drop]\nkind = \"droplet\"\ndiameter = 5e-3\n\
             impact_velocity = 0.2\ninitial_temperature = 300.0\nspacing = 0.25e-3\ngravity = 9.81\n{keys}\n\
             fluid = {{ density = 1400.0, viscosity = 10.0, specific_heat = 2500.0, conductivity = 0.5{of_fluid} }}\n\
             [[wall]]\nname = \"wall\"\nunder = \"drop\"\nfootprint = {{ rings = {{ count = 20, radius = 8e-3 }} }}\n"
        );
        let notes = forecast(&parse(&text, "scene.toml").unwrap()).droplets.remove(0).notes;
        notes.into_iter().find(|note| note.contains("would shorten this run"))
    };
    assert!(honey("", "", 0.5).is_some());
    assert_eq!(honey("", "", 2e-3), None, "short anyway");
    assert_eq!(honey("pressure = \"implicit\"", "", 0.5), None);
    assert_eq!(honey("viscous = \"explicit\"", "", 0.5), None);
    assert_eq!(honey("", ", sound_speed = 1400.0", 0.5), None);
}
