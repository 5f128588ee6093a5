//! Solids that crack: their damage advances with their heat.

use std::ops::Range;

use super::SolidBody;
use super::memo::SolidMemo;
use super::notched::Notched;
use crate::body::{Acts, BodyError};
use crate::laws::fracture::Dissipation;
use crate::method::damage::{
    BreakingOrder, Cracks, DamageError, DamageModel, DamageProblem, DamageState, Domain, Elements,
    Energies, Form, Side,
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
/// Axes of the mesh along which sections are meshed, and bodies in space.
const IN_SECTION: [usize; 2] = [0, 2];
const IN_SPACE: [usize; 3] = [0, 1, 2];
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

/// The mechanics of a solid that cracks, on its mesh or in a section of it.
pub struct Cracking {
    problem: Box<dyn DamageModel>,
    /// Axes of the body's mesh along which it is meshed: all, or those of a section.
    along: &'static [usize],
    /// Numbers of nodes of the body's mesh.
    counts: [usize; 3],
    /// Number of copies of the mesh that make up the body.
    copies: f64,
    /// Width of the body along the normal of a plane section [m].
    width: Option<f64>,
    /// Its notches, if it has any.
    notched: Option<Notched>,
    /// Kinds of the sides along these axes.
    sides: Vec<[Side; 2]>,
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
        let breaking = law.strength() / (law.elastic.young * law.expansion.abs());
        let thickness = mesh.axes[1].end() - mesh.axes[1].start();
        let along_y = if mesh.mirrored[1] { 2.0 } else { 1.0 };
        let along: &[usize] = if plan.cracks_in_section { &IN_SECTION } else { &IN_SPACE };
        let nodes = |axis: usize| mesh.axes[axis].nodes.clone();
        let mirrored = |axis: usize| axis < 2 && mesh.mirrored[axis];
        let held = held(plan, along);
        let width = (plan.cracks_in_section && mesh.geometry == Geometry::Box)
            .then_some(along_y * thickness);
        let (problem, notched): (Box<dyn DamageModel>, _) = if plan.cracks_in_section {
            let form = match (mesh.geometry, law.elastic.is_plane_stress) {
                (Geometry::Axisymmetric, _) => Form::Axisymmetric,
                (Geometry::Box, true) => Form::PlaneStress { thickness },
                (Geometry::Box, false) => Form::PlaneStrain { thickness },
            };
            let domain =
                Domain { axes: IN_SECTION.map(nodes), form, mirrored: IN_SECTION.map(mirrored) };
            let problem = DamageProblem::<2, 4, 4>::new(Elements::new(domain, law), held, threads);
            let notched = Notched::of(&problem, &plan.notches, (mesh, width));
            (Box::new(problem), notched)
        } else {
            let domain = Domain {
                axes: IN_SPACE.map(nodes),
                form: Form::Space,
                mirrored: IN_SPACE.map(mirrored),
            };
            let problem = DamageProblem::<3, 8, 6>::new(Elements::new(domain, law), held, threads);
            (Box::new(problem), None)
        };
        Some(Self {
            notched,
            problem,
            along,
            counts: mesh.node_counts(),
            copies: mesh.copies(),
            width,
            sides: sides(plan, along),
            most_change: PART_OF_BREAKING * breaking,
        })
    }

    /// Number of nodes that crack.
    fn nodes(&self) -> usize {
        self.along.iter().map(|&axis| self.counts[axis]).product()
    }

    /// Number of components of a displacement and of a place.
    fn dimension(&self) -> usize {
        self.along.len()
    }

    /// Places in the mechanical part of a state of what follows the fields of the nodes: work, clock, place and time of
    /// the first crack.
    fn work_at(&self) -> usize {
        (self.dimension() + 2) * self.nodes()
    }

    fn clock_at(&self) -> usize {
        self.work_at() + 1
    }

    fn place_at(&self) -> Range<usize> {
        self.clock_at() + 1..self.clock_at() + 1 + self.dimension()
    }

    fn first_at(&self) -> usize {
        self.place_at().end
    }

    /// Returns the state at time zero: in equilibrium at a temperature above the stress-free one [K], without forces.
    pub fn initial_state(&self, rise: f64) -> Vec<f64> {
        let notched = self.notched.as_ref().map(|notched| notched.state.clone());
        let mut state = notched.unwrap_or_else(|| self.problem.initial_state());
        if rise != 0.0 {
            let rises = vec![rise; self.nodes()];
            let none = vec![0.0; self.dimension() * self.nodes()];
            let before = state.clone();
            // The first step reports what keeps a body from its equilibrium.
            let (loads, mut order) = ((&rises[..], &none[..]), BreakingOrder::default());
            let allowance = Allowance::default();
            if self.problem.advance(&mut state, loads, &allowance, &mut order).is_err() {
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
        let displacement = match self.dimension() {
            2 => "displacement in the section [m]",
            _ => "displacement [m]",
        };
        let place = "place of the first crack, or 0 [m]";
        Layout::default()
            .with(field("displacement", displacement, Per::Node, self.dimension()), nodes)
            .with(field("damage", "damage [1]", Per::Node, 1), nodes)
            .with(field("rise", "temperature of the equilibrium [K]", Per::Node, 1), nodes)
            .with(field("work", "work of loads and thermal strain [J]", Per::Body, 1), 1)
            .with(field("clock", "time since the start [s]", Per::Body, 1), 1)
            .with(field("first_crack_place", place, Per::Body, self.dimension()), 1)
            .with(field("first_crack", "clock at the first crack, or 0 [s]", Per::Body, 1), 1)
    }

    /// Places of displacement, damage and temperature in the mechanical part of a state.
    fn places(&self) -> [Range<usize>; 3] {
        let (nodes, moved) = (self.nodes(), self.dimension() * self.nodes());
        [0..moved, moved..moved + nodes, moved + nodes..moved + 2 * nodes]
    }

    fn load(&self, flat: &[f64]) -> DamageState {
        let [displacement, damage, rise] = self.places().map(|place| flat[place].to_vec());
        DamageState { displacement, damage, rise, work: flat[self.work_at()] }
    }

    fn store(&self, state: &DamageState, flat: &mut [f64]) {
        let lists = [&state.displacement, &state.damage, &state.rise];
        for (place, list) in self.places().into_iter().zip(lists) {
            flat[place].copy_from_slice(list);
        }
        flat[self.work_at()] = state.work;
    }

    /// Time since the start and that of the first crack, zero before it [s].
    fn times(&self, flat: &[f64]) -> [f64; 2] {
        [flat[self.clock_at()], flat[self.first_at()]]
    }

    /// Place of the first crack: x, or the radius, in space y, and z; zero before it [m].
    fn place_of_first<'a>(&self, flat: &'a [f64]) -> &'a [f64] {
        &flat[self.place_at()]
    }

    /// Advances the clock, and notes its time at the end of the first part of a step that leaves a crack, with the
    /// place that broke first.
    fn note_time(&self, flat: &mut [f64], duration: f64, order: &BreakingOrder) {
        let [clock, first] = self.times(flat);
        let clock = clock + duration;
        flat[self.clock_at()] = clock;
        if first != 0.0 {
            return;
        }
        let cracked = self.cracked(flat);
        if let Some(node) = order.first_of(&cracked) {
            flat[self.place_at()].copy_from_slice(&self.problem.place(node));
            flat[self.first_at()] = clock;
        }
    }

    /// Nodes of cracks that are not those of notches.
    fn cracked(&self, flat: &[f64]) -> Vec<usize> {
        let [_, damage, _] = self.places();
        let damage = &flat[damage];
        match &self.notched {
            Some(notched) => self.problem.grown(damage, &notched.cut),
            None => self.problem.grown(damage, &vec![false; damage.len()]),
        }
    }

    fn cracks(&self, flat: &[f64]) -> Cracks {
        let [_, damage, _] = self.places();
        self.problem.cracks(&flat[damage], &self.sides)
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
        let place = self.place_of_first(flat);
        let is_inside = self.problem.axes().iter().zip(place).all(|(axis, at)| {
            axis.first().is_some_and(|low| low <= at) && axis.last().is_some_and(|high| at <= high)
        });
        match if first == 0.0 { place.iter().all(|at| *at == 0.0) } else { is_inside } {
            true => Ok(()),
            false => Err(format!("a first crack at {place:?} m, {first:e} s from the start")),
        }
    }

    /// Values of the nodes that crack at the nodes of the body's mesh.
    fn spread<T: Copy>(&self, section: &[T]) -> Vec<T> {
        let [columns, rows, _] = self.counts;
        let rows = if self.is_section() { rows } else { 1 };
        let layers = section.chunks(columns);
        layers.flat_map(|layer| std::iter::repeat_n(layer, rows).flatten().copied()).collect()
    }

    fn is_section(&self) -> bool {
        self.along == IN_SECTION
    }

    /// Nodal values of the body's mesh at the nodes that crack: those of the first row along y of a section.
    fn gathered(&self, nodal: &[f64]) -> Vec<f64> {
        let [columns, rows, _] = self.counts;
        let rows = if self.is_section() { rows } else { 1 };
        nodal.chunks(columns * rows).flat_map(|layer| &layer[..columns]).copied().collect()
    }

    /// Forces on the nodes that crack from those on the nodes of the body's mesh [N].
    fn gathered_forces(&self, forces: &[f64]) -> Vec<f64> {
        if !self.is_section() {
            return forces.to_vec();
        }
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

    /// Displacement of the nodes of the body's mesh: that of a plane section is zero along y.
    fn displacement(&self, state: &DamageState) -> Vec<f64> {
        if !self.is_section() {
            return state.displacement.clone();
        }
        let in_section: Vec<[f64; 2]> =
            state.displacement.chunks(2).map(|own| [own[0], own[1]]).collect();
        let nodal = self.spread(&in_section);
        match self.width {
            Some(_) => nodal.into_iter().flat_map(|[x, z]| [x, 0.0, z]).collect(),
            None => nodal.into_flattened(),
        }
    }
}

/// Kinds of the sides along some axes of the mesh. Cracks along a face that is held begin elsewhere.
fn sides(plan: &Plan, along: &[usize]) -> Vec<[Side; 2]> {
    let mesh: &Mesh = &plan.mesh;
    let mut sides = [[Side::Face; 2]; 3];
    for (face, _) in &plan.supports {
        sides[face.axis][usize::from(face.high)] = Side::Held;
    }
    match mesh.geometry {
        Geometry::Axisymmetric => sides[0][0] = Side::Axis,
        Geometry::Box => {
            let mirrored = (0..2).filter(|&axis| mesh.mirrored[axis]);
            mirrored.for_each(|axis| sides[axis][0] = Side::Mirror);
        }
    }
    along.iter().map(|&axis| sides[axis]).collect()
}

/// Displacements along some axes of the mesh that supports, planes of symmetry and the axis hold.
fn held(plan: &Plan, along: &[usize]) -> Vec<bool> {
    let mesh: &Mesh = &plan.mesh;
    let counts: Vec<usize> = along.iter().map(|&axis| mesh.node_counts()[axis]).collect();
    let width = along.len();
    let mut held = vec![false; width * counts.iter().product::<usize>()];
    let mut hold = |axis: usize, high: bool, components: std::ops::Range<usize>| {
        let Some(own) = along.iter().position(|&other| other == axis) else { return };
        let stride: usize = counts[..own].iter().product();
        for (node, held) in held.chunks_exact_mut(width).enumerate() {
            if node / stride % counts[own] == if high { counts[own] - 1 } else { 0 } {
                held[components.clone()].fill(true);
            }
        }
    };
    let normal = |axis: usize| {
        let own = along.iter().position(|&other| other == axis).unwrap_or(0);
        own..own + 1
    };
    for (face, support) in &plan.supports {
        match support {
            Support::Clamped => hold(face.axis, face.high, 0..width),
            Support::Roller => hold(face.axis, face.high, normal(face.axis)),
        }
    }
    let is_axisymmetric = mesh.geometry == Geometry::Axisymmetric;
    for axis in (0..2).filter(|&axis| mesh.mirrored[axis] || axis == 0 && is_axisymmetric) {
        hold(axis, false, normal(axis));
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
        let (rise, forces) = self.loads_on_cracking(cracking, state, acts)?;
        let changes = rise.iter().zip(&mechanics.rise).map(|(new, old)| (new - old).abs());
        if halves == 0 || changes.fold(0.0, f64::max) <= cracking.most_change {
            let (mut order, loads) = (BreakingOrder::default(), (&rise[..], &forces[..]));
            let advanced = cracking.problem.advance(&mut mechanics, loads, allowance, &mut order);
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

    /// Temperatures above the stress-free one [K] and forces [N] at the nodes that crack at the end of a step.
    fn loads_on_cracking(
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
        self.require_even(&temperatures)?;
        let thermal = self.solid.above_stress_free(temperatures);
        let rise = match thermal[0].is_empty() {
            true => vec![0.0; cracking.nodes()],
            false => cracking.gathered(&thermal[0]),
        };
        Ok((rise, cracking.gathered_forces(&self.nodal_forces(&loads)?)))
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
        let remembered = Remembered::elastic(cracking.spread(&cracking.problem.stress(&state)));
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
        let law = cracking.problem.law();
        let nodes = match law.dissipation {
            Dissipation::At1 => cracking.problem.away_from_broken(damage, REACH * law.length),
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
        cracking.problem.opening(&own[displacement], &own[damage])
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

    /// Place of the first crack along an axis: x, or the radius, in space y, and z [m]; zero before it, and without
    /// cracks.
    pub(super) fn place_of_first_crack(&self, state: &[f64], axis: usize) -> f64 {
        let Some(cracking) = &self.cracking else { return 0.0 };
        let own = cracking.along.iter().position(|&other| other == axis);
        own.map_or(0.0, |own| cracking.place_of_first(self.mechanics_of(state))[own])
    }

    /// Returns true if a crack of the later state is not part of one of the earlier.
    pub(super) fn has_new_crack(&self, before: &[f64], after: &[f64]) -> bool {
        let Some(cracking) = &self.cracking else { return false };
        let [_, damage, _] = cracking.places();
        let [before, after] = [before, after].map(|own| &self.mechanics_of(own)[damage.clone()]);
        cracking.problem.has_new_crack(before, after)
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
        cracking.copies * self.mechanics_of(state)[cracking.work_at()]
    }

    /// Area of notches and cracks, and that of notches [m²]; zero without cracks.
    pub(super) fn areas_of_cracks(&self, state: &[f64], memo: &mut SolidMemo) -> [f64; 2] {
        let Some(cracking) = &self.cracking else { return [0.0; 2] };
        let by_energy = self.energies(state, memo).dissipated / cracking.problem.law().energy;
        let Some(notched) = &cracking.notched else { return [by_energy, 0.0] };
        let [_, damage, _] = cracking.places();
        let damage = &self.mechanics_of(state)[damage];
        [notched.area_of_cracks(damage, by_energy), notched.area]
    }

    /// Width of a plane section that cracks [m].
    pub(super) fn width_of_section(&self) -> Option<f64> {
        self.cracking.as_ref()?.width
    }
}
