//! Classical flows of the droplet engine: between plates (Park 2019, §2.4.5.2), Taylor–Green's
//! vortices, water at rest, a rotating square, and the break of a dam.

use impinge::method::sph::{Extent, ParticleFields, Viscous};
use impinge::port::WallCells;

use crate::classical_flows::{Column, Flow, Poiseuille, Setup, TaylorGreen, lattice};
use crate::common::Trial;
use crate::study::{POISSON, Study, YOUNG, alumina, keep, line_of_probes};

fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}

/// Depth and length of the plate under the flow [m]; only its middle is compared, where its ends are
/// not felt.
const THICKNESS: f64 = 0.25;
const PERIODS: usize = 5;

/// Mean shear stress at half depth over a period, and displacement of the top, of a plate that is
/// clamped at its bottom under the shear of each tile.
fn plate_under(shear: &[f64], spacing: f64) -> [f64; 2] {
    let length = PERIODS as f64 * Poiseuille::LENGTH;
    let tiles = PERIODS * shear.len();
    let shape = format!("box = [{length:?}, 0.2, {THICKNESS:?}]");
    let mesh = format!("spacing = {spacing:?}, growth = 1.0, order = 1");
    let faces = "bottom = { clamped = true }\nfront = { roller = true }\nback = { roller = true }";
    let load = format!(
        "[[load]]\nname = \"flow\"\non = \"plate.top\"\nfootprint = {{ tiles = {{ count = [{tiles}, 1], size = \
         [{length:?}, 0.2] }} }}\ncarries = [\"shear\"]\n"
    );
    let middles = |z: f64| -> Vec<[f64; 3]> {
        let width = Poiseuille::LENGTH / shear.len() as f64;
        (0..shear.len()).map(|i| [(i as f64 + 0.5) * width - 0.6, 0.0, z]).collect()
    };
    let inside = line_of_probes("inside", &middles(-0.5 * THICKNESS), "\"stress\"");
    let top = line_of_probes("top", &middles(0.0), "\"displacement\"");
    let mut trial = Trial::new(&alumina(&shape, &mesh, faces, &(load + &inside + &top)));
    for tile in 0..tiles {
        trial.set(&format!("flow.shear_x[{},1]", tile + 1), shear[tile % shear.len()]);
    }
    trial.step(1.0);
    ["inside#.stress_xz", "top#.displacement_x"].map(|name| {
        let of_probe = |i: usize| trial.get(&name.replace('#', &i.to_string()));
        mean(&(0..shear.len()).map(of_probe).collect::<Vec<f64>>())
    })
}

/// Park Figs. 2.8 and 2.9 with the shear of her own closed form, H/2 · dp/dx = 5 Pa.
#[test]
fn flow_between_plates_and_the_plate_below() {
    let time = |share: f64| share * Poiseuille::TIME;
    let steady = 0.5 * Poiseuille::GRADIENT;
    let stiffness = YOUNG / (2.0 * (1.0 + POISSON));
    let mut table = Vec::new();
    for support in [4.0, 3.0] {
        let mut study = Study::new(
            &format!("Flow between plates, Re 10, H = {support}Δx"),
            &[
                "velocities at 0.1 H²/ν (norm)",
                "steady velocities (norm)",
                "shear from 0.05 to 0.1 H²/ν",
                "steady shear (5 Pa)",
            ],
        );
        let mut plate = Study::new(
            &format!("Clamped plate under the flow, H = {support}Δx"),
            &["σ_xz from 0.05 to 0.1 H²/ν", "steady σ_xz (5 Pa)", "steady u_x of the top"],
        );
        for rows in [10, 20, 40] {
            let spacing = 1.0 / rows as f64;
            let mut flow = Poiseuille::start(rows, support);
            flow.advance(time(0.05));
            flow.advance(time(0.05));
            let early = Poiseuille::shear(&flow);
            let early_exact = Poiseuille::mean_shear(time(0.05), time(0.1));
            let early_error = Poiseuille::error(&flow, time(0.1));
            let mut keep_profile = |flow: &Flow, now: f64| {
                let p = flow.particles();
                let row = |i: usize| {
                    let exact = Poiseuille::velocity(p.position[i][2], time(now));
                    vec![support, rows as f64, now, p.position[i][2], p.velocity[i][0], exact]
                };
                table.extend((0..p.mass.len()).map(row));
            };
            keep_profile(&flow, 0.1);
            flow.advance(time(0.9));
            flow.advance(time(0.2));
            keep_profile(&flow, 1.2);
            let late = Poiseuille::shear(&flow);
            let label = format!("Δx = H/{rows}");
            study.add(
                &label,
                spacing,
                vec![
                    early_error,
                    Poiseuille::error(&flow, time(1.2)),
                    mean(&early) / early_exact - 1.0,
                    mean(&late) / steady - 1.0,
                ],
            );
            let [stress, _] = plate_under(&early, spacing);
            let [steady_stress, displacement] = plate_under(&late, spacing);
            plate.add(
                &label,
                spacing,
                vec![
                    stress / early_exact - 1.0,
                    steady_stress / steady - 1.0,
                    displacement / (steady * THICKNESS / stiffness) - 1.0,
                ],
            );
        }
        study.print();
        plate.print();
        if support == 4.0 {
            study.require(&[0, 1, 2], 1.6, 5e-3);
            plate.require(&[0], 1.6, 5e-3);
        } else {
            // Kernel sums with fewer neighbours miss a share of the viscosity.
            study.require(&[0, 1, 2], 1.0, 8e-3);
        }
        // What drives the fluid arrives at the plates, whatever the resolution.
        assert!(study.finest(3) < 1e-3 && plate.finest(1) < 2e-3 && plate.finest(2) < 2e-3);
    }
    keep("plates.csv", "support,rows,time,z,velocity,exact", table);
}

#[test]
fn taylor_green_vortices() {
    let mut table = Vec::new();
    let mut run = |label: f64, mut flow: Flow| {
        let before = flow.totals().kinetic_energy;
        let spacing = flow.drop.plan().spacing;
        for tenth in 1..=10 {
            flow.advance(0.1);
            let energy = flow.totals().kinetic_energy / before;
            table.push(vec![label, spacing, 0.1 * f64::from(tenth), energy]);
        }
        let rate = (before / flow.totals().kinetic_energy).ln() / TaylorGreen::DECAY - 1.0;
        (spacing, vec![rate, TaylorGreen::error(&flow, 1.0)])
    };
    let quantities = ["decay rate of the kinetic energy", "velocities at 1 s (norm)"];
    for support in [4.0, 3.0] {
        let title = format!("Taylor–Green vortices, Re 100, H = {support}Δx");
        let mut study = Study::new(&title, &quantities);
        for m in [12, 24, 48] {
            let (spacing, errors) = run(support, TaylorGreen::start(m, support));
            study.add(&format!("{} particles", 5 * m * m), spacing, errors);
        }
        study.print();
        if support == 4.0 {
            study.require(&[0, 1], 1.0, 1e-2);
        } else {
            study.require(&[1], 0.8, 3e-2);
            assert!(study.finest(0) < 2e-2);
        }
    }
    let title = "Taylor–Green vortices from a lattice along the axes, Re 100, H = 4Δx";
    let mut study = Study::new(title, &quantities);
    for n in [27, 54, 107] {
        let spacing = 1.0 / n as f64;
        let flow = TaylorGreen::start_on(spacing, &lattice(n, n, spacing), 4.0);
        let (spacing, errors) = run(0.0, flow);
        study.add(&format!("{} particles", n * n), spacing, errors);
    }
    study.print();
    keep("vortices.csv", "support,spacing,time,energy", table);
}

#[test]
fn column_of_water_at_rest() {
    const STEPS: usize = 40;
    let mut study = Study::new(
        "Column of water at rest for 20 √(H/g), means over the second half",
        &[
            "weight on the wall",
            "pressure of layers (norm)",
            "weight, root mean square of moments",
            "kinetic energy at the end, over ρgH³",
        ],
    );
    let mut table = Vec::new();
    for rows in [12, 24, 48] {
        let mut flow = Column::start(rows);
        let mut weights = Vec::new();
        let mut layers = vec![[0.0; 2]; rows];
        for step in 0..STEPS {
            flow.advance(20.0 / STEPS as f64 * Column::time());
            if step >= STEPS / 2 {
                weights.push(Column::force(&flow) - 1.0);
                let p = flow.particles();
                for (x, pressure) in p.position.iter().zip(&p.pressure) {
                    let layer = &mut layers[((x[2] * rows as f64) as usize).min(rows - 1)];
                    // The pressure where the layer's particles are is told by their own heights.
                    *layer = [layer[0] + pressure - Column::pressure([x[0], x[2]]), layer[1] + 1.0];
                }
            }
        }
        let exact = |k: usize| Column::pressure([0.0, (k as f64 + 0.5) / rows as f64]);
        let filled = (0..rows).filter(|&k| layers[k][1] > 0.0);
        let (error, whole) = filled.fold((0.0, 0.0), |(error, whole), k| {
            let miss = layers[k][0] / layers[k][1];
            table.push(vec![rows as f64, exact(k), miss]);
            (error + miss * miss, whole + exact(k).powi(2))
        });
        let moments = mean(&weights.iter().map(|w| w * w).collect::<Vec<f64>>()).sqrt();
        let errors = vec![mean(&weights), (error / whole).sqrt(), moments, Column::motion(&flow)];
        study.add(&format!("Δx = H/{rows}"), 1.0 / rows as f64, errors);
    }
    study.print();
    assert!(study.finest(0) < 1e-3 && study.finest(1) < 1e-2 && study.finest(2) < 5e-3);
    assert!(study.finest(3) < 1e-4);
    keep("column.csv", "rows,exact,miss", table);
}

/// A square of 1 m that rotates at 1 rad/s without viscosity: its inside is under tension, under
/// which particles clump. Source: Le Touzé, Colagrossi, Colicchio & Greco (2013), Int. J. Numer.
/// Methods Fluids 73, 660–691, doi 10.1002/fld.3819.
fn rotating_square(side: usize, shifting: bool) -> Flow {
    const DENSITY: f64 = 1000.0;
    let spacing = 1.0 / side as f64;
    let setup = Setup {
        spacing,
        support: 3.0,
        density: DENSITY,
        viscosity: 0.0.into(),
        sound_speed: 7.0,
        shifting,
        viscous: Viscous::Explicit,
        gravity: [0.0; 3],
        extents: [Extent::Open; 3],
        cells: None,
    };
    // That of an incompressible fluid; a double Fourier series of odd terms.
    let pressure = |[x, z]: [f64; 2]| {
        let pi = std::f64::consts::PI;
        let mut sum = 0.0;
        for m in (1..40).step_by(2).map(|m| pi * f64::from(m)) {
            for n in (1..40).step_by(2).map(|n| pi * f64::from(n)) {
                let wave = (m * (x + 0.5)).sin() * (n * (z + 0.5)).sin();
                sum -= 32.0 * DENSITY * wave / (m * n * (m * m + n * n));
            }
        }
        sum
    };
    let points: Vec<[f64; 2]> =
        lattice(side, side, spacing).into_iter().map(|p| p.map(|x| x - 0.5)).collect();
    Flow::start(setup, &points, |[x, z]| [z, -x], pressure)
}

fn angular_momentum(p: &ParticleFields) -> f64 {
    let of = |i: usize| {
        let ([x, _, z], [u, _, w]) = (p.position[i], p.velocity[i]);
        p.mass[i] * (z * u - x * w)
    };
    (0..p.mass.len()).map(of).sum()
}

/// Mean distance to the nearest particle and radius of the largest hole within 0.15 m of the centre,
/// over the spacing; on a lattice 1 and √½.
fn evenness(p: &ParticleFields, spacing: f64) -> [f64; 2] {
    const RADIUS: f64 = 0.15;
    let places: Vec<[f64; 2]> = p.position.iter().map(|x| [x[0], x[2]]).collect();
    let gap = |at: [f64; 2], skip: usize| {
        let others = places.iter().enumerate().filter(|&(j, _)| j != skip);
        others.map(|(_, x)| (x[0] - at[0]).hypot(x[1] - at[1])).fold(f64::INFINITY, f64::min)
    };
    let inside = |at: &[f64; 2]| at[0].hypot(at[1]) < RADIUS;
    let own = (0..places.len()).filter(|&i| inside(&places[i]));
    let nearest: Vec<f64> = own.map(|i| gap(places[i], i) / spacing).collect();
    let steps = (4.0 * RADIUS / spacing) as usize;
    let grid = lattice(steps, steps, 2.0 * RADIUS / steps as f64).into_iter();
    let middles = grid.map(|at| at.map(|x| x - RADIUS)).filter(inside);
    [mean(&nearest), middles.map(|at| gap(at, usize::MAX)).fold(0.0, f64::max) / spacing]
}

#[test]
fn rotating_square_of_fluid() {
    const SIDE: usize = 50;
    let mut table = Vec::new();
    println!("\n### Square of 50 × 50 particles that rotates freely, H = 3Δx\n");
    println!(
        "| shifting | ωt | mean distance to the nearest / Δx | largest hole / Δx | kinetic energy | angular momentum |"
    );
    println!("|---|---|---|---|---|---|");
    let mut rows = Vec::new();
    for shifting in [false, true] {
        let mut flow = rotating_square(SIDE, shifting);
        let [energy, momentum] =
            [flow.totals().kinetic_energy, angular_momentum(&flow.particles())];
        for step in 1..=6 {
            flow.advance(0.5);
            let p = flow.particles();
            let [nearest, hole] = evenness(&p, 1.0 / SIDE as f64);
            let energy = flow.totals().kinetic_energy / energy - 1.0;
            let momentum = angular_momentum(&p) / momentum - 1.0;
            let time = 0.5 * f64::from(step);
            println!(
                "| {} | {time} | {nearest:.3} | {hole:.2} | {energy:+.1e} | {momentum:+.1e} |",
                if shifting { "yes" } else { "no" }
            );
            rows.push((shifting, time, nearest, hole, energy, momentum));
            if step % 2 == 0 {
                let kind = f64::from(u8::from(shifting));
                table.extend(
                    (0..p.mass.len()).map(|i| {
                        vec![kind, time, p.position[i][0], p.position[i][2], p.pressure[i]]
                    }),
                );
            }
        }
    }
    keep("square.csv", "shifting,time,x,z,pressure", table);
    let at = |shifting: bool, time: f64| {
        *rows.iter().find(|row| row.0 == shifting && row.1 == time).unwrap()
    };
    let (_, _, nearest, hole, ..) = at(false, 1.0);
    assert!(nearest < 0.5 && hole > 1.2, "{nearest} {hole}");
    for time in [1.0, 2.0, 3.0] {
        let (_, _, nearest, hole, energy, momentum) = at(true, time);
        assert!(nearest > 0.9 && hole < 0.8, "{time}: {nearest} {hole}");
        assert!(energy.abs() < 0.025 && momentum.abs() < 5e-3, "{time}: {energy} {momentum}");
    }
}

/// Place of the front over the base a of a column twice as high, at times over √(a/2g): a = 57.15 mm.
/// Read from Fig. 3 of Martin & Moyce (1952), Phil. Trans. R. Soc. Lond. A 244, 312–324, doi
/// 10.1098/rsta.1952.0006, by the authors of PySPH, in whose examples the numbers stand
/// (pypr/pysph, `pysph/examples/db_exp_data.py`).
const MARTIN_MOYCE: [[f64; 2]; 15] = [
    [0.832, 1.217],
    [1.219, 1.474],
    [1.997, 2.292],
    [2.547, 2.995],
    [3.345, 4.134],
    [4.034, 4.944],
    [4.418, 5.881],
    [5.091, 6.980],
    [5.685, 7.945],
    [6.306, 8.966],
    [6.822, 9.986],
    [7.439, 10.963],
    [8.031, 11.977],
    [8.633, 13.005],
    [9.237, 13.970],
];

/// Fronts of a column of some particles over its base, at the times of the measurement; keeps
/// pictures of the finest run.
fn dam_break(columns: usize, pictures: Option<&mut Vec<Vec<f64>>>) -> Vec<f64> {
    const BASE: f64 = 0.05715;
    const GRAVITY: f64 = 9.81;
    let spacing = BASE / columns as f64;
    let setup = Setup {
        spacing,
        support: 3.0,
        density: 1000.0,
        viscosity: 1e-3.into(),
        sound_speed: 20.0 * (GRAVITY * BASE).sqrt(),
        shifting: true,
        viscous: Viscous::Explicit,
        gravity: [0.0, 0.0, -GRAVITY],
        extents: [Extent::Closed(20.0 * BASE), Extent::Open, Extent::Open],
        cells: Some(WallCells::Tiles { count: [1, 1], size: [1.0, 1.0] }),
    };
    let points = lattice(columns, 2 * columns, spacing);
    let mut flow = Flow::start(setup, &points, |_| [0.0; 2], |_| 0.0);
    let unit = (BASE / (2.0 * GRAVITY)).sqrt();
    let mut shown = Vec::new();
    let mut now = 0.0;
    let fronts = MARTIN_MOYCE.map(|[time, _]| {
        flow.advance((time - now) * unit);
        now = time;
        let p = flow.particles();
        let row = |i: usize| {
            let [x, _, z] = p.position[i].map(|x| x / BASE);
            vec![time, x, z, p.velocity[i][0].hypot(p.velocity[i][2])]
        };
        shown.extend((0..p.mass.len()).map(row));
        (p.position.iter().map(|x| x[0]).fold(0.0, f64::max) + 0.5 * spacing) / BASE
    });
    if let Some(pictures) = pictures {
        *pictures = shown;
    }
    fronts.into()
}

#[test]
fn break_of_a_dam() {
    let mut pictures = Vec::new();
    let runs = [dam_break(10, None), dam_break(20, None), dam_break(40, Some(&mut pictures))];
    println!("\n### Front of a collapsing column of water, height 2a, place over a\n");
    println!("| t √(2g/a) | Martin & Moyce (1952) | Δx = a/10 | Δx = a/20 | Δx = a/40 |");
    println!("|---|---|---|---|---|");
    for (k, [time, measured]) in MARTIN_MOYCE.iter().enumerate() {
        let [a, b, c] = [0, 1, 2].map(|run: usize| runs[run][k]);
        println!("| {time:.3} | {measured:.3} | {a:.3} | {b:.3} | {c:.3} |");
    }
    let table = MARTIN_MOYCE.iter().enumerate();
    keep(
        "fronts.csv",
        "time,measured,coarse,middle,fine",
        table.map(|(k, [time, measured])| {
            vec![*time, *measured, runs[0][k], runs[1][k], runs[2][k]]
        }),
    );
    keep("collapse.csv", "time,x,z,speed", pictures);
    // Mean speed from the sixth time on, when the column has sunk to a third.
    let speed =
        |fronts: &[f64]| (fronts[14] - fronts[5]) / (MARTIN_MOYCE[14][0] - MARTIN_MOYCE[5][0]);
    let measured = speed(&MARTIN_MOYCE.map(|pair| pair[1]));
    let speeds: Vec<f64> = runs.iter().map(|run| speed(run) / measured - 1.0).collect();
    println!("\nMean speed after t √(2g/a) = 4, relative to the measured one: {speeds:+.3?}");
    assert!(speeds[2].abs() < 0.08, "{speeds:?}");
    for k in 0..MARTIN_MOYCE.len() {
        assert!((runs[2][k] / runs[1][k] - 1.0).abs() < 0.03, "{k}: {runs:?}");
        // The water's own start is late: its diaphragm takes time to go.
        let late = (runs[2][k] - MARTIN_MOYCE[k][1]) / runs[2][k];
        assert!((-0.02..0.2).contains(&late), "{k}: {late}");
    }
}
