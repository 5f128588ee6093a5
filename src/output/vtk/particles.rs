//! The particles of a droplet, or the segments of a strand: points (`.vtp`).

use std::io::{self, Write};

use quick_xml::Writer;

use super::{Array, write_file, write_structure};
use crate::model::ParticleFields;

/// Writes the particles of one droplet at `time` [s].
pub fn write_particles(out: impl Write, time: f64, fields: &ParticleFields) -> io::Result<()> {
    let count = fields.position.len();
    let time = [time];
    let time = Array::scalar("TimeValue", "s", &time);
    let mut points = vec![
        Array::scalar("temperature", "K", &fields.temperature),
        Array::scalar("pressure", "Pa", &fields.pressure),
        Array::scalar("density", "kg/m3", &fields.density),
        Array::scalar("mass", "kg", &fields.mass),
        Array::vector("velocity", "m/s", &fields.velocity),
    ];
    if !fields.solid_fraction.is_empty() {
        points.push(Array::scalar("solid_fraction", "1", &fields.solid_fraction));
    }
    if !fields.width.is_empty() {
        points.push(Array::scalar("width", "m", &fields.width));
    }
    if !fields.damage.is_empty() {
        points.push(Array::scalar("damage", "1", &fields.damage));
    }
    if !fields.displacement.is_empty() {
        points.push(Array::vector("displacement", "m", &fields.displacement));
        points.push(Array::scalar("von_mises", "Pa", &fields.von_mises));
    }
    let places = [Array::vector("position", "m", &fields.position)];
    // Viewers draw cells, so each point is one.
    let own: Vec<i64> = (0..count as i64).collect();
    let ends: Vec<i64> = (1..=count as i64).collect();
    let cells = [Array::indices("connectivity", &own), Array::indices("offsets", &ends)];
    let count = count.to_string();
    let structure = |xml: &mut Writer<_>| {
        let piece = [("NumberOfPoints", count.as_str()), ("NumberOfVerts", count.as_str())];
        let others = [("Points", &places[..]), ("Verts", &cells)];
        write_structure(xml, ("PolyData", &[]), &piece, (&time, &points), &others)
    };
    let all = std::iter::once(&time).chain(&points).chain(&places).chain(&cells);
    write_file(out, "PolyData", structure, &all.collect::<Vec<_>>())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::output::vtk::reader::read;

    #[test]
    fn particles_read_back_bit_for_bit() {
        let fields = ParticleFields {
            position: vec![[0.1, 0.2, 0.3], [-1.0 / 3.0, 2.0, 1e-6]],
            velocity: vec![[0.0, 0.0, -50.0], [1.0, 2.0, 3.0]],
            mass: vec![1e-14, 2e-14],
            density: vec![1000.0, 1010.5],
            pressure: vec![0.0, 2.6e6],
            temperature: vec![373.15, 300.1],
            solid_fraction: vec![0.0, 0.75],
            width: vec![1e-3, 2e-3],
            damage: vec![0.0, 1.0],
            displacement: vec![[0.0, 1e-3, 0.0], [2e-3, 0.0, -1e-6]],
            von_mises: vec![3e6, 0.0],
        };
        let mut bytes = Vec::new();
        write_particles(&mut bytes, 2e-6, &fields).unwrap();
        let read = read(&bytes);
        assert_eq!(read.elements["VTKFile"]["type"], "PolyData");
        assert_eq!(read.elements["Piece"]["NumberOfVerts"], "2");
        assert_eq!(read.arrays["TimeValue"].1, [2e-6]);
        assert_eq!(read.arrays["position"].1, fields.position.as_flattened());
        assert_eq!(read.arrays["velocity"].1, fields.velocity.as_flattened());
        assert_eq!(read.arrays["displacement"].1, fields.displacement.as_flattened());
        for (name, values) in [
            ("mass", &fields.mass),
            ("density", &fields.density),
            ("pressure", &fields.pressure),
            ("temperature", &fields.temperature),
            ("solid_fraction", &fields.solid_fraction),
            ("width", &fields.width),
            ("damage", &fields.damage),
            ("von_mises", &fields.von_mises),
        ] {
            assert_eq!(&read.arrays[name].1, values, "{name}");
        }
        for (name, whole) in [("connectivity", [0, 1]), ("offsets", [1, 2])] {
            let (attributes, values) = &read.arrays[name];
            let bits: Vec<u64> = values.iter().map(|value| value.to_bits()).collect();
            assert_eq!((attributes["type"].as_str(), bits), ("Int64", whole.to_vec()), "{name}");
        }
    }

    #[test]
    fn empty_particle_file() {
        let mut bytes = Vec::new();
        write_particles(&mut bytes, 0.0, &ParticleFields::default()).unwrap();
        assert_eq!(read(&bytes).elements["Piece"]["NumberOfPoints"], "0");
    }
}
