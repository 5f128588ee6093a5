//! Warnings about strands on solids, before a scene runs.

use super::plan::share_of_rise;
use crate::body::solid::plan as solid_plan;
use crate::method::fem::Plan;
use crate::scene::check::number;
use crate::scene::{Coupling, Filament, Scene, Solid};
use crate::warning::{self, Warning};

/// Number of nodes below a strand from which on a run takes minutes.
const MANY_NODES: usize = 500_000;
/// Error of the heat on a fine mesh, and what a length of elements adds over the diameter and the share of the rise.
/// Upper bounds of `tests/verification/strands.py` from half a second on, for wax, paste and solder on glass, copper,
/// steel and FR4, on meshes of a quarter to a twentieth of the diameter.
const ERROR: [f64; 2] = [0.02, 1.3];
/// Error of the heat that is worth a warning.
const LARGE: f64 = 0.2;
/// Part of the difference of temperatures between fluid and solid within which a contact that is at the freezing point
/// may freeze early or late.
const NEAR: f64 = 0.1;

/// Expected error of the heat that a strand transfers to the solid below, by its mesh; `None` without heat.
pub fn heat_error(filament: &Filament, solid: &Solid, plan: &Plan) -> Option<f64> {
    let [base, of_length] = ERROR;
    let length = spacing(plan) / filament.nozzle.diameter;
    let share = share_of_rise(filament, solid);
    (share > 0.0).then_some(base + of_length * share * length)
}

/// Shortest distance of nodes along the surface [m].
fn spacing(plan: &Plan) -> f64 {
    let elements = plan.mesh.axes[..2].iter().flat_map(|axis| {
        (0..axis.elements()).map(|element| {
            let [start, end] = axis.bounds(element);
            (end - start) / plan.mesh.order() as f64
        })
    });
    elements.fold(f64::INFINITY, f64::min)
}

/// Warns of meshes below strands that are large or coarse, and of contacts near the freezing point.
pub fn warnings_on_strands(scene: &Scene) -> Vec<Warning> {
    let of_coupling = |coupling: &Coupling| {
        let name = coupling.solid()?;
        let (filament, solid) = (scene.filament(&coupling.from)?, scene.solid(name)?);
        let plan = solid_plan(scene, name, solid);
        let [nodes, _] = plan.unknowns();
        let many = (nodes > MANY_NODES).then(|| {
            let (nodes, finest) = (format!("{nodes:.1e}"), format!("{:.1e}", 4.0 * spacing(&plan)));
            let linear = match plan.newton {
                Some(_) => "give the solid constants of one temperature (`at` of a substance), with which heat is linear; ",
                None => "",
            };
            warning::mesh_below_strand_is_large(&coupling.from, nodes, finest, linear).at(name)
        });
        let coarse =
            heat_error(filament, solid, &plan).filter(|&error| error > LARGE).map(|error| {
                let finer = number(0.1 * filament.nozzle.diameter);
                let error = format!("{:.0}", 100.0 * error);
                warning::mesh_below_strand_is_coarse(&coupling.from, error, finer).at(name)
            });
        let near = near_freezing(filament, solid).map(|[contact, low, high]| {
            warning::strand_freezes_at_contact(name, contact, low, high).at(&coupling.from)
        });
        Some([many, coarse, near].into_iter().flatten())
    };
    scene.coupling.iter().filter_map(of_coupling).flatten().collect()
}

/// Temperature of first contact, and the range of freezing in which that nearly is [K].
fn near_freezing(filament: &Filament, solid: &Solid) -> Option<[String; 3]> {
    let melting = filament.fluid.melting?;
    let (hot, cold) = (filament.nozzle.temperature, solid.initial_temperature);
    let contact = cold + share_of_rise(filament, solid) * (hot - cold);
    let margin = NEAR * (hot - cold).abs();
    let is_near = melting.solidus - margin < contact && contact < melting.liquidus + margin;
    let shown = [contact, melting.solidus, melting.liquidus].map(|value| format!("{value:.1}"));
    (is_near && cold < melting.solidus).then_some(shown)
}
