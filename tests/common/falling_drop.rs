//! Fluid without anything around it, and a drop of water that hits a cold wall, for tests.

use std::f64::consts::PI;

use impinge::kernel::Kernel;
use impinge::laws::Viscosity;
use impinge::method::sph::{
    DropletPlan, DropletSph, Extent, Fluid, Placement, Precision, Release, Viscous, Wall,
};
use impinge::port::WallCells;

pub const DIAMETER: f64 = 1e-4;
pub const SPEED: f64 = 50.0;
pub const HOT: f64 = 373.15;
pub const COLD: f64 = 293.15;
pub const RINGS: usize = 30;

/// Hot water, without surface tension.
pub const WATER: Fluid = Fluid {
    density: 1000.0,
    viscosity: Viscosity::Constant(3e-4),
    specific_heat: 4000.0,
    conductivity: 0.6,
    surface_tension: 0.0,
    sound_speed: 500.0,
    freezing: None,
};

/// Particles of a fluid in open space, as scenes have them, without any drop.
pub fn open_space(spacing: f64, fluid: Fluid) -> DropletPlan {
    DropletPlan {
        dimension: 3,
        axisymmetric: false,
        spacing,
        support: 3.0,
        kernel: Kernel::WendlandC2,
        fluid,
        placement: Placement::Lattice,
        precision: Precision::Single,
        viscous: Viscous::Explicit,
        density_diffusion: 0.1,
        corrected_diffusion: true,
        shifting: true,
        gravity: [0.0; 3],
        mirrors: [false; 2],
        extents: [Extent::Open; 3],
        demand: None,
        feed: None,
        releases: Vec::new(),
        wall: None,
    }
}

/// A quarter of a drop, with some particles over its diameter, half a distance above a wall of cells that it hits at a
/// speed [m/s].
pub fn above_wall(
    [diameter, across, speed]: [f64; 3],
    temperature: f64,
    fluid: Fluid,
    cells: WallCells,
) -> DropletPlan {
    let spacing = diameter / across;
    DropletPlan {
        mirrors: [true; 2],
        releases: vec![Release {
            time: 0.0,
            centre: [0.0, 0.0, 0.5 * (diameter + spacing)],
            diameter,
            velocity: [0.0, 0.0, -speed],
            temperature,
        }],
        wall: Some(Wall { cells, contact_angle: 0.5 * PI, effusivity: None, conductance: None }),
        ..open_space(spacing, fluid)
    }
}

/// A quarter of a drop, with some particles over its diameter, that is about to hit a wall of rings.
pub fn falling_drop(across: f64, fluid: Fluid) -> DropletPlan {
    let rings = WallCells::Rings { count: RINGS, radius: 1.5e-4 };
    above_wall([DIAMETER, across, SPEED], HOT, fluid, rings)
}

/// A state after some steps of 0.25 µs, an eighth of D/U, above a cold wall.
pub fn run(drop: &DropletSph, steps: usize) -> Vec<f64> {
    let mut state = drop.initial_state();
    for _ in 0..steps {
        drop.advance(&mut state, &[COLD; RINGS], 0.25e-6).unwrap();
    }
    state
}
