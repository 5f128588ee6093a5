//! Plates of alumina that fall into water from five temperatures: cracks grow in number and length, and their spacing
//! falls (thermal shock of 99 % alumina, 50 × 10 × 1 mm, from 300, 350, 400, 500 and 600 °C into water of 20 °C).

use crate::common::Trial;

/// Points along the surface and through the depth at which damage is read.
const GRID: [usize; 2] = [401, 9];
/// Depth of the quarter that is modelled, and its length [m].
const DEPTH: f64 = 5e-3;
const LENGTH: f64 = 25e-3;
/// Part of the length that is not beside the cooled end.
const ALONG_TOP: f64 = 0.9;

/// A quarter of a plate, with constants of a published study; its strength sets the length of damage, 0.18 mm.
fn plate(celsius: f64) -> String {
    let [columns, rows] = GRID;
    format!(
        r#"
name = "Quench"
stop_time = 0.2
step = 4e-3
[body.plate]
kind = "solid"
shape = {{ box = [{LENGTH}, 1e-3, {DEPTH}] }}
section = "plane_stress"
initial_temperature = {}
faces.top = {{ convection = {{ coefficient = 60e3, ambient = 293.15 }} }}
faces.right = {{ convection = {{ coefficient = 60e3, ambient = 293.15 }} }}
faces.left = {{ roller = true }}
faces.bottom = {{ roller = true }}
[body.plate.material]
model = "thermoelastic"
density = 3980.0
specific_heat = 880.0
conductivity = 31.0
young = 370e9
poisson = 0.3
expansion = 7.5e-6
fracture = {{ model = "at1", strength = 180e6, energy = 42.47, scatter = 0.1, seed = 3 }}
[[field]]
name = "section"
in = "plate"
plane = {{ y = 0.0 }}
grid = [{columns}, {rows}]
gives = ["damage"]
"#,
        celsius + 273.15
    )
}

/// Number of cracks that reach a row of points, counted from the top.
fn cracks_at(trial: &mut Trial, row: usize) -> usize {
    let [columns, rows] = GRID;
    let last = (ALONG_TOP * columns as f64) as usize;
    let mut is_broken = |i: usize| {
        let name = format!("section.damage[{i},{}]", rows - row);
        trial.get(&name) > 0.8
    };
    let broken: Vec<bool> = (1..=last).map(&mut is_broken).collect();
    broken.windows(2).filter(|pair| !pair[0] && pair[1]).count() + usize::from(broken[0])
}

#[test]
fn hotter_plates_crack_more_densely() {
    let mut found = Vec::new();
    for celsius in [300.0, 350.0, 400.0, 500.0, 600.0] {
        let mut trial = Trial::new(&plate(celsius));
        for _ in 0..50 {
            trial.step(4e-3);
        }
        let counts = [1, 2, 3, 4].map(|row| cracks_at(&mut trial, row));
        let [length, depth] =
            ["crack_length", "crack_depth"].map(|key| 1e3 * trial.get(&format!("plate.{key}")));
        let spacing = ALONG_TOP * LENGTH * 1e3 / counts[0] as f64;
        println!(
            "{celsius} °C: {counts:?} cracks reach 0.6, 1.2, 1.9 and 2.5 mm, {spacing:.2} mm apart; {length:.1} mm in all, \
             {depth:.2} mm at most"
        );
        found.push((counts, length));
    }
    for pair in found.windows(2) {
        let [(before, shorter), (after, longer)] = [pair[0], pair[1]];
        assert!(after[0] >= before[0] && longer > shorter, "{before:?} {after:?}");
        // Long cracks relieve others: fewer go on.
        assert!(after[3] <= after[0], "{after:?}");
    }
    let [first, last] = [found[0].0[0], found[4].0[0]];
    assert!(last as f64 > 1.3 * first as f64, "{first} {last}");
}
