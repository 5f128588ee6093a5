//! Heat conduction on a structured mesh, solved exactly in time.
//!
//! The Galerkin equations `M(ρc) θ̇ + K(k) θ = F` of a box or a meridian section with uniform conditions on each face
//! are separable where ρc and k vary along z alone: M and K are sums of Kronecker products of the matrices of the axes.
//! Modes along the surface and modes along z ([`DepthModes`]) diagonalise them once (R. E. Lynch, J. R. Rice and
//! D. H. Thomas 1964, doi 10.1007/BF01386067), and each product mode then obeys a scalar equation whose solution under
//! a load that is a polynomial in time is an exponential and φ-functions. So a step of any length costs a few
//! operations per node, is L-stable and has no time error; θ is the temperature above the initial one.
//!
//! Arrays are modal, `(i, j, mode)`, or mixed: `(i, j, k)` with modes along the surface and coefficients in the basis
//! of [`DepthModes`] along z.

mod class;
mod depth;
mod homogeneous;
mod layered;
mod modal;
mod rates;
mod row;
mod temperatures;

pub use layered::depth_ends;
pub use modal::ModalRow;

use super::modes::EndCondition;
use crate::math::exponential;
use crate::math::separable::{add_product, contract};
use crate::method::heat_totals::HeatTotals;
use crate::method::mesh::{Mesh, MeshFace};
use crate::state::{Field, Layout, Per};
use class::Class;
pub use depth::DepthModes;

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
pub struct HeatProblem<D: DepthModes> {
    depth: D,
    copies: f64,
    faces: Vec<(MeshFace, ThermalFace)>,
    classes: Vec<Class<D::Columns>>,
}

/// Loads of the heat problem, or a time derivative of them.
pub struct HeatLoads<'a> {
    /// For each class, heat into the nodes of the bottom and the top of the mesh [W]; empty for none.
    pub surface: &'a [[Vec<f64>; 2]],
    /// For each class and face: flux [W/m²], or temperature above the initial one [K].
    pub faces: &'a [Vec<f64>],
}

/// Integrals over a step of the even part; or, as rates, its values at a moment.
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

/// Heat that passed the faces over a step, and the size of the terms of which it is the sum.
struct Passed {
    totals: HeatTotals,
    terms: f64,
}

/// Terms over the heat that is their sum from which on rounding of the terms counts, that rounding over them, and the
/// largest part of the heat that it may be.
const CANCELLED: f64 = 1e4;
const ROUNDING: f64 = 4e-13;
const LARGEST: f64 = 1e-2;

impl HeatLoads<'_> {
    /// Returns true if loads drive a class.
    fn drive(&self, class: usize) -> bool {
        let mut values = self.faces[class].iter().chain(self.surface[class].iter().flatten());
        values.any(|&value| value != 0.0)
    }
}

impl<D: DepthModes> HeatProblem<D> {
    /// `lateral_conductivity` is that of the layers if lateral faces are convective.
    fn new(
        mesh: &Mesh,
        depth: D,
        lateral_conductivity: f64,
        faces: Vec<(MeshFace, ThermalFace)>,
    ) -> Self {
        let class = |parity| Class::new(mesh, parity, &depth, lateral_conductivity, &faces);
        let classes = mesh.parities().into_iter().map(class).collect();
        Self { depth, copies: mesh.copies(), faces, classes }
    }

    /// Returns the fields of a state: modes class by class, then the face values of the last step, then totals.
    pub fn layout(&self) -> Layout {
        let field = |name, words, per| Field { name, words, per, width: 1 };
        let content = field("content", "amplitude of a mode of heat [K m^(3/2)]", Per::Mode);
        let value =
            field("face_value", "flux [W/m²] or rise of temperature [K] of a face", Per::Face);
        let modes = self.classes.iter().map(|class| self.len(class));
        let layout = modes.fold(Layout::default(), |all, modes| all.with(content, modes));
        HeatTotals::at_end_of(layout.with(value, self.faces.len()))
    }

    /// Advances `state` by `dt` [s] under loads that are polynomials in time, at most quadratic: one
    /// entry of `loads` for their values at the beginning and one for each derivative.
    pub fn advance(&self, state: &mut [f64], loads: &[HeatLoads], dt: f64) {
        let (mut contents, tail) = state.split_at_mut(state.len() - self.tail());
        for (index, class) in self.classes.iter().enumerate() {
            let (content, rest) = contents.split_at_mut(self.len(class));
            contents = rest;
            let last = loads.iter().rposition(|part| part.drive(index));
            if last.is_none() && is_zero(content, tail) {
                continue;
            }
            let source =
                |part: &HeatLoads| self.source(class, &part.surface[index], &part.faces[index]);
            let sources: Vec<Vec<f64>> = loads[..=last.unwrap_or(0)].iter().map(source).collect();
            if !class.parity.is_even() {
                // Antisymmetric parts carry no net heat.
                self.advance_modes(class, content, &sources, dt);
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
            let integral = self.advance_modes(class, content, &sources, dt);
            let after = self.effective(class, content, &end);
            let passage = Passage {
                change: after.iter().zip(&before).map(|(a, b)| a - b).collect(),
                integral: self.effective(class, &integral, &values),
                surface: [surface(0), surface(1)],
                value_change: end.iter().zip(&*tail).map(|(a, b)| a - b).collect(),
                values,
            };
            tail[..end.len()].copy_from_slice(&end);
            self.settled(class, &passage, HeatTotals::read(tail)).add_to(tail);
        }
    }

    /// The heat that passed the faces of the whole body. What is lost is taken from the balance where it is the small
    /// difference of large terms: over a long step a strong convection multiplies the rounding of temperatures that have
    /// settled.
    fn settled(
        &self,
        class: &Class<D::Columns>,
        passage: &Passage,
        before: HeatTotals,
    ) -> HeatTotals {
        let Passed { totals: HeatTotals { brought_in, lost }, terms } = self.passed(class, passage);
        if terms <= CANCELLED * lost.abs().max(brought_in.abs()) {
            return HeatTotals { brought_in, lost };
        }
        let stored = self.stored_of(class, &passage.change, &passage.value_change);
        let balanced = brought_in - stored;
        let rounding = ROUNDING * terms;
        // Beyond that nothing is known of the balance, and the step is refused.
        let heats = [stored, brought_in, before.brought_in, before.lost];
        let is_known =
            rounding <= LARGEST * heats.iter().fold(0.0, |most: f64, q| most.max(q.abs()));
        let is_rounding = is_known && (balanced - lost).abs() <= rounding;
        HeatTotals { brought_in, lost: if is_rounding { balanced } else { lost } }
    }

    pub fn totals(&self, state: &[f64]) -> HeatTotals {
        HeatTotals::read(state)
    }

    fn prescribed(&self) -> impl Iterator<Item = usize> + '_ {
        (0..self.faces.len()).filter(|&f| self.faces[f].1 == ThermalFace::Prescribed)
    }

    /// Number of modes of a class.
    fn len(&self, class: &Class<D::Columns>) -> usize {
        class.plane() * self.depth.count()
    }

    /// Length of the part of a state after the modes.
    fn tail(&self) -> usize {
        self.faces.len() + 2
    }

    fn contents<'s>(&'s self, state: &'s [f64]) -> impl Iterator<Item = &'s [f64]> {
        let mut rest = state;
        self.classes.iter().map(move |class| {
            let (content, after) = rest.split_at(self.len(class));
            rest = after;
            content
        })
    }

    /// Modal amplitudes of the free nodes: the heat content without that of the prescribed nodes.
    fn effective(&self, class: &Class<D::Columns>, content: &[f64], values: &[f64]) -> Vec<f64> {
        let mut out = content.to_vec();
        if let Some(held) = self.held(class, values) {
            out.iter_mut().zip(held).for_each(|(value, held)| *value -= held);
        }
        out
    }

    /// `φᵀ M b g` of the prescribed nodes; `None` where all their values are zero.
    fn held(&self, class: &Class<D::Columns>, values: &[f64]) -> Option<Vec<f64>> {
        if self.prescribed().all(|f| values[f] == 0.0) {
            return None;
        }
        let mut mixed = self.zeros(class);
        for f in self.prescribed() {
            add_product(&mut mixed, values[f], class.drives[f].mass.each_ref().map(Vec::as_slice));
        }
        Some(self.depth.to_modal(class, mixed))
    }

    fn zeros(&self, class: &Class<D::Columns>) -> Vec<f64> {
        vec![0.0; class.plane() * self.depth.basis().ncols()]
    }

    /// Rate of change of the modal heat content that loads and faces cause: `φᵀ(F − K b g) + λ φᵀ M b g`.
    fn source(
        &self,
        class: &Class<D::Columns>,
        surface: &[Vec<f64>; 2],
        values: &[f64],
    ) -> Vec<f64> {
        let (capacity, conductivity) = (self.depth.capacity(), self.depth.conductivity());
        let mut mixed = self.zeros(class);
        for (nodal, high) in surface.iter().zip([false, true]) {
            class.add_surface(&mut mixed, nodal, &self.depth.at_end(high), 1.0 / capacity);
        }
        for (f, &(_, condition)) in self.faces.iter().enumerate() {
            let drive = &class.drives[f];
            let area = drive.area.each_ref().map(Vec::as_slice);
            match condition {
                ThermalFace::Flux => add_product(&mut mixed, values[f] / capacity, area),
                ThermalFace::Convective(coefficient) => {
                    add_product(&mut mixed, coefficient * values[f] / capacity, area);
                }
                ThermalFace::Prescribed => {
                    let factor = conductivity / capacity * values[f];
                    for term in &drive.stiffness {
                        add_product(&mut mixed, -factor, term.each_ref().map(Vec::as_slice));
                    }
                }
            }
        }
        let mut out = self.depth.to_modal(class, mixed);
        if let Some(held) = self.held(class, values) {
            self.depth.for_each_mode(class, |at, decay| out[at] += decay * held[at]);
        }
        out
    }

    /// Replaces the content of a class by its value a time `dt` later and returns its integral over the step (see
    /// [`exponential::weights`]). `sources` holds the source at the beginning and its time derivatives.
    fn advance_modes(
        &self,
        class: &Class<D::Columns>,
        content: &mut [f64],
        sources: &[Vec<f64>],
        dt: f64,
    ) -> Vec<f64> {
        let mut integral = vec![0.0; content.len()];
        self.depth.for_each_mode(class, |at, decay| {
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

    /// Returns the heat that passed the faces of the whole body.
    fn passed(&self, class: &Class<D::Columns>, passage: &Passage) -> Passed {
        let integral = self.depth.to_mixed(class, &passage.integral);
        let change = self.depth.to_mixed(class, &passage.change);
        let mut brought = passage.surface.iter().flatten().sum::<f64>();
        let (mut lost, mut terms) = (0.0, 0.0);
        for (f, &(_, condition)) in self.faces.iter().enumerate() {
            let drive = &class.drives[f];
            let value = passage.values[f];
            let overlap = |g: usize| class.face_overlap(f, g);
            let coefficient = match condition {
                ThermalFace::Flux => {
                    brought += value * drive.measure;
                    1.0
                }
                ThermalFace::Convective(coefficient) => {
                    let free = contract(&integral, drive.area.each_ref().map(Vec::as_slice));
                    let held = self.prescribed().map(|g| passage.values[g] * overlap(g));
                    let held = free + held.sum::<f64>();
                    lost += coefficient * (held - value * drive.measure);
                    terms += coefficient * (held.abs() + (value * drive.measure).abs());
                    coefficient
                }
                ThermalFace::Prescribed => {
                    lost += class.surface_at_boundary(drive, &passage.surface);
                    let parts = self.reaction(class, f, (&change, &integral), passage);
                    lost -= parts.iter().sum::<f64>();
                    terms += parts.iter().map(|part| part.abs()).sum::<f64>();
                    0.0
                }
            };
            // Heat that a flux or a convective face supplies directly to prescribed nodes.
            lost += self.prescribed().map(|g| coefficient * value * overlap(g)).sum::<f64>();
        }
        let totals = HeatTotals { brought_in: self.copies * brought, lost: self.copies * lost };
        Passed { totals, terms: self.copies * terms }
    }

    /// Heat that the nodes of a prescribed face took up or passed on, `bᵀ(M Δθ + K ∫θ dt)`, in its parts.
    fn reaction(
        &self,
        class: &Class<D::Columns>,
        f: usize,
        (change, integral): (&[f64], &[f64]),
        passage: &Passage,
    ) -> Vec<f64> {
        let drive = &class.drives[f];
        let (capacity, conductivity) = (self.depth.capacity(), self.depth.conductivity());
        let conducted =
            |term: &[Vec<f64>; 3]| contract(integral, term.each_ref().map(Vec::as_slice));
        let mut parts = vec![
            capacity * contract(change, drive.mass.each_ref().map(Vec::as_slice))
                + conductivity * drive.stiffness.iter().map(conducted).sum::<f64>(),
        ];
        for g in self.prescribed() {
            let (mass, stiffness) = class.boundary_overlap(&self.depth, f, g);
            parts.push(capacity * mass * passage.value_change[g]);
            parts.push(conductivity * stiffness * passage.values[g]);
        }
        parts
    }
}

fn is_zero(content: &[f64], values: &[f64]) -> bool {
    values.iter().chain(content).all(|&v| v == 0.0)
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

/// Returns `Σ a_k t^{k + shift}/(k + shift)!` of lists that are empty or of equal length: the value at `t` of a
/// polynomial with these derivatives at zero, or its integral with a `shift` of one.
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
