//! Reduction of a modal system that a file holds: orders, errors of step responses, bounds and times.
//!
//! `cargo bench --bench reduction -- FILE ORDER …`: two whole numbers of 8 bytes, of modes and of outputs, then as
//! numbers of 8 bytes the rates, what the one input drives, and a row for each output. `benches/reduced_peer.py` writes
//! it.

use std::time::Instant;
use std::{env, fs};

use impinge::method::reduced::{Balanced, Clumped, Ranges, ReducedSystem, Request, Residues};

/// Times at which step responses are compared, from the first to these times the slowest mode's own.
const LOOKS: usize = 400;
const FIRST: f64 = 1e-7;
const LAST: f64 = 100.0;

struct System {
    rates: Vec<f64>,
    input: Vec<f64>,
    rows: Vec<Vec<f64>>,
}

impl System {
    fn read(path: &str) -> Self {
        let bytes = fs::read(path).unwrap_or_else(|error| panic!("{path}: {error}"));
        let mut words =
            bytes.chunks_exact(8).map(|word| <[u8; 8]>::try_from(word).expect("eight bytes"));
        let mut count = || u64::from_le_bytes(words.next().expect("a count")) as usize;
        let [modes, outputs] = [count(), count()];
        let mut list =
            || -> Vec<f64> { words.by_ref().take(modes).map(f64::from_le_bytes).collect() };
        Self { rates: list(), input: list(), rows: (0..outputs).map(|_| list()).collect() }
    }

    /// What outputs answer to a step.
    fn steps(&self, t: f64) -> Vec<f64> {
        let grown: Vec<f64> =
            self.rates.iter().zip(&self.input).map(|(rate, b)| b * step(*rate, t)).collect();
        self.rows.iter().map(|row| row.iter().zip(&grown).map(|(c, g)| c * g).sum()).collect()
    }
}

/// `(1 − e^{−νt})/ν`
fn step(rate: f64, t: f64) -> f64 {
    if rate == 0.0 { t } else { -(-rate * t).exp_m1() / rate }
}

fn complex_step([re, im]: [f64; 2], t: f64) -> [f64; 2] {
    let (decay, size) = ((-re * t).exp(), re * re + im * im);
    let [a, b] = [1.0 - decay * (im * t).cos(), decay * (im * t).sin()];
    [(a * re + b * im) / size, (b * re - a * im) / size]
}

fn main() {
    let arguments: Vec<String> =
        env::args().skip(1).filter(|word| !word.starts_with("--")).collect();
    let Some((path, orders)) = arguments.split_first() else {
        println!("FILE ORDER …");
        return;
    };
    let system = System::read(path);
    let slowest = system.rates.iter().copied().fold(f64::INFINITY, f64::min);
    let ratio: f64 = LAST / slowest / FIRST;
    let times: Vec<f64> =
        (0..LOOKS).map(|n| FIRST * ratio.powf(n as f64 / (LOOKS - 1) as f64)).collect();
    let exact: Vec<Vec<f64>> = times.iter().map(|&t| system.steps(t)).collect();

    let begin = Instant::now();
    let clumped = Clumped::new(system.rates.clone(), vec![system.input.clone()]);
    let residues: Vec<Residues> = system.rows.iter().map(|row| clumped.residues(row)).collect();
    let clumping = begin.elapsed().as_secs_f64();
    let rows: Vec<Vec<&[f64]>> =
        residues.iter().map(|own| vec![own.values[0].as_slice()]).collect();
    let begin = Instant::now();
    let balanced = Balanced::new(&clumped.points, &rows).expect("singular values");
    let balancing = begin.elapsed().as_secs_f64();
    println!(
        "{} modes, {} rates: clumped in {clumping:.2} s, balanced in {balancing:.2} s",
        system.rates.len(),
        clumped.points.len()
    );
    for order in orders.iter().filter_map(|order| order.parse::<usize>().ok()) {
        // The slowest mode is one of them.
        let Some(found) = balanced.truncated(order - 1) else { continue };
        let mut worst: f64 = 0.0;
        for (t, exact) in times.iter().zip(&exact) {
            for (k, exact) in exact.iter().enumerate() {
                let slow = residues[k].slow[0] * step(clumped.slow_rate(), *t);
                let parts = found.poles.iter().zip(&found.inputs[0]).zip(&found.outputs[k]);
                let sum: f64 = parts
                    .map(|((pole, b), c)| {
                        let w = [b[0] * c[0] - b[1] * c[1], b[0] * c[1] + b[1] * c[0]];
                        let s = complex_step(*pole, *t);
                        w[0] * s[0] - w[1] * s[1]
                    })
                    .sum();
                worst = worst.max((slow + sum - exact).abs());
            }
        }
        println!("order {order}: {worst:.2e}");
    }
    let slow: Vec<f64> = system.rows.iter().map(|row| clumped.slow_output(row)).collect();
    let (direct, missed) = (vec![vec![0.0]; rows.len()], vec![vec![0.0]; rows.len()]);
    for tolerance in [1e-2, 1e-3, 1e-4, 1e-5, 1e-6] {
        let request = Request {
            clumped: &clumped,
            residues: &residues,
            slow: &slow,
            direct: &direct,
            start: &[1.0],
            missed: &missed,
            horizon: LAST / slowest,
            allowed: &|ranges: &Ranges| {
                ranges.together.iter().map(|range| vec![tolerance * range]).collect()
            },
        };
        let begin = Instant::now();
        let (reduced, _) = ReducedSystem::new(&request).expect("a system");
        let spent = begin.elapsed().as_secs_f64();
        let bound = reduced.bounds.iter().copied().fold(0.0, f64::max);
        println!(
            "tolerance {tolerance:e}: order {}, bound {bound:.2e}, {spent:.2} s",
            reduced.order()
        );
    }
}
