//! Flows of smoothed particles at settings that no scene reaches, to see where the method fails.
//!
//! `cargo bench --bench flow_limits -- '{"flow": "lattice", "courant": 0.7}'` prints one line of JSON: the values that
//! came out, the seconds of the start and of all steps, the peak of memory, and why it failed, if it did.

use std::f64::consts::PI;
use std::time::Instant;

use impinge::kernel::Kernel;
use impinge::method::sph::{
    DropletPlan, DropletSph, Extent, Failure, Fluid, ParticleFields, Placement, Precision,
    StepShares, Viscous,
};
use serde::{Deserialize, Serialize};

#[allow(dead_code, reason = "one of several files with set-ups of flows")]
#[path = "../tests/common/capillary.rs"]
mod capillary;
#[allow(dead_code, reason = "one of several files with set-ups of flows")]
#[path = "../tests/common/classical_flows.rs"]
mod classical_flows;

/// What a run is asked for; what is left out is as in scenes.
#[derive(Deserialize)]
#[serde(default, deny_unknown_fields)]
struct Run {
    flow: Which,
    kernel: Kernel,
    /// H/Δx.
    support: f64,
    precision: Precision,
    diffusion: f64,
    corrected: bool,
    shifting: bool,
    /// Shares of the bounds of time steps; nothing where a scene's are kept.
    courant: Option<f64>,
    capillary: Option<f64>,
    /// Particles along a side, across a drop or over the width of a column.
    across: f64,
    /// c₀ over the speed of the flow.
    sound: f64,
    /// Reynolds number of vortices.
    reynolds: f64,
    /// ν/(c₀H) of a lattice.
    viscosity: f64,
    /// p₀/(ρ₀c₀²) of a lattice.
    pressure: f64,
    cells: Cells,
    /// Time steps of a lattice.
    steps: usize,
    /// End of vortices over D/U, turns of a square, Rayleigh periods of drops, √(a/2g) of columns.
    stop: f64,
    /// µ/√(ρσR) of drops.
    ohnesorge: f64,
    model: Model,
    /// Length of drops over their diameter.
    stretch: f64,
}

impl Default for Run {
    fn default() -> Self {
        Self {
            flow: Which::Lattice,
            kernel: Kernel::WendlandC2,
            support: 3.0,
            precision: Precision::Single,
            diffusion: 0.1,
            corrected: true,
            shifting: false,
            courant: None,
            capillary: None,
            across: 24.0,
            sound: 10.0,
            reynolds: 100.0,
            viscosity: 0.0,
            pressure: 0.0,
            cells: Cells::Square,
            steps: 200,
            stop: 0.5,
            ohnesorge: 0.1,
            model: Model::Quarter,
            stretch: 1.1,
        }
    }
}

#[derive(Deserialize)]
#[serde(rename_all = "snake_case")]
enum Which {
    /// Fluid at rest under a pressure, between periods.
    Lattice,
    /// Taylor and Green's vortices.
    Vortices,
    /// A square that turns, its inside under tension.
    Square,
    /// A drop that swings.
    Swing,
    /// A column of water that is let go beside a wall.
    Dam,
}

#[derive(Deserialize, PartialEq)]
#[serde(rename_all = "snake_case")]
enum Cells {
    Square,
    Hexagonal,
}

#[derive(Deserialize, PartialEq)]
#[serde(rename_all = "snake_case")]
enum Model {
    Quarter,
    Whole,
    Rings,
}

/// Speed of random motion over that of sound, and temperature of everything [K].
const NOISE: f64 = 1e-6;
const TEMPERATURE: f64 = 300.0;
const DENSITY: f64 = 1000.0;
/// Longest share of H/c₀ in a run that sound alone bounds.
const UNBOUNDED: f64 = 1e9;

#[derive(Serialize, Default)]
struct Values(serde_json::Map<String, serde_json::Value>);

impl Values {
    fn keep(&mut self, name: &str, value: f64) {
        self.0.insert(name.to_owned(), value.into());
    }
}

/// A flow, its state, and what it took to make it.
struct Flow {
    drop: DropletSph,
    state: Vec<f64>,
    start: f64,
    steps: f64,
}

impl Flow {
    fn of(plan: DropletPlan, shares: StepShares, particles: &ParticleFields) -> Self {
        let begin = Instant::now();
        let drop = DropletSph::with_shares(plan, 1, shares);
        let state = drop.state_of(particles);
        Self { drop, state, start: begin.elapsed().as_secs_f64(), steps: 0.0 }
    }

    fn advance(&mut self, duration: f64) -> Result<(), Failure> {
        let begin = Instant::now();
        let advanced = self.drop.advance(&mut self.state, &[], duration);
        self.steps += begin.elapsed().as_secs_f64();
        advanced
    }

    fn particles(&self) -> ParticleFields {
        self.drop.particles(&self.state)
    }

    /// Smallest and mean distance of particles to their nearest over Δx, in a plane with periods.
    fn nearest(&self, periods: Option<[f64; 2]>) -> [f64; 2] {
        let places: Vec<[f64; 2]> =
            self.particles().position.iter().map(|x| [x[0], x[2]]).collect();
        let along = |d: f64, axis: usize| match periods {
            Some(periods) => d - periods[axis] * (d / periods[axis]).round(),
            None => d,
        };
        let apart = |a: &[f64; 2], b: &[f64; 2]| along(a[0] - b[0], 0).hypot(along(a[1] - b[1], 1));
        let nearest = places.iter().enumerate().map(|(i, a)| {
            let others = places.iter().enumerate().filter(|&(j, _)| j != i);
            others.map(|(_, b)| apart(a, b)).fold(f64::INFINITY, f64::min)
        });
        let nearest: Vec<f64> = nearest.map(|r| r / self.drop.plan().spacing).collect();
        let mean = nearest.iter().sum::<f64>() / nearest.len() as f64;
        [nearest.into_iter().fold(f64::INFINITY, f64::min), mean]
    }
}

impl Run {
    fn plan(&self, spacing: f64, viscosity: f64, sound: f64, extents: [Extent; 3]) -> DropletPlan {
        DropletPlan {
            dimension: 2,
            axisymmetric: false,
            spacing,
            support: self.support,
            kernel: self.kernel,
            fluid: Fluid {
                density: DENSITY,
                viscosity: viscosity.into(),
                specific_heat: 1.0,
                conductivity: 0.0,
                surface_tension: 0.0,
                sound_speed: sound,
                freezing: None,
            },
            placement: Placement::Lattice,
            precision: self.precision,
            viscous: Viscous::Explicit,
            density_diffusion: self.diffusion,
            corrected_diffusion: self.corrected,
            shifting: self.shifting,
            gravity: [0.0; 3],
            mirrors: [false; 2],
            extents,
            demand: None,
            feed: None,
            releases: Vec::new(),
            wall: None,
        }
    }

    fn shares(&self) -> StepShares {
        let usual = StepShares::default();
        match self.courant {
            // Nothing else bounds a step whose length is asked for.
            Some(courant) => StepShares {
                courant,
                viscous: UNBOUNDED,
                diffusive: UNBOUNDED,
                capillary: self.capillary.unwrap_or(usual.capillary),
                ..usual
            },
            None => StepShares { capillary: self.capillary.unwrap_or(usual.capillary), ..usual },
        }
    }

    /// Random motion on a lattice: by which factor it has grown, and how close particles have come.
    fn lattice(&self, values: &mut Values) -> Result<Flow, Failure> {
        let side = self.across as usize;
        let (spacing, sound) = (1.0 / self.across, 1.0);
        let (points, periods) = match self.cells {
            Cells::Square => (classical_flows::lattice(side, side, spacing), [1.0, 1.0]),
            Cells::Hexagonal => hexagonal(side),
        };
        let shares = self.shares();
        let height = self.support * spacing;
        let viscosity = self.viscosity * DENSITY * sound * height;
        let extents = [Extent::Periodic(periods[0]), Extent::Open, Extent::Periodic(periods[1])];
        let plan = self.plan(spacing, viscosity, sound, extents);
        let particles = cloud(
            (&points, spacing),
            |n| [0, 1].map(|axis| NOISE * sound * random(2 * n + axis)),
            |_| self.pressure * DENSITY * sound * sound,
            sound,
        );
        let mut flow = Flow::of(plan, shares, &particles);
        let before = speed(&flow.particles());
        // A little less than so many whole steps, however the noise changes these.
        let duration = (self.steps as f64 - 1e-3) * shares.courant * height / sound;
        let outcome = flow.advance(duration);
        values.keep("steps", flow.drop.totals(&flow.state).steps);
        let [closest, mean] = flow.nearest(Some(periods));
        values.keep("growth", speed(&flow.particles()) / before);
        values.keep("closest", closest);
        values.keep("nearest", mean);
        outcome.map(|()| flow)
    }

    /// Errors of vortices on a tilted lattice in a square of 1 m that turn at 1 m/s.
    fn vortices(&self, values: &mut Values) -> Result<Flow, Failure> {
        let (spacing, points) = classical_flows::tilted_lattice(self.across as usize);
        let viscosity = DENSITY / self.reynolds;
        let extents = [Extent::Periodic(1.0), Extent::Open, Extent::Periodic(1.0)];
        let plan = self.plan(spacing, viscosity, self.sound, extents);
        let rate = 8.0 * PI * PI / self.reynolds;
        let wave = |x: f64| (2.0 * PI * x).sin_cos();
        let exact = |[x, z]: [f64; 2], time: f64| {
            let ([sx, cx], [sz, cz]) = (wave(x).into(), wave(z).into());
            let left: f64 = (-rate * time).exp();
            [-left * cx * sz, left * sx * cz]
        };
        let pressure = |[x, z]: [f64; 2], time: f64| {
            let left = (-2.0 * rate * time).exp();
            -0.25 * DENSITY * left * ((4.0 * PI * x).cos() + (4.0 * PI * z).cos())
        };
        let particles = cloud(
            (&points, spacing),
            |n| exact(points[n], 0.0),
            |n| pressure(points[n], 0.0),
            self.sound,
        );
        let mut flow = Flow::of(plan, self.shares(), &particles);
        let before = flow.drop.totals(&flow.state).kinetic_energy;
        flow.advance(self.stop)?;
        let totals = flow.drop.totals(&flow.state);
        let decay = (before / totals.kinetic_energy).ln() / (2.0 * rate * self.stop);
        let p = flow.particles();
        let at = |i: usize| [p.position[i][0], p.position[i][2]];
        let count = p.mass.len();
        let [mut error, mut whole, mut rough, mut pressed] = [0.0; 4];
        let level = p.pressure.iter().sum::<f64>() / count as f64;
        for i in 0..count {
            let exact = exact(at(i), self.stop);
            for (found, exact) in [p.velocity[i][0], p.velocity[i][2]].into_iter().zip(exact) {
                error += (found - exact).powi(2);
                whole += exact * exact;
            }
            let exact = pressure(at(i), self.stop);
            rough += (p.pressure[i] - level - exact).powi(2);
            pressed += exact * exact;
        }
        values.keep("decay", decay);
        values.keep("velocity_error", f64::sqrt(error / whole));
        values.keep("pressure_error", f64::sqrt(rough / pressed));
        values.keep("steps", totals.steps);
        Ok(flow)
    }

    /// How close particles of a square of 1 m that turns at 1 rad/s come, and the energy that is left.
    fn square(&self, values: &mut Values) -> Result<Flow, Failure> {
        let side = self.across as usize;
        let spacing = 1.0 / self.across;
        let points: Vec<[f64; 2]> = classical_flows::lattice(side, side, spacing)
            .into_iter()
            .map(|point| point.map(|x| x - 0.5))
            .collect();
        // Corners move at √½ m/s.
        let sound = self.sound * 0.5f64.sqrt();
        let plan = self.plan(spacing, 0.0, sound, [Extent::Open; 3]);
        let particles = cloud(
            (&points, spacing),
            |n| [points[n][1], -points[n][0]],
            |n| pressure_in_square(points[n]),
            sound,
        );
        let mut flow = Flow::of(plan, self.shares(), &particles);
        let before = flow.drop.totals(&flow.state).kinetic_energy;
        flow.advance(2.0 * PI * self.stop)?;
        let totals = flow.drop.totals(&flow.state);
        let [closest, mean] = flow.nearest(None);
        values.keep("closest", closest);
        values.keep("nearest", mean);
        values.keep("energy", totals.kinetic_energy / before);
        values.keep("stray", totals.stray_mass / totals.mass);
        values.keep("steps", totals.steps);
        Ok(flow)
    }

    /// Frequency and decay of a swing over those of the normal mode, and what has come off.
    fn swing(&self, values: &mut Values) -> Result<Flow, Failure> {
        let viscosity = capillary::viscosity(self.ohnesorge);
        let mut plan = DropletPlan {
            kernel: self.kernel,
            support: self.support,
            precision: self.precision,
            viscous: Viscous::Explicit,
            density_diffusion: self.diffusion,
            corrected_diffusion: self.corrected,
            shifting: self.shifting,
            ..capillary::plan(3, self.across, viscosity)
        };
        plan.fluid.sound_speed *= 0.1 * self.sound;
        plan.mirrors = [self.model == Model::Quarter; 2];
        plan.axisymmetric = self.model == Model::Rings;
        let exact = capillary::normal_mode(&plan).decay_and_frequency();
        let (initial, mut particles) = {
            let (drop, state) = capillary::stretched(plan.clone(), self.stretch);
            (drop.totals(&state).surface_energy, drop.particles(&state))
        };
        // A drop at rest is not at rest on a lattice.
        particles.temperature.iter_mut().for_each(|t| *t = TEMPERATURE);
        let mut flow = Flow::of(plan, self.shares(), &particles);
        const SAMPLES: f64 = 40.0;
        let mut rows = vec![[0.0, capillary::elongation(&flow.particles())]];
        for sample in 1..=(SAMPLES * self.stop) as usize {
            flow.advance(capillary::period() / SAMPLES)?;
            rows.push([sample as f64 / SAMPLES, capillary::elongation(&flow.particles())]);
        }
        let totals = flow.drop.totals(&flow.state);
        values.keep("stray", totals.stray_mass / totals.mass);
        values.keep("motion", totals.kinetic_energy / initial);
        values.keep("steps", totals.steps);
        if self.stop > 1.0 {
            let exact = exact.map(|rate| rate * capillary::period());
            let [decay, frequency] = capillary::fitted(&rows, exact);
            values.keep("decay", decay / exact[0]);
            values.keep("frequency", frequency / exact[1]);
        }
        Ok(flow)
    }

    /// How far a column of water of 1 m by 2 m has gone, over its width: its front from where it began, its middle.
    /// Floor and walls let it slip but for water's own viscosity.
    fn dam(&self, values: &mut Values) -> Result<Flow, Failure> {
        let columns = self.across as usize;
        let spacing = 1.0 / self.across;
        let points = classical_flows::lattice(columns, dam::TALL * columns, spacing);
        let sound = self.sound * dam::fastest();
        let extents = [Extent::Closed(dam::TANK), Extent::Open, Extent::Closed(dam::TANK)];
        let mut plan = self.plan(spacing, dam::VISCOSITY, sound, extents);
        plan.gravity = [0.0, 0.0, -dam::GRAVITY];
        let particles =
            cloud((&points, spacing), |_| [0.0; 2], |n| dam::pressure(points[n]), sound);
        let mut flow = Flow::of(plan, self.shares(), &particles);
        let [front, middle] = dam::places(&particles);
        let energy = dam::energy(&particles);
        flow.advance(self.stop / (2.0 * dam::GRAVITY).sqrt())?;
        let particles = flow.particles();
        let [front_now, middle_now] = dam::places(&particles);
        values.keep("front", 1.0 + front_now - front);
        values.keep("middle", 0.5 + middle_now - middle);
        values.keep("energy", dam::energy(&particles) / energy);
        values.keep("steps", flow.drop.totals(&flow.state).steps);
        Ok(flow)
    }
}

/// The column of water of Martin & Moyce (1952, doi 10.1098/rsta.1952.0006), twice as high as wide.
mod dam {
    use std::f64::consts::PI;

    use super::{DENSITY, ParticleFields};

    pub const GRAVITY: f64 = 9.81;
    pub const VISCOSITY: f64 = 1e-3;
    /// Height over the width of 1 m.
    pub const TALL: usize = 2;
    /// Width and height of the tank [m].
    pub const TANK: f64 = 4.0;

    /// Speed of a fall over the height [m/s].
    pub fn fastest() -> f64 {
        (2.0 * GRAVITY * TALL as f64).sqrt()
    }

    /// That of an incompressible fluid as it is let go: harmonic, nothing at the free faces, and with the weight's
    /// slope on the floor, `Σ 4ρg(−1)ⁿ/(π(2n + 1)k) cos(kx) sinh(k(H − z))/cosh(kH)`, `k = (n + ½)π/a`.
    pub fn pressure([x, z]: [f64; 2]) -> f64 {
        let height = TALL as f64;
        let term = |n: u32| {
            let (sign, odd) = (1.0 - 2.0 * f64::from(n % 2), f64::from(2 * n + 1));
            let k = 0.5 * PI * odd;
            // sinh(k(H − z))/cosh(kH), which overflow by themselves.
            let fall = ((-k * z).exp() - (-k * (2.0 * height - z)).exp())
                / (1.0 + (-2.0 * k * height).exp());
            4.0 * DENSITY * GRAVITY * sign / (PI * odd * k) * (k * x).cos() * fall
        };
        (0..200).map(term).sum()
    }

    /// The furthest particle and the middle of all along x [m].
    pub fn places(particles: &ParticleFields) -> [f64; 2] {
        let along = || particles.position.iter().map(|x| x[0]);
        let weighted: f64 = along().zip(&particles.mass).map(|(x, m)| x * m).sum();
        [along().fold(0.0, f64::max), weighted / particles.mass.iter().sum::<f64>()]
    }

    /// Kinetic energy and that of the height [J].
    pub fn energy(particles: &ParticleFields) -> f64 {
        let of = |n: usize| {
            let square: f64 = particles.velocity[n].iter().map(|v| v * v).sum();
            particles.mass[n] * (0.5 * square + GRAVITY * particles.position[n][2])
        };
        (0..particles.mass.len()).map(of).sum()
    }
}

/// That of a square of an incompressible fluid that turns at 1 rad/s (Le Touzé, Colagrossi, Colicchio & Greco 2013,
/// Int. J. Numer. Methods Fluids 73, 660–691, doi 10.1002/fld.3819).
fn pressure_in_square([x, z]: [f64; 2]) -> f64 {
    let odd = || (1..40).step_by(2).map(|n| PI * f64::from(n));
    let term = |m: f64, n: f64| {
        let wave = (m * (x + 0.5)).sin() * (n * (z + 0.5)).sin();
        -32.0 * DENSITY * wave / (m * n * (m * m + n * n))
    };
    odd().flat_map(|m| odd().map(move |n| term(m, n))).sum()
}

/// Particles at points, of a velocity and pressure each.
fn cloud(
    (points, spacing): (&[[f64; 2]], f64),
    velocity: impl Fn(usize) -> [f64; 2],
    pressure: impl Fn(usize) -> f64,
    sound: f64,
) -> ParticleFields {
    let mut particles = ParticleFields::default();
    for (n, &[x, z]) in points.iter().enumerate() {
        let [u, w] = velocity(n);
        // Tait's equation of state.
        let stiffness = DENSITY * sound * sound / 7.0;
        let density = DENSITY * (1.0 + pressure(n) / stiffness).powf(1.0 / 7.0);
        particles.position.push([x, 0.0, z]);
        particles.velocity.push([u, 0.0, w]);
        particles.mass.push(density * spacing * spacing);
        particles.density.push(density);
        particles.temperature.push(TEMPERATURE);
    }
    particles
}

/// A lattice of triangles with about as many particles along both sides of its periods, and these; a particle has the
/// area of one on a square lattice.
fn hexagonal(side: usize) -> (Vec<[f64; 2]>, [f64; 2]) {
    let rows = 2 * ((side as f64 / 3f64.sqrt()).round() as usize);
    let spacing = 1.0 / side as f64;
    let apart = spacing * (2.0 / 3f64.sqrt()).sqrt();
    let rise = 0.5 * 3f64.sqrt() * apart;
    let at = |n: usize| {
        let (row, column) = (n / side, n % side);
        let offset = 0.25 + 0.5 * (row % 2) as f64;
        [(column as f64 + offset) * apart, (row as f64 + 0.5) * rise]
    };
    ((0..rows * side).map(at).collect(), [side as f64 * apart, rows as f64 * rise])
}

/// Between −1 and 1, without order (Weyl 1916).
fn random(n: usize) -> f64 {
    let mut bits = (n as u64 + 1).wrapping_mul(0x9e37_79b9_7f4a_7c15);
    bits = (bits ^ (bits >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    bits = (bits ^ (bits >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    2.0 * ((bits ^ (bits >> 31)) >> 11) as f64 / (1u64 << 53) as f64 - 1.0
}

/// Root mean square.
fn speed(particles: &ParticleFields) -> f64 {
    let squares: f64 = particles.velocity.iter().flatten().map(|v| v * v).sum();
    (squares / particles.velocity.len() as f64).sqrt()
}

/// Peak of this process [B].
fn peak_memory() -> f64 {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"));
    let kibibytes = line.and_then(|line| line.split_whitespace().next()?.parse::<f64>().ok());
    1024.0 * kibibytes.unwrap_or(0.0)
}

fn main() {
    let asked = std::env::args().find(|word| word.starts_with('{'));
    let asked = asked.unwrap_or_else(|| "{}".to_owned());
    let run: Run = serde_json::from_str(&asked).expect("the run is asked for in JSON");
    let mut values = Values::default();
    let outcome = match run.flow {
        Which::Lattice => run.lattice(&mut values),
        Which::Vortices => run.vortices(&mut values),
        Which::Square => run.square(&mut values),
        Which::Swing => run.swing(&mut values),
        Which::Dam => run.dam(&mut values),
    };
    let (start, steps, failure) = match outcome {
        Ok(flow) => (flow.start, flow.steps, String::new()),
        Err(failure) => (0.0, 0.0, failure.to_string()),
    };
    println!(
        "{}",
        serde_json::json!({
            "values": values, "start": start, "steps": steps, "memory": peak_memory(), "failure": failure,
        })
    );
}
