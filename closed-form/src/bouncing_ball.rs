//! An elastic ball that bounces off a rigid plane without friction, slowly: contact by Hertz, without waves.
//!
//! `F = 4/3 E* √R δ^(3/2)` with the indentation δ and `E* = E/(1 − ν²)`. Source: K. L. Johnson, *Contact Mechanics*,
//! Cambridge 1985, §4.2 and §11.4.

/// An elastic ball.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ElasticBall {
    /// [m]
    pub radius: f64,
    /// [kg/m³]
    pub density: f64,
    /// [Pa]
    pub young: f64,
    /// [1]
    pub poisson: f64,
}

/// `∫₀¹ dx/√(1 − x^(5/2))`, half of the time of contact over δ/V.
const HALF_TIME: f64 = 1.471_637_6;

impl ElasticBall {
    fn modulus(&self) -> f64 {
        self.young / (1.0 - self.poisson * self.poisson)
    }

    /// [kg]
    pub fn mass(&self) -> f64 {
        4.0 / 3.0 * std::f64::consts::PI * self.radius.powi(3) * self.density
    }

    /// Largest indentation at a speed [m/s] of impact [m]: `(15 m V²/(16 E* √R))^(2/5)`.
    pub fn indentation(&self, speed: f64) -> f64 {
        let energy = 15.0 * self.mass() * speed * speed / (16.0 * self.modulus());
        (energy / self.radius.sqrt()).powf(0.4)
    }

    /// Largest force [N].
    pub fn force(&self, speed: f64) -> f64 {
        4.0 / 3.0 * self.modulus() * self.radius.sqrt() * self.indentation(speed).powf(1.5)
    }

    /// Radius of the contact at the largest indentation [m].
    pub fn contact_radius(&self, speed: f64) -> f64 {
        (self.radius * self.indentation(speed)).sqrt()
    }

    /// Time of contact [s].
    pub fn contact_time(&self, speed: f64) -> f64 {
        2.0 * HALF_TIME * self.indentation(speed) / speed
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn half_of_the_time_is_its_integral() {
        // x = 1 − s² takes the singularity away.
        let count = 200_000;
        let term = |n: usize| {
            let s = (n as f64 + 0.5) / count as f64;
            let x = 1.0 - s * s;
            2.0 * s / (1.0 - x.powf(2.5)).sqrt() / count as f64
        };
        let found: f64 = (0..count).map(term).sum();
        assert!((found - HALF_TIME).abs() < 1e-7, "{found}");
    }

    #[test]
    fn the_work_of_the_force_is_the_kinetic_energy() {
        let ball = ElasticBall { radius: 0.01, density: 1000.0, young: 1e5, poisson: 0.4 };
        let work = 0.4 * ball.force(0.2) * ball.indentation(0.2);
        assert!((work / (0.5 * ball.mass() * 0.04) - 1.0).abs() < 1e-12);
    }
}
