//! Strands of slow nozzles, and heaps of nozzles that stand.

use super::*;
use crate::closed_form::{GravityCurrent, RestingPaste, Spreading as Shape};

const SOLDER: &str = "density = 7400.0\nviscosity = 2e-3\nspecific_heat = 250.0\nconductivity = 30.0\nsurface_tension \
                      = 0.55\ncontact_angle = 0.7";
const GLYCEROL: &str =
    "density = 1260.0\nviscosity = 1.0\nspecific_heat = 2.4e3\nconductivity = 0.29";
const SILICONE: &str = "density = 1050.0\nviscosity = { law = \"herschel_bulkley\", yield_stress = 40.0, consistency = \
                        30.0, exponent = 0.5 }\nspecific_heat = 1.5e3\nconductivity = 0.25\nsurface_tension = 0.021";

/// Speeds of the nozzle over that of the fluid in it.
const RATIOS: [f64; 9] = [0.02, 0.05, 0.1, 0.2, 0.2499, 0.25, 0.2501, 0.5, 2.0];

/// Fluids, and diameters of nozzles [m].
const FLUIDS: [(&str, f64); 5] =
    [(WAX, 0.7e-3), (SOLDER, 0.7e-3), (GLYCEROL, 1e-3), (SILICONE, 0.8e-3), (CONCRETE, 0.02)];

/// Speed of the nozzle over its diameter [1/s].
const PACE: f64 = 2.0;

/// Lays a straight line of a length over the diameter, in a number of steps and at a height over the diameter.
fn laid(
    line: &Line,
    ratio: f64,
    (length, height): (f64, f64),
    (steps, air): (usize, f64),
) -> (Strand, f64) {
    let LinePlan { diameter, .. } = *line.plan();
    let speed = PACE * diameter;
    let flow = speed / ratio * line.plan().outlet();
    let step = length / PACE / steps as f64;
    let cells = line.plan().cells.as_ref().map_or(0, |_| 576);
    let response = SurfaceResponse::of_half_space(1.2e3, [1e-4, 10.0]);
    let mut strand = line.start([0.0, 0.0, height * diameter]);
    let mut received = 0.0;
    for n in 0..steps {
        let surface = Surface {
            amplitudes: vec![0.0; cells * response.len()],
            response: response.clone(),
            ..still(300.0, cells)
        };
        let around = Around { surface: &surface, air: Trend::held(air) };
        let from = speed * step * n as f64;
        line.advance(&mut strand, &[along(step, (from, height * diameter), speed, flow)], &around)
            .unwrap();
        received += strand.cell_heat.iter().sum::<f64>();
    }
    line.check(&strand).unwrap();
    (strand, received)
}

fn line_of(fluid: &str, diameter: f64, spacing: f64, cells: bool) -> Line {
    let cells = cells.then(|| tiles(60.0 * diameter)).flatten();
    let most = 1e4 * diameter.powi(3);
    Line::new(LinePlan { spacing: spacing * diameter, most, cells, ..plan(fluid, diameter) })
}

/// At any speed a segment holds the flow over the speed, and the segments are as long as the path.
#[test]
fn sections_are_the_flow_over_any_speed() {
    for (fluid, diameter) in FLUIDS {
        for ratio in RATIOS {
            for (steps, spacing) in [(1, 0.5), (30, 0.25)] {
                let line = line_of(fluid, diameter, spacing, false);
                let (strand, _) = laid(&line, ratio, (16.0, 0.5), (steps, 340.0));
                let own = segments(&strand);
                let section = line.plan().outlet() / ratio;
                assert!(own.len() > 6, "{ratio} {spacing}: {}", own.len());
                for segment in &own {
                    let found = segment.width() * segment.height() / section;
                    assert!((found - 1.0).abs() < 1e-9, "{ratio} {spacing} {steps}: {segment:?}");
                }
                let length: f64 = own.iter().map(Segment::length).sum();
                assert!((length / (16.0 * diameter) - 1.0).abs() < 1e-9, "{ratio}: {length}");
                let volume: f64 = own.iter().map(|own| own.volume).sum();
                assert!((volume / strand.volume - 1.0).abs() < 1e-12);
            }
        }
    }
}

/// A paste rests as wide as in closed form at any speed, a Newtonian fluid spreads as Huppert's current.
#[test]
fn widths_follow_closed_forms_at_any_speed() {
    for ratio in RATIOS {
        for (fluid, diameter) in [(CONCRETE, 0.05), (CONCRETE, 0.02), (GLYCEROL, 0.01)] {
            let line = line_of(fluid, diameter, 0.5, false);
            let (mut strand, _) = laid(&line, ratio, (20.0, 1.0), (20, 340.0));
            let rest = Motion { flow: [0.0; 3], ..along(1e4, (0.0, 0.1), 0.0, 0.0) };
            let around = Around { surface: &Surface::default(), air: Trend::held(340.0) };
            line.advance(&mut strand, &[rest], &around).unwrap();
            let section = line.plan().outlet() / ratio;
            let density = line.plan().fluid.density;
            let segment = strand.segment(strand.len() / 2);
            let expected = match line.plan().fluid.viscosity.yield_stress() {
                0.0 => {
                    let spreading = Shape::Plane { area: 0.5 * section };
                    GravityCurrent { spreading, gravity: 9.81, viscosity: 1.0 / density }
                        .front(strand.time - segment.born)
                }
                yield_stress => {
                    let paste = RestingPaste { yield_stress, weight: density * 9.81 };
                    let pressed = section.min(4.0 * line.plan().outlet()) / diameter;
                    paste.line_half_width(section).max(0.5 * section.sqrt()).max(0.5 * pressed)
                }
            };
            let found = segment.half_width;
            assert!((found / expected - 1.0).abs() < 1e-3, "{ratio}: {found} {expected}");
        }
    }
}

/// Widths, areas and heat to the plate pass the limit of slow nozzles without a jump, and heat balances.
#[test]
fn strands_change_evenly_with_the_speed() {
    for (fluid, diameter) in FLUIDS {
        let of = |ratio: f64| {
            let line = line_of(fluid, diameter, 0.5, true);
            let (strand, received) = laid(&line, ratio, (16.0, 0.8), (10, 300.0));
            let totals = line.totals(&strand);
            assert!((received / strand.given - 1.0).abs() < 1e-12);
            let content = line.plan().reference * line.plan().fluid.density * strand.volume;
            let scale = content * line.plan().fluid.specific_heat;
            assert!(totals.missing.abs() < 1e-12 * scale, "{totals:?} {scale}");
            [totals.width, totals.volume / totals.height, strand.given]
        };
        let speeds = [0.04, 0.16, 0.249, 0.25 - 1e-6, 0.25 + 1e-6, 0.251, 0.27];
        let found = speeds.map(of);
        for (n, pair) in found.windows(2).enumerate() {
            let change = (speeds[n + 1] / speeds[n]).ln();
            for (one, other) in pair[0].iter().zip(pair[1]) {
                let slope = (one / other).ln() / change;
                let slack = 2e-3 / change;
                let limits = -0.01 - slack..1.2 + slack;
                assert!(limits.contains(&slope), "{diameter} {}: {slope}", speeds[n]);
            }
        }
    }
}

/// Widths, heights and heat of slow strands converge with the length of segments, widths and heights with the
/// communication step.
#[test]
fn slow_strands_converge() {
    for (fluid, diameter) in [FLUIDS[0], FLUIDS[3], FLUIDS[4]] {
        for (ratio, height) in [(0.03, 0.8), (0.1, 3.0)] {
            let of = |spacing: f64, steps: usize, cells: bool| {
                let line = line_of(fluid, diameter, spacing, cells);
                let air = if cells { 300.0 } else { 340.0 };
                let (strand, _) = laid(&line, ratio, (16.0, height), (steps, air));
                let totals = line.totals(&strand);
                [totals.width, totals.height, if cells { strand.given } else { 1.0 }]
            };
            let apart = |one: [f64; 3], other: [f64; 3]| {
                (0..3).map(|n| (one[n] / other[n]).ln().abs()).fold(0.0, f64::max)
            };
            let [coarse, middle, fine] = [0.8, 0.4, 0.2].map(|spacing| of(spacing, 40, true));
            let errors = [apart(coarse, middle), apart(middle, fine)];
            let said = format!("{diameter} m, {ratio}, {height}: {errors:?}");
            assert!(errors[0] < 8e-3 && errors[1] < 3e-3 && errors[1] < 0.8 * errors[0], "{said}");
            let [once, long, short] = [1, 10, 100].map(|steps| of(0.4, steps, false));
            let errors = [apart(once, short), apart(long, short)];
            assert!(errors[0] < 0.02 && errors[1] < 0.01, "{diameter} {ratio} {height} {errors:?}");
        }
    }
}

/// Under a nozzle that slows down to a stop, stands and goes on, the covered area and the volume of the
/// heap hardly depend on the lengths of segments and steps.
#[test]
fn stops_do_not_depend_on_segments_or_steps() {
    for (fluid, diameter) in [FLUIDS[2], FLUIDS[3], FLUIDS[4]] {
        let of = |spacing: f64, steps: usize| {
            let line = line_of(fluid, diameter, spacing, false);
            let speed = PACE * diameter;
            let flow = speed * line.plan().outlet();
            let mut strand = line.start([0.0, 0.0, diameter]);
            let around = Around { surface: &Surface::default(), air: Trend::held(340.0) };
            // Two seconds evenly, two slowing down, two at rest, and two evenly.
            let mut lay = |duration: f64, [from, speed, bend]: [f64; 3]| {
                let step = duration / steps as f64;
                for n in 0..steps {
                    let since = step * n as f64;
                    let place = [from + since * (speed + 0.5 * since * bend), speed + since * bend];
                    let mut motion = along(step, (place[0], diameter), place[1], flow);
                    motion.place[2][0] = bend;
                    line.advance(&mut strand, &[motion], &around).unwrap();
                }
            };
            lay(2.0, [0.0, speed, 0.0]);
            lay(2.0, [2.0 * speed, speed, -0.5 * speed]);
            lay(2.0, [3.0 * speed, 0.0, 0.0]);
            lay(2.0, [3.0 * speed, speed, 0.0]);
            line.check(&strand).unwrap();
            let own = segments(&strand);
            let area: f64 = own.iter().map(Segment::area).sum();
            let heap = own.iter().map(|own| own.volume).fold(0.0, f64::max);
            let heaps = own.iter().filter(|own| own.is_heap()).count();
            (heaps, [area / diameter.powi(2), heap / flow])
        };
        let (_, fine) = of(0.06, 25);
        for (spacing, steps) in [(0.5, 1), (0.5, 4), (0.5, 200), (0.25, 25), (0.125, 25)] {
            let (heaps, found) = of(spacing, steps);
            let said = format!("{diameter} {spacing} {steps}: {heaps} {found:?} {fine:?}");
            assert!(heaps == 1 && (found[0] / fine[0] - 1.0).abs() < 0.035, "{said}");
            assert!((found[1] / fine[1] - 1.0).abs() < 0.03, "{said}");
        }
    }
}

/// Layers of a slow nozzle lie on each other, though the nozzle is inside the layer below.
#[test]
fn slow_layers_are_stacked() {
    for (ratio, fluid) in [(0.05, CONCRETE), (0.15, CONCRETE), (0.15, SILICONE)] {
        let line = line_of(fluid, 0.02, 0.5, false);
        let (speed, diameter) = (0.04, 0.02);
        let flow = speed / ratio * line.plan().outlet();
        let around = Around { surface: &Surface::default(), air: Trend::held(340.0) };
        let mut strand = line.start([0.0, 0.0, 0.6 * diameter]);
        let mut counts = vec![0];
        for layer in 0..3 {
            let height = 0.6 * diameter * f64::from(layer + 1);
            let pass = along(8.0, (0.0, height), speed, flow);
            let travel = Motion { flow: [0.0; 3], ..along(1.0, (0.32, height), 0.0, 0.0) };
            line.advance(&mut strand, &[pass, travel], &around).unwrap();
            counts.push(strand.len());
        }
        for layer in 0..3 {
            for n in counts[layer]..counts[layer + 1] {
                let own = strand.segment(n);
                let carriers: Vec<usize> = own.below.iter().map(|(lower, _)| lower).collect();
                assert_eq!(carriers.is_empty(), layer == 0, "{ratio} {layer} {n}: {own:?}");
                let below = counts[layer.max(1) - 1]..counts[layer];
                assert!(carriers.iter().all(|lower| below.contains(lower)), "{layer} {carriers:?}");
            }
        }
        assert!(line.rise_above_outlet(&strand).is_some());
    }
}

/// A strand over the seam of two others lies on both, with half of its weight on each, wherever the seam is to
/// rounding; over a gap that is narrower than half of it, too, and on the plate over a wider one.
#[test]
fn strands_over_seams_lie_on_both_sides() {
    let stiff = CONCRETE.replace("yield_stress = 800.0", "yield_stress = 8000.0");
    let line = line_of(&stiff, 0.02, 0.5, false);
    let flow = 0.1 * line.plan().outlet();
    let width = line.plan().outlet() / 0.012;
    let around = Around { surface: &Surface::default(), air: Trend::held(340.0) };
    for across in [false, true] {
        for (apart, shift, on_both) in [
            (1.0, 0.0, true),
            (1.0 - 1e-12, 0.0, true),
            (1.0 + 1e-12, 0.0, true),
            (1.0, 1e-12, true),
            (1.1, 0.0, true),
            (1.3, 0.03, true),
            (1.8, 0.0, false),
        ] {
            let mut strand = line.start([0.0; 3]);
            for (layer, place) in [(1, -0.5 * apart), (1, 0.5 * apart), (2, shift)] {
                let mut pass = along(4.0, (0.0, 0.012 * f64::from(layer)), 0.1, flow);
                pass.place[0][1] = place * width;
                if across {
                    (0..2).for_each(|order| pass.place[order].swap(0, 1));
                }
                let lifted = Motion { flow: [0.0; 3], duration: 0.1, ..pass };
                line.advance(&mut strand, &[lifted, pass], &around).unwrap();
            }
            let count = strand.len() / 3;
            for n in 2 * count + 1..strand.len() - 1 {
                let own = strand.segment(n);
                assert_eq!(!own.below.is_empty(), on_both, "{apart} {shift} {n}: {own:?}");
                let first: f64 =
                    own.below.iter().filter(|(lower, _)| *lower < count).map(|part| part.1).sum();
                assert!(!on_both || (first - 0.5).abs() < 0.07, "{apart} {shift} {n}: {first}");
                assert!(!on_both || (own.height() / 0.012 - 1.0).abs() < 1e-3, "{n}: {own:?}");
            }
        }
    }
}
