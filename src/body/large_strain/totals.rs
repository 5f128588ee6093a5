//! Readings of solids of large strain.

use super::snapshot::Snapshot;
use super::warming::HeatTotals;
use crate::body::{Descriptor, Direct};
use crate::method::large_strain::Fragments;
use crate::quantity::Quantity;
use crate::scene::{FaceName, HeldFace, LargeStrain};

/// Integrals over time of a body, in addition to its [`Snapshot`].
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Sums {
    pub dissipated: f64,
    pub load_work: f64,
    pub contact_force: f64,
    pub impulse: f64,
    /// Along x and y.
    pub shear: [f64; 2],
    pub friction_heat: f64,
    pub lift_off: f64,
    pub steps: f64,
    pub force_outside: f64,
    pub heat: HeatTotals,
}

/// A scalar of a whole body.
struct Total {
    key: &'static str,
    words: &'static str,
    quantity: Quantity,
    of: Offered,
    read: Read,
}

/// Bodies that offer a total.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Offered {
    All,
    /// Those with inertia.
    Moving,
    /// Those above a plane or another body.
    Above,
    /// Those with friction on what lies below.
    Rubbing,
    /// Those with loads on their faces.
    Loaded,
    /// Those on a solid, over whose edge they may reach.
    OnASolid,
    /// Those that conduct heat.
    Conducting,
    /// Those whose heat passes to the solid below.
    Warming,
    /// Boxes in a plane.
    PlaneBox,
    /// Those of concrete.
    Concrete,
    /// Those of concrete with inertia.
    MovingConcrete,
}

enum Read {
    Snapshot(fn(&Snapshot) -> f64),
    Fragments(fn(&Fragments) -> f64),
    Sums(fn(&Sums) -> f64),
    Heat(fn(&HeatTotals) -> f64),
}

const TOTALS: [Total; 36] = [
    all("width", "extent along x", Quantity::Length, |s| s.width),
    all("height", "extent along z", Quantity::Length, |s| s.height),
    all("centre_z", "height of the centre of mass", Quantity::Length, |s| s.centre),
    all("mass", "mass", Quantity::Mass, |s| s.mass),
    all("max_von_mises", "highest von Mises stress of a point", Quantity::Stress, |s| s.von_mises),
    all("least_jacobian", "lowest volume over that before deformation", Quantity::Ratio, |s| {
        s.least_jacobian
    }),
    all("stored", "elastic energy, that of the contact included", Quantity::Energy, |s| s.stored),
    Total {
        key: "dissipated",
        words: "work of the stresses that is no longer stored",
        quantity: Quantity::Energy,
        of: Offered::All,
        read: Read::Sums(|sums| sums.dissipated),
    },
    Total {
        key: "load_work",
        words: "work of pressures and tractions on its faces since time zero",
        quantity: Quantity::Energy,
        of: Offered::Loaded,
        read: Read::Sums(|sums| sums.load_work),
    },
    moving("kinetic", "kinetic energy", Quantity::Energy, |s| s.kinetic),
    moving("momentum_x", "momentum along x", Quantity::Momentum, |s| s.momentum[0]),
    moving("momentum_y", "momentum along y", Quantity::Momentum, |s| s.momentum[1]),
    moving("momentum_z", "momentum along z", Quantity::Momentum, |s| s.momentum[2]),
    Total {
        key: "contact_radius",
        words: "largest distance of a point in contact from the middle of the contact",
        quantity: Quantity::Length,
        of: Offered::Above,
        read: Read::Snapshot(|s| s.contact_radius),
    },
    above(
        "contact_force",
        "force on what lies below, mean over the last exchange",
        Quantity::Force,
        |s| s.contact_force,
    ),
    above(
        "impulse_z",
        "impulse along z on what lies below, into it negative",
        Quantity::Momentum,
        |s| -s.impulse,
    ),
    rubbing("impulse_x", "impulse along x on what lies below", Quantity::Momentum, |s| s.shear[0]),
    rubbing("impulse_y", "impulse along y on what lies below", Quantity::Momentum, |s| s.shear[1]),
    rubbing(
        "friction_heat",
        "heat that friction has made, which warms neither body",
        Quantity::Energy,
        |s| s.friction_heat,
    ),
    above("lift_off_time", "time of the last lift-off, 0 before", Quantity::Time, |s| s.lift_off),
    Total {
        key: "steps",
        words: "time steps made inside the unit",
        quantity: Quantity::Ratio,
        of: Offered::Moving,
        read: Read::Sums(|sums| sums.steps),
    },
    Total {
        key: "force_outside",
        words: "force beyond the edge of the solid, which does not act on it, mean over the last exchange",
        quantity: Quantity::Force,
        of: Offered::OnASolid,
        read: Read::Sums(|sums| sums.force_outside),
    },
    Total {
        key: "curvature",
        words: "mean curvature of the middle half along x, positive if the ends turn towards z",
        quantity: Quantity::Curvature,
        of: Offered::PlaneBox,
        read: Read::Snapshot(|s| s.curvature),
    },
    conducting(
        "max_temperature",
        "highest temperature of the body",
        Quantity::Temperature,
        |heat| heat.highest,
    ),
    conducting("mean_temperature", "mean temperature by capacity", Quantity::Temperature, |heat| {
        heat.mean
    }),
    conducting(
        "heat_in",
        "heat that prescribed fluxes have brought in",
        Quantity::Energy,
        |heat| heat.brought_in,
    ),
    conducting("heat_stored", "heat stored since time zero", Quantity::Energy, |heat| heat.stored),
    conducting(
        "heat_lost",
        "heat that has left through convective and prescribed-temperature faces",
        Quantity::Energy,
        |heat| heat.lost,
    ),
    Total {
        of: Offered::Warming,
        ..conducting(
            "heat",
            "heat given to the solid below since time zero",
            Quantity::Energy,
            |heat| heat.given,
        )
    },
    concrete(
        "max_damage",
        "largest damage of a point, 0 intact to 1 broken",
        Quantity::Ratio,
        |f| f.max_damage,
    ),
    concrete("mean_damage", "mean damage of the volume", Quantity::Ratio, |f| f.mean_damage),
    concrete("fragments", "number of parts of unbroken nodes, 1 at first", Quantity::Count, |f| {
        f.count as f64
    }),
    concrete("largest_fragment_mass", "mass of the largest fragment", Quantity::Mass, |f| {
        f.largest_mass
    }),
    concrete(
        "broken_mass",
        "mass of broken nodes, which are in no fragment",
        Quantity::Mass,
        |f| f.broken_mass,
    ),
    Total {
        of: Offered::MovingConcrete,
        ..concrete(
            "largest_fragment_speed",
            "speed of the centre of the largest fragment",
            Quantity::Velocity,
            |f| f.largest_speed,
        )
    },
    Total {
        key: "steps",
        words: "steps of equilibrium made inside the unit",
        quantity: Quantity::Ratio,
        of: Offered::All,
        read: Read::Sums(|sums| sums.steps),
    },
];

/// Returns true of the place of the energy that is no longer stored.
pub fn is_dissipated(place: usize) -> bool {
    TOTALS.get(place).is_some_and(|total| total.key == "dissipated")
}

/// Place of the steps of a body in equilibrium, which those of one that moves replace.
const STEPS_AT_REST: usize = TOTALS.len() - 1;

const fn all(
    key: &'static str,
    words: &'static str,
    quantity: Quantity,
    read: fn(&Snapshot) -> f64,
) -> Total {
    Total { key, words, quantity, of: Offered::All, read: Read::Snapshot(read) }
}

const fn moving(
    key: &'static str,
    words: &'static str,
    quantity: Quantity,
    read: fn(&Snapshot) -> f64,
) -> Total {
    Total { key, words, quantity, of: Offered::Moving, read: Read::Snapshot(read) }
}

const fn concrete(
    key: &'static str,
    words: &'static str,
    quantity: Quantity,
    read: fn(&Fragments) -> f64,
) -> Total {
    Total { key, words, quantity, of: Offered::Concrete, read: Read::Fragments(read) }
}

const fn above(
    key: &'static str,
    words: &'static str,
    quantity: Quantity,
    read: fn(&Sums) -> f64,
) -> Total {
    Total { key, words, quantity, of: Offered::Above, read: Read::Sums(read) }
}

const fn rubbing(
    key: &'static str,
    words: &'static str,
    quantity: Quantity,
    read: fn(&Sums) -> f64,
) -> Total {
    Total { key, words, quantity, of: Offered::Rubbing, read: Read::Sums(read) }
}

const fn conducting(
    key: &'static str,
    words: &'static str,
    quantity: Quantity,
    read: fn(&HeatTotals) -> f64,
) -> Total {
    Total { key, words, quantity, of: Offered::Conducting, read: Read::Heat(read) }
}

/// Returns the totals that a solid offers, each with its place: first those of the table, then the forces of faces
/// that are held or moved. In a plane model they are amounts per metre of depth.
pub fn offered_totals(solid: &LargeStrain, is_coupled: bool) -> Vec<(usize, Descriptor)> {
    let is_plane = solid.dimension == 2;
    let is_offered = |place: usize| match TOTALS[place].of {
        _ if place == STEPS_AT_REST => !solid.inertia,
        Offered::All => true,
        Offered::Moving => solid.inertia,
        Offered::Above => solid.is_above(),
        Offered::Rubbing => solid.friction.is_some(),
        Offered::Loaded => solid.faces.values().any(HeldFace::is_loaded),
        Offered::OnASolid => is_coupled,
        Offered::Conducting => solid.conducts(),
        Offered::Warming => solid.conductance_below.is_some(),
        Offered::PlaneBox => is_plane && solid.is_box(),
        Offered::Concrete => solid.is_of_concrete(),
        Offered::MovingConcrete => solid.is_of_concrete() && solid.inertia,
    };
    let described = |key, words, quantity: Quantity| {
        let quantity = if is_plane { quantity.per_depth() } else { quantity };
        // Bodies in equilibrium follow the displacements of their faces without delay.
        let direct = if solid.inertia { Direct::Nothing } else { Direct::OwnInputs };
        Descriptor { key, words, quantity, direct }
    };
    let own = (0..TOTALS.len()).filter(|&place| is_offered(place)).map(|place| {
        let Total { key, words, quantity, .. } = TOTALS[place];
        (place, described(key, words, quantity))
    });
    let of_faces = held_faces(solid).into_iter().enumerate().flat_map(|(n, face)| {
        solid.held_axes(face).into_iter().map(move |axis| {
            let words = "force on the face by which it is held or moved";
            let key = force_key(face, axis);
            (TOTALS.len() + 3 * n + axis, described(key, words, Quantity::Force))
        })
    });
    own.chain(of_faces).collect()
}

/// Faces that are held or moved, in their order.
pub fn held_faces(solid: &LargeStrain) -> Vec<FaceName> {
    let held = solid.faces.iter().filter(|(_, face)| face.is_held());
    held.map(|(&face, _)| face).collect()
}

/// Faces whose displacement is prescribed, in their order.
pub fn moved_faces(solid: &LargeStrain) -> Vec<FaceName> {
    let moved = solid.faces.iter().filter(|(_, face)| face.displacement.is_some());
    moved.map(|(&face, _)| face).collect()
}

/// Faces with loads, in their order.
pub fn loaded_faces(solid: &LargeStrain) -> Vec<FaceName> {
    let loaded = solid.faces.iter().filter(|(_, face)| face.is_loaded());
    loaded.map(|(&face, _)| face).collect()
}

/// Place of a force among those of the faces.
pub fn force(place: usize) -> Option<(usize, usize)> {
    let beyond = place.checked_sub(TOTALS.len())?;
    Some((beyond / 3, beyond % 3))
}

pub fn read(snapshot: &Snapshot, sums: &Sums, place: usize) -> f64 {
    match TOTALS[place].read {
        Read::Snapshot(of) => of(snapshot),
        Read::Fragments(of) => of(&snapshot.fragments),
        Read::Sums(of) => of(sums),
        Read::Heat(of) => of(&sums.heat),
    }
}

/// Last part of the name of a force on a face along an axis.
fn force_key(face: FaceName, axis: usize) -> &'static str {
    const KEYS: [[&str; 3]; 7] = [
        ["top.force_x", "top.force_y", "top.force_z"],
        ["bottom.force_x", "bottom.force_y", "bottom.force_z"],
        ["sides.force_x", "sides.force_y", "sides.force_z"],
        ["left.force_x", "left.force_y", "left.force_z"],
        ["right.force_x", "right.force_y", "right.force_z"],
        ["front.force_x", "front.force_y", "front.force_z"],
        ["back.force_x", "back.force_y", "back.force_z"],
    ];
    KEYS[face as usize][axis]
}
