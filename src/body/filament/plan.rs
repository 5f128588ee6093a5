//! Converts a filament of a scene to the plan of its method.

use crate::kernel::Kernel;
use crate::method::fem::Refinement;
use crate::method::filament::{LinePlan, Target};
use crate::method::sph::{self, DropletPlan, Extent, Feed, Placement, Precision, Viscous};
use crate::port::WallCells;
use crate::scene::{Coupling, Droplet, Filament, Scene, Solid, lateral_extents};
use crate::warning::{self, Finding};

/// Returns the plan of a filament, above the cells of a solid or above an insulated plane.
pub fn plan_of(
    filament: &Filament,
    cells: Option<WallCells>,
    conductance: Option<f64>,
) -> LinePlan {
    LinePlan {
        fluid: filament.fluid.clone(),
        reference: filament.nozzle.temperature,
        diameter: filament.nozzle.diameter,
        least_height: filament.least_height(),
        spacing: filament.segment_length(),
        most: filament.most,
        gravity: filament.gravity,
        air: filament.convection.map_or(0.0, |convection| convection.coefficient),
        conductance,
        cells,
    }
}

/// Side of the plate of a filament without a solid below [m].
const PLATE: f64 = 1e3;

/// Returns the plan of a filament of particles, above the cells of a solid or on a plate that takes no heat, with the
/// place of the outlet at time zero.
pub fn particles_of(
    scene: &Scene,
    (name, filament): (&str, &Filament),
    (cells, outlet): (Option<WallCells>, [f64; 3]),
) -> DropletPlan {
    let fluid = &filament.fluid;
    let fastest = scene.fastest_strand(filament);
    let tension = fluid.surface_tension;
    let inertia = fluid.density * fastest.powi(2) * filament.nozzle.diameter;
    let plan = DropletPlan {
        dimension: 3,
        axisymmetric: false,
        spacing: filament.particle_distance(),
        support: Droplet::DEFAULT_SUPPORT,
        kernel: Kernel::WendlandC2,
        fluid: sph::Fluid {
            density: fluid.density,
            viscosity: fluid.viscosity.clone(),
            specific_heat: fluid.specific_heat,
            conductivity: fluid.conductivity,
            surface_tension: tension,
            sound_speed: scene.sound_of_strand(filament),
            freezing: fluid.freezing(),
        },
        placement: Placement::Lattice,
        precision: Precision::Single,
        viscous: Viscous::WithPressure { rate: fastest / filament.nozzle.diameter },
        density_diffusion: Droplet::DEFAULT_DENSITY_DIFFUSION,
        corrected_diffusion: true,
        shifting: tension == 0.0 || inertia > tension,
        gravity: [0.0, 0.0, -filament.gravity],
        mirrors: [false; 2],
        extents: [Extent::Open; 3],
        releases: Vec::new(),
        demand: None,
        feed: Some(Feed {
            diameter: filament.nozzle.diameter,
            outlet,
            most: filament.most,
            fastest,
            temperature: filament.nozzle.temperature,
            air: filament.convection.map_or(0.0, |convection| convection.coefficient),
        }),
        wall: Some(sph::Wall {
            cells: cells.unwrap_or(WallCells::Tiles { count: [1, 1], size: [PLATE, PLATE] }),
            contact_angle: fluid.contact_angle,
            effusivity: None,
            conductance: scene.conductance_below(name),
        }),
    };
    plan.with_cheaper_viscosity(fastest)
}

/// Warnings about a nozzle that has jumped further than a limit [m], or that is late.
pub fn nozzle_warnings([jump, limit]: [f64; 2], is_late: bool) -> impl Iterator<Item = Finding> {
    let jumped = (jump > limit)
        .then(|| warning::nozzle_jumps(format!("{jump:.2e}"), format!("{limit:.2e}")));
    jumped.into_iter().chain(is_late.then(warning::nozzle_is_late))
}

/// The line that a filament is meant to follow.
pub fn target_of(scene: &Scene, name: &str) -> Option<Target> {
    scene.target_of(name).map(|target| Target::new(target.line.clone()))
}

/// Part `e_f/(e + e_f)` of the difference of temperature by which a strand warms the solid below it, with the
/// effusivities e of the solid's top and e_f of the fluid. The error that cells beside the edge of the strand cause is
/// in proportion to it (`tests/verification/strands.py`).
pub fn share_of_rise(filament: &Filament, solid: &Solid) -> f64 {
    let top = solid.strata().first().map_or(f64::INFINITY, |layer| layer.constants.effusivity());
    let own = filament.fluid.effusivity();
    if own > 0.0 { own / (own + top) } else { 0.0 }
}

/// Margin of the fine mesh around a path, in diameters of the nozzle.
const MARGIN: f64 = 2.0;

/// Refinement where a strand is laid: around the path of the nozzle, around the target if inputs move the nozzle, or
/// over the whole face.
pub fn refinement(scene: &Scene, (coupling, filament): (&Coupling, &Filament)) -> Refinement {
    let margin = coupling.radius.unwrap_or(MARGIN * filament.nozzle.diameter);
    let around = |[low, high]: [f64; 2]| [low - margin, high + margin];
    let target = scene.target_of(&coupling.from);
    let route = scene.route(filament).filter(|route| route.laid().next().is_some());
    let [x, y] = match (coupling.radius, &route, target) {
        (_, Some(route), _) => route.ranges().map(around),
        (_, None, Some(target)) => [0, 1].map(|axis| {
            let along = || target.line.iter().map(|place| place[axis]);
            around([along().fold(f64::INFINITY, f64::min), along().fold(f64::MIN, f64::max)])
        }),
        (Some(radius), None, None) => [[-radius, radius]; 2],
        (None, None, None) => {
            let solid = coupling.solid().and_then(|name| scene.solid(name));
            let extents = solid.map_or([0.0; 2], |solid| lateral_extents(&solid.shape));
            extents.map(|extent| [-0.5 * extent, 0.5 * extent])
        }
    };
    let solid = coupling.solid().and_then(|name| scene.solid(name));
    let share = solid.map_or(1.0, |solid| share_of_rise(filament, solid));
    let feature = filament.nozzle.diameter / (1.0 + share);
    Refinement { x, y, top: true, feature, heats: true, edges: [None; 2] }
}

#[cfg(test)]
mod tests {
    use super::*;

    const WAX: &str =
        "{ density = 780.0, viscosity = 4e-3, specific_heat = 2.2e3, conductivity = 0.15 }";
    const GLASS: &str =
        "{ model = \"thermoelastic\", density = 2.5e3, specific_heat = 800.0, conductivity = 1.0 }";
    const COPPER: &str = "{ model = \"thermoelastic\", density = 8.9e3, specific_heat = 385.0, conductivity = 400.0 }";

    /// Share of the rise on a plate that consists of some keys.
    fn share_on(plate: &str) -> f64 {
        let text = format!(
            "name = \"Lay\"\nstop_time = 1.0\nstep = 0.1\n[material]\nglass = {GLASS}\ncopper = {COPPER}\n[body.ink]\nkind = \"filament\"\nfluid = {WAX}\nnozzle = {{ \
             diameter = 1e-3, height = 1e-3, temperature = 340.0 }}\npath = \"input\"\nmost = 1e-8\n[body.plate]\nkind = \
             \"solid\"\nshape = {{ box = [40e-3, 30e-3, 2e-3] }}\n{plate}\ninitial_temperature = 293.15\n[[coupling]]\n\
             from = \"ink\"\nto = \"plate.top\"\ntraction = false\n"
        );
        let (scene, _) = crate::advice::parse_with_warnings(&text, "scene.toml").unwrap();
        share_of_rise(scene.filament("ink").unwrap(), scene.solid("plate").unwrap())
    }

    /// A radius of the coupling is a distance from the path, wherever that is.
    #[test]
    fn meshes_are_fine_around_the_path() {
        for (key, margin) in [("radius = 4e-3", 4e-3), ("", 2e-3)] {
            let ranges = fine_ranges(key);
            for ([low, high], [first, last]) in ranges.into_iter().zip([[0.02, 0.024], [0.0, 0.0]])
            {
                let off = (low + margin - first).abs().max((high - margin - last).abs());
                assert!(off < 1e-15, "{key}: {ranges:?}");
            }
        }
    }

    /// The fine ranges of a plate below a strand from x = 20 to 24 mm.
    fn fine_ranges(of_coupling: &str) -> [[f64; 2]; 2] {
        let text = format!(
            "name = \"Lay\"\nstop_time = 1.0\nstep = 0.1\n[body.ink]\nkind = \"filament\"\nfluid = {WAX}\nnozzle = {{ \
             diameter = 1e-3, height = 1e-3, temperature = 340.0 }}\npath = {{ time = [0.0, 1.0], x = [0.02, \
             0.024], y = [0.0, 0.0], flow = [1e-9, 1e-9] }}\nmost = 1e-8\n[body.plate]\nkind = \"solid\"\nshape = {{ box = \
             [60e-3, 30e-3, 2e-3] }}\nmaterial = {GLASS}\ninitial_temperature = 293.15\n[[coupling]]\nfrom = \
             \"ink\"\nto = \"plate.top\"\ntraction = false\n{of_coupling}\n"
        );
        let (scene, _) = crate::advice::parse_with_warnings(&text, "scene.toml").unwrap();
        let Refinement { x, y, .. } =
            refinement(&scene, (&scene.coupling[0], scene.filament("ink").unwrap()));
        [x, y]
    }

    /// A strand warms the layer on which it lies, whatever is below that.
    #[test]
    fn layered_plates_are_warmed_as_their_top_layer_is() {
        for (top, bottom) in [("glass", "copper"), ("copper", "glass")] {
            let layers = format!(
                "layers = [{{ material = \"{top}\", thickness = 1e-3 }}, {{ material = \"{bottom}\", thickness = 1e-3 }}]"
            );
            assert_eq!(share_on(&layers), share_on(&format!("material = \"{top}\"")));
        }
        assert!(share_on("material = \"glass\"") > 10.0 * share_on("material = \"copper\""));
    }
}
