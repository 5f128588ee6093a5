//! Time of gradient damage on the edge crack of `tests/verification/cracks.rs`, on one thread.
//!
//! `cargo bench --bench cracks -- NODES_PER_LENGTH PART …` prints a line for each part of the depth of heat;
//! `benches/cracks_peer.py` runs it beside a program in scikit-fem.

#[path = "../tests/common/edge_crack.rs"]
#[allow(dead_code)]
mod edge_crack;

use std::env;

use edge_crack::EdgeCrack;
use impinge::runtime::Usage;

fn main() {
    let numbers: Vec<f64> = env::args().skip(1).filter_map(|text| text.parse().ok()).collect();
    let Some((per_length, parts)) = numbers.split_first() else {
        panic!("the number of nodes per length of damage, and parts of the depth of heat")
    };
    let mut plane = EdgeCrack::new(1.0 / per_length, 1);
    for &part in parts {
        let before = Usage::now().processor_time;
        let effort = plane.solve(part);
        let time = Usage::now().processor_time - before;
        println!(
            "{{\"nodes\": {}, \"part\": {part}, \"alternations\": {}, \"iterations\": {}, \"factorings\": {}, \
             \"dissipated\": {:.6}, \"processor_time\": {time:.3}}}",
            plane.cracked.state.damage.len(),
            effort.alternations,
            effort.iterations,
            effort.factorings,
            plane.cracked.dissipated()
        );
    }
}
