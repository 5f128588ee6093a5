//! Values of a lattice as a whole.

use crate::body::{BodyError, Descriptor, Direct, Reading};
use crate::method::lattice::{LatticeMotion, LatticeState, LatticeTotals, MotionTotals};
use crate::quantity::Quantity;
use crate::scene::{Lattice, LatticeControl};

/// A scalar and its reader.
struct Total {
    descriptor: Descriptor,
    of: Offered,
    read: fn(&Seen) -> f64,
}

/// Lattices that offer a total: a prescribed quantity is an input.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Offered {
    All,
    DisplacementFollows,
    OpeningFollows,
    /// Those in equilibrium.
    Resting,
    /// Those with inertia.
    Moving,
}

/// Values of a state, as readings see it.
#[derive(Debug, Clone, Copy, Default)]
pub struct Seen {
    pub totals: LatticeTotals,
    /// [N]
    pub force: f64,
    /// [J]
    pub work: f64,
    pub dissipated: f64,
    pub released: f64,
    pub damped: f64,
    pub kinetic: f64,
    pub fragments: usize,
    pub steps: f64,
    /// Mass of the strip [kg].
    pub mass: f64,
}

impl Seen {
    pub fn at_rest(state: &LatticeState, totals: LatticeTotals, mass: f64) -> Self {
        let LatticeState { force, work, dissipated, released, .. } = *state;
        Self { totals, force, work, dissipated, released, mass, ..Self::default() }
    }

    pub fn in_motion(motion: &LatticeMotion, totals: MotionTotals, mass: f64) -> Self {
        let LatticeMotion { work, dissipated, damped, steps, .. } = *motion;
        let MotionTotals { sums: totals, kinetic_energy: kinetic, fragments } = totals;
        let force = motion.force();
        let released = 0.0;
        Self { totals, force, work, dissipated, released, damped, kinetic, fragments, steps, mass }
    }

    /// Work without cause [J].
    fn drift(&self) -> f64 {
        let gone = self.dissipated + self.released + self.damped;
        self.work - gone - self.totals.elastic_energy - self.kinetic
    }
}

const TOTALS: [Total; 16] = [
    total("force", "load", Quantity::Force, |seen| seen.force),
    of(
        Offered::DisplacementFollows,
        total("displacement", "displacement of the load", Quantity::Displacement, |seen| {
            seen.totals.displacement
        }),
    ),
    of(
        Offered::OpeningFollows,
        total(
            "opening",
            "opening of the notch at the lower face",
            Quantity::Displacement,
            |seen| seen.totals.opening.unwrap_or(0.0),
        ),
    ),
    total("max_damage", "largest damage of a link", Quantity::Ratio, |seen| {
        seen.totals.broken.max_damage
    }),
    total("broken_links", "number of links without force", Quantity::Count, |seen| {
        seen.totals.broken.links as f64
    }),
    total("crack_length", "length of the facets of broken links", Quantity::Length, |seen| {
        seen.totals.broken.length
    }),
    of(
        Offered::Moving,
        total(
            "fragments",
            "number of parts that unbroken links connect",
            Quantity::Count,
            |seen| seen.fragments as f64,
        ),
    ),
    total("elastic_energy", "energy stored in the links", Quantity::Energy, |seen| {
        seen.totals.elastic_energy
    }),
    total("dissipated_energy", "energy that damage has dissipated", Quantity::Energy, |seen| {
        seen.dissipated
    }),
    of(
        Offered::Resting,
        total(
            "released_energy",
            "energy that sudden breaks have turned into motion, which is left out",
            Quantity::Energy,
            |seen| seen.released,
        ),
    ),
    of(
        Offered::Moving,
        total("kinetic_energy", "kinetic energy", Quantity::Energy, |seen| seen.kinetic),
    ),
    of(
        Offered::Moving,
        total(
            "damped_energy",
            "energy that damping and meeting faces of cracks have taken",
            Quantity::Energy,
            |seen| seen.damped,
        ),
    ),
    total("mechanical_work", "work of the load since time zero", Quantity::Energy, |seen| {
        seen.work
    }),
    total(
        "energy_drift",
        "error of the energy balance: mechanical_work less the other energies",
        Quantity::Energy,
        Seen::drift,
    ),
    of(
        Offered::Moving,
        total("steps", "time steps made inside the unit", Quantity::Ratio, |seen| seen.steps),
    ),
    total("mass", "mass", Quantity::Mass, |seen| seen.mass),
];

const fn total(
    key: &'static str,
    words: &'static str,
    quantity: Quantity,
    read: fn(&Seen) -> f64,
) -> Total {
    let descriptor = Descriptor { key, words, quantity, direct: Direct::Nothing };
    Total { descriptor, of: Offered::All, read }
}

const fn of(of: Offered, total: Total) -> Total {
    Total { of, ..total }
}

/// Returns the totals that a lattice offers, each with its place in the table.
pub fn offered_totals(lattice: &Lattice) -> Vec<(usize, Descriptor)> {
    let is_offered = |total: &Total| match total.of {
        Offered::All => true,
        Offered::DisplacementFollows => lattice.control != LatticeControl::Displacement,
        Offered::OpeningFollows => {
            lattice.notch.is_some() && lattice.control != LatticeControl::Opening
        }
        Offered::Resting => !lattice.inertia,
        Offered::Moving => lattice.inertia,
    };
    let places = TOTALS.iter().enumerate().filter(|(_, total)| is_offered(total));
    places.map(|(place, total)| (place, total.descriptor)).collect()
}

/// Reads a total.
pub fn read(reading: &Reading, seen: &Seen) -> Result<f64, BodyError> {
    match *reading {
        Reading::Total(place) => Ok((TOTALS[place].read)(seen)),
        _ => Err(BodyError::NoSuchReading),
    }
}
