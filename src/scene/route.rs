//! Motion of a nozzle over time as a sequence of legs, each a polynomial in time.

use super::filament::PathTable;

/// A part of a route.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Leg {
    /// Time at its beginning, and its duration [s].
    pub start: f64,
    pub duration: f64,
    /// Place of the outlet at the beginning, velocity there, and acceleration [m, m/s, m/s²].
    pub place: [[f64; 3]; 3],
    /// Volume flow at the beginning and its slope [m³/s, m³/s²]; `None` if an input sets the flow.
    pub flow: Option<[f64; 2]>,
}

/// A nozzle's route: it rests before the first leg and after the last, and no fluid comes then.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Route {
    pub legs: Vec<Leg>,
}

impl Leg {
    /// Place of the outlet at a time after the beginning [m].
    pub fn at(&self, s: f64) -> [f64; 3] {
        let [place, velocity, bend] = self.place;
        [0, 1, 2].map(|axis| place[axis] + s * (velocity[axis] + 0.5 * s * bend[axis]))
    }

    pub fn stop(&self) -> f64 {
        self.start + self.duration
    }

    /// Larger one of the speeds at both ends [m/s].
    pub fn fastest(&self) -> f64 {
        let [_, velocity, bend] = self.place;
        let speed = |s: f64| {
            let along = |axis: usize| velocity[axis] + s * bend[axis];
            (0..3).map(|axis| along(axis).powi(2)).sum::<f64>().sqrt()
        };
        speed(0.0).max(speed(self.duration))
    }

    /// Larger one of the flows at both ends [m³/s]; 0 where an input sets the flow.
    pub fn largest_flow(&self) -> f64 {
        self.flow.map_or(0.0, |[value, slope]| value.max(value + slope * self.duration))
    }

    /// Returns true if fluid may come on it.
    pub fn lays(&self) -> bool {
        self.flow != Some([0.0; 2])
    }

    /// Volume that the route lets come in a part of the leg [m³]; 0 where an input sets the flow.
    fn volume(&self, duration: f64) -> f64 {
        self.flow.map_or(0.0, |[value, slope]| duration * (value + 0.5 * slope * duration))
    }
}

impl Route {
    /// The even motion between the places of a table, up to the end of its shortest list; `height` is that of a table
    /// without `z` [m].
    pub fn of_table(table: &PathTable, height: f64) -> Self {
        let leg = |n: usize| {
            let duration = table.time[n + 1] - table.time[n];
            let slope = |from: f64, to: f64| (to - from) / duration;
            let [from, to] = [n, n + 1].map(|n| table.knot(n, height));
            let flow = table.flow.as_ref().map(|flow| [flow[n], 0.0]);
            Leg {
                start: table.time[n],
                duration,
                place: [from, [0, 1, 2].map(|axis| slope(from[axis], to[axis])), [0.0; 3]],
                flow,
            }
        };
        let others = [&table.z, &table.flow].into_iter().flatten().map(Vec::len);
        let lengths = others.chain([table.time.len(), table.x.len(), table.y.len()]);
        let count = lengths.min().unwrap_or(0);
        Self { legs: (1..count).map(|n| leg(n - 1)).collect() }
    }

    /// Time at which the last leg ends [s].
    pub fn stop(&self) -> f64 {
        self.legs.last().map_or(0.0, Leg::stop)
    }

    /// Length of time until a stop time in which the nozzle is on its route [s].
    pub fn time_until(&self, stop: f64) -> f64 {
        let start = self.legs.first().map_or(0.0, |leg| leg.start);
        (self.stop().min(stop) - start).max(0.0)
    }

    /// Volume that the route lets come until a time [m³].
    pub fn volume_until(&self, stop: f64) -> f64 {
        let of_leg = |leg: &Leg| leg.volume((stop - leg.start).clamp(0.0, leg.duration));
        self.legs.iter().map(of_leg).sum()
    }

    /// Legs on which fluid may come.
    pub fn laid(&self) -> impl Iterator<Item = &Leg> {
        self.legs.iter().filter(|leg| leg.lays())
    }

    /// Legs that begin before a time [s], up to it.
    pub fn legs_until(&self, stop: f64) -> impl Iterator<Item = Leg> {
        let begun = self.legs.iter().filter(move |leg| leg.start < stop);
        begun.map(move |leg| Leg { duration: leg.duration.min(stop - leg.start), ..*leg })
    }

    /// The lowest place until a time on legs of a kind, as height [m] and time [s].
    pub fn lowest_until(&self, stop: f64, counts: impl Fn(&Leg) -> bool) -> Option<[f64; 2]> {
        let legs = self.legs_until(stop).filter(|leg| counts(leg));
        let ends = legs.flat_map(|leg| [0.0, leg.duration].map(|s| [leg.at(s)[2], leg.start + s]));
        ends.min_by(|a, b| a[0].total_cmp(&b[0]))
    }

    /// Ranges of x and y where fluid may come [m]; without any, the first is the larger.
    pub fn ranges(&self) -> [[f64; 2]; 2] {
        let ends = || self.laid().flat_map(|leg| [leg.place[0], leg.at(leg.duration)]);
        [0, 1].map(|axis| {
            let along = || ends().map(|place| place[axis]);
            [along().fold(f64::INFINITY, f64::min), along().fold(f64::NEG_INFINITY, f64::max)]
        })
    }

    /// The leg at a time, or the place at which the nozzle rests then [m].
    pub fn leg_at(&self, time: f64) -> Result<&Leg, [f64; 3]> {
        let next = self.legs.partition_point(|leg| leg.start <= time);
        match next.checked_sub(1).map(|n| &self.legs[n]) {
            None => Err(self.legs.first().map_or([0.0; 3], |leg| leg.place[0])),
            Some(leg) if time < leg.stop() => Ok(leg),
            Some(leg) => Err(leg.at(leg.duration)),
        }
    }
}
