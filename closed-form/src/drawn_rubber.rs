//! Compressible neo-Hookean solids that are drawn: uniform deformation, from the roots of two equations.
//!
//! The energy per reference volume is `½ µ (J^(−2/3) tr C − 3) + ½ κ (½ (J² − 1) − ln J)`, source: J. C. Simo and T. J.
//! R. Hughes, *Computational Inelasticity*, Springer 1998, eq. 9.2.3.

/// A neo-Hookean solid.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rubber {
    /// Bulk modulus κ [Pa].
    pub bulk: f64,
    /// Shear modulus µ [Pa].
    pub shear: f64,
}

/// Conditions across the direction in which the solid is drawn.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Sides {
    /// Free along both: a bar.
    Free,
    /// Free along one, held along the other: plane strain.
    OneHeld,
    /// Held along both.
    Held,
}

impl Rubber {
    /// The solid with these moduli at small strains.
    pub fn of_young(young: f64, poisson: f64) -> Self {
        Self { bulk: young / (3.0 * (1.0 - 2.0 * poisson)), shear: young / (2.0 * (1.0 + poisson)) }
    }

    /// Force per reference area [Pa] along the first principal stretch.
    pub(crate) fn nominal(&self, [a, b, c]: [f64; 3]) -> f64 {
        let j = a * b * c;
        let trace = a * a + b * b + c * c;
        let isochoric = self.shear * j.powf(-2.0 / 3.0) * (a - trace / (3.0 * a));
        isochoric + 0.5 * self.bulk * (j - 1.0 / j) * b * c
    }

    /// Lateral stretch at a stretch, by bisection for the lateral force that vanishes.
    pub fn lateral(&self, stretch: f64, sides: Sides) -> f64 {
        let force = |lateral: f64| match sides {
            Sides::Free => self.nominal([lateral, lateral, stretch]),
            Sides::OneHeld => self.nominal([lateral, stretch, 1.0]),
            Sides::Held => lateral - 1.0,
        };
        root(force, [0.02, 20.0])
    }

    /// Force per reference area that holds a stretch [Pa].
    pub fn force(&self, stretch: f64, sides: Sides) -> f64 {
        let lateral = self.lateral(stretch, sides);
        match sides {
            Sides::Free => self.nominal([stretch, lateral, lateral]),
            Sides::OneHeld => self.nominal([stretch, lateral, 1.0]),
            Sides::Held => self.nominal([stretch, 1.0, 1.0]),
        }
    }
}

/// Root of an increasing function.
fn root(f: impl Fn(f64) -> f64, [mut low, mut high]: [f64; 2]) -> f64 {
    for _ in 0..200 {
        let middle = 0.5 * (low + high);
        if f(middle) > 0.0 { high = middle } else { low = middle }
    }
    0.5 * (low + high)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn small_strains_are_those_of_hooke() {
        let (young, poisson) = (7.0, 0.3);
        let rubber = Rubber::of_young(young, poisson);
        let strain = 1e-6;
        let free = rubber.force(1.0 + strain, Sides::Free) / strain;
        assert!((free / young - 1.0).abs() < 1e-5, "{free}");
        let plane = rubber.force(1.0 + strain, Sides::OneHeld) / strain;
        assert!((plane / (young / (1.0 - poisson * poisson)) - 1.0).abs() < 1e-5, "{plane}");
        let held = rubber.force(1.0 + strain, Sides::Held) / strain;
        let modulus = rubber.bulk + 4.0 / 3.0 * rubber.shear;
        assert!((held / modulus - 1.0).abs() < 1e-5, "{held}");
    }

    #[test]
    fn nearly_incompressible_rubber_keeps_its_volume() {
        let rubber = Rubber::of_young(3.0, 0.499_999);
        let stretch: f64 = 1.7;
        let lateral = rubber.lateral(stretch, Sides::Free);
        assert!((lateral * lateral * stretch - 1.0).abs() < 1e-5);
        // σ = µ (λ² − 1/λ), per reference area divided by λ.
        let exact = rubber.shear * (stretch - stretch.powi(-2));
        assert!((rubber.force(stretch, Sides::Free) / exact - 1.0).abs() < 1e-4);
    }
}
