//! Drops that surface tension moves: their set-up for the droplet engine, and their closed forms.

use std::f64::consts::PI;

use impinge::closed_form::SwingingDrop;
use impinge::kernel::Kernel;
use impinge::method::sph::{
    DropletPlan, DropletSph, Extent, Fluid, ParticleFields, Placement, Precision, Release, Viscous,
    Wall,
};
use impinge::port::WallCells;
use nalgebra::{DMatrix, DVector};

/// Water, radius 1 mm.
pub const RADIUS: f64 = 1e-3;
pub const DENSITY: f64 = 1000.0;
pub const TENSION: f64 = 0.072;

/// Speed of sound that scenes get where they name none, for a distance of particles [m/s].
pub fn sound_speed(spacing: f64) -> f64 {
    10.0 * (2.0 * TENSION / (DENSITY * spacing)).sqrt()
}

/// A drop about the origin at rest, of some particles over its diameter.
pub fn plan(dimension: usize, across: f64, viscosity: f64) -> DropletPlan {
    DropletPlan {
        dimension,
        axisymmetric: false,
        spacing: 2.0 * RADIUS / across,
        support: 3.0,
        kernel: Kernel::WendlandC2,
        fluid: Fluid {
            density: DENSITY,
            viscosity: viscosity.into(),
            specific_heat: 4000.0,
            conductivity: 0.0,
            surface_tension: TENSION,
            sound_speed: sound_speed(2.0 * RADIUS / across),
            freezing: None,
        },
        placement: Placement::Lattice,
        precision: Precision::Single,
        viscous: Viscous::Explicit,
        density_diffusion: 0.1,
        corrected_diffusion: true,
        shifting: false,
        gravity: [0.0; 3],
        mirrors: [dimension == 3; 2],
        extents: [Extent::Open; 3],
        demand: None,
        feed: None,
        releases: vec![Release {
            time: 0.0,
            centre: [0.0; 3],
            diameter: 2.0 * RADIUS,
            velocity: [0.0; 3],
            temperature: 300.0,
        }],
        wall: None,
    }
}

/// The drop of a plan stretched along z by a factor, its volume kept; with its state.
pub fn stretched(plan: DropletPlan, factor: f64) -> (DropletSph, Vec<f64>) {
    let across = factor.powf(-1.0 / (plan.dimension as f64 - 1.0));
    let drop = DropletSph::new(plan, 1);
    let mut particles = drop.particles(&drop.initial_state());
    for [x, y, z] in &mut particles.position {
        (*x, *y, *z) = (across * *x, across * *y, factor * *z);
    }
    let state = drop.state_of(&particles);
    (drop, state)
}

/// T = 2π √(ρR³/8σ) of the oscillation between oblate and prolate (Rayleigh 1879, doi
/// 10.1098/rspl.1879.0015).
pub fn period() -> f64 {
    2.0 * PI * (DENSITY * RADIUS.powi(3) / (8.0 * TENSION)).sqrt()
}

/// The swing of a plan's drop by the theory of small swings.
pub fn normal_mode(plan: &DropletPlan) -> SwingingDrop {
    SwingingDrop {
        radius: RADIUS,
        density: DENSITY,
        viscosity: plan.fluid.viscosity.constant().expect("a number"),
        surface_tension: TENSION,
    }
}

/// Viscosity [Pa s] for an Ohnesorge number µ/√(ρσR).
pub fn viscosity(ohnesorge: f64) -> f64 {
    ohnesorge * (DENSITY * TENSION * RADIUS).sqrt()
}

/// Elongation of a plan's drop, stretched by a tenth, at times over Rayleigh's period, for 1.3 periods.
pub fn elongations(plan: DropletPlan) -> Vec<[f64; 2]> {
    const SAMPLES: usize = 40;
    let (drop, mut state) = stretched(plan, 1.1);
    let mut rows = vec![[0.0, elongation(&drop.particles(&state))]];
    for sample in 1..=13 * SAMPLES / 10 {
        drop.advance(&mut state, &[], period() / SAMPLES as f64).unwrap();
        rows.push([sample as f64 / SAMPLES as f64, elongation(&drop.particles(&state))]);
    }
    rows
}

/// Decay rate and angular frequency of `e^(−at) (A cos bt + B sin bt) + C` that fits rows of time and value
/// best from 0.3 on, when the layer of vorticity below the surface has formed; by Gauss and Newton's method
/// from a first guess on.
pub fn fitted(rows: &[[f64; 2]], guess: [f64; 2]) -> [f64; 2] {
    let rows: Vec<_> = rows.iter().filter(|row| row[0] >= 0.3).collect();
    let times = DVector::from_iterator(rows.len(), rows.iter().map(|row| row[0]));
    let values = DVector::from_iterator(rows.len(), rows.iter().map(|row| row[1]));
    let terms = |[decay, frequency]: [f64; 2]| {
        DMatrix::from_fn(rows.len(), 3, |i, term| match term {
            0 => (-decay * times[i]).exp() * (frequency * times[i]).cos(),
            1 => (-decay * times[i]).exp() * (frequency * times[i]).sin(),
            _ => 1.0,
        })
    };
    let misfit = |swing: [f64; 2]| {
        let terms = terms(swing);
        let parts = terms.clone().svd(true, true).solve(&values, 1e-12).unwrap();
        terms * parts - &values
    };
    let mut swing = guess;
    for _ in 0..40 {
        const STEP: f64 = 1e-5;
        let here = misfit(swing);
        let ahead = [[STEP, 0.0], [0.0, STEP]]
            .map(|[a, b]| (misfit([swing[0] + a, swing[1] + b]) - &here) / STEP);
        let slopes = DMatrix::from_columns(&ahead);
        let change = slopes.svd(true, true).solve(&here, 1e-12).unwrap();
        swing = [swing[0] - change[0].clamp(-0.3, 0.3), swing[1] - change[1].clamp(-0.3, 0.3)];
    }
    swing
}

/// Mean of z² − (x² + y²)/2 over R², 0 for a sphere.
pub fn elongation(particles: &ParticleFields) -> f64 {
    let ParticleFields { position, mass, .. } = particles;
    let part = |(&[x, y, z], m): (&[f64; 3], &f64)| m * (z * z - 0.5 * (x * x + y * y));
    let sum: f64 = position.iter().zip(mass).map(part).sum();
    sum / mass.iter().sum::<f64>() / (RADIUS * RADIUS)
}

/// Mean pressure in the inner part of a drop over Laplace's 2σ/R.
pub fn core_pressure(particles: &ParticleFields) -> f64 {
    let inside = |x: &[f64; 3]| x.iter().map(|x| x * x).sum::<f64>() < (0.6 * RADIUS).powi(2);
    let pairs = particles.position.iter().zip(&particles.pressure);
    let inner: Vec<f64> = pairs.filter(|(x, _)| inside(x)).map(|(_, p)| *p).collect();
    inner.iter().sum::<f64>() / inner.len() as f64 / (2.0 * TENSION / RADIUS)
}

/// A drop of the volume of a sphere of radius R on a wall that it meets at an angle, without gravity.
pub struct SphericalCap {
    angle: f64,
    /// Of its sphere [m].
    radius: f64,
}

impl SphericalCap {
    /// `4R³ = r³ (1 − cos θ)² (2 + cos θ)`.
    pub fn of(angle: f64) -> Self {
        let cosine = angle.cos();
        let volume = (1.0 - cosine).powi(2) * (2.0 + cosine);
        Self { angle, radius: RADIUS * (4.0 / volume).cbrt() }
    }

    /// The drop, at first a hemisphere at rest.
    pub fn drop(&self, across: f64, viscosity: f64) -> (DropletSph, Vec<f64>) {
        self.drop_of(across, viscosity, |plan| plan)
    }

    /// The same in a model that is made of that of a quarter.
    pub fn drop_of(
        &self,
        across: f64,
        viscosity: f64,
        model: impl Fn(DropletPlan) -> DropletPlan,
    ) -> (DropletSph, Vec<f64>) {
        let cells = WallCells::Rings { count: 1, radius: 10.0 * RADIUS };
        let wall =
            Some(Wall { cells, contact_angle: self.angle, effusivity: None, conductance: None });
        let mut plan = model(DropletPlan { wall, ..plan(3, across, viscosity) });
        // Half of a sphere has the drop's volume.
        plan.releases[0].diameter *= 2f64.cbrt();
        upper_half(DropletSph::new(plan, 1))
    }

    /// Height of the centre of mass and root mean square distance from the axis, over those of the cap.
    pub fn found(&self, particles: &ParticleFields) -> [f64; 2] {
        let ParticleFields { position, mass, .. } = particles;
        let mean = |of: &dyn Fn(&[f64; 3]) -> f64| {
            let sum: f64 = position.iter().zip(mass).map(|(x, m)| m * of(x)).sum();
            sum / mass.iter().sum::<f64>()
        };
        let [height, square] = self.moments();
        let across = mean(&|x| x[0] * x[0] + x[1] * x[1]);
        [mean(&|x| x[2]) / height, (across / square).sqrt()]
    }

    /// Means of z and of x² + y².
    fn moments(&self) -> [f64; 2] {
        let (r, centre) = (self.radius, -self.radius * self.angle.cos());
        // Square of the radius at a height.
        let circle = |z: f64| r * r - (z - centre).powi(2);
        let height = r * (1.0 - self.angle.cos());
        const PARTS: usize = 100;
        let step = height / PARTS as f64;
        let integral = |of: &dyn Fn(f64) -> f64| {
            let part = |n: usize| {
                let z = n as f64 * step;
                step / 6.0 * (of(z) + 4.0 * of(z + 0.5 * step) + of(z + step))
            };
            (0..PARTS).map(part).sum::<f64>()
        };
        let volume = integral(&|z| PI * circle(z));
        [
            integral(&|z| PI * z * circle(z)) / volume,
            integral(&|z| 0.5 * PI * circle(z).powi(2)) / volume,
        ]
    }
}

/// Half of a plane drop on a wall that it meets at an angle [rad], at first at a right one.
pub fn on_wall(across: f64, angle: f64) -> (DropletSph, Vec<f64>) {
    let cells = WallCells::Tiles { count: [1, 1], size: [10.0 * RADIUS, 1.0] };
    let plan = DropletPlan {
        mirrors: [true, false],
        wall: Some(Wall { cells, contact_angle: angle, effusivity: None, conductance: None }),
        ..plan(2, across, 1e-2)
    };
    upper_half(DropletSph::new(plan, 1))
}

/// The state of a drop about the origin of which what is below is cut away.
fn upper_half(drop: DropletSph) -> (DropletSph, Vec<f64>) {
    let whole = drop.particles(&drop.initial_state());
    let above: Vec<usize> = (0..whole.mass.len()).filter(|&i| whole.position[i][2] > 0.0).collect();
    let of = |list: &[f64]| above.iter().map(|&i| list[i]).collect();
    let state = drop.state_of(&ParticleFields {
        position: above.iter().map(|&i| whole.position[i]).collect(),
        velocity: above.iter().map(|&i| whole.velocity[i]).collect(),
        mass: of(&whole.mass),
        density: of(&whole.density),
        pressure: of(&whole.pressure),
        temperature: of(&whole.temperature),
        ..ParticleFields::default()
    });
    (drop, state)
}

/// Half width of a plane drop over R that meets a wall at an angle: a segment of a circle with the area of
/// half the circle of radius R.
pub fn half_width(angle: f64) -> f64 {
    let radius = (0.5 * PI / (angle - angle.sin() * angle.cos())).sqrt();
    radius * angle.sin()
}

/// That of particles: of those of the first layer.
pub fn found_half_width(particles: &ParticleFields, spacing: f64) -> f64 {
    let near = particles.position.iter().filter(|x| x[2] < 1.5 * spacing);
    (near.map(|x| x[0]).fold(0.0, f64::max) + 0.5 * spacing) / RADIUS
}
