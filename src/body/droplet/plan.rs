//! Converts a droplet of a scene to the plan from which the engine builds it.

use crate::method::fem::Refinement;
use crate::method::sph::{self, Demand, DropletPlan, Extent, Release, Viscous};
use crate::port::WallCells;
use crate::scene::{Arrival, Coupling, Droplet, PressureAdvance, ViscousAdvance};

/// Returns the plan of a droplet, above the cells of a wall or in free space.
pub fn plan_of(
    droplet: &Droplet,
    cells: Option<WallCells>,
    effusivity: Option<f64>,
) -> DropletPlan {
    let fluid = &droplet.fluid;
    let release = |arrival: &Arrival| release_at(droplet, arrival);
    let expected = release(&Arrival::default());
    let rate = droplet.fastest_flow() / droplet.diameter;
    let plan = DropletPlan {
        dimension: droplet.dimension,
        axisymmetric: droplet.is_axisymmetric(),
        spacing: droplet.spacing,
        support: droplet.support,
        kernel: droplet.kernel,
        fluid: sph::Fluid {
            density: fluid.density,
            viscosity: fluid.viscosity.clone(),
            specific_heat: fluid.specific_heat,
            conductivity: fluid.conductivity,
            surface_tension: fluid.surface_tension,
            sound_speed: droplet.sound_speed(),
            freezing: None,
        },
        placement: droplet.placement,
        precision: droplet.precision,
        viscous: match (droplet.pressure, droplet.viscous) {
            (PressureAdvance::Implicit, _) => Viscous::WithPressure { rate },
            (PressureAdvance::Explicit, ViscousAdvance::Explicit) => Viscous::Explicit,
            (PressureAdvance::Explicit, _) => Viscous::Implicit { rate },
        },
        density_diffusion: droplet.density_diffusion,
        corrected_diffusion: droplet.corrected_diffusion,
        shifting: droplet.shifts(),
        gravity: [0.0, 0.0, -droplet.gravity],
        mirrors: droplet.mirrors(),
        extents: [Extent::Open; 3],
        releases: droplet.arrivals().iter().map(release).collect(),
        demand: droplet.is_on_demand().then_some(Demand { most: droplet.drops(), expected }),
        feed: None,
        wall: cells.map(|cells| sph::Wall {
            cells,
            contact_angle: fluid.contact_angle,
            effusivity,
            conductance: None,
        }),
    };
    match droplet.viscous {
        _ if droplet.pressure == PressureAdvance::Implicit => plan,
        ViscousAdvance::Auto => plan.with_cheaper_viscosity(droplet.fastest_flow()),
        ViscousAdvance::Explicit | ViscousAdvance::Implicit => plan,
    }
}

/// A drop as released by the scene.
pub fn release_at(droplet: &Droplet, arrival: &Arrival) -> Release {
    Release {
        time: arrival.time,
        centre: [arrival.x, arrival.y, droplet.gap() + 0.5 * droplet.diameter],
        diameter: droplet.diameter,
        velocity: droplet.velocity(),
        temperature: droplet.initial_temperature,
    }
}

/// Radius around a landing point within which the mesh below is fine [m], with this much time remaining [s]: the
/// expected spread radius, but no more than the flow can reach at its arrival speed.
pub fn fine_radius(coupling: &Coupling, droplet: &Droplet, time: f64) -> f64 {
    let soonest = 0.5 * droplet.diameter + droplet.fastest_flow() * time;
    coupling.radius.unwrap_or((0.5 * droplet.spread_diameter()).min(soonest))
}

/// Refinements where droplets spread on a solid.
pub fn refinements(coupling: &Coupling, droplet: &Droplet, stop_time: f64) -> Vec<Refinement> {
    let at = |arrival: &Arrival| {
        let radius = fine_radius(coupling, droplet, (stop_time - arrival.time).max(0.0));
        let stretch = |centre: f64| [centre - radius, centre + radius];
        let feature = 0.5 * droplet.diameter;
        let [x, y] = droplet.landing([arrival.x, arrival.y], droplet.velocity()).map(stretch);
        Refinement { x, y, top: true, feature, heats: true, edges: [None; 2] }
    };
    // The landing places of drops on demand are unknown.
    let at_origin = droplet.is_on_demand().then(Arrival::default);
    droplet.arrivals().iter().chain(&at_origin).map(at).collect()
}
