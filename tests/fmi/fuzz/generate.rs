//! Random scripts: calls that go well together, with odd ones among them.

use std::ffi::c_int;

use fastrand::Rng;
use impinge::variables::Causality;

use super::call::{Birth, Call, INSTANCES, Line, Nulls, PLACES, Place, Point, StateCall};
use super::world::{Kind, World};
use crate::functions::{EXCHANGE, STATUS};

const PLAIN: [&str; 6] = [
    "fmi2EnterInitializationMode",
    "fmi2ExitInitializationMode",
    "fmi2Terminate",
    "fmi2Reset",
    "fmi2CancelStep",
    "fmi2EnterInitializationMode",
];

/// Values that programs trip over.
const ODD: [f64; 20] = [
    f64::NAN,
    f64::INFINITY,
    f64::NEG_INFINITY,
    f64::MAX,
    f64::MIN,
    f64::MIN_POSITIVE,
    5e-324,
    0.0,
    -0.0,
    -1.0,
    1.0,
    1e-300,
    1e-60,
    1e9,
    1e60,
    2_147_483_647.0,
    -2_147_483_648.0,
    0.5,
    0.4999999999999999,
    -0.9999999999999999,
];

/// Texts for `output.directory`, none of which can become a folder.
const TEXTS: [Option<&[u8]>; 5] = [
    Some(b""),
    Some(b"/dev/null/fields"),
    Some(b"\xff\xfe"),
    None,
    Some("/dev/null/ü %s%n".as_bytes()),
];

/// A script that a seed stands for.
pub fn script(world: &World, seed: u64, length: usize) -> Vec<Line> {
    let mut random = Random { world, rng: Rng::with_seed(seed) };
    // Where a master that makes no mistakes would be: the phase of each instance.
    let mut phases = [' '; INSTANCES];
    (0..length).map(|_| random.line(&mut phases)).collect()
}

struct Random<'a> {
    world: &'a World,
    rng: Rng,
}

impl Random<'_> {
    fn line(&mut self, phases: &mut [char; INSTANCES]) -> Line {
        let instance = self.rng.usize(..INSTANCES);
        let phase = &mut phases[instance];
        let call = if *phase == ' ' && self.chance(0.95) {
            Call::Instantiate(Birth::Good)
        } else if self.chance(0.3) {
            self.onward(*phase)
        } else {
            self.any(instance)
        };
        *phase = match &call {
            Call::Instantiate(Birth::Good) => 'i',
            Call::Instantiate(_) | Call::Free => ' ',
            Call::Plain("fmi2EnterInitializationMode") if *phase == 'i' => 'm',
            Call::Plain("fmi2ExitInitializationMode") if *phase == 'm' => 's',
            Call::Plain("fmi2Terminate") if *phase == 's' => 't',
            Call::Plain("fmi2Reset") => 'i',
            _ => *phase,
        };
        Line { instance, call, watched: self.chance(0.3) }
    }

    /// What comes next in the life of an instance.
    fn onward(&mut self, phase: char) -> Call {
        match phase {
            'i' if self.chance(0.4) => {
                let stop = self.chance(0.3).then_some(1e-5);
                Call::Setup { tolerance: None, start: 0.0, stop }
            }
            'i' => Call::Plain("fmi2EnterInitializationMode"),
            'm' => Call::Plain("fmi2ExitInitializationMode"),
            's' if self.chance(0.05) => Call::Plain("fmi2Terminate"),
            's' => Call::Step { point: Point::Here, size: self.size() },
            _ => Call::Plain("fmi2Reset"),
        }
    }

    fn any(&mut self, own: usize) -> Call {
        match self.rng.u32(..100) {
            0 => Call::Free,
            1 => Call::Instantiate(self.birth()),
            2..6 => Call::Plain(self.one_of(&PLAIN)),
            6..8 => Call::Exchange(self.one_of(&EXCHANGE)),
            8..11 => self.logging(),
            11..16 => self.setup(),
            16..34 => self.get(),
            34..56 => self.set(),
            56..60 => self.set_texts(),
            60..74 => Call::Step { point: self.point(), size: self.size() },
            74..79 => self.status(),
            79..92 => Call::State(self.state(own)),
            92..95 => self.directional(),
            95..96 => self.input_derivatives(),
            _ => self.output_derivatives(),
        }
    }

    fn chance(&mut self, part: f64) -> bool {
        self.rng.f64() < part
    }

    fn one_of<T: Copy>(&mut self, choices: &[T]) -> T {
        choices[self.rng.usize(..choices.len())]
    }

    fn birth(&mut self) -> Birth {
        self.one_of(&[
            Birth::Good,
            Birth::NoCallbacks,
            Birth::NoName,
            Birth::NoGuid,
            Birth::OtherGuid,
            Birth::NoResources,
            Birth::ForModelExchange,
        ])
    }

    fn nulls(&mut self) -> Nulls {
        match self.rng.u32(..40) {
            0 => Nulls::References,
            1 => Nulls::Values,
            2 => Nulls::AllOfMany,
            _ => Nulls::None,
        }
    }

    fn logging(&mut self) -> Call {
        let names = ["logAll", "logStatusError", "logStatusWarning", "model", "gossip"];
        let count = self.rng.usize(..3);
        let categories = (0..count).map(|_| self.one_of(&names)).collect();
        Call::Logging { on: self.rng.bool(), categories, nulls: self.nulls() }
    }

    fn setup(&mut self) -> Call {
        let tolerance = self.chance(0.3).then(|| self.one_of(&[1e-6, 0.0, f64::NAN, -1.0, 1.0]));
        let start = if self.chance(0.6) { 0.0 } else { self.one_of(&ODD) };
        let stop =
            self.chance(0.4).then(|| if self.chance(0.7) { 1e-6 } else { self.one_of(&ODD) });
        Call::Setup { tolerance, start, stop }
    }

    fn size(&mut self) -> f64 {
        match self.rng.u32(..20) {
            0 => self.one_of(&ODD),
            1 => self.one_of(&[-1e-8, 1e-30, 1e-3, 1e4, 1e300]),
            _ => 10_f64.powf(-9.0 + 3.0 * self.rng.f64()),
        }
    }

    fn point(&mut self) -> Point {
        match self.rng.u32(..12) {
            0 => Point::Off(self.one_of(&[1e-12, 1e-9, 0.5, 1.0, -1.0, 1e9])),
            1 => Point::At(self.one_of(&ODD)),
            _ => Point::Here,
        }
    }

    /// A reference of this kind, or seldom any other, or none at all.
    fn reference(&mut self, kind: Kind) -> u32 {
        let known = self.world.references(kind);
        let count = self.world.variables.len() as u32;
        match self.rng.u32(..60) {
            0 => self.one_of(&[count, count + 1, u32::MAX, i32::MAX as u32]),
            1 => self.rng.u32(..count),
            _ if known.is_empty() => self.rng.u32(..count),
            _ => self.one_of(&known),
        }
    }

    fn references(&mut self, kind: Kind) -> Vec<u32> {
        // Mostly few, sometimes more than there are variables.
        let count = if self.chance(0.02) { 1000 } else { self.rng.usize(..6) };
        (0..count).map(|_| self.reference(kind)).collect()
    }

    fn reals_of(&mut self, causality: Causality) -> Vec<u32> {
        let known = self.world.reals_of(|other| other == causality);
        let count = self.rng.usize(..5);
        let pick = |random: &mut Self| match random.chance(0.03) {
            true => random.reference(Kind::Real),
            false => random.one_of(&known),
        };
        (0..count).map(|_| pick(self)).collect()
    }

    fn kind(&mut self) -> Kind {
        match self.rng.u32(..10) {
            0 => Kind::Boolean,
            1 => Kind::Integer,
            2 => Kind::String,
            _ => Kind::Real,
        }
    }

    fn get(&mut self) -> Call {
        let kind = self.kind();
        Call::Get { kind, references: self.references(kind), nulls: self.nulls() }
    }

    fn set(&mut self) -> Call {
        let kind = match self.kind() {
            Kind::String => Kind::Real,
            other => other,
        };
        let causality = if self.chance(0.7) { Causality::Input } else { Causality::Parameter };
        let references = match self.chance(0.7) && kind == Kind::Real {
            true => self.reals_of(causality),
            false => self.references(kind),
        };
        let values = references.iter().map(|&reference| self.value(reference)).collect();
        Call::Set { kind, references, values, nulls: self.nulls() }
    }

    fn value(&mut self, reference: u32) -> f64 {
        if self.chance(0.03) {
            return self.one_of(&ODD);
        }
        let (low, high) = self.world.plain_values(reference);
        // A few values only, so that equal models meet in the cache.
        low + (high - low) * f64::from(self.rng.u32(..4)) / 4.0
    }

    fn set_texts(&mut self) -> Call {
        let references = self.references(Kind::String);
        let values = references
            .iter()
            .map(|_| if self.chance(0.7) { Some(&b""[..]) } else { self.one_of(&TEXTS) })
            .collect();
        Call::SetTexts { references, values, nulls: self.nulls() }
    }

    fn status(&mut self) -> Call {
        let kind = self.one_of(&[0, 1, 2, 2, 2, 3, 4, -1, c_int::MAX]);
        Call::Status { name: self.one_of(&STATUS), kind, null: self.chance(0.1) }
    }

    /// A place of the instance, seldom of another one.
    fn place(&mut self, own: usize) -> Place {
        let instance = if self.chance(0.9) { own } else { self.rng.usize(..INSTANCES) };
        (instance, self.rng.usize(..PLACES))
    }

    fn state(&mut self, own: usize) -> StateCall {
        match self.rng.u32(..16) {
            0..4 => StateCall::Save { into: self.place(own) },
            4..8 => StateCall::Restore { from: self.place(own) },
            8 => StateCall::Free { of: self.place(own) },
            9..12 => {
                let room = self.one_of(&[0, 0, 0, 7, -1, isize::MIN]);
                StateCall::Serialize { of: self.place(own), room }
            }
            12..15 => {
                let cut = self.one_of(&[0, 0, 0, 0, 0, 1, 9, usize::MAX]);
                let changed = self.chance(0.1).then(|| self.rng.usize(..4096));
                let bytes = self.place(own);
                StateCall::Deserialize { bytes, into: self.place(own), cut, changed }
            }
            _ => StateCall::SaveNowhere,
        }
    }

    fn directional(&mut self) -> Call {
        let (unknowns, knowns) =
            (self.reals_of(Causality::Output), self.reals_of(Causality::Input));
        let change = |random: &mut Self| match random.chance(0.05) {
            true => random.one_of(&ODD),
            false => 2.0 * random.rng.f64() - 1.0,
        };
        let changes = knowns.iter().map(|_| change(self)).collect();
        Call::Directional { unknowns, knowns, changes, nulls: self.nulls() }
    }

    fn input_derivatives(&mut self) -> Call {
        let references = self.reals_of(Causality::Input);
        let orders = self.orders(references.len());
        let values = references.iter().map(|_| self.one_of(&[0.0, 1.0, -1e3, f64::NAN])).collect();
        Call::InputDerivatives { references, orders, values, nulls: self.nulls() }
    }

    fn output_derivatives(&mut self) -> Call {
        let references = self.reals_of(Causality::Output);
        let orders = self.orders(references.len());
        Call::OutputDerivatives { references, orders, nulls: self.nulls() }
    }

    fn orders(&mut self, count: usize) -> Vec<c_int> {
        (0..count).map(|_| self.one_of(&[1, 1, 1, 1, 1, 1, 0, 2, -1, c_int::MAX])).collect()
    }
}
