//! Estimates of errors of bodies that yield or creep are those of such bodies.

use impinge::model::tolerance::{BodyEstimate, estimates};
use impinge::scene::parse;

use crate::common::Trial;

/// A heated spot on a metal disc or box, on a mesh that the scene sets.
struct Case {
    name: &'static str,
    material: &'static str,
    flux: f64,
    shape: &'static str,
    order: usize,
    /// Distances of nodes of the mesh that is judged over the radius of the spot.
    spacing: f64,
}

const STEEL: &str = "model = \"elastoplastic\", density = 7800.0, specific_heat = 500.0, conductivity = 45.0, \
                     young = 200e9, poisson = 0.3, expansion = 1.2e-5, yield_stress = 250e6, \
                     isotropic_hardening = 2e9";
const ALUMINIUM: &str = "model = \"elastoplastic\", density = 2700.0, specific_heat = 900.0, conductivity = 200.0, \
                         young = 70e9, poisson = 0.33, expansion = 2.3e-5, yield_stress = 80e6";
const COPPER: &str = "model = \"elastoplastic\", density = 8960.0, specific_heat = 385.0, conductivity = 400.0, \
                      young = 120e9, poisson = 0.34, expansion = 1.7e-5, yield_stress = 70e6, \
                      kinematic_hardening = 2e9";
const LEAD: &str = "model = \"elastoplastic\", density = 11340.0, specific_heat = 129.0, conductivity = 35.0, \
                    young = 16e9, poisson = 0.44, expansion = 2.9e-5, yield_stress = 12e6, isotropic_hardening = 5e7";

const DISC: &str = "disc = { radius = 3e-3, thickness = 1e-3 }";
const BOX: &str = "box = [4e-3, 4e-3, 1e-3]";

const CASES: [Case; 6] = [
    Case { name: "steel", material: STEEL, flux: 4e7, shape: DISC, order: 1, spacing: 0.4 },
    Case { name: "steel", material: STEEL, flux: 4e7, shape: DISC, order: 2, spacing: 0.4 },
    Case {
        name: "aluminium",
        material: ALUMINIUM,
        flux: 1.5e8,
        shape: DISC,
        order: 2,
        spacing: 0.5,
    },
    Case { name: "copper", material: COPPER, flux: 3e8, shape: DISC, order: 1, spacing: 0.5 },
    Case { name: "lead", material: LEAD, flux: 1.5e7, shape: DISC, order: 2, spacing: 0.3 },
    Case { name: "steel", material: STEEL, flux: 4e7, shape: BOX, order: 1, spacing: 0.6 },
];

/// Radius of the spot [m].
const RADIUS: f64 = 8e-4;
const PLACES: [[f64; 3]; 3] = [[0.0, 0.0, 0.0], [4e-4, 0.0, -1e-4], [0.0, 0.0, -3e-4]];

fn text(case: &Case, refined: f64) -> String {
    let probe = |(n, at): (usize, &[f64; 3])| {
        format!("[[probe]]\nname = \"q{n}\"\nin = \"plate\"\nat = {at:?}\ngives = [\"stress\"]\n")
    };
    let probes: String = PLACES.iter().enumerate().map(probe).collect();
    let spacing = case.spacing * RADIUS / refined;
    format!(
        "name = \"Spot\"\nstop_time = 0.01\nstep = 0.0025\n[body.plate]\nkind = \"solid\"\n\
         shape = {{ {} }}\n{}initial_temperature = 300.0\nmaterial = {{ {} }}\n\
         mesh = {{ spacing = {spacing:e}, depth_spacing = {:e}, growth = {:?}, order = {} }}\n[body.plate.faces]\n\
         bottom = {{ {} = true, convection = {{ coefficient = 1e3, ambient = 300.0 }} }}\n[[load]]\nname = \"spot\"\n\
         on = \"plate.top\"\nfootprint = {{ gaussian = {{ radius = {RADIUS:e} }} }}\ncarries = [\"heat_flux\"]\n\
         start = {{ heat_flux = {:e} }}\n{probes}",
        case.shape,
        if case.shape == BOX { "symmetry = \"quarter\"\n" } else { "" },
        case.material,
        0.6 * spacing,
        1.0 + 0.4 / refined,
        case.order,
        if case.shape == BOX { "clamped" } else { "roller" },
        case.flux,
    )
}

/// Stress at all probes over time.
fn stresses(text: &str) -> Vec<f64> {
    let mut trial = Trial::new(text);
    let mut all = Vec::new();
    for _ in 0..4 {
        trial.step(2.5e-3);
        for n in 0..PLACES.len() {
            for key in ["stress_xx", "stress_yy", "stress_zz", "stress_xz", "von_mises"] {
                all.push(trial.get(&format!("q{n}.{key}")));
            }
        }
    }
    assert!(trial.get("plate.max_plastic_strain") > 1e-5);
    all
}

fn estimate(text: &str) -> BodyEstimate {
    estimates(&parse(text, "scene").unwrap_or_else(|error| panic!("{error}"))).1.remove(0)
}

#[test]
fn estimates_of_bodies_that_yield_cover_what_a_finer_mesh_finds() {
    for case in &CASES {
        let own = text(case, 1.0);
        let found = estimate(&own);
        let finer = if case.shape == BOX { 2.5 } else { 5.0 };
        let (own, fine) = (stresses(&own), stresses(&text(case, finer)));
        let largest = fine.iter().fold(0.0_f64, |most, stress| most.max(stress.abs()));
        let pairs = own.iter().zip(&fine);
        let error = pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max) / largest;
        let Case { name, shape, order, .. } = case;
        let said = found.worst().unwrap();
        println!("{name} {shape} {order}: {error:.4}, estimated {said:.4} {:?}", found.notes);
        assert!(
            said > 0.8 * error && said < 12.0 * error,
            "{name} {shape} {order}: {error} {said}"
        );
        assert!(!found.notes.iter().any(|note| note.contains("flows")), "{:?}", found.notes);
    }
}

#[test]
fn an_estimate_in_which_nothing_flows_says_so() {
    let rests = text(&CASES[0], 1.0).replace("heat_flux = 4e7", "heat_flux = 0.0");
    let notes = estimate(&rests).notes;
    assert!(notes.iter().any(|note| note.starts_with("nothing flows under")), "{notes:?}");
}
