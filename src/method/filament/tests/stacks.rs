//! Heat of segments that lie on each other.

use super::*;
use crate::method::filament::carriers::Carriers;
use crate::method::filament::cooling::SHARES;

/// Height of a layer [m].
const HEIGHT: f64 = 0.7e-3;
/// Temperature of the plate [K].
const PLATE: f64 = 293.0;

/// A fluid that does not spread.
fn stiff(fluid: &str) -> Line {
    let fluid = fluid.replace("viscosity = 4e-3", "viscosity = 1e9");
    Line::new(LinePlan { cells: tiles(0.2), ..plan(&fluid, 1e-3) })
}

/// A number of segments on each other, warm at the given temperatures from below.
fn stack(line: &Line, temperatures: &[f64]) -> Strand {
    let mut strand = line.start([0.0, 0.0, 0.1]);
    let (width, length) = (4e-3, 4e-3);
    let volume = width * length * HEIGHT;
    for (n, &temperature) in temperatures.iter().enumerate() {
        let heat = line.heat.content_at(temperature) * line.heat.capacity(volume);
        let below = Carriers::of(n.checked_sub(1));
        let base = n as f64 * HEIGHT;
        let (start, end) = ([0.0; 2], [length, 0.0]);
        strand.push(&Segment {
            start,
            end,
            base,
            volume,
            heats: SHARES.map(|share| share * heat),
            half_width: 0.5 * width,
            born: 0.0,
            path: length,
            outlet: base + HEIGHT,
            longest: 0.0,
            below,
        });
        strand.volume += volume;
        strand.supplied += heat;
    }
    strand
}

/// Lets a stack rest on a plate; returns the heat that the plate receives [J/m²].
fn rested(line: &Line, strand: &mut Strand, (duration, steps): (f64, usize)) -> f64 {
    let around = Around { surface: &still(PLATE, 576), air: Trend::held(300.0) };
    let rest = Motion { flow: [0.0; 3], ..along(duration / steps as f64, (0.0, 0.1), 0.0, 0.0) };
    for _ in 0..steps {
        line.advance(strand, &[rest], &around).unwrap();
    }
    line.check(strand).unwrap();
    strand.given / strand.segment(0).area()
}

/// The same by an explicit enthalpy method with the same constants.
fn explicit(line: &Line, temperatures: &[f64], duration: f64) -> f64 {
    const CELLS: usize = 20;
    let heat = &line.heat;
    let size = HEIGHT / CELLS as f64;
    let starts = temperatures.iter().flat_map(|&own| [heat.content_at(own); CELLS]);
    let mut contents: Vec<f64> = starts.collect();
    let fastest = 3.0 * heat.conductivity / heat.capacity;
    let steps = (duration * fastest / (0.4 * size * size)).ceil();
    let step = duration / steps;
    let mut given = 0.0;
    for _ in 0..steps as usize {
        let half = |content: f64| 0.5 * size / heat.conductivity(content);
        let at = |n: usize| (heat.temperature(contents[n]), half(contents[n]));
        let mut flows = vec![(at(0).0 - PLATE) / at(0).1];
        flows.extend((1..contents.len()).map(|n| {
            let ((low, below), (high, above)) = (at(n - 1), at(n));
            (high - low) / (below + above)
        }));
        given += step * flows[0];
        for n in 0..contents.len() {
            let above = flows.get(n + 1).copied().unwrap_or(0.0);
            contents[n] += step * (above - flows[n]) / (size * heat.capacity);
        }
    }
    given
}

/// Wax, and wax that does not freeze.
fn fluids() -> [Line; 2] {
    let molten = WAX.replace("melting", "# melting").replace("frozen", "# frozen");
    [stiff(WAX), stiff(&molten)]
}

/// Stacks of two and three layers pass the heat of an explicit method to the plate, in one step and in many.
#[test]
fn heat_passes_through_stacks_in_steps_of_any_length() {
    for line in fluids() {
        let cases = [(&[300.0, 340.0][..], 1.0, 0.07), (&[300.0, 320.0, 340.0], 8.0, 0.01)];
        for (temperatures, duration, most) in cases {
            let expected = explicit(&line, temperatures, duration);
            for steps in [1, 7, 160] {
                let mut strand = stack(&line, temperatures);
                let found = rested(&line, &mut strand, (duration, steps));
                let error = found / expected - 1.0;
                assert!(error.abs() < most, "{temperatures:?} in {steps} steps: {error}");
                let missing = line.totals(&strand).missing;
                assert!(missing.abs() < 1e-11 * strand.given, "{missing}");
            }
        }
    }
}

/// What a stack gives to the plate in one step is what it gives in short ones.
#[test]
fn stacks_cool_alike_in_one_step_and_in_many() {
    for line in fluids() {
        for duration in [0.3, 8.0] {
            let [once, often] = [1, 400].map(|steps| {
                rested(&line, &mut stack(&line, &[300.0, 340.0, 340.0]), (duration, steps))
            });
            assert!((once / often - 1.0).abs() < 0.02, "{duration} s: {once} {often}");
        }
    }
}
