//! Warnings of a model: of its meshes and reductions, of steps, states and values, and of runs that end.

use super::{Model, State, tolerance};
use crate::body::{Occasion, Reading};
use crate::limits::number;
use crate::scene::FidelityLevel;
use crate::variables::{Output, Registry, Slot, Variable};
use crate::warning::{self, Warning};

/// Fraction of the resolved time of a mesh, and of the scene's step, below which a step is too short.
const SHORT: f64 = 0.5;
/// Share of the range of nodal temperatures by which the lowest may be too low beside a jump along one axis, of which
/// it is 2 − √3: `(2 − √3)/(3 − √3)`, rounded up.
const UNDERSHOOT: f64 = 0.212;
/// Fraction of the scene's step that rounding may leave.
const ROUNDING: f64 = 1e-9;

impl Model {
    /// Warns of bodies whose outputs have known errors beyond the tolerance.
    pub fn tolerance_warnings(&self) -> Vec<Warning> {
        let wanted = self.scene.fidelity.tolerance;
        let over = self.scene.refinement.iter().filter_map(|(name, mesh)| {
            let error = mesh.estimated_error.filter(|&error| error > wanted)?;
            let [error, wanted] = [error, wanted].map(tolerance::percent);
            Some(warning::outputs_beyond_tolerance(error, wanted).at(name))
        });
        over.chain(self.reduction_warnings()).collect()
    }

    /// Warns of reduced bodies whose bound does not keep the tolerance.
    pub fn reduction_warnings(&self) -> impl Iterator<Item = Warning> {
        let remedy = match self.scene.fidelity.level {
            FidelityLevel::Auto => "packed with these parameters, it takes the full model",
            _ => "`fidelity.level = \"full\"` keeps it, and \"auto\" takes that where it must",
        };
        self.bodies.iter().filter_map(move |body| body.beyond_tolerance(remedy))
    }

    /// Warns of a state after a step; the tests are quick.
    pub fn warnings(&self, state: &State) -> Vec<Warning> {
        let bodies = self.bodies.iter().zip(&state.bodies).enumerate();
        let extremes = bodies.filter_map(|(place, (body, unknowns))| {
            self.scene.substances_of(body.name()).next()?;
            let [lowest, highest] = body.temperature_range(unknowns, &state.inputs)?;
            let coldest = lowest + UNDERSHOOT * (highest - lowest);
            let ends = [(coldest, true), (highest, false)];
            Some(ends.map(|(value, is_cold)| self.warning_beyond(place, value, is_cold)))
        });
        let extremes = extremes.flatten().flatten();
        self.warnings_on(state, Occasion::Step).into_iter().chain(extremes).collect()
    }

    /// Warns of inputs that were set in response to the last step and contradict how it was computed; `before` are
    /// those at its beginning.
    pub fn warning_on_response(&self, state: &State, before: &[f64]) -> Option<Warning> {
        let occasion = Occasion::Response { before, now: &state.inputs };
        self.warnings_on(state, occasion).into_iter().next()
    }

    /// Warns of the state at the end of a run.
    pub fn closing_warnings(&self, state: &State) -> Vec<Warning> {
        self.warnings_on(state, Occasion::End)
    }

    fn warnings_on(&self, state: &State, occasion: Occasion) -> Vec<Warning> {
        let bodies = self.bodies.iter().zip(&state.bodies);
        bodies.flat_map(|(body, unknowns)| body.warnings(unknowns, occasion)).collect()
    }

    /// Warns of a step of `dt` [s] that is much shorter than the step for which the meshes were chosen.
    pub fn warning_on_step(&self, dt: f64) -> Option<Warning> {
        let asked = self.scene.step;
        // The remainder of a run may be as short as rounding.
        if dt >= SHORT * asked || dt < ROUNDING * asked {
            return None;
        }
        let body = self.bodies.iter().find(|body| dt < SHORT * body.resolved_from())?;
        let [step, resolved] = [dt, body.resolved_from()].map(|time| format!("{time:.1e}"));
        let finding = warning::step_shorter_than_mesh_resolves(step, resolved, number(asked));
        Some(finding.at(body.name()))
    }

    /// Warns of an output's value.
    pub fn warning_on_value(&self, output: &Output, value: f64) -> Option<Warning> {
        self.bodies[output.body].warning_on_value(&output.reading, value)
    }

    /// Warns of a temperature that is read in a solid and is above the range of the substances that it consists of [K].
    /// Those below are [`Self::warnings`] of a state, as a point beside a jump may be colder than its surroundings.
    pub fn warning_on_temperature(&self, body: usize, value: f64) -> Option<Warning> {
        self.warning_beyond(body, value, false)
    }

    /// Warns of a temperature below the range, or above it.
    fn warning_beyond(&self, body: usize, value: f64, is_cold: bool) -> Option<Warning> {
        let name = self.bodies[body].name();
        let beyond = self.scene.beyond_substance(name, value)?;
        if beyond.is_cold != is_cold {
            return None;
        }
        let melting = beyond.unmelted.map_or(String::new(), |point| {
            format!(", and above the {point} K at which it melts: the model keeps it solid")
        });
        let (temperature, substance) = (format!("{value:.0}"), beyond.substance);
        let end = match beyond.is_cold {
            true => format!("below the {} K from", beyond.end),
            false => format!("above the {} K up to", beyond.end),
        };
        let needed = match beyond.unmelted {
            Some(_) => "constants that hold there, and with `melting`,",
            None => "constants that hold there",
        };
        let finding = warning::solid_beyond_substance(temperature, end, substance, melting, needed);
        let side = if beyond.is_cold { "below" } else { "beyond" };
        Some(finding.at(name).of_subject(format!("{name} {side} {substance}")))
    }

    /// Returns the outputs whose values may give rise to warnings, by name: totals of bodies, probes and flaws.
    pub fn watched_outputs(&self) -> impl Iterator<Item = (String, Output)> {
        let watched = |variable: Variable| match variable.slot {
            Slot::Output(output) => is_watched(&output.reading).then_some((variable.name, output)),
            _ => None,
        };
        Registry::of(&self.scene).variables.into_iter().filter_map(watched)
    }

    /// Warns of fluids in a state beyond the temperatures at which their constants hold, except on subjects that were
    /// already reported.
    pub fn phase_warnings(&self, state: &State, is_said: impl Fn(&str) -> bool) -> Vec<Warning> {
        let mut found = Vec::new();
        for (body, unknowns) in self.bodies.iter().zip(&state.bodies) {
            let Some(watch) = body.watch() else { continue };
            let is_open = |passage: &_| !is_said(&watch.subject(*passage));
            let wanted: Vec<_> = watch.passages().filter(is_open).collect();
            if wanted.is_empty() {
                continue;
            }
            let Some(places) = body.warm_places(unknowns) else { continue };
            let warning = |passage| watch.warning(passage, places, state.time);
            found.extend(wanted.into_iter().filter_map(warning));
        }
        found
    }

    /// Returns true if a fluid has points to watch.
    pub fn watches_phases(&self) -> bool {
        self.bodies
            .iter()
            .any(|body| body.watch().is_some_and(|watch| watch.passages().count() > 0))
    }
}

fn is_watched(reading: &Reading) -> bool {
    matches!(reading, Reading::Total(_) | Reading::Point { alone: true, .. } | Reading::Flaw { .. })
}
