//! Fields over time as files of ParaView.

use std::fs;
use std::path::{Path, PathBuf};

use super::collection::{Entry, write_collection};
use super::replace::replace;
use super::{OutputError, vtk};
use crate::body::Fields;
use crate::model::{Cache, Model, State};
use crate::scene::{Body, Drawn, Scene};

/// The fields of all bodies as ParaView time series. For each time `BODY.pvd` lists one `BODY_NNNNNN.vtr` (the nodes of
/// a box, or of a disc's meridian section), `.vts` (those of a disc, revolved about its axis) or `.vtp` (the particles
/// of a droplet). `all-bodies.pvd` lists those of several bodies, so that a viewer opens them at once.
///
/// Bodies without nodes or particles have no files: reduced solids, recorded drops and films. A droplet has none at
/// times at which no drop has been released yet.
///
/// Files appear whole or not at all, and the list is updated after each time, so an interrupted run leaves a readable
/// series. A time with a file that cannot be written is not listed. A state whose time is not later than the last one
/// replaces all times from its own on. Files of the series that are no longer listed are removed, also those of an
/// earlier run.
pub struct FieldSeries {
    directory: PathBuf,
    bodies: Vec<Drawing>,
    /// Times written so far, ascending [s].
    times: Vec<f64>,
}

/// The files of a body.
struct Drawing {
    body: String,
    /// Content of its files; `None` for a body that has nothing to draw, of which files may remain from other runs.
    kind: Option<Kind>,
    /// For each time, whether there is a file.
    written: Vec<bool>,
}

impl FieldSeries {
    /// Creates the folder if it is missing, and empty lists in it; removes the files of an earlier series of these
    /// bodies.
    pub fn create(directory: &Path, model: &Model, discs: Discs) -> Result<Self, OutputError> {
        fs::create_dir_all(directory).map_err(OutputError::at("create the folder", directory))?;
        let series = Self::of(directory, model.scene(), discs);
        series.write_lists()?;
        series.remove_unlisted();
        Ok(series)
    }

    /// A series without times, with nothing written yet.
    fn of(directory: &Path, scene: &Scene, discs: Discs) -> Self {
        let drawing = |(name, body): (&str, &Body)| {
            let kind = match body.drawn_as()? {
                _ if !scene.is_drawn(name) => None,
                Drawn::Grid if body.is_round() && discs == Discs::Revolved => Some(Kind::Revolved),
                Drawn::Grid => Some(Kind::Grid),
                Drawn::Particles => Some(Kind::Particles),
            };
            Some(Drawing { body: name.to_owned(), kind, written: Vec::new() })
        };
        let bodies = scene.bodies_by_kind().into_iter().filter_map(drawing).collect();
        Self { directory: directory.to_owned(), bodies, times: Vec::new() }
    }

    /// Removes the series of a model's bodies from a folder, including unfinished files. A file that cannot be removed
    /// is an error: it would be mistaken for a field of a later run.
    pub fn remove(directory: &Path, model: &Model) -> Result<(), OutputError> {
        let series = Self::of(directory, model.scene(), Discs::Sections);
        let Ok(entries) = fs::read_dir(directory) else { return Ok(()) };
        let names = entries.flatten().filter_map(|entry| entry.file_name().into_string().ok());
        for name in names.filter(|name| series.is_list(name) || series.is_unlisted(name)) {
            let path = directory.join(name);
            fs::remove_file(&path).map_err(OutputError::at("remove", &path))?;
        }
        Ok(())
    }

    /// Returns true if a name is that of a list of the series.
    fn is_list(&self, name: &str) -> bool {
        name == ALL || self.bodies.iter().any(|drawing| name == drawing.list_name())
    }

    /// The first file in a folder that a series of a scene's bodies would replace or remove.
    pub fn found_in(directory: &Path, scene: &Scene) -> Option<PathBuf> {
        let series = Self::of(directory, scene, Discs::Sections);
        let entries = fs::read_dir(directory).ok()?;
        let names = entries.flatten().filter_map(|entry| entry.file_name().into_string().ok());
        let own = names.filter(|name| series.is_list(name) || series.is_unlisted(name)).min()?;
        Some(directory.join(own))
    }

    /// The folder of the files.
    pub fn directory(&self) -> &Path {
        &self.directory
    }

    /// Checks that the lists and all their files exist.
    pub fn check_present(&self) -> Result<(), OutputError> {
        let drawn = || self.bodies.iter().filter(|drawing| drawing.kind.is_some());
        let files = drawn().flat_map(|drawing| {
            drawing.entries(&self.times).map(|entry| entry.file).chain([drawing.list_name()])
        });
        let all = self.lists_all().then(|| ALL.to_owned());
        let mut paths = files.chain(all).map(|name| self.directory.join(name));
        match paths.find(|path| !path.exists()) {
            None => Ok(()),
            Some(path) => Err(OutputError::Gone { path }),
        }
    }

    /// Discards the times after `time` [s], when a state of that time was restored.
    pub fn go_back(&mut self, time: f64) -> Result<(), OutputError> {
        self.keep(|written| written <= time);
        self.write_lists()?;
        self.remove_unlisted();
        Ok(())
    }

    /// Keeps the times that fulfil a condition, which ends with one of them.
    fn keep(&mut self, is_kept: impl Fn(f64) -> bool) {
        self.times.retain(|&time| is_kept(time));
        self.bodies.iter_mut().for_each(|drawing| drawing.written.truncate(self.times.len()));
    }

    /// Removes unlisted files of the series, complete or not. Files that cannot be removed do no harm.
    fn remove_unlisted(&self) {
        let Ok(entries) = fs::read_dir(&self.directory) else { return };
        let names = entries.flatten().filter_map(|entry| entry.file_name().into_string().ok());
        for name in names.filter(|name| self.is_unlisted(name)) {
            let _ = fs::remove_file(self.directory.join(name));
        }
    }

    /// Returns true if a name is that of an unfinished file of the series, or of one beyond its times.
    fn is_unlisted(&self, name: &str) -> bool {
        let (whole, is_unfinished) = match name.split_once(".part") {
            Some((whole, _)) => (whole, true),
            None => (name, false),
        };
        if whole == ALL {
            return is_unfinished || !self.lists_all();
        }
        self.bodies.iter().any(|drawing| {
            let Some(rest) = whole.strip_prefix(drawing.body.as_str()) else { return false };
            if rest == ".pvd" {
                return is_unfinished || drawing.kind.is_none();
            }
            let number = rest.strip_prefix('_').and_then(|rest| rest.split_once('.'));
            let Some((digits, ending)) = number else { return false };
            let is_ours = digits.len() >= DIGITS && ["vtr", "vts", "vtp"].contains(&ending);
            let place: Option<usize> = digits.parse().ok().filter(|_| is_ours);
            place.is_some_and(|place| is_unfinished || !drawing.has_file(place))
        })
    }

    /// Adds the fields of one state.
    pub fn write(
        &mut self,
        model: &Model,
        state: &State,
        cache: &mut Cache,
    ) -> Result<(), OutputError> {
        if self.times.last().is_some_and(|&last| last >= state.time) {
            self.keep(|time| time < state.time);
            // Files are unlisted while they are replaced.
            self.write_lists()?;
            self.remove_unlisted();
        }
        let write = |drawing: &Drawing| self.write_body(drawing, model, state, cache);
        match self.bodies.iter().map(write).collect::<Result<Vec<bool>, _>>() {
            Err(error) => {
                self.remove_unlisted();
                return Err(error);
            }
            Ok(written) => {
                self.bodies.iter_mut().zip(written).for_each(|(body, is)| body.written.push(is));
            }
        }
        self.times.push(state.time);
        self.write_lists()
    }

    /// Writes a body's fields at the next time, unless it has none; returns true if it has.
    fn write_body(
        &self,
        drawing: &Drawing,
        model: &Model,
        state: &State,
        cache: &mut Cache,
    ) -> Result<bool, OutputError> {
        let Some(kind) = drawing.kind else { return Ok(false) };
        let path = self.directory.join(drawing.file_name(kind, self.times.len()));
        let time = state.time;
        match model.fields(state, cache, &drawing.body)? {
            Fields::Nodes(fields) if kind == Kind::Revolved => {
                replace(&path, |out| vtk::write_revolved(out, time, &fields))
            }
            Fields::Nodes(fields) => replace(&path, |out| vtk::write_grid(out, time, &fields)),
            Fields::Particles(fields) if fields.position.is_empty() => return Ok(false),
            Fields::Particles(fields) => {
                replace(&path, |out| vtk::write_particles(out, time, &fields))
            }
        }?;
        Ok(true)
    }

    /// Returns true if several bodies are drawn, so that there is a list of all.
    fn lists_all(&self) -> bool {
        self.bodies.iter().filter(|drawing| drawing.kind.is_some()).count() > 1
    }

    /// Writes the list of each body that is drawn, and that of all if there are several.
    fn write_lists(&self) -> Result<(), OutputError> {
        let drawn: Vec<_> = self.bodies.iter().filter(|body| body.kind.is_some()).collect();
        for drawing in &drawn {
            let path = self.directory.join(drawing.list_name());
            replace(&path, |out| write_collection(out, drawing.entries(&self.times)))?;
        }
        if !self.lists_all() {
            return Ok(());
        }
        let parts = drawn.iter().enumerate();
        let mut entries: Vec<_> = parts
            .flat_map(|(part, body)| body.entries(&self.times).map(move |e| Entry { part, ..e }))
            .collect();
        entries.sort_by(|a, b| a.time.total_cmp(&b.time).then(a.part.cmp(&b.part)));
        replace(&self.directory.join(ALL), |out| write_collection(out, entries.into_iter()))
    }
}

impl Drawing {
    /// Name of the list of the body's files.
    fn list_name(&self) -> String {
        format!("{}.pvd", self.body)
    }

    /// Name of the file at the `place`-th time.
    fn file_name(&self, kind: Kind, place: usize) -> String {
        format!("{}_{place:0DIGITS$}.{}", self.body, kind.ending())
    }

    /// Returns true if there is a file of the `place`-th time.
    fn has_file(&self, place: usize) -> bool {
        self.written.get(place).is_some_and(|is_written| *is_written)
    }

    /// The files that there are, of all times [s].
    fn entries<'a>(&'a self, times: &'a [f64]) -> impl Iterator<Item = Entry<'a>> {
        let places = times.iter().enumerate().filter(|(place, _)| self.has_file(*place));
        places.filter_map(|(place, &time)| {
            let file = self.file_name(self.kind?, place);
            Some(Entry { time, part: 0, name: &self.body, file })
        })
    }
}

/// Name of the list of all bodies' files; no body has a name with a hyphen.
const ALL: &str = "all-bodies.pvd";

/// Form of discs in files; they are modelled in a meridian section.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Discs {
    /// The section, whose x is the radius.
    Sections,
    /// The section turned about the axis; a file is some 25 times as large.
    Revolved,
}

/// Content of a body's files.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Kind {
    Grid,
    Revolved,
    Particles,
}

/// Smallest number of digits of a file's number.
const DIGITS: usize = 6;

impl Kind {
    fn ending(self) -> &'static str {
        match self {
            Kind::Grid => "vtr",
            Kind::Revolved => "vts",
            Kind::Particles => "vtp",
        }
    }
}
