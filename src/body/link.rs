//! Which bodies exchange heat and force, and how often.

use super::Body;
use super::droplet;
use super::solid::plan;
use crate::laws::Constants;
use crate::method::fem::Plan;
use crate::method::sph::DropletSph;
use crate::port::{CommonCells, LateralModes};
use crate::port::{SurfaceResponse, WallCells};
use crate::scene::{Coupling, Droplet, FaceName, Scene};

/// Most parts of a step that is cut where bodies ask for it.
pub const MOST_PARTS: usize = 64;

/// A body that stands on a face of another.
#[derive(Debug, Clone, PartialEq)]
pub struct Link {
    /// Places of the bodies, the one above first.
    pub from: usize,
    pub to: usize,
    /// Of the body below.
    pub face: FaceName,
    /// Longest time between two exchanges [s].
    pub interval: f64,
    /// Whether forces pass.
    pub traction: bool,
}

/// Two faces that touch, between which heat passes in proportion to the difference of their temperatures.
#[derive(Debug, Clone, PartialEq)]
pub struct Joint {
    /// Heat counts from the first to the second.
    pub sides: [Side; 2],
    /// h [W/(m² K)]
    pub conductance: f64,
    /// Longest part of a step [s].
    pub interval: f64,
    pub cells: CommonCells,
    /// Along the cells.
    pub modes: LateralModes,
    /// How fast two bodies whose temperatures are even each come to one temperature [1/s].
    rate: f64,
}

/// A face in a joint.
#[derive(Debug, Clone, PartialEq)]
pub struct Side {
    /// Place of the body.
    pub body: usize,
    pub face: FaceName,
    /// Cells of the face along x, and all of them.
    pub counts: [usize; 2],
    /// How the face answers to heat that is uniform along it, and the diffusivity of what is below [m²/s].
    pub response: SurfaceResponse,
    pub diffusivity: f64,
}

impl Joint {
    /// Number of equal parts of a step of `dt` [s].
    pub fn parts(&self, dt: f64) -> usize {
        parts(self.interval, dt)
    }

    /// How often a part of a step of this length [s] is halved for its first parts. What is fast beside a part would go
    /// beyond its rest in the stages of one, by a tenth; parts that grow let it come to rest first.
    pub fn halvings(&self, length: f64) -> usize {
        let ratio = length * self.rate / FASTEST;
        if ratio > 1.0 { (ratio.log2().ceil() as usize).min(MOST_HALVINGS) } else { 0 }
    }

    /// Temperatures of a side's cells as they are at the common ones.
    pub fn values(&self, side: usize, own: &[f64]) -> Vec<f64> {
        self.cells.values(side, own, self.sides[side].counts[0])
    }

    /// Amounts at the common cells as those of a side's own.
    pub fn deposit(&self, side: usize, amounts: &[f64]) -> Vec<f64> {
        self.cells.deposit(side, amounts, self.sides[side].counts)
    }
}

/// Faces of a solid that a scene couples.
pub fn linked_faces(scene: &Scene, name: &str) -> Vec<FaceName> {
    let ends = scene.coupling.iter().flat_map(|coupling| {
        let below = coupling.solid().map(|solid| (solid, FaceName::Top));
        [coupling.upper(), coupling.lower(), below]
    });
    let ends = ends.flatten().filter(|(body, _)| *body == name);
    let mut faces: Vec<FaceName> = ends.map(|(_, face)| face).collect();
    faces.sort();
    faces.dedup();
    faces
}

/// Most cells of a face that touches a body; `place` tells that of a body.
pub fn most_cells(
    scene: &Scene,
    name: &str,
    bodies: &[Option<Box<dyn Body>>],
    place: impl Fn(&str) -> Option<usize>,
) -> usize {
    let of_partner = |coupling: &Coupling| {
        let ends = [coupling.lower()?, coupling.upper()?];
        let (other, face) = match ends.map(|(body, _)| body == name) {
            [true, false] => ends[1],
            [false, true] => ends[0],
            _ => return None,
        };
        let cells = bodies[place(other)?].as_ref()?.conductor()?.cells(face)?;
        Some(cells.len())
    };
    scene.coupling.iter().filter_map(of_partner).max().unwrap_or(0)
}

/// The joints of a scene; `place` tells that of a body.
pub fn joints(
    scene: &Scene,
    bodies: &[Option<Box<dyn Body>>],
    place: impl Fn(&str) -> Option<usize>,
) -> Vec<Joint> {
    let joint = |coupling: &Coupling| {
        let ends = [coupling.lower()?, coupling.upper()?];
        let conductor = |name| {
            let body = place(name)?;
            Some((body, bodies[body].as_ref()?.conductor()?))
        };
        let own = ends.map(|(name, face)| conductor(name)?.1.cells(face));
        let known = own.iter().flatten().next()?.clone();
        let own = own.map(|cells| cells.unwrap_or_else(|| known.clone()));
        let cells = CommonCells::of(own.each_ref())?;
        let area = cells.areas.iter().sum();
        let side = |n: usize| {
            let (name, face) = ends[n];
            let (body, conductor) = conductor(name)?;
            Some(Side {
                body,
                face,
                counts: [width(&own[n]), own[n].len()],
                response: conductor.response(face, area),
                diffusivity: conductor.diffusivity(face),
            })
        };
        let (from, to) = (side(0)?, side(1)?);
        let conductance = coupling.conductance?;
        // Of the slowest mode, the inverse of the body's heat capacity per area; of the others, its own resistance.
        let slowest = |side: &Side| side.response.gains.first().copied().unwrap_or(0.0);
        let resistance = |side: &Side| {
            let modes = side.response.rates.iter().zip(&side.response.gains).skip(1);
            modes.map(|(rate, gain)| gain / rate).sum::<f64>()
        };
        let through = 1.0 / conductance + resistance(&from) + resistance(&to);
        Some(Joint {
            modes: cells.modes(),
            cells,
            rate: (slowest(&from) + slowest(&to)) / through,
            sides: [from, to],
            conductance,
            interval: coupling.interval.unwrap_or(f64::INFINITY),
        })
    };
    scene.coupling.iter().filter_map(joint).collect()
}

/// Cells along x.
fn width(cells: &WallCells) -> usize {
    match cells {
        WallCells::Nodes { x, .. } => x.len(),
        cells => cells.len(),
    }
}

/// What may happen in a part of a step, over a relaxation time: at three times that stages go beyond rest.
const FASTEST: f64 = 1.5;
const MOST_HALVINGS: usize = 20;

/// Least part of a squared element's length over which heat may diffuse along it between two exchanges.
const LEAST_ALONG: f64 = 0.01;

/// The links of a scene; `place` tells that of a body.
pub fn links(scene: &Scene, place: impl Fn(&str) -> Option<usize>) -> Vec<Link> {
    let link = |coupling: &Coupling| {
        let (solid, droplet) = (coupling.solid()?, scene.droplet(&coupling.from)?);
        let plan = plan(scene, solid, scene.solid(solid)?);
        Some(Link {
            from: place(&coupling.from)?,
            to: place(solid)?,
            face: FaceName::Top,
            interval: interval(coupling, droplet, &plan),
            traction: coupling.traction,
        })
    };
    scene.coupling.iter().filter_map(link).collect()
}

impl Link {
    /// Number of equal parts of a step of `dt` [s], each with one exchange.
    pub fn parts(&self, dt: f64) -> usize {
        parts(self.interval, dt)
    }
}

/// Number of equal parts of a step of `dt` [s], each with one exchange.
pub fn parts(interval: f64, dt: f64) -> usize {
    // A step that is an interval but for rounding is one part.
    (dt / interval - 1e-9).ceil().max(1.0) as usize
}

/// Longest time between exchanges [s]: the scene's own, or the shorter of those in which
/// - the flow goes by a distance of particles, Δx/U, and
/// - heat that passes along the surface within an exchange, which only the next one finds there, stays small:
///   `a Δt/h² ≤ e/(e + e_f)`, but no less than [`LEAST_ALONG`], with the solid's diffusivity a, its shortest
///   element h, and effusivities e and e_f of solid and fluid; of layers, the largest a and the least e. On a good
///   insulator it would else take places that are as warm as the fluid beyond its temperature;
///
/// but no shorter than a time step of the droplet.
///
/// Drops that are replayed know heat and force of any time, and exchange once in a communication step.
pub fn interval(coupling: &Coupling, droplet: &Droplet, plan: &Plan) -> f64 {
    if droplet.is_replayed() {
        return coupling.interval.unwrap_or(f64::INFINITY);
    }
    let (_, time_step) = DropletSph::forecast(&droplet::plan_of(droplet, None, None));
    let flow = droplet.spacing / droplet.fastest_flow();
    let fluid = &droplet.fluid;
    let layers = || plan.strata.iter().map(|layer| layer.constants);
    let solid = layers().map(|c| c.effusivity()).fold(f64::INFINITY, f64::min);
    let of_fluid = fluid.effusivity();
    let share = (solid / (solid + of_fluid)).max(LEAST_ALONG);
    let length = shortest_element(plan);
    let along = |c: Constants| share * length.powi(2) * c.heat_capacity() / c.conductivity;
    let along = layers().map(along).fold(f64::INFINITY, f64::min);
    coupling.interval.unwrap_or_else(|| flow.min(along).max(time_step))
}

/// What was chosen, as a sentence.
pub fn note(interval: f64) -> String {
    format!("heat and momentum pass between droplet and solid at least every {interval:.3e} s")
}

/// Along the surface [m].
fn shortest_element(plan: &Plan) -> f64 {
    let lengths = plan.mesh.axes[..2].iter().flat_map(|axis| {
        (0..axis.elements()).map(|element| {
            let [start, end] = axis.bounds(element);
            end - start
        })
    });
    lengths.fold(f64::INFINITY, f64::min)
}
