//! Records a profile from an impact of smoothed particles.

use super::profile::{Amounts, Profile};
use crate::method::sph::{DropletPlan, DropletSph, Failure};
use crate::port::{WallCells, WallExchange};
use crate::runtime::allowance::Allowance;

/// Settings of a recording.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Recorder {
    /// Speed towards the wall at contact [m/s].
    pub speed: f64,
    /// Heat capacity of the drop [J/K].
    pub heat_capacity: f64,
    /// Duration [s].
    pub duration: f64,
    pub samples: usize,
    pub threads: usize,
}

/// Temperature difference of the recording [K].
const DIFFERENCE: f64 = 100.0;

/// Computes the single drop of a plan above its wall, which must consist of rings.
///
/// # Panics
/// If the plan's wall is not cut into rings, or the plan does not have exactly one drop.
pub fn record_profile(plan: DropletPlan, recorder: Recorder) -> Result<Profile, Failure> {
    let wall = plan.wall.as_ref().map(|wall| wall.cells.clone());
    let (Some(WallCells::Rings { count, radius }), [drop]) = (wall, &plan.releases[..]) else {
        panic!("one drop above rings is recorded")
    };
    let temperature = drop.temperature - DIFFERENCE;
    let droplet = DropletSph::new(plan, recorder.threads);
    let mut state = droplet.initial_state();
    let mut sums = vec![Amounts::default(); count];
    let (mut amounts, mut spread, mut stray) = (Vec::new(), Vec::new(), 0.0_f64);
    let step = recorder.duration / recorder.samples as f64;
    let allowance = Allowance::default();
    for _ in 0..recorder.samples {
        let exchange = droplet.advance_on_half_space(&mut state, temperature, step, &allowance)?;
        add(&mut sums, &exchange);
        amounts.extend_from_slice(&sums);
        let totals = droplet.totals(&state);
        spread.push(totals.spread_diameter);
        stray = stray.max((totals.stray_mass / totals.mass).min(1.0));
    }
    let Recorder { speed, heat_capacity, duration, .. } = recorder;
    Ok(Profile { speed, heat_capacity, duration, rings: count, radius, amounts, spread, stray })
}

/// Amounts beyond the rings are added to the outermost.
fn add(sums: &mut [Amounts], exchange: &WallExchange) {
    for (sum, (heat, impulse)) in sums.iter_mut().zip(exchange.heat.iter().zip(&exchange.impulse)) {
        sum.heat += heat / DIFFERENCE;
        sum.push -= impulse[2];
        sum.outward += impulse[0];
    }
    if let Some(last) = sums.last_mut() {
        last.heat += exchange.heat_outside / DIFFERENCE;
        last.push -= exchange.impulse_outside[2];
    }
}
