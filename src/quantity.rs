//! Physical quantities with their SI and display units.

use std::f64::consts::PI;

/// A physical quantity: the unit of its values, and their usual display.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Quantity {
    Time,
    Temperature,
    /// Difference of two temperatures.
    TemperatureDifference,
    HeatFlux,
    Stress,
    Length,
    Displacement,
    Energy,
    Density,
    SpecificHeat,
    /// Heat per mass of a change of phase.
    LatentHeat,
    Conductivity,
    Modulus,
    Ratio,
    /// A whole number of objects.
    Count,
    Angle,
    Expansion,
    HeatTransferCoefficient,
    /// Thermal resistance of a contact per area.
    ThermalResistance,
    Area,
    Volume,
    VolumeFlow,
    Velocity,
    ShearRate,
    Viscosity,
    SurfaceTension,
    Mass,
    Momentum,
    Force,
    HeatFlow,
    /// Energy per metre of depth, of plane models.
    EnergyPerLength,
    MassPerLength,
    MomentumPerLength,
    ForcePerLength,
    HeatFlowPerLength,
    StressIntensity,
    /// Energy per area of a new crack.
    EnergyPerArea,
    /// Inverse of the radius of a bent line.
    Curvature,
    /// Expected number of failures per volume.
    FailureDensity,
    /// Expected number of failures per area.
    SurfaceFailureDensity,
}

/// A unit for display: `display value = factor · SI value + offset`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DisplayUnit {
    pub name: &'static str,
    pub factor: f64,
    pub offset: f64,
}

const fn scaled(name: &'static str, factor: f64) -> Option<DisplayUnit> {
    Some(DisplayUnit { name, factor, offset: 0.0 })
}

impl Quantity {
    pub const ALL: [Quantity; 40] = [
        Quantity::Time,
        Quantity::Temperature,
        Quantity::TemperatureDifference,
        Quantity::HeatFlux,
        Quantity::Stress,
        Quantity::Length,
        Quantity::Displacement,
        Quantity::Energy,
        Quantity::Density,
        Quantity::SpecificHeat,
        Quantity::LatentHeat,
        Quantity::Conductivity,
        Quantity::Modulus,
        Quantity::Ratio,
        Quantity::Count,
        Quantity::Angle,
        Quantity::Expansion,
        Quantity::HeatTransferCoefficient,
        Quantity::ThermalResistance,
        Quantity::Area,
        Quantity::Volume,
        Quantity::VolumeFlow,
        Quantity::Velocity,
        Quantity::ShearRate,
        Quantity::Viscosity,
        Quantity::SurfaceTension,
        Quantity::Mass,
        Quantity::Momentum,
        Quantity::Force,
        Quantity::HeatFlow,
        Quantity::EnergyPerLength,
        Quantity::MassPerLength,
        Quantity::MomentumPerLength,
        Quantity::ForcePerLength,
        Quantity::HeatFlowPerLength,
        Quantity::StressIntensity,
        Quantity::EnergyPerArea,
        Quantity::Curvature,
        Quantity::FailureDensity,
        Quantity::SurfaceFailureDensity,
    ];

    /// The quantity per metre of a plane model's depth; unchanged if independent of depth.
    pub fn per_depth(self) -> Self {
        match self {
            Quantity::Energy => Quantity::EnergyPerLength,
            Quantity::Mass => Quantity::MassPerLength,
            Quantity::Momentum => Quantity::MomentumPerLength,
            Quantity::Force => Quantity::ForcePerLength,
            Quantity::HeatFlow => Quantity::HeatFlowPerLength,
            other => other,
        }
    }

    /// Returns true if it is a quantity per metre of depth of a plane model.
    pub fn is_per_depth(self) -> bool {
        Self::ALL.into_iter().any(|other| other != self && other.per_depth() == self)
    }

    /// Name of the FMI type.
    pub fn type_name(self) -> &'static str {
        match self {
            Quantity::Time => "Time",
            Quantity::Temperature => "Temperature",
            Quantity::TemperatureDifference => "TemperatureDifference",
            Quantity::HeatFlux => "HeatFlux",
            Quantity::Stress => "Stress",
            Quantity::Length => "Length",
            Quantity::Displacement => "Displacement",
            Quantity::Energy => "Energy",
            Quantity::Density => "Density",
            Quantity::SpecificHeat => "SpecificHeat",
            Quantity::LatentHeat => "LatentHeat",
            Quantity::Conductivity => "ThermalConductivity",
            Quantity::Modulus => "ElasticModulus",
            Quantity::Ratio => "Ratio",
            Quantity::Count => "Count",
            Quantity::Angle => "Angle",
            Quantity::Expansion => "ThermalExpansion",
            Quantity::HeatTransferCoefficient => "HeatTransferCoefficient",
            Quantity::ThermalResistance => "ThermalInsulance",
            Quantity::Area => "Area",
            Quantity::Volume => "Volume",
            Quantity::VolumeFlow => "VolumeFlowRate",
            Quantity::Velocity => "Velocity",
            Quantity::ShearRate => "ShearRate",
            Quantity::Viscosity => "DynamicViscosity",
            Quantity::SurfaceTension => "SurfaceTension",
            Quantity::Mass => "Mass",
            Quantity::Momentum => "Momentum",
            Quantity::Force => "Force",
            Quantity::HeatFlow => "HeatFlowRate",
            Quantity::EnergyPerLength => "EnergyPerLength",
            Quantity::MassPerLength => "MassPerLength",
            Quantity::MomentumPerLength => "MomentumPerLength",
            Quantity::ForcePerLength => "ForcePerLength",
            Quantity::HeatFlowPerLength => "HeatFlowRatePerLength",
            Quantity::StressIntensity => "StressIntensity",
            Quantity::EnergyPerArea => "EnergyPerArea",
            Quantity::Curvature => "Curvature",
            Quantity::FailureDensity => "FailureDensity",
            Quantity::SurfaceFailureDensity => "SurfaceFailureDensity",
        }
    }

    /// SI unit of the values.
    pub fn unit(self) -> &'static str {
        match self {
            Quantity::Time => "s",
            Quantity::Temperature | Quantity::TemperatureDifference => "K",
            Quantity::HeatFlux => "W/m2",
            Quantity::Stress | Quantity::Modulus => "Pa",
            Quantity::Length | Quantity::Displacement => "m",
            Quantity::Energy => "J",
            Quantity::Density => "kg/m3",
            Quantity::SpecificHeat => "J/(kg.K)",
            Quantity::LatentHeat => "J/kg",
            Quantity::Conductivity => "W/(m.K)",
            Quantity::Ratio | Quantity::Count => "1",
            Quantity::Angle => "rad",
            Quantity::Expansion => "1/K",
            Quantity::HeatTransferCoefficient => "W/(m2.K)",
            Quantity::ThermalResistance => "m2.K/W",
            Quantity::Area => "m2",
            Quantity::Volume => "m3",
            Quantity::VolumeFlow => "m3/s",
            Quantity::Velocity => "m/s",
            Quantity::ShearRate => "1/s",
            Quantity::Viscosity => "Pa.s",
            Quantity::SurfaceTension => "N/m",
            Quantity::Mass => "kg",
            Quantity::Momentum => "kg.m/s",
            Quantity::Force => "N",
            Quantity::HeatFlow => "W",
            Quantity::EnergyPerLength => "J/m",
            Quantity::MassPerLength => "kg/m",
            Quantity::MomentumPerLength => "kg/s",
            Quantity::ForcePerLength => "N/m",
            Quantity::HeatFlowPerLength => "W/m",
            Quantity::StressIntensity => "Pa.m(1/2)",
            Quantity::EnergyPerArea => "J/m2",
            Quantity::Curvature => "1/m",
            Quantity::FailureDensity => "1/m3",
            Quantity::SurfaceFailureDensity => "1/m2",
        }
    }

    /// Exponents of kg, m, s and K; angles count as numbers. `None` if one of them is no whole number.
    pub fn base_exponents(self) -> Option<[i32; 4]> {
        Some(match self {
            Quantity::Time => [0, 0, 1, 0],
            Quantity::Temperature | Quantity::TemperatureDifference => [0, 0, 0, 1],
            Quantity::HeatFlux => [1, 0, -3, 0],
            Quantity::Stress | Quantity::Modulus => [1, -1, -2, 0],
            Quantity::Length | Quantity::Displacement => [0, 1, 0, 0],
            Quantity::Energy => [1, 2, -2, 0],
            Quantity::Density => [1, -3, 0, 0],
            Quantity::SpecificHeat => [0, 2, -2, -1],
            Quantity::LatentHeat => [0, 2, -2, 0],
            Quantity::Conductivity => [1, 1, -3, -1],
            Quantity::Ratio | Quantity::Count | Quantity::Angle => [0, 0, 0, 0],
            Quantity::Expansion => [0, 0, 0, -1],
            Quantity::HeatTransferCoefficient => [1, 0, -3, -1],
            Quantity::ThermalResistance => [-1, 0, 3, 1],
            Quantity::Area => [0, 2, 0, 0],
            Quantity::Volume => [0, 3, 0, 0],
            Quantity::VolumeFlow => [0, 3, -1, 0],
            Quantity::Velocity => [0, 1, -1, 0],
            Quantity::ShearRate => [0, 0, -1, 0],
            Quantity::Viscosity => [1, -1, -1, 0],
            Quantity::SurfaceTension => [1, 0, -2, 0],
            Quantity::Mass => [1, 0, 0, 0],
            Quantity::Momentum => [1, 1, -1, 0],
            Quantity::Force => [1, 1, -2, 0],
            Quantity::HeatFlow => [1, 2, -3, 0],
            Quantity::EnergyPerLength => [1, 1, -2, 0],
            Quantity::MassPerLength => [1, -1, 0, 0],
            Quantity::MomentumPerLength => [1, 0, -1, 0],
            Quantity::ForcePerLength => [1, 0, -2, 0],
            Quantity::HeatFlowPerLength => [1, 1, -3, 0],
            Quantity::StressIntensity => return None,
            Quantity::EnergyPerArea => [1, 0, -2, 0],
            Quantity::Curvature => [0, -1, 0, 0],
            Quantity::FailureDensity => [0, -3, 0, 0],
            Quantity::SurfaceFailureDensity => [0, -2, 0, 0],
        })
    }

    /// Display unit, if it differs from the SI unit.
    pub fn display_unit(self) -> Option<DisplayUnit> {
        match self {
            Quantity::Time => scaled("µs", 1e6),
            Quantity::Temperature => {
                Some(DisplayUnit { name: "degC", factor: 1.0, offset: -273.15 })
            }
            Quantity::HeatFlux => scaled("MW/m2", 1e-6),
            Quantity::Stress => scaled("MPa", 1e-6),
            Quantity::Modulus => scaled("GPa", 1e-9),
            Quantity::Length => scaled("µm", 1e6),
            Quantity::Displacement => scaled("nm", 1e9),
            Quantity::Energy => scaled("µJ", 1e6),
            Quantity::Angle => scaled("deg", 180.0 / PI),
            Quantity::Expansion => scaled("1e-6/K", 1e6),
            Quantity::Viscosity => scaled("mPa.s", 1e3),
            Quantity::Mass => scaled("µg", 1e9),
            Quantity::Force => scaled("mN", 1e3),
            Quantity::HeatFlow => scaled("mW", 1e3),
            Quantity::StressIntensity => scaled("MPa.m(1/2)", 1e-6),
            _ => None,
        }
    }

    /// Typical magnitude, for tools that scale tolerances.
    pub fn nominal(self) -> f64 {
        match self {
            Quantity::Time => 1e-6,
            Quantity::Temperature => 300.0,
            Quantity::TemperatureDifference => 1.0,
            Quantity::HeatFlux => 1e6,
            Quantity::Stress => 1e6,
            Quantity::Modulus => 1e11,
            Quantity::Length => 1e-5,
            Quantity::Displacement => 1e-9,
            Quantity::Energy => 1e-6,
            Quantity::Density => 1e3,
            Quantity::SpecificHeat => 1e3,
            Quantity::LatentHeat => 1e5,
            Quantity::Conductivity => 10.0,
            Quantity::Ratio | Quantity::Count | Quantity::Angle => 1.0,
            Quantity::Expansion => 1e-5,
            Quantity::HeatTransferCoefficient => 10.0,
            Quantity::ThermalResistance => 1e-6,
            Quantity::Area => 1e-10,
            Quantity::Volume => 1e-12,
            Quantity::VolumeFlow => 1e-8,
            Quantity::Velocity => 10.0,
            Quantity::ShearRate => 1e3,
            Quantity::Viscosity => 1e-3,
            Quantity::SurfaceTension => 0.1,
            Quantity::Mass => 1e-9,
            Quantity::Momentum => 1e-8,
            Quantity::Force => 1e-2,
            Quantity::HeatFlow => 1e-1,
            Quantity::EnergyPerLength => 1e-3,
            Quantity::MassPerLength => 1e-6,
            Quantity::MomentumPerLength => 1e-5,
            Quantity::ForcePerLength => 1e1,
            Quantity::HeatFlowPerLength => 1e2,
            Quantity::StressIntensity => 1e6,
            Quantity::EnergyPerArea => 10.0,
            Quantity::Curvature => 1.0,
            Quantity::FailureDensity => 1e9,
            Quantity::SurfaceFailureDensity => 1e6,
        }
    }
}

/// Magnitude below which six decimals display a temperature [K].
const FIXED: f64 = 1e6;

/// Formats a temperature in kelvin, of any magnitude.
pub fn kelvin(value: f64) -> String {
    if value.abs() < FIXED { format!("{value:.6} K") } else { format!("{value:.6e} K") }
}

/// Formats a fraction as a percentage.
pub fn percent(part: f64) -> String {
    let value = 100.0 * part;
    match value {
        0.0 => "0 %".to_owned(),
        _ if value < 0.01 => format!("{value:.0e} %"),
        _ if value < 1.0 => format!("{value:.2} %"),
        _ if value < 10.0 => format!("{value:.1} %"),
        _ => format!("{value:.0} %"),
    }
}
