//! Solids reduced to some tens of unknowns, with an error bound.
//!
//! The full solid is built once to be reduced (`build`), unless its reduction is stored (`store`). The reduced
//! equations are scalar and advance exactly. The state holds their unknowns, the supplied heat, and the largest size of
//! each drive so far: the reported bound applies to the inputs that occurred.

mod build;
mod drives;
mod forecast;
mod linear;
mod notes;
mod store;
mod totals;
mod values;

pub use forecast::forecast;
pub use store::{KeptReduction, forget_unused_reductions, keep_reduction};
pub use totals::offered_totals;

use std::any::Any;
use std::sync::Arc;

use super::solid::{BodyLoads, Measure, Sampling, plan};
use super::{
    Acts, Body, BodyError, Direct, Fields, Given, Linear, Memo, Reading, Received, point_quantities,
};
use crate::body::{Advice, Approach, Events, Giver, Maxima, Resources};
use crate::inputs::{InputLayout, InputPath};
use crate::method::fem::NodalFields;
use crate::method::reduced::ReducedSystem;
use crate::runtime::allowance::Allowance;
use crate::scene::{Scene, Solid, footprints_along};
use crate::state::{Field, Layout, Per};
use crate::warning::Warning;
use build::Full;
use drives::Drives;
use totals::{Total, total};
use values::{Kind, Values};

/// Reduction of a full solid.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Reduction {
    pub system: ReducedSystem,
    /// Value of each output without drives and stored heat.
    pub offsets: Vec<f64>,
    /// Error bound of each output over its range in the default experiment.
    pub errors: Vec<f64>,
    /// Heat flow supplied by a unit of each drive [W].
    pub brought: Vec<f64>,
    /// Modes of the full solid.
    pub modes: usize,
}

/// A reduced solid, with the scene's data that concern it.
pub struct ReducedBody {
    name: String,
    loads: BodyLoads,
    drives: Drives,
    values: Values,
    kinds: Vec<Kind>,
    reduction: Arc<Reduction>,
    /// Initial sizes of the amounts of the drives, wherever their footprints are.
    start: Vec<f64>,
    /// Tolerance of the scene.
    tolerance: f64,
    /// Resolved time of the full solid [s].
    resolved_from: f64,
}

/// The row of heat stored.
const STORED: usize = 0;
/// Share by which unknowns may exceed their bound due to rounding.
const SLACK: f64 = 1e-6;
/// Share of a length by which a place may deviate from another.
const ROUNDING: f64 = 1e-9;

/// Values of the drives, or their rates of change.
struct ReducedMemo {
    drives: Vec<f64>,
    /// True if an input changes that the model holds constant.
    moves_what_is_held: bool,
}

impl ReducedBody {
    pub fn new(
        scene: &Scene,
        layout: &InputLayout,
        (name, solid): (&str, &Solid),
        start: &[f64],
        threads: usize,
    ) -> Result<Self, BodyError> {
        let drives = Drives::of(scene, layout, name, footprints_along);
        let values = Values::of(scene, name);
        let reduction = store::known(scene, name, || {
            let full = Full::new(scene, layout, (name, solid), start, &drives, threads)?;
            full.reduce(&values, &drives, start)
        })?;
        reduction.fits(name, [drives.list.len(), values.list.len()])?;
        let plan = plan(scene, name, solid);
        let loads = BodyLoads::of(scene, layout, (name, solid.shape), &plan);
        Ok(Self {
            name: name.into(),
            loads,
            start: drives.amounts(start),
            drives,
            kinds: values.kinds().collect(),
            values,
            reduction,
            tolerance: scene.fidelity.tolerance,
            resolved_from: plan.resolved_from,
        })
    }

    fn system(&self) -> &ReducedSystem {
        &self.reduction.system
    }

    /// Places in a state of the heat stored directly by the drives, of the supplied heat, and of the first size.
    fn places(&self) -> [usize; 3] {
        let order = self.system().order();
        [order, order + 1, order + 2]
    }

    fn len(&self) -> usize {
        self.system().order() + 2 + self.system().inputs
    }

    fn unknowns<'s>(&self, state: &'s [f64]) -> &'s [f64] {
        &state[..self.system().order()]
    }

    /// An output, including the direct effect of the drives.
    fn output(&self, state: &[f64], drives: &[f64], place: usize) -> f64 {
        let value = self.system().output(self.unknowns(state), drives, place);
        self.reduction.offsets[place] + value
    }

    /// Heat stored at the end of the last step.
    fn stored(&self, state: &[f64]) -> f64 {
        let order = self.system().order();
        self.system().from_unknowns(&state[..order], STORED) + state[order]
    }

    /// Largest error bound of the values of a kind, and the place of a value with that bound.
    fn bound(&self, sizes: &[f64], kind: Kind) -> Option<(usize, f64)> {
        let places = self.kinds.iter().enumerate().filter(|(_, own)| **own == kind);
        let bounds = places.map(|(place, _)| (place, self.system().bound(sizes, place)));
        bounds.max_by(|a, b| a.1.total_cmp(&b.1))
    }

    /// Largest sizes of the drives so far, among them the present ones.
    fn sizes(&self, state: &[f64], drives: &[f64]) -> Vec<f64> {
        let [.., first] = self.places();
        let mut sizes = state[first..].to_vec();
        note_sizes(&mut sizes, drives);
        sizes
    }

    fn total(&self, state: &[f64], drives: &[f64], place: usize) -> f64 {
        let [_, brought, _] = self.places();
        match total(place) {
            Total::HeatIn => state[brought],
            Total::HeatStored => self.stored(state),
            Total::HeatLost => state[brought] - self.stored(state),
            Total::Bound(kind) => {
                self.bound(&self.sizes(state, drives), kind).map_or(0.0, |(_, bound)| bound)
            }
        }
    }

    /// Value of a measure; `value` returns that of each row.
    fn measure(&self, (quantity, at): (usize, [f64; 3]), value: impl Fn(usize) -> f64) -> Measured {
        let rows = self.values.rows_at(at);
        let known = "rows are made for all that is registered";
        let stress = || {
            let first = rows.stress.expect(known);
            std::array::from_fn(|slot| value(first + slot))
        };
        match point_quantities()[quantity].measure {
            Measure::Temperature => Measured::Plain(value(rows.temperature.expect(known))),
            Measure::Displacement(axis) => {
                Measured::Plain(value(rows.displacement.expect(known) + axis))
            }
            Measure::Stress(slot) => Measured::Plain(value(rows.stress.expect(known) + slot)),
            Measure::OfStress(measure, rate) => Measured::Stress(measure, rate, stress()),
            Measure::PlasticStrain => panic!("nothing yields in a reduced model"),
            Measure::Damage => panic!("nothing cracks in a reduced model"),
            Measure::FailureDensity(_) => panic!("nothing has flaws in a reduced model"),
        }
    }

    /// Advances under drives that are polynomials in time, as values at the beginning followed by derivatives.
    fn advance_part(&self, state: &mut [f64], drives: &[&[f64]], dt: f64) {
        let [held, brought, sizes] = self.places();
        self.system().advance(&mut state[..held], drives, dt);
        let (mut end, mut weight) = (vec![0.0; self.system().inputs], 1.0);
        for (k, list) in drives.iter().enumerate() {
            end.iter_mut().zip(*list).for_each(|(end, value)| *end += weight * value);
            weight *= dt / (k + 1) as f64;
            let flow: f64 = self.reduction.brought.iter().zip(*list).map(|(b, u)| b * u).sum();
            state[brought] += weight * flow;
        }
        state[held] = self.system().at_once(&end, STORED);
        for list in [drives[0], &end] {
            note_sizes(&mut state[sizes..], list);
        }
    }

    fn advance_along(
        &self,
        state: &mut [f64],
        (path, duration): (&InputPath, f64),
        allowance: &Allowance,
    ) -> Result<(), BodyError> {
        let sampling = Sampling::of(&self.loads, path, duration);
        let halted = |halt| BodyError::Halted { body: self.name.clone(), halt };
        let foreseen =
            allowance.foresee(sampling.count(), "samples of moving footprints", state.len());
        foreseen.map_err(halted)?;
        let [.., sizes] = self.places();
        for s in path.turns(duration) {
            note_sizes(&mut state[sizes..], &self.drives.values(&path.at(0, s)));
        }
        let at = |s: f64| {
            let inputs = path.at(0, s);
            self.check_inputs(&inputs).map_err(|error| error.underway(s))?;
            Ok::<_, BodyError>(self.drives.values(&inputs))
        };
        let mut first = at(0.0)?;
        for part in sampling.parts() {
            let h = part.duration;
            let [middle, last] = [at(part.middle)?, at(part.end)?];
            let sum = |weights: [f64; 3]| -> Vec<f64> {
                let samples = first.iter().zip(&middle).zip(&last);
                samples
                    .map(|((a, b), c)| weights[0] * a + weights[1] * b + weights[2] * c)
                    .collect()
            };
            let slope = sum([-3.0 / h, 4.0 / h, -1.0 / h]);
            let bend = sum([4.0, -8.0, 4.0].map(|weight| weight / (h * h)));
            self.advance_part(state, &[&first, &slope, &bend], h);
            first = last;
        }
        Ok(())
    }

    /// Refuses unknowns that are not numbers, and temperatures that are not above absolute zero while heat is
    /// extracted.
    fn check_end(&self, state: &[f64], start: &[f64], end: &[f64]) -> Result<(), BodyError> {
        if !state.iter().all(|value| value.is_finite()) {
            return Err(BodyError::Overflow { body: self.name.clone() });
        }
        if !self.loads.draws_heat(start) && !self.loads.draws_heat(end) {
            return Ok(());
        }
        let drives = self.drives.values(end);
        let places = (0..self.kinds.len()).filter(|&place| self.kinds[place] == Kind::Temperature);
        let least =
            places.map(|place| self.output(state, &drives, place)).fold(f64::INFINITY, f64::min);
        match least <= 0.0 {
            true => {
                Err(BodyError::BelowAbsoluteZero { body: self.name.clone(), temperature: least })
            }
            false => Ok(()),
        }
    }
}

/// A value at a point: a plain component, or a measure of stress with its rate.
enum Measured {
    Plain(f64),
    Stress(fn([f64; 6]) -> f64, fn([f64; 6], [f64; 6]) -> f64, [f64; 6]),
}

/// Keeps the larger of earlier and present sizes.
fn note_sizes(sizes: &mut [f64], drives: &[f64]) {
    sizes.iter_mut().zip(drives).for_each(|(size, drive)| *size = size.max(drive.abs()));
}

fn drives_of(memo: &Memo) -> &[f64] {
    &reduced(memo).drives
}

fn reduced(memo: &Memo) -> &ReducedMemo {
    let memo: &(dyn Any + Send + Sync) = memo.as_ref();
    memo.downcast_ref().expect("a memo is that of the body that made it")
}

impl Body for ReducedBody {
    fn name(&self) -> &str {
        &self.name
    }

    fn initial_state(&self) -> Vec<f64> {
        vec![0.0; self.len()]
    }

    fn layout(&self, state: &[f64]) -> Option<Layout> {
        let field = |name, words, per| Field { name, words, per, width: 1 };
        let layout = Layout::default()
            .with(
                field("amplitude", "unknown of a reduced model", Per::Mode),
                self.system().order(),
            )
            .with(field("held", "heat that face values hold at once [J]", Per::Body), 1)
            .with(field("brought_in", "heat brought in since time zero [J]", Per::Body), 1)
            .with(
                field("size", "largest size of a load or face value so far", Per::Face),
                self.system().inputs,
            );
        Some(layout).filter(|layout| layout.len() == state.len())
    }

    fn check_state(&self, state: &[f64], _inputs: &[f64]) -> Result<(), String> {
        let (name, wanted) = (&self.name, self.len());
        if state.len() != wanted {
            return Err(format!("{} unknowns of {name}; this body has {wanted}", state.len()));
        }
        let [_, _, first] = self.places();
        let sizes = &state[first..];
        if let Some(size) = sizes.iter().find(|size| **size < 0.0) {
            return Err(format!("{size} as the largest size of a load of {name}"));
        }
        let bounds = self.system().reach(sizes);
        for (place, (unknown, bound)) in state.iter().zip(bounds).enumerate() {
            if unknown.abs() > bound * (1.0 + SLACK) {
                return Err(format!(
                    "{unknown} as unknown {place} of {name}, which the loads that it had cannot \
                     bring beyond {bound:e}"
                ));
            }
        }
        Ok(())
    }

    fn check_inputs(&self, inputs: &[f64]) -> Result<(), BodyError> {
        self.loads.check(inputs)?;
        for (index, start, load) in &self.drives.fixed {
            let value = inputs[*index];
            if (value - start).abs() > ROUNDING * start.abs().max(f64::MIN_POSITIVE) {
                let message = format!(
                    "{value} m moves {load}, whose footprint a reduced model holds at {start} m (allowed: that, a \
                     `range` of the load in the scene, or fidelity full)"
                );
                return Err(BodyError::Input { index: *index, message });
            }
        }
        Ok(())
    }

    fn memo(&self, inputs: &[f64], _: &[Received]) -> Memo {
        Box::new(ReducedMemo { drives: self.drives.values(inputs), moves_what_is_held: false })
    }

    fn advance(
        &self,
        state: &mut Vec<f64>,
        memo: &Memo,
        acts: &Acts,
        allowance: &Allowance,
    ) -> Result<Option<Given>, BodyError> {
        if acts.path.is_held() {
            self.advance_part(state, &[drives_of(memo)], acts.duration);
            self.check_end(state, acts.path.start(), acts.path.start())?;
            return Ok(None);
        }
        self.advance_along(state, (acts.path, acts.duration), allowance)?;
        self.check_end(state, acts.path.start(), &acts.path.at(0, acts.duration))?;
        Ok(None)
    }

    fn read(&self, state: &[f64], memo: &mut Memo, reading: &Reading) -> Result<f64, BodyError> {
        let drives = drives_of(memo);
        let value = |place: usize| self.output(state, drives, place);
        Ok(match *reading {
            Reading::Point { quantity, at, .. } => match self.measure((quantity, at), value) {
                Measured::Plain(value) => value,
                Measured::Stress(measure, _, stress) => measure(stress),
            },
            Reading::Mean { field, cell, .. } => value(self.values.mean(field, cell)),
            Reading::Total(place) => self.total(state, drives, place),
            Reading::Peak { .. } | Reading::Flaw { .. } | Reading::Cell { .. } | Reading::Error => {
                // It has neither running maxima nor flaws nor a wall, and its bounds report its error.
                return Err(BodyError::NoSuchReading);
            }
        })
    }

    fn follows_at_once(&self, reading: &Reading) -> bool {
        match *reading {
            Reading::Point { quantity, .. } | Reading::Mean { quantity, .. } => {
                point_quantities()[quantity].descriptor.direct != Direct::Nothing
            }
            Reading::Total(place) => matches!(total(place), Total::Bound(_)),
            _ => false,
        }
    }

    fn fields(&self, _: &[f64], _: &mut Memo) -> Result<Fields, BodyError> {
        Ok(Fields::Nodes(NodalFields::default()))
    }

    fn linear(&self) -> Option<&dyn Linear> {
        Some(self)
    }
}

impl Giver for ReducedBody {}

impl Events for ReducedBody {}

impl Maxima for ReducedBody {}

impl Approach for ReducedBody {}

impl Advice for ReducedBody {
    fn notes(&self) -> Vec<String> {
        self.own_notes()
    }

    fn resolved_from(&self) -> f64 {
        self.resolved_from
    }

    fn beyond_tolerance(&self, remedy: &str) -> Option<Warning> {
        Some(self.finding_beyond_tolerance(remedy)?.at(&self.name))
    }
}

impl Resources for ReducedBody {
    fn reduction(&self) -> Option<KeptReduction> {
        Some(self.kept())
    }
}
