//! Readings at a point of a solid.

use super::linear::SolidChange;
use super::reader::SolidReader;
use super::rows;
use crate::body::{BodyError, Descriptor, Direct};
use crate::laws::stress::{max_principal, von_mises};
use crate::laws::stress_rate::{max_principal_rate, von_mises_rate};
use crate::method::fem::FlawsIn;
use crate::quantity::Quantity;
use crate::scene::Gives;

/// A scalar at a point.
pub struct PointQuantity {
    pub descriptor: Descriptor,
    /// Output names of a scene that include the quantity.
    pub given_by: &'static [Gives],
    pub(in crate::body) measure: Measure,
}

/// Derivation of a quantity from the fields.
pub enum Measure {
    Temperature,
    Displacement(usize),
    Stress(usize),
    /// A measure of stress and its rate.
    OfStress(fn([f64; 6]) -> f64, fn([f64; 6], [f64; 6]) -> f64),
    PlasticStrain,
    Damage,
    FailureDensity(FlawsIn),
}

/// All quantities, in the order in which a probe lists them.
pub fn point_quantities() -> &'static [PointQuantity] {
    &QUANTITIES
}

const QUANTITIES: [PointQuantity; 16] = [
    PointQuantity {
        descriptor: Descriptor {
            key: "temperature",
            words: "temperature",
            quantity: Quantity::Temperature,
            direct: Direct::Temperatures,
        },
        given_by: &[Gives::Temperature],
        measure: Measure::Temperature,
    },
    component("stress_xx", "stress component xx", 0),
    component("stress_yy", "stress component yy", 1),
    component("stress_zz", "stress component zz", 2),
    component("stress_xy", "stress component xy", 3),
    component("stress_yz", "stress component yz", 4),
    component("stress_xz", "stress component xz", 5),
    PointQuantity {
        descriptor: stress("von_mises", "von Mises stress"),
        given_by: &[Gives::Stress, Gives::VonMises],
        measure: Measure::OfStress(von_mises, von_mises_rate),
    },
    PointQuantity {
        descriptor: stress("max_principal", "largest principal stress, tension positive"),
        given_by: &[Gives::MaxPrincipal],
        measure: Measure::OfStress(max_principal, max_principal_rate),
    },
    displacement("displacement_x", "displacement along x", 0),
    displacement("displacement_y", "displacement along y", 1),
    displacement("displacement_z", "displacement along z", 2),
    PointQuantity {
        descriptor: Descriptor {
            key: "plastic_strain",
            words: "accumulated plastic strain",
            quantity: Quantity::Ratio,
            direct: Direct::Nothing,
        },
        given_by: &[Gives::PlasticStrain],
        measure: Measure::PlasticStrain,
    },
    PointQuantity {
        descriptor: Descriptor {
            key: "damage",
            words: "damage, 0 intact to 1 broken",
            quantity: Quantity::Ratio,
            direct: Direct::Nothing,
        },
        given_by: &[Gives::Damage],
        measure: Measure::Damage,
    },
    PointQuantity {
        descriptor: Descriptor {
            key: "failure_density",
            words: "density of the failure risk so far over the volume",
            quantity: Quantity::FailureDensity,
            direct: Direct::Nothing,
        },
        given_by: &[Gives::FailureDensity],
        measure: Measure::FailureDensity(FlawsIn::Volume),
    },
    PointQuantity {
        descriptor: Descriptor {
            key: "surface_failure_density",
            words: "density of the failure risk so far over the faces",
            quantity: Quantity::SurfaceFailureDensity,
            direct: Direct::Nothing,
        },
        given_by: &[Gives::SurfaceFailureDensity],
        measure: Measure::FailureDensity(FlawsIn::Faces),
    },
];

const fn stress(key: &'static str, words: &'static str) -> Descriptor {
    let direct = Direct::TemperaturesAndTractions;
    Descriptor { key, words, quantity: Quantity::Stress, direct }
}

const fn component(key: &'static str, words: &'static str, place: usize) -> PointQuantity {
    PointQuantity {
        descriptor: stress(key, words),
        given_by: &[Gives::Stress],
        measure: Measure::Stress(place),
    }
}

const fn displacement(key: &'static str, words: &'static str, axis: usize) -> PointQuantity {
    PointQuantity {
        descriptor: Descriptor {
            key,
            words,
            quantity: Quantity::Displacement,
            direct: Direct::TemperaturesAndTractions,
        },
        given_by: &[Gives::Displacement],
        measure: Measure::Displacement(axis),
    }
}

impl PointQuantity {
    /// Returns true if it follows from displacements.
    pub fn is_mechanical(&self) -> bool {
        !matches!(self.measure, Measure::Temperature)
    }

    pub(super) fn is_displacement(&self) -> bool {
        matches!(self.measure, Measure::Displacement(_))
    }

    /// Returns true if it depends on the body's history.
    pub(super) fn is_of_history(&self) -> bool {
        matches!(
            self.measure,
            Measure::PlasticStrain | Measure::Damage | Measure::FailureDensity(_)
        )
    }

    /// Returns its place among the components that rows can read, if it is such a component.
    pub(super) fn component(&self) -> Option<usize> {
        match self.measure {
            Measure::Displacement(axis) => Some(rows::displacement(axis)),
            Measure::Stress(slot) => Some(rows::stress(slot)),
            _ => None,
        }
    }

    pub(super) fn read(
        &self,
        reader: &mut SolidReader,
        point: [f64; 3],
        alone: bool,
    ) -> Result<f64, BodyError> {
        Ok(match self.measure {
            Measure::Temperature => reader.initial_temperature() + reader.rise_at(point, alone),
            Measure::Displacement(axis) => reader.displacement_along(axis, point)?,
            Measure::Stress(place) => reader.stress_component(place, point)?,
            Measure::OfStress(measure, _) => measure(reader.stress_at(point)?),
            Measure::PlasticStrain => reader.plastic_strain_at(point)?,
            Measure::Damage => reader.damage_at(point)?,
            Measure::FailureDensity(which) => reader.failure_density_at(which, point)?,
        })
    }

    pub(super) fn rate(
        &self,
        SolidChange { now, change }: &mut SolidChange,
        point: [f64; 3],
        alone: bool,
    ) -> Result<f64, BodyError> {
        Ok(match self.measure {
            Measure::Temperature => change.rise_at(point, alone),
            Measure::Displacement(axis) => change.displacement_along(axis, point)?,
            Measure::Stress(place) => change.stress_component(place, point)?,
            Measure::OfStress(_, rate) => rate(now.stress_at(point)?, change.stress_at(point)?),
            Measure::PlasticStrain | Measure::Damage | Measure::FailureDensity(_) => {
                return Err(BodyError::NoRate);
            }
        })
    }
}
