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
        self.least(self.flow)
    }

    /// Least temperature of the fluid within the duration [K].
    pub fn least_temperature(&self) -> f64 {
        self.least(self.temperature)
    }

    /// Least height of the outlet within the duration [m].
    pub fn least_height(&self) -> f64 {
        self.least(self.place.map(|derivative| derivative[2]))
    }

    /// Least value of a polynomial within the duration, at an end or where it turns.
    fn least(&self, polynomial: [f64; 3]) -> f64 {
        let [_, slope, bend] = polynomial;
        let turn = if bend > 0.0 { (-slope / bend).clamp(0.0, self.duration) } else { 0.0 };
        let values = [0.0, turn, self.duration].map(|s| at(polynomial, s));
        values.into_iter().fold(f64::INFINITY, f64::min)
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

#[cfg(test)]
mod tests {
    use super::*;

    /// `(s − 1)²` is least at its turning point if the motion reaches it, and at its end otherwise; `−s²` at its end.
    #[test]
    fn least_values_are_at_ends_or_turning_points() {
        let parabola = [1.0, -2.0, 2.0];
        let of = |polynomial: [f64; 3], duration: f64| {
            let place = polynomial.map(|derivative| [9.0, 9.0, derivative]);
            let motion = Motion { duration, place, flow: polynomial, temperature: polynomial };
            let least = motion.least_flow();
            assert_eq!([motion.least_temperature(), motion.least_height()], [least; 2]);
            least
        };
        assert_eq!([of(parabola, 3.0), of(parabola, 0.5)], [0.0, 0.25]);
        assert_eq!(of([0.0, 0.0, -2.0], 3.0), -9.0);
        assert_eq!(of([2.0, 1.0, 0.0], 3.0), 2.0);
    }
}
