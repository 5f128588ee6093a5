//! Notes on a droplet before it runs: choices and simplifications.

use super::plan::{fine_radius, plan_of};
use super::watch;
use crate::advice::{HeatError, Resolution};
use crate::method::sph::Viscous;
use crate::scene::{Droplet, Governing, PressureAdvance, Scene, ViscousAdvance, Wall};

/// Returns notes on choices and simplifications, with reasons: one sentence each.
pub fn notes(scene: &Scene, name: &str, droplet: &Droplet) -> Vec<String> {
    let wall = scene.wall_under(name).map(|wall| &scene.wall[wall]);
    let stands = scene.has_surface_below(name);
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
    notes.extend((!stands).then(|| NOTHING_BELOW.to_owned()));
    notes.extend(note_on_box(scene, name, droplet));
    notes.extend(note_on_sound(droplet));
    notes.extend(note_on_viscosity(droplet));
    notes.extend(droplet.is_on_demand().then(|| note_on_demand(scene, name, droplet)));
    notes.extend(stands.then(|| note_on_first_blow(droplet)));
    let tolerance = scene.fidelity.tolerance;
    let resolution = Resolution::of(scene, (name, droplet)).filter(|_| stands);
    notes.extend(resolution.map(|resolution| note_on_resolution(&resolution, tolerance)));
    notes.extend(note_on_first_contact(scene, name, droplet));
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
        notes.push(watch::note(scene, (name, &droplet.fluid)));
        notes.extend(wall.and_then(|wall| note_on_held_wall(wall, droplet)));
    }
    notes
}

/// Note on a drop that meets nothing.
const NOTHING_BELOW: &str = "nothing lies below the drop, which falls freely: a `[[coupling]]` or a `[[wall]]` lets it land";

/// Notes how axisymmetric drops interact with a box.
fn note_on_box(scene: &Scene, name: &str, droplet: &Droplet) -> Option<String> {
    let solid = scene.coupling_from(name).and_then(|coupling| scene.coupling[coupling].solid())?;
    (droplet.is_axisymmetric() && scene.meets_rings(solid)).then(|| {
        format!(
            "`{solid}` is a box, which meets the drop on rings: each is as warm as the box is on average along it, and \
             what lies farther out than its nearest edge gives it nothing"
        )
    })
}

/// Returns notes on a scene's walls for users who couple them: one sentence each.
pub fn notes_on_walls(scene: &Scene) -> Vec<String> {
    let note = |wall: &Wall| {
        let droplet = scene.droplet(&wall.under)?;
        note_on_held_wall(wall, droplet).filter(|_| droplet.fluid.conductivity > 0.0)
    };
    scene.wall.iter().filter_map(note).collect()
}

/// Notes how viscosity is advanced where it is not in the usual way.
fn note_on_viscosity(droplet: &Droplet) -> Option<String> {
    if droplet.pressure == PressureAdvance::Implicit {
        let note = "pressure and viscosity are solved at the end of every time step, which sound does not limit: faster \
                    where fluid is thick, slow or at rest, slower in impacts of thin fluids. Sound is damped, so that \
                    the first blow is blunt";
        return Some(note.to_owned());
    }
    let Viscous::Implicit { .. } = plan_of(droplet, None, None).viscous else { return None };
    let reason = match droplet.fluid.viscosity.constant() {
        None => "its viscosity depends on the temperature or on the shear rate",
        Some(_) if droplet.viscous == ViscousAdvance::Implicit => "the scene sets `viscous`",
        Some(_) => "explicit steps would be shorter than is worth it",
    };
    let yields = match droplet.fluid.viscosity.yield_stress() {
        0.0 => "",
        _ => {
            ". Fluid below its yield stress rests but for the solver's tolerance, which `creep` shows"
        }
    };
    Some(format!("viscosity is solved at the end of every time step, because {reason}{yields}"))
}

/// Notes when inputs release drops, and the assumptions of the forecast about them.
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

/// Time over D/U over which mean forces and pressures hardly depend on sound and resolution.
const WINDOW: f64 = 0.1;

/// Notes the effect of the model's speed of sound on the first impact force, and the quantities that do not depend on
/// it.
fn note_on_first_blow(droplet: &Droplet) -> String {
    let speed = droplet.normal_speed_at_contact();
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

/// Notes the measured errors for this number of particles over the diameter.
fn note_on_resolution(resolution: &Resolution, tolerance: f64) -> String {
    let across = resolution.across();
    let [low, high] = resolution.spread().map(|error| 100.0 * error);
    let [few, many] = resolution.spread().map(|error| (error * across / tolerance).round());
    let [film, sheared] = resolution.layers();
    let of_heat = match (resolution.heat(), resolution.thermal_layers()) {
        (Some(HeatError { half, outside: Some(outside), .. }), Some(_)) => {
            let half = 100.0 * half;
            format!(", up to {half:.0} % either way for heat by the stop time, as {outside}")
        }
        (Some(HeatError { expected, half, .. }), Some(warmed)) => format!(
            ", {:+.0} ± {:.0} % for heat by the stop time ({film:.2} particles lie across the film at last, \
             {sheared:.2} across its layer of shear √(νD/U), {warmed:.2} across that of heat √(aD/U))",
            100.0 * expected,
            100.0 * half
        ),
        (_, Some(_)) if !resolution.conducts() => {
            ", for heat that of the wetted area, as what lies below conducts less than the fluid (a tenth to a fifth at \
             D/Δx 20, a half where films break up)"
                .to_owned()
        }
        _ => String::new(),
    };
    let of_spread = resolution.outside_of_spread();
    let of_spread = of_spread.map_or(String::new(), |outside| format!(", {outside}"));
    if let Some(outside) = resolution.outside_of_force() {
        return format!(
            "at D/Δx {across:.0} errors are about {low:.1} to {high:.1} % for the largest spread (far more where the film \
             gets thinner than two particles{of_spread}){of_heat}; the error of means of force over {WINDOW} D/U is not \
             known, {outside}"
        );
    }
    let wanted = match resolution.across_for_force(tolerance) {
        Some(forced) => format!(
            "a tolerance of {tolerance:e} takes D/Δx of {few} to {many} for the spread and {forced:.0} for force"
        ),
        None => format!("no D/Δx is known to keep a tolerance of {tolerance:e} of force"),
    };
    format!(
        "at D/Δx {across:.0} errors are about {low:.1} to {high:.1} % for the largest spread (far more where the film gets \
         thinner than two particles{of_spread}), about {:.0} % for means of force over {WINDOW} D/U{of_heat}; {wanted}",
        100.0 * resolution.force()
    )
}

/// Returns a note on how particles at the stagnation point affect the first temperatures there.
fn note_on_first_contact(scene: &Scene, name: &str, droplet: &Droplet) -> Option<String> {
    scene.coupling_from(name)?;
    let speed = droplet.normal_speed_at_contact();
    (droplet.fluid.conductivity > 0.0 && speed > 0.0).then(|| {
        format!(
            "in the first 2 Δx/U = {:.1e} s of contact the temperature under the middle may dip by a tenth to a half of its \
             rise: the first particles at the wall move apart there before others come down",
            2.0 * droplet.spacing / speed
        )
    })
}

/// Notes the effect of constant wall temperature during a step on a wall that a master may couple.
///
/// Two half spaces of effusivities e (below) and e_f have a contact temperature of `e_f/(e + e_f)` of their difference.
/// A wall at constant temperature over a step Δt transfers `2 e_f √(Δt/π)` to a surface. A constant flux of this
/// duration warms that surface by `2 √(Δt/π)/e` for each W/m². The result is `4/π · e_f/e` of the difference at the
/// end, however short the step.
fn note_on_held_wall(wall: &Wall, droplet: &Droplet) -> Option<String> {
    wall.effusivity.is_none().then(|| {
        format!(
            "`{}` names no `effusivity` e = √(kρc) of what lies below: it is held at its temperature over a step; a plate's \
             unit that a master couples with it would warm at first contact by 4/π (1 + {:.0}/e) times as much as it \
             should, in steps of any length: name the plate's (copper 37 000, alumina 6000, glass 1400, polymers 600 W \
             √s/(m² K))",
            wall.name,
            droplet.fluid.effusivity()
        )
    })
}

/// Notes the chosen speed of sound, or the cost of the scene's own.
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
