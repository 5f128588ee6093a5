//! Converts a lattice of a scene to the plan of its method.

use crate::method::lattice::{
    Arrangement, Control, Inertia, LatticePlan, Notch, Sheet, Strip, Support,
};
use crate::scene::{Lattice, LatticeArrangement, LatticeControl, LatticeSupport};

/// The plan of a checked scene's lattice.
///
/// # Panics
/// If keys of its softening are missing.
pub fn plan_of(lattice: &Lattice) -> LatticePlan {
    let material = &lattice.material;
    let arrangement = match lattice.arrangement {
        LatticeArrangement::Across => Arrangement::Across,
        LatticeArrangement::Along => Arrangement::Along,
        LatticeArrangement::Random => Arrangement::Random { seed: lattice.seed },
    };
    let notch = lattice.notch.map(|own| Notch { at: own.at, depth: own.depth, width: own.width });
    LatticePlan {
        strip: Strip {
            length: lattice.length,
            depth: lattice.depth,
            spacing: lattice.spacing,
            arrangement,
            notch,
        },
        sheet: Sheet {
            young: material.young,
            poisson: material.poisson,
            thickness: lattice.thickness,
        },
        support: match lattice.support {
            LatticeSupport::ThreePoint(own) => Support::ThreePoint { span: own.span },
            LatticeSupport::Ends => Support::Ends,
        },
        control: match lattice.control {
            LatticeControl::Displacement => Control::Displacement,
            LatticeControl::Opening => Control::Opening,
        },
        softening: material.softening.law().expect("checked scenes have the keys of their model"),
        bending: material.softening.bending,
        closes: lattice.contact,
        scatter: lattice.scatter,
        seed: lattice.seed,
    }
}

/// Mass and damping of a lattice that moves.
pub fn inertia_of(lattice: &Lattice) -> Inertia {
    Inertia { density: lattice.material.density, damping: lattice.damping }
}
