//! Solids that crack: their damage advances with their heat.

use std::ops::Range;

use super::SolidBody;
use super::memo::SolidMemo;
use super::notched::Notched;
use crate::body::{Acts, BodyError};
use crate::laws::fracture::{Components, Dissipation};
use crate::method::damage::{
    BreakingOrder, Cracks, DamageError, DamageProblem, DamageState, Elements, Energies, Form,
    Section, Side,
};
use crate::method::fem::elastic::Support;
use crate::method::fem::{Deformation, Geometry, Mesh, Plan, Remembered, SolidLoads};
use crate::runtime::allowance::Allowance;
use crate::state::{Field, Layout, Per};

/// Largest number of halvings of a step in which temperatures change much.
const MOST_HALVES: u32 = 4;
/// Change of temperature in a part of a step over that which breaks a held bar.
const PART_OF_BREAKING: f64 = 0.25;
/// Largest temperature above the stress-free one in a state [K].
const HOTTEST: f64 = 1e100;
/// Distance from a crack up to which its damage reaches with AT1, over the length of damage.
const REACH: f64 = 2.0;

/// Damage of the nodes farther from broken ones than that of a crack reaches. Bodies of AT2 are damaged everywhere, and
/// all their nodes count.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct DamageAway {
    pub most: f64,
    pub mean: f64,
    /// Its part of the energy of all damage.
    pub part: f64,
    /// True if elements differ.
    pub scatters: bool,
}

/// The mechanics of a solid that cracks, in a section of its mesh.
pub struct Cracking {
    problem: DamageProblem,
    /// Numbers of nodes of the body's mesh.
    counts: [usize; 3],
    /// Number of copies of the mesh that make up the body.
    copies: f64,
    /// Width of the body along the normal of a plane section [m].
    width: Option<f64>,
    /// Its notches, if it has any.
    notched: Option<Notched>,
    /// Kinds of the section's sides.
    sides: [[Side; 2]; 2],
    /// Largest change of temperature in a part of a step [K].
    most_change: f64,
}

/// Advances the thermal part of a state.
type Heating<'a> = dyn Fn(&mut [f64], &Acts) -> Result<(), BodyError> + 'a;

/// Data for advancing a part of a step.
struct Advance<'a> {
    cracking: &'a Cracking,
    allowance: &'a Allowance,
    heat: &'a Heating<'a>,
}

impl Cracking {
    /// Returns `None` if nothing cracks.
    pub fn of(plan: &Plan, threads: usize) -> Option<Self> {
        let law = plan.damage?;
        let mesh = &plan.mesh;
        let thickness = mesh.axes[1].end() - mesh.axes[1].start();
        let form = match (mesh.geometry, law.elastic.is_plane_stress) {
            (Geometry::Axisymmetric, _) => Form::Axisymmetric,
            (Geometry::Box, true) => Form::PlaneStress { thickness },
            (Geometry::Box, false) => Form::PlaneStrain { thickness },
        };
        let along_y = if mesh.mirrored[1] { 2.0 } else { 1.0 };
        let axes = [mesh.axes[0].nodes.clone(), mesh.axes[2].nodes.clone()];
        let breaking = law.strength() / (law.elastic.young * law.expansion.abs());
        let elements = Elements::new(Section { axes, form }, law);
        let problem = DamageProblem::new(elements, held(plan), threads);
        let width = (mesh.geometry == Geometry::Box).then_some(along_y * thickness);
        Some(Self {
            notched: Notched::of(&problem, &plan.notches, (mesh, width)),
            problem,
            counts: mesh.node_counts(),
            copies: mesh.copies(),
            width,
            sides: sides(plan),
            most_change: PART_OF_BREAKING * breaking,
        })
    }

    /// Number of nodes of the section.
    fn nodes(&self) -> usize {
        self.counts[0] * self.counts[2]
    }

    /// Returns the state at time zero: in equilibrium at a temperature above the stress-free one [K], without forces.
    pub fn initial_state(&self, rise: f64) -> Vec<f64> {
        let notched = self.notched.as_ref().map(|notched| notched.state.clone());
        let mut state = notched.unwrap_or_else(|| self.problem.initial_state());
        if rise != 0.0 {
            let rises = vec![rise; self.nodes()];
            let none = vec![0.0; 2 * self.nodes()];
            let before = state.clone();
            // The first step reports what keeps a body from its equilibrium.
            if self.problem.advance(&mut state, (&rises, &none), &Allowance::default()).is_err() {
                state = before;
            }
        }
        let mut flat = vec![0.0; self.layout().len()];
        self.store(&state, &mut flat);
        flat
    }

    pub fn layout(&self) -> Layout {
        let field = |name, words, per, width| Field { name, words, per, width };
        let nodes = self.nodes();
        Layout::default()
            .with(field("displacement", "displacement in the section [m]", Per::Node, 2), nodes)
            .with(field("damage", "damage [1]", Per::Node, 1), nodes)
            .with(field("rise", "temperature of the equilibrium [K]", Per::Node, 1), nodes)
            .with(field("work", "work of loads and thermal strain [J]", Per::Body, 1), 1)
            .with(field("clock", "time since the start [s]", Per::Body, 1), 1)
            .with(field("first_crack_place", "place of the first crack, or 0 [m]", Per::Body, 2), 1)
            .with(field("first_crack", "clock at the first crack, or 0 [s]", Per::Body, 1), 1)
    }

    /// Places of displacement, damage and temperature in the mechanical part of a state; work, clock, place and time of
    /// the first crack follow.
    fn places(&self) -> [Range<usize>; 3] {
        let nodes = self.nodes();
        [0..2 * nodes, 2 * nodes..3 * nodes, 3 * nodes..4 * nodes]
    }

    fn load(&self, flat: &[f64]) -> DamageState {
        let [displacement, damage, rise] = self.places().map(|place| flat[place].to_vec());
        DamageState { displacement, damage, rise, work: flat[4 * self.nodes()] }
    }

    fn store(&self, state: &DamageState, flat: &mut [f64]) {
        let lists = [&state.displacement, &state.damage, &state.rise];
        for (place, list) in self.places().into_iter().zip(lists) {
            flat[place].copy_from_slice(list);
        }
        flat[4 * self.nodes()] = state.work;
    }

    /// Time since the start and that of the first crack, zero before it [s].
    fn times(&self, flat: &[f64]) -> [f64; 2] {
        [1, 4].map(|after| flat[4 * self.nodes() + after])
    }

    /// Place of the first crack: x, or the radius, and z; zero before it [m].
    fn place_of_first(&self, flat: &[f64]) -> [f64; 2] {
        [2, 3].map(|after| flat[4 * self.nodes() + after])
    }

    /// Advances the clock, and notes its time at the end of the first part of a step that leaves a crack, with the
    /// place that broke first.
    fn note_time(&self, flat: &mut [f64], duration: f64, order: &BreakingOrder) {
        let [clock, first] = self.times(flat);
        let clock = clock + duration;
        let own = 4 * self.nodes();
        flat[own + 1] = clock;
        if first != 0.0 {
            return;
        }
        let cracked = self.cracked(flat);
        if let Some(node) = order.first_of(&cracked) {
            let place = self.problem.elements.section.place(node);
            flat[own + 2..own + 4].copy_from_slice(&place);
            flat[own + 4] = clock;
        }
    }

    /// Nodes of cracks that are not those of notches.
    fn cracked(&self, flat: &[f64]) -> Vec<usize> {
        let [_, damage, _] = self.places();
        let (section, damage) = (&self.problem.elements.section, &flat[damage]);
        match &self.notched {
            Some(notched) => section.grown(damage, &notched.cut),
            None => section.grown(damage, &vec![false; damage.len()]),
        }
    }

    fn cracks(&self, flat: &[f64]) -> Cracks {
        let [_, damage, _] = self.places();
        let elements = &self.problem.elements;
        elements.section.cracks(&flat[damage], self.sides, elements.law.length)
    }

    /// Refuses damage outside of its range, and impossible temperatures and times.
    pub fn check(&self, flat: &[f64]) -> Result<(), String> {
        let [_, damage, rise] = self.places();
        let wrong = flat[damage].iter().find(|&&value| !(0.0..=1.0).contains(&value));
        if let Some(value) = wrong {
            return Err(format!("damage of {value:e}, which is between 0 and 1"));
        }
        let wrong = flat[rise].iter().find(|value| !(-HOTTEST..HOTTEST).contains(*value));
        wrong.map_or(Ok(()), |value| Err(format!("equilibrium at {value:e} K")))?;
        let [clock, first] = self.times(flat);
        let is_possible = (0.0..=clock).contains(&first) && clock < f64::INFINITY;
        if !is_possible || first != 0.0 && self.cracked(flat).is_empty() {
            return Err(format!("a first crack at {first:e} s, {clock:e} s from the start"));
        }
        let place @ [along, z] = self.place_of_first(flat);
        let axes = &self.problem.elements.section.axes;
        let is_inside = axes.iter().zip(place).all(|(axis, at)| {
            axis.first().is_some_and(|&low| low <= at)
                && axis.last().is_some_and(|&high| at <= high)
        });
        match if first == 0.0 { place == [0.0; 2] } else { is_inside } {
            true => Ok(()),
            false => {
                Err(format!("a first crack at [{along:e}, {z:e}] m, {first:e} s from the start"))
            }
        }
    }

    /// Values of the section's nodes at the nodes of the body's mesh.
    fn spread<T: Copy>(&self, section: &[T]) -> Vec<T> {
        let [columns, rows, _] = self.counts;
        let layers = section.chunks(columns);
        layers.flat_map(|layer| std::iter::repeat_n(layer, rows).flatten().copied()).collect()
    }

    /// Nodal values of the body's mesh at the section's nodes: those of the first row along y.
    fn first_row(&self, nodal: &[f64]) -> Vec<f64> {
        let [columns, rows, _] = self.counts;
        nodal.chunks(columns * rows).flat_map(|layer| &layer[..columns]).copied().collect()
    }

    /// Forces on the section's nodes from those on the nodes of the body's mesh [N].
    fn section_forces(&self, forces: &[f64]) -> Vec<f64> {
        let [columns, rows, layers] = self.counts;
        let degrees = forces.len() / (columns * rows * layers);
        let mut found = vec![0.0; 2 * self.nodes()];
        for (node, own) in forces.chunks(degrees).enumerate() {
            let place = node % columns + columns * (node / (columns * rows));
            found[2 * place] += own[0];
            found[2 * place + 1] += own[degrees - 1];
        }
        found
    }

    /// Displacement of the nodes of the body's mesh: along z and, in boxes, along y, where it is zero.
    fn displacement(&self, state: &DamageState) -> Vec<f64> {
        let in_section: Vec<[f64; 2]> =
            state.displacement.chunks(2).map(|own| [own[0], own[1]]).collect();
        let nodal = self.spread(&in_section);
        match self.width {
            Some(_) => nodal.into_iter().flat_map(|[x, z]| [x, 0.0, z]).collect(),
            None => nodal.into_flattened(),
        }
    }
}

/// Kinds of the section's sides. Cracks along a face that is held begin elsewhere.
fn sides(plan: &Plan) -> [[Side; 2]; 2] {
    let mesh: &Mesh = &plan.mesh;
    let mut sides = [[Side::Face; 2]; 2];
    for (face, _) in plan.supports.iter().filter(|(face, _)| face.axis != 1) {
        sides[usize::from(face.axis == 2)][usize::from(face.high)] = Side::Held;
    }
    match mesh.geometry {
        Geometry::Axisymmetric => sides[0][0] = Side::Axis,
        Geometry::Box if mesh.mirrored[0] => sides[0][0] = Side::Mirror,
        Geometry::Box => {}
    }
    sides
}

/// Displacements of the section's nodes that supports, planes of symmetry and the axis hold.
fn held(plan: &Plan) -> Vec<bool> {
    let mesh: &Mesh = &plan.mesh;
    let [columns, _, layers] = mesh.node_counts();
    let mut held = vec![false; 2 * columns * layers];
    let mut hold = |axis: usize, high: bool, components: &[usize]| {
        for node in 0..columns * layers {
            let (place, count) =
                if axis == 0 { (node % columns, columns) } else { (node / columns, layers) };
            if place == if high { count - 1 } else { 0 } {
                components.iter().for_each(|component| held[2 * node + component] = true);
            }
        }
    };
    for (face, support) in plan.supports.iter().filter(|(face, _)| face.axis != 1) {
        let normal = [usize::from(face.axis == 2)];
        match support {
            Support::Clamped => hold(face.axis, face.high, &[0, 1]),
            Support::Roller => hold(face.axis, face.high, &normal),
        }
    }
    if mesh.mirrored[0] || mesh.geometry == Geometry::Axisymmetric {
        hold(0, false, &[0]);
    }
    held
}

impl SolidBody {
    /// Advances heat, displacement and damage to the equilibrium at the end, in parts in which temperatures change by
    /// at most a quarter of what breaks a held bar, unless they jump.
    ///
    /// Received heat changes linearly over the whole step, so such a step is not cut.
    pub(super) fn advance_cracking(
        &self,
        cracking: &Cracking,
        state: &mut [f64],
        acts: &Acts,
        allowance: &Allowance,
        heat: impl Fn(&mut [f64], &Acts) -> Result<(), BodyError>,
    ) -> Result<(), BodyError> {
        let advance = Advance { cracking, allowance, heat: &heat };
        let halves = if acts.received.is_empty() { MOST_HALVES } else { 0 };
        self.crack_in_part(&advance, state, acts, halves)
    }

    /// Advances over one part of a step, with at most this many further halvings.
    fn crack_in_part(
        &self,
        advance: &Advance,
        state: &mut [f64],
        acts: &Acts,
        halves: u32,
    ) -> Result<(), BodyError> {
        let Advance { cracking, allowance, heat } = *advance;
        let start = state.to_vec();
        heat(&mut state[..self.heat_len], acts)?;
        let mut mechanics = cracking.load(self.mechanics_of(state));
        let (rise, forces) = self.section_loads(cracking, state, acts)?;
        let changes = rise.iter().zip(&mechanics.rise).map(|(new, old)| (new - old).abs());
        if halves == 0 || changes.fold(0.0, f64::max) <= cracking.most_change {
            let (mut order, loads) = (BreakingOrder::default(), (&rise[..], &forces[..]));
            let advanced =
                cracking.problem.advance_noting(&mut mechanics, loads, allowance, &mut order);
            advanced.map_err(|error| self.damage_error(error))?;
            let length = cracking.layout().len();
            let own = &mut state[self.heat_len..][..length];
            cracking.store(&mechanics, own);
            cracking.note_time(own, acts.duration, &order);
            return Ok(());
        }
        state.copy_from_slice(&start);
        acts.in_halves(|half| self.crack_in_part(advance, state, half, halves - 1))
    }

    /// Temperatures above the stress-free one [K] and forces [N] at the section's nodes at the end of a step.
    fn section_loads(
        &self,
        cracking: &Cracking,
        state: &[f64],
        acts: &Acts,
    ) -> Result<(Vec<f64>, Vec<f64>), BodyError> {
        let inputs = acts.path.at(0, acts.duration);
        let mut loads: SolidLoads = self.loads.assemble(&inputs, self.meshes());
        for received in acts.received {
            self.port(received.face).add(&mut loads, received.given);
        }
        let temperatures = self.solid.temperatures(self.heat_of(state), &loads);
        let thermal = self.solid.above_stress_free(temperatures);
        let rise = match thermal[0].is_empty() {
            true => vec![0.0; cracking.nodes()],
            false => cracking.first_row(&thermal[0]),
        };
        Ok((rise, cracking.section_forces(&self.nodal_forces(&loads)?)))
    }

    fn damage_error(&self, error: DamageError) -> BodyError {
        match error {
            DamageError::Solver(error) => error.into(),
            DamageError::Halted(halt) => BodyError::Halted { body: self.name.clone(), halt },
            error => BodyError::Cracking { body: self.name.clone(), error },
        }
    }

    /// Displacement, stress and damage of a body that cracks.
    pub(super) fn cracked(&self, cracking: &Cracking, state: &[f64]) -> Deformation {
        let state = cracking.load(self.mechanics_of(state));
        // The normal of a plane section is y, that of a meridian section the hoop.
        let of_section =
            |[first, second, third, shear]: Components| [first, third, second, 0.0, 0.0, shear];
        let stress: Vec<[f64; 6]> =
            cracking.problem.stress(&state).into_iter().map(of_section).collect();
        let remembered = Remembered::elastic(cracking.spread(&stress));
        let damage = cracking.spread(&state.damage);
        Deformation::of_nodes(cracking.displacement(&state), remembered).with_damage(damage)
    }

    /// Largest damage of all nodes [1]; zero without cracks.
    pub(super) fn max_damage(&self, state: &[f64]) -> f64 {
        let Some(cracking) = &self.cracking else { return 0.0 };
        let [_, damage, _] = cracking.places();
        self.mechanics_of(state)[damage].iter().copied().fold(0.0, f64::max)
    }

    /// Damage away from cracks.
    pub(super) fn damage_away(&self, state: &[f64]) -> DamageAway {
        let Some(cracking) = &self.cracking else { return DamageAway::default() };
        let [_, damage, _] = cracking.places();
        let damage = &self.mechanics_of(state)[damage];
        let Elements { section, law, .. } = &cracking.problem.elements;
        let nodes = match law.dissipation {
            Dissipation::At1 => section.away_from_broken(damage, REACH * law.length),
            Dissipation::At2 => (0..damage.len()).collect(),
        };
        let most = nodes.iter().map(|&node| damage[node]).fold(0.0, f64::max);
        let sum: f64 = nodes.iter().map(|&node| damage[node]).sum();
        // The gradient takes as much energy as the damage of a crack itself.
        let of_cracks = 2.0 * (damage.iter().sum::<f64>() - sum);
        let mean = sum / nodes.len().max(1) as f64;
        let part = if most > 0.0 { sum / (sum + of_cracks) } else { 0.0 };
        DamageAway { most, mean, part, scatters: law.scatter > 0.0 }
    }

    /// Width of the widest crack over the size of its elements [1]; zero without cracks.
    pub(super) fn opening_of_cracks(&self, state: &[f64]) -> f64 {
        let Some(cracking) = &self.cracking else { return 0.0 };
        let [displacement, damage, _] = cracking.places();
        let own = self.mechanics_of(state);
        cracking.problem.elements.section.opening(&own[displacement], &own[damage])
    }

    /// Number and depth of the cracks of a state.
    pub(super) fn cracks_of(&self, state: &[f64]) -> Cracks {
        let own = self.mechanics_of(state);
        self.cracking.as_ref().map_or(Cracks::default(), |cracking| cracking.cracks(own))
    }

    /// Time from the start to the first crack [s]; zero before it, and without cracks.
    pub(super) fn time_of_first_crack(&self, state: &[f64]) -> f64 {
        let Some(cracking) = &self.cracking else { return 0.0 };
        let [_, first] = cracking.times(self.mechanics_of(state));
        first
    }

    /// Place of the first crack: x, or the radius, and z [m]; zero before it, and without cracks.
    pub(super) fn place_of_first_crack(&self, state: &[f64]) -> [f64; 2] {
        let Some(cracking) = &self.cracking else { return [0.0; 2] };
        cracking.place_of_first(self.mechanics_of(state))
    }

    /// Returns true if a crack of the later state is not part of one of the earlier.
    pub(super) fn has_new_crack(&self, before: &[f64], after: &[f64]) -> bool {
        let Some(cracking) = &self.cracking else { return false };
        let [_, damage, _] = cracking.places();
        let [before, after] = [before, after].map(|own| &self.mechanics_of(own)[damage.clone()]);
        cracking.problem.elements.section.has_new_crack(before, after)
    }

    /// Energies of a body that cracks [J].
    pub(super) fn energies(&self, state: &[f64], memo: &mut SolidMemo) -> Energies {
        let Some(cracking) = &self.cracking else { return Energies::default() };
        memo.energies(|| {
            let own = cracking.problem.energies(&cracking.load(self.mechanics_of(state)));
            let Energies { elastic, dissipated } = own;
            let copies = cracking.copies;
            Energies { elastic: copies * elastic, dissipated: copies * dissipated }
        })
    }

    /// Work that loads and thermal strain have done [J].
    pub(super) fn work_of_cracks(&self, state: &[f64]) -> f64 {
        let Some(cracking) = &self.cracking else { return 0.0 };
        cracking.copies * self.mechanics_of(state)[4 * cracking.nodes()]
    }

    /// Area of notches and cracks, and that of notches [m²]; zero without cracks.
    pub(super) fn areas_of_cracks(&self, state: &[f64], memo: &mut SolidMemo) -> [f64; 2] {
        let Some(cracking) = &self.cracking else { return [0.0; 2] };
        let by_energy =
            self.energies(state, memo).dissipated / cracking.problem.elements.law.energy;
        let Some(notched) = &cracking.notched else { return [by_energy, 0.0] };
        let [_, damage, _] = cracking.places();
        let damage = &self.mechanics_of(state)[damage];
        let section = &cracking.problem.elements.section;
        [notched.area_of_cracks(section, damage, by_energy), notched.area]
    }

    /// Width of a plane section that cracks [m].
    pub(super) fn width_of_section(&self) -> Option<f64> {
        self.cracking.as_ref()?.width
    }
}
