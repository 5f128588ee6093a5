//! Filaments of particles.

use super::motions::NozzleInputs;
use super::totals::{self, Seen};
use super::{forecast, plan};
use crate::body::droplet::{Watch, is_large};
use crate::body::{
    Acts, Advice, Approach, Body, BodyError, Events, Fields, Given, Giver, Link, Maxima, Memo,
    Occasion, Reading, Received, Resources,
};
use crate::inputs::{InputLayout, InputPath, Motion};
use crate::laws::Melting;
use crate::method::filament::{Failure, LineTotals, Sliced, Slicing, Target, guard};
use crate::method::sph::{self, DropletSph, UNKNOWNS, WarmPlace};
use crate::port::{Surface, WallCells, WallExchange};
use crate::runtime::allowance::{Allowance, cost};
use crate::scene::{Filament, Scene};
use crate::state::Layout;
use crate::warning::{self, Warning};

/// A filament of particles.
pub struct ParticleFilament {
    name: String,
    sph: DropletSph,
    nozzle: NozzleInputs,
    slicing: Slicing,
    /// Largest volume that may come [m³].
    most: f64,
    target: Option<Target>,
    watch: Watch,
    /// True if forces are transferred to a solid below, `None` without one.
    traction: Option<bool>,
    notes: Vec<String>,
    threads: usize,
}

/// Name of the time steps in messages.
const STEPS: &str = "time steps of a filament";

impl ParticleFilament {
    /// `on` holds the cells of a body below and the link with it.
    pub fn new(
        scene: &Scene,
        (layout, start): (&InputLayout, &[f64]),
        (name, filament): (&str, &Filament),
        on: Option<(WallCells, &Link)>,
        threads: impl Fn(bool) -> usize,
    ) -> Self {
        let nozzle = NozzleInputs::new(filament, scene.route(filament), layout.of_body(name));
        let traction = on.as_ref().map(|(_, link)| link.traction);
        let cells = on.map(|(cells, _)| cells);
        let outlet = nozzle.start(start);
        let plan = plan::particles_of(scene, (name, filament), (cells, outlet));
        let threads = threads(is_large(plan.particles()));
        Self {
            name: name.to_owned(),
            slicing: Slicing { segment: 0.5 * filament.nozzle.diameter, layer: plan.spacing },
            sph: DropletSph::new(plan, threads),
            nozzle,
            most: filament.most,
            target: plan::target_of(scene, name),
            watch: Watch::of(scene, (name, &filament.fluid), filament.fluid.melting.is_some()),
            traction,
            notes: forecast::notes(scene, (name, filament)),
            threads,
        }
    }

    fn refused(&self, failure: Failure) -> BodyError {
        BodyError::Filament { body: self.name.clone(), failure }
    }

    fn failed(&self, failure: sph::Failure) -> BodyError {
        match failure {
            sph::Failure::Halted(halt) => BodyError::Halted { body: self.name.clone(), halt },
            failure => BodyError::Droplet { name: self.name.clone(), failure },
        }
    }

    /// Refuses motions that lay more than may come, that have fluid at or below its freezing point at any time, or the
    /// outlet lower than a distance of particles above the plate.
    fn check_motions(&self, mut came: f64, motions: &[Motion]) -> Result<(), Failure> {
        for motion in motions {
            guard(motion, came, self.most)?;
            came += motion.volume(motion.duration);
            check_motion(motion, self.melting(), self.slicing.layer)?;
        }
        Ok(())
    }

    fn melting(&self) -> Option<Melting> {
        self.sph.plan().fluid.freezing.map(|freezing| freezing.melting)
    }

    fn view(&self, state: &[f64]) -> Seen {
        let (laid, sums) = (self.sph.laid(state), self.sph.sums(state));
        let sliced = Sliced::of(&laid, self.slicing);
        let exchange = self.sph.exchange(state);
        let [coldest, hottest] = sums.temperature_range;
        let stored = sums.heat - sums.heat_released;
        let density = self.sph.plan().fluid.density;
        let totals = sliced.totals(laid.fed.nozzle);
        let volume: f64 = laid.volume.iter().sum();
        Seen {
            volume: laid.fed.volume,
            mass: density * laid.fed.volume,
            totals: LineTotals {
                volume,
                hottest,
                coldest,
                frozen: if laid.volume.is_empty() {
                    0.0
                } else {
                    sums.frozen_mass / (density * volume)
                },
                heat_stored: stored,
                missing: stored + sums.heat_to_wall + sums.heat_to_air,
                ..totals
            },
            deviation: (self.target.as_ref())
                .map_or_else(Default::default, |target| target.deviation(&sliced.segments)),
            segments: sliced.segments.len(),
            touch: sliced.touch,
            impulse: sums.impulse_to_wall,
            supplied: sums.heat_released,
            given: sums.heat_to_wall,
            lost: sums.heat_to_air,
            exchanged: [
                exchange.heat.iter().sum::<f64>() + exchange.heat_outside,
                exchange.impulse.iter().map(|impulse| impulse[2]).sum(),
            ],
            duration: exchange.duration,
            particles: sums,
            resting: laid.resting,
            density,
        }
    }

    /// Number of time steps in `dt` [s] at the expected speed, and number of particles of the largest volume.
    fn expected_steps(&self, dt: f64) -> (f64, usize) {
        let (particles, time_step) = self.sph.expected();
        (dt / time_step, particles)
    }
}

/// Refuses a motion that has fluid at or below its freezing point at any time, or the outlet lower than a height [m].
fn check_motion(motion: &Motion, melting: Option<Melting>, least: f64) -> Result<(), Failure> {
    let temperature = motion.least_temperature();
    if temperature <= 0.0 {
        return Err(Failure::BelowAbsoluteZero { temperature });
    }
    if let Some(Melting { liquidus, .. }) = melting
        && temperature <= liquidus
    {
        return Err(Failure::Frozen { temperature, liquidus });
    }
    let height = motion.least_height();
    match height < least {
        true => Err(Failure::NozzleInPlate { height, least, when: "with fluid in it" }),
        false => Ok(()),
    }
}

impl Body for ParticleFilament {
    fn name(&self) -> &str {
        &self.name
    }

    fn initial_state(&self) -> Vec<f64> {
        self.sph.initial_state()
    }

    fn layout(&self, state: &[f64]) -> Option<Layout> {
        self.sph.layout(state)
    }

    fn check_state(&self, state: &[f64], _: &[f64]) -> Result<(), String> {
        self.sph.check_state(state).map_err(|reason| format!("{}: {reason}", self.name))
    }

    fn check_inputs(&self, inputs: &[f64]) -> Result<(), BodyError> {
        self.nozzle.check(inputs)
    }

    fn memo(&self, _: &[f64], _: &[Received]) -> Memo {
        Box::new(None::<Seen>)
    }

    fn forget_state(&self, memo: &mut Memo) {
        *memo = Box::new(None::<Seen>);
    }

    fn advance(
        &self,
        state: &mut Vec<f64>,
        _: &Memo,
        acts: &Acts,
        allowance: &Allowance,
    ) -> Result<Option<Given>, BodyError> {
        let time = self.sph.time(state);
        let motions = self.nozzle.motions(acts.path, time, acts.duration);
        let checked = self.check_motions(self.sph.fed(state).volume, &motions);
        checked.map_err(|failure| self.refused(failure))?;
        let insulated = Surface::held(&[self.sph.plan().reference_temperature()]);
        let surface = acts.below.unwrap_or(&insulated);
        let air = self.nozzle.air(acts.path, time, self.sph.plan().reference_temperature());
        let rises = self.sph.advance_fed(state, &motions, (surface, air), allowance);
        let rises = rises.map_err(|failure| self.failed(failure))?;
        Ok(self.given(state).map(|given| Given {
            falling: surface.falling_parts(&given.heat, &rises, acts.duration),
            ..given
        }))
    }

    fn read(&self, state: &[f64], memo: &mut Memo, reading: &Reading) -> Result<f64, BodyError> {
        let Reading::Total(place) = *reading else { return Err(BodyError::NoSuchReading) };
        let seen: &mut Option<Seen> = memo.downcast_mut().expect("a memo of this body");
        Ok(totals::read(place, seen.get_or_insert_with(|| self.view(state))))
    }

    fn fields(&self, state: &[f64], _: &mut Memo) -> Result<Fields, BodyError> {
        Ok(Fields::Particles(self.sph.particles(state)))
    }
}

impl Giver for ParticleFilament {
    fn given(&self, state: &[f64]) -> Option<Given> {
        let traction = self.traction?;
        let WallExchange { duration, heat, impulse, .. } = self.sph.exchange(state);
        Some(Given {
            duration,
            heat,
            falling: Vec::new(),
            impulse: if traction { impulse } else { Vec::new() },
            symmetric: [false; 2],
        })
    }
}

impl Events for ParticleFilament {}

impl Maxima for ParticleFilament {}

impl Approach for ParticleFilament {
    fn approached(
        &self,
        state: &mut Vec<f64>,
        path: &InputPath,
        (_, ahead): (f64, f64),
    ) -> Vec<(usize, [f64; 2])> {
        let fed = self.sph.fed(state);
        let approached = self.nozzle.approached(path, fed.nozzle, ahead);
        if fed.flowing == 0.0 || approached.is_empty() {
            return Vec::new();
        }
        self.sph.note_late(state);
        approached
    }
}

impl Advice for ParticleFilament {
    fn notes(&self) -> Vec<String> {
        self.notes.iter().map(|note| format!("{}: {note}", self.name)).collect()
    }

    fn warnings(&self, state: &[f64], occasion: Occasion) -> Vec<Warning> {
        if !matches!(occasion, Occasion::Step) {
            return Vec::new();
        }
        let fed = self.sph.fed(state);
        let WallExchange { heat_outside, impulse_outside, .. } = self.sph.exchange(state);
        let beyond = self.traction.is_some() && (heat_outside != 0.0 || impulse_outside[2] != 0.0);
        plan::nozzle_warnings([fed.jump, self.slicing.segment], fed.late == 1.0)
            .chain(beyond.then(warning::strand_beyond_edge))
            .chain(self.sph.freezes_at_outlet(state).then(warning::strand_freezes_at_outlet))
            .map(|finding| finding.at(&self.name).whatever_its_numbers())
            .collect()
    }

    fn watch(&self) -> Option<&Watch> {
        Some(&self.watch)
    }

    fn warm_places(&self, state: &[f64]) -> Option<[WarmPlace; 2]> {
        self.sph.extremes(state)
    }
}

impl Resources for ParticleFilament {
    fn foresee(&self, state: &[f64], dt: f64, allowance: &Allowance) -> Result<(), BodyError> {
        let size = self.sph.particles_in(state) * UNKNOWNS;
        // Fluid at rest allows longer steps than the nozzle.
        let steps = 0.1 * self.expected_steps(dt).0;
        let foreseen = allowance.foresee_step(dt, steps, STEPS, size);
        foreseen.map_err(|halt| BodyError::Halted { body: self.name.clone(), halt })
    }

    fn updates(&self, dt: f64) -> f64 {
        let (steps, particles) = self.expected_steps(dt);
        cost(steps, particles * UNKNOWNS)
    }

    fn threads(&self) -> usize {
        self.threads
    }

    fn steps_are_deep(&self) -> bool {
        true
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Fluid that freezes, or an outlet that dips into the plate, at one time of a motion alone.
    #[test]
    fn motions_are_refused_for_any_of_their_times() {
        let melting = Some(Melting { solidus: 331.0, liquidus: 333.0, latent_heat: 2e5 });
        let motion = |temperature: [f64; 3], height: [f64; 3]| Motion {
            duration: 2.0,
            place: height.map(|derivative| [0.0, 0.0, derivative]),
            temperature,
            ..Motion::default()
        };
        let (warm, high) = ([336.0, 0.0, 0.0], [2e-3, 0.0, 0.0]);
        let refusal =
            |temperature, height| check_motion(&motion(temperature, height), melting, 1e-3).err();
        assert_eq!(refusal(warm, high), None);
        // Over the liquidus in the middle, and below it at the end.
        let cooling = refusal([336.0, -2.5, 0.0], high);
        assert!(matches!(cooling, Some(Failure::Frozen { temperature: 331.0, .. })), "{cooling:?}");
        // Low in the middle, and high at both ends.
        let dipping = refusal(warm, [2e-3, -3e-3, 3e-3]);
        let is_dip = |height: f64| (height - 0.5e-3).abs() < 1e-12;
        assert!(
            matches!(dipping, Some(Failure::NozzleInPlate { height, .. }) if is_dip(height)),
            "{dipping:?}"
        );
    }
}
