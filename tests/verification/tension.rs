//! Surface tension of droplets: Rayleigh's period, Laplace's pressure and Young's angle.

use std::f64::consts::PI;

use crate::capillary::{
    RADIUS, TENSION, core_pressure, elongation, elongations, fitted, found_half_width, half_width,
    normal_mode, on_wall, period, plan, stretched, viscosity,
};
use crate::common::Trial;
use crate::study::keep;
use impinge::method::sph::{DropletPlan, Placement};

/// Samples in a period.
const SAMPLES: f64 = 100.0;

/// Period over Rayleigh's between crossings in the same direction, the amplitude left after a period, and
/// the mean core pressure over Laplace's.
fn swing(plan: DropletPlan, name: &str) -> [f64; 3] {
    let (drop, mut state) = stretched(plan, 1.1);
    let mut rows = vec![[0.0, elongation(&drop.particles(&state)), 0.0]];
    let count = (1.45 * SAMPLES) as usize;
    for sample in 1..=count {
        drop.advance(&mut state, &[], period() / SAMPLES).unwrap();
        let particles = drop.particles(&state);
        rows.push([sample as f64 / SAMPLES, elongation(&particles), core_pressure(&particles)]);
    }
    keep(name, "t_over_T,elongation,core_pressure", rows.iter().map(|row| row.to_vec()));
    let crossings: Vec<f64> = rows
        .windows(2)
        .filter(|pair| pair[0][1] * pair[1][1] < 0.0)
        .map(|pair| pair[0][0] + pair[0][1] / (pair[0][1] - pair[1][1]) / SAMPLES)
        .collect();
    // A drop is prolate for longer than oblate, so half periods tell nothing.
    let lasting = crossings[2] - crossings[0];
    let high = rows[rows.len() / 2..].iter().map(|row| row[1]).fold(0.0, f64::max);
    let pressure = rows[1..].iter().map(|row| row[2]).sum::<f64>() / count as f64;
    [lasting, high / rows[0][1], pressure]
}

#[test]
fn tension_of_a_swinging_drop() {
    println!(
        "\nSwinging drop: period over Rayleigh's, amplitude after a swing, core pressure over 2σ/R"
    );
    // Blue noise settles first, its pressure with it.
    let cases = [
        (Placement::Lattice, "lattice", [(20.0, 0.07), (28.0, 0.05), (40.0, 0.03)]),
        (Placement::BlueNoise, "noise", [(20.0, 0.12), (28.0, 0.08), (40.0, 0.04)]),
    ];
    for (placement, label, errors) in cases {
        for (across, error) in errors {
            let plan = DropletPlan { placement, ..plan(3, across, 1e-3) };
            let [lasting, left, pressure] = swing(plan, &format!("swing_{label}_{across}.csv"));
            println!("{label:8} D/Δx {across}: {lasting:.3}  {left:.2}  {pressure:+.3}");
            assert!((lasting - 1.0).abs() < error, "{label} {across}: {lasting}");
            assert!((pressure - 1.0).abs() < error, "{label} {across}: {pressure}");
            assert!((0.75..1.0).contains(&left), "{label} {across}: {left}");
        }
    }
}

#[test]
fn decay_of_a_swinging_drop() {
    println!("\nSwinging drop: decay in a period of Rayleigh, of the normal mode and found");
    println!(
        "\n| Oh | D/Δx | normal mode | found | kept over that of the normal mode | frequency |"
    );
    println!("|---|---|---|---|---|---|");
    for ohnesorge in [0.01, 0.03, 0.1, 0.3] {
        for across in [20.0, 32.0] {
            let plan = plan(3, across, viscosity(ohnesorge));
            let exact = normal_mode(&plan).decay_and_frequency().map(|rate| rate * period());
            let found = fitted(&elongations(plan), exact);
            let kept = (exact[0] - found[0]).exp();
            let frequency = found[1] / exact[1];
            println!(
                "| {ohnesorge} | {across} | {:.4} | {:.4} | {kept:.3} | {frequency:.3} |",
                exact[0], found[0]
            );
            // What is left after a period, where viscosity takes little, and the decay, where it takes much.
            let error = (kept - 1.0).abs().min((found[0] / exact[0] - 1.0).abs());
            assert!(error < 0.06, "{ohnesorge} {across}: {found:?} {exact:?}");
            assert!((frequency - 1.0).abs() < 0.04, "{ohnesorge} {across}: {frequency}");
        }
    }
}

#[test]
fn tension_of_a_drop_at_rest() {
    println!(
        "\nDrop at rest: mean core pressure over 2σ/R, surface energy over 4πR²σ after 4 periods"
    );
    let errors = [20.0, 28.0, 40.0].map(|across| {
        let (drop, mut state) = stretched(plan(3, across, 1e-2), 1.0);
        drop.advance(&mut state, &[], 2.0 * period()).unwrap();
        let mut pressure = 0.0;
        for _ in 0..200 {
            drop.advance(&mut state, &[], 0.01 * period()).unwrap();
            pressure += core_pressure(&drop.particles(&state)) / 200.0;
        }
        let energy = drop.totals(&state).surface_energy / (4.0 * PI * RADIUS * RADIUS * TENSION);
        println!("D/Δx {across}: {pressure:.3}  {energy:.3}");
        (pressure - 1.0).abs()
    });
    assert!(errors[2] < 0.02 && errors.iter().all(|error| *error < 0.06), "{errors:?}");
}

#[test]
fn tension_of_a_drop_on_a_wall() {
    println!("\nPlane drop on a wall: half width over R by Young's angle, and with D/Δx 28 and 40");
    for degrees in [45.0, 60.0, 75.0, 90.0, 105.0, 120.0, 135.0] {
        let angle = PI * degrees / 180.0;
        let found = [28.0, 40.0].map(|across| {
            let (drop, mut state) = on_wall(across, angle);
            drop.advance(&mut state, &[300.0], 6.0 * period()).unwrap();
            found_half_width(&drop.particles(&state), drop.plan().spacing)
        });
        let asked = half_width(angle);
        println!("{degrees}°: {asked:.3}  {:.3}  {:.3}", found[0], found[1]);
        // Two distances of particles, three at the edge of a thin wedge.
        let error = if degrees < 60.0 { 0.15 } else { 0.1 };
        assert!((found[1] - asked).abs() < error, "{degrees}");
    }
}

/// The suite has the same at 14 particles over the diameter.
#[test]
fn mass_of_a_finer_drop_at_rest() {
    println!(
        "\nDrop of water at rest, 20 particles over the diameter: height over its first, a row a period"
    );
    let text = r#"
name = "Drop"
stop_time = 1.0
step = 1e-3
[body.drop]
kind = "droplet"
diameter = 2e-3
impact_velocity = 0.0
initial_temperature = 300.0
spacing = 1e-4
fluid = { density = 998.0, viscosity = 1e-3, surface_tension = 0.072, specific_heat = 4000.0, conductivity = 0.0 }
"#;
    let mut trial = Trial::new(text);
    let start = trial.get("drop.height");
    for _ in 0..4 {
        trial.step(2.0 * PI * (998e-9_f64 / (8.0 * 0.072)).sqrt());
        let height = trial.get("drop.height");
        println!("{:.4}", height / start);
        assert_eq!(trial.get("drop.stray_particles"), 0.0);
        assert!((height - start).abs() < 0.17e-3, "{height} {start}");
    }
    assert_eq!(trial.get("drop.stray_mass"), 0.0);
    assert_eq!(trial.model.closing_warnings(&trial.state), []);
}
