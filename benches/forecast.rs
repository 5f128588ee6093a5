//! Time of droplets beside the time that `check` says, on one thread.
//!
//! `cargo bench --bench forecast -- RUNS`: medians of RUNS runs (default 3).

use std::env;
use std::time::Instant;

use impinge::model::forecast;

#[path = "../tests/common/forecast_cases.rs"]
mod forecast_cases;

use forecast_cases::{CASES, scene, steps_of};

fn main() {
    let runs = env::args().nth(1).and_then(|text| text.parse().ok()).unwrap_or(3_usize).max(1);
    println!("{:<20} {:>8} {:>8} {:>8} {:>8}", "droplet", "steps", "time, s", "said, s", "ratio");
    for case in CASES {
        let scene = scene(case);
        let said = forecast(&scene).run_time();
        let mut steps = 0.0;
        let mut times: Vec<f64> = (0..runs)
            .map(|_| {
                let begin = Instant::now();
                steps = steps_of(&scene);
                begin.elapsed().as_secs_f64()
            })
            .collect();
        times.sort_by(f64::total_cmp);
        let time = times[runs / 2];
        println!("{:<20} {steps:>8} {time:>8.3} {said:>8.3} {:>8.2}", case.0, time / said);
    }
}
