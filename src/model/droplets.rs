//! Droplets: from scene to plan, and what is read from their states.

use std::ops::Range;

use super::ModelError;
use super::contact::Contact;
use crate::math::allowance::{Allowance, cost};
use crate::method::sph::{
    self, Domain, DropletPlan, DropletSph, DropletTotals, Extent, Failure, ParticleFields, Release,
    Surface, WallCells, WallExchange,
};
use crate::scene::{Droplet, Footprint, Governing, Scene, Wall};
use crate::variables::{DropletTotal, InputLayout, WallOutput};

/// A body of droplets and what lies below it.
pub struct DropletModel {
    pub name: String,
    pub droplet: DropletSph,
    pub below: Below,
    /// Images at mirrors for each particle.
    copies: f64,
    rest: Rest,
    pub notes: Vec<String>,
}

/// The fluid before anything happens to it.
struct Rest {
    /// [kg/m³]
    density: f64,
    /// [K]
    temperature: f64,
}

/// What a droplet exchanges heat and momentum with.
pub enum Below {
    Nothing,
    Wall(WallBelow),
    Solid(Box<Contact>),
}

/// A wall whose cells have their temperatures from inputs.
pub struct WallBelow {
    /// Places of the temperatures among the inputs.
    pub inputs: Range<usize>,
    /// Of each cell [m²].
    areas: Vec<f64>,
}

/// What is read from a droplet's state, computed when first asked for.
#[derive(Debug, Default)]
pub struct DropletCache {
    totals: Option<DropletTotals>,
    exchange: Option<WallExchange>,
}

impl DropletModel {
    /// `contact` is there for a droplet that the scene couples.
    pub fn new(
        scene: &Scene,
        layout: &InputLayout,
        name: &str,
        contact: Option<Contact>,
        threads: usize,
    ) -> Self {
        let droplet = &scene.droplet(name).expect("asked for by the name of a droplet");
        let wall = scene.wall_under(name);
        let cells = match (&contact, wall) {
            (Some(contact), _) => Some(contact.cells()),
            (None, Some(wall)) => cells_of(&scene.wall[wall].footprint),
            (None, None) => None,
        };
        let effusivity = match (&contact, wall) {
            (Some(_), _) => None,
            (None, wall) => wall.and_then(|wall| scene.wall[wall].effusivity),
        };
        let mut notes = notes(scene, name, droplet);
        notes.extend(contact.as_ref().map(Contact::note));
        let below = match (contact, wall) {
            (Some(contact), _) => Below::Solid(Box::new(contact)),
            (None, Some(wall)) => Below::Wall(WallBelow {
                inputs: layout.walls[wall].clone(),
                areas: cells_of(&scene.wall[wall].footprint)
                    .map_or(Vec::new(), |cells| cells.areas(Domain::whole(droplet.dimension))),
            }),
            (None, None) => Below::Nothing,
        };
        Self {
            name: name.to_owned(),
            droplet: DropletSph::new(plan_of(droplet, cells, effusivity), threads),
            below,
            copies: droplet.mirrors().iter().map(|&m| if m { 2.0 } else { 1.0 }).product(),
            rest: Rest { density: droplet.fluid.density, temperature: droplet.initial_temperature },
            notes,
        }
    }

    /// Refuses temperatures of the wall that make no sense.
    pub fn check(&self, inputs: &[f64]) -> Result<(), ModelError> {
        let Below::Wall(wall) = &self.below else { return Ok(()) };
        match wall.inputs.clone().find(|&index| inputs[index] <= 0.0) {
            Some(index) => {
                let message = format!("{} K is not above absolute zero", inputs[index]);
                Err(ModelError::Input { index, message })
            }
            None => Ok(()),
        }
    }

    /// Advances by `dt` [s] under wall temperatures, held.
    pub fn advance(
        &self,
        state: &mut Vec<f64>,
        wall_temperature: &[f64],
        dt: f64,
        allowance: &Allowance,
    ) -> Result<(), ModelError> {
        let advanced = self.droplet.advance_within(state, wall_temperature, dt, allowance);
        advanced.map_err(|failure| self.error(failure))
    }

    /// Ends a step of `dt` [s] that is known to take the droplet too many time steps.
    pub fn foresee(&self, state: &[f64], dt: f64, allowance: &Allowance) -> Result<(), ModelError> {
        let particles = self.droplet.particles_in(state);
        let steps = if particles > 0 { self.expected_steps(dt).0 } else { 0.0 };
        let foreseen = allowance.foresee(steps, "time steps of a droplet", particles);
        foreseen.map_err(|halt| ModelError::Halted { body: self.name.clone(), halt })
    }

    /// Time steps that `dt` [s] take at least, and the particles that there are at last.
    fn expected_steps(&self, dt: f64) -> (f64, usize) {
        let (particles, time_step) = DropletSph::forecast(self.droplet.plan());
        // Fluid at rest takes longer steps than one that arrives.
        (0.5 * dt / time_step, particles)
    }

    /// Updates of unknowns that `dt` [s] take, about, once all drops are released.
    pub fn updates(&self, dt: f64) -> f64 {
        let (steps, particles) = self.expected_steps(dt);
        cost(steps, particles)
    }

    /// Advances above the surface of a solid that answers to the droplet's heat; the rises of its cells [K m²].
    pub fn advance_above(
        &self,
        state: &mut Vec<f64>,
        surface: &Surface,
        dt: f64,
        allowance: &Allowance,
    ) -> Result<Vec<f64>, ModelError> {
        let advanced = self.droplet.advance_above(state, surface, dt, allowance);
        advanced.map_err(|failure| self.error(failure))
    }

    fn error(&self, failure: Failure) -> ModelError {
        match failure {
            Failure::Halted(halt) => ModelError::Halted { body: self.name.clone(), halt },
            failure => ModelError::Droplet { name: self.name.clone(), failure },
        }
    }

    pub fn total(&self, state: &[f64], cache: &mut DropletCache, total: DropletTotal) -> f64 {
        match total {
            DropletTotal::Force => {
                let exchange = self.exchange(state, cache);
                let pushes = exchange.impulse.iter().map(|impulse| -impulse[2]);
                return a_time(pushes.sum::<f64>() - exchange.impulse_outside[2], exchange);
            }
            DropletTotal::HeatFlow => {
                let exchange = self.exchange(state, cache);
                let sum = exchange.heat.iter().sum::<f64>() + exchange.heat_outside;
                return a_time(sum, exchange);
            }
            DropletTotal::ForceOutside => {
                let exchange = self.exchange(state, cache);
                return a_time(-exchange.impulse_outside[2], exchange);
            }
            _ => {}
        }
        let totals = cache.totals.get_or_insert_with(|| self.totals(state));
        match total {
            DropletTotal::Height => totals.height,
            DropletTotal::KineticEnergy => totals.kinetic_energy,
            DropletTotal::CompressionEnergy => totals.compression_energy,
            DropletTotal::SurfaceEnergy => totals.surface_energy,
            DropletTotal::Mass => totals.mass,
            DropletTotal::Momentum(axis) => totals.momentum[axis],
            DropletTotal::HeatStored => totals.heat - totals.heat_released,
            DropletTotal::HeatDrift => totals.heat - totals.heat_released + totals.heat_to_wall,
            DropletTotal::MaxPressure => totals.max_pressure,
            DropletTotal::MaxSpeed => totals.max_speed,
            DropletTotal::MinDensity => totals.density_range[0] * self.rest.density,
            DropletTotal::MaxDensity => totals.density_range[1] * self.rest.density,
            DropletTotal::MinTemperature => totals.temperature_range[0],
            DropletTotal::MaxTemperature => totals.temperature_range[1],
            DropletTotal::Particles => self.copies * totals.particles,
            DropletTotal::Steps => totals.steps,
            DropletTotal::StrayMass => totals.stray_mass,
            DropletTotal::StrayParticles => self.copies * totals.stray_particles,
            DropletTotal::SpreadDiameter => totals.spread_diameter,
            DropletTotal::Heat => totals.heat_to_wall,
            DropletTotal::Impulse(axis) => totals.impulse_to_wall[axis],
            DropletTotal::HeatFlow | DropletTotal::Force | DropletTotal::ForceOutside => {
                unreachable!("returned above")
            }
        }
    }

    /// Sums over the fluid; before the first drop, extremes are those of the fluid at rest.
    fn totals(&self, state: &[f64]) -> DropletTotals {
        let totals = self.droplet.totals(state);
        if totals.particles > 0.0 {
            return totals;
        }
        let temperature_range = [self.rest.temperature; 2];
        DropletTotals { max_pressure: 0.0, density_range: [1.0; 2], temperature_range, ..totals }
    }

    /// What a cell of the wall got, or all that lies beyond the cells.
    pub fn wall_output(&self, state: &[f64], cache: &mut DropletCache, output: WallOutput) -> f64 {
        let exchange = self.exchange(state, cache);
        let Below::Wall(wall) = &self.below else {
            panic!("outputs of a wall are registered for the droplet above it")
        };
        let (amount, area) = match output {
            WallOutput::HeatFlux(cell) => (exchange.heat[cell], wall.areas[cell]),
            WallOutput::Pressure(cell) => (-exchange.impulse[cell][2], wall.areas[cell]),
            WallOutput::ShearX(cell) | WallOutput::ShearR(cell) => {
                (exchange.impulse[cell][0], wall.areas[cell])
            }
            WallOutput::ShearY(cell) => (exchange.impulse[cell][1], wall.areas[cell]),
            WallOutput::HeatFlowOutside => (exchange.heat_outside, 1.0),
            WallOutput::ForceOutside => (-exchange.impulse_outside[2], 1.0),
        };
        a_time(amount, exchange) / area
    }

    /// All particles, images at mirrors included.
    pub fn particles(&self, state: &[f64]) -> ParticleFields {
        let mut fields = self.droplet.particles(state);
        let mirrors = self.droplet.plan().mirrors;
        for axis in (0..2).filter(|&axis| mirrors[axis]) {
            for i in 0..fields.mass.len() {
                let image = |mut vector: [f64; 3]| {
                    vector[axis] = -vector[axis];
                    vector
                };
                fields.position.push(image(fields.position[i]));
                fields.velocity.push(image(fields.velocity[i]));
                for values in [
                    &mut fields.mass,
                    &mut fields.density,
                    &mut fields.pressure,
                    &mut fields.temperature,
                ] {
                    values.push(values[i]);
                }
            }
        }
        fields
    }

    /// Whether fluid touched what lies beyond the edge of the solid in the last exchange.
    pub fn overflows(&self, state: &[f64]) -> bool {
        let WallExchange { heat_outside, impulse_outside, .. } = self.droplet.exchange(state);
        matches!(self.below, Below::Solid(_)) && (heat_outside != 0.0 || impulse_outside[2] != 0.0)
    }

    fn exchange<'c>(&self, state: &[f64], cache: &'c mut DropletCache) -> &'c WallExchange {
        cache.exchange.get_or_insert_with(|| self.droplet.exchange(state))
    }
}

/// An amount of the last step as a mean rate; nothing before the first step.
fn a_time(amount: f64, exchange: &WallExchange) -> f64 {
    if exchange.duration > 0.0 { amount / exchange.duration } else { 0.0 }
}

/// What the engine builds a droplet from, above the cells of a wall or none.
pub fn plan_of(
    droplet: &Droplet,
    cells: Option<WallCells>,
    effusivity: Option<f64>,
) -> DropletPlan {
    let fluid = &droplet.fluid;
    let releases = droplet.arrivals.iter().map(|arrival| Release {
        time: arrival.time,
        centre: [arrival.x, arrival.y, droplet.gap() + 0.5 * droplet.diameter],
        diameter: droplet.diameter,
        velocity: [0.0, 0.0, -droplet.impact_velocity],
        temperature: droplet.initial_temperature,
    });
    DropletPlan {
        dimension: droplet.dimension,
        spacing: droplet.spacing,
        support: droplet.support,
        kernel: droplet.kernel,
        fluid: sph::Fluid {
            density: fluid.density,
            viscosity: fluid.viscosity,
            specific_heat: fluid.specific_heat,
            conductivity: fluid.conductivity,
            surface_tension: fluid.surface_tension,
            sound_speed: droplet.sound_speed(),
        },
        placement: droplet.placement,
        precision: droplet.precision,
        density_diffusion: droplet.density_diffusion,
        corrected_diffusion: droplet.corrected_diffusion,
        shifting: droplet.shifts(),
        gravity: [0.0, 0.0, -droplet.gravity],
        mirrors: droplet.mirrors(),
        extents: [Extent::Open; 3],
        releases: releases.collect(),
        wall: cells.map(|cells| sph::Wall {
            cells,
            contact_angle: fluid.contact_angle,
            effusivity,
        }),
    }
}

/// The cells of a wall's footprint; scenes with other footprints are refused.
pub fn cells_of(footprint: &Footprint) -> Option<WallCells> {
    match *footprint {
        Footprint::Rings { count, radius } => Some(WallCells::Rings { count, radius }),
        Footprint::Tiles { count, size } => Some(WallCells::Tiles { count, size }),
        Footprint::Disc { .. } | Footprint::Gaussian { .. } => None,
    }
}

/// What was chosen or left out, and why: a sentence each.
pub fn notes(scene: &Scene, name: &str, droplet: &Droplet) -> Vec<String> {
    let wall = scene.wall_under(name).map(|wall| &scene.wall[wall]);
    let stands = wall.is_some() || scene.coupling_from(name).is_some();
    let mut notes = vec![match droplet.mirrors() {
        [true, true] => "a quarter of the drop is modelled: it mirrors itself in x = 0 and y = 0",
        [true, false] => "half of the plane drop is modelled: it mirrors itself in x = 0",
        _ => "the whole drop is modelled: nothing makes it mirror itself, or the scene asks for it",
    }
    .to_owned()];
    notes.extend(note_on_sound(droplet));
    notes.extend(stands.then(|| note_on_first_blow(droplet)));
    if droplet.fluid.surface_tension == 0.0 {
        notes.push("surface tension is left out: the scene names none".to_owned());
    } else if !droplet.shifts() && droplet.shifting.is_none() {
        notes.push("particles are not shifted: surface tension rules this drop".to_owned());
    }
    if droplet.fluid.surface_tension > 0.0 && stands {
        notes.push(format!(
            "contact angle {}°, which decides how far a slow drop spreads (`fluid.contact_angle` in rad; 90° \
             where a scene names none)",
            (10.0 * droplet.fluid.contact_angle.to_degrees()).round() / 10.0
        ));
    }
    if droplet.fluid.conductivity == 0.0 {
        notes.push("heat is left out: the fluid does not conduct any".to_owned());
    } else {
        notes.push(
            "the fluid neither solidifies, melts nor evaporates, and its constants do not change with temperature"
                .to_owned(),
        );
        notes.extend(wall.and_then(|wall| note_on_held_wall(wall, droplet)));
    }
    notes
}

/// What is to be known of a scene's walls by who couples them: a sentence each.
pub fn notes_on_walls(scene: &Scene) -> Vec<String> {
    let note = |wall: &Wall| {
        let droplet = scene.droplet(&wall.under)?;
        note_on_held_wall(wall, droplet).filter(|_| droplet.fluid.conductivity > 0.0)
    };
    scene.wall.iter().filter_map(note).collect()
}

/// Time over D/U over which forces and pressures are means that hardly depend on sound and resolution.
const WINDOW: f64 = 0.1;

/// What the model's speed of sound does to the first blow, and what does not depend on it.
fn note_on_first_blow(droplet: &Droplet) -> String {
    let hammer = droplet.fluid.density * droplet.sound_speed() * droplet.impact_velocity;
    let window = match droplet.impact_velocity {
        speed if speed > 0.0 => format!(" = {:.1e} s", WINDOW * droplet.diameter / speed),
        _ => String::new(),
    };
    format!(
        "that speed of sound is artificial: the pressure of the first blow, ρcU = {hammer:.3e} Pa here, and \
         `max_pressure` are in proportion to it; what follows after some D/c is not. `max_pressure` is the water \
         hammer in a single particle: it grows as particles get smaller and converges to nothing. Forces \
         converge as means over {WINDOW} D/U{window} and longer: differences of `impulse_z` over these times"
    )
}

/// Part of the time Δx²/a, in which heat goes through a layer of particles, that steps of a master may take.
const STEP_OF_MASTER: f64 = 0.1;

/// What a wall does whose temperature is held, though a master may couple it.
fn note_on_held_wall(wall: &Wall, droplet: &Droplet) -> Option<String> {
    let fluid = &droplet.fluid;
    let diffusivity = fluid.conductivity / (fluid.density * fluid.specific_heat);
    let step = STEP_OF_MASTER * droplet.spacing.powi(2) / diffusivity;
    wall.effusivity.is_none().then(|| {
        format!(
            "`{}` names no `effusivity`: its heat flux just after contact is that of a wall held at its \
             temperature; a master that couples it with the unit of a plate has to name the plate's √(kρc), or to \
             take steps of 0.1 Δx²/a = {step:.1e} s or shorter",
            wall.name
        )
    })
}

/// The speed of sound that was chosen, or what one that the scene asks for costs.
fn note_on_sound(droplet: &Droplet) -> Option<String> {
    let (sound, (governing, speed)) = (droplet.sound_speed(), droplet.governing_speed());
    let ratio = sound / speed;
    if droplet.fluid.sound_speed.is_none() {
        let what = match governing {
            Governing::Flow => "the fastest flow expected",
            Governing::Surface => {
                "the speed √(2σ/(ρΔx)) that surface tension gives single particles"
            }
            Governing::Viscosity => {
                "the speed √(12µU/(ρD)) of the pressure that stops a viscous drop"
            }
        };
        return Some(format!("speed of sound chosen: {sound:.4} m/s, ten times {what}"));
    }
    let compressed = 100.0 / (ratio * ratio);
    (ratio < 10.0).then(|| match governing {
        Governing::Surface => format!(
            "the speed of sound is only {ratio:.2} times √(2σ/(ρΔx)): single particles may come loose from the \
             surface, none at ten times"
        ),
        Governing::Flow => format!(
            "the speed of sound is only {ratio:.2} times the fastest flow: the fluid is compressed by about \
             {compressed:.1} %, by 1 % at ten times"
        ),
        Governing::Viscosity => format!(
            "the speed of sound is only {ratio:.2} times √(12µU/(ρD)): where the drop is stopped, the fluid is \
             compressed by about {compressed:.1} %, by 1 % at ten times"
        ),
    })
}
