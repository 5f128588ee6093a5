//! Thick and yielding fluids, whose viscosity is solved implicitly, against closed forms.

use impinge::closed_form::{
    GravityCurrent, HerschelBulkley, RestingPaste, Slump, Spreading, YieldingFilm,
};
use impinge::method::sph::{DropletPlan, Extent, Viscous};
use impinge::port::WallCells;

use crate::capillary;
use crate::classical_flows::{Column, Flow, Setup, TaylorGreen, lattice, tilted_lattice};
use crate::thick_flows::{Channel, Mound, law};

const IMPLICIT: Viscous = Viscous::Implicit { rate: 1.0 };

fn bingham(yield_stress: f64, consistency: f64) -> HerschelBulkley {
    HerschelBulkley { yield_stress, consistency, exponent: 1.0 }
}

/// Mean of a quantity of particles by mass.
fn mean(flow: &Flow, of: impl Fn([f64; 3], [f64; 3]) -> f64) -> f64 {
    let p = flow.particles();
    let parts = (0..p.mass.len()).map(|i| p.mass[i] * of(p.position[i], p.velocity[i]));
    parts.sum::<f64>() / p.mass.iter().sum::<f64>()
}

fn mean_speed(flow: &Flow) -> f64 {
    mean(flow, |_, [u, ..]| u)
}

/// Root mean square distance from the axis or the plane x = 0.
fn spread(flow: &Flow) -> f64 {
    mean(flow, |[x, ..], _| x * x).sqrt()
}

#[test]
fn channel_of_yielding_fluid() {
    println!(
        "\nPaste between plates: relative error of the velocities (norm) at 21, 41 and 81 rows"
    );
    let channel = Channel::PASTE;
    let errors = [(21, 1.0), (41, 1.0), (81, 0.4)].map(|(rows, time)| {
        let mut flow = channel.start_steady(rows);
        flow.advance(time);
        let error = channel.error_of(&flow);
        println!("{rows}: {error:.2e} in {} steps", flow.totals().steps);
        error
    });
    let order = (errors[0] / errors[1]).ln() / (41f64 / 21.0).ln();
    println!("order of the first two {order:.2}");
    assert!(errors[0] < 8e-3 && order > 1.6, "{errors:?}");
    // What is left does not fall with the distance of particles.
    assert!(errors[2] < 2.5e-3, "{errors:?}");
}

#[test]
fn stopping_time_of_bingham_flow() {
    println!("\nFlow between plates without a gradient: time to rest of 20 and 40 rows, and exact");
    for (yield_stress, stop) in [(0.5, 0.4082), (1.0, 0.1484)] {
        let fluid = bingham(yield_stress, 1.0);
        let channel = Channel { fluid, density: 1.0, width: 2.0, gradient: 2.0 };
        let exact = channel.exact();
        let times = [20, 40].map(|rows| {
            let mut flow = channel.start(rows, 0.0, |z| exact.velocity(z));
            let first = mean_speed(&flow);
            let mut samples = 0;
            while mean_speed(&flow) > 1e-3 * first && samples < 2000 {
                flow.advance(5e-4);
                samples += 1;
            }
            flow.advance(0.1);
            let creep = flow.totals().max_speed / exact.velocity(1.0);
            assert!(creep < 1e-5, "{yield_stress} {rows}: {creep}");
            f64::from(samples) * 5e-4
        });
        println!("τ₀ {yield_stress}: {:.4} {:.4}, exact {stop}", times[0], times[1]);
        assert!(times.iter().all(|time| (time / stop - 1.0).abs() < 0.02), "{times:?}");
    }
}

/// A film on an incline under forces along and onto it [N/m³], with the exact one.
fn film(rows: usize, along: f64) -> (Flow, YieldingFilm) {
    const ONTO: f64 = 1.0;
    let exact = YieldingFilm { fluid: Channel::PASTE.fluid, weight: along, thickness: 0.25 };
    let spacing = exact.thickness / rows as f64;
    let setup = Setup {
        spacing,
        support: 3.0,
        density: 1.0,
        viscosity: law(exact.fluid),
        sound_speed: 10.0,
        shifting: false,
        viscous: Viscous::Implicit { rate: 2.0 },
        gravity: [along, 0.0, -ONTO],
        extents: [Extent::Periodic(8.0 * spacing), Extent::Open, Extent::Open],
        cells: Some(WallCells::Tiles { count: [1, 1], size: [10.0; 2] }),
    };
    let pressure = |[_, z]: [f64; 2]| ONTO * (exact.thickness - z);
    (Flow::start(setup, &lattice(8, rows, spacing), |_| [0.0; 2], pressure), exact)
}

#[test]
fn film_of_paste_on_an_incline() {
    println!("\nFilm of paste: error of its profile, and the speed of one below its yield stress");
    for rows in [10, 20] {
        let (mut flow, exact) = film(rows, 10.0);
        flow.advance(2.0);
        let error = flow.norm(|p, i| [p.velocity[i][0]], |[_, z]| [exact.velocity(z)]);
        // Three quarters of what it bears.
        let (mut resting, exact) = film(rows, 1.5);
        assert!(exact.thickness < exact.plug());
        resting.advance(1.0);
        let speed = mean_speed(&resting) / 1.5;
        println!("{rows} rows: {error:.2e}; {speed:.1e} of that in free fall");
        // Weakly compressed, it is heavier than the exact one by some 0.1 %.
        assert!(error < 8e-3, "{rows}: {error}");
        assert_eq!(resting.totals().yielded_mass, 0.0);
        assert!(speed.abs() < 1e-5, "{rows}: {speed}");
    }
}

#[test]
fn slump_of_a_cylinder_of_paste() {
    println!(
        "\nSlump of a cylinder as high as wide, 16 rows: s/H, and by the model of Pashias with"
    );
    println!("the criteria of Tresca and of von Mises");
    const WEIGHT: f64 = 1e4;
    const HEIGHT: f64 = 0.1;
    let slump = |yield_stress| Slump { yield_stress, weight: WEIGHT, height: HEIGHT }.slump();
    for number in [0.05, 0.1, 0.15, 0.2, 0.3, 0.5] {
        let yield_stress = number * WEIGHT * HEIGHT;
        let mound = Mound {
            viscosity: law(bingham(yield_stress, 10.0)),
            density: 1000.0,
            gravity: 10.0,
            size: [0.5 * HEIGHT, HEIGHT],
            spacing: HEIGHT / 16.0,
            sound_speed: 10.0,
            rate: 10.0,
            is_round: true,
        };
        let mut flow = mound.start();
        let first = flow.totals().height;
        flow.advance(0.8);
        let found = (first - flow.totals().height) / HEIGHT;
        // The law yields at √3 τ₀ in a column, the model at 2 τ₀.
        let models = [1.0, 0.75f64.sqrt()].map(|part| slump(part * yield_stress) / HEIGHT);
        let [tresca, mises] = models;
        let speed = flow.totals().max_speed;
        println!("τ' {number}: {found:.3}, models {tresca:.3} {mises:.3}; {speed:.0e} m/s");
        // The model leaves out the friction of the floor.
        let bounds = [tresca.min(mises) - 0.05, mises + 0.01];
        assert!((found - tresca).abs() < 0.08, "{number}: {found} {tresca}");
        assert!(bounds[0] < found && found < bounds[1], "{number}: {found} {models:?}");
    }
}

#[test]
fn radius_of_a_resting_layer_of_paste() {
    println!("\nLayer of paste that spreads to rest: radius over that of Roussel and Coussot");
    let size = [0.15, 0.0224];
    let mound = Mound {
        viscosity: law(bingham(5.0, 0.5)),
        density: 1000.0,
        gravity: 10.0,
        size,
        spacing: size[1] / 8.0,
        sound_speed: 6.0,
        rate: 10.0,
        is_round: true,
    };
    let exact = RestingPaste { yield_stress: 5.0, weight: 1e4 }.drop_radius(mound.volume());
    let mut flow = mound.start();
    for time in [1.0, 2.0, 3.0, 4.0] {
        flow.advance(1.0);
        // Of the shape √(1 − r/R).
        let radius = spread(&flow) / (8f64 / 21.0).sqrt();
        println!("{time} s: {:.3}, {:.0e} m/s", radius / exact, flow.totals().max_speed);
    }
    let radius = spread(&flow) / (8f64 / 21.0).sqrt();
    assert!((radius / exact - 1.0).abs() < 0.05, "{radius} {exact}");
}

#[test]
fn viscous_gravity_currents() {
    println!("\nViscous gravity currents: front and height over those of Huppert");
    for is_round in [false, true] {
        let size = [0.05, 0.05];
        let mound = Mound {
            viscosity: 20.0.into(),
            density: 1000.0,
            gravity: 10.0,
            size,
            spacing: size[1] / 20.0,
            sound_speed: 7.0,
            rate: 10.0,
            is_round,
        };
        let volume = mound.volume();
        let (spreading, shape): (_, f64) = match is_round {
            true => (Spreading::Axisymmetric { volume }, 3.0 / 7.0),
            false => (Spreading::Plane { area: volume }, 3.0 / 11.0),
        };
        let exact = GravityCurrent { spreading, gravity: 10.0, viscosity: 0.02 };
        let mut flow = mound.start();
        let found = [1.0, 2.0, 4.0].map(|time| {
            flow.advance(if time > 1.0 { 0.5 * time } else { time });
            let front = spread(&flow) / shape.sqrt() / exact.front(time);
            let height = (flow.totals().height + 0.5 * mound.spacing) / exact.height(time);
            println!("round {is_round}, {time} s: {front:.3} {height:.3}");
            front
        });
        // The start from a block is forgotten in time.
        assert!((found[2] - 1.0).abs() < 0.04, "{is_round}: {found:?}");
    }
}

#[test]
fn decay_of_vortices() {
    println!("\nVortices of Taylor and Green: error of their decay, 20 and 40 particles a side");
    for viscous in [Viscous::Explicit, IMPLICIT] {
        let errors = [9, 18].map(|m| {
            let (spacing, points) = tilted_lattice(m);
            let mut flow = TaylorGreen::start_with(viscous, spacing, &points, 3.0);
            let start = flow.totals().kinetic_energy;
            flow.advance(2.0 / TaylorGreen::DECAY);
            0.5 * (start / flow.totals().kinetic_energy).ln() - 1.0
        });
        println!("{viscous:?}: {:+.4} {:+.4}", errors[0], errors[1]);
        assert!(errors[0].abs() < 0.03 && errors[1].abs() < 0.01, "{errors:?}");
    }
}

#[test]
fn drops_with_implicit_viscosity() {
    println!(
        "\nDrops of 20 particles across, implicit: decay and frequency over the normal mode's"
    );
    let of = |viscosity| DropletPlan { viscous: IMPLICIT, ..capillary::plan(3, 20.0, viscosity) };
    for ohnesorge in [0.03, 0.1, 0.3] {
        let plan = of(capillary::viscosity(ohnesorge));
        let rates = capillary::normal_mode(&plan).decay_and_frequency();
        let exact = rates.map(|rate| rate * capillary::period());
        let found = capillary::fitted(&capillary::elongations(plan), exact);
        let [decay, frequency] = [0, 1].map(|n| found[n] / exact[n]);
        println!("Oh {ohnesorge}: {decay:.3} {frequency:.3}");
        assert!((decay - 1.0).abs() < 0.06 && (frequency - 1.0).abs() < 0.04, "{ohnesorge}");
    }
    let (drop, mut state) = capillary::stretched(of(1e-2), 1.0);
    drop.advance(&mut state, &[], 2.0 * capillary::period()).unwrap();
    let samples = 100;
    let pressure = (0..samples).map(|_| {
        drop.advance(&mut state, &[], 0.01 * capillary::period()).unwrap();
        capillary::core_pressure(&drop.particles(&state))
    });
    let pressure = pressure.sum::<f64>() / f64::from(samples);
    println!("pressure over 2σ/R: {pressure:.3}");
    assert!((pressure - 1.0).abs() < 0.06, "{pressure}");
}

#[test]
fn column_rests_over_a_hundred_thousand_steps() {
    println!("\nColumn of 20 rows of viscosity 1 Pa s, implicit: pressure, motion, force");
    let mut flow = Column::start_with(20, 1.0, IMPLICIT);
    while flow.totals().steps < 1e5 {
        flow.advance(40.0 * Column::time());
    }
    let error = flow.norm(|p, i| [p.pressure[i]], |at| [Column::pressure(at)]);
    let (motion, force) = (Column::motion(&flow), Column::force(&flow));
    println!("{} steps: {error:.1e} {motion:.1e} {force:.5}", flow.totals().steps);
    assert!(error < 0.01 && motion < 1e-6 && (force - 1.0).abs() < 1e-3, "{error} {force}");
}
