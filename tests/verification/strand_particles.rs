//! Strands of particles beside the mass balance and closed forms of their width.

use std::time::Instant;

use crate::common::Trial;

/// Flow that comes as fast as a nozzle of 1 mm moves at 20 mm/s [m³/s].
const FLOW: f64 = 0.02 * 0.785398e-6;

/// A strand of 8 mm above the plane, with this many particles across the nozzle.
fn strand(viscosity: &str, across: f64) -> Trial {
    Trial::new(&format!(
        "name = \"Strand\"\nstop_time = 3.0\nstep = 0.02\n[body.ink]\nkind = \"filament\"\nmethod = \"particles\"\n\
         fluid = {{ density = 1000.0, viscosity = {viscosity}, specific_heat = 2000.0, conductivity = 0.0 }}\n\
         nozzle = {{ diameter = 1e-3, height = 1e-3, temperature = 293.0, flow = {FLOW:e} }}\n\
         path = {{ time = [0.0, 0.4], x = [-4e-3, 4e-3], y = [0.0, 0.0] }}\nmost = 1e-8\nspacing = {:e}\n",
        1e-3 / across
    ))
}

/// Error of the section of what is laid between two times [s]: volume that comes over length that is laid.
fn section(trial: &mut Trial, [from, to]: [f64; 2]) -> f64 {
    let mut length = 0.0;
    let steps = (to / 0.02).round() as usize;
    for n in 1..=steps {
        trial.step(0.02);
        if n == (from / 0.02).round() as usize {
            length = trial.get("ink.length");
        }
    }
    let laid = trial.get("ink.length") - length;
    FLOW * (to - from) / laid / 0.785398e-6 - 1.0
}

#[test]
fn strands_of_particles_have_the_section_of_the_mass_balance() {
    println!(
        "fluid, across: section, width and height [mm], densities, particles, steps, time [s]"
    );
    for (viscosity, across) in [
        ("10.0", 4.0),
        ("10.0", 6.0),
        ("1.0", 4.0),
        ("{ law = \"bingham\", yield_stress = 60.0, plastic_viscosity = 2.0 }", 5.0),
    ] {
        let start = Instant::now();
        let mut trial = strand(viscosity, across);
        let error = section(&mut trial, [0.2, 0.36]);
        let of = ["width", "height", "min_density", "max_density", "particles", "steps"];
        let found = of.map(|key| trial.get(&format!("ink.{key}")));
        println!(
            "{viscosity}, {across}: {:+.2} %, {found:.4?}, {:.0?}",
            100.0 * error,
            start.elapsed()
        );
        assert!(error.abs() < 0.02, "{viscosity} {across}: {error}");
        assert!(found[2] > 960.0 && found[3] < 1040.0, "{found:?}");
    }
}
