//! Classical flows in the plane: their set-up for the droplet engine, and their closed forms.

use std::f64::consts::PI;

use impinge::kernel::Kernel;
use impinge::laws::Viscosity;
use impinge::method::sph::{
    DropletPlan, DropletSph, DropletTotals, Extent, Fluid, ParticleFields, Placement, Precision,
    Viscous, Wall,
};
use impinge::port::WallCells;

/// A model and its state.
pub struct Flow {
    pub drop: DropletSph,
    pub state: Vec<f64>,
}

/// What a flow is made from; in all of them heat plays no part.
pub struct Setup {
    pub spacing: f64,
    /// H/Δx.
    pub support: f64,
    pub density: f64,
    pub viscosity: Viscosity,
    pub sound_speed: f64,
    pub shifting: bool,
    pub viscous: Viscous,
    pub gravity: [f64; 3],
    pub extents: [Extent; 3],
    pub cells: Option<WallCells>,
}

impl Flow {
    /// Starts with a particle at each point [x, z], of the velocity and pressure there.
    pub fn start(
        setup: Setup,
        points: &[[f64; 2]],
        velocity: impl Fn([f64; 2]) -> [f64; 2],
        pressure: impl Fn([f64; 2]) -> f64,
    ) -> Self {
        Self::start_plan(setup.plan(), points, velocity, pressure)
    }

    /// The same with pair interactions in double precision, at zero pressure.
    pub fn start_in_double(
        setup: Setup,
        points: &[[f64; 2]],
        velocity: impl Fn([f64; 2]) -> [f64; 2],
    ) -> Self {
        let plan = DropletPlan { precision: Precision::Double, ..setup.plan() };
        Self::start_plan(plan, points, velocity, |_| 0.0)
    }

    /// Starts from rest with a ring at each point [r, z], of the pressure there.
    pub fn start_rings(
        setup: Setup,
        points: &[[f64; 2]],
        pressure: impl Fn([f64; 2]) -> f64,
    ) -> Self {
        let plan = DropletPlan { dimension: 3, axisymmetric: true, ..setup.plan() };
        Self::start_plan(plan, points, |_| [0.0; 2], pressure)
    }

    /// Starts from rest with a particle at each point [x, z] of the half that the plane x = 0 mirrors.
    pub fn start_half(
        setup: Setup,
        points: &[[f64; 2]],
        pressure: impl Fn([f64; 2]) -> f64,
    ) -> Self {
        let plan = DropletPlan { mirrors: [true, false], ..setup.plan() };
        Self::start_plan(plan, points, |_| [0.0; 2], pressure)
    }

    fn start_plan(
        plan: DropletPlan,
        points: &[[f64; 2]],
        velocity: impl Fn([f64; 2]) -> [f64; 2],
        pressure: impl Fn([f64; 2]) -> f64,
    ) -> Self {
        let Fluid { density, sound_speed, .. } = plan.fluid;
        let area = plan.spacing * plan.spacing;
        let mut particles = ParticleFields::default();
        for &[x, z] in points {
            let [u, w] = velocity([x, z]);
            // Tait's equation of state.
            let stiffness = density * sound_speed * sound_speed / 7.0;
            let here = density * (1.0 + pressure([x, z]) / stiffness).powf(1.0 / 7.0);
            let around = if plan.axisymmetric { 2.0 * PI * x } else { 1.0 };
            particles.position.push([x, 0.0, z]);
            particles.velocity.push([u, 0.0, w]);
            particles.mass.push(here * area * around);
            particles.density.push(here);
            particles.temperature.push(300.0);
        }
        let drop = DropletSph::new(plan, 1);
        let state = drop.state_of(&particles);
        Self { drop, state }
    }

    pub fn advance(&mut self, duration: f64) {
        let cells = self.drop.plan().wall.as_ref().map_or(0, |wall| wall.cells.len());
        self.drop.advance(&mut self.state, &vec![300.0; cells], duration).unwrap();
    }

    pub fn particles(&self) -> ParticleFields {
        self.drop.particles(&self.state)
    }

    pub fn totals(&self) -> DropletTotals {
        self.drop.totals(&self.state)
    }

    /// Root of the summed squared errors of a quantity over that of the exact values.
    pub fn norm<const N: usize>(
        &self,
        value: impl Fn(&ParticleFields, usize) -> [f64; N],
        exact: impl Fn([f64; 2]) -> [f64; N],
    ) -> f64 {
        let particles = self.particles();
        let (mut error, mut whole) = (0.0, 0.0);
        for (i, &[x, _, z]) in particles.position.iter().enumerate() {
            for (value, exact) in value(&particles, i).into_iter().zip(exact([x, z])) {
                error += (value - exact).powi(2);
                whole += exact * exact;
            }
        }
        (error / whole).sqrt()
    }
}

impl Setup {
    fn plan(self) -> DropletPlan {
        let fluid = Fluid {
            density: self.density,
            viscosity: self.viscosity,
            specific_heat: 1.0,
            conductivity: 0.0,
            surface_tension: 0.0,
            sound_speed: self.sound_speed,
            freezing: None,
        };
        DropletPlan {
            dimension: 2,
            axisymmetric: false,
            spacing: self.spacing,
            support: self.support,
            kernel: Kernel::WendlandC2,
            fluid,
            placement: Placement::Lattice,
            precision: Precision::Single,
            viscous: self.viscous,
            density_diffusion: 0.1,
            corrected_diffusion: true,
            shifting: self.shifting,
            gravity: self.gravity,
            mirrors: [false; 2],
            extents: self.extents,
            demand: None,
            feed: None,
            releases: Vec::new(),
            wall: self.cells.map(|cells| Wall {
                cells,
                contact_angle: 0.5 * PI,
                effusivity: None,
                conductance: None,
            }),
        }
    }
}

/// Middles of square cells.
pub fn lattice(columns: usize, rows: usize, spacing: f64) -> Vec<[f64; 2]> {
    let at = |i: usize| (i as f64 + 0.5) * spacing;
    (0..rows * columns).map(|n| [at(n % columns), at(n / columns)]).collect()
}

/// A lattice over the unit square, periodic in it, whose rows rise by one in two: distance `1/(m √5)`.
pub fn tilted_lattice(m: usize) -> (f64, Vec<[f64; 2]>) {
    let spacing = 1.0 / (m as f64 * 5f64.sqrt());
    let m = m as i64;
    // In units of 1/(5m); the offset keeps points off the edges.
    let places = (-5 * m..5 * m).flat_map(|i| (-5 * m..5 * m).map(move |j| [2 * i - j, i + 2 * j]));
    let inside = places.filter(|place| place.iter().all(|p| (0..5 * m).contains(p)));
    let at = |p: i64| (p as f64 + 0.5) / (5 * m) as f64;
    (spacing, inside.map(|place| place.map(at)).collect())
}

/// Flow between plates at distance H = 1 m under a pressure gradient of 10 Pa/m, viscosity 1 mPa s
/// (Park 2019, §2.4.5.2), from rest. The density, which no steady shear depends on, makes the
/// Reynolds number of the largest velocity 10.
pub struct Poiseuille;

impl Poiseuille {
    pub const GRADIENT: f64 = 10.0;
    const VISCOSITY: f64 = 1e-3;
    const FASTEST: f64 = Self::GRADIENT / (8.0 * Self::VISCOSITY);
    const DENSITY: f64 = 10.0 * Self::VISCOSITY / Self::FASTEST;
    /// Time H²/ν in which the viscosity acts over the distance of the plates [s].
    pub const TIME: f64 = Self::DENSITY / Self::VISCOSITY;
    /// Period along the plates [m].
    pub const LENGTH: f64 = 1.2;
    /// Tiles of the lower plate over one period.
    pub const TILES: usize = 12;

    pub fn start(rows: usize, support: f64) -> Flow {
        let spacing = 1.0 / rows as f64;
        // Tiles are centred on the origin, so that half of them lie beside the period.
        let cells =
            WallCells::Tiles { count: [2 * Self::TILES, 1], size: [2.0 * Self::LENGTH, 1.0] };
        let setup = Setup {
            spacing,
            support,
            density: Self::DENSITY,
            viscosity: Self::VISCOSITY.into(),
            sound_speed: 10.0 * Self::FASTEST,
            shifting: true,
            viscous: Viscous::Explicit,
            gravity: [Self::GRADIENT / Self::DENSITY, 0.0, 0.0],
            extents: [Extent::Periodic(Self::LENGTH), Extent::Open, Extent::Closed(1.0)],
            cells: Some(cells),
        };
        let columns = (Self::LENGTH / spacing).round() as usize;
        Flow::start(setup, &lattice(columns, rows, spacing), |_| [0.0; 2], |_| 0.0)
    }

    /// Velocity at a height z; Σ over odd n (Morris, Fox & Zhu 1997, doi 10.1006/jcph.1997.5776):
    /// `u = u_m [4z(1 − z) − Σ 32/(nπ)³ sin(nπz) exp(−n²π²νt/H²)]`.
    pub fn velocity(z: f64, time: f64) -> f64 {
        let decayed = odd_modes()
            .take(50)
            .map(|k| 32.0 / k.powi(3) * (k * z).sin() * (-k * k * time / Self::TIME).exp());
        Self::FASTEST * (4.0 * z * (1.0 - z) - decayed.sum::<f64>())
    }

    /// Mean of the shear at a plate between two times [Pa].
    pub fn mean_shear(begin: f64, end: f64) -> f64 {
        // The impulse a unit of area since the start.
        let impulse = |time: f64| {
            let missing =
                |k: f64| 4.0 / k.powi(4) * Self::TIME * (1.0 - (-k * k * time / Self::TIME).exp());
            Self::GRADIENT * (0.5 * time - odd_modes().take(1000).map(missing).sum::<f64>())
        };
        (impulse(end) - impulse(begin)) / (end - begin)
    }

    /// Relative error of the velocities (norm).
    pub fn error(flow: &Flow, time: f64) -> f64 {
        flow.norm(|p, i| [p.velocity[i][0]], |[_, z]| [Self::velocity(z, time)])
    }

    /// Shear on each tile of a period [Pa], as a mean over the last step.
    pub fn shear(flow: &Flow) -> Vec<f64> {
        let exchange = flow.drop.exchange(&flow.state);
        let area = Self::LENGTH / Self::TILES as f64;
        let tiles = &exchange.impulse[Self::TILES..];
        tiles.iter().map(|impulse| impulse[0] / (exchange.duration * area)).collect()
    }
}

/// nπ for n = 1, 3, 5 …
fn odd_modes() -> impl Iterator<Item = f64> {
    (0..).map(|n: u32| f64::from(2 * n + 1) * PI)
}

/// Vortices in a periodic square of 1 m, Re 100 for a velocity of 1 m/s.
pub struct TaylorGreen;

impl TaylorGreen {
    const VISCOSITY: f64 = 0.01;
    /// Decay rate of the kinetic energy, 2 · 2νk² for k = 2π [1/s].
    pub const DECAY: f64 = 16.0 * Self::VISCOSITY * PI * PI;

    /// On a tilted lattice, 5m² particles. (Along the axes the flow would draw the rows of a lattice
    /// apart just where it stagnates.)
    pub fn start(m: usize, support: f64) -> Flow {
        let (spacing, points) = tilted_lattice(m);
        Self::start_on(spacing, &points, support)
    }

    pub fn start_on(spacing: f64, points: &[[f64; 2]], support: f64) -> Flow {
        Self::start_with(Viscous::Explicit, spacing, points, support)
    }

    pub fn start_with(viscous: Viscous, spacing: f64, points: &[[f64; 2]], support: f64) -> Flow {
        let setup = Setup {
            spacing,
            support,
            density: 1000.0,
            viscosity: (1000.0 * Self::VISCOSITY).into(),
            sound_speed: 10.0,
            shifting: true,
            viscous,
            gravity: [0.0; 3],
            extents: [Extent::Periodic(1.0), Extent::Open, Extent::Periodic(1.0)],
            cells: None,
        };
        let pressure = |[x, z]: [f64; 2]| -250.0 * ((4.0 * PI * x).cos() + (4.0 * PI * z).cos());
        Flow::start(setup, points, |at| Self::velocity(at, 0.0), pressure)
    }

    pub fn velocity([x, z]: [f64; 2], time: f64) -> [f64; 2] {
        let [[sx, cx], [sz, cz]] = [x, z].map(|x| [(2.0 * PI * x).sin(), (2.0 * PI * x).cos()]);
        let decay = (-0.5 * Self::DECAY * time).exp();
        [-decay * cx * sz, decay * sx * cz]
    }

    /// Relative error of the velocities (norm).
    pub fn error(flow: &Flow, time: f64) -> f64 {
        let value = |p: &ParticleFields, i: usize| [p.velocity[i][0], p.velocity[i][2]];
        flow.norm(value, |at| Self::velocity(at, time))
    }
}

/// A column of water of 1 m between side walls, at rest under its weight, as wide as high.
pub struct Column;

impl Column {
    const GRAVITY: f64 = 9.81;
    const DENSITY: f64 = 1000.0;
    const SOUND_SPEED: f64 = 45.0;
    /// Of the pressure, ρgH [Pa].
    pub const SCALE: f64 = Self::DENSITY * Self::GRAVITY;

    pub fn start(rows: usize) -> Flow {
        Self::start_with(rows, 1e-3, Viscous::Explicit)
    }

    /// A column of a fluid of some viscosity [Pa s].
    pub fn start_with(rows: usize, viscosity: f64, viscous: Viscous) -> Flow {
        let spacing = 1.0 / rows as f64;
        let setup = Setup {
            spacing,
            support: 3.0,
            density: Self::DENSITY,
            viscosity: viscosity.into(),
            sound_speed: Self::SOUND_SPEED,
            shifting: true,
            viscous,
            gravity: [0.0, 0.0, -Self::GRAVITY],
            extents: [Extent::Closed(1.0), Extent::Open, Extent::Open],
            cells: Some(WallCells::Tiles { count: [1, 1], size: [4.0, 1.0] }),
        };
        Flow::start(setup, &lattice(rows, rows, spacing), |_| [0.0; 2], Self::pressure)
    }

    /// √(H/g) [s].
    pub fn time() -> f64 {
        (1.0 / Self::GRAVITY).sqrt()
    }

    /// Under its weight the fluid of Tait's equation of state has the density
    /// `(ρ/ρ₀)⁶ = 1 + 6g(H − z)/c₀²`.
    pub fn pressure([_, z]: [f64; 2]) -> f64 {
        let square = Self::SOUND_SPEED * Self::SOUND_SPEED;
        let sixth_power = 1.0 + 6.0 * Self::GRAVITY * (1.0 - z) / square;
        Self::DENSITY * square / 7.0 * (sixth_power.powf(7.0 / 6.0) - 1.0)
    }

    /// Force on the wall as a mean over the last step, over the weight.
    pub fn force(flow: &Flow) -> f64 {
        let exchange = flow.drop.exchange(&flow.state);
        -exchange.impulse[0][2] / (exchange.duration * flow.totals().mass * Self::GRAVITY)
    }

    /// Kinetic energy over ρgH³.
    pub fn motion(flow: &Flow) -> f64 {
        flow.totals().kinetic_energy / Self::SCALE
    }
}
