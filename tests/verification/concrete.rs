//! Softening of concrete: the energy of a bar that breaks, over the distance of nodes.

use impinge::laws::solid::large_strain::concrete::{DamageFunction, Surfaces, energy};
use impinge::laws::solid::large_strain::{Concrete, Deviator, LargeStrainLaw};
use impinge::method::large_strain::{Course, Deformable, LayerOfBody};
use impinge::space::{Form, Mesh, Reproducing, Side, Sides, reproducing};

const LENGTH: f64 = 0.16;
const WIDTH: f64 = 0.024;
/// Length of the material [m].
const RADIUS: f64 = 0.032;
const TENSILE: f64 = 4e6;
/// Energy per area of a crack over [`RADIUS`] [J/m²].
const ENERGY: f64 = 100.0;

fn law(tensile: f64) -> LargeStrainLaw {
    let f = 40e6;
    let surfaces = Surfaces::new(
        [[0.2956 * f, 0.4463, 0.0808 / f], [0.2232 * f, 0.625, 0.2575 / f]],
        [0.4417, 0.1183 / f],
        tensile,
        1.15,
        &[[3.0, 0.753], [8.45, 1.0]],
    );
    let points = [
        [0.0, 0.0],
        [2e-5, 0.6],
        [6e-5, 0.95],
        [1e-4, 1.0],
        [5e-4, 0.6],
        [1.5e-3, 0.25],
        [4e-3, 0.0],
    ];
    let function = DamageFunction::new(&points).unwrap();
    let of_volume = ENERGY / RADIUS;
    let concrete = Concrete {
        exponents: [1.6, energy::exponent(&function, TENSILE, 0.0, of_volume).unwrap()],
        opening: energy::opening(&function, TENSILE, of_volume),
        surfaces: surfaces.unwrap(),
        function,
        dilatancy: 0.0,
        broken: 0.95,
        compaction: Vec::new(),
    };
    let (young, poisson) = (30e9, 0.2);
    LargeStrainLaw {
        bulk: young / (3.0 * (1.0 - 2.0 * poisson)),
        shear: young / (2.0 * (1.0 + poisson)),
        deviator: Deviator::Concrete(concrete),
    }
}

/// A bar in the plane, weaker by 3 % in its middle, whose ends are held along it.
fn bar((spacing, width): (f64, f64), smoothing: Option<f64>) -> Deformable {
    let count = [LENGTH, 0.0, width].map(|length| (length / spacing).round() as usize);
    let mesh = Mesh::of_box(Form::Plane, [0.0; 3], [LENGTH, 0.0, width], count);
    let held = Sides::of(&[Side::Left, Side::Right]);
    let space = reproducing(&mesh, Reproducing { smoothing, held, ..Reproducing::default() });
    let space = space.unwrap();
    let is_weak = |group: &std::ops::Range<usize>| {
        (space.volume.at[group.start][0] - 0.5 * LENGTH).abs() < 0.01
    };
    let of_groups = space.groups.iter().map(|group| usize::from(is_weak(group))).collect();
    let layers = [1.0, 0.97].map(|part| LayerOfBody { law: law(part * TENSILE), density: 2400.0 });
    Deformable::layered(space, (layers.to_vec(), of_groups), [false; 2], 1)
}

/// Energy that a bar has dissipated per area when its ends are 0.3 mm apart, pulled at a steady speed; damping of
/// motion across the even one takes its own.
fn dissipated(body: &Deformable, width: f64) -> f64 {
    let (speed, damping) = (0.04, 2e3);
    let dt = 1.4 / body.highest_frequency();
    let team = body.team();
    let places: Vec<f64> = body.space.nodes.iter().map(|at| at[0]).collect();
    let is_end = |x: f64| !(1e-9..=LENGTH - 1e-9).contains(&x);
    let mut u = vec![[0.0; 3]; body.nodes()];
    let mut velocity: Vec<[f64; 3]> =
        places.iter().map(|x| [speed * x / LENGTH, 0.0, 0.0]).collect();
    let mut history = vec![0.0; body.history()];
    let (mut work, mut damped, mut before, mut stored) = (0.0, 0.0, 0.0, 0.0);
    for _ in 0..(3e-4 / speed / dt) as usize {
        for (u, v) in u.iter_mut().zip(&velocity) {
            (0..3).for_each(|a| u[a] += dt * v[a]);
        }
        let still = body.in_all(Course::NONE);
        let stresses = body.respond(&u, &still, &mut history, &team).unwrap();
        let forces = body.forces(&stresses, &team);
        let mut pull = 0.0;
        for (node, v) in velocity.iter_mut().enumerate() {
            let (x, mass) = (places[node], body.mass[node]);
            if x > LENGTH - 1e-9 {
                pull -= forces[node][0];
            }
            for (axis, even) in [(0, speed * x / LENGTH), (2, 0.0)] {
                if axis == 2 || !is_end(x) {
                    v[axis] += dt * forces[node][axis] / mass;
                    let loss = damping * dt * (v[axis] - even);
                    damped += mass * v[axis] * loss;
                    v[axis] -= loss;
                }
            }
        }
        work += 0.5 * (pull + before) * speed * dt;
        (before, stored) = (pull, stresses.energy);
    }
    let squares = velocity.iter().zip(&body.mass);
    let kinetic: f64 =
        squares.map(|(v, mass)| 0.5 * mass * v.iter().map(|v| v * v).sum::<f64>()).sum();
    assert!(before.abs() < 0.02 * TENSILE * width, "{before}");
    (work - stored - damped - kinetic) / width
}

fn energy_of(spacing: f64, width: f64, smoothing: Option<f64>) -> f64 {
    dissipated(&bar((spacing, width), smoothing), width)
}

#[test]
fn second_smoothing_keeps_the_energy_of_softening() {
    let smooth = [8e-3, 6e-3, 4e-3].map(|spacing| energy_of(spacing, WIDTH, Some(RADIUS)));
    println!("second smoothing: {smooth:.1?} J/m²");
    assert!(smooth.iter().all(|own| (own / smooth[0] - 1.0).abs() < 0.05), "{smooth:?}");
    let slender = [8e-3, 4e-3].map(|spacing| energy_of(spacing, 2.0 * spacing, Some(RADIUS)));
    println!("two cells across: {slender:.1?} J/m²");
    let plain = [8e-3, 4e-3, 8e-3 / 3.0].map(|spacing| energy_of(spacing, WIDTH, None));
    println!("none: {plain:.1?} J/m²");
    // Without it energy follows the mesh, and is far too small.
    let [least, most] = [f64::min, f64::max].map(|of| plain.into_iter().reduce(of).unwrap());
    assert!(most > 1.2 * least && most < 0.65 * smooth[0], "{plain:?}");
}
