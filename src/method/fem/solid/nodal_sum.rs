//! Sums of stresses over points from those of the nodes, which many such sums share.

use std::collections::BTreeMap;

use super::risk::like_image;
use super::{ImageStress, SolidFem};
use crate::method::mesh::Geometry;

/// A sum over points of a combination of stress components, by the nodes of one image of the mesh.
pub struct NodalSum {
    image: [bool; 2],
    /// Factors of xx, yy, zz, xy, yz, xz.
    factors: [f64; 6],
    /// Weights of nodes, interfaces doubled.
    nodes: Vec<(usize, f64)>,
}

impl SolidFem {
    /// Returns the sum over points with weights; `None` in a meridian section, whose components turn with the point,
    /// and for points of several images.
    pub fn nodal_sum(
        &self,
        points: &[[f64; 3]],
        weights: &[f64],
        factors: [f64; 6],
    ) -> Option<NodalSum> {
        let (_, image) = self.mesh.locate(*points.first()?);
        if self.mesh.geometry != Geometry::Box {
            return None;
        }
        let [columns, rows, _] = self.mesh.sided_counts();
        let mut nodes = BTreeMap::new();
        for (&point, weight) in points.iter().zip(weights) {
            let (place, own) = self.mesh.locate(point);
            if own != image {
                return None;
            }
            let [x, y, z] = self.sided_weights(place);
            for (c, of_z) in z.values.iter().enumerate() {
                for (b, of_y) in y.values.iter().enumerate() {
                    for (a, of_x) in x.values.iter().enumerate() {
                        let level = y.first + b + rows * (z.first + c);
                        let node = x.first + a + columns * level;
                        *nodes.entry(node).or_insert(0.0) += weight * of_x * of_y * of_z;
                    }
                }
            }
        }
        Some(NodalSum { image, factors, nodes: nodes.into_iter().collect() })
    }

    /// Value of a sum for the stresses of all distinct images.
    pub fn value_of(&self, sum: &NodalSum, stresses: &[ImageStress]) -> f64 {
        let Some((own, stress)) = like_image(stresses, sum.image) else { return 0.0 };
        // The reflections that are left change signs alone.
        let left = [0, 1].map(|axis| own[axis] != sum.image[axis]);
        let factors = self.imaged(sum.factors, left);
        let of_node = |&(node, weight): &(usize, f64)| {
            let products = factors.iter().zip(&stress[node]).map(|(factor, own)| factor * own);
            weight * products.sum::<f64>()
        };
        sum.nodes.iter().map(of_node).sum()
    }
}
