//! Values of a lattice as a whole.

use crate::body::{Descriptor, Direct};
use crate::method::lattice::{LatticeState, LatticeTotals};
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
}

/// A state with its sums, as readings see it.
pub struct Seen<'a> {
    pub state: &'a LatticeState,
    pub totals: &'a LatticeTotals,
    /// Mass of the strip [kg].
    pub mass: f64,
}

const TOTALS: [Total; 12] = [
    total("force", "load", Quantity::Force, |seen| seen.state.force),
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
    total("max_damage", "largest damage of a link", Quantity::Ratio, |seen| seen.totals.max_damage),
    total("broken_links", "number of links without force", Quantity::Count, |seen| {
        seen.totals.broken_links as f64
    }),
    total("crack_length", "length of the facets of broken links", Quantity::Length, |seen| {
        seen.totals.crack_length
    }),
    total("elastic_energy", "energy stored in the links", Quantity::Energy, |seen| {
        seen.totals.elastic_energy
    }),
    total("dissipated_energy", "energy that damage has dissipated", Quantity::Energy, |seen| {
        seen.state.dissipated
    }),
    total(
        "released_energy",
        "energy that sudden breaks have turned into motion, which is left out",
        Quantity::Energy,
        |seen| seen.state.released,
    ),
    total("mechanical_work", "work of the load since time zero", Quantity::Energy, |seen| {
        seen.state.work
    }),
    total(
        "energy_drift",
        "error of the energy balance: mechanical_work less the other energies",
        Quantity::Energy,
        |seen| {
            let state = seen.state;
            state.work - state.dissipated - state.released - seen.totals.elastic_energy
        },
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
    };
    let places = TOTALS.iter().enumerate().filter(|(_, total)| is_offered(total));
    places.map(|(place, total)| (place, total.descriptor)).collect()
}

/// Reads the total at a place of the table.
pub fn read(place: usize, seen: &Seen) -> f64 {
    (TOTALS[place].read)(seen)
}
