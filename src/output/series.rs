//! Fields over time as files of ParaView.

use std::fs::{self, File};
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};
use std::process;
use std::sync::atomic::{AtomicUsize, Ordering};

use quick_xml::Writer;
use quick_xml::events::{BytesDecl, Event};

use super::{OutputError, vtk};
use crate::body::Fields;
use crate::model::{Cache, Model, State};
use crate::scene::{Body, Drawn, Scene};

/// The fields of all bodies as ParaView time series. For each time `BODY.pvd` lists one `BODY_NNNNNN.vtr` (the nodes of
/// a box, or of a disc's meridian section), `.vts` (those of a disc, revolved about its axis) or `.vtp` (the particles of
/// a droplet).
///
/// Files appear whole or not at all, and the list is updated after each time, so an interrupted run leaves a readable
/// series. A time with a file that cannot be written is not listed. A state whose time is not later than the last one
/// replaces all times from its own on. Files of the series that are no longer listed are removed, also those of an
/// earlier run.
pub struct FieldSeries {
    directory: PathBuf,
    /// Names of the bodies, and kinds of their files.
    bodies: Vec<(String, Kind)>,
    /// Times written so far, ascending [s].
    times: Vec<f64>,
}

impl FieldSeries {
    /// Creates the folder if it is missing, and empty lists in it; removes the files of an earlier series of these
    /// bodies.
    pub fn create(directory: &Path, model: &Model, discs: Discs) -> Result<Self, OutputError> {
        fs::create_dir_all(directory).map_err(OutputError::at("create the folder", directory))?;
        let series = Self::of(directory, model.scene(), discs);
        for body in &series.bodies {
            series.write_list(body)?;
        }
        series.remove_unlisted();
        Ok(series)
    }

    /// A series without times, with nothing written yet.
    fn of(directory: &Path, scene: &Scene, discs: Discs) -> Self {
        let kind = |body: &Body| match body.drawn_as()? {
            Drawn::Grid if body.is_round() && discs == Discs::Revolved => Some(Kind::Revolved),
            Drawn::Grid => Some(Kind::Grid),
            Drawn::Particles => Some(Kind::Particles),
        };
        let bodies = scene.bodies_by_kind().into_iter();
        let bodies =
            bodies.filter_map(|(name, body)| Some((name.to_owned(), kind(body)?))).collect();
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
        self.bodies.iter().any(|(body, _)| name.strip_suffix(".pvd") == Some(body.as_str()))
    }

    /// The first file in a folder that a series of a scene's bodies would replace or remove.
    pub fn found_in(directory: &Path, scene: &Scene) -> Option<PathBuf> {
        let series = Self::of(directory, scene, Discs::Sections);
        let entries = fs::read_dir(directory).ok()?;
        let names = entries.flatten().filter_map(|entry| entry.file_name().into_string().ok());
        let own = names.filter(|name| series.is_list(name) || series.is_unlisted(name)).min()?;
        Some(directory.join(own))
    }

    /// Checks that the lists and all their files exist.
    pub fn check_present(&self) -> Result<(), OutputError> {
        let files = self.bodies.iter().flat_map(|body| {
            let files = (0..self.times.len()).map(|place| file_name(body, place));
            files.chain([format!("{}.pvd", body.0)])
        });
        let mut paths = files.map(|name| self.directory.join(name));
        match paths.find(|path| !path.exists()) {
            None => Ok(()),
            Some(path) => Err(OutputError::Gone { path }),
        }
    }

    /// Discards the times after `time` [s], when a state of that time was restored.
    pub fn go_back(&mut self, time: f64) -> Result<(), OutputError> {
        self.times.retain(|&written| written <= time);
        self.bodies.iter().try_for_each(|body| self.write_list(body))?;
        self.remove_unlisted();
        Ok(())
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
        self.bodies.iter().any(|(body, _)| {
            let Some(rest) = whole.strip_prefix(body.as_str()) else { return false };
            if rest == ".pvd" {
                return is_unfinished;
            }
            let number = rest.strip_prefix('_').and_then(|rest| rest.split_once('.'));
            let Some((digits, ending)) = number else { return false };
            let is_ours = digits.len() >= DIGITS && ["vtr", "vts", "vtp"].contains(&ending);
            let place: Option<usize> = digits.parse().ok().filter(|_| is_ours);
            place.is_some_and(|place| is_unfinished || place >= self.times.len())
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
            self.times.retain(|&time| time < state.time);
            // Files are unlisted while they are replaced.
            self.bodies.iter().try_for_each(|body| self.write_list(body))?;
            self.remove_unlisted();
        }
        let written =
            self.bodies.iter().try_for_each(|body| self.write_body(body, model, state, cache));
        if let Err(error) = written {
            self.remove_unlisted();
            return Err(error);
        }
        self.times.push(state.time);
        self.bodies.iter().try_for_each(|body| self.write_list(body))
    }

    /// Writes a body's fields at the next time.
    fn write_body(
        &self,
        body: &(String, Kind),
        model: &Model,
        state: &State,
        cache: &mut Cache,
    ) -> Result<(), OutputError> {
        let path = self.directory.join(file_name(body, self.times.len()));
        let time = state.time;
        match model.fields(state, cache, &body.0)? {
            Fields::Nodes(fields) if body.1 == Kind::Revolved => {
                replace(&path, |out| vtk::write_revolved(out, time, &fields))
            }
            Fields::Nodes(fields) => replace(&path, |out| vtk::write_grid(out, time, &fields)),
            Fields::Particles(fields) => {
                replace(&path, |out| vtk::write_particles(out, time, &fields))
            }
        }
    }

    fn write_list(&self, body: &(String, Kind)) -> Result<(), OutputError> {
        let path = self.directory.join(format!("{}.pvd", body.0));
        replace(&path, |out| write_collection(out, body, &self.times))
    }
}

/// How files show discs, which are modelled in a meridian section.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Discs {
    /// The section as it is: x is the radius.
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

/// Name of the file of a body at its `place`-th time.
fn file_name((body, kind): &(String, Kind), place: usize) -> String {
    let ending = match kind {
        Kind::Grid => "vtr",
        Kind::Revolved => "vts",
        Kind::Particles => "vtp",
    };
    format!("{body}_{place:0DIGITS$}.{ending}")
}

/// Writes a ParaView collection of a body's files at `times` [s].
fn write_collection(out: impl Write, body: &(String, Kind), times: &[f64]) -> io::Result<()> {
    let mut xml = Writer::new_with_indent(out, b' ', 2);
    xml.write_event(Event::Decl(BytesDecl::new("1.0", None, None)))?;
    let file = xml.create_element("VTKFile").with_attributes([
        ("type", "Collection"),
        ("version", "1.0"),
        ("byte_order", "LittleEndian"),
    ]);
    file.write_inner_content(|xml| {
        xml.create_element("Collection").write_inner_content(|xml| {
            for (place, time) in times.iter().enumerate() {
                xml.create_element("DataSet")
                    .with_attribute(("timestep", format!("{time:?}").as_str()))
                    .with_attribute(("part", "0"))
                    .with_attribute(("file", file_name(body, place).as_str()))
                    .write_empty()?;
            }
            Ok(())
        })?;
        Ok(())
    })?;
    Ok(())
}

/// Writes a temporary file next to `path` and renames it once it is complete; leaves no temporary file.
fn replace(
    path: &Path,
    write: impl FnOnce(&mut BufWriter<File>) -> io::Result<()>,
) -> Result<(), OutputError> {
    // A unique name, in case another series is written to the same folder.
    static COUNT: AtomicUsize = AtomicUsize::new(0);
    let count = COUNT.fetch_add(1, Ordering::Relaxed);
    let mut unfinished = path.as_os_str().to_owned();
    unfinished.push(format!(".part{}_{count}", process::id()));
    let fill = || {
        let mut out = BufWriter::new(File::create(&unfinished)?);
        write(&mut out)?;
        out.flush()?;
        drop(out);
        fs::rename(&unfinished, path)
    };
    fill().map_err(|reason| {
        let _ = fs::remove_file(&unfinished);
        OutputError::at("write", path)(reason)
    })
}
