//! The constants of filaments other than those of their fluid: a row for each.

use super::{Constant, OfferedConstant, fluid};
use crate::quantity::Quantity;
use crate::scene::Filament;

/// A constant of a filament.
#[derive(Debug)]
pub struct FilamentConstant {
    /// Last part of the variable's name.
    pub key: &'static str,
    pub description: &'static str,
    pub quantity: Quantity,
    place: fn(&mut Filament) -> Option<&mut f64>,
}

impl FilamentConstant {
    pub const ALL: &[Self] = &[
        Self {
            key: "nozzle_diameter",
            description: "inner diameter of the nozzle",
            quantity: Quantity::Length,
            place: |filament| Some(&mut filament.nozzle.diameter),
        },
        Self {
            key: "air_coefficient",
            description: "heat transfer coefficient to the air",
            quantity: Quantity::HeatTransferCoefficient,
            place: |filament| Some(&mut filament.convection.as_mut()?.coefficient),
        },
    ];

    /// The constant's place in a filament; `None` where the scene sets no number.
    pub(super) fn place<'a>(&self, filament: &'a mut Filament) -> Option<&'a mut f64> {
        (self.place)(filament)
    }
}

/// Keys tell constants apart.
impl PartialEq for FilamentConstant {
    fn eq(&self, other: &Self) -> bool {
        self.key == other.key
    }
}

impl Eq for FilamentConstant {}

/// The constants of a filament, with those of its fluid; inputs set place, flow and temperature of the nozzle.
pub fn offered(body: &str, filament: &Filament) -> Vec<OfferedConstant> {
    let is_offered = |constant: &&FilamentConstant| constant.place(&mut filament.clone()).is_some();
    let own = FilamentConstant::ALL.iter().filter(is_offered).map(|constant| OfferedConstant {
        key: constant.key.to_owned(),
        description: format!("{} of {body}", constant.description),
        constant: Constant::Filament(constant),
    });
    let (of_fluid, of_law) = fluid::offered(body, &filament.fluid);
    own.chain(of_fluid).chain(of_law).collect()
}
