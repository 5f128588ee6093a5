//! The nodes of a disc, whose meridian section is revolved about the axis: a structured grid (`.vts`).
//!
//! Viewers show a meridian section as the half plane alone. Here it is repeated at equal angles, with vectors and
//! tensors rotated into components along x, y, z. Values at the angle 0 are those of the section to the bit.

use std::f64::consts::TAU;
use std::io::{self, Write};

use quick_xml::Writer;

use super::grid::{invariants, point_arrays};
use super::{AXES, Array, Values, write_file, write_structure};
use crate::model::NodalFields;

/// Number of angles: with 24 the outline is within 1 % of a circle.
const SECTORS: usize = 24;
/// Number of sections in a file: the first angle stands at the end again.
pub const SECTIONS: usize = SECTORS + 1;

/// Writes the fields of a disc at `time` [s].
pub fn write_revolved(out: impl Write, time: f64, fields: &NodalFields) -> io::Result<()> {
    let whole = revolved(fields);
    let [von_mises, max_principal] = invariants(&whole.fields.stress);
    let time = [time];
    let time = Array::scalar("TimeValue", "s", &time);
    let points = point_arrays(&whole.fields, [&von_mises, &max_principal]);
    let places = [Array {
        name: "position",
        unit: "m",
        components: &AXES,
        values: Values::Real(whole.position.as_flattened()),
    }];
    let extent = format!("0 {} 0 {SECTORS} 0 {}", whole.counts[0] - 1, whole.counts[1] - 1);
    let structure = |xml: &mut Writer<_>| {
        let grid = ("StructuredGrid", &[("WholeExtent", extent.as_str())][..]);
        let piece = [("Extent", extent.as_str())];
        write_structure(xml, grid, &piece, (&time, &points), &[("Points", &places)])
    };
    let arrays: Vec<&Array> = std::iter::once(&time).chain(&points).chain(&places).collect();
    write_file(out, "StructuredGrid", structure, &arrays)
}

/// Nodes of all sections.
struct Revolved {
    /// Numbers of nodes along the radius and z.
    counts: [usize; 2],
    position: Vec<[f64; 3]>,
    /// Values at the nodes.
    fields: NodalFields,
}

/// The section at all angles; the index along the radius runs fastest, then that of the angle, then z.
fn revolved(fields: &NodalFields) -> Revolved {
    let [radii, _, heights] = &fields.axes;
    let counts = [radii.len(), heights.len()];
    let angle = |sector: usize| {
        // Returns to the first angle to the bit.
        let angle = TAU * (sector % SECTORS) as f64 / SECTORS as f64;
        (angle.cos(), angle.sin())
    };
    let mut position = Vec::new();
    let mut all = NodalFields::default();
    for (k, &z) in heights.iter().enumerate() {
        for (cos, sin) in (0..=SECTORS).map(angle) {
            for (i, &r) in radii.iter().enumerate() {
                let node = k * counts[0] + i;
                position.push([r * cos, r * sin, z]);
                all.temperature.push(fields.temperature[node]);
                if let Some(&[u, v, w]) = fields.displacement.get(node) {
                    all.displacement.push([cos * u - sin * v, sin * u + cos * v, w]);
                }
                all.stress.extend(fields.stress.get(node).map(|stress| turned(*stress, cos, sin)));
                all.plastic_strain.extend(fields.plastic_strain.get(node));
                all.damage.extend(fields.damage.get(node));
            }
        }
    }
    Revolved { counts, position, fields: all }
}

/// Components along x, y, z of a stress rr, tt, zz, rt, tz, rz at an angle to the x axis: σ' = R σ Rᵀ.
fn turned([rr, tt, zz, rt, tz, rz]: [f64; 6], cos: f64, sin: f64) -> [f64; 6] {
    [
        cos * cos * rr + sin * sin * tt - 2.0 * sin * cos * rt,
        sin * sin * rr + cos * cos * tt + 2.0 * sin * cos * rt,
        zz,
        sin * cos * (rr - tt) + (cos * cos - sin * sin) * rt,
        sin * rz + cos * tz,
        cos * rz - sin * tz,
    ]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::output::vtk::reader::read;

    #[test]
    fn disc_is_written_as_full_revolution() {
        let fields = NodalFields {
            axes: [vec![0.0, 1.0, 2.0], vec![0.0], vec![-0.5, 0.0]],
            temperature: (0..6).map(|i| 300.0 + f64::from(i)).collect(),
            displacement: (0..6).map(|i| [f64::from(i), 0.0, -1.0]).collect(),
            stress: vec![[5.0, 3.0, 1.0, 0.0, 0.0, 2.0]; 6],
            plastic_strain: Vec::new(),
            damage: Vec::new(),
        };
        let mut bytes = Vec::new();
        write_revolved(&mut bytes, 2.5e-6, &fields).unwrap();
        let read = read(&bytes);
        assert_eq!(read.elements["VTKFile"]["type"], "StructuredGrid");
        assert_eq!(read.elements["Piece"]["Extent"], format!("0 2 0 {SECTORS} 0 1"));
        let vector = |name: &str, node: usize| read.arrays[name].1[3 * node..][..3].to_vec();
        let stress = |node: usize| read.arrays["stress"].1[6 * node..][..6].to_vec();
        let close = |a: Vec<f64>, b: &[f64]| a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-14);
        // The section itself, a quarter turn, and the full turn.
        let quarter = 3 * (SECTORS / 4) + 2;
        let last = 3 * SECTORS + 2;
        for (node, place, moved, pulled) in [
            (2, [2.0, 0.0, -0.5], [2.0, 0.0, -1.0], [5.0, 3.0, 1.0, 0.0, 0.0, 2.0]),
            (quarter, [0.0, 2.0, -0.5], [0.0, 2.0, -1.0], [3.0, 5.0, 1.0, 0.0, 2.0, 0.0]),
            (last, [2.0, 0.0, -0.5], [2.0, 0.0, -1.0], [5.0, 3.0, 1.0, 0.0, 0.0, 2.0]),
        ] {
            assert_eq!(read.arrays["temperature"].1[node], 302.0);
            assert!(close(vector("position", node), &place), "{node}");
            assert!(close(vector("displacement", node), &moved), "{node}");
            assert!(close(stress(node), &pulled), "{node}: {:?}", stress(node));
        }
        assert_eq!(read.arrays["stress"].0["ComponentName5"], "xz");
        // Invariants are the same at all angles: σ₁ of [5 2; 2 1] and 3.
        let largest = &read.arrays["max_principal"].1;
        assert!(largest.iter().all(|s| (s - (3.0 + 8f64.sqrt())).abs() < 1e-12), "{largest:?}");
    }
}
