//! Readings of a whole solid.

use super::linear::SolidChange;
use super::reader::SolidReader;
use crate::body::{BodyError, Descriptor, Direct};
use crate::quantity::Quantity;
use crate::scene::{Scene, Solid};

/// A scalar of a whole solid, with the readers of its value and rate.
struct Total {
    descriptor: Descriptor,
    of: Offered,
    read: fn(&mut SolidReader) -> Result<f64, BodyError>,
    rate: fn(&mut SolidChange) -> Result<f64, BodyError>,
}

/// Solids that offer a total.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Offered {
    All,
    /// Those whose heat particles conduct.
    OfParticles,
    /// Those with a melting layer.
    Melting,
    /// Those that yield.
    Yielding,
    /// Those whose moduli relax.
    Relaxing,
    /// Those that crack, and among them plane sections and bodies in space.
    Cracking,
    CrackingSections,
    CrackingInSpace,
    /// Plane sections that crack and have notches.
    Notched,
    /// Those whose mechanics is modelled.
    Mechanical,
    /// Those with a distribution of flaws.
    Breaking,
}

const TOTALS: [Total; 32] = [
    Total {
        descriptor: Descriptor {
            key: "max_temperature",
            words: "highest temperature of the body",
            quantity: Quantity::Temperature,
            direct: Direct::Temperatures,
        },
        of: Offered::All,
        read: |reader| Ok(reader.max_temperature()),
        rate: |both| Ok(both.max_temperature_rate()),
    },
    Total {
        descriptor: heat("heat_in", "heat that loads and prescribed fluxes have brought in"),
        of: Offered::All,
        read: |reader| Ok(reader.heat_totals().brought_in),
        rate: |both| Ok(both.change.heat_totals().brought_in),
    },
    Total {
        descriptor: heat("heat_stored", "heat stored since time zero"),
        of: Offered::All,
        read: |reader| Ok(reader.heat_stored()),
        rate: |both| Ok(both.change.heat_stored()),
    },
    Total {
        descriptor: heat(
            "heat_lost",
            "heat that has left through convective and prescribed-temperature faces",
        ),
        of: Offered::All,
        read: |reader| Ok(reader.heat_totals().lost),
        rate: |both| Ok(both.change.heat_totals().lost),
    },
    Total {
        descriptor: heat(
            "heat_drift",
            "error of the heat balance: heat stored less what came in and was not lost",
        ),
        of: Offered::OfParticles,
        read: |reader| Ok(reader.heat_drift()),
        rate: |both| Ok(both.change.heat_drift()),
    },
    Total {
        descriptor: Descriptor {
            key: "fallback_particles",
            words: "particles that conduct by the plain operator because the corrected one is near singular",
            quantity: Quantity::Ratio,
            direct: Direct::Nothing,
        },
        of: Offered::OfParticles,
        read: |reader| Ok(reader.fallback_particles()),
        rate: |_| Ok(0.0),
    },
    Total {
        descriptor: Descriptor {
            key: "liquid_volume",
            words: "volume that is liquid",
            quantity: Quantity::Volume,
            direct: Direct::Nothing,
        },
        of: Offered::Melting,
        read: |reader| Ok(reader.liquid_volume()),
        rate: |_| Err(BodyError::NoRate),
    },
    Total {
        descriptor: Descriptor {
            key: "max_plastic_strain",
            words: "largest accumulated plastic strain",
            quantity: Quantity::Ratio,
            direct: Direct::Nothing,
        },
        of: Offered::Yielding,
        read: |reader| Ok(reader.max_plastic_strain()),
        rate: |_| Err(BodyError::NoRate),
    },
    Total {
        descriptor: heat(
            "plastic_work",
            "energy that yielding has dissipated, without what hardening stores",
        ),
        of: Offered::Yielding,
        read: |reader| Ok(reader.plastic_work()),
        rate: |_| Err(BodyError::NoRate),
    },
    Total {
        descriptor: heat("dissipated", "energy that relaxation has dissipated"),
        of: Offered::Relaxing,
        read: |reader| Ok(reader.relaxation_loss()),
        rate: |_| Err(BodyError::NoRate),
    },
    Total {
        descriptor: heat("stored", "elastic energy of the body"),
        of: Offered::Relaxing,
        read: |reader| reader.stored_energy(),
        rate: |_| Err(BodyError::NoRate),
    },
    of_cracks("max_damage", "largest damage, 0 intact to 1 broken", Quantity::Ratio, |reader| {
        Ok(reader.max_damage())
    }),
    of_cracks(
        "crack_area",
        "area of notches and cracks: of cracks the energy that damage has dissipated over that per area",
        Quantity::Area,
        |reader| Ok(reader.crack_area()),
    ),
    Total {
        of: Offered::CrackingSections,
        ..of_cracks(
            "crack_length",
            "length of notches and cracks in the section: their area over the width of the body",
            Quantity::Length,
            |reader| Ok(reader.crack_length()),
        )
    },
    Total {
        of: Offered::Notched,
        ..of_cracks(
            "crack_growth",
            "length of cracks in the section beyond notches, 0 until a place outside of these is broken",
            Quantity::Length,
            |reader| Ok(reader.crack_growth()),
        )
    },
    of_cracks(
        "crack_count",
        "number of cracks: connected places where damage is 0.9 or more",
        Quantity::Count,
        |reader| Ok(reader.crack_count()),
    ),
    of_cracks(
        "first_crack_time",
        "time from the start to the first crack, 0 until then",
        Quantity::Time,
        |reader| Ok(reader.time_of_first_crack()),
    ),
    of_cracks(
        "first_crack_x",
        "x, or the radius in a disc, of the place outside of notches that broke first, 0 until then",
        Quantity::Length,
        |reader| Ok(reader.place_of_first_crack(0)),
    ),
    Total {
        of: Offered::CrackingInSpace,
        ..of_cracks(
            "first_crack_y",
            "y of the place that broke first, 0 until then",
            Quantity::Length,
            |reader| Ok(reader.place_of_first_crack(1)),
        )
    },
    of_cracks(
        "first_crack_z",
        "z of the place outside of notches that broke first, 0 until then",
        Quantity::Length,
        |reader| Ok(reader.place_of_first_crack(2)),
    ),
    of_cracks(
        "crack_depth",
        "depth of the deepest crack, where damage is 0.9 or more, from the face at which it begins",
        Quantity::Length,
        |reader| Ok(reader.crack_depth()),
    ),
    of_cracks(
        "dissipated_energy",
        "energy that damage has dissipated",
        Quantity::Energy,
        |reader| Ok(reader.energies().dissipated),
    ),
    of_cracks("elastic_energy", "elastic energy of the body", Quantity::Energy, |reader| {
        Ok(reader.energies().elastic)
    }),
    of_cracks(
        "mechanical_work",
        "work that loads and thermal strain have done on the body: elastic and dissipated energy, and what jumps of \
         cracks have freed",
        Quantity::Energy,
        |reader| Ok(reader.work_of_cracks()),
    ),
    Total {
        descriptor: stress("max_von_mises", "highest von Mises stress of the body"),
        of: Offered::Mechanical,
        read: |reader| Ok(reader.max_stress()?[0]),
        rate: |both| Ok(both.max_stress_rate()?[0]),
    },
    Total {
        descriptor: stress(
            "max_principal",
            "largest principal stress of the body, tension positive",
        ),
        of: Offered::Mechanical,
        read: |reader| Ok(reader.max_stress()?[1]),
        rate: |both| Ok(both.max_stress_rate()?[1]),
    },
    risk(
        "failure_probability",
        "probability that the body has failed by the largest stress of every place so far",
        |reader| Ok(reader.risk_so_far()?.probability()),
    ),
    risk(
        "failure_risk",
        "number B of failures expected from the largest stress of every place so far",
        |reader| Ok(reader.risk_so_far()?.value),
    ),
    Total {
        descriptor: Descriptor {
            direct: Direct::TemperaturesAndTractions,
            ..risk_descriptor(
                "present_failure_risk",
                "number of failures expected from the present stress",
            )
        },
        of: Offered::Breaking,
        read: |reader| reader.present_risk(),
        rate: |both| both.present_risk_rate(),
    },
    place_of_risk(
        "failure_place_x",
        "x of the place of the largest failure density so far",
        |reader| Ok(reader.risk_so_far()?.at[0]),
    ),
    place_of_risk(
        "failure_place_y",
        "y of the place of the largest failure density so far",
        |reader| Ok(reader.risk_so_far()?.at[1]),
    ),
    place_of_risk(
        "failure_place_z",
        "z of the place of the largest failure density so far",
        |reader| Ok(reader.risk_so_far()?.at[2]),
    ),
];

/// Reader of a total.
type Read = fn(&mut SolidReader) -> Result<f64, BodyError>;

const fn risk_descriptor(key: &'static str, words: &'static str) -> Descriptor {
    Descriptor { key, words, quantity: Quantity::Ratio, direct: Direct::Nothing }
}

const fn risk(key: &'static str, words: &'static str, read: Read) -> Total {
    let descriptor = risk_descriptor(key, words);
    Total { descriptor, of: Offered::Breaking, read, rate: |_| Err(BodyError::NoRate) }
}

const fn place_of_risk(key: &'static str, words: &'static str, read: Read) -> Total {
    let descriptor = Descriptor { quantity: Quantity::Length, ..risk_descriptor(key, words) };
    Total { descriptor, of: Offered::Breaking, read, rate: |_| Err(BodyError::NoRate) }
}

const fn of_cracks(
    key: &'static str,
    words: &'static str,
    quantity: Quantity,
    read: Read,
) -> Total {
    let descriptor = Descriptor { key, words, quantity, direct: Direct::Nothing };
    Total { descriptor, of: Offered::Cracking, read, rate: |_| Err(BodyError::NoRate) }
}

const fn heat(key: &'static str, words: &'static str) -> Descriptor {
    Descriptor { key, words, quantity: Quantity::Energy, direct: Direct::Nothing }
}

const fn stress(key: &'static str, words: &'static str) -> Descriptor {
    let direct = Direct::TemperaturesAndTractions;
    Descriptor { key, words, quantity: Quantity::Stress, direct }
}

/// The totals that a solid of a scene offers, each with its place in the table.
pub fn offered_totals(scene: &Scene, (name, solid): (&str, &Solid)) -> Vec<(usize, Descriptor)> {
    let is_offered = |total: &Total| match total.of {
        Offered::All => true,
        Offered::OfParticles => solid.sph().is_some(),
        Offered::Melting => solid.melts(),
        Offered::Yielding => solid.yields() && scene.asks_mechanics(name),
        Offered::Relaxing => solid.relaxes() && scene.asks_mechanics(name),
        Offered::Mechanical => scene.asks_mechanics(name),
        Offered::Cracking => solid.cracks(),
        Offered::CrackingSections => solid.cracks() && solid.section.is_some(),
        Offered::CrackingInSpace => solid.cracks_in_space(),
        Offered::Notched => solid.cracks() && solid.section.is_some() && !solid.notches.is_empty(),
        Offered::Breaking => solid.has_flaws(),
    };
    let totals = TOTALS.iter().enumerate().filter(|(_, total)| is_offered(total));
    totals.map(|(place, total)| (place, total.descriptor)).collect()
}

pub fn direct(place: usize) -> Direct {
    TOTALS[place].descriptor.direct
}

pub fn is_mechanical(place: usize) -> bool {
    matches!(TOTALS[place].of, Offered::Mechanical | Offered::Relaxing)
}

/// Returns true for the highest von Mises stress.
pub fn is_von_mises(place: usize) -> bool {
    TOTALS[place].descriptor.key == "max_von_mises"
}

/// Returns true for risks of failure.
pub fn is_risk(place: usize) -> bool {
    TOTALS[place].of == Offered::Breaking
}

pub fn read(reader: &mut SolidReader, place: usize) -> Result<f64, BodyError> {
    (TOTALS[place].read)(reader)
}

pub fn rate(both: &mut SolidChange, place: usize) -> Result<f64, BodyError> {
    (TOTALS[place].rate)(both)
}
