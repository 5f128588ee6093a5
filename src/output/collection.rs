//! Lists of files over time, as ParaView opens them (`.pvd`).

use std::io::{self, Write};

use quick_xml::Writer;
use quick_xml::events::{BytesDecl, Event};

/// A file of a list.
pub struct Entry<'a> {
    /// [s]
    pub time: f64,
    /// Number of the body among those of the list.
    pub part: usize,
    /// Name of the body.
    pub name: &'a str,
    /// Name of the file, in the folder of the list.
    pub file: String,
}

/// Writes a collection of files.
pub fn write_collection<'a>(
    out: impl Write,
    entries: impl Iterator<Item = Entry<'a>>,
) -> io::Result<()> {
    let mut xml = Writer::new_with_indent(out, b' ', 2);
    xml.write_event(Event::Decl(BytesDecl::new("1.0", None, None)))?;
    let file = xml.create_element("VTKFile").with_attributes([
        ("type", "Collection"),
        ("version", "1.0"),
        ("byte_order", "LittleEndian"),
    ]);
    file.write_inner_content(|xml| {
        xml.create_element("Collection").write_inner_content(|xml| {
            for entry in entries {
                xml.create_element("DataSet")
                    .with_attribute(("timestep", format!("{:?}", entry.time).as_str()))
                    .with_attribute(("part", entry.part.to_string().as_str()))
                    .with_attribute(("name", entry.name))
                    .with_attribute(("file", entry.file.as_str()))
                    .write_empty()?;
            }
            Ok(())
        })?;
        Ok(())
    })?;
    Ok(())
}
