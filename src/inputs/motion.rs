//! Motion and flow of a nozzle over a part of a step.

/// Polynomials in time of the nozzle over a duration: value, first and second derivative at its beginning.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Motion {
    /// [s]
    pub duration: f64,
    /// Place of the outlet [m].
    pub place: [[f64; 3]; 3],
    /// Volume flow [m³/s].
    pub flow: [f64; 3],
    /// Temperature of the fluid [K].
    pub temperature: [f64; 3],
}

/// Bisections in the search for the time of a volume.
const HALVINGS: usize = 60;
/// Rounding of a flow, over the largest term of its polynomial.
const SLACK: f64 = 1e-9;

fn at([value, slope, bend]: [f64; 3], s: f64) -> f64 {
    value + s * (slope + 0.5 * s * bend)
}

impl Motion {
    /// Volume that has come after a time [m³].
    pub fn volume(&self, s: f64) -> f64 {
        let [value, slope, bend] = self.flow;
        s * (value + s * (0.5 * slope + s * bend / 6.0))
    }

    /// Place of the outlet after a time [m].
    pub fn outlet(&self, s: f64) -> [f64; 3] {
        [0, 1, 2].map(|axis| at(self.place.map(|derivative| derivative[axis]), s))
    }

    /// Temperature of the fluid that comes after a time [K].
    pub fn temperature_at(&self, s: f64) -> f64 {
        at(self.temperature, s)
    }

    /// Least flow within the duration [m³/s].
    pub fn least_flow(&self) -> f64 {
        let [_, slope, bend] = self.flow;
        let turn = if bend > 0.0 { (-slope / bend).clamp(0.0, self.duration) } else { 0.0 };
        let flows = [0.0, turn, self.duration].map(|s| at(self.flow, s));
        flows.into_iter().fold(f64::INFINITY, f64::min)
    }

    /// Flow that is rounding of an input that falls to zero within the duration [m³/s].
    pub fn rounding(&self) -> f64 {
        let [value, slope, bend] = self.flow.map(f64::abs);
        SLACK * (value + self.duration * (slope + self.duration * bend))
    }

    /// The time from `from` on at which a volume has come [s].
    pub fn time_of(&self, volume: f64, from: f64) -> f64 {
        let [mut low, mut high] = [from, self.duration];
        for _ in 0..HALVINGS {
            let middle = 0.5 * (low + high);
            *(if self.volume(middle) < volume { &mut low } else { &mut high }) = middle;
        }
        high
    }
}
