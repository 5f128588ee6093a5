//! Effects that a scene's model leaves out.

use impinge::model::Forecast;
use impinge::scene::{Carries, Droplet, Load, Scene};

/// Acceleration of free fall [m/s²].
const FREE_FALL: f64 = 9.81;
/// Bond number ρgD²/σ above which gravity flattens a drop by some per cent.
const FELT: f64 = 0.1;
/// `√We Re^¼` from which on drops splash on dry walls (C. Mundo, M. Sommerfeld & C. Tropea 1995, Int. J. Multiphase
/// Flow 21, 151–173, doi 10.1016/0301-9322(94)00069-V).
const SPLASHES: f64 = 57.7;

/// Share of a beam on its face below which the remainder is reported.
const WHOLE_BEAM: f64 = 0.99;

/// Lists effects that the model leaves out and that somebody may expect of such a scene.
pub fn omissions(scene: &Scene, forecast: &Forecast) -> Vec<String> {
    let mut list = Vec::new();
    for body in
        forecast.bodies.iter().filter(|body| body.unknowns[1] == 0 && body.reduced.is_none())
    {
        list.push(format!(
            "stress in {} (nothing reads it, or elastic constants are missing)",
            body.name
        ));
    }
    let droplets: Vec<_> = scene.droplets().collect();
    if !droplets.is_empty() {
        let freezes = droplets.iter().all(|(name, _)| scene.freezing_of(name).is_some());
        let freezing = if freezes { "shrinking of what freezes" } else { "freezing" };
        list.push(format!("{freezing}, boiling and evaporation of liquids, the air"));
    }
    if scene.large_strains().next().is_some() {
        let conduct = scene.large_strains().all(|(_, solid)| solid.conducts());
        let heat = if conduct {
            "heat that deformation and friction make"
        } else {
            "heat without `conductance` or thermal faces"
        };
        let rubs = scene.large_strains().any(|(_, solid)| solid.friction.is_some());
        let friction = if rubs { "" } else { ", friction" };
        list.push(format!("{heat}{friction} of solids of large strain"));
    }
    if scene.filaments().next().is_some() {
        list.push(
            "inertia, swelling and coiling of strands, bridges between them, boiling and evaporation".to_owned(),
        );
        let pulls = |name: &str| {
            let mut below = scene.coupling.iter().filter(|own| own.from == name);
            below.any(|own| scene.asks_mechanics(own.to.split('.').next().unwrap_or_default()))
        };
        if scene.filaments().any(|(name, _)| pulls(name)) {
            list.push("the pull of strands on what lies below as they cool and shrink".to_owned());
        }
    }
    if scene.lattices().next().is_some() {
        let rests = scene.lattices().any(|(_, lattice)| !lattice.inertia);
        let inertia = if rests { "inertia, " } else { "" };
        list.push(format!("{inertia}weight, creep, shrinkage and heat of lattices"));
    }
    let free = droplets.iter().filter(|(name, _)| !scene.has_surface_below(name));
    list.extend(free.map(|(name, _)| {
        format!("an impact of {name}: nothing lies below it (`[[coupling]]` or `[[wall]]`)")
    }));
    let heavy = |&(name, droplet): &(&str, &Droplet)| {
        let bond = bond(droplet);
        (droplet.gravity == 0.0 && bond > FELT && bond.is_finite())
            .then(|| format!("gravity on {name} (Bond number {bond:.2}; `gravity = 9.81`)"))
    };
    list.extend(droplets.iter().filter_map(heavy));
    let violent = |&(name, droplet): &(&str, &Droplet)| {
        let splash = splash(droplet);
        (scene.has_surface_below(name) && splash > SPLASHES && splash.is_finite())
            .then(|| format!("splashing of {name}: We^½ Re^¼ is {splash:.0}, and drops splash above some {SPLASHES}"))
    };
    list.extend(droplets.iter().filter_map(violent));
    list.extend(scene.load.iter().filter_map(|load| beam_beyond_face(scene, load)));
    list
}

/// `√We Re^¼` at impact.
fn splash(droplet: &Droplet) -> f64 {
    let (fluid, speed) = (&droplet.fluid, droplet.speed_at_contact());
    let weber = fluid.density * speed.powi(2) * droplet.diameter / fluid.surface_tension;
    let reynolds = fluid.density * speed * droplet.diameter / droplet.reference_viscosity();
    weber.sqrt() * reynolds.powf(0.25)
}

/// The power of a beam whose tails leave the face.
fn beam_beyond_face(scene: &Scene, load: &Load) -> Option<String> {
    let shape = &scene.solid_under(load)?.shape;
    let share = load.least_share_on(shape);
    let leaves = load.carries.contains(&Carries::Power) && share < WHOLE_BEAM;
    leaves.then(|| {
        let moves = load.range.x.or(load.range.y).or(load.range.radius).is_some();
        let least = if moves { "at least " } else { "" };
        format!(
            "the part of the beam {} beside {}: {least}{:.1} % of its power act on the face",
            load.name,
            load.on,
            100.0 * share
        )
    })
}

fn bond(droplet: &Droplet) -> f64 {
    let fluid = &droplet.fluid;
    fluid.density * FREE_FALL * droplet.diameter.powi(2) / fluid.surface_tension
}
