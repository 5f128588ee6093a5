//! Thin plate that sinks upright into a bath at constant speed, long after it began to: the temperature about the
//! surface of the bath no longer changes.
//!
//! In the frame of the surface, with heights s above it, the plate moves down: `D T″ + v T′ = 0` above, and
//! `D T″ + v T′ = β (T − T∞)` below it, with the diffusivity D and the rate β at which a thin piece of the plate
//! follows the bath. Above, `T = T₀ − A e^{−vs/D}`; below, `T = T∞ + B e^{ms}`, with `m = (√(v² + 4Dβ) − v)/(2D)`. Value and
//! slope are continuous. As β → ∞ the plate has the temperature of the bath at its surface, `A = T₀ − T∞`
//! (M. Adda-Bedia & Y. Pomeau 1995, doi 10.1103/PhysRevE.52.4105).

/// A thin plate that sinks into a bath.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DippedPlate {
    /// Diffusivity D [m²/s].
    pub diffusivity: f64,
    /// Speed v at which the plate sinks [m/s].
    pub speed: f64,
    /// Rate β at which a thin piece follows the bath [1/s]: coefficient of heat transfer times perimeter, over heat
    /// capacity per volume times area of the cross-section.
    pub rate: f64,
}

impl DippedPlate {
    /// `(T − T∞)/(T₀ − T∞)` at a height above the surface of the bath [m].
    pub fn temperature(&self, height: f64) -> f64 {
        let Self { diffusivity, speed, rate } = *self;
        let above = speed / diffusivity;
        // The difference of two roots that are close for slow exchange.
        let below = 2.0 * rate / ((speed * speed + 4.0 * diffusivity * rate).sqrt() + speed);
        let at_surface = above / (above + below);
        match height > 0.0 {
            true => 1.0 - (1.0 - at_surface) * (-above * height).exp(),
            false => at_surface * (below * height).exp(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const PLATE: DippedPlate = DippedPlate { diffusivity: 5e-7, speed: 2e-4, rate: 3.0 };

    #[test]
    fn temperature_obeys_the_equation_of_the_moving_plate() {
        let h = 1e-5;
        for height in [-1e-3, -2e-4, 3e-4, 4e-3] {
            let [low, own, high] = [-h, 0.0, h].map(|step| PLATE.temperature(height + step));
            let (slope, bend) = ((high - low) / (2.0 * h), (high - 2.0 * own + low) / (h * h));
            let gained = PLATE.diffusivity * bend + PLATE.speed * slope;
            let lost = if height < 0.0 { PLATE.rate * own } else { 0.0 };
            assert!((gained - lost).abs() < 1e-3 * PLATE.speed * slope, "{gained} {lost}");
        }
    }

    #[test]
    fn heat_flows_on_across_the_surface() {
        let h = 1e-9;
        let slope = |height: f64| {
            (PLATE.temperature(height + h) - PLATE.temperature(height - h)) / (2.0 * h)
        };
        assert!((slope(-2e-8) / slope(2e-8) - 1.0).abs() < 1e-3);
    }

    #[test]
    fn strong_bath_holds_its_temperature_at_the_surface() {
        let plate = DippedPlate { rate: 1e12, ..PLATE };
        let wanted = 1.0 - (-plate.speed * 2e-3 / plate.diffusivity).exp();
        assert!((plate.temperature(2e-3) - wanted).abs() < 1e-5);
        assert!(plate.temperature(0.0) < 1e-5);
    }
}
