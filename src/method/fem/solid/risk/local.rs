//! Nodal values on one patch, interpolated and integrated by Gauss points.

use super::patch::{Patch, Points};
use crate::method::mesh::Mesh;

/// Nodal values of a patch relative to a scale.
pub(super) struct Local {
    values: [f64; 27],
    counts: [usize; 3],
    pub most: f64,
    pub least: f64,
}

impl Local {
    pub fn of(mesh: &Mesh, patch: &Patch, equivalent: &[f64], scale: f64) -> Self {
        let (mut values, mut most, mut least) = ([0.0; 27], f64::NEG_INFINITY, f64::INFINITY);
        patch.for_nodes(mesh, |place, node| {
            let value = equivalent[node] / scale;
            values[place] = value;
            most = most.max(value);
            least = least.min(value);
        });
        Self { values, counts: patch.spans.map(|span| span.count), most, least }
    }

    /// The same values over the largest.
    pub fn relative(&self) -> Self {
        let values = self.values.map(|value| value / self.most);
        Self { values, counts: self.counts, most: 1.0, least: self.least / self.most }
    }

    /// Largest change along lines of nodes in the direction of an axis, over twice the largest value; negative values
    /// count as zero.
    pub fn variation(&self, axis: usize) -> f64 {
        let stride = [1, 3, 9][axis];
        let others: [usize; 2] = std::array::from_fn(|i| (axis + 1 + i) % 3);
        let mut most = 0.0_f64;
        for i in 0..self.counts[others[0]] {
            for j in 0..self.counts[others[1]] {
                let first = i * [1, 3, 9][others[0]] + j * [1, 3, 9][others[1]];
                let line = (0..self.counts[axis]).map(|k| self.values[first + k * stride].max(0.0));
                let [low, high] =
                    line.fold([f64::INFINITY, 0.0], |[low, high], v| [low.min(v), high.max(v)]);
                most = most.max((high - low) / (2.0 * self.most - (high - low)));
            }
        }
        most
    }

    /// `∫ ⟨s⟩^m` over the patch, with a list of points for each axis.
    pub fn integral(&self, points: &Points, power: impl Fn(f64) -> f64) -> f64 {
        let cap = self.cap();
        let mut sum = 0.0;
        self.for_points(points, |value, _, measure| {
            if value > 0.0 {
                sum += measure * power(value.min(cap));
            }
        });
        sum
    }

    /// `∫ m ⟨s⟩^(m−1) ṡ` over the patch, with the nodal values of ṡ.
    pub fn integral_of_change(
        &self,
        change: &Self,
        points: &Points,
        slope: impl Fn(f64) -> f64,
    ) -> f64 {
        let cap = self.cap();
        let mut sum = 0.0;
        self.for_points(points, |value, shapes, measure| {
            if value > 0.0 {
                sum += measure * slope(value.min(cap)) * change.at(shapes);
            }
        });
        sum
    }

    /// Interpolation between positive and negative nodes may overshoot.
    fn cap(&self) -> f64 {
        if self.least < 0.0 { self.most } else { f64::INFINITY }
    }

    /// Value at a point of given shape functions along the axes.
    fn at(&self, [x, y, z]: [&[f64; 3]; 3]) -> f64 {
        let nodes = self.values.iter().enumerate();
        nodes.map(|(n, value)| x[n % 3] * y[n / 3 % 3] * z[n / 9] * value).sum()
    }

    /// Passes the value, the shape functions and the measure of each point.
    fn for_points(&self, points: &Points, mut pass: impl FnMut(f64, [&[f64; 3]; 3], f64)) {
        for (along_z, of_z) in &points[2] {
            let plane: [f64; 9] = std::array::from_fn(|n| {
                (0..self.counts[2]).map(|c| along_z[c] * self.values[n + 9 * c]).sum()
            });
            for (along_y, of_y) in &points[1] {
                let line: [f64; 3] = std::array::from_fn(|n| {
                    (0..self.counts[1]).map(|b| along_y[b] * plane[n + 3 * b]).sum()
                });
                for (along_x, of_x) in &points[0] {
                    let value: f64 = along_x.iter().zip(line).map(|(n, value)| n * value).sum();
                    pass(value, [along_x, along_y, along_z], of_x * of_y * of_z);
                }
            }
        }
    }
}
