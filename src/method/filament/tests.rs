//! Strands against mass balance, closed forms and independent integrations.

use std::f64::consts::{FRAC_1_SQRT_2, PI};

use super::{Around, Line, LinePlan, Segment, Strand, Target};
use crate::inputs::{Motion, Trend};
use crate::laws::Fluid;
use crate::port::{Surface, SurfaceResponse, WallCells};

mod slow;
mod stacks;

const WAX: &str = "density = 780.0\nviscosity = 4e-3\nspecific_heat = 2.2e3\nconductivity = 0.15\nmelting = { solidus = \
                   309.0, liquidus = 309.7, latent_heat = 2.47e5 }\nfrozen = { specific_heat = 1.9e3, conductivity = \
                   0.3 }";
const CONCRETE: &str = "density = 2300.0\nviscosity = { law = \"bingham\", yield_stress = 800.0, plastic_viscosity = \
                        20.0 }\nspecific_heat = 1e3\nconductivity = 1.5";

fn segments(strand: &Strand) -> Vec<Segment> {
    strand.segments().collect()
}

fn plan(fluid: &str, diameter: f64) -> LinePlan {
    let fluid: Fluid = toml::from_str(fluid).unwrap();
    LinePlan {
        fluid,
        reference: 340.0,
        diameter,
        least_height: 0.01 * diameter,
        spacing: 0.5 * diameter,
        most: 400.0 * diameter.powi(3),
        gravity: 9.81,
        air: 0.0,
        conductance: None,
        cells: None,
    }
}

fn tiles(extent: f64) -> Option<WallCells> {
    Some(WallCells::Tiles { count: [24, 24], size: [extent; 2] })
}

/// A straight motion along x.
fn along(duration: f64, (from, height): (f64, f64), speed: f64, flow: f64) -> Motion {
    Motion {
        duration,
        place: [[from, 0.0, height], [speed, 0.0, 0.0], [0.0; 3]],
        flow: [flow, 0.0, 0.0],
        temperature: [340.0, 0.0, 0.0],
    }
}

fn still(temperature: f64, cells: usize) -> Surface {
    Surface::held(&vec![temperature; cells])
}

/// Lays a straight line in a number of steps.
fn straight(line: &Line, steps: usize, (height, speed, flow): (f64, f64, f64)) -> Strand {
    let duration = 0.75 * line.plan().most / flow;
    let mut strand = line.start([0.0, 0.0, height]);
    let surface = still(300.0, 24 * 24);
    let step = duration / steps as f64;
    for n in 0..steps {
        let motion = along(step, (speed * step * n as f64, height), speed, flow);
        let around = Around { surface: &surface, air: Trend::held(300.0) };
        line.advance(&mut strand, &[motion], &around).unwrap();
    }
    strand
}

/// `w h = (π/4) D² U_out/U_nozzle` per length, pressed by the nozzle or free, in any number of steps.
#[test]
fn sections_follow_from_the_mass_balance() {
    let line = Line::new(plan(CONCRETE, 0.02));
    let outlet = line.plan().outlet();
    for (ratio, height) in [(1.0, 0.01), (0.8, 0.012), (2.0, 0.02), (0.5, 0.02)] {
        let speed = 0.1;
        let flow = ratio * speed * outlet;
        for steps in [1, 37] {
            let strand = straight(&line, steps, (height, speed, flow));
            let segments: Vec<_> = strand.segments().collect();
            assert!(segments.len() > 100);
            for segment in &segments[12..segments.len() - 3] {
                let section = segment.width() * segment.height();
                assert!(
                    (section / (ratio * outlet) - 1.0).abs() < 1e-6,
                    "{ratio} {height} {segment:?}"
                );
            }
            let volume: f64 = segments.iter().map(|segment| segment.volume).sum();
            assert!((volume / strand.volume - 1.0).abs() < 1e-12);
            assert!((strand.volume / (0.75 * line.plan().most) - 1.0).abs() < 1e-9);
            line.check(&strand).unwrap();
        }
    }
}

/// A pressed strand is as high as the gap; one laid from far above is as wide as high before it spreads.
#[test]
fn the_gap_below_the_nozzle_presses_strands() {
    let stiff = CONCRETE.replace("800.0", "1e5");
    let line = Line::new(plan(&stiff, 0.02));
    let flow = 0.1 * line.plan().outlet();
    let pressed = straight(&line, 5, (0.008, 0.1, flow)).segment(40);
    assert!((pressed.height() / 0.008 - 1.0).abs() < 1e-6, "{pressed:?}");
    let free = straight(&line, 5, (0.03, 0.1, flow)).segment(80);
    assert!((free.height() / free.width() - 1.0).abs() < 1e-6, "{free:?}");
}

/// A nozzle that stands still piles fluid up in one heap, from which a strand goes on.
#[test]
fn a_nozzle_at_rest_makes_one_heap() {
    let line = Line::new(plan(CONCRETE, 0.02));
    let flow = 0.1 * line.plan().outlet();
    let mut strand = line.start([0.0, 0.0, 0.02]);
    let around = Around { surface: &Surface::default(), air: Trend::held(300.0) };
    let rest = along(2.0, (0.0, 0.02), 0.0, flow);
    line.advance(&mut strand, &[rest, along(1.0, (0.0, 0.02), 0.1, flow)], &around).unwrap();
    let heap = strand.segment(0);
    assert!(heap.volume > 1.99 * flow && strand.len() > 5, "{heap:?}");
    assert!((heap.length() - heap.width()).abs() < 1e-12);
    let volume: f64 = strand.segments().map(|segment| segment.volume).sum();
    assert!((volume / (3.0 * flow) - 1.0).abs() < 1e-12);
}

/// A valve that closes slowly, or leaks, draws no strand over a travel without flow: what it lets through stays with the
/// strand that ended, and the next one begins at the nozzle. The places are far from the origin.
#[test]
fn next_to_no_flow_draws_no_strand() {
    let line = Line::new(plan(CONCRETE, 0.02));
    let flow = 0.1 * line.plan().outlet();
    let around = Around { surface: &Surface::default(), air: Trend::held(300.0) };
    let laid = |leak: f64| {
        let mut strand = line.start([10.0, 0.0, 0.02]);
        let motions = [
            along(2.0, (10.0, 0.02), 0.1, flow),
            along(0.5, (10.2, 0.02), 2.0, leak * flow),
            along(0.5, (11.2, 0.02), 2.0, leak * flow),
            along(2.0, (12.2, 0.02), 0.1, flow),
        ];
        line.advance(&mut strand, &motions, &around).unwrap();
        line.check(&strand).unwrap();
        segments(&strand)
    };
    let closed = laid(0.0);
    let length = |all: &[Segment]| all.iter().map(Segment::length).sum::<f64>();
    assert!((length(&closed) - 0.4).abs() < 0.01, "{}", length(&closed));
    for leak in [1e-30, 1e-20, 1e-9, 1e-4, 1e-3] {
        let leaking = laid(leak);
        assert_eq!(leaking.len(), closed.len(), "{leak}");
        let volume: f64 = leaking.iter().map(|own| own.volume).sum();
        assert!((volume / ((4.0 + leak) * flow) - 1.0).abs() < 1e-12, "{leak}");
        assert!((length(&leaking) - length(&closed)).abs() < 1e-9, "{leak}");
        assert!(leaking.iter().all(|own| own.end[0] < 10.21 || own.start[0] > 12.19), "{leak}");
    }
    // Drawn to a tenth of the section of the nozzle it is a strand.
    assert!(laid(2.0).len() > closed.len() + 10);
}

/// A nozzle whose inputs jump from step to step lays the same volume along its path, in as many segments.
#[test]
fn inputs_without_derivatives_lay_a_strand() {
    let line = Line::new(plan(CONCRETE, 0.02));
    let flow = 0.1 * line.plan().outlet();
    let around = Around { surface: &Surface::default(), air: Trend::held(300.0) };
    let lengths = [0.04, 0.07, 0.3].map(|step| {
        let mut strand = line.start([0.0, 0.0, 0.015]);
        let steps = (4.0_f64 / step).round() as usize;
        for n in 0..steps {
            let held = along(step, (0.1 * step * n as f64, 0.015), 0.0, flow);
            line.advance(&mut strand, &[held], &around).unwrap();
        }
        line.check(&strand).unwrap();
        assert!(strand.len() < 45, "{step}: {} segments", strand.len());
        assert!((strand.jump / (0.1 * step) - 1.0).abs() < 1e-9);
        strand.segment(strand.len() - 1).end[0] / (0.1 * step * (steps - 1) as f64)
    });
    // But for the lag of an outlet that is above the strand, half of that gap at equal speeds.
    assert!(lengths.iter().all(|part| (0.99..1.0 + 1e-9).contains(part)), "{lengths:?}");
}

/// The strand trails by half the time of the fall from a steadily moving nozzle.
#[test]
fn a_strand_trails_behind_a_high_nozzle() {
    let line = Line::new(plan(CONCRETE, 0.02));
    let (speed, height) = (0.1, 0.06);
    let flow = 0.5 * speed * line.plan().outlet();
    let strand = straight(&line, 13, (height, speed, flow));
    let thickness = strand.segment(strand.len() - 1).height();
    let expected = 0.5 * speed * (height - thickness) / (0.5 * speed);
    let lag = line.totals(&strand).lag;
    assert!((lag / expected - 1.0).abs() < 0.05, "{lag} {expected}");
    let low = straight(&line, 13, (0.01, speed, flow));
    assert!(line.totals(&low).lag < 1e-12);
}

/// Under a nozzle on a circle of radius R with the angular velocity ω the strand is laid on one of the radius `R/√(1 +
/// (ω t_r)²)`, an angle `arctan(ω t_r)` behind.
#[test]
fn circles_are_laid_smaller() {
    let line = Line::new(LinePlan { spacing: 0.002, most: 1e-2, ..plan(CONCRETE, 0.02) });
    let (radius, rate, height) = (0.2, 0.5, 0.12);
    let speed = radius * rate;
    let flow = speed * line.plan().outlet();
    let mut strand = line.start([radius, 0.0, height]);
    let around = Around { surface: &Surface::default(), air: Trend::held(300.0) };
    let (turns, parts) = (0.9, 400);
    let step = 2.0 * PI * turns / rate / f64::from(parts);
    for n in 0..parts {
        let (sine, cosine) = (rate * step * f64::from(n)).sin_cos();
        let motion = Motion {
            place: [
                [radius * cosine, radius * sine, height],
                [-speed * sine, speed * cosine, 0.0],
                [-speed * rate * cosine, -speed * rate * sine, 0.0],
            ],
            ..along(step, (0.0, 0.0), 0.0, flow)
        };
        line.advance(&mut strand, &[motion], &around).unwrap();
    }
    // The strand is as wide as high where it touches down.
    let relaxation = 0.5 * (height - line.plan().outlet().sqrt()) / speed;
    let lag = rate * relaxation;
    let [x, y] = strand.touch;
    assert!((x.hypot(y) / (radius / (1.0 + lag * lag).sqrt()) - 1.0).abs() < 1e-3, "{x} {y}");
    let behind = 2.0 * PI * (turns - 1.0) - y.atan2(x);
    assert!((behind - lag.atan()).abs() < 1e-2, "{} {}", y.atan2(x), lag.atan());
}

/// After a right angle the strand nears the new leg as `exp(−t/t_r)`, from the point before the corner at which it
/// lagged.
#[test]
fn corners_are_cut_exponentially() {
    let line = Line::new(LinePlan { spacing: 0.002, most: 1e-2, ..plan(CONCRETE, 0.02) });
    let (speed, height) = (0.1, 0.12);
    let flow = speed * line.plan().outlet();
    let relaxation = 0.5 * (height - line.plan().outlet().sqrt()) / speed;
    let mut strand = line.start([-1.0, 0.0, height]);
    let around = Around { surface: &Surface::default(), air: Trend::held(300.0) };
    line.advance(&mut strand, &[along(10.0, (-1.0, height), speed, flow)], &around).unwrap();
    assert!((strand.touch[0] / (-speed * relaxation) - 1.0).abs() < 1e-3, "{:?}", strand.touch);
    let mut since = 0.0;
    for duration in [0.1, 0.2, 0.4, 0.8] {
        let mut turned = along(duration, (0.0, height), 0.0, flow);
        (turned.place[0][1], turned.place[1][1]) = (speed * since, speed);
        line.advance(&mut strand, &[turned], &around).unwrap();
        since += duration;
        let decay = (-since / relaxation).exp();
        let expected = [-speed * relaxation * decay, speed * (since - relaxation * (1.0 - decay))];
        let apart = [0, 1].map(|axis| (strand.touch[axis] - expected[axis]).abs());
        assert!(
            apart.iter().all(|&apart| apart < 1e-4),
            "{since}: {:?} {expected:?}",
            strand.touch
        );
    }
}

/// The load of stacked layers is that of their height, over √3 times the yield stress.
#[test]
fn stacks_load_their_lowest_layer() {
    let line = Line::new(LinePlan { most: 1e-2, ..plan(CONCRETE, 0.02) });
    let flow = 0.1 * line.plan().outlet();
    let around = Around { surface: &Surface::default(), air: Trend::held(300.0) };
    let mut strand = line.start([0.0, 0.0, 0.015]);
    let mut height = 0.015;
    for layers in 1..=3 {
        line.advance(&mut strand, &[along(4.0, (0.0, height), 0.1, flow)], &around).unwrap();
        let travel = Motion { flow: [0.0; 3], ..along(0.1, (0.0, height), 0.0, 0.0) };
        line.advance(&mut strand, &[travel], &around).unwrap();
        let top = strand.segments().map(|segment| segment.top()).fold(0.0, f64::max);
        let expected = 2300.0 * 9.81 * top / (3.0_f64.sqrt() * 800.0);
        let found = line.totals(&strand).bearing;
        assert!((found / expected - 1.0).abs() < 1e-9, "{layers}: {found} {expected}");
        let stacked = line.bearing_of_stacks(&strand);
        assert_eq!(stacked, if layers == 1 { 0.0 } else { found });
        assert!(top > 0.9 * f64::from(layers) * strand.segment(9).height(), "{layers}: {top}");
        height = top + 0.015;
    }
}

/// Lays a wall of four layers of 12 mm, each for a time [s], in one direction or there and back.
fn wall(line: &Line, duration: f64, there_and_back: bool) -> Strand {
    let around = Around { surface: &Surface::default(), air: Trend::held(300.0) };
    let flow = 0.1 * line.plan().outlet();
    let mut strand = line.start([0.0, 0.0, 0.012]);
    for layer in 0..4 {
        let height = 0.012 * f64::from(layer + 1);
        let back = there_and_back && layer % 2 == 1;
        let (from, speed) = if back { (0.1 * duration, -0.1) } else { (0.0, 0.1) };
        let pass = along(duration, (from, height), speed, flow);
        let travel =
            Motion { flow: [0.0; 3], ..along(0.1, (from + speed * duration, height), 0.0, 0.0) };
        line.advance(&mut strand, &[pass, travel], &around).unwrap();
    }
    strand
}

/// A wall laid there and back bears its own height wherever segments end, with the flow stopped at turns or not.
#[test]
fn walls_of_any_length_bear_their_height() {
    for (duration, conductivity) in [(3.0, 1.5), (3.7, 0.0), (4.1, 1.5), (4.43, 0.0), (5.3, 1.5)] {
        let fluid =
            CONCRETE.replace("conductivity = 1.5", &format!("conductivity = {conductivity}"));
        let line = Line::new(LinePlan { most: 2e-2, ..plan(&fluid, 0.02) });
        let expected = 2300.0 * 9.81 * 0.048 / (3.0_f64.sqrt() * 800.0);
        let found = line.totals(&wall(&line, duration, true)).bearing;
        assert!((found / expected - 1.0).abs() < 1e-6, "{duration} s: {found} {expected}");
    }
}

/// Concrete that keeps its shape, in air that hardly cools it.
fn stiff(spacing: f64) -> Line {
    let fluid = CONCRETE.replace("yield_stress = 800.0", "yield_stress = 8000.0");
    Line::new(LinePlan { spacing, most: 2e-2, air: 0.01, ..plan(&fluid, 0.02) })
}

/// Area of such a strand that gives heat to the air [m²].
fn open_area(line: &Line, mut strand: Strand) -> f64 {
    let around = Around { surface: &Surface::default(), air: Trend::held(300.0) };
    let before = strand.lost;
    let rest = Motion { flow: [0.0; 3], ..along(10.0, (0.0, 0.1), 0.0, 0.0) };
    line.advance(&mut strand, &[rest], &around).unwrap();
    line.check(&strand).unwrap();
    (strand.lost - before) / (0.01 * 40.0 * 10.0)
}

/// A wall gives heat to the air through the sides of all layers and the top of the highest, wherever segments end, and
/// each layer below carries the whole of the next.
#[test]
fn covered_layers_lose_heat_through_their_sides() {
    for (spacing, duration) in [(0.01, 4.0), (0.013, 4.43), (0.007, 3.7), (0.03, 5.3)] {
        for there_and_back in [true, false] {
            let line = stiff(spacing);
            let strand = wall(&line, duration, there_and_back);
            let [sides, top] = segments(&strand).iter().fold([0.0; 2], |[sides, top], own| {
                let is_highest = own.base > 0.033;
                let own_top = if is_highest { own.area() } else { 0.0 };
                [sides + 2.0 * own.height() * own.length(), top + own_top]
            });
            let found = open_area(&line, strand) / (sides + top);
            // Ends of layers do not meet exactly.
            assert!((0.995..1.02).contains(&found), "{spacing} m, {duration} s: {found}");
        }
    }
}

/// Layers that cross at right angles cover each other with segments down to a quarter of the width.
#[test]
fn crossing_layers_cover_each_other() {
    for spacing in [0.02, 0.01, 0.0065] {
        let line = stiff(spacing);
        let (outlet, lines) = (line.plan().outlet(), 4);
        // Lines of the width of a strand side by side, as many along as across.
        let pitch = outlet / 0.012;
        let length = f64::from(lines) * pitch;
        let around = Around { surface: &Surface::default(), air: Trend::held(300.0) };
        let mut strand = line.start([0.0, 0.0, 0.012]);
        for layer in 0..2_usize {
            let height = 0.012 * (layer + 1) as f64;
            for n in 0..lines {
                let mut pass = along(length / 0.1, (-0.5 * length, height), 0.1, 0.1 * outlet);
                pass.place[0][1] = (f64::from(n) - 0.5 * f64::from(lines - 1)) * pitch;
                (0..2).filter(|_| layer == 1).for_each(|order| pass.place[order].swap(0, 1));
                let lifted = Motion { flow: [0.0; 3], duration: 0.1, ..pass };
                line.advance(&mut strand, &[lifted, pass], &around).unwrap();
            }
        }
        let expected = length * length + 4.0 * f64::from(lines) * length * 0.012;
        let found = open_area(&line, strand) / expected;
        assert!((found - 1.0).abs() < 0.05, "{spacing} m: {found}");
    }
}

/// Heat that leaves the segments reaches the plate or the air, and the plate's cells get all of it.
#[test]
fn heat_and_volume_balance() {
    for (conductance, air) in [(None, 30.0), (Some(400.0), 0.0)] {
        let own = plan(WAX, 1e-3);
        let line = Line::new(LinePlan { conductance, air, cells: tiles(0.2), ..own });
        let response = SurfaceResponse::of_half_space(1.2e3, [1e-4, 10.0]);
        let mut strand = line.start([-0.05, 0.0, 0.8e-3]);
        let mut to_cells = 0.0;
        for n in 0..40 {
            let surface = Surface {
                amplitudes: vec![0.0; 576 * response.len()],
                response: response.clone(),
                ..still(295.0, 576)
            };
            let place = -0.05 + 0.02 * 0.1 * f64::from(n);
            let motion = along(0.1, (place, 0.8e-3), 0.02, 0.8e-6 * 0.02);
            let around = Around { surface: &surface, air: Trend::held(293.0) };
            line.advance(&mut strand, &[motion], &around).unwrap();
            to_cells += strand.cell_heat.iter().sum::<f64>();
        }
        let totals = line.totals(&strand);
        assert!(strand.given > 0.0 && (strand.lost > 0.0) == (air > 0.0));
        assert!(totals.missing.abs() < 1e-10 * strand.given, "{totals:?}");
        assert!((to_cells / strand.given - 1.0).abs() < 1e-12);
        assert!(totals.frozen > 0.0 && totals.coldest > 293.0, "{totals:?}");
        line.check(&strand).unwrap();
    }
}

/// Weight and momentum of the fluid reach the plate.
#[test]
fn impulse_balances() {
    let own = plan(CONCRETE, 0.02);
    let line = Line::new(LinePlan { cells: tiles(20.0), ..own });
    let strand = straight(&line, 20, (0.01, 0.1, 0.1 * line.plan().outlet()));
    let duration = strand.time;
    let mass = 2300.0 * strand.volume;
    // The mass on the plate grows evenly.
    let weight = 0.5 * mass * 9.81 * duration;
    let [x, y, z] = strand.impulse;
    assert!((x / (mass * 0.1) - 1.0).abs() < 1e-9 && y == 0.0);
    assert!((-z / (weight + mass * 0.1) - 1.0).abs() < 1e-9, "{z} {weight}");
}

/// Segments beyond the edge are found wherever they are in the strand, laid there or spread to there later.
#[test]
fn strands_beyond_the_edge_are_found() {
    let honey = "density = 1e3\nviscosity = 100.0\nspecific_heat = 2e3\nconductivity = 0.0";
    let is_beyond = |edges: [f64; 2], rest: f64| {
        let cells = WallCells::Tiles { count: [24, 24], size: edges.map(|edge| 2.0 * edge) };
        let line = Line::new(LinePlan { cells: Some(cells), ..plan(honey, 0.02) });
        let flow = 0.1 * line.plan().outlet();
        let around = Around { surface: &still(340.0, 576), air: Trend::held(340.0) };
        let mut strand = line.start([-0.04, 0.015, 0.012]);
        let mut first = along(0.8, (-0.04, 0.012), 0.1, flow);
        first.place[0][1] = 0.015;
        let pause =
            |duration: f64| Motion { flow: [0.0; 3], ..along(duration, (-0.02, 0.012), 0.0, 0.0) };
        let motions = [first, pause(0.1), along(0.4, (-0.02, 0.012), 0.1, flow)];
        line.advance(&mut strand, &motions, &around).unwrap();
        line.advance(&mut strand, &[pause(rest)], &around).unwrap();
        let last = strand.segments().next_back().unwrap();
        assert!(last.end[0] < edges[0] && last.half_width < edges[1], "{last:?}");
        line.reaches_beyond(&strand)
    };
    assert!(!is_beyond([0.1, 0.04], 0.1), "within the edges");
    assert!(is_beyond([0.03, 0.04], 0.1), "laid beyond an edge on the way");
    assert!(is_beyond([0.1, 0.04], 30.0), "spread over an edge at rest");
}

/// The first drop of fluid is small however short the steps, and no width remains from it.
#[test]
fn width_does_not_follow_the_step() {
    let line = Line::new(plan(CONCRETE, 0.02));
    let width = |steps| {
        let strand = straight(&line, steps, (0.02, 0.1, 0.1 * line.plan().outlet()));
        line.totals(&strand).width
    };
    let widths = [4, 40, 400].map(width);
    assert!((widths[0] / widths[2] - 1.0).abs() < 2e-3, "{widths:?}");
    assert!((widths[1] / widths[2] - 1.0).abs() < 2e-3, "{widths:?}");
}

/// The rounding of a path's end makes no segment of its own.
#[test]
fn no_slivers_end_a_strand() {
    let line = Line::new(plan(CONCRETE, 0.02));
    let whole = line.plan().segment_volume();
    let around = Around { surface: &Surface::default(), air: Trend::held(300.0) };
    let mut strand = line.start([0.0, 0.0, 0.015]);
    let flow = 0.1 * line.plan().outlet();
    let duration = 4.0 * whole / flow;
    line.advance(&mut strand, &[along(duration, (0.0, 0.015), 0.1, flow)], &around).unwrap();
    let count = strand.len();
    let rest = along(1e-9 * duration, (0.1 * duration, 0.015), 0.1, flow);
    line.advance(&mut strand, &[rest], &around).unwrap();
    assert_eq!(strand.len(), count);
    assert!(line.totals(&strand).last_width > 0.5 * strand.segment(0).width());
}

/// A strand that crosses an older one lies on that, and heats it.
#[test]
fn strands_lie_on_strands() {
    let line = Line::new(plan(CONCRETE, 0.02));
    let flow = 0.1 * line.plan().outlet();
    let around = Around { surface: &Surface::default(), air: Trend::held(300.0) };
    let mut strand = line.start([0.0, 0.0, 0.02]);
    let first = along(4.0, (0.0, 0.02), 0.1, flow);
    line.advance(&mut strand, &[first], &around).unwrap();
    let count = strand.len();
    let older = strand.segment(20);
    let mut second = along(2.0, (0.2, 0.04), 0.0, flow);
    (second.place[0][1], second.place[1][1]) = (-0.1, 0.1);
    let travel = Motion { flow: [0.0; 3], ..second };
    let lifted = Motion { duration: 0.1, ..travel };
    line.advance(&mut strand, &[lifted, second], &around).unwrap();
    let on_top: Vec<_> =
        (count..strand.len()).filter(|&n| !strand.segment(n).below.is_empty()).collect();
    assert!(!on_top.is_empty() && on_top.len() < 6, "{on_top:?}");
    for &n in &on_top {
        for (lower, share) in strand.segment(n).below.iter() {
            let below = strand.segment(lower);
            assert!((strand.segment(n).base / below.top() - 1.0).abs() < 1e-9);
            assert!(below.distance(older.middle()) < 0.3 && share > 0.1);
        }
    }
    assert!(strand.segment(count).below.is_empty());
}

/// Refused steps name their reason.
#[test]
fn impossible_motions_are_refused() {
    let line = Line::new(plan(WAX, 1e-3));
    let around = Around { surface: &Surface::default(), air: Trend::held(300.0) };
    let refusal = |motion: Motion| {
        let mut strand = line.start([0.0; 3]);
        line.advance(&mut strand, &[motion], &around).unwrap_err().to_string()
    };
    let fine = along(1.0, (0.0, 1e-3), 0.01, 1e-8);
    assert!(refusal(along(1.0, (0.0, 0.0), 0.01, 1e-8)).contains("outlet"));
    assert!(refusal(Motion { flow: [1e-6, 0.0, 0.0], ..fine }).contains("most"));
    assert!(refusal(Motion { flow: [1e-8, -2e-8, 0.0], ..fine }).contains("flow"));
    assert!(refusal(Motion { flow: [1e3, 0.0, 0.0], ..fine }).contains("most"));
    assert!(refusal(Motion { temperature: [-1.0, 0.0, 0.0], ..fine }).contains("absolute zero"));
}

/// Around a corner that the nozzle cuts as a circle of radius R: the largest deviation is `(1 − √½) R`, and the mean
/// over the arc `(1 − (4/π) √½) R`.
#[test]
fn deviations_converge_with_the_length_of_segments() {
    let (radius, straight, arc) = (4e-3, 0.01, 0.5 * PI * 4e-3);
    let mean = arc / (arc + straight) * (1.0 - 4.0 / PI * FRAC_1_SQRT_2) * radius;
    let largest = (1.0 - FRAC_1_SQRT_2) * radius;
    let errors = |spacing: f64| {
        let own = plan(CONCRETE, 1e-3);
        let line = Line::new(LinePlan { spacing, most: 1e-7, ..own });
        let target = Target::new(vec![[-0.02, -radius], [radius, -radius], [radius, 0.02]]);
        let mut strand = line.start([-straight, -radius, 0.8e-3]);
        let around = Around { surface: &Surface::default(), air: Trend::held(300.0) };
        let (speed, flow) = (0.02, 1.5e-8);
        let mut motions = vec![along(straight / speed, (-straight, 0.8e-3), speed, flow)];
        motions[0].place[0][1] = -radius;
        // A circle of short parabolas.
        let (parts, rate) = (64, speed / radius);
        for n in 0..parts {
            let (sine, cosine) = (0.5 * PI * f64::from(n) / f64::from(parts)).sin_cos();
            motions.push(Motion {
                duration: 0.5 * PI / rate / f64::from(parts),
                place: [
                    [radius * sine, -radius * cosine, 0.8e-3],
                    [speed * cosine, speed * sine, 0.0],
                    [-speed * rate * sine, speed * rate * cosine, 0.0],
                ],
                ..along(0.0, (0.0, 0.0), 0.0, flow)
            });
        }
        line.advance(&mut strand, &motions, &around).unwrap();
        let found = target.deviation(&segments(&strand));
        [(found.mean / mean - 1.0).abs(), (found.largest / largest - 1.0).abs()]
    };
    let [coarse, middle, fine] = [2e-3, 1e-3, 0.25e-3].map(errors);
    assert!(middle[0] < 0.5 * coarse[0] && fine[0] < 0.1 * middle[0]);
    // The largest one is met at the nearest of the places compared.
    assert!(fine[1] < 0.04, "{coarse:?} {middle:?} {fine:?}");
}

/// A target is bare where the strand ends early.
#[test]
fn gaps_are_lengths_that_nothing_covers() {
    let line = Line::new(plan(CONCRETE, 0.02));
    let strand = straight(&line, 3, (0.01, 0.1, 0.1 * line.plan().outlet()));
    let end = strand.touch[0];
    let target = Target::new(vec![[0.0, 0.0], [end + 0.5, 0.0]]);
    let found = target.deviation(&segments(&strand));
    let half_width = strand.segment(strand.len() - 1).half_width;
    assert!((found.gap - (0.5 - half_width)).abs() < 1e-9, "{found:?}");
    assert!(found.largest < 1e-12);
    // Across the strand, half of its width on each side is covered.
    let middle = strand.segment(40);
    let across = Target::new(vec![[middle.middle()[0], -0.1], [middle.middle()[0], 0.3]]);
    assert!((across.deviation(&segments(&strand)).gap - (0.4 - middle.width())).abs() < 1e-9);
}
