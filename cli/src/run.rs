use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::time::Instant;

use clap::Args;
use impinge::advice;
use impinge::model::{
    Cache, Model, ModelError, State, Timeline, check_memory, to_be_recorded, tolerance,
};
use impinge::output::{CsvTable, FieldSeries, FolderLock, OutputError};
use impinge::runtime::available_memory;
use impinge::scene::{self, Scene};
use indicatif::{ProgressBar, ProgressStyle};

use super::CliError;
use super::error::input_name;
use super::idle;
use super::inputs::{Between, InputTable};
use super::patience;
use super::set::{self, Assignment, InputValue};
use super::summary::{self, Balance, BalanceOutputs};
use super::units::engineering;

/// Number of times at which fields are written, about, if the user does not say.
const SNAPSHOTS: usize = 50;

/// Rows of inputs per step from which on a run says that they make it longer.
const ROWS_PER_STEP: usize = 10;

/// Name of the file of variables over time.
const TABLE: &str = "outputs.csv";

/// Extensions of files that runs write.
const WRITTEN: [&str; 5] = ["csv", "pvd", "vtp", "vtr", "vtu"];

/// Run a scene, and write its variables and fields over time
#[derive(Args)]
pub struct Run {
    /// The scene, a TOML file
    scene: PathBuf,
    /// Set a parameter or an input by name; `impinge check` lists them
    #[arg(long, value_name = "NAME=VALUE")]
    set: Vec<Assignment>,
    /// Stop at this time, as if the scene's stop_time said so
    #[arg(long, value_name = "SECONDS", value_parser = positive, allow_negative_numbers = true)]
    until: Option<f64>,
    /// Use this communication step, as if the scene's step said so
    #[arg(long, value_name = "SECONDS", value_parser = positive, allow_negative_numbers = true)]
    step: Option<f64>,
    /// Folder for the files [default: out/NAME]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Replace the files of an earlier run in that folder
    #[arg(long)]
    overwrite: bool,
    /// Inputs over time: comma-separated values, first column `time` [s], then one each for inputs by their names
    #[arg(long, value_name = "TABLE")]
    inputs: Option<PathBuf>,
    /// What inputs do between the rows of that table
    #[arg(long, value_enum, default_value_t, requires = "inputs")]
    between: Between,
    /// Write variables every N steps, and at the end
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u64).range(1..))]
    rows_every: u64,
    /// Write fields every N steps, 0 for never [default: about 50 times]
    #[arg(long, value_name = "N")]
    fields_every: Option<usize>,
}

fn positive(text: &str) -> Result<f64, &'static str> {
    let value = text.parse().ok().filter(|value: &f64| value.is_finite() && *value > 0.0);
    value.ok_or("expected a positive number of seconds")
}

impl Run {
    /// Runs, and reports where the heat went.
    pub fn execute(&self) -> Result<String, CliError> {
        let started = Instant::now();
        let (scene, inputs) = self.asked_scene()?;
        // What is wrong with files is told before meshes are judged, which takes its time.
        let table = self.input_table(&scene, &inputs)?;
        self.check_folder(&self.folder(&scene), &scene)?;
        check_memory(&scene, available_memory()).map_err(CliError::Model)?;
        if let Some(note) = patience::expected(&scene)? {
            super::print_message("note", &note);
        }
        for note in to_be_recorded(&scene).into_iter().chain(tolerance::note_on_sample(&scene)) {
            super::print_message("note", &note);
        }
        let levels = tolerance::levels(&scene, available_memory());
        for note in &levels.notes {
            super::print_message("note", note);
        }
        let (scene, estimates) = tolerance::estimates(&levels.scene);
        for warning in tolerance::warnings(&scene, &estimates) {
            super::print_message("warning", &warning);
        }
        let model = Model::build(&scene, scene.solver.threads)
            .map_err(|error| CliError::from_model(error, &scene))?;
        for warning in model.reduction_warnings() {
            super::print_message("warning", &warning);
        }
        let timeline = Timeline::new(scene.step, scene.stop_time);
        let rows = table.as_ref().map_or(0, |table| table.rows_until(scene.stop_time));
        if rows > ROWS_PER_STEP * timeline.count {
            let steps = timeline.count;
            let note = format!(
                "{rows} rows of inputs cut {steps} steps: this takes as long as that many steps do"
            );
            super::print_message("note", &note);
        }
        let mut run = Running {
            state: start(&model, &inputs, (table.as_ref(), timeline.length(0)))?,
            cache: Cache::default(),
            timeline,
            table,
            told_of_length: false,
            balance_outputs: BalanceOutputs::of(&scene),
            told_of_phases: BTreeSet::new(),
            balances: Vec::new(),
            model: &model,
        };
        let note = || idle::note(&scene, &run.state.inputs);
        if let Some(note) = self.inputs.is_none().then(note).flatten() {
            super::print_message("note", &note);
        }
        let mut record = self.record(&run)?;
        run.finish(&mut record)?;
        let spent = engineering(started.elapsed().as_secs_f64(), "s");
        let report = run.report()?;
        Ok(format!(
            "{}: {spent}, {} steps\n\n{report}\n{}",
            scene.name, run.timeline.count, record.place
        ))
    }

    /// The scene with everything that the command line changes in it, and the inputs it sets.
    fn asked_scene(&self) -> Result<(Scene, Vec<InputValue>), CliError> {
        let (mut scene, warnings) = patience::read(&self.scene)?;
        let read = scene.clone();
        scene.stop_time = self.until.unwrap_or(scene.stop_time);
        scene.step = self.step.unwrap_or(scene.step);
        let inputs = set::apply(&mut scene, &self.set)?;
        scene::check(&scene)?;
        super::warn(&if scene == read { warnings } else { advice::warnings(&scene) });
        for warning in set::implausible(&scene, &inputs) {
            super::print_message("warning", &warning);
        }
        Ok((scene, inputs))
    }

    /// The inputs over time, none of which is among those that are set.
    fn input_table(
        &self,
        scene: &Scene,
        set: &[InputValue],
    ) -> Result<Option<InputTable>, CliError> {
        let Some(path) = &self.inputs else { return Ok(None) };
        let table = InputTable::read(path, self.between, scene)?;
        for warning in set::implausible(scene, &table.samples(scene)) {
            super::print_message("warning", &warning);
        }
        if let Some((kind, message)) = table.remark(path, scene.stop_time) {
            super::print_message(kind, &message);
        }
        let twice = table.given().find(|place| set.iter().any(|(other, _)| other == place));
        match twice {
            Some(place) => Err(CliError::GivenTwice { name: input_name(scene, place) }),
            None => Ok(Some(table)),
        }
    }

    /// Refuses to write where what is read may be one of the files of the run.
    fn keep_what_is_read(&self, folder: &Path) -> Result<(), CliError> {
        let could_be_written = |file: &&PathBuf| {
            let Ok(place) = file.canonicalize() else { return false };
            let is_there = folder.canonicalize().is_ok_and(|own| place.parent() == Some(&own));
            let extension = place.extension().and_then(|extension| extension.to_str());
            is_there && extension.is_some_and(|name| WRITTEN.contains(&name))
        };
        match [Some(&self.scene), self.inputs.as_ref()].into_iter().flatten().find(could_be_written)
        {
            Some(file) => Err(CliError::ReadInFolder { file: file.clone() }),
            None => Ok(()),
        }
    }

    /// Where files of the run go.
    fn folder(&self, scene: &Scene) -> PathBuf {
        self.out.clone().unwrap_or_else(|| PathBuf::from("out").join(&scene.name))
    }

    /// Refuses a folder of another run, of what is read, and what is no folder.
    fn check_folder(&self, folder: &Path, scene: &Scene) -> Result<(), CliError> {
        let table = folder.join(TABLE);
        let own = table.symlink_metadata().is_ok().then_some(table);
        let taken = own.or_else(|| FieldSeries::found_in(folder, scene));
        if let Some(file) = taken.filter(|_| !self.overwrite) {
            return Err(CliError::Taken { folder: folder.to_owned(), file });
        }
        if folder.exists() && !folder.is_dir() {
            return Err(CliError::NoFolder { path: folder.to_owned() });
        }
        self.keep_what_is_read(folder)
    }

    /// Opens the files of the run.
    fn record(&self, run: &Running) -> Result<Record, CliError> {
        let folder = self.folder(run.model.scene());
        let lock = FolderLock::take(&folder)?;
        self.check_folder(&folder, run.model.scene())?;
        let table = folder.join(TABLE);
        let every = self.fields_every.unwrap_or(run.timeline.count.div_ceil(SNAPSHOTS));
        let table = CsvTable::create(&table, run.model)?;
        let fields = match every {
            0 => {
                // Fields of another run beside this one's table would be taken for its own.
                FieldSeries::remove(&folder, run.model)?;
                None
            }
            _ => Some(FieldSeries::create(&folder, run.model)?),
        };
        let place = format!("files in {}\n", folder.display());
        let rows_every = usize::try_from(self.rows_every).unwrap_or(usize::MAX);
        Ok(Record { table, fields, every, rows_every, place, _lock: lock })
    }
}

/// The state at time zero with the inputs that were asked for, and those of a table before a first step [s].
fn start(
    model: &Model,
    inputs: &[InputValue],
    (table, step): (Option<&InputTable>, f64),
) -> Result<State, CliError> {
    let mut state = model.initial_state();
    for &(index, value) in inputs {
        state.inputs[index] = value;
    }
    if let Some(table) = table {
        table.apply(&mut state, 0.0, step);
    }
    model
        .check_inputs(&state.inputs)
        .map_err(|error| CliError::from_model(error, model.scene()))?;
    Ok(state)
}

/// The files of a run.
struct Record {
    table: CsvTable,
    fields: Option<FieldSeries>,
    /// Steps between two times at which fields are written.
    every: usize,
    /// Steps between two times at which variables are written.
    rows_every: usize,
    /// Words for where the files are.
    place: String,
    /// Keeps others from writing there meanwhile.
    _lock: FolderLock,
}

impl Record {
    /// Whether all files that were written are still there.
    fn check_present(&self) -> Result<(), OutputError> {
        self.table.check_present()?;
        self.fields.as_ref().map_or(Ok(()), FieldSeries::check_present)
    }

    /// Adds what `run` has reached after `done` steps.
    fn write(&mut self, run: &mut Running, done: usize) -> Result<(), OutputError> {
        let is_last = done == run.timeline.count;
        let is_due = is_last || (self.every > 0 && done.is_multiple_of(self.every));
        if is_last || done.is_multiple_of(self.rows_every) {
            self.table.write(run.model, &run.state, &mut run.cache)?;
            run.look_at_balances()?;
        }
        match &mut self.fields {
            Some(fields) if is_due => fields.write(run.model, &run.state, &mut run.cache),
            _ => Ok(()),
        }
    }
}

/// A model on its way through time.
struct Running<'a> {
    model: &'a Model,
    state: State,
    cache: Cache,
    timeline: Timeline,
    table: Option<InputTable>,
    /// Whether a part of a step that is too short for a mesh was told of.
    told_of_length: bool,
    balance_outputs: Vec<BalanceOutputs>,
    /// Fluids and changes of phase that were warned of.
    told_of_phases: BTreeSet<String>,
    /// Of the last row that was written.
    balances: Vec<Balance>,
}

impl Running<'_> {
    fn finish(&mut self, record: &mut Record) -> Result<(), CliError> {
        let progress = progress_bar(self.timeline.count);
        record.write(self, 0)?;
        for i in 0..self.timeline.count {
            self.step(i)?;
            record.write(self, i + 1)?;
            progress.inc(1);
        }
        progress.finish_and_clear();
        Ok(record.check_present()?)
    }

    /// Takes the step that begins after `i` steps.
    fn step(&mut self, i: usize) -> Result<(), CliError> {
        let (start, end) = (self.timeline.time(i), self.timeline.time(i + 1));
        let length = self.timeline.length(i);
        let rows = self.table.as_ref().map_or(Vec::new(), |table| table.times_within(start, end));
        let looks_every = rows.len().div_ceil(ROWS_PER_STEP).max(1);
        let mut from = start;
        for (part, &to) in rows.iter().chain([&end]).enumerate() {
            let is_whole = from == start && to == end;
            let length = if is_whole { length } else { to - from };
            // What is left of a run that is no whole number of steps is short, but follows no jump.
            let is_rest = is_whole && i > 0 && i + 1 == self.timeline.count;
            if !is_rest {
                self.warn_of_length(length);
            }
            self.advance((from, to), length)?;
            self.state.set_time(to);
            self.warn_of_phases();
            if to < end && part.is_multiple_of(looks_every) {
                // Heat that comes and goes within a step counts, too.
                self.look_at_balances().map_err(CliError::Model)?;
            }
            from = to;
        }
        Ok(())
    }

    /// Tells once of a step that is too short for a mesh [s].
    fn warn_of_length(&mut self, length: f64) {
        if let Some(warning) = self.model.warning_on_step(length).filter(|_| !self.told_of_length) {
            super::print_message("warning", &warning);
            self.told_of_length = true;
        }
    }

    /// Warns once of each fluid that is beyond a point at which it freezes or boils.
    fn warn_of_phases(&mut self) {
        let told = &self.told_of_phases;
        let warnings = self.model.phase_warnings(&self.state, |subject| told.contains(subject));
        for warning in warnings {
            super::print_message("warning", &warning);
            self.told_of_phases.insert(warning.subject().to_owned());
        }
    }

    /// Advances over a time between rows of the table [s].
    fn advance(&mut self, (from, to): (f64, f64), length: f64) -> Result<(), CliError> {
        if let Some(table) = &self.table {
            table.apply(&mut self.state, from, to);
        }
        self.model.step(&mut self.state, &mut self.cache, length).map_err(|error| {
            let reason = Box::new(CliError::from_model(error, self.model.scene()));
            CliError::Step { time: from, reason }
        })
    }

    /// Brings the heat balances up to date.
    fn look_at_balances(&mut self) -> Result<(), ModelError> {
        let read = |one: &BalanceOutputs| one.read(self.model, &self.state, &mut self.cache);
        let mut balances =
            self.balance_outputs.iter().map(read).collect::<Result<Vec<Balance>, _>>()?;
        Balance::join(&mut balances, &self.balances);
        self.balances = balances;
        Ok(())
    }

    /// Returns the heat balances, what probes read, and the extremes; warns on standard error if heat is missing.
    fn report(&mut self) -> Result<String, CliError> {
        let named = |error| CliError::from_model(error, self.model.scene());
        self.look_at_balances().map_err(named)?;
        let probes =
            summary::probes_table(self.model, &self.state, &mut self.cache).map_err(named)?;
        let extremes =
            summary::extremes_table(self.model, &self.state, &mut self.cache).map_err(named)?;
        let peaks =
            summary::peaks_table(self.model, &self.state, &mut self.cache).map_err(named)?;
        let of_values =
            self.model.warnings_on_values(&self.state, &mut self.cache).map_err(named)?;
        let overflows = self.model.warnings(&self.state);
        let strays = self.model.closing_warnings(&self.state);
        let balances_off = self.balances.iter().filter_map(Balance::warning);
        for warning in balances_off.chain(overflows).chain(strays).chain(of_values) {
            super::print_message("warning", &warning);
        }
        let balances = summary::balance_table(&self.balances);
        let tables = [balances, probes, extremes, peaks];
        let tables: Vec<_> = tables.into_iter().filter(|table| !table.is_empty()).collect();
        Ok(tables.join("\n"))
    }
}

/// A bar on standard error; hidden where that is not a terminal.
fn progress_bar(steps: usize) -> ProgressBar {
    let style = ProgressStyle::with_template("{bar:40} {pos}/{len} steps, {eta} left")
        .expect("a valid template");
    ProgressBar::new(steps as u64).with_style(style)
}
