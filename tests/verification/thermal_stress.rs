use impinge::closed_form::{Conductor, Elastic, SuddenSurface, constrained_layer};

use crate::common::Trial;
use crate::study::{
    CONDUCTIVITY, EXPANSION, HEAT_CAPACITY, POISSON, Study, YOUNG, alumina, line_of_probes,
    relative_norm,
};

const BODY: Conductor = Conductor { conductivity: CONDUCTIVITY, heat_capacity: HEAT_CAPACITY };
const ELASTIC: Elastic = Elastic { young: YOUNG, poisson: POISSON };

/// A laterally held half space whose surface temperature jumps by 16.499 K: −50.75 MPa there.
#[test]
fn step_heating_of_a_laterally_held_surface() {
    let points: Vec<[f64; 3]> = (0..20).map(|i| [0.0, 0.0, -1.13e-6 * i as f64]).collect();
    let heat = SuddenSurface { body: BODY, step: 16.499 };
    let stress = |point: &[f64; 3]| {
        constrained_layer::in_plane_stress(&ELASTIC, EXPANSION, heat.rise(-point[2], 1e-5))
    };
    let wanted: Vec<f64> = points.iter().map(stress).collect();
    assert!((wanted[0] + 50.75e6).abs() < 0.005e6);
    for (order, least) in [(1, 1.9), (2, 2.8)] {
        let mut study = Study::new(
            &format!("Step heating of a laterally held half space, 10 µs, order {order}"),
            &[
                "σ_xx at the surface (−50.75 MPa)",
                "σ_xx over 21 µm of depth (norm)",
                "σ_zz at the surface / σ_xx",
            ],
        );
        for spacing in [4e-6, 2e-6, 1e-6, 0.5e-6] {
            let faces = "sides = { roller = true }\nbottom = { clamped = true }\ntop = { temperature = 309.649 }";
            let mesh = format!(
                "spacing = 5e-5, depth_spacing = {spacing:e}, growth = 1.00001, order = {order}"
            );
            let probes = line_of_probes("p", &points, "\"stress\"");
            let mut trial =
                Trial::new(&alumina("box = [1e-4, 1e-4, 0.8e-4]", &mesh, faces, &probes));
            trial.step(1e-5);
            let values: Vec<f64> =
                (0..points.len()).map(|i| trial.get(&format!("p{i}.stress_xx"))).collect();
            let errors = vec![
                values[0] / wanted[0] - 1.0,
                relative_norm(&values, &wanted),
                trial.get("p0.stress_zz") / wanted[0],
            ];
            study.add(&format!("h = {:.1} µm", spacing * 1e6), spacing, errors);
        }
        study.print();
        study.require(&[1], least, 5e-3);
        // The recovery repeats a heated layer, so the surface is right on every mesh.
        assert!(study.finest(0) < 1e-10 && study.finest(2) < 1e-10);
    }
}
