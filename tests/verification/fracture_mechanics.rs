//! Cracks as gradient damage beside closed forms of linear fracture mechanics: beams, pennies and dense arrays.

use closed_form::edge_crack::{cantilever_opening, cantilever_release, penny_in_cylinder};
use impinge::method::damage::Form;

use crate::edge_crack::{AHEAD, Cracked, EXPANSION, POISSON, YOUNG, fine_within};

/// Size of elements at cracks; energy of cracks and length of damage are the units.
const H: f64 = 1.0 / 3.0;
const PLANE_YOUNG: f64 = YOUNG / (1.0 - POISSON * POISSON);

/// Distance of a place from a crack along an axis up to its tip, whose row of elements is broken.
fn from_crack(along: f64, across: f64, tip: f64) -> f64 {
    match along < tip {
        true => across.abs() - 0.5 * H,
        false => (along - tip).hypot(across),
    }
}

/// Two arms are pulled apart at their ends: load and opening give the energy release rate of the beams.
#[test]
fn double_cantilever_runs_at_its_energy() {
    let (height, start) = (60.0, 120.0);
    let x = fine_within([start - 2.0, start + 14.0], [0.0, start + 4.0 * height], H, 5.0);
    let z = fine_within([-3.0, 3.0], [-height, height], H, 5.0);
    let held = |[i, _]: [usize; 2], [columns, _]: [usize; 2]| {
        let is_far = i == columns - 1;
        [is_far, i == 0 || is_far]
    };
    let mut beam = Cracked::new([x, z], held, |[x, z]| from_crack(x, z, start), 2);
    let places: Vec<[f64; 2]> = beam.places().collect();
    let rise = vec![0.0; places.len()];
    let opening = cantilever_opening(start + AHEAD, height, PLANE_YOUNG);
    let first = beam.dissipated();
    let mut releases = Vec::new();
    for step in 0..40 {
        let own = opening * (0.95 + 0.01 * f64::from(step));
        for (n, [_, z]) in places.iter().enumerate().filter(|(_, [x, _])| *x == 0.0) {
            beam.state.displacement[2 * n + 1] = 0.5 * own * z.signum();
        }
        beam.solve(&rise);
        let forces = beam.problem.forces(&beam.state);
        let of_upper_arm = places.iter().enumerate().filter(|(_, [x, z])| *x == 0.0 && *z > 0.0);
        let load: f64 = of_upper_arm.map(|(n, _)| forces[2 * n + 1]).sum();
        let grown = beam.dissipated() - first;
        if grown > 1.0 {
            releases.push(cantilever_release(load * own, start + AHEAD + grown, height));
        }
        if grown > 8.0 {
            break;
        }
    }
    println!("double cantilever: it runs at {releases:.3?} of its energy, by load and opening");
    assert!(releases.len() > 3);
    // The damage beside the crack weakens the arms, and broken elements keep a millionth of their stiffness.
    assert!(releases.iter().all(|release| (release - 1.0).abs() < 0.04), "{releases:?}");
}

/// A round crack in a cylinder that is pulled along its axis.
#[test]
fn penny_starts_at_its_stress() {
    let radius = 30.0;
    let end = 8.0 * radius;
    let r: Vec<f64> = fine_within([radius - 4.0, radius + 6.0], [0.0, end], H, 8.0);
    let z = fine_within([-3.0, 3.0], [-end, end], H, 8.0);
    let held = |[i, j]: [usize; 2], [_, rows]: [usize; 2]| [i == 0, j == 0 || j == rows - 1];
    let mut body =
        Cracked::of_form(Form::Axisymmetric, [r, z], held, |[r, z]| from_crack(r, z, radius), 2);
    let places: Vec<[f64; 2]> = body.places().collect();
    let rise = vec![0.0; places.len()];
    let at_unit = penny_in_cylinder(radius + AHEAD, end, 1.0);
    let wanted = PLANE_YOUNG.sqrt() / at_unit;
    let first = body.dissipated();
    let mut last = 0.0;
    let mut starts = None;
    for step in 0..40 {
        let strain = wanted / YOUNG * (0.95 + 0.0025 * f64::from(step));
        for (n, [_, z]) in places.iter().enumerate().filter(|(_, [_, z])| z.abs() == end) {
            body.state.displacement[2 * n + 1] = strain * z;
        }
        body.solve(&rise);
        let forces = body.problem.forces(&body.state);
        let on_top = places.iter().enumerate().filter(|(_, [_, z])| *z == end);
        let stress = on_top.map(|(n, _)| forces[2 * n + 1]).sum::<f64>()
            / (std::f64::consts::PI * end * end);
        let grown = (body.dissipated() - first) / (std::f64::consts::TAU * radius);
        if grown > 0.5 {
            starts = Some(last / wanted);
            break;
        }
        last = stress;
    }
    let starts = starts.expect("it starts");
    println!("penny: it starts at {starts:.4} of its stress");
    assert!((starts - 1.0).abs() < 0.02, "{starts}");
}

/// Cracks at equal distances in a half plane that cools from its surface: their depth is where `G = pσ²/(2E')`.
#[test]
fn dense_array_goes_as_deep_as_its_energy() {
    let (spacing, start, deepest) = (50.0, 160.0, 185.0);
    let critical = 0.06 * spacing;
    let stress = (PLANE_YOUNG / critical).sqrt();
    let drop = stress * (1.0 - POISSON) / (YOUNG * EXPANSION);
    // Ratio of depth to that of heat: erfc(a/(2δ)) = √(2 l_c/p).
    let wanted = (0..4000)
        .map(|k| 1e-3 * f64::from(k))
        .find(|a| libm::erfc(0.5 * a) < (2.0 * critical / spacing).sqrt())
        .unwrap();
    let end = 6.0 * start;
    let x = fine_within([-3.0, 3.0], [-0.5 * spacing, 0.5 * spacing], H, 2.0);
    let z = fine_within([start - 4.0, deepest + 6.0], [0.0, end], H, 8.0);
    let held = |[i, j]: [usize; 2], [columns, rows]: [usize; 2]| {
        [i == 0 || i == columns - 1, j == rows - 1]
    };
    let mut cell = Cracked::new([x, z], held, |[x, z]| from_crack(z, x, start), 2);
    let depths: Vec<f64> = cell.places().map(|[_, z]| z).collect();
    let first = cell.dissipated();
    let mut ratios = Vec::new();
    for step in 0..30 {
        let reach = (start + AHEAD) / wanted * (0.9 + 0.02 * f64::from(step));
        if wanted * reach > deepest {
            break;
        }
        let rise: Vec<f64> = depths.iter().map(|z| -drop * libm::erfc(z / (2.0 * reach))).collect();
        cell.solve(&rise);
        let grown = cell.dissipated() - first;
        let depth = start + AHEAD + grown;
        if grown > 1.0 {
            ratios.push(depth / (wanted * reach));
        }
    }
    println!("dense array: cracks are {ratios:.3?} times as deep");
    assert!(ratios.len() > 3);
    assert!(ratios.iter().all(|ratio| (ratio - 1.0).abs() < 0.05), "{ratios:?}");
}
