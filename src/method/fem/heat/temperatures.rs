//! Readings of a state: temperatures and stored heat.

use faer::Mat;

use super::class::{Class, dot, multiply};
use super::depth::DepthModes;
use super::{HeatProblem, is_zero};
use crate::math::separable::{
    Side, add_product, contract, transform, transform_depth, transform_planes,
};
use crate::method::mesh::Mesh;

impl<D: DepthModes> HeatProblem<D> {
    /// Heat stored since time zero [J].
    pub fn stored(&self, state: &[f64]) -> f64 {
        let class = &self.classes[0];
        let values = &state[state.len() - self.tail()..][..self.faces.len()];
        let content = self.effective(class, &state[..self.len(class)], values);
        self.stored_of(class, &content, values)
    }

    /// Heat in the free nodes with these modal amplitudes and in the prescribed ones with these values [J].
    pub(super) fn stored_of(
        &self,
        class: &Class<D::Columns>,
        content: &[f64],
        values: &[f64],
    ) -> f64 {
        let [x, y] = &class.lateral;
        let masses = [&x.mass, &y.mass, self.depth.mass()]
            .map(|mass| multiply(mass, &vec![1.0; mass.nrows()]));
        let rows = [x.project(&masses[0]), y.project(&masses[1]), self.depth.project(&masses[2])];
        let mixed = self.depth.to_mixed(class, content);
        let free = contract(&mixed, rows.each_ref().map(Vec::as_slice));
        let held = |f: usize| {
            let boundary = &class.drives[f].boundary;
            values[f] * (0..3).map(|a| dot(&masses[a], &boundary[a])).product::<f64>()
        };
        let held = self.prescribed().map(held).sum::<f64>();
        self.copies * self.depth.capacity() * (free + held)
    }

    /// Returns the temperature above the initial one at a point of the mesh and its `image` [K]. On an interface it is
    /// that of the layer above. `faces` holds the present face values of each class.
    pub fn temperature_at(
        &self,
        mesh: &Mesh,
        state: &[f64],
        faces: &[Vec<f64>],
        point: [f64; 3],
        image: [bool; 2],
    ) -> f64 {
        let mut sum = 0.0;
        let [x, y, _] = &mesh.axes;
        let shapes = [x.shape_at(point[0]), y.shape_at(point[1]), mesh.sided_shape_at(point[2])];
        let row_z = shapes[2].interpolate_columns(self.depth.basis());
        for (class, (content, values)) in self.classes.iter().zip(self.contents(state).zip(faces)) {
            if is_zero(content, values) {
                continue;
            }
            let [row_x, row_y] =
                [0, 1].map(|a| shapes[a].interpolate_columns(&class.lateral[a].shapes));
            let content = self.effective(class, content, values);
            let mixed = self.depth.to_mixed(class, &content);
            let mut part = contract(&mixed, [&row_x, &row_y, &row_z]);
            for f in self.prescribed() {
                let factor = |a: usize| shapes[a].interpolate(&class.drives[f].boundary[a]);
                part += values[f] * (0..3).map(factor).product::<f64>();
            }
            sum += class.parity.sign(image) * part;
        }
        sum
    }

    /// Returns the temperature above the initial one at all nodes, class by class [K]; empty for a class that is zero.
    /// Nodes on interfaces are listed twice.
    pub fn nodal(&self, state: &[f64], faces: &[Vec<f64>]) -> Vec<Vec<f64>> {
        self.of_classes(state, faces, |class, mixed, values| {
            let [x, y] = class.lateral.each_ref().map(|modes| &modes.shapes);
            let mut nodal = transform(mixed, [x, y, self.depth.basis()], Side::Direct);
            for f in self.prescribed() {
                let b = class.drives[f].boundary.each_ref().map(Vec::as_slice);
                add_product(&mut nodal, values[f], b);
            }
            nodal
        })
    }

    /// Returns nodal temperatures multiplied by a matrix along z, each of whose rows weights the nodes there. The
    /// result has one plane of nodes per row.
    pub fn along_depth(&self, state: &[f64], faces: &[Vec<f64>], rows: &Mat<f64>) -> Vec<Vec<f64>> {
        let basis = self.depth.basis();
        let mut product = vec![0.0; rows.nrows() * basis.ncols()];
        crate::math::product::product(&mut product, rows.as_ref(), basis.as_ref());
        let of_basis =
            Mat::from_fn(rows.nrows(), basis.ncols(), |i, k| product[i + rows.nrows() * k]);
        self.of_classes(state, faces, |class, mixed, values| {
            let [x, y] = class.lateral.each_ref().map(|modes| &modes.shapes);
            let mut planes = transform_planes(&transform_depth(mixed, &of_basis), [x, y]);
            for f in self.prescribed() {
                let [x, y, z] = &class.drives[f].boundary;
                add_product(&mut planes, values[f], [x, y, &multiply(rows, z)]);
            }
            planes
        })
    }

    /// Evaluates each class from its coefficients in the basis along z and its face values; empty for a class that is
    /// zero.
    fn of_classes(
        &self,
        state: &[f64],
        faces: &[Vec<f64>],
        evaluate: impl Fn(&Class<D::Columns>, &[f64], &[f64]) -> Vec<f64>,
    ) -> Vec<Vec<f64>> {
        let parts = self.contents(state).zip(faces).zip(&self.classes);
        parts
            .map(|((content, values), class)| {
                if is_zero(content, values) {
                    return Vec::new();
                }
                let content = self.effective(class, content, values);
                evaluate(class, &self.depth.to_mixed(class, &content), values)
            })
            .collect()
    }
}
