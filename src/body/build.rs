//! Builds the bodies of a scene's tables, and the links and joints between them.

use super::contract::Body;
use super::droplet::{DropletBody, ReplayBody};
use super::error::BodyError;
use super::filament::{FilamentBody, ParticleFilament};
use super::large_strain::{MovingBody, RestingBody, SwingingBody};
use super::lattice::{MovingLatticeBody, RestingLatticeBody};
use super::link::{self, Joint, Link};
use super::reduced::ReducedBody;
use super::reservoir::ReservoirBody;
use super::solid::SolidBody;
use crate::inputs::InputLayout;
use crate::scene::{self, FilamentMethod, MotionSteps, Scene};

/// All bodies of a scene.
pub struct Assembly {
    /// In the order of their names.
    pub bodies: Vec<Box<dyn Body>>,
    pub links: Vec<Link>,
    pub joints: Vec<Joint>,
}

/// Number of states in which a model will be read.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Readings {
    /// The number of states of the scene's default experiment.
    Usual,
    OfStates(usize),
}

/// Builds the bodies of a scene with their links and joints; `start` holds the initial inputs. The first number
/// requests threads, with 0 for as many as are worthwhile; the second one limits them.
pub fn build(
    scene: &Scene,
    (layout, start): (&InputLayout, &[f64]),
    [wanted, most]: [usize; 2],
    readings: Readings,
) -> Result<Assembly, BodyError> {
    let threads = |is_large| threads_for(wanted, is_large).min(most);
    let place = |name: &str| scene.body.keys().position(|key| key == name);
    let mut built: Vec<Option<Box<dyn Body>>> = scene.body.keys().map(|_| None).collect();
    for (index, (name, body)) in scene.body.iter().enumerate() {
        if let scene::Body::Solid(solid) = body {
            if scene.is_reduced(name) {
                let body = ReducedBody::new(scene, layout, (name, solid), start, threads(false))?;
                built[index] = Some(Box::new(body));
                continue;
            }
            let linked = link::linked_faces(scene, name);
            let body = SolidBody::new(scene, layout, (name, solid), &linked, threads)?;
            let body = match readings {
                Readings::Usual => body,
                Readings::OfStates(count) => body.read_in_states(count),
            };
            built[index] = Some(Box::new(body));
        }
    }
    let links = link::links(scene, place);
    for (index, (name, body)) in scene.body.iter().enumerate() {
        if let scene::Body::Droplet(droplet) = body {
            let link = links.iter().find(|link| link.from == index);
            let cells = link.and_then(|link| {
                let below = built[link.to].as_ref()?.conductor()?;
                Some((below.cells(link.face)?, link))
            });
            built[index] = Some(match droplet.is_replayed() {
                false => Box::new(DropletBody::new(scene, layout, (name, droplet), cells, threads)),
                true => {
                    let body =
                        ReplayBody::new(scene, layout, (name, droplet), cells, threads(true));
                    let named = |failure| BodyError::Droplet { name: name.clone(), failure };
                    Box::new(body.map_err(named)?)
                }
            });
        }
    }
    for (index, (name, body)) in scene.body.iter().enumerate() {
        if let scene::Body::Filament(filament) = body {
            let link = links.iter().find(|link| link.from == index);
            let cells = link.and_then(|link| {
                let below = built[link.to].as_ref()?.conductor()?;
                Some((below.cells(link.face)?, link))
            });
            let (inputs, own) = ((layout, start), (name.as_str(), &**filament));
            built[index] = Some(match filament.method {
                FilamentMethod::Line => Box::new(FilamentBody::new(scene, inputs, own, cells)),
                FilamentMethod::Particles => {
                    Box::new(ParticleFilament::new(scene, inputs, own, cells, threads))
                }
            });
        }
    }
    for (index, (name, body)) in scene.body.iter().enumerate() {
        if let scene::Body::LargeStrain(solid) = body {
            let link = links.iter().find(|link| link.from == index);
            let cells = link.and_then(|link| {
                let below = built[link.to].as_ref()?.conductor()?;
                Some((below.cells(link.face)?, link))
            });
            let (parts, own) = ((scene, layout), (name.as_str(), &**solid));
            built[index] = Some(match solid.steps() {
                Some(MotionSteps::Explicit) => {
                    Box::new(MovingBody::new(parts, own, cells, threads)?)
                }
                Some(MotionSteps::Implicit) => Box::new(SwingingBody::new(parts, own, threads)?),
                None => Box::new(RestingBody::new(parts, own, threads)?),
            });
        }
    }
    for (name, lattice) in scene.lattices() {
        let own = (name, lattice);
        built[place(name).expect("a body of the scene")] = Some(match lattice.inertia {
            true => Box::new(MovingLatticeBody::new(layout, own, threads)?),
            false => Box::new(RestingLatticeBody::new(layout, own, threads)?),
        });
    }
    for (name, reservoir) in scene.reservoirs() {
        let cells = link::most_cells(scene, name, &built, place);
        let body = ReservoirBody::new(layout, (name, reservoir), cells);
        built[place(name).expect("a body of the scene")] = Some(Box::new(body));
    }
    let joints = link::joints(scene, &built, place);
    Ok(Assembly { bodies: built.into_iter().flatten().collect(), links, joints })
}

/// Returns the reductions of a scene with initial inputs `start`, as bytes, each with the name of its body.
pub fn reductions(
    scene: &Scene,
    (layout, start): (&InputLayout, &[f64]),
    threads: usize,
) -> Result<Vec<(String, Vec<u8>)>, BodyError> {
    let bytes = |(name, solid): (&str, &scene::Solid)| {
        let body = ReducedBody::new(scene, layout, (name, solid), start, threads.max(1))?;
        Ok((name.to_owned(), body.to_bytes(scene)))
    };
    scene.solids().filter(|(name, _)| scene.is_reduced(name)).map(bytes).collect()
}

/// Number of threads for a body; if `wanted` is 0, as many as are worthwhile.
pub fn threads_for(wanted: usize, is_large: bool) -> usize {
    match wanted {
        0 if !is_large => 1,
        0 => std::thread::available_parallelism().map_or(1, Into::into),
        threads => threads,
    }
}
