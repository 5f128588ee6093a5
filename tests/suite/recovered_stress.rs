//! Stress on the axis of a disc and on free and loaded faces: what symmetry and the tractions say, and how
//! fast the rest converges.

use crate::common::Trial;

fn disc(spacing: f64, order: usize, faces: &str, start: &str) -> String {
    let growth = 1.0 + 0.25 * spacing / 4e-5;
    format!(
        r#"
name = "Disc"
stop_time = 1e-3
step = 1e-3
[body.p]
kind = "solid"
shape = {{ disc = {{ radius = 1e-3, thickness = 0.4e-3 }} }}
material = {{ model = "thermoelastic", density = 7850.0, specific_heat = 470.0, conductivity = 45.0, young = 210e9, poisson = 0.3, expansion = 12e-6 }}
initial_temperature = 300.0
mesh = {{ spacing = {spacing:?}, growth = {growth:?}, order = {order} }}
[body.p.faces]
{faces}
[[load]]
name = "l"
on = "p.top"
footprint = {{ gaussian = {{ radius = 2e-4 }} }}
carries = ["heat_flux", "pressure"]
start = {{ {start} }}
{}"#,
        (0..4).map(|i| probe(i, [0.0, 0.0, -1e-5 * (i * i) as f64])).collect::<String>()
            + &probe(4, [7e-5, 0.0, 0.0])
            + &probe(5, [0.0, 7e-5, 0.0])
    )
}

fn probe(i: usize, at: [f64; 3]) -> String {
    format!(
        "[[probe]]\nname = \"p{i}\"\nin = \"p\"\nat = {at:?}\ngives = [\"stress\", \"max_principal\"]\n"
    )
}

const CLAMPED: &str = "sides = { clamped = true }";
const HEAT: &str = "heat_flux = 1e8";
const PRESSURE: &str = "pressure = 1e7";

fn run(text: &str) -> Trial {
    let mut trial = Trial::new(text);
    trial.step(1e-3);
    trial
}

#[test]
fn on_the_axis_of_a_disc_no_direction_is_another() {
    for order in [1, 2] {
        for start in [HEAT, PRESSURE] {
            let mut trial = run(&disc(4e-5, order, CLAMPED, start));
            for i in 0..4 {
                let [xx, yy, xz] =
                    ["xx", "yy", "xz"].map(|c| trial.get(&format!("p{i}.stress_{c}")));
                assert!((xx - yy).abs() <= 1e-12 * xx.abs(), "order {order} {start}: {xx} {yy}");
                assert!(xz.abs() <= 1e-9 * xx.abs(), "order {order} {start}: {xz}");
            }
            // Off the axis the two directions change places.
            let along = [("p4", "p5", "xx", "yy"), ("p4", "p5", "yy", "xx")];
            for (a, b, c, d) in along {
                let [a, b] = [(a, c), (b, d)].map(|(p, c)| trial.get(&format!("{p}.stress_{c}")));
                assert!((a - b).abs() <= 1e-12 * a.abs());
            }
        }
    }
}

/// Values of one stress at probes on the axis over ever finer meshes, and the order at which they
/// approach the finest.
fn orders(component: &str, probes: &[usize], order: usize, start: &str) -> Vec<f64> {
    let spacings = [4e-5, 2e-5, 1e-5, 2.5e-6];
    let mut values = spacings.map(|spacing| {
        let mut trial = run(&disc(spacing, order, CLAMPED, start));
        probes.iter().map(|i| trial.get(&format!("p{i}.stress_{component}"))).collect::<Vec<_>>()
    });
    let reference = std::mem::take(&mut values[3]);
    let errors: Vec<f64> = values[..3]
        .iter()
        .map(|row| row.iter().zip(&reference).map(|(v, r)| (v - r).powi(2)).sum::<f64>().sqrt())
        .collect();
    println!("{component} {order} {start}: {errors:?} of {reference:?}");
    errors.windows(2).map(|pair| (pair[0] / pair[1]).log2()).collect()
}

#[test]
fn stress_on_the_axis_converges_at_second_order() {
    for order in [1, 2] {
        for start in [HEAT, PRESSURE] {
            let found = orders("xx", &[0, 1, 2, 3], order, start);
            // The coarsest mesh has two and a half elements over the radius of the load.
            assert!(found[1] > 1.7, "order {order} {start}: {found:?}");
        }
    }
}

#[test]
fn stress_below_a_free_surface_vanishes_towards_it() {
    for order in [1, 2] {
        let mut coarse = run(&disc(4e-5, order, CLAMPED, HEAT));
        let along = coarse.get("p0.stress_xx");
        assert!(along < -5e7, "{along}");
        for (p, share) in [("p0", 1e-12), ("p4", 1e-12), ("p1", 5e-3)] {
            let normal = coarse.get(&format!("{p}.stress_zz"));
            assert!(
                normal.abs() < share * along.abs(),
                "order {order} {p}: {normal} beside {along}"
            );
            let shear = coarse.get(&format!("{p}.stress_xz"));
            assert!(p == "p1" || shear.abs() < 1e-12 * along.abs(), "order {order} {p}: {shear}");
        }
    }
}

#[test]
fn under_a_load_the_normal_stress_is_its_pressure() {
    for order in [1, 2] {
        let errors = [4e-5, 2e-5, 1e-5].map(|spacing| {
            let mut trial = run(&disc(spacing, order, CLAMPED, PRESSURE));
            let exact = |r: f64| -1e7 * (-2.0 * (r / 2e-4_f64).powi(2)).exp();
            let mut error =
                |p: &str, r: f64| (trial.get(&format!("{p}.stress_zz")) / exact(r) - 1.0).abs();
            [error("p0", 0.0), error("p4", 7e-5)].into_iter().fold(0.0, f64::max)
        });
        assert!(errors[0] < 0.04 && errors[2] < 4e-3, "order {order}: {errors:?}");
        assert!((errors[0] / errors[2]).log2() > 3.0, "order {order}: {errors:?}");
    }
}

#[test]
fn a_support_s_reaction_is_not_taken_for_a_free_face() {
    // Held at its bottom, the disc is pressed as a whole: −p all through on rollers.
    let faces = "bottom = { roller = true }\nsides = { roller = true }";
    let text = disc(4e-5, 2, faces, "pressure = 1e7");
    let text = text.replace("gaussian = { radius = 2e-4 }", "disc = { radius = 1e-3 }");
    let text = text + &probe(6, [2e-4, 0.0, -4e-4]);
    let mut trial = run(&text);
    for p in ["p0", "p3", "p4", "p6"] {
        let normal = trial.get(&format!("{p}.stress_zz"));
        assert!((normal / -1e7 - 1.0).abs() < 1e-9, "{p}: {normal}");
    }
}

#[test]
fn boxes_honour_tractions_on_both_faces_in_every_symmetry() {
    for symmetry in ["auto", "none"] {
        let text = format!(
            r#"
name = "Box"
stop_time = 1e-3
step = 1e-3
[body.p]
kind = "solid"
shape = {{ box = [1e-3, 0.8e-3, 0.3e-3] }}
material = {{ model = "thermoelastic", density = 7850.0, specific_heat = 470.0, conductivity = 45.0, young = 210e9, poisson = 0.3, expansion = 12e-6 }}
initial_temperature = 300.0
symmetry = "{symmetry}"
mesh = {{ spacing = 5e-5, depth_spacing = 4e-5 }}
[body.p.faces]
sides = {{ clamped = true }}
[[load]]
name = "hot"
on = "p.top"
footprint = {{ gaussian = {{ radius = 2e-4 }} }}
carries = ["heat_flux"]
start = {{ heat_flux = 1e8, x = 1e-4 }}
[[load]]
name = "push"
on = "p.bottom"
footprint = {{ tiles = {{ count = [1, 1], size = [0.7e-3, 0.6e-3] }} }}
carries = ["pressure", "shear"]
start = {{ pressure = 2e7, shear_x = 3e6, shear_y = -1e6, x = -1e-4 }}
{}{}{}"#,
            probe(0, [1e-4, 0.0, 0.0]),
            probe(1, [-1.3e-4, 1e-4, 0.0]),
            probe(2, [-1e-4, 5e-5, -0.3e-3]),
        );
        let mut trial = run(&text);
        let scale = trial.get("p0.stress_xx").abs();
        for p in ["p0", "p1"] {
            for component in ["zz", "yz", "xz"] {
                let value = trial.get(&format!("{p}.stress_{component}"));
                assert!(value.abs() < 1e-12 * scale, "{symmetry} {p} {component}: {value}");
            }
        }
        // The outward normal of the bottom points down.
        for (component, wanted) in [("zz", -2e7), ("xz", -3e6), ("yz", 1e6)] {
            let value = trial.get(&format!("p2.stress_{component}"));
            // The edges of the tile are two elements away.
            assert!((value / wanted - 1.0).abs() < 1e-4, "{symmetry} {component}: {value}");
        }
    }
}
