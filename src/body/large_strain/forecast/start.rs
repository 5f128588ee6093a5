//! Loads of the start over those at which metal yields.

use crate::laws::solid::large_strain::Deviator;
use crate::method::large_strain::LayerOfBody;
use crate::scene::{FaceName, HeldFace, LargeStrain};

use super::{HELD, OF_IMPLICIT_JUMP, OF_JUMP, OF_JUMP_OF_SHEET};

/// Loads that a scene sets at the start.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StartLoads {
    /// Strain by which faces jump over the yield strain, and stress of the loads over the yield stress; 0 of a body
    /// that does not yield.
    jump: f64,
    load: f64,
    /// True if all inputs of faces have start values other than zero, so that the default experiment has these loads;
    /// false of concrete, which softens under them.
    are_known: bool,
    /// True if stress relaxes under constant loads.
    relaxes: bool,
}

/// Stresses over the yield stress from which on some and most steps yield: those of loads are estimates, and take their
/// time to act.
const SOME: f64 = 1.0;
const MOST: f64 = 4.0;
/// Largest jump that counts: a body of which no step can be solved ends its run.
const LARGEST: f64 = 100.0;

impl StartLoads {
    pub fn of(solid: &LargeStrain, layers: &[LayerOfBody]) -> Self {
        let faces = || solid.faces.iter().map(|(&name, face)| (normal(name), face));
        let strain = faces().map(|(axis, face)| strain(solid, axis, face)).fold(0.0, f64::max);
        let mut stress: f64 = faces().map(|(axis, face)| stress(solid, axis, face)).sum();
        // A load that acts at once stresses a body that swings by twice what it does at rest.
        stress *= if solid.inertia { 2.0 } else { 1.0 };
        let [.., height] = solid.extents();
        let speed = solid.start.velocity.iter().fold(0.0, |most: f64, v| most.max(v.abs()));
        let [mut jump, mut load] = [0.0_f64; 2];
        for own in layers {
            let Deviator::Plastic(metal) = &own.law.deviator else { continue };
            let young = own.law.young();
            let of_motion = speed * (own.density * young).sqrt();
            let weight = own.density * solid.gravity * height;
            jump = jump.max(strain * young / metal.yield_stress);
            load = load.max((stress + of_motion + weight) / metal.yield_stress);
        }
        let acts = strain > 0.0 || stress > 0.0 || speed > 0.0 || solid.gravity > 0.0;
        let relaxes = |own: &LayerOfBody| {
            matches!(own.law.deviator, Deviator::Relaxing(_)) && own.law.history() > 0
        };
        Self {
            jump,
            load,
            are_known: acts && !solid.is_of_concrete() && solid.faces.values().all(is_set),
            relaxes: layers.iter().any(relaxes),
        }
    }

    /// Share of the steps in which a body yields, unless its loads are those of inputs.
    pub fn share_of_yielding(&self) -> f64 {
        let load = self.jump.max(self.load);
        if self.are_known { ((load - SOME) / (MOST - SOME)).clamp(0.0, 1.0) } else { 1.0 }
    }

    /// Number of steps in which loads change that take as long as a run of some steps.
    pub fn usual_steps(&self, solid: &LargeStrain, steps: f64) -> f64 {
        let of_jump = match (solid.inertia, solid.is_sheet()) {
            (true, _) => OF_IMPLICIT_JUMP,
            (false, true) => OF_JUMP_OF_SHEET,
            (false, false) => OF_JUMP,
        };
        let holds = self.are_known && !solid.inertia && !self.relaxes;
        let jump = if self.jump > 1.0 { of_jump * self.jump.min(LARGEST) } else { 0.0 };
        steps * if holds { HELD } else { 1.0 } + jump
    }
}

/// Returns true unless inputs of a face start at zero.
fn is_set(face: &HeldFace) -> bool {
    let moves = face.displacement.is_none_or(|way| way != [0.0; 3]);
    let pulls = face.traction.is_none_or(|traction| traction != [0.0; 3]);
    moves && pulls && face.pressure != Some(0.0)
}

/// Strain of a body one face of which is displaced at the start: along it by shear or, of a slender body, by bending.
fn strain(solid: &LargeStrain, axis: usize, face: &HeldFace) -> f64 {
    let extents = solid.extents();
    let length = extents[axis];
    let of_part = |(a, way): (usize, f64)| {
        let slender = if a == axis { 1.0 } else { (1.5 * extents[a] / length).min(1.0) };
        slender * way.abs() / length
    };
    face.displacement.map_or(0.0, |way| way.into_iter().enumerate().map(of_part).sum())
}

/// Equivalent stress of a body with a load on a face [Pa]: of a slender one where it is clamped at the other end.
fn stress(solid: &LargeStrain, axis: usize, face: &HeldFace) -> f64 {
    let extents = solid.extents();
    let of_part = |(a, traction): (usize, f64)| {
        let larger =
            if a == axis { 1.0 } else { (6.0 * extents[axis] / extents[a]).max(3.0_f64.sqrt()) };
        larger * traction.abs()
    };
    let traction = face.traction.map_or(0.0, |own| own.into_iter().enumerate().map(of_part).sum());
    traction + face.pressure.unwrap_or(0.0).abs()
}

/// Axis normal to a face.
fn normal(face: FaceName) -> usize {
    match face {
        FaceName::Left | FaceName::Right | FaceName::Sides => 0,
        FaceName::Front | FaceName::Back => 1,
        FaceName::Bottom | FaceName::Top => 2,
    }
}
