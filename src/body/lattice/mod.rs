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

use crate::body::Memo;
use crate::method::lattice::Particles;
use crate::method::sph::ParticleFields;
use totals::Seen;

/// Lazily computed readings of a state.
#[derive(Default)]
struct LatticeMemo(Option<Seen>);

impl LatticeMemo {
    fn of_mut(memo: &mut Memo) -> &mut Self {
        memo.downcast_mut().expect("a memo of the body that made it")
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
