//! The heat problem in modal form: decay rates, sources of loads, and rows of readings.

use super::class::{Class, dot, multiply};
use super::depth::DepthModes;
use super::{HeatLoads, HeatProblem};
use crate::math::separable::add_product;
use crate::method::mesh::Mesh;

/// A value of temperatures that is a sum over modes and face values.
#[derive(Debug, Clone, PartialEq)]
pub struct ModalRow {
    /// For each mode of the requested classes, in their order.
    pub modes: Vec<f64>,
    /// For each class and face.
    pub faces: Vec<Vec<f64>>,
}

impl ModalRow {
    /// Direct contribution of the face values of each class.
    pub fn direct(&self, faces: &[Vec<f64>]) -> f64 {
        self.faces.iter().zip(faces).map(|(row, values)| dot(row, values)).sum()
    }
}

impl<D: DepthModes> HeatProblem<D> {
    /// Decay rates of the modes of the classes in `take` [1/s].
    pub fn modal_rates(&self, take: &[bool]) -> Vec<f64> {
        let mut rates = Vec::new();
        for (class, _) in self.classes.iter().zip(take).filter(|(_, take)| **take) {
            let start = rates.len();
            rates.resize(start + self.len(class), 0.0);
            self.depth.for_each_mode(class, |at, decay| rates[start + at] = decay);
        }
        rates
    }

    /// Returns for each class whether loads drive it.
    pub fn driven(&self, loads: &HeatLoads) -> Vec<bool> {
        (0..self.classes.len()).map(|class| loads.drive(class)).collect()
    }

    /// Rate of change of the content of these modes under loads.
    pub fn modal_sources(&self, take: &[bool], loads: &HeatLoads) -> Vec<f64> {
        let mut sources = Vec::new();
        for (index, class) in self.classes.iter().enumerate().filter(|(index, _)| take[*index]) {
            match loads.drive(index) {
                true => {
                    sources.extend(self.source(class, &loads.surface[index], &loads.faces[index]))
                }
                false => sources.resize(sources.len() + self.len(class), 0.0),
            }
        }
        sources
    }

    /// Heat flow supplied by loads [W].
    pub fn brought_in_by(&self, loads: &HeatLoads) -> f64 {
        let class = &self.classes[0];
        let zero = vec![0.0; self.faces.len()];
        let passage = super::Passage {
            change: vec![0.0; self.len(class)],
            integral: vec![0.0; self.len(class)],
            surface: loads.surface[0].clone(),
            value_change: zero,
            values: loads.faces[0].clone(),
        };
        self.passed(class, &passage).totals.brought_in
    }

    /// Temperature above the initial one at a point of the mesh and its `image`.
    pub fn point_row(
        &self,
        mesh: &Mesh,
        take: &[bool],
        (point, image): ([f64; 3], [bool; 2]),
    ) -> ModalRow {
        let [x, y, _] = &mesh.axes;
        let shapes = [x.shape_at(point[0]), y.shape_at(point[1]), mesh.sided_shape_at(point[2])];
        let row_z = shapes[2].interpolate_columns(self.depth.basis());
        self.row_of(take, |class| {
            let sign = class.parity.sign(image);
            let [row_x, row_y] =
                [0, 1].map(|a| shapes[a].interpolate_columns(&class.lateral[a].shapes));
            let mut mixed = self.zeros(class);
            add_product(&mut mixed, sign, [&row_x, &row_y, &row_z]);
            let boundary = |f: usize| {
                let factor = |a: usize| shapes[a].interpolate(&class.drives[f].boundary[a]);
                sign * (0..3).map(factor).product::<f64>()
            };
            (mixed, (0..self.faces.len()).map(boundary).collect())
        })
    }

    /// Sum over nodes of the bottom or, if `high`, the top, with weights for each class; empty for none.
    pub fn face_row(&self, take: &[bool], weights: &[Vec<f64>], high: bool) -> ModalRow {
        let mut place = 0;
        self.row_of(take, |class| {
            let own = &weights[place];
            place += 1;
            let mut mixed = self.zeros(class);
            class.add_surface(&mut mixed, own, &self.depth.at_end(high), 1.0);
            let none = [Vec::new(), Vec::new()];
            let surface = match high {
                true => [none[0].clone(), own.clone()],
                false => [own.clone(), none[1].clone()],
            };
            let boundary = |f: usize| class.surface_at_boundary(&class.drives[f], &surface);
            (mixed, (0..self.faces.len()).map(boundary).collect())
        })
    }

    /// Heat stored [J].
    pub fn stored_row(&self, take: &[bool]) -> ModalRow {
        self.row_of(take, |class| {
            let mut mixed = self.zeros(class);
            if !class.parity.is_even() {
                return (mixed, vec![0.0; self.faces.len()]);
            }
            let [x, y] = &class.lateral;
            let masses = [&x.mass, &y.mass, self.depth.mass()]
                .map(|mass| multiply(mass, &vec![1.0; mass.nrows()]));
            let rows =
                [x.project(&masses[0]), y.project(&masses[1]), self.depth.project(&masses[2])];
            let factor = self.copies * self.depth.capacity();
            add_product(&mut mixed, factor, rows.each_ref().map(Vec::as_slice));
            let held = |f: usize| {
                let boundary = &class.drives[f].boundary;
                factor * (0..3).map(|a| dot(&masses[a], &boundary[a])).product::<f64>()
            };
            (mixed, (0..self.faces.len()).map(held).collect())
        })
    }

    /// Builds a row from a mixed array and the contribution of prescribed nodes, class by class; modes include the heat
    /// that these store.
    fn row_of(
        &self,
        take: &[bool],
        mut of_class: impl FnMut(&Class<D::Columns>) -> (Vec<f64>, Vec<f64>),
    ) -> ModalRow {
        let mut out = ModalRow { modes: Vec::new(), faces: Vec::new() };
        for (class, &take) in self.classes.iter().zip(take) {
            let (mixed, boundary) = of_class(class);
            let mut faces = vec![0.0; self.faces.len()];
            if take {
                let own = self.depth.to_modal(class, mixed);
                for f in self.prescribed() {
                    let mut unit = vec![0.0; self.faces.len()];
                    unit[f] = 1.0;
                    let held = self.held(class, &unit).unwrap_or_default();
                    faces[f] = boundary[f] - dot(&own, &held);
                }
                out.modes.extend(own);
            }
            out.faces.push(faces);
        }
        out
    }
}
