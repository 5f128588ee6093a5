use std::time::Instant;

use impinge::model::tolerance::choice::{Levels, Trials, factors, first_levels, search};
use impinge::model::tolerance::estimate::differences;
use impinge::model::tolerance::responses::{Responses, responses};
use impinge::model::tolerance::twin::{Physics, Twin};
use impinge::scene;

use crate::random_scenes::random_scene;

fn combine(a: &Responses, b: &Responses, c: &Responses) -> Responses {
    let mut out = a.clone();
    for ((o, b), c) in out.iter_mut().zip(b).zip(c) {
        for ((o, b), c) in o.iter_mut().zip(b).zip(c) {
            for ((o, b), c) in o.iter_mut().zip(b).zip(c) {
                *o += b - c;
            }
        }
    }
    out
}

#[test]
fn calibration() {
    let env = |name: &str, other: f64| {
        std::env::var(name).ok().and_then(|v| v.parse().ok()).unwrap_or(other)
    };
    let (from, count) = (env("FROM", 0.0) as u64, env("COUNT", 10.0) as u64);
    let stress = env("STRESS", 0.0) > 0.0;
    for seed in from..from + count {
        let drawn = random_scene(seed, stress);
        let scene =
            scene::parse(&drawn.text, "scene").unwrap_or_else(|e| panic!("{e}\n{}", drawn.text));
        let physics = if stress { Physics::Deformation } else { Physics::Heat };
        let twin = Twin::of(&scene, "plate", physics).unwrap();
        for tolerance in [1e-1, 1e-2, 1e-3] {
            let mut trials = Trials::new(&twin, physics);
            let t = Instant::now();
            let (levels, estimated) =
                search(&mut trials, first_levels(tolerance, [true; 2]), [true; 2], tolerance);
            let chosen = 1e3 * t.elapsed().as_secs_f64();
            let [i, j] = levels;
            let up = if drawn.is_disc { 4 } else { 2 };
            let run = |levels: Levels| {
                responses(&twin.on_mesh(factors(levels)), &trials.watched).unwrap()
            };
            let t = Instant::now();
            let base = run(levels);
            let tb = 1e3 * t.elapsed().as_secs_f64();
            if trials.nodes([i + up, j]).max(trials.nodes([i, j + up])) > 1.5e5 {
                println!("skip {seed} {tolerance} est {estimated:?} {levels:?} {}", drawn.words);
                continue;
            }
            let reference = combine(&run([i + up, j]), &run([i, j + up]), &base);
            let errors = differences(&reference, &base, &trials.watched);
            let worst = errors.iter().copied().fold(0.0, f64::max);
            let at = errors.iter().position(|e| *e == worst).unwrap();
            // The cheapest mesh of this family that would have done.
            let mut least = trials.nodes(levels);
            let mut cheapest = levels;
            let mut at_work = worst <= tolerance;
            while at_work {
                at_work = false;
                let [a, b] = cheapest;
                let mut tried: Vec<Levels> = vec![[a - 1, b - 1], [a - 1, b], [a, b - 1]];
                tried.sort_by(|x, y| trials.nodes(*x).total_cmp(&trials.nodes(*y)));
                for levels in tried {
                    let nodes = trials.nodes(levels);
                    if nodes < least
                        && differences(&reference, &run(levels), &trials.watched)
                            .iter()
                            .all(|e| *e <= tolerance)
                    {
                        (least, cheapest, at_work) = (nodes, levels, true);
                        break;
                    }
                }
            }
            println!(
                "tol {tolerance:.0e} est {:.1e} true {worst:.1e} [{}] levels {levels:?} nodes {:.0} cheapest {cheapest:?} ratio {:.2} choice {chosen:.0} ms run {tb:.0} ms | {}",
                estimated.unwrap_or(f64::NAN),
                trials.watched[at].name,
                trials.nodes(levels),
                trials.nodes(levels) / least,
                drawn.words
            );
        }
    }
}
