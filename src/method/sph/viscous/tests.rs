use super::*;
use crate::kernel::Kernel;
use crate::math::conjugate_gradients::Operator;
use crate::method::sph::neighbours::{Displacements, Neighbours};
use crate::method::sph::order::space_order;
use crate::method::sph::{DropletPlan, Extent, Fluid, Placement, Viscous, Wall};
use crate::port::WallCells;
use crate::scene::Precision;

const SPACING: f64 = 1e-5;

const WITH_PRESSURE: Viscous = Viscous::WithPressure { rate: 1.0 };

static FLUID: Pieces = Pieces::NONE;

/// Very viscous fluid of particles at unit distance over H = 3, without any drop.
fn plan() -> DropletPlan {
    let fluid = Fluid {
        density: 1000.0,
        viscosity: 1.0.into(),
        specific_heat: 4000.0,
        conductivity: 0.0,
        surface_tension: 0.0,
        sound_speed: 100.0,
        freezing: None,
    };
    DropletPlan {
        dimension: 3,
        axisymmetric: false,
        spacing: SPACING,
        support: 3.0,
        kernel: Kernel::WendlandC2,
        fluid,
        placement: Placement::Lattice,
        precision: Precision::Double,
        viscous: Viscous::Implicit { rate: 1.0 },
        density_diffusion: 0.1,
        corrected_diffusion: false,
        shifting: false,
        gravity: [0.0; 3],
        mirrors: [false; 2],
        extents: [Extent::Open; 3],
        releases: Vec::new(),
        demand: None,
        feed: None,
        wall: None,
    }
}

fn wall() -> Option<Wall> {
    let cells = WallCells::Tiles { count: [1, 1], size: [1e-3; 2] };
    Some(Wall { cells, contact_angle: 1.0, effusivity: None, conductance: None })
}

/// Numbers in [0, 1) without order.
fn number(i: usize) -> f64 {
    (i as f64 * 0.754877666 + 0.123).fract()
}

/// A ball of disordered particles; of their coordinates, over their distance, only those beyond
/// the planes of the plan.
fn ball(plan: &DropletPlan, radius: f64, centre: f64) -> (Cloud, Neighbours) {
    let reach = radius.ceil() as i64 + centre.ceil() as i64;
    let axis = || -reach..=reach;
    let mut points = Vec::new();
    for (i, j, k) in axis().flat_map(|i| axis().flat_map(move |j| axis().map(move |k| (i, j, k)))) {
        let n = points.len();
        let jitter = |a: usize| 0.3 * (number(3 * n + a) - 0.5);
        let flat = plan.dimension == 2 || plan.axisymmetric;
        if flat && j != 0 {
            continue;
        }
        let mut x = [i, j, k].map(|i| i as f64 + 0.5);
        (0..3).for_each(|a| x[a] += jitter(a));
        if flat {
            x[1] = 0.0;
        }
        let inside = x[0] * x[0] + x[1] * x[1] + (x[2] - centre).powi(2) < radius * radius;
        let [above_x, above_y] = plan.even();
        let kept = (x[2] > 0.0 || plan.wall.is_none())
            && (x[0] > 0.0 || !above_x)
            && (x[1] >= 0.0 || !above_y);
        if inside && kept {
            points.push(x);
        }
    }
    let team = Team::new(1);
    let order = space_order(&points, &team);
    let mut cloud = Cloud::default();
    for &i in &order {
        let place = points[i as usize].map(|x| x / plan.support);
        let around = if plan.axisymmetric { 2.0 * std::f64::consts::PI * place[0] } else { 1.0 };
        let axes = plan.axes() as i32;
        cloud.push(place, [0.0; 3], around * plan.support.powi(-axes), 0.0);
    }
    let images = Method::of(plan).images.clone();
    let mut neighbours = Neighbours::of(&cloud.position, &team);
    let none = Displacements::none(cloud.len());
    neighbours.prepare(&cloud.position, &none, &images, &team);
    (cloud, neighbours)
}

/// Plans with all kinds of images, with the height of a ball's centre over its particles' distance.
fn plans() -> Vec<(DropletPlan, f64)> {
    let side = 12.0 * SPACING;
    vec![
        (plan(), 0.0),
        (DropletPlan { mirrors: [true, true], wall: wall(), ..plan() }, 3.0),
        (DropletPlan { dimension: 2, wall: wall(), ..plan() }, 3.0),
        (DropletPlan { axisymmetric: true, wall: wall(), ..plan() }, 3.0),
        (
            DropletPlan {
                dimension: 2,
                wall: wall(),
                extents: [Extent::Periodic(side), Extent::Open, Extent::Closed(side)],
                ..plan()
            },
            6.0,
        ),
    ]
}

/// The system of a Newtonian fluid over a time step.
fn newtonian<'a>(
    method: &'a Method,
    cloud: &'a Cloud,
    neighbours: &'a Neighbours,
    dt: f64,
    team: &'a Team,
) -> System<'a> {
    let moduli = vec![Moduli::newtonian(method.viscosity); cloud.len()];
    System::of(method, cloud, &FLUID, &neighbours.blocks, dt, moduli, team)
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// Velocities without order, in the plane if that is all that moves.
fn disordered(plan: &DropletPlan, count: usize, seed: usize) -> Vec<f64> {
    let flat = plan.dimension == 2 || plan.axisymmetric;
    let value = |n: usize| if flat && n % 3 == 1 { 0.0 } else { number(7 * n + seed) - 0.5 };
    (0..3 * count).map(value).collect()
}

#[test]
fn operator_is_symmetric_and_positive() {
    let with_pressure = |(plan, centre): (DropletPlan, f64)| {
        (DropletPlan { viscous: WITH_PRESSURE, ..plan }, centre)
    };
    for (plan, centre) in plans().into_iter().chain(plans().into_iter().map(with_pressure)) {
        let (cloud, neighbours) = ball(&plan, 5.5, centre);
        let (method, team) = (Method::of(&plan), Team::new(2));
        let system = newtonian(&method, &cloud, &neighbours, 10.0, &team);
        let [x, y] = [1, 4].map(|seed| disordered(&plan, cloud.len(), seed));
        let apply = |x: &[f64]| {
            let mut out = vec![0.0; x.len()];
            system.apply(x, &mut out);
            out
        };
        let (ax, ay) = (apply(&x), apply(&y));
        let size = (dot(&x, &ax) * dot(&y, &ay)).sqrt();
        assert!((dot(&y, &ax) - dot(&x, &ay)).abs() < 1e-10 * size, "{:?}", plan.extents);
        assert!(dot(&x, &ax) > 0.0 && dot(&y, &ay) > 0.0);
    }
}

/// Dissipation `½ u·A u` over the exact one of a uniform strain rate.
fn dissipation(plan: &DropletPlan, gradient: [[f64; 3]; 3]) -> f64 {
    let (cloud, neighbours) = ball(plan, 6.5, 0.0);
    let (method, team) = (Method::of(plan), Team::new(1));
    let system = newtonian(&method, &cloud, &neighbours, 1.0, &team);
    let velocity: Vec<f64> =
        cloud.position.iter().flat_map(|x| gradient.map(|row| dot(&row, x))).collect();
    let mut out = vec![0.0; velocity.len()];
    system.apply(&velocity, &mut out);
    let masses: Vec<f64> = cloud.mass.iter().flat_map(|m| [*m; 3]).collect();
    let of_mass: f64 = velocity.iter().zip(&masses).map(|(v, m)| m * v * v).sum();
    let found = 0.5 * (dot(&velocity, &out) - of_mass);
    let rate = |a: usize, b: usize| 0.5 * (gradient[a][b] + gradient[b][a]);
    let squares: f64 = (0..9).map(|n| rate(n / 3, n % 3).powi(2)).sum();
    let trace: f64 = (0..3).map(|a| rate(a, a)).sum();
    let volume: f64 = cloud.mass.iter().sum();
    found / (method.viscosity * volume * (squares + 0.5 * trace * trace)).max(1e-300)
}

#[test]
fn uniform_strain_dissipates_exactly_up_to_free_surfaces() {
    let space = plan();
    let plane = DropletPlan { dimension: 2, ..plan() };
    let rings = DropletPlan { axisymmetric: true, ..plan() };
    let shear = [[0.0, 0.0, 1.0], [0.0; 3], [0.0; 3]];
    let stretch = [[-0.5, 0.0, 0.0], [0.0, -0.5, 0.0], [0.0, 0.0, 1.0]];
    let squeeze = [[1.0, 0.0, 0.0], [0.0; 3], [0.0, 0.0, -1.0]];
    let spread = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0; 3]];
    let cases = [
        (&space, vec![shear, stretch, squeeze, spread]),
        (&plane, vec![shear, squeeze]),
        (&rings, vec![stretch, spread]),
    ];
    for (plan, gradients) in cases {
        for gradient in gradients {
            let ratio = dissipation(plan, gradient);
            assert!((ratio - 1.0).abs() < 4e-3, "{gradient:?}: {ratio}");
        }
    }
}

#[test]
fn rigid_motion_bears_no_force() {
    let plan = plan();
    let (cloud, neighbours) = ball(&plan, 5.5, 0.0);
    let (method, team) = (Method::of(&plan), Team::new(1));
    let system = newtonian(&method, &cloud, &neighbours, 1.0, &team);
    let turning =
        |[x, y, z]: [f64; 3]| [1.0 + 2.0 * y - 3.0 * z, 4.0 * z - 2.0 * x, 3.0 * x - 4.0 * y];
    let velocity: Vec<f64> = cloud.position.iter().flat_map(|x| turning(*x)).collect();
    let pairs = system.elongations(&velocity);
    let forces = system.forces(&pairs, &system.forms(&pairs));
    let largest = forces.as_flattened().as_flattened().iter().fold(0.0_f64, |a, f| a.max(f.abs()));
    assert!(largest < 1e-10, "{largest}");
}

#[test]
fn momentum_and_angular_momentum_are_conserved() {
    for viscous in [Viscous::Implicit { rate: 1.0 }, WITH_PRESSURE] {
        conserves_momenta(&DropletPlan { viscous, ..plan() });
    }
}

fn conserves_momenta(plan: &DropletPlan) {
    let (mut cloud, neighbours) = ball(plan, 5.5, 0.0);
    let velocity = disordered(plan, cloud.len(), 2);
    cloud.velocity = velocity.as_chunks().0.to_vec();
    let (method, team) = (Method::of(plan), Team::new(2));
    let start = (10.0, &cloud.velocity[..]);
    let step = advance(&method, &cloud, &FLUID, &neighbours.blocks, start, &team).unwrap();
    let (mut change, mut turn, mut whole) = ([0.0; 3], [0.0; 3], 0.0);
    for (i, v) in step.changes.iter().enumerate() {
        let (m, x) = (cloud.mass[i], cloud.position[i]);
        for a in 0..3 {
            let (b, c) = ((a + 1) % 3, (a + 2) % 3);
            change[a] += m * v[a];
            turn[a] += m * (x[b] * v[c] - x[c] * v[b]);
            whole += m * v[a].abs();
        }
    }
    assert!(change.iter().chain(&turn).all(|sum| sum.abs() < 1e-11 * whole), "{change:?} {turn:?}");
}
