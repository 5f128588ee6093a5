//! Where conduction by particles ends: explicit Euler steps on its operator, and the operator on disordered particles
//! beside a face without images. `benches/maps/cases/solids/` maps what it prints as JSON.
//!
//! `cargo bench --bench particle_limits -- euler SIDE SUPPORT OPERATOR STEP COUNT` with the step in units of Δx²/a: by
//! what random temperatures have grown.
//! `… operator SUPPORT DISORDER DISTANCE COUNT`: conditions and errors of clouds, lengths in units of Δx.

use std::env;
use std::f64::consts::{FRAC_PI_4, PI};

use impinge::kernel::Kernel;
use impinge::method::particle_heat::operators::{CONDITION_LIMIT, Neighbour};
use impinge::method::particle_heat::operators::{condition, corrected, plain};
use impinge::method::particle_heat::{
    End, LatticeAxis, Operator, ParticleHeat, Settings, Setup, Sources,
};

const IDENTITY: [[f64; 3]; 3] = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];

fn main() {
    let words: Vec<String> = env::args().skip(1).filter(|word| !word.starts_with("--")).collect();
    let number = |place: usize| words[place].parse::<f64>().expect("a number");
    match words.first().map(String::as_str) {
        Some("euler") => {
            let operator = match words[3].as_str() {
                "plain" => Operator::Plain,
                _ => Operator::Corrected,
            };
            let problem = insulated(number(1) as usize, number(2), operator);
            println!("{{\"growth\": {:e}}}", growth(&problem, number(4), number(5) as usize));
        }
        Some("operator") => clouds([number(1), number(2), number(3)], number(4) as u64),
        _ => println!(
            "euler SIDE SUPPORT OPERATOR STEP COUNT | operator SUPPORT DISORDER DISTANCE COUNT"
        ),
    }
}

/// A cube of particles one apart, of diffusivity one.
fn insulated(side: usize, support: f64, operator: Operator) -> ParticleHeat {
    let nodes: Vec<f64> = (0..side).map(|i| i as f64).collect();
    let mut measures = vec![1.0; side];
    (measures[0], measures[side - 1]) = (0.5, 0.5);
    let axis = LatticeAxis { nodes, measures, ends: [End::Mirror; 2], radial: false };
    let setup = Setup {
        axes: [axis.clone(), axis.clone(), axis],
        settings: Settings { operator, kernel: Kernel::WendlandC2, support },
        capacity: 1.0,
        conductivity: 1.0,
        faces: Vec::new(),
        classes: vec![[false; 2]],
        copies: 1.0,
    };
    ParticleHeat::new(setup, 1)
}

/// Largest temperature after Euler steps over that at first.
fn growth(problem: &ParticleHeat, step: f64, count: usize) -> f64 {
    let mut random = fastrand::Rng::with_seed(7);
    let mut state = vec![0.0; problem.layout().len()];
    state.iter_mut().for_each(|value| *value = 2.0 * random.f64() - 1.0);
    let none = Sources { surface: &[[Vec::new(), Vec::new()]], faces: &[Vec::new()] };
    let largest = |state: &[f64]| state.iter().fold(0.0, |most: f64, value| most.max(value.abs()));
    let particles = state.len() - 2;
    let before = largest(&state[..particles]);
    for _ in 0..count {
        let rates = problem.rates(&state, &none, &none);
        state.iter_mut().zip(&rates).for_each(|(value, rate)| *value += step * rate);
        let now = largest(&state[..particles]);
        if now > 1e6 * before {
            return now / before;
        }
    }
    largest(&state[..particles]) / before
}

/// Prints what shaken lattices come to that end a distance below a particle.
fn clouds([support, disorder, distance]: [f64; 3], count: u64) {
    // A plane wave, twelve particles long.
    let wave = PI / 6.0 / 3f64.sqrt();
    let f = |r: [f64; 3]| (wave * (r[0] + r[1] + r[2]) + FRAC_PI_4).cos();
    let wanted = -3.0 * wave * wave * f([0.0; 3]);
    let (mut conditions, mut squares, mut of_plain, mut given_up) = (Vec::new(), 0.0, 0.0, 0);
    for seed in 0..count {
        let neighbours = cloud(support, disorder, distance, seed);
        let found = condition(&neighbours, 3);
        given_up += u64::from(found >= CONDITION_LIMIT);
        conditions.push(found);
        let applied = |c: &[f64]| {
            let sum: f64 =
                c.iter().zip(&neighbours).map(|(c, n)| c * (f(n.offset) - f([0.0; 3]))).sum();
            (sum / wanted - 1.0).powi(2)
        };
        let simple = applied(&plain(&neighbours, 3, &IDENTITY));
        of_plain += simple;
        squares += corrected(&neighbours, 3, &IDENTITY).map_or(simple, |c| applied(&c));
    }
    conditions.sort_by(f64::total_cmp);
    let total = count as f64;
    println!(
        "{{\"condition\": {:e}, \"fallback\": {}, \"error\": {}, \"plain\": {}}}",
        conditions[conditions.len() / 2].min(1e300),
        given_up as f64 / total,
        (squares / total).sqrt(),
        (of_plain / total).sqrt()
    );
}

/// The neighbours of a particle at the origin on a lattice of spacing one, each place shaken by up to `disorder`, none
/// lower than `−distance`.
fn cloud(support: f64, disorder: f64, distance: f64, seed: u64) -> Vec<Neighbour> {
    let mut random = fastrand::Rng::with_seed(seed);
    let reach = (support + 1.0).ceil() as i32;
    let mut out = Vec::new();
    for k in -reach..=reach {
        for j in -reach..=reach {
            for i in -reach..=reach {
                let shaken =
                    [i, j, k].map(|x| f64::from(x) + disorder * (2.0 * random.f64() - 1.0));
                if [i, j, k] != [0; 3] && shaken[2] >= -distance {
                    out.extend(Neighbour::new(shaken, 1.0, (Kernel::WendlandC2, support, 3)));
                }
            }
        }
    }
    out
}
