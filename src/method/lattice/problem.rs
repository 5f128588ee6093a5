//! A strip whose load moves, or whose notch opens, along a path.

use std::f64::consts::PI;

use super::arrangement::{Arrangement, Cell, Particles, Strip, distance};
use super::equilibrium::{Balanced, Equilibrium, Trial, WORK, product};
use super::fragments::fragments;
use super::frame::{COMPONENTS, Frame, Support};
use super::frequency::highest_frequency;
use super::link::{Link, Sheet};
use super::order::dissect;
use super::settling::Masses;
use super::stiffness::Pattern;
use super::{Broken, LatticeError, LatticeState, LatticeTotals};
use crate::laws::fracture::SofteningLaw;
use crate::runtime::allowance::Allowance;

/// Prescribed quantity.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Control {
    /// Displacement of the load.
    Displacement,
    /// Opening of the notch at the lower face.
    Opening,
}

/// Everything that a lattice is made of.
#[derive(Debug, Clone, PartialEq)]
pub struct LatticePlan {
    pub strip: Strip,
    pub sheet: Sheet,
    pub support: Support,
    pub control: Control,
    pub softening: SofteningLaw,
    /// Share β of bending in the stretch that damages [1].
    pub bending: f64,
    /// True if broken links bear pressure.
    pub closes: bool,
    /// Half the width of the range of strengths, over its middle, and the number of its sample.
    pub scatter: f64,
    pub seed: u32,
}

/// A lattice of links that soften and break, in equilibrium with what is prescribed.
pub struct Lattice {
    plan: LatticePlan,
    particles: Particles,
    equilibrium: Equilibrium,
    /// Longest step of what is prescribed [m].
    longest: f64,
}

/// Name of the steps of what is prescribed in messages.
const STEPS: &str = "steps of equilibrium";
/// Least flexural stiffness over the axial one and the length squared: at ν = 1/3 links do not bend, and nothing else
/// would hold the rotation of particles.
const SPIN: f64 = 1e-9;
/// Part of the longest stable time step that sudden breaks take.
const STABLE: f64 = 0.8;
/// Distance from supports and loads within which links stay intact, over the spacing.
const PROTECTED: f64 = 2.0;
/// Longest step over the opening of a link at the knee of its law, and shortest step over the longest.
const LONGEST: f64 = 0.5;
const SHORTEST: f64 = 0.02;
/// Growth of the damage of a link in a step, at most.
const GROWTH: f64 = 0.2;
/// Iterations up to which the next step is longer, and its factor.
const EASY: usize = 6;
const LENGTHENED: f64 = 1.5;

impl LatticePlan {
    /// Stress at which a link softens along itself [Pa], and the energy that it takes per area [J/m²]: the area below
    /// its law and what it stores up to its strength.
    pub fn strength_and_energy(&self) -> (f64, f64) {
        let young = self.sheet.young;
        let spacing = self.strip.fitted_spacing();
        let law = self.softening.of_link(spacing, young, 1.0);
        (young * law.onset, law.energy() * young * spacing * law.onset * law.onset)
    }

    /// Longest step of what is prescribed [m].
    pub fn longest_step(&self) -> f64 {
        let spacing = self.strip.fitted_spacing();
        let law = self.softening.of_link(spacing, self.sheet.young, 1.0);
        LONGEST * (law.knee - 1.0) * law.onset * spacing
    }
}

impl Lattice {
    /// Updates of an unknown in an iteration of the equilibrium.
    pub const WORK: usize = WORK;

    pub fn new(plan: LatticePlan, threads: usize) -> Result<Self, LatticeError> {
        let particles = plan.strip.fill();
        let frame = Frame::new(&particles, &plan.strip, plan.support);
        let control = match plan.control {
            Control::Displacement => Some(frame.load.clone()),
            Control::Opening => frame.mouth.clone(),
        };
        let control = control.ok_or(LatticeError::NoMouth)?;
        let links = links(&plan, &particles, &frame.loaded);
        let pattern = Pattern::new(frame, &links, &dissect(&particles), threads)?;
        let (bending, closes, longest) = (plan.bending, plan.closes, plan.longest_step());
        let masses = masses(&plan, &particles, &links, &pattern.frame);
        let forces = links.iter().map(|link| link.axial * link.softening.onset * link.length);
        let strength = forces.fold(0.0, f64::max);
        let equilibrium =
            Equilibrium { links, pattern, bending, closes, control, masses, strength };
        Ok(Self { plan, particles, equilibrium, longest })
    }

    pub fn plan(&self) -> &LatticePlan {
        &self.plan
    }

    pub fn particles(&self) -> &Particles {
        &self.particles
    }

    pub fn links(&self) -> &[Link] {
        &self.equilibrium.links
    }

    fn frame(&self) -> &Frame {
        &self.equilibrium.pattern.frame
    }

    pub fn initial_state(&self) -> LatticeState {
        LatticeState {
            displacement: vec![0.0; self.frame().unknowns],
            damage: vec![0.0; self.links().len()],
            ..LatticeState::default()
        }
    }

    /// Number of unknowns.
    pub fn unknowns(&self) -> usize {
        self.frame().unknowns
    }

    /// Moves to a value of what is prescribed [m], in steps of their own. After an error the state is unusable.
    pub fn advance(
        &self,
        state: &mut LatticeState,
        target: f64,
        allowance: &Allowance,
    ) -> Result<(), LatticeError> {
        let from = state.prescribed;
        let total = (target - from).abs();
        allowance.foresee(total / self.longest, STEPS, WORK * self.unknowns())?;
        let (mut done, mut step) = (0.0, self.longest);
        while done < total {
            let rest = total - done;
            let is_last = step >= rest * (1.0 - 1e-9);
            let length = if is_last { rest } else { step };
            let wanted =
                if is_last { target } else { from + (target - from).signum() * (done + length) };
            let shortest = SHORTEST * self.longest;
            let balanced =
                self.equilibrium.solve(&state.balanced(), &state.damage, wanted, allowance)?;
            let found =
                balanced.filter(|found| length <= shortest || grows_slowly(state, &found.trial));
            match found {
                Some(found) => {
                    let is_easy = found.iterations <= EASY;
                    step = (step * if is_easy { LENGTHENED } else { 1.0 }).min(self.longest);
                    self.accept(state, found.balanced, found.trial);
                }
                None if length > shortest => {
                    step = (0.5 * length).max(shortest);
                    continue;
                }
                None => self.jump(state, wanted, allowance)?,
            }
            state.prescribed = wanted;
            done += length;
        }
        Ok(())
    }

    /// Moves a state to the next equilibrium, with work and dissipation of the mean forces between both.
    fn accept(&self, state: &mut LatticeState, balanced: Balanced, trial: Trial) {
        let before = self.equilibrium.deformations(&state.displacement);
        let damage = [&state.damage[..], &trial.damage];
        state.dissipated += self.equilibrium.dissipation([&before, &trial.deformation], damage);
        state.work += self.work(state, &balanced);
        state.damage = trial.damage;
        state.displacement = balanced.displacement;
        state.force = balanced.force;
    }

    /// Lets links break suddenly; the energy that they release is not dissipated by damage.
    fn jump(
        &self,
        state: &mut LatticeState,
        wanted: f64,
        allowance: &Allowance,
    ) -> Result<(), LatticeError> {
        let stored = self.elastic_energy(state);
        let start = state.balanced();
        let damage = &mut state.damage;
        let (balanced, dissipated) = match self.plan.control {
            Control::Displacement => self.equilibrium.settle(&start, damage, wanted, allowance)?,
            Control::Opening => self.equilibrium.relax(&start, damage, wanted, allowance)?,
        };
        let work = match self.plan.control {
            Control::Displacement => self.work_before_break(state, &balanced),
            // The load moves before links break: it falls by what they release.
            Control::Opening => {
                self.work(state, &balanced).max(state.force * self.moved(state, &balanced))
            }
        };
        state.work += work;
        state.dissipated += dissipated;
        state.displacement = balanced.displacement;
        state.force = balanced.force;
        state.released += work - dissipated - (self.elastic_energy(state) - stored);
        Ok(())
    }

    /// Work of the mean load from a state to the next equilibrium [J].
    fn work(&self, state: &LatticeState, next: &Balanced) -> f64 {
        0.5 * (state.force + next.force) * self.moved(state, next)
    }

    /// Work of a load that moves to the next equilibrium before links break [J]: without more damage, the strip is linear
    /// from the start on.
    fn work_before_break(&self, state: &LatticeState, next: &Balanced) -> f64 {
        let moved = self.moved(state, next);
        let place = product(&self.equilibrium.pattern.frame.load, &state.displacement);
        let stiffness = if place == 0.0 { 0.0 } else { (state.force / place).max(0.0) };
        (state.force + 0.5 * stiffness * moved) * moved
    }

    /// Motion of the load from a state to the next equilibrium [m].
    fn moved(&self, state: &LatticeState, next: &Balanced) -> f64 {
        let load = &self.frame().load;
        product(load, &next.displacement) - product(load, &state.displacement)
    }

    /// Elastic energy [J].
    pub fn elastic_energy(&self, state: &LatticeState) -> f64 {
        let deformation = self.equilibrium.deformations(&state.displacement);
        self.equilibrium.elastic_energy(&deformation, &state.damage)
    }

    pub fn totals(&self, state: &LatticeState) -> LatticeTotals {
        let value = |of| product(of, &state.displacement);
        LatticeTotals {
            displacement: value(&self.frame().load),
            opening: self.frame().mouth.as_ref().map(value),
            elastic_energy: self.elastic_energy(state),
            broken: Broken::of(&self.particles, &state.damage),
        }
    }

    /// Number of parts that unbroken links connect.
    pub fn fragments(&self, state: &LatticeState) -> usize {
        fragments(self.particles.places.len(), self.links(), &state.damage)
    }

    /// Displacement of each particle [m].
    pub fn displacements(&self, state: &LatticeState) -> Vec<[f64; 2]> {
        let value = |unknown: &Option<usize>| unknown.map_or(0.0, |at| state.displacement[at]);
        let of_particle = |own: &[Option<usize>]| [value(&own[0]), value(&own[1])];
        self.frame().unknown.chunks_exact(3).map(of_particle).collect()
    }

    /// Largest damage of the links of each particle, and the pressure in it [Pa].
    pub fn at_particles(&self, state: &LatticeState) -> Vec<(f64, f64)> {
        let deformation = self.equilibrium.deformations(&state.displacement);
        let links = self.links().iter().zip(&deformation).zip(&state.damage);
        let normals = links.map(|((link, q), &damage)| {
            let [normal, ..] = self.equilibrium.conjugate(link, q, damage);
            normal
        });
        at_particles(&self.plan, &self.particles, (self.links(), &state.damage), normals)
    }

    /// Refuses a state that is not in equilibrium with what is prescribed, or whose damage no stretch explains.
    pub fn check(&self, state: &LatticeState) -> Result<(), String> {
        check_damage(self.links(), &state.damage)?;
        self.equilibrium.check(&state.balanced(), &state.damage, state.prescribed)?;
        let energies = [state.work, state.dissipated + state.released, self.elastic_energy(state)];
        let missing = energies[0] - energies[1] - energies[2];
        let size = energies.iter().fold(0.0, |sum, energy| sum + energy.abs());
        match missing.abs() <= ENERGY * size + self.equilibrium.rounding_of_energy() {
            true => Ok(()),
            false => Err(format!("{missing:.1e} J of {:.1e} J of work have no cause", energies[0])),
        }
    }
}

/// Part of the energies by which those of a state may differ: closing cracks leave up to a thousandth.
const ENERGY: f64 = 0.05;

/// Returns true if no link gains more damage than a step may bring.
fn grows_slowly(state: &LatticeState, trial: &Trial) -> bool {
    trial.damage.iter().zip(&state.damage).all(|(new, old)| new - old <= GROWTH)
}

/// Mass of each unknown for a density of one, which is that of all components that follow it, a stable time step, and
/// half the critical damping of the slowest wave along the strip.
fn masses(plan: &LatticePlan, particles: &Particles, links: &[Link], frame: &Frame) -> Masses {
    let thickness = plan.sheet.thickness;
    let mut of_unknowns = vec![0.0; frame.unknowns];
    for (cell, unknown) in particles.cells.iter().zip(frame.unknown.chunks_exact(COMPONENTS)) {
        for (at, of_cell) in unknown.iter().zip([cell.area, cell.area, cell.moment]) {
            if let Some(at) = *at {
                of_unknowns[at] += thickness * of_cell;
            }
        }
    }
    let inverse = |cell: &Cell| [cell.area, cell.moment].map(|of_cell| 1.0 / (thickness * of_cell));
    let inverse: Vec<_> = particles.cells.iter().map(inverse).collect();
    let time_step = STABLE * 2.0 / highest_frequency(links, &inverse);
    let swing = PI * plan.sheet.young.sqrt() / plan.strip.length;
    Masses { of_unknowns, time_step, fading: (-swing * time_step).exp() }
}

/// Refuses damage beyond its range, and that of links that stay intact.
pub(super) fn check_damage(links: &[Link], damage: &[f64]) -> Result<(), String> {
    if let Some(damage) = damage.iter().find(|damage| !(0.0..=1.0).contains(*damage)) {
        return Err(format!("damage of {damage:e}, which is between 0 and 1"));
    }
    match links.iter().zip(damage).any(|(link, damage)| !link.breaks && *damage > 0.0) {
        true => Err("damage of a link that stays intact".to_owned()),
        false => Ok(()),
    }
}

/// Largest damage of the links of each particle, and the pressure in it [Pa]: a third of the trace of the stress that
/// follows from the normal forces of its links [N].
pub(super) fn at_particles(
    plan: &LatticePlan,
    particles: &Particles,
    (links, damage): (&[Link], &[f64]),
    normals: impl Iterator<Item = f64>,
) -> Vec<(f64, f64)> {
    let thickness = plan.sheet.thickness;
    let mut at = vec![(0.0_f64, 0.0); particles.places.len()];
    for ((link, &damage), normal) in links.iter().zip(damage).zip(normals) {
        for end in link.ends {
            let volume = particles.cells[end].area * thickness;
            at[end].0 = at[end].0.max(damage);
            at[end].1 -= normal * link.length / (6.0 * volume);
        }
    }
    at
}

/// The links of all pairs; those near supports and loads stay intact.
pub(super) fn links(plan: &LatticePlan, particles: &Particles, loaded: &[usize]) -> Vec<Link> {
    let places = &particles.places;
    let reach = PROTECTED * particles.spacing;
    let is_far = |i: usize| loaded.iter().all(|&j| distance(places[i], places[j]) > reach);
    let far: Vec<bool> = (0..places.len()).map(is_far).collect();
    let mut is_loaded = vec![false; places.len()];
    loaded.iter().for_each(|&i| is_loaded[i] = true);
    let to_platens = match plan.support {
        Support::Ends => plan.strip.part_to_platens(places, plan.sheet.poisson),
        Support::ThreePoint { .. } => 1.0,
    };
    let sheet = match plan.strip.arrangement {
        Arrangement::Random { .. } => plan.sheet.of_random_links(),
        _ => plan.sheet,
    };
    let of_pair = |(number, pair): (usize, &super::Pair)| {
        let [a, b] = pair.ends.map(|i| places[i]);
        let length = distance(a, b);
        let [a_is_loaded, b_is_loaded] = pair.ends.map(|i| is_loaded[i]);
        let part = if a_is_loaded == b_is_loaded { 1.0 } else { to_platens };
        let [axial, flexural] = sheet.stiffness(length, pair.facet).map(|own| part * own);
        let strength =
            crate::laws::fracture::scattered(plan.scatter, plan.seed, [number as u64, 0]);
        let flexural = flexural.max(SPIN * axial * length * length);
        Link {
            ends: pair.ends,
            length,
            direction: [(b[0] - a[0]) / length, (b[1] - a[1]) / length],
            axial,
            flexural,
            softening: plan.softening.of_link(length, plan.sheet.young, strength),
            breaks: pair.ends.iter().all(|&i| far[i]),
        }
    };
    particles.pairs.iter().enumerate().map(of_pair).collect()
}
