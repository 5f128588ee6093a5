//! An edge crack in a half plane whose surface is suddenly cooled, as a problem of gradient damage. Energy of cracks
//! and length of damage are the units.

use closed_form::edge_crack::shocked;
use closed_form::gradient_damage::beside_at1;
use impinge::laws::fracture::{Dissipation, GradientDamage, Principal, Split};
use impinge::method::damage::{DamageState, Effort, Elements, Form, Section, SectionProblem};
use impinge::runtime::allowance::Allowance;

pub const YOUNG: f64 = 100.0;
pub const POISSON: f64 = 0.2;
pub const EXPANSION: f64 = 1e-3;

/// Distance of the tip of the equivalent crack of linear fracture mechanics from that of broken elements, which
/// `moving_crack_dissipates_its_energy_per_length` of `tests/verification/cracks.rs` measures.
pub const AHEAD: f64 = 1.33;

/// Depth of the crack.
const DEPTH: f64 = 20.0;

/// Damage problem of a plane section in AT1, with a crack from one end of an axis to its tip.
pub struct Cracked {
    pub problem: SectionProblem,
    pub state: DamageState,
    axes: [Vec<f64>; 2],
}

impl Cracked {
    /// A section in plane strain; `distance` is that of a place from the crack, whose row of elements is broken.
    pub fn new(
        axes: [Vec<f64>; 2],
        held: impl Fn([usize; 2], [usize; 2]) -> [bool; 2],
        distance: impl Fn([f64; 2]) -> f64,
        threads: usize,
    ) -> Self {
        Self::of_form(Form::PlaneStrain { thickness: 1.0 }, axes, held, distance, threads)
    }

    pub fn of_form(
        form: Form,
        axes: [Vec<f64>; 2],
        held: impl Fn([usize; 2], [usize; 2]) -> [bool; 2],
        distance: impl Fn([f64; 2]) -> f64,
        threads: usize,
    ) -> Self {
        let law = GradientDamage {
            elastic: Principal { young: YOUNG, poisson: POISSON, is_plane_stress: false },
            expansion: EXPANSION,
            split: Split::NoTension,
            pressed: 1.0,
            dissipation: Dissipation::At1,
            energy: 1.0,
            length: 1.0,
            scatter: 0.0,
            seed: 0,
        };
        let section = Section { axes: axes.clone(), form, mirrored: [false; 2] };
        let counts = section.grid().counts;
        let nodes: Vec<[usize; 2]> =
            (0..counts[0] * counts[1]).map(|n| [n % counts[0], n / counts[0]]).collect();
        let held = nodes.iter().flat_map(|&node| held(node, counts)).collect();
        let problem = SectionProblem::new(Elements::new(section, law), held, threads);
        let mut state = problem.initial_state();
        for (damage, [i, j]) in state.damage.iter_mut().zip(&nodes) {
            *damage = beside_at1(distance([axes[0][*i], axes[1][*j]]).max(0.0));
        }
        Self { problem, state, axes }
    }

    pub fn places(&self) -> impl Iterator<Item = [f64; 2]> + use<'_> {
        let [x, z] = &self.axes;
        z.iter().flat_map(move |&z| x.iter().map(move |&x| [x, z]))
    }

    /// Solves at nodal temperatures.
    pub fn solve(&mut self, rise: &[f64]) -> Effort {
        let none = vec![0.0; 2 * rise.len()];
        self.problem.advance(&mut self.state, (rise, &none), &Allowance::default()).unwrap()
    }

    /// Energy that damage has dissipated.
    pub fn dissipated(&self) -> f64 {
        self.problem.energies(&self.state).dissipated
    }
}

/// Places at equal distances.
pub fn even(from: f64, to: f64, count: usize) -> Vec<f64> {
    (0..=count).map(|i| from + (to - from) * i as f64 / count as f64).collect()
}

/// Places with a distance from 0 to `fine`, and ever larger ones up to `end`.
fn growing(fine: f64, end: f64, distance: f64) -> Vec<f64> {
    growing_to(f64::INFINITY, fine, end, distance)
}

/// The same with distances up to `most`.
fn growing_to(most: f64, fine: f64, end: f64, distance: f64) -> Vec<f64> {
    let mut places = even(0.0, fine, (fine / distance).round() as usize);
    let mut step = 1.15 * distance;
    while places[places.len() - 1] + 1.5 * step < end {
        places.push(places[places.len() - 1] + step);
        step = most.min(1.15 * step);
    }
    places.push(end);
    places
}

/// Places from one end to the other: a distance apart in a fine part, in whose middle is that of an element, and up to
/// `most` apart elsewhere.
pub fn fine_within(fine: [f64; 2], ends: [f64; 2], distance: f64, most: f64) -> Vec<f64> {
    let (middle, half) = (0.5 * (fine[0] + fine[1]), 0.5 * distance);
    let side = |fine: f64, end: f64| {
        let places = growing_to(most, fine - half, end - half, distance).into_iter();
        places.map(move |place| place + half).collect::<Vec<f64>>()
    };
    let below = side(middle - fine[0], middle - ends[0]).into_iter().rev();
    let above = side(fine[1] - middle, ends[1] - middle).into_iter();
    below.map(|place| middle - place).chain(above.map(|place| middle + place)).collect()
}

/// The half plane under a shock.
pub struct EdgeCrack {
    pub cracked: Cracked,
    /// Change of the surface temperature, and the depth of heat √(κt) at which K(a + AHEAD, t) = K_Ic.
    drop: f64,
    reach: f64,
    depths: Vec<f64>,
}

impl EdgeCrack {
    /// Elements of a size around the crack.
    pub fn new(size: f64, threads: usize) -> Self {
        let end = 12.0 * DEPTH;
        let aside = growing(3.0, end, size);
        // An element across the plane of the crack.
        let across = [0.5 * size, -0.5 * size];
        let left = aside.iter().rev().map(|x| -x + across[1]);
        let x: Vec<f64> = left.chain(aside.iter().map(|x| x + across[0])).collect();
        let axes = [x, growing(DEPTH + 8.0, end, size)];
        let held = |[i, j]: [usize; 2], [columns, rows]: [usize; 2]| {
            [i == 0 || i == columns - 1, j == rows - 1]
        };
        let distance = |[x, z]: [f64; 2]| match z < DEPTH {
            true => x.abs() - 0.5 * size,
            false => x.hypot(z - DEPTH),
        };
        let cracked = Cracked::new(axes, held, distance, threads);
        let reach = 0.5 * (DEPTH + AHEAD);
        let toughness = (YOUNG / (1.0 - POISSON * POISSON)).sqrt();
        let stress = toughness / (reach.sqrt() * shocked(2.0));
        let drop = stress * (1.0 - POISSON) / (YOUNG * EXPANSION);
        let depths = cracked.places().map(|[_, z]| z).collect();
        Self { cracked, drop, reach, depths }
    }

    /// Solves when heat has gone a part of the depth at which the crack starts by linear fracture mechanics.
    pub fn solve(&mut self, part: f64) -> Effort {
        let cold = |z: &f64| -self.drop * libm::erfc(z / (2.0 * part * self.reach));
        let rise: Vec<f64> = self.depths.iter().map(cold).collect();
        self.cracked.solve(&rise)
    }
}
