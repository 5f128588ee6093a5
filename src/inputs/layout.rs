//! Places of inputs in a state.

use std::ops::Range;

use crate::channel::Channel;
use crate::scene::{Body, FaceName, Load, Scene, Wall};

/// Places of the inputs of a scene in [`crate::model::State::inputs`].
#[derive(Debug, Clone, PartialEq)]
pub struct InputLayout {
    /// In the order of the scene's loads.
    pub loads: Vec<LoadInputs>,
    pub faces: Vec<FaceInput>,
    /// Temperatures of the cells of each wall, in the order of the scene's walls.
    pub walls: Vec<Range<usize>>,
    /// Inputs of whole bodies, in the order of [`crate::scene::Body::inputs`], of the bodies that have any.
    pub bodies: Vec<(String, Range<usize>)>,
    /// Number of inputs.
    pub len: usize,
}

/// Places of a load's inputs; a range holds a value for each cell, the first index running slowest.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct LoadInputs {
    /// Places of its amounts.
    pub amounts: Vec<(Channel, Range<usize>)>,
    pub x: Option<usize>,
    pub y: Option<usize>,
    pub radius: Option<usize>,
}

/// The input that a face's thermal condition offers.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct FaceInput {
    pub body: String,
    pub face: FaceName,
    pub kind: FaceInputKind,
    pub index: usize,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FaceInputKind {
    Temperature,
    Ambient,
    Flux,
}

impl InputLayout {
    pub fn of(scene: &Scene) -> Self {
        let mut next = 0;
        let loads = scene.load.iter().map(|load| {
            let body = scene.body.get(load.body_and_face().0);
            let round_body = body.is_some_and(Body::is_round);
            load_inputs(load, round_body, &mut next)
        });
        let loads = loads.collect();
        let faces = face_inputs(scene, &mut next);
        let walls = wall_inputs(scene, &mut next);
        let bodies = body_inputs(scene, &mut next);
        Self { loads, faces, walls, bodies, len: next }
    }

    /// Inputs of a whole body.
    pub fn of_body(&self, name: &str) -> Range<usize> {
        let own = self.bodies.iter().find(|(body, _)| body == name);
        own.map_or(0..0, |(_, range)| range.clone())
    }
}

fn load_inputs(load: &Load, round_body: bool, next: &mut usize) -> LoadInputs {
    let cells = load.footprint.cell_count();
    let mut take = |count: usize| {
        let range = *next..*next + count;
        *next = range.end;
        range
    };
    LoadInputs {
        amounts: load.channels().map(|channel| (channel, take(cells))).collect(),
        x: (!round_body).then(|| take(1).start),
        y: (!round_body).then(|| take(1).start),
        radius: load.footprint.radius().map(|_| take(1).start),
    }
}

fn wall_inputs(scene: &Scene, next: &mut usize) -> Vec<Range<usize>> {
    let range = |wall: &Wall| {
        let start = *next;
        *next += wall.footprint.cell_count();
        start..*next
    };
    scene.wall.iter().map(range).collect()
}

fn body_inputs(scene: &Scene, next: &mut usize) -> Vec<(String, Range<usize>)> {
    let range = |(name, body): (&String, &Body)| {
        let start = *next;
        *next += body.inputs().len();
        (start < *next).then(|| (name.clone(), start..*next))
    };
    scene.body.iter().filter_map(range).collect()
}

fn face_inputs(scene: &Scene, next: &mut usize) -> Vec<FaceInput> {
    let mut inputs = Vec::new();
    for (name, body) in &scene.body {
        for (face, condition) in body.faces() {
            let kind = if condition.temperature.is_some() {
                FaceInputKind::Temperature
            } else if condition.convection.is_some() {
                FaceInputKind::Ambient
            } else if condition.flux.is_some() {
                FaceInputKind::Flux
            } else {
                continue;
            };
            inputs.push(FaceInput { body: name.to_owned(), face, kind, index: *next });
            *next += 1;
        }
    }
    inputs
}
