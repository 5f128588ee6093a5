use super::damaged::Damaged;
use super::elements::Nodal;
use super::*;
use crate::laws::fracture::{Dissipation, GradientDamage, Principal, Split};
use crate::math::nine_point::Padded;
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
        dissipation,
        energy: ENERGY,
        length: DAMAGE_LENGTH,
        scatter: 0.0,
        seed: 0,
    }
}

/// A bar along x in plane stress whose ends are drawn apart, weak in the middle by a part of a crack's damage.
struct Bar {
    problem: DamageProblem,
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
        let section = Section { axes, form: Form::PlaneStress { thickness: 1.0 } };
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
            let last = if dissipation == Dissipation::At1 { 1.1 } else { 2.2 };
            let steps = 40;
            let stress = (1..=steps).map(|i| bar.draw(strain * last * i as f64 / steps as f64));
            let peak = stress.fold(0.0, f64::max);
            assert!(
                (peak / strength - 1.0).abs() < 0.02,
                "{dissipation:?} {split:?} {}",
                peak / strength
            );
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
        assert!((part - 1.0).abs() < 0.02, "{elements} {part}");
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

#[test]
fn stiffness_is_the_derivative_of_forces() {
    const H: f64 = 1e-7;
    let axes = [vec![0.1, 0.3, 0.6], vec![-0.2, 0.0, 0.1]];
    for form in [Form::Axisymmetric, Form::PlaneStrain { thickness: 0.5 }] {
        for split in [Split::None, Split::NoTension, Split::Spectral, Split::Volumetric] {
            let mut law = law(Dissipation::At1, split);
            law.elastic.is_plane_stress = false;
            let section = Section { axes: axes.clone(), form };
            let elements = Elements::new(section, law);
            let nodes = elements.grid.nodes();
            let wave = |n: usize| (1.7 * n as f64 + 0.3).sin();
            let displacement: Vec<f64> = (0..2 * nodes).map(|n| 1e-3 * wave(n)).collect();
            let damage: Vec<f64> = (0..nodes).map(|n| 0.3 + 0.2 * wave(n)).collect();
            let rise: Vec<f64> = (0..nodes).map(|n| 2.0 * wave(3 * n)).collect();
            let change: Vec<f64> = (0..2 * nodes).map(|n| wave(7 * n)).collect();
            let team = Team::new(1);
            let at = |by: f64| {
                let moved: Vec<f64> =
                    displacement.iter().zip(&change).map(|(u, du)| u + by * du).collect();
                let nodal = Nodal { displacement: &moved, damage: &damage, rise: &rise };
                elements.forces(&nodal, &team)
            };
            let nodal = Nodal { displacement: &displacement, damage: &damage, rise: &rise };
            let mut stiffness = elements.intact_stiffness(&team);
            Damaged::of(&elements, &damage).correct_stiffness(
                &elements,
                &nodal,
                &mut stiffness,
                &team,
            );
            let mut padded = Padded::zeros(elements.grid);
            padded.inner_mut().copy_from_slice(&change);
            let mut found = vec![0.0; 2 * nodes];
            stiffness.product(&padded, &vec![false; 2 * nodes], &mut found, &team);
            let scale = found.iter().map(|own| own.abs()).fold(0.0, f64::max);
            for ((high, low), found) in at(H).iter().zip(&at(-H)).zip(&found) {
                let slope = (high - low) / (2.0 * H);
                assert!((slope - found).abs() < 1e-5 * scale, "{form:?} {split:?} {slope} {found}");
            }
        }
    }
}
