use std::fs::{self, File};
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

use quick_xml::Writer;
use quick_xml::events::{BytesDecl, Event};

use super::{OutputError, vtk};
use crate::model::{Cache, Model, State};

/// The fields of all bodies as ParaView time series: `BODY.pvd` lists one `BODY_NNNNNN.vtr` a time.
///
/// Files appear whole or not at all, and the list is brought up to date after each time, so a run
/// that is cut off leaves a readable series. A state whose time is not past the last one replaces what
/// was written from that time on.
pub struct FieldSeries {
    directory: PathBuf,
    bodies: Vec<String>,
    /// Times written so far, ascending [s].
    times: Vec<f64>,
}

impl FieldSeries {
    /// Creates the folder where it is missing, and empty lists in it.
    pub fn create(directory: &Path, model: &Model) -> Result<Self, OutputError> {
        fs::create_dir_all(directory).map_err(OutputError::at("create the folder", directory))?;
        let bodies = model.scene().body.keys().cloned().collect();
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
            let fields = model.nodal_fields(state, cache, body)?;
            let path = self.directory.join(grid_file(body, place));
            replace(&path, |out| vtk::write_grid(out, state.time, &fields))?;
            self.write_list(body)?;
        }
        Ok(())
    }

    fn write_list(&self, body: &str) -> Result<(), OutputError> {
        let path = self.directory.join(format!("{body}.pvd"));
        replace(&path, |out| write_collection(out, body, &self.times))
    }
}

/// Name of the file of a body at its `place`-th time.
fn grid_file(body: &str, place: usize) -> String {
    format!("{body}_{place:06}.vtr")
}

/// Writes a ParaView collection of the grids at `times` [s].
fn write_collection(out: impl Write, body: &str, times: &[f64]) -> io::Result<()> {
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
                    .with_attribute(("file", grid_file(body, place).as_str()))
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
