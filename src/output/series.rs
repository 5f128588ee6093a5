use std::fs::{self, File};
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

use quick_xml::Writer;
use quick_xml::events::{BytesDecl, Event};

use super::{OutputError, vtk};
use crate::model::{Cache, Model, State};

/// The fields of all bodies as ParaView time series: `BODY.pvd` lists one `BODY_NNNNNN.vtr` (the nodes
/// of a solid) or `.vtp` (the particles of a droplet) a time.
///
/// Files appear whole or not at all, and the list is brought up to date after each time, so a run
/// that is cut off leaves a readable series. A state whose time is not past the last one replaces what
/// was written from that time on.
pub struct FieldSeries {
    directory: PathBuf,
    /// Names and kinds of their files.
    bodies: Vec<(String, Kind)>,
    /// Times written so far, ascending [s].
    times: Vec<f64>,
}

impl FieldSeries {
    /// Creates the folder where it is missing, and empty lists in it.
    pub fn create(directory: &Path, model: &Model) -> Result<Self, OutputError> {
        fs::create_dir_all(directory).map_err(OutputError::at("create the folder", directory))?;
        let solids = model.scene().solids().map(|(name, _)| (name.to_owned(), Kind::Grid));
        let droplets = model.scene().droplets().map(|(name, _)| (name.to_owned(), Kind::Particles));
        let bodies = solids.chain(droplets).collect();
        let series = Self { directory: directory.to_owned(), bodies, times: Vec::new() };
        for body in &series.bodies {
            series.write_list(body)?;
        }
        Ok(series)
    }

    /// Forgets the times after `time` [s]: a state of that time was restored. Their files are replaced
    /// as the run goes on.
    pub fn go_back(&mut self, time: f64) {
        self.times.retain(|&written| written <= time);
    }

    /// Adds the fields of one state.
    pub fn write(
        &mut self,
        model: &Model,
        state: &State,
        cache: &mut Cache,
    ) -> Result<(), OutputError> {
        self.times.retain(|&time| time < state.time);
        let place = self.times.len();
        self.times.push(state.time);
        for body in &self.bodies {
            let path = self.directory.join(file_name(body, place));
            match body.1 {
                Kind::Grid => {
                    let fields = model.nodal_fields(state, cache, &body.0)?;
                    replace(&path, |out| vtk::write_grid(out, state.time, &fields))?;
                }
                Kind::Particles => {
                    let fields = model.particle_fields(state, &body.0);
                    replace(&path, |out| vtk::write_particles(out, state.time, &fields))?;
                }
            }
            self.write_list(body)?;
        }
        Ok(())
    }

    fn write_list(&self, body: &(String, Kind)) -> Result<(), OutputError> {
        let path = self.directory.join(format!("{}.pvd", body.0));
        replace(&path, |out| write_collection(out, body, &self.times))
    }
}

/// What a body's files hold.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Kind {
    Grid,
    Particles,
}

/// Name of the file of a body at its `place`-th time.
fn file_name((body, kind): &(String, Kind), place: usize) -> String {
    let ending = match kind {
        Kind::Grid => "vtr",
        Kind::Particles => "vtp",
    };
    format!("{body}_{place:06}.{ending}")
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

/// Writes a file beside `path` and puts it in its place once it is complete.
fn replace(
    path: &Path,
    write: impl FnOnce(&mut BufWriter<File>) -> io::Result<()>,
) -> Result<(), OutputError> {
    let mut unfinished = path.as_os_str().to_owned();
    unfinished.push(".part");
    let fill = || {
        let mut out = BufWriter::new(File::create(&unfinished)?);
        write(&mut out)?;
        out.flush()?;
        drop(out);
        fs::rename(&unfinished, path)
    };
    fill().map_err(OutputError::at("write", path))
}
