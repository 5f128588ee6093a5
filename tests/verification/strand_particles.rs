//! Strands of particles beside the mass balance, and their convergence.

use std::time::Instant;

use crate::common::Trial;

/// Flow that comes as fast as a nozzle of 1 mm moves at 20 mm/s [m³/s].
const FLOW: f64 = 0.02 * 0.785398e-6;

/// Path along x of 16 mm, and one of 8 mm that turns to y in its middle.
const STRAIGHT: &str = "{ time = [0.0, 0.8], x = [-8e-3, 8e-3], y = [0.0, 0.0] }";
const BENT: &str = "{ time = [0.0, 0.2, 0.4], x = [-4e-3, 0.0, 0.0], y = [0.0, 0.0, 4e-3] }";

/// A strand along a path above the plane, with this many particles across the nozzle.
fn strand(viscosity: &str, across: f64, path: &str) -> Trial {
    Trial::new(&format!(
        "name = \"Strand\"\nstop_time = 3.0\nstep = 0.02\n[body.ink]\nkind = \"filament\"\nmethod = \"particles\"\n\
         fluid = {{ density = 1000.0, viscosity = {viscosity}, specific_heat = 2000.0, conductivity = 0.0 }}\n\
         nozzle = {{ diameter = 1e-3, height = 1e-3, temperature = 293.0, flow = {FLOW:e} }}\n\
         path = {path}\nmost = 5e-8\nspacing = {:e}\n\
         [[target]]\nof = \"ink\"\nline = [[-4e-3, 0.0], [0.0, 0.0], [0.0, 4e-3]]\n",
        1e-3 / across
    ))
}

/// Error of the section of what is laid between two times [s].
fn section(trial: &mut Trial, [from, to]: [f64; 2]) -> f64 {
    let laid = |trial: &mut Trial| {
        let [length, width, height] =
            ["length", "width", "height"].map(|key| trial.get(&format!("ink.{key}")));
        [length, length * width * height]
    };
    let [first, last] = [from, to].map(|time| (time / 0.02).round() as usize);
    let mut before = [0.0; 2];
    for n in 1..=last {
        trial.step(0.02);
        if n == first {
            before = laid(trial);
        }
    }
    let after = laid(trial);
    (after[1] - before[1]) / (after[0] - before[0]) / 0.785398e-6 - 1.0
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
        let mut trial = strand(viscosity, across, STRAIGHT);
        let error = section(&mut trial, [0.2, 0.76]);
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

/// Distances from the drawn corner change by less than 2 % of the diameter where the distance of particles halves, and
/// widths by less than 5 %.
#[test]
fn bent_strands_converge() {
    println!("across: mean and largest deviation, width, height, lag [mm]");
    let of = ["deviation", "largest_deviation", "width", "height", "lag"];
    let [coarse, fine] = [4.0, 8.0].map(|across| {
        let mut trial = strand("10.0", across, BENT);
        (0..18).for_each(|_| trial.step(0.02));
        let found = of.map(|key| 1e3 * trial.get(&format!("ink.{key}")));
        println!("{across}: {found:.4?}");
        found
    });
    assert!((coarse[0] - fine[0]).abs() < 0.02, "{coarse:?} {fine:?}");
    for n in [2, 3] {
        assert!((coarse[n] / fine[n] - 1.0).abs() < 0.05, "{coarse:?} {fine:?}");
    }
}
