//! Whether chosen meshes keep tolerances, and what they cost.

use crate::random_scenes::{Outcome, outcome, random_scene};

/// Scenes with temperatures alone, and discs with stress.
const THERMAL: u64 = 160;
const MECHANICAL: u64 = 40;

/// Every scene against references two levels finer; what fails is listed.
#[test]
fn tolerances_of_random_scenes() {
    let part = |name: &str, all: u64| {
        std::env::var(name).ok().and_then(|value| value.parse().ok()).unwrap_or(all)
    };
    let (thermal, mechanical) = (part("THERMAL", THERMAL), part("MECHANICAL", MECHANICAL));
    let scenes =
        (0..thermal).map(|seed| (seed, false)).chain((0..mechanical).map(|seed| (seed, true)));
    let scenes: Vec<_> = scenes.map(|(seed, stress)| random_scene(seed, stress)).collect();
    let mut lines = vec![
        "| tolerance | scenes | not reached, as said | kept of the others | true over asked, median | worst | estimate \
         over true, 5 %, 50 %, 95 % | cost over the cheapest, median | 90 % | choice, median | 90 % |"
            .to_owned(),
        "|---|---|---|---|---|---|---|---|---|---|---|".to_owned(),
    ];
    let mut failures = Vec::new();
    let mut shares = Vec::new();
    for tolerance in [1e-1, 1e-2, 1e-3] {
        let all: Vec<(Outcome, &str)> = scenes
            .iter()
            .filter_map(|drawn| Some((outcome(drawn, tolerance)?, drawn.words.as_str())))
            .collect();
        let (reached, beyond): (Vec<_>, Vec<_>) =
            all.iter().partition(|(one, _)| one.estimated <= tolerance);
        let over = sorted(reached.iter().map(|(one, _)| one.found / tolerance));
        let kept = reached.iter().filter(|(one, _)| one.found <= tolerance).count();
        for (one, words) in reached.iter().filter(|(one, _)| one.found > tolerance) {
            failures.push(format!(
                "{tolerance:.0e}: {:.2} times over, estimated {:.2}: {words}",
                one.found / tolerance,
                one.estimated / tolerance
            ));
        }
        let effectivity =
            sorted(reached.iter().map(|(one, _)| one.estimated / one.found.max(1e-15)));
        let cost = sorted(reached.iter().filter_map(|(one, _)| one.cost));
        let choice = sorted(all.iter().map(|(one, _)| 1e3 * one.seconds));
        lines.push(format!(
            "| {tolerance:.0e} | {} | {} | {:.1} % | {:.2} | {:.2} | {:.1}, {:.1}, {:.1} | {:.1} | {:.1} | {:.0} ms | {:.0} \
             ms |",
            all.len(),
            beyond.len(),
            100.0 * kept as f64 / reached.len().max(1) as f64,
            at(&over, 0.5),
            at(&over, 1.0),
            at(&effectivity, 0.05),
            at(&effectivity, 0.5),
            at(&effectivity, 0.95),
            at(&cost, 0.5),
            at(&cost, 0.9),
            at(&choice, 0.5),
            at(&choice, 0.9),
        ));
        shares.push((kept as f64 / reached.len().max(1) as f64, at(&over, 1.0), at(&cost, 0.5)));
    }
    println!("{}\n\nNot kept:\n{}", lines.join("\n"), failures.join("\n"));
    for (kept, worst, cost) in shares {
        assert!(kept >= 0.95 && worst <= 3.0 && cost <= 3.0, "{kept} {worst} {cost}");
    }
}

fn sorted(values: impl Iterator<Item = f64>) -> Vec<f64> {
    let mut values: Vec<f64> = values.collect();
    values.sort_by(f64::total_cmp);
    values
}

/// The value below which a part of ascending ones lies.
fn at(sorted: &[f64], part: f64) -> f64 {
    let last = sorted.len().saturating_sub(1) as f64;
    sorted.get((part * last).round() as usize).copied().unwrap_or(f64::NAN)
}
