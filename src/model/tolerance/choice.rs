//! Meshes that keep a tolerance: the usual mesh, refined where estimates require it.

use std::collections::BTreeMap;

use super::estimate::{Estimate, OutputError, differences};
use super::experiment::experiments;
use super::order::{Finer, LINEAR, OF_HISTORY, Order};
use super::responses::{Responses, Watched, responses, watched};
use super::twin::{Physics, Twin};
use crate::body::{BodyForecast, Reading, forecast};
use crate::model::{ModelError, check_memory};
use crate::quantity::Quantity;
use crate::scene::{Scene, Shape, Solid, takes_newton};
use crate::variables::{Registry, Slot};

/// Levels of fineness along the surface and through the thickness. Each level has √2 times as many elements as the one
/// before; level 0 is the usual mesh.
pub type Levels = [i32; 2];

/// Largest number of nodes, times experiments, of trial meshes: for heat, and for stress in sections, in boxes of one
/// material, and in boxes of layers, whose stress takes many times as long.
const MOST_NODES: f64 = 2.5e5;
const MOST_NODES_OF_SECTIONS: f64 = 3e4;
const MOST_NODES_OF_BOXES: f64 = 5e4;
const MOST_NODES_OF_LAYERS: f64 = 1.2e4;
/// The same limit for bodies with history-dependent stress, and the fraction of it for bodies that creep: each moment
/// needs Newton's method, and creep many inner steps.
const MOST_NODES_WITH_HISTORY: f64 = 4e3;
const PART_OF_CREEP: f64 = 0.25;
/// Fraction of these limits for meshes far finer than the one to be judged, which reveal coarse ones.
const FEW: f64 = 0.15;
/// Largest number of nodes along any axis: all modes along it are computed, at a cost of the cube of their number.
const MOST_ALONG: usize = 1000;
/// Largest number of nodes of meshes for stress that are used without a trial, and levels beyond the last trial.
const MOST_NODES_UNTRIED: f64 = 1.5e5;
const BEYOND: i32 = 4;
/// Finest level.
const FINEST: i32 = 10;
/// Coarsest level whose error a finer mesh estimates.
pub const COARSEST_TRIED: i32 = -8;
/// Largest number of meshes tried after the first.
const MOST_TRIALS: usize = 16;
/// Tolerance that usual meshes keep in most cases.
const USUAL: f64 = 1e-2;
/// Convergence orders in the number of elements, of quadratic elements and of bodies that melt or yield.
const ORDER: f64 = 3.0;
const ORDER_OF_NONLINEAR: f64 = 2.0;
/// Safety factor on errors of stress estimated from coarser meshes: they decrease less evenly than those of
/// temperature.
const UNEVEN_STRESS: f64 = 1.15;
/// Largest error of linear elements with nodal quadrature, which nonlinear heat uses, over that of the twin's elements;
/// ratios of 1.7 for temperature and 2.7 for stress were measured.
const INTEGRALS_AT_NODES: f64 = 3.0;
/// Levels from the empirical law without an estimate.
const LAW: [i32; 2] = [-3, 4];
/// Scatter of a front in a column of level 0, over its depth. It is a tenth of the local node spacing, which is a fifth
/// of the depth and more, as elements grow with depth.
const FRONT: f64 = 0.03;

/// Returns the numbers of elements over the usual ones.
pub fn factors(levels: Levels) -> [f64; 2] {
    levels.map(|level| 2f64.powf(0.5 * f64::from(level)))
}

/// A mesh for a tolerance.
#[derive(Debug, Clone, PartialEq)]
pub struct Choice {
    pub factors: [f64; 2],
    /// Largest error of the outputs that were estimated.
    pub error: Option<f64>,
}

/// Returns whether the scene leaves the mesh of a solid to be chosen, along its surface and through its thickness. That
/// of bodies that crack follows from the length of damage.
pub fn open(solid: &Solid) -> [bool; 2] {
    let keys = &solid.mesh;
    if solid.cracks() {
        return [false; 2];
    }
    [keys.spacing.is_none(), keys.spacing.is_none() && keys.depth_spacing.is_none()]
}

/// Returns true if the mesh of a scene's solid is chosen.
pub fn is_chosen(scene: &Scene, name: &str) -> bool {
    let is_open = |solid: &Solid| open(solid) != [false; 2];
    !scene.refinement.contains_key(name) && scene.meshed(name).is_some_and(is_open)
}

/// Chooses the mesh of a scene's solid if the scene does not set it.
pub fn choose(scene: &Scene, name: &str) -> Choice {
    let Some(solid) = scene.meshed(name) else { return Choice { factors: [1.0; 2], error: None } };
    let open = open(solid);
    let tolerance = scene.fidelity.tolerance;
    let law = |order: f64| {
        let level = (2.0 * (USUAL / tolerance).log2() / order).round() as i32;
        open.map(|is_open| if is_open { level.clamp(LAW[0], LAW[1]) } else { 0 })
    };
    if let Some(order) = order_of_law(scene, name, solid) {
        let [along, through] = law(order);
        let of_front =
            if is_melting_column(scene, name, solid) { level_of_front(tolerance) } else { through };
        let through = if open[1] { through.max(of_front) } else { through };
        return Choice { factors: factors([along, through]), error: None };
    }
    let start = first_levels(tolerance, open);
    let Some(heat) = Twin::of(scene, name, Physics::Heat) else {
        return Choice { factors: factors(law(ORDER)), error: None };
    };
    let mut trials = Trials::new(&heat, Physics::Heat);
    if trials.is_idle() {
        return Choice { factors: factors(law(ORDER)), error: None };
    }
    let (mut levels, mut error) = search(&mut trials, start, open, tolerance);
    if scene.gives_mechanics(name)
        && let Some(twin) = Twin::of(scene, name, Physics::Deformation)
    {
        let mut trials = Trials::new(&twin, Physics::Deformation);
        let of_stress;
        (levels, of_stress) = search(&mut trials, levels, open, tolerance);
        // Beyond trial meshes, errors are assumed to decrease with second order: by a half with each level.
        let (mut left, mut beyond) = (of_stress.unwrap_or(0.0), 0);
        while left > tolerance && beyond < BEYOND {
            let next = [0, 1].map(|way| levels[way] + i32::from(open[way]));
            if trials.nodes(next) > MOST_NODES_UNTRIED {
                break;
            }
            (levels, left, beyond) = (next, 0.5 * left, beyond + 1);
        }
        error = error.zip(of_stress.map(|_| left)).map(|(a, b)| a.max(b));
    }
    Choice { factors: factors(levels), error }
}

/// Levels at which the search begins; coarser meshes never kept a tolerance in sixty random scenes.
pub fn first_levels(tolerance: f64, open: [bool; 2]) -> Levels {
    let level = (FIRST - 2.0 * (tolerance / USUAL).log10()).round() as i32;
    open.map(|is_open| if is_open { level.clamp(-6, 0) } else { 0 })
}

/// Level at which the search for the usual tolerance begins.
const FIRST: f64 = -3.0;

/// Order of the empirical law, for bodies whose trial meshes would be too expensive.
fn order_of_law(scene: &Scene, name: &str, solid: &Solid) -> Option<f64> {
    let is_nonlinear = takes_newton(scene, solid) || !solid.deforms_linearly();
    let touches = scene.coupling.iter().any(|coupling| {
        let of = |place: &str| place.rsplit_once('.').is_some_and(|(body, _)| body == name);
        of(&coupling.from) || of(&coupling.to)
    });
    if is_nonlinear {
        Some(ORDER_OF_NONLINEAR)
    } else if touches || is_layered_box(solid) {
        Some(ORDER)
    } else {
        None
    }
}

/// Returns true if a front crosses all of a column at once, so that its position between nodes does not average out.
fn is_melting_column(scene: &Scene, name: &str, solid: &Solid) -> bool {
    let across = || {
        let bodies = forecast(scene).bodies;
        bodies.into_iter().find(|body| body.name == name).map(|body| (body.nodes, body.order))
    };
    solid.melts() && across().is_some_and(|([x, y, _], order)| x.max(y) <= order + 1)
}

/// Level through the thickness on which the scatter of a front is within a tolerance, as node spacings decrease. Beyond
/// the highest level of the law, inner steps take too long, because nodes melt one after another.
fn level_of_front(tolerance: f64) -> i32 {
    ((2.0 * (FRONT / tolerance).log2()).round() as i32).clamp(LAW[0], LAW[1])
}

fn is_layered_box(solid: &Solid) -> bool {
    solid.strata().len() > 1 && matches!(solid.shape, Shape::Box(_))
}

/// Experiments with a body on meshes of several levels, each computed once.
pub struct Trials<'a> {
    twin: &'a Twin,
    pub watched: Vec<Watched>,
    solved: BTreeMap<Levels, Responses>,
    most_nodes: f64,
    /// Safety factor on errors estimated from coarser meshes.
    margin: f64,
    order: &'static Order,
}

impl<'a> Trials<'a> {
    pub fn new(twin: &'a Twin, physics: Physics) -> Self {
        let is_mechanical = physics == Physics::Deformation;
        let solid = twin.solid();
        let most_nodes = match physics {
            Physics::Heat if is_layered_box(solid) => FEW * MOST_NODES,
            Physics::Heat => MOST_NODES,
            _ if is_layered_box(solid) => MOST_NODES_OF_LAYERS,
            _ if matches!(solid.shape, Shape::Box(_)) => MOST_NODES_OF_BOXES,
            _ => MOST_NODES_OF_SECTIONS,
        };
        let most_nodes = match twin.has_history {
            true => most_with_history(twin.solid()).min(most_nodes),
            false => most_nodes,
        };
        let mut watched = watched(twin.scene(), is_mechanical);
        let is_extreme = |one: &Watched| matches!(one.output.reading, Reading::Total(_));
        watched.retain(|one| twin.reads_extremes || !is_extreme(one));
        watched.retain(|one| !twin.has_drops || one.quantity != Quantity::Energy);
        watched.extend(flow_of(twin));
        let count = experiments(twin.scene()).len().max(1) as f64;
        let margin = if is_mechanical { UNEVEN_STRESS } else { 1.0 };
        let order = if twin.has_history { &OF_HISTORY } else { &LINEAR };
        Self {
            twin,
            watched,
            solved: BTreeMap::new(),
            most_nodes: most_nodes / count,
            margin,
            order,
        }
    }

    /// Returns true if nothing acts on the body alone.
    pub fn is_idle(&self) -> bool {
        experiments(self.twin.scene()).is_empty()
    }

    /// Returns true if no output can be estimated.
    pub fn is_blind(&self) -> bool {
        !self.watched.iter().any(is_estimated)
    }

    /// Returns true if the body flows under any of the inputs that were tried on a mesh.
    pub fn flows(&self, levels: Levels) -> bool {
        let marks = self.watched.iter().enumerate().filter(|(_, one)| !is_estimated(one));
        let solved = self.solved.get(&levels).into_iter().flatten().flatten();
        let mut marks = marks.flat_map(|(place, _)| solved.clone().map(move |row| row[place]));
        marks.any(|strain| strain > 0.0)
    }

    /// Returns true if a mesh is too large to be tried.
    pub fn is_too_large(&self, levels: Levels) -> bool {
        let bodies = self.bodies(levels);
        let along = bodies.iter().flat_map(|body| body.nodes).max().unwrap_or(0);
        along > MOST_ALONG || nodes_of(&bodies) > self.most_nodes
    }

    /// Number of nodes of a mesh.
    pub fn nodes(&self, levels: Levels) -> f64 {
        nodes_of(&self.bodies(levels))
    }

    /// Forecast of the twin on a mesh.
    fn bodies(&self, levels: Levels) -> Vec<BodyForecast> {
        forecast(&self.twin.on_mesh(factors(levels))).bodies
    }

    /// Returns true if a mesh has so few elements that the coarser level is equal; columns are exact along the surface.
    fn is_coarsest(&self, levels: Levels, coarser: Levels) -> bool {
        self.nodes(levels) == self.nodes(coarser)
    }

    /// Differences of outputs from those on another mesh.
    fn beside(&mut self, levels: Levels, other: Levels) -> Result<Vec<f64>, ModelError> {
        self.solve(other)?;
        Ok(differences(&self.solved[&levels], &self.solved[&other], &self.watched))
    }

    /// Errors of outputs from meshes that are finer along the surface or through the thickness. One finer mesh may
    /// itself be far too coarse, which a still finer one reveals. `None` if all of these are too large.
    fn beside_finer(&mut self, levels: Levels, way: usize) -> Result<Option<Vec<f64>>, ModelError> {
        let finer = |more: i32| {
            let mut finer = levels;
            finer[way] += more;
            finer
        };
        if self.nodes(finer(self.order.twice.0)) == self.nodes(levels) {
            return Ok(Some(vec![0.0; self.watched.len()]));
        }
        let of = |(more, factor): Finer, trials: &mut Self| {
            let found = trials.beside(levels, finer(more))?;
            Ok::<_, ModelError>(found.into_iter().map(|part| factor * part).collect::<Vec<f64>>())
        };
        if self.is_too_large(finer(self.order.twice.0)) {
            let is_too_large = self.is_too_large(finer(self.order.barely.0));
            return if is_too_large { Ok(None) } else { of(self.order.barely, self).map(Some) };
        }
        let mut errors = of(self.order.twice, self)?;
        for far in self.order.far {
            let mesh = finer(far.0);
            if self.is_too_large(mesh) || self.nodes(mesh) > FEW * self.most_nodes {
                break;
            }
            let found = of(far, self)?;
            errors.iter_mut().zip(found).for_each(|(error, found)| *error = error.max(found));
        }
        Ok(Some(errors))
    }

    fn solve(&mut self, levels: Levels) -> Result<(), ModelError> {
        if !self.solved.contains_key(&levels) {
            let scene = self.twin.on_mesh(factors(levels));
            check_memory(&scene, f64::INFINITY)?;
            let responses = responses(&scene, &self.watched)?;
            self.solved.insert(levels, responses);
        }
        Ok(())
    }

    /// Errors of outputs on a mesh, from differences to coarser ones, or to finer ones if the mesh cannot be made
    /// coarser.
    pub fn estimate(&mut self, levels: Levels) -> Result<Estimate, ModelError> {
        let parts = [self.part(levels, 0)?, self.part(levels, 1)?];
        let mut estimate = self.joined(parts);
        for one in &mut estimate.outputs {
            one.along *= self.margin;
            one.through *= self.margin;
        }
        Ok(estimate)
    }

    /// Errors from finer meshes, unless these are too large. A mesh may be so coarse that it and all coarser ones share
    /// the same error, or be accurate where those are not.
    pub fn judge(&mut self, levels: Levels) -> Result<Estimate, ModelError> {
        self.solve(levels)?;
        let mut parts = [Vec::new(), Vec::new()];
        for (way, part) in parts.iter_mut().enumerate() {
            *part = match self.beside_finer(levels, way)? {
                Some(found) => found,
                None => self.part(levels, way)?,
            };
        }
        Ok(self.joined(parts))
    }

    /// Errors of outputs along the surface (0) or through the thickness (1), from coarser meshes.
    fn part(&mut self, levels: Levels, way: usize) -> Result<Vec<f64>, ModelError> {
        let coarser = |less: i32| {
            let mut coarser = levels;
            coarser[way] -= less;
            coarser
        };
        self.solve(levels)?;
        if self.is_coarsest(levels, coarser(2))
            && let Some(found) = self.beside_finer(levels, way)?
        {
            return Ok(found);
        }
        let [first, second] = [self.beside(levels, coarser(1))?, self.beside(levels, coarser(2))?];
        Ok(self.order.by_coarser(way, &first, &second))
    }

    fn joined(&self, [along, through]: [Vec<f64>; 2]) -> Estimate {
        let outputs = self.watched.iter().zip(along.into_iter().zip(through));
        let more = if self.twin.linear_heat { INTEGRALS_AT_NODES } else { 1.0 };
        let error = |(one, (along, through)): (&Watched, (f64, f64))| OutputError {
            name: one.name.clone(),
            along: more * along,
            through: more * through,
        };
        let outputs = outputs.filter(|(one, _)| is_estimated(one));
        Estimate { outputs: outputs.map(error).collect() }
    }
}

/// Returns true if errors of an output are estimated; flow only shows whether there is any.
fn is_estimated(one: &Watched) -> bool {
    one.quantity != Quantity::Ratio
}

/// The largest plastic strain of a body with a history.
fn flow_of(twin: &Twin) -> Option<Watched> {
    let name = format!("{}.max_plastic_strain", twin.name());
    let variables = Registry::structured(twin.scene()).variables.into_iter();
    let found = variables.filter(|_| twin.has_history).find(|variable| variable.name == name)?;
    let Slot::Output(output) = found.slot else { return None };
    Some(Watched { name, quantity: Quantity::Ratio, rest: 0.0, capacity: None, output })
}

fn nodes_of(bodies: &[BodyForecast]) -> f64 {
    bodies.iter().map(|body| body.unknowns[0] as f64).sum()
}

/// Largest number of nodes of trials of a body with history-dependent stress.
fn most_with_history(solid: &Solid) -> f64 {
    let materials = solid.materials_of_layers();
    let creeps = materials.iter().any(|own| own.law.deformation().creeps());
    MOST_NODES_WITH_HISTORY * if creeps { PART_OF_CREEP } else { 1.0 }
}

/// First mesh, from some levels on, whose estimate keeps a tolerance, with the estimate if there is one.
pub fn search(
    trials: &mut Trials,
    start: Levels,
    open: [bool; 2],
    tolerance: f64,
) -> (Levels, Option<f64>) {
    let mut levels = start;
    let mut found = None;
    if trials.is_too_large(start) {
        return (start, None);
    }
    for _ in 0..=MOST_TRIALS {
        let Ok(estimate) = trials.estimate(levels) else { break };
        found = Some((levels, estimate.worst()));
        let wanted = next(&estimate, levels, open, tolerance);
        let Some(next) = wanted.into_iter().find(|next| !trials.is_too_large(*next)) else { break };
        levels = next;
    }
    match found {
        Some((levels, error)) => (levels, Some(error)),
        None => (start, None),
    }
}

/// Next meshes to try, in the order in which the first that is not too large is used; none if the tolerance is kept or
/// out of reach.
fn next(estimate: &Estimate, levels: Levels, open: [bool; 2], tolerance: f64) -> Vec<Levels> {
    if estimate.worst() <= tolerance {
        return Vec::new();
    }
    let over = [0, 1].map(|way| estimate.worst_of(way) / (0.5 * tolerance));
    let most = over[0].max(over[1]);
    let (mut far, mut near, mut least) = (levels, levels, levels);
    // None of these reduces the error of the other direction.
    for way in [0, 1].into_iter().filter(|&way| open[way] && over[way] > 1.0) {
        far[way] += if over[way] > FAR { 2 } else { 1 };
        near[way] += 1;
        least[way] += i32::from(over[way] == most);
    }
    let fits = |next: &Levels| *next != levels && next.iter().all(|level| *level <= FINEST);
    [far, near, least].into_iter().filter(fits).collect()
}

/// Error over the tolerance from which on meshes are refined twofold at once.
const FAR: f64 = 8.0;
