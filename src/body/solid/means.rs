//! Means over the cells of a face for fields on footprints.

use super::linear::SolidChange;
use super::point::PointQuantity;
use super::reader::SolidReader;
use crate::body::BodyError;
use crate::coupling::FaceMeans;
use crate::method::fem::Mesh;
use crate::scene::{FaceName, FieldCells, Gives, Sampling, Scene, Solid};

/// Returns the means of a body's fields, each with the place of its field among the scene's.
pub fn means_of(
    scene: &Scene,
    (name, solid): (&str, &Solid),
    [heat, force]: [&Mesh; 2],
) -> Vec<(usize, FaceMeans)> {
    let own = scene.field.iter().enumerate().filter(|(_, field)| field.body_and_place().0 == name);
    let means = own.filter_map(|(place, field)| match field.sampling(solid) {
        Sampling::Points(_) => None,
        Sampling::Cells(FieldCells { face, footprint, at }) => {
            let force = field.gives.iter().any(Gives::is_mechanical).then_some(force);
            let is_top = face == FaceName::Top;
            Some((place, FaceMeans::of((heat, force), is_top, &footprint, at)))
        }
    });
    means.collect()
}

impl PointQuantity {
    /// Mean over a cell: exact for temperatures, otherwise of values interpolated between nodes.
    pub(super) fn mean(
        &self,
        reader: &mut SolidReader,
        (field, cell): (usize, usize),
    ) -> Result<f64, BodyError> {
        let means = reader.body.means(field);
        if !self.is_mechanical() {
            return Ok(reader.initial_temperature() + reader.mean_rise(means, cell));
        }
        let by_rows = self.component().and_then(|own| reader.mean_by_rows((field, cell), own));
        if let Some(mean) = by_rows {
            return mean;
        }
        weighted(means.points(cell), |point| self.read(reader, point, false))
    }

    pub(super) fn mean_rate(
        &self,
        change: &mut SolidChange,
        (field, cell): (usize, usize),
    ) -> Result<f64, BodyError> {
        let means = change.now.body.means(field);
        if !self.is_mechanical() {
            return Ok(change.change.mean_rise(means, cell));
        }
        let own = self.component();
        if let Some(mean) = own.and_then(|own| change.change.mean_by_rows((field, cell), own)) {
            return mean;
        }
        weighted(means.points(cell), |point| self.rate(change, point, false))
    }
}

fn weighted(
    points: &[([f64; 3], f64)],
    mut value: impl FnMut([f64; 3]) -> Result<f64, BodyError>,
) -> Result<f64, BodyError> {
    let mut sum = 0.0;
    for &(point, weight) in points {
        sum += weight * value(point)?;
    }
    Ok(sum)
}
