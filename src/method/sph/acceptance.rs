//! Checks whether a vector from outside is a state that a run of these droplets can reach.

use super::cloud::{Cloud, HeadNumbers, cloud_of, head_len, ledger_of, particles_in};
use super::feed::{ASLEEP, BY_NOZZLE, Column, FREE, Fed};
use super::images::Source;
use super::kick::{DENSITIES, FARTHEST, FASTEST};
use super::method::Method;
use super::plan::{Demand, DropletPlan};
use super::requests::Requests;
use crate::runtime::parallel::Team;

/// Particles of the drops released so far, and their mass over ρ₀H^d.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Released {
    pub particles: usize,
    pub mass: f64,
}

/// Relative rounding of a sum of masses.
const ROUNDING: f64 = 1e-9;
/// Free surface over H² that no particle reaches.
const LARGEST_AREA: f64 = 10.0;
/// Viscous stress over ρ₀c₀² that no flow reaches which is much slower than sound.
const LARGEST_STRESS: f64 = 1e3;

/// Returns the reason why a state must not be loaded: the particle loops cannot process it, or no
/// run leads to it. `coldest` returns the lowest temperature [K] of a cloud, `released` the
/// particles after a number of releases, and `waits` whether fluid occupies the place of the next
/// one.
pub fn check(
    state: &[f64],
    (plan, method, head): (&DropletPlan, &Method, HeadNumbers),
    column: Option<&Column>,
    coldest: impl Fn(&Cloud) -> f64,
    released: impl Fn(usize) -> Released,
    waits: impl Fn(&Cloud, usize) -> bool,
) -> Result<(), String> {
    let Some(count) = particles_in(state, head) else {
        return Err(format!("{} unknowns, which fit no number of particles", state.len()));
    };
    let [drops, due] = check_head(&state[..head_len(head)], (plan, method, head), column)?;
    let expected = released(drops);
    if count != expected.particles || count > Source::MOST {
        let expected = expected.particles;
        return Err(format!("{count} particles, where {drops} drops have {expected}"));
    }
    let cloud = cloud_of(state, head, &Team::new(1));
    if drops < due && !waits(&cloud, drops) {
        return Err(format!("{drops} drops released, where {due} are due and have room"));
    }
    check_masses(&cloud, expected)?;
    let coldest = coldest(&cloud);
    if coldest <= 0.0 {
        return Err(format!("a particle at {coldest} K, which is not above absolute zero"));
    }
    let near_plane = method.images.begin();
    for (i, (x, density)) in cloud.position.iter().zip(&cloud.density).enumerate() {
        for a in 0..3 {
            if x[a].abs() >= FARTHEST || (near_plane[a] && x[a] < 0.0) {
                return Err(format!("particle {i} at {:?}, which no run reaches", x));
            }
        }
        let speed = cloud.velocity[i].iter().map(|v| v * v).sum::<f64>().sqrt();
        if speed >= FASTEST {
            return Err(format!("particle {i} at {speed} times the speed of sound"));
        }
        let ratio = 1.0 + density;
        if !(DENSITIES[0]..DENSITIES[1]).contains(&ratio) {
            return Err(format!("particle {i} has {ratio} of the density at rest"));
        }
    }
    check_contents(&cloud, method)?;
    check_areas(&cloud)?;
    if let Some(column) = column {
        check_origins(&cloud, column, drops)?;
    }
    let sizes =
        cloud.stress.iter().flatten().map(|stress| stress.iter().map(|s| s * s).sum::<f64>());
    match sizes.enumerate().find(|(_, size)| *size >= LARGEST_STRESS * LARGEST_STRESS) {
        Some((i, size)) => {
            Err(format!("particle {i} under {} times the stress ρc² of sound", size.sqrt()))
        }
        None => Ok(()),
    }
}

/// Refuses a ledger that contradicts itself or the plan; returns the numbers of drops that are released and due.
fn check_head(
    numbers: &[f64],
    (plan, method, head): (&DropletPlan, &Method, HeadNumbers),
    column: Option<&Column>,
) -> Result<[usize; 2], String> {
    let [time, drops] = [numbers[0], numbers[1]];
    let ledger = ledger_of(numbers, head);
    if let (Some(column), Some(fed)) = (column, &ledger.fed) {
        check_nozzle((column, fed), drops, (plan, method))?;
    }
    let due = match (&plan.demand, &ledger.requests) {
        _ if column.is_some() => drops as usize,
        (Some(demand), Some(requests)) => {
            check_requests(requests, drops, demand, method)?;
            drops as usize
        }
        _ => plan.releases.iter().take_while(|release| release.time <= time).count(),
    };
    if !(0.0..=due as f64).contains(&drops) || drops.fract() != 0.0 {
        return Err(format!("{drops} drops released, where {due} are due at {time} s"));
    }
    let numbers = [
        ("a time", time),
        ("time steps", ledger.steps),
        ("a last step", ledger.exchange.duration),
        ("a way", ledger.way),
        ("a volume", ledger.surrounded),
        ("a creep", ledger.creep.unwrap_or(0.0)),
        ("an arrest", ledger.arrest.unwrap_or(0.0)),
        ("iterations", ledger.iterations.unwrap_or(0.0)),
    ];
    match numbers.into_iter().find(|&(_, number)| number < 0.0) {
        Some((what, number)) => Err(format!("{what} of {number}, which is below zero")),
        None => Ok([drops as usize, due]),
    }
}

/// Refuses a nozzle that no run has, with a number of layers.
fn check_nozzle(
    (column, fed): (&Column, &Fed),
    layers: f64,
    (plan, method): (&DropletPlan, &Method),
) -> Result<(), String> {
    let most = plan.feed.map_or(0.0, |feed| feed.most);
    if !(0.0..=most * (1.0 + ROUNDING)).contains(&fed.volume) {
        return Err(format!("{} m³ have come, of at most {most}", fed.volume));
    }
    let due = column.passed(fed.volume) + column.layers;
    if layers != due as f64 {
        return Err(format!("{layers} layers of fluid, where {due} have come"));
    }
    let is_flag = |value: f64| value == 0.0 || value == 1.0;
    if !(is_flag(fed.flowing) && is_flag(fed.late) && fed.jump >= 0.0) {
        return Err("a flag or a jump of the nozzle that no run has".to_owned());
    }
    match fed.nozzle.iter().any(|x| x.abs() >= FARTHEST * method.units.length) {
        true => Err(format!("a nozzle at {:?} m, which no run reaches", fed.nozzle)),
        false => Ok(()),
    }
}

/// Refuses particles in layers that have not come, and holds that do not follow from these.
fn check_origins(cloud: &Cloud, column: &Column, layers: usize) -> Result<(), String> {
    let Some(origin) = &cloud.origin else { return Ok(()) };
    let passed = layers - column.layers.min(layers);
    let mut counts = vec![0; layers];
    for (i, (&layer, &hold)) in origin.layer.iter().zip(&origin.hold).enumerate() {
        if layer.fract() != 0.0 || !(0.0..layers as f64).contains(&layer) {
            return Err(format!("particle {i} of layer {layer}, of {layers}"));
        }
        let is_free = (layer as usize) < passed;
        let rests = hold == ASLEEP && cloud.velocity[i] == [0.0; 3];
        let is_known = if is_free { hold == FREE || rests } else { hold == BY_NOZZLE };
        if !is_known {
            return Err(format!("particle {i} with the hold {hold} in layer {layer}"));
        }
        counts[layer as usize] += 1;
    }
    match counts.iter().position(|count| *count != column.places.len()) {
        Some(layer) => Err(format!("{} particles in layer {layer}", counts[layer])),
        None => Ok(()),
    }
}

/// Refuses requests for drops that no caller can have made.
fn check_requests(
    requests: &Requests,
    released: f64,
    demand: &Demand,
    method: &Method,
) -> Result<(), String> {
    let &Requests { asked, .. } = requests;
    let most = demand.most as f64;
    let whole = asked.fract() == 0.0 && released.fract() == 0.0;
    if !(whole && (0.0..=asked).contains(&released) && asked <= most) {
        return Err(format!("{released} drops released of {asked}, of at most {most}"));
    }
    for drop in requests.drops(released, &demand.expected) {
        let far = drop.centre.iter().any(|x| x.abs() >= FARTHEST * method.units.length);
        let speed = drop.velocity.iter().map(|v| v * v).sum::<f64>().sqrt();
        if far || speed >= FASTEST * method.units.speed || drop.temperature <= 0.0 {
            return Err(format!(
                "a waiting drop at {:?} m, {speed} m/s and {} K",
                drop.centre, drop.temperature
            ));
        }
    }
    let unused = &requests.waiting[requests.waiting(released)..];
    match unused.as_flattened().iter().all(|number| *number == 0.0) {
        true => Ok(()),
        false => Err(format!("more drops wait than {asked} less {released}")),
    }
}

/// Refuses temperatures that do not follow from the heat contents.
fn check_contents(cloud: &Cloud, method: &Method) -> Result<(), String> {
    let (Some(phases), Some(contents)) = (&method.phases, &cloud.content) else { return Ok(()) };
    for (i, (&content, &rise)) in contents.iter().zip(&cloud.temperature).enumerate() {
        let expected = phases.rise(content);
        if (expected - rise).abs() > ROUNDING * (1.0 + expected.abs()) {
            return Err(format!(
                "particle {i} is {rise} K warm, where its heat makes {expected} K"
            ));
        }
    }
    Ok(())
}

/// Refuses free surfaces that no particle has.
fn check_areas(cloud: &Cloud) -> Result<(), String> {
    let areas = cloud.exposed.iter().flatten();
    match areas.enumerate().find(|(_, area)| !(0.0..LARGEST_AREA).contains(*area)) {
        Some((i, area)) => Err(format!("particle {i} with {area} of free surface over H²")),
        None => Ok(()),
    }
}

fn check_masses(cloud: &Cloud, expected: Released) -> Result<(), String> {
    if let Some((i, mass)) = cloud.mass.iter().enumerate().find(|(_, mass)| **mass <= 0.0) {
        return Err(format!("particle {i} with a mass of {mass}"));
    }
    let mass: f64 = cloud.mass.iter().sum();
    if (mass - expected.mass).abs() > ROUNDING * expected.mass {
        return Err(format!("{mass} of mass, where {} were released", expected.mass));
    }
    Ok(())
}
