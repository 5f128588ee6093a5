//! Motion of a nozzle over a step, by the inputs and by the table of its path.

use std::ops::Range;

use crate::body::BodyError;
use crate::inputs::{InputPath, Motion, Trend};
use crate::scene::{Filament, Route};

/// Part of a segment that is no distance between two places of the nozzle.
const NO_DISTANCE: f64 = 1e-3;
/// Part of the largest volume whose flow per second is rounding.
const ROUNDING: f64 = 1e-12;

/// Places of a filament's inputs, and the path that the scene sets.
pub struct NozzleInputs {
    /// Places of x, y and z among the inputs, if inputs move the nozzle.
    place: Option<Range<usize>>,
    /// `None` if the route sets the flow.
    flow: Option<usize>,
    temperature: usize,
    air: Option<usize>,
    /// Flow below zero that is rounding, as of inputs that fall to zero [m³/s].
    rounding: f64,
    /// Distance that is rounding of a place [m].
    least: f64,
    route: Option<Route>,
}

impl NozzleInputs {
    /// `own` are the places of the filament's inputs, in the order of [`Filament::inputs`].
    pub fn new(filament: &Filament, route: Option<Route>, own: Range<usize>) -> Self {
        let mut next = own.start;
        let mut take = |count: usize| {
            next += count;
            next - count
        };
        let place = filament.moves_by_inputs().then(|| take(3)).map(|first| first..first + 3);
        let flow = (!filament.path_sets_flow()).then(|| take(1));
        let temperature = take(1);
        let air = filament.convection.map(|_| take(1));
        let rounding = ROUNDING * filament.most;
        let least = NO_DISTANCE * filament.segment_length();
        Self { place, flow, temperature, air, rounding, least, route }
    }

    /// Place of the outlet at time zero [m].
    pub fn start(&self, inputs: &[f64]) -> [f64; 3] {
        match (&self.route, &self.place) {
            (Some(route), _) => match route.leg_at(0.0) {
                Ok(leg) => leg.at(-leg.start),
                Err(place) => place,
            },
            (None, Some(place)) => [0, 1, 2].map(|axis| inputs[place.start + axis]),
            (None, None) => [0.0; 3],
        }
    }

    /// Temperature of the air over a step that begins at a time [K]; `otherwise` where there is none.
    pub fn air(&self, path: &InputPath, begin: f64, otherwise: f64) -> Trend {
        let trend = |air| Trend { begin, derivatives: input(path, air, 0.0) };
        self.air.map_or(Trend::held(otherwise), trend)
    }

    /// Places and values of inputs that are temperatures.
    fn temperatures<'a>(&self, inputs: &'a [f64]) -> impl Iterator<Item = (usize, f64)> + 'a {
        let places = [Some(self.temperature), self.air].into_iter().flatten();
        places.map(|place| (place, inputs[place]))
    }

    /// The flow of an input vector [m³/s] that goes back into the nozzle, with its place.
    fn flow_back(&self, inputs: &[f64]) -> Option<(usize, f64)> {
        let flow = inputs[self.flow?];
        (flow < -self.rounding).then_some((self.flow?, flow))
    }

    /// Refuses temperatures that are not above absolute zero, and a flow that goes back.
    pub fn check(&self, inputs: &[f64]) -> Result<(), BodyError> {
        let cold = self.temperatures(inputs).find(|(_, value)| *value <= 0.0);
        if let Some((index, value)) = cold {
            let message = format!("{value} K is not above absolute zero");
            return Err(BodyError::Input { index, message });
        }
        match self.flow_back(inputs) {
            Some((index, flow)) => {
                let message = format!("a flow of {flow} m³/s goes back into the nozzle");
                Err(BodyError::Input { index, message })
            }
            None => Ok(()),
        }
    }

    /// The places of the nozzle that were set without derivatives and apart from its place [m]: it moves evenly to them
    /// over a step. A place that jumps is no motion of a machine, and hosts that send no derivatives mean none.
    pub fn approached(
        &self,
        path: &InputPath,
        nozzle: [f64; 3],
        duration: f64,
    ) -> Vec<(usize, [f64; 2])> {
        let Some(own) = self.place.clone() else { return Vec::new() };
        let moves = |list: &Vec<f64>| list[own.clone()].iter().any(|&rate| rate != 0.0);
        let set = &path.start()[own.clone()];
        let apart = set.iter().zip(nozzle).map(|(set, at)| (set - at).powi(2)).sum::<f64>().sqrt();
        let comes =
            path.derivatives().iter().any(|list| self.flow.is_some_and(|own| list[own] > 0.0));
        if path.derivatives()[1..].iter().any(moves) || apart <= self.least || !comes {
            return Vec::new();
        }
        let ways = own.zip(set.iter().zip(nozzle));
        ways.map(|(place, (&set, at))| (place, [at, (set - at) / duration])).collect()
    }

    /// Motions of the nozzle over a step that begins at a time [s]: one, or one for each leg of the route.
    pub fn motions(&self, path: &InputPath, start: f64, duration: f64) -> Vec<Motion> {
        let Some(route) = &self.route else {
            let place = self.place.clone().map_or([[0.0; 3]; 3], |own| {
                let axes = own.map(|place| input(path, place, 0.0));
                let axes: Vec<[f64; 3]> = axes.collect();
                [0, 1, 2].map(|order| [0, 1, 2].map(|axis| axes[axis][order]))
            });
            return vec![self.motion(path, (0.0, duration), place, None)];
        };
        let ends = route.legs.iter().flat_map(|leg| [leg.start, leg.stop()]);
        let inner = ends.map(|time| time - start).filter(|&s| s > 0.0 && s < duration);
        let ends: Vec<f64> = [0.0].into_iter().chain(inner).chain([duration]).collect();
        let part = |ends: &[f64]| {
            let length = ends[1] - ends[0];
            let (place, flow) = on_route(route, start + 0.5 * (ends[0] + ends[1]), length);
            self.motion(path, (ends[0], length), place, flow)
        };
        ends.windows(2).filter(|ends| ends[1] > ends[0]).map(part).collect()
    }

    /// The motion of a part of a step, from a time after its beginning on [s].
    fn motion(
        &self,
        path: &InputPath,
        (from, duration): (f64, f64),
        place: [[f64; 3]; 3],
        flow: Option<[f64; 2]>,
    ) -> Motion {
        let of_input = || self.flow.map_or([0.0; 3], |own| input(path, own, from));
        let mut flow = flow.map_or_else(of_input, |[value, slope]| [value, slope, 0.0]);
        flow[0] = flow[0].max(0.0);
        Motion { duration, place, flow, temperature: input(path, self.temperature, from) }
    }
}

/// Value and derivatives of an input at a time after the beginning of its path [s].
fn input(path: &InputPath, place: usize, from: f64) -> [f64; 3] {
    [0, 1, 2].map(|order| path.at(order, from).get(place).copied().unwrap_or(0.0))
}

/// Place of the outlet with its derivatives at the beginning of a part that is around a time [s] on one leg of a route,
/// or before or after all, and the flow there; `None` if an input sets that.
fn on_route(route: &Route, middle: f64, length: f64) -> ([[f64; 3]; 3], Option<[f64; 2]>) {
    let leg = match route.leg_at(middle) {
        Ok(leg) => leg,
        Err(place) => return ([place, [0.0; 3], [0.0; 3]], Some([0.0; 2])),
    };
    let since = middle - 0.5 * length - leg.start;
    let [_, velocity, bend] = leg.place;
    let speed = [0, 1, 2].map(|axis| velocity[axis] + since * bend[axis]);
    let flow = leg.flow.map(|[value, slope]| [value + since * slope, slope]);
    ([leg.at(since), speed, bend], flow)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn motions(path: &str, inputs: (&[f64], &[Vec<f64>])) -> Vec<Motion> {
        let filament: Filament = toml::from_str(&format!(
            "fluid = {{ density = 1e3, viscosity = 1.0, specific_heat = 1e3, conductivity = 0.0 }}\nnozzle = {{ diameter = \
             1e-3, height = 2e-3, temperature = 300.0 }}\nmost = 1e-6\npath = {path}"
        ))
        .unwrap();
        let route = filament.route(&Default::default()).unwrap();
        let nozzle = NozzleInputs::new(&filament, route, 0..2);
        nozzle.motions(&InputPath::new(inputs.0, inputs.1), 1.5, 3.0)
    }

    fn close(found: [f64; 3], wanted: [f64; 3]) -> bool {
        found.iter().zip(wanted).all(|(a, b)| (a - b).abs() < 1e-12)
    }

    const TABLE: &str = "{ time = [1.0, 2.0, 4.0], x = [0.0, 0.1, 0.1], y = [0.0, 0.0, 0.4] }";

    /// The flow of the input ends with the table.
    #[test]
    fn tables_are_followed_across_their_knots() {
        let motions = motions(TABLE, (&[1e-8, 300.0], &[vec![1e-9, 0.0], vec![0.0, 0.0]]));
        let durations: Vec<f64> = motions.iter().map(|motion| motion.duration).collect();
        assert_eq!(durations, [0.5, 2.0, 0.5]);
        assert!(close(motions[0].place[0], [0.05, 0.0, 2e-3]));
        assert!(close(motions[0].place[1], [0.1, 0.0, 0.0]));
        assert!(close(motions[1].place[0], [0.1, 0.0, 2e-3]));
        assert!(close(motions[1].place[1], [0.0, 0.2, 0.0]));
        assert!(close(motions[2].place[0], [0.1, 0.4, 2e-3]) && motions[2].place[1] == [0.0; 3]);
        assert!((motions[1].flow[0] - 1.05e-8).abs() < 1e-20 && motions[2].flow == [0.0; 3]);
    }

    /// A column of the table sets the flow, and no input does.
    #[test]
    fn tables_may_set_the_flow() {
        let table = TABLE.replace(" }", ", flow = [3e-8, 2e-8, 0.0] }");
        let motions = motions(&table, (&[300.0, 280.0], &[]));
        assert!(close(motions[0].flow.map(|flow| 1e8 * flow), [3.0, 0.0, 0.0]), "{motions:?}");
        assert!(close(motions[1].flow.map(|flow| 1e8 * flow), [2.0, 0.0, 0.0]));
        assert!(motions[0].temperature[0] == 300.0 && motions[2].flow == [0.0; 3]);
    }
}
