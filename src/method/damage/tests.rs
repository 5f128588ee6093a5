use super::damaged::Damaged;
use super::domain::{Kinematics, Point};
use super::elements::Nodal;
use super::*;
use crate::laws::fracture::{Dissipation, GradientDamage, Principal, Split};
use crate::math::grid_matrix::{GridMatrix, Padded};
use crate::runtime::allowance::Allowance;
use crate::runtime::parallel::Team;

const LENGTH: f64 = 1.0;
const DAMAGE_LENGTH: f64 = 0.05;
const ENERGY: f64 = 2.0;

fn law(dissipation: Dissipation, split: Split) -> GradientDamage {
    GradientDamage {
        elastic: Principal { young: 100.0, poisson: 0.2, is_plane_stress: true },
        expansion: 1e-3,
        split,
        pressed: 3.0,
        dissipation,
        energy: ENERGY,
        length: DAMAGE_LENGTH,
        scatter: 0.0,
        seed: 0,
    }
}

/// A bar along x in plane stress whose ends are drawn apart, weak in the middle by a part of a crack's damage.
struct Bar {
    problem: SectionProblem,
    state: DamageState,
    columns: usize,
}

impl Bar {
    fn new(law: GradientDamage, elements: usize, weakness: f64) -> Self {
        let even = |extent: f64, count: usize| -> Vec<f64> {
            (0..=count).map(|i| extent * i as f64 / count as f64).collect()
        };
        // One row of squares.
        let height = LENGTH / elements as f64;
        let axes = [even(LENGTH, elements), vec![0.0, height]];
        let section =
            Section { axes, form: Form::PlaneStress { thickness: 1.0 }, mirrored: [false; 2] };
        let columns = elements + 1;
        let mut held = vec![false; 2 * 2 * columns];
        for row in 0..2 {
            held[2 * row * columns] = true;
            held[2 * (row * columns + elements)] = true;
        }
        held[1] = true;
        let problem = DamageProblem::new(Elements::new(section, law), held, 1);
        let mut state = problem.initial_state();
        for (node, damage) in state.damage.iter_mut().enumerate() {
            let place = LENGTH * (node % columns) as f64 / elements as f64 - 0.5 * LENGTH;
            *damage = weakness * profile(place).powi(2);
        }
        Self { problem, state, columns }
    }

    fn height(&self) -> f64 {
        LENGTH / (self.columns - 1) as f64
    }

    /// Draws the ends apart and returns the stress.
    fn draw(&mut self, strain: f64) -> f64 {
        let last = self.columns - 1;
        for row in 0..2 {
            self.state.displacement[2 * (row * self.columns + last)] = strain * LENGTH;
        }
        let none = (vec![0.0; 2 * self.columns], vec![0.0; 4 * self.columns]);
        let loads = (&none.0[..], &none.1[..]);
        self.problem.advance(&mut self.state, loads, &Allowance::default()).unwrap();
        let forces = self.problem.forces(&self.state);
        let at_end = (0..2).map(|row| forces[2 * (row * self.columns + last)]);
        at_end.sum::<f64>() / self.height()
    }
}

/// `1 − |x|/(2ℓ)`, whose square is the damage beside a crack of AT1.
fn profile(place: f64) -> f64 {
    (1.0 - place.abs() / (2.0 * DAMAGE_LENGTH)).max(0.0)
}

#[test]
fn bars_break_at_the_strength_of_their_model() {
    for (dissipation, weakness) in [(Dissipation::At1, 5e-3), (Dissipation::At2, 0.0)] {
        for split in [Split::None, Split::NoTension] {
            let law = law(dissipation, split);
            let strength = law.strength();
            let strain = strength / law.elastic.young;
            let mut bar = Bar::new(law, 60, weakness);
            // AT1 is elastic until then; AT2 is damaged from the first load on.
            let parts: Vec<f64> = match dissipation {
                Dissipation::At1 => (0..40).map(|i| 0.9 + 0.005 * f64::from(i)).collect(),
                Dissipation::At2 => (1..=40).map(|i| 0.055 * f64::from(i)).collect(),
            };
            let peak = parts.iter().map(|part| bar.draw(part * strain)).fold(0.0, f64::max);
            let ratio = peak / strength;
            assert!((ratio - 1.0).abs() < 0.01, "{dissipation:?} {split:?} {ratio}");
        }
    }
}

#[test]
fn broken_bar_has_dissipated_the_energy_of_a_crack() {
    // Cracks in the middle of an element, of a mesh that resolves them well and of the coarsest that is accepted.
    for elements in [161, 61] {
        let law = law(Dissipation::At1, Split::NoTension);
        let strain = law.strength() / law.elastic.young;
        let mut bar = Bar::new(law, elements, 0.05);
        let force = bar.draw(1.5 * strain);
        assert!(force.abs() < 1e-3 * law.strength(), "{force}");
        let energies = bar.problem.energies(&bar.state);
        let part = energies.dissipated / (ENERGY * bar.height());
        assert!((part - 1.0).abs() < 0.003, "{elements} {part}");
        // The profile beside the broken row of elements, whose length is corrected by `1 − 3h/(8ℓ)`.
        let h = LENGTH / elements as f64;
        let stretched = 1.0 - 3.0 * h / (8.0 * DAMAGE_LENGTH);
        for node in 0..bar.columns {
            let place = (h * node as f64 - 0.5 * LENGTH).abs() - 0.5 * h;
            let wanted = profile(place.max(0.0) / stretched).powi(2);
            let found = bar.state.damage[bar.columns + node];
            assert!((found - wanted).abs() < 0.01, "{place} {found} {wanted}");
        }
    }
}

/// A nodal field without a pattern.
fn wave(n: usize) -> f64 {
    (1.7 * n as f64 + 0.3).sin()
}

/// Asserts that the stiffness of damaged elements is the derivative of their forces.
fn derivative<const D: usize, const C: usize, const V: usize>(
    domain: &Domain<D>,
    law: GradientDamage,
) where
    Point<D, C>: Kinematics<D, C, V>,
{
    const H: f64 = 1e-7;
    let elements = Elements::<D, C, V>::new(domain.clone(), law);
    let nodes = elements.grid.nodes();
    let displacement: Vec<f64> = (0..D * nodes).map(|n| 1e-3 * wave(n)).collect();
    let damage: Vec<f64> = (0..nodes).map(|n| 0.3 + 0.2 * wave(n)).collect();
    let rise: Vec<f64> = (0..nodes).map(|n| 2.0 * wave(3 * n)).collect();
    let change: Vec<f64> = (0..D * nodes).map(|n| wave(7 * n)).collect();
    let team = Team::new(1);
    let at = |by: f64| {
        let moved: Vec<f64> = displacement.iter().zip(&change).map(|(u, du)| u + by * du).collect();
        let nodal = Nodal { displacement: &moved, damage: &damage, rise: &rise };
        elements.forces(&nodal, &team)
    };
    let nodal = Nodal { displacement: &displacement, damage: &damage, rise: &rise };
    let mut stiffness = elements.intact_stiffness(&team);
    Damaged::of(&elements, &damage).correct_stiffness(&elements, &nodal, &mut stiffness, &team);
    let mut padded = Padded::zeros(elements.grid);
    padded.inner_mut().copy_from_slice(&change);
    let mut found = vec![0.0; D * nodes];
    stiffness.product(&padded, &vec![false; D * nodes], &mut found, &team);
    let scale = found.iter().map(|own| own.abs()).fold(0.0, f64::max);
    for ((high, low), found) in at(H).iter().zip(&at(-H)).zip(&found) {
        let slope = (high - low) / (2.0 * H);
        let form = domain.form;
        assert!((slope - found).abs() < 1e-5 * scale, "{form:?} {law:?} {slope} {found}");
    }
}

#[test]
fn stiffness_is_the_derivative_of_forces() {
    let [x, y, z] = [vec![0.1, 0.3, 0.6], vec![0.0, 0.25, 0.35], vec![-0.2, 0.0, 0.1]];
    for split in
        [Split::None, Split::NoTension, Split::Spectral, Split::Volumetric, Split::StarConvex]
    {
        let mut law = law(Dissipation::At1, split);
        law.elastic.is_plane_stress = false;
        for form in [Form::Axisymmetric, Form::PlaneStrain { thickness: 0.5 }] {
            derivative::<2, 4, 4>(
                &Domain { axes: [x.clone(), z.clone()], form, mirrored: [false; 2] },
                law,
            );
        }
        let axes = [x.clone(), y.clone(), z.clone()];
        derivative::<3, 8, 6>(&Domain { axes, form: Form::Space, mirrored: [false; 3] }, law);
    }
}

/// A strip in plane strain, and the same in space, one element thick between planes that do not move along y, with a
/// notch, under temperatures that vary.
#[test]
fn cracks_in_space_are_those_of_plane_strain_between_fixed_planes() {
    let h = 0.25 * DAMAGE_LENGTH;
    let even = |count: usize| -> Vec<f64> { (0..=count).map(|i| h * i as f64).collect() };
    let (columns, layers) = (14, 8);
    let mut law = law(Dissipation::At1, Split::NoTension);
    law.elastic.is_plane_stress = false;
    let section = Domain {
        axes: [even(columns), even(layers)],
        form: Form::PlaneStrain { thickness: h },
        mirrored: [false; 2],
    };
    let space = Domain {
        axes: [even(columns), even(1), even(layers)],
        form: Form::Space,
        mirrored: [false; 3],
    };
    // Both ends are held along x, the lowest layer along z.
    let [nx, nz] = section.grid().counts;
    let is_end = |i: usize| i == 0 || i == columns;
    let in_section = (0..nx * nz).flat_map(|n| [is_end(n % nx), n / nx == 0]).collect();
    let in_space =
        (0..nx * 2 * nz).flat_map(|n| [is_end(n % nx), true, n / (2 * nx) == 0]).collect();
    let plane = DamageProblem::<2, 4, 4>::new(Elements::new(section, law), in_section, 1);
    let bricks = DamageProblem::<3, 8, 6>::new(Elements::new(space, law), in_space, 1);
    let (mut flat, mut solid) = (plane.initial_state(), bricks.initial_state());
    for k in layers - 2..=layers {
        for i in [columns / 2, columns / 2 + 1] {
            flat.damage[i + nx * k] = 1.0;
            (0..2).for_each(|j| solid.damage[i + nx * (j + 2 * k)] = 1.0);
        }
    }
    let cold = -1.2 * law.strength() / (law.elastic.young * law.expansion);
    for step in 1..=3 {
        let of_node = |n: usize| cold * step as f64 / 3.0 * (0.4 + 0.05 * (n / nx) as f64);
        let rise: Vec<f64> = (0..nx * nz).map(of_node).collect();
        let in_space: Vec<f64> =
            (0..nz).flat_map(|k| [&rise[nx * k..][..nx], &rise[nx * k..][..nx]].concat()).collect();
        let none = vec![0.0; 2 * rise.len()];
        plane.advance(&mut flat, (&rise, &none), &Allowance::default()).unwrap();
        let none = vec![0.0; 3 * in_space.len()];
        bricks.advance(&mut solid, (&in_space, &none), &Allowance::default()).unwrap();
    }
    let [one, other] = [plane.energies(&flat), bricks.energies(&solid)];
    assert!(one.dissipated > 2.0 * ENERGY * h * h, "{one:?}");
    for (one, other) in [(one.dissipated, other.dissipated), (one.elastic, other.elastic)] {
        assert!((one / other - 1.0).abs() < 1e-3, "{one} {other}");
    }
    for (n, damage) in flat.damage.iter().enumerate() {
        for j in 0..2 {
            let own = solid.damage[n % nx + nx * (j + 2 * (n / nx))];
            assert!((own - damage).abs() < 5e-3, "{n} {own} {damage}");
        }
    }
    let [mine, theirs] = [plane.stress(&flat), bricks.stress(&solid)];
    let scale = mine.iter().flatten().fold(0.0_f64, |most, own| most.max(own.abs()));
    for (n, own) in mine.iter().enumerate() {
        let other = theirs[n % nx + nx * 2 * (n / nx)];
        for (own, other) in own.iter().zip(other) {
            assert!((own - other).abs() < 5e-3 * scale, "{n} {own} {other}");
        }
    }
}

#[test]
fn bar_in_space_breaks_at_its_strength_with_the_energy_of_its_section() {
    let law = GradientDamage {
        elastic: Principal {
            is_plane_stress: false,
            ..law(Dissipation::At1, Split::NoTension).elastic
        },
        ..law(Dissipation::At1, Split::NoTension)
    };
    let count = 61;
    let h = LENGTH / count as f64;
    let along = (0..=count).map(|i| h * i as f64).collect();
    let domain = Domain {
        axes: [along, vec![0.0, h], vec![0.0, h]],
        form: Form::Space,
        mirrored: [false; 3],
    };
    let nodes = domain.grid().nodes();
    let mut held = vec![false; 3 * nodes];
    let is_end = |node: usize| [0, count].contains(&(node % (count + 1)));
    (0..nodes).filter(|&node| is_end(node)).for_each(|node| held[3 * node] = true);
    // The planes y = 0 and z = 0 do not move along their normals.
    for node in 0..nodes {
        let row = node / (count + 1);
        held[3 * node + 1] = row % 2 == 0;
        held[3 * node + 2] = row / 2 == 0;
    }
    let problem = DamageProblem::<3, 8, 6>::new(Elements::new(domain, law), held, 2);
    let mut state = problem.initial_state();
    for (node, damage) in state.damage.iter_mut().enumerate() {
        let place = h * (node % (count + 1)) as f64 - 0.5 * LENGTH;
        *damage = 5e-3 * profile(place).powi(2);
    }
    let strain = law.strength() / law.elastic.young;
    let none = (vec![0.0; nodes], vec![0.0; 3 * nodes]);
    let mut peak = 0.0_f64;
    for part in (0..=16).map(|step| 0.97 + 0.0025 * f64::from(step)).chain([1.5]) {
        for node in (0..nodes).filter(|node| node % (count + 1) == count) {
            state.displacement[3 * node] = part * strain * LENGTH;
        }
        problem.advance(&mut state, (&none.0, &none.1), &Allowance::default()).unwrap();
        let forces = problem.forces(&state);
        let end = (0..nodes).filter(|node| node % (count + 1) == count);
        peak = peak.max(end.map(|node| forces[3 * node]).sum::<f64>() / (h * h));
    }
    assert!((peak / law.strength() - 1.0).abs() < 0.01, "{}", peak / law.strength());
    let part = problem.energies(&state).dissipated / (ENERGY * h * h);
    assert!((part - 1.0).abs() < 0.01, "{part}");
}

/// Nodes that may be damaged have the damage of a minimum over all, from any margin around them on, with wide damage
/// and scattered elements.
#[test]
fn damage_is_that_of_all_nodes() {
    let law = GradientDamage { scatter: 0.2, ..law(Dissipation::At1, Split::NoTension) };
    let even = |count: usize| (0..=count).map(|i| 0.01 * i as f64).collect::<Vec<_>>();
    let domain = Domain {
        axes: [even(60), even(40)],
        form: Form::PlaneStress { thickness: 1.0 },
        mirrored: [false; 2],
    };
    let nodes = domain.grid().nodes();
    let problem = SectionProblem::new(Elements::new(domain, law), vec![false; 2 * nodes], 1);
    let team = Team::new(1);
    // Above the threshold in a spot, and next to nothing elsewhere.
    let threshold = ENERGY / (8.0 / 3.0 * DAMAGE_LENGTH);
    let of_element = |n: usize| {
        let [x, y] = [n % 60, n / 60].map(|i| 0.01 * (i as f64 + 0.5));
        let square = (x - 0.2_f64).powi(2) + (y - 0.15_f64).powi(2);
        [threshold * (0.01 + 40.0 * (-square / 0.03_f64.powi(2)).exp()); 4]
    };
    let released: Vec<[f64; 4]> = (0..60 * 40).map(of_element).collect();
    let low = vec![0.0; nodes];
    let softened = |margin: usize| {
        let grid = problem.elements.grid;
        let (mut damage, mut matrix) = (Padded::zeros(grid), GridMatrix::zeros(grid));
        let given = (&released, margin);
        let gradient = problem.soften(given, &low, &mut damage, &mut matrix, &team);
        (damage.inner().to_vec(), gradient)
    };
    let (all, first) = softened(100);
    let damaged = all.iter().filter(|d| **d > 0.0).count();
    assert!(all.iter().any(|d| *d > 0.9) && damaged > 100 && damaged < nodes / 2, "{damaged}");
    for margin in [1, 3, problem.elements.reach_of_damage()] {
        let (some, gradient) = softened(margin);
        assert!(some == all, "{margin}");
        let moved = (0..nodes).filter(|&n| all[n] > 0.0);
        assert!(moved.into_iter().all(|n| gradient[n] == first[n]), "{margin}");
    }
}
