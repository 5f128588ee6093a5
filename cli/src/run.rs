use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::time::Instant;

use assessments::{Meshes, Store};
use clap::Args;
use impinge::advice;
use impinge::model::{
    self, Cache, Model, ModelError, State, Timeline, check_memory, to_be_recorded, tolerance,
};
use impinge::output::{CsvTable, Discs, FieldSeries, FilesForecast, FolderLock, OutputError};
use impinge::runtime::available_memory;
use impinge::scene::{self, Scene};
use impinge::warning::Warning;
use indicatif::{ProgressBar, ProgressStyle};

use super::CliError;
use super::error::input_name;
use super::idle;
use super::inputs::{Between, InputTable};
use super::overdue::Overdue;
use super::passing::Passing;
use super::patience;
use super::ranges::Ranges;
use super::report::{self, Fact, Stopwatch, Story};
use super::set::{self, Assignment, InputValue};
use super::summary::{self, Balance, BalanceOutputs};
use super::units::{engineering, megabytes};

/// Default number of times at which fields are written.
const SNAPSHOTS: usize = 50;

/// Number of steps between two times of fields, by default.
pub fn default_fields_every(steps: usize) -> usize {
    steps.div_ceil(SNAPSHOTS)
}

/// Number of times at which fields are written every so many steps, and at the end.
pub fn snapshots(steps: usize, every: usize) -> usize {
    if every == 0 { 0 } else { 1 + steps.div_ceil(every) }
}

/// Number of input rows per step from which a run reports that they slow it down.
const ROWS_PER_STEP: usize = 10;

/// Name of the file of variables over time.
pub const TABLE: &str = "outputs.csv";

/// Extensions of files that runs and their reports write.
const WRITTEN: [&str; 7] = ["csv", "html", "json", "pvd", "vtp", "vtr", "vts"];

/// Run a scene, and write its variables and fields over time
#[derive(Args)]
pub struct Run {
    /// The scene, a TOML file
    scene: PathBuf,
    #[command(flatten)]
    options: Options,
}

/// Settings of a run.
#[derive(Args)]
pub struct Options {
    /// Set a parameter or an input by name; `impinge check --list` lists them
    #[arg(long, value_name = "NAME=VALUE")]
    set: Vec<Assignment>,
    /// Stop at this time instead of the scene's stop_time
    #[arg(long, value_name = "SECONDS", value_parser = positive, allow_negative_numbers = true)]
    until: Option<f64>,
    /// Use this communication step instead of the scene's step
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
    /// Interpolation of inputs between the rows of that table
    #[arg(long, value_enum, default_value_t, requires = "inputs")]
    between: Between,
    /// Write variables every N steps, and at the end
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u64).range(1..))]
    rows_every: u64,
    /// Write fields every N steps, 0 for never [default: about 50 times]
    #[arg(long, value_name = "N")]
    fields_every: Option<usize>,
    /// Turn the fields of discs about their axis: files of about 25 times the size
    #[arg(long)]
    revolve: bool,
    /// Choose meshes and estimate errors anew, instead of reusing those stored for an equal scene
    #[arg(long)]
    fresh: bool,
}

fn positive(text: &str) -> Result<f64, &'static str> {
    let value = text.parse().ok().or_else(|| scene::quantity(text, "s", false).ok());
    let value = value.filter(|value: &f64| value.is_finite() && *value > 0.0);
    value.ok_or("expected a positive number of seconds, or a text such as \"20 ms\"")
}

impl Options {
    /// Returns true if files of an earlier run may be replaced.
    pub fn overwrites(&self) -> bool {
        self.overwrite
    }

    /// Refuses settings of a run where none is made.
    pub fn refuse_settings(&self, what: &str) -> Result<(), CliError> {
        let given = [
            ("--set", !self.set.is_empty()),
            ("--until", self.until.is_some()),
            ("--step", self.step.is_some()),
            ("--out", self.out.is_some()),
            ("--inputs", self.inputs.is_some()),
            ("--rows-every", self.rows_every != 1),
            ("--fields-every", self.fields_every.is_some()),
            ("--revolve", self.revolve),
            ("--fresh", self.fresh),
        ];
        match given.into_iter().find(|(_, is_given)| *is_given) {
            Some((option, _)) => Err(CliError::NoRun { option, what: what.to_owned() }),
            None => Ok(()),
        }
    }
}

impl Run {
    pub fn of(scene: PathBuf, options: Options) -> Self {
        Self { scene, options }
    }

    /// Runs the scene and reports the heat balance.
    pub fn execute(&self) -> Result<String, CliError> {
        self.execute_in_folder().map(|(report, _)| report)
    }

    /// Runs the scene; returns the report and the folder of the files.
    pub fn execute_in_folder(&self) -> Result<(String, PathBuf), CliError> {
        let started = Instant::now();
        let mut stopwatch = Stopwatch::start();
        let (scene, inputs) = self.modified_scene()?;
        // Errors of files are reported before meshes are assessed, which takes time.
        let table = self.input_table(&scene, &inputs)?;
        self.check_folder(&self.folder(&scene), &scene)?;
        check_memory(&scene, available_memory()).map_err(CliError::Model)?;
        if let Some(note) = patience::expected(&scene)? {
            super::print_message("note", &note);
        }
        for note in to_be_recorded(&scene).into_iter().chain(tolerance::note_on_sample(&scene)) {
            super::print_message("note", &note);
        }
        let store = Store::of_user(self.options.fresh);
        let levels = store.levels(&scene, available_memory()).found;
        for note in &levels.notes {
            super::print_message("note", note);
        }
        let Meshes { scene, estimates, warnings } = store.meshes(&levels.scene).found;
        super::warn(&warnings);
        stopwatch.lap("reading the scene, choosing and judging meshes");
        let model = Model::build(&scene, scene.solver.threads)
            .map_err(|error| CliError::from_model(error, &scene))?;
        super::warn(&model.reduction_warnings().collect::<Vec<_>>());
        stopwatch.lap("building the model");
        let timeline = Timeline::new(scene.step, scene.stop_time);
        let rows = table.as_ref().map_or(0, |table| table.rows_until(scene.stop_time));
        if rows > ROWS_PER_STEP * timeline.count {
            let steps = timeline.count;
            let note = format!(
                "{rows} rows of inputs cut {steps} steps: the run takes as long as that many steps"
            );
            super::print_message("note", &note);
        }
        let mut run = Running {
            state: start(&model, &inputs, (table.as_ref(), timeline.length(0)))?,
            cache: Cache::default(),
            timeline,
            table,
            warned_of_length: false,
            balance_outputs: BalanceOutputs::of(&scene),
            warned_of_phases: BTreeSet::new(),
            balances: Vec::new(),
            has_all_rows: self.options.rows_every == 1,
            ranges: Ranges::of(&scene),
            passing: Passing::of(&model),
            model: &model,
        };
        let note = || idle::note(&scene, &run.state.inputs);
        if let Some(note) = self.options.inputs.is_none().then(note).flatten() {
            super::print_message("note", &note);
        }
        super::print_message("note", &self.announcement(&run));
        let folder = self.folder(&scene);
        if former(&folder, &scene).is_some() {
            run.rehearse()?;
        }
        let mut record = self.record(&run)?;
        let mut story = Story::begin(&model, &estimates, &self.source())?;
        story.write(&folder)?;
        report::remove_page(&folder)?;
        run.finish(&mut record)?;
        stopwatch.lap("steps, readings and files");
        let spent = engineering(started.elapsed().as_secs_f64(), "s");
        let report = run.report()?;
        story.end(&stopwatch);
        story.write(&folder)?;
        let place = &record.place;
        let text =
            format!("{}: {spent}, {} steps\n\n{report}\n{place}", scene.name, run.timeline.count);
        Ok((text, folder))
    }

    /// Files and settings that the run follows from.
    fn source(&self) -> Vec<Fact> {
        let path = |path: &PathBuf| path.display().to_string();
        let options = &self.options;
        let mut facts = vec![Fact::new("scene", path(&self.scene))];
        facts.extend(options.set.iter().map(|one| Fact::new("set", one.to_string())));
        facts.extend(options.inputs.iter().map(|file| Fact::new("inputs over time", path(file))));
        facts
    }

    /// The scene with all modifications of the command line, and the inputs that it sets.
    fn modified_scene(&self) -> Result<(Scene, Vec<InputValue>), CliError> {
        let (mut scene, warnings) = patience::read(&self.scene)?;
        let read = scene.clone();
        scene.stop_time = self.options.until.unwrap_or(scene.stop_time);
        scene.step = self.options.step.unwrap_or(scene.step);
        let inputs = set::apply(&mut scene, &self.options.set)?;
        scene::check(&scene)?;
        super::warn(&if scene == read { warnings } else { advice::warnings(&scene) });
        super::warn(&set::implausible(&scene, &inputs));
        super::warn(&set::implausible_together(&scene, [inputs.clone()]));
        Ok((scene, inputs))
    }

    /// The table of inputs; refuses inputs that are also set.
    fn input_table(
        &self,
        scene: &Scene,
        set: &[InputValue],
    ) -> Result<Option<InputTable>, CliError> {
        let Some(path) = &self.options.inputs else { return Ok(None) };
        let table = InputTable::read(path, self.options.between, scene)?;
        super::warn(&set::implausible(scene, &table.samples(scene)));
        let with_set = |row: Vec<InputValue>| set.iter().copied().chain(row).collect();
        super::warn(&set::implausible_together(scene, table.rows().map(with_set)));
        if let Some((kind, message)) = table.remark(path, scene.stop_time) {
            super::print_message(kind, &message);
        }
        let twice = table.given().find(|place| set.iter().any(|(other, _)| other == place));
        match twice {
            Some(place) => Err(CliError::GivenTwice { name: input_name(scene, place) }),
            None => Ok(Some(table)),
        }
    }

    /// Refuses output paths that would overwrite files the run reads.
    fn refuse_overwriting_inputs(&self, folder: &Path) -> Result<(), CliError> {
        let could_be_written = |file: &&PathBuf| {
            let Ok(place) = file.canonicalize() else { return false };
            let is_there = folder.canonicalize().is_ok_and(|own| place.parent() == Some(&own));
            let extension = place.extension().and_then(|extension| extension.to_str());
            is_there && extension.is_some_and(|name| WRITTEN.contains(&name))
        };
        match [Some(&self.scene), self.options.inputs.as_ref()]
            .into_iter()
            .flatten()
            .find(could_be_written)
        {
            Some(file) => Err(CliError::ReadInFolder { file: file.clone() }),
            None => Ok(()),
        }
    }

    /// Folder of the run's files.
    fn folder(&self, scene: &Scene) -> PathBuf {
        self.options.out.clone().unwrap_or_else(|| PathBuf::from("out").join(&scene.name))
    }

    /// Refuses a folder that holds another run or files being read, and anything that is not a folder.
    fn check_folder(&self, folder: &Path, scene: &Scene) -> Result<(), CliError> {
        if let Some(file) = former(folder, scene).filter(|_| !self.options.overwrite) {
            return Err(CliError::Taken { folder: folder.to_owned(), file });
        }
        if folder.exists() && !folder.is_dir() {
            return Err(CliError::NoFolder { path: folder.to_owned() });
        }
        self.refuse_overwriting_inputs(folder)
    }

    /// Number of steps between two times of fields; 0 for none.
    fn fields_every(&self, run: &Running) -> usize {
        self.options.fields_every.unwrap_or(default_fields_every(run.timeline.count))
    }

    fn discs(&self) -> Discs {
        if self.options.revolve { Discs::Revolved } else { Discs::Sections }
    }

    /// Says what the run will write.
    fn announcement(&self, run: &Running) -> String {
        let scene = run.model.scene();
        let steps = run.timeline.count;
        let rows_every = usize::try_from(self.options.rows_every).unwrap_or(usize::MAX);
        let rows = 1 + steps.div_ceil(rows_every);
        let times = snapshots(steps, self.fields_every(run));
        let forecast = model::forecast(scene);
        let files = FilesForecast::of(scene, &forecast, [rows, times], self.discs());
        let folder = self.folder(scene);
        format!(
            "writes {} files, about {}, in {}",
            files.count + 1,
            megabytes(files.bytes),
            folder.display()
        )
    }

    /// Opens the files of the run.
    fn record(&self, run: &Running) -> Result<Record, CliError> {
        let folder = self.folder(run.model.scene());
        let lock = FolderLock::take(&folder)?;
        self.check_folder(&folder, run.model.scene())?;
        let table = folder.join(TABLE);
        let every = self.fields_every(run);
        let table = CsvTable::create(&table, run.model)?;
        let fields = match every {
            0 => {
                // Fields of another run in this table's folder would be mistaken for its own.
                FieldSeries::remove(&folder, run.model)?;
                None
            }
            _ => Some(FieldSeries::create(&folder, run.model, self.discs())?),
        };
        let place = format!("files in {}\n", folder.display());
        let rows_every = usize::try_from(self.options.rows_every).unwrap_or(usize::MAX);
        Ok(Record { table, fields, every, rows_every, place, _lock: lock })
    }
}

/// A file of a former run in a folder.
fn former(folder: &Path, scene: &Scene) -> Option<PathBuf> {
    let own = [folder.join(TABLE), folder.join(report::FILE)];
    let own = own.into_iter().find(|file| file.symlink_metadata().is_ok());
    own.or_else(|| FieldSeries::found_in(folder, scene))
}

/// The state at time zero with the requested inputs, and those of a table before a first step [s].
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
    /// Number of steps between two writes of fields.
    every: usize,
    /// Number of steps between two writes of variables.
    rows_every: usize,
    /// Description of the location of the files.
    place: String,
    /// Prevents others from writing there meanwhile.
    _lock: FolderLock,
}

impl Record {
    /// Checks that all written files still exist.
    fn check_present(&self) -> Result<(), OutputError> {
        self.table.check_present()?;
        self.fields.as_ref().map_or(Ok(()), FieldSeries::check_present)
    }

    /// Appends the state of `run` after `done` steps.
    fn write(&mut self, run: &mut Running, done: usize) -> Result<(), OutputError> {
        let is_last = done == run.timeline.count;
        let is_due = is_last || (self.every > 0 && done.is_multiple_of(self.every));
        if is_last || done.is_multiple_of(self.rows_every) {
            self.table.write(run.model, &run.state, &mut run.cache)?;
            run.ranges.update(self.table.last_row().map(|(_, value)| value));
            run.passing.see_values(run.model, self.table.last_row(), run.state.time);
            run.update_balances()?;
        }
        match &mut self.fields {
            Some(fields) if is_due => fields.write(run.model, &run.state, &mut run.cache),
            _ => Ok(()),
        }
    }
}

/// A running simulation.
struct Running<'a> {
    model: &'a Model,
    state: State,
    cache: Cache,
    timeline: Timeline,
    table: Option<InputTable>,
    /// True if a row is written after each step.
    has_all_rows: bool,
    /// True if a step too short for the mesh has been reported.
    warned_of_length: bool,
    balance_outputs: Vec<BalanceOutputs>,
    /// Fluids and phase changes already warned of.
    warned_of_phases: BTreeSet<String>,
    /// Balances of the last row.
    balances: Vec<Balance>,
    ranges: Ranges,
    passing: Passing,
}

impl Running<'_> {
    fn finish(&mut self, record: &mut Record) -> Result<(), CliError> {
        let progress = progress_bar(self.timeline.count);
        let _overdue = Overdue::watch(model::forecast(self.model.scene()).run_time(), &progress);
        record.write(self, 0)?;
        for i in 0..self.timeline.count {
            self.step(i)?;
            record.write(self, i + 1)?;
            progress.inc(1);
        }
        progress.finish_and_clear();
        Ok(record.check_present()?)
    }

    /// Takes the first step and goes back, so that a run which fails at once leaves the files of a former one.
    fn rehearse(&mut self) -> Result<(), CliError> {
        let start = self.state.clone();
        if self.timeline.count > 0 {
            self.step(0)?;
        }
        self.state = start;
        self.cache = Cache::default();
        self.balances.clear();
        self.passing = Passing::of(self.model);
        Ok(())
    }

    /// Advances by the step after the first `i` steps.
    fn step(&mut self, i: usize) -> Result<(), CliError> {
        let (start, end) = (self.timeline.time(i), self.timeline.time(i + 1));
        let length = self.timeline.length(i);
        let rows = self.table.as_ref().map_or(Vec::new(), |table| table.times_within(start, end));
        let looks_every = rows.len().div_ceil(ROWS_PER_STEP).max(1);
        let mut from = start;
        for (part, &to) in rows.iter().chain([&end]).enumerate() {
            let is_whole = from == start && to == end;
            let length = if is_whole { length } else { to - from };
            // The remainder of a run that is not a whole number of steps is short, but no jump precedes it.
            let is_rest = is_whole && i > 0 && i + 1 == self.timeline.count;
            if !is_rest {
                let cut = (!is_whole).then_some((from, to));
                self.warn_of_length(length, cut);
            }
            self.advance((from, to), length)?;
            self.state.set_time(to);
            self.passing.see_state(self.model, &self.state);
            self.warn_of_phases();
            if to < end && part.is_multiple_of(looks_every) {
                // Heat that is added and removed within a step counts, too.
                self.update_balances().map_err(CliError::Model)?;
            }
            from = to;
        }
        Ok(())
    }

    /// Warns once of a step that is too short for a mesh [s], and names the rows of the table that cut it.
    fn warn_of_length(&mut self, length: f64, cut: Option<(f64, f64)>) {
        let warning = self.model.warning_on_step(length).filter(|_| !self.warned_of_length);
        let Some(warning) = warning else { return };
        let rows = cut.zip(self.table.as_ref()).map(|((from, to), table)| table.rows_at(from, to));
        super::warn(&[match rows {
            Some(rows) => {
                let place = format!("{rows}: {}", warning.place());
                warning.finding().clone().at(place)
            }
            None => warning,
        }]);
        self.warned_of_length = true;
    }

    /// Warns once of each fluid that is beyond a point at which it freezes or boils.
    fn warn_of_phases(&mut self) {
        let told = &self.warned_of_phases;
        let warnings = self.model.phase_warnings(&self.state, |subject| told.contains(subject));
        for warning in warnings {
            self.warned_of_phases.insert(warning.subject().to_owned());
            super::warn(&[warning]);
        }
    }

    /// Advances between rows of the table [s].
    fn advance(&mut self, (from, to): (f64, f64), length: f64) -> Result<(), CliError> {
        if let Some(table) = &self.table {
            table.apply(&mut self.state, from, to);
        }
        self.model.step(&mut self.state, &mut self.cache, length).map_err(|error| {
            let reason = Box::new(CliError::from_model(error, self.model.scene()));
            CliError::Step { time: from, reason }
        })
    }

    /// Updates the heat balances.
    fn update_balances(&mut self) -> Result<(), ModelError> {
        let read = |one: &BalanceOutputs| one.read(self.model, &self.state, &mut self.cache);
        let mut balances =
            self.balance_outputs.iter().map(read).collect::<Result<Vec<Balance>, _>>()?;
        Balance::join(&mut balances, &self.balances);
        self.balances = balances;
        Ok(())
    }

    /// Returns what probes and fields read over time, peaks, heat balances and totals; warns on standard error if heat
    /// is missing.
    fn report(&mut self) -> Result<String, CliError> {
        let named = |error| CliError::from_model(error, self.model.scene());
        self.update_balances().map_err(named)?;
        let totals =
            summary::totals_table(self.model, &self.state, &mut self.cache).map_err(named)?;
        let peaks =
            summary::peaks_table(self.model, &self.state, &mut self.cache).map_err(named)?;
        let too_hot = self.ranges.warnings(self.model);
        let is_said = |warning: &Warning| {
            too_hot.iter().any(|hottest| hottest.subject() == warning.subject())
        };
        let mut passing = self.passing.at_end(self.state.time);
        passing.retain(|warning| !is_said(warning));
        let strays = self.model.closing_warnings(&self.state);
        let balances_off = self.balances.iter().filter_map(Balance::warning);
        let warnings = balances_off.chain(passing).chain(strays).chain(too_hot);
        super::warn(&warnings.collect::<Vec<_>>());
        let balances = summary::balance_table(&self.balances);
        let tables = [self.ranges.table(self.has_all_rows), peaks, balances, totals];
        let tables: Vec<_> = tables.into_iter().filter(|table| !table.is_empty()).collect();
        Ok(tables.join("\n"))
    }
}

/// A progress bar on standard error; hidden if that is not a terminal.
fn progress_bar(steps: usize) -> ProgressBar {
    let style = ProgressStyle::with_template("{bar:40} {pos}/{len} steps, {eta} left")
        .expect("a valid template");
    ProgressBar::new(steps as u64).with_style(style)
}
