//! One rectilinear grid as a VTK XML file (`.vtr`), arrays appended as raw little-endian doubles.
//!
//! Source: *VTK File Formats*, <https://docs.vtk.org/en/latest/design_documents/VTKFileFormats.html>.

use std::io::{self, Write};

use quick_xml::Writer;
use quick_xml::events::{BytesDecl, BytesEnd, BytesStart, BytesText, Event};

use crate::material::stress::von_mises;
use crate::model::NodalFields;

const AXES: [&str; 3] = ["x", "y", "z"];
const STRESSES: [&str; 6] = ["xx", "yy", "zz", "xy", "yz", "xz"];
/// The same places in a meridian section, where y points around the axis.
const AXISYMMETRIC_STRESSES: [&str; 6] = ["rr", "tt", "zz", "rt", "tz", "rz"];

/// An array of the file. Tuples of `components.len()` values stand one after another; a scalar has
/// a single component without a name.
struct Array<'a> {
    name: &'static str,
    unit: &'static str,
    components: &'static [&'static str],
    values: &'a [f64],
}

impl Array<'_> {
    /// Bytes the array takes in the appended section: its length, then its values.
    fn appended_bytes(&self) -> usize {
        size_of::<u64>() + size_of_val(self.values)
    }
}

/// Writes the fields of one body at `time` [s].
pub fn write_grid(out: impl Write, time: f64, fields: &NodalFields) -> io::Result<()> {
    let von_mises: Vec<f64> = fields.stress.iter().copied().map(von_mises).collect();
    let time = [time];
    let time = Array { name: "TimeValue", unit: "s", components: &[""], values: &time };
    let points = point_arrays(fields, &von_mises);
    let axes: Vec<Array> = AXES
        .iter()
        .zip(&fields.axes)
        .map(|(name, axis)| Array { name, unit: "m", components: &[""], values: axis })
        .collect();

    let mut xml = Writer::new_with_indent(out, b' ', 2);
    xml.write_event(Event::Decl(BytesDecl::new("1.0", None, None)))?;
    let file = BytesStart::new("VTKFile").with_attributes([
        ("type", "RectilinearGrid"),
        ("version", "1.0"),
        ("byte_order", "LittleEndian"),
        ("header_type", "UInt64"),
    ]);
    xml.write_event(Event::Start(file))?;
    write_structure(&mut xml, &extent(fields), &time, &points, &axes)?;
    write_appended(&mut xml, std::iter::once(&time).chain(&points).chain(&axes))?;
    xml.write_event(Event::End(BytesEnd::new("VTKFile")))
}

/// The arrays at the nodes; mechanical ones where mechanics is modelled.
fn point_arrays<'a>(fields: &'a NodalFields, von_mises: &'a [f64]) -> Vec<Array<'a>> {
    let is_section = fields.axes[1].len() == 1;
    let stresses = if is_section { &AXISYMMETRIC_STRESSES } else { &STRESSES };
    let all = [
        ("temperature", "K", &[""][..], &fields.temperature[..]),
        ("displacement", "m", &AXES, fields.displacement.as_flattened()),
        ("stress", "Pa", stresses, fields.stress.as_flattened()),
        ("von_mises", "Pa", &[""], von_mises),
    ];
    all.into_iter()
        .filter(|(.., values)| !values.is_empty())
        .map(|(name, unit, components, values)| Array { name, unit, components, values })
        .collect()
}

/// Index range of the nodes along each axis.
fn extent(fields: &NodalFields) -> String {
    let [x, y, z] = fields.axes.each_ref().map(|axis| axis.len().saturating_sub(1));
    format!("0 {x} 0 {y} 0 {z}")
}

fn write_structure<W: Write>(
    xml: &mut Writer<W>,
    extent: &str,
    time: &Array,
    points: &[Array],
    axes: &[Array],
) -> io::Result<()> {
    let mut offset = 0;
    let grid = xml.create_element("RectilinearGrid").with_attribute(("WholeExtent", extent));
    grid.write_inner_content(|xml| {
        xml.create_element("FieldData")
            .write_inner_content(|xml| write_header(xml, time, Some("1"), &mut offset))?;
        let piece = xml.create_element("Piece").with_attribute(("Extent", extent));
        piece.write_inner_content(|xml| {
            let data = xml.create_element("PointData").with_attribute(("Scalars", "temperature"));
            data.write_inner_content(|xml| {
                points.iter().try_for_each(|array| write_header(xml, array, None, &mut offset))
            })?;
            xml.create_element("Coordinates").write_inner_content(|xml| {
                axes.iter().try_for_each(|array| write_header(xml, array, None, &mut offset))
            })?;
            Ok(())
        })?;
        Ok(())
    })?;
    Ok(())
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
        .with_attribute(("type", "Float64"))
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

fn write_appended<'a, W: Write>(
    xml: &mut Writer<W>,
    arrays: impl Iterator<Item = &'a Array<'a>>,
) -> io::Result<()> {
    let tag = BytesStart::new("AppendedData").with_attributes([("encoding", "raw")]);
    xml.write_event(Event::Start(tag))?;
    let out = xml.get_mut();
    out.write_all(b"_")?;
    for array in arrays {
        out.write_all(&(size_of_val(array.values) as u64).to_le_bytes())?;
        for value in array.values {
            out.write_all(&value.to_le_bytes())?;
        }
    }
    out.write_all(b"\n")?;
    xml.write_event(Event::End(BytesEnd::new("AppendedData")))
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;

    use quick_xml::Reader;

    use super::*;

    /// A body with a different value in every place.
    fn fields(axes: [Vec<f64>; 3]) -> NodalFields {
        let count = axes.iter().map(Vec::len).product();
        let value = |i: usize, c: usize| (1 + i) as f64 / 3.0 - c as f64;
        NodalFields {
            axes,
            temperature: (0..count).map(|i| 300.0 + value(i, 0)).collect(),
            displacement: (0..count).map(|i| [0, 1, 2].map(|c| 1e-9 * value(i, c))).collect(),
            stress: (0..count).map(|i| [0, 1, 2, 3, 4, 5].map(|c| 1e6 * value(i, c))).collect(),
        }
    }

    /// What a reader finds: attributes of the last element of each kind, arrays by name.
    #[derive(Default)]
    struct Read {
        elements: BTreeMap<String, BTreeMap<String, String>>,
        arrays: BTreeMap<String, (BTreeMap<String, String>, Vec<f64>)>,
    }

    fn read(bytes: &[u8]) -> Read {
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

    fn values(appended: &[u8], offset: usize) -> Vec<f64> {
        let word = |at: usize| <[u8; 8]>::try_from(&appended[at..at + 8]).unwrap();
        let bytes = u64::from_le_bytes(word(offset)) as usize;
        (0..bytes / 8).map(|i| f64::from_le_bytes(word(offset + 8 + 8 * i))).collect()
    }

    fn written(fields: &NodalFields) -> Vec<u8> {
        let mut bytes = Vec::new();
        write_grid(&mut bytes, 1.5e-6, fields).unwrap();
        bytes
    }

    #[test]
    fn a_grid_reads_back_bit_for_bit() {
        let fields = fields([vec![-1.0, 0.0, 1.0], vec![-0.5, 0.5], vec![-0.1, 0.0]]);
        let bytes = written(&fields);
        let read = read(&bytes);
        assert_eq!(read.elements["VTKFile"]["type"], "RectilinearGrid");
        assert_eq!(read.elements["Piece"]["Extent"], "0 2 0 1 0 1");
        assert_eq!(read.arrays["TimeValue"].1, [1.5e-6]);
        for (name, axis) in AXES.iter().zip(&fields.axes) {
            assert_eq!(&read.arrays[*name].1, axis);
        }
        assert_eq!(read.arrays["temperature"].1, fields.temperature);
        assert_eq!(read.arrays["displacement"].1, fields.displacement.as_flattened());
        assert_eq!(read.arrays["stress"].1, fields.stress.as_flattened());
        assert_eq!(read.arrays["stress"].0["ComponentName5"], "xz");
        assert_eq!(read.arrays["von_mises"].1.len(), fields.temperature.len());
        assert!(bytes.ends_with(b"</AppendedData>\n</VTKFile>"));
    }

    #[test]
    fn a_meridian_section_names_its_stresses_by_cylinder_coordinates() {
        let read = read(&written(&fields([vec![0.0, 1.0], vec![0.0], vec![-0.1, 0.0]])));
        assert_eq!(read.elements["RectilinearGrid"]["WholeExtent"], "0 1 0 0 0 1");
        assert_eq!(read.arrays["stress"].0["ComponentName1"], "tt");
    }

    #[test]
    fn a_body_without_mechanics_has_temperature_only() {
        let mut fields = fields([vec![0.0, 1.0], vec![0.0, 1.0], vec![-0.1, 0.0]]);
        fields.displacement.clear();
        fields.stress.clear();
        let read = read(&written(&fields));
        let names: Vec<_> = read.arrays.keys().map(String::as_str).collect();
        assert_eq!(names, ["TimeValue", "temperature", "x", "y", "z"]);
    }
}
