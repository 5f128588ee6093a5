//! Conditions on the faces of a solid of large strain: those that hold or move it, and its loads.

use std::ops::Range;

use super::plan;
use super::snapshot::copies;
use super::totals::{loaded_faces, moved_faces};
use crate::inputs::InputLayout;
use crate::method::large_strain::{Deformable, FaceLoad, LoadedFaces};
use crate::scene::{LargeStrain, LoadComponent};
use crate::space::{Form, Mesh, Side};

/// Conditions on the faces of a body and where their values are among its inputs.
pub struct Faces {
    /// Conditions on each node along x, y and z.
    holds: Vec<[Hold; 3]>,
    /// Axes along which the displacements of faces are prescribed, face by face.
    moved: Vec<Vec<usize>>,
    /// Components of the loads on faces, face by face.
    loaded: Vec<Vec<LoadComponent>>,
    mirrors: [bool; 2],
    is_round: bool,
    /// Places of displacements, loads and the temperature, if it acts, among the inputs.
    inputs: Range<usize>,
    /// Temperature without an input [K].
    temperature: f64,
}

/// Conditions that the inputs prescribe at a time.
#[derive(Debug, Clone, PartialEq)]
pub struct Prescribed {
    /// Displacements of the moved faces [m].
    pub places: Vec<[f64; 3]>,
    pub loads: Vec<FaceLoad>,
    /// [K]
    pub temperature: f64,
    /// Rise of each node of a body that conducts heat [K].
    pub rise: Vec<f64>,
}

impl Prescribed {
    pub fn middle(&self, other: &Self) -> Self {
        let half = |(a, b): (&[f64; 3], &[f64; 3])| [0, 1, 2].map(|n| 0.5 * (a[n] + b[n]));
        Self {
            places: self.places.iter().zip(&other.places).map(half).collect(),
            loads: self.loads.iter().zip(&other.loads).map(|(a, b)| a.middle(b)).collect(),
            temperature: 0.5 * (self.temperature + other.temperature),
            rise: self.rise.iter().zip(&other.rise).map(|(a, b)| 0.5 * (a + b)).collect(),
        }
    }
}

/// Condition on a node along an axis.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Hold {
    Free,
    Fixed,
    /// Moves with a face, by its number among those that are moved.
    With(usize),
}

impl Faces {
    pub fn new(
        layout: &InputLayout,
        (name, solid): (&str, &LargeStrain),
        mesh: &Mesh,
        body: &Deformable,
    ) -> Self {
        let moved = moved_faces(solid).into_iter().map(|face| solid.moved_axes(face)).collect();
        let loaded =
            loaded_faces(solid).into_iter().map(|face| solid.load_components(face)).collect();
        Self {
            holds: holds(solid, mesh, body),
            moved,
            loaded,
            mirrors: solid.mirrors(),
            is_round: body.space.form == Form::Axisymmetric,
            inputs: layout.of_body(name),
            temperature: solid.initial_temperature,
        }
    }

    /// Number of moved faces.
    pub fn moved(&self) -> usize {
        self.moved.len()
    }

    /// Number of loaded faces.
    pub fn loaded(&self) -> usize {
        self.loaded.len()
    }

    /// Returns for each node the axes along which its displacement is prescribed.
    pub fn held(&self) -> Vec<[bool; 3]> {
        self.holds.iter().map(|holds| holds.map(|hold| hold != Hold::Free)).collect()
    }

    /// Returns what all inputs prescribe.
    pub fn prescribed(&self, inputs: &[f64]) -> Prescribed {
        let mut own = inputs[self.inputs.clone()].iter().copied();
        let of_moved = |axes: &Vec<usize>| {
            let mut displacement = [0.0; 3];
            axes.iter().zip(&mut own).for_each(|(&axis, value)| displacement[axis] = value);
            displacement
        };
        let places = self.moved.iter().map(of_moved).collect();
        let of_loaded = |components: &Vec<LoadComponent>| {
            let mut load = FaceLoad::default();
            for (component, value) in components.iter().zip(&mut own) {
                match component {
                    LoadComponent::Pressure => load.pressure = value,
                    LoadComponent::Traction(axis) => load.traction[*axis] = value,
                }
            }
            load
        };
        let loads = self.loaded.iter().map(of_loaded).collect();
        let temperature = own.next().unwrap_or(self.temperature);
        Prescribed { places, loads, temperature, rise: Vec::new() }
    }

    /// Displacements of held nodes for places of the moved faces [m]; zero for others.
    pub fn displacements(&self, places: &[[f64; 3]]) -> Vec<[f64; 3]> {
        let of_node = |holds: &[Hold; 3]| {
            [0, 1, 2].map(|a| match holds[a] {
                Hold::Free | Hold::Fixed => 0.0,
                Hold::With(face) => places[face][a],
            })
        };
        self.holds.iter().map(of_node).collect()
    }

    /// Places of the moved faces for displacements of the nodes [m].
    pub fn places(&self, displacements: &[[f64; 3]]) -> Vec<[f64; 3]> {
        let mut places = vec![[0.0; 3]; self.moved.len()];
        for (holds, u) in self.holds.iter().zip(displacements) {
            for a in 0..3 {
                if let Hold::With(face) = holds[a] {
                    places[face][a] = u[a];
                }
            }
        }
        places
    }

    /// Forces on the moved faces, images included; those of images along mirrored axes cancel.
    pub fn forces(&self, reactions: &[[f64; 3]]) -> Vec<[f64; 3]> {
        let mut forces = vec![[0.0; 3]; self.moved.len()];
        for (holds, reaction) in self.holds.iter().zip(reactions) {
            for a in 0..3 {
                if let Hold::With(face) = holds[a] {
                    let mirrored = a < 2 && (self.mirrors[a] || self.is_round);
                    let copies = if mirrored { 0.0 } else { copies(self.mirrors) };
                    forces[face][a] += copies * reaction[a];
                }
            }
        }
        forces
    }

    /// Refuses displacements of nodes that are fixed.
    pub fn check(&self, displacements: &[[f64; 3]]) -> Result<(), String> {
        for (holds, u) in self.holds.iter().zip(displacements) {
            if (0..3).any(|a| holds[a] == Hold::Fixed && u[a] != 0.0) {
                return Err("a node moves along an axis that holds it".to_owned());
            }
        }
        Ok(())
    }
}

/// The loaded faces of a solid on its body.
pub fn loaded(solid: &LargeStrain, body: &Deformable) -> LoadedFaces {
    let faces = loaded_faces(solid);
    let is_on = |face| move |side: Side| plan::is_on(solid, face, side);
    let predicates: Vec<_> = faces.into_iter().map(is_on).collect();
    let predicates: Vec<&dyn Fn(Side) -> bool> =
        predicates.iter().map(|is_on| is_on as &dyn Fn(Side) -> bool).collect();
    LoadedFaces::new(body, &predicates)
}

/// Conditions on the nodes of a mesh by the faces of a solid; where faces meet, fixed prevails over moved.
fn holds(solid: &LargeStrain, mesh: &Mesh, body: &Deformable) -> Vec<[Hold; 3]> {
    let fixed = |fixed: &[bool; 3]| fixed.map(|fixed| if fixed { Hold::Fixed } else { Hold::Free });
    let mut holds: Vec<[Hold; 3]> = body.fixed.iter().map(fixed).collect();
    let moved = moved_faces(solid);
    for (&face, held) in solid.faces.iter().filter(|(_, held)| held.is_held()) {
        let number = moved.iter().position(|&other| other == face);
        for (side, corners) in mesh.faces.iter().filter(|(side, _)| plan::is_on(solid, face, *side))
        {
            for &node in corners {
                for (axis, hold) in holds[node as usize].iter_mut().enumerate() {
                    let is_free = held.roller && plan::normal(*side) != axis;
                    if *hold != Hold::Fixed && !is_free {
                        *hold = number.map_or(Hold::Fixed, Hold::With);
                    }
                }
            }
        }
    }
    holds
}
