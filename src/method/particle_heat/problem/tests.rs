use super::*;
use crate::closed_form::{Conductor, HeatedSlab, SuddenSurface};
use crate::kernel::Kernel;
use crate::method::particle_heat::Operator;

const WATER: Conductor = Conductor { conductivity: 0.6, heat_capacity: 4e6 };

/// Nodes from 0 to `length`, each distance `growth` times the one before, with trapezoidal shares.
fn axis(length: f64, intervals: usize, growth: f64) -> LatticeAxis {
    let steps: Vec<f64> = (0..intervals).map(|i| growth.powi(i as i32)).collect();
    let total: f64 = steps.iter().sum();
    let mut nodes = vec![0.0];
    let mut sum = 0.0;
    for step in steps {
        sum += step;
        nodes.push(length * sum / total);
    }
    let n = nodes.len();
    let width = |i: usize| nodes[(i + 1).min(n - 1)] - nodes[i.saturating_sub(1)];
    let measures = (0..n).map(|i| 0.5 * width(i)).collect();
    LatticeAxis { nodes, measures, ends: [End::Mirror; 2], radial: false }
}

fn point() -> LatticeAxis {
    LatticeAxis { nodes: vec![0.0], measures: vec![1.0], ends: [End::Mirror; 2], radial: false }
}

fn setup(axes: [LatticeAxis; 3], operator: Operator, faces: &[(usize, bool, Condition)]) -> Setup {
    let face = |&(axis, high, condition): &(usize, bool, Condition)| Face { axis, high, condition };
    Setup {
        axes,
        settings: Settings { operator, kernel: Kernel::WendlandC2, support: 3.0 },
        capacity: WATER.heat_capacity,
        conductivity: WATER.conductivity,
        faces: faces.iter().map(face).collect(),
        classes: vec![[false; 2]],
        copies: 1.0,
    }
}

const MIXED: [(usize, bool, Condition); 4] = [
    (0, true, Condition::Held),
    (1, false, Condition::Convective(700.0)),
    (2, true, Condition::Flux),
    (2, false, Condition::Held),
];

/// Runs from zero and returns problem and state.
fn run(setup: Setup, values: &[f64], steps: &[f64]) -> (ParticleHeat, Vec<f64>) {
    let problem = ParticleHeat::new(setup, 1);
    let mut state = vec![0.0; problem.layout().len()];
    let sources = Sources { surface: &[[Vec::new(), Vec::new()]], faces: &[values.to_vec()] };
    steps.iter().for_each(|&dt| {
        problem.advance(&mut state, &[sources], dt, &Allowance::default()).unwrap()
    });
    (problem, state)
}

fn drift(problem: &ParticleHeat, state: &[f64]) -> f64 {
    let (stored, totals) = (problem.stored(state), problem.totals(state));
    (stored - totals.brought_in + totals.lost) / stored.abs().max(totals.brought_in.abs())
}

#[test]
fn heat_balances_at_equal_distances_under_every_condition() {
    for operator in [Operator::Plain, Operator::Corrected] {
        let axes = [axis(1e-3, 6, 1.0), axis(2e-3, 7, 1.0), axis(1e-3, 5, 1.0)];
        let (problem, state) =
            run(setup(axes, operator, &MIXED), &[3.0, 20.0, 4e4, -5.0], &[0.01, 2.0, 0.3]);
        let drift = drift(&problem, &state);
        assert!(drift.abs() < 1e-12, "{operator:?}: {drift}");
    }
}

#[test]
fn heat_drift_of_the_corrected_operator_decreases_under_refinement() {
    for (condition, value) in [(Condition::Flux, 1e4), (Condition::Held, 1.0)] {
        let drifts = [20, 40, 80].map(|n| {
            // The same grading, sampled ever finer: the last distance is nine times the first.
            let axes = [point(), point(), axis(1e-3, n, 9f64.powf(1.0 / n as f64))];
            let faces = [(2, false, condition)];
            let (problem, state) = run(setup(axes, Operator::Corrected, &faces), &[value], &[0.7]);
            drift(&problem, &state).abs()
        });
        assert!(drifts[0] < 0.01, "{condition:?}: {drifts:?}");
        let order = (drifts[0] / drifts[2]).log2() / 2.0;
        assert!(order > 1.5, "{condition:?}: {drifts:?}");
    }
}

#[test]
fn linear_profile_between_held_ends_is_steady() {
    for (operator, growth) in [(Operator::Corrected, 1.4), (Operator::Plain, 1.0)] {
        let axes = [axis(1e-3, 3, growth), axis(1e-3, 4, growth), axis(1e-3, 8, growth)];
        let depths = axes[2].nodes.clone();
        let faces = [(2, false, Condition::Held), (2, true, Condition::Held)];
        let (problem, state) = run(setup(axes, operator, &faces), &[0.0, 7.0], &[1e3]);
        let values = &problem.temperatures(&state, &[vec![0.0, 7.0]])[0];
        for (i, value) in values.iter().enumerate() {
            assert!((value - 7e3 * depths[i / 20]).abs() < 1e-9, "{operator:?}: {value}");
        }
    }
}

/// Largest error over the slab [K], of a flux into one end and the other insulated.
fn slab_error(intervals: usize, operator: Operator) -> f64 {
    let slab = HeatedSlab { body: WATER, flux: 1e4, thickness: 1e-3 };
    let side = 2e-3 / intervals as f64;
    let axes = [axis(side, 2, 1.0), axis(side, 2, 1.0), axis(1e-3, intervals, 1.0)];
    let depths = axes[2].nodes.clone();
    let (problem, state) =
        run(setup(axes, operator, &[(2, false, Condition::Flux)]), &[1e4], &[0.7]);
    let values = &problem.temperatures(&state, &[vec![1e4]])[0];
    let errors = values
        .iter()
        .enumerate()
        .map(|(i, value)| (value - slab.rise_with_insulated_back(depths[i / 9], 0.7)).abs());
    errors.fold(0.0, f64::max)
}

#[test]
fn slab_under_flux_converges_at_second_order_only_with_the_corrected_operator() {
    let corrected = [40, 80, 160].map(|n| slab_error(n, Operator::Corrected));
    let plain = [40, 80, 160].map(|n| slab_error(n, Operator::Plain));
    for pair in corrected.windows(2) {
        let order = (pair[0] / pair[1]).log2();
        assert!(order > 1.8, "{corrected:?}");
    }
    // The kernel sums of a lattice miss a fixed fraction of the second moment.
    assert!(plain[2] > 4.0 * corrected[2], "{plain:?}");
    assert!((plain[1] / plain[2]).log2() < 0.5, "{plain:?}");
}

/// A rod of unit length and diffusivity, its left end suddenly at one: Park (2019) Fig. 2.7.
#[test]
fn sudden_end_temperature_converges_only_with_the_corrected_operator() {
    let exact =
        SuddenSurface { body: Conductor { conductivity: 1.0, heat_capacity: 1.0 }, step: 1.0 };
    let error = |intervals: usize, operator| {
        let axes = [point(), point(), axis(1.0, intervals, 1.0)];
        let nodes = axes[2].nodes.clone();
        let faces = [(2, false, Condition::Held), (2, true, Condition::Held)];
        let mut setup = setup(axes, operator, &faces);
        (setup.capacity, setup.conductivity) = (1.0, 1.0);
        let (problem, state) = run(setup, &[1.0, 0.0], &[0.03]);
        let values = &problem.temperatures(&state, &[vec![1.0, 0.0]])[0];
        let square =
            |(x, v): (&f64, &f64)| (v - exact.rise(*x, 0.03) + exact.rise(2.0 - x, 0.03)).powi(2);
        (nodes.iter().zip(values).map(square).sum::<f64>() / nodes.len() as f64).sqrt()
    };
    let corrected = [79, 159, 319].map(|n| error(n, Operator::Corrected));
    let plain = [79, 159, 319].map(|n| error(n, Operator::Plain));
    assert!(corrected.windows(2).all(|e| (e[0] / e[1]).log2() > 1.9), "{corrected:?}");
    assert!((plain[1] / plain[2]).log2() < 0.5, "{plain:?}");
}

#[test]
fn odd_parts_see_an_odd_lattice() {
    // Right half of a rod whose ends are held at ±1: linear once steady.
    let mut setup = setup(
        [axis(1e-3, 8, 1.2), point(), axis(1e-3, 3, 1.0)],
        Operator::Corrected,
        &[(0, true, Condition::Held)],
    );
    setup.classes = vec![[false, false], [true, false]];
    let nodes = setup.axes[0].nodes.clone();
    let problem = ParticleHeat::new(setup, 1);
    let mut state = vec![0.0; problem.layout().len()];
    let nothing = [[Vec::new(), Vec::new()], [Vec::new(), Vec::new()]];
    let faces = [vec![0.0], vec![1.0]];
    problem
        .advance(
            &mut state,
            &[Sources { surface: &nothing, faces: &faces }],
            1e3,
            &Allowance::default(),
        )
        .unwrap();
    let parts = problem.temperatures(&state, &faces);
    assert!(parts[0].is_empty());
    for (i, value) in parts[1].iter().enumerate() {
        assert!((value - 1e3 * nodes[i % 9]).abs() < 1e-9, "{value}");
    }
    assert_eq!(problem.totals(&state), HeatTotals::default());
}

#[test]
fn steps_of_any_length_give_the_same() {
    let axes = || [axis(1e-3, 5, 1.2), axis(2e-3, 4, 1.0), axis(1e-3, 6, 0.8)];
    let values = [3.0, 20.0, 4e4, -5.0];
    let (_, once) = run(setup(axes(), Operator::Corrected, &MIXED), &values, &[1.0]);
    let often = [1e-6, 0.3, 0.2, 0.4, 0.1 - 1e-6];
    let (_, often) = run(setup(axes(), Operator::Corrected, &MIXED), &values, &often);
    let scale = once.iter().fold(0.0, |high: f64, v| high.max(v.abs()));
    for (a, b) in once.iter().zip(&often) {
        assert!((a - b).abs() < 1e-10 * scale, "{a} {b}");
    }
}

#[test]
fn nearest_neighbour_support_falls_back_everywhere() {
    let axes = [axis(1e-3, 3, 1.0), axis(1e-3, 3, 1.0), axis(1e-3, 3, 1.0)];
    let mut narrow = setup(axes, Operator::Corrected, &[(2, true, Condition::Held)]);
    assert_eq!(ParticleHeat::new(narrow.clone(), 1).fallback(), 0);
    narrow.settings.support = 1.3;
    // Held particles need no operator.
    assert_eq!(ParticleHeat::new(narrow, 1).fallback(), 48);
}

#[test]
fn a_radius_is_a_round_body() {
    // A disc heated through its rim: the mean rises by the heat over the capacity. In the settled profile the rim
    // exceeds the axis by q R/(2k).
    let error = |intervals: usize| {
        let mut radius = axis(1e-3, intervals, 1.0);
        let share = |i: usize| -> f64 {
            // ∫ N 2πr dr of linear shape functions.
            let h = 1e-3 / intervals as f64;
            let r = radius.nodes[i];
            let inner = if i > 0 { h * (r / 2.0 - h / 6.0) } else { 0.0 };
            let outer = if i < intervals { h * (r / 2.0 + h / 6.0) } else { 0.0 };
            std::f64::consts::TAU * (inner + outer)
        };
        radius.measures = (0..=intervals).map(share).collect();
        radius.radial = true;
        let axes = [radius, point(), axis(1e-3, 4, 1.0)];
        let setup = setup(axes, Operator::Corrected, &[(0, true, Condition::Flux)]);
        let (problem, state) = run(setup, &[1e4], &[40.0]);
        let lead = state[intervals] - state[0];
        let wanted = 1e4 * 1e-3 / (2.0 * WATER.conductivity);
        ((lead / wanted - 1.0).abs(), drift(&problem, &state).abs())
    };
    let errors = [6, 12, 24].map(error);
    for (lead, drift) in errors {
        // The steady profile is quadratic, for which the operator is exact.
        assert!(lead < 1e-10 && drift < 1e-3, "{errors:?}");
    }
    assert!(errors.windows(2).all(|pair| pair[1].1 < 0.3 * pair[0].1), "{errors:?}");
}

#[test]
fn stability_on_lattices_of_any_grading() {
    // Any value at any particle; in an insulated body all differences decay.
    for (growth, fine) in [(1.0, 0.05), (1.3, 0.1), (1.7, 1.0)] {
        for insulated in [true, false] {
            let axes = [axis(1e-3, 5, growth), axis(1e-3, 3, 1.0), axis(fine * 1e-3, 6, growth)];
            let held = [(0, true, Condition::Held), (2, false, Condition::Held)];
            let faces = if insulated { &[] } else { &held[..] };
            let mut setup = setup(axes, Operator::Corrected, faces);
            (setup.capacity, setup.conductivity) = (1e6, 1.0);
            let problem = ParticleHeat::new(setup, 1);
            let mut state: Vec<f64> =
                (0..problem.layout().len()).map(|i| (1.7 * (i * i) as f64).sin()).collect();
            let values = [vec![0.0; faces.len()]];
            let sources = Sources { surface: &[[Vec::new(), Vec::new()]], faces: &values };
            problem.advance(&mut state, &[sources], 10.0, &Allowance::default()).unwrap();
            let values = &state[..state.len() - 2];
            let [least, most] = values
                .iter()
                .fold([f64::INFINITY, f64::NEG_INFINITY], |[a, b], &v| [a.min(v), b.max(v)]);
            assert!(most - least < 1e-9, "growth {growth}, {fine}: {least} to {most}");
            assert!(insulated || most.abs() < 1e-9, "growth {growth}, {fine}: {most}");
        }
    }
}

#[test]
fn convective_cooling_converges_at_second_order_on_graded_lattices() {
    // The slowest mode of a slab, cos(b x/L) with b tan b = hL/k = 2, decays as exp(−b² at/L²).
    let mut b: f64 = 1.0;
    for _ in 0..20 {
        b -= (b * b.tan() - 2.0) / (b.tan() + b / b.cos().powi(2));
    }
    let coefficient = 2.0 * WATER.conductivity / 1e-3;
    let time = 1.0;
    let decay = (-b * b * WATER.conductivity / WATER.heat_capacity * time / 1e-6).exp();
    let errors = [10, 20, 40].map(|n| {
        let axes = [point(), axis(1e-4, 3, 1.0), axis(1e-3, n, 3f64.powf(-1.0 / n as f64))];
        let nodes = axes[2].nodes.clone();
        let faces = [(2, true, Condition::Convective(coefficient))];
        let problem = ParticleHeat::new(setup(axes, Operator::Corrected, &faces), 1);
        let mode = |i: usize| (b * nodes[i / 4] / 1e-3).cos();
        let mut state: Vec<f64> = (0..4 * nodes.len()).map(mode).chain([0.0; 2]).collect();
        let (stored, still) = (problem.stored(&state), [[Vec::new(), Vec::new()]]);
        problem
            .advance(
                &mut state,
                &[Sources { surface: &still, faces: &[vec![0.0]] }],
                time,
                &Allowance::default(),
            )
            .unwrap();
        let lost = problem.totals(&state).lost / (stored * (1.0 - decay)) - 1.0;
        let worst = (0..4 * nodes.len()).map(|i| (state[i] - decay * mode(i)).abs());
        [worst.fold(0.0, f64::max), lost.abs()]
    });
    // First to last: the error of the temperature changes sign in between.
    for q in 0..2 {
        assert!((errors[0][q] / errors[2][q]).log2() / 2.0 > 1.8, "{errors:?}");
    }
    assert!(errors[2].iter().all(|&error| error < 1e-4), "{errors:?}");
}
