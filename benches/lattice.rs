//! Speed of lattices that move on one core: links of hexagons times time steps, per second of processor time.
//!
//! `cargo bench --bench lattice -- COLUMNS ROWS`; `benches/lattice_peer.py` runs it beside a program in Numba.

use std::env;

use impinge::laws::fracture::SofteningLaw;
use impinge::method::lattice::{
    Arrangement, Control, Inertia, LatticePlan, MovingLattice, Sheet, Strip, Support,
};
use impinge::runtime::Usage;
use impinge::runtime::allowance::Allowance;

const SPACING: f64 = 1e-3;
/// Links times time steps of a measurement.
const LINK_STEPS: f64 = 4e7;

fn main() {
    let sizes: Vec<f64> = env::args().skip(1).filter_map(|text| text.parse().ok()).collect();
    let [columns, rows] = sizes[..] else { panic!("the number of columns and of rows") };
    let plan = LatticePlan {
        strip: Strip {
            length: columns * 0.75_f64.sqrt() * SPACING,
            depth: rows * SPACING,
            spacing: SPACING,
            arrangement: Arrangement::Across,
            notch: None,
        },
        sheet: Sheet { young: 30e9, poisson: 0.2, thickness: 0.1 },
        support: Support::Ends,
        control: Control::Displacement,
        softening: SofteningLaw::Openings { strength: 4.5e6, ends: [9e-6, 197e-6], share: 0.13 },
        bending: 0.1,
        closes: true,
        scatter: 0.05,
        seed: 0,
    };
    let lattice = MovingLattice::new(plan, Inertia { density: 2300.0, damping: 0.0 }, 1).unwrap();
    let mut motion = lattice.initial_state();
    let links = motion.damage.len() as f64;
    let duration = (LINK_STEPS / links).ceil() * lattice.longest_step();
    let before = Usage::now().processor_time;
    lattice.advance(&mut motion, 0.1 * duration, duration, &Allowance::default()).unwrap();
    let speed = links * motion.steps / (Usage::now().processor_time - before);
    println!(
        "{{\"links\": {links}, \"steps\": {}, \"link_steps_per_second\": {speed:e}}}",
        motion.steps
    );
}
