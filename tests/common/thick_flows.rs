//! Flows of thick and yielding fluids whose viscosity is solved implicitly: their set-up for the droplet engine.

use std::f64::consts::PI;

use impinge::closed_form::{HerschelBulkley, YieldingChannel};
use impinge::laws::Viscosity;
use impinge::laws::fluid::viscosity::{self, FluidLaw};
use impinge::method::sph::{Extent, Viscous};
use impinge::port::WallCells;

use crate::classical_flows::{Flow, Setup, lattice};

/// The law of a closed form for the droplet engine.
pub fn law(fluid: HerschelBulkley) -> Viscosity {
    let HerschelBulkley { yield_stress, consistency, exponent } = fluid;
    FluidLaw::HerschelBulkley(viscosity::HerschelBulkley { yield_stress, consistency, exponent })
        .into()
}

/// Flow between plates under a pressure gradient, periodic along them.
#[derive(Clone, Copy)]
pub struct Channel {
    pub fluid: HerschelBulkley,
    pub density: f64,
    /// Distance of the plates [m].
    pub width: f64,
    /// Pressure gradient that drives the steady flow [Pa/m].
    pub gradient: f64,
}

impl Channel {
    /// Paste of Park (2019), §2.6: its plug moves at 1.066667 m/s.
    pub const PASTE: Self = Self {
        fluid: HerschelBulkley { yield_stress: 0.5, consistency: 0.5, exponent: 0.5 },
        density: 1.0,
        width: 0.5,
        gradient: 10.0,
    };
    /// The same, proportional to the rate beyond its yield stress.
    pub const BINGHAM: Self =
        Self { fluid: HerschelBulkley { exponent: 1.0, ..Self::PASTE.fluid }, ..Self::PASTE };

    pub fn exact(&self) -> YieldingChannel {
        YieldingChannel { fluid: self.fluid, gradient: self.gradient, width: self.width }
    }

    /// Starts with rows of particles between the plates at some velocity over the height, under a gradient [Pa/m].
    pub fn start(&self, rows: usize, gradient: f64, velocity: impl Fn(f64) -> f64) -> Flow {
        let (setup, points) = self.setup(rows, gradient);
        Flow::start(setup, &points, |[_, z]| [velocity(z), 0.0], |_| 0.0)
    }

    /// The steady flow, in double precision.
    pub fn start_steady(&self, rows: usize) -> Flow {
        let (setup, points) = self.setup(rows, self.gradient);
        Flow::start_in_double(setup, &points, |[_, z]| [self.exact().velocity(z), 0.0])
    }

    fn setup(&self, rows: usize, gradient: f64) -> (Setup, Vec<[f64; 2]>) {
        let spacing = self.width / rows as f64;
        let setup = Setup {
            spacing,
            support: 3.0,
            density: self.density,
            viscosity: law(self.fluid),
            sound_speed: 10.0,
            shifting: false,
            viscous: Viscous::Implicit { rate: 2.0 },
            gravity: [gradient / self.density, 0.0, 0.0],
            extents: [Extent::Periodic(8.0 * spacing), Extent::Open, Extent::Closed(self.width)],
            cells: Some(WallCells::Tiles { count: [1, 1], size: [10.0; 2] }),
        };
        (setup, lattice(8, rows, spacing))
    }

    /// Relative error of the velocities (norm) of the steady flow.
    pub fn error_of(&self, flow: &Flow) -> f64 {
        flow.norm(|p, i| [p.velocity[i][0]], |[_, z]| [self.exact().velocity(z)])
    }

    /// The same, reached from rest.
    pub fn error(&self, rows: usize) -> f64 {
        let mut flow = self.start(rows, self.gradient, |_| 0.0);
        flow.advance(2.0);
        self.error_of(&flow)
    }
}

/// A body of fluid at rest on a wall that starts to spread under its weight: a cylinder, or a block of which the
/// plane x = 0 mirrors the other half.
#[derive(Clone)]
pub struct Mound {
    pub viscosity: Viscosity,
    pub density: f64,
    pub gravity: f64,
    /// Radius or half-width, and height [m].
    pub size: [f64; 2],
    pub spacing: f64,
    pub sound_speed: f64,
    /// Shear rate of the reference viscosity [1/s].
    pub rate: f64,
    pub is_round: bool,
}

impl Mound {
    pub fn start(&self) -> Flow {
        let [columns, rows] = self.size.map(|size| (size / self.spacing).round() as usize);
        let reach = 100.0 * self.size[0];
        let cells = if self.is_round {
            WallCells::Rings { count: 1, radius: reach }
        } else {
            WallCells::Tiles { count: [1, 1], size: [reach; 2] }
        };
        let setup = Setup {
            spacing: self.spacing,
            support: 3.0,
            density: self.density,
            viscosity: self.viscosity.clone(),
            sound_speed: self.sound_speed,
            shifting: true,
            viscous: Viscous::Implicit { rate: self.rate },
            gravity: [0.0, 0.0, -self.gravity],
            extents: [Extent::Open; 3],
            cells: Some(cells),
        };
        let weight = self.density * self.gravity;
        let pressure = |[_, z]: [f64; 2]| weight * (self.size[1] - z);
        let points = lattice(columns, rows, self.spacing);
        if self.is_round {
            return Flow::start_rings(setup, &points, pressure);
        }
        Flow::start_half(setup, &points, pressure)
    }

    /// Volume, per length of a block [m³ or m²], of one side.
    pub fn volume(&self) -> f64 {
        let [across, height] = self.size;
        if self.is_round { PI * across * across * height } else { across * height }
    }
}
