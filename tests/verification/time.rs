use impinge::closed_form::{Conductor, Contact, GaussianFlux};

use crate::common::Trial;
use crate::study::{CONDUCTIVITY, HEAT_CAPACITY, Study, alumina, probe};

const BODY: Conductor = Conductor { conductivity: CONDUCTIVITY, heat_capacity: HEAT_CAPACITY };
const TEMPERATURE: &str = "\"temperature\"";

/// Inputs that are held over a step are integrated exactly, so a step's length makes no error; what
/// is left is what a master loses by holding an input that moves.
#[test]
fn moving_gaussian_flux_held_at_the_middle_of_each_step() {
    let (speed, duration) = (1.0, 4e-4);
    let exact = GaussianFlux { body: BODY, peak: 1e8, radius: 50e-6, velocity: speed };
    let mut study = Study::new(
        "Gaussian flux w 50 µm moving at 1 m/s for 0.4 ms, place held at the middle of each step, \
         order 2, h = 5 µm",
        &["at the centre", "50 µm behind", "20 µm below the centre"],
    );
    let start = -2e-4;
    let end = start + speed * duration;
    let points = [[end, 0.0, 0.0], [end - 50e-6, 0.0, 0.0], [end, 0.0, -20e-6]];
    let probes: String = points
        .iter()
        .enumerate()
        .map(|(i, &at)| probe(&format!("p{i}"), at, TEMPERATURE))
        .collect();
    let rest = format!(
        "[[load]]\nname = \"spot\"\non = \"plate.top\"\nfootprint = {{ gaussian = {{ radius = 50e-6 }} }}\ncarries = [\"heat_flux\"]\nstart = {{ heat_flux = 1e8, x = {start:e} }}\nrange = {{ x = [-2e-4, 2e-4] }}\n{probes}"
    );
    let mesh = "spacing = 5e-6, growth = 1.15, order = 2";
    let mut trial = Trial::new(&alumina("box = [2e-3, 2e-3, 0.6e-3]", mesh, "", &rest));
    let beginning = trial.state.clone();
    for steps in [20, 40, 80, 160, 320] {
        trial.restart(&beginning);
        let dt = duration / steps as f64;
        for i in 0..steps {
            trial.set("spot.x", start + speed * dt * (i as f64 + 0.5));
            trial.step(dt);
        }
        let errors = (0..3)
            .map(|i| {
                let [x, y, z] = points[i];
                let wanted = exact.rise([x - start, y, -z], duration);
                (trial.get(&format!("p{i}.temperature")) - 293.15) / wanted - 1.0
            })
            .collect();
        study.add(&format!("{steps} steps"), dt, errors);
    }
    study.print();
    // Below the surface the mesh's own error is left.
    study.require(&[0, 1], 1.5, 5e-3);
    study.require(&[2], 0.5, 5e-3);
}

/// A flux that falls as 1/√t, given to the unit as its mean over each step.
#[test]
fn contact_flux_given_as_means_over_the_steps() {
    let water = Conductor { conductivity: 0.6, heat_capacity: 4e6 };
    let contact = Contact {
        first: water,
        first_temperature: 373.15,
        second: BODY,
        second_temperature: 293.15,
    };
    let wanted = contact.temperature_of_contact() - 293.15;
    let faces = "top = { flux = 0.0 }";
    let mesh = "spacing = 5e-5, depth_spacing = 0.1e-6, growth = 1.1, order = 2";
    let text = alumina(
        "box = [1e-4, 1e-4, 0.8e-4]",
        mesh,
        faces,
        &probe("surface", [0.0; 3], TEMPERATURE),
    );
    let mut trial = Trial::new(&text);
    let beginning = trial.state.clone();
    let duration = 3.5e-6;
    let mut study = Study::new(
        "Contact flux as means over equal steps, surface temperature at 3.5 µs, order 2",
        &["surface"],
    );
    for steps in [10, 20, 40, 80, 160] {
        trial.restart(&beginning);
        let dt = duration / steps as f64;
        for i in 0..steps {
            let heat = |t: f64| if t > 0.0 { contact.heat(t) } else { 0.0 };
            let (from, to) = (dt * i as f64, dt * (i + 1) as f64);
            trial.set("plate.top.flux", (heat(to) - heat(from)) / dt);
            trial.step(dt);
        }
        let error = (trial.get("surface.temperature") - 293.15) / wanted - 1.0;
        study.add(&format!("{steps} steps"), dt, vec![error]);
    }
    study.print();
    assert!(study.finest(0) < 5e-3 && study.overall_order(0) > 0.45);
}
