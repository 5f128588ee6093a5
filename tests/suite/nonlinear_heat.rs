//! What nonlinear conduction must do: closed forms with rates, balances, ends of ranges.

mod ranges;

use impinge::closed_form::{
    Conductor, Contact as TwoBodies, LinearConductivity, MeltingFront, RadiatingLump,
};
use impinge::laws::{Conduction, Melting, Property, Table};
use impinge::method::enthalpy::{Condition, Contact, EnthalpyHeat, Face, Loads, Setup};
use impinge::method::fem::{
    Axis, Geometry, HeatLoads, HeatProblem, Layering, Mesh, MeshFace, ThermalFace, Weight,
};
use impinge::runtime::allowance::Allowance;

static NONE: [Vec<f64>; 2] = [Vec::new(), Vec::new()];
const BOTTOM: MeshFace = MeshFace { axis: 2, high: false };
const TOP: MeshFace = MeshFace { axis: 2, high: true };
const RIGHT: MeshFace = MeshFace { axis: 0, high: true };

fn line(length: f64, count: usize) -> Axis {
    let ends: Vec<f64> = (0..=count).map(|i| length * i as f64 / count as f64).collect();
    Axis::from_element_ends(&ends, 1, Weight::Uniform)
}

fn slab(length: f64, count: usize) -> Mesh {
    let axes = [Axis::point(), Axis::point(), line(length, count)];
    Mesh { axes, mirrored: [false; 2], geometry: Geometry::Box, layering: Layering::default() }
}

fn block(lengths: [f64; 3], counts: [usize; 3]) -> Mesh {
    let axes = [0, 1, 2].map(|a| line(lengths[a], counts[a]));
    Mesh { axes, mirrored: [false; 2], geometry: Geometry::Box, layering: Layering::default() }
}

fn disc(radius: f64, depth: f64, counts: [usize; 2]) -> Mesh {
    let ends: Vec<f64> = (0..=counts[0]).map(|i| radius * i as f64 / counts[0] as f64).collect();
    let r = Axis::from_element_ends(&ends, 1, Weight::Radial);
    let axes = [r, Axis::point(), line(depth, counts[1])];
    Mesh {
        axes,
        mirrored: [false; 2],
        geometry: Geometry::Axisymmetric,
        layering: Layering::default(),
    }
}

fn plain(density: f64, specific_heat: f64, conductivity: f64) -> Conduction {
    let (specific_heat, conductivity) = (specific_heat.into(), conductivity.into());
    Conduction { density, specific_heat, conductivity, melting: None }
}

fn table(temperature: &[f64], value: &[f64]) -> Property {
    Property::Table(Table { temperature: temperature.to_vec(), value: value.to_vec() })
}

fn setup(
    mesh: Mesh,
    reference: f64,
    material: Conduction,
    faces: &[(MeshFace, Condition)],
) -> Setup {
    let faces = faces.iter().map(|&(place, condition)| Face { place, condition }).collect();
    let materials = vec![material];
    Setup { mesh, reference, materials, layers: Vec::new(), contacts: Vec::new(), faces }
}

/// A problem and its state.
struct Run {
    heat: EnthalpyHeat,
    state: Vec<f64>,
}

impl Run {
    fn new(setup: &Setup) -> Self {
        let heat = EnthalpyHeat::new(setup).unwrap();
        let state = heat.initial_state(setup.reference);
        Self { heat, state }
    }

    fn advance(&mut self, faces: &[f64], dt: f64, tolerance: f64) {
        self.load(&[Loads { surface: &NONE, faces }], dt, tolerance);
    }

    #[track_caller]
    fn load(&mut self, loads: &[Loads], dt: f64, tolerance: f64) {
        self.heat.advance(&mut self.state, loads, dt, tolerance, &Allowance::default()).unwrap();
        assert!(self.imbalance() < 1e-9, "{}", self.imbalance());
    }

    /// Heat in less heat stored and lost, over what passed.
    fn imbalance(&self) -> f64 {
        let (totals, stored) = (self.heat.totals(&self.state), self.heat.stored(&self.state));
        let moved = totals.brought_in.abs() + totals.lost.abs() + stored.abs();
        (totals.brought_in - totals.lost - stored).abs() / moved.max(f64::MIN_POSITIVE)
    }

    fn temperatures(&self) -> Vec<f64> {
        self.heat.temperatures(&self.state)
    }

    fn steps(&self) -> f64 {
        self.heat.steps(&self.state)
    }

    /// Volume of what is liquid, over the area of a slab: depth [m].
    fn liquid(&self) -> f64 {
        self.heat.liquid(&self.state).iter().map(|[volume, part]| volume * part).sum()
    }
}

fn rate(coarse: f64, fine: f64) -> f64 {
    (coarse / fine).log2()
}

#[test]
fn constant_constants_give_the_exact_modes_at_second_order() {
    let (capacity, conductivity, ambient) = (6.0, 5.0, 40.0);
    let difference = |n: usize| {
        let mesh = block([1.0, 0.8, 0.5], [2 * n, n, n]);
        let conditions = [
            (TOP, ThermalFace::Flux, Condition::Flux, 300.0),
            (RIGHT, ThermalFace::Prescribed, Condition::Prescribed, -20.0),
            (BOTTOM, ThermalFace::Convective(8.0), Condition::Convective(8.0), ambient),
        ];
        let modal = HeatProblem::homogeneous(
            &mesh,
            capacity,
            conductivity,
            conditions.iter().map(|c| (c.0, c.1)).collect(),
        );
        let mut exact = vec![0.0; modal.layout().len()];
        let values = [conditions.iter().map(|c| c.3).collect::<Vec<f64>>()];
        let loads = HeatLoads { surface: std::slice::from_ref(&NONE), faces: &values };
        modal.advance(&mut exact, &[loads], 0.05);
        let faces: Vec<_> = conditions.iter().map(|c| (c.0, c.2)).collect();
        let mut run = Run::new(&setup(mesh.clone(), 300.0, plain(2.0, 3.0, conductivity), &faces));
        run.advance(&[300.0, 280.0, 340.0], 0.05, 1e-5);
        let middle = n + (2 * n + 1) * (n / 2 + (n + 1) * (n / 2));
        let point = [0.5, 0.4, 0.25];
        let wanted = modal.temperature_at(&mesh, &exact, &values, point, [false; 2]);
        let totals = [modal.totals(&exact).lost, run.heat.totals(&run.state).lost];
        assert!(wanted.abs() > 1.0 && totals[0].abs() > 1.0);
        [(run.temperatures()[middle] - 300.0 - wanted).abs(), (totals[1] - totals[0]).abs()]
    };
    let (coarse, fine) = (difference(4), difference(8));
    for (i, what) in ["temperature", "heat lost"].iter().enumerate() {
        let rate = rate(coarse[i], fine[i]);
        assert!(rate > 1.5, "{what}: {coarse:?} {fine:?}, rate {rate}");
    }
}

/// `k` and `c` that grow linearly from 300 K on by 0.3 % per kelvin.
fn kirchhoff() -> (LinearConductivity, Conduction) {
    let body = Conductor { conductivity: 5.0, heat_capacity: 6.0 };
    let grown = |value: f64| table(&[200.0, 900.0], &[0.7 * value, 2.8 * value]);
    let material = Conduction {
        density: 2.0,
        specific_heat: grown(3.0),
        conductivity: grown(5.0),
        melting: None,
    };
    (LinearConductivity { body, slope: 3e-3 }, material)
}

#[test]
fn a_half_space_of_changing_conductivity_converges_at_second_order() {
    let (exact, material) = kirchhoff();
    let (length, time) = (4.0, 0.1);
    for (condition, value) in [(Condition::Prescribed, 800.0), (Condition::Flux, 3000.0)] {
        let error = |n: usize| {
            let faces = [(BOTTOM, condition)];
            let mut run = Run::new(&setup(slab(length, n), 300.0, material.clone(), &faces));
            run.advance(&[value], time, 1e-4);
            let rise = |z: f64| match condition {
                Condition::Flux => exact.uniform_flux(value, z, time),
                _ => exact.sudden_surface(value - 300.0, z, time),
            };
            let t = run.temperatures();
            let off = |i: usize| t[i] - 300.0 - rise(length * i as f64 / n as f64);
            (0..=n).map(|i| off(i).powi(2) * length / n as f64).sum::<f64>().sqrt()
        };
        let errors = [40, 80, 160].map(error);
        for pair in errors.windows(2) {
            let rate = rate(pair[0], pair[1]);
            assert!((rate - 2.0).abs() < 0.15, "{condition:?}: {errors:?}, rate {rate}");
        }
    }
}

#[test]
fn a_steady_slab_of_changing_conductivity_is_exact_at_the_nodes() {
    let (exact, material) = kirchhoff();
    let faces = [(BOTTOM, Condition::Prescribed), (TOP, Condition::Prescribed)];
    let mut run = Run::new(&setup(slab(2.0, 7), 300.0, material, &faces));
    run.advance(&[250.0, 850.0], 1e4, 1e-6);
    for (i, t) in run.temperatures().iter().enumerate() {
        let wanted = 300.0 + exact.steady_slab([-50.0, 550.0], i as f64 / 7.0);
        assert!((t - wanted).abs() < 1e-5, "{i}: {t} {wanted}");
    }
    // What goes in at the top goes out at the bottom.
    let before = run.heat.totals(&run.state).lost;
    run.advance(&[250.0, 850.0], 1.0, 1e-6);
    assert!((run.heat.totals(&run.state).lost - before).abs() < 1e-3);
}

/// Ice and water of one density.
fn water(solidus: f64, liquidus: f64) -> Conduction {
    Conduction {
        density: 1000.0,
        specific_heat: table(&[273.1499, 273.1501], &[2050.0, 4200.0]),
        conductivity: table(&[273.1499, 273.1501], &[2.2, 0.57]),
        melting: Some(Melting { solidus, liquidus, latent_heat: 3.34e5 }),
    }
}

/// Errors of water that freezes or ice that melts from its bottom: of the depth of the front, root mean square over
/// times and relative to the last one; its largest move from time to time, over the first one; and the mean error of
/// temperature [K].
fn front(surface: f64, initial: f64, n: usize, tolerance: f64) -> [f64; 3] {
    let ice = Conductor { conductivity: 2.2, heat_capacity: 2.05e6 };
    let liquid = Conductor { conductivity: 0.57, heat_capacity: 4.2e6 };
    let freezes = surface < 273.15;
    let (new, old) = if freezes { (ice, liquid) } else { (liquid, ice) };
    let (latent, beyond) = (3.34e8, |t: f64| (t - 273.15).abs());
    let exact =
        MeltingFront { new, old, latent, surface: beyond(surface), initial: beyond(initial) };
    let length = 0.15;
    let faces = [(BOTTOM, Condition::Prescribed)];
    let setup = setup(slab(length, n), 273.15, water(273.15, 273.15), &faces);
    let mut run = Run::new(&setup);
    // At the temperature of freezing itself a body is solid.
    let start = if freezes { initial + 1e-9 } else { initial };
    run.state = run.heat.initial_state(start);
    let sign = if freezes { -1.0 } else { 1.0 };
    let (mut sum, mut largest, mut before, mut mean) = (0.0, 0.0_f64, 0.0, 0.0);
    for number in 1..=TIMES {
        let time = 30.0 * number as f64;
        run.advance(&[surface], 30.0, tolerance);
        let depth = if freezes { length - run.liquid() } else { run.liquid() };
        sum += (depth - exact.depth(time)).powi(2);
        largest = largest.max(depth - before);
        before = depth;
        for (i, t) in run.temperatures().iter().enumerate() {
            let rise = exact.rise(length * i as f64 / n as f64, time);
            mean += (t - 273.15 - sign * rise).abs() / ((n + 1) * TIMES) as f64;
        }
    }
    let first = exact.depth(30.0);
    [(sum / TIMES as f64).sqrt() / before, largest / first, mean]
}

/// Times at which fronts are looked at.
const TIMES: usize = 30;

#[test]
fn fronts_go_as_neumann_says_and_do_not_stall() {
    for [surface, initial] in
        [[253.15, 273.15], [253.15, 278.15], [303.15, 273.15], [293.15, 263.15]]
    {
        let (coarse, fine) = (front(surface, initial, 60, 0.3), front(surface, initial, 240, 0.3));
        let rates = [0, 2].map(|i| 0.5 * rate(coarse[i], fine[i]));
        assert!(fine[0] < 0.01, "{surface} {initial}: {fine:?}");
        // The front goes on by the same share everywhere, nodes or not: it is fastest at first.
        assert!(fine[1] < 1.2, "{surface} {initial}: {fine:?}");
        assert!(
            rates[0] > 0.8 && rates[1] > 0.8,
            "{surface} {initial}: {coarse:?} {fine:?} {rates:?}"
        );
    }
}

#[test]
fn a_molten_pool_freezes_and_every_joule_is_accounted_for() {
    // A hot disc melts a pool, which freezes when the heat is off and the disc radiates.
    let steel = Conduction {
        density: 7500.0,
        specific_heat: table(&[300.0, 1000.0, 1050.0, 1800.0], &[450.0, 800.0, 700.0, 830.0]),
        conductivity: table(&[300.0, 1100.0, 1750.0], &[50.0, 27.0, 34.0]),
        melting: Some(Melting { solidus: 1720.0, liquidus: 1770.0, latent_heat: 2.6e5 }),
    };
    let mesh = disc(4e-3, 2e-3, [16, 12]);
    let faces = [(TOP, Condition::Radiative(0.8)), (TOP, Condition::Convective(50.0))];
    let mut run = Run::new(&setup(mesh.clone(), 300.0, steel, &faces));
    let areas: Vec<f64> = mesh.axes[0].integrals();
    let spot: Vec<f64> = areas.iter().take(6).map(|area| 1e8 * area).collect();
    let heat: f64 = spot.iter().sum();
    let on = [Vec::new(), [spot, vec![0.0; 11]].concat()];
    let values = [300.0, 300.0];
    run.load(&[Loads { surface: &on, faces: &values }], 0.25, 0.5);
    let melted = run.liquid();
    let hottest = run.temperatures().into_iter().fold(0.0, f64::max);
    assert!(melted > 1e-10 && hottest > 1800.0, "{melted:e} {hottest}");
    assert!((run.heat.totals(&run.state).brought_in / (0.25 * heat) - 1.0).abs() < 1e-12);
    run.advance(&values, 0.05, 0.5);
    let later = run.liquid();
    assert!(later < melted, "{later:e} {melted:e}");
    run.advance(&values, 20.0, 0.5);
    assert_eq!(run.liquid(), 0.0);
    run.advance(&values, 1e5, 0.5);
    assert!(run.temperatures().iter().all(|t| (t - 300.0).abs() < 0.5));
}

#[test]
fn a_thin_sheet_radiates_as_the_closed_forms_say_the_better_the_smaller_the_tolerance() {
    for (initial, ambient) in [(1500.0, 0.0), (1500.0, 400.0), (300.0, 900.0)] {
        let exact =
            RadiatingLump { capacity: 1000.0 * 500.0 * 1e-3, emissivity: 0.8, initial, ambient };
        let error = |tolerance: f64| {
            let faces = [(TOP, Condition::Radiative(0.8))];
            let material = plain(1000.0, 500.0, 1e7);
            let mut run = Run::new(&setup(slab(1e-3, 2), initial, material, &faces));
            run.advance(&[ambient], 20.0, tolerance);
            ((run.temperatures()[1] - exact.temperature(20.0)).abs(), run.steps())
        };
        let (coarse, fine) = (error(1.0), error(1e-3));
        assert!(fine.0 < 2e-2, "{coarse:?} {fine:?}");
        let order = (coarse.0 / fine.0).ln() / (fine.1 / coarse.1).ln();
        assert!(order > 2.0, "{initial} {ambient}: {coarse:?} {fine:?}, order {order}");
    }
}

#[test]
fn time_is_at_third_order() {
    let (_, material) = kirchhoff();
    let faces = [(BOTTOM, Condition::Flux), (TOP, Condition::Radiative(1.0))];
    let end = |tolerance: f64| {
        let mut run = Run::new(&setup(slab(1.0, 10), 300.0, material.clone(), &faces));
        let derivatives = [[0.0, 500.0], [8000.0, 0.0], [-4000.0, 0.0]];
        let loads = derivatives.each_ref().map(|faces| Loads { surface: &NONE, faces });
        run.load(&loads, 1.0, tolerance);
        // The flux is 8000 t − 2000 t².
        let wanted = 4000.0 - 2000.0 / 3.0;
        assert!((run.heat.totals(&run.state).brought_in / wanted - 1.0).abs() < 1e-12);
        (run.temperatures()[0], run.steps())
    };
    let (exact, runs) = (end(1e-9), [0.3, 0.03, 0.003, 3e-4].map(end));
    for pair in runs.windows(2) {
        let errors = [0, 1].map(|i| (pair[i].0 - exact.0).abs());
        let order = (errors[0] / errors[1]).ln() / (pair[1].1 / pair[0].1).ln();
        assert!(order > 2.5, "{runs:?} {exact:?}, order {order}");
    }
}

#[test]
fn flux_and_fluid_come_to_rest_where_they_balance() {
    let (_, material) = kirchhoff();
    let faces = [(TOP, Condition::Flux), (TOP, Condition::Convective(40.0))];
    let mut run = Run::new(&setup(slab(1.0, 10), 300.0, material, &faces));
    run.advance(&[2000.0, 320.0], 1e4, 1e-4);
    assert!(run.temperatures().iter().all(|t| (t - 370.0).abs() < 1e-4));
}

#[test]
fn layers_with_a_contact_have_the_steady_temperatures_of_resistances_in_series() {
    let mesh = slab(3e-3, 6);
    let faces = [(BOTTOM, Condition::Prescribed), (TOP, Condition::Flux)];
    let mut setup = setup(mesh, 300.0, plain(8900.0, 385.0, 400.0), &faces);
    setup.materials.push(plain(120.0, 1000.0, 0.02));
    setup.materials.push(plain(3950.0, 900.0, 20.0));
    setup.layers = vec![0, 0, 1, 1, 2, 2];
    setup.contacts = vec![Contact { below: 4, conductance: 500.0 }];
    let mut run = Run::new(&setup);
    run.advance(&[300.0, 1e4], 1e6, 1e-6);
    let rises: Vec<f64> = run.temperatures().iter().map(|t| (t - 300.0) / 1e4).collect();
    let mut wanted = vec![0.0, 5e-4 / 400.0, 1e-3 / 400.0];
    wanted.extend([5e-4, 1e-3].map(|z| 1e-3 / 400.0 + z / 0.02));
    let above = 1e-3 / 400.0 + 1e-3 / 0.02 + 1.0 / 500.0;
    wanted.extend([0.0, 5e-4, 1e-3].map(|z| above + z / 20.0));
    assert_eq!(rises.len(), wanted.len());
    for (rise, wanted) in rises.iter().zip(&wanted) {
        assert!((rise - wanted).abs() < 1e-8, "{rises:?} {wanted:?}");
    }
}

#[test]
fn two_bodies_in_contact_share_the_temperature_that_their_effusivities_say() {
    let (first, second) = (plain(2700.0, 900.0, 200.0), plain(1000.0, 4000.0, 0.6));
    let of = |m: &Conduction, c: f64, k: f64| Conductor {
        heat_capacity: m.density * c,
        conductivity: k,
    };
    let exact = TwoBodies {
        first: of(&first, 900.0, 200.0),
        first_temperature: 400.0,
        second: of(&second, 4000.0, 0.6),
        second_temperature: 300.0,
    };
    let error = |n: usize| {
        // As deep as heat goes, on either side.
        let mut ends: Vec<f64> = (0..=n).map(|i| 4e-3 * i as f64 / n as f64).collect();
        ends.extend((1..=n).map(|i| 4e-3 + 3e-4 * i as f64 / n as f64));
        let mut mesh = slab(1.0, 1);
        mesh.axes[2] = Axis::from_element_ends(&ends, 1, Weight::Uniform);
        let mut setup = setup(mesh, 300.0, first.clone(), &[]);
        setup.materials.push(second.clone());
        setup.layers = (0..2 * n).map(|e| usize::from(e >= n)).collect();
        let heat = EnthalpyHeat::new(&setup).unwrap();
        let start: Vec<f64> = ends.iter().map(|z| exact.temperature(z - 4e-3, 1e-12)).collect();
        let state = heat.initial_state_of(&start);
        let mut run = Run { heat, state };
        let loads = [Loads { surface: &NONE, faces: &[] }];
        run.heat.advance(&mut run.state, &loads, 0.005, 1e-4, &Allowance::default()).unwrap();
        // The first body gave what the second has got.
        assert!(run.heat.stored(&run.state).abs() < 1e-12 * 2700.0 * 900.0 * 4e-3 * 100.0);
        let off = |(z, t): (&f64, f64)| (t - exact.temperature(z - 4e-3, 0.005)).powi(2);
        let sum: f64 = ends.iter().zip(run.temperatures()).map(off).sum();
        (sum / ends.len() as f64).sqrt()
    };
    let errors = [10, 20, 40].map(error);
    assert!(errors[2] < 1.0, "{errors:?}");
    for pair in errors.windows(2) {
        assert!(rate(pair[0], pair[1]) > 0.8, "{errors:?}");
    }
}
