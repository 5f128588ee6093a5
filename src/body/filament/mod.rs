//! Filaments: the strand that a moving nozzle lays, with the scene's data that concern it.

mod forecast;
mod motions;
mod particles;
mod plan;
mod totals;
mod warnings;

pub use forecast::FilamentForecast;
pub use particles::ParticleFilament;
pub use plan::refinement;
pub use totals::offered_totals;
pub use warnings::warnings_on_strands;

use crate::body::droplet::Watch;
use crate::body::{
    Acts, Advice, Approach, BodyError, Events, Given, Giver, Link, Maxima, Occasion, Reading,
    Resources, Structured,
};
use crate::inputs::{InputLayout, InputPath};
use crate::laws::Constants;
use crate::method::fem::Plan;
use crate::method::filament::{Around, Deviation, Failure, Line, Segment, Strand, Target};
use crate::method::sph::{ParticleFields, WarmPlace};
use crate::port::{Surface, WallCells};
use crate::runtime::allowance::Allowance;
use crate::scene::{Coupling, Filament, FilamentMethod, Scene};
use crate::state::store_all;
use crate::warning::{self, Warning};

use motions::NozzleInputs;
use totals::Seen;

/// A filament that is laid as a line.
pub struct FilamentBody {
    name: String,
    line: Line,
    nozzle: NozzleInputs,
    /// The strand before time starts.
    start: Strand,
    target: Option<Target>,
    watch: Watch,
    /// True if forces are transferred to a solid below, `None` without one.
    traction: Option<bool>,
    notes: Vec<String>,
}

/// Updates that a segment takes in a step, and the words for them.
const WORK: usize = 40;
const ROUNDS: &str = "steps of segments";

impl FilamentBody {
    /// `on` holds the cells of a body below and the link with it.
    pub fn new(
        scene: &Scene,
        (layout, start): (&InputLayout, &[f64]),
        (name, filament): (&str, &Filament),
        on: Option<(WallCells, &Link)>,
    ) -> Self {
        let conductance = scene.conductance_below(name);
        let traction = on.as_ref().map(|(_, link)| link.traction);
        let line = Line::new(plan::plan_of(filament, on.map(|(cells, _)| cells), conductance));
        let nozzle = NozzleInputs::new(filament, scene.route(filament), layout.of_body(name));
        Self {
            name: name.to_owned(),
            start: line.start(nozzle.start(start)),
            line,
            nozzle,
            target: plan::target_of(scene, name),
            watch: Watch::of(scene, (name, &filament.fluid), filament.fluid.melting.is_some()),
            traction,
            notes: forecast::notes(scene, (name, filament)),
        }
    }

    fn given_of(&self, strand: &Strand) -> Option<Given> {
        let traction = self.traction?;
        Some(Given {
            duration: strand.duration,
            heat: strand.cell_heat.clone(),
            falling: Vec::new(),
            impulse: if traction { strand.cell_impulse.clone() } else { Vec::new() },
            symmetric: [false; 2],
        })
    }

    fn error(&self, failure: Failure) -> BodyError {
        BodyError::Filament { body: self.name.clone(), failure }
    }
}

impl Structured for FilamentBody {
    type State = Strand;
    type View = Seen;

    fn name(&self) -> &str {
        &self.name
    }

    fn start(&self) -> &Strand {
        &self.start
    }

    fn of_length(&self, numbers: usize) -> Option<Strand> {
        self.start.of_length(numbers)
    }

    fn check(&self, state: &Strand) -> Result<(), String> {
        self.line.check(state)
    }

    fn check_inputs(&self, inputs: &[f64]) -> Result<(), BodyError> {
        self.nozzle.check(inputs)
    }

    fn advance(
        &self,
        state: &mut Strand,
        acts: &Acts,
        allowance: &Allowance,
    ) -> Result<Option<Given>, BodyError> {
        let spend = |rounds: f64, segments: usize| {
            let spent = allowance.spend(rounds, ROUNDS, WORK * segments);
            spent.map_err(|halt| BodyError::Halted { body: self.name.clone(), halt })
        };
        spend(1.0, state.len())?;
        let motions = self.nozzle.motions(acts.path, state.time, acts.duration);
        let nothing = Surface::default();
        let around = Around {
            surface: acts.below.unwrap_or(&nothing),
            air: self.nozzle.air(acts.path, state.time, self.line.plan().reference),
        };
        let advanced = self.line.advance(state, &motions, &around);
        let parts = advanced.map_err(|failure| self.error(failure))?;
        if parts > 1 {
            spend((parts - 1) as f64, state.len())?;
        }
        Ok(self.given_of(state))
    }

    fn view(&self, strand: Strand, _: &[f64]) -> Result<Seen, BodyError> {
        let segments: Vec<Segment> = strand.segments().collect();
        let density = self.line.plan().fluid.density;
        Ok(Seen {
            volume: strand.volume,
            mass: density * strand.volume,
            totals: self.line.totals(&strand),
            deviation: (self.target.as_ref())
                .map_or_else(Deviation::default, |target| target.deviation(&segments)),
            segments: segments.len(),
            touch: strand.touch,
            impulse: strand.impulse,
            supplied: strand.supplied,
            given: strand.given,
            lost: strand.lost,
            exchanged: [
                strand.cell_heat.iter().sum(),
                strand.cell_impulse.iter().map(|impulse| impulse[2]).sum(),
            ],
            duration: strand.duration,
            density,
            ..Seen::default()
        })
    }

    fn read(&self, seen: &Seen, reading: &Reading) -> Result<f64, BodyError> {
        let Reading::Total(place) = *reading else { return Err(BodyError::NoSuchReading) };
        Ok(totals::read(place, seen))
    }

    /// Segments are drawn as particles in their middle.
    fn drawn(&self, strand: Strand, _: &[f64]) -> Result<ParticleFields, BodyError> {
        let density = self.line.plan().fluid.density;
        let freezes = self.line.plan().phases().is_some();
        let mut fields = ParticleFields::default();
        for segment in strand.segments() {
            let [x, y] = segment.middle();
            fields.position.push([x, y, segment.base + 0.5 * segment.height()]);
            fields.velocity.push([0.0; 3]);
            fields.mass.push(density * segment.volume);
            fields.width.push(segment.width());
            fields.density.push(density);
            fields.pressure.push(density * self.line.plan().gravity * segment.height());
            fields.temperature.push(self.line.temperature(&segment));
            fields.solid_fraction.extend(freezes.then(|| self.line.frozen(&segment)));
        }
        Ok(fields)
    }
}

impl Giver for FilamentBody {
    fn given(&self, state: &[f64]) -> Option<Given> {
        self.traction?;
        self.given_of(&self.structure(state))
    }
}

impl Events for FilamentBody {}

impl Maxima for FilamentBody {}

impl Approach for FilamentBody {
    fn approached(
        &self,
        state: &mut Vec<f64>,
        path: &InputPath,
        (_, ahead): (f64, f64),
    ) -> Vec<(usize, [f64; 2])> {
        let mut strand = self.structure(state);
        let approached = self.nozzle.approached(path, strand.nozzle, ahead);
        if strand.flowing == 0.0 || approached.is_empty() {
            return Vec::new();
        }
        strand.late = 1.0;
        store_all(&mut strand, state);
        approached
    }
}

impl Advice for FilamentBody {
    fn notes(&self) -> Vec<String> {
        self.notes.iter().map(|note| format!("{}: {note}", self.name)).collect()
    }

    fn warnings(&self, state: &[f64], occasion: Occasion) -> Vec<Warning> {
        if !matches!(occasion, Occasion::Step) {
            return Vec::new();
        }
        let strand = self.structure(state);
        let beyond = self.line.reaches_beyond(&strand).then(warning::strand_beyond_edge);
        let slow = self.line.rise_above_outlet(&strand);
        let slow = slow.map(|rise| warning::nozzle_is_slow(format!("{rise:.1e}")));
        let bearing = self.line.bearing_of_stacks(&strand);
        // Once, and again each time that the load has doubled.
        let yields = (bearing >= 1.0).then(|| {
            let subject = format!("{}: stack_yields {}", self.name, bearing.log2().floor());
            warning::stack_yields(format!("{bearing:.1}")).at(&self.name).of_subject(subject)
        });
        plan::nozzle_warnings([strand.jump, self.line.plan().spacing], strand.late == 1.0)
            .chain(beyond)
            .chain(slow)
            .map(|finding| finding.at(&self.name).whatever_its_numbers())
            .chain(yields)
            .collect()
    }

    fn watch(&self) -> Option<&Watch> {
        Some(&self.watch)
    }

    fn warm_places(&self, state: &[f64]) -> Option<[WarmPlace; 2]> {
        let strand = self.structure(state);
        let place = |segment: Segment| {
            let [x, y] = segment.middle();
            let place = [x, y, segment.base + 0.5 * segment.height()];
            WarmPlace { temperature: self.line.temperature(&segment), place }
        };
        let by_temperature = |a: &WarmPlace, b: &WarmPlace| a.temperature.total_cmp(&b.temperature);
        let coldest = strand.segments().map(place).min_by(by_temperature)?;
        Some([coldest, strand.segments().map(place).max_by(by_temperature)?])
    }
}

impl Resources for FilamentBody {
    fn foresee(&self, state: &[f64], dt: f64, allowance: &Allowance) -> Result<(), BodyError> {
        let work = WORK * self.structure(state).len();
        let foreseen = allowance.foresee_step(dt, 1.0, ROUNDS, work);
        foreseen.map_err(|halt| BodyError::Halted { body: self.name.clone(), halt })
    }
}

/// Part of the time that heat takes to spread along the surface of a solid, to which an exchange is limited.
const ALONG: f64 = 3e-3;
/// Part of the time in which heat crosses a strand, to which every exchange is limited.
const ACROSS: f64 = 0.1;

/// Longest time between two exchanges with the solid below [s]: that of the scene, or `c D²/a ((e + e_f)/e_f)²`. Within
/// an exchange the surface responds as a half space does. So the heat that spreads along it, with the diffusivity a,
/// stays small there, the more so the smaller the rise `e_f/(e + e_f)` of its temperature is. D is the diameter of the
/// nozzle, e and e_f are the effusivities of solid and fluid; of layers, the largest a and the smallest e. With
/// c = 0.003 the heat of strands of wax and solder on glass, copper and FR4 is accurate to 3 % in steps of any length.
/// Segments that lie on others exchange heat with these in parts of that time.
///
/// Strands lose heat to plate and air at once. An exchange much longer than heat takes to cross them would give all of
/// it to the one that takes more at first: 42 % less to the plate after `4 D²/a_f`, with the fluid's diffusivity a_f.
/// So no exchange is longer than `0.1 D²/a_f`, whatever the scene says; at that, heat to the plate differs by 1 % and
/// heat to the air by 5 % from those of the default.
///
/// Particles exchange as often as the nozzle passes one of them, too.
pub fn interval(scene: &Scene, coupling: &Coupling, (filament, plan): (&Filament, &Plan)) -> f64 {
    let of_layer = |share: f64, constants: Constants| {
        let along = filament.nozzle.diameter.powi(2) * constants.heat_capacity();
        ALONG * share * along / constants.conductivity
    };
    let layers = || plan.strata.iter().map(|layer| layer.constants);
    let solid = layers().map(|c| c.effusivity()).fold(f64::INFINITY, f64::min);
    let share = (1.0 + solid / filament.fluid.effusivity()).powi(2);
    let along = layers().map(|c| of_layer(share, c)).fold(f64::INFINITY, f64::min);
    let passing = match filament.method {
        FilamentMethod::Line => f64::INFINITY,
        FilamentMethod::Particles => filament.particle_distance() / scene.fastest_strand(filament),
    };
    let fluid = &filament.fluid;
    let across = filament.nozzle.diameter.powi(2) * fluid.density * fluid.specific_heat;
    coupling.interval.unwrap_or(along.min(passing)).min(ACROSS * across / fluid.conductivity)
}
