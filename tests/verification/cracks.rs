//! Cracks as gradient damage beside linear fracture mechanics.

use closed_form::edge_crack::shocked;
use closed_form::gradient_damage::{around_tip, beside_at1};
use impinge::laws::fracture::{Dissipation, GradientDamage, Principal, Split};
use impinge::method::damage::{DamageProblem, DamageState, Elements, Form, Section};
use impinge::runtime::allowance::Allowance;

const YOUNG: f64 = 100.0;
const POISSON: f64 = 0.2;
const EXPANSION: f64 = 1e-3;
/// Energy of cracks and length of damage are the units.
const H: f64 = 1.0 / 3.0;

/// Distance of the tip of the equivalent crack of linear fracture mechanics from that of broken elements, which
/// [`moving_crack_dissipates_its_energy_per_length`] measures.
const AHEAD: f64 = 1.33;

/// Damage problem of a plane section in AT1, with a crack from one end of an axis to its tip.
struct Cracked {
    problem: DamageProblem,
    state: DamageState,
    axes: [Vec<f64>; 2],
}

impl Cracked {
    /// `distance` is that of a place from the crack, whose row of elements is broken.
    fn new(
        axes: [Vec<f64>; 2],
        held: impl Fn([usize; 2], [usize; 2]) -> [bool; 2],
        distance: impl Fn([f64; 2]) -> f64,
    ) -> Self {
        let law = GradientDamage {
            elastic: Principal { young: YOUNG, poisson: POISSON, is_plane_stress: false },
            expansion: EXPANSION,
            split: Split::NoTension,
            dissipation: Dissipation::At1,
            energy: 1.0,
            length: 1.0,
            scatter: 0.0,
            seed: 0,
        };
        let section = Section { axes: axes.clone(), form: Form::PlaneStrain { thickness: 1.0 } };
        let counts = section.grid().counts;
        let nodes: Vec<[usize; 2]> =
            (0..counts[0] * counts[1]).map(|n| [n % counts[0], n / counts[0]]).collect();
        let held = nodes.iter().flat_map(|&node| held(node, counts)).collect();
        let problem = DamageProblem::new(Elements::new(section, law), held, 2);
        let mut state = problem.initial_state();
        for (damage, [i, j]) in state.damage.iter_mut().zip(&nodes) {
            *damage = beside_at1(distance([axes[0][*i], axes[1][*j]]).max(0.0));
        }
        Self { problem, state, axes }
    }

    fn places(&self) -> impl Iterator<Item = [f64; 2]> + use<'_> {
        let [x, z] = &self.axes;
        z.iter().flat_map(move |&z| x.iter().map(move |&x| [x, z]))
    }

    /// Solves at nodal temperatures and returns the dissipated energy.
    fn solve(&mut self, rise: &[f64]) -> f64 {
        let none = vec![0.0; 2 * rise.len()];
        self.problem.advance(&mut self.state, (rise, &none), &Allowance::default()).unwrap();
        self.problem.energies(&self.state).dissipated
    }
}

/// Places at equal distances.
fn even(from: f64, to: f64, count: usize) -> Vec<f64> {
    (0..=count).map(|i| from + (to - from) * i as f64 / count as f64).collect()
}

/// Places with distances H from 0 to `fine`, and ever larger ones up to `end`.
fn growing(fine: f64, end: f64) -> Vec<f64> {
    let mut places = even(0.0, fine, (fine / H).round() as usize);
    let mut step = 1.15 * H;
    while places[places.len() - 1] + 1.5 * step < end {
        places.push(places[places.len() - 1] + step);
        step *= 1.15;
    }
    places.push(end);
    places
}

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
    let mut strip = Cracked::new(axes, on_edge, distance);
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
        dissipated.push(strip.solve(&rise));
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
    // The equivalent crack of linear fracture mechanics is longer than the row of broken elements.
    let depth = 20.0;
    let effective = depth + AHEAD;
    let end = 12.0 * depth;
    let aside = growing(3.0, end);
    // An element across the plane of the crack.
    let across = [0.5 * H, -0.5 * H];
    let left = aside.iter().rev().map(|x| -x + across[1]);
    let x: Vec<f64> = left.chain(aside.iter().map(|x| x + across[0])).collect();
    let axes = [x, growing(depth + 8.0, end)];
    let held = |[i, j]: [usize; 2], [columns, rows]: [usize; 2]| {
        [i == 0 || i == columns - 1, j == rows - 1]
    };
    let distance = |[x, z]: [f64; 2]| match z < depth {
        true => x.abs() - 0.5 * H,
        false => x.hypot(z - depth),
    };
    let mut plane = Cracked::new(axes, held, distance);
    let reach = 0.5 * effective;
    let toughness = (YOUNG / (1.0 - POISSON * POISSON)).sqrt();
    let stress = toughness / (reach.sqrt() * shocked(2.0));
    let drop = stress * (1.0 - POISSON) / (YOUNG * EXPANSION);
    let depths: Vec<f64> = plane.places().map(|[_, z]| z).collect();
    let mut first = None;
    let starts = (0..20).map(|step| 0.9 + 0.01 * f64::from(step)).find(|part| {
        let cold = |z: &f64| -drop * libm::erfc(z / (2.0 * part * reach));
        let rise: Vec<f64> = depths.iter().map(cold).collect();
        let dissipated = plane.solve(&rise);
        dissipated - *first.get_or_insert(dissipated) > 0.2
    });
    println!("edge crack: it starts at {starts:?} of the depth of heat");
    let starts = starts.expect("it starts");
    let energies = plane.problem.energies(&plane.state);
    let gained = energies.elastic + energies.dissipated - first.unwrap();
    let balance = gained / plane.state.work;
    println!("edge crack: {balance:.5} of the work is elastic energy and that of cracks");
    assert!((balance - 1.0).abs() < 2e-3, "{balance}");
    // Time goes with the square of that depth.
    assert!((starts * starts - 1.0).abs() < 0.05, "{starts}");
}
