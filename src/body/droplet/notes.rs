//! What a user should know of a droplet before it runs.

use super::plan::fine_radius;
use crate::scene::{Coupling, Droplet, Governing, Scene, Wall};

/// What was chosen or left out, and why: a sentence each.
pub fn notes(scene: &Scene, name: &str, droplet: &Droplet) -> Vec<String> {
    let wall = scene.wall_under(name).map(|wall| &scene.wall[wall]);
    let stands = wall.is_some() || scene.coupling_from(name).is_some();
    let mut notes = vec![match droplet.mirrors() {
        _ if droplet.is_axisymmetric() => {
            "the drop is modelled in the plane of radius and height: particles are rings about the axis, films and \
             spray break up into rings, and fluid that flows back to the axis has wider ones there"
        }
        [true, true] => "a quarter of the drop is modelled: it mirrors itself in x = 0 and y = 0",
        [true, false] if droplet.dimension == 2 => {
            "half of the plane drop is modelled: it mirrors itself in x = 0"
        }
        [true, false] => "half of the drop is modelled: it moves in x = 0, and mirrors itself there",
        [false, true] => "half of the drop is modelled: it moves in y = 0, and mirrors itself there",
        _ => "the whole drop is modelled: nothing makes it mirror itself, or the scene asks for it",
    }
    .to_owned()];
    notes.extend(note_on_box(scene, name, droplet));
    notes.extend(note_on_sound(droplet));
    notes.extend(droplet.is_on_demand().then(|| note_on_demand(scene, name, droplet)));
    notes.extend(stands.then(|| note_on_first_blow(droplet)));
    let tolerance = scene.fidelity.tolerance;
    notes
        .extend((stands && droplet.dimension == 3).then(|| note_on_resolution(droplet, tolerance)));
    if droplet.fluid.surface_tension == 0.0 {
        notes.push("surface tension is left out: the scene names none".to_owned());
    } else if !droplet.shifts() && droplet.shifting.is_none() {
        notes.push("particles are not shifted: surface tension rules this drop".to_owned());
    }
    if droplet.fluid.surface_tension > 0.0 && stands {
        notes.push(format!(
            "contact angle {}°, which decides how far a slow drop spreads (`fluid.contact_angle` in rad; 90° \
             where a scene names none)",
            (10.0 * droplet.fluid.contact_angle.to_degrees()).round() / 10.0
        ));
    }
    if droplet.fluid.conductivity == 0.0 {
        notes.push("heat is left out: the fluid does not conduct any".to_owned());
    } else {
        notes.push(
            "the fluid neither solidifies, melts nor evaporates, and its constants do not change with temperature"
                .to_owned(),
        );
        notes.extend(wall.and_then(|wall| note_on_held_wall(wall, droplet)));
    }
    notes
}

/// What axisymmetric drops see of a box.
fn note_on_box(scene: &Scene, name: &str, droplet: &Droplet) -> Option<String> {
    let solid = scene.coupling_from(name).and_then(|coupling| scene.coupling[coupling].solid())?;
    (droplet.is_axisymmetric() && scene.meets_rings(solid)).then(|| {
        format!(
            "`{solid}` is a box, which meets the drop on rings: each is as warm as the box is on average along it, and \
             what lies farther out than its nearest edge gives it nothing"
        )
    })
}

/// What is to be known of a scene's walls by who couples them: a sentence each.
pub fn notes_on_walls(scene: &Scene) -> Vec<String> {
    let note = |wall: &Wall| {
        let droplet = scene.droplet(&wall.under)?;
        note_on_held_wall(wall, droplet).filter(|_| droplet.fluid.conductivity > 0.0)
    };
    scene.wall.iter().filter_map(note).collect()
}

/// What drops may get wrong on the solids of a scene without anything else telling: a sentence each.
pub fn warnings_on_landing(scene: &Scene) -> Vec<String> {
    let warning = |coupling: &Coupling| {
        let droplet = scene.droplet(&coupling.from)?;
        let is_unknown = droplet.is_on_demand() && coupling.radius.is_none();
        is_unknown.then(|| {
            format!(
                "{}: inputs may let drops fall anywhere on `{}`, whose mesh is fine out to {:.1e} m from its middle alone: \
                 beyond, rises of temperature are too low by far; `radius` of the coupling sets how far it is fine",
                coupling.from,
                coupling.to,
                fine_radius(coupling, droplet, scene.stop_time)
            )
        })
    };
    scene.coupling.iter().filter_map(warning).collect()
}

/// What drops that inputs release wait for, and what is said of them ahead.
fn note_on_demand(scene: &Scene, name: &str, droplet: &Droplet) -> String {
    let fine = match scene.coupling_from(name).map(|index| &scene.coupling[index]) {
        Some(coupling) => format!(
            "; the mesh of `{}` is fine about the origin, out to {:.3e} m (`radius` of the coupling): drops that fall \
             beyond heat elements too coarse for them",
            coupling.to,
            fine_radius(coupling, droplet, scene.stop_time)
        ),
        None => String::new(),
    };
    format!(
        "inputs release up to {} drops, at up to {:.4} m/s: a drop starts with a step, and waits while fluid is within \
         half a distance of particles of its place, which a `height` above the film keeps free; memory and time are \
         forecast as if all were released at once{fine}",
        droplet.drops(),
        droplet.fastest_release()
    )
}

/// Time over D/U over which forces and pressures are means that hardly depend on sound and resolution.
const WINDOW: f64 = 0.1;

/// What the model's speed of sound does to the first blow, and what does not depend on it.
fn note_on_first_blow(droplet: &Droplet) -> String {
    let speed = droplet.normal_speed();
    let hammer = droplet.fluid.density * droplet.sound_speed() * speed;
    let window = match speed {
        speed if speed > 0.0 => format!(" = {:.1e} s", WINDOW * droplet.diameter / speed),
        _ => String::new(),
    };
    format!(
        "that speed of sound is artificial: the pressure of the first blow, ρcU = {hammer:.3e} Pa here, and \
         `max_pressure` are in proportion to it; what follows after some D/c is not. `max_pressure` is the water \
         hammer in a single particle: it grows as particles get smaller and converges to nothing. Forces \
         converge as means over {WINDOW} D/U{window} and longer: differences of `impulse_z` over these times"
    )
}

/// Errors of the largest spread over Δx/D, lowest and highest: at We 30, Re 500 beside finer particles and at Re 27 beside
/// volumes of fluid (`tests/verification/README.md`).
const SPREAD: [f64; 2] = [0.7, 2.4];
/// Of forces as means over that window, at D/Δx 24 to 48.
const FORCE: f64 = 0.01;
/// Errors of heat in films thicker than two particles, lowest and highest, at D/Δx 16 to 32 (`docs/maps/fluids.md`).
const HEAT: [f64; 2] = [0.03, 0.2];

/// What so many particles over the diameter err by, as measured.
fn note_on_resolution(droplet: &Droplet, tolerance: f64) -> String {
    let particles = droplet.diameter / droplet.spacing;
    let [low, high] = SPREAD.map(|rate| 100.0 * rate / particles);
    let [few, many] = SPREAD.map(|rate| (rate / tolerance).round());
    let [least, most] = HEAT.map(|error| 100.0 * error);
    let wanted = match FORCE > tolerance {
        true => format!(
            "no number of particles is known to keep a tolerance of {tolerance:e} of force and heat"
        ),
        false => {
            format!("a tolerance of {tolerance:e} takes D/Δx of {few} to {many} for the spread")
        }
    };
    format!(
        "at D/Δx {particles:.0} the largest spread errs by about {low:.1} to {high:.1} % (in proportion to Δx/D, measured \
         at D/Δx 16 to 64 and Re 27 to 500; by far more where the film gets thinner than two particles), means of force \
         over {WINDOW} D/U by about {:.0} % at any D/Δx from 24 on, heat by {least:.0} to {most:.0} % while films are \
         thicker than two particles, by up to a half where they are thinner; {wanted}",
        100.0 * FORCE
    )
}

/// Part of the time Δx²/a, in which heat goes through a layer of particles, that steps of a master may take.
const STEP_OF_MASTER: f64 = 0.1;

/// What a wall does whose temperature is held, though a master may couple it.
fn note_on_held_wall(wall: &Wall, droplet: &Droplet) -> Option<String> {
    let fluid = &droplet.fluid;
    let diffusivity = fluid.conductivity / (fluid.density * fluid.specific_heat);
    let step = STEP_OF_MASTER * droplet.spacing.powi(2) / diffusivity;
    wall.effusivity.is_none().then(|| {
        format!(
            "`{}` names no `effusivity`: its heat flux just after contact is that of a wall held at its \
             temperature; a master that couples it with the unit of a plate has to name the plate's √(kρc), or to \
             take steps of 0.1 Δx²/a = {step:.1e} s or shorter",
            wall.name
        )
    })
}

/// The speed of sound that was chosen, or what one that the scene asks for costs.
fn note_on_sound(droplet: &Droplet) -> Option<String> {
    let (sound, (governing, speed)) = (droplet.sound_speed(), droplet.governing_speed());
    let ratio = sound / speed;
    if droplet.fluid.sound_speed.is_none() {
        let what = match governing {
            Governing::Flow => "the fastest flow expected",
            Governing::Surface => {
                "the speed √(2σ/(ρΔx)) that surface tension gives single particles"
            }
            Governing::Viscosity => {
                "the speed √(12µU/(ρD)) of the pressure that stops a viscous drop"
            }
        };
        return Some(format!("speed of sound chosen: {sound:.4} m/s, ten times {what}"));
    }
    let compressed = 100.0 / (ratio * ratio);
    (ratio < 10.0).then(|| match governing {
        Governing::Surface => format!(
            "the speed of sound is only {ratio:.2} times √(2σ/(ρΔx)): single particles may come loose from the \
             surface, none at ten times"
        ),
        Governing::Flow => format!(
            "the speed of sound is only {ratio:.2} times the fastest flow: the fluid is compressed by about \
             {compressed:.1} %, by 1 % at ten times"
        ),
        Governing::Viscosity => format!(
            "the speed of sound is only {ratio:.2} times √(12µU/(ρD)): where the drop is stopped, the fluid is \
             compressed by about {compressed:.1} %, by 1 % at ten times"
        ),
    })
}

/// Of fluid beyond the edge of the body below.
pub fn on_overflow(name: &str) -> String {
    format!(
        "{name}: fluid lies beyond the edge of the solid; it gives no heat there, and its force, which \
         does not act on the solid, is counted apart as force_outside"
    )
}

/// Of a part of the fluid that has come off.
pub fn on_stray_mass(name: &str, part: f64) -> String {
    format!(
        "{name}: {:.0} % of the fluid have come off in small lumps (stray_mass): films thinner than some two \
         particles break up, those of a smaller `spacing` later",
        100.0 * part
    )
}
