//! A droplet on the top of a solid: what the one takes from the other, and how often.

use std::f64::consts::PI;

use super::loads::add;
use crate::body::fem::{Geometry, Plan, Refinement, SolidFem, SolidLoads};
use crate::body::sph::{WallCells, WallExchange};
use crate::coupling::TopFace;
use crate::scene::{Arrival, Coupling, Droplet};

/// Part of the difference of temperatures by which the contact may change the solid's surface
/// between two exchanges.
const CHANGE_BETWEEN_EXCHANGES: f64 = 0.02;

/// How a droplet and a solid are joined.
pub struct Contact {
    /// Place of the solid among the model's bodies.
    pub solid: usize,
    /// Longest time between two exchanges [s].
    interval: f64,
    face: TopFace,
    effusivity: f64,
    initial_temperature: f64,
    geometry: Geometry,
    /// Planes in which the droplet mirrors itself.
    symmetric: [bool; 2],
    traction: bool,
}

impl Contact {
    /// `time_step` is that of the droplet at rest [s].
    pub fn of(
        coupling: &Coupling,
        droplet: &Droplet,
        (solid, plan): (usize, &Plan),
        time_step: f64,
    ) -> Self {
        Self {
            solid,
            interval: interval(coupling, droplet, plan, time_step),
            face: TopFace::of(&plan.mesh),
            effusivity: effusivity(plan),
            initial_temperature: plan.initial_temperature,
            geometry: plan.mesh.geometry,
            symmetric: droplet.mirrors(),
            traction: coupling.traction,
        }
    }

    pub fn cells(&self) -> WallCells {
        self.face.cells()
    }

    /// √(kρc) of the solid [W √s/(m² K)].
    pub fn effusivity(&self) -> f64 {
        self.effusivity
    }

    /// Number of equal parts of a step of `dt` [s], each with one exchange.
    pub fn parts(&self, dt: f64) -> usize {
        // A step that is an interval but for rounding is one part.
        (dt / self.interval - 1e-9).ceil().max(1.0) as usize
    }

    /// Temperature of the solid's surface at each cell [K].
    pub fn wall_temperature(
        &self,
        solid: &SolidFem,
        unknowns: &[f64],
        loads: &SolidLoads,
    ) -> Vec<f64> {
        let rise = self.face.rise(&solid.temperatures(unknowns, loads));
        rise.into_iter().map(|rise| self.initial_temperature + rise).collect()
    }

    /// Adds what the droplet gave during its last step, as rates, to what acts on the solid.
    pub fn add(&self, loads: &mut SolidLoads, exchange: &WallExchange) {
        if exchange.duration <= 0.0 {
            return;
        }
        let rate = 1.0 / exchange.duration;
        let heat: Vec<f64> = exchange.heat.iter().map(|heat| heat * rate).collect();
        for (class, vector) in self.parts_of(&heat, [false; 2]) {
            add(&mut loads.heat[class][1], &vector, 1.0);
        }
        if !self.traction {
            return;
        }
        for (component, axis, flips) in self.directions() {
            let force: Vec<f64> = exchange.impulse.iter().map(|p| p[axis] * rate).collect();
            for (class, vector) in self.parts_of(&force, flips) {
                add(&mut loads.force[class][1][component], &vector, 1.0);
            }
        }
    }

    fn parts_of(
        &self,
        amounts: &[f64],
        flips: [bool; 2],
    ) -> impl Iterator<Item = (usize, Vec<f64>)> {
        self.face.nodal(amounts, flips, self.symmetric).into_iter().enumerate()
    }

    /// Displacement component of the solid, component of the impulse, and where mirrors turn it.
    fn directions(&self) -> Vec<(usize, usize, [bool; 2])> {
        match self.geometry {
            Geometry::Box => {
                vec![(0, 0, [true, false]), (1, 1, [false, true]), (2, 2, [false; 2])]
            }
            Geometry::Axisymmetric => vec![(0, 0, [true, false]), (1, 2, [false; 2])],
        }
    }

    /// What was chosen, as a sentence.
    pub fn note(&self) -> String {
        format!(
            "heat and momentum pass between droplet and solid at least every {:.3e} s",
            self.interval
        )
    }
}

/// Longest time between exchanges [s]: the scene's own, or the shorter of the times in which
/// - the flow goes by a distance of particles, Δx/U, and
/// - a flux 2k(T_f − T_s)/Δx, that of fluid half a distance from the wall, changes the surface of a
///   solid with effusivity e by the part ε of T_f − T_s: `Δt = π (ε e Δx / 4k)²`, from the half
///   space under a constant flux (H. S. Carslaw and J. C. Jaeger, *Conduction of Heat in Solids*,
///   Oxford 1959, §2.9 (7)),
///
/// but no shorter than a time step of the droplet. The larger flux of a layer thinner than Δx is bounded for
/// itself.
fn interval(coupling: &Coupling, droplet: &Droplet, plan: &Plan, time_step: f64) -> f64 {
    let flow = droplet.spacing / droplet.fastest_flow();
    let reach = CHANGE_BETWEEN_EXCHANGES * effusivity(plan) * droplet.spacing;
    let heat = PI * (reach / (4.0 * droplet.fluid.conductivity)).powi(2);
    coupling.interval.unwrap_or_else(|| flow.min(heat).max(time_step))
}

fn effusivity(plan: &Plan) -> f64 {
    plan.constants.effusivity()
}

/// Where a droplet spreads: as far as it is expected to, but no faster than it arrives.
pub fn refinements(coupling: &Coupling, droplet: &Droplet, stop_time: f64) -> Vec<Refinement> {
    let at = |arrival: &Arrival| {
        let time = (stop_time - arrival.time).max(0.0);
        let soonest = 0.5 * droplet.diameter + droplet.fastest_flow() * time;
        let expected = (0.5 * droplet.spread_diameter()).min(soonest);
        let radius = coupling.radius.unwrap_or(expected);
        let stretch = |centre: f64| [centre - radius, centre + radius];
        let feature = 0.5 * droplet.diameter;
        let [x, y] = [arrival.x, arrival.y].map(stretch);
        Refinement { x, y, top: true, feature, heats: true }
    };
    droplet.arrivals.iter().map(at).collect()
}
