//! Slump of a cylinder of a yield-stress fluid once its mould is lifted.
//!
//! Each layer bears the weight above it over its own section; half of that stress is the largest shear. Layers below
//! the depth 2τ'H yield and widen until the shear is τ₀ again, plane layers remain plane. With `τ' = τ₀/(ρgH)` the
//! height falls by `s/H = 1 − 2τ'(1 − ln 2τ')`, and not at all for τ' ≥ 1/2.
//!
//! It is a model, not exact: friction of the floor, the bulging of layers and inertia are left out, and the criterion
//! is Tresca's. Measured slumps of mineral suspensions in cylinders about as high as wide follow it to some 10 %. By
//! the criterion of von Mises the uniaxial yield stress is √3 τ₀ for 2 τ₀.
//!
//! Source: N. Pashias, D. V. Boger, J. Summers and D. J. Glenister (1996), J. Rheol. 40, 1179–1189,
//! doi 10.1122/1.550780.

/// The cylinder before it slumps.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Slump {
    /// Yield stress τ₀ [Pa].
    pub yield_stress: f64,
    /// Weight per volume ρg [N/m³].
    pub weight: f64,
    /// Height H [m].
    pub height: f64,
}

impl Slump {
    /// Dimensionless yield stress `τ' = τ₀/(ρgH)` [1].
    pub fn yield_number(&self) -> f64 {
        self.yield_stress / (self.weight * self.height)
    }

    /// Loss of height s [m].
    pub fn slump(&self) -> f64 {
        let part = (2.0 * self.yield_number()).min(1.0);
        self.height * (1.0 - part * (1.0 - part.ln()))
    }

    /// Section over the initial one of the layer that lay at a depth [m] below the top: 1 in the unyielded part.
    pub fn widening(&self, depth: f64) -> f64 {
        (0.5 * self.weight * depth / self.yield_stress).max(1.0)
    }
}

#[cfg(test)]
mod tests {
    use super::super::checks::{assert_close, assert_within};
    use super::super::quadrature::integrate;
    use super::*;

    fn slump(number: f64) -> Slump {
        Slump { yield_stress: number * 3000.0, weight: 2e4, height: 0.15 }
    }

    #[test]
    fn six_yield_numbers() {
        let digits =
            [(0.05, 0.66974), (0.1, 0.47811), (0.2, 0.23348), (0.3, 0.09350), (0.4, 0.02149)];
        for (number, part) in digits {
            assert_close(slump(number).yield_number(), number, 1e-14);
            assert_within(slump(number).slump() / 0.15, part, 6e-6);
        }
        for number in [0.5, 0.8] {
            assert_eq!(slump(number).slump(), 0.0);
        }
    }

    #[test]
    fn height_is_the_sum_of_the_widened_layers() {
        for number in [0.05, 0.2, 0.45] {
            let cylinder = slump(number);
            let yields = 2.0 * number * 0.15;
            let layer = |depth: f64| 1.0 / cylinder.widening(depth);
            let height = integrate(layer, &[0.0, yields, 0.15]);
            assert_close(0.15 - height, cylinder.slump(), 1e-9);
            // Half the weight above over the widened section is the yield stress.
            let shear = 0.5 * cylinder.weight * 0.14 / cylinder.widening(0.14);
            assert_close(shear, cylinder.yield_stress, 1e-13);
        }
    }
}
