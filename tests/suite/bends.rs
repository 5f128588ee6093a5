//! Bends of metal beyond yield: a run ends with a warning where the mesh resolves them poorly, and only there.

use crate::common::Trial;
use crate::driven_solids::probe;
use crate::plastic_steps::metal;

/// Size of a strip [m], and its yield stress [Pa].
const LENGTH: f64 = 20e-3;
const HEIGHT: f64 = 2e-3;
const YIELD_STRESS: f64 = 1e8;

/// Aluminium with keys of its body, and one of its hardening.
fn aluminium(keys: &str, hardening: &str) -> String {
    metal(
        keys,
        &format!("young = 70e9, poisson = 0.33, yield_stress = {YIELD_STRESS:?}, {hardening}"),
    )
}

fn strip(across: f64, hardening: &str, right: &str) -> String {
    let keys = format!(
        "shape = {{ box = [{LENGTH:?}, 1.0, {HEIGHT:?}] }}\ndimension = 2\nsection = \"plane_stress\"\n\
         mesh = {{ spacing = {:?} }}\n\
         faces = {{ left = {{ clamped = true }}, right = {{ {right} = [0.0, 0.0, 0.0] }} }}\n",
        HEIGHT / across
    );
    aluminium(&keys, hardening)
        + &probe("end", [0.5 * LENGTH, 0.0, -0.5 * HEIGHT], "\"displacement\"")
}

/// Warnings as a run ends.
fn closing(trial: &Trial) -> Vec<String> {
    let warnings = trial.model.closing_warnings(&trial.state);
    warnings.iter().map(ToString::to_string).collect()
}

/// Deflection that stays of a cantilever after a multiple of the load of first yield [m], and the warnings.
fn let_go(text: &str, load: f64) -> (f64, Vec<String>) {
    let mut trial = Trial::new(text);
    let most = load * YIELD_STRESS * HEIGHT / (6.0 * LENGTH);
    for part in [0.5, 0.8, 1.0, 0.5, 0.0] {
        trial.set("pad.right.traction_z", part * most);
        trial.step(1.0);
    }
    (trial.get("end.displacement_z"), closing(&trial))
}

/// Warnings after displacements of a face.
fn moved(text: &str, input: &str, ways: &[f64]) -> Vec<String> {
    let mut trial = Trial::new(text);
    for way in ways {
        trial.set(input, *way);
        trial.step(1.0);
    }
    closing(&trial)
}

/// The message estimates the error that the limit of fine meshes shows.
#[test]
fn coarse_bends_are_warned_of_with_their_error() {
    let hardening = "isotropic_hardening = 1e9";
    let left = |across: f64| let_go(&strip(across, hardening, "traction"), 1.3);
    let ((coarse, warnings), (fine, _)) = (left(8.0), left(16.0));
    let error = 100.0 * (1.0 - coarse / (fine + (fine - coarse) / 3.0));
    let [warning] = &warnings[..] else { panic!("{warnings:?}") };
    let words = warning.split_once("may be ").unwrap().1;
    let (estimate, rest) = words.split_once(" % ").unwrap();
    let ratio = estimate.parse::<f64>().unwrap() / error;
    assert!((0.6..1.6).contains(&ratio), "{warning} {error}");
    assert!(rest.starts_with("too small; set a `mesh.spacing` of "), "{warning}");
    assert!(warning.starts_with("pad: metal was bent") && warning.contains("with 8 elements"));
}

#[test]
fn fine_bends_and_those_of_kernels_are_not_warned_of() {
    // Errors of 1.6 %.
    let hardening = "isotropic_hardening = 7e9";
    let fine = strip(16.0, hardening, "traction");
    let kernels = strip(8.0, hardening, "traction").replace("kind", "mechanics = \"rkpm\"\nkind");
    for (text, load) in [(fine, 2.0), (kernels, 1.6)] {
        let (left, warnings) = let_go(&text, load);
        assert!(left > 0.0 && warnings.is_empty(), "{warnings:?}");
    }
}

/// Four elements across give the springback of a bend to 0.2 to 2 % where the faces of the strip are moved.
#[test]
fn bends_that_faces_prescribe_need_few_elements() {
    let text = strip(4.0, "isotropic_hardening = 1e9", "displacement");
    let ways = [2e-4, 4e-4, 8e-4, 7e-4, 6.5e-4];
    assert_eq!(moved(&text, "pad.right.displacement_z", &ways), Vec::<String>::new());
    let strong = strip(2.0, "isotropic_hardening = 1e9", "displacement");
    assert_eq!(moved(&strong, "pad.right.displacement_z", &[1e-4, 2e-4, 1.5e-4]).len(), 1);
}

/// Bars that are pulled evenly or neck, and blocks that are pressed, are not bent, whatever their mesh.
#[test]
fn bars_and_blocks_are_not_taken_for_bends() {
    let linear = "isotropic_hardening = 1e9";
    let saturating = "hardening = { saturation = 180e6, rate = 15.0 }";
    let body = |width: f64, height: f64, is_clamped: bool| {
        let ends = if is_clamped { "clamped" } else { "roller" };
        let top = if is_clamped { "" } else { "roller = true, " };
        format!(
            "shape = {{ box = [{width:?}, 1.0, {height:?}] }}\ndimension = 2\nmesh = {{ spacing = 2.5e-3 }}\n\
             faces = {{ bottom = {{ {ends} = true }}, top = {{ {top}displacement = [0.0, 0.0, 0.0] }} }}\n"
        )
    };
    let cases = [
        ("even bar", linear, body(10e-3, 40e-3, false), 4e-3),
        ("necking bar", saturating, body(10e-3, 40e-3, true), 6e-3),
        ("block", linear, body(10e-3, 10e-3, true), -2e-3),
        ("flat block", linear, body(20e-3, 10e-3, true), -3e-3),
    ];
    for (name, hardening, keys, way) in cases {
        let ways: Vec<f64> = (1..=10).map(|n| 0.1 * way * f64::from(n)).collect();
        let warnings = moved(&aluminium(&keys, hardening), "pad.top.displacement_z", &ways);
        assert_eq!(warnings, Vec::<String>::new(), "{name}");
    }
}
