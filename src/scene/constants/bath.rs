//! The constants of a solid's bath: a row for each.

use super::{Constant, OfferedConstant};
use crate::limits::Bounds;
use crate::quantity::Quantity;
use crate::scene::types::Bath;

/// A constant of a bath.
#[derive(Debug)]
pub struct BathConstant {
    /// Last part of the variable's name.
    pub key: &'static str,
    pub description: &'static str,
    pub quantity: Quantity,
    pub bounds: Bounds,
    place: fn(&mut Bath) -> &mut f64,
}

impl BathConstant {
    const ALL: &[Self] = &[
        Self {
            key: "bath_coefficient",
            description: "heat transfer coefficient of the bath",
            quantity: Quantity::HeatTransferCoefficient,
            bounds: Bounds::from(0.0),
            place: |bath| &mut bath.coefficient,
        },
        Self {
            key: "bath_temperature",
            description: "temperature of the bath",
            quantity: Quantity::Temperature,
            bounds: Bounds::from(0.0),
            place: |bath| &mut bath.ambient,
        },
        Self {
            key: "bath_speed",
            description: "speed at which the bath rises along the body",
            quantity: Quantity::Velocity,
            bounds: Bounds::between(-1e3, 1e3),
            place: |bath| &mut bath.speed,
        },
        Self {
            key: "bath_depth",
            description: "height immersed in the bath at time zero",
            quantity: Quantity::Length,
            bounds: Bounds::between(-1e6, 1e6),
            place: |bath| &mut bath.depth,
        },
    ];

    pub(super) fn place<'a>(&self, bath: &'a mut Bath) -> &'a mut f64 {
        (self.place)(bath)
    }
}

/// Constants of one key are equal.
impl PartialEq for BathConstant {
    fn eq(&self, other: &Self) -> bool {
        self.key == other.key
    }
}

impl Eq for BathConstant {}

/// The constants of the bath of a body.
pub(super) fn offered(body: &str) -> impl Iterator<Item = OfferedConstant> {
    BathConstant::ALL.iter().map(move |constant| OfferedConstant {
        key: constant.key.to_owned(),
        description: format!("{} of {body}", constant.description),
        constant: Constant::Bath(constant),
    })
}
