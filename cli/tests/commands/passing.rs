//! Warnings of what is past again when a run ends.

use std::fs;

use super::Workplace;

const PAD: &str = r#"
name = "Pad"
stop_time = 4.0
step = 0.1
[body.pad]
kind = "solid"
strain = "finite"
shape = { disc = { radius = 5e-3, thickness = 6e-3 } }
initial_temperature = 293.15
material = { model = "neo_hookean", density = 1000.0, specific_heat = 1900.0, conductivity = 0.2, young = 1e6, poisson = 0.49 }
mesh = { spacing = 0.5e-3 }
faces = { bottom = { clamped = true }, top = { displacement = [0.0, 0.0, 0.0] } }
"#;

/// A pad that relaxes.
const RELAXING: &str = "\"viscoelastic\", shear_relaxation = [{ fraction = 0.6, time = 0.3 }]";

fn told(scene: &str, rows: &str, until: &str) -> String {
    let place = Workplace::new();
    fs::write(place.path("pad.toml"), scene).unwrap();
    fs::write(place.path("table.csv"), format!("time,pad.top.displacement_z\n{rows}")).unwrap();
    let options = ["--inputs", "table.csv", "--fields-every", "0", "--until", until];
    place.call(&[&["run", "pad.toml"], &options[..]].concat()).succeeds().stderr()
}

/// A pad is pressed until its sides pass the platens, and let go.
#[test]
fn warnings_of_states_in_the_middle_of_a_run_tell_their_times() {
    let press = "0,0\n1,-2.7e-3\n1.5,-2.7e-3\n2,0\n";
    let said = told(PAD, press, "1.2");
    assert!(said.contains("warning: pad: ") && said.contains("[sides_pass_faces]"), "{said}");
    let said = told(PAD, press, "2");
    let own = said.lines().find(|line| line.contains("[sides_pass_faces]")).unwrap();
    assert!(own.contains("warning: pad, ") && own.contains(" to 1.5 s: "), "{own}");
    assert_eq!(said.matches("[sides_pass_faces]").count(), 1, "{said}");
    assert!(!told(PAD, "0,0\n1,0\n", "1").contains("[sides_pass_faces]"));
}

/// A pad is drawn until its law stores more than the work done, and pushed back.
#[test]
fn warnings_of_values_in_the_middle_of_a_run_tell_their_times() {
    let coarse = PAD.replace("0.5e-3", "1e-3").replace("step = 0.1", "step = 1.0");
    let scene = coarse.replace("\"neo_hookean\"", RELAXING);
    let said = told(&scene, "0,0\n1,24e-3\n2,-2e-3\n3,0\n", "4");
    let own = said.lines().find(|line| line.contains("[dissipation_below_zero]")).unwrap();
    assert!(own.contains("warning: pad.dissipated, 1 s to 2 s: "), "{own}");
}
