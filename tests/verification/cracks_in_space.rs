//! A round crack in a block that is pulled across it, in space: at what stress it starts. Energy of cracks and length of
//! damage are the units.

use std::f64::consts::PI;

use closed_form::edge_crack::penny_in_cylinder;
use closed_form::gradient_damage::beside_at1;
use impinge::laws::fracture::{Dissipation, GradientDamage, Principal, Split};
use impinge::method::damage::{DamageProblem, Domain, Elements, Form};
use impinge::runtime::allowance::Allowance;

use crate::edge_crack::{AHEAD, POISSON, YOUNG, fine_within};

const H: f64 = 1.0 / 3.0;
const RADIUS: f64 = 4.0;
const END: f64 = 5.0 * RADIUS;
const ROUNDING: f64 = 1e-9;
const PLANE_YOUNG: f64 = YOUNG / (1.0 - POISSON * POISSON);

/// A quarter of the block in AT1 without split, whose ends move apart along z; the plane of the crack is one row of
/// elements.
#[test]
fn penny_in_space_starts_at_its_stress() {
    let law = GradientDamage {
        elastic: Principal { young: YOUNG, poisson: POISSON, is_plane_stress: false },
        expansion: 0.0,
        split: Split::NoTension,
        pressed: 1.0,
        dissipation: Dissipation::At1,
        energy: 1.0,
        length: 1.0,
        scatter: 0.0,
        seed: 0,
    };
    let lateral = fine_within([1.0, RADIUS + 3.0], [0.0, END], H, 4.0);
    let z = fine_within([-2.0, 2.0], [-END, END], H, 4.0);
    let domain = Domain {
        axes: [lateral.clone(), lateral.clone(), z.clone()],
        form: Form::Space,
        mirrored: [false; 3],
    };
    let grid = domain.grid();
    let places: Vec<[f64; 3]> = (0..grid.nodes()).map(|node| domain.place(node)).collect();
    let is_end = |place: &[f64; 3]| place[2].abs() > END - ROUNDING;
    let held = places.iter().flat_map(|p| [p[0] < ROUNDING, p[1] < ROUNDING, is_end(p)]).collect();
    let problem = DamageProblem::<3, 8, 6>::new(Elements::new(domain, law), held, 2);
    let mut state = problem.initial_state();
    for (damage, [x, y, z]) in state.damage.iter_mut().zip(&places) {
        let r = x.hypot(*y);
        let distance = if r < RADIUS { z.abs() - 0.5 * H } else { (r - RADIUS).hypot(*z) };
        *damage = beside_at1(distance.max(0.0));
    }
    let none = (vec![0.0; places.len()], vec![0.0; 3 * places.len()]);
    let wanted = PLANE_YOUNG.sqrt() / penny_in_cylinder(RADIUS + AHEAD, END, 1.0);
    println!("{} nodes", places.len());
    let dissipated = |state: &_| problem.energies(state).dissipated;
    let (mut first, mut last, mut starts) = (dissipated(&state), 0.0, None);
    for step in 0..40 {
        let strain = wanted / YOUNG * (0.9 + 0.005 * f64::from(step));
        for (n, place) in places.iter().enumerate().filter(|(_, place)| is_end(place)) {
            state.displacement[3 * n + 2] = strain * place[2];
        }
        problem.advance(&mut state, (&none.0, &none.1), &Allowance::default()).unwrap();
        if step == 0 {
            // Rows of elements that the circle cuts settle.
            first = dissipated(&state);
        }
        let forces = problem.forces(&state);
        let on_top = places.iter().enumerate().filter(|(_, place)| place[2] > END - ROUNDING);
        let stress = on_top.map(|(n, _)| forces[3 * n + 2]).sum::<f64>() / (END * END);
        // Growth of the radius of a quarter.
        let grown = (dissipated(&state) - first) / (0.5 * PI * RADIUS);
        if grown > 0.5 {
            starts = Some(last / wanted);
            break;
        }
        last = stress;
    }
    let starts = starts.expect("it starts");
    println!("penny in space: it starts at {starts:.4} of its stress");
    assert!((starts - 1.0).abs() < 0.05, "{starts}");
}
