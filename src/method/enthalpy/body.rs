//! Discrete data of a body: fields that follow from enthalpies, and the heat flow that they cause.

use super::grid::Grid;
use super::lateral::{End, Lateral};
use super::setup::{Condition, Loads, Setup};
use crate::laws::{Curve, Enthalpy, radiative_flux, radiative_slope};

/// All data known before time starts.
pub struct Body {
    pub reference: f64,
    pub copies: f64,
    pub grid: Grid,
    pub lateral: Lateral,
    /// Area of a level [m²].
    area: f64,
    /// Volume next to each node [m³].
    pub volumes: Vec<f64>,
    /// Laws of the levels' volumetric enthalpy, and the index of each level's law.
    laws: Vec<Enthalpy>,
    law_of: Vec<usize>,
    /// Heat conductivity integral of each material.
    curves: Vec<Curve>,
    pub faces: Vec<FaceNodes>,
    /// True if a node has a prescribed temperature.
    pub held: Vec<bool>,
    /// True if systems are symmetric: one material without contacts.
    pub is_symmetric: bool,
}

pub struct FaceNodes {
    pub condition: Condition,
    axis: usize,
    high: bool,
    /// Nodes with their areas [m²]; for a prescribed face those that it holds.
    pub nodes: Vec<(usize, f64)>,
    /// Ends along z of the part of the face that each node represents [m].
    spans: Vec<[f64; 2]>,
    measure: f64,
}

/// Fields that follow from the nodal enthalpies.
pub struct Fields {
    /// Temperature above the reference [K].
    pub rise: Vec<f64>,
    /// `dT/dH` [m³ K/J]
    pub inverse_capacity: Vec<f64>,
    /// `ρc` without latent heat [J/(m³ K)].
    pub sensible: Vec<f64>,
    /// Conductivity of the material below and above [W/(m K)], and its integral from the reference [W/m].
    pub conductivity: [Vec<f64>; 2],
    pub integral: [Vec<f64>; 2],
}

/// Values of loads at a moment.
pub struct Drive {
    pub faces: Vec<f64>,
    pub surface: [Vec<f64>; 2],
}

/// Derivatives of the heat losses to the surroundings by temperature.
pub struct Losses {
    /// Of the nodes [W/K].
    pub nodes: Vec<f64>,
    /// Their means over the areas of bottom and top [W/(m² K)].
    pub ends: [f64; 2],
    /// Those of each level to a bath, through lateral faces, over the area of the level [W/(m² K)]; empty without a
    /// bath. Other lateral faces belong to the modes of conduction along x and y.
    pub aside: Vec<f64>,
}

/// Heat that flows at a moment [W].
pub struct Flow {
    /// Heat flow into the nodes.
    pub nodes: Vec<f64>,
    pub brought_in: f64,
    /// Heat flow out through faces whose flux depends on the temperature, without those of prescribed temperature.
    pub lost: f64,
}

impl Body {
    pub fn new(setup: &Setup) -> Self {
        let grid = Grid::new(setup);
        let (laws, law_of) = laws(setup, &grid);
        let curve = |substance: &crate::laws::Conduction| substance.kirchhoff(setup.reference);
        let curves: Vec<Curve> = setup.materials.iter().map(curve).collect();
        let areas = grid.areas();
        let volumes = grid.levels.iter().flat_map(|l| areas.iter().map(|area| area * l.height()));
        let volumes = volumes.collect();
        let mut held = vec![false; grid.nodes()];
        let faces = face_nodes(setup, &grid, &mut held);
        let first = grid.levels[0].materials[0];
        let is_symmetric = setup.contacts.is_empty()
            && grid.levels.iter().all(|level| level.materials == [first; 2]);
        let lateral = Lateral::new(&grid.sides, lateral_ends(&grid, &curves, &faces));
        Self {
            reference: setup.reference,
            copies: setup.mesh.copies(),
            grid,
            lateral,
            area: areas.iter().sum(),
            volumes,
            laws,
            law_of,
            curves,
            faces,
            held,
            is_symmetric,
        }
    }

    pub fn law(&self, node: usize) -> &Enthalpy {
        &self.laws[self.law_of[node / self.grid.plane()]]
    }

    pub fn fields(&self, contents: &[f64]) -> Fields {
        let list = || Vec::with_capacity(contents.len());
        let mut fields = Fields {
            rise: list(),
            inverse_capacity: list(),
            sensible: list(),
            conductivity: [list(), list()],
            integral: [list(), list()],
        };
        let plane = self.grid.plane();
        for (k, level) in self.grid.levels.iter().enumerate() {
            let law = &self.laws[self.law_of[k]];
            let curves = level.materials.map(|material| &self.curves[material]);
            for content in &contents[k * plane..][..plane] {
                let point = law.at(*content);
                fields.rise.push(point.rise);
                fields.inverse_capacity.push(point.inverse_capacity);
                fields.sensible.push(point.sensible);
                let below = curves[0].at(point.rise);
                let above = if level.is_uniform() { below } else { curves[1].at(point.rise) };
                for (side, (conductivity, integral)) in [below, above].into_iter().enumerate() {
                    fields.conductivity[side].push(conductivity);
                    fields.integral[side].push(integral);
                }
            }
        }
        fields
    }

    /// Conductivities of the materials next to a level at the reference temperature.
    pub fn reference_conductivity(&self, level: usize) -> [f64; 2] {
        self.grid.levels[level].materials.map(|material| self.curves[material].at(0.0).0)
    }

    pub fn flow(&self, fields: &Fields, drive: &Drive) -> Flow {
        let mut nodes = vec![0.0; fields.rise.len()];
        let [below, above] = &fields.integral;
        self.grid.conduct([below, above], &fields.rise, &mut nodes);
        let (mut brought_in, mut lost) = (0.0, 0.0);
        for (face, &value) in self.faces.iter().zip(&drive.faces) {
            match face.condition {
                Condition::Prescribed => continue,
                Condition::Flux => brought_in += face.measure * value,
                Condition::Convective(_) | Condition::Radiative(_) | Condition::Wetted { .. } => {}
            }
            for (&(node, area), span) in face.nodes.iter().zip(&face.spans) {
                let heat = area * self.flux(face.condition, fields.rise[node], value, span);
                nodes[node] += heat;
                if face.condition != Condition::Flux {
                    lost -= heat;
                }
            }
        }
        let last = nodes.len() - self.grid.plane();
        for (start, surface) in [0, last].into_iter().zip(&drive.surface) {
            brought_in += surface.iter().sum::<f64>();
            nodes[start..].iter_mut().zip(surface).for_each(|(heat, load)| *heat += load);
        }
        Flow { nodes, brought_in, lost }
    }

    /// Flux into a face [W/m²].
    fn flux(&self, condition: Condition, rise: f64, value: f64, span: &[f64; 2]) -> f64 {
        match condition {
            Condition::Flux => value,
            Condition::Convective(coefficient) => coefficient * ((value - self.reference) - rise),
            Condition::Wetted { coefficient, ambient } => {
                wet(span, value) * coefficient * ((ambient - self.reference) - rise)
            }
            Condition::Radiative(emissivity) => {
                radiative_flux(emissivity, self.reference + rise, value)
            }
            Condition::Prescribed => 0.0,
        }
    }

    /// `−∂q/∂T` [W/(m² K)].
    fn flux_slope(&self, condition: Condition, rise: f64, value: f64, span: &[f64; 2]) -> f64 {
        match condition {
            Condition::Flux | Condition::Prescribed => 0.0,
            Condition::Convective(coefficient) => coefficient,
            Condition::Wetted { coefficient, .. } => wet(span, value) * coefficient,
            Condition::Radiative(emissivity) => radiative_slope(emissivity, self.reference + rise),
        }
    }

    pub fn losses(&self, fields: &Fields, drive: &Drive) -> Losses {
        let mut losses = vec![0.0; fields.rise.len()];
        let mut ends = [0.0; 2];
        let mut aside = Vec::new();
        for (face, &value) in self.faces.iter().zip(&drive.faces) {
            let mut sum = 0.0;
            for (&(node, area), span) in face.nodes.iter().zip(&face.spans) {
                let rise = fields.rise[node];
                let loss = area * self.flux_slope(face.condition, rise, value, span);
                losses[node] += loss;
                sum += loss;
            }
            match face.condition {
                _ if face.axis == 2 => ends[usize::from(face.high)] += sum / face.measure,
                Condition::Wetted { coefficient, .. } => {
                    aside.resize(self.grid.levels.len(), 0.0);
                    for (&(node, area), span) in face.nodes.iter().zip(&face.spans) {
                        let loss = area * coefficient * wet(span, value);
                        aside[node / self.grid.plane()] += loss / self.area;
                    }
                }
                _ => {}
            }
        }
        Losses { nodes: losses, ends, aside }
    }

    /// Sets the enthalpy of nodes of prescribed temperature.
    pub fn hold(&self, contents: &mut [f64], drive: &Drive) {
        for (face, value) in self.faces.iter().zip(&drive.faces) {
            if face.condition == Condition::Prescribed {
                for &(node, _) in &face.nodes {
                    contents[node] = self.law(node).content(value - self.reference);
                }
            }
        }
    }
}

impl Drive {
    /// Returns the loads a time `t` after the beginning of a step, from their values there and their derivatives.
    pub fn at(loads: &[Loads], t: f64) -> Self {
        let mut drive = Self { faces: Vec::new(), surface: [Vec::new(), Vec::new()] };
        let mut weight = 1.0;
        for (order, load) in loads.iter().enumerate() {
            add(&mut drive.faces, load.faces, weight);
            for (sum, list) in drive.surface.iter_mut().zip(load.surface) {
                add(sum, list, weight);
            }
            weight *= t / (order + 1) as f64;
        }
        drive
    }
}

/// Part of a span along z that is below a surface [1]; a span without extent is either above or below.
fn wet(&[low, high]: &[f64; 2], surface: f64) -> f64 {
    match high > low {
        true => ((surface - low) / (high - low)).clamp(0.0, 1.0),
        false => f64::from(u8::from(surface > low)),
    }
}

fn add(sum: &mut Vec<f64>, list: &[f64], weight: f64) {
    sum.resize(sum.len().max(list.len()), 0.0);
    sum.iter_mut().zip(list).for_each(|(sum, value)| *sum += weight * value);
}

/// Returns one law for each combination of materials and their shares in a level.
fn laws(setup: &Setup, grid: &Grid) -> (Vec<Enthalpy>, Vec<usize>) {
    let mut kinds: Vec<([usize; 2], f64)> = Vec::new();
    let mut laws = Vec::new();
    let number = |level: &super::grid::Level| {
        let share = match level.is_uniform() {
            true => 1.0,
            false => level.heights[0] / level.height(),
        };
        let kind = (level.materials, share);
        kinds.iter().position(|other| *other == kind).unwrap_or_else(|| {
            let [below, above] = level.materials.map(|material| &setup.materials[material]);
            laws.push(match level.is_uniform() {
                true => below.enthalpy(setup.reference),
                false => {
                    let parts = [(share, below), (1.0 - share, above)];
                    Enthalpy::of_mixture(&parts, setup.reference)
                }
            });
            kinds.push(kind);
            kinds.len() - 1
        })
    };
    let law_of = grid.levels.iter().map(number).collect();
    (laws, law_of)
}

fn face_nodes(setup: &Setup, grid: &Grid, held: &mut [bool]) -> Vec<FaceNodes> {
    let bounds = grid.bounds(setup.mesh.axes[2].start());
    let face_nodes = |face: &super::setup::Face| {
        let (axis, high) = (face.place.axis, face.place.high);
        let mut nodes = grid.face(axis, high);
        let measure = nodes.iter().map(|(_, area)| area).sum();
        let span = |&(node, _): &(usize, f64)| match axis {
            2 => [bounds[if high { bounds.len() - 1 } else { 0 }]; 2],
            _ => [bounds[node / grid.plane()], bounds[node / grid.plane() + 1]],
        };
        if face.condition == Condition::Prescribed {
            nodes.retain(|&(node, _)| !std::mem::replace(&mut held[node], true));
        }
        let spans = nodes.iter().map(span).collect();
        FaceNodes { condition: face.condition, axis, high, nodes, spans, measure }
    };
    setup.faces.iter().map(face_nodes).collect()
}

/// Approximate end conditions along x and y: with the materials' mean conductivity at the reference.
fn lateral_ends(grid: &Grid, curves: &[Curve], faces: &[FaceNodes]) -> [[End; 2]; 2] {
    let (mut sum, mut height) = (0.0, 0.0);
    for level in &grid.levels {
        for (own, material) in level.heights.iter().zip(level.materials) {
            sum += own * curves[material].at(0.0).0;
            height += own;
        }
    }
    let mut ends = [[End::Open(0.0); 2]; 2];
    for face in faces.iter().filter(|face| face.axis < 2) {
        let end = &mut ends[face.axis][usize::from(face.high)];
        *end = match (face.condition, *end) {
            (Condition::Prescribed, _) | (_, End::Held) => End::Held,
            (Condition::Convective(h), End::Open(ratio)) => End::Open(ratio + h * height / sum),
            (_, other) => other,
        };
    }
    ends
}
