//! Frozen particles are rigid: pieces on the wall rest, others move as rigid bodies, and all balances close.

use impinge::kernel::Kernel;
use impinge::laws::{Freezing, Melting};
use impinge::method::sph::{
    DropletPlan, DropletSph, Extent, Fluid, ParticleFields, Placement, Precision, Release, Viscous,
    Wall,
};
use impinge::port::WallCells;
use nalgebra::Vector3;

const SPACING: f64 = 1e-3;
const DENSITY: f64 = 1000.0;
const SOUND: f64 = 10.0;
const FROZEN: f64 = 400.0;
const MOLTEN: f64 = 600.0;
const TURNED: [f64; 3] = [0.3, -0.5, 0.7];

/// Fluid that conducts nearly no heat, so that what is frozen stays so.
fn plan() -> DropletPlan {
    let melting = Melting { solidus: 490.0, liquidus: 500.0, latent_heat: 1e5 };
    let conductivity = 1e-9;
    let fluid = Fluid {
        density: DENSITY,
        viscosity: 0.1.into(),
        specific_heat: 4000.0,
        conductivity,
        surface_tension: 0.0,
        sound_speed: SOUND,
        freezing: Some(Freezing { melting, specific_heat: 4000.0, conductivity }),
    };
    let release = Release {
        time: 0.0,
        centre: [0.0; 3],
        diameter: 4.0 * SPACING,
        velocity: [0.0; 3],
        temperature: MOLTEN,
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
        viscous: Viscous::Explicit,
        density_diffusion: 0.1,
        corrected_diffusion: false,
        shifting: true,
        gravity: [0.0; 3],
        mirrors: [false; 2],
        extents: [Extent::Open; 3],
        releases: vec![release],
        demand: None,
        feed: None,
        wall: None,
    }
}

fn walled(plan: DropletPlan) -> DropletPlan {
    let cells = WallCells::Tiles { count: [1, 1], size: [1.0; 2] };
    let wall = Wall { cells, contact_angle: 1.0, effusivity: None, conductance: None };
    DropletPlan { wall: Some(wall), ..plan }
}

/// Particles on a lattice where `temperature` has a value there [K], for positions over Δx; velocities as given [m/s].
fn particles(
    plan: &DropletPlan,
    temperature: impl Fn([f64; 3]) -> Option<f64>,
    velocity: impl Fn([f64; 3]) -> [f64; 3],
) -> ParticleFields {
    const REACH: i32 = 14;
    let mut fields = ParticleFields::default();
    let flat = plan.axes() == 2;
    let axis = || -REACH..REACH;
    for (i, j, k) in axis().flat_map(|i| axis().flat_map(move |j| axis().map(move |k| (i, j, k)))) {
        let at = [i, j, k].map(|n| f64::from(n) + 0.5);
        let x = [at[0], if flat { 0.0 } else { at[1] }, at[2]];
        let [even_x, even_y] = plan.even();
        if (flat && j != 0) || (even_x && x[0] < 0.0) || (even_y && x[1] < 0.0) {
            continue;
        }
        let Some(temperature) = temperature(x) else { continue };
        let around = if plan.axisymmetric { std::f64::consts::TAU * x[0] * SPACING } else { 1.0 };
        fields.position.push(x.map(|x| x * SPACING));
        fields.velocity.push(velocity(x));
        fields.mass.push(DENSITY * SPACING.powi(plan.axes() as i32) * around);
        fields.density.push(DENSITY);
        fields.temperature.push(temperature);
    }
    fields.pressure = vec![0.0; fields.mass.len()];
    fields
}

fn norm(x: [f64; 3]) -> f64 {
    x.iter().map(|x| x * x).sum::<f64>().sqrt()
}

fn minus(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

/// A frozen ball about a centre.
fn ball(centre: [f64; 3], radius: f64) -> impl Fn([f64; 3]) -> Option<f64> {
    move |x| (norm(minus(x, centre)) < radius).then_some(FROZEN)
}

fn turning([x, y, z]: [f64; 3], spin: [f64; 3]) -> [f64; 3] {
    let [p, q, r] = spin.map(|s| s * SPACING);
    [q * z - r * y, r * x - p * z, p * y - q * x]
}

/// Mass, momentum, angular momentum and kinetic energy.
fn sums(fields: &ParticleFields) -> (f64, [f64; 3], [f64; 3], f64) {
    let (mut mass, mut momentum, mut energy) = (0.0, Vector3::zeros(), 0.0);
    let mut angular = Vector3::zeros();
    for (i, &m) in fields.mass.iter().enumerate() {
        let [x, v] = [fields.position[i], fields.velocity[i]].map(Vector3::from);
        mass += m;
        momentum += m * v;
        angular += m * x.cross(&v);
        energy += 0.5 * m * v.norm_squared();
    }
    (mass, momentum.into(), angular.into(), energy)
}

/// Distances of the particles from the first one.
fn shape(fields: &ParticleFields) -> Vec<f64> {
    let mut shape: Vec<f64> =
        fields.position.iter().map(|&x| norm(minus(x, centre(fields)))).collect();
    shape.sort_by(f64::total_cmp);
    shape
}

fn centre(fields: &ParticleFields) -> [f64; 3] {
    let (mass, ..) = sums(fields);
    [0, 1, 2].map(|a| {
        fields.position.iter().zip(&fields.mass).map(|(x, m)| m * x[a]).sum::<f64>() / mass
    })
}

fn assert_same_shape(a: &ParticleFields, b: &ParticleFields) {
    for (a, b) in shape(a).iter().zip(shape(b)) {
        assert!((a - b).abs() < 1e-11 * SPACING, "{a} {b}");
    }
}

fn assert_near(a: [f64; 3], b: [f64; 3], tolerance: f64) {
    assert!(norm(minus(a, b)) <= tolerance, "{a:?} {b:?} {tolerance:e}");
}

/// Momentum, plus the wall's impulse, less that of gravity; and the sum of the sizes of these.
fn balance(drop: &DropletSph, state: &[f64]) -> ([f64; 3], f64) {
    let totals = drop.totals(state);
    let sum = [0, 1, 2]
        .map(|a| totals.momentum[a] + totals.impulse_to_wall[a] - totals.impulse_of_gravity[a]);
    (sum, norm(totals.impulse_to_wall) + norm(totals.momentum) + norm(totals.impulse_of_gravity))
}

/// The plan with each way to advance viscosity and pressure.
fn each(plan: DropletPlan) -> [DropletPlan; 3] {
    [Viscous::Explicit, Viscous::Implicit { rate: 1.0 }, Viscous::WithPressure { rate: 1.0 }]
        .map(|viscous| DropletPlan { viscous, ..plan.clone() })
}

#[test]
fn frozen_drop_on_a_plate_does_not_move() {
    let gravity = [0.0, 0.0, -98.1];
    for plan in each(walled(DropletPlan { gravity, ..plan() })) {
        let drop = DropletSph::new(plan.clone(), 1);
        let start = particles(&plan, ball([0.0, 0.0, 3.2], 3.5), |_| [0.0; 3]);
        let mut state = drop.state_of(&start);
        let sorted = drop.particles(&state).position;
        drop.advance(&mut state, &[FROZEN], 5e-3).unwrap();
        let end = drop.particles(&state);
        assert_eq!(end.position, sorted);
        assert!(end.velocity.iter().all(|v| *v == [0.0; 3]));
        let (mass, ..) = sums(&end);
        let pushed = drop.totals(&state).impulse_to_wall;
        assert_near(pushed, gravity.map(|g| mass * g * 5e-3), 1e-12 * mass);
    }
}

#[test]
fn thrown_frozen_ball_leaves_its_momentum_to_the_wall_that_it_meets() {
    let plan = walled(DropletPlan { gravity: [0.0, 0.0, -9.81], ..plan() });
    let drop = DropletSph::new(plan.clone(), 1);
    let start = particles(&plan, ball([0.0, 0.0, 4.5], 3.0), |_| [0.2, 0.1, -1.0]);
    let mut state = drop.state_of(&start);
    let (before, _) = balance(&drop, &state);
    drop.advance(&mut state, &[FROZEN], 3e-3).unwrap();
    let end = drop.particles(&state);
    assert!(end.velocity.iter().all(|v| *v == [0.0; 3]));
    let (after, size) = balance(&drop, &state);
    assert_near(before, after, 1e-12 * size);
    assert_same_shape(&start, &end);
}

#[test]
fn free_ball_keeps_momentum_energy_and_shape_over_a_turn() {
    let spin = [200.0, -300.0, 250.0];
    let turn = std::f64::consts::TAU / norm(spin);
    for plan in each(plan()) {
        let drop = DropletSph::new(plan.clone(), 1);
        let velocity = |x| minus(turning(x, spin), [0.1, -0.2, 0.3]);
        let start = particles(&plan, ball([0.0; 3], 3.3), velocity);
        let mut state = drop.state_of(&start);
        drop.advance(&mut state, &[], turn).unwrap();
        let end = drop.particles(&state);
        let ((_, p, l, e), (mass, p_end, l_end, e_end)) = (sums(&start), sums(&end));
        assert_near(p, p_end, 1e-12 * norm(p));
        assert_near(l, l_end, 1e-11 * norm(l));
        assert!((e / e_end - 1.0).abs() < 1e-11, "{e} {e_end}");
        assert_same_shape(&start, &end);
        // After a turn it looks as at first.
        let way = p.map(|p| p / mass * turn);
        for x in &start.position {
            let near = end.position.iter().map(|y| norm(minus(minus(*y, *x), way)));
            assert!(near.fold(f64::INFINITY, f64::min) < 1e-9 * SPACING);
        }
    }
}

/// A slab with three moments of inertia, which tumbles about its middle axis.
#[test]
fn tumbling_slab_keeps_its_energy_on_average() {
    let plan = plan();
    let drop = DropletSph::new(plan.clone(), 1);
    let slab =
        |[x, y, z]: [f64; 3]| (x.abs() < 4.0 && y.abs() < 3.0 && z.abs() < 1.0).then_some(FROZEN);
    let start = particles(&plan, slab, |x| turning(x, [3.0, 300.0, 3.0]));
    let (_, _, l, e) = sums(&start);
    let mut state = drop.state_of(&start);
    let mut extremes = [f64::INFINITY, 0.0_f64];
    let mut axis = [f64::INFINITY, f64::NEG_INFINITY];
    for _ in 0..40 {
        drop.advance(&mut state, &[], 2e-3).unwrap();
        let now = drop.particles(&state);
        let (_, _, l_now, e_now) = sums(&now);
        assert_near(l, l_now, 1e-10 * norm(l));
        assert_same_shape(&start, &now);
        extremes = [extremes[0].min(e_now / e), extremes[1].max(e_now / e)];
        let corner = now.position[0][1];
        axis = [axis[0].min(corner), axis[1].max(corner)];
    }
    let (_, _, _, e_end) = sums(&drop.particles(&state));
    println!("energy {extremes:?}, at the end {}", e_end / e);
    assert!(extremes[0] > 1.0 - 2e-4 && extremes[1] < 1.0 + 2e-4, "{extremes:?}");
    // It has turned over, so the middle axis was unstable.
    assert!(axis[0] < 0.0 && axis[1] > 0.0, "{axis:?}");
}

#[test]
fn free_ball_falls_like_a_point() {
    let gravity = [1.0, -2.0, -9.81];
    for plan in each(DropletPlan { gravity, ..plan() }) {
        let drop = DropletSph::new(plan.clone(), 1);
        let start =
            particles(&plan, ball([0.0; 3], 3.0), |x| turning(x, TURNED.map(|s| 300.0 * s)));
        let mut state = drop.state_of(&start);
        drop.advance(&mut state, &[], 0.02).unwrap();
        let end = drop.particles(&state);
        let (mass, momentum, ..) = sums(&end);
        assert_near(momentum, gravity.map(|g| mass * 0.02 * g), 1e-12 * mass);
        // Steps of implicit viscosity fall ahead by half of one.
        let ahead = match plan.viscous {
            Viscous::Explicit => 1e-11,
            Viscous::Implicit { .. } | Viscous::WithPressure { .. } => {
                1.5 / drop.totals(&state).steps
            }
        };
        let way = gravity.map(|g| 2e-4 * g);
        assert_near(centre(&end), way, ahead * norm(way));
        assert_same_shape(&start, &end);
    }
}

#[test]
fn balls_that_meet_become_one() {
    for plan in each(plan()) {
        let drop = DropletSph::new(plan.clone(), 1);
        let left = |x: [f64; 3]| x[0] < 0.0;
        let balls = |x| ball([-4.0, 0.0, 0.0], 2.5)(x).or(ball([4.0, 0.0, 2.0], 2.5)(x));
        let start =
            particles(&plan, balls, |x| if left(x) { [1.0, 0.0, 0.0] } else { [-0.5, 0.1, 0.0] });
        let mut state = drop.state_of(&start);
        drop.advance(&mut state, &[], 4e-3).unwrap();
        let end = drop.particles(&state);
        let ((_, p, l, e), (_, p_end, l_end, e_end)) = (sums(&start), sums(&end));
        assert_near(p, p_end, 1e-12 * norm(p));
        assert_near(l, l_end, 1e-11 * norm(l));
        assert!(e_end < 0.9 * e);
        let before = shape(&end);
        drop.advance(&mut state, &[], 4e-3).unwrap();
        for (a, b) in shape(&drop.particles(&state)).iter().zip(before) {
            assert!((a - b).abs() < 1e-11 * SPACING);
        }
    }
}

#[test]
fn models_with_symmetry_move_as_the_whole() {
    // Half and quarter of a ball that rises; it turns in the half as in the whole.
    let spin = [300.0, 0.0, 0.0];
    let velocity = |x: [f64; 3]| minus(turning(x, spin), [0.0, 0.1, -0.3]);
    let whole = plan();
    let half = DropletPlan { mirrors: [true, false], ..plan() };
    let ends = [whole, half].map(|plan| {
        let drop = DropletSph::new(plan.clone(), 1);
        let start = particles(&plan, ball([0.0, 1.0, 0.0], 3.2), velocity);
        let mut state = drop.state_of(&start);
        drop.advance(&mut state, &[], 4e-3).unwrap();
        let end = drop.particles(&state);
        assert!((sums(&start).3 / sums(&end).3 - 1.0).abs() < 1e-11);
        end
    });
    for x in &ends[1].position {
        let near = ends[0].position.iter().map(|y| norm(minus(*y, *x)));
        assert!(near.fold(f64::INFINITY, f64::min) < 1e-10 * SPACING);
    }
    // Motion that the symmetry forbids vanishes.
    for (plan, velocity) in [
        (DropletPlan { mirrors: [true, true], ..plan() }, [0.2, 0.3, 0.4]),
        (DropletPlan { axisymmetric: true, ..plan() }, [0.2, 0.0, 0.4]),
    ] {
        let drop = DropletSph::new(plan.clone(), 1);
        let start = particles(&plan, ball([0.0; 3], 3.2), |_| velocity);
        let mut state = drop.state_of(&start);
        let radii = drop.particles(&state).position;
        drop.advance(&mut state, &[], 2e-3).unwrap();
        let end = drop.particles(&state);
        for ((v, x), before) in end.velocity.iter().zip(&end.position).zip(radii) {
            assert_near(*v, [0.0, 0.0, 0.4], 1e-12);
            assert_near(*x, [before[0], before[1], before[2] + 0.4 * 2e-3], 1e-13);
        }
    }
    // A disc in a plane model.
    let plan = DropletPlan { dimension: 2, ..plan() };
    let drop = DropletSph::new(plan.clone(), 1);
    let start = particles(&plan, ball([1.0, 0.0, 0.0], 3.2), |x| turning(x, [0.0, 300.0, 0.0]));
    let mut state = drop.state_of(&start);
    drop.advance(&mut state, &[], 0.02).unwrap();
    let end = drop.particles(&state);
    let ((_, p, l, e), (_, p_end, l_end, e_end)) = (sums(&start), sums(&end));
    assert_near(p, p_end, 1e-12 * norm(p));
    assert_near(l, l_end, 1e-11 * norm(l));
    assert!((e / e_end - 1.0).abs() < 1e-11);
}

/// A plane model with a period of twelve particles.
fn channel() -> DropletPlan {
    let period = Extent::Periodic(12.0 * SPACING);
    let extents = [period, Extent::Open, Extent::Open];
    walled(DropletPlan { dimension: 2, extents, ..plan() })
}

/// Layers on the wall: frozen below a height, and molten up to another.
fn layers(frozen: f64, molten: f64) -> impl Fn([f64; 3]) -> Option<f64> {
    move |[x, _, z]| {
        let within = (0.0..12.0).contains(&x) && (0.0..molten).contains(&z);
        within.then_some(if z < frozen { FROZEN } else { MOLTEN })
    }
}

#[test]
fn piece_across_a_period_moves_as_one() {
    let plan = DropletPlan { wall: None, ..channel() };
    let drop = DropletSph::new(plan.clone(), 1);
    let disc = |x: [f64; 3]| {
        let near = |centre: f64| (norm(minus(x, [centre, 0.0, 0.0])) < 3.2).then_some(FROZEN);
        (0.0..12.0).contains(&x[0]).then(|| near(0.0).or(near(12.0))).flatten()
    };
    let about = |x: f64| if x < 6.0 { x } else { x - 12.0 };
    let velocity =
        |[x, y, z]: [f64; 3]| minus(turning([about(x), y, z], [0.0, 300.0, 0.0]), [-1.0, 0.0, 0.0]);
    let start = particles(&plan, disc, velocity);
    let mut state = drop.state_of(&start);
    drop.advance(&mut state, &[], 0.015).unwrap();
    let ((_, p, _, e), (_, p_end, _, e_end)) = (sums(&start), sums(&drop.particles(&state)));
    assert_near(p, p_end, 1e-12 * norm(p));
    assert!((e / e_end - 1.0).abs() < 1e-11);
}

#[test]
fn liquid_on_a_frozen_layer_balances_with_the_wall() {
    let gravity = [0.3, 0.0, -2.0];
    for plan in each(DropletPlan { gravity, ..channel() }) {
        let drop = DropletSph::new(plan.clone(), 1);
        let fall = |x: [f64; 3]| if x[2] > 3.0 { [0.1, 0.0, -0.4] } else { [0.0; 3] };
        let start = particles(&plan, layers(3.0, 8.0), fall);
        let mut state = drop.state_of(&start);
        let (before, _) = balance(&drop, &state);
        for _ in 0..10 {
            drop.advance(&mut state, &[FROZEN], 2e-3).unwrap();
            let (after, size) = balance(&drop, &state);
            assert_near(before, after, 1e-12 * size);
        }
        let low = drop.particles(&state).position.iter().filter(|x| x[2] < 3.0 * SPACING).count();
        assert_eq!(low, 36, "fluid entered the frozen layer");
    }
}

#[test]
fn saved_states_continue_with_the_same_bits() {
    for plan in each(DropletPlan { gravity: [0.3, 0.0, -2.0], ..channel() }) {
        let fields = particles(
            &plan,
            |x| layers(3.0, 6.0)(x).or(ball([6.0, 0.0, 10.2], 2.5)(x)),
            |x| {
                if x[2] > 6.0 { [0.1, 0.0, -0.6] } else { [0.0; 3] }
            },
        );
        let states = [1, 2].map(|threads| {
            let drop = DropletSph::new(plan.clone(), threads);
            let mut state = drop.state_of(&fields);
            for _ in 0..6 {
                drop.advance(&mut state, &[FROZEN], 1e-3).unwrap();
            }
            state
        });
        let drop = DropletSph::new(plan, 1);
        let mut state = drop.state_of(&fields);
        for _ in 0..6 {
            let mut next = state.clone();
            DropletSph::new(drop.plan().clone(), 1).advance(&mut next, &[FROZEN], 1e-3).unwrap();
            state = next;
        }
        assert!(states[0] == states[1] && states[0] == state);
    }
}

/// A film slides down a frozen layer as on a wall at its surface, `u = g/ν (h z − z²/2)`.
#[test]
fn film_sticks_to_the_surface_of_a_frozen_layer() {
    let fluid = Fluid { viscosity: 1.0.into(), ..plan().fluid };
    let (height, gravity, viscosity) = (6.0 * SPACING, 10.0, 1.0 / DENSITY);
    for plan in each(DropletPlan { gravity: [gravity, 0.0, 0.0], fluid, ..channel() }) {
        let drop = DropletSph::new(plan.clone(), 1);
        let start = particles(&plan, layers(3.0, 9.0), |_| [0.0; 3]);
        let mut state = drop.state_of(&start);
        drop.advance(&mut state, &[FROZEN], 0.08).unwrap();
        let end = drop.particles(&state);
        for (x, v) in end.position.iter().zip(&end.velocity) {
            let z = x[2] - 3.0 * SPACING;
            let exact = gravity / viscosity * (height * z - 0.5 * z * z);
            if z < 0.0 {
                assert_eq!(*v, [0.0; 3]);
            } else if z > SPACING {
                assert!((v[0] / exact - 1.0).abs() < 0.03, "{z} {} {exact}", v[0]);
            }
        }
    }
}

#[test]
fn liquid_around_a_piece_drags_it_and_keeps_momentum() {
    let paste = r#"{ "law": "bingham", "yield_stress": 1.0, "plastic_viscosity": 0.1 }"#;
    let paste = Fluid { viscosity: serde_json::from_str(paste).unwrap(), ..plan().fluid };
    let implicit = Viscous::Implicit { rate: 100.0 };
    let paste = DropletPlan { fluid: paste, viscous: implicit, ..plan() };
    let [explicit, implicit, solved] = each(plan());
    for plan in [explicit, implicit, solved, paste] {
        // Shifting conserves no angular momentum.
        let plan = DropletPlan { shifting: false, ..plan };
        let drop = DropletSph::new(plan.clone(), 1);
        let is_core = |x: [f64; 3]| norm(minus(x, [0.5, 0.0, 0.0])) < 2.0;
        let whole = |x| ball([0.0; 3], 4.0)(x).map(|_| if is_core(x) { FROZEN } else { MOLTEN });
        let start = particles(&plan, whole, |x| {
            if is_core(x) {
                [0.0; 3]
            } else {
                minus(turning(x, [20.0, 50.0, 0.0]), [0.1, 0.0, 0.0])
            }
        });
        let mut state = drop.state_of(&start);
        drop.advance(&mut state, &[], 2e-3).unwrap();
        let end = drop.particles(&state);
        let ((_, p, l, e), (_, p_end, l_end, e_end)) = (sums(&start), sums(&end));
        assert_near(p, p_end, 1e-12 * norm(p));
        assert_near(l, l_end, 1e-11 * norm(l));
        assert!(e_end < e);
        let core = |fields: &ParticleFields| {
            let frozen = |list: &[[f64; 3]]| -> Vec<[f64; 3]> {
                let all = list.iter().zip(&fields.temperature);
                all.filter(|(_, t)| **t < 490.0).map(|(x, _)| *x).collect()
            };
            let (position, velocity) = (frozen(&fields.position), frozen(&fields.velocity));
            ParticleFields {
                mass: vec![1.0; position.len()],
                position,
                velocity,
                ..ParticleFields::default()
            }
        };
        assert_same_shape(&core(&start), &core(&end));
        let (count, pace, ..) = sums(&core(&end));
        assert!(pace[0] < -0.01 * count, "{pace:?}");
    }
}
