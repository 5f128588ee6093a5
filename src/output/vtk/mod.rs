//! VTK XML files with appended arrays of raw little-endian numbers of eight bytes.
//!
//! Source: *VTK File Formats*, <https://docs.vtk.org/en/latest/design_documents/VTKFileFormats.html>.

mod grid;
mod particles;
mod revolved;

use std::io::{self, Write};

use quick_xml::Writer;
use quick_xml::events::{BytesDecl, BytesEnd, BytesStart, BytesText, Event};

pub use grid::write_grid;
pub use particles::write_particles;
pub use revolved::{SECTIONS, write_revolved};

const AXES: [&str; 3] = ["x", "y", "z"];

/// An array of a file. Tuples of `components.len()` values stand one after another; a scalar has
/// a single component without a name.
struct Array<'a> {
    name: &'static str,
    unit: &'static str,
    components: &'static [&'static str],
    values: Values<'a>,
}

enum Values<'a> {
    Real(&'a [f64]),
    Whole(&'a [i64]),
}

impl<'a> Array<'a> {
    fn scalar(name: &'static str, unit: &'static str, values: &'a [f64]) -> Self {
        Self { name, unit, components: &[""], values: Values::Real(values) }
    }

    fn vector(name: &'static str, unit: &'static str, values: &'a [[f64; 3]]) -> Self {
        Self { name, unit, components: &AXES, values: Values::Real(values.as_flattened()) }
    }

    /// Numbers of points or cells.
    fn indices(name: &'static str, values: &'a [i64]) -> Self {
        Self { name, unit: "1", components: &[""], values: Values::Whole(values) }
    }

    /// VTK's name of the number type.
    fn type_name(&self) -> &'static str {
        match self.values {
            Values::Real(_) => "Float64",
            Values::Whole(_) => "Int64",
        }
    }

    fn bytes(&self) -> usize {
        match self.values {
            Values::Real(values) => size_of_val(values),
            Values::Whole(values) => size_of_val(values),
        }
    }

    /// Number of bytes of the array in the appended section: its length, then its values.
    fn appended_bytes(&self) -> usize {
        size_of::<u64>() + self.bytes()
    }
}

/// Writes a file of a kind of data set: `structure` describes arrays, in the order of `arrays`.
fn write_file<W: Write>(
    out: W,
    kind: &str,
    structure: impl FnOnce(&mut Writer<W>) -> io::Result<()>,
    arrays: &[&Array],
) -> io::Result<()> {
    let mut xml = Writer::new_with_indent(out, b' ', 2);
    xml.write_event(Event::Decl(BytesDecl::new("1.0", None, None)))?;
    let file = BytesStart::new("VTKFile").with_attributes([
        ("type", kind),
        ("version", "1.0"),
        ("byte_order", "LittleEndian"),
        ("header_type", "UInt64"),
    ]);
    xml.write_event(Event::Start(file))?;
    structure(&mut xml)?;
    write_appended(&mut xml, arrays)?;
    xml.write_event(Event::End(BytesEnd::new("VTKFile")))
}

/// Writes nested elements, each a name with its attributes, with a time and one piece. The piece holds arrays at
/// points, and further arrays under their own elements.
fn write_structure<W: Write>(
    xml: &mut Writer<W>,
    (grid, grid_attributes): (&str, &[(&str, &str)]),
    piece_attributes: &[(&str, &str)],
    (time, points): (&Array, &[Array]),
    others: &[(&str, &[Array])],
) -> io::Result<()> {
    let mut offset = 0;
    let grid = xml.create_element(grid).with_attributes(grid_attributes.iter().copied());
    grid.write_inner_content(|xml| {
        xml.create_element("FieldData")
            .write_inner_content(|xml| write_header(xml, time, Some("1"), &mut offset))?;
        let piece = xml.create_element("Piece");
        let piece = piece.with_attributes(piece_attributes.iter().copied());
        piece.write_inner_content(|xml| {
            let data = xml.create_element("PointData").with_attribute(("Scalars", "temperature"));
            data.write_inner_content(|xml| write_headers(xml, points, &mut offset))?;
            for (name, arrays) in others {
                let element = xml.create_element(*name);
                element.write_inner_content(|xml| write_headers(xml, arrays, &mut offset))?;
            }
            Ok(())
        })?;
        Ok(())
    })?;
    Ok(())
}

fn write_headers<W: Write>(
    xml: &mut Writer<W>,
    arrays: &[Array],
    offset: &mut usize,
) -> io::Result<()> {
    arrays.iter().try_for_each(|array| write_header(xml, array, None, offset))
}

/// Describes an array that begins at `offset` in the appended section, and moves `offset` past it.
fn write_header<W: Write>(
    xml: &mut Writer<W>,
    array: &Array,
    tuples: Option<&str>,
    offset: &mut usize,
) -> io::Result<()> {
    let mut element = xml
        .create_element("DataArray")
        .with_attribute(("type", array.type_name()))
        .with_attribute(("Name", array.name));
    if let Some(tuples) = tuples {
        element = element.with_attribute(("NumberOfTuples", tuples));
    }
    if array.components.len() > 1 {
        let count = array.components.len().to_string();
        element = element.with_attribute(("NumberOfComponents", count.as_str()));
        for (i, component) in array.components.iter().enumerate() {
            let key = format!("ComponentName{i}");
            element = element.with_attribute((key.as_str(), *component));
        }
    }
    let begin = offset.to_string();
    *offset += array.appended_bytes();
    element
        .with_attribute(("format", "appended"))
        .with_attribute(("offset", begin.as_str()))
        .write_inner_content(|xml| write_unit(xml, array.unit))?;
    Ok(())
}

/// VTK's own key for the unit of an array.
fn write_unit<W: Write>(xml: &mut Writer<W>, unit: &str) -> io::Result<()> {
    xml.create_element("InformationKey")
        .with_attribute(("name", "UNITS_LABEL"))
        .with_attribute(("location", "vtkDataArray"))
        .write_text_content(BytesText::new(unit))?;
    Ok(())
}

fn write_appended<W: Write>(xml: &mut Writer<W>, arrays: &[&Array]) -> io::Result<()> {
    let tag = BytesStart::new("AppendedData").with_attributes([("encoding", "raw")]);
    xml.write_event(Event::Start(tag))?;
    let out = xml.get_mut();
    out.write_all(b"_")?;
    for array in arrays {
        out.write_all(&(array.bytes() as u64).to_le_bytes())?;
        match array.values {
            Values::Real(values) => {
                values.iter().try_for_each(|value| out.write_all(&value.to_le_bytes()))?;
            }
            Values::Whole(values) => {
                values.iter().try_for_each(|value| out.write_all(&value.to_le_bytes()))?;
            }
        }
    }
    out.write_all(b"\n")?;
    xml.write_event(Event::End(BytesEnd::new("AppendedData")))
}

/// A small reader of such files.
#[cfg(test)]
mod reader {
    use std::collections::BTreeMap;

    use quick_xml::Reader;
    use quick_xml::events::Event;

    /// Result of reading: attributes of the last element of each kind, arrays by name.
    #[derive(Default)]
    pub struct Read {
        pub elements: BTreeMap<String, BTreeMap<String, String>>,
        pub arrays: BTreeMap<String, (BTreeMap<String, String>, Vec<f64>)>,
    }

    pub fn read(bytes: &[u8]) -> Read {
        let marker = b"<AppendedData encoding=\"raw\">_";
        let at = bytes.windows(marker.len()).position(|w| w == marker).unwrap();
        let appended = &bytes[at + marker.len()..];
        let mut reader = Reader::from_str(std::str::from_utf8(&bytes[..at]).unwrap());
        let mut found = Read::default();
        loop {
            let start = match reader.read_event().unwrap() {
                Event::Start(start) => start,
                Event::Eof => return found,
                _ => continue,
            };
            let element = start.name().as_ref().to_owned();
            let attributes: BTreeMap<_, _> = start
                .attributes()
                .map(Result::unwrap)
                .map(|a| (a.key.as_ref().to_owned(), a.value.into_owned()))
                .collect();
            if element == "DataArray" {
                let values = values(appended, attributes["offset"].parse().unwrap());
                found.arrays.insert(attributes["Name"].clone(), (attributes, values));
            } else {
                found.elements.insert(element, attributes);
            }
        }
    }

    /// Values of eight bytes each; whole numbers keep their bits.
    fn values(appended: &[u8], offset: usize) -> Vec<f64> {
        let word = |at: usize| <[u8; 8]>::try_from(&appended[at..at + 8]).unwrap();
        let bytes = u64::from_le_bytes(word(offset)) as usize;
        (0..bytes / 8).map(|i| f64::from_le_bytes(word(offset + 8 + 8 * i))).collect()
    }
}
