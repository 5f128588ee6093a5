//! The nonlinear heat of a body, its state and how that advances.

use super::body::{Body, Drive};
use super::setup::{Loads, Setup, SetupError};
use super::stage::Unsolved;
use super::step::{Outcome, Step};
use crate::method::heat_totals::HeatTotals;
use crate::runtime::allowance::{Allowance, Halt};

/// What a step aims at, in parts of the error allowed; and how much the next one may be shorter or longer.
const AIM: f64 = 0.9;
const SHRINK: f64 = 0.1;
const GROWTH: f64 = 4.0;
/// Part of its length that a step is given again where its systems could not be solved.
const RETREAT: f64 = 0.25;
/// Part of a communication step below which inner steps are given up: the time would not go on.
const SHORTEST: f64 = 1e-16;
/// Change of temperature that a first step is made for, in tolerances.
const FIRST: f64 = 10.0;
/// Numbers a node that a problem and a step of it hold at once.
const VECTORS: f64 = 65.0;

/// Entries of the state after the nodes' enthalpies.
const STEP: usize = 0;
const COUNT: usize = 1;
const INITIAL: usize = 2;
const EXTRA: usize = 5;

/// The nonlinear heat problem of a body: everything known before time starts.
///
/// Its state is a vector: for each node, x running fastest, then y, then the levels along z, the volumetric enthalpy
/// above that of the solid at the reference temperature [J/m³]; then the length of the next inner step [s], zero before
/// the first; the number of inner steps made; the heat of the body at time zero above that at the reference; the heat
/// brought in and the heat lost since then [J]. At a contact two levels stand at one height, the lower side's first.
pub struct EnthalpyHeat {
    body: Body,
}

/// Why a state could not be advanced; it is as it was before.
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
    /// Memory [bytes] that a problem and a step of it take at most, about, for numbers of nodes along x and y and of
    /// levels along z.
    pub fn expected_bytes(counts: [usize; 3]) -> f64 {
        let [x, y, z] = counts.map(|count| count as f64);
        // An eigenproblem takes its matrix, its vectors and what they are made in.
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

    /// State of a body at one temperature [K]; solid, where that is the one at which it melts.
    pub fn initial_state(&self, temperature: f64) -> Vec<f64> {
        self.initial_state_of(&vec![temperature; self.nodes()])
    }

    /// State of a body whose nodes have temperatures [K].
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
    /// `tolerance` [K] is what an inner step may err by at any node, as far as its estimate tells: enthalpy over the
    /// heat capacity without melting.
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
                // No rest that is short beside the steps before it.
                long if long >= left * (1.0 - 1e-9) => left,
                long if 2.0 * long > left => 0.5 * left,
                short => short,
            };
            let step = Step { body: &self.body, loads, start: time, length, tolerance, allowance };
            let (outcome, taken) = attempt(step, &contents, shortest)?;
            time = if taken == left { dt } else { time + taken };
            // What has just been too long is so again.
            let growth = if taken < length { 1.0 } else { GROWTH };
            let next = taken * factor(outcome.error).min(growth);
            // A step that the end has cut short says little about the next one.
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

    /// Time in which what flows at the beginning changes temperatures by some tolerances.
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

    /// Part of what melts at a node that is liquid: 0 where nothing melts.
    pub fn liquid_fractions(&self, state: &[f64]) -> Vec<f64> {
        self.each(state, |node, content| {
            let law = self.body.law(node);
            let latent = law.latent();
            if latent > 0.0 { (law.at(content).latent / latent).clamp(0.0, 1.0) } else { 0.0 }
        })
    }

    /// Volume that each node stands for, of the mesh [m³].
    pub fn volumes(&self) -> &[f64] {
        &self.body.volumes
    }

    /// Heat stored since time zero [J].
    pub fn stored(&self, state: &[f64]) -> f64 {
        let (contents, extra) = state.split_at(self.nodes());
        self.heat(contents) - extra[INITIAL]
    }

    /// Heat that has passed since time zero [J]; what prescribed temperatures take is lost.
    pub fn totals(&self, state: &[f64]) -> HeatTotals {
        HeatTotals::read(state)
    }

    /// Inner steps made since time zero.
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

/// Takes a step, or a shorter one that can be taken and is accurate enough, and tells its length.
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

/// How long the next step may be over one with an error: the estimate grows as the third power.
fn factor(error: f64) -> f64 {
    // An error that is no number is one that is too large.
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
