use impinge::closed_form::{Conductor, DiscFlux, GaussianFlux, SuddenSurface, UniformFlux};

use crate::common::Trial;
use crate::study::{
    CONDUCTIVITY, HEAT_CAPACITY, Study, alumina, growth, line_of_probes, relative_norm,
};

const BODY: Conductor = Conductor { conductivity: CONDUCTIVITY, heat_capacity: HEAT_CAPACITY };
const COLUMN: &str = "box = [1e-4, 1e-4, 0.8e-4]";

/// A column that is fine only in depth, with nodes at equal distances.
fn column_mesh(spacing: f64, order: usize) -> String {
    format!("spacing = 5e-5, depth_spacing = {spacing:e}, growth = 1.00001, order = {order}")
}

/// Points at equal distances down the axis.
fn depths(count: usize, step: f64) -> Vec<[f64; 3]> {
    (0..count).map(|i| [0.0, 0.0, -step * i as f64]).collect()
}

fn temperature_probes(points: &[[f64; 3]]) -> String {
    line_of_probes("p", points, "\"temperature\"")
}

fn rises(trial: &mut Trial, count: usize) -> Vec<f64> {
    (0..count).map(|i| trial.get(&format!("p{i}.temperature")) - 293.15).collect()
}

#[test]
fn uniform_flux() {
    let points = depths(20, 1.13e-6);
    let exact = UniformFlux { body: BODY, flux: 5e7 };
    let wanted: Vec<f64> = points.iter().map(|p| exact.rise(-p[2], 1e-5)).collect();
    for (order, least) in [(1, 1.9), (2, 2.9)] {
        let mut study = Study::new(
            &format!("Uniform flux on a half space, 10 µs, order {order}"),
            &["surface temperature", "temperature over 21 µm of depth (norm)"],
        );
        for spacing in [4e-6, 2e-6, 1e-6, 0.5e-6] {
            let mesh = column_mesh(spacing, order);
            let faces = "top = { flux = 5e7 }";
            let mut trial =
                Trial::new(&alumina(COLUMN, &mesh, faces, &temperature_probes(&points)));
            trial.step(1e-5);
            let values = rises(&mut trial, points.len());
            assert!(trial.heat_residual("plate") < 1e-9);
            let errors = vec![values[0] / wanted[0] - 1.0, relative_norm(&values, &wanted)];
            study.add(&format!("h = {:.1} µm", spacing * 1e6), spacing, errors);
        }
        study.print();
        study.require(&[0, 1], least, 5e-3);
    }
}

#[test]
fn sudden_surface_temperature() {
    let points = depths(20, 1.13e-6);
    let exact = SuddenSurface { body: BODY, step: 16.499 };
    let wanted: Vec<f64> = points.iter().map(|p| exact.rise(-p[2], 1e-5)).collect();
    // ∫ q dt = 2 t q(t) for a flux that falls as 1/√t, over the area of the column.
    let heat = 2.0 * 1e-5 * exact.flux(1e-5) * 1e-8;
    for (order, least) in [(1, 1.9), (2, 2.9)] {
        let mut study = Study::new(
            &format!("Sudden surface temperature, 10 µs, order {order}"),
            &["temperature over 21 µm of depth (norm)", "heat taken up"],
        );
        for spacing in [4e-6, 2e-6, 1e-6, 0.5e-6] {
            let faces = "top = { temperature = 309.649 }";
            let mesh = column_mesh(spacing, order);
            let mut trial =
                Trial::new(&alumina(COLUMN, &mesh, faces, &temperature_probes(&points)));
            trial.step(1e-5);
            let norm = relative_norm(&rises(&mut trial, points.len()), &wanted);
            let taken = trial.get("plate.heat_stored") / heat - 1.0;
            assert!(trial.heat_residual("plate") < 1e-9);
            study.add(&format!("h = {:.1} µm", spacing * 1e6), spacing, vec![norm, taken]);
        }
        study.print();
        study.require(&[0, 1], least, 5e-3);
    }
}

fn round_load(kind: &str, radius: f64, flux: f64) -> String {
    format!(
        "[[load]]\nname = \"spot\"\non = \"plate.top\"\nfootprint = {{ {kind} = {{ radius = {radius:e} }} }}\ncarries = [\"heat_flux\"]\nstart = {{ heat_flux = {flux:e} }}\n"
    )
}

const SHAPES: [(&str, &str); 2] =
    [("disc", "disc = { radius = 1e-3, thickness = 1e-3 }"), ("box", "box = [2e-3, 2e-3, 1e-3]")];

#[test]
fn disc_flux() {
    let exact = DiscFlux { body: BODY, flux: 1e8, radius: 50e-6 };
    let points = depths(12, 10e-6);
    let wanted: Vec<f64> = points.iter().map(|p| exact.rise_on_axis(-p[2], 1e-3)).collect();
    for (name, shape) in SHAPES {
        for (order, least) in [(1, 1.5), (2, 1.5)] {
            let title = format!("Disc flux R 50 µm, axis of a {name}, 1 ms, order {order}");
            let quantities =
                ["surface (371.74 K)", "20 µm deep (211.72 K)", "110 µm of depth (norm)"];
            let mut study = Study::new(&title, &quantities);
            for spacing in [16e-6, 8e-6, 4e-6] {
                let mesh = format!(
                    "spacing = {spacing:e}, growth = {}, order = {order}",
                    growth(spacing, 16e-6)
                );
                let rest = round_load("disc", 50e-6, 1e8) + &temperature_probes(&points);
                let mut trial = Trial::new(&alumina(shape, &mesh, "", &rest));
                trial.step(1e-3);
                assert!(trial.heat_residual("plate") < 1e-9);
                let values = rises(&mut trial, points.len());
                let errors = vec![
                    values[0] / wanted[0] - 1.0,
                    values[2] / wanted[2] - 1.0,
                    relative_norm(&values, &wanted),
                ];
                study.add(&format!("h = {:.1} µm", spacing * 1e6), spacing, errors);
            }
            study.print();
            study.require(&[2], least, 5e-3);
        }
    }
}

#[test]
fn gaussian_flux_at_rest() {
    let exact = GaussianFlux { body: BODY, peak: 1e8, radius: 40e-6, velocity: 0.0 };
    let mut points = depths(8, 10e-6);
    points.extend((1..8).map(|i| [10e-6 * i as f64, 0.0, 0.0]));
    let wanted: Vec<f64> = points.iter().map(|p| exact.rise([p[0], p[1], -p[2]], 2e-4)).collect();
    for (name, shape) in SHAPES {
        for (order, least) in [(1, 1.5), (2, 2.5)] {
            let title = format!("Gaussian flux w 40 µm at rest on a {name}, 0.2 ms, order {order}");
            let mut study = Study::new(&title, &["centre", "70 µm of depth and surface (norm)"]);
            for spacing in [16e-6, 8e-6, 4e-6] {
                let mesh = format!(
                    "spacing = {spacing:e}, growth = {}, order = {order}",
                    growth(spacing, 16e-6)
                );
                let rest = round_load("gaussian", 40e-6, 1e8) + &temperature_probes(&points);
                let mut trial = Trial::new(&alumina(shape, &mesh, "", &rest));
                trial.step(2e-4);
                let values = rises(&mut trial, points.len());
                let errors = vec![values[0] / wanted[0] - 1.0, relative_norm(&values, &wanted)];
                study.add(&format!("h = {:.1} µm", spacing * 1e6), spacing, errors);
            }
            study.print();
            study.require(&[1], least, 5e-3);
        }
    }
}
