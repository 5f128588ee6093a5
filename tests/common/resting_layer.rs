//! A layer of fluid at rest on a wall, periodic along it.

use crate::falling_drop::open_space;
use impinge::method::sph::{DropletPlan, DropletSph, Extent, Fluid, ParticleFields, Release, Wall};
use impinge::port::WallCells;

/// Particles along each side of a period.
const SIDE: usize = 6;

/// The wall below a layer: effusivity of a half space [W √s/(m² K)], and conductance of the contact [W/(m² K)].
#[derive(Clone, Copy, Default)]
pub struct Below {
    pub effusivity: Option<f64>,
    pub conductance: Option<f64>,
}

/// A layer in a state, and the area of a period [m²].
pub struct RestingLayer {
    pub drop: DropletSph,
    pub state: Vec<f64>,
    pub area: f64,
}

impl RestingLayer {
    /// Creates a layer of some rows of particles at a temperature [K].
    pub fn of(fluid: Fluid, (spacing, rows): (f64, usize), temperature: f64, below: Below) -> Self {
        let (period, density) = (SIDE as f64 * spacing, fluid.density);
        let never =
            Release { time: 1e9, centre: [0.0; 3], diameter: 0.0, velocity: [0.0; 3], temperature };
        let cells = WallCells::Tiles { count: [1, 1], size: [4.0 * period; 2] };
        let Below { effusivity, conductance } = below;
        let plan = DropletPlan {
            extents: [Extent::Periodic(period), Extent::Periodic(period), Extent::Open],
            releases: vec![never],
            wall: Some(Wall { cells, contact_angle: 1.5, effusivity, conductance }),
            ..open_space(spacing, fluid)
        };
        let mut particles = ParticleFields::default();
        for n in 0..SIDE * SIDE * rows {
            let place = [n % SIDE, n / SIDE % SIDE, n / (SIDE * SIDE)];
            particles.position.push(place.map(|i| (i as f64 + 0.5) * spacing));
            particles.velocity.push([0.0; 3]);
            particles.mass.push(density * spacing.powi(3));
            particles.density.push(density);
            particles.temperature.push(temperature);
        }
        let drop = DropletSph::new(plan, 1);
        let state = drop.state_of(&particles);
        Self { drop, state, area: period * period }
    }

    /// Returns the heat given to the half space in a time [J/m²], which was at a temperature at first [K].
    pub fn advance(&mut self, wall_temperature: f64, duration: f64) -> f64 {
        let exchange = self
            .drop
            .advance_on_half_space(&mut self.state, wall_temperature, duration, &Default::default())
            .unwrap();
        exchange.heat[0] / self.area
    }
}
