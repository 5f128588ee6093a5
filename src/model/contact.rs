//! A droplet on the top of a solid: what the one takes from the other, and how often.

use super::loads::add;
use crate::coupling::TopFace;
use crate::material::Constants;
use crate::math::allowance::{Allowance, Halt};
use crate::method::fem::{Geometry, Plan, Refinement, SolidFem, SolidLoads, Temperatures};
use crate::method::sph::{Surface, SurfaceResponse, WallCells, WallExchange};
use crate::scene::{Arrival, Coupling, Droplet};

/// Least part of a squared element's length over which heat may diffuse along it between two exchanges.
const LEAST_ALONG: f64 = 0.01;

/// How a droplet and a solid are joined.
pub struct Contact {
    /// Place of the solid among the model's bodies.
    pub solid: usize,
    /// Longest time between two exchanges [s].
    interval: f64,
    face: TopFace,
    response: SurfaceResponse,
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
        [rates, gains]: [Vec<f64>; 2],
        time_step: f64,
    ) -> Self {
        let face = TopFace::of(&plan.mesh, plan.sph.is_some());
        Self {
            solid,
            interval: interval(coupling, droplet, plan, time_step),
            face,
            response: SurfaceResponse { rates, gains },
            initial_temperature: plan.initial_temperature,
            geometry: plan.mesh.geometry,
            symmetric: droplet.mirrors(),
            traction: coupling.traction,
        }
    }

    pub fn cells(&self) -> WallCells {
        self.face.cells()
    }

    /// Number of equal parts of a step of `dt` [s], each with one exchange.
    pub fn parts(&self, dt: f64) -> usize {
        // A step that is an interval but for rounding is one part.
        (dt / self.interval - 1e-9).ceil().max(1.0) as usize
    }

    /// Temperature of the solid's surface at each cell [K].
    fn at_cells(&self, temperatures: &Temperatures) -> Vec<f64> {
        let rise = self.face.rise(temperatures);
        rise.into_iter().map(|rise| self.initial_temperature + rise).collect()
    }

    /// The solid's surface over a step of `dt` [s] if the droplet gives nothing, and how it answers to heat.
    ///
    /// Every place answers as the whole top would that is heated as it is: during a step heat hardly passes
    /// along the surface. How far the solid itself goes in the step is exact, as drift about these modes.
    pub fn surface(
        &self,
        solid: &SolidFem,
        unknowns: &[f64],
        loads: &SolidLoads,
        dt: f64,
        allowance: &Allowance,
    ) -> Result<Surface, Halt> {
        let temperatures = solid.temperatures(unknowns, loads);
        let start = self.at_cells(&temperatures);
        let response = self.response.clone();
        let count = response.len();
        let amplitudes = self.face.parts(&solid.top_amplitudes(&temperatures), count);
        let rest = |(t, parts): (f64, &[f64])| t - parts.iter().sum::<f64>();
        let base = start.into_iter().zip(amplitudes.chunks_exact(count)).map(rest).collect();
        let mut later = unknowns.to_vec();
        solid.advance(&mut later, std::slice::from_ref(loads), dt, allowance)?;
        let end = self.at_cells(&solid.temperatures(&later, loads));
        let mut surface = Surface { response, base, amplitudes, drift: vec![0.0; end.len()] };
        let free = surface.free(1.0, dt);
        surface.drift = end.iter().zip(free).map(|(end, free)| end - free).collect();
        Ok(surface)
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

    /// What acts on the solid over a step of `dt` [s]: loads that are held, what the droplet gave, and changes of
    /// its heat in the course of the step [W], which leave the surface as warm as the droplet found it.
    pub fn loads_during(
        &self,
        mut loads: SolidLoads,
        exchange: &WallExchange,
        falling: &[f64],
        dt: f64,
    ) -> [SolidLoads; 2] {
        self.add(&mut loads, exchange);
        let mut rates = loads.zero();
        for (class, vector) in self.parts_of(falling, [false; 2]) {
            add(&mut loads.heat[class][1], &vector, 1.0);
            add(&mut rates.heat[class][1], &vector, -2.0 / dt);
        }
        [loads, rates]
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

/// Longest time between exchanges [s]: the scene's own, or the shorter of those in which
/// - the flow goes by a distance of particles, Δx/U, and
/// - heat that passes along the surface within an exchange, which only the next one finds there, stays small:
///   `a Δt/h² ≤ e/(e + e_f)`, but no less than [`LEAST_ALONG`], with the solid's diffusivity a, its shortest
///   element h, and effusivities e and e_f of solid and fluid; of layers, the largest a and the least e. On a good insulator it would else take places
///   that are as warm as the fluid beyond its temperature;
///
/// but no shorter than a time step of the droplet.
fn interval(coupling: &Coupling, droplet: &Droplet, plan: &Plan, time_step: f64) -> f64 {
    let flow = droplet.spacing / droplet.fastest_flow();
    let fluid = &droplet.fluid;
    let layers = || plan.strata.iter().map(|layer| layer.constants);
    let solid = layers().map(|c| c.effusivity()).fold(f64::INFINITY, f64::min);
    let of_fluid = (fluid.conductivity * fluid.density * fluid.specific_heat).sqrt();
    let share = (solid / (solid + of_fluid)).max(LEAST_ALONG);
    let along =
        |c: Constants| share * shortest_element(plan).powi(2) * c.heat_capacity() / c.conductivity;
    let along = layers().map(along).fold(f64::INFINITY, f64::min);
    coupling.interval.unwrap_or_else(|| flow.min(along).max(time_step))
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
