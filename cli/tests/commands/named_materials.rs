//! Constants of named materials, set in one of their bodies.

use std::process::Command;

const SCENE: &str = r#"
name = "Named"
stop_time = 1.0
step = 0.5
[material.steel]
model = "elastoplastic"
density = 7800.0
specific_heat = 500.0
conductivity = 45.0
young = 200e9
poisson = 0.3
expansion = 1.2e-5
yield_stress = 250e6
[body.plate]
kind = "solid"
shape = { box = [1e-2, 1e-2, 2e-3] }
material = "steel"
initial_temperature = 300.0
[body.plate.faces]
bottom = { clamped = true, temperature = 310.0 }
[body.stack]
kind = "solid"
shape = { box = [1e-2, 1e-2, 2e-3] }
layers = [{ material = "steel", thickness = 1e-3 }, { material = "steel", thickness = 1e-3, contact_resistance = 0.0 }]
initial_temperature = 300.0
[body.stack.faces]
bottom = { temperature = 310.0 }
[[probe]]
name = "inside"
in = "plate"
at = [0.0, 0.0, -1e-3]
gives = ["temperature", "stress"]
"#;

fn run(setting: &str) -> (bool, String) {
    let folder = tempfile::TempDir::with_prefix("impinge-named-").unwrap();
    let scene = folder.path().join("scene.toml");
    std::fs::write(&scene, SCENE).unwrap();
    let output = Command::new(env!("CARGO_BIN_EXE_impinge"))
        .args(["run", "--fields-every", "0", "--set", setting, "--out"])
        .arg(folder.path().join("out"))
        .arg(&scene)
        .output()
        .unwrap();
    (output.status.success(), String::from_utf8(output.stderr).unwrap())
}

#[test]
fn set_values_are_checked_like_those_of_the_scene() {
    for (setting, key) in [
        ("plate.density=0", "body.plate.material.density"),
        ("plate.specific_heat=0", "body.plate.material.specific_heat"),
        ("plate.conductivity=0", "body.plate.material.conductivity"),
        ("plate.young=1e300", "body.plate.material.young"),
        ("plate.poisson=0.4999999999", "body.plate.material.poisson"),
        ("plate.yield_stress=0", "body.plate.material.yield_stress"),
        ("stack.steel.density=0", "body.stack.layers[0].material.density"),
    ] {
        let (is_fine, said) = run(setting);
        assert!(!is_fine && said.contains(key) && said.contains("allowed:"), "{setting}: {said}");
        assert!(!said.contains("panicked"), "{setting}: {said}");
    }
    for setting in ["plate.density=7700", "plate.yield_stress=1e8", "stack.steel.conductivity=50"] {
        let (is_fine, said) = run(setting);
        assert!(is_fine, "{setting}: {said}");
    }
}
