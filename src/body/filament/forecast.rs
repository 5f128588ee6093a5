//! Cost of filaments, and notes on their model.

use super::warnings::heat_error;
use super::{interval, plan};
use crate::body::droplet::{PARTICLE_MEMORY, exchange_time, is_large};
use crate::body::link;
use crate::body::solid::plan as solid_plan;
use crate::body::threads_for;
use crate::limits::two_digits;
use crate::method::fem::Plan;
use crate::method::sph::{DropletSph, Viscous};
use crate::scene::{Filament, FilamentMethod, Scene};

#[derive(Debug, Clone, PartialEq)]
pub struct FilamentForecast {
    pub name: String,
    /// Number of segments or particles of the largest volume, and the word for them.
    pub count: usize,
    pub of: &'static str,
    /// Memory [B].
    pub memory: f64,
    /// Time of all steps of the default experiment [s].
    pub run_time: f64,
    /// Expected error of the heat to the solid below, by its mesh.
    pub heat_error: Option<f64>,
    /// Notes on choices and simplifications.
    pub notes: Vec<String>,
}

/// Time of a solid from which on a note says why [s].
const LONG: f64 = 5.0;
/// Memory of a segment in the state, its copies and its place on the plate [B].
const SEGMENT: f64 = 1000.0;
/// Time of a segment in a step [s], measured on wax above a plate of 2500 nodes.
const STEP: f64 = 4e-6;
/// Time of a particle in a time step with solved pressure [s], measured on strands of 10 Pa s with 280 to 1800
/// particles.
const PARTICLE_STEP: f64 = 35e-6;
/// The same with explicit pressure, and in addition of a fluid that freezes [s], measured on water and wax with up to
/// 1850 particles.
const EXPLICIT_STEP: f64 = 1.2e-6;
const FREEZING_STEP: f64 = 0.8e-6;
/// Layers of particles that move behind a nozzle, where fluid that yields comes to rest.
const MOVING: f64 = 50.0;

impl FilamentForecast {
    pub fn of(scene: &Scene, name: &str, filament: &Filament) -> Self {
        if filament.method == FilamentMethod::Particles {
            return Self::of_particles(scene, (name, filament));
        }
        let plan = plan::plan_of(filament, None, None);
        let segments = plan.capacity();
        let volume = expected_volume(scene, filament);
        // Half of them in the mean.
        let laid = 0.5 * volume / plan.segment_volume();
        let steps = (scene.stop_time / scene.step).ceil();
        let below = contact(scene, name, filament);
        let solid = scene.coupling_from(name).and_then(|place| scene.coupling[place].solid());
        let solid = solid.and_then(|name| scene.solid(name));
        let heat_error = below
            .as_ref()
            .zip(solid)
            .and_then(|((_, plan), solid)| heat_error(filament, solid, plan));
        let parts = below.as_ref().map_or(1, |(interval, _)| link::parts(*interval, scene.step));
        let exchanges = steps * parts as f64;
        let exchange = scene.step / parts as f64;
        let hot = filament.nozzle.temperature;
        let (of_solid, dear) = cost_of_solid(below.as_ref(), exchanges, exchange, hot);
        Self {
            name: name.to_owned(),
            count: segments,
            of: "segments",
            memory: SEGMENT * segments as f64,
            run_time: STEP * exchanges * laid + of_solid,
            heat_error,
            notes: notes(scene, (name, filament)).into_iter().chain(dear).collect(),
        }
    }
}

impl FilamentForecast {
    fn of_particles(scene: &Scene, (name, filament): (&str, &Filament)) -> Self {
        let outlet = [0.0, 0.0, filament.nozzle.height];
        let sph = plan::particles_of(scene, (name, filament), (None, outlet));
        let (count, time_step) = DropletSph::forecast(&sph);
        let threads = threads_for(scene.solver.threads, is_large(count)) as f64;
        let below = contact(scene, name, filament);
        let parts = below.as_ref().map_or(1, |(interval, _)| link::parts(*interval, scene.step));
        let exchanges = (scene.stop_time / scene.step).ceil() * parts as f64;
        let exchange = scene.step / parts as f64;
        let hot = filament.nozzle.temperature;
        let (of_solid, dear) = cost_of_solid(below.as_ref(), exchanges, exchange, hot);
        // Half of the particles in the mean.
        let mean = 0.5 * expected_volume(scene, filament) / sph.spacing.powi(3);
        let moving = match filament.fluid.viscosity.yield_stress() > 0.0 {
            true => mean.min(MOVING * filament.outlet() / sph.spacing.powi(2)),
            false => mean,
        };
        let of_freezing = if filament.fluid.melting.is_some() { FREEZING_STEP } else { 0.0 };
        let of_step = of_freezing
            + match sph.viscous {
                Viscous::Explicit => EXPLICIT_STEP,
                _ => PARTICLE_STEP,
            };
        let of_fluid = of_step * moving * scene.stop_time / time_step / threads;
        Self {
            name: name.to_owned(),
            count,
            of: "particles",
            memory: PARTICLE_MEMORY * count as f64,
            run_time: of_fluid + of_solid,
            heat_error: None,
            notes: notes(scene, (name, filament)).into_iter().chain(dear).collect(),
        }
    }
}

/// Time of the solid below [s] in a number of exchanges of some length [s] with a fluid of a temperature [K], and a
/// note if that is long because its heat is not linear.
fn cost_of_solid(
    below: Option<&(f64, Plan)>,
    exchanges: f64,
    exchange: f64,
    hot: f64,
) -> (f64, Option<String>) {
    let Some((_, plan)) = below else { return (0.0, None) };
    let time = exchanges * exchange_time(plan, exchange, hot);
    let is_dear = plan.newton.is_some() && time > LONG;
    let note = is_dear.then(|| {
        format!(
            "{} s of that are the solid's below, whose heat is not linear: constants of one temperature (`at` of its \
             substance) take a fraction of it",
            two_digits(time)
        )
    });
    (time, note)
}

/// Volume that comes in the default experiment [m³].
fn expected_volume(scene: &Scene, filament: &Filament) -> f64 {
    let route = scene.route(filament).filter(|_| filament.path_sets_flow());
    let of_flow = || filament.nozzle.flow * scene.stop_time;
    let volume = route.map_or_else(of_flow, |route| route.volume_until(scene.stop_time));
    if volume > 0.0 { volume.min(filament.most) } else { filament.most }
}

/// Longest time between two exchanges with the solid below [s] and the plan of that, if there is one.
fn contact(scene: &Scene, name: &str, filament: &Filament) -> Option<(f64, Plan)> {
    let coupling = &scene.coupling[scene.coupling_from(name)?];
    let solid = coupling.solid()?;
    let plan = solid_plan(scene, solid, scene.solid(solid)?);
    Some((interval(scene, coupling, (filament, &plan)), plan))
}

/// Viscosity [Pa s] and kinetic pressure over that of viscosity or surface tension above which inertia throws strands.
const INERTIAL: f64 = 1.0;

/// Number of particles between outlet and plate below which the flow there is not resolved.
const LEAST_BETWEEN: f64 = 3.0;

/// Returns notes on choices and simplifications, with reasons: one sentence each.
pub fn notes(scene: &Scene, (name, filament): (&str, &Filament)) -> Vec<String> {
    if filament.method == FilamentMethod::Particles {
        return notes_on_particles(scene, (name, filament));
    }
    let spacing = filament.segment_length();
    let mut notes = vec![
        format!(
            "the strand is a line of segments of {spacing:.2e} m where it is as thick as the nozzle, each with one width and one \
             temperature: mass and heat balance exactly, widths follow from the balance of gravity, surface tension, \
             viscosity and yield stress (docs/theory/filament.md)"
        ),
        "strands side by side do not touch, none spans a gap of more than half its width, and heat does not pass along the \
         strand"
            .to_owned(),
    ];
    notes.push(match contact(scene, name, filament) {
        Some((interval, _)) => link::note(interval),
        None => {
            "the strand lies on an insulated plane, as no coupling joins it to a solid".to_owned()
        }
    });
    if filament.fluid.melting.is_some() {
        let held = "a strand whose frozen fraction passes 0.64 neither spreads nor flows";
        notes.push(held.to_owned());
    }
    notes.extend(inertia(scene, filament));
    notes
}

/// Returns the notes on a filament of particles.
fn notes_on_particles(scene: &Scene, (name, filament): (&str, &Filament)) -> Vec<String> {
    let plan = plan::particles_of(scene, (name, filament), (None, [0.0; 3]));
    let across = filament.nozzle.diameter / plan.spacing;
    let advance = match plan.viscous {
        Viscous::WithPressure { .. } => "pressure and viscosity are solved at the end of each step",
        _ => "pressure and viscosity are explicit, as that is cheaper",
    };
    let cost = match filament.comes_to_rest() {
        true => "fluid that has come to rest takes no part in steps, but for its heat",
        false => {
            "all of them take part in every step, so the cost grows with the square of the length: only fluid that yields or \
             freezes comes to rest"
        }
    };
    let splash = jet(scene, filament).map(|[reynolds, weber]| {
        format!(
            "the fluid leaves the nozzle as a jet (Re {reynolds:.1}, We {weber:.1}): it splashes, and what is faster than \
             half of its flow does not count as laid, so that lengths and widths are those of slow fluid alone"
        )
    });
    let mut notes = vec![
        format!(
            "{across:.1} particles across the nozzle, {:.2e} m apart, leave it in layers, with the mean speed of the flow; \
             {advance}, and sound passes at {:.2e} m/s",
            plan.spacing, plan.fluid.sound_speed
        ),
        cost.to_owned(),
        "the nozzle has no rim: fluid that it presses into a gap below its diameter may rise beside it".to_owned(),
    ];
    let between = filament.nozzle.height / plan.spacing;
    notes.extend((between < LEAST_BETWEEN).then(|| {
        format!(
            "{between:.1} particles lie between outlet and plate, which resolve no flow there: three and more do"
        )
    }));
    notes.extend(splash);
    notes
}

/// Notes a fluid that leaves the nozzle so fast that its inertia matters, which lines leave out.
fn inertia(scene: &Scene, filament: &Filament) -> Option<String> {
    jet(scene, filament).map(|[reynolds, weber]| {
        format!(
            "the fluid leaves the nozzle as a jet (Re {reynolds:.1}, We {weber:.1}), whose inertia the model leaves out: a \
             real strand overshoots bends"
        )
    })
}

/// Reynolds and Weber number of a fluid that leaves the nozzle so fast that its inertia matters.
fn jet(scene: &Scene, filament: &Filament) -> Option<[f64; 2]> {
    let speed = scene.largest_flow(filament) / filament.outlet();
    let fluid = &filament.fluid;
    let diameter = filament.nozzle.diameter;
    let viscosity = fluid.reference_viscosity(filament.nozzle.temperature, speed / diameter);
    let reynolds = fluid.density * speed * diameter / viscosity;
    let weber = fluid.density * speed * speed * diameter / fluid.surface_tension;
    let is_jet = reynolds > INERTIAL && weber > INERTIAL && speed > 0.0 && scene.stop_time > 0.0;
    is_jet.then_some([reynolds, weber])
}
