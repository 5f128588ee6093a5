//! Lattices: strips of concrete that soften and break, with the scene's data that concern them.

mod forecast;
mod moving;
mod plan;
mod resting;
mod totals;

pub use forecast::LatticeForecast;
pub use moving::MovingLatticeBody;
pub use resting::RestingLatticeBody;
pub use totals::offered_totals;

use crate::body::BodyError;
use crate::method::lattice::{LatticeError, Particles};
use crate::method::sph::ParticleFields;

/// Gives an error the name of its body.
fn named(body: &str, error: LatticeError) -> BodyError {
    let body = body.to_owned();
    match error {
        LatticeError::Halted(halt) => BodyError::Halted { body, halt },
        error => BodyError::Lattice { body, error },
    }
}

/// Material and temperature of what is drawn.
struct Drawn {
    /// [kg/m³]
    density: f64,
    /// [m]
    thickness: f64,
    /// [K]
    temperature: f64,
}

impl Drawn {
    /// Particles in files, from displacements [m], velocities [m/s], and damage and pressure [Pa] of each.
    fn particles(
        &self,
        particles: &Particles,
        motion: impl Iterator<Item = [[f64; 2]; 2]>,
        inside: Vec<(f64, f64)>,
    ) -> ParticleFields {
        let mut fields = ParticleFields::default();
        let mass = self.density * self.thickness;
        let all = particles.places.iter().zip(&particles.cells).zip(motion).zip(inside);
        for (((place, cell), [moved, velocity]), (damage, pressure)) in all {
            fields.position.push([place[0] + moved[0], 0.0, place[1] + moved[1]]);
            fields.velocity.push([velocity[0], 0.0, velocity[1]]);
            fields.mass.push(mass * cell.area);
            fields.density.push(self.density);
            fields.pressure.push(pressure);
            fields.temperature.push(self.temperature);
            fields.damage.push(damage);
        }
        fields
    }
}
