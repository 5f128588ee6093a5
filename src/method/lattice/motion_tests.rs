//! Lattices that move, compared with waves, beams and their own energy.

use std::f64::consts::PI;

use super::arrangement::Cell;
use super::fragments::fragments;
use super::frequency::highest_frequency;
use super::link::Link;
use super::member::{Member, Pose};
use super::*;
use crate::laws::fracture::SofteningLaw;
use crate::runtime::allowance::Allowance;

const STRONG: SofteningLaw =
    SofteningLaw::Openings { strength: 1e9, ends: [1e-5, 2e-4], share: 0.13 };
const DENSITY: f64 = 2300.0;

/// A strip between platens.
fn strip(length: f64, depth: f64, spacing: f64, poisson: f64) -> LatticePlan {
    LatticePlan {
        strip: Strip { length, depth, spacing, arrangement: Arrangement::Across, notch: None },
        sheet: Sheet { young: 30e9, poisson, thickness: 0.1 },
        support: Support::Ends,
        control: Control::Displacement,
        softening: STRONG,
        bending: 0.1,
        closes: true,
        scatter: 0.0,
        seed: 0,
    }
}

fn moving(plan: LatticePlan, damping: f64) -> MovingLattice {
    MovingLattice::new(plan, Inertia { density: DENSITY, damping }, 1).unwrap()
}

/// A link at an angle.
fn link(angle: f64) -> Link {
    let [axial, flexural] = strip(1.0, 1.0, 1.0, 0.1).sheet.stiffness(2e-3, 1.2e-3);
    Link {
        ends: [0, 1],
        length: 2e-3,
        direction: [angle.cos(), angle.sin()],
        axial,
        flexural,
        softening: STRONG.of_link(2e-3, 30e9, 1.0),
        breaks: true,
    }
}

/// The step follows the highest frequency of hexagons with their own inertia: `ω² s²/c²` of a lattice without end, by
/// Bloch waves in numpy, beside the `14.4 (1 − 3ν)/(1 − ν²)` of uniform spin.
#[test]
fn highest_frequency_is_that_of_bloch_waves() {
    for (poisson, wanted) in
        [(0.0, 14.40), (0.1, 10.18), (0.2, 6.00), (0.3, 5.86), (1.0 / 3.0, 6.0)]
    {
        let plan = strip(0.12, 0.06, 2e-3, poisson);
        let particles = plan.strip.fill();
        let links = super::problem::links(&plan, &particles, &[]);
        let mass = DENSITY * plan.sheet.thickness;
        let inverse: Vec<_> = particles
            .cells
            .iter()
            .map(|cell| [1.0 / (mass * cell.area), 1.0 / (mass * cell.moment)])
            .collect();
        let over = highest_frequency(&links, &inverse) * particles.spacing;
        let square = over * over * DENSITY / plan.sheet.young;
        assert!((square / wanted - 1.0).abs() < 0.01, "ν {poisson}: {square} for {wanted}");
    }
}

/// Voronoi cells fill the strip, and have about the inertia of hexagons, `5 s²/36` of their area `s² √3/2`.
#[test]
fn cells_have_their_own_area_and_inertia() {
    let plan = strip(0.1, 0.05, 2e-3, 0.2);
    let arrangement = Arrangement::Random { seed: 3 };
    let particles = Strip { arrangement, ..plan.strip }.fill();
    let sum = |of: fn(&Cell) -> f64| particles.cells.iter().map(of).sum::<f64>();
    let area = sum(|cell| cell.area);
    assert!((area / (0.1 * 0.05) - 1.0).abs() < 1e-12, "{area}");
    let even: f64 = particles
        .cells
        .iter()
        .map(|cell| 5.0 / 36.0 * cell.area * cell.area / 0.75_f64.sqrt())
        .sum();
    let ratio = sum(|cell| cell.moment) / even;
    assert!((1.0..1.1).contains(&ratio), "{ratio}");
}

/// A rigid motion by any angle leaves a member without forces, and forces are the derivative of its energy.
#[test]
fn members_turn_freely_and_have_a_potential() {
    for turn in [0.0, 0.1, 0.3, 1.0, 3.0] {
        let link = link(0.4);
        let member = Member::new(&link);
        let [x, z] = link.direction.map(|part| part * link.length);
        let (c, s) = (f64::cos(turn), f64::sin(turn));
        let rigid = [0.0, 0.0, turn, c * x - s * z - x, s * x + c * z - z, turn];
        let strain = |at: &[f64; 6]| {
            let poses = [Pose::new([at[0], at[1]], at[2]), Pose::new([at[3], at[4]], at[5])];
            member.strain([&poses[0], &poses[1]])
        };
        let energy = |at: &[f64; 6]| {
            let q = strain(at).q;
            0.5 * link.elastic(&q).iter().zip(&q).map(|(a, b)| a * b).sum::<f64>()
        };
        let forces = |at: &[f64; 6]| {
            let [fx, fz, first, second] = member.forces(&strain(at), [1.0, 1.0]);
            [-fx, -fz, first, fx, fz, second]
        };
        let size = link.axial * 1e-5;
        assert!(forces(&rigid).iter().all(|force| force.abs() < 1e-9 * size), "{turn}");
        let mut bent = rigid;
        let change = [2e-6, -1e-6, 3e-3, 4e-6, 5e-6, -2e-3];
        bent.iter_mut().zip(change).for_each(|(own, change)| *own += change);
        for (k, force) in forces(&bent).into_iter().enumerate() {
            let h = if k % 3 == 2 { 1e-6 } else { 1e-9 };
            let ends = [-h, h].map(|h| {
                let mut at = bent;
                at[k] += h;
                energy(&at)
            });
            let wanted = (ends[0] - ends[1]) / (2.0 * h);
            let scale = if k % 3 == 2 { size * link.length } else { size };
            assert!((force - wanted).abs() < 1e-5 * scale, "{turn}, {k}: {force} for {wanted}");
        }
    }
}

/// A platen that pulls a bar at a constant speed bears `ρ c v` per area until the wave returns from the other end,
/// after `2L/c`, and then three times as much.
#[test]
fn pulled_bars_have_the_impedance_of_waves() {
    let (length, depth, speed) = (0.2, 0.04, 0.1);
    let lattice = moving(strip(length, depth, 2e-3, 0.0), 0.0);
    let wave = (30e9_f64 / DENSITY).sqrt();
    let mut motion = lattice.initial_state();
    let mut mean = |from: f64, to: f64| {
        let crossing = length / wave;
        let until = (from - motion.prescribed / (speed * crossing)) * crossing;
        let target = motion.prescribed + speed * until;
        lattice.advance(&mut motion, target, until, &Allowance::default()).unwrap();
        let duration = (to - from) * crossing;
        let target = motion.prescribed + speed * duration;
        lattice.advance(&mut motion, target, duration, &Allowance::default()).unwrap();
        motion.force() / (DENSITY * wave * speed * depth * 0.1)
    };
    let loads = [mean(0.5, 1.5), mean(2.3, 3.7)];
    assert!((loads[0] - 1.0).abs() < 0.02, "{loads:?}");
    assert!((loads[1] / 3.0 - 1.0).abs() < 0.02, "{loads:?}");
}

/// Frequency of a beam on two supports whose middle is held, in halves like two beams, over `f = π/(2 l²) √(EI/(ρA))`
/// with the correction `1 − ½(π r/l)² (1 + E/(k G))` of S. Timoshenko 1921 (doi 10.1080/14786442108636264).
fn over_timoshenko(rows: f64) -> f64 {
    let (half, depth, poisson) = (0.15, 0.02, 0.2);
    let plan = LatticePlan {
        support: Support::ThreePoint { span: 2.0 * half },
        ..strip(2.0 * half + 8e-3, depth, depth / rows, poisson)
    };
    let lattice = moving(plan, 0.0);
    let mut motion = lattice.initial_state();
    let wave = PI / half;
    for (velocity, [x, z]) in motion.velocity.iter_mut().zip(&lattice.particles().places) {
        let slope = 1e-3 * wave * (wave * x).cos();
        *velocity = [-slope * (z - 0.5 * depth), 1e-3 * (wave * x).sin(), slope];
    }
    motion.work = lattice.totals(&motion).kinetic_energy;
    let radius = depth / 12.0_f64.sqrt();
    let shear = 2.0 * (1.0 + poisson) * 6.0 / 5.0;
    let slender = 0.5 * PI / (half * half) * radius * (30e9_f64 / DENSITY).sqrt();
    let frequency = slender * (1.0 - 0.5 * (PI * radius / half).powi(2) * (1.0 + shear));
    let swing = |motion: &LatticeMotion| -> f64 {
        let all = motion.displacement.iter().zip(&lattice.particles().places);
        all.map(|(moved, [x, _])| moved[1] * (wave * x).sin()).sum()
    };
    // Half a period ends where the swing crosses zero.
    let dt = 0.01 / frequency;
    let (mut before, mut time) = (0.0, 0.0);
    loop {
        lattice.advance(&mut motion, 0.0, dt, &Allowance::default()).unwrap();
        let now = swing(&motion);
        if now < 0.0 {
            return 0.5 / (time + dt * before / (before - now)) / frequency;
        }
        (before, time) = (now, time + dt);
        assert!(time < 2.0 / frequency);
    }
}

/// The half rows at the faces soften few rows; the error is that of the first order in the spacing.
#[test]
fn beams_swing_at_the_frequency_of_timoshenko() {
    let [few, more] = [8.0, 16.0].map(over_timoshenko);
    let limit = 2.0 * more - few;
    assert!((limit - 1.0).abs() < 0.015 && (0.9..more).contains(&few), "{few} {more} {limit}");
}

/// The energy of a swinging bar fades at the rate of damping, and what is lost is counted.
#[test]
fn damping_takes_energy_at_its_rate() {
    let length = 0.1;
    // Of ten rows those at the faces lack half a link.
    let period = 2.0 * length / (0.95 * 30e9_f64 / DENSITY).sqrt();
    let damping = 0.3 / period;
    let lattice = moving(strip(length, 0.02, 2e-3, 0.0), damping);
    let mut motion = lattice.initial_state();
    for (velocity, place) in motion.velocity.iter_mut().zip(&lattice.particles().places) {
        velocity[0] = 1e-2 * (PI * place[0] / length).cos();
    }
    let energy = |motion: &LatticeMotion| {
        let totals = lattice.totals(motion);
        totals.kinetic_energy + totals.sums.elastic_energy
    };
    // Supports act at once on the particles that they hold.
    motion.work = lattice.totals(&motion).kinetic_energy;
    lattice.advance(&mut motion, 0.0, 1e-9, &Allowance::default()).unwrap();
    let start = energy(&motion);
    let taken = motion.damped;
    for _ in 0..6 {
        lattice.advance(&mut motion, 0.0, 0.5 * period, &Allowance::default()).unwrap();
    }
    let end = energy(&motion);
    assert!((end / start / (-0.9_f64).exp() - 1.0).abs() < 0.02, "{}", end / start);
    let missing = start - end - (motion.damped - taken);
    assert!(missing.abs() < 2e-3 * start, "{missing:e} J of {start:e} J");
}

#[test]
fn unbroken_links_connect_parts() {
    let links = [[0, 1], [1, 2], [3, 4], [0, 4], [2, 3]].map(|ends| Link { ends, ..link(0.0) });
    assert_eq!(fragments(6, &links, &[0.0; 5]), 2);
    assert_eq!(fragments(6, &links, &[0.0, 1.0, 0.9, 0.0, 0.0]), 2);
    assert_eq!(fragments(6, &links, &[0.0, 1.0, 0.9, 1.0, 0.0]), 3);
    assert_eq!(fragments(6, &links, &[1.0; 5]), 6);
}
