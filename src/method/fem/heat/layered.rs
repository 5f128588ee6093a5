//! Conduction of heat through layers, solved exactly in time.
//!
//! With conductivity and capacity that vary along z alone the Galerkin matrices are
//! `K_x⊗M_y⊗M_z(k) + M_x⊗K_y⊗M_z(k) + M_x⊗M_y⊗K_z(k)` and `M_x⊗M_y⊗M_z(c)`. The modes of x and y diagonalise
//! them along the surface; each pair of these then has modes of its own along z ([`DepthProblem`]), which only its
//! sum of eigenvalues matters to. Arrays are modal, `(i, j, mode)`, or mixed: `(i, j, node along z)` with modes
//! along the surface and nodes along z.

mod class;

use faer::Mat;

use super::super::columns::DepthProblem;
use super::super::modes::EndCondition;
use super::{
    HeatLoads, HeatTotals, Passage, ThermalFace, dot, end_conditions, multiply, state_layout,
    taylor,
};
use crate::material::Constants;
use crate::math::exponential;
use crate::math::separable::{Side, add_product, contract, transform};
use crate::method::mesh::{Mesh, MeshFace};
use crate::state::Layout;
use class::{Columns, LayeredClass};

/// The heat problem of a body of layers: everything known before time starts.
pub struct LayeredHeat {
    depth: DepthProblem,
    copies: f64,
    faces: Vec<(MeshFace, ThermalFace)>,
    classes: Vec<LayeredClass>,
    threads: usize,
}

impl LayeredHeat {
    /// `constants` of the layers, from the lowest on. Where lateral faces are convective these conduct equally.
    pub fn new(
        mesh: &Mesh,
        constants: &[Constants],
        faces: Vec<(MeshFace, ThermalFace)>,
        threads: usize,
    ) -> Self {
        let depth = DepthProblem::new(mesh, constants, depth_ends(&faces));
        let conductivity = constants[0].conductivity;
        let class = |parity| LayeredClass::new(mesh, parity, &depth, conductivity, &faces);
        let classes = mesh.parities().into_iter().map(class).collect();
        let built = Self { depth, copies: mesh.copies(), faces, classes, threads };
        // The first step is no slower than the others.
        built.columns(&built.classes[0]);
        built
    }

    /// The fields of a state, as [`super::HeatProblem::layout`] has them.
    pub fn layout(&self) -> Layout {
        state_layout(self.classes.iter().map(LayeredClass::len), self.faces.len())
    }

    /// Advances `state` by `dt` [s], as [`super::HeatProblem::advance`] does.
    pub fn advance(&self, state: &mut [f64], loads: &[HeatLoads], dt: f64) {
        let split = state.len() - self.faces.len() - 2;
        let (mut contents, tail) = state.split_at_mut(split);
        for (index, class) in self.classes.iter().enumerate() {
            let (content, rest) = contents.split_at_mut(class.len());
            contents = rest;
            let driven = |part: &HeatLoads| {
                let mut values =
                    part.faces[index].iter().chain(part.surface[index].iter().flatten());
                values.any(|&v| v != 0.0)
            };
            let last = loads.iter().rposition(driven);
            if last.is_none() && is_zero(content, tail) {
                continue;
            }
            let source =
                |k: usize| self.source(class, &loads[k].surface[index], &loads[k].faces[index]);
            let sources: Vec<Vec<f64>> = (0..=last.unwrap_or(0)).map(source).collect();
            if !class.parity.is_even() {
                // Parts that are odd carry no heat in sum.
                self.advance_class(class, content, &sources, dt);
                continue;
            }
            let faces = |shift: usize| {
                taylor(loads.iter().map(|part| part.faces[index].as_slice()), shift, dt)
            };
            let surface = |side: usize| {
                taylor(loads.iter().map(|part| part.surface[index][side].as_slice()), 1, dt)
            };
            let (end, values) = (faces(0), faces(1));
            let before = self.effective(class, content, &tail[..end.len()]);
            let integral = self.advance_class(class, content, &sources, dt);
            let after = self.effective(class, content, &end);
            let passage = Passage {
                change: after.iter().zip(&before).map(|(a, b)| a - b).collect(),
                integral: self.effective(class, &integral, &values),
                surface: [surface(0), surface(1)],
                value_change: end.iter().zip(&*tail).map(|(a, b)| a - b).collect(),
                values,
            };
            let HeatTotals { brought_in, lost } = self.passed(class, &passage);
            let count = end.len();
            tail[..count].copy_from_slice(&end);
            tail[count] += brought_in;
            tail[count + 1] += lost;
        }
    }

    /// Time derivative of a state, as [`super::HeatProblem::rates`] gives it.
    pub fn rates(&self, state: &[f64], loads: &HeatLoads, rates: &HeatLoads) -> Vec<f64> {
        let mut out = Vec::with_capacity(state.len());
        for (index, (class, content)) in self.classes.iter().zip(self.contents(state)).enumerate() {
            let (surface, values) = (&loads.surface[index], &loads.faces[index]);
            let mut loaded = surface.iter().flatten().chain(values);
            if is_zero(content, values) && loaded.all(|&v| v == 0.0) {
                out.resize(out.len() + class.len(), 0.0);
                continue;
            }
            let mut source = self.source(class, surface, values);
            class.for_each_mode(self.columns(class), |at, decay| source[at] -= decay * content[at]);
            out.extend(source);
        }
        let class = &self.classes[0];
        let (values, value_rates) = (&loads.faces[0], &rates.faces[0]);
        let passage = Passage {
            change: self.effective(class, &out[..class.len()], value_rates),
            integral: self.effective(class, &state[..class.len()], values),
            surface: loads.surface[0].clone(),
            value_change: value_rates.clone(),
            values: values.clone(),
        };
        let totals = self.passed(class, &passage);
        out.extend(value_rates);
        out.extend([totals.brought_in, totals.lost]);
        out
    }

    /// Heat stored since time zero [J].
    pub fn stored(&self, state: &[f64]) -> f64 {
        let class = &self.classes[0];
        let tail = &state[state.len() - self.faces.len() - 2..];
        let [x, y] = &class.lateral;
        let [mx, my] = [x, y].map(|modes| multiply(&modes.mass, &vec![1.0; modes.mass.nrows()]));
        let mz = multiply(&self.depth.capacity, &vec![1.0; self.depth.nodes()]);
        let content = self.effective(class, &state[..class.len()], &tail[..self.faces.len()]);
        let mixed = class.to_mixed(self.columns(class), &content);
        let free = contract(&mixed, [&x.project(&mx), &y.project(&my), &mz]);
        let held = |f: usize| {
            let [bx, by, bz] = &class.drives[f].boundary;
            tail[f] * dot(&mx, bx) * dot(&my, by) * dot(&mz, bz)
        };
        self.copies * (free + self.prescribed().map(held).sum::<f64>())
    }

    pub fn totals(&self, state: &[f64]) -> HeatTotals {
        let n = state.len();
        HeatTotals { brought_in: state[n - 2], lost: state[n - 1] }
    }

    /// Temperature above the initial one at a point of the mesh and its `image` [K], on an interface that of
    /// the layer above; `faces` holds the present face values of each class.
    pub fn temperature_at(
        &self,
        mesh: &Mesh,
        state: &[f64],
        faces: &[Vec<f64>],
        point: [f64; 3],
        image: [bool; 2],
    ) -> f64 {
        let mut sum = 0.0;
        let depth = mesh.sided_shape_at(point[2]);
        for (class, (content, values)) in self.classes.iter().zip(self.contents(state).zip(faces)) {
            if is_zero(content, values) {
                continue;
            }
            let [x, y] = [0, 1].map(|a| class.lateral[a].at(&mesh.axes[a], point[a]));
            let mixed =
                class.to_mixed(self.columns(class), &self.effective(class, content, values));
            let nodes = depth.first..depth.first + depth.count;
            let plane = x.len() * y.len();
            let near = &mixed[plane * nodes.start..plane * nodes.end];
            let mut part = contract(near, [&x, &y, &depth.values[..depth.count]]);
            for f in self.prescribed() {
                let b = &class.drives[f].boundary;
                let along = |a: usize| {
                    let shape = mesh.axes[a].shape_at(point[a]);
                    dot(&shape.values[..shape.count], &b[a][shape.first..])
                };
                part += values[f]
                    * along(0)
                    * along(1)
                    * dot(&depth.values[..depth.count], &b[2][nodes.clone()]);
            }
            sum += class.parity.sign(image) * part;
        }
        sum
    }

    /// Temperature above the initial one at all nodes, those on interfaces twice, class by class [K]; empty for
    /// a class that is zero.
    pub fn nodal(&self, state: &[f64], faces: &[Vec<f64>]) -> Vec<Vec<f64>> {
        let parts = self.contents(state).zip(faces).zip(&self.classes);
        parts
            .map(|((content, values), class)| {
                if is_zero(content, values) {
                    return Vec::new();
                }
                let content = self.effective(class, content, values);
                let mixed = class.to_mixed(self.columns(class), &content);
                let [x, y] = class.lateral.each_ref().map(|modes| &modes.shapes);
                let n = self.depth.nodes();
                let mut nodal = transform(&mixed, [x, y, &Mat::identity(n, n)], Side::Direct);
                for f in self.prescribed() {
                    let b = class.drives[f].boundary.each_ref().map(Vec::as_slice);
                    add_product(&mut nodal, values[f], b);
                }
                nodal
            })
            .collect()
    }

    fn prescribed(&self) -> impl Iterator<Item = usize> + '_ {
        (0..self.faces.len()).filter(|&f| self.faces[f].1 == ThermalFace::Prescribed)
    }

    fn contents<'s>(&'s self, state: &'s [f64]) -> impl Iterator<Item = &'s [f64]> {
        let mut rest = state;
        self.classes.iter().map(move |class| {
            let (content, after) = rest.split_at(class.len());
            rest = after;
            content
        })
    }

    fn columns<'c>(&self, class: &'c LayeredClass) -> &'c Columns {
        let conserves = class.parity.is_even()
            && self
                .faces
                .iter()
                .all(|(face, condition)| face.axis == 2 || *condition == ThermalFace::Flux);
        let make = || Columns::new(&class.lateral, &self.depth, conserves, self.threads);
        class.columns.get_or_init(make)
    }

    /// Modal amplitudes of the free nodes: the heat content less what the prescribed nodes hold.
    fn effective(&self, class: &LayeredClass, content: &[f64], values: &[f64]) -> Vec<f64> {
        let mut out = content.to_vec();
        if self.prescribed().all(|f| values[f] == 0.0) {
            return out;
        }
        let held = class.to_modal(self.columns(class), &self.held(class, values));
        out.iter_mut().zip(held).for_each(|(value, held)| *value -= held);
        out
    }

    /// `M(c) b` of the prescribed nodes, mixed.
    fn held(&self, class: &LayeredClass, values: &[f64]) -> Vec<f64> {
        let mut mixed = class.zeros(&self.depth);
        for f in self.prescribed() {
            let mass = class.drives[f].mass.each_ref().map(Vec::as_slice);
            add_product(&mut mixed, values[f], mass);
        }
        mixed
    }

    /// Rate of change of the modal heat content that loads and faces cause: `φᵀ(F − K b g) + λ φᵀ M(c) b g`.
    fn source(&self, class: &LayeredClass, surface: &[Vec<f64>; 2], values: &[f64]) -> Vec<f64> {
        let mut mixed = class.zeros(&self.depth);
        for (nodal, high) in surface.iter().zip([false, true]) {
            class.add_surface(&mut mixed, nodal, high);
        }
        let mut prescribed = false;
        for (f, &(_, condition)) in self.faces.iter().enumerate() {
            let drive = &class.drives[f];
            let area = drive.area.each_ref().map(Vec::as_slice);
            match condition {
                ThermalFace::Flux => add_product(&mut mixed, values[f], area),
                ThermalFace::Convective(coefficient) => {
                    add_product(&mut mixed, coefficient * values[f], area);
                }
                ThermalFace::Prescribed => {
                    prescribed |= values[f] != 0.0;
                    for term in &drive.stiffness {
                        let term = term.each_ref().map(Vec::as_slice);
                        add_product(&mut mixed, -values[f], term);
                    }
                }
            }
        }
        let columns = self.columns(class);
        let mut out = class.to_modal(columns, &mixed);
        if prescribed {
            let held = class.to_modal(columns, &self.held(class, values));
            class.for_each_mode(columns, |at, decay| out[at] += decay * held[at]);
        }
        out
    }

    /// Replaces the content of a class by its value a time `dt` later and returns its integral over the step, as
    /// [`exponential::weights`] say; `sources` holds the source at the beginning and its time derivatives.
    fn advance_class(
        &self,
        class: &LayeredClass,
        content: &mut [f64],
        sources: &[Vec<f64>],
        dt: f64,
    ) -> Vec<f64> {
        let mut integral = vec![0.0; content.len()];
        class.for_each_mode(self.columns(class), |at, decay| {
            let weights = exponential::weights(decay * dt);
            let start = content[at];
            let (mut end, mut sum) = (weights[0] * start, weights[1] * start);
            let mut power = dt;
            for (k, source) in sources.iter().enumerate() {
                end += weights[k + 1] * power * source[at];
                sum += weights[k + 2] * power * source[at];
                power *= dt;
            }
            content[at] = end;
            integral[at] = dt * sum;
        });
        integral
    }

    /// What passed the faces of the whole body.
    fn passed(&self, class: &LayeredClass, passage: &Passage) -> HeatTotals {
        let columns = self.columns(class);
        let integral = class.to_mixed(columns, &passage.integral);
        let change = class.to_mixed(columns, &passage.change);
        let mut brought = passage.surface.iter().flatten().sum::<f64>();
        let mut lost = 0.0;
        for (f, &(_, condition)) in self.faces.iter().enumerate() {
            let drive = &class.drives[f];
            let value = passage.values[f];
            let held = |g: usize| class.face_overlap(f, g);
            let coefficient = match condition {
                ThermalFace::Flux => {
                    brought += value * drive.measure;
                    1.0
                }
                ThermalFace::Convective(coefficient) => {
                    let area = drive.area.each_ref().map(Vec::as_slice);
                    let held = self.prescribed().map(|g| passage.values[g] * held(g));
                    let mean = contract(&integral, area) + held.sum::<f64>();
                    lost += coefficient * (mean - value * drive.measure);
                    coefficient
                }
                ThermalFace::Prescribed => {
                    lost += class.surface_at_boundary(drive, &passage.surface);
                    lost -= self.reaction(class, f, (&change, &integral), passage);
                    0.0
                }
            };
            // What a flux or an ambient brings straight into prescribed nodes.
            lost += self.prescribed().map(|g| coefficient * value * held(g)).sum::<f64>();
        }
        HeatTotals { brought_in: self.copies * brought, lost: self.copies * lost }
    }

    /// Heat that the nodes of a prescribed face took up or passed on: `bᵀ(M(c) Δθ + K ∫θ dt)`.
    fn reaction(
        &self,
        class: &LayeredClass,
        f: usize,
        (change, integral): (&[f64], &[f64]),
        passage: &Passage,
    ) -> f64 {
        let drive = &class.drives[f];
        let conducted =
            |term: &[Vec<f64>; 3]| contract(integral, term.each_ref().map(Vec::as_slice));
        let mut sum = contract(change, drive.mass.each_ref().map(Vec::as_slice))
            + drive.stiffness.iter().map(conducted).sum::<f64>();
        for g in self.prescribed() {
            let (mass, stiffness) = class.boundary_overlap(&self.depth, f, g);
            sum += mass * passage.value_change[g] + stiffness * passage.values[g];
        }
        sum
    }
}

/// Conditions at the bottom and the top, with heat transfer coefficients as they are.
pub fn depth_ends(faces: &[(MeshFace, ThermalFace)]) -> [EndCondition; 2] {
    end_conditions(faces, 2, 1.0)
}

fn is_zero(content: &[f64], values: &[f64]) -> bool {
    values.iter().chain(content).all(|&v| v == 0.0)
}
