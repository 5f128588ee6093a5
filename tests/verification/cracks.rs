//! Cracks as gradient damage beside linear fracture mechanics.

use closed_form::gradient_damage::around_tip;

use crate::edge_crack::{AHEAD, Cracked, EdgeCrack, POISSON, YOUNG, even};

/// Size of elements; energy of cracks and length of damage are the units.
const H: f64 = 1.0 / 3.0;

/// A strip whose edge moves as it does around the tip of a crack of the material's toughness, tip by tip.
#[test]
fn moving_crack_dissipates_its_energy_per_length() {
    let rows = 61;
    let half = 0.5 * H * rows as f64;
    let axes = [even(0.0, 40.0, 120), even(-half, half, rows)];
    let on_edge = |[i, j]: [usize; 2], [columns, rows]: [usize; 2]| {
        [i == 0 || j == 0 || i == columns - 1 || j == rows - 1; 2]
    };
    let start = 8.0;
    let distance = |[x, z]: [f64; 2]| match x < start {
        true => z.abs() - 0.5 * H,
        false => (x - start).hypot(z),
    };
    let mut strip = Cracked::new(axes, on_edge, distance, 2);
    let toughness = (YOUNG / (1.0 - POISSON * POISSON)).sqrt();
    let places: Vec<[f64; 2]> = strip.places().collect();
    let rise = vec![0.0; places.len()];
    let [columns, rows] = strip.problem.elements.grid.counts;
    let (mut dissipated, mut ahead) = (Vec::new(), 0.0);
    for step in 0..=24 {
        let tip = start + 0.5 * f64::from(step);
        for (n, [x, z]) in places.iter().enumerate() {
            if on_edge([n % columns, n / columns], [columns, rows])[0] {
                let own = around_tip([x - tip, *z], toughness, [YOUNG, POISSON]);
                strip.state.displacement[2 * n..][..2].copy_from_slice(&own);
            }
        }
        strip.solve(&rise);
        dissipated.push(strip.dissipated());
        let middle = &strip.state.damage[columns * (rows / 2)..][..columns];
        let broken = middle.iter().rposition(|&damage| damage > 0.95).unwrap();
        ahead = tip - places[broken][0];
    }
    let rate = (dissipated[24] - dissipated[12]) / 6.0;
    println!("moving crack: {rate:.4} of its energy per length, broken elements {ahead:.2} behind");
    assert!((rate - 1.0).abs() < 0.02, "{rate}");
    assert!((ahead - AHEAD).abs() < H, "{ahead}");
}

/// A half plane with an edge crack, whose surface is suddenly cooled so that K(a, t) = K_Ic at a + AHEAD = 2√(κt).
#[test]
fn edge_crack_starts_when_its_stress_intensity_is_the_toughness() {
    let mut plane = EdgeCrack::new(H, 2);
    let mut first = None;
    let starts = (0..20).map(|step| 0.9 + 0.01 * f64::from(step)).find(|&part| {
        plane.solve(part);
        let dissipated = plane.cracked.dissipated();
        dissipated - *first.get_or_insert(dissipated) > 0.2
    });
    println!("edge crack: it starts at {starts:?} of the depth of heat");
    let starts = starts.expect("it starts");
    let Cracked { problem, state, .. } = &plane.cracked;
    let energies = problem.energies(state);
    let gained = energies.elastic + energies.dissipated - first.unwrap();
    let balance = gained / state.work;
    println!("edge crack: {balance:.5} of the work is elastic energy and that of cracks");
    assert!((balance - 1.0).abs() < 2e-3, "{balance}");
    // Time goes with the square of that depth.
    assert!((starts * starts - 1.0).abs() < 0.05, "{starts}");
}
