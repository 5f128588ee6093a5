//! Readings of flaws: stress intensity, energy release rate, safety, and the depth if it is searched.

use super::SolidBody;
use super::crack::{Crack, Intensity};
use super::linear::SolidChange;
use super::reader::SolidReader;
use crate::body::{BodyError, Descriptor, Direct};
use crate::quantity::Quantity;
use crate::scene::{Flaw, FlawGives};

/// A quantity of a flaw.
struct FlawQuantity {
    descriptor: Descriptor,
    of: Offered,
    read: fn(&mut SolidReader, &Crack, Intensity) -> f64,
    /// Rate of change, from the intensity and its rate.
    rate: fn(&Crack, Intensity, f64) -> Option<f64>,
}

/// Flaws that offer a quantity.
enum Offered {
    /// Those that give it.
    By(FlawGives),
    /// Those whose depth is searched.
    Searched,
    /// Those that grow.
    Growing,
}

const QUANTITIES: [FlawQuantity; 5] = [
    FlawQuantity {
        descriptor: descriptor(
            "stress_intensity",
            "stress intensity, zero where it is closed,",
            Quantity::StressIntensity,
        ),
        of: Offered::By(FlawGives::StressIntensity),
        read: |_, _, own| own.value,
        rate: |_, _, rate| Some(rate),
    },
    FlawQuantity {
        descriptor: descriptor(
            "energy_release_rate",
            "energy release rate in plane strain",
            Quantity::EnergyPerArea,
        ),
        of: Offered::By(FlawGives::EnergyReleaseRate),
        read: |reader, crack, own| crack.energy_release_rate(reader, own),
        rate: |crack, own, rate| Some(crack.energy_release_change(own.value, rate)),
    },
    FlawQuantity {
        descriptor: descriptor(
            "safety",
            "toughness over stress intensity, at most 1e6,",
            Quantity::Ratio,
        ),
        of: Offered::By(FlawGives::Safety),
        read: |_, crack, own| crack.safety(own.value),
        rate: |crack, own, rate| Some(crack.safety_change(own.value, rate)),
    },
    FlawQuantity {
        descriptor: descriptor("depth", "depth of highest stress intensity", Quantity::Length),
        of: Offered::Searched,
        read: |_, _, own| own.depth,
        rate: |_, _, _| None,
    },
    FlawQuantity {
        descriptor: Descriptor {
            direct: Direct::Nothing,
            ..descriptor("grown_depth", "depth after slow growth", Quantity::Length)
        },
        of: Offered::Growing,
        read: |_, _, own| own.depth,
        rate: |_, _, _| None,
    },
];

const fn descriptor(key: &'static str, words: &'static str, quantity: Quantity) -> Descriptor {
    Descriptor { key, words, quantity, direct: Direct::TemperaturesAndTractions }
}

/// Returns the quantities that a flaw offers, each with its place among all.
pub fn flaw_quantities(flaw: &Flaw) -> Vec<(usize, Descriptor)> {
    let is_offered = |quantity: &FlawQuantity| match quantity.of {
        Offered::By(gives) => flaw.gives.contains(&gives),
        Offered::Searched => flaw.depth.given().is_none(),
        Offered::Growing => flaw.growth.is_some(),
    };
    let all = QUANTITIES.iter().enumerate().filter(|(_, quantity)| is_offered(quantity));
    all.map(|(place, quantity)| (place, quantity.descriptor)).collect()
}

/// Returns true if a quantity is the depth that was searched.
pub(super) fn is_worst_depth(quantity: usize) -> bool {
    matches!(QUANTITIES[quantity].of, Offered::Searched)
}

impl SolidBody {
    /// A flaw, by its place among the scene's.
    pub(super) fn crack(&self, flaw: usize) -> Result<&Crack, BodyError> {
        let found = self.place_of_flaw(flaw).ok_or(BodyError::NoSuchReading)?;
        Ok(&self.cracks[found].1)
    }

    /// Place of a flaw among the body's, which are listed in the scene's order.
    pub(super) fn place_of_flaw(&self, flaw: usize) -> Option<usize> {
        self.cracks.binary_search_by_key(&flaw, |(place, _)| *place).ok()
    }
}

/// Signed stress intensity of a flaw of given depth, by its row or a solution; `None` if the depth is searched or
/// grows.
fn signed(reader: &mut SolidReader, crack: &Crack, flaw: usize) -> Result<Option<f64>, BodyError> {
    if let Some(value) = reader.flaw_by_row(flaw) {
        return value.map(Some);
    }
    match reader.flaw_by_nodes(flaw) {
        Some(value) => value.map(Some),
        None => crack.signed(reader),
    }
}

/// Reads a quantity of a flaw, by the place of the flaw among the scene's.
pub fn read(reader: &mut SolidReader, flaw: usize, quantity: usize) -> Result<f64, BodyError> {
    let crack = reader.body.crack(flaw)?;
    let grown = reader.body.grown_depth(reader.state, flaw);
    let intensity = match (grown, signed(reader, crack, flaw)?) {
        (Some(depth), _) => crack.at_depth(reader, depth)?,
        (None, Some(signed)) => crack.opened(signed),
        (None, None) => crack.worst(reader)?,
    };
    Ok((QUANTITIES[quantity].read)(reader, crack, intensity))
}

/// Rate of change of a quantity of a flaw of given depth. A closed crack stays closed, unless it is about to open.
pub fn rate(both: &mut SolidChange, flaw: usize, quantity: usize) -> Result<f64, BodyError> {
    let body = both.now.body;
    let crack = body.crack(flaw)?;
    let Some(now) = signed(&mut both.now, crack, flaw)? else { return Err(BodyError::NoRate) };
    let change = signed(&mut both.change, crack, flaw)?.unwrap_or(0.0);
    let change = match now {
        now if now > 0.0 => change,
        0.0 => change.max(0.0),
        _ => 0.0,
    };
    let rate = (QUANTITIES[quantity].rate)(crack, crack.opened(now), change);
    rate.ok_or(BodyError::NoRate)
}
