//! Bodies of one temperature T: `C dT/dt = P − G (T − T∞) + Q`, with the heat flow Q from solids in contact.
//!
//! Sources are polynomials in time over a step, under which the equation is solved exactly (φ-functions, M. Hochbruck
//! and A. Ostermann 2010, doi 10.1017/S0962492910000048).

use std::any::Any;
use std::ops::Range;

use super::{
    Acts, Body, BodyError, Conductor, Descriptor, Direct, Fields, Given, Linear, Memo, Reading,
    Received,
};
use crate::body::{Advice, Approach, Events, Giver, Maxima, Resources};
use crate::inputs::{InputLayout, InputPath};
use crate::math::exponential;
use crate::method::fem::NodalFields;
use crate::port::{Surface, SurfaceResponse, WallCells};
use crate::quantity::Quantity;
use crate::runtime::allowance::Allowance;
use crate::scene::{FaceName, Reservoir};
use crate::state::{Field, Layout, Per};

/// A reservoir, with the scene's data that concern it.
pub struct ReservoirBody {
    name: String,
    /// C [J/K].
    heat_capacity: f64,
    /// G [W/K].
    conductance: f64,
    /// [K]
    initial_temperature: f64,
    /// Places of the heating among the inputs and, if heat is lost, of the ambient temperature.
    inputs: Range<usize>,
    /// Largest number of cells of a face that touches it.
    cells: usize,
}

/// Length of a state: temperature above the initial one [K], heat supplied and heat lost since time zero [J].
const LEN: usize = 3;

/// Share of the stored or transferred heat that a balance may miss; runs keep the balance to rounding.
const BALANCE: f64 = 1e-6;

/// Diffusivity that represents the uniform temperature of a reservoir, far above that of any conductor [m²/s].
const EVEN: f64 = 1e3;

/// The sources P, T∞ and Q, or their time derivatives.
#[derive(Debug, Clone, Copy, Default)]
struct Sources {
    heating: f64,
    ambient: f64,
    received: f64,
}

const TOTALS: [Descriptor; 4] = [
    Descriptor {
        key: "temperature",
        words: "temperature of the reservoir",
        quantity: Quantity::Temperature,
        direct: Direct::Nothing,
    },
    heat("heat_in", "heat that heating and other bodies have brought in"),
    heat("heat_stored", "heat stored since time zero"),
    heat("heat_lost", "heat that has left to the surroundings"),
];

const fn heat(key: &'static str, words: &'static str) -> Descriptor {
    Descriptor { key, words, quantity: Quantity::Energy, direct: Direct::Nothing }
}

/// Returns the totals that every reservoir offers.
pub fn offered_totals() -> Vec<(usize, Descriptor)> {
    TOTALS.into_iter().enumerate().collect()
}

impl ReservoirBody {
    pub fn new(layout: &InputLayout, (name, reservoir): (&str, &Reservoir), cells: usize) -> Self {
        Self {
            name: name.into(),
            heat_capacity: reservoir.heat_capacity,
            conductance: reservoir.conductance.unwrap_or(0.0),
            initial_temperature: reservoir.initial_temperature,
            inputs: layout.of_body(name),
            cells,
        }
    }

    /// Sources of inputs, or of a time derivative of them.
    fn sources(&self, inputs: &[f64]) -> Sources {
        let own = &inputs[self.inputs.clone()];
        let ambient = own.get(1).copied().unwrap_or_default();
        Sources { heating: own[0], ambient, received: 0.0 }
    }

    /// Returns the sources at the beginning of a step and their time derivatives.
    fn over_step(&self, path: &InputPath, received: &[Received]) -> [Sources; 3] {
        let mut all = [Sources::default(); 3];
        for (sources, inputs) in all.iter_mut().zip(path.derivatives()) {
            *sources = self.sources(inputs);
        }
        for Received { given, .. } in received {
            let falling: f64 = given.falling.iter().sum();
            all[0].received += flow(given) + falling;
            if given.duration > 0.0 {
                all[1].received -= 2.0 * falling / given.duration;
            }
        }
        all
    }

    fn advanced(&self, state: &[f64], path: &InputPath, received: &[Received], h: f64) -> Vec<f64> {
        let sources = self.over_step(path, received);
        let rate = self.conductance / self.heat_capacity;
        let (z, start) = (rate * h, self.initial_temperature);
        let weights = exponential::weights(z);
        // Temperatures are relative to the surroundings if these dominate, and to the initial one otherwise. Then
        // neither the stored nor the lost heat is a small difference of large numbers.
        let rules = z > 1.0;
        let base = |k: usize| match (rules, k) {
            (true, _) => sources.get(k).map_or(0.0, |s| s.ambient),
            (false, 0) => start,
            (false, _) => 0.0,
        };
        let excess =
            |k: usize| if self.conductance > 0.0 { sources[k].ambient - base(k) } else { 0.0 };
        let mut above = weights[0] * (start + state[0] - base(0));
        let mut integral = h * weights[1] * (start + state[0] - base(0));
        if !rules {
            // Bitwise unchanged if nothing acts.
            above = weights[0] * state[0];
            integral = h * weights[1] * state[0];
        }
        let (mut brought, mut of_excess, mut end, mut power) = (0.0, 0.0, 0.0, 1.0);
        for k in 0..sources.len() {
            let inward = sources[k].heating + sources[k].received;
            let source = inward / self.heat_capacity - base(k + 1) + rate * excess(k);
            let h_k = h.powi(k as i32 + 1);
            above += h_k * weights[k + 1] * source;
            integral += h_k * h * weights[k + 2] * source;
            end += power * base(k);
            power *= h / (k + 1) as f64;
            brought += power * inward;
            of_excess += power * excess(k);
        }
        let rise = if rules { above + (end - start) } else { above };
        let lost = self.conductance * (integral - of_excess);
        vec![rise, state[1] + brought, state[2] + lost]
    }

    fn temperature(&self, state: &[f64]) -> f64 {
        self.initial_temperature + state[0]
    }

    /// Returns a total of a state, or of a change of it if temperatures are relative to zero.
    fn total(&self, state: &[f64], from: f64, reading: &Reading) -> Result<f64, BodyError> {
        match reading {
            Reading::Total(0) => Ok(from + state[0]),
            Reading::Total(1) => Ok(state[1]),
            Reading::Total(2) => Ok(self.heat_capacity * state[0]),
            Reading::Total(_) => Ok(state[2]),
            _ => Err(BodyError::NoSuchReading),
        }
    }
}

/// Mean heat flow of a transfer [W].
fn flow(given: &Given) -> f64 {
    let heat: f64 = given.heat.iter().sum();
    if given.duration > 0.0 { heat / given.duration } else { 0.0 }
}

fn sources_of(memo: &Memo) -> Sources {
    let memo: &(dyn Any + Send + Sync) = memo.as_ref();
    *memo.downcast_ref().expect("a memo is that of the body that made it")
}

impl Body for ReservoirBody {
    fn name(&self) -> &str {
        &self.name
    }

    fn initial_state(&self) -> Vec<f64> {
        vec![0.0; LEN]
    }

    fn layout(&self, state: &[f64]) -> Option<Layout> {
        let field = |name, words| Field { name, words, per: Per::Body, width: 1 };
        let layout = Layout::default()
            .with(field("rise", "temperature above the initial one [K]"), 1)
            .with(field("brought_in", "heat brought in since time zero [J]"), 1)
            .with(field("lost", "heat lost since time zero [J]"), 1);
        Some(layout).filter(|layout| layout.len() == state.len())
    }

    fn check_state(&self, state: &[f64], _inputs: &[f64]) -> Result<(), String> {
        let (name, start) = (&self.name, self.initial_temperature);
        let &[rise, brought_in, lost] = state else {
            return Err(format!("{} unknowns of {name}; this body has {LEN}", state.len()));
        };
        if start + rise <= 0.0 {
            return Err(format!("{name} is {rise} K above its initial temperature"));
        }
        let stored = self.heat_capacity * rise;
        let missing = stored - (brought_in - lost);
        let scale = self.heat_capacity * (start + rise) + brought_in.abs() + lost.abs();
        match missing.abs() <= BALANCE * scale {
            true => Ok(()),
            false => {
                Err(format!("{missing:e} J more heat in {name} than was brought in and not lost"))
            }
        }
    }

    fn check_inputs(&self, inputs: &[f64]) -> Result<(), BodyError> {
        match self.inputs.clone().nth(1).filter(|&index| inputs[index] <= 0.0) {
            None => Ok(()),
            Some(index) => {
                let message = format!("{} K is not above absolute zero", inputs[index]);
                Err(BodyError::Input { index, message })
            }
        }
    }

    fn memo(&self, inputs: &[f64], received: &[Received]) -> Memo {
        let received = received.iter().map(|received| flow(received.given)).sum();
        Box::new(Sources { received, ..self.sources(inputs) })
    }

    fn advance(
        &self,
        state: &mut Vec<f64>,
        _: &Memo,
        acts: &Acts,
        _: &Allowance,
    ) -> Result<Option<Given>, BodyError> {
        *state = self.advanced(state, acts.path, acts.received, acts.duration);
        if !state.iter().all(|value| value.is_finite()) {
            return Err(BodyError::Overflow { body: self.name.clone() });
        }
        let temperature = self.temperature(state);
        if temperature <= 0.0 {
            return Err(BodyError::BelowAbsoluteZero { body: self.name.clone(), temperature });
        }
        Ok(None)
    }

    fn read(&self, state: &[f64], _: &mut Memo, reading: &Reading) -> Result<f64, BodyError> {
        self.total(state, self.initial_temperature, reading)
    }

    fn fields(&self, _: &[f64], _: &mut Memo) -> Result<Fields, BodyError> {
        Ok(Fields::Nodes(NodalFields::default()))
    }

    fn linear(&self) -> Option<&dyn Linear> {
        Some(self)
    }

    fn conductor(&self) -> Option<&dyn Conductor> {
        Some(self)
    }
}

impl Giver for ReservoirBody {}

impl Events for ReservoirBody {}

impl Maxima for ReservoirBody {}

impl Approach for ReservoirBody {}

impl Advice for ReservoirBody {}

impl Resources for ReservoirBody {}

impl Conductor for ReservoirBody {
    fn response(&self, _: FaceName, area: f64) -> SurfaceResponse {
        let rate = self.conductance / self.heat_capacity;
        SurfaceResponse { rates: vec![rate], gains: vec![area / self.heat_capacity] }
    }

    fn diffusivity(&self, _: FaceName) -> f64 {
        EVEN
    }

    fn tolerance(&self) -> f64 {
        0.0
    }

    fn cells(&self, _: FaceName) -> Option<WallCells> {
        None
    }

    fn surfaces(
        &self,
        state: &[f64],
        _: &Memo,
        faces: &[FaceName],
        _: &Acts,
        _: &Allowance,
    ) -> Result<Vec<Surface>, BodyError> {
        let held = Surface::held(&vec![self.temperature(state); self.cells]);
        Ok(vec![held; faces.len()])
    }

    fn temperatures_after(
        &self,
        state: &[f64],
        _: &Memo,
        faces: &[FaceName],
        acts: &Acts,
        _: &Allowance,
    ) -> Result<Vec<Vec<f64>>, BodyError> {
        let later = self.advanced(state, acts.path, acts.received, acts.duration);
        Ok(vec![vec![self.temperature(&later); self.cells]; faces.len()])
    }
}

impl Linear for ReservoirBody {
    fn change(&self, _: &[f64], rates: &[f64]) -> Memo {
        Box::new(self.sources(rates))
    }

    fn rates(&self, state: &[f64], memo: &Memo, _: &Memo) -> Vec<f64> {
        let Sources { heating, ambient, received } = sources_of(memo);
        let lost = match self.conductance > 0.0 {
            true => self.conductance * (self.temperature(state) - ambient),
            false => 0.0,
        };
        let brought = heating + received;
        vec![(brought - lost) / self.heat_capacity, brought, lost]
    }

    fn read_rate(
        &self,
        _: (&[f64], &mut Memo),
        (rates, _): (&[f64], &mut Memo),
        reading: &Reading,
    ) -> Result<f64, BodyError> {
        self.total(rates, 0.0, reading)
    }
}
