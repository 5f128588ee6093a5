//! Conditions on the faces of a solid of large strain: those that hold or move it, and its loads.

use std::ops::Range;

use super::plan;
use super::snapshot::copies;
use super::totals::{held_faces, loaded_faces, moved_faces};
use crate::inputs::InputLayout;
use crate::method::large_strain::{Deformable, FaceLoad, LoadedFaces};
use crate::scene::{FaceName, LargeStrain, LoadComponent};
use crate::space::{Form, Mesh, Side};

/// Conditions on the faces of a body and where their values are among its inputs.
pub struct Faces {
    /// Conditions on each node along x, y and z.
    holds: Vec<[Hold; 3]>,
    /// Number among held faces of that which bears the force on each node along x, y and z.
    bearers: Vec<[Option<usize>; 3]>,
    /// Number of held faces, moved ones included.
    held: usize,
    /// Numbers among held faces of bottom and top, if both are plane and held or moved along z.
    platens: Option<[usize; 2]>,
    /// Axes along which the displacements of faces are prescribed, face by face.
    moved: Vec<Vec<usize>>,
    /// Components of the loads on faces, face by face.
    loaded: Vec<Vec<LoadComponent>>,
    mirrors: [bool; 2],
    is_round: bool,
    /// Places of displacements, loads and the temperature, if it acts, among the inputs.
    inputs: Range<usize>,
    /// Names of these within the body, and their units.
    keys: Vec<(&'static str, &'static str)>,
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
        let (holds, bearers) = holds(solid, mesh, body);
        Self {
            holds,
            bearers,
            held: held_faces(solid).len(),
            platens: platens(solid),
            moved,
            loaded,
            mirrors: solid.mirrors(),
            is_round: body.space.form == Form::Axisymmetric,
            inputs: layout.of_body(name),
            keys: solid.inputs().iter().map(|input| (input.key, input.quantity.unit())).collect(),
            temperature: solid.initial_temperature,
        }
    }

    /// The forces on held faces before time starts [N].
    pub fn no_forces(&self) -> Vec<[f64; 3]> {
        vec![[0.0; 3]; self.held]
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

    /// Inputs that prescribe displacements, each with the displacement of its face [m].
    pub fn displacing(&self, displacements: &[[f64; 3]]) -> Vec<(usize, f64)> {
        let places = self.places(displacements);
        self.inputs.clone().zip(self.along_moved_axes(&places)).collect()
    }

    /// Displacements of the moved faces along the axes that inputs prescribe, in the order of the inputs.
    fn along_moved_axes(&self, places: &[[f64; 3]]) -> Vec<f64> {
        let faces = self.moved.iter().zip(places);
        faces.flat_map(|(axes, place)| axes.iter().map(|&axis| place[axis])).collect()
    }

    /// Forces on the held faces, moved ones included, with their images. Along a mirrored axis, where those of images
    /// are opposite, it is the force on the face of the model; about an axis of rotation they cancel.
    pub fn forces(&self, reactions: &[[f64; 3]]) -> Vec<[f64; 3]> {
        let mut forces = self.no_forces();
        let images = [0, 1, 2].map(|axis| match axis < 2 && self.mirrors[axis] {
            true => 0.5 * copies(self.mirrors),
            false if axis == 0 && self.is_round => 0.0,
            false => copies(self.mirrors),
        });
        for (bearers, reaction) in self.bearers.iter().zip(reactions) {
            for axis in 0..3 {
                if let Some(face) = bearers[axis] {
                    forces[face][axis] += images[axis] * reaction[axis];
                }
            }
        }
        forces
    }

    /// The inputs that change between two conditions, with their values.
    pub fn change(&self, from: &Prescribed, to: &Prescribed) -> String {
        let pairs = self.numbers(from).into_iter().zip(self.numbers(to));
        let changes = self.keys.iter().zip(pairs).filter(|(_, (before, after))| before != after);
        let words: Vec<String> = changes
            .map(|((key, unit), (before, after))| {
                format!("{key} = {before:.6e} and {after:.6e} {unit}")
            })
            .collect();
        match (words.is_empty(), from.rise == to.rise) {
            (false, _) => format!("between {}", words.join(", ")),
            (true, false) => "as its temperatures change".to_owned(),
            (true, true) => "under its weight and what its faces bear".to_owned(),
        }
    }

    /// Values of the inputs under conditions, in the order of the inputs.
    fn numbers(&self, own: &Prescribed) -> Vec<f64> {
        let places = self.along_moved_axes(&own.places).into_iter();
        let loads = self.loaded.iter().zip(&own.loads).flat_map(|(components, load)| {
            components.iter().map(|component| match component {
                LoadComponent::Pressure => load.pressure,
                LoadComponent::Traction(axis) => load.traction[*axis],
            })
        });
        places.chain(loads).chain([own.temperature]).collect()
    }

    /// Returns how far nodes have passed the planes of bottom and top between which the body is held [m], and the
    /// distance of these planes [m].
    pub fn passed(&self, places: &[[f64; 3]], displacements: &[[f64; 3]]) -> Option<[f64; 2]> {
        let heights = || places.iter().zip(displacements).map(|(at, u)| at[2] + u[2]);
        let plane = |face: usize| {
            let mut own = heights().zip(&self.bearers).filter(|(_, by)| by[2] == Some(face));
            own.next().map(|(height, _)| height)
        };
        let [low, high] = self.platens?.map(plane);
        let (low, high) = (low?, high?);
        let passed = heights().map(|height| (low - height).max(height - high));
        Some([passed.fold(0.0, f64::max), high - low])
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

/// Numbers among held faces of bottom and top of a plate, if both are held along z.
fn platens(solid: &LargeStrain) -> Option<[usize; 2]> {
    solid.plate()?;
    let held = held_faces(solid);
    let number = |face: FaceName| held.iter().position(|own| *own == face);
    Some([number(FaceName::Bottom)?, number(FaceName::Top)?])
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

/// Conditions on the nodes of a mesh by the faces of a solid, and the number of the held face that bears each. Where
/// faces meet, fixed prevails over moved, the first fixed one over others.
fn holds(
    solid: &LargeStrain,
    mesh: &Mesh,
    body: &Deformable,
) -> (Vec<[Hold; 3]>, Vec<[Option<usize>; 3]>) {
    let fixed = |fixed: &[bool; 3]| fixed.map(|fixed| if fixed { Hold::Fixed } else { Hold::Free });
    let mut holds: Vec<[Hold; 3]> = body.fixed.iter().map(fixed).collect();
    let mut bearers = vec![[None; 3]; holds.len()];
    let moved = moved_faces(solid);
    for (bearer, face) in held_faces(solid).into_iter().enumerate() {
        let held = solid.faces[&face];
        let number = moved.iter().position(|&other| other == face);
        for (side, corners) in mesh.faces.iter().filter(|(side, _)| plan::is_on(solid, face, *side))
        {
            for &node in corners {
                for (axis, hold) in holds[node as usize].iter_mut().enumerate() {
                    let is_free = held.roller && plan::normal(*side) != axis;
                    if *hold != Hold::Fixed && !is_free {
                        *hold = number.map_or(Hold::Fixed, Hold::With);
                        bearers[node as usize][axis] = Some(bearer);
                    }
                }
            }
        }
    }
    (holds, bearers)
}
