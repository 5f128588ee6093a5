//! Notes on replayed drops.

use crate::body::droplet::watch;
use crate::limits::number;
use crate::method::record::Course;
use crate::scene::{Droplet, DropletMethod, Scene};

/// Returns notes on choices and simplifications, with reasons: one sentence each.
pub fn notes(scene: &Scene, (name, droplet): (&str, &Droplet)) -> Vec<String> {
    let what = match droplet.method {
        DropletMethod::Film => {
            "closed forms of a film that spreads and cools represent every drop: heat is accurate to about a fifth, on poor \
             conductors to a half (docs/fidelity.md)"
                .to_owned()
        }
        _ => format!(
            "one impact at {} is recorded ahead and repeated for every drop; a unit that was packed with its record has \
             it, others compute it before they start",
            speeds(droplet)
        ),
    };
    let mut notes = vec![
        what,
        "each drop gives heat in proportion to its temperature above that of the wall where and when it comes down: \
         exact on a plate that is warm evenly; drops that come down on the films of others, which `overlapping` counts, give \
         heat with them as one drop of all volumes would, and force as if alone"
            .to_owned(),
        "heat and force are known at any time, and act as means and slopes over communication steps, which are cut as a drop \
         comes down and cools where they are longer than that takes, or over `interval` of the coupling: a drop feels those \
         before it as of the beginning of its part of a step"
            .to_owned(),
    ];
    notes.extend(note_on_depth(scene, (name, droplet)));
    if droplet.fluid.conductivity == 0.0 {
        notes.push("heat is left out: the fluid does not conduct any".to_owned());
    } else {
        notes.push(watch::note(scene, (name, &droplet.fluid)));
    }
    notes
}

fn speeds(droplet: &Droplet) -> String {
    match &droplet.recorded_speeds()[..] {
        [one] => format!("{} m/s", number(droplet.contact(*one).0)),
        several => format!("each of {} speeds", several.len()),
    }
}

/// Largest heat penetration depth, as a share of a layer's thickness, up to which the layer is a half space.
const SHALLOW: f64 = 0.5;

/// Notes a top layer that is thinner than the heat penetration depth while a drop spreads.
fn note_on_depth(scene: &Scene, (name, droplet): (&str, &Droplet)) -> Option<String> {
    let coupling = &scene.coupling[scene.coupling_from(name)?];
    let top = scene.solid(coupling.solid()?)?.strata().first().copied()?;
    let time = droplet.recorded_time(droplet.speed_at_contact());
    let depth = (4.0 * top.constants.diffusivity() * time).sqrt();
    let thickness = top.thickness();
    (depth > SHALLOW * thickness && scene.effusivity_below(name).is_some()).then(|| {
        format!(
            "heat goes {depth:.1e} m deep while a drop spreads, and the top layer is {thickness:.1e} m thick: what is known \
             of a drop was found on a half space of its material"
        )
    })
}

/// Notes the speeds and times for which drops are known.
pub fn on_course(course: &Course, droplet: &Droplet) -> String {
    let [slowest, fastest] = course.speeds();
    let speed = droplet.speed_at_contact();
    let range = match slowest == fastest {
        true => format!("at {slowest:.4} m/s"),
        false => format!("from {slowest:.4} to {fastest:.4} m/s"),
    };
    let known = droplet.recorded_time(speed);
    format!(
        "drops are known {range} as they touch the wall, for {known:.3e} s on {} rings out to {:.3e} m; then they cool as a \
         film, and have given what they give after {:.3e} s",
        course.rings(),
        course.radius(),
        course.duration(speed)
    )
}
