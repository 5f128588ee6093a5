//! Repeated drops over walls and plates: what these get is what the drops transfer, whatever their temperatures and the
//! length of steps.

use crate::common::{Trial, off};
use crate::replay::{STEP, TILES, content, drop, get, plate, steps};

/// A drop that has come to rest has given all its heat to a wall that is held, in steps of any length.
#[test]
fn at_last_all_heat_has_been_given() {
    for method in ["record", "film"] {
        let mut heats = Vec::new();
        let mut trial = Trial::new(&(drop(method, "") + TILES));
        let start = trial.state.clone();
        for step in [1e-6, 3.3e-5, 1e-2] {
            trial.restart(&start);
            let mut steps = 0;
            while steps == 0 || trial.get("drop.active") > 0.0 {
                trial.step(step);
                steps += 1;
                assert!(steps < 100_000);
            }
            heats.push(trial.get("drop.heat"));
            trial.step(step);
            let [flow, force, heat] = get(&mut trial, ["heat_flow", "force", "heat"]);
            assert_eq!([flow, force], [0.0; 2]);
            assert!(off(heat, content()) < 1e-9, "{method}: {}", heat / content());
        }
        assert!(heats.iter().all(|heat| off(*heat, heats[0]) < 1e-12), "{heats:?}");
    }
}

/// A wall that warms over a step has its temperature of the moment at which a drop touches it, in steps of any length.
#[test]
fn drops_meet_the_wall_as_it_is_when_they_touch_it() {
    let rings = "[[wall]]\nname = \"wall\"\nunder = \"drop\"\nfootprint = { rings = { count = 2, radius = 3e-4 } }\n\
                 start = { temperature = 300.0 }\n";
    for (method, most) in [("record", 1e-3), ("film", 1e-3), ("sph", 0.02)] {
        let round = if method == "film" { "" } else { "symmetry = \"axisymmetric\"" };
        let mut trial = Trial::new(&(drop(method, round) + rings));
        let start = trial.state.clone();
        let heats = [1, 40].map(|steps| {
            trial.restart(&start);
            let whole = 2e-5;
            for n in 0..steps {
                for ring in ["wall.temperature[1]", "wall.temperature[2]"] {
                    trial.set(ring, 300.0 + 40.0 * f64::from(n) / f64::from(steps));
                    trial.set_derivative(ring, 1, 40.0 / whole);
                }
                trial.step(whole / f64::from(steps));
            }
            trial.get("drop.heat")
        });
        assert!(off(heats[0], heats[1]) < most, "{method}: {heats:?}");
    }
}

#[test]
fn what_cells_got_is_what_the_drop_gave() {
    let mut trial = Trial::new(&(drop("record", "arrivals = [{ x = 4.2e-4, y = -1e-5 }]") + TILES));
    let area = (1e-3 / 8.0_f64).powi(2);
    let (mut heat, mut impulse) = (0.0, 0.0);
    for _ in 0..30 {
        trial.step(STEP);
        let sum = |trial: &mut Trial, key: &str| {
            let cells = (1..=8).flat_map(|i| (1..=8).map(move |j| [i, j]));
            let names = cells.map(|[i, j]| format!("wall.{key}[{i},{j}]"));
            names.map(|name| area * trial.get(&name)).sum::<f64>()
        };
        // Beyond the tiles the wall goes on.
        let beyond = ["wall.heat_flow_outside", "wall.force_outside"].map(|name| trial.get(name));
        heat += STEP * (sum(&mut trial, "heat_flux") + beyond[0]);
        impulse += STEP * (sum(&mut trial, "pressure") + beyond[1]);
        let [flow, force] = get(&mut trial, ["heat_flow", "force"]);
        let scale = content() / 1e-5;
        assert!((sum(&mut trial, "heat_flux") + beyond[0] - flow).abs() < 1e-12 * scale);
        assert!((sum(&mut trial, "pressure") + beyond[1] - force).abs() < 1e-9);
    }
    let [given, pushed, aside] = get(&mut trial, ["heat", "impulse_z", "impulse_x"]);
    assert!(off(heat, given) < 1e-12 && off(impulse, -pushed) < 1e-12);
    assert!(aside.abs() < 1e-9 * pushed.abs());
}

/// A film that spreads beyond a disc pushes to all sides alike, and a step says that it is beyond.
#[test]
fn momentum_along_a_disc_is_zero_beyond_its_edge_too() {
    for method in ["film", "record"] {
        let disc = "shape = { disc = { radius = 6e-5, thickness = 1e-4 } }";
        let plate = plate(300.0, "").replace("shape = { box = [1e-3, 1e-3, 1e-4] }", disc);
        let mut trial = Trial::new(&(drop(method, "") + &plate.replace("radius = 1.5e-4\n", "")));
        let (mut widest, mut said) = (0.0_f64, false);
        for _ in 0..40 {
            trial.step(STEP);
            widest = widest.max(trial.get("drop.spread_diameter"));
            assert_eq!(get(&mut trial, ["impulse_x", "impulse_y"]), [0.0; 2], "{method}");
            let found = trial.model.warnings(&trial.state);
            said |= found.iter().any(|warning| warning.to_string().contains("beyond the edge"));
        }
        assert!(widest > 1.2e-4 && said, "{method}: {widest}");
    }
}

/// The flow does not depend on temperatures, and conduction is linear.
#[test]
fn heat_is_in_proportion_to_the_difference_of_temperatures() {
    for method in ["record", "film"] {
        let given = |plate_at: f64| {
            let mut trial = Trial::new(&(drop(method, "") + &plate(plate_at, "")));
            steps(&mut trial, 30);
            trial.get("drop.heat") / (350.0 - plate_at)
        };
        let one = given(300.0);
        for other in [400.0, 349.0, 77.0] {
            assert!(off(given(other), one) < 1e-9, "{method} on {other} K");
        }
    }
}
