//! Means over cells are adjoint to loads on the same cells, exact for what shape functions hold, and see all images.

use std::f64::consts::PI;

use crate::common::{Trial, off};

const SHAPES: [(&str, &str); 2] =
    [("box", "box = [8e-4, 6e-4, 2e-4]"), ("disc", "disc = { radius = 4e-4, thickness = 2e-4 }")];

/// Cells on the top, how many they are, and labels of those looked at.
const CELLS: [(&str, &[&str]); 5] = [
    ("disc = { radius = 1.2e-4 }", &[""]),
    ("gaussian = { radius = 6e-5 }", &[""]),
    ("ring = { inner = 5e-5, outer = 1.5e-4 }", &[""]),
    ("rings = { count = 4, radius = 1.4e-4 }", &["[1]", "[2]", "[3]", "[4]"]),
    ("tiles = { count = [2, 3], size = [2e-4, 2.5e-4] }", &["[1,1]", "[1,3]", "[2,2]"]),
];

/// A plate whose loads and means share a footprint.
fn plate(shape: &str, cells: &str, place: [f64; 2], more: &str) -> String {
    let [x, y] = place;
    let (start, at) = match place == [0.0; 2] {
        true => (String::new(), String::new()),
        false => (format!("start = {{ x = {x:e}, y = {y:e} }}"), format!("at = [{x:e}, {y:e}]")),
    };
    format!(
        "name = \"Plate\"\nstop_time = 1e-3\nstep = 1e-4\n[body.plate]\nkind = \"solid\"\nshape = {{ {shape} }}\n\
         initial_temperature = 300.0\nmaterial = {{ model = \"thermoelastic\", density = 8900.0, specific_heat = 385.0, \
         conductivity = 390.0, young = 120e9, poisson = 0.34, expansion = 1.7e-5 }}\n\
         mesh = {{ spacing = 4e-5, depth_spacing = 4e-5 }}\n{more}\n[body.plate.faces]\n\
         bottom = {{ clamped = true, convection = {{ coefficient = 5e4, ambient = 300.0 }} }}\n\
         [[load]]\nname = \"hot\"\non = \"plate.top\"\nfootprint = {{ {cells} }}\n\
         carries = [\"heat_flux\", \"pressure\"]\n{start}\n\
         [[field]]\nname = \"seen\"\non = \"plate.top\"\nfootprint = {{ {cells} }}\n{at}\n\
         gives = [\"temperature\", \"displacement\"]\n"
    )
}

fn area(cells: &str, label: &str) -> f64 {
    let ring = |i: f64| PI * (3.5e-5_f64).powi(2) * (2.0 * i - 1.0);
    match (cells.split(' ').next().unwrap(), label) {
        ("disc", _) => PI * 1.2e-4 * 1.2e-4,
        ("gaussian", _) => PI * 6e-5 * 6e-5 / 2.0,
        ("ring", _) => PI * (1.5e-4 * 1.5e-4 - 5e-5 * 5e-5),
        ("rings", label) => ring(label.trim_matches(['[', ']']).parse().unwrap()),
        _ => 1e-4 * 2.5e-4 / 3.0,
    }
}

/// Changes on all cells that follow from a unit of one input on each, times the area of the other: `[heat, force]`.
fn transfers(scene: &str, cells: &str, labels: &[&str]) -> Vec<Vec<[f64; 2]>> {
    let mut trial = Trial::new(scene);
    let start = trial.state.clone();
    let mut row = |from: &&str| {
        trial.restart(&start);
        trial.set(&format!("hot.pressure{from}"), 1e6);
        let seen =
            |key: &str| labels.iter().map(|to| format!("seen.{key}{to}")).collect::<Vec<_>>();
        let pushes: Vec<f64> = seen("displacement_z").iter().map(|name| -trial.get(name)).collect();
        trial.restart(&start);
        trial.set(&format!("hot.heat_flux{from}"), 1e8);
        [1e-6, 1e-5, 4e-5].into_iter().for_each(|step| trial.step(step));
        let rises =
            seen("temperature").iter().map(|name| trial.get(name) - 300.0).collect::<Vec<_>>();
        let both = rises.iter().zip(&pushes).zip(labels);
        both.map(|((rise, push), to)| [rise / 1e8, push / 1e6].map(|v| v * area(cells, to) * 1e9))
            .collect()
    };
    labels.iter().map(&mut row).collect()
}

#[test]
fn what_a_cell_feels_of_another_that_feels_of_it() {
    for (shape_name, shape) in SHAPES {
        for (cells, labels) in CELLS.into_iter().filter(|(_, labels)| labels.len() > 1) {
            let is_box = shape_name == "box";
            if !is_box && cells.starts_with("tiles") {
                continue;
            }
            for more in ["symmetry = \"auto\"", "symmetry = \"none\"", "heat = \"sph\""] {
                // Particles on rings conduct by an operator that is not symmetric.
                if !is_box && more != "symmetry = \"auto\"" {
                    continue;
                }
                let place = if is_box { [7e-5, -4e-5] } else { [0.0; 2] };
                // On any mesh.
                let scene = plate(shape, cells, place, more).replace(
                    "spacing = 4e-5, depth_spacing = 4e-5",
                    "spacing = 7e-5, depth_spacing = 5e-5",
                );
                let found = transfers(&scene, cells, labels);
                for (i, a) in labels.iter().enumerate() {
                    for (j, b) in labels.iter().enumerate().skip(i + 1) {
                        let [there, back] = [found[i][j], found[j][i]];
                        for k in 0..2 {
                            let off = off(there[k], back[k]);
                            assert!(off < 1e-9, "{shape_name} {cells} {more} {a} {b} {k}: {off}");
                            assert!(there[k] > 0.0, "{there:?}");
                        }
                    }
                }
            }
        }
    }
}

#[test]
fn the_mean_of_all_points_of_a_fine_grid_is_that_of_the_tile() {
    let cells = "tiles = { count = [2, 1], size = [2e-4, 1e-4] }";
    let grid = "[[field]]\nname = \"points\"\non = \"plate.top\"\ngrid = [80, 40]\nsize = [2e-4, 1e-4]\n\
                gives = [\"temperature\", \"stress\"]\n";
    let more = "gives = [\"temperature\", \"displacement\"]";
    let scene = plate(SHAPES[0].1, cells, [0.0; 2], "")
        .replace(more, "gives = [\"temperature\", \"stress\"]")
        .replace("spacing = 4e-5, depth_spacing = 4e-5", "spacing = 2e-5, depth_spacing = 4e-5")
        + grid;
    for heat in ["fem", "sph"] {
        let scene =
            scene.replace("[body.plate.faces]", &format!("heat = \"{heat}\"\n[body.plate.faces]"));
        let mut trial = Trial::new(&scene);
        trial.set("hot.heat_flux[1,1]", 3e8);
        trial.set("hot.pressure[2,1]", 1e7);
        trial.step(1e-5);
        for (key, base, bound) in
            [("temperature", 300.0, 1e-3), ("stress_xx", 0.0, 5e-3), ("von_mises", 0.0, 5e-2)]
        {
            for (tile, columns) in [(1, 1..=40), (2, 41..=80)] {
                let points = columns.flat_map(|i| (1..=40).map(move |j| (i, j)));
                let value = |(i, j)| trial.get(&format!("points.{key}[{i},{j}]"));
                let values: Vec<f64> = points.map(value).collect();
                let mean = values.iter().sum::<f64>() / values.len() as f64;
                let found = trial.get(&format!("seen.{key}[{tile},1]"));
                let off = off(found - base, mean - base);
                assert!(off < bound, "{heat} {key} tile {tile}: {found} {mean} {off}");
            }
        }
    }
}

#[test]
fn a_uniform_temperature_is_its_mean_on_every_cell() {
    for (cells, labels) in CELLS {
        let scene = plate(SHAPES[0].1, cells, [-9e-5, 3e-5], "")
            .replace("ambient = 300.0", "ambient = 400.0");
        let mut trial = Trial::new(&scene);
        trial.step(1e3);
        for label in labels {
            let mean = trial.get(&format!("seen.temperature{label}"));
            assert!((mean - 400.0).abs() < 1e-9, "{cells}{label}: {mean}");
        }
    }
}

/// Means of components over rings of a disc are those of components along x, y and z, as in a box: of radial and hoop
/// stress their mean, of radial displacement nothing.
#[test]
fn rings_of_discs_have_components_along_the_axes() {
    let rings = "rings = { count = 4, radius = 1.4e-4 }";
    let probe =
        "[[probe]]\nname = \"p\"\nin = \"plate\"\nat = [1.2e-4, 0.0, 0.0]\ngives = [\"stress\"]\n";
    let text = plate(SHAPES[1].1, rings, [0.0; 2], "");
    let text = text.replace(
        "gives = [\"temperature\", \"displacement\"]",
        "gives = [\"stress\", \"displacement\"]",
    );
    let mut trial = Trial::new(&(text + probe));
    for ring in 1..=4 {
        trial.set(&format!("hot.heat_flux[{ring}]"), if ring < 3 { 1e8 } else { 0.0 });
    }
    trial.step(1e-3);
    let [radial, hoop] = ["p.stress_xx", "p.stress_yy"].map(|name| trial.get(name));
    assert!(off(radial, hoop) > 0.05, "{radial} {hoop}");
    let read = |trial: &mut Trial, name: &str| trial.get(&format!("seen.{name}[4]"));
    let [xx, yy, xy] = ["stress_xx", "stress_yy", "stress_xy"].map(|name| read(&mut trial, name));
    assert!(off(xx, yy) < 1e-9 && xy.abs() < 1e-9 * xx.abs(), "{xx} {yy} {xy}");
    assert!(off(xx, 0.5 * (radial + hoop)) < 0.05, "{xx} {radial} {hoop}");
    let [along, down] = ["displacement_x", "displacement_z"].map(|name| read(&mut trial, name));
    assert!(along.abs() < 1e-9 * down.abs(), "{along} {down}");
}
