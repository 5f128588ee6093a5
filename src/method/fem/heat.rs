//! Conduction of heat on a structured mesh, solved exactly in time.
//!
//! The Galerkin equations `ρc M θ̇ + k K θ = F` of a box or a meridian section with uniform
//! conditions on each face are separable: M and K are sums of Kronecker products of the matrices
//! of the axes. The modes of the axes diagonalise them once (R. E. Lynch, J. R. Rice and
//! D. H. Thomas 1964, doi 10.1007/BF01386067), and each product mode then obeys a scalar equation
//! whose solution under a load that is a polynomial in time is an exponential and φ-functions. So a
//! step of any length costs a few operations a node, is L-stable and has no time error; θ is the
//! temperature above the initial one.

mod layered;
mod rates;

pub use layered::{LayeredHeat, depth_ends};

use faer::Mat;

use super::modes::{AxisModes, EndCondition};
use crate::math::exponential;
use crate::math::separable::{Side, add_product, contract, transform};
use crate::method::heat_totals::HeatTotals;
use crate::method::mesh::{Mesh, MeshFace, Parity};
use crate::state::{Field, Layout, Per};

/// Thermal condition on an end of an axis.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum ThermalFace {
    /// Insulated where the flux is zero [W/m²].
    Flux,
    /// Prescribed temperature.
    Prescribed,
    /// Heat transfer coefficient [W/(m² K)].
    Convective(f64),
}

/// The heat problem of a body: everything known before time starts.
pub struct HeatProblem {
    /// ρc [J/(m³ K)]
    capacity: f64,
    /// k [W/(m K)]
    conductivity: f64,
    copies: f64,
    faces: Vec<(MeshFace, ThermalFace)>,
    classes: Vec<HeatClass>,
}

/// The part of one symmetry class.
struct HeatClass {
    parity: Parity,
    modes: [AxisModes; 3],
    /// For each face: what a unit of its value drives.
    drives: Vec<FaceDrive>,
}

/// Modal and nodal vectors of a face, as products over the axes.
struct FaceDrive {
    /// Nodes of the face that have its prescribed temperature, one factor an axis.
    boundary: [Vec<f64>; 3],
    /// `φᵀ M b` and `φᵀ K b`, one factor an axis.
    mass: [Vec<f64>; 3],
    stiffness: [Vec<f64>; 3],
    /// `φᵀ ∫ N dA` over the face, one factor an axis.
    area: [Vec<f64>; 3],
    /// `∫ N dA` over the face, one factor an axis.
    area_nodal: [Vec<f64>; 3],
    /// Area of the face on the mesh [m²].
    measure: f64,
}

/// What drives the heat problem, or a time derivative of it.
pub struct HeatLoads<'a> {
    /// For each class, heat into the nodes of the bottom and the top of the mesh [W]; empty for none.
    pub surface: &'a [[Vec<f64>; 2]],
    /// For each class and face: flux [W/m²], or temperature above the initial one [K].
    pub faces: &'a [Vec<f64>],
}

/// What happened during a step to the even part; or, as rates, what happens at a moment.
struct Passage {
    /// Change of the modal amplitudes of the free nodes, and their integral over the step.
    change: Vec<f64>,
    integral: Vec<f64>,
    /// Integral of the surface loads over the step [J].
    surface: [Vec<f64>; 2],
    /// Change of the face values, and their integral over the step.
    value_change: Vec<f64>,
    values: Vec<f64>,
}

impl HeatProblem {
    pub fn new(
        mesh: &Mesh,
        capacity: f64,
        conductivity: f64,
        faces: Vec<(MeshFace, ThermalFace)>,
    ) -> Self {
        let classes = mesh
            .parities()
            .into_iter()
            .map(|parity| HeatClass::new(mesh, parity, conductivity, &faces))
            .collect();
        Self { capacity, conductivity, copies: mesh.copies(), faces, classes }
    }

    /// The fields of a state: modes class after class, then what the last step had at the faces, then totals.
    pub fn layout(&self) -> Layout {
        state_layout(self.classes.iter().map(HeatClass::len), self.faces.len())
    }

    /// Advances `state` by `dt` [s] under loads that are polynomials in time, at most quadratic: one
    /// entry of `loads` for their values at the beginning and one for each derivative.
    pub fn advance(&self, state: &mut [f64], loads: &[HeatLoads], dt: f64) {
        let (contents, tail) = self.split_mut(state);
        let mut contents = contents;
        for (index, class) in self.classes.iter().enumerate() {
            let (content, rest) = contents.split_at_mut(class.len());
            contents = rest;
            let driven = |part: &HeatLoads| {
                let mut values =
                    part.faces[index].iter().chain(part.surface[index].iter().flatten());
                values.any(|&v| v != 0.0)
            };
            let last = loads.iter().rposition(driven);
            if last.is_none() && class.is_zero(content, tail) {
                continue;
            }
            let source =
                |k: usize| self.source(class, &loads[k].surface[index], &loads[k].faces[index]);
            let sources: Vec<Vec<f64>> = (0..=last.unwrap_or(0)).map(source).collect();
            if !class.parity.is_even() {
                // Parts that are odd carry no heat in sum.
                class.advance(content, &sources, self.diffusivity(), dt);
                continue;
            }
            let faces = |shift: usize| {
                let lists = loads.iter().map(|part| part.faces[index].as_slice());
                taylor(lists, shift, dt)
            };
            let surface = |side: usize| {
                let lists = loads.iter().map(|part| part.surface[index][side].as_slice());
                taylor(lists, 1, dt)
            };
            let (end, values) = (faces(0), faces(1));
            let before = self.effective(class, content, &tail[..end.len()]);
            let integral = class.advance(content, &sources, self.diffusivity(), dt);
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

    /// Heat stored since time zero [J].
    pub fn stored(&self, state: &[f64]) -> f64 {
        let class = &self.classes[0];
        let tail = &state[state.len() - self.faces.len() - 2..];
        let values = &tail[..self.faces.len()];
        let ones = class.modes.each_ref().map(|m| vec![1.0; m.mass.nrows()]);
        let masses = [0, 1, 2].map(|a| multiply(&class.modes[a].mass, &ones[a]));
        let rows = [0, 1, 2].map(|a| class.modes[a].project(&masses[a]));
        let content = self.effective(class, &state[..class.len()], values);
        let free = contract(&content, rows.each_ref().map(Vec::as_slice));
        let held: f64 = self
            .prescribed()
            .map(|f| {
                let b = &class.drives[f].boundary;
                values[f] * (0..3).map(|a| dot(&masses[a], &b[a])).product::<f64>()
            })
            .sum();
        self.copies * self.capacity * (free + held)
    }

    pub fn totals(&self, state: &[f64]) -> HeatTotals {
        let n = state.len();
        HeatTotals { brought_in: state[n - 2], lost: state[n - 1] }
    }

    /// Temperature above the initial one at a point of the mesh and its `image` [K].
    ///
    /// `faces` holds the present face values of each class.
    pub fn temperature_at(
        &self,
        mesh: &Mesh,
        state: &[f64],
        faces: &[Vec<f64>],
        point: [f64; 3],
        image: [bool; 2],
    ) -> f64 {
        let mut sum = 0.0;
        for (class, (content, values)) in self.contents(state).zip(faces).enumerate() {
            let class = &self.classes[class];
            if class.is_zero(content, values) {
                continue;
            }
            let rows = [0, 1, 2].map(|a| class.modes[a].at(&mesh.axes[a], point[a]));
            let content = self.effective(class, content, values);
            let mut part = contract(&content, rows.each_ref().map(Vec::as_slice));
            for f in self.prescribed() {
                let factor = |a: usize| {
                    let shape = mesh.axes[a].shape_at(point[a]);
                    let b = &class.drives[f].boundary[a];
                    (0..shape.count).map(|i| shape.values[i] * b[shape.first + i]).sum::<f64>()
                };
                part += values[f] * (0..3).map(factor).product::<f64>();
            }
            sum += class.parity.sign(image) * part;
        }
        sum
    }

    /// Temperature above the initial one at all nodes, class by class [K]; empty for a class that
    /// is zero.
    pub fn nodal(&self, state: &[f64], faces: &[Vec<f64>]) -> Vec<Vec<f64>> {
        let parts = self.contents(state).zip(faces).zip(&self.classes);
        parts
            .map(|((content, values), class)| {
                if class.is_zero(content, values) {
                    return Vec::new();
                }
                let content = self.effective(class, content, values);
                let shapes = class.modes.each_ref().map(|m| &m.shapes);
                let mut nodal = transform(&content, shapes, Side::Direct);
                for f in self.prescribed() {
                    let b = class.drives[f].boundary.each_ref().map(Vec::as_slice);
                    add_product(&mut nodal, values[f], b);
                }
                nodal
            })
            .collect()
    }

    fn diffusivity(&self) -> f64 {
        self.conductivity / self.capacity
    }

    fn prescribed(&self) -> impl Iterator<Item = usize> + '_ {
        (0..self.faces.len()).filter(|&f| self.faces[f].1 == ThermalFace::Prescribed)
    }

    fn split_mut<'s>(&self, state: &'s mut [f64]) -> (&'s mut [f64], &'s mut [f64]) {
        let tail = self.faces.len() + 2;
        state.split_at_mut(state.len() - tail)
    }

    fn contents<'s>(&'s self, state: &'s [f64]) -> impl Iterator<Item = &'s [f64]> {
        let mut rest = state;
        self.classes.iter().map(move |class| {
            let (content, after) = rest.split_at(class.len());
            rest = after;
            content
        })
    }

    /// Modal amplitudes of the free nodes: the heat content less what the prescribed nodes hold.
    fn effective(&self, class: &HeatClass, content: &[f64], values: &[f64]) -> Vec<f64> {
        let mut out = content.to_vec();
        for f in self.prescribed() {
            let mass = class.drives[f].mass.each_ref().map(Vec::as_slice);
            add_product(&mut out, -values[f], mass);
        }
        out
    }

    /// Rate of change of the modal heat content that loads and faces cause [K/s, modal].
    fn source(&self, class: &HeatClass, surface: &[Vec<f64>; 2], values: &[f64]) -> Vec<f64> {
        let mut out = vec![0.0; class.len()];
        for (nodal, high) in surface.iter().zip([false, true]) {
            class.add_surface(&mut out, nodal, high, 1.0 / self.capacity);
        }
        for (f, &(_, condition)) in self.faces.iter().enumerate() {
            let drive = &class.drives[f];
            match condition {
                ThermalFace::Flux => class.add_area(&mut out, drive, values[f] / self.capacity),
                ThermalFace::Convective(coefficient) => {
                    class.add_area(&mut out, drive, coefficient * values[f] / self.capacity);
                }
                ThermalFace::Prescribed => {
                    class.add_prescribed(&mut out, drive, self.diffusivity() * values[f]);
                }
            }
        }
        out
    }

    /// What passed the faces of the whole body.
    fn passed(&self, class: &HeatClass, passage: &Passage) -> HeatTotals {
        let mut brought = passage.surface.iter().flatten().sum::<f64>();
        let mut lost = 0.0;
        for (f, &(_, condition)) in self.faces.iter().enumerate() {
            let drive = &class.drives[f];
            let value = passage.values[f];
            match condition {
                ThermalFace::Flux => brought += value * drive.measure,
                ThermalFace::Convective(coefficient) => {
                    let held = self.held_at(class, f, passage);
                    lost += coefficient * (held - value * drive.measure);
                }
                ThermalFace::Prescribed => {
                    lost += class.surface_at_boundary(drive, &passage.surface);
                    lost -= self.reaction(class, f, passage);
                }
            }
            if condition != ThermalFace::Prescribed {
                lost += self.driven_at_prescribed(class, f, condition, value);
            }
        }
        HeatTotals { brought_in: self.copies * brought, lost: self.copies * lost }
    }

    /// `∫∫ θ dA dt` over a face [K m² s].
    fn held_at(&self, class: &HeatClass, f: usize, passage: &Passage) -> f64 {
        let free = contract(&passage.integral, class.drives[f].area.each_ref().map(Vec::as_slice));
        let held = |g: usize| passage.values[g] * class.face_overlap(f, g);
        free + self.prescribed().map(held).sum::<f64>()
    }

    /// Heat that the nodes of a prescribed face took up or passed on: `bᵀ(ρc M Δθ + k K ∫θ dt)`.
    fn reaction(&self, class: &HeatClass, f: usize, passage: &Passage) -> f64 {
        let drive = &class.drives[f];
        let conducted = class.stiffness_terms(drive).map(|t| contract(&passage.integral, t));
        let mut sum = self.capacity
            * contract(&passage.change, drive.mass.each_ref().map(Vec::as_slice))
            + self.conductivity * conducted.iter().sum::<f64>();
        for g in self.prescribed() {
            let (mass, stiffness) = class.boundary_overlap(f, g);
            sum += self.capacity * mass * passage.value_change[g];
            sum += self.conductivity * stiffness * passage.values[g];
        }
        sum
    }

    /// Heat that a flux or an ambient brings straight into prescribed nodes.
    fn driven_at_prescribed(
        &self,
        class: &HeatClass,
        f: usize,
        condition: ThermalFace,
        value: f64,
    ) -> f64 {
        let factor = match condition {
            ThermalFace::Convective(coefficient) => coefficient,
            _ => 1.0,
        };
        self.prescribed().map(|g| factor * value * class.face_overlap(f, g)).sum()
    }
}

impl HeatClass {
    fn new(
        mesh: &Mesh,
        parity: Parity,
        conductivity: f64,
        faces: &[(MeshFace, ThermalFace)],
    ) -> Self {
        let modes = [0, 1, 2].map(|axis| {
            let mut ends = end_conditions(faces, axis, conductivity);
            if axis < 2 && parity.odd[axis] {
                ends[0] = EndCondition::Prescribed;
            }
            AxisModes::of(&mesh.axes[axis], ends)
        });
        let drives = (0..faces.len()).map(|f| FaceDrive::new(mesh, parity, &modes, faces, f));
        let drives = drives.collect();
        Self { parity, modes, drives }
    }

    fn len(&self) -> usize {
        self.modes.iter().map(AxisModes::count).product()
    }

    fn is_zero(&self, content: &[f64], values: &[f64]) -> bool {
        values.iter().chain(content).all(|&v| v == 0.0)
    }

    /// Replaces the content by its value a time `dt` later and returns its integral over the step,
    /// as [`exponential::weights`] say; `sources` holds the source at the beginning and its time
    /// derivatives.
    fn advance(
        &self,
        content: &mut [f64],
        sources: &[Vec<f64>],
        diffusivity: f64,
        dt: f64,
    ) -> Vec<f64> {
        let [x, y, z] = self.modes.each_ref().map(|m| &m.decay);
        let mut integral = vec![0.0; content.len()];
        let mut at = 0;
        for decay_z in z {
            for decay_y in y {
                for decay_x in x {
                    let exponent = diffusivity * (decay_x + decay_y + decay_z) * dt;
                    let weights = exponential::weights(exponent);
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
                    at += 1;
                }
            }
        }
        integral
    }

    fn add_surface(&self, out: &mut [f64], nodal: &[f64], high: bool, factor: f64) {
        if nodal.is_empty() {
            return;
        }
        let [x, y, z] = &self.modes;
        let plane = Mat::from_fn(1, 1, |_, _| 1.0);
        let modal = transform(nodal, [&x.shapes, &y.shapes, &plane], Side::Transposed);
        let end = z.at_node(if high { z.shapes.nrows() - 1 } else { 0 });
        for (slab, amplitude) in out.chunks_exact_mut(modal.len()).zip(end) {
            for (value, m) in slab.iter_mut().zip(&modal) {
                *value += factor * amplitude * m;
            }
        }
    }

    fn add_area(&self, out: &mut [f64], drive: &FaceDrive, factor: f64) {
        add_product(out, factor, drive.area.each_ref().map(Vec::as_slice));
    }

    /// `+ a g (Σ μ m̂ − k̂)`: the boundary value's share in the rate of the heat content.
    fn add_prescribed(&self, out: &mut [f64], drive: &FaceDrive, factor: f64) {
        for term in self.stiffness_terms(drive) {
            add_product(out, -factor, term);
        }
        for axis in 0..3 {
            let weighted: Vec<f64> =
                drive.mass[axis].iter().zip(&self.modes[axis].decay).map(|(m, d)| m * d).collect();
            let mut term = drive.mass.each_ref().map(Vec::as_slice);
            term[axis] = &weighted;
            add_product(out, factor, term);
        }
    }

    /// `φᵀ K b = Σ_axis (φᵀ K b)_axis ∏_others (φᵀ M b)`.
    fn stiffness_terms<'a>(&self, drive: &'a FaceDrive) -> [[&'a [f64]; 3]; 3] {
        [0, 1, 2].map(|axis| {
            let mut term = drive.mass.each_ref().map(Vec::as_slice);
            term[axis] = &drive.stiffness[axis];
            term
        })
    }

    /// `bᵀ M b'` and `bᵀ K b'` of two prescribed faces.
    fn boundary_overlap(&self, f: usize, g: usize) -> (f64, f64) {
        let (a, b) = (&self.drives[f].boundary, &self.drives[g].boundary);
        let mass = [0, 1, 2].map(|i| dot(&a[i], &multiply(&self.modes[i].mass, &b[i])));
        let stiffness = [0, 1, 2].map(|i| dot(&a[i], &multiply(&self.modes[i].stiffness, &b[i])));
        let product = mass.iter().product();
        let sum = (0..3).map(|i| stiffness[i] * mass[(i + 1) % 3] * mass[(i + 2) % 3]).sum();
        (product, sum)
    }

    /// `∫ b' dA` over the face `f`, for the prescribed nodes `b'` of face `g` [m²].
    fn face_overlap(&self, f: usize, g: usize) -> f64 {
        (0..3).map(|a| dot(&self.drives[f].area_nodal[a], &self.drives[g].boundary[a])).product()
    }

    /// Surface load that falls on nodes of a prescribed face [W].
    fn surface_at_boundary(&self, drive: &FaceDrive, surface: &[Vec<f64>; 2]) -> f64 {
        let [bx, by, bz] = &drive.boundary;
        let ends = [bz[0], bz[bz.len() - 1]];
        let parts = surface.iter().zip(ends).filter(|(nodal, _)| !nodal.is_empty());
        parts.map(|(nodal, end)| contract(nodal, [bx, by, &[end]])).sum()
    }
}

impl FaceDrive {
    fn new(
        mesh: &Mesh,
        parity: Parity,
        modes: &[AxisModes; 3],
        faces: &[(MeshFace, ThermalFace)],
        f: usize,
    ) -> Self {
        let (face, condition) = faces[f];
        let end_node = |face: MeshFace| if face.high { mesh.axes[face.axis].len() - 1 } else { 0 };
        let mut boundary = [0, 1, 2].map(|a| vec![0.0; mesh.axes[a].len()]);
        if condition == ThermalFace::Prescribed {
            boundary = [0, 1, 2].map(|a| vec![1.0; mesh.axes[a].len()]);
            for axis in (0..2).filter(|&a| parity.odd[a]) {
                boundary[axis][0] = 0.0;
            }
            boundary[face.axis].fill(0.0);
            boundary[face.axis][end_node(face)] = 1.0;
            // A node on the edge of two prescribed faces belongs to the face listed first.
            for &(earlier, other) in &faces[..f] {
                if other == ThermalFace::Prescribed && earlier.axis != face.axis {
                    boundary[earlier.axis][end_node(earlier)] = 0.0;
                }
            }
        }
        let area_nodal = [0, 1, 2].map(|a| face_factor(mesh, face, a));
        let project = |v: &[Vec<f64>; 3]| [0, 1, 2].map(|a| modes[a].project(&v[a]));
        let mass = project(&[0, 1, 2].map(|a| multiply(&modes[a].mass, &boundary[a])));
        let stiffness = project(&[0, 1, 2].map(|a| multiply(&modes[a].stiffness, &boundary[a])));
        let measure = area_nodal.iter().map(|v| v.iter().sum::<f64>()).product();
        Self { area: project(&area_nodal), boundary, mass, stiffness, area_nodal, measure }
    }
}

/// The fields of a state with so many modes in each class, and so many faces.
fn state_layout(classes: impl Iterator<Item = usize>, faces: usize) -> Layout {
    let field = |name, words, per| Field { name, words, per, width: 1 };
    let content = field("content", "amplitude of a mode of heat [K m^(3/2)]", Per::Mode);
    let value = field("face_value", "flux [W/m²] or rise of temperature [K] of a face", Per::Face);
    let brought_in = field("brought_in", "heat brought in since time zero [J]", Per::Body);
    let lost = field("lost", "heat lost since time zero [J]", Per::Body);
    let layout = classes.fold(Layout::default(), |all, modes| all.with(content, modes));
    layout.with(value, faces).with(brought_in, 1).with(lost, 1)
}

/// Conditions at both ends of an axis.
pub fn end_conditions(
    faces: &[(MeshFace, ThermalFace)],
    axis: usize,
    conductivity: f64,
) -> [EndCondition; 2] {
    let mut ends = [EndCondition::Natural; 2];
    for (face, condition) in faces.iter().filter(|(face, _)| face.axis == axis) {
        ends[usize::from(face.high)] = match condition {
            ThermalFace::Flux => EndCondition::Natural,
            ThermalFace::Prescribed => EndCondition::Prescribed,
            ThermalFace::Convective(h) => EndCondition::Convective(h / conductivity),
        };
    }
    ends
}

/// Factor along one axis of `∫ N dA` over a face.
fn face_factor(mesh: &Mesh, face: MeshFace, axis: usize) -> Vec<f64> {
    let along = &mesh.axes[axis];
    if axis != face.axis {
        return along.integrals();
    }
    let mut end = vec![0.0; along.len()];
    let node = if face.high { along.len() - 1 } else { 0 };
    end[node] = along.weight_at(along.nodes[node]);
    end
}

/// `Σ a_k t^{k + shift}/(k + shift)!` of lists that are one as long as the other or empty: the value
/// at `t` of a polynomial with these derivatives at zero, or its integral with a `shift` of one.
fn taylor<'a>(lists: impl Iterator<Item = &'a [f64]>, shift: usize, t: f64) -> Vec<f64> {
    let mut sum: Vec<f64> = Vec::new();
    let mut weight = if shift == 0 { 1.0 } else { t };
    for (k, list) in lists.enumerate() {
        sum.resize(sum.len().max(list.len()), 0.0);
        for (s, value) in sum.iter_mut().zip(list) {
            *s += weight * value;
        }
        weight *= t / (k + shift + 1) as f64;
    }
    sum
}

fn multiply(matrix: &Mat<f64>, v: &[f64]) -> Vec<f64> {
    (0..matrix.nrows()).map(|i| (0..v.len()).map(|j| matrix[(i, j)] * v[j]).sum()).collect()
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(x, y)| x * y).sum()
}
