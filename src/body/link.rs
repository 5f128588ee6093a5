//! Exchange of heat and force between bodies: partners and intervals.

use super::Body;
use super::droplet;
use super::filament;
use super::large_strain::contact_interval;
use super::solid::plan;
use crate::laws::Constants;
use crate::limits::two_digits;
use crate::method::fem::Plan;
use crate::method::sph::DropletSph;
use crate::port::{CommonCells, LateralModes};
use crate::port::{SurfaceResponse, WallCells};
use crate::scene::{self, Coupling, Droplet, FaceName, Scene};

/// Largest number of parts of a step that is cut at the moments bodies ask for.
pub const MOST_PARTS: usize = 64;

/// A body that stands on a face of another.
#[derive(Debug, Clone, PartialEq)]
pub struct Link {
    /// Places of the upper and of the lower body.
    pub from: usize,
    pub to: usize,
    /// Face of the lower body.
    pub face: FaceName,
    /// Longest time between two exchanges [s].
    pub interval: f64,
    /// True if forces are transferred.
    pub traction: bool,
}

/// Two faces in contact, between which heat flows in proportion to their temperature difference.
#[derive(Debug, Clone, PartialEq)]
pub struct Joint {
    /// The heat flow is positive from the first side to the second.
    pub sides: [Side; 2],
    /// h [W/(m² K)]
    pub conductance: f64,
    /// Longest part of a step [s].
    pub interval: f64,
    pub cells: CommonCells,
    /// Modes along the cells.
    pub modes: LateralModes,
    /// Rate at which two bodies, each of uniform temperature, equilibrate [1/s].
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
    /// Response of the face to heat that is uniform along it, and diffusivity of the material below [m²/s].
    pub response: SurfaceResponse,
    pub diffusivity: f64,
}

impl Joint {
    /// Number of equal parts of a step of `dt` [s].
    pub fn parts(&self, dt: f64) -> usize {
        parts(self.interval, dt)
    }

    /// Number of times that a part of a step of this length [s] is halved to form its first parts. Modes that are fast
    /// relative to a part overshoot their equilibrium by a tenth in its stages; growing parts let them decay first.
    pub fn halvings(&self, length: f64) -> usize {
        halvings(length, self.rate)
    }

    /// Error of temperatures at the end of a part of this length [s] for each unit by which the flux at its beginning
    /// differs from the line through those at its stages [K m²/W].
    ///
    /// A wrong flux changes the difference of temperatures by `R/(1 + hR)`, where R is the rise of both sides per flux.
    /// Modes that decay fast keep a tenth of that at most, with the wrong sign. Slow ones, of rate λ, depart from the
    /// line by `(λ Δt)²/6`, so that the estimate is of third order in the length; the error is of fourth.
    pub fn error(&self, length: f64) -> f64 {
        let rise: f64 = self.sides.iter().map(|side| side.response.of_held_flux(length)).sum();
        OVERSHOOT * rise / (1.0 + self.conductance * rise)
    }

    /// Differences of temperature at each flux, from those of both sides at the common cells.
    pub fn means(&self, [from, to]: [&[f64]; 2]) -> Vec<f64> {
        let differences: Vec<f64> = from.iter().zip(to).map(|(from, to)| from - to).collect();
        self.cells.means(&differences)
    }

    /// Temperatures of a side's cells, transferred to the common cells.
    pub fn values(&self, side: usize, own: &[f64]) -> Vec<f64> {
        self.cells.values(side, own, self.sides[side].counts[0])
    }

    /// Amounts at the common cells, transferred to a side's own cells.
    pub fn deposit(&self, side: usize, amounts: &[f64]) -> Vec<f64> {
        self.cells.deposit(side, amounts, self.sides[side].counts)
    }
}

/// Number of halvings of a part of a step of this length [s] between bodies that equilibrate at a rate [1/s].
pub fn halvings(length: f64, rate: f64) -> usize {
    let ratio = length * rate / FASTEST;
    if ratio > 1.0 { (ratio.log2().ceil() as usize).min(MOST_HALVINGS) } else { 0 }
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

/// Largest number of cells of a face that touches a body; `place` returns the place of a body.
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

/// Returns the joints of a scene; `place` returns the place of a body.
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
        // Slowest mode: inverse of the body's heat capacity per area; other modes: their own resistance.
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

/// Number of cells along x.
fn width(cells: &WallCells) -> usize {
    match cells {
        WallCells::Nodes { x, .. } => x.len(),
        cells => cells.len(),
    }
}

/// Largest length of a part of a step over the relaxation time; at three times that, stages overshoot equilibrium.
const FASTEST: f64 = 1.5;
const MOST_HALVINGS: usize = 20;
/// Share of the difference of temperatures by which long parts of a step overshoot equilibrium.
const OVERSHOOT: f64 = 0.1;

/// Lower bound of the limit on `a Δt/h²` for diffusion along an element between two exchanges.
const LEAST_ALONG: f64 = 0.01;

/// Returns the links of a scene; `place` returns the place of a body.
pub fn links(scene: &Scene, place: impl Fn(&str) -> Option<usize>) -> Vec<Link> {
    let link = |coupling: &Coupling| {
        let solid = coupling.solid()?;
        let interval = match scene.body.get(&coupling.from)? {
            scene::Body::LargeStrain(body) => contact_interval(coupling, body),
            from => {
                let plan = plan(scene, solid, scene.solid(solid)?);
                match from {
                    scene::Body::Filament(own) => filament::interval(scene, coupling, (own, &plan)),
                    _ => interval(coupling, scene.droplet(&coupling.from)?, &plan),
                }
            }
        };
        Some(Link {
            from: place(&coupling.from)?,
            to: place(solid)?,
            face: FaceName::Top,
            interval,
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
    // A step of one interval, up to rounding, is one part.
    (dt / interval - 1e-9).ceil().max(1.0) as usize
}

/// Longest time between exchanges [s]: the value of the scene, or the shorter of two times. During them
/// - the flow passes one particle spacing, Δx/U, and
/// - heat that spreads along the surface within an exchange, which only the next exchange notices, stays small:
///   `a Δt/h² ≤ e/(e + e_f)`, but no less than [`LEAST_ALONG`]. Here a is the solid's diffusivity, h its shortest
///   element, and e and e_f are the effusivities of solid and fluid; of layers, the largest a and the smallest e.
///   Otherwise places on a good insulator that are as warm as the fluid would exceed its temperature.
///
/// The result is at least one time step of the droplet.
///
/// Replayed drops know heat and force at any time, and exchange once in a communication step.
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

/// Returns a note on the chosen interval.
pub fn note(interval: f64) -> String {
    format!("heat and momentum pass to the solid below at least every {} s", two_digits(interval))
}

/// Length of the shortest element along the surface [m].
fn shortest_element(plan: &Plan) -> f64 {
    let lengths = plan.mesh.axes[..2].iter().flat_map(|axis| {
        (0..axis.elements()).map(|element| {
            let [start, end] = axis.bounds(element);
            end - start
        })
    });
    lengths.fold(f64::INFINITY, f64::min)
}
