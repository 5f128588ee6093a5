//! Surface tension of droplets: Rayleigh's period, Laplace's pressure and Young's angle.

use std::f64::consts::PI;

use crate::capillary::{
    core_pressure, elongation, found_half_width, half_width, on_wall, period, plan, stretched,
};
use crate::study::keep;
use impinge::body::sph::{DropletPlan, Placement};

/// Samples in a period.
const SAMPLES: f64 = 100.0;

/// Mean period over Rayleigh's from the first crossings, the amplitude left after a period, and
/// the mean core pressure over Laplace's of the second half.
fn swing(plan: DropletPlan, name: &str) -> [f64; 3] {
    let (drop, mut state) = stretched(plan, 1.1);
    let mut rows = vec![[0.0, elongation(&drop.particles(&state)), 0.0]];
    let count = (1.9 * SAMPLES) as usize;
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
    let swings = 0.5 * (crossings.len() - 1) as f64;
    let lasting = (crossings[crossings.len() - 1] - crossings[0]) / swings;
    let high = rows[rows.len() / 3..].iter().map(|row| row[1]).fold(0.0, f64::max);
    let late = &rows[rows.len() / 2..];
    let pressure = late.iter().map(|row| row[2]).sum::<f64>() / late.len() as f64;
    [lasting, high / rows[0][1], pressure]
}

#[test]
fn tension_of_a_swinging_drop() {
    println!(
        "\nSwinging drop: period over Rayleigh's, amplitude after a swing, core pressure over 2σ/R"
    );
    for (placement, label) in [(Placement::Lattice, "lattice"), (Placement::BlueNoise, "noise")] {
        for across in [20.0, 28.0, 40.0] {
            let plan = DropletPlan { placement, ..plan(3, across, 1e-3) };
            let [lasting, left, pressure] = swing(plan, &format!("swing_{label}_{across}.csv"));
            println!("{label:8} D/Δx {across}: {lasting:.3}  {left:.2}  {pressure:+.2}");
            // Coarser drops stop before they have swung once.
            let error = (lasting - 1.0).abs();
            assert!(across < 25.0 || error < 0.1, "{label} {across}: {lasting}");
        }
    }
}

#[test]
fn tension_of_a_drop_on_a_wall() {
    println!("\nPlane drop on a wall, D/Δx 40: half width over R, found and by Young's angle");
    for degrees in [60.0, 75.0, 90.0, 105.0, 120.0] {
        let angle = PI * degrees / 180.0;
        let (drop, mut state) = on_wall(40.0, angle);
        drop.advance(&mut state, &[300.0], 6.0 * period()).unwrap();
        let found = found_half_width(&drop.particles(&state), drop.plan().spacing);
        println!("{degrees}°: {found:.3}  {:.3}", half_width(angle));
        assert!((found - half_width(angle)).abs() < 0.3, "{degrees}");
    }
}
