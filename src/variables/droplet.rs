//! Variables of droplets and of the walls below them.

use super::registry::{Output, Slot, Value, Variable, cell_labels, cell_start};
use super::{InputLayout, Parameter, Quantity};
use crate::scene::{Droplet, Footprint, Scene, Wall};

/// A constant of a droplet.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum DropletConstant {
    Diameter,
    ImpactVelocity,
    Density,
    Viscosity,
    SpecificHeat,
    Conductivity,
    SurfaceTension,
    SoundSpeed,
}

/// A scalar of a whole droplet body.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum DropletTotal {
    Height,
    KineticEnergy,
    CompressionEnergy,
    SurfaceEnergy,
    Mass,
    Momentum(usize),
    HeatStored,
    HeatDrift,
    MaxPressure,
    MaxSpeed,
    MinDensity,
    MaxDensity,
    MinTemperature,
    MaxTemperature,
    Particles,
    Steps,
    StrayMass,
    StrayParticles,
    SpreadDiameter,
    Heat,
    HeatFlow,
    Impulse(usize),
    Force,
    ForceOutside,
}

/// What a wall gets; numbers are those of cells, from zero.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum WallOutput {
    HeatFlux(usize),
    Pressure(usize),
    ShearX(usize),
    ShearY(usize),
    ShearR(usize),
    HeatFlowOutside,
    ForceOutside,
}

const AXES: [&str; 3] = ["x", "y", "z"];

impl DropletConstant {
    pub const ALL: [DropletConstant; 8] = [
        DropletConstant::Diameter,
        DropletConstant::ImpactVelocity,
        DropletConstant::Density,
        DropletConstant::Viscosity,
        DropletConstant::SpecificHeat,
        DropletConstant::Conductivity,
        DropletConstant::SurfaceTension,
        DropletConstant::SoundSpeed,
    ];

    /// Key in the scene and last part of the variable's name.
    pub fn key(self) -> &'static str {
        match self {
            DropletConstant::Diameter => "diameter",
            DropletConstant::ImpactVelocity => "impact_velocity",
            DropletConstant::Density => "density",
            DropletConstant::Viscosity => "viscosity",
            DropletConstant::SpecificHeat => "specific_heat",
            DropletConstant::Conductivity => "conductivity",
            DropletConstant::SurfaceTension => "surface_tension",
            DropletConstant::SoundSpeed => "sound_speed",
        }
    }

    fn description(self) -> &'static str {
        match self {
            DropletConstant::Diameter => "diameter of a drop",
            DropletConstant::ImpactVelocity => "speed towards the wall at the release",
            DropletConstant::Density => "mass density at rest",
            DropletConstant::Viscosity => "dynamic viscosity",
            DropletConstant::SpecificHeat => "specific heat capacity",
            DropletConstant::Conductivity => "thermal conductivity",
            DropletConstant::SurfaceTension => "surface tension",
            DropletConstant::SoundSpeed => "speed of sound of the model",
        }
    }

    fn quantity(self) -> Quantity {
        match self {
            DropletConstant::Diameter => Quantity::Length,
            DropletConstant::ImpactVelocity | DropletConstant::SoundSpeed => Quantity::Velocity,
            DropletConstant::Density => Quantity::Density,
            DropletConstant::Viscosity => Quantity::Viscosity,
            DropletConstant::SpecificHeat => Quantity::SpecificHeat,
            DropletConstant::Conductivity => Quantity::Conductivity,
            DropletConstant::SurfaceTension => Quantity::SurfaceTension,
        }
    }

    /// Where a droplet holds it; a speed of sound that the scene leaves out is put there first.
    pub(super) fn place(self, droplet: &mut Droplet) -> &mut f64 {
        let sound_speed = droplet.sound_speed();
        let fluid = &mut droplet.fluid;
        match self {
            DropletConstant::Diameter => &mut droplet.diameter,
            DropletConstant::ImpactVelocity => &mut droplet.impact_velocity,
            DropletConstant::Density => &mut fluid.density,
            DropletConstant::Viscosity => &mut fluid.viscosity,
            DropletConstant::SpecificHeat => &mut fluid.specific_heat,
            DropletConstant::Conductivity => &mut fluid.conductivity,
            DropletConstant::SurfaceTension => &mut fluid.surface_tension,
            DropletConstant::SoundSpeed => fluid.sound_speed.get_or_insert(sound_speed),
        }
    }
}

impl DropletTotal {
    /// Of any droplet.
    const FREE: [DropletTotal; 20] = [
        DropletTotal::Height,
        DropletTotal::KineticEnergy,
        DropletTotal::CompressionEnergy,
        DropletTotal::SurfaceEnergy,
        DropletTotal::Mass,
        DropletTotal::Momentum(0),
        DropletTotal::Momentum(1),
        DropletTotal::Momentum(2),
        DropletTotal::HeatStored,
        DropletTotal::HeatDrift,
        DropletTotal::MaxPressure,
        DropletTotal::MaxSpeed,
        DropletTotal::MinDensity,
        DropletTotal::MaxDensity,
        DropletTotal::MinTemperature,
        DropletTotal::MaxTemperature,
        DropletTotal::Particles,
        DropletTotal::Steps,
        DropletTotal::StrayMass,
        DropletTotal::StrayParticles,
    ];
    /// Of a droplet above a wall or a solid.
    const ABOVE_A_WALL: [DropletTotal; 7] = [
        DropletTotal::SpreadDiameter,
        DropletTotal::Heat,
        DropletTotal::HeatFlow,
        DropletTotal::Impulse(0),
        DropletTotal::Impulse(1),
        DropletTotal::Impulse(2),
        DropletTotal::Force,
    ];
    /// Of a droplet on a solid, which may run over its edge.
    const ON_A_SOLID: [DropletTotal; 1] = [DropletTotal::ForceOutside];

    fn key(self) -> String {
        let key = match self {
            DropletTotal::Height => "height",
            DropletTotal::KineticEnergy => "kinetic_energy",
            DropletTotal::CompressionEnergy => "compression_energy",
            DropletTotal::SurfaceEnergy => "surface_energy",
            DropletTotal::Mass => "mass",
            DropletTotal::Momentum(axis) => return format!("momentum_{}", AXES[axis]),
            DropletTotal::HeatStored => "heat_stored",
            DropletTotal::HeatDrift => "heat_drift",
            DropletTotal::MaxPressure => "max_pressure",
            DropletTotal::MaxSpeed => "max_speed",
            DropletTotal::MinDensity => "min_density",
            DropletTotal::MaxDensity => "max_density",
            DropletTotal::MinTemperature => "min_temperature",
            DropletTotal::MaxTemperature => "max_temperature",
            DropletTotal::Particles => "particles",
            DropletTotal::Steps => "steps",
            DropletTotal::StrayMass => "stray_mass",
            DropletTotal::StrayParticles => "stray_particles",
            DropletTotal::SpreadDiameter => "spread_diameter",
            DropletTotal::Heat => "heat",
            DropletTotal::HeatFlow => "heat_flow",
            DropletTotal::Impulse(axis) => return format!("impulse_{}", AXES[axis]),
            DropletTotal::Force => "force",
            DropletTotal::ForceOutside => "force_outside",
        };
        key.to_owned()
    }

    fn description(self) -> String {
        let text = match self {
            DropletTotal::Height => "height of the body of fluid above the wall, without strays",
            DropletTotal::KineticEnergy => "kinetic energy",
            DropletTotal::CompressionEnergy => "elastic energy of the weak compression",
            DropletTotal::SurfaceEnergy => "energy of free and wetted surface, against a dry wall",
            DropletTotal::Mass => "mass released so far",
            DropletTotal::Momentum(axis) => return format!("momentum along {}", AXES[axis]),
            DropletTotal::HeatStored => "heat gained since the release, negative when cooled",
            DropletTotal::HeatDrift => {
                "heat stored and given to the wall, together: zero but for rounding"
            }
            DropletTotal::MaxPressure => {
                "highest pressure of a single particle, which rings and grows with resolution"
            }
            DropletTotal::MaxSpeed => "highest speed of a particle",
            DropletTotal::MinDensity => "lowest density of a particle",
            DropletTotal::MaxDensity => "highest density of a particle",
            DropletTotal::MinTemperature => "lowest temperature of a particle",
            DropletTotal::MaxTemperature => "highest temperature of a particle",
            DropletTotal::Particles => "number of particles, images at mirrors included",
            DropletTotal::Steps => "time steps made inside the unit",
            DropletTotal::StrayMass => {
                "mass that has come off the body of fluid, in lumps below a tenth of a drop"
            }
            DropletTotal::StrayParticles => {
                "number of particles that have come off the body of fluid, images included"
            }
            DropletTotal::SpreadDiameter => {
                "diameter of the film on the wall, without holes and spray"
            }
            DropletTotal::Heat => "heat given to the wall since time zero",
            DropletTotal::HeatFlow => "heat flow into the wall, mean over the last exchange",
            DropletTotal::Impulse(axis) => {
                return format!("impulse along {} given to the wall since time zero", AXES[axis]);
            }
            DropletTotal::Force => {
                "force into the wall, mean over the last exchange, which rings with the fluid's sound"
            }
            DropletTotal::ForceOutside => {
                "force beyond the edge of the solid, which does not act on it, mean over the last \
                 exchange"
            }
        };
        text.to_owned()
    }

    fn quantity(self) -> Quantity {
        match self {
            DropletTotal::Height | DropletTotal::SpreadDiameter => Quantity::Length,
            DropletTotal::KineticEnergy
            | DropletTotal::CompressionEnergy
            | DropletTotal::SurfaceEnergy
            | DropletTotal::HeatStored
            | DropletTotal::HeatDrift
            | DropletTotal::Heat => Quantity::Energy,
            DropletTotal::Mass | DropletTotal::StrayMass => Quantity::Mass,
            DropletTotal::Momentum(_) | DropletTotal::Impulse(_) => Quantity::Momentum,
            DropletTotal::MaxPressure => Quantity::Stress,
            DropletTotal::MaxSpeed => Quantity::Velocity,
            DropletTotal::MinDensity | DropletTotal::MaxDensity => Quantity::Density,
            DropletTotal::MinTemperature | DropletTotal::MaxTemperature => Quantity::Temperature,
            DropletTotal::Particles | DropletTotal::Steps | DropletTotal::StrayParticles => {
                Quantity::Ratio
            }
            DropletTotal::HeatFlow => Quantity::HeatFlow,
            DropletTotal::Force | DropletTotal::ForceOutside => Quantity::Force,
        }
    }
}

pub(super) fn parameters(body: &str, droplet: &Droplet, list: &mut Vec<Variable>) {
    let mut copy = droplet.clone();
    for constant in DropletConstant::ALL {
        list.push(Variable {
            name: format!("{body}.{}", constant.key()),
            description: format!("{} of {body}", constant.description()),
            slot: Slot::Parameter(Parameter::Droplet { body: body.to_owned(), constant }),
            quantity: Some(constant.quantity()),
            start: Some(Value::Real(*constant.place(&mut copy))),
            min: Some(0.0),
            max: None,
        });
    }
    list.push(Variable {
        name: format!("{body}.initial_temperature"),
        description: format!("uniform temperature of {body} at the release"),
        slot: Slot::Parameter(Parameter::InitialTemperature { body: body.to_owned() }),
        quantity: Some(Quantity::Temperature),
        start: Some(Value::Real(droplet.initial_temperature)),
        min: Some(0.0),
        max: None,
    });
}

/// Temperatures of the cells of walls.
pub(super) fn inputs(scene: &Scene, layout: &InputLayout, list: &mut Vec<Variable>) {
    for (wall, range) in scene.wall.iter().zip(&layout.walls) {
        let own = scene.droplet(&wall.under).map(|droplet| droplet.initial_temperature);
        let shape = wall.footprint.cells();
        for (cell, (label, place)) in cell_labels(shape).into_iter().enumerate() {
            let given = wall.start.temperature.as_ref();
            let start = given.map(|values| cell_start(Some(values), shape, cell)).or(own);
            list.push(Variable {
                name: format!("{}.temperature{label}", wall.name),
                description: format!("temperature of the wall{place}, {}", wall.name),
                slot: Slot::Input(range.start + cell),
                quantity: Some(Quantity::Temperature),
                start: start.map(Value::Real),
                min: Some(0.0),
                max: None,
            });
        }
    }
}

pub(super) fn outputs(scene: &Scene, list: &mut Vec<Variable>) {
    for (body, droplet) in scene.droplets() {
        let stands = scene.wall_under(body).or(scene.coupling_from(body)).is_some();
        let above: &[DropletTotal] = if stands { &DropletTotal::ABOVE_A_WALL } else { &[] };
        let on_solid: &[DropletTotal] = match scene.coupling_from(body) {
            Some(_) => &DropletTotal::ON_A_SOLID,
            None => &[],
        };
        for &total in DropletTotal::FREE.iter().chain(above).chain(on_solid) {
            let output = Output::Droplet { body: body.to_owned(), total };
            let (quantity, depth) = by_depth(total.quantity(), Some(droplet));
            let description = format!("{}{depth} ({body})", total.description());
            let name = format!("{body}.{}", total.key());
            list.push(output_variable(name, description, output, quantity));
        }
    }
    for (index, wall) in scene.wall.iter().enumerate() {
        wall_outputs(index, wall, scene.droplet(&wall.under), list);
    }
}

fn wall_outputs(index: usize, wall: &Wall, droplet: Option<&Droplet>, list: &mut Vec<Variable>) {
    type Kind = (&'static str, &'static str, Quantity, fn(usize) -> WallOutput);
    let mut kinds: Vec<Kind> = vec![
        ("heat_flux", "heat flux into the wall", Quantity::HeatFlux, WallOutput::HeatFlux),
        ("pressure", "pressure on the wall", Quantity::Stress, WallOutput::Pressure),
    ];
    if let Footprint::Rings { .. } = wall.footprint {
        let meaning = "radial shear on the wall, outward positive";
        kinds.push(("shear_r", meaning, Quantity::Stress, WallOutput::ShearR));
    } else {
        let meaning = "shear on the wall along x";
        kinds.push(("shear_x", meaning, Quantity::Stress, WallOutput::ShearX));
        if droplet.is_some_and(|droplet| droplet.dimension == 3) {
            let meaning = "shear on the wall along y";
            kinds.push(("shear_y", meaning, Quantity::Stress, WallOutput::ShearY));
        }
    }
    let mean = "mean over the last step";
    for (key, meaning, quantity, of_cell) in kinds {
        for (cell, (label, place)) in cell_labels(wall.footprint.cells()).into_iter().enumerate() {
            let output = Output::Wall { wall: index, output: of_cell(cell) };
            let name = format!("{}.{key}{label}", wall.name);
            let description = format!("{meaning}{place}, {}, {mean}", wall.name);
            list.push(output_variable(name, description, output, quantity));
        }
    }
    for (key, meaning, quantity, output) in [
        ("heat_flow_outside", "heat flow", Quantity::HeatFlow, WallOutput::HeatFlowOutside),
        ("force_outside", "force", Quantity::Force, WallOutput::ForceOutside),
    ] {
        let name = format!("{}.{key}", wall.name);
        let (quantity, depth) = by_depth(quantity, droplet);
        let description =
            format!("{meaning} into the wall beyond its cells{depth}, {}, {mean}", wall.name);
        list.push(output_variable(
            name,
            description,
            Output::Wall { wall: index, output },
            quantity,
        ));
    }
}

/// What a plane model gives of a quantity, and words for it.
fn by_depth(quantity: Quantity, droplet: Option<&Droplet>) -> (Quantity, &'static str) {
    let is_plane = droplet.is_some_and(|droplet| droplet.dimension == 2);
    match quantity.per_depth() {
        per_depth if is_plane && per_depth != quantity => (per_depth, ", per metre of depth"),
        _ => (quantity, ""),
    }
}

fn output_variable(
    name: String,
    description: String,
    output: Output,
    quantity: Quantity,
) -> Variable {
    let slot = Slot::Output(output);
    Variable {
        name,
        description,
        slot,
        quantity: Some(quantity),
        start: None,
        min: None,
        max: None,
    }
}
