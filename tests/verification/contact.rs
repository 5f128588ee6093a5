//! Heat of contact of a fluid with a wall and with a plate: two half spaces brought together.

use std::f64::consts::PI;
use std::ops::Range;

use crate::common::Trial;
use crate::falling_drop::open_space;
use crate::study::{Study, alumina, keep, probe, relative_norm};
use impinge::closed_form::{Conductor, Contact, SuddenSurface};
use impinge::laws::Viscosity;
use impinge::method::sph::{DropletPlan, DropletSph, Extent, Fluid, ParticleFields, Release, Wall};
use impinge::port::WallCells;

/// The case of Park (2019), §2.4.6.
const HOT: f64 = 373.15;
const COLD: f64 = 293.15;
const TIME: f64 = 3.5e-6;
const WATER: Fluid = Fluid {
    density: 1000.0,
    viscosity: Viscosity::Constant(3e-4),
    specific_heat: 4000.0,
    conductivity: 0.6,
    surface_tension: 0.0,
    sound_speed: 50.0,
    freezing: None,
};
const FLUID: Conductor = Conductor { conductivity: 0.6, heat_capacity: 4e6 };
const SOLID: Conductor = Conductor { conductivity: 10.0, heat_capacity: 3950.0 * 900.0 };

/// Fluid and plate as half spaces.
const CONTACT: Contact =
    Contact { first: FLUID, first_temperature: HOT, second: SOLID, second_temperature: COLD };

/// Thickness √(πκt) of the layer in the fluid at the end [m].
fn thickness() -> f64 {
    (PI * FLUID.diffusivity() * TIME).sqrt()
}

/// A layer of fluid on a wall, periodic along it.
struct Layer {
    drop: DropletSph,
    state: Vec<f64>,
    area: f64,
}

#[derive(Clone, Copy)]
struct Case {
    /// H/Δx.
    support: f64,
    /// Whether the temperature before contact is known; without it the layer at the wall is taken to be even.
    thin: bool,
    /// Rate at which the fluid is sheared at first [1/s].
    shear: f64,
    /// Of a solid below.
    effusivity: Option<f64>,
}

const AT_REST: Case = Case { support: 3.0, thin: true, shear: 0.0, effusivity: None };
/// Layers' thickness √(πκt) over Δx.
const FINENESS: [f64; 6] = [0.25, 0.5, 1.0, 2.0, 4.0, 8.0];

impl Layer {
    fn of(spacing: f64, case: Case) -> Self {
        let rows = (8.0 * thickness() / spacing).ceil().max(4.0) as usize;
        let columns = (2.0 * case.support).ceil() as usize;
        let period = columns as f64 * spacing;
        let cells = WallCells::Tiles { count: [1, 1], size: [4.0 * period; 2] };
        let at_no_time = Release {
            time: 1.0,
            centre: [0.0; 3],
            diameter: 0.0,
            velocity: [0.0; 3],
            temperature: HOT,
        };
        let plan = DropletPlan {
            support: case.support,
            extents: [Extent::Periodic(period), Extent::Periodic(period), Extent::Open],
            // Without droplets there is no temperature before contact.
            releases: if case.thin { vec![at_no_time] } else { Vec::new() },
            wall: Some(Wall {
                cells,
                contact_angle: 0.5 * PI,
                effusivity: case.effusivity,
                conductance: None,
            }),
            ..open_space(spacing, WATER)
        };
        let mut particles = ParticleFields::default();
        for n in 0..columns * columns * rows {
            let place = [n % columns, n / columns % columns, n / (columns * columns)];
            let at = place.map(|i| (i as f64 + 0.5) * spacing);
            particles.position.push(at);
            particles.velocity.push([case.shear * at[2], 0.0, 0.0]);
            particles.mass.push(WATER.density * spacing.powi(3));
            particles.density.push(WATER.density);
            particles.temperature.push(HOT);
        }
        let drop = DropletSph::new(plan, 1);
        let state = drop.state_of(&particles);
        Self { drop, state, area: period * period }
    }

    /// Heat given to a wall of this temperature in a time [J/m²].
    fn advance(&mut self, wall: f64, duration: f64) -> f64 {
        self.drop.advance(&mut self.state, &[wall], duration).unwrap();
        self.drop.exchange(&self.state).heat[0] / self.area
    }

    /// Relative error of the heat that particles lost (norm), each of them against the mean of the closed
    /// form over its thickness.
    fn error(&self, exact: impl Fn(f64) -> f64) -> f64 {
        const PARTS: usize = 32;
        let spacing = self.drop.plan().spacing;
        let particles = self.drop.particles(&self.state);
        let place = |z: f64, part: usize| z + spacing * ((part as f64 + 0.5) / PARTS as f64 - 0.5);
        let mean =
            |z: f64| (0..PARTS).map(|part| exact(place(z, part))).sum::<f64>() / PARTS as f64;
        let lost: Vec<f64> = particles.temperature.iter().map(|t| t - HOT).collect();
        let exact: Vec<f64> = particles.position.iter().map(|x| mean(x[2])).collect();
        relative_norm(&lost, &exact)
    }
}

/// The wall keeps its temperature: errors of heat and flux over layers' thickness.
#[test]
fn contact_with_a_held_wall() {
    let exact = SuddenSurface { body: FLUID, step: COLD - HOT };
    let heat = |t: f64| -2.0 * t * exact.flux(t);
    let mut table = Vec::new();
    let sheared = Case { shear: 1e6, ..AT_REST };
    for (kind, title, case) in [
        (0.0, "at rest, layers taken to be even", Case { thin: false, ..AT_REST }),
        (1.0, "at rest", AT_REST),
        (2.0, "at rest, H = 4Δx", Case { support: 4.0, ..AT_REST }),
        (3.0, "sheared by 3.5", sheared),
    ] {
        let mut study = Study::new(
            &format!("Contact with a held wall, fluid {title}"),
            &["heat at t/10", "heat at t", "flux from 0.9 t to t", "temperatures at t (norm)"],
        );
        for fineness in FINENESS {
            let mut layer = Layer::of(thickness() / fineness, case);
            let [first, second, third] =
                [0.1, 0.8, 0.1].map(|part| layer.advance(COLD, part * TIME));
            let errors = vec![
                first / heat(0.1 * TIME) - 1.0,
                (first + second + third) / heat(TIME) - 1.0,
                third / (heat(TIME) - heat(0.9 * TIME)) - 1.0,
                layer.error(|z| exact.rise(z, TIME)),
            ];
            let [coldest, warmest] = layer.drop.totals(&layer.state).temperature_range;
            assert!(coldest >= COLD && warmest <= HOT, "{title}: {coldest} {warmest}");
            table.push([&[kind, fineness], &errors[..]].concat());
            study.add(&format!("Δx = layer/{fineness}"), 1.0 / fineness, errors);
        }
        study.print();
        if case.thin {
            // At any spacing; temperatures of single layers follow.
            let [least, most] = study.range(&[0, 1, 2]);
            assert!(least > -0.013 && most < 0.01, "{title}: {least} {most}");
            // Those that reach farther blur more layers at the wall.
            let norm = if case.support > 3.0 { 2e-2 } else { 7e-3 };
            assert!(study.order(3) > 1.3 && study.finest(3) < norm, "{title}");
        } else {
            // Layers that are not even take their heat too late; what they miss vanishes with them.
            study.require(&[1, 2, 3], 1.0, 7e-3);
        }
    }
    keep("contact_wall.csv", "kind,fineness,early_heat,heat,flux,temperatures", table);
}

/// How layer and plate are joined.
#[derive(Clone, Copy)]
struct Joint {
    fineness: f64,
    thin: bool,
    /// Exchanges in all.
    exchanges: usize,
    /// Thickness and order of the plate's first elements [m].
    depth: f64,
    order: usize,
}

/// Mean flux from the fluid into the plate [W/m²] during each exchange, and the surface's temperature after
/// it [K]. Layer and plate take turns as in a scene that couples them.
fn on_plate(joint: Joint) -> Vec<[f64; 2]> {
    let Joint { fineness, thin, exchanges, depth, order } = joint;
    let mesh = format!("spacing = 5e-5, depth_spacing = {depth:?}, growth = 1.3, order = {order}");
    let footprint = "tiles = { count = [1, 1], size = [1e-4, 1e-4] }";
    let load = format!(
        "[[load]]\nname = \"fluid\"\non = \"plate.top\"\nfootprint = {{ {footprint} }}\ncarries = [\"heat_flux\"]\n"
    );
    let rest = load + &probe("surface", [0.0; 3], "\"temperature\"");
    let mut plate = Trial::new(&alumina("box = [1e-4, 1e-4, 1e-4]", &mesh, "", &rest));
    let effusivity = Some(SOLID.effusivity());
    let mut layer = Layer::of(thickness() / fineness, Case { thin, effusivity, ..AT_REST });
    let interval = TIME / exchanges as f64;
    let mut turn = || {
        let flux = layer.advance(plate.get("surface.temperature"), interval) / interval;
        plate.set("fluid.heat_flux[1,1]", flux);
        plate.step(interval);
        [flux, plate.get("surface.temperature")]
    };
    (0..exchanges).map(|_| turn()).collect()
}

/// Errors of what [`on_plate`] gives.
fn errors_on_plate(joint: Joint, rows: &[[f64; 2]]) -> Vec<f64> {
    let interval = TIME / joint.exchanges as f64;
    let exact_rise = CONTACT.temperature_of_contact() - COLD;
    let rise = |exchange: usize| (rows[exchange - 1][1] - COLD) / exact_rise - 1.0;
    let heat = |range: Range<usize>| {
        let given = interval * rows[range.clone()].iter().map(|row| row[0]).sum::<f64>();
        let [begin, end] = [range.start, range.end].map(|n| n as f64 * interval);
        let before = if begin > 0.0 { CONTACT.heat(begin) } else { 0.0 };
        given / (CONTACT.heat(end) - before) - 1.0
    };
    let (all, tenth) = (joint.exchanges, joint.exchanges / 10);
    vec![rise(1), rise(tenth), rise(all), heat(0..tenth), heat(0..all), heat(all - tenth..all)]
}

/// Two half spaces: contact temperature, heat and flux over layers' thickness, exchanges and elements.
#[test]
fn contact_with_a_plate() {
    let names = [
        "rise after the first exchange",
        "rise at t/10",
        "rise at t",
        "heat at t/10",
        "heat at t",
        "flux from 0.9 t to t",
    ];
    let usual = Joint { fineness: 1.0, thin: true, exchanges: 70, depth: 0.3e-6, order: 2 };
    let mut table = Vec::new();
    for thin in [false, true] {
        let title = if thin { "" } else { ", layers taken to be even" };
        let mut study = Study::new(&format!("Contact with a plate, 70 exchanges{title}"), &names);
        for fineness in FINENESS {
            let joint = Joint { fineness, thin, ..usual };
            let rows = on_plate(joint);
            let time = |n: usize| (n + 1) as f64 * TIME / rows.len() as f64;
            let kind = [f64::from(u8::from(thin)), fineness];
            let row = |(n, row): (usize, &[f64; 2])| [&kind[..], &[time(n)], row].concat();
            table.extend(rows.iter().enumerate().map(row));
            study.add(
                &format!("Δx = layer/{fineness}"),
                1.0 / fineness,
                errors_on_plate(joint, &rows),
            );
        }
        study.print();
        if thin {
            let [least, most] = study.range(&[1, 2, 3, 4, 5]);
            assert!(least > -0.015 && most < 0.01, "{least} {most}");
            assert!(study.finest(2) < 3e-3);
        } else {
            study.require(&[2, 4, 5], 1.3, 6e-3);
            // What the first exchanges miss is more of what there is after seven.
            study.require(&[1, 3], 1.0, 2e-2);
        }
    }
    keep("contact_plate.csv", "thin,fineness,time,flux,temperature", table);
    let coarse = Joint { fineness: 0.5, ..usual };
    let mut study = Study::new("Contact with a plate, Δx = layer/0.5, exchanges", &names);
    for exchanges in [20, 70, 210, 700] {
        let joint = Joint { exchanges, ..coarse };
        let errors = errors_on_plate(joint, &on_plate(joint));
        study.add(&format!("{exchanges}"), 1.0 / exchanges as f64, errors);
    }
    study.print();
    for order in [1, 2] {
        let title = format!("Contact with a plate, Δx = layer/0.5, elements of order {order}");
        let mut study = Study::new(&title, &names);
        for depth in [6e-6, 3e-6, 1e-6, 0.3e-6] {
            let joint = Joint { depth, order, ..coarse };
            let errors = errors_on_plate(joint, &on_plate(joint));
            study.add(&format!("{:.1} µm thick", 1e6 * depth), depth, errors);
        }
        study.print();
    }
}
