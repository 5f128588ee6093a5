//! Constants that are plausible alone, but not together; and effects of loads.

use super::{Reviewer, power};
use crate::closed_form::{Conductor, DiscFlux, GaussianFlux, UniformFlux};
use crate::laws::{Constants, Fluid, Material};
use crate::limits::number;
use crate::limits::plausible;
use crate::scene::lateral_extents;
use crate::scene::locate::Path;
use crate::scene::{Droplet, FaceName, Footprint, HeatMethod, LargeStrain, Mesh, Solid};
use crate::warning;

/// Foams and aerogels have a lower density [kg/m³] and conductivity [W/(m K)] than these.
const LIGHT: f64 = 30.0;
const LIGHT_CONDUCTS: f64 = 1.0;
/// Temperature at which unknown materials are judged [K].
const ROOM: f64 = 293.15;
/// Upper limit of the speed of sound √(E/ρ) in a bar; it is 18 600 m/s in diamond [m/s].
const FASTEST_SOUND: f64 = 22_000.0;
/// Viscosity limit of liquids with the heat capacity of water or the conductivity of a metal [Pa s].
const THIN: f64 = 0.1;
const WATERY: f64 = 3900.0;
const METALLIC: f64 = 7.0;
/// Particle spacing below heated faces over √(at) up to which their temperatures are accurate to some per cent.
const COARSEST_PARTICLES: f64 = 1.5;
/// Recommended spacing over √(at).
const FINE_PARTICLES: f64 = 0.3;
/// Width over thickness from which on the bending of a plate is lost in rounding. The rounding error is some 10⁻¹⁷
/// times its fourth power, 10 % to 60 % at 20 000.
const MOST_SLENDER: f64 = 5e3;
/// Rise of the surface that no solid withstands [K].
const HOTTEST_RISE: f64 = 1e4;

pub fn review(reviewer: &mut Reviewer) {
    let root = Path::default();
    for (name, own) in &reviewer.scene.material {
        solid(reviewer, &root.key("material").key(name), &own.at(ROOM));
    }
    for (name, body) in reviewer.scene.solids() {
        let path = root.key("body").key(name);
        for (place, own) in body.materials(&path) {
            if place.is_within(&path) {
                let start = body.initial_temperature;
                solid(reviewer, &place, &own.at(start));
            }
        }
        fluxes(reviewer, (&path, name), body);
        particles(reviewer, &path, body);
        slender(reviewer, &path, (name, body));
    }
    for (name, body) in reviewer.scene.large_strains() {
        fluxes_at_large_strain(reviewer, &root.key("body").key(name), body);
    }
    for (name, body) in reviewer.scene.droplets() {
        fluid(reviewer, &root.key("body").key(name).key("fluid"), body);
    }
}

fn solid(reviewer: &mut Reviewer, path: &Path, law: &Constants) {
    if !plausible::DENSITY.holds(law.density) {
        return;
    }
    if law.density < LIGHT && law.conductivity > LIGHT_CONDUCTS {
        let (meant, given) = (number(1e3 * law.density), number(law.density));
        let conductivity = number(law.conductivity);
        let finding = warning::light_solid_conducts(conductivity, meant, given);
        reviewer.warn(&path.key("density"), finding);
    } else if let Some(young) = law.young.filter(|&young| plausible::YOUNG.holds(young)) {
        let sound = (young / law.density).sqrt();
        if sound > FASTEST_SOUND {
            let (density, sound) = (number(law.density), number(sound.round()));
            let finding = warning::sound_faster_than_in_diamond(density, sound);
            reviewer.warn(&path.key("young"), finding);
        }
    }
}

fn fluid(reviewer: &mut Reviewer, path: &Path, droplet: &Droplet) {
    let Fluid { density, specific_heat, conductivity, .. } = droplet.fluid;
    let Some(viscosity) = droplet.fluid.viscosity.constant() else { return };
    let kind = if conductivity >= METALLIC {
        "conducts like a metal"
    } else if specific_heat >= WATERY && (900.0..=1200.0).contains(&density) {
        "takes up heat like water"
    } else {
        return;
    };
    if viscosity >= THIN && plausible::VISCOSITY.holds(viscosity) {
        let (meant, given) = (number(1e-3 * viscosity), number(viscosity));
        let finding = warning::thin_liquid_too_viscous(kind, meant, given);
        reviewer.warn(&path.key("viscosity"), finding);
    }
}

/// Warns of particles that are further apart below the faces than the heat penetration depth at the stop time.
fn particles(reviewer: &mut Reviewer, path: &Path, solid: &Solid) {
    let Mesh { spacing, depth_spacing, .. } = solid.mesh;
    let (HeatMethod::Sph, Some(apart)) = (solid.heat, depth_spacing.or(spacing)) else { return };
    let diffusivity = solid.strata().iter().fold(0.0, |a: f64, s| a.max(s.constants.diffusivity()));
    let depth = (diffusivity * reviewer.scene.stop_time).sqrt();
    if apart > COARSEST_PARTICLES * depth {
        let key = if depth_spacing.is_some() { "depth_spacing" } else { "spacing" };
        let fine = rounded(FINE_PARTICLES * depth);
        let finding = warning::heat_particles_too_coarse(rounded(depth), number(apart), fine);
        reviewer.warn(&path.key("mesh").key(key), finding);
    }
}

/// Warns of bending plates so thin that their deflection is lost in rounding.
fn slender(reviewer: &mut Reviewer, path: &Path, (name, solid): (&str, &Solid)) {
    let is_flat = [FaceName::Top, FaceName::Bottom].into_iter().any(|face| {
        let face = solid.face(face);
        face.clamped || face.roller
    });
    let widest = lateral_extents(&solid.shape).into_iter().fold(0.0, f64::max);
    let ratio = widest / solid.shape.thickness();
    if is_flat || ratio < MOST_SLENDER || !reviewer.scene.gives_mechanics(name) {
        return;
    }
    let (ratio, most) = (format!("{ratio:.0e}"), format!("{MOST_SLENDER:.0e}"));
    reviewer.warn(&path.key("shape"), warning::plate_too_slender(ratio, most));
}

/// Formats to two digits.
fn rounded(value: f64) -> String {
    format!("{value:.1e}")
}

/// Warns of the effect of fluxes of loads and faces at the stop time.
fn fluxes(reviewer: &mut Reviewer, (path, name): (&Path, &str), solid: &Solid) {
    for (face, condition) in &solid.faces {
        if let Some(flux) = condition.flux {
            let path = path.key("faces").key(face.as_str()).key("flux");
            flux_of(reviewer, &path, Spot::whole(flux), &Heated::of(solid));
        }
    }
    for (i, load) in reviewer.scene.load.iter().enumerate() {
        let Some((channel, fluxes)) = load.start_fluxes() else { continue };
        let face = solid.face(load.body_and_face().1);
        if load.body_and_face().0 == name && face.temperature.is_none() {
            let path = Path::default().key("load").index(i).key("start").key(channel.key());
            let size = load.start_radius().unwrap_or(f64::INFINITY);
            let is_gaussian = matches!(load.footprint, Footprint::Gaussian { .. });
            let spot = Spot { flux: largest(&fluxes), radius: size, is_gaussian };
            flux_of(reviewer, &path, spot, &Heated::of(solid));
            if let Some(power) = load.start.power.filter(|_| channel.is_of_whole())
                && let Some(finding) = power::implausible_power(load, channel, [power, size])
            {
                reviewer.warn(&path, finding);
            }
        }
    }
}

/// The same of fluxes on faces of a solid of large strain.
fn fluxes_at_large_strain(reviewer: &mut Reviewer, path: &Path, solid: &LargeStrain) {
    let start = solid.initial_temperature;
    let conductor = |Material { heat, .. }: &Material| Conductor {
        conductivity: heat.conductivity.value(start),
        heat_capacity: heat.density * heat.specific_heat.value(start),
    };
    let layers = solid.materials_of_layers().into_iter().map(conductor).collect();
    let heated = Heated { layers, start };
    for (face, condition) in &solid.faces {
        if let Some(flux) = condition.flux {
            let path = path.key("faces").key(face.as_str()).key("flux");
            flux_of(reviewer, &path, Spot::whole(flux), &heated);
        }
    }
}

/// Layers of a solid, and its initial temperature [K].
struct Heated {
    layers: Vec<Conductor>,
    start: f64,
}

impl Heated {
    fn of(solid: &Solid) -> Self {
        let conductor = |law: &Constants| Conductor {
            conductivity: law.conductivity,
            heat_capacity: law.heat_capacity(),
        };
        let layers = solid.strata().into_iter().map(|own| conductor(&own.constants)).collect();
        Self { layers, start: solid.initial_temperature }
    }
}

/// A flux, at most [W/m²], on a round part of a face [m].
#[derive(Clone, Copy)]
struct Spot {
    flux: f64,
    radius: f64,
    is_gaussian: bool,
}

impl Spot {
    fn whole(flux: f64) -> Self {
        Self { flux, radius: f64::INFINITY, is_gaussian: false }
    }

    /// Rise in the middle of a half space's surface after a time [s], if the spot rests [K].
    fn rise(&self, body: Conductor, time: f64) -> f64 {
        let Self { flux, radius, .. } = *self;
        if radius.is_infinite() {
            UniformFlux { body, flux }.rise(0.0, time)
        } else if self.is_gaussian {
            let source = GaussianFlux { body, peak: flux, radius, velocity: 0.0 };
            source.rise_at_centre_at_rest(time)
        } else {
            DiscFlux { body, flux, radius }.rise_on_axis(0.0, time)
        }
    }
}

/// Warns of the rise of a half space's surface under a constant flux.
fn flux_of(reviewer: &mut Reviewer, path: &Path, spot: Spot, heated: &Heated) {
    let flux = spot.flux;
    // For layers, the smallest rise of any of them.
    let time = reviewer.scene.stop_time;
    let rises = heated.layers.iter().map(|layer| spot.rise(*layer, time));
    let rise = rises.reduce(|a, b| if b.abs() < a.abs() { b } else { a }).unwrap_or(0.0);
    if !plausible::HEAT_FLUX.holds(flux) {
        return;
    }
    let about = number((rise.abs() / 10.0).round() * 10.0);
    if rise > HOTTEST_RISE {
        reviewer.warn(path, warning::flux_overheats_surface(about));
    } else if rise < -heated.start {
        reviewer.warn(path, warning::flux_undercools_surface(about));
    }
}

/// Returns the value of the largest magnitude.
fn largest(values: &[f64]) -> f64 {
    values.iter().fold(0.0, |a: f64, b| if b.abs() > a.abs() { *b } else { a })
}
