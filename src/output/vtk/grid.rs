//! The nodes of a box: one rectilinear grid (`.vtr`).

use std::io::{self, Write};

use quick_xml::Writer;

use super::{AXES, Array, Values, write_file, write_structure};
use crate::laws::stress::{max_principal, von_mises};
use crate::model::NodalFields;

const STRESSES: [&str; 6] = ["xx", "yy", "zz", "xy", "yz", "xz"];

/// Writes the fields of one body at `time` [s].
pub fn write_grid(out: impl Write, time: f64, fields: &NodalFields) -> io::Result<()> {
    let [von_mises, max_principal] = invariants(&fields.stress);
    let time = [time];
    let time = Array::scalar("TimeValue", "s", &time);
    let points = point_arrays(fields, [&von_mises, &max_principal]);
    let axes: Vec<Array> =
        AXES.iter().zip(&fields.axes).map(|(name, axis)| Array::scalar(name, "m", axis)).collect();
    let extent = extent(fields);
    let structure = |xml: &mut Writer<_>| {
        let grid = ("RectilinearGrid", &[("WholeExtent", extent.as_str())][..]);
        let piece = [("Extent", extent.as_str())];
        write_structure(xml, grid, &piece, (&time, &points), &[("Coordinates", &axes)])
    };
    let arrays: Vec<&Array> = std::iter::once(&time).chain(&points).chain(&axes).collect();
    write_file(out, "RectilinearGrid", structure, &arrays)
}

/// Von Mises and largest principal stresses.
pub fn invariants(stress: &[[f64; 6]]) -> [Vec<f64>; 2] {
    [von_mises, max_principal].map(|invariant| stress.iter().copied().map(invariant).collect())
}

/// The arrays at the nodes; mechanical ones where mechanics is modelled.
pub fn point_arrays<'a>(
    fields: &'a NodalFields,
    [von_mises, max_principal]: [&'a [f64]; 2],
) -> Vec<Array<'a>> {
    let all = [
        ("temperature", "K", &[""][..], &fields.temperature[..]),
        ("displacement", "m", &AXES, fields.displacement.as_flattened()),
        ("stress", "Pa", &STRESSES, fields.stress.as_flattened()),
        ("von_mises", "Pa", &[""], von_mises),
        ("max_principal", "Pa", &[""], max_principal),
        ("plastic_strain", "1", &[""], &fields.plastic_strain),
        ("damage", "1", &[""], &fields.damage),
    ];
    all.into_iter()
        .filter(|(.., values)| !values.is_empty())
        .map(|(name, unit, components, values)| {
            let values = Values::Real(values);
            Array { name, unit, components, values }
        })
        .collect()
}

/// Index range of the nodes along each axis.
fn extent(fields: &NodalFields) -> String {
    let [x, y, z] = fields.axes.each_ref().map(|axis| axis.len().saturating_sub(1));
    format!("0 {x} 0 {y} 0 {z}")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::output::vtk::reader::read;

    /// A body with a different value in every place.
    fn fields(axes: [Vec<f64>; 3]) -> NodalFields {
        let count = axes.iter().map(Vec::len).product();
        let value = |i: usize, c: usize| (1 + i) as f64 / 3.0 - c as f64;
        NodalFields {
            axes,
            temperature: (0..count).map(|i| 300.0 + value(i, 0)).collect(),
            displacement: (0..count).map(|i| [0, 1, 2].map(|c| 1e-9 * value(i, c))).collect(),
            stress: (0..count).map(|i| [0, 1, 2, 3, 4, 5].map(|c| 1e6 * value(i, c))).collect(),
            plastic_strain: (0..count).map(|i| 1e-3 * value(i, 0)).collect(),
            damage: (0..count).map(|i| 1e-2 * value(i, 0)).collect(),
        }
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
        let largest = fields.stress.iter().map(|&stress| max_principal(stress));
        assert_eq!(read.arrays["max_principal"].1, largest.collect::<Vec<_>>());
        assert_eq!(read.arrays["von_mises"].1.len(), fields.temperature.len());
        assert_eq!(read.arrays["plastic_strain"].1, fields.plastic_strain);
        assert_eq!(read.arrays["damage"].1, fields.damage);
        assert!(bytes.ends_with(b"</AppendedData>\n</VTKFile>"));
    }

    #[test]
    fn body_without_mechanics_has_only_temperature() {
        let mut fields = fields([vec![0.0, 1.0], vec![0.0, 1.0], vec![-0.1, 0.0]]);
        fields.displacement.clear();
        fields.stress.clear();
        fields.plastic_strain.clear();
        fields.damage.clear();
        let read = read(&written(&fields));
        let names: Vec<_> = read.arrays.keys().map(String::as_str).collect();
        assert_eq!(names, ["TimeValue", "temperature", "x", "y", "z"]);
    }
}
