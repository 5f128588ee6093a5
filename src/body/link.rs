//! Which bodies exchange heat and force, and how often.

use super::droplet;
use super::solid::{TOP, plan};
use crate::method::fem::Plan;
use crate::method::sph::DropletSph;
use crate::scene::{Coupling, Droplet, Scene};

/// A body that stands on a face of another.
#[derive(Debug, Clone, PartialEq)]
pub struct Link {
    /// Places of the bodies, the one above first.
    pub from: usize,
    pub to: usize,
    /// Of the body below.
    pub port: usize,
    /// Longest time between two exchanges [s].
    pub interval: f64,
    /// Whether forces pass.
    pub traction: bool,
}

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
            port: TOP,
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
///   element h, and effusivities e and e_f of solid and fluid. On a good insulator it would else take places
///   that are as warm as the fluid beyond its temperature;
///
/// but no shorter than a time step of the droplet.
pub fn interval(coupling: &Coupling, droplet: &Droplet, plan: &Plan) -> f64 {
    let (_, time_step) = DropletSph::forecast(&droplet::plan_of(droplet, None, None));
    let flow = droplet.spacing / droplet.fastest_flow();
    let fluid = &droplet.fluid;
    let solid = plan.constants.effusivity();
    let of_fluid = (fluid.conductivity * fluid.density * fluid.specific_heat).sqrt();
    let share = (solid / (solid + of_fluid)).max(LEAST_ALONG);
    let along = share * shortest_element(plan).powi(2) * plan.constants.heat_capacity()
        / plan.constants.conductivity;
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
