//! The bodies of a scene behind one interface: how they start, advance, meet each other and are read.
//!
//! A kind of body is a folder. Only this module and the scene's own know which kinds there are.

mod droplet;
mod error;
mod forecast;
mod link;
mod read;
mod reduced;
mod reservoir;
mod solid;

use std::any::Any;
use std::sync::Arc;

pub use droplet::{
    Kept, WallQuantity, fine_radius, forget_unused_records, keep_record, notes_on_walls, records,
    to_be_recorded, wall_quantities, warnings_on_landing,
};
pub use error::BodyError;
pub use forecast::{BodyForecast, DropletForecast, Forecast, ParticleForecast, forecast};
pub use link::{Joint, Link, MOST_PARTS, Side};
pub use read::{Descriptor, Direct, PeakPart, Reading, peaks, totals};
pub use reduced::{KeptReduction, forget_unused_reductions, keep_reduction};
pub use solid::{PointQuantity, point_quantities};

use crate::inputs::{InputLayout, InputPath};
pub use crate::method::fem::Extreme;
use crate::method::fem::{ElasticProblem, NodalFields};
use crate::method::sph::{ParticleFields, Surface, SurfaceResponse, WallCells, WarmPlace};
use crate::runtime::allowance::Allowance;
use crate::scene::{self, FaceName, Scene};
use crate::state::Layout;
use droplet::{DropletBody, ReplayBody, Watch};
use reduced::ReducedBody;
use reservoir::ReservoirBody;
use solid::SolidBody;

/// A body of a scene: everything known of it before time starts. What changes is a flat vector, its state.
pub trait Body: Send + Sync {
    fn name(&self) -> &str;

    /// The state at time zero.
    fn initial_state(&self) -> Vec<f64>;

    /// The fields of a state; nothing if it has a length that no state of this body has.
    fn layout(&self, state: &[f64]) -> Option<Layout>;

    /// Refuses a vector that no run of this body leads to, with what is wrong with it; `inputs` are those of
    /// the moment.
    fn check_state(&self, state: &[f64], inputs: &[f64]) -> Result<(), String>;

    /// Refuses inputs that make no sense for this body.
    fn check_inputs(&self, inputs: &[f64]) -> Result<(), BodyError>;

    /// What follows from inputs, held, and from what was received through ports during the last step; filled further
    /// as the body is read.
    fn memo(&self, inputs: &[f64], received: &[Received]) -> Memo;

    /// Takes over from the memo of other inputs what is the same under these, of the same state.
    fn carry_over(&self, _from: Memo, _to: &mut Memo) {}

    /// Forgets what follows from the state; what acts stays.
    fn forget_state(&self, _memo: &mut Memo) {}

    /// Advances a state; what was given through the port below, if there is one. `memo` is that of the inputs at the
    /// beginning, unless these change. A failure leaves the state as it was, or of no use: the caller has a copy.
    fn advance(
        &self,
        state: &mut Vec<f64>,
        memo: &Memo,
        acts: &Acts,
        allowance: &Allowance,
    ) -> Result<Option<Given>, BodyError>;

    /// Ends a step of `dt` [s] that is known to take too long.
    fn foresee(&self, _state: &[f64], _dt: f64, _: &Allowance) -> Result<(), BodyError> {
        Ok(())
    }

    /// Updates of unknowns that `dt` [s] take, about; nothing where any step takes the same.
    fn updates(&self, _dt: f64) -> f64 {
        0.0
    }

    /// Moments within a step of this length [s] at which a body below should be asked anew, as what this one gives
    /// changes fast there.
    fn moments(&self, _state: &[f64], _path: &InputPath, _duration: f64) -> Vec<f64> {
        Vec::new()
    }

    /// Counts what is told as of the last step over that from the state `before`, too.
    fn join_steps(&self, _before: &[f64], _state: &mut Vec<f64>) {}

    /// What was given through the port below during the last step.
    fn given(&self, _state: &[f64]) -> Option<Given> {
        None
    }

    /// A value, where the memo is that of what acts and of the state.
    fn read(&self, state: &[f64], memo: &mut Memo, reading: &Reading) -> Result<f64, BodyError>;

    /// How many running maxima are kept of the body.
    fn peaks(&self) -> usize {
        0
    }

    /// What the running maximum of a number is of, as it is now, where the memo is that of what acts and of the state.
    fn observe(
        &self,
        _state: &[f64],
        _memo: &mut Memo,
        which: usize,
    ) -> Result<Extreme, BodyError> {
        panic!("{} has no running maximum {which}", self.name())
    }

    /// Refuses a running maximum that no run of this body leads to, with what is wrong with it.
    fn check_peak(&self, _which: usize, _peak: &Extreme) -> Result<(), String> {
        Ok(())
    }

    /// Whether a value follows inputs without delay.
    fn follows_at_once(&self, _reading: &Reading) -> bool {
        false
    }

    /// Whether a reading takes more stack than a host's thread need have; nothing is remembered yet without a memo.
    fn is_deep(&self, _memo: Option<&Memo>, _reading: &Reading) -> bool {
        false
    }

    /// Values at all nodes or particles.
    fn fields(&self, state: &[f64], memo: &mut Memo) -> Result<Fields, BodyError>;

    /// The body as one that is linear between steps, if it is.
    fn linear(&self) -> Option<&dyn Linear> {
        None
    }

    /// The body as one whose faces answer to heat, if they do.
    fn conductor(&self) -> Option<&dyn Conductor> {
        None
    }

    /// What was chosen or left out, and why: a sentence each.
    fn notes(&self) -> Vec<String> {
        Vec::new()
    }

    /// What of its own making errs by more than the scene's tolerance, in words.
    fn beyond_tolerance(&self) -> Option<String> {
        None
    }

    /// What a reduced body follows from, for those that are equal.
    fn reduction(&self) -> Option<KeptReduction> {
        None
    }

    /// From when on after a jump of what acts the temperatures of heated faces can be told [s].
    fn resolved_from(&self) -> f64 {
        0.0
    }

    /// What a user should know of a state, quickly found.
    fn warning(&self, _state: &[f64]) -> Option<String> {
        None
    }

    /// Points at which a fluid of the body would freeze or boil.
    fn watch(&self) -> Option<&Watch> {
        None
    }

    /// The coldest and the hottest place of a fluid in a state; nothing where there is none.
    fn warm_places(&self, _state: &[f64]) -> Option<[WarmPlace; 2]> {
        None
    }

    /// What inputs tell since the last step, in answer to it, that does not go with how it was computed: those of its
    /// beginning, and those that there are now.
    fn warning_on_answer(&self, _state: &[f64], _before: &[f64], _now: &[f64]) -> Option<String> {
        None
    }

    /// What a user should know of a value that is read.
    fn warning_on_value(&self, _reading: &Reading, _value: f64) -> Option<String> {
        None
    }

    /// What a user should know of the state at the end of a run: a sentence each.
    fn closing_warnings(&self, _state: &[f64]) -> Vec<String> {
        Vec::new()
    }

    /// What bodies that differ in what concerns heat alone share.
    fn stiffness(&self) -> Option<Arc<ElasticProblem>> {
        None
    }

    /// Stored entries of all factorisations made so far.
    fn factor_entries(&self) -> usize {
        0
    }

    /// Threads that the body may use.
    fn threads(&self) -> usize {
        1
    }

    /// Whether steps take more stack than a host's thread need have.
    fn steps_are_deep(&self) -> bool {
        false
    }
}

/// A body whose faces answer to heat and force that others give.
pub trait Conductor {
    /// How a face answers to heat that is uniform along an area of it [m²].
    fn response(&self, face: FaceName, area: f64) -> SurfaceResponse;

    /// Thermal diffusivity beside a face [m²/s].
    fn diffusivity(&self, face: FaceName) -> f64;

    /// What temperatures may err by from step to step [K]; nothing where they are exact.
    fn tolerance(&self) -> f64;

    /// The cells through which others exchange with a face; nothing of a body that is the same all over, which takes
    /// those of what it touches.
    fn cells(&self, face: FaceName) -> Option<WallCells>;

    /// Each face over a step if nothing is received, and how it answers to heat.
    fn surfaces(
        &self,
        state: &[f64],
        memo: &Memo,
        faces: &[FaceName],
        acts: &Acts,
        allowance: &Allowance,
    ) -> Result<Vec<Surface>, BodyError>;

    /// Temperatures of the cells of faces at the end of what acts [K].
    fn temperatures_after(
        &self,
        state: &[f64],
        memo: &Memo,
        faces: &[FaceName],
        acts: &Acts,
        allowance: &Allowance,
    ) -> Result<Vec<Vec<f64>>, BodyError>;
}

/// A body that is linear between steps: unknowns and what acts on it go into its outputs as sums.
pub trait Linear {
    /// What acts, as it changes when the inputs change at `rates`: a memo in which all is a change.
    fn change(&self, inputs: &[f64], rates: &[f64]) -> Memo;

    /// Time derivative of the state under what acts and its change.
    fn rates(&self, state: &[f64], memo: &Memo, change: &Memo) -> Vec<f64>;

    /// The change of a value. At kinks it is one-sided, in the direction of the change: where stress vanishes or
    /// principal stresses meet, and for extremes of a body, which follow the node that has the extreme, of several
    /// the fastest.
    fn read_rate(
        &self,
        now: (&[f64], &mut Memo),
        change: (&[f64], &mut Memo),
        reading: &Reading,
    ) -> Result<f64, BodyError>;
}

/// What a body remembers of a state, in a form of its own.
pub type Memo = Box<dyn Any + Send + Sync>;

/// What acts on a body while it advances.
pub struct Acts<'a> {
    /// The inputs, from the beginning of the advance on.
    pub path: &'a InputPath,
    /// [s]
    pub duration: f64,
    /// Through the ports of the body's faces.
    pub received: &'a [Received<'a>],
    /// What the body stands on, if that answers to it.
    pub below: Option<&'a Surface>,
}

/// What a body gave to another through the cells of a port.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Given {
    /// Of the advance [s].
    pub duration: f64,
    /// Of each cell [J].
    pub heat: Vec<f64>,
    /// Flow of heat above its mean at the beginning of the advance, from where it falls evenly to its opposite, of
    /// each cell [W]; empty if it is even.
    pub falling: Vec<f64>,
    /// Of each cell along x, y, z (r, –, z in axisymmetry) [N s]; empty where forces do not pass.
    pub impulse: Vec<[f64; 3]>,
    /// Planes x = 0 and y = 0 about which all this is symmetric.
    pub symmetric: [bool; 2],
}

/// What comes through a face.
#[derive(Debug, Clone, Copy)]
pub struct Received<'a> {
    pub face: FaceName,
    pub given: &'a Given,
}

/// Values of a whole body.
pub enum Fields {
    Nodes(NodalFields),
    Particles(ParticleFields),
}

/// All bodies of a scene.
pub struct Assembly {
    /// In the order of their names.
    pub bodies: Vec<Box<dyn Body>>,
    pub links: Vec<Link>,
    pub joints: Vec<Joint>,
}

/// How much of a model is read.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Readings {
    /// As many states as the scene's default experiment has.
    Usual,
    OfStates(usize),
}

/// Builds the bodies of a scene, whose inputs begin as `start` says, and what joins them. Of the threads that are
/// wanted, 0 for as many as are worth it, no more are taken than a second number.
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
    for (name, reservoir) in scene.reservoirs() {
        let cells = link::most_cells(scene, name, &built, place);
        let body = ReservoirBody::new(layout, (name, reservoir), cells);
        built[place(name).expect("a body of the scene")] = Some(Box::new(body));
    }
    let joints = link::joints(scene, &built, place);
    Ok(Assembly { bodies: built.into_iter().flatten().collect(), links, joints })
}

/// The reductions of a scene whose inputs begin as `start` says, each with the name of its body, as bytes.
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

/// Threads for a body; 0 are wanted for as many as are worth it.
fn threads_for(wanted: usize, is_large: bool) -> usize {
    match wanted {
        0 if !is_large => 1,
        0 => std::thread::available_parallelism().map_or(1, Into::into),
        threads => threads,
    }
}
