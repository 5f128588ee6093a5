//! Motion of a nozzle over a step, by the inputs and by the table of its path.

use std::ops::Range;

use crate::inputs::InputPath;
use crate::method::filament::Motion;
use crate::scene::{Filament, PathTable};

/// Part of the largest volume whose flow per second is rounding.
const ROUNDING: f64 = 1e-12;

/// Places of a filament's inputs, and the path that the scene sets.
pub struct NozzleInputs {
    /// Places of x, y and z among the inputs, if inputs move the nozzle.
    place: Option<Range<usize>>,
    flow: usize,
    temperature: usize,
    air: Option<usize>,
    /// Flow below zero that is rounding, as of inputs that fall to zero [m³/s].
    rounding: f64,
    table: Option<(PathTable, f64)>,
}

impl NozzleInputs {
    /// `own` are the places of the filament's inputs, in the order of [`Filament::inputs`].
    pub fn new(filament: &Filament, own: Range<usize>) -> Self {
        let table = filament.table().map(|table| (table.clone(), filament.nozzle.height));
        let place = table.is_none().then(|| own.start..own.start + 3);
        let flow = own.start + place.as_ref().map_or(0, Range::len);
        let air = filament.convection.map(|_| flow + 2);
        let rounding = ROUNDING * filament.most;
        Self { place, flow, temperature: flow + 1, air, rounding, table }
    }

    /// Place of the outlet at time zero [m].
    pub fn start(&self, inputs: &[f64]) -> [f64; 3] {
        match (&self.table, &self.place) {
            (Some((table, height)), _) => table.knot(0, *height),
            (None, Some(place)) => [0, 1, 2].map(|axis| inputs[place.start + axis]),
            (None, None) => [0.0; 3],
        }
    }

    /// Mean temperature of the air over a step [K]; `otherwise` where there is none.
    pub fn air(&self, path: &InputPath, duration: f64, otherwise: f64) -> f64 {
        self.air.map_or(otherwise, |air| path.at(0, 0.5 * duration)[air])
    }

    /// Places and values of inputs that are temperatures.
    pub fn temperatures<'a>(&self, inputs: &'a [f64]) -> impl Iterator<Item = (usize, f64)> + 'a {
        let places = [Some(self.temperature), self.air].into_iter().flatten();
        places.map(|place| (place, inputs[place]))
    }

    /// The flow of an input vector [m³/s] that goes back into the nozzle, with its place.
    pub fn flow_back(&self, inputs: &[f64]) -> Option<(usize, f64)> {
        let flow = inputs[self.flow];
        (flow < -self.rounding).then_some((self.flow, flow))
    }

    /// Motions of the nozzle over a step that begins at a time [s]: one, or one for each part of the table.
    pub fn motions(&self, path: &InputPath, start: f64, duration: f64) -> Vec<Motion> {
        let of = |from: f64, duration: f64, place: [[f64; 3]; 3]| {
            let derivatives = [0, 1, 2].map(|order| path.at(order, from));
            let input = |index: usize| {
                derivatives.each_ref().map(|list| list.get(index).copied().unwrap_or(0.0))
            };
            let place = match &self.place {
                None => place,
                Some(own) => {
                    let axes = [0, 1, 2].map(|axis| input(own.start + axis));
                    [0, 1, 2].map(|order| [0, 1, 2].map(|axis| axes[axis][order]))
                }
            };
            let (mut flow, temperature) = (input(self.flow), input(self.temperature));
            flow[0] = flow[0].max(0.0);
            Motion { duration, place, flow, temperature }
        };
        let Some((table, height)) = &self.table else {
            return vec![of(0.0, duration, [[0.0; 3]; 3])];
        };
        let inner = table.time.iter().map(|time| time - start);
        let inner = inner.filter(|&s| s > 0.0 && s < duration);
        let ends: Vec<f64> = [0.0].into_iter().chain(inner).chain([duration]).collect();
        let part = |ends: &[f64]| {
            let length = ends[1] - ends[0];
            of(ends[0], length, evenly(table, *height, start + 0.5 * (ends[0] + ends[1]), length))
        };
        ends.windows(2).filter(|ends| ends[1] > ends[0]).map(part).collect()
    }
}

/// The even motion around a time that lies between two knots, or before or after all: value and derivatives at the
/// beginning of a part of the given length [s].
fn evenly(table: &PathTable, height: f64, middle: f64, length: f64) -> [[f64; 3]; 3] {
    let last = table.len() - 1;
    let next = table.time.partition_point(|&time| time <= middle);
    if next == 0 || next > last {
        return [table.knot(if next == 0 { 0 } else { last }, height), [0.0; 3], [0.0; 3]];
    }
    let [from, to] = [next - 1, next].map(|n| table.knot(n, height));
    let [begin, end] = [next - 1, next].map(|n| table.time[n]);
    let speed = [0, 1, 2].map(|axis| (to[axis] - from[axis]) / (end - begin));
    let since = middle - 0.5 * length - begin;
    [[0, 1, 2].map(|axis| from[axis] + since * speed[axis]), speed, [0.0; 3]]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tables_are_followed_across_their_knots() {
        let filament: Filament = toml::from_str(
            "fluid = { density = 1e3, viscosity = 1.0, specific_heat = 1e3, conductivity = 0.0 }\nnozzle = { diameter = \
             1e-3, height = 2e-3, temperature = 300.0, flow = 1e-8 }\nmost = 1e-6\npath = { time = [1.0, 2.0, 4.0], x = \
             [0.0, 0.1, 0.1], y = [0.0, 0.0, 0.4] }",
        )
        .unwrap();
        let nozzle = NozzleInputs::new(&filament, 0..2);
        let path = InputPath::new(&[1e-8, 300.0], &[vec![1e-9, 0.0], vec![0.0, 0.0]]);
        let motions = nozzle.motions(&path, 1.5, 3.0);
        let durations: Vec<f64> = motions.iter().map(|motion| motion.duration).collect();
        assert_eq!(durations, [0.5, 2.0, 0.5]);
        let close = |found: [f64; 3], wanted: [f64; 3]| {
            found.iter().zip(wanted).all(|(a, b)| (a - b).abs() < 1e-12)
        };
        assert!(close(motions[0].place[0], [0.05, 0.0, 2e-3]));
        assert!(close(motions[0].place[1], [0.1, 0.0, 0.0]));
        assert!(close(motions[1].place[0], [0.1, 0.0, 2e-3]));
        assert!(close(motions[1].place[1], [0.0, 0.2, 0.0]));
        assert!(close(motions[2].place[0], [0.1, 0.4, 2e-3]) && motions[2].place[1] == [0.0; 3]);
        assert!((motions[2].flow[0] - 1.25e-8).abs() < 1e-20);
    }
}
