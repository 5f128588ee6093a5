//! Converts derivatives of a reading by nodal temperatures to those by the parts of a state.

use super::class::dot;
use super::depth::DepthModes;
use super::{HeatProblem, is_zero};
use crate::math::separable::{Side, add_product, contract, transform};

impl<D: DepthModes> HeatProblem<D> {
    /// Returns the modal part of a state for each class.
    pub fn class_contents<'s>(&'s self, state: &'s [f64]) -> Vec<&'s [f64]> {
        self.contents(state).collect()
    }

    /// Transpose of [`HeatProblem::nodal`] for one class: derivatives by modal heat content, and by face values. Of
    /// these, only prescribed temperatures act without delay.
    pub fn row(&self, class: usize, nodal: &[f64]) -> [Vec<f64>; 2] {
        let class = &self.classes[class];
        if is_zero(nodal, &[]) {
            return [self.len(class), self.faces.len()].map(|count| vec![0.0; count]);
        }
        let [x, y] = class.lateral.each_ref().map(|modes| &modes.shapes);
        let mixed = transform(nodal, [x, y, self.depth.basis()], Side::Transposed);
        // Modes are orthogonal: the map from coefficients to amplitudes is the transpose of its inverse.
        let modal = self.depth.to_modal(class, mixed);
        let mut faces = vec![0.0; self.faces.len()];
        for f in self.prescribed() {
            let drive = &class.drives[f];
            let mut mixed = self.zeros(class);
            add_product(&mut mixed, 1.0, drive.mass.each_ref().map(Vec::as_slice));
            let held = self.depth.to_modal(class, mixed);
            let there = contract(nodal, drive.boundary.each_ref().map(Vec::as_slice));
            faces[f] = there - dot(&modal, &held);
        }
        [modal, faces]
    }
}
