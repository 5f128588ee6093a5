//! Reduces a solid.

use super::Reduction;
use super::drives::{Drive, DriveKind, Drives};
use super::values::{Kind, Value, Values};
use crate::body::BodyError;
use crate::body::solid::{BodyLoads, means_of, plan};
use crate::coupling::FaceMeans;
use crate::inputs::InputLayout;
use crate::math::exponential::weights as weights_of;
use crate::method::fem::{
    Component, HeatValue, Mesh, ModalRow, SolidFem, SolidLoads, SolidModes, heat_mesh,
};
use crate::method::reduced::{Clumped, Ranges, ReducedSystem, Request, Residues, integral};
use crate::scene::{Scene, Solid};

/// Smallest range that counts for an output, as a share of the largest range of all outputs of its kind.
const LEAST_RANGE: f64 = 0.01;

/// A full solid, with the drives of the model to be made.
pub struct Full<'a> {
    scene: &'a Scene,
    initial_temperature: f64,
    fem: SolidFem,
    meshes: [Mesh; 2],
    /// Kind of each drive, and the loads of a unit of it.
    drive_kinds: Vec<DriveKind>,
    columns: Vec<SolidLoads>,
    /// Loads of unit amounts on footprints between the supporting ones, and the drives that represent them.
    trials: Vec<(SolidLoads, Vec<f64>)>,
    /// For each symmetry class, whether any of these loads drives it.
    take: Vec<bool>,
    means: Vec<(usize, FaceMeans)>,
}

impl<'a> Full<'a> {
    pub fn new(
        scene: &'a Scene,
        layout: &InputLayout,
        (name, solid): (&str, &Solid),
        start: &[f64],
        drives: &Drives,
        threads: usize,
    ) -> Result<Self, BodyError> {
        let plan = plan(scene, name, solid);
        let fem = SolidFem::new(&plan, threads);
        let meshes = [heat_mesh(&plan), fem.mesh().clone()];
        let loads = BodyLoads::of(scene, layout, (name, solid.shape), &plan);
        let column = |drive: &Drive| {
            let mut inputs = start.to_vec();
            if let Some((family, member)) = drive.member {
                let family = &drives.families[family];
                for (index, place) in family.places.iter().zip(family.place(member)) {
                    if let (Some(index), Some(place)) = (index, place) {
                        inputs[*index] = place;
                    }
                }
            }
            let mut unit = vec![0.0; start.len()];
            unit[drive.index] = 1.0;
            loads.change(&inputs, &unit, meshes.each_ref())
        };
        let columns: Vec<SolidLoads> = drives.list.iter().map(column).collect();
        let trial = |(index, inputs): (usize, Vec<f64>)| {
            let mut unit = vec![0.0; start.len()];
            unit[index] = 1.0;
            let found = loads.change(&inputs, &unit, meshes.each_ref());
            (found, drives.values(&inputs))
        };
        let trials: Vec<(SolidLoads, Vec<f64>)> =
            drives.trials(start).into_iter().map(trial).collect();
        let modes = modes_of(&fem)?;
        let mut take = modes.driven_classes(&columns);
        for (loads, _) in &trials {
            let driven = modes.driven_classes(std::slice::from_ref(loads));
            take.iter_mut().zip(driven).for_each(|(take, driven)| *take |= driven);
        }
        let means = means_of(scene, (name, solid), meshes.each_ref());
        let initial_temperature = solid.initial_temperature;
        let drive_kinds = drives.list.iter().map(|drive| drive.kind).collect();
        Ok(Self {
            scene,
            initial_temperature,
            fem,
            meshes,
            drive_kinds,
            columns,
            trials,
            take,
            means,
        })
    }

    /// Computes the reduced model for inputs as large as those at the `start`.
    pub fn reduce(
        &self,
        values: &Values,
        drives: &Drives,
        start: &[f64],
    ) -> Result<Reduction, BodyError> {
        let modes = modes_of(&self.fem)?;
        let sources = |loads: &SolidLoads| modes.sources(&self.take, loads);
        let clumped =
            Clumped::new(modes.decay_rates(&self.take), self.columns.iter().map(sources).collect());
        let between = Clumped::new(
            modes.decay_rates(&self.take),
            self.trials.iter().map(|(loads, _)| sources(loads)).collect(),
        );
        let (mut residues, mut slow, mut direct, mut offsets, mut missed) =
            (Vec::new(), Vec::new(), Vec::new(), Vec::new(), Vec::new());
        for value in &values.list {
            let row = self.row(value)?;
            let own = clumped.residues(&row.modes);
            missed.push(self.missed(&between, &row, &own));
            residues.push(own);
            slow.push(clumped.slow_output(&row.modes));
            direct.push(row.direct);
            offsets.push(row.offset);
        }
        let kinds: Vec<Kind> = values.kinds().collect();
        let amounts = drives.amounts(start);
        let experiment =
            Experiment { kinds: &kinds, drive_kinds: &self.drive_kinds, drives, amounts };
        let tolerance = self.scene.fidelity.tolerance;
        let request = Request {
            clumped: &clumped,
            residues: &residues,
            slow: &slow,
            direct: &direct,
            start: &drives.values(start),
            missed: &missed,
            horizon: self.scene.stop_time,
            allowed: &|ranges| experiment.allowed(tolerance, ranges),
        };
        let (system, ranges) = ReducedSystem::new(&request)
            .map_err(|error| BodyError::Reduction { message: error.to_string() })?;
        let errors = experiment.errors(&system, &ranges);
        let brought = self.columns.iter().map(|loads| modes.brought_in_by(loads)).collect();
        Ok(Reduction { system, offsets, errors, brought, modes: clumped.modes() })
    }

    /// Largest interpolation error of each drive for footprints between the supporting ones: in heat over all time, and
    /// in instantaneous effects.
    fn missed(&self, between: &Clumped, row: &Row, own: &Residues) -> Vec<f64> {
        let found = between.residues(&row.modes);
        let mut missed = vec![0.0_f64; self.columns.len()];
        for (t, (_, weights)) in self.trials.iter().enumerate() {
            let mut values = found.values[t].clone();
            let (mut slow, mut direct) = (found.slow[t], row.trials[t]);
            for (j, weight) in weights.iter().enumerate().filter(|(_, weight)| **weight != 0.0) {
                values.iter_mut().zip(&own.values[j]).for_each(|(v, r)| *v -= weight * r);
                slow -= weight * own.slow[j];
                direct -= weight * row.direct[j];
            }
            let horizon = self.scene.stop_time;
            let lasting = slow.abs() * horizon * weights_of(between.slow_rate() * horizon)[1];
            let miss = integral(&between.points, &values) + lasting + direct.abs();
            for (own, weight) in missed.iter_mut().zip(weights) {
                if *weight != 0.0 {
                    *own = own.max(miss);
                }
            }
        }
        missed
    }

    fn row(&self, value: &Value) -> Result<Row, BodyError> {
        let thermal = |row: ModalRow, offset: f64| {
            let direct = self.columns.iter().map(|loads| row.direct(&loads.faces)).collect();
            let trials = self.trials.iter().map(|(loads, _)| row.direct(&loads.faces)).collect();
            Row { modes: row.modes, direct, trials, offset }
        };
        let modes = modes_of(&self.fem)?;
        Ok(match *value {
            Value::Temperature(point) => {
                thermal(modes.temperature_row(&self.take, point), self.initial_temperature)
            }
            Value::Mean { field, cell } => {
                let found = self.means.iter().find(|(place, _)| *place == field);
                let means = &found.expect("means are made for fields of cells").1;
                let (weights, high) = means.on_face(cell, &self.meshes[0]);
                let row = modes.value_row(&self.take, &HeatValue::Face { weights, high });
                thermal(row, self.initial_temperature)
            }
            Value::Stored => thermal(modes.value_row(&self.take, &HeatValue::Stored), 0.0),
            Value::Stress(point, slot) => self.mechanical(Component::Stress(slot), point)?,
            Value::Displacement(point, axis) => {
                self.mechanical(Component::Displacement(axis), point)?
            }
        })
    }

    /// A component of stress or displacement at a point, by its influence on modes, face values and forces. Classes
    /// without drives are not solved.
    fn mechanical(&self, component: Component, point: [f64; 3]) -> Result<Row, BodyError> {
        let functional = self.fem.functional(component, &[(point, 1.0)]);
        let mut out = Row {
            modes: Vec::new(),
            direct: vec![0.0; self.columns.len()],
            trials: vec![0.0; self.trials.len()],
            offset: 0.0,
        };
        for (class, &take) in self.take.iter().enumerate() {
            let at_once = |loads: &SolidLoads| SolidFem::drives_at_once(loads, class);
            if !take && !self.columns.iter().any(at_once) {
                continue;
            }
            let row = self.fem.row(&functional, class);
            let row = row.expect("a checked scene has mechanics where it gives stress")?;
            for (direct, loads) in out.direct.iter_mut().zip(&self.columns) {
                *direct += row.of(&[], &loads.faces[class], &loads.force[class]);
            }
            for (direct, (loads, _)) in out.trials.iter_mut().zip(&self.trials) {
                *direct += row.of(&[], &loads.faces[class], &loads.force[class]);
            }
            out.offset += row.constant;
            if take {
                out.modes.extend(row.heat.iter());
            }
        }
        Ok(out)
    }
}

/// Returns the modes of a solid; every solid that is reduced has them.
fn modes_of(fem: &SolidFem) -> Result<SolidModes<'_>, BodyError> {
    let message = || "its heat has no modes".to_owned();
    fem.modes().ok_or_else(|| BodyError::Reduction { message: message() })
}

/// A value as a sum over modes and drives.
struct Row {
    modes: Vec<f64>,
    direct: Vec<f64>,
    /// Direct terms of the trials.
    trials: Vec<f64>,
    offset: f64,
}

/// Kinds of outputs and drives, and the initial amount of each drive, which may be anywhere in its range.
struct Experiment<'a> {
    kinds: &'a [Kind],
    drive_kinds: &'a [DriveKind],
    drives: &'a Drives,
    amounts: Vec<f64>,
}

impl Experiment<'_> {
    /// Range that counts for an output: its own, or a share of the largest of its kind; infinite if all are zero.
    fn range(&self, ranges: &[f64], k: usize) -> f64 {
        let range = ranges[k].max(LEAST_RANGE * self.largest(ranges, k));
        if range > 0.0 { range } else { f64::INFINITY }
    }

    /// The same under a unit of one drive. The largest range is that under any drive of its kind, because one cell of
    /// many may reach an output that another hardly reaches.
    fn range_under(&self, single: &[Vec<f64>], [k, j]: [usize; 2]) -> f64 {
        let kinds = self.drive_kinds;
        let like = (0..kinds.len()).filter(|&other| kinds[other] == kinds[j]);
        let under = |j: usize| single.iter().map(|ranges| ranges[j]).collect::<Vec<f64>>();
        let largest = like.map(|j| self.largest(&under(j), k)).fold(0.0, f64::max);
        let range = single[k][j].max(LEAST_RANGE * largest);
        if range > 0.0 { range } else { f64::INFINITY }
    }

    /// Range that counts for an output while a drive acts: over the default experiment or, for a footprint that may be
    /// elsewhere then, under the drive alone if that is larger.
    fn range_while(&self, ranges: &Ranges, [k, j]: [usize; 2]) -> f64 {
        let together = self.range(&ranges.together, k);
        let alone = self.amounts[j] * self.range_under(&ranges.single, [k, j]);
        let moves = self.drives.list[j].member.is_some();
        if moves && alone.is_finite() { together.max(alone) } else { together }
    }

    /// Largest range of any output of the same kind.
    fn largest(&self, ranges: &[f64], k: usize) -> f64 {
        let of_kind = self.kinds.iter().zip(ranges).filter(|(kind, _)| **kind == self.kinds[k]);
        of_kind.map(|(_, range)| *range).fold(0.0, f64::max)
    }

    /// Allowed error of each output for each drive. The errors of an output sum to a share of its range, wherever
    /// footprints are. For a drive that starts from zero, the range under a unit of it counts.
    fn allowed(&self, tolerance: f64, ranges: &Ranges) -> Vec<Vec<f64>> {
        let groups = self.drives.groups();
        let active = groups.iter().filter(|group| self.amounts[group[0]] != 0.0).count() as f64;
        let of_pair = |k: usize, j: usize| {
            let (amount, spread) = (self.amounts[j], self.drives.spread(j));
            match amount != 0.0 {
                true => tolerance * self.range_while(ranges, [k, j]) / (active * spread * amount),
                false => tolerance * self.range_under(&ranges.single, [k, j]) / spread,
            }
        };
        let drives = 0..self.amounts.len();
        (0..self.kinds.len()).map(|k| drives.clone().map(|j| of_pair(k, j)).collect()).collect()
    }

    /// Error bound of each output over its range: over the default experiment, with footprints anywhere in their ranges,
    /// or under a single drive that starts from zero, whichever is larger.
    fn errors(&self, system: &ReducedSystem, ranges: &Ranges) -> Vec<f64> {
        let of_output = |k: usize| {
            let bound = |j: usize| system.bounds[k * system.inputs + j];
            let share = |j: usize| bound(j) / self.range_while(ranges, [k, j]);
            let together = self.drives.largest(&self.amounts, share);
            let idle = (0..self.amounts.len()).filter(|&j| self.amounts[j] == 0.0);
            let alone = idle.map(|j| {
                self.drives.spread(j) * bound(j) / self.range_under(&ranges.single, [k, j])
            });
            alone.fold(together, f64::max)
        };
        (0..self.kinds.len()).map(of_output).collect()
    }
}
