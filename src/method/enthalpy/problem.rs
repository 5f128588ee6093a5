//! Nonlinear heat problem of a body, its state and time integration.

use super::body::{Body, Drive};
use super::grid::Joint;
use super::setup::{Loads, Setup, SetupError};
use super::stage::Unsolved;
use super::step::{Outcome, Step};
use crate::method::heat_totals::HeatTotals;
use crate::runtime::allowance::{Allowance, Halt};

/// Target error of a step, as a fraction of the allowed one, and limits of the ratio of step lengths.
const AIM: f64 = 0.9;
const SHRINK: f64 = 0.1;
const GROWTH: f64 = 4.0;
/// Factor of the length at which a step is repeated if its systems could not be solved.
const RETREAT: f64 = 0.25;
/// Fraction of a communication step below which inner steps are abandoned: time would no longer advance.
const SHORTEST: f64 = 1e-16;
/// Temperature change of a first step, in tolerances.
const FIRST: f64 = 10.0;
/// Numbers per node that a problem and a step of it hold at once.
const VECTORS: f64 = 65.0;

/// Entries of the state after the nodes' enthalpies.
const STEP: usize = 0;
const COUNT: usize = 1;
const INITIAL: usize = 2;
const EXTRA: usize = 5;

/// Nonlinear heat problem of a body: everything known before time starts.
///
/// Its state is a vector. It begins with the volumetric enthalpy of each node above that of the solid at the reference
/// temperature [J/m³], with x running fastest, then y, then the levels along z. Then follow the length of the next
/// inner step [s], zero before the first; the number of inner steps made; the heat of the body at time zero above that
/// at the reference; and the heat supplied and lost since then [J]. At a contact two levels have equal height, with the
/// lower side first.
pub struct EnthalpyHeat {
    body: Body,
}

/// Reasons why a state could not be advanced; it is then unchanged.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum Failure {
    #[error(transparent)]
    Halted(#[from] Halt),
    #[error("nonlinear heat finds no solution even over {0:e} s")]
    Unsolved(f64),
    #[error("tolerance {0} K of nonlinear heat (allowed: finite, above 0)")]
    Tolerance(f64),
    #[error("step of {0} s (allowed: finite, 0 or above)")]
    Length(f64),
    #[error("{given} loads on faces or nodes of nonlinear heat (allowed: {allowed})")]
    Loads { given: usize, allowed: usize },
    #[error("a load or state of nonlinear heat that is no finite number: {0}")]
    NotFinite(f64),
}

impl EnthalpyHeat {
    /// Approximate upper bound of the memory [bytes] of a problem and a step of it, for numbers of nodes along x and y
    /// and of levels along z.
    pub fn expected_bytes(counts: [usize; 3]) -> f64 {
        let [x, y, z] = counts.map(|count| count as f64);
        // An eigenproblem needs its matrix, its vectors and their work space.
        8.0 * (VECTORS * x * y * z + 4.0 * (x * x + y * y))
    }

    pub fn new(setup: &Setup) -> Result<Self, SetupError> {
        setup.check()?;
        Ok(Self { body: Body::new(setup) })
    }

    /// Numbers of nodes along x and y, and of levels along z.
    pub fn node_counts(&self) -> [usize; 3] {
        let grid = &self.body.grid;
        [grid.sides[0].mass.len(), grid.sides[1].mass.len(), grid.levels.len()]
    }

    pub fn nodes(&self) -> usize {
        self.body.grid.nodes()
    }

    pub fn state_len(&self) -> usize {
        self.nodes() + EXTRA
    }

    /// Returns the state of a body at one temperature [K]; at the melting temperature it is solid.
    pub fn initial_state(&self, temperature: f64) -> Vec<f64> {
        self.initial_state_of(&vec![temperature; self.nodes()])
    }

    /// Returns the state of a body with these nodal temperatures [K].
    pub fn initial_state_of(&self, temperatures: &[f64]) -> Vec<f64> {
        let body = &self.body;
        let content = |(node, t): (usize, &f64)| body.law(node).content(t - body.reference);
        let mut state: Vec<f64> = temperatures.iter().enumerate().map(content).collect();
        let held = self.heat(&state);
        state.extend([0.0, 0.0, held, 0.0, 0.0]);
        state
    }

    /// Advances `state` by `dt` [s] under loads that are polynomials in time, at most quadratic: one entry of `loads`
    /// for their values at the beginning and one for each derivative.
    ///
    /// `tolerance` [K] limits the estimated error of an inner step at any node: enthalpy over the heat capacity without
    /// melting.
    pub fn advance(
        &self,
        state: &mut [f64],
        loads: &[Loads],
        dt: f64,
        tolerance: f64,
        allowance: &Allowance,
    ) -> Result<(), Failure> {
        self.check_loads(loads)?;
        check(state, loads, dt, tolerance)?;
        let (contents, extra) = state.split_at(self.nodes());
        let (mut contents, mut extra) = (contents.to_vec(), extra.to_vec());
        if extra[STEP] <= 0.0 {
            extra[STEP] = self.first_step(&contents, loads, dt, tolerance);
        }
        let shortest = (SHORTEST * dt).max(f64::MIN_POSITIVE);
        let mut time = 0.0;
        while time < dt {
            let left = dt - time;
            let wanted = extra[STEP].max(shortest);
            let length = match wanted {
                // Avoids a remainder that is short relative to the steps before it.
                long if long >= left * (1.0 - 1e-9) => left,
                long if 2.0 * long > left => 0.5 * left,
                short => short,
            };
            let step = Step { body: &self.body, loads, start: time, length, tolerance, allowance };
            let (outcome, taken) = attempt(step, &contents, shortest)?;
            time = if taken == left { dt } else { time + taken };
            // A length that was just too long is not tried again.
            let growth = if taken < length { 1.0 } else { GROWTH };
            let next = taken * factor(outcome.error).min(growth);
            // A step cut short by the end is no guide for the next one.
            let is_cut = taken == length && length < wanted && outcome.error <= 0.5;
            extra[STEP] = if is_cut { next.max(wanted) } else { next };
            extra[COUNT] += 1.0;
            outcome.passed.times(self.body.copies).add_to(&mut extra);
            contents = outcome.contents;
        }
        let nodes = self.nodes();
        state[..nodes].copy_from_slice(&contents);
        state[nodes..].copy_from_slice(&extra);
        Ok(())
    }

    fn check_loads(&self, loads: &[Loads]) -> Result<(), Failure> {
        let wrong = |given: usize, allowed: usize| match given == allowed {
            true => Ok(()),
            false => Err(Failure::Loads { given, allowed }),
        };
        let (faces, plane) = (self.body.faces.len(), self.body.grid.plane());
        if loads.is_empty() {
            return wrong(0, faces);
        }
        for load in loads {
            wrong(load.faces.len(), faces)?;
            for surface in load.surface.iter().filter(|surface| !surface.is_empty()) {
                wrong(surface.len(), plane)?;
            }
        }
        Ok(())
    }

    /// Time in which the initial heat flow changes temperatures by some tolerances.
    fn first_step(&self, contents: &[f64], loads: &[Loads], dt: f64, tolerance: f64) -> f64 {
        let body = &self.body;
        let drive = Drive::at(loads, 0.0);
        let mut contents = contents.to_vec();
        body.hold(&mut contents, &drive);
        let fields = body.fields(&contents);
        let flow = body.flow(&fields, &drive);
        let rate = |node: usize| {
            let capacity = body.volumes[node] * fields.sensible[node];
            if body.held[node] { 0.0 } else { (flow.nodes[node] / capacity).abs() }
        };
        let fastest = (0..contents.len()).map(rate).fold(0.0, f64::max);
        dt.min(FIRST * tolerance / fastest)
    }

    /// Temperature of every node [K].
    pub fn temperatures(&self, state: &[f64]) -> Vec<f64> {
        self.each(state, |node, content| self.body.reference + self.body.law(node).at(content).rise)
    }

    /// Volume at each node that can melt [m³], and the fraction of it that is liquid.
    pub fn liquid(&self, state: &[f64]) -> Vec<[f64; 2]> {
        let of_node = |(node, &content): (usize, &f64)| {
            let law = self.body.law(node);
            let part = law.melting_part();
            let fraction = if part > 0.0 { law.at(content).liquid / part } else { 0.0 };
            [part * self.body.volumes[node], fraction.clamp(0.0, 1.0)]
        };
        state[..self.nodes()].iter().enumerate().map(of_node).collect()
    }

    /// Pairs of nodes at the ends of an element along z.
    pub fn neighbours_along_z(&self) -> impl Iterator<Item = [usize; 2]> {
        let plane = self.body.grid.plane();
        let joints = self.body.grid.joints.iter().enumerate();
        let elements = joints.filter(|(_, joint)| matches!(joint, Joint::Element(_)));
        elements.flat_map(move |(level, _)| {
            (level * plane..(level + 1) * plane).map(move |node| [node, node + plane])
        })
    }

    /// Heat stored since time zero [J].
    pub fn stored(&self, state: &[f64]) -> f64 {
        let (contents, extra) = state.split_at(self.nodes());
        self.heat(contents) - extra[INITIAL]
    }

    /// Heat transferred since time zero [J]; heat absorbed by prescribed temperatures counts as lost.
    pub fn totals(&self, state: &[f64]) -> HeatTotals {
        HeatTotals::read(state)
    }

    /// Number of inner steps since time zero.
    pub fn steps(&self, state: &[f64]) -> f64 {
        state[self.nodes() + COUNT]
    }

    fn each(&self, state: &[f64], of: impl Fn(usize, f64) -> f64) -> Vec<f64> {
        state[..self.nodes()].iter().enumerate().map(|(node, h)| of(node, *h)).collect()
    }

    /// Heat of the body above that at the reference [J].
    fn heat(&self, contents: &[f64]) -> f64 {
        let sum: f64 = contents.iter().zip(&self.body.volumes).map(|(h, v)| h * v).sum();
        self.body.copies * sum
    }
}

/// Takes a step, or a shorter one that can be solved and is accurate enough; returns its length.
fn attempt(mut step: Step, contents: &[f64], shortest: f64) -> Result<(Outcome, f64), Failure> {
    loop {
        step.allowance.spend(1.0, "steps of nonlinear heat", contents.len())?;
        let change = match step.take(contents) {
            Ok(outcome) if outcome.error <= 1.0 => return Ok((outcome, step.length)),
            Ok(outcome) => factor(outcome.error),
            Err(Unsolved::Halted(halt)) => return Err(halt.into()),
            Err(Unsolved::Diverged) => RETREAT,
        };
        step.length *= change;
        if step.length.is_nan() || step.length < shortest {
            return Err(Failure::Unsolved(step.length));
        }
    }
}

/// Ratio of the next step's length to that of a step with an error: the estimate grows as the third power.
fn factor(error: f64) -> f64 {
    // NaN counts as too large an error.
    (AIM / error.cbrt()).max(SHRINK)
}

fn check(state: &[f64], loads: &[Loads], dt: f64, tolerance: f64) -> Result<(), Failure> {
    if !(tolerance > 0.0 && tolerance.is_finite()) {
        return Err(Failure::Tolerance(tolerance));
    }
    if !(dt >= 0.0 && dt.is_finite()) {
        return Err(Failure::Length(dt));
    }
    let driven = |load: &Loads| {
        let mut all = load.faces.iter().chain(load.surface.iter().flatten());
        all.find(|value| !value.is_finite()).copied()
    };
    let odd = state.iter().find(|value| !value.is_finite()).copied();
    match odd.or_else(|| loads.iter().find_map(driven)) {
        Some(odd) => Err(Failure::NotFinite(odd)),
        None => Ok(()),
    }
}
