//! Keys that shorten long runs of bodies that crack.

use crate::laws::fracture::GradientDamage;
use crate::limits::number;
use crate::quantity::percent;
use crate::scene::{Mesh, Scene, Solid, Symmetry};

/// Duration from which savings are proposed, and for which the proposal aims [s].
const LONG: f64 = 600.0;
/// Largest part of the smallest extent of a section that a proposed length of damage is: damage spreads over twice that
/// on both sides of a crack.
const LARGEST_PART: f64 = 1.0 / 6.0;
/// Least factor of the length of damage that is worth a proposal.
const WORTH: f64 = 1.2;

/// Keys that shorten the steps of a body that cracks, `time` in all [s], on a number of nodes; `None` if it is short.
pub fn savings(
    scene: &Scene,
    (name, solid): (&str, &Solid),
    (nodes, time): (f64, f64),
) -> Option<String> {
    let law = solid.damage()?;
    if time <= LONG {
        return None;
    }
    let start = format!(
        "cracks of `{name}` take {time:.1e} s of {} steps: {nodes:.1e} nodes resolve damage of length ℓ = {} m",
        (scene.stop_time / scene.step).ceil(),
        number(rounded(law.length))
    );
    let proposals = [finer_than_needed(solid, &law), longer(solid, &law, time), symmetry(solid)];
    let proposals: Vec<String> = proposals.into_iter().flatten().collect();
    let proposals = match proposals.is_empty() {
        true => String::new(),
        false => format!("{}; ", proposals.join("; ")),
    };
    Some(format!(
        "{start}. {proposals}a smaller part of the body, or a longer `step`, saves in proportion"
    ))
}

/// A mesh that is finer than damage needs.
fn finer_than_needed(solid: &Solid, law: &GradientDamage) -> Option<String> {
    let needed = law.length / Mesh::NODES_PER_LENGTH;
    let [along, through] =
        solid.mesh.spacing_of_cracks(law.length).map(|own| own.min(needed) / needed);
    let part = if solid.cracks_in_space() { along * along * through } else { along * through };
    (part < 1.0 / WORTH).then(|| {
        format!(
            "`mesh.spacing = {:.2e}` (ℓ/3) without a `depth_spacing` takes {} of this time, with the energy of cracks \
             right to some per cent",
            needed,
            percent(part)
        )
    })
}

/// A longer length of damage.
fn longer(solid: &Solid, law: &GradientDamage, time: f64) -> Option<String> {
    let extents = solid.extents_of_cracks();
    let extent = extents.iter().copied().fold(f64::INFINITY, f64::min);
    let dimension = extents.len() as f64;
    let factor = (time / LONG).powf(1.0 / dimension).min(LARGEST_PART * extent / law.length);
    if factor < WORTH {
        return None;
    }
    let length = rounded(factor * law.length);
    let strength = rounded(law.strength() / factor.sqrt());
    let is_by_strength = solid.material.as_ref()?.material().fracture.cracking?.strength.is_some();
    let key = match is_by_strength {
        true => format!("`fracture.strength = {strength:e}` (ℓ = {} m)", number(length)),
        false => format!("`fracture.length = {length:e}`"),
    };
    Some(format!(
        "{key} takes {} of this time, as ℓ goes with 1/strength²: cracks then begin at {strength:.1e} Pa instead \
         of {:.1e} Pa, so that more of them begin, and earlier, where there is no notch; those longer than some ℓ run \
         as before, since G_c stays",
        percent(factor.powf(-dimension)),
        law.strength()
    ))
}

/// Half of a body whose loads are even.
fn symmetry(solid: &Solid) -> Option<String> {
    let part = match (solid.section.is_some(), solid.cracks_in_space()) {
        (true, _) => "halves",
        (_, true) => "quarters",
        _ => return None,
    };
    (solid.symmetry != Symmetry::Quarter).then(|| {
        format!("`symmetry = \"quarter\"` {part} the nodes of what is even about its middle, cracks included")
    })
}

/// A number to two digits.
fn rounded(value: f64) -> f64 {
    format!("{value:.1e}").parse().unwrap_or(value)
}
