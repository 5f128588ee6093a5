//! How far a drop spreads on a wall that it hits, beside correlations of measurements.

use std::f64::consts::PI;
use std::time::Instant;

use impinge::method::sph::{DropletPlan, DropletSph, Fluid};
use impinge::port::WallCells;

use crate::falling_drop::above_wall;
use crate::study::keep;

const REYNOLDS: f64 = 500.0;
const WEBERS: [f64; 5] = [10.0, 30.0, 100.0, 200.0, 400.0];
const CONTACT_ANGLE: f64 = 0.5 * PI;
/// [m], [m/s], [kg/m³]
pub const DIAMETER: f64 = 2e-3;
pub const SPEED: f64 = 1.0;
pub const DENSITY: f64 = 1000.0;
/// D/U [s].
pub const TIME: f64 = DIAMETER / SPEED;

const NAMES: [&str; 5] = [
    "Clanet et al. (2004)",
    "Pasandideh-Fard et al. (1996)",
    "Roisman (2009)",
    "Laan et al. (2014)",
    "Wildeman et al. (2016)",
];
/// How many of them are correlations of measurements.
const MEASURED: usize = 4;

/// D_max/D after the [`NAMES`], for We = ρU²D/σ and Re = ρUD/µ:
/// - `We^(1/4)` (C. Clanet et al., J. Fluid Mech. 517 (2004) 199, doi 10.1017/S0022112004000904), of
///   drops that hardly wet and are not stopped by viscosity, `We < Re^(4/5)`;
/// - `√((We + 12)/(3(1 − cos θ) + 4We/√Re))` (M. Pasandideh-Fard et al., Phys. Fluids 8 (1996) 650, doi
///   10.1063/1.868850);
/// - `0.87 Re^(1/5) − 0.40 Re^(2/5) We^(−1/2)` (I. V. Roisman, Phys. Fluids 21 (2009) 052104, doi
///   10.1063/1.3129283);
/// - `Re^(1/5) √P/(1.24 + √P)` with `P = We Re^(−2/5)` (N. Laan et al., Phys. Rev. Applied 2 (2014)
///   044018, doi 10.1103/PhysRevApplied.2.044018);
/// - the root β of `3(1 − cos θ) β²/We + 0.7 β² √(β − 1)/√Re = 12/We + 1/2`, which fits computed drops
///   above We 30 (S. Wildeman et al., J. Fluid Mech. 805 (2016) 636, doi 10.1017/jfm.2016.584).
fn correlations(weber: f64) -> [f64; 5] {
    let energy =
        (weber + 12.0) / (3.0 * (1.0 - CONTACT_ANGLE.cos()) + 4.0 * weber / REYNOLDS.sqrt());
    let root = (weber * REYNOLDS.powf(-0.4)).sqrt();
    [
        weber.powf(0.25),
        energy.sqrt(),
        0.87 * REYNOLDS.powf(0.2) - 0.40 * REYNOLDS.powf(0.4) / weber.sqrt(),
        REYNOLDS.powf(0.2) * root / (1.24 + root),
        wildeman(weber),
    ]
}

fn wildeman(weber: f64) -> f64 {
    let wetted = 3.0 * (1.0 - CONTACT_ANGLE.cos()) / weber;
    let lost = |beta: f64| 0.7 * (beta - 1.0).sqrt() / REYNOLDS.sqrt();
    let too_wide = |beta: f64| beta * beta * (wetted + lost(beta)) > 12.0 / weber + 0.5;
    let mut between = [1.0, 10.0];
    while between[1] - between[0] > 1e-9 {
        let middle = 0.5 * (between[0] + between[1]);
        between[usize::from(too_wide(middle))] = middle;
    }
    between[0]
}

/// That of scenes that name none [m/s].
fn sound_speed(weber: f64, resolution: usize) -> f64 {
    10.0 * SPEED * (2.0 * resolution as f64 / weber).sqrt().max(1.0)
}

/// A quarter of a drop with so many particles over its diameter, half a distance above the wall.
pub fn drop_of(weber: f64, reynolds: f64, resolution: usize) -> DropletSph {
    let fluid = Fluid {
        density: DENSITY,
        viscosity: (DENSITY * SPEED * DIAMETER / reynolds).into(),
        specific_heat: 4000.0,
        conductivity: 0.0,
        surface_tension: DENSITY * SPEED * SPEED * DIAMETER / weber,
        sound_speed: sound_speed(weber, resolution),
        freezing: None,
    };
    let cells = WallCells::Rings { count: 1, radius: 5.0 * DIAMETER };
    let plan = above_wall([DIAMETER, resolution as f64, SPEED], 293.15, fluid, cells);
    let plan = DropletPlan { shifting: false, ..plan };
    DropletSph::new(plan, 2)
}

/// What is asked of a run, lengths over D and times over D/U.
struct Spread {
    /// Time and spread from step to step.
    history: Vec<[f64; 2]>,
    /// The largest one, and its time.
    largest: f64,
    time: f64,
    /// Distance to the axis, height and speed over U of all particles at that time.
    shape: Vec<[f64; 3]>,
    /// What it took to compute [s], until the film drew back.
    seconds: f64,
}

impl Spread {
    /// Share of the fluid beyond the film when that is widest: fingers and what flew off.
    fn beyond(&self) -> f64 {
        let beyond = self.shape.iter().filter(|[radius, ..]| *radius > 0.5 * self.largest);
        beyond.count() as f64 / self.shape.len() as f64
    }
}

/// Until the film has drawn back by a tenth of D, or five D/U have gone by.
fn spread(weber: f64, reynolds: f64, resolution: usize) -> Spread {
    const STEP: f64 = 0.05;
    let drop = drop_of(weber, reynolds, resolution);
    let mut state = drop.initial_state();
    let mut run =
        Spread { history: Vec::new(), largest: 0.0, time: 0.0, shape: Vec::new(), seconds: 0.0 };
    let mut now = 0.0;
    let begin = Instant::now();
    while now < 5.0 {
        drop.advance(&mut state, &[293.15], STEP * TIME).unwrap();
        now += STEP;
        let spread = drop.totals(&state).spread_diameter / DIAMETER;
        run.history.push([now, spread]);
        if spread > run.largest {
            (run.largest, run.time) = (spread, now);
            let p = drop.particles(&state);
            let of = |(x, v): (&[f64; 3], &[f64; 3])| {
                let speed = v.iter().map(|v| v * v).sum::<f64>().sqrt() / SPEED;
                [x[0].hypot(x[1]) / DIAMETER, x[2] / DIAMETER, speed]
            };
            run.shape = p.position.iter().zip(&p.velocity).map(of).collect();
        } else if spread < run.largest - 0.1 {
            break;
        }
    }
    run.seconds = begin.elapsed().as_secs_f64();
    run
}

#[test]
fn largest_spread_of_drops() {
    const RESOLUTIONS: [usize; 2] = [24, 48];
    let (mut histories, mut shapes, mut largest) = (Vec::new(), Vec::new(), Vec::new());
    println!("\n### Largest spread D_max/D of drops, Re 500, contact angle 90°\n");
    println!(
        "| We | D/Δx | D_max/D | at t U/D | fluid beyond | largest step | computed in | {} |",
        NAMES.join(" | ")
    );
    println!("|---|---|---|---|---|---|---|---|---|---|---|---|");
    let pairs = |resolution: usize| WEBERS.map(|weber| (weber, resolution));
    let others = [30.0, 100.0].map(|weber| [16, 36, 64].map(|resolution| (weber, resolution)));
    for (weber, resolution) in [RESOLUTIONS.map(pairs).concat(), others.concat()].concat() {
        let run = spread(weber, REYNOLDS, resolution);
        let steps = run.history.windows(2).map(|pair| (pair[1][1] - pair[0][1]).abs());
        // The first layer lands at once.
        let jump = steps.skip(5).fold(0.0, f64::max);
        let values = correlations(weber);
        let list: Vec<String> = values.iter().map(|value| format!("{value:.2}")).collect();
        println!(
            "| {weber} | {resolution} | {:.2} | {:.2} | {:.1} % | {jump:.3} | {:.1} s | {} |",
            run.largest,
            run.time,
            100.0 * run.beyond(),
            run.seconds,
            list.join(" | ")
        );
        assert!(jump < 0.2, "{weber}: {jump}");
        let case = [weber, resolution as f64];
        largest.push([&case[..], &[run.largest, run.time, run.seconds], &values].concat());
        histories.extend(run.history.iter().map(|row| [&case[..], row].concat()));
        shapes.extend(run.shape.iter().map(|row| [&case[..], row].concat()));
    }
    let at = |weber: f64, resolution: usize| {
        let case = |row: &&Vec<f64>| row[0] == weber && row[1] == resolution as f64;
        largest.iter().find(case).unwrap()[2]
    };
    for weber in WEBERS {
        let measured = &correlations(weber)[..MEASURED];
        let [low, high] =
            [f64::min, f64::max].map(|of| measured.iter().copied().reduce(of).unwrap());
        let [coarse, fine] = RESOLUTIONS.map(|resolution| at(weber, resolution));
        assert!((low..1.04 * high).contains(&coarse), "{weber}: {coarse} {low} {high}");
        assert!((low..1.01 * high).contains(&fine), "{weber}: {fine} {low} {high}");
        assert!((coarse / fine - 1.0).abs() < 0.05, "{weber}: {coarse} {fine}");
    }
    for weber in [30.0, 100.0] {
        assert!((at(weber, 48) / at(weber, 64) - 1.0).abs() < 0.02);
    }
    for resolution in RESOLUTIONS {
        assert!(WEBERS.windows(2).all(|pair| at(pair[0], resolution) < at(pair[1], resolution)));
    }
    keep(
        "spread.csv",
        "weber,resolution,spread,time,seconds,clanet,pasandideh_fard,roisman,laan,wildeman",
        largest,
    );
    keep("spread_history.csv", "weber,resolution,time,spread", histories);
    keep("spread_shape.csv", "weber,resolution,radius,height,speed", shapes);
}

/// Weber and Reynolds numbers, and the largest diameter over D that an independent code computed: two phases on a
/// fixed mesh with D/100 (the first two) or D/60, in axisymmetry, without slip and at 90°; see volume_of_fluid.py.
const BY_VOLUME_OF_FLUID: [[f64; 3]; 4] =
    [[51.0, 27.0, 1.64], [70.0, 234.0, 2.39], [27.0, 2000.0, 2.61], [100.0, 500.0, 2.79]];

#[test]
fn spread_beside_a_volume_of_fluid_code() {
    println!("\n### Largest spread D_max/D beside a volume-of-fluid code, contact angle 90°\n");
    println!("| We | Re | volume of fluid | D/Δx 20 | 28 | 40 | off by |");
    println!("|---|---|---|---|---|---|---|");
    for [weber, reynolds, reference] in BY_VOLUME_OF_FLUID {
        let found = [20, 28, 40].map(|across| spread(weber, reynolds, across).largest);
        let error = found[2] / reference - 1.0;
        let [a, b, c] = found;
        println!(
            "| {weber} | {reynolds} | {reference:.2} | {a:.3} | {b:.3} | {c:.3} | {:+.1} % |",
            100.0 * error
        );
        assert!(error.abs() < 0.08, "{weber} {reynolds}: {c} {reference}");
        // Where viscosity rules, what is left falls with Δx.
        if reynolds < 100.0 {
            assert!(error < 0.8 * (a / reference - 1.0), "{found:?}");
        }
    }
}

/// Highest mean force over a time of 0.1 D/U, over ρU²D², and the middle of that time over D/U.
fn peak_force(weber: f64, reynolds: f64, resolution: usize) -> [f64; 2] {
    const SAMPLES: usize = 100;
    const WINDOW: usize = 10;
    let drop = drop_of(weber, reynolds, resolution);
    let mut state = drop.initial_state();
    let unit = DENSITY * SPEED * DIAMETER.powi(3);
    let mut impulses = vec![0.0];
    for _ in 0..SAMPLES / 2 {
        drop.advance(&mut state, &[293.15], TIME / SAMPLES as f64).unwrap();
        impulses.push(-drop.totals(&state).impulse_to_wall[2] / unit);
    }
    let means = impulses.windows(WINDOW + 1).enumerate().map(|(first, part)| {
        let force = (part[WINDOW] - part[0]) * (SAMPLES / WINDOW) as f64;
        [force, (first as f64 + 0.5 * WINDOW as f64) / SAMPLES as f64]
    });
    means.fold([0.0; 2], |most, next| if next[0] > most[0] { next } else { most })
}

/// Drops of high Weber and Reynolds numbers push most, 0.81 to 0.85 ρU²D², 0.167 D/U after contact (B. Zhang et al.,
/// Phys. Rev. Lett. 129 (2022) 104501, doi 10.1103/PhysRevLett.129.104501).
#[test]
fn peak_force_of_drops() {
    println!(
        "\nHighest force over ρU²D², We 250, Re 6000, as a mean over 0.1 D/U, and its time over D/U"
    );
    for resolution in [24, 36, 48] {
        let [force, time] = peak_force(250.0, 6000.0, resolution);
        println!("D/Δx {resolution}: {force:.3} at {time:.2}");
        assert!((0.78..0.86).contains(&force), "{resolution}: {force}");
    }
}
