//! Notches of a body that cracks: their state at time zero, and what they add to its measures of cracks.

use std::f64::consts::PI;

use crate::math::segments::{Segment, distance, united};
use crate::method::damage::{DamageState, Section, SectionProblem, broken};
use crate::method::fem::{Geometry, Mesh};
use crate::runtime::allowance::Allowance;
use crate::scene::Notch;

/// Distance over the length of the shortest notch below which notches touch.
const TOUCHING: f64 = 1e-9;

/// The notches of a body.
pub struct Notched {
    /// The state at time zero, without load.
    pub state: DamageState,
    /// Nodes that are broken in it.
    pub cut: Vec<bool>,
    /// Area of the notches [m²], mirror images included.
    pub area: f64,
    /// Area by which the energy of that state exceeds it [m²]: damage around the ends, and elements cut in part.
    excess: f64,
    /// Ends of notches within the section.
    ends: usize,
    section: Section,
}

impl Notched {
    /// The notches of a section, whose damage is the least that they need; `None` without any. `width` is that of a
    /// plane section [m].
    pub fn of(
        problem: &SectionProblem,
        notches: &[Notch],
        (mesh, width): (&Mesh, Option<f64>),
    ) -> Option<Self> {
        if notches.is_empty() {
            return None;
        }
        let section = &problem.elements.domain;
        let state = at_start(problem, notches);
        let cut = broken(&state.damage);
        let lines: Vec<Segment> = notches.iter().map(|notch| [notch.from, notch.to]).collect();
        let shortest = lines.iter().map(|[a, b]| distance(*a, *b)).fold(f64::INFINITY, f64::min);
        // Where notches lie on each other there is one.
        let lines = united(&lines, TOUCHING * shortest);
        let area = lines.iter().map(|line| area_of(line, mesh, width)).sum();
        let dissipated = mesh.copies() * problem.energies(&state).dissipated;
        let excess = dissipated / problem.elements.law.energy - area;
        Some(Self {
            ends: section.ends(&state.damage, &cut),
            section: section.clone(),
            state,
            cut,
            area,
            excess,
        })
    }

    /// Area of notches and cracks [m²] from the area of their energy. Damage around the ends of notches has energy
    /// without area; it is subtracted in proportion to the ends that remain, as those that reach a side lose it.
    pub fn area_of_cracks(&self, damage: &[f64], by_energy: f64) -> f64 {
        let section = &self.section;
        if section.grown(damage, &self.cut).is_empty() {
            return self.area;
        }
        let part = match self.ends {
            0 => 1.0,
            ends => (section.ends(damage, &self.cut) as f64 / ends as f64).min(1.0),
        };
        (by_energy - part * self.excess).max(self.area)
    }
}

/// The state of a section with notches in equilibrium without load.
fn at_start(problem: &SectionProblem, notches: &[Notch]) -> DamageState {
    let mut state = problem.initial_state();
    for notch in notches {
        for node in problem.elements.domain.nodes_along([notch.from, notch.to]) {
            state.damage[node] = 1.0;
        }
    }
    let cut = state.clone();
    let rise = vec![0.0; state.damage.len()];
    let none = vec![0.0; state.displacement.len()];
    // Without load nothing should fail. If it does, the excess of the ends is left out, and the first step reports it.
    match problem.advance(&mut state, (&rise, &none), &Allowance::default()) {
        Ok(_) => state,
        Err(_) => cut,
    }
}

/// Area of a notch and its mirror image [m²], a metre deep without a width; one in the plane of symmetry is its own.
fn area_of(&[from, to]: &Segment, mesh: &Mesh, width: Option<f64>) -> f64 {
    let length = distance(from, to);
    match mesh.geometry {
        Geometry::Box => {
            let is_in_plane = from[0] == 0.0 && to[0] == 0.0;
            let images = if mesh.mirrored[0] && !is_in_plane { 2.0 } else { 1.0 };
            images * length * width.unwrap_or(1.0)
        }
        // The lateral face of a frustum.
        Geometry::Axisymmetric => PI * (from[0] + to[0]) * length,
    }
}
