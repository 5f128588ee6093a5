//! A one-dimensional mesh: tensor products of three of these make the structured meshes.

use std::f64::consts::TAU;

use faer::Mat;

use crate::math::gauss::gauss_on;
use crate::math::lagrange::{shape, slope};

/// Measure of a length element of an axis in integrals.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Weight {
    /// `dx`
    Uniform,
    /// `2 π r dr`: the radius of an axisymmetric body, whole circle included.
    Radial,
}

/// Nodes along one coordinate, grouped into elements of `order + 1` nodes that share end nodes.
///
/// An axis without elements is the single point of a direction outside the model.
#[derive(Debug, Clone, PartialEq)]
pub struct Axis {
    /// Ascending coordinates [m].
    pub nodes: Vec<f64>,
    pub order: usize,
    pub weight: Weight,
}

/// Shape functions at one place: `values[i]` and `slopes[i]` [1/m] belong to node `first + i`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ShapeAt {
    pub first: usize,
    pub count: usize,
    pub values: [f64; 3],
    pub slopes: [f64; 3],
}

impl ShapeAt {
    /// Interpolates a function from its values at the nodes.
    pub fn interpolate(&self, nodal: &[f64]) -> f64 {
        (0..self.count).map(|i| self.values[i] * nodal[self.first + i]).sum()
    }

    /// Interpolates functions whose values at the nodes are the columns of a matrix.
    pub fn interpolate_columns(&self, nodal: &Mat<f64>) -> Vec<f64> {
        let value =
            |k: usize| (0..self.count).map(|i| self.values[i] * nodal[(self.first + i, k)]).sum();
        (0..nodal.ncols()).map(value).collect()
    }
}

impl Axis {
    /// Distance of the last two nodes, or of the first two [m]; zero if there is only one.
    pub fn end_distance(&self, at_high_end: bool) -> f64 {
        let count = self.nodes.len();
        let first = if at_high_end { count.saturating_sub(2) } else { 0 };
        self.nodes.get(first + 1).map_or(0.0, |next| next - self.nodes[first])
    }

    /// Creates an axis with elements between `ends`, which ascend.
    pub fn from_element_ends(ends: &[f64], order: usize, weight: Weight) -> Self {
        let mut nodes = vec![ends[0]];
        for pair in ends.windows(2) {
            for i in 1..=order {
                // The last node equals the end to the bit.
                let node = if i == order {
                    pair[1]
                } else {
                    pair[0] + (pair[1] - pair[0]) * i as f64 / order as f64
                };
                nodes.push(node);
            }
        }
        Self { nodes, order, weight }
    }

    /// Axis of a direction outside the model: one node, no element, measure one.
    pub fn point() -> Self {
        Self { nodes: vec![0.0], order: 1, weight: Weight::Uniform }
    }

    pub fn len(&self) -> usize {
        self.nodes.len()
    }

    pub fn is_empty(&self) -> bool {
        self.nodes.is_empty()
    }

    pub fn elements(&self) -> usize {
        (self.nodes.len() - 1) / self.order
    }

    /// Returns true if all nodes are equidistant.
    pub fn is_uniform(&self) -> bool {
        let steps = || self.nodes.windows(2).map(|pair| pair[1] - pair[0]);
        let [least, most] =
            steps().fold([f64::INFINITY, 0.0], |[low, high], step| [low.min(step), high.max(step)]);
        most <= least * (1.0 + 1e-6)
    }

    /// End coordinates of an element.
    pub fn bounds(&self, element: usize) -> [f64; 2] {
        [self.nodes[element * self.order], self.nodes[(element + 1) * self.order]]
    }

    pub fn start(&self) -> f64 {
        self.nodes[0]
    }

    pub fn end(&self) -> f64 {
        self.nodes[self.nodes.len() - 1]
    }

    /// Shape functions at `x`, clamped to the nearest end.
    pub fn shape_at(&self, x: f64) -> ShapeAt {
        if self.elements() == 0 {
            return ShapeAt { first: 0, count: 1, values: [1.0, 0.0, 0.0], slopes: [0.0; 3] };
        }
        let x = x.clamp(self.start(), self.end());
        let above = self.nodes.partition_point(|&node| node <= x);
        let element = (above.saturating_sub(1) / self.order).min(self.elements() - 1);
        self.shape_in(element, x)
    }

    /// Shape functions of one element at `x`.
    pub fn shape_in(&self, element: usize, x: f64) -> ShapeAt {
        let [a, b] = self.bounds(element);
        let xi = (2.0 * x - a - b) / (b - a);
        ShapeAt {
            first: element * self.order,
            count: self.order + 1,
            values: shape(self.order, xi),
            slopes: slope(self.order, xi).map(|s| s * 2.0 / (b - a)),
        }
    }

    /// Measure of a length element at `x`.
    pub fn weight_at(&self, x: f64) -> f64 {
        match self.weight {
            Weight::Uniform => 1.0,
            Weight::Radial => TAU * x,
        }
    }

    /// `∫ N_a N_b w dx` as a dense matrix.
    pub fn mass(&self) -> Mat<f64> {
        self.gram(|at| at.values)
    }

    /// `∫ N_a' N_b' w dx` as a dense matrix.
    pub fn stiffness(&self) -> Mat<f64> {
        self.gram(|at| at.slopes)
    }

    /// `∫ N_a w dx` for every node.
    pub fn integrals(&self) -> Vec<f64> {
        if self.elements() == 0 {
            return vec![1.0];
        }
        self.integrate(self.start(), self.end(), |_| 1.0)
    }

    /// `∫ N_a f w dx` over `[from, to]` for every node, by Gauss points in every element.
    pub fn integrate(&self, from: f64, to: f64, f: impl Fn(f64) -> f64) -> Vec<f64> {
        let mut out = vec![0.0; self.len()];
        for element in 0..self.elements() {
            let [a, b] = self.bounds(element);
            let (a, b) = (a.max(from), b.min(to));
            if a >= b {
                continue;
            }
            for (x, w) in gauss_on(GAUSS_FOR_LOADS, a, b) {
                let at = self.shape_in(element, x);
                for i in 0..at.count {
                    out[at.first + i] += w * self.weight_at(x) * f(x) * at.values[i];
                }
            }
        }
        out
    }

    fn gram(&self, pick: impl Fn(&ShapeAt) -> [f64; 3]) -> Mat<f64> {
        let mut out = Mat::zeros(self.len(), self.len());
        if self.elements() == 0 {
            // A point has measure one and no extent: mass one, stiffness zero.
            out[(0, 0)] = pick(&self.shape_at(0.0))[0].powi(2);
            return out;
        }
        for element in 0..self.elements() {
            let [a, b] = self.bounds(element);
            for (x, w) in gauss_on(self.order + 1, a, b) {
                let at = self.shape_in(element, x);
                let picked = pick(&at);
                for i in 0..at.count {
                    for j in 0..at.count {
                        out[(at.first + i, at.first + j)] +=
                            w * self.weight_at(x) * picked[i] * picked[j];
                    }
                }
            }
        }
        out
    }
}

/// Enough for any Gaussian that an element resolves.
const GAUSS_FOR_LOADS: usize = 8;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn mass_and_stiffness_sums() {
        for (weight, measure) in [(Weight::Uniform, 3.0), (Weight::Radial, TAU * 7.5)] {
            for order in [1, 2] {
                let axis = Axis::from_element_ends(&[1.0, 1.5, 2.2, 4.0], order, weight);
                let n = axis.len();
                let total = |m: &Mat<f64>| -> f64 {
                    (0..n).flat_map(|i| (0..n).map(move |j| (i, j))).map(|p| m[p]).sum()
                };
                assert!((total(&axis.mass()) - measure).abs() < 1e-12);
                assert!(total(&axis.stiffness()).abs() < 1e-11);
                assert!((axis.integrals().iter().sum::<f64>() - measure).abs() < 1e-12);
            }
        }
    }

    #[test]
    fn outside_places_are_clamped_to_the_nearest_end() {
        let axis = Axis::from_element_ends(&[0.0, 1.0, 3.0], 2, Weight::Uniform);
        assert_eq!(axis.shape_at(7.0).values[2], 1.0);
        assert_eq!(axis.shape_at(7.0).first, 2);
        assert_eq!(axis.shape_at(-1.0).values[0], 1.0);
    }
}
