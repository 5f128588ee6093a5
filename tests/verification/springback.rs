//! A strip of metal is bent beyond its yield stress and let go: springback as in `docs/theory/large_strain.md`.

use crate::common::Trial;

const LENGTH: f64 = 50e-3;
const HEIGHT: f64 = 2e-3;

/// Deflection of the end of a cantilever under a multiple of the load of first yield, and after unloading [m], and the
/// part of that of which the end of the run warns.
fn bent(across: f64, load: f64, hardening: f64) -> ([f64; 2], f64) {
    bent_by(1, across, load, hardening)
}

/// The same by elements of an order, so many distances of nodes across.
fn bent_by(order: usize, across: f64, load: f64, hardening: f64) -> ([f64; 2], f64) {
    let text = format!(
        r#"
name = "Springback"
stop_time = 2.0
step = 0.25
[body.strip]
kind = "solid"
strain = "finite"
dimension = 2
section = "plane_stress"
shape = {{ box = [{LENGTH:?}, 1.0, {HEIGHT:?}] }}
mesh = {{ spacing = {:?}, order = {order} }}
initial_temperature = 293.15
faces = {{ left = {{ clamped = true }}, right = {{ traction = [0.0, 0.0, 0.0] }} }}
[body.strip.material]
model = "elastoplastic"
density = 2700.0
specific_heat = 900.0
conductivity = 200.0
young = 70e9
poisson = 0.33
yield_stress = 100e6
isotropic_hardening = {hardening:?}
[[probe]]
name = "end"
in = "strip"
at = [{:?}, 0.0, {:?}]
gives = ["displacement"]
"#,
        HEIGHT / across,
        0.5 * LENGTH,
        -0.5 * HEIGHT
    );
    let mut trial = Trial::new(&text);
    let most = load * 100e6 * HEIGHT / (6.0 * LENGTH);
    let mut to = |part: f64| {
        trial.set("strip.right.traction_z", part * most);
        trial.step(0.25);
        trial.get("end.displacement_z")
    };
    let under_load = [0.25, 0.5, 0.75, 1.0].map(&mut to)[3];
    let found = [under_load, [0.75, 0.5, 0.25, 0.0].map(&mut to)[3]];
    let warnings = trial.model.closing_warnings(&trial.state);
    let missing = warnings.first().map_or(0.0, |warning| {
        let words = warning.to_string();
        let words = words.split_once("may be ").expect("a bend that is coarse").1;
        words.split_once(" % too ").expect("an error").0.parse::<f64>().expect("a number")
    });
    (found, 0.01 * missing)
}

#[test]
fn springback_converges_to_second_order() {
    for (load, hardening, errors) in
        [(1.3, 1e9, [-0.41, -0.15, -0.04]), (1.45, 7e9, [-0.36, -0.10, -0.03])]
    {
        let bends = [4.0, 8.0, 16.0, 32.0].map(|across| bent(across, load, hardening));
        let (found, missing) = (bends.map(|bend| bend.0), bends.map(|bend| bend.1));
        let limit = [0, 1].map(|n| found[3][n] + (found[3][n] - found[2][n]) / 3.0);
        let off = found.map(|own| [0, 1].map(|n| own[n] / limit[n] - 1.0));
        println!("springback at {load}: under load {limit:?} m, errors {off:?}");
        for (found, wanted) in off.iter().zip(errors) {
            assert!((found[1] - wanted).abs() < 0.015, "{off:?}");
        }
        // The warning estimates the error, from above on coarse meshes, and fine ones have none.
        println!("errors warned of: {missing:?}");
        let ratios = [0, 1, 2].map(|n| missing[n] / -off[n][1]);
        assert!((0.9..2.1).contains(&ratios[0]) && (0.7..1.4).contains(&ratios[1]), "{ratios:?}");
        assert!(missing[3] == 0.0 && (missing[2] == 0.0 || ratios[2] < 1.4), "{missing:?}");
        // From 8 elements on errors fall by a quarter.
        let order = ((found[2][1] - found[1][1]) / (found[3][1] - found[2][1])).log2();
        assert!(order > 1.7, "{order}");
    }
}

/// Quadratic elements with as many nodes across, beside the limit of linear ones.
#[test]
fn quadratic_elements_keep_more_of_a_bend() {
    for (load, hardening) in [(1.3, 1e9), (1.45, 7e9)] {
        let [middle, fine] = [16.0, 32.0].map(|across| bent(across, load, hardening).0[1]);
        let limit = fine + (fine - middle) / 3.0;
        let bends = [4.0, 8.0, 16.0].map(|across| bent_by(2, across, load, hardening));
        let errors = bends.map(|bend| bend.0[1] / limit - 1.0);
        let told = bends.map(|bend| bend.1);
        println!("springback at {load}, quadratic: {errors:?}, told {told:?}");
        for (error, most) in errors.into_iter().zip([0.25, 0.04, 0.003]) {
            assert!(error.abs() < most, "{errors:?}");
        }
        assert!(told[2] == 0.0 && (0..2).all(|n| told[n] >= 0.9 * errors[n].abs()), "{told:?}");
    }
}
